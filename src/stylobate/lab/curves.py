"""Response curves and initial conditions on them, from theory and from exact orbits."""

from collections.abc import Mapping
from itertools import count
from typing import Any, Literal

import numpy as np
import xarray as xr

from stylobate import config, orbits, studies
from stylobate.base_motions import Harmonic
from stylobate.config.simulation import SteadyCase, built_parts
from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError
from stylobate.lab import answers
from stylobate.lab.messages import Emit, Note
from stylobate.models import Model
from stylobate.orbits.orbit import SUPERCRITICAL_OF
from stylobate.run_arguments import InitialConditions as RunStart
from stylobate.run_arguments import numbers_of
from stylobate.text import plural
from stylobate.theory.averaging import circular_components

_ORBITS = 400
"""Maximum number of orbits of a family each way, enough for a plot; near the vertical, families have thousands."""


def response(values: Mapping[str, Any]) -> answers.ResponseCurves:
    """Compute the curves of theory that `values` describe, one for each sense and branch, within milliseconds."""
    setup = config.study_config(studies.response_curves).parse(values).build()
    with np.errstate(all="ignore"):
        return _curves(studies.response_curves(setup.model, setup.motion, **setup.options))


def _curves(curves: xr.Dataset) -> answers.ResponseCurves:
    senses, branches = curves["sense"].to_numpy(), curves["branch"].to_numpy()
    lines = {(sense, branch): curves.sel(sense=sense, branch=branch) for sense in senses for branch in branches}
    critical = zip(senses, answers.numbers(curves["critical_frequency"]), strict=True)
    return answers.ResponseCurves(
        angular_frequency=curves["angular_frequency"],
        branches=[
            answers.CurveBranch(
                sense=str(sense),
                branch=str(branch),
                amplitude=line["amplitude"],
                phase=line["phase"],
                stable=line["stable"].to_numpy().tolist(),
            )
            for (sense, branch), line in lines.items()
        ],
        backbone=curves["backbone"],
        critical=[answers.CriticalFrequency(sense=str(sense), angular_frequency=value) for sense, value in critical],
        averaged=bool(curves.attrs["averaged"]),
    )


def exact_curves(values: Mapping[str, Any], emit: Emit) -> answers.ExactOrbits:
    """Compute the exact orbits that `values` describe; progress states the number of orbits and the last frequency."""
    setup = config.study_config(studies.exact_response).parse(values).build()

    number = count(1)

    def reached(frequency: float) -> None:
        emit(Note(f"{plural(next(number), 'exact orbit')} found, the last at {frequency:.4g} rad/s"))

    found = studies.exact_response(
        setup.model,
        setup.motion,
        **setup.options,
        control=orbits.StepControl(most=_ORBITS),
        progress=reached,
    )
    owner = found["branch"].to_numpy()
    arrays = {name: found[name].to_numpy() for name in answers.OrbitFamily.model_fields if name != "name"}
    families = [
        answers.OrbitFamily(name=str(label), **{name: array[owner == index].tolist() for name, array in arrays.items()})
        for index, label in enumerate(found["branch_name"].to_numpy())
    ]
    names = ("kind", "angular_frequency", "mean_tilt", "supercritical")
    rows = zip(*(found[f"bifurcation_{name}"].to_numpy().tolist() for name in names), strict=True)
    bifurcations = [
        answers.Bifurcation(
            kind=kind, angular_frequency=frequency, mean_tilt=tilt, supercritical=SUPERCRITICAL_OF[known]
        )
        for kind, frequency, tilt, known in rows
    ]
    return answers.ExactOrbits(families=families, bifurcations=bifurcations)


# Initial conditions on steady rolling, which the page updates while the user changes the frequency

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


def start(values: Mapping[str, Any], emit: Emit) -> answers.Start:
    """Compute the initial conditions on steady rolling that `values` describe.

    Under a circular motion the closed form is exact. Under an elliptic or straight motion it is averaged, and not
    close enough to the motion: the upper branch then starts on the exact periodic orbit, if one is found.

    The spin is 0 for a model without spin. There is one warning if the start is approximate, or its orbit unstable or
    bifurcated from the branch.

    Raises
    ------
    ConfigError, ParameterError, UnsupportedError
        If the case is invalid, or has no steady rolling on the branch in closed form.
    """
    del emit
    given = StartConfig.parse(values)
    model, motion = built_parts(given.column, given.model, given.motion, [])
    if not isinstance(motion, Harmonic):
        raise ParameterError(
            f"motion.kind must be a horizontal harmonic motion for a start on a branch, got {given.motion.kind!r}"
        )
    known = studies.steady_start(model, motion, branch=given.branch)
    if _is_circular(motion):
        return _start(known)
    if given.branch != "upper":
        return _start(known, _ONLY_UPPER)
    orbit = _orbit_near(model, motion, known["tilt"])
    if orbit is None:
        return _start(known, _NONE_FOUND)
    remarks = () if orbit.stable and orbit.inversion else (_ASYMMETRIC if orbit.stable else _UNSTABLE,)
    return _start({name: getattr(orbit, name) for name in numbers_of(RunStart)}, *remarks)


def _is_circular(motion: Harmonic) -> bool:
    (first, second, _), phase = motion.amplitude, motion.phase
    sizes = [abs(complex(circle)) for circle in circular_components(first, second, phase[1] - phase[0])]
    return min(sizes) <= _NO_CIRCLE * max(sizes)


def _orbit_near(model: Model, motion: Harmonic, tilt: Any) -> orbits.PeriodicOrbit | None:
    """Compute the exact orbit of an averaged start with this `tilt`; return None if none is found.

    Newton's method from the averaged start itself converges to other orbits; continuation from the circular motion
    stays on the branch.
    """
    try:
        orbit = orbits.periodic_orbit(model, motion)
    except (NoOrbitError, UnsupportedError):
        return None
    averaged = float(np.hypot(*tilt))
    near = abs(orbit.mean_tilt - averaged) <= _NEAR * averaged
    return orbit if near and abs(orbit.turns) == 1.0 else None


def _start(found: Mapping[str, Any], *warnings: str) -> answers.Start:
    return answers.Start(**{name: found.get(name, 0.0) for name in numbers_of(RunStart)}, warnings=list(warnings))
