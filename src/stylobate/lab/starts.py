"""Starts on steady rolling, which a page follows while its reader changes the frequency."""

from collections.abc import Mapping
from typing import Any, Literal

from stylobate import studies
from stylobate.errors import ParameterError
from stylobate.lab.plain import numbers
from stylobate.motions import Harmonic
from stylobate.spec.columns import ColumnDescription
from stylobate.spec.description import Description
from stylobate.spec.models import ModelDescription, SlenderModel
from stylobate.spec.motions import MotionDescription
from stylobate.spec.simulation import built_parts


class StartDescription(Description):
    """The case whose steady rolling is wanted: `column`, `model`, a horizontal harmonic `motion`, and which branch."""

    column: ColumnDescription
    model: ModelDescription = SlenderModel()
    motion: MotionDescription
    branch: Literal["upper", "lower"] = "upper"


def start(values: Mapping[str, Any]) -> dict[str, Any]:
    """Compute the start on steady rolling that `values` describe, by theory.

    Returns
    -------
    dict
        "tilt" [rad], "tilt_rate" and "spin" [rad/s]; the spin is 0 for a model that cannot turn about its axis.

    Raises
    ------
    DescriptionError, ParameterError, UnsupportedError
        If the case cannot be, or has no steady rolling on the branch in closed form.
    """
    given = StartDescription.parse(values)
    model, motion = built_parts(given.column, given.model, given.motion, [])
    if not isinstance(motion, Harmonic):
        message = f"motion.kind must be a horizontal harmonic motion for a start on a branch, got {given.motion.kind!r}"
        raise ParameterError(message)
    found: Mapping[str, Any] = studies.steady_start(model, motion, branch=given.branch)
    return {**{name: numbers(found[name]) for name in ("tilt", "tilt_rate")}, "spin": float(found.get("spin", 0.0))}
