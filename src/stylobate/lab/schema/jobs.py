"""Schemas of jobs: state, events and results."""

from stylobate.errors import Outcome
from stylobate.lab.schema.notation import (
    Schema,
    exactly,
    listed,
    number,
    or_none,
    ref,
    table,
    text,
    whole,
    word,
)
from stylobate.results.outcomes import NUMERICALLY_UNCERTAIN

KINDS = ("exact", "map", "basin", "animation")
"""The kinds of jobs."""

_CODE: Schema = {"type": "integer"}
_NAMES = listed("codes and their meanings", exactly("", _CODE, text("meaning")))
_CODES = listed("a row for each value of x", listed("a code for each value of y", _CODE))
_SIZE = {
    "uncertain": whole(f"runs whose outcome is {NUMERICALLY_UNCERTAIN}"),
    "runs": whole("number of runs"),
}


def _share(about: str) -> Schema:
    return or_none(number(about, minimum=0.0, maximum=1.0))


_AXIS = table(
    "A quantity that varies.",
    {"name": text("name as in the description"), "values": listed("in SI units", {"type": ["number", "null"]})},
    {"long_name": text("name in words"), "units": text("unit such as rad s-1")},
)

_PLANE_BEGUN = table(
    "The first event of a map or basin: its axes, and the meanings of the codes of cells.",
    {"axes": table("", {"x": _AXIS, "y": _AXIS}), "names": _NAMES},
)

_CELLS = table(
    "Computed cells, from coarse to fine.",
    {
        "stride": whole("step between known values along x and y"),
        "cells": listed("", exactly("", whole("index along x"), whole("index along y"), _CODE)),
    },
)

_MAP = table(
    "The result of a map: frequencies of the outcomes.",
    {
        **_SIZE,
        "shares": table("Shares of outcomes.", {one.label: _share(f"share that ended {one.label}") for one in Outcome}),
    },
)

_CONTACT_MAP = table(
    "The result of a map of a model that slides: kinds of contact.", {**_SIZE, "codes": _CODES, "names": _NAMES}
)

_BASIN = table(
    "The result of a basin: the attractor of each initial condition.",
    {
        **_SIZE,
        "codes": _CODES,
        "names": _NAMES,
        "attractors": listed(
            "the attractors",
            table(
                "",
                {
                    "name": text("name as in names"),
                    "kind": text("kind of outcome"),
                    "period": whole("period in periods of the base; 0 if there is none"),
                    "fraction": _share("share of all initial conditions"),
                    "fraction_low": _share("lower end of its interval"),
                    "fraction_high": _share("upper end of its interval"),
                },
            ),
        ),
    },
)

_RESULTS = ("ExactOrbits", "MapResult", "ContactMapResult", "BasinResult")

_JOB = table(
    "The state of a job.",
    {
        "id": text("identity of the job in requests"),
        "kind": word("kind of computation", KINDS),
        "state": word("state", ["waiting", "running", "done", "failed", "cancelled"]),
        "done": whole("number of completed runs"),
        "total": whole("number of runs; 0 while unknown"),
        "note": text("a line about the computation, such as the compilation of a kernel"),
        "events": listed("events, from the number `after` on", {"anyOf": [ref("PlaneBegun"), ref("PlaneCells")]}),
        "next": whole("value of `after` in the next request"),
        "problems": listed("reasons for the failure, one line each", {"type": "string"}),
        "result": {
            "description": "the result when the job is done; null before, and for an animation, which has a file",
            "anyOf": [*(ref(name) for name in _RESULTS), {"type": "null"}],
        },
    },
)

JOBS = {
    "Begun": table("A new job.", {"id": text("identity of the job in requests")}),
    "Job": _JOB,
    "PlaneBegun": _PLANE_BEGUN,
    "PlaneCells": _CELLS,
    "MapResult": _MAP,
    "ContactMapResult": _CONTACT_MAP,
    "BasinResult": _BASIN,
}
"""Components of the OpenAPI document."""
