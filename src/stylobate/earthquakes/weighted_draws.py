"""Distributions of an object's numbers beside outcomes of tests: likelihood, most probable state and posterior.

A *state* has the means and the standard deviations of d numbers between tests, in units of their ranges, and the share
λ of outcomes that have other reasons: shape (2d + 1,). Priors are flat, for standard deviations in their logarithm.
"""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.special import expit, logit, ndtr, ndtri
from scipy.stats import qmc

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

# The spread of a number between tests is at least this fraction of its range, and a state rests on so many draws of
# equal weight at least: fewer would fit the outcomes by chance.
_NARROWEST, _FEWEST = 0.02, 16.0
# Fraction of outcomes that have nothing to do with the model, at most; that at which a search begins, and its spread.
_MOST_LAPSES, _USUAL_LAPSE, _USUAL_SPREAD = 0.5, 0.05, 0.3
# Steps of the chains before the first state that is kept, and for each that is; scatter of the states in which they
# begin; fraction of steps that are whole differences, which lead from one hill of the posterior to another.
_WARM_UP, _THINNED, _SCATTER, _WHOLE = 500, 20, 0.05, 0.1
_JITTER = 1e-4
# A normal distribution so wide is even within the range.
_EVEN = 1e3


@dataclass(frozen=True, eq=False)
class Draws:
    """Draws of the object's numbers, and the tests in which each overturned.

    Parameters
    ----------
    places
        Numbers of each draw in units of their ranges, shape (k, d).
    density
        Density of the draws there: 1 if they are evenly spread; shape (k,).
    fell
        1 where the object of a draw overturned in a test, shape (k, n).
    """

    places: Floats
    density: Floats
    fell: Floats

    def __len__(self) -> int:
        return len(self.places)

    def of_tests(self, chosen: Bools) -> "Draws":
        """Return the same draws in some of the tests."""
        return Draws(self.places, self.density, self.fell[:, chosen])

    def weights(self, states: Floats) -> Floats:
        """Return the weight of each draw in each state, shape (s, k); their sums are 1."""
        count = self.places.shape[1]
        mean, spread = states[:, np.newaxis, :count], states[:, np.newaxis, count : 2 * count]
        exponents = -0.5 * np.sum(((self.places - mean) / spread) ** 2, axis=2) - np.log(self.density)
        weights = np.exp(exponents - exponents.max(axis=1, keepdims=True))
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))

    def probabilities(self, states: Floats) -> Floats:
        """Return the probability of overturning in each state and test, shape (s, n)."""
        return self._probabilities(states, self.weights(states))

    def _probabilities(self, states: Floats, weights: Floats) -> Floats:
        lapse = states[:, -1:]
        return np.asarray(0.5 * lapse + (1.0 - lapse) * (weights @ self.fell))

    def effective(self, states: Floats) -> Floats:
        """Return the number of draws of equal weight that would know each state as well (Kish), shape (s,)."""
        return _effective(self.weights(states))

    def log_likelihood(self, states: Floats, overturned: Bools) -> Floats:
        """Return the logarithm of the probability of all outcomes in each state, shape (s,).

        It is −∞ outside the ranges, and where too few draws know the state.
        """
        count = self.places.shape[1]
        mean, spread, lapse = states[:, :count], states[:, count : 2 * count], states[:, -1]
        inside = np.all((mean >= 0.0) & (mean <= 1.0) & (spread >= _NARROWEST) & (spread <= 1.0), axis=1)
        inside &= (lapse > 0.0) & (lapse <= _MOST_LAPSES)
        weights = self.weights(states[inside])
        known = _effective(weights) >= min(_FEWEST, 0.5 * len(self))
        inside[inside] = known
        found = np.full(len(states), -math.inf)
        p = self._probabilities(states[inside], weights[known])
        found[inside] = np.sum(np.log(np.where(overturned, p, 1.0 - p)), axis=1)
        return found

    def most_probable(self, overturned: Bools) -> Floats:
        """Return the state of the largest likelihood, from searches that begin at the best two draws."""
        count = self.places.shape[1]
        same = np.mean(self.fell == overturned, axis=1)

        def state_of(free: Floats) -> Floats:
            shares = expit(free)
            spread = _NARROWEST + (1.0 - _NARROWEST) * shares[count : 2 * count]
            return np.concatenate([shares[:count], spread, _MOST_LAPSES * shares[-1:]])

        def unlikely(free: Floats) -> float:
            return -float(self.log_likelihood(state_of(free)[np.newaxis], overturned)[0])

        best, largest = state_of(np.zeros(2 * count + 1)), -math.inf
        for start in self.places[np.argsort(-same)[:2]]:
            inside = np.clip(start, 0.02, 0.98)
            begun = logit(np.concatenate([inside, np.full(count, _USUAL_SPREAD), [_USUAL_LAPSE / _MOST_LAPSES]]))
            found = minimize(
                unlikely,
                begun,
                method="Nelder-Mead",
                options={"maxiter": 200 * count, "xatol": 1e-2, "fatol": 1e-2},
            )
            if -found.fun > largest:
                best, largest = state_of(found.x), -found.fun
        return best

    def posterior(self, overturned: Bools, samples: int, generator: np.random.Generator) -> Floats:
        """Return at least `samples` states of the posterior, shape (chains, m, 2d + 1).

        Chains begin around the most probable state. Each proposes differences of two chains of the other half (ter
        Braak, Statistics and Computing 16, 2006), so that step sizes need no choice.
        """
        best = self.most_probable(overturned)
        size, chains = len(best), 2 * len(best) + 2
        states = best + _SCATTER * generator.normal(size=(chains, size))
        states[:, :-1] = np.clip(states[:, :-1], _NARROWEST, 1.0 - _NARROWEST)
        states[:, -1] = np.clip(states[:, -1], 1e-3, _MOST_LAPSES)
        spreads = slice(self.places.shape[1], size - 1)

        def plain(logarithmic: Floats) -> Floats:
            found = logarithmic.copy()
            found[:, spreads] = np.exp(found[:, spreads])
            return found

        states[:, spreads] = np.log(states[:, spreads])
        now = self.log_likelihood(plain(states), overturned)
        beside = ~np.isfinite(now)
        states[beside], now[beside] = states[np.argmax(now)], now.max()
        kept, usual = [], 2.38 / math.sqrt(2.0 * size)
        halves = np.arange(chains).reshape(2, -1)
        for step in range(_WARM_UP + _THINNED * max(math.ceil(samples / chains), 2)):
            for moved, others in (halves, halves[::-1]):
                first = generator.integers(len(others), size=len(moved))
                second = (first + generator.integers(1, len(others), size=len(moved))) % len(others)
                factor = 1.0 if generator.random() < _WHOLE else usual
                proposed = states[moved] + factor * (states[others[first]] - states[others[second]])
                proposed += _JITTER * generator.normal(size=proposed.shape)
                then = self.log_likelihood(plain(proposed), overturned)
                accepted = np.log(generator.random(len(moved))) < then - now[moved]
                states[moved[accepted]], now[moved[accepted]] = proposed[accepted], then[accepted]
            if step >= _WARM_UP and (step - _WARM_UP) % _THINNED == 0:
                kept.append(plain(states))
        return np.stack(kept, axis=1)


def _effective(weights: Floats) -> Floats:
    return np.asarray(1.0 / np.sum(weights**2, axis=1))


def r_hat(posterior: Floats) -> Floats:
    """Return R̂ of each part of a state (Gelman and Rubin, Statistical Science 7, 1992): 1 if all chains agree.

    Parameters
    ----------
    posterior
        States by chain, shape (chains, m, 2d + 1).
    """
    length = posterior.shape[1]
    between, within = posterior.mean(axis=1).var(axis=0, ddof=1), posterior.var(axis=1, ddof=1).mean(axis=0)
    return np.asarray(np.sqrt((length - 1) / length + between / within))


@dataclass(frozen=True, slots=True)
class Mixture:
    """Normal distributions within the ranges of the numbers, each as probable as the others.

    Parameters
    ----------
    mean, spread
        Means and standard deviations, shape (s, d).
    """

    mean: Floats
    spread: Floats

    @classmethod
    def even(cls, count: int) -> Self:
        """Return the even distribution of `count` numbers."""
        return cls(np.full((1, count), 0.5), np.full((1, count), _EVEN))

    def draws(self, number: int, generator: np.random.Generator) -> Floats:
        """Return draws from points of Sobol's sequence, whose first coordinate chooses a distribution: (number, d)."""
        sobol = qmc.Sobol(1 + self.mean.shape[1], rng=generator)
        points = sobol.random_base2(math.ceil(math.log2(number)))[:number]
        each = (points[:, 0] * len(self.mean)).astype(int)
        low, inside = self._inside()
        shares = low[each] + inside[each] * points[:, 1:]
        return np.asarray(np.clip(self.mean[each] + self.spread[each] * ndtri(shares), 0.0, 1.0))

    def density(self, places: Floats) -> Floats:
        """Return the density at places, shape (k,)."""
        exponents = -0.5 * ((places[:, np.newaxis] - self.mean) / self.spread) ** 2
        each = np.exp(exponents) / (math.sqrt(2.0 * math.pi) * self.spread * self._inside()[1])
        return np.asarray(np.mean(np.prod(each, axis=2), axis=1))

    def _inside(self) -> tuple[Floats, Floats]:
        """Return the probabilities below and within the ranges."""
        low = np.asarray(ndtr(-self.mean / self.spread))
        return low, np.asarray(ndtr((1.0 - self.mean) / self.spread) - low)
