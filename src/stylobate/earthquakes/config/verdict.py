"""Description of a verdict: how many variations, which distributions, and the base motion that they vary."""

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field

from stylobate.config.description import Config, Seconds, built
from stylobate.earthquakes.config.spreads import AnySpread
from stylobate.errors import LARGEST_SEED, MOST_RUNS, ConfigError, require_not_negative, require_whole
from stylobate.studies.proportions import require_confidence


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
