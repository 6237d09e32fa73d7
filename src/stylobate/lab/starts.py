"""Initial conditions on steady rolling, which the page updates while the user changes the frequency."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from stylobate import orbits, studies
from stylobate.base_motions import Harmonic
from stylobate.config.response import SteadyCase
from stylobate.config.simulation import built_parts
from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError
from stylobate.lab.json_values import numbers
from stylobate.models import Model
from stylobate.run_arguments import Start, numbers_of
from stylobate.theory.averaging import circular_components

_NO_CIRCLE = 1e-12
"""A base motion is circular if its counter-rotating circle is smaller than this fraction of the main circle."""

_NEAR = 0.5
"""Maximum difference between the mean tilt of an exact orbit on the branch and the averaged tilt, as a fraction."""

_ONLY_UPPER = "start: averaged branch, approximate; exact orbits are computed for the upper branch only"
_NONE_FOUND = "start: averaged branch, approximate; no exact orbit was found from it"
_UNSTABLE = "start: the exact orbit is unstable, and the motion leaves it"
_ASYMMETRIC = "start: the exact orbit has bifurcated from the branch and lacks its symmetry"


class StartConfig(SteadyCase):
    """The case of steady rolling: `column`, `model`, a horizontal harmonic `motion`, and the branch."""

    branch: Literal["upper", "lower"] = "upper"


def start(values: Mapping[str, Any]) -> dict[str, Any]:
    """Compute the initial conditions on steady rolling that `values` describe.

    Under a circular motion the closed form is exact. Under an elliptic or straight motion it is averaged, and not
    close enough to the motion: the upper branch then starts on the exact periodic orbit, if one is found.

    Returns
    -------
    dict
        "tilt" [rad], "tilt_rate" and "spin" [rad/s], the spin is 0 for a model without spin;
        "warnings", one line if the start is approximate, or its orbit unstable or bifurcated from the branch.

    Raises
    ------
    ConfigError, ParameterError, UnsupportedError
        If the case is invalid, or has no steady rolling on the branch in closed form.
    """
    given = StartConfig.parse(values)
    model, motion = built_parts(given.column, given.model, given.motion, [])
    if not isinstance(motion, Harmonic):
        message = f"motion.kind must be a horizontal harmonic motion for a start on a branch, got {given.motion.kind!r}"
        raise ParameterError(message)
    known: Mapping[str, Any] = studies.steady_start(model, motion, branch=given.branch)
    if _is_circular(motion):
        return _plain(known)
    if given.branch != "upper":
        return _plain(known, _ONLY_UPPER)
    orbit = _orbit_near(model, motion, known)
    if orbit is None:
        return _plain(known, _NONE_FOUND)
    return _plain({name: getattr(orbit, name) for name in numbers_of(Start)}, *_remark(orbit))


def _is_circular(motion: Harmonic) -> bool:
    (first, second, _), phase = motion.amplitude, motion.phase
    sizes = [abs(complex(circle)) for circle in circular_components(first, second, phase[1] - phase[0])]
    return min(sizes) <= _NO_CIRCLE * max(sizes)


def _orbit_near(model: Model, motion: Harmonic, known: Mapping[str, Any]) -> orbits.PeriodicOrbit | None:
    """Compute the exact orbit of an averaged start; return None if none is found.

    Newton's method from the averaged start itself converges to other orbits; continuation from the circular motion
    stays on the branch.
    """
    try:
        orbit = orbits.periodic_orbit(model, motion)
    except (NoOrbitError, UnsupportedError):
        return None
    averaged = _size(known["tilt"])
    near = abs(orbit.mean_tilt - averaged) <= _NEAR * averaged
    return orbit if near and abs(orbit.turns) == 1.0 else None


def _size(tilt: tuple[float, float]) -> float:
    return float((tilt[0] ** 2 + tilt[1] ** 2) ** 0.5)


def _remark(orbit: orbits.PeriodicOrbit) -> tuple[str, ...]:
    if not orbit.stable:
        return (_UNSTABLE,)
    return () if orbit.inversion else (_ASYMMETRIC,)


def _plain(found: Mapping[str, Any], *warnings: str) -> dict[str, Any]:
    given = {name: np.asarray(found.get(name, 0.0)) for name in numbers_of(Start)}
    named = {name: numbers(one) if one.ndim else float(one) for name, one in given.items()}
    return {**named, "warnings": list(warnings)}
