"""Starts on known motions: the steady rolling of the closed form."""

import math
from typing import TypedDict

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.models import Slender
from stylobate.motions import Harmonic
from stylobate.studies.rolling_frame import RollingFrame


class Start(TypedDict):
    """The start of a run, as keyword arguments of `simulate`."""

    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]


def steady_start(model: Slender, motion: Harmonic, *, branch: str = "upper", sense: int | None = None) -> Start:
    """Return the start at t = 0 on the steady rolling (8) of a harmonic motion without ramp.

    Exact for circular motion, averaged for elliptic and straight motion.

    Parameters
    ----------
    model
        The slender model.
    motion
        A horizontal harmonic motion.
    branch
        "upper" or "lower".
    sense
        +1 anticlockwise or −1 clockwise; by default that of the larger circular part of the motion.

    Raises
    ------
    ParameterError
        If there is no such solution.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> start = sb.studies.steady_start(model, motion)
    >>> sb.simulate(model, motion, **start, duration=50.0).outcome
    <Outcome.ROLLING: 'rolling'>
    """
    frame = RollingFrame.of(model, motion, sense)
    steady = theory.steady_rolling(frame.theta, frame.drive, c=model.column.slenderness, eta=model.damping)
    chosen = {"upper": steady.upper, "lower": steady.lower}.get(branch)
    if chosen is None:
        message = f'branch must be "upper" or "lower", got {branch!r}'
        raise ParameterError(message)
    tilt, psi = float(chosen.amplitude), float(chosen.phase)
    if not math.isfinite(tilt):
        message = f"motion has no steady rolling on the {branch} branch at {motion.angular_frequency!r} rad/s"
        raise ParameterError(message)
    vector, rate = frame.to_tilt(tilt, psi, 0.0, frame.theta)
    return {"tilt": vector, "tilt_rate": rate}
