"""Search for attractors: periodic orbits in stroboscopic samples, their periods and kinds."""

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.errors import Outcome, ParameterError, require_positive, require_whole
from stylobate.models import Model
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import whole

Complexes = npt.NDArray[np.complex128]
Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class AttractorRules:
    """Tolerances by which attractors are identified from stroboscopic samples.

    The first two are fractions of the tilt c/(1 + ν²) and the tilt rate cν/(1 + ν²) of free rolling (5) at the
    frequency ratio ν of the forcing. This is the size of the motions at every frequency.

    Parameters
    ----------
    repeat_tolerance
        A run repeats every k periods if all its samples differ from the last k by less than this.
    match_tolerance
        Two runs are on the same orbit if their samples differ by less than this. Samples of one orbit must differ by
        more. It must be well above `repeat_tolerance`: a slowly converging run is farther from its orbit than it moves
        during the samples, and a run that spirals in must not count as an orbit of several periods.
    branch_tolerance
        Along a parameter, a periodic orbit continues one at an earlier value if their samples differ by less than
        this. Otherwise it begins a branch. Increase it if the values are far apart.

    Raises
    ------
    ParameterError
        If a tolerance is not positive.
    """

    repeat_tolerance: float = 1e-3
    match_tolerance: float = 3e-2
    branch_tolerance: float = 0.5

    def __post_init__(self) -> None:
        for name in self.__slots__:
            object.__setattr__(self, name, require_positive(f"attractor_rules.{name}", getattr(self, name)))


@dataclass(frozen=True, slots=True)
class OrbitScales:
    """Units for comparing stroboscopic samples: `tilt` [rad], `tilt_rate` [rad/s]; and the forcing's `period` [s]."""

    tilt: float
    tilt_rate: float
    period: float | None

    @classmethod
    def of(cls, model: Model, motion: BaseMotion | None) -> Self:
        """Return the tilt and rate of free rolling (5) at the frequency of `motion`; c and cω0 without a frequency."""
        c, scale = model.column.slenderness, 1.0 / model.time_scale
        period = None if motion is None else motion.period
        if period is None:
            return cls(c, c * scale, None)
        nu = 2.0 * np.pi / (period * scale)
        return cls(c / (1.0 + nu**2), c * nu * scale / (1.0 + nu**2), period)

    def states(self, tilt: Floats, tilt_rate: Floats) -> Complexes:
        """Return vectors (..., 2) of tilt and rate as dimensionless states (..., 2): tilt and rate, each x + iy."""
        return np.stack(
            [
                (tilt[..., 0] + 1j * tilt[..., 1]) / self.tilt,
                (tilt_rate[..., 0] + 1j * tilt_rate[..., 1]) / self.tilt_rate,
            ],
            axis=-1,
        )

    def vectors(self, states: Complexes) -> tuple[Floats, Floats]:
        """Return the vectors of tilt [rad] and rate [rad/s] of dimensionless `states`: the inverse of `states`."""
        parts = np.stack([states.real, states.imag], axis=-1)
        return parts[..., 0, :] * self.tilt, parts[..., 1, :] * self.tilt_rate


def repeating_periods(strobes: Complexes, rules: AttractorRules) -> tuple[Integers, Floats]:
    """Determine the number of periods after which stroboscopic samples repeat.

    Parameters
    ----------
    strobes
        Dimensionless states of n runs in m successive samples, shape (n, m, 2), the newest last.
    rules
        Maximum difference from the last samples, and minimum difference between samples of an orbit.

    Returns
    -------
    tuple
        The smallest such number up to m/2, shape (n,), 0 if there is none, and the remaining difference.
    """
    runs, window = strobes.shape[:2]
    periods, left = np.zeros(runs, dtype=np.int64), np.full(runs, np.inf)
    place = np.arange(window) - window
    for k in range(1, window // 2 + 1):
        open_runs = periods == 0
        # The last k states, repeated backwards through the window; NaN (no sample) never repeats.
        difference = np.abs(strobes[open_runs] - strobes[open_runs][:, window - k + place % k]).max(axis=(1, 2))
        repeats = difference < rules.repeat_tolerance
        for divisor in (d for d in range(1, k) if k % d == 0):
            cycle = strobes[open_runs][:, -k:]
            apart = np.abs(cycle - np.roll(cycle, divisor, axis=1)).max(axis=(1, 2))
            repeats &= apart > rules.match_tolerance
        found = np.flatnonzero(open_runs)[repeats]
        periods[found], left[found] = k, difference[repeats]
    return periods, left


def is_flat(cycle: Complexes, tolerance: float) -> bool:
    """Return whether an orbit is planar: no angular momentum about the vertical at any sample.

    Parameters
    ----------
    cycle
        Dimensionless states, shape (k, 2).
    tolerance
        Tolerance of the angular momentum, as a fraction of the peak tilt times the peak rate.
    """
    tilt, rate = cycle.T
    return bool(np.abs(np.imag(np.conj(tilt) * rate)).max() < tolerance * np.abs(tilt).max() * np.abs(rate).max())


def cycle_distance(cycles: Complexes, cycle: Complexes) -> Floats:
    """Return the distances of orbits of k states from another orbit, shape (n,), for any first state.

    Parameters
    ----------
    cycles
        Shape (n, k, 2).
    cycle
        Shape (k, 2).
    """
    shifted = [np.abs(cycles - np.roll(cycle, shift, axis=0)).max(axis=(1, 2)) for shift in range(len(cycle))]
    return np.asarray(np.min(shifted, axis=0))


def group_cycles(cycles: Complexes, left: Floats, tolerance: float) -> tuple[Integers, Integers]:
    """Gather orbits of k states into groups.

    The leader of each group is the run that repeats best among the remaining runs, and the group holds all runs closer
    to the leader than `tolerance`: the order of the runs does not matter.

    Parameters
    ----------
    cycles
        Shape (n, k, 2).
    left
        Remaining difference of each run from repetition, shape (n,).

    Returns
    -------
    tuple
        The group of each run, shape (n,), and the leader of each group.
    """
    flat = cycles.reshape(len(cycles), -1)
    # If runs repeat equally well, the state decides, not the order.
    order = np.lexsort((*flat.real.T, *flat.imag.T, left))
    groups, leaders = np.full(len(cycles), -1, dtype=np.int64), list[int]()
    for candidate in order:
        if groups[candidate] < 0:
            open_runs = np.flatnonzero(groups < 0)
            close = cycle_distance(cycles[open_runs], cycles[candidate]) < tolerance
            groups[open_runs[close]] = len(leaders)
            leaders.append(int(candidate))
    return groups, np.array(leaders, dtype=np.int64)


USUAL_STROBES = 32
"""Default number of stroboscopic samples."""

# Samples that identify an orbit of two periods: it repeats after half as many. Period one needs two samples.
_FOR_TWO_PERIODS, _FOR_ONE = 4, 2
# Tolerance for rounding of the number of periods, in periods.
_ROUNDING = 1e-9


def with_strobes(sweep: Sweep, asked: int | None) -> Sweep:
    """Return `sweep` with the number of samples `asked` for, else 32, else half of the periods of its shortest run.

    The first half of a run shorter than 32 periods serves for settling. Without a periodic base motion there are no
    samples, and only rest and overturning are identified.

    Raises
    ------
    ParameterError
        If the shortest run has fewer periods than `asked`, or fewer than 8, whose second half identifies orbits of one
        and two periods; or if `asked` is below two, which identifies nothing.
    """
    chosen = USUAL_STROBES if asked is None else require_whole("strobes", asked, least=_FOR_ONE)
    held = _whole_periods(sweep)
    if held is not None:
        needed = 2 * _FOR_TWO_PERIODS if asked is None else chosen
        if held < needed:
            remedy = "follow them longer" if asked is None else "follow them longer or ask for fewer strobes"
            raise ParameterError(
                f"runs must last at least {needed} periods of the base motion to identify attractors, got {held} "
                f"(duration {_shortest(sweep):g} s); {remedy}"
            )
        chosen = chosen if held >= chosen else held // 2
    return replace(sweep, options={**sweep.options, "strobes": chosen})


def _whole_periods(sweep: Sweep) -> int | None:
    """Return the number of whole periods of the shortest run; None if the base motion has no period."""
    values = sweep.design.coordinates(whole(sweep.design))
    if not all(array.size for array in values.values()):
        return None
    if sweep.periods is not None:
        return math.floor(sweep.periods + _ROUNDING)
    if "angular_frequency" in values:
        longest: float | None = 2.0 * math.pi / float(np.min(values["angular_frequency"]))
    else:
        longest = sweep.motion.period
    return None if longest is None else math.floor(_shortest(sweep) / longest + _ROUNDING)


def _shortest(sweep: Sweep) -> float:
    values = sweep.design.coordinates(whole(sweep.design))
    if "duration" in values:
        return float(np.min(values["duration"]))
    if sweep.duration is not None:
        return sweep.duration
    assert sweep.periods is not None  # a sweep has one of these
    if "angular_frequency" in values:
        return sweep.periods * 2.0 * math.pi / float(np.max(values["angular_frequency"]))
    assert sweep.motion.period is not None  # a sweep refuses periods of a motion without one
    return sweep.periods * sweep.motion.period


UNSETTLED = -2
"""The label of a run that has not reached an attractor by its end."""

NOT_SETTLED = "not settled"
"""The name of such runs in the table of attractors."""
REMEDY = "not settled: run them for more periods"

AT_REST, ROCKING, OVERTURNED = "at rest", "rocking", "overturned"
ROLLING = {1: "rolling anticlockwise", -1: "rolling clockwise"}
MODULATED = {1: "modulated anticlockwise", -1: "modulated clockwise"}
APERIODIC = {1: "aperiodic anticlockwise", -1: "aperiodic clockwise", 0: "aperiodic"}
ENDINGS = {
    Outcome.OVERTURNED: OVERTURNED,
    Outcome.LIMIT_REACHED: "tilt limit reached",
    Outcome.LIFTED_OFF: "lifted off",
    Outcome.SURVIVED: "survived",
}

KINDS = (AT_REST, *ROLLING.values(), ROCKING, *MODULATED.values(), *APERIODIC.values(), *ENDINGS.values(), NOT_SETTLED)
"""All kinds, in the order in which attractors are listed."""

# Tolerance of the mean turns of the contact point per forcing period for zero or one turn: half a turn in ten.
_TURNING = 0.05
# Outcomes of runs that move until their end; a column at rest at the end may rest for only a part of each period.
_MOVING = (
    *(Outcome.ROLLING, Outcome.ROCKING, Outcome.PERIODIC, Outcome.MODULATED, Outcome.APERIODIC),
    *(Outcome.STILL_MOVING, Outcome.AT_REST),
)


@dataclass(frozen=True, slots=True)
class Attractor:
    """An attractor of a set of runs.

    Attributes
    ----------
    kind
        Kind in words.
    period
        Number of forcing periods after which it repeats; 0 if it does not repeat.
    turns
        Mean turns of the contact point per forcing period, anticlockwise positive. NaN for an orbit whose period does
        not divide the averaging periods of the rolling rate (`OutcomeRules.periods`): the mean shows only the sign.
    mean_tilt
        Mean tilt over the last periods of its runs [rad]; 0 at rest, NaN if the attractor ends a run.
    states
        Dimensionless stroboscopic samples (`OrbitScales.states`), shape (period, 2); a single sample without a period,
        none if the attractor ends a run.
    """

    kind: str
    period: int
    turns: float
    mean_tilt: float
    states: Complexes


@dataclass(frozen=True, slots=True)
class FoundAttractors:
    """The `attractors` of some runs, and the index of the attractor of each run: `labels`, in the shape of the runs."""

    attractors: tuple[Attractor, ...]
    labels: Integers

    def listed(self) -> "FoundAttractors":
        """Return the result with unsettled runs, if any, listed last like an attractor."""
        unsettled = self.labels == UNSETTLED
        if not unsettled.any():
            return self
        place = len(self.attractors)
        row = Attractor(NOT_SETTLED, 0, np.nan, np.nan, np.empty((0, 2), dtype=complex))
        return FoundAttractors((*self.attractors, row), np.where(unsettled, place, self.labels))


def find_attractors(runs: xr.Dataset, scales: OrbitScales, rules: AttractorRules) -> FoundAttractors:
    """Find the attractors of `runs` of one column under one base motion, and the attractor of each run.

    The outcome identifies rest, overturning and other ends of a run. A run that moves until its end is on a periodic
    orbit if its stroboscopic samples repeat; the set of samples identifies the orbit. Otherwise the outcome decides:
    MODULATED is modulated rolling, APERIODIC is aperiodic (quasi-periodic or chaotic), both labelled by their sense.
    All other runs are unsettled. A column that stands at every sample counts as at rest.

    Parameters
    ----------
    runs
        Result of an ensemble or sweep with `strobes`.
    scales
        Units of the stroboscopic samples, and the period of the forcing.
    rules
        Tolerances by which attractors are identified.

    Returns
    -------
    FoundAttractors
        The attractors in an order that depends only on them, and labels: UNSETTLED, NOT_COMPUTED, or their index.

    Raises
    ------
    ParameterError
        If the runs have no stroboscopic samples, or all moving runs are too short for them.
    """
    if "strobe_tilt" not in runs:
        raise ParameterError(
            "runs must have stroboscopic samples, from which attractors are identified. Follow them with strobes=32"
        )
    shape, flat = runs["outcome"].shape, _Flat.of(runs, scales)
    labels = np.full(flat.outcome.shape, UNSETTLED)
    labels[flat.outcome == NOT_COMPUTED] = NOT_COMPUTED
    if scales.period is not None:
        flat.require_strobes()
    groups = sorted(_groups(flat, rules), key=lambda group: rank(group[0], rules.match_tolerance))
    for place, (_, members) in enumerate(groups):
        labels[members] = place
    return FoundAttractors(tuple(attractor for attractor, _ in groups), labels.reshape(shape))


@dataclass(frozen=True, slots=True)
class _Flat:
    """The data that identify attractors, flat over the runs, with samples of shape (n, strobes, 2)."""

    outcome: npt.NDArray[np.int8]
    strobes: Complexes
    turns: Floats
    mean_tilt: Floats
    periods_of_mean: int

    @classmethod
    def of(cls, runs: xr.Dataset, scales: OrbitScales) -> "_Flat":
        """Return the arrays of `runs`."""
        dims = runs["outcome"].dims
        vectors = [runs[name].transpose(*dims, "strobe", "axis").to_numpy() for name in _STROBED]
        count, strobes = runs["outcome"].size, vectors[0].shape[-2]
        tilt, rate = (vector.reshape(count, strobes, 2) for vector in vectors)
        return cls(
            runs["outcome"].to_numpy().ravel(),
            scales.states(tilt, rate),
            runs["mean_rolling_rate"].to_numpy().ravel() * (scales.period or 0.0) / (2.0 * np.pi),
            runs["mean_tilt"].to_numpy().ravel(),
            _periods_of_mean(runs),
        )

    def require_strobes(self) -> None:
        """Raise ParameterError if there are runs that move until their end and none of them has all samples."""
        outcomes = [outcome for outcome in _MOVING if outcome is not Outcome.AT_REST]
        moving = np.isin(self.outcome, outcomes)
        if moving.any() and np.isnan(self.strobes[moving]).any(axis=(1, 2)).all():
            count = self.strobes.shape[1]
            raise ParameterError(
                f"runs must last as many periods of the base motion as they have strobes, {count}, got shorter ones; "
                "follow them longer or with fewer strobes"
            )


def _periods_of_mean(runs: xr.Dataset) -> int:
    """Return the number of last periods over which the rolling rate of `runs` was averaged."""
    rules = json.loads(runs.attrs.get("provenance", "{}")).get("rules")
    return int(rules["periods"]) if isinstance(rules, dict) and "periods" in rules else OutcomeRules().periods


_STROBED = ("strobe_tilt", "strobe_tilt_rate")


def _groups(runs: _Flat, rules: AttractorRules) -> Iterator[tuple[Attractor, Integers]]:
    """Yield each attractor with its runs."""
    for outcome, kind in ENDINGS.items():
        if (ended := np.flatnonzero(runs.outcome == outcome)).size:
            yield Attractor(kind, 0, 0.0, np.nan, np.empty((0, 2), dtype=complex)), ended
    moving = np.isin(runs.outcome, _MOVING)
    stands = (runs.outcome == Outcome.AT_REST) & ~(np.abs(runs.strobes) > 0.0).any(axis=(1, 2))
    if stands.any():
        yield Attractor(AT_REST, 0, 0.0, 0.0, np.zeros((1, 2), dtype=complex)), np.flatnonzero(stands)
    candidates = np.flatnonzero(moving & ~stands)
    periods, left = repeating_periods(runs.strobes[candidates], rules)
    for period in np.unique(periods[periods > 0]):
        chosen = periods == period
        yield from _orbits(runs, candidates[chosen], int(period), left[chosen], rules.match_tolerance)
    yield from _unrepeated(runs, candidates[periods == 0])


def _orbits(
    runs: _Flat, candidates: Integers, period: int, left: Floats, tolerance: float
) -> Iterator[tuple[Attractor, Integers]]:
    cycles = runs.strobes[candidates, -period:]
    groups, leaders = group_cycles(cycles, left, tolerance)
    for group, leader in enumerate(leaders):
        members = candidates[groups == group]
        # An orbit of k periods makes a whole number of turns in them; none if the rate is unknown, or if the lean only
        # changes sides.
        mean = 0.0 if is_flat(cycles[leader], tolerance) else _median(runs.turns[members], otherwise=0.0)
        counted = not mean or runs.periods_of_mean % period == 0  # else the mean counts a part of the orbit twice
        turns = round(period * mean) / period if counted else np.nan
        kind = kind_of_orbit(turns if counted else mean * (abs(mean) > _TURNING))
        yield Attractor(kind, period, turns, _median(runs.mean_tilt[members]), _ordered(cycles[leader])), members


def _unrepeated(runs: _Flat, candidates: Integers) -> Iterator[tuple[Attractor, Integers]]:
    outcome = runs.outcome[candidates]
    settled = candidates[np.isin(outcome, (Outcome.MODULATED, Outcome.APERIODIC))]
    turns = runs.turns[settled]
    senses = np.where(np.abs(turns) > _TURNING, np.sign(turns), 0.0)
    with_forcing = runs.outcome[settled] == Outcome.MODULATED
    for kinds, chosen in ((MODULATED, with_forcing), (APERIODIC, ~with_forcing)):
        for sense, kind in kinds.items():
            members = settled[chosen & (senses == sense)]
            if members.size:
                # The samples fill a curve or more: the state of largest tilt represents them, for any order of runs.
                last = runs.strobes[members, -1]
                farthest = last[np.argmax(np.abs(last[:, 0]))]
                mean = _median(runs.turns[members])
                yield Attractor(kind, 0, mean, _median(runs.mean_tilt[members]), farthest[np.newaxis]), members


def kind_of_orbit(turns: float) -> str:
    """Return the kind of a periodic orbit with this number of turns per forcing period: rolling, or rocking if none."""
    return ROLLING[int(np.sign(turns))] if turns else ROCKING


def with_turns(found: FoundAttractors, turns: Floats, tolerance: float) -> tuple[FoundAttractors, Integers]:
    """Return `found` with kinds by these `turns` for orbits whose turns were unknown, and the new order.

    The order holds for each index the previous index of its attractor.
    """
    attractors = [
        replace(one, turns=float(value), kind=kind_of_orbit(value))
        if np.isnan(one.turns) and np.isfinite(value)
        else one
        for one, value in zip(found.attractors, turns, strict=True)
    ]
    order = np.array(
        sorted(range(len(attractors)), key=lambda place: rank(attractors[place], tolerance)), dtype=np.int64
    )
    place = np.empty_like(order)
    place[order] = np.arange(order.size)
    labels, settled = found.labels.copy(), found.labels >= 0
    labels[settled] = place[found.labels[settled]]
    return FoundAttractors(tuple(attractors[old] for old in order), labels), order


def _ordered(cycle: Complexes) -> Complexes:
    """Return the states of an orbit, starting with the state of largest tilt."""
    return np.roll(cycle, -int(np.argmax(np.abs(cycle[:, 0]))), axis=0)


def _median(values: Floats, *, otherwise: float = np.nan) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else otherwise


def rank(attractor: Attractor, tolerance: float) -> tuple[float, ...]:
    """Return the sort key of an attractor: by kind and period, then by tilt, the largest first, then by its state.

    Numbers are rounded to the `tolerance`, so that rounding errors do not change the order of two orbits.
    """
    first = attractor.states[0] if len(attractor.states) else np.zeros(2, dtype=complex)
    state = np.round(np.array([np.abs(first).max(), *first.real, *first.imag]) / tolerance)
    return (KINDS.index(attractor.kind), attractor.period, *(-state))


def names_of(attractors: Sequence[Attractor]) -> list[str]:
    """Return a name for each attractor: kind, period if longer than the forcing's, and a number if names agree."""
    plain = [found.kind + (f", period {found.period}" if found.period > 1 else "") for found in attractors]
    return [
        f"{name} ({plain[:place].count(name) + 1})" if plain.count(name) > 1 else name
        for place, name in enumerate(plain)
    ]
