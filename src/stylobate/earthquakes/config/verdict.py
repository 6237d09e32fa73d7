"""Description of a verdict, its variations, and the distributions of uncertain properties."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from stylobate import earthquakes
from stylobate.config.description import Config, Seconds, built
from stylobate.errors import LARGEST_SEED, MOST_RUNS, ConfigError, require_not_negative, require_whole
from stylobate.studies.proportions import require_confidence

if TYPE_CHECKING:
    from stylobate.earthquakes.property_spreads import Spread


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


class VerdictConfig(Config):
    """The table `verdict` of a run: its small variations.

    Parameters
    ----------
    runs
        Number of variations.
    seed
        Seed of the random numbers.
    confidence
        Confidence level of intervals.
    tail
        Free-vibration time after the motion [s]; by default 20/`column.frequency_parameter`, and eight times as long
        for runs that still move then.
    variations
        Distribution of each variation that is not to have its default, by its name: tables as for `spreads` of a
        fragility; false leaves the variation out.
    """

    runs: int = 300
    seed: int = 0
    confidence: float = 0.9
    tail: Seconds | None = None
    variations: dict[str, AnySpread | Literal[False]] = Field(default_factory=dict)

    @classmethod
    def of(cls, values: Mapping[str, Any] | None) -> dict[str, Any]:
        """Return the arguments of `verdict` in the table `values`; none without a table.

        Raises
        ------
        ConfigError
            With one line for each mistake.
        """
        if values is not None and not isinstance(values, Mapping):
            message = f"verdict: must be a table (got {values!r}). Write one such as [verdict] runs = 300."
            raise ConfigError([message])
        table, problems = cls.parse(values or {}), list[str]()
        checks = {
            "runs": lambda: require_whole("runs", table.runs, least=2, most=MOST_RUNS),
            "seed": lambda: require_whole("seed", table.seed, least=0, most=LARGEST_SEED),
            "confidence": lambda: require_confidence(table.confidence),
            "tail": lambda: require_not_negative("tail", table.tail or 0.0, "s"),
        }
        for name, check in checks.items():
            built(f"verdict.{name}", check, problems)
        spreads = {
            name: one if one is False else built(f"verdict.variations.{name}", one.build, problems)
            for name, one in table.variations.items()
        }
        if problems:
            raise ConfigError(problems)
        numbers = table.model_dump(exclude={"variations"})
        return {**numbers, "variations": {name: one or None for name, one in spreads.items()}}
