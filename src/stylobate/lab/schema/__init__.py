"""OpenAPI description of the laboratory's endpoints."""

from importlib.metadata import version
from typing import Any

from stylobate.errors import LARGEST, SMALLEST
from stylobate.lab.limits import Limits
from stylobate.lab.schema.curves import CURVES
from stylobate.lab.schema.endpoints import paths
from stylobate.lab.schema.jobs import JOBS
from stylobate.lab.schema.options import CATALOGUE
from stylobate.lab.schema.requests import components
from stylobate.lab.schema.runs import RUNS


def schema(limits: Limits) -> dict[str, Any]:
    """Return the endpoints as OpenAPI 3.1."""
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "stylobate laboratory",
            "version": version("stylobate"),
            "description": f"Requests may have {limits.body} bytes, uploads of records {limits.records}. Numbers are "
            f"in SI units, angles in rad; their size must be zero or between {SMALLEST:g} and {LARGEST:g}.",
        },
        "paths": paths(),
        "components": {"schemas": {**components(limits), **CATALOGUE, **RUNS, **CURVES, **JOBS}},
    }
