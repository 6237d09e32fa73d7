"""Attractors of a column under one base motion, their orbits, and the share of initial conditions that reach each."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Unpack

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.engine import simulate_ensemble
from stylobate.errors import MOST_RUNS, require_whole
from stylobate.models import Model
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes
from stylobate.results.random_numbers import Rng
from stylobate.studies.checks import require_starts
from stylobate.studies.maps.attractor_search import (
    NOT_SETTLED,
    REMEDY,
    Attractor,
    AttractorRules,
    Floats,
    FoundAttractors,
    OrbitScales,
    find_attractors,
    names_of,
    with_strobes,
    with_turns,
)
from stylobate.studies.proportions import fraction_interval
from stylobate.studies.study import StudyArguments, described, study
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.running import Label

# Maximum turn between samples for which its sense is certain.
_LARGEST_TURN = np.pi / 2.0
# Number of times along a path, and of forcing periods for a motion that does not repeat.
_SAMPLES, _PERIODS_UNREPEATED = 1025, 20


def orbit_paths(
    model: Model, motion: BaseMotion | None, attractors: Sequence[Attractor], scales: OrbitScales
) -> xr.Dataset:
    """Return the tilt along each attractor, and its mean and peak tilt.

    Parameters
    ----------
    model, motion
        The column and its base motion. Only a harmonic motion has paths, because its steady part is known.
    attractors
        The attractors.
    scales
        Units of the attractors' states.

    Returns
    -------
    xarray.Dataset
        `orbit_tilt` (attractor_index, orbit_sample, axis) [rad], at equal times over the period (20 forcing periods for
        an attractor that does not repeat); `attractor_mean_tilt` and `attractor_peak_tilt` (attractor_index) [rad]. NaN
        if the attractor ends a run, has not been reached, or its path is unknown.
    """
    tilt = np.full((len(attractors), _SAMPLES, 2), np.nan)
    mean = np.array([attractor.mean_tilt for attractor in attractors])
    standing = np.array([attractor.mean_tilt == 0.0 for attractor in attractors], dtype=bool)
    tilt[standing] = 0.0
    steady = _steady(motion)
    moving = [i for i, found in enumerate(attractors) if len(found.states) and not standing[i]]
    if steady is not None and moving:
        tilt[moving] = _followed(model, steady, [attractors[i] for i in moving], scales)
        amplitude = np.hypot(tilt[moving, :, 0], tilt[moving, :, 1])
        mean[moving] = np.trapezoid(amplitude, axis=1) / (_SAMPLES - 1)
    largest = np.hypot(tilt[..., 0], tilt[..., 1]).max(axis=1, initial=0.0)
    return xr.Dataset(
        {
            "attractor_mean_tilt": ("attractor_index", mean, {"units": "rad", "long_name": "mean tilt"}),
            "attractor_peak_tilt": ("attractor_index", largest, {"units": "rad", "long_name": "peak tilt"}),
            "orbit_tilt": (
                ("attractor_index", "orbit_sample", "axis"),
                tilt,
                {"units": "rad", "long_name": "tilt along the orbit"},
            ),
        }
    )


def turns_of_paths(paths: xr.Dataset, attractors: Sequence[Attractor]) -> Floats:
    """Count the turns of each orbit round the vertical per forcing period along its path, anticlockwise positive.

    NaN if the attractor has no period or no path, or if the path passes so close to the vertical that the change of its
    azimuth between samples is ambiguous.
    """
    x, y = np.moveaxis(paths["orbit_tilt"].to_numpy(), -1, 0)
    steps = np.angle((x[:, 1:] + 1j * y[:, 1:]) * (x[:, :-1] - 1j * y[:, :-1]))
    period = np.array([attractor.period for attractor in attractors], dtype=float)
    followed = (period > 0.0) & (np.abs(steps).max(axis=1, initial=0.0) < _LARGEST_TURN)
    turns = np.full(len(attractors), np.nan)
    turns[followed] = np.round(steps[followed].sum(axis=1) / (2.0 * np.pi)) / period[followed]
    return turns


def _followed(
    model: Model, steady: Harmonic, attractors: Sequence[Attractor], scales: OrbitScales
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    tilt, tilt_rate = scales.vectors(np.stack([attractor.states[0] for attractor in attractors]))
    periods = np.array([attractor.period or _PERIODS_UNREPEATED for attractor in attractors])
    runs = simulate_ensemble(
        model, steady, tilt=tilt, tilt_rate=tilt_rate, duration=periods * steady.period, samples=_SAMPLES
    )
    return runs["sampled_tilt"].transpose("run", "sample", "axis").to_numpy()


def _steady(motion: BaseMotion | None) -> Harmonic | None:
    """Return the harmonic motion from phase zero, without ramp."""
    return replace(motion, start_phase=0.0, ramp=0.0) if isinstance(motion, Harmonic) else None


_TABLE = "attractor_index"


@study("attractors")
def attractors(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, Sequence[float]],
    count: int,
    rng: Rng = 0,
    attractor_rules: AttractorRules | None = None,
    confidence: float = 0.95,
    **run: Unpack[StudyArguments],
) -> tuple[Sweep, Label]:
    """Find the attractors of a column under one base motion, and their fractions, from random initial conditions.

    The rules of `label_attractors` classify the runs without a list in advance: at rest, rolling in either sense,
    rocking and other periodic motions, modulated rolling, aperiodic motions and overturning.

    Parameters
    ----------
    model, motion
        The column and its base motion.
    over
        Range of each initial condition that varies: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s],
        start_phase [rad].
    count, rng
        Number of initial conditions, drawn uniformly; seed or numpy.random.Generator.
    attractor_rules
        Tolerances by which attractors are identified.
    confidence
        Confidence level of the intervals of the fractions.
    **run

    Returns
    -------
    xarray.Dataset
        The table of `label_attractors`, of kind "attractors", without the runs.

    Raises
    ------
    ParameterError
        If an argument is out of range, a name in `over` changes the system, or runs are too short for the samples.

    Notes
    -----
    Runs must be long enough to settle before the stroboscopic samples. With damping η, transients decay as
    exp(−ηω0 t/2): to a thousandth in 14/(ηω0).
    """
    require_starts("over", over)
    sweep = Sweep.random(
        model,
        motion,
        over=over,
        count=require_whole("count", count, least=1, most=MOST_RUNS),
        rng=rng,
        **described(run),
    )

    def label(runs: xr.Dataset) -> xr.Dataset:
        found = label_attractors(runs, model, motion, rules=attractor_rules, confidence=confidence)
        return found.drop_dims("run").assign_attrs(kind="attractors")

    return with_strobes(sweep, run["strobes"] or None), label


def label_attractors(
    runs: xr.Dataset,
    model: Model,
    motion: BaseMotion | None = None,
    *,
    rules: AttractorRules | None = None,
    confidence: float = 0.95,
) -> xr.Dataset:
    """Identify the attractor that each of `runs` has reached, for one column under one base motion.

    A run that moves to its end is on a periodic orbit if its stroboscopic samples repeat, after at most half as many
    periods as there are samples. Two orbits are the same if their samples agree, from whichever sample they begin. If
    the samples do not repeat, the outcome decides: MODULATED is modulated rolling, APERIODIC is aperiodic
    (quasi-periodic or chaotic). Modulated and aperiodic motions are distinguished only by their sense. All other runs
    have "not settled": use more periods.

    Parameters
    ----------
    runs
        Result of an ensemble or sweep with `strobes`. All runs have the same column and base motion; only the start
        phase may differ.
    model, motion
        The column and its base motion.
    rules
        Tolerances by which attractors are identified.
    confidence
        Confidence level of the intervals of the fractions (Wilson's). The lower end counts no unsettled run towards
        an attractor, the upper end counts all of them. Runs on a grid are treated as random; if basins are larger than
        the cells, their intervals are too wide rather than too narrow.

    Returns
    -------
    xarray.Dataset
        The runs without their stroboscopic samples, with `attractor` (−1 if not computed). Over `attractor_index`,
        by kind and size, "not settled" last: `attractor_name`, `attractor_kind`, `attractor_period` [forcing periods, 0
        for none], `attractor_turns` [per forcing period; NaN if unknown], mean and maximum tilt [rad], `count`,
        `fraction` of all runs computed, `fraction_low` and `fraction_high`. Over `orbit_point`, the peak tilt first:
        the stroboscopic samples `attractor_tilt` [rad] and `attractor_tilt_rate` [rad/s]; `orbit_tilt` along the path.
        `unsettled` and `computed` count runs. Fractions add up to one.

    Raises
    ------
    ParameterError
        If the runs have no stroboscopic samples.
    """
    chosen, scales = rules or AttractorRules(), OrbitScales.of(model, motion)
    found = find_attractors(runs, scales, chosen).listed()
    paths = orbit_paths(model, motion, found.attractors, scales)
    found, order = with_turns(found, turns_of_paths(paths, found.attractors), chosen.match_tolerance)
    labels = found.labels.astype(np.int16)
    labelled = runs.drop_dims("strobe").assign(attractor=(runs["outcome"].dims, labels, _label_attributes(found)))
    table = xr.merge(
        [attractor_table(found.attractors, scales), paths.isel(attractor_index=order)],
        combine_attrs="drop",
    )
    whole = labelled.merge(table).merge(shares(found, confidence))
    own = {"tilt_scale": scales.tilt, "tilt_rate_scale": scales.tilt_rate}
    return whole.assign_attrs({**runs.attrs, **rule_attributes(chosen, confidence), **own})


def attractor_table(attractors: Sequence[Attractor], scales: OrbitScales) -> xr.Dataset:
    """Return names, periods, turns and stroboscopic samples of `attractors` over `attractor_index`."""
    points = max((len(attractor.states) for attractor in attractors), default=1)
    states = np.full((len(attractors), max(points, 1), 2), np.nan, dtype=complex)
    for i, attractor in enumerate(attractors):
        states[i, : len(attractor.states)] = attractor.states
    tilt, tilt_rate = scales.vectors(states)
    along = (_TABLE, "orbit_point", "axis")
    return xr.Dataset(
        {
            "attractor_period": (
                _TABLE,
                np.array([attractor.period for attractor in attractors], dtype=np.int32),
                {"units": "1", "long_name": "period in forcing periods"},
            ),
            "attractor_turns": (
                _TABLE,
                np.array([attractor.turns for attractor in attractors], dtype=float),
                {"units": "1", "long_name": "turns of the contact point per forcing period"},
            ),
            "attractor_tilt": (along, tilt, {"units": "rad", "long_name": "stroboscopic tilt"}),
            "attractor_tilt_rate": (along, tilt_rate, {"units": "rad s-1", "long_name": "stroboscopic tilt rate"}),
        },
        coords={
            _TABLE: np.arange(len(attractors)),
            "attractor_name": (_TABLE, np.array(names_of(attractors), dtype=str)),
            "attractor_kind": (_TABLE, np.array([attractor.kind for attractor in attractors], dtype=str)),
            "axis": ["x", "y"],
        },
    )


def shares(found: FoundAttractors, confidence: float) -> xr.Dataset:
    """Return the number of runs that reach each attractor, and the fraction with its interval.

    The attractor of an unsettled run is unknown: the lower end counts no unsettled run towards the attractor, the upper
    end counts all of them.
    """
    found = found.listed()
    labels = found.labels.ravel()
    count = np.array([np.count_nonzero(labels == place) for place in range(len(found.attractors))], dtype=np.int64)
    computed = int(np.count_nonzero(labels != NOT_COMPUTED))
    rest = np.array([attractor.kind == NOT_SETTLED for attractor in found.attractors], dtype=bool)
    unsettled = int(count[rest].sum())
    low, high = fraction_interval(count, np.where(rest, 0, unsettled), computed, confidence=confidence)
    interval = f"end of the {100.0 * confidence:g} % interval of the fraction"
    return xr.Dataset(
        {
            "count": (_TABLE, count, {"units": "1", "long_name": "runs that reach it"}),
            "fraction": (_TABLE, count / max(computed, 1), {"units": "1", "long_name": "fraction of the runs"}),
            "fraction_low": (_TABLE, low, {"units": "1", "long_name": f"lower {interval}"}),
            "fraction_high": (_TABLE, high, {"units": "1", "long_name": f"upper {interval}"}),
            "unsettled": ((), unsettled, {"units": "1", "long_name": "runs that have not settled", "comment": REMEDY}),
            "computed": ((), computed, {"units": "1", "long_name": "runs computed"}),
        }
    )


def rule_attributes(rules: AttractorRules, confidence: float) -> dict[str, Any]:
    """Return the attributes with the rules by which attractors were identified."""
    return {
        "repeat_tolerance": rules.repeat_tolerance,
        "match_tolerance": rules.match_tolerance,
        "branch_tolerance": rules.branch_tolerance,
        "confidence": confidence,
    }


def _label_attributes(found: FoundAttractors) -> dict[str, Any]:
    names = ["not computed", *names_of(found.attractors)]
    meanings = (name.replace(",", "").replace(" ", "_") for name in names)
    return flag_attributes("attractor", meanings, first=NOT_COMPUTED, dtype=np.int16)
