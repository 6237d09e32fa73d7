"""Calibration: the numbers of an object learnt from tests in which it stood or fell."""

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine.ensemble import simulate_ensemble
from stylobate.engine.parameters import check_names
from stylobate.errors import Outcome, ParameterError, UnlikelyInputWarning, require_positive, require_whole
from stylobate.models import Model
from stylobate.progress import Progress, report_of, shows_progress
from stylobate.results.random_numbers import Rng, generator_of

from .weighted_draws import Bools, Draws, Floats, Mixture, r_hat

_EVEN = 0.5
# Further draws come from distributions of so many states of the posterior, wider by this factor, and at least so wide.
_STATES, _WIDER, _LEAST_WIDTH = 64, 1.5, 0.04
# Effective number of draws below which a posterior is not known.
_FEW = 50


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
        Draws of the numbers, and the tests in which each overturned.
    overturned
        Outcomes of the tests, shape (n,).
    posterior
        Samples of the posterior by chain, shape (chains, m, 2d + 1): means and standard deviations in units of the
        ranges, and λ.
    """

    model: Model
    ranges: Mapping[str, tuple[float, float]]
    draws: Draws
    overturned: Bools
    posterior: Floats

    def numbers(self) -> xr.Dataset:
        """Return the mean and the standard deviation of each number between tests, and λ, with 95 % intervals.

        Returns
        -------
        xarray.Dataset
            `mean`, `spread` over `number` and `quantile` (0.025, 0.5, 0.975), in the units of the numbers; `lapse`, λ,
            over `quantile`. `effective_draws` is how many draws of equal weight would know the probabilities as well,
            the mean over the posterior: below about 50 the intervals are too narrow. `r_hat` is the largest R̂ (Gelman
            and Rubin 1992): above about 1.1 the chains have not met.
        """
        low, width = _bounds(self.ranges)
        count, shares = len(low), [0.025, 0.5, 0.975]
        quantiles = np.quantile(self.posterior, shares, axis=(0, 1))
        axes = ("quantile", "number")
        return xr.Dataset(
            {
                "mean": (axes, low + width * quantiles[:, :count]),
                "spread": (axes, width * quantiles[:, count : 2 * count]),
                "lapse": ("quantile", quantiles[:, -1]),
                "effective_draws": self.effective_draws,
                "r_hat": float(r_hat(self.posterior).max()),
            },
            coords={"quantile": shares, "number": list(self.ranges)},
        )

    def probabilities(self) -> Floats:
        """Return the probability that the object overturns in each test, shape (n,)."""
        return np.asarray(self.draws.probabilities(self.states).mean(axis=0))

    @shows_progress("prediction")
    def predict(self, motions: Sequence[BaseMotion], *, tail: float = 2.0, progress: Progress = None) -> Floats:
        """Return the probability that the object overturns under further motions; arguments as for `calibrate`."""
        fell = _fallen(self.model, motions, self.ranges, self.draws.places, tail, progress)
        return replace(self, draws=replace(self.draws, fell=fell)).probabilities()

    def relearnt(self, overturned: Sequence[bool] | Bools, *, samples: int = 1000, rng: Rng = 0) -> "Calibration":
        """Learn from other outcomes of the same tests without further runs.

        The draws are where the first outcomes put them: a warning says if they are too few for the others.

        Parameters
        ----------
        overturned, samples, rng
            As for `calibrate`.
        """
        known, samples = _outcomes(overturned, len(self.overturned)), require_whole("samples", samples, least=1)
        found = replace(self, overturned=known, posterior=self.draws.posterior(known, samples, generator_of(rng)))
        _remark(found)
        return found

    def held_out(
        self, *, folds: int = 5, repeats: int = 10, groups: npt.ArrayLike | None = None, rng: Rng = 0
    ) -> Floats:
        """Return the probabilities of tests that were not used, shape (repeats, n).

        The tests are divided at random into `folds` parts; those of each part are predicted from the others. Only the
        distributions are learnt again, from the same simulated outcomes. All tests decide where draws are dense; that
        changes how well the probabilities are integrated, not what they are learnt from.

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
                best = self.draws.of_tests(~part).most_probable(self.overturned[~part])
                found[repeat, part] = self.draws.of_tests(part).probabilities(best[np.newaxis])[0]
        return found

    @property
    def states(self) -> Floats:
        """Samples of the posterior of all chains, shape (chains · m, 2d + 1)."""
        return self.posterior.reshape(-1, self.posterior.shape[-1])

    @property
    def effective_draws(self) -> float:
        """Number of draws of equal weight that would know the probabilities as well, the mean over the posterior."""
        return float(self.draws.effective(self.states).mean())


@shows_progress("calibration")
def calibrate(
    model: Model,
    motions: Sequence[BaseMotion],
    overturned: Sequence[bool] | Bools,
    *,
    ranges: Mapping[str, tuple[float, float]],
    count: int = 256,
    rounds: int = 3,
    samples: int = 1000,
    tail: float = 2.0,
    rng: Rng = 0,
    progress: Progress = None,
) -> Calibration:
    """Learn the numbers of an object from tests in which it stood or fell.

    The object is simulated in each test with draws of its numbers. The share of them that overturns, weighted by a
    normal distribution of the numbers, is the probability of the outcome; means and standard deviations of this
    distribution follow from the likelihood of all outcomes. The first draws are spread over the ranges, further rounds
    draw where the distributions are.

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
        Number of draws in each round.
    rounds
        Number of rounds.
    samples
        Least number of samples of the posterior.
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
    The draws are points of Sobol's sequence. The weight of a draw is the density of the distribution there, divided by
    the density of the draws of all rounds, so each likelihood needs no further run. A warning says if the posterior
    rests on too few of them. Its priors are flat, for standard
    deviations in their logarithm; it is sampled by chains that propose differences of
    each other (ter Braak 2006).

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> block = sb.PlanarRocking.block(width=0.3, height=2.0, density=2700.0)
    >>> pulses = [sb.Pulse.one_sine(acceleration=a, angular_frequency=12.0) for a in np.linspace(0.5, 6.0, 30)]
    >>> fell = [sb.simulate(block, pulse, duration=5.0).outcome is sb.Outcome.OVERTURNED for pulse in pulses]
    >>> ranges = {"slenderness": (0.1, 0.25)}
    >>> found = calibrate(block, pulses, fell, ranges=ranges, count=64, tail=4.0, progress=False)
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
    number, rounds = require_whole("count", count, least=8), require_whole("rounds", rounds, least=1)
    samples, tail = require_whole("samples", samples, least=1), require_positive("tail", tail, "s")
    report, size = report_of(progress), len(ranges)
    found = Calibration(
        model=model,
        ranges=dict(ranges),
        draws=Draws(np.empty((0, size)), np.empty(0), np.empty((0, len(motions)))),
        overturned=known,
        posterior=np.empty((0, 0, 2 * size + 1)),
    )
    mixtures: list[Mixture] = []
    for place in range(rounds):
        mixtures.append(_around(found, generator) if place else Mixture.even(size))
        new = mixtures[-1].draws(number, generator)

        def counted(done: int, total: int, before: int = place) -> None:
            report(before * total + done, rounds * total)

        fell = np.concatenate([found.draws.fell, _fallen(model, motions, ranges, new, tail, counted)])
        places = np.concatenate([found.draws.places, new])
        draws = Draws(places, np.mean([one.density(places) for one in mixtures], axis=0), fell)
        found = replace(
            found, draws=draws, posterior=draws.posterior(known, samples if place == rounds - 1 else _STATES, generator)
        )
    _remark(found)
    return found


def _remark(found: Calibration) -> None:
    """Warn if the posterior rests on few draws."""
    effective = found.effective_draws
    if effective < _FEW:
        message = (
            f"calibration: rests on few draws ({len(found.draws)} count as {effective:.0f}), so that intervals are too "
            "narrow. Give a larger count, or more rounds."
        )
        warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def _around(known: Calibration, generator: np.random.Generator) -> Mixture:
    """Return distributions of the posterior, widened."""
    states = known.states[generator.choice(len(known.states), _STATES)]
    count = len(known.ranges)
    return Mixture(states[:, :count], np.maximum(_WIDER * states[:, count : 2 * count], _LEAST_WIDTH))


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
