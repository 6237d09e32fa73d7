"""Descriptions of the distributions of uncertain properties and of small variations."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from stylobate import earthquakes
from stylobate.config.description import Config

if TYPE_CHECKING:
    from stylobate.earthquakes import Spread


class _Described(Config):
    def build(self) -> "Spread":
        """Build the distribution; raise ParameterError for an invalid number."""
        numbers = {name: value for name, value in self if name != "kind" and value is not None}
        made: Spread = getattr(earthquakes, _MADE[getattr(self, "kind")])(**numbers)  # noqa: B009  every subclass has one
        return made


class Lognormal(_Described):
    """Lognormal distribution of a property.

    Parameters
    ----------
    dispersion
        Standard deviation of the logarithm.
    median
        Median; the value of the model by default.
    """

    kind: Literal["lognormal"]
    dispersion: float
    median: float | None = None


class Normal(_Described):
    """Truncated normal distribution of a property.

    Parameters
    ----------
    deviation
        Standard deviation.
    mean
        Mean; the value of the model by default.
    least
        Lower bound.
    most
        Upper bound; none by default.
    """

    kind: Literal["normal"]
    deviation: float
    mean: float | None = None
    least: float = 0.0
    most: float | None = None


class Uniform(_Described):
    """Uniform distribution of a property.

    Parameters
    ----------
    least
        Lower bound.
    most
        Upper bound.
    """

    kind: Literal["uniform"]
    least: float
    most: float


class LogUniform(_Described):
    """Uniform distribution of the logarithm of a property.

    Parameters
    ----------
    least
        Lower bound.
    most
        Upper bound.
    """

    kind: Literal["log_uniform"]
    least: float
    most: float


class Choices(_Described):
    """Equally probable values of a property.

    Parameters
    ----------
    among
        The values.
    """

    kind: Literal["choice"]
    among: tuple[float, ...]


# Names of the distributions, which are imported at their first use.
_MADE: Mapping[str, str] = {
    "lognormal": "LognormalSpread",
    "normal": "NormalSpread",
    "uniform": "UniformSpread",
    "log_uniform": "LogUniformSpread",
    "choice": "Choice",
}
_KINDS: Mapping[str, type[_Described]] = {
    "lognormal": Lognormal,
    "normal": Normal,
    "uniform": Uniform,
    "log_uniform": LogUniform,
    "choice": Choices,
}


def described_spread(spread: "Spread") -> dict[str, Any]:
    """Return the description of a distribution as plain values; only its text for one of the user's own classes."""
    kind = next((kind for kind, made in _MADE.items() if type(spread) is getattr(earthquakes, made)), None)
    if kind is None:
        return {"kind": "other", "repr": repr(spread)}
    numbers = {field.name: getattr(spread, field.name) for field in fields(spread)}  # type: ignore[arg-type]
    plain = {name: list(value) if isinstance(value, tuple) else value for name, value in numbers.items()}
    return {"kind": kind, **{name: value for name, value in plain.items() if value is not None and value != math.inf}}


def _as_spread(values: Any) -> Any:
    """Validate the spread of this kind; error messages name the keys of the file, without class names."""
    if isinstance(values, Config):
        return values
    kind = values.get("kind") if isinstance(values, Mapping) else None
    if kind not in _KINDS:
        message = f"a spread must have a kind, {', '.join(map(repr, _KINDS))}, such as {_EXAMPLE}"
        raise PydanticCustomError("spread", message)
    return _KINDS[str(kind)].model_validate(values)


_EXAMPLE = '{kind = "lognormal", dispersion = 0.4}'
AnySpread = Annotated[Lognormal | Normal | Uniform | LogUniform | Choices, BeforeValidator(_as_spread)]
