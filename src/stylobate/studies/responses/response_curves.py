"""Response curves of steady rolling from theory, averaged motion, and initial conditions on a branch, in SI units.

`stylobate response` shows the curves.
"""

import json
import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.declared import kinds_by_acceleration
from stylobate.base_motions.harmonic import as_harmonic
from stylobate.config.options import COLUMN, HORIZONTAL_MOTION, MODEL_OF_STEADY_ROLLING, OUTPUT, run_numbers
from stylobate.config.study import Analysis, Instead
from stylobate.errors import ConfigError, ParameterError, UnsupportedError, as_numbers, require_positive, require_vector
from stylobate.models import Model, Slender
from stylobate.models.declared import name_by_symbol
from stylobate.models.model import ClosedForm, RollingLaw, closed_form_of
from stylobate.provenance import provenance_of_run
from stylobate.quantities import Quantity, states
from stylobate.results.tables import ResultTable
from stylobate.run_arguments import Argument, numbers_of
from stylobate.studies.study import analysis

if TYPE_CHECKING:
    import xarray as xr


class Frequencies(TypedDict, total=False):
    """The frequencies of response curves in a description."""

    angular_frequency_range: Annotated[
        tuple[float, float],
        Quantity(unit="rad/s", text="lowest and highest angular frequency", components=2),
        Argument(),
    ]
    points: Annotated[int, Quantity(text="number of frequencies", ge=2), Argument(400)]


FREQUENCIES = run_numbers(Frequencies, panel="Options")
STEADY_CASE = (COLUMN, MODEL_OF_STEADY_ROLLING, HORIZONTAL_MOTION, OUTPUT)


def _with_frequency(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the values of a description; a missing frequency of the motion follows from the range."""
    from stylobate.config.parts import made_by

    motion = values.get("motion")
    kind = motion.get("kind") if isinstance(motion, Mapping) else None
    if isinstance(motion, Mapping) and kind in kinds_by_acceleration():
        # A mistake in the range is reported once: the motion is built with a valid frequency.
        stated = values.get("angular_frequency_range")
        ends = stated if isinstance(stated, (list, tuple)) else ()
        possible = (float(one) for one in ends if isinstance(one, (int, float)) and 0.0 < one < math.inf)
        values = {**values, "motion": {"angular_frequency": next(possible, 1.0), **motion}}
    make = made_by(kind)
    if make is not None and not states(make, "responds"):
        raise ConfigError([f"motion.kind must be a horizontal harmonic motion for response curves, got {kind!r}"])
    return values


def _problems(config: Any) -> list[str]:
    from stylobate.config.description import built

    problems: list[str] = []
    low, high = config.angular_frequency_range
    if not 0.0 < low < high:
        problems.append(f"angular_frequency_range must rise from above zero, got {low!r} to {high!r} rad/s")
    for end in (low, high) if not problems else ():
        built("angular_frequency_range", partial(require_positive, "an end", end, "rad/s"), problems)
    built("points", partial(numbers_of(Frequencies)["points"].checked, config.points), problems)
    return problems


def _frequencies_of(config: Any, _: object) -> dict[str, Any]:
    low, high = map(float, config.angular_frequency_range)
    return {"angular_frequency": np.linspace(low, high, config.points)}


def _tables(curves: "xr.Dataset") -> list[ResultTable]:
    shown = np.unique(np.linspace(0, curves.sizes["angular_frequency"] - 1, _ROWS).round().astype(int))
    senses = curves["sense"].to_numpy()
    columns = [(sense, branch) for sense in senses for branch in curves["branch"].to_numpy()]
    header = ["Ω [rad/s]", *(f"{sense}, {branch}: A [rad], ψ [rad]" for sense, branch in columns)]
    rows = []
    for index in shown:
        at = curves.isel(angular_frequency=int(index))
        cells = [_cell(at.sel(sense=sense, branch=branch)) for sense, branch in columns]
        rows.append([f"{float(at['angular_frequency']):.4f}", *cells])
    known = zip(senses, curves["critical_frequency"].to_numpy(), strict=True)
    critical = ", ".join(f"{float(value):.6f} rad/s ({sense})" for sense, value in known)
    exact = "averaged: the full motion may overturn where this is stable" if curves.attrs["averaged"] else "exact"
    return [ResultTable(f"stable where marked * ({exact}); critical frequency {critical}", header, rows)]


_ROWS = 17


def _cell(at: "xr.Dataset") -> str:
    if not np.isfinite(at["amplitude"]):
        return "none"
    return f"{float(at['amplitude']):.5f}, {float(at['phase']):+.4f}{' *' if bool(at['stable']) else ''}"


RESPONSE = Analysis(
    name="response",
    source="TOML description",
    help="""Compute amplitude and phase of steady rolling against frequency.

    Theory is exact for circular motion and averaged for straight and elliptic motion. With --exact, periodic orbits
    and their bifurcations are computed instead. Examples:

    stylobate response --slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.065
    --angular-frequency-range 0.2 4 --figure response.png

    stylobate response --exact --slenderness 0.1 --damping 0.1 --motion straight --acceleration 0.13
    --angular-frequency-range 0.8 8 --figure exact.png
    """,
    groups=(FREQUENCIES, *STEADY_CASE),
    numbers=Frequencies,
    steady=True,
    read=_with_frequency,
    problems=_problems,
    arguments=_frequencies_of,
    instead=Instead(
        key="exact",
        text="exact periodic orbits and bifurcations, no theory",
        place="stylobate.studies:exact_response",
        kind="exact response",
    ),
    tables=_tables,
)


@analysis(RESPONSE)
def response_curves(
    model: Model, motion: BaseMotion, *, angular_frequency: npt.ArrayLike | Sequence[float]
) -> "xr.Dataset":
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
    import xarray as xr

    from stylobate import theory

    eta, column = _damping(model), model.column
    frequency = _frequencies(angular_frequency)
    a1, a2, phase = _amplitudes(motion, column.gravity)
    c, scale = column.slenderness, column.frequency_scale
    steady = theory.averaged_rolling(frequency / scale, a1, a2, phase, c=c, eta=eta)
    p, q = (abs(part) for part in theory.averaging.circular_components(a1, a2, phase))
    largest = max(p, q)
    senses = [
        (name, branches, size)
        for name, branches, size in (("anticlockwise", steady.forward, p), ("clockwise", steady.backward, q))
        if size > _NO_PART * largest
    ]
    if not senses:
        raise ParameterError(f"motion: its acceleration is negligible beside gravity (got {motion!r}). Increase it.")
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
    from stylobate.orbits.finding import rolling_form_of

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
        raise ParameterError(f"angular_frequency must be a list of positive numbers [rad/s], got {angular_frequency!r}")
    return frequency


def _amplitudes(motion: BaseMotion, gravity: float) -> tuple[float, float, float]:
    harmonic = as_harmonic(motion)
    if harmonic is None:
        raise ParameterError(f"motion must be a Harmonic motion, got {motion!r}")
    a1, a2, a3 = harmonic.amplitude
    if a3 != 0.0:
        raise ParameterError(f"motion must be horizontal for the closed form, got a vertical amplitude of {a3!r} m/s²")
    if a1 == a2 == 0.0:
        raise ParameterError("motion must have a horizontal amplitude above zero, got 0 m/s²")
    return a1 / gravity, a2 / gravity, harmonic.phase[1] - harmonic.phase[0]


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
) -> "xr.Dataset":
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
    >>> slow = averaged_motion(model, motion, **start, duration=20.0)
    >>> round(float(slow["amplitude"].max() - slow["amplitude"].min()), 9)
    0.0
    """
    import xarray as xr
    from scipy.integrate import solve_ivp

    from stylobate.studies.known_rolling import RollingFrame
    from stylobate.theory.averaging import rotating_frame_rates

    form = closed_form_of(model)
    if form is None or form.law is not RollingLaw.SLENDER:
        raise UnsupportedError(
            f"model: averaged_motion holds for Slender only (got {type(model).__name__}). Pass Slender(column)."
        )
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


_BRANCHES = ("upper", "lower")


class SteadyStart(TypedDict):
    """Initial condition of a run, as keyword arguments of `simulate`."""

    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]


class TurningStart(SteadyStart):
    """Initial condition of a column with axial rotation (spin)."""

    spin: float


def steady_start(model: Model, motion: Harmonic, *, branch: str = "upper", sense: int | None = None) -> SteadyStart:
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
    SteadyStart
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
    from stylobate.orbits.finding import steady_rolling_of
    from stylobate.studies.known_rolling import RollingFrame

    if branch not in _BRANCHES:
        raise ParameterError(f'branch must be "upper" or "lower", got {branch!r}')
    form = _closed_form(model, branch)
    frame = RollingFrame.of(model, motion, sense)
    tilt, psi, spin = steady_rolling_of(form, model.column, frame.nu, frame.drive, branch)
    if not math.isfinite(tilt):
        raise ParameterError(
            f"motion has no steady rolling on the {branch} branch at {motion.angular_frequency!r} rad/s"
        )
    vector, rate = frame.to_tilt(tilt, psi, 0.0, frame.nu)
    if model.spin_state is None:
        return {"tilt": vector, "tilt_rate": rate}
    return TurningStart(tilt=vector, tilt_rate=rate, spin=frame.sense * spin / frame.time_scale)


def _closed_form(model: Model, branch: str) -> ClosedForm:
    """Return the closed form of steady rolling of a model; raise an error if it does not apply."""
    from stylobate.orbits.finding import rolling_form_of

    form = rolling_form_of(model)
    if form is None:
        raise UnsupportedError(
            "steady_start needs a closed form of steady rolling, as of slender, slender rolling, wobbling and rolling; "
            f"got model {getattr(model, 'name', model)!s}, whose class {type(model).__name__} states none"
        )
    if form.requires is not None:
        name, value = form.requires
        raise UnsupportedError(
            f"{name} must be {value!r} for a closed form of steady rolling, got {getattr(model, name)!r}"
        )
    if form.law is RollingLaw.FREE_TWIST and branch != "upper":
        raise ParameterError(
            f'branch must be "upper" for slender rolling, whose closed form has no other; got {branch!r}'
        )
    if form.law in (RollingLaw.FREE_TWIST, RollingLaw.FULL) and form.eta > 0.0 and form.zeta == 0.0:
        raise ParameterError(
            f"{name_by_symbol(type(model), 'ζ')} must be above zero if there is damping, got 0.0: without it the "
            "spin grows without bound, and there is no steady rolling"
        )
    return form
