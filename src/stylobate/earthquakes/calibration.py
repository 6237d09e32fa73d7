"""Calibration: the numbers of an object learnt from tests in which it stood or fell."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.optimize import minimize
from scipy.special import expit, logit
from scipy.stats import qmc

from stylobate.base_motions import BaseMotion
from stylobate.engine.ensemble import simulate_ensemble
from stylobate.engine.parameters import check_names
from stylobate.errors import Outcome, ParameterError, require_positive, require_whole
from stylobate.models import Model
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.results.random_numbers import Rng, generator_of

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

# The spread of a number between tests is at least this fraction of its range: fewer draws than a few would count else.
_NARROWEST = 0.02
# Fraction of outcomes that have nothing to do with the model: that at which a search begins, and at most.
_USUAL_LAPSE, _MOST_LAPSES = 0.05, 0.5
_EVEN = 0.5
# Steps of the chain for each state that is kept, and its length before the first one.
_THINNED, _WARM_UP = 10, 500


@dataclass(frozen=True, eq=False)
class Calibration:
    """What tests with known outcomes say of an object.

    Each test draws the numbers of the object from normal distributions that its place, wear and impacts explain;
    a share λ of the outcomes has other reasons. Means, standard deviations and λ have a posterior distribution.

    Parameters
    ----------
    model
        The model whose numbers are learnt.
    ranges
        Range of each number.
    draws
        Draws of the numbers, evenly spread over their ranges, shape (k, d), in units of the ranges.
    fell
        1 where the object of a draw overturned in a test, shape (k, n).
    overturned
        Outcomes of the tests, shape (n,).
    posterior
        Samples of the posterior, shape (m, 2d + 1): means and standard deviations in units of the ranges, and λ.
    """

    model: Model
    ranges: Mapping[str, tuple[float, float]]
    draws: Floats
    fell: Floats
    overturned: Bools
    posterior: Floats

    def numbers(self) -> xr.Dataset:
        """Return the mean and the standard deviation of each number between tests, and λ, with 95 % intervals.

        Returns
        -------
        xarray.Dataset
            `mean`, `spread` over `number` and `quantile` (0.025, 0.5, 0.975), in the units of the numbers; `lapse`, λ,
            over `quantile`.
        """
        low, width = _bounds(self.ranges)
        count, shares = len(low), [0.025, 0.5, 0.975]
        quantiles = np.quantile(self.posterior, shares, axis=0)
        axes = ("quantile", "number")
        return xr.Dataset(
            {
                "mean": (axes, low + width * quantiles[:, :count]),
                "spread": (axes, width * quantiles[:, count : 2 * count]),
                "lapse": ("quantile", quantiles[:, -1]),
            },
            coords={"quantile": shares, "number": list(self.ranges)},
        )

    def probabilities(self, fell: Floats | None = None) -> Floats:
        """Return the probability that the object overturns in each test, shape (n,).

        Parameters
        ----------
        fell
            1 where the object of a draw overturned, shape (k, n); by default in the tests of the calibration.
        """
        fell = self.fell if fell is None else fell
        each = [_probabilities(state, self.draws, fell) for state in self.posterior]
        return np.asarray(np.mean(each, axis=0))

    @shows_progress("prediction")
    def predict(self, motions: Sequence[BaseMotion], *, tail: float = 2.0, progress: Progress = None) -> Floats:
        """Return the probability that the object overturns under further motions; arguments as for `calibrate`."""
        return self.probabilities(_fallen(self.model, motions, self.ranges, self.draws, tail, progress))

    def relearnt(self, overturned: Sequence[bool] | Bools, *, samples: int = 200, rng: Rng = 0) -> "Calibration":
        """Learn from other outcomes of the same tests, such as those of a second object, without further runs.

        Parameters
        ----------
        overturned, samples, rng
            As for `calibrate`.
        """
        known, generator = _outcomes(overturned, self.fell.shape[1]), generator_of(rng)
        best = _most_probable(self.draws, self.fell, known)
        chain = _chain(best, self.draws, self.fell, known, require_whole("samples", samples, least=1), generator)
        return Calibration(self.model, self.ranges, self.draws, self.fell, known, chain)

    def held_out(
        self, *, folds: int = 5, repeats: int = 10, groups: npt.ArrayLike | None = None, rng: Rng = 0
    ) -> Floats:
        """Return the probabilities of tests that were not used, shape (repeats, n).

        The tests are divided at random into `folds` parts; those of each part are predicted from the others. Only the
        distributions are learnt again, from the same simulated outcomes.

        Parameters
        ----------
        folds, repeats
            Number of parts, and of divisions.
        groups
            Label of each test, such as the name of its motion, shape (n,): tests with one label are in one part. By
            default each test is divided from all others.
        rng
            Seed or numpy.random.Generator.

        Raises
        ------
        ParameterError
            If there are fewer labels than parts, or not one for each test.
        """
        generator, count = generator_of(rng), len(self.overturned)
        folds, repeats = require_whole("folds", folds, least=2), require_whole("repeats", repeats, least=1)
        labels = np.arange(count) if groups is None else np.unique(np.asarray(groups), return_inverse=True)[1].ravel()
        if labels.shape != (count,):
            raise ParameterError(f"groups: must have a label for each of {count} tests (got {labels.size}).")
        kinds = int(labels.max()) + 1
        if kinds < folds:
            raise ParameterError(f"groups: must have at least {folds} labels, one a part (got {kinds}).")
        found = np.empty((repeats, count))
        for repeat in range(repeats):
            for chosen in np.array_split(generator.permutation(kinds), folds):
                part = np.isin(labels, chosen)
                best = _most_probable(self.draws, self.fell[:, ~part], self.overturned[~part])
                found[repeat, part] = _probabilities(best, self.draws, self.fell[:, part])
        return found


@shows_progress("calibration")
def calibrate(
    model: Model,
    motions: Sequence[BaseMotion],
    overturned: Sequence[bool] | Bools,
    *,
    ranges: Mapping[str, tuple[float, float]],
    count: int = 256,
    samples: int = 200,
    tail: float = 2.0,
    rng: Rng = 0,
    progress: Progress = None,
) -> Calibration:
    """Learn the numbers of an object from tests in which it stood or fell.

    The object is simulated in each test with `count` draws of its numbers. The share of them that overturns, weighted
    by a normal distribution of the numbers, is the probability of the outcome; means and standard deviations of this
    distribution follow from the likelihood of all outcomes.

    Parameters
    ----------
    model
        The model; its other numbers stay as they are.
    motions
        Base motion of each test.
    overturned
        Whether the object overturned in each test, shape (n,).
    ranges
        Smallest and largest value of each number to be learnt, by the names of parameters of `simulate_ensemble`, such
        as {"slenderness": (0.1, 0.2)}. `offset_x` is a constant acceleration [m/s²]; it stands for a base that slopes,
        or for a body that tips at different angles to both sides.
    count
        Number of draws.
    samples
        Number of samples of the posterior.
    tail
        Time after the end of each motion in which the object may still fall [s].
    rng
        Seed or numpy.random.Generator.
    progress
        Function called as progress(done, total); False for nothing; by default a bar.

    Returns
    -------
    Calibration
        The posterior, with probabilities of the tests and of further motions.

    Raises
    ------
    ParameterError
        If numbers of motions and outcomes differ, all outcomes are equal, or a range is empty or has an unknown name.

    Notes
    -----
    The draws are points of Sobol's sequence. The weight of a draw is the density of the distribution there, so each
    likelihood needs no further run. The posterior has flat priors within the ranges and is sampled by a chain of
    Metropolis from the most probable state.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> block = sb.PlanarRocking.block(width=0.3, height=2.0, density=2700.0)
    >>> pulses = [sb.Pulse.one_sine(acceleration=a, angular_frequency=12.0) for a in np.linspace(0.5, 6.0, 30)]
    >>> fell = [sb.simulate(block, pulse, duration=5.0).outcome is sb.Outcome.OVERTURNED for pulse in pulses]
    >>> ranges = {"slenderness": (0.1, 0.25)}
    >>> found = calibrate(block, pulses, fell, ranges=ranges, count=64, samples=50, tail=4.0, progress=False)
    >>> low, middle, high = found.numbers()["mean"].sel(number="slenderness").values
    >>> bool(low < block.column.slenderness < high)
    True
    """
    known = _outcomes(overturned, len(motions))
    for name, (low, high) in ranges.items():
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise ParameterError(f"ranges[{name!r}] must be a smaller and a larger number, got {(low, high)!r}")
    check_names(model, None, ranges, where="ranges")
    generator = generator_of(rng)
    number = require_whole("count", count, least=8)
    draws = qmc.Sobol(len(ranges), rng=generator).random(number)
    fell = _fallen(model, motions, ranges, draws, require_positive("tail", tail, "s"), progress)
    begun = Calibration(model, dict(ranges), draws, fell, known, np.empty((0, 2 * len(ranges) + 1)))
    return begun.relearnt(known, samples=samples, rng=generator)


def _outcomes(overturned: Sequence[bool] | Bools, tests: int) -> Bools:
    known = np.asarray(overturned, dtype=bool)
    if known.shape != (tests,):
        raise ParameterError(f"overturned must have one outcome for each of {tests} motions, got shape {known.shape}")
    if known.all() or not known.any():
        raise ParameterError("overturned must have both outcomes: tests that end alike bound numbers on one side only")
    return known


def scores(probability: npt.ArrayLike, overturned: npt.ArrayLike) -> dict[str, float]:
    """Return scores of probabilities beside outcomes.

    Parameters
    ----------
    probability
        Probability of overturning of each test, shape (…, n).
    overturned
        Outcomes, shape (n,).

    Returns
    -------
    dict
        `same_outcome`, the fraction of tests whose outcome has the larger probability; `brier`, the mean square of
        probability minus outcome (0.25 for a coin); `log_loss`, the mean of −ln of the probability of the outcome.
    """
    p, known = np.asarray(probability, dtype=float), np.asarray(overturned, dtype=bool)
    of_outcome = np.where(known, p, 1.0 - p)
    return {
        "same_outcome": float(np.mean((p > _EVEN) == known)),
        "brier": float(np.mean((p - known) ** 2)),
        "log_loss": float(np.mean(-np.log(np.clip(of_outcome, 1e-12, None)))),
    }


def reliability(probability: npt.ArrayLike, overturned: npt.ArrayLike, *, bins: int = 5) -> xr.Dataset:
    """Return the fraction of tests that overturned among those of like probability.

    Returns
    -------
    xarray.Dataset
        Over `bin`: `predicted`, mean probability; `overturned`, fraction of outcomes; `tests`, number of tests.
    """
    p, known = np.asarray(probability, dtype=float).ravel(), np.asarray(overturned, dtype=float)
    known = np.resize(known, p.shape)
    place = np.minimum((p * bins).astype(int), bins - 1)
    tests = np.bincount(place, minlength=bins)
    with np.errstate(invalid="ignore"):
        means = [np.bincount(place, values, bins) / tests for values in (p, known)]
    return xr.Dataset({"predicted": ("bin", means[0]), "overturned": ("bin", means[1]), "tests": ("bin", tests)})


def _bounds(ranges: Mapping[str, tuple[float, float]]) -> tuple[Floats, Floats]:
    low, high = np.array(list(ranges.values()), dtype=float).T
    return low, high - low


def _fallen(
    model: Model,
    motions: Sequence[BaseMotion],
    ranges: Mapping[str, tuple[float, float]],
    draws: Floats,
    tail: float,
    progress: Progress,
) -> Floats:
    """Return 1 where the object of a draw overturns under a motion, shape (k, n)."""
    report, (low, width) = report_of(progress), _bounds(ranges)
    parameters: dict[str, Any] = dict(zip(ranges, (low + width * draws).T, strict=True))
    fell = np.empty((len(draws), len(motions)))
    for number, motion in enumerate(motions):
        runs = simulate_ensemble(model, motion, duration=motion.duration + tail, parameters=parameters, progress=False)
        fell[:, number] = runs["outcome"].values == Outcome.OVERTURNED
        report(number + 1, len(motions))
    return fell


def _probabilities(state: Floats, draws: Floats, fell: Floats) -> Floats:
    """Return the probability of overturning in each test for means, standard deviations and λ."""
    count = draws.shape[1]
    mean, spread, lapse = state[:count], state[count : 2 * count], state[-1]
    exponents = -0.5 * np.sum(((draws - mean) / spread) ** 2, axis=1)
    weights = np.exp(exponents - exponents.max())
    share = weights @ fell / weights.sum()
    return np.asarray(0.5 * lapse + (1.0 - lapse) * share)


def _log_likelihood(state: Floats, draws: Floats, fell: Floats, overturned: Bools) -> float:
    """Return the logarithm of the probability of all outcomes; −∞ outside the ranges."""
    count = draws.shape[1]
    mean, spread, lapse = state[:count], state[count : 2 * count], state[-1]
    inside = np.all((mean >= 0.0) & (mean <= 1.0) & (spread >= _NARROWEST) & (spread <= 1.0))
    if not inside or not 0.0 < lapse <= _MOST_LAPSES:
        return -math.inf
    p = _probabilities(state, draws, fell)
    return float(np.sum(np.log(np.where(overturned, p, 1.0 - p))))


def _most_probable(draws: Floats, fell: Floats, overturned: Bools) -> Floats:
    """Return the state of the largest likelihood, from a search that begins at the best draws."""
    count = draws.shape[1]
    same = np.mean(fell == overturned, axis=1)

    def state_of(free: Floats) -> Floats:
        shares = expit(free)
        spread = _NARROWEST + (1.0 - _NARROWEST) * shares[count : 2 * count]
        return np.concatenate([shares[:count], spread, _MOST_LAPSES * shares[-1:]])

    def unlikely(free: Floats) -> float:
        return -_log_likelihood(state_of(free), draws, fell, overturned)

    best, largest = state_of(np.zeros(2 * count + 1)), -math.inf
    for start in draws[np.argsort(-same)[:2]]:
        inside = np.clip(start, 0.02, 0.98)
        begun = logit(np.concatenate([inside, np.full(count, 0.1), [_USUAL_LAPSE / _MOST_LAPSES]]))
        found = minimize(
            unlikely,
            begun,
            method="Nelder-Mead",
            options={"maxiter": 200 * count, "xatol": 1e-2, "fatol": 1e-2},
        )
        if -found.fun > largest:
            best, largest = state_of(found.x), -found.fun
    return best


def _chain(
    begun: Floats, draws: Floats, fell: Floats, overturned: Bools, samples: int, generator: np.random.Generator
) -> Floats:
    """Return samples of the posterior by a chain of Metropolis, whose steps adapt while it warms up."""
    state, now = begun, _log_likelihood(begun, draws, fell, overturned)
    size, kept = np.full(len(begun), 0.05), []
    for step in range(_WARM_UP + samples * _THINNED):
        proposed = state + size * generator.normal(size=len(state)) / math.sqrt(len(state))
        then = _log_likelihood(proposed, draws, fell, overturned)
        accepted = math.log(generator.random()) < then - now
        if accepted:
            state, now = proposed, then
        if step < _WARM_UP:  # towards a quarter of the steps accepted
            size = size * (1.05 if accepted else 0.983)
        elif (step - _WARM_UP) % _THINNED == _THINNED - 1:
            kept.append(state)
    return np.array(kept)
