"""Validity of averaging: predicted stability and amplitude compared with exact orbits."""

import json
from collections.abc import Sequence
from functools import cache

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine import with_parameters
from stylobate.errors import Interrupted, NoOrbitError
from stylobate.models import Model
from stylobate.orbits import Branch, continue_branch
from stylobate.orbits.orbit import require_subject
from stylobate.orbits.shooting import is_stable
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.studies.checks import require_parameters, require_rising_frequencies
from stylobate.studies.responses.exact_response import between_bifurcations, first_orbit
from stylobate.studies.responses.response_curves import response_curves
from stylobate.text import plural

Floats = npt.NDArray[np.float64]

_UNSTABLE, _STABLE, _NONE = 0, 1, -1
_ROUNDED = 1e-12


@shows_progress("averaging map")
def averaging_map(
    model: Model,
    motion: BaseMotion,
    *,
    parameter: str = "acceleration",
    values: Sequence[float],
    angular_frequency: Sequence[float],
    sense: int | None = None,
    progress: Progress = None,
) -> xr.Dataset:
    """Compare averaged rolling with the exact orbit, over a parameter and the frequency.

    Parameters
    ----------
    model, motion
        The slender column and a harmonic base motion.
    parameter, values
        Name and values of a parameter, such as acceleration, or amplitude_y as an ellipse opens.
    angular_frequency
        Frequencies [rad/s], increasing.
    sense
        Sense of rolling, +1 or −1; by default that of the larger circular component of the base motion.
    progress
        A function that is called with the number of values done and of all values; a bar by default, False for none.

    Returns
    -------
    xarray.Dataset
        Over the parameter and `angular_frequency`: `exact` and `averaged` (1 stable, 0 unstable, −1 no such rolling),
        `error`, the mean tilt of the exact orbit over the averaged one less 1, and `swing`, its peak tilt over the
        averaged one. Without damping stable means neutrally stable.

    Raises
    ------
    ParameterError
        If values are missing or have an impossible sign, or the frequencies are not positive and increasing.
    Interrupted
        On Ctrl-C; `partial` has the values of the parameter that were done.
    """
    require_subject(model, motion)
    frequencies, chosen = require_rising_frequencies(angular_frequency), require_parameters(values, parameter)
    shape = (chosen.size, frequencies.size)
    exact, averaged = (np.full(shape, _NONE, dtype=np.int8) for _ in range(2))
    error, swing = np.full(shape, np.nan), np.full(shape, np.nan)
    done, stopped = 0, False
    try:
        for row, value in enumerate(chosen):
            changed = with_parameters(model, motion, **{parameter: float(value)})
            theory = response_curves(*changed, angular_frequency=frequencies)
            wanted = "clockwise" if sense == -1 else "anticlockwise"
            name = wanted if wanted in theory["sense"] else str(theory["sense"][0].item())
            upper = theory.sel(sense=name, branch="upper")
            amplitude = upper["amplitude"].to_numpy()
            averaged[row] = np.where(np.isfinite(amplitude), upper["stable"].to_numpy(), _NONE)
            branch = _followed(*changed, frequencies, sense)
            if branch is not None:
                at = np.array([point.value for point in branch.path])
                of_theory = response_curves(*changed, angular_frequency=at)["amplitude"].sel(sense=name, branch="upper")
                exact[row], error[row], swing[row] = _at(branch, of_theory.to_numpy(), frequencies)
            done = row + 1
            report_of(progress)(done, chosen.size)
    except KeyboardInterrupt:
        if not done:
            raise
        stopped = True
    dims = (parameter, "angular_frequency")
    states = {"long_name": "1 stable, 0 unstable, -1 no such rolling"}
    found = xr.Dataset(
        {
            "exact": (dims, exact[:done], states),
            "averaged": (dims, averaged[:done], states),
            "error": (dims, error[:done], {"units": "1", "long_name": "exact mean tilt over averaged tilt, less 1"}),
            "swing": (dims, swing[:done], {"units": "1", "long_name": "peak exact tilt over averaged tilt"}),
        },
        coords={
            parameter: (parameter, chosen[:done], attributes_of(parameter)),
            "angular_frequency": ("angular_frequency", frequencies, {"units": "rad s-1"}),
        },
        attrs={
            "kind": "averaging map",
            "parameter": parameter,
            "friction": int(model.comes_to_rest),
            "provenance": json.dumps(provenance_of_run(model, motion)),
        },
    )
    if stopped:
        raise Interrupted(f"stopped after {done} of {plural(chosen.size, 'value')}, which `partial` has", found)
    return found


def _followed(model: Model, motion: BaseMotion, frequencies: Floats, sense: int | None) -> Branch | None:
    bounds = (float(frequencies[0]), float(frequencies[-1]))
    try:
        orbit = first_orbit(model, motion, bounds, sense)
    except NoOrbitError:
        return None
    return between_bifurcations(continue_branch(orbit, "angular_frequency", bounds=bounds))


def _at(branch: Branch, amplitude: Floats, frequencies: Floats) -> tuple[npt.NDArray[np.int8], Floats, Floats]:
    """Return stability, and error and swing relative to the averaged `amplitude`, at these frequencies.

    Stability changes only at bifurcations, which are points of the branch; ratios to the averaged amplitude, which
    change slowly, are interpolated between points. If a branch is folded, its first orbit counts.
    """
    at, stable = (np.array(of) for of in zip(*((p.value, is_stable(p.multipliers)) for p in branch.path), strict=True))

    @cache  # the mean tilt takes an integration, and few points may have a frequency beside them
    def ratios(index: int) -> Floats:
        orbit = branch.orbit(index)
        return np.asarray([orbit.mean_tilt, orbit.peak_tilt]) / float(amplitude[index])

    found = np.full((2, frequencies.size), np.nan)
    codes = np.full(frequencies.size, _NONE, dtype=np.int8)
    for index in range(at.size - 1):
        low, high = sorted(at[index : index + 2])
        inside = (frequencies >= low * (1.0 - _ROUNDED)) & (frequencies <= high * (1.0 + _ROUNDED)) & (codes == _NONE)
        if not inside.any() or low == high:
            continue
        share = (frequencies[inside] - at[index]) / (at[index + 1] - at[index])
        found[:, inside] = ratios(index)[:, np.newaxis] + np.outer(ratios(index + 1) - ratios(index), share)
        codes[inside] = _STABLE if stable[index] or stable[index + 1] else _UNSTABLE
    return codes, found[0] - 1.0, found[1]
