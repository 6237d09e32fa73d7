"""Starts on known motions: the steady rolling of the closed forms."""

import math
from typing import TypedDict

from stylobate.base_motions import Harmonic
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.models import Model, Rolling, Slender, SlenderRolling, Wobbling
from stylobate.orbits.steady import steady_rolling_of
from stylobate.studies.responses.rolling_frame import RollingFrame

_BRANCHES = ("upper", "lower")


class Start(TypedDict):
    """The start of a run, as keyword arguments of `simulate`."""

    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]


class TurningStart(Start):
    """The start of a run of a column that may turn about its axis."""

    spin: float


def steady_start(model: Model, motion: Harmonic, *, branch: str = "upper", sense: int | None = None) -> Start:
    """Return the start at t = 0 on the steady rolling of a harmonic motion without ramp.

    Exact for circular motion, averaged for elliptic and straight motion: (8) of the slender model, and of the others
    `free_twist_rolling`, `wobbling_rolling` and `full_rolling`.

    Parameters
    ----------
    model
        Slender, slender rolling, wobbling or rolling, without rolling resistance; couples of the contact.
    motion
        A horizontal harmonic motion.
    branch
        "upper" or "lower"; at finite tilt "upper" is the stable branch or, if none is, that of a phase near 0. Of
        slender rolling only the upper one is known.
    sense
        +1 anticlockwise or −1 clockwise; by default that of the larger circular part of the motion.

    Returns
    -------
    Start
        `tilt` [rad], `tilt_rate` [rad/s]; of a model that may turn a `TurningStart`, with `spin` [rad/s] too.

    Raises
    ------
    ParameterError
        If there is no such solution.
    UnsupportedError
        If there is no closed form for the model.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> start = sb.studies.steady_start(model, motion)
    >>> sb.simulate(model, motion, **start, duration=50.0).outcome
    <Outcome.ROLLING: 'rolling'>
    """
    if branch not in _BRANCHES:
        message = f'branch must be "upper" or "lower", got {branch!r}'
        raise ParameterError(message)
    _require_closed_form(model, branch)
    frame = RollingFrame.of(model, motion, sense)
    tilt, psi, spin = steady_rolling_of(model, frame.theta, frame.drive, branch)
    if not math.isfinite(tilt):
        message = f"motion has no steady rolling on the {branch} branch at {motion.angular_frequency!r} rad/s"
        raise ParameterError(message)
    vector, rate = frame.to_tilt(tilt, psi, 0.0, frame.theta)
    if model.spin_state is None:
        return {"tilt": vector, "tilt_rate": rate}
    return TurningStart(tilt=vector, tilt_rate=rate, spin=frame.sense * spin / frame.time_scale)


def _require_closed_form(model: Model, branch: str) -> None:
    """Raise an error of one line unless theory knows steady rolling of the model, with its frictions."""
    if type(model) not in (Slender, SlenderRolling, Wobbling, Rolling):  # a subclass has other equations
        message = (
            "steady_start needs a closed form of steady rolling, as of slender, slender rolling, wobbling and rolling; "
            f"got model {getattr(model, 'name', model)!s}"
        )
        raise UnsupportedError(message)
    if isinstance(model, Wobbling | Rolling) and model.rolling_resistance > 0.0:
        message = f"rolling_resistance must be 0 for a closed form of steady rolling, got {model.rolling_resistance!r}"
        raise UnsupportedError(message)
    if isinstance(model, SlenderRolling):
        if model.couples != "contact":
            message = f"couples must be 'contact' for a closed form of steady rolling, got {model.couples!r}"
            raise UnsupportedError(message)
        if branch != "upper":
            message = f'branch must be "upper" for slender rolling, whose closed form has no other; got {branch!r}'
            raise ParameterError(message)
    if isinstance(model, SlenderRolling | Rolling) and model.damping > 0.0 and model.spin_damping == 0.0:
        message = (
            "spin_damping must be above zero where there is damping, got 0.0: without it the base spins the column up "
            "for ever, and there is no steady rolling"
        )
        raise ParameterError(message)
