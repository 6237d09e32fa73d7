"""Starts on known motions: the steady rolling of the closed form."""

import math
from typing import TypedDict

import numpy as np

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.models import Slender
from stylobate.motions import Harmonic


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
    gravity, scale = model.column.gravity, model.column.frequency_scale
    (a1, a2, _), (phi1, phi2, _) = motion.amplitude, motion.phase
    theta = motion.angular_frequency / scale
    parts = theory.averaged_rolling(
        theta, a1 / gravity, a2 / gravity, phi2 - phi1, c=model.column.slenderness, eta=model.damping
    )
    p, q = theory.circular_components(a1, a2, phi2 - phi1)
    turning = (1 if abs(p) >= abs(q) else -1) if sense is None else sense
    steady = parts.forward if turning == 1 else parts.backward
    chosen = {"upper": steady.upper, "lower": steady.lower}.get(branch)
    if chosen is None:
        message = f'branch must be "upper" or "lower", got {branch!r}'
        raise ParameterError(message)
    tilt, phase = float(chosen.amplitude), float(chosen.phase)
    if not math.isfinite(tilt):
        message = (
            f"motion has no steady rolling on the {branch} branch at angular_frequency {motion.angular_frequency!r}"
        )
        raise ParameterError(message)
    # The closed form measures its azimuth from axis 1 at the phase of that axis.
    azimuth = turning * (motion.start_phase + phi1 + phase) + float(np.asarray(steady.azimuth_offset))
    x, y = math.cos(azimuth), math.sin(azimuth)
    rate = turning * motion.angular_frequency * tilt
    return {"tilt": (tilt * x, tilt * y), "tilt_rate": (-rate * y, rate * x)}
