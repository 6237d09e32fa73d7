"""Provenance of a spectrum: the values that repeat it."""

import json
from dataclasses import asdict
from typing import Any

from stylobate.base_motions import BaseMotion
from stylobate.models import Model
from stylobate.provenance import provenance_of_run
from stylobate.results import OutcomeRules
from stylobate.run_arguments import RunOptions, defaults_of


def provenance_of_spectrum(
    model: Model, motion: BaseMotion, options: RunOptions, *, tail: float | None, duration: float | None, **own: float
) -> str:
    """Return model, motion, options and length of the runs, in JSON."""
    chosen: dict[str, Any] = {**defaults_of(RunOptions), **options}
    chosen["rules"] = asdict(chosen["rules"] or OutcomeRules())
    length = {"tail": tail if tail is None else float(tail)} if duration is None else {"duration": float(duration)}
    return json.dumps({**provenance_of_run(model, motion, **chosen), **length, **own})
