"""Uncertain properties of a column: distributions and samples."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import ndtr, ndtri

from stylobate.base_motions import BASE_AT_REST
from stylobate.engine.parameters import COLUMN_NAMES, check_names, model_names, present_value
from stylobate.errors import ParameterError, require_not_negative, require_positive, require_whole
from stylobate.models import Model
from stylobate.results.random_numbers import Rng, generator_of
from stylobate.studies.sweeps.quantities import Floats


class Spread(Protocol):
    """The distribution of an uncertain property."""

    def draw(self, nominal: float, shares: Floats) -> Floats:
        """Return the quantiles of these `shares` of the distribution; `nominal` is the value of the model."""


@dataclass(frozen=True, slots=True)
class LognormalSpread:
    """A lognormal distribution.

    Parameters
    ----------
    dispersion
        Standard deviation of the logarithm.
    median
        Median; by default the value of the model.
    """

    dispersion: float
    median: float | None = None

    def __post_init__(self) -> None:
        require_not_negative("dispersion", self.dispersion)
        if self.median is not None:
            require_positive("median", self.median)

    def draw(self, nominal: float, shares: Floats) -> Floats:
        """Return the quantiles of these `shares`."""
        median = require_positive("median", nominal if self.median is None else self.median)
        return np.asarray(median * np.exp(self.dispersion * ndtri(shares)))


@dataclass(frozen=True, slots=True)
class NormalSpread:
    """A normal distribution, truncated at `least` and `most`.

    Parameters
    ----------
    deviation
        Standard deviation before truncation, in the unit of the property.
    mean
        Mean before truncation; by default the value of the model.
    least, most
        Bounds.
    """

    deviation: float
    mean: float | None = None
    least: float = 0.0
    most: float = np.inf

    def __post_init__(self) -> None:
        require_positive("deviation", self.deviation)
        if not self.least < self.most:
            raise ParameterError(f"least must be below most, got {self.least!r} and {self.most!r}")

    def draw(self, nominal: float, shares: Floats) -> Floats:
        """Return the quantiles of these `shares`."""
        mean = nominal if self.mean is None else self.mean
        low, high = (ndtr((bound - mean) / self.deviation) for bound in (self.least, self.most))
        values = mean + self.deviation * ndtri(low + shares * (high - low))
        return np.asarray(np.clip(values, self.least, self.most))


@dataclass(frozen=True, slots=True)
class UniformSpread:
    """A uniform distribution between two values, for a property with known bounds only."""

    least: float
    most: float

    def __post_init__(self) -> None:
        if not self.least <= self.most:
            raise ParameterError(f"least must not lie above most, got {self.least!r} and {self.most!r}")

    def draw(self, nominal: float, shares: Floats) -> Floats:
        """Return the quantiles of these `shares`."""
        del nominal
        return np.asarray((1.0 - shares) * self.least + shares * self.most)


@dataclass(frozen=True, slots=True)
class LogUniformSpread:
    """A uniform distribution of the logarithm between two positive values."""

    least: float
    most: float

    def __post_init__(self) -> None:
        if not 0.0 < require_positive("least", self.least) <= require_positive("most", self.most):
            raise ParameterError(
                f"least: must not lie above most (got {self.least!r} and {self.most!r}). Exchange them."
            )

    def draw(self, nominal: float, shares: Floats) -> Floats:
        """Return the quantiles of these `shares`."""
        del nominal
        return np.asarray(np.exp((1.0 - shares) * np.log(self.least) + shares * np.log(self.most)))


@dataclass(frozen=True, slots=True)
class Choice:
    """Equally probable values, such as the corners of a low-pass filter; infinity for no filter."""

    among: tuple[float, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "among", tuple(float(value) for value in self.among))
        if not self.among or any(np.isnan(value) for value in self.among):
            raise ParameterError(f"among: must be one number or more (got {self.among!r}). Name each value once.")

    def draw(self, nominal: float, shares: Floats) -> Floats:
        """Return the quantiles of these `shares`, in the order of `among`."""
        del nominal
        places = np.minimum((shares * len(self.among)).astype(int), len(self.among) - 1)
        return np.asarray(np.array(self.among)[places], dtype=np.float64)


def property_samples(model: Model, spreads: Mapping[str, Spread], *, count: int, rng: Rng) -> dict[str, Floats]:
    """Draw independent samples of uncertain properties, for the argument `parameters`.

    Parameters
    ----------
    model
        The column with its nominal properties.
    spreads
        The distribution of each property, by the names of parameters of column and model: damping, slenderness (changes
        the radius), size (all lengths at one density; nominally 1), restitution, mass_height …
    count
        The number of samples.
    rng
        Seed or numpy.random.Generator. A longer series begins with the samples of a shorter one.

    Returns
    -------
    dict
        Arrays of shape (count,), in the order of `spreads`.

    Raises
    ------
    ParameterError
        If a name is no parameter of column or model, or a distribution does not suit it.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.02)
    >>> spreads = {"damping": LognormalSpread(0.4), "size": NormalSpread(0.02)}
    >>> samples = property_samples(model, spreads, count=2000, rng=0)
    >>> print(f"{np.median(samples['damping']):.3f} {samples['size'].std():.3f}")
    0.020 0.020
    """
    if not isinstance(spreads, Mapping) or not spreads:
        raise ParameterError(
            f'spreads must name properties, such as {{"damping": LognormalSpread(0.4)}}, got {spreads!r}'
        )
    number = require_whole("count", count, least=1)
    check_names(model, None, spreads, where="spreads")
    for name, spread in spreads.items():
        if name not in (*COLUMN_NAMES, *model_names(model)):
            raise ParameterError(f"spreads cannot name {name}: it belongs to the base motion")
        if not hasattr(spread, "draw"):
            raise ParameterError(f"spreads[{name!r}] must be a spread such as LognormalSpread(0.4), got {spread!r}")
    shares = generator_of(rng).random((number, len(spreads)))
    return {
        name: spread.draw(present_value(model, BASE_AT_REST, name), shares[:, place])
        for place, (name, spread) in enumerate(spreads.items())
    }
