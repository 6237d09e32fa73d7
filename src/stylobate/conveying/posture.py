"""Whether a part on a vibrating base stays upright: shares over initial tilts and phases of the vibration."""

import json
import math
from collections.abc import Mapping, Sequence
from enum import IntEnum
from typing import TYPE_CHECKING, Annotated, Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.declared import numbers_of_motion, value_of
from stylobate.config.options import MOTION_WITHOUT_RECORDS, SLIDING
from stylobate.config.study import Study
from stylobate.conveying.transport import require_conveyor, throw_number_of
from stylobate.errors import MOST_RUNS, Named, Outcome, ParameterError, require_finite, require_positive, require_whole
from stylobate.models import Model
from stylobate.quantities import Quantity
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes, lands_flat, stays_in_a_plane
from stylobate.results.tables import DEGREES, ResultTable
from stylobate.results.verdict import CLEAR, VerdictWord, percent, word_of
from stylobate.studies.proportions import fraction_interval, require_confidence
from stylobate.studies.study import RunsOfOwnLength, options_of, study

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.studies.sweeps import Sweep
    from stylobate.studies.sweeps.running import Label

Floats = npt.NDArray[np.float64]

KIND = "upright"
"""Value of the attribute `kind` of the result."""

TILTS = (0.0, 1e-5, 1e-3, 1e-2)
"""Default initial tilts [rad]."""

PHASES, PERIODS = 64, 100.0
"""Default number of phases, and default duration in periods of the base motion."""

# Mean tilt over the last periods above which a part rocks [units of c].
_ROCKS = 1e-3
# Relative differences of durations and sums of shares below this are rounding.
_ROUNDING = 1e-9
# Tilt at the end beyond which a part falls [tipping angles].
_FALLS_BEYOND = 2.0
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


class Posture(Named, IntEnum):
    """What a part does at the end of a run."""

    UPRIGHT = 0
    """It rests, slides or hops; its mean tilt over the last periods is below a thousandth of c."""
    ROCKING = 1
    """It rocks or rolls on its rim, hopping or not, if only by a hundredth of a degree. It may still fall later."""
    FALLEN = 2
    """It overturned, or tilts by more than twice its tipping angle at the end."""


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    ends = ("share", "share_low", "share_high")
    shares = {
        str(name): {end: float(result[end].sel(posture_name=name)) for end in ends}
        for name in result["posture_name"].to_numpy()
    }
    rows = [
        {"friction_coefficient": mu, "tilt": tilt, **shares_of_tilt} for mu, tilt, shares_of_tilt in _by_tilt(result)
    ]
    verdict = {name: result.attrs[name] for name in ("verdict", "throw_number", "confidence")}
    return {**verdict, "shares": shares, "counted": int(result["counted"]), "by_tilt": rows}


def _by_tilt(result: "xr.Dataset") -> list[tuple[float, float, dict[str, float]]]:
    """Return the shares of each friction coefficient and initial tilt."""
    names = [str(name) for name in result["posture_name"].to_numpy()]
    return [
        (float(mu), float(tilt), dict(zip(names, map(float, shares), strict=True)))
        for mu, by_tilt in zip(result["friction"].to_numpy(), result["share_of_tilt"].to_numpy(), strict=True)
        for tilt, shares in zip(result["tilt"].to_numpy(), by_tilt, strict=True)
    ]


def _table(result: "xr.Dataset") -> ResultTable:
    rows = [
        [f"{mu:.4g}", f"{DEGREES.factor * tilt:.4g}°", *(percent(share) for share in shares.values())]
        for mu, tilt, shares in _by_tilt(result)
    ]
    header = ("friction coefficient", "initial tilt", *map(str, result["posture_name"].to_numpy()))
    return ResultTable(str(result.attrs["verdict"]), header, rows)


def _repeated(_: Mapping[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """Return the values that repeat a posture, whose table has its tilts and the number of its periods."""
    settings = dict(values[KIND])
    kept = {name: value for name, value in values.items() if name not in ("tilt", "duration")}
    return {**kept, "periods": settings.pop("periods"), KIND: settings}


_FRICTION = Quantity(text="friction coefficient; repeat it for several, each as probable")


@study(
    "upright",
    Study(
        name=KIND,
        source="TOML description, or a saved result (.nc) to show or repeat",
        help="""Decide whether a part on a vibrating base stays upright, rocks or falls.

    The runs differ in initial tilt, in the direction of this tilt and in the phase of the vibration. The shares leave
    out parts that start exactly flat and hop: they always land flat. Examples:

    stylobate upright --radius 6mm --height 40mm --density 7850 --friction-coefficient 0.2 --motion stroke
    --stroke 1mm --frequency 50Hz --angle 25deg --figure upright.png

    stylobate upright upright.toml --tilts 0.05deg --tilts 0.5deg --friction 0.2 --friction 0.3 --output upright.nc
    """,
        without={
            "duration": "runs last a number of periods. Set `periods` of the base motion instead.",
            "tilt": "runs start at the tilts of the table `upright`. Set `tilts` there instead.",
        },
        usual={"model": {"kind": "sliding"}, "periods": PERIODS},
        model=SLIDING,
        motion=MOTION_WITHOUT_RECORDS,
        records=False,
        kinds=(KIND,),
        repeated=_repeated,
        table=_table,
        summary=_summary,
    ),
)
def upright(
    model: Model,
    motion: BaseMotion,
    *,
    tilts: Annotated[Sequence[float], Quantity(unit="rad", text="initial tilt angle; repeat it for several")] = TILTS,
    phases: Annotated[int, Quantity(text="number of phases at which the vibration starts")] = PHASES,
    friction: Annotated[float | Sequence[float] | None, _FRICTION] = None,
    azimuth: Annotated[
        float | None, Quantity(unit="rad", text="azimuth of the initial tilt; spread by default")
    ] = None,
    periods: float = PERIODS,
    confidence: Annotated[float, Quantity(text="confidence level of intervals")] = 0.9,
    **run: Unpack[RunsOfOwnLength],
) -> "tuple[Sweep, Label]":
    """Decide whether a part on a vibrating base stays upright, rocks or falls, over initial tilts and phases.

    One run is one initial tilt and one phase of the vibration. Above the throw number 1 a part that starts at a tilt of
    exactly 0 lands flat forever, for every friction coefficient; a tilt of a hundredth of a millimetre can make the
    same part rock or fall. So runs that start exactly flat and hop are marked, and the shares leave them out.

    Parameters
    ----------
    model
        A model that changes between kinds of contact, `Sliding`.
    motion
        A periodic base motion, such as `Harmonic.stroke`.
    tilts
        Initial tilt angles [rad].
    phases
        Number of phases at which the vibration starts, evenly spaced.
    friction
        Friction coefficient, or several, each as probable; that of the model by default.
    azimuth
        Azimuth of the initial tilt [rad]; by default the azimuths are spread over all directions, one for each phase.
        A tilt exactly in the plane of vibration keeps the part in this plane, which no real part does.
    periods
        Duration of each run in periods of the base motion, at least one more than those of the mean tilt, `periods` of
        the `rules` (10). Shorter runs are undecided.
    confidence
        Confidence level of the intervals.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "upright".

        * Over `run`: coordinates `friction_coefficient`, `initial_tilt` [rad], `phase` and `azimuth` [rad]; `posture`,
          a `Posture` (−1 if undecided), `lands_flat`, and all variables of ensembles.
        * Over `posture_name`: `share`, `share_low` and `share_high`, the shares upright, rocking and fallen of the
          runs that count, with their intervals (Wilson's; undecided runs count on both sides).
        * Over `friction`, `tilt` and `posture_name`: `share_of_tilt`, of all runs of this friction and initial tilt.
        * `counted`, the number of runs that count: all except those that start exactly flat and hop.
        * Attributes: `verdict`, the result in one line; `throw_number`; `provenance`.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the model does not change between kinds of contact, or the base motion has no period.
    Interrupted
        On Ctrl-C.

    Notes
    -----
    The verdict is "does not fall" if the interval of the share that falls lies below 5 %, "falls" if it lies above
    95 %, else "may fall", or "undecided" if no run falls and too few are decided. It is "stays upright" if the interval
    of the share upright lies above 95 %. The shares depend on the tilts: choose those of your process. The intervals
    treat phases and azimuths as drawn at random.

    Examples
    --------
    >>> import stylobate as sb
    >>> pin = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
    >>> part = sb.Sliding(pin, friction_coefficient=0.2, damping=0.05, normal_restitution=0.1)
    >>> trough = sb.Harmonic.stroke(stroke=0.0003, frequency=50.0, angle=0.436)
    >>> found = sb.conveying.upright(part, trough, tilts=[0.0, 1e-5], phases=32, periods=30)
    >>> print(found.attrs["verdict"].partition(", ")[0])
    stays upright: 100 % of 64 runs stay upright (90 % interval 96 to 100 %)
    """
    from stylobate.studies.checks import remark_on_knife_edge, require_no_limits
    from stylobate.studies.sweeps import Sweep
    from stylobate.studies.sweeps.designs import checked_values

    require_conveyor(model, motion, "posture")
    require_no_limits(options_of(run))
    if np.any(run["tilt"]):
        raise ParameterError(
            f"tilt: tilts sets the initial tilts (got {run['tilt']!r}). Pass tilts, and azimuth if needed."
        )
    confidence = require_confidence(confidence)
    lengths = _tilts(tilts)
    count = require_whole("phases", phases, least=1, most=MOST_RUNS)
    periods = require_positive("periods", periods)
    azimuth = None if azimuth is None else require_finite("azimuth", azimuth, "rad")
    frictions = None if friction is None else checked_values("friction", "friction_coefficient", friction, scalar=True)
    if frictions is not None and not frictions.size:
        raise ParameterError(
            f"friction: must be at least one number (got {friction!r}). Leave it out for that of the model."
        )
    remark_on_knife_edge("friction", model, {} if frictions is None else {"friction_coefficient": frictions})
    turns = np.arange(count, dtype=float)
    angles = 2.0 * math.pi * turns / count
    ways = 2.0 * math.pi * (turns * _GOLDEN % 1.0) if azimuth is None else np.full(count, azimuth)
    grid = np.meshgrid(np.zeros(1) if frictions is None else frictions, lengths, turns, indexing="ij")
    mu, tilt = (np.asarray(array, dtype=float).ravel() for array in grid[:2])
    turn = grid[2].ravel().astype(np.intp)
    at = {
        "tilt_x": tilt * np.cos(ways[turn]),
        "tilt_y": tilt * np.sin(ways[turn]),
        **_delayed(motion, angles[turn]),
        **({} if frictions is None else {"friction_coefficient": mu}),
    }
    sweep = Sweep.points(model, motion, at=at, periods=periods, **options_of(run))
    own: Any = model
    given = {
        "friction_coefficient": np.full(mu.size, own.friction_coefficient) if frictions is None else mu,
        "initial_tilt": tilt,
        "phase": angles[turn],
        "azimuth": ways[turn],
    }
    settings = {
        "tilts": lengths.tolist(),
        "phases": count,
        "friction": None if frictions is None else frictions.tolist(),
        "azimuth": azimuth,
        "periods": periods,
        "confidence": confidence,
    }
    # The last periods of the mean tilt follow at least one period.
    least = (run["rules"] or OutcomeRules()).periods + 1

    def label(runs: "xr.Dataset") -> "xr.Dataset":
        posture = _postures(runs, model.column.slenderness, periods * _period_of(motion))
        return _labelled(runs, posture, throw_number_of(model, motion), given, settings, least)

    return sweep, label


def _tilts(given: npt.ArrayLike) -> Floats:
    from stylobate.studies.sweeps.designs import checked_values

    values = np.unique(checked_values("tilts", "tilt_x", given, scalar=True))
    if not values.size or values[0] < 0.0:
        raise ParameterError(
            f"tilts: must be one or more angles from 0 to below π/2 rad (got {given!r}). Give their magnitudes."
        )
    return values


def _delayed(motion: BaseMotion, phase: Floats) -> dict[str, Floats]:
    """Return the quantity that makes a periodic motion start at each phase [rad] of its period."""
    if "start_phase" in numbers_of_motion(motion):
        return {"start_phase": value_of(motion, "start_phase") + phase}
    return {"delay": -phase / (2.0 * math.pi) * _period_of(motion)}


def _period_of(motion: BaseMotion) -> float:
    assert motion.period is not None
    return motion.period


def _labelled(
    runs: "xr.Dataset",
    posture: npt.NDArray[np.int8],
    throw: float,
    given: dict[str, Floats],
    settings: dict[str, Any],
    least: int,
) -> "xr.Dataset":
    """Add postures, shares and the verdict to the runs, whose coordinates are `given`.

    Runs of fewer periods than `least` have no mean tilt.
    """
    flat = lands_flat(runs).to_numpy()
    counts = ~(flat & (given["initial_tilt"] == 0.0))
    about = {"units": "1"}
    ends = np.array([_share(posture[counts], kind, settings["confidence"]) for kind in Posture])
    level = f"{100.0 * settings['confidence']:g} % interval"
    frictions = np.unique(given["friction_coefficient"])
    tilts = np.array(settings["tilts"])
    by_tilt = [
        [_shares(posture[(given["friction_coefficient"] == mu) & (given["initial_tilt"] == tilt)]) for tilt in tilts]
        for mu in frictions
    ]
    units = {"friction_coefficient": "1", "initial_tilt": "rad", "phase": "rad", "azimuth": "rad"}
    provenance = {**json.loads(runs.attrs["provenance"]), KIND: settings}
    names = [kind.name.lower() for kind in Posture]
    meanings = ["UNDECIDED", *(kind.name for kind in Posture)]
    found = runs.assign(
        posture=("run", posture, flag_attributes("posture at the end", meanings, first=NOT_COMPUTED)),
        lands_flat=("run", flat, {"long_name": "hops and lands at a tilt of exactly 0"}),
        share=("posture_name", ends[:, 0], {**about, "long_name": "share of the runs that count"}),
        share_low=("posture_name", ends[:, 1], {**about, "long_name": f"lower end of the {level}"}),
        share_high=("posture_name", ends[:, 2], {**about, "long_name": f"upper end of the {level}"}),
        share_of_tilt=(("friction", "tilt", "posture_name"), by_tilt, {**about, "long_name": "share of the runs"}),
        counted=((), int(counts.sum()), {**about, "long_name": "runs that do not start exactly flat and hop"}),
        computed=((), int((runs["outcome"] != NOT_COMPUTED).sum()), {**about, "long_name": "runs computed"}),
    ).assign_coords(
        {
            **{name: ("run", values, {"units": units[name]}) for name, values in given.items()},
            "friction": ("friction", frictions, {"units": "1", "long_name": "friction coefficient"}),
            "tilt": ("tilt", tilts, {"units": "rad", "long_name": "initial tilt"}),
            "posture_name": names,
        }
    )
    return found.assign_attrs(
        kind=KIND,
        throw_number=throw,
        confidence=settings["confidence"],
        verdict=_line(ends, counts, settings, throw) + _remarks(runs, posture, counts, settings["periods"], least),
        provenance=json.dumps(provenance),
    )


def _postures(runs: "xr.Dataset", slenderness: float, duration: float) -> npt.NDArray[np.int8]:
    """Return the `Posture` of each run; −1 for runs that failed, are too short for a mean tilt, or are not computed."""
    outcome, mean = runs["outcome"].to_numpy(), runs["mean_tilt"].to_numpy()
    # A run that ends early at rest has no mean tilt, and rests for good.
    rests = (outcome == Outcome.AT_REST) & (runs["end_time"].to_numpy() < (1.0 - _ROUNDING) * duration)
    stands = rests | (runs["peak_tilt"].to_numpy() == 0.0)
    falls = np.hypot(*runs["end_tilt"].transpose("axis", ...).to_numpy()) > _FALLS_BEYOND * math.atan(slenderness)
    chosen = np.where(mean > _ROCKS * slenderness, Posture.ROCKING, Posture.UPRIGHT)
    chosen = np.where(falls | (outcome == Outcome.OVERTURNED), Posture.FALLEN, chosen)
    unknown = (np.isnan(mean) & ~stands & (chosen != Posture.FALLEN)) | np.isin(outcome, (Outcome.FAILED, NOT_COMPUTED))
    return np.where(unknown, NOT_COMPUTED, chosen).astype(np.int8)


def _shares(posture: npt.NDArray[np.int8]) -> list[float]:
    return [float(np.mean(posture == kind)) if posture.size else math.nan for kind in Posture]


def _share(posture: npt.NDArray[np.int8], kind: Posture, confidence: float) -> tuple[float, float, float]:
    """Return the share of a posture with its interval; NaN, 0 and 1 without runs."""
    count, undecided = int((posture == kind).sum()), int((posture == NOT_COMPUTED).sum())
    low, high = fraction_interval(count, undecided, posture.size, confidence=confidence)
    return count / posture.size if posture.size else math.nan, float(low), float(high)


def _line(ends: Floats, counts: npt.NDArray[np.bool_], settings: dict[str, Any], throw: float) -> str:
    """Return the verdict in one line."""
    over = f"tilts {_between(settings['tilts'])} rad, {settings['phases']} phases, {settings['periods']:g} periods"
    flat = int((~counts).sum())
    left_out = (
        f"; {flat} runs that start exactly flat are not counted: at throw number {throw:.3g} they always land flat"
        if flat
        else ""
    )
    if not counts.any():
        return f"not decided: all runs start exactly flat; {over}{left_out}"
    shares = dict(zip(Posture, ends, strict=True))
    if shares[Posture.UPRIGHT][1] >= 1.0 - CLEAR:
        word, first, verbs = "stays upright", Posture.UPRIGHT, {Posture.ROCKING: "rock", Posture.FALLEN: "fall"}
    else:
        share, low, high = shares[Posture.FALLEN].tolist()
        word = _FALLS[word_of(low, high)] if share > 0.0 or high <= CLEAR else "undecided"
        first, verbs = Posture.FALLEN, {Posture.ROCKING: "rock", Posture.UPRIGHT: "stay upright"}
    share, low, high = shares[first]
    interval = f"{percent(settings['confidence'])} interval {percent(low).removesuffix(' %')} to {percent(high)}"
    does = "stay upright" if first is Posture.UPRIGHT else "fall"
    others = ", ".join(f"{percent(shares[kind][0])} {verb}" for kind, verb in verbs.items())
    unknown = 1.0 - float(ends[:, 0].sum())
    others += f", {percent(unknown)} are undecided" if unknown > _ROUNDING else ""
    return f"{word}: {percent(share)} of {int(counts.sum())} runs {does} ({interval}), {others}; {over}{left_out}"


def _remarks(
    runs: "xr.Dataset", posture: npt.NDArray[np.int8], counts: npt.NDArray[np.bool_], periods: float, least: int
) -> str:
    """Return remarks on runs that are too short, and on motion exactly in one plane."""
    undecided = counts & (posture == NOT_COMPUTED)
    short = undecided.any() and periods < least
    remedy = (
        f"; increase periods to {least} or more: a posture follows from the last {least - 1} of them" if short else ""
    )
    planar = stays_in_a_plane(runs).to_numpy()[counts]
    aside = "; all of them move exactly in one vertical plane, which no real part does: vary the azimuth"
    return remedy + (aside if planar.size and planar.all() else "")


_FALLS = {VerdictWord.STANDS: "does not fall", VerdictWord.OVERTURNS: "falls", VerdictWord.UNDECIDED: "may fall"}


def _between(values: Sequence[float]) -> str:
    """Write the range of increasing values, such as "0 to 0.01"."""
    return " to ".join(dict.fromkeys(f"{value:.4g}" for value in (values[0], values[-1])))
