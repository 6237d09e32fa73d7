"""Mean transport velocity of a column on a vibrating base with its interval, and mean rate of rotation."""

import json
import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Annotated, Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.config.options import MOTION_WITHOUT_RECORDS, SLIDING
from stylobate.config.study import Study
from stylobate.errors import (
    FileError,
    Interrupted,
    Named,
    Outcome,
    ParameterError,
    UnsupportedError,
    require_positive,
    require_whole,
)
from stylobate.models import Model
from stylobate.progress import Progress
from stylobate.quantities import Quantity
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED, contact_classes, flag_attributes, knife_edge_remarks, lands_flat
from stylobate.results.tables import DEGREES, Practical, ResultTable, number_of_runs, practical
from stylobate.run_arguments import RunOptions
from stylobate.studies.proportions import require_confidence
from stylobate.studies.study import RunsOfOwnLength, options_of, study

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.studies.sweeps import Executor, Sweep
    from stylobate.studies.sweeps.running import Label

Floats = npt.NDArray[np.float64]

_MOST_NAMES = 2

TOLERANCE, MOST_PERIODS, CONFIDENCE = 0.02, 2000.0, 0.9
"""Defaults: relative half-width of the interval of a mean velocity, maximum duration in periods, confidence level."""

# Number of batches of periods, each of equal length, and the least for an interval.
_BATCHES, _LEAST_BATCHES = 10, 4
# Speed below which the half-width is compared with this speed instead [peak velocities of the base].
_SLOW = 0.01
# Relative half-width of a motion that repeats.
_EXACT = 1e-4
# Fraction of the acceleration of free sliding down a slope from which a column accelerates.
_ACCELERATES = 0.5
_SAMPLES = 64


class Transport(Named, IntEnum):
    """What is known of the mean velocity of a run."""

    KNOWN = 0
    """The half-width of its interval is within the tolerance."""
    UNSETTLED = 1
    """The half-width is larger; `speed_low` and `speed_high` are its interval."""
    STANDS = 2
    """The column came to permanent rest; its velocity is 0."""
    ACCELERATES = 3
    """The column slides ever faster down a slope beyond the friction angle: no mean velocity exists."""
    ENDED = 4
    """The motion ended early, for example by overturning: no mean velocity exists."""


# Maximum rows of a table; longer tables show only the fastest runs.
_ROWS, _FASTEST = 40, 12


def _table(result: "xr.Dataset") -> ResultTable:
    rows = _rows(result)
    names = [str(dim) for dim in result["outcome"].dims]
    title = number_of_runs(result, f" over {' and '.join(names)}")
    if len(rows) > _ROWS:
        rows = sorted(rows, key=lambda row: -_or_zero(row["transport_speed"]))[:_FASTEST]
        title += f"; the {_FASTEST} fastest are shown, --json shows all"
    axes = {name: practical([row[name] for row in rows], str(result[name].attrs.get("units", "1"))) for name in names}
    pace = practical([row["transport_speed"] for row in rows], "m s-1")
    twist = Practical(DEGREES.factor, "°/s")
    header = (
        *(f"{name.replace('_', ' ')} {one.bracketed}".rstrip() for name, one in axes.items()),
        f"velocity x, y {pace.bracketed}",
        f"speed {pace.bracketed}",
        f"twist rate {twist.bracketed}",
        "throw number",
        "contact class",
    )
    cells = [_cells(row, axes, pace, twist) for row in rows]
    return ResultTable("; ".join([title, *knife_edge_remarks(result)]), header, cells)


def _rows(result: "xr.Dataset") -> list[dict[str, Any]]:
    """Return the numbers of each run, in the order of its names."""
    names = [str(dim) for dim in result["outcome"].dims]
    runs = result.stack(run=names)
    meanings = str(result["contact_class"].attrs["flag_meanings"]).split()
    return [_row(runs.isel(run=place), names, meanings) for place in range(runs.sizes["run"])]


def _row(one: "xr.Dataset", names: list[str], meanings: list[str]) -> dict[str, Any]:
    x, y = one["mean_velocity"].to_numpy()
    numbers = ("transport_speed", "speed_low", "speed_high", "periods_computed", "mean_twist_rate", "throw_number")
    known = str(one["transport"].attrs["flag_meanings"]).split()
    return {
        **{name: float(one[name]) for name in names},
        "mean_velocity": [float(x), float(y)],
        **{name: float(one[name]) for name in numbers},
        "transport": known[int(one["transport"])],
        "contact_class": meanings[int(one["contact_class"]) + 1],
    }


def _speed(row: Mapping[str, Any], unit: Practical) -> str:
    """Write the speed, with the half-width of its interval where its digits show it, or why there is none."""
    if row["transport"] in ("ACCELERATES", "ENDED"):
        return str(row["transport"]).lower()
    half = row["speed_high"] - row["transport_speed"]
    wide = " (unsettled)" if row["transport"] == "UNSETTLED" else ""
    speed = f"{unit.factor * row['transport_speed']:.4g}"
    shown = half > _DIGITS * abs(row["transport_speed"])
    return f"{speed} ± {unit.factor * half:.2g}{wide}" if shown else f"{speed}{wide}"


# Half a step of the last of four digits, relative to the number.
_DIGITS = 5e-5


def _or_zero(speed: float) -> float:
    return speed if math.isfinite(speed) else 0.0


def _cells(row: Mapping[str, Any], axes: Mapping[str, Practical], pace: Practical, twist: Practical) -> list[str]:
    x, y = (pace.factor * one for one in row["mean_velocity"])
    moves = math.isfinite(row["transport_speed"])
    return [
        *(f"{unit.factor * row[name]:.6g}" for name, unit in axes.items()),
        f"{x:.4g}, {y:.4g}" if moves else "none",
        _speed(row, pace),
        f"{twist.factor * row['mean_twist_rate']:.4g}",
        f"{row['throw_number']:.4g}",
        row["contact_class"].lower().replace("_", " "),
    ]


def _completed(saved: "xr.Dataset", setup: Callable[[], Any], options: Mapping[str, Any]) -> "xr.Dataset":
    """Return a saved drift; add speeds and throw numbers to the runs of a store."""
    del options
    if "speed_high" in saved:
        return saved
    if saved.attrs["kind"] not in ("sweep", "drift") or "mean_twist_rate" not in saved:
        raise FileError(f"no drift (got a {saved.attrs['kind']}). Show it with stylobate map.")
    made = setup()
    arguments = {name: value for name, value in made.options.items() if name not in ("over", "late")}
    return drift_of_runs(saved, made.model, made.motion, **arguments)


def _repeated(_: Mapping[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """Return the values that repeat a drift, whose rules state the periods of its means."""
    late = dict(values.pop("rules", {})).get("periods")
    return values if late is None else {**values, "drift": {"late": int(late), **values["drift"]}}


_LATE = Quantity(text="number of last periods of the initial runs over which means are taken", ge=1)


@study(
    "drift",
    Study(
        name="drift",
        source="TOML description, or a saved drift (.nc) or store (.zarr) to show or repeat",
        help="""Compute the mean transport velocity of a column on a vibrating base.

    One or two numbers of column, model, base motion or initial state vary: friction-coefficient, acceleration,
    angular-frequency, stroke, angle … The model is sliding. Each run lasts 60 periods at first, and longer until the
    interval of its mean velocity is narrow enough. A part that accelerates beyond the friction angle has no mean
    velocity. The result also holds the mean rate of rotation about the axis. Examples:

    stylobate drift --radius 20mm --height 30mm --density 7800 --friction-coefficient 0.3 --motion stroke
    --frequency 50Hz --angle 30deg --x stroke 0.1mm 1.2mm 23 --tilt 0 0.1deg --figure drift.png

    stylobate drift drift.toml --y friction-coefficient 0.1 0.5 9 --output drift.zarr
    """,
        axes=("x", "y?"),
        without={
            "duration": "a drift lasts a number of periods. Set `periods` of its base motion instead.",
            "rules": "a drift has none. Set `late`, the number of last periods over which means are taken.",
        },
        usual={"model": {"kind": "sliding"}, "periods": 60.0},
        model=SLIDING,
        motion=MOTION_WITHOUT_RECORDS,
        records=False,
        completed=_completed,
        repeated=_repeated,
        table=_table,
        summary=lambda result: {"drifts": _rows(result)},
    ),
)
def drift(
    model: Model,
    motion: BaseMotion,
    *,
    over: Mapping[str, npt.ArrayLike],
    periods: float = 60.0,
    late: Annotated[int, _LATE] = 20,
    tolerance: Annotated[float | None, Quantity(text="relative half-width of the interval of a speed")] = TOLERANCE,
    most_periods: Annotated[float, Quantity(text="maximum duration of a run in periods")] = MOST_PERIODS,
    confidence: Annotated[float, Quantity(text="confidence level of the intervals")] = CONFIDENCE,
    **run: Unpack[RunsOfOwnLength],
) -> "tuple[Sweep, Label]":
    """Compute the mean transport velocity of a column on a vibrating base, and its mean rate of rotation.

    Both are means over a whole number of last periods of the base motion. A run whose mean velocity is not known to the
    tolerance is repeated with twice the duration, and its mean is then over the second half.

    Parameters
    ----------
    model
        A model that changes between kinds of contact, `Sliding`.
    motion
        A periodic base motion, such as `Harmonic.oblique`.
    over
        One or two names with their values, as for `overturning_map`.
    periods
        Initial duration of each run in periods of its base motion.
    late
        Number of last periods over which the means of a run of this duration are taken.
    tolerance
        Half-width of the interval of the speed, relative to the speed or, if larger, to a hundredth of the peak
        velocity of the base. None leaves each run at its initial duration.
    most_periods
        Maximum duration in periods of the base motion.
    confidence
        Confidence level of the intervals.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "drift": the runs over the names, with `mean_velocity` (axis) and `transport_speed` [m/s], `speed_low`
        and `speed_high`, the confidence interval of the speed [m/s], `transport` (a `Transport`), `periods_computed`,
        `mean_twist_rate` [rad/s], `contact_class`, `throw_number` and all variables of ensembles. Velocities are NaN if
        the motion ended early or the column accelerates, and 0 if the column came to permanent rest.

    Raises
    ------
    ParameterError
        If `over` does not have one or two names, `periods` does not exceed `late`, or an argument is out of range.
    UnsupportedError
        If the model does not change between kinds of contact, or the base motion has no period.

    Notes
    -----
    The interval is Student's for the means of ten batches of successive periods, along the mean velocity. A lag-one
    correlation ρ > 0 of these means widens it by the factor √((1 + ρ)/(1 − ρ)). It is about one motion: other initial
    conditions can reach another one, see `upright`. A store holds the runs of the initial duration.

    Examples
    --------
    >>> import stylobate as sb
    >>> block = sb.Column.solid(radius=1.5, height=2.0, density=1000.0)
    >>> sloping = sb.Sliding(block, friction_coefficient=0.2, incline=0.1)
    >>> shaking = sb.Harmonic.straight(acceleration=1.0, angular_frequency=3.0)
    >>> found = sb.conveying.drift(sloping, shaking, over={"acceleration": [1.0, 3.0]}, periods=30, late=10)
    >>> found["mean_velocity"].sel(axis="x").values.round(3).tolist()    # down the slope
    [0.0, 0.388]
    >>> [sb.conveying.Transport(code).name for code in found["transport"].values]
    ['KNOWN', 'KNOWN']
    """
    from stylobate.studies.checks import remark_on_knife_edge, require_values
    from stylobate.studies.sweeps import Sweep

    require_conveyor(model, motion, "drift", varied=over)
    if not isinstance(over, Mapping) or not 1 <= len(over) <= _MOST_NAMES:
        raise ParameterError(f'over must name one or two parameters, such as "friction_coefficient"; got {over!r}')
    late = require_whole("late", late, least=1)
    periods = require_positive("periods", periods)
    if not periods >= late + 1:
        raise ParameterError(f"periods must be at least one more than late, which is {late}; got {periods!r}")
    require_values("over", over)
    remark_on_knife_edge("over", model, over)
    settings: Any = {
        "tolerance": None if tolerance is None else require_positive("tolerance", tolerance),
        "most_periods": require_positive("most_periods", most_periods),
        "confidence": require_confidence(confidence),
    }
    options = options_of(run)
    how: Any = {"executor": run["executor"], "progress": run["progress"]}
    sweep = Sweep.grid(model, motion, over=over, periods=periods, **_with_window(options, late))

    def label(runs: "xr.Dataset") -> "xr.Dataset":
        return drift_of_runs(runs, model, motion, periods=periods, **settings, **how, **options)

    return sweep, label


def drift_of_runs(
    runs: "xr.Dataset",
    model: Model,
    motion: BaseMotion,
    *,
    periods: float,
    tolerance: float | None = TOLERANCE,
    most_periods: float = MOST_PERIODS,
    confidence: float = CONFIDENCE,
    executor: "Executor | None" = None,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> "xr.Dataset":
    """Convert `runs` of the initial duration to a drift, and repeat those whose mean velocity is not known.

    Parameters
    ----------
    runs
        Runs of this model and motion, with stroboscopic samples of the last periods, such as those of a store.
    model, motion, periods, tolerance, most_periods, confidence, executor, progress, **options
        As for `drift`.
    """
    case = _Case(
        model,
        motion,
        None if tolerance is None else require_positive("tolerance", tolerance),
        require_positive("most_periods", most_periods),
        require_confidence(confidence),
        options,
    )
    return case.refined(case.labelled(runs), float(periods), executor, progress)


def require_conveyor(model: Model, motion: BaseMotion, study: str, *, varied: Collection[str] = ()) -> None:
    """Raise UnsupportedError unless the contact of the model changes and the base motion has a period."""
    if not model.switches:
        raise UnsupportedError(
            f"model {model.name} assumes permanent contact without slip. A {study} needs Sliding(column)."
        )
    if not isinstance(motion, BaseMotion) or (motion.period is None and "angular_frequency" not in varied):
        raise UnsupportedError(f"motion: a {study} needs a periodic base motion (got {named(motion)}). {PERIODIC}")


PERIODIC = "Pass one such as Harmonic.stroke; on the command line --motion stroke."
"""Remedy without a periodic base motion."""


def named(motion: object) -> str:
    """Return a base motion in a message."""
    return "a base at rest" if motion in (None, BASE_AT_REST) else repr(motion)


def throw_number_of(model: Model, motion: BaseMotion) -> float:
    """Compute the throw number: the peak downward acceleration of the base over gravity along its normal."""
    low, _ = motion.vertical_range(0.0)
    return -low / (model.column.gravity * (1.0 + model.slope[2]))


def _with_window(options: RunOptions, late: int) -> RunOptions:
    """Return the options of runs whose means are over so many last periods."""
    return RunOptions(**{**options, "rules": OutcomeRules(periods=late), "strobes": late + 1})


@dataclass(frozen=True, slots=True)
class _Case:
    """The arguments of a drift."""

    model: Model
    motion: BaseMotion
    tolerance: float | None
    most_periods: float
    confidence: float
    options: RunOptions

    def labelled(self, runs: "xr.Dataset") -> "xr.Dataset":
        """Add speeds, intervals, classes and throw numbers to the runs."""
        import xarray as xr

        # A run at permanent rest ends before its last periods: its mean velocity is zero.
        stands = (runs["outcome"] == Outcome.AT_REST) & runs["mean_twist_rate"].isnull()
        velocity = runs["mean_velocity"].where(~stands, 0.0).assign_attrs(runs["mean_velocity"].attrs)
        turning = runs["mean_twist_rate"].where(~stands, 0.0).assign_attrs(runs["mean_twist_rate"].attrs)
        numbers = self._numbers(runs)
        half, transport = self._intervals(runs, velocity, numbers)
        transport = np.where(stands.to_numpy(), Transport.STANDS, transport).astype(np.int8)
        dims = runs["outcome"].dims
        velocity = velocity.where(xr.DataArray(transport != Transport.ACCELERATES, dims=dims))
        speed = (velocity**2).sum("axis", skipna=False) ** 0.5
        half = np.where(transport == Transport.STANDS, 0.0, half)
        level = f"{100.0 * self.confidence:g} % interval of the mean transport speed"
        meanings = flag_attributes("what is known of the mean velocity", [kind.name for kind in Transport])
        settings = {"tolerance": self.tolerance, "most_periods": self.most_periods, "confidence": self.confidence}
        provenance = {**json.loads(runs.attrs["provenance"]), "drift": settings}
        return (
            runs.drop_vars([name for name in runs.data_vars if "strobe" in runs[name].dims])
            .assign(
                mean_velocity=velocity.assign_attrs(runs["mean_velocity"].attrs),
                mean_twist_rate=turning,
                transport_speed=speed.assign_attrs(units="m s-1", long_name="mean transport speed"),
                speed_low=(speed - half).assign_attrs(units="m s-1", long_name=f"lower end of the {level}"),
                speed_high=(speed + half).assign_attrs(units="m s-1", long_name=f"upper end of the {level}"),
                transport=(dims, transport, meanings),
                periods_computed=(
                    dims,
                    runs["end_time"].to_numpy() / numbers["period"],
                    {"units": "1", "long_name": "periods of the base motion computed"},
                ),
                contact_class=contact_classes(runs),
                lands_flat=lands_flat(runs),
                throw_number=(dims, numbers["throw"], {"units": "1", "long_name": "throw number"}),
                computed=(
                    (),
                    int((runs["outcome"] != NOT_COMPUTED).sum()),
                    {"units": "1", "long_name": "runs computed"},
                ),
            )
            .assign_attrs(kind="drift", provenance=json.dumps(provenance))
        )

    def refined(
        self, found: "xr.Dataset", periods: float, executor: "Executor | None", progress: Progress
    ) -> "xr.Dataset":
        """Repeat runs whose mean velocity is not known with twice the duration, until it is known.

        A short run can seem known before it leaves a transient: unless it repeats, its mean must agree with that of the
        run of twice the duration.
        """
        from stylobate.studies.sweeps import Sweep, run_sweep

        names = [str(dim) for dim in found["outcome"].dims]
        if self.tolerance is None:
            return found
        speed, half = _interval(found)
        known = found["transport"].to_numpy() == Transport.KNOWN
        again = (found["transport"].to_numpy() == Transport.UNSETTLED) | (known & (half > _EXACT * speed))
        while again.any() and periods < self.most_periods:
            places = np.nonzero(again)
            periods = min(2.0 * periods, self.most_periods)
            late = max(int(periods / 2.0), 1)
            at = {name: found[name].to_numpy()[place] for name, place in zip(names, places, strict=True)}
            sweep = Sweep.points(self.model, self.motion, at=at, periods=periods, **_with_window(self.options, late))
            try:
                longer = self.labelled(run_sweep(sweep, executor=executor, progress=progress))
            except Interrupted as stop:
                raise Interrupted(str(stop), found) from None
            new_speed, new_half = _interval(longer)
            agree = np.abs(new_speed - speed[places]) <= new_half + half[places]
            code = longer["transport"].to_numpy()
            code = np.where((code == Transport.KNOWN) & ~agree, Transport.UNSETTLED, code).astype(np.int8)
            found = found.copy(deep=True)
            for name, variable in longer.assign(transport=("run", code)).data_vars.items():
                if variable.dims[:1] == ("run",):
                    found[name].to_numpy()[places] = variable.to_numpy()
            speed, half = _interval(found)
            again = found["transport"].to_numpy() == Transport.UNSETTLED
        return found

    def _numbers(self, runs: "xr.Dataset") -> dict[str, Floats]:
        """Return numbers of the case of each run.

        They are the throw number, the period [s], the peak velocity of the base [m/s], and the acceleration of free
        sliding down the slope [m/s²], which is not positive within the friction angle.
        """
        from stylobate.engine.parameters import with_parameters
        from stylobate.studies.sweeps.designs import OF_A_RUN

        names = [str(dim) for dim in runs["outcome"].dims]
        varied = [name for name in runs.coords if name not in OF_A_RUN and set(runs[name].dims) <= set(names)]
        shape = runs["outcome"].shape
        found = {name: np.empty(shape) for name in ("throw", "period", "velocity", "sliding")}
        values = {str(name): np.broadcast_to(_over(runs, str(name), names), shape) for name in varied if name != "run"}
        for place in np.ndindex(*shape):
            chosen = {name: float(value[place]) for name, value in values.items()}
            model, motion = with_parameters(self.model, self.motion, **chosen)
            own: Any = model
            period = motion.period or math.nan
            down = math.tan(own.incline) - own.friction_coefficient
            found["throw"][place] = throw_number_of(model, motion)
            found["period"][place] = period
            found["velocity"][place] = np.linalg.norm(motion.velocity(np.linspace(0.0, period, _SAMPLES)), axis=1).max()
            found["sliding"][place] = model.column.gravity * math.cos(own.incline) * down
        return found

    def _intervals(
        self, runs: "xr.Dataset", velocity: "xr.DataArray", numbers: Mapping[str, Floats]
    ) -> tuple[Floats, npt.NDArray[np.int8]]:
        """Return the half-width of the interval of each speed [m/s], and its `Transport`."""
        shape = runs["outcome"].shape
        mean = velocity.transpose(..., "axis").to_numpy()
        speed = np.hypot(mean[..., 0], mean[..., 1])
        half, codes = np.full(shape, np.nan), np.full(shape, Transport.ENDED, dtype=np.int8)
        moves = np.isfinite(speed)
        codes[moves] = Transport.UNSETTLED
        if "strobe_footprint" not in runs:
            return half, codes
        footprint = runs["strobe_footprint"].transpose(..., "strobe", "axis").to_numpy()
        for place in zip(*np.nonzero(moves), strict=True):
            along = mean[place] / speed[place] if speed[place] > 0.0 else np.array([1.0, 0.0])
            path = footprint[place] @ along
            means = np.diff(path[np.isfinite(path)]) / numbers["period"][place]
            half[place] = half_width(means, self.confidence)
            if _accelerates(means, numbers["period"][place], numbers["sliding"][place]):
                codes[place] = Transport.ACCELERATES
                continue
            wanted = (self.tolerance or TOLERANCE) * max(speed[place], _SLOW * numbers["velocity"][place])
            if half[place] <= wanted:
                codes[place] = Transport.KNOWN
        return half, codes


def half_width(values: Floats, confidence: float) -> float:
    """Return the half-width of the confidence interval of the mean of a stationary series; NaN if it is too short.

    Student's interval for the means of batches of successive values (batch means), widened for their correlation.
    """
    from scipy.special import stdtrit

    batches = min(_BATCHES, values.size)
    if batches < _LEAST_BATCHES:
        return math.nan
    size = values.size // batches
    means = values[values.size - batches * size :].reshape(batches, size).mean(axis=1)
    off = means - means.mean()
    spread = float(off @ off)
    if spread == 0.0:
        return 0.0
    correlation = min(max(float(off[1:] @ off[:-1]) / spread, 0.0), 0.9)
    error = math.sqrt(spread / (batches * (batches - 1)) * (1.0 + correlation) / (1.0 - correlation))
    return float(stdtrit(batches - 1, 0.5 * (1.0 + confidence))) * error


def _interval(found: "xr.Dataset") -> tuple[Floats, Floats]:
    """Return the speeds of a drift, and the half-widths of their intervals [m/s]."""
    speed = found["transport_speed"].to_numpy()
    return speed, found["speed_high"].to_numpy() - speed


def _accelerates(means: Floats, period: float, sliding: float) -> bool:
    """Return whether the mean velocities of successive periods grow as those of a body that slides down freely."""
    if sliding <= 0.0 or means.size < 2:  # noqa: PLR2004  two values for a slope
        return False
    slope = np.polyfit(np.arange(means.size) * period, means, 1)[0]
    return bool(slope > _ACCELERATES * sliding)


def _over(runs: "xr.Dataset", name: str, names: list[str]) -> Floats:
    """Return a coordinate of the runs, broadcast over their dimensions."""
    array: Floats = runs[name].broadcast_like(runs["outcome"]).transpose(*names).to_numpy()
    return array
