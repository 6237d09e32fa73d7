"""The averaged slow flow (10), integrated, to compare with the full motion."""

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from stylobate.base_motions import Harmonic
from stylobate.errors import UnsupportedError, require_positive, require_vector
from stylobate.models import Slender
from stylobate.models.model import RollingLaw, closed_form_of
from stylobate.studies.responses.rolling_frame import RollingFrame
from stylobate.theory.averaging import rotating_frame_rates


def averaged_motion(
    model: Slender,
    motion: Harmonic,
    *,
    tilt: tuple[float, float],
    tilt_rate: tuple[float, float] = (0.0, 0.0),
    duration: float,
    sense: int | None = None,
    samples: int = 1001,
    rtol: float = 1e-9,
) -> xr.Dataset:
    """Integrate the averaged equations (10) from an initial condition of the full motion.

    Parameters
    ----------
    model
        The slender model.
    motion
        A horizontal harmonic motion without ramp. For circular motion the flow is exact.
    tilt, tilt_rate
        Initial condition, as for `simulate` [rad], [rad/s]; the tilt must not be zero.
    duration
        Duration [s].
    sense
        Sense of rolling about which to average, +1 or −1; by default that of the larger circular component.
    samples
        Number of samples.
    rtol
        Relative tolerance of the integration.

    Returns
    -------
    xarray.Dataset
        `amplitude`, `azimuth` and `phase` [rad] over `time` [s]. It ends early if the averaged tilt passes through
        zero or exceeds a hundred times c.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the model is not `Slender`, or is a subclass with equations of its own.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=3.0)
    >>> start = sb.studies.steady_start(model, motion)
    >>> slow = sb.studies.averaged_motion(model, motion, **start, duration=20.0)
    >>> round(float(slow["amplitude"].max() - slow["amplitude"].min()), 9)
    0.0
    """
    form = closed_form_of(model)
    if form is None or form.law is not RollingLaw.SLENDER:
        message = f"model: averaged_motion holds for Slender only (got {type(model).__name__}). Pass Slender(column)."
        raise UnsupportedError(message)
    frame = RollingFrame.of(model, motion, sense)
    x, y = require_vector("tilt", tilt, 2, "rad")
    vx, vy = require_vector("tilt_rate", tilt_rate, 2, "rad/s")
    end = require_positive("duration", duration, "s") / frame.time_scale
    c, eta = model.column.slenderness, form.eta

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        return rotating_frame_rates(state, frame.nu, frame.drive, c=c, eta=eta)

    def leaves(_: float, state: np.ndarray) -> float:
        return float(min(state[2] - _SMALLEST * c, _LARGEST * c - state[2]))

    leaves.terminal = True  # type: ignore[attr-defined]
    start = frame.from_tilt((x, y), (vx, vy))
    tau = np.linspace(0.0, end, samples)
    flow = solve_ivp(
        rates, (0.0, end), start, method="DOP853", t_eval=tau, events=leaves, rtol=rtol, atol=1e-3 * rtol * c
    )
    _, _, amplitude, psi = flow.y
    return xr.Dataset(
        {
            "amplitude": ("time", amplitude, {"units": "rad", "long_name": "averaged tilt angle"}),
            "phase": ("time", psi, {"units": "rad", "long_name": "averaged phase"}),
            "azimuth": ("time", frame.sense * (frame.nu * flow.t + psi) + frame.offset, {"units": "rad"}),
        },
        coords={"time": ("time", flow.t * frame.time_scale, {"units": "s", "long_name": "time"})},
    )


# The averaged motion ends if the tilt is below or above these [units of c].
_SMALLEST, _LARGEST = 1e-6, 100.0
