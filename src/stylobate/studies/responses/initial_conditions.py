"""Initial conditions on known motions: the steady rolling of the closed forms."""

import math
from typing import TypedDict

from stylobate.base_motions import Harmonic
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.models.declared import name_by_symbol
from stylobate.models.model import ClosedForm, RollingLaw
from stylobate.orbits.finding import rolling_form_of, steady_rolling_of
from stylobate.studies.responses.rolling_frame import RollingFrame

_BRANCHES = ("upper", "lower")


class Start(TypedDict):
    """Initial condition of a run, as keyword arguments of `simulate`."""

    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]


class TurningStart(Start):
    """Initial condition of a column with axial rotation (spin)."""

    spin: float


def steady_start(model: Model, motion: Harmonic, *, branch: str = "upper", sense: int | None = None) -> Start:
    """Compute the initial condition of steady rolling under a harmonic motion without ramp.

    It is exact for circular motion and averaged for elliptic and straight motion: (8) for the slender model, and
    `free_twist_rolling`, `wobbling_rolling` and `full_rolling` for the others.

    Parameters
    ----------
    model
        Slender, slender rolling, wobbling or rolling, without rolling resistance.
    motion
        A horizontal harmonic motion.
    branch
        "upper" or "lower". At finite tilt "upper" is the stable branch, or the one with a phase near 0 if none is
        stable. Slender rolling has the upper branch only.
    sense
        +1 anticlockwise or −1 clockwise; by default that of the larger circular component of the motion.

    Returns
    -------
    Start
        `tilt` [rad], `tilt_rate` [rad/s]. For a model with a spin a `TurningStart`, which also has `spin` [rad/s].

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
    form = _closed_form(model, branch)
    frame = RollingFrame.of(model, motion, sense)
    tilt, psi, spin = steady_rolling_of(form, model.column, frame.nu, frame.drive, branch)
    if not math.isfinite(tilt):
        message = f"motion has no steady rolling on the {branch} branch at {motion.angular_frequency!r} rad/s"
        raise ParameterError(message)
    vector, rate = frame.to_tilt(tilt, psi, 0.0, frame.nu)
    if model.spin_state is None:
        return {"tilt": vector, "tilt_rate": rate}
    return TurningStart(tilt=vector, tilt_rate=rate, spin=frame.sense * spin / frame.time_scale)


def _closed_form(model: Model, branch: str) -> ClosedForm:
    """Return the closed form of steady rolling of a model; raise an error if it does not apply."""
    form = rolling_form_of(model)
    if form is None:
        message = (
            "steady_start needs a closed form of steady rolling, as of slender, slender rolling, wobbling and rolling; "
            f"got model {getattr(model, 'name', model)!s}, whose class {type(model).__name__} states none"
        )
        raise UnsupportedError(message)
    if form.requires is not None:
        name, value = form.requires
        message = f"{name} must be {value!r} for a closed form of steady rolling, got {getattr(model, name)!r}"
        raise UnsupportedError(message)
    if form.law is RollingLaw.FREE_TWIST and branch != "upper":
        message = f'branch must be "upper" for slender rolling, whose closed form has no other; got {branch!r}'
        raise ParameterError(message)
    if form.law in (RollingLaw.FREE_TWIST, RollingLaw.FULL) and form.eta > 0.0 and form.zeta == 0.0:
        message = (
            f"{name_by_symbol(type(model), 'ζ')} must be above zero if there is damping, got 0.0: without it the "
            "spin grows without bound, and there is no steady rolling"
        )
        raise ParameterError(message)
    return form
