"""Frequency response of steady rolling, from theory, in SI units."""

import json
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate import theory
from stylobate.base_motions import BaseMotion, as_harmonic
from stylobate.errors import ParameterError, UnsupportedError, as_numbers
from stylobate.models import Model
from stylobate.models.model import RollingLaw
from stylobate.orbits.finding import rolling_form_of
from stylobate.provenance import provenance_of_run
from stylobate.theory.averaging import circular_components


def response_curves(
    model: Model, motion: BaseMotion, *, angular_frequency: npt.ArrayLike | Sequence[float]
) -> xr.Dataset:
    """Compute amplitude and phase of steady rolling over the frequency of a harmonic base motion.

    For circular motion the solution (8) is exact. For elliptic and straight motion it is the averaged solution (10)
    with the two circular components of the ellipse, one for each sense of rolling.

    Parameters
    ----------
    model
        The slender model.
    motion
        A horizontal harmonic motion; its acceleration amplitudes are kept, its frequency is replaced.
    angular_frequency
        Frequencies, shape (n,) [rad/s].

    Returns
    -------
    xarray.Dataset
        `amplitude` [rad], `phase` [rad], `stable` over (sense, branch, angular_frequency); `backbone` (5) and the
        critical frequency of each sense [rad/s]. NaN where there is no solution.

    Raises
    ------
    ParameterError
        If a frequency is not positive, or the motion is not horizontal.
    UnsupportedError
        If the model has no closed form.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.0)
    >>> curves = sb.studies.response_curves(model, motion, angular_frequency=[1.0, 2.0])
    >>> curves["stable"].sel(sense="anticlockwise", branch="upper").values
    array([False,  True])
    """
    eta, column = _damping(model), model.column
    frequency = _frequencies(angular_frequency)
    a1, a2, phase = _amplitudes(motion, column.gravity)
    c, scale = column.slenderness, column.frequency_scale
    steady = theory.averaged_rolling(frequency / scale, a1, a2, phase, c=c, eta=eta)
    p, q = (abs(part) for part in circular_components(a1, a2, phase))
    largest = max(p, q)
    senses = [
        (name, branches, size)
        for name, branches, size in (("anticlockwise", steady.forward, p), ("clockwise", steady.backward, q))
        if size > _NO_PART * largest
    ]
    if not senses:
        message = f"motion: its acceleration is negligible beside gravity (got {motion!r}). Increase it."
        raise ParameterError(message)
    dims = ("sense", "branch", "angular_frequency")
    stacked = {
        field: np.stack([[getattr(s.upper, field), getattr(s.lower, field)] for _, s, _ in senses])
        for field in ("amplitude", "phase", "stable")
    }
    critical = [scale * float(theory.critical_frequency(size, c=c, eta=eta)) for _, _, size in senses]
    return xr.Dataset(
        {
            "amplitude": (dims, stacked["amplitude"], {"units": "rad", "long_name": "tilt angle"}),
            "phase": (
                dims,
                stacked["phase"],
                {"units": "rad", "long_name": "phase of the lean to the base acceleration"},
            ),
            "stable": (dims, stacked["stable"], {"long_name": "stable"}),
            "backbone": (dims[-1:], theory.rolling_backbone(frequency / scale, c), {"units": "rad"}),
            "critical_frequency": ("sense", critical, {"units": "rad s-1", "long_name": "critical frequency"}),
        },
        coords={
            "sense": [name for name, _, _ in senses],
            "branch": ["upper", "lower"],
            "angular_frequency": ("angular_frequency", frequency, {"units": "rad s-1"}),
        },
        attrs={
            "kind": "response curves",
            "averaged": int(len(senses) > 1),
            "provenance": json.dumps(provenance_of_run(model, motion)),
        },
    )


# A circular component smaller than this fraction of the other is rounding: the base motion is circular.
_NO_PART = 1e-12


def _damping(model: Model) -> float:
    """Return η of a model with the equations of the slender model, or raise an error."""
    form = rolling_form_of(model)
    if form is None or form.law is not RollingLaw.SLENDER:
        message = f"response_curves needs the slender model, which has a closed form; got {model.name}"
        if form is not None:
            message += f". Use theory.{form.law.value} for its steady rolling, or orbits.continue_branch for its orbits"
        raise UnsupportedError(message)
    return form.eta


def _frequencies(angular_frequency: npt.ArrayLike) -> npt.NDArray[np.float64]:
    angular_frequency = as_numbers("angular_frequency", angular_frequency, "rad/s")
    frequency = np.atleast_1d(np.asarray(angular_frequency, dtype=float))
    if frequency.ndim != 1 or not np.all(np.isfinite(frequency) & (frequency > 0.0)):
        message = f"angular_frequency must be a list of positive numbers [rad/s], got {angular_frequency!r}"
        raise ParameterError(message)
    return frequency


def _amplitudes(motion: BaseMotion, gravity: float) -> tuple[float, float, float]:
    harmonic = as_harmonic(motion)
    if harmonic is None:
        message = f"motion must be a Harmonic motion, got {motion!r}"
        raise ParameterError(message)
    a1, a2, a3 = harmonic.amplitude
    if a3 != 0.0:
        message = f"motion must be horizontal for the closed form, got a vertical amplitude of {a3!r} m/s²"
        raise ParameterError(message)
    if a1 == a2 == 0.0:
        message = "motion must have a horizontal amplitude above zero, got 0 m/s²"
        raise ParameterError(message)
    return a1 / gravity, a2 / gravity, harmonic.phase[1] - harmonic.phase[0]
