"""Uncertain properties: distributions and samples, and the small variations of a verdict."""

import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Protocol

import numpy as np
from scipy.special import ndtr, ndtri

from stylobate.base_motions import BASE_AT_REST
from stylobate.column import Column
from stylobate.engine.parameters import COLUMN_NAMES, check_names, model_names, present_value
from stylobate.errors import ParameterError, require_not_negative, require_positive, require_whole
from stylobate.models import Model
from stylobate.models.declared import dissipation_of
from stylobate.results.random_numbers import Rng, generator_of
from stylobate.studies.sweeps.designs import Floats
from stylobate.text import did_you_mean


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


# Standard deviations at which an estimated moment of inertia is truncated, and the share of the way that remains to a
# moment that no body has.
_ENDS, _ROOM = 3.0, 0.9


def inertia_spreads(column: Column) -> dict[str, Spread]:
    """Return the distributions of the moments of inertia of a column; none if they are not estimated.

    Parameters
    ----------
    column
        The column, such as one of `Column.estimated`.

    Returns
    -------
    dict
        Truncated normal distributions of `transverse_inertia` and `axial_inertia`, for `verdict`, `property_samples`
        and others. All their values are those of a body of revolution.

    Examples
    --------
    >>> import stylobate as sb
    >>> vase = sb.Column.estimated(radius=0.05, height=0.3, mass_height=0.15, mass=1.2, profile="vase")
    >>> list(inertia_spreads(vase))
    ['transverse_inertia', 'axial_inertia']
    """
    own = column.profile
    if own is None or not own.is_estimated:
        return {}
    across, along = column.transverse_inertia, column.axial_inertia
    # I_a ≤ 2 I_t, and with the height of the body I_t − I_a/2 ≤ m h (H − h): each takes half of the room.
    most = min(along * (1.0 + _ENDS * own.axial_spread), along + 0.5 * _ROOM * (2.0 * across - along))
    least = along * max(0.0, 1.0 - _ENDS * own.axial_spread)
    low, high = max(across * (1.0 - _ENDS * own.transverse_spread), 0.5 * most), math.inf
    if column.height is not None:
        room = column.mass * column.mass_height * (column.height - column.mass_height) + 0.5 * along - across
        least = max(least, along - 0.5 * _ROOM * room)
        high = across + 0.5 * _ROOM * room
    high = min(high, across * (1.0 + _ENDS * own.transverse_spread))
    bounds = {
        "transverse_inertia": (own.transverse_spread * across, low, high),
        "axial_inertia": (own.axial_spread * along, least, most),
    }
    return {
        name: NormalSpread(deviation, least=least, most=most)
        for name, (deviation, least, most) in bounds.items()
        if deviation > 0.0 and least < most
    }


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


_ANY: Final = -math.inf

VARIATIONS: Mapping[str, Spread] = MappingProxyType(
    {
        "scale": LognormalSpread(0.02),
        "clock": LognormalSpread(0.001),
        "lowpass": Choice((math.inf, 40.0, 25.0, 15.0)),
        "rotation": NormalSpread(math.radians(3.0), least=_ANY),
        "slope_x": NormalSpread(math.radians(0.07), least=_ANY),
        "slope_y": NormalSpread(math.radians(0.07), least=_ANY),
        "start_x": NormalSpread(1e-4, least=_ANY),
        "start_y": NormalSpread(1e-4, least=_ANY),
        "size": LognormalSpread(0.01),
        "slenderness": LognormalSpread(0.01),
        "dissipation": LogUniformSpread(0.5, 2.0),
        "tolerance": Choice((1.0, 0.01)),
    }
)
"""Default variations of a verdict; all are independent.

scale
    Factor of the record: 2 %, the calibration of an instrument.
clock
    Factor of the time of the record: 0.1 %.
lowpass
    Corner of a low-pass filter of a record [Hz]: none, or one of three; a corner above its Nyquist frequency does
    nothing.
rotation
    Rotation of the record about the vertical [rad]: 3°, the orientation of an instrument.
slope_x, slope_y
    Slope of the base [rad]: 0.07° each, together a tenth of a degree.
start_x, start_y
    Initial tilt over α_c: 10⁻⁴ each, ambient vibration. A column that already rocks by 10⁻³ is another case: it needs
    no acceleration above its threshold to leave rest, and overturns far more often.
size
    Factor of all lengths: 1 %.
slenderness
    Slenderness r/h: 1 %.
dissipation
    Factor of all dissipation parameters (of the loss, 1 − restitution, at impacts): half to twice, the levels that an
    assessment recommends.
tolerance
    Factor of the tolerance of the integration.
"""

"""Names of variations in figures and sentences; another variation has the name of its parameter."""

# Value of a variation that is not a parameter of column or model, before it is varied.
_NEUTRAL: Mapping[str, float] = {
    "scale": 1.0,
    "clock": 1.0,
    "lowpass": math.inf,
    "rotation": 0.0,
    "slope_x": 0.0,
    "slope_y": 0.0,
    "start_x": 0.0,
    "start_y": 0.0,
    "dissipation": 1.0,
    "tolerance": 1.0,
}


def chosen_variations(
    changes: Mapping[str, Spread | None] | None, own: Mapping[str, Spread] = MappingProxyType({})
) -> dict[str, Spread]:
    """Return the default variations with these changes: another distribution, or None to leave a variation out.

    Variations of the case at hand, `own`, are defaults too.

    Raises
    ------
    ParameterError
        If `changes` does not map names to distributions.
    """
    if changes is not None and not isinstance(changes, Mapping):
        raise ParameterError(
            f'variations: must map names to distributions (got {changes!r}). Pass {{"scale": LognormalSpread(0.05)}}.'
        )
    for name, spread in (changes or {}).items():
        if spread is not None and not hasattr(spread, "draw"):
            raise ParameterError(
                f"variations[{name!r}]: must be a distribution or None (got {spread!r}). Pass one such as "
                "LognormalSpread(0.05)."
            )
    return {name: spread for name, spread in {**VARIATIONS, **own, **(changes or {})}.items() if spread is not None}


def check_variations(models: tuple[Model, ...], variations: Mapping[str, Spread]) -> None:
    """Raise ParameterError if a variation is neither one of `VARIATIONS` nor a parameter of column and models."""
    for name in variations:
        known = [{*_NEUTRAL, *COLUMN_NAMES, *model_names(model)} for model in models]
        if not any(name in some for some in known):
            remedy = did_you_mean(name, set().union(*known)) or f"use one of {', '.join((*VARIATIONS, 'damping'))} …"
            raise ParameterError(f"variations: {name} is no variation of a {models[0].name} column; {remedy}")


def drawn(name: str, spread: Spread, model: Model, *, runs: int, seed: int) -> Floats:
    """Draw the values of one variation, shape (runs,).

    The values depend on the name, its distribution and the seed only: a further variation changes no other, and more
    runs begin with the same.
    """
    return spread.draw(_nominal_of(model, name), shares_of(name, runs=runs, seed=seed))


def shares_of(name: str, *, runs: int, seed: int) -> Floats:
    """Return independent uniform numbers between 0 and 1 for a variation, shape (runs,)."""
    return np.random.default_rng([seed, zlib.crc32(name.encode())]).random(runs)


def _nominal_of(model: Model, name: str) -> float:
    """Return the value of a variation in the given case; NaN for a parameter that the model does not have."""
    if name in _NEUTRAL:
        return _NEUTRAL[name]
    if name in COLUMN_NAMES or name in model_names(model):
        return present_value(model, BASE_AT_REST, name)
    return math.nan


def scaled_dissipation(model: Model, factors: Floats, stated: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the dissipation parameters of a model times `factors`; of a restitution, the loss 1 − e.

    A parameter that the model does not use, or whose values are `stated`, is left out.
    """
    values = {}
    for name, quantity in dissipation_of(type(model)).items():
        value, lossless = getattr(model, name), quantity.lossless
        # Without a stated restitution the model uses that of the impact.
        value = getattr(model, f"impact_{name}", lossless) if value is None else value
        if name not in stated and value != lossless:
            values[name] = np.maximum(0.0, lossless - factors * (lossless - float(value)))
    return values
