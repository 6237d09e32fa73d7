"""Uncertainty exponent of a basin boundary: how fast the share of undecided initial conditions falls with precision."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.optimize import minimize
from scipy.special import xlogy

from stylobate.base_motions import BaseMotion
from stylobate.errors import MOST_RUNS, Outcome, ParameterError, require_whole
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.results.random_numbers import Rng
from stylobate.studies.checks import require_no_limits, require_starts
from stylobate.studies.maps.attractor_search import (
    UNSETTLED,
    AttractorRules,
    Floats,
    Integers,
    OrbitScales,
    find_attractors,
    with_strobes,
)
from stylobate.studies.maps.integrity import UNRESOLVED
from stylobate.studies.proportions import require_confidence, wilson_interval
from stylobate.studies.study import StudyArguments, described, study
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import Box, checked_values, whole
from stylobate.studies.sweeps.running import Label

# Shares above this are near saturation, and the power law does not hold.
_LARGEST_SHARE = 0.5
# Tolerance of the simplex that maximises the likelihood, in log f.
_FIT_TOLERANCE = 1e-9
_LEAST_POINTS = 2


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """The law f = prefactor · x^exponent.

    Attributes
    ----------
    exponent, prefactor
        Parameters of the law; NaN with fewer than two points.
    standard_error
        Standard error of the exponent, from the Fisher information of the binomial counts; multiplied by the root of
        `misfit` if the misfit is above 1.
    misfit
        Deviance per degree of freedom: about 1 if the law holds, far above 1 otherwise. NaN for two points.
    used
        Whether the fit uses each point.
    """

    exponent: float
    prefactor: float
    standard_error: float
    misfit: float
    used: npt.NDArray[np.bool_]

    def at(self, x: Floats) -> Floats:
        """Return f at `x`."""
        return np.asarray(self.prefactor * x**self.exponent)


def fit_power_law(x: Floats, count: npt.ArrayLike, total: npt.ArrayLike) -> PowerLaw:
    """Fit a power law to the shares `count`/`total` at `x` by maximum likelihood.

    Counts are binomial, so that points with a count of zero have the right weight. Points with more than half of the
    total are left out, because their share is near saturation.

    Parameters
    ----------
    x
        Positive numbers, shape (n,).
    count, total
        Count and total at each.
    """
    k, n = np.asarray(count, dtype=float), np.asarray(total, dtype=float)
    used = (n > 0.0) & (k <= _LARGEST_SHARE * n)
    if np.count_nonzero(used & (k > 0.0)) < _LEAST_POINTS:
        return PowerLaw(np.nan, np.nan, np.nan, np.nan, used)
    k, n, logs = k[used], n[used], np.log(x[used])
    middle = float(np.average(logs, weights=k))
    (level, slope), deviance = _most_likely(logs - middle, k, n)
    share = np.exp(level + slope * (logs - middle))
    # Fisher information of (level, slope): the variance of log(k/n) is (1 − f)/(n f).
    weight = n * share / (1.0 - share)
    offset = logs - middle
    information = np.array([[weight.sum(), weight @ offset], [weight @ offset, weight @ offset**2]])
    error = float(np.sqrt(np.linalg.inv(information)[1, 1]))
    freedom = k.size - _LEAST_POINTS
    misfit = deviance / freedom if freedom else np.nan
    spread = np.sqrt(max(1.0, misfit)) if freedom else 1.0
    return PowerLaw(slope, float(np.exp(level - slope * middle)), error * spread, misfit, used)


def _most_likely(x: Floats, k: Floats, n: Floats) -> tuple[tuple[float, float], float]:
    """Return level and slope of log f against `x` of maximum likelihood, and their deviance."""

    def deviance(law: Floats) -> float:
        share = np.exp(law[0] + law[1] * x)
        if np.any(share >= 1.0):
            return np.inf
        missed = n - k
        return float(2.0 * np.sum(xlogy(k, k / (n * share)) + xlogy(missed, missed / (n * (1.0 - share)))))

    found = k > 0.0
    slope, level = np.polyfit(x[found], np.log(k[found] / n[found]), 1, w=np.sqrt(k[found]))
    # If the law through the counts would exceed 1, the search starts lower.
    level -= max(0.0, float(np.max(level + slope * x)) + 0.1)
    best = minimize(
        deviance,
        (level, slope),
        method="Nelder-Mead",
        options={"xatol": _FIT_TOLERANCE, "fatol": _FIT_TOLERANCE, "maxiter": 10_000},
    )
    return (float(best.x[0]), float(best.x[1])), float(best.fun)


# Default shifts: this many, geometric, between these fractions of the range of the shifted component.
_USUAL_SHIFTS = np.geomspace(1e-5, 3e-2, 8)
# Share of dropped initial conditions above which a warning is logged.
_MANY_DROPPED = 0.1

_log = logging.getLogger("stylobate")


@study("uncertainty exponent")
def uncertainty_exponent(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, Sequence[float]],
    shifted: str,
    shifts: npt.ArrayLike | None = None,
    count: int,
    rng: Rng = 0,
    overturning_only: bool = False,
    attractor_rules: AttractorRules | None = None,
    confidence: float = 0.95,
    **run: Unpack[StudyArguments],
) -> tuple[Sweep, Label]:
    """Estimate the uncertainty exponent υ of a basin boundary, f(ε) ~ ε^υ, and the boundary's dimension.

    A random initial condition is uncertain at ε if the run reaches another attractor when one component is shifted by
    +ε or −ε. A run that overturned counts as different from every run that did not, even from an unsettled one. υ = 1
    means a smooth boundary; the smaller υ, the less a more accurate initial condition helps. The boundary has the
    dimension D − υ within the D initial conditions that vary: McDonald, Grebogi, Ott, Yorke, "Fractal basin
    boundaries", Physica D 17 (1985). Each ε has its own sample, so the errors of the fractions are independent, and
    the standard error of υ is that of the fit.

    Parameters
    ----------
    model, motion
        The column and its base motion.
    over
        Range of each initial condition that varies: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s],
        start_phase [rad].
    shifted
        Name of the component that is shifted.
    shifts
        Values of ε in the unit of `shifted`, increasing; by default 8 in geometric order between 1e-5 and 3e-2 of its
        range. They must be large against the integration error (rtol).
    count, rng
        Number of initial conditions per ε, three runs each; seed or numpy.random.Generator.
    overturning_only
        Consider only the boundary between overturning and survival.
    attractor_rules
        Tolerances by which attractors are identified.
    confidence
        Confidence level of the intervals of the fractions.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "uncertainty exponent". Over `epsilon`: the number of `uncertain` among `pairs` initial conditions,
        `fraction`, `fraction_low`, `fraction_high`, `fitted` and the `fit`; `dropped`, the number of initial conditions
        that cannot be classified, because a run is unsettled or failed and none differs for certain. Also
        `uncertainty_exponent`, its `standard_error`, `boundary_dimension`, `misfit`. A warning is logged if more than
        a tenth of the initial conditions is dropped.

    Raises
    ------
    ParameterError
        If an argument is out of range, a name in `over` is not an initial condition, runs are too short for the
        stroboscopic samples, or `tilt_limit` is given with `overturning_only`: a run stopped there may not overturn.
    """
    require_starts("over", over)
    epsilon = _shifts(shifts, over, shifted)
    base = Box.of(over, epsilon.size * require_whole("count", count, least=1, most=MOST_RUNS), rng)
    if overturning_only:
        require_no_limits(run)
    sweep = Sweep.points(
        model,
        motion,
        at=shifted_starts(base.values(whole(base)), shifted, epsilon),
        **described(run),
    )

    classify: Callable[[xr.Dataset], Integers] = overturned_or_not
    if not overturning_only:
        sweep = with_strobes(sweep, run["strobes"] or None)
        rules = attractor_rules or AttractorRules()
        classify = partial(_attractor_of_each, scales=OrbitScales.of(model, motion), rules=rules)
    settings: Any = {"shifted": shifted, "dimension": len(over), "confidence": require_confidence(confidence)}

    def label(runs: xr.Dataset) -> xr.Dataset:
        found = _labelled(runs, classify=classify, epsilon=epsilon, **settings)
        _warn_of_dropped(found)
        return found.assign_attrs(overturning_only=int(overturning_only))

    return sweep, label


def _warn_of_dropped(found: xr.Dataset) -> None:
    dropped, classified = int(found["dropped"].sum()), int(found["pairs"].sum())
    if dropped > _MANY_DROPPED * (dropped + classified):
        _log.warning(
            "uncertainty_exponent dropped %d of %d initial conditions as undecided. "
            "Run them longer so that they settle",
            dropped,
            dropped + classified,
        )


def _labelled(
    runs: xr.Dataset,
    classify: Callable[[xr.Dataset], Integers],
    epsilon: Floats,
    shifted: str,
    dimension: int,
    confidence: float,
) -> xr.Dataset:
    overturned = overturned_or_not(runs)
    found = exponent_of(classify(runs), epsilon, overturned=overturned, dimension=dimension, confidence=confidence)
    found["epsilon"].attrs = attributes_of(shifted)
    return found.assign_attrs({**runs.attrs, **found.attrs, "shifted": shifted})


def overturned_or_not(runs: xr.Dataset) -> Integers:
    """Return 1 for each run that overturned and 0 for each run that did not.

    UNSETTLED if overturning is undecided: the run failed, lifted off or was stopped at a tilt limit; also NOT_COMPUTED.
    """
    codes = runs["outcome"].to_numpy().astype(np.int64)
    states: Integers = (codes == Outcome.OVERTURNED).astype(np.int64)
    states[np.isin(codes, UNRESOLVED)] = UNSETTLED
    states[codes == NOT_COMPUTED] = NOT_COMPUTED
    return states


def _attractor_of_each(runs: xr.Dataset, scales: OrbitScales, rules: AttractorRules) -> Integers:
    return find_attractors(runs, scales, rules).labels


def shifted_starts(base: Mapping[str, Floats], shifted: str, epsilon: Floats) -> dict[str, Floats]:
    """Return the `base` initial conditions, followed by all with `shifted` lowered by ε, then all with it raised by ε.

    The initial conditions form blocks of equal length, one for each ε.
    """
    change = np.repeat(epsilon, base[shifted].size // epsilon.size)
    moved = {shifted: np.concatenate([base[shifted], base[shifted] - change, base[shifted] + change])}
    return {name: moved[name] if name in moved else np.tile(values, 3) for name, values in base.items()}


def exponent_of(
    states: npt.NDArray[np.integer],
    epsilon: Floats,
    *,
    overturned: npt.NDArray[np.integer] | None = None,
    dimension: int,
    confidence: float = 0.95,
) -> xr.Dataset:
    """Estimate the uncertainty exponent from the final `states` of the runs of `shifted_starts`.

    Parameters
    ----------
    states
        Code of the final state of each run, negative if unknown: NOT_COMPUTED or UNSETTLED.
    epsilon
        The shifts.
    overturned
        1 for each run that overturned, 0 for each run that did not, negative if undecided. It can distinguish runs
        whose states are unknown.
    dimension
        Number D of initial conditions that vary.
    confidence
        Confidence level of the intervals of the fractions.
    """
    differ, agree = _compared(np.reshape(states, (3, epsilon.size, -1)))
    if overturned is not None:
        differ |= _compared(np.reshape(overturned, (3, epsilon.size, -1)))[0]
    computed = (np.reshape(states, (3, epsilon.size, -1)) != NOT_COMPUTED).all(axis=0)
    one_differs, both_agree = differ.any(axis=0) & computed, agree.all(axis=0)
    uncertain = np.count_nonzero(one_differs, axis=1)
    pairs = np.count_nonzero(one_differs | both_agree, axis=1)
    dropped = np.count_nonzero(computed, axis=1) - pairs
    low, high = wilson_interval(uncertain, pairs, confidence=confidence)
    law = fit_power_law(epsilon, uncertain, pairs)
    interval = f"end of its {100.0 * confidence:g} % interval"
    return xr.Dataset(
        {
            "uncertain": ("epsilon", uncertain, {"units": "1", "long_name": "uncertain initial conditions"}),
            "pairs": ("epsilon", pairs, {"units": "1", "long_name": "initial conditions classified"}),
            "dropped": ("epsilon", dropped, {"units": "1", "long_name": "initial conditions dropped as undecided"}),
            "fraction": (
                "epsilon",
                np.where(pairs > 0, uncertain / np.maximum(pairs, 1), np.nan),
                {"units": "1", "long_name": "fraction of uncertain initial conditions"},
            ),
            "fraction_low": ("epsilon", low, {"units": "1", "long_name": f"lower {interval}"}),
            "fraction_high": ("epsilon", high, {"units": "1", "long_name": f"upper {interval}"}),
            "fitted": ("epsilon", law.used, {"long_name": "used for the fit"}),
            "fit": ("epsilon", law.at(epsilon), {"units": "1", "long_name": "fraction by the fit"}),
            "uncertainty_exponent": ((), law.exponent, {"units": "1", "long_name": "uncertainty exponent υ"}),
            "standard_error": ((), law.standard_error, {"units": "1", "long_name": "standard error of υ"}),
            "boundary_dimension": (
                (),
                dimension - law.exponent,
                {"units": "1", "long_name": f"dimension of the boundary within {dimension}"},
            ),
            "misfit": ((), law.misfit, {"units": "1", "long_name": "deviance of the fit per degree of freedom"}),
        },
        coords={"epsilon": epsilon},
        attrs={"kind": "uncertainty exponent", "confidence": confidence},
    )


def _compared(states: npt.NDArray[np.integer]) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return whether the state of each base run certainly differs from that of a shifted run, and whether all agree."""
    base, shifted = states[:1], states[1:]
    known = (base >= 0) & (shifted >= 0)
    return known & (base != shifted), known & (base == shifted)


def _shifts(shifts: npt.ArrayLike | None, over: Mapping[str, Sequence[float]], shifted: str) -> Floats:
    if shifted not in over:
        raise ParameterError(f"shifted must be one of {', '.join(over)}, got {shifted!r}")
    if shifts is None:
        low, high = checked_values("over", shifted, over[shifted])[[0, -1]]
        return np.asarray(_USUAL_SHIFTS * (high - low))
    epsilon = checked_values("shifts", shifted, shifts)
    if epsilon.size < 2 or not (epsilon[0] > 0.0 and np.all(np.diff(epsilon) > 0.0)):  # noqa: PLR2004
        raise ParameterError(f"shifts must be at least two positive numbers, increasing; got {shifts!r}")
    return epsilon
