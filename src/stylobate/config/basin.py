"""Describe basins of attraction: the case that all runs share, and initial conditions on a grid or at random."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

from pydantic import Field, field_validator

from stylobate.config.axis import Axis
from stylobate.config.description import Config, built
from stylobate.config.many_runs import ManyRuns, common_values, refuse_design
from stylobate.config.run_numbers import fields_of
from stylobate.config.simulation import Setup
from stylobate.errors import LARGEST_SEED, MOST_RUNS, require_whole
from stylobate.parameter_quantities import quantity_of
from stylobate.run_arguments import Stroboscopic
from stylobate.units import read_all


class Starts(Config):
    """Initial conditions on a grid of two of them, or drawn at random.

    Parameters
    ----------
    x, y
        Values of an initial condition on a grid: a table as below.
    random
        Number of initial conditions to draw, in place of a grid.
    seed
        Seed of the draw.
    over
        Range of each initial condition that is drawn: minimum and maximum.
    """

    x: Axis | None = None
    y: Axis | None = None
    random: int | None = None
    seed: int = 0
    over: dict[str, tuple[float, float]] = Field(default_factory=dict)

    @field_validator("over")
    @classmethod
    def _written_as_in_python(cls, over: dict[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        return {name.replace("-", "_"): bounds for name, bounds in over.items()}

    @field_validator("over", mode="before")
    @classmethod
    def _read_units(cls, over: Any) -> Any:
        """Read bounds with a unit, such as "5 deg"."""
        if not isinstance(over, Mapping):
            return over
        return {name: read_all(one, quantity_of(str(name).replace("-", "_")).unit) for name, one in over.items()}

    def arguments(self, problems: list[str]) -> dict[str, Any]:
        """Make the arguments of `stylobate.studies.basins`; add a line to `problems` for each mistake."""
        axes = {place: axis for place, axis in (("x", self.x), ("y", self.y)) if axis is not None}
        if self.random is None:
            problems += _problems_of_the_grid(axes, self.over)
            return {"over": {axis.name: built(f"basin.{place}", axis.build, problems) for place, axis in axes.items()}}
        if axes:
            problems.append(
                f"basin.{' and basin.'.join(axes)}: random initial conditions have ranges (over) and no grid"
            )
        if not self.over:
            problems.append("basin.over is missing: the ranges of random initial conditions, by name")
        built("basin", lambda: require_whole("random", self.random or 0, least=1, most=MOST_RUNS), problems)
        built("basin", lambda: require_whole("seed", self.seed, least=0, most=LARGEST_SEED), problems)
        return {"over": dict(self.over), "count": self.random, "rng": self.seed}


def _problems_of_the_grid(axes: Mapping[str, Axis], over: Mapping[str, object]) -> list[str]:
    if over:
        return ["basin.random is missing: the number of initial conditions to draw in the ranges over"]
    if len({axis.name for axis in axes.values()}) == 2:  # noqa: PLR2004  a plane
        return []
    if not axes:
        return ["basin: x and y are missing (a grid of initial conditions), or random and over (a random sample)"]
    missing = [f"basin.{place} is missing" for place in "xy" if place not in axes]
    return missing or [f"basin.x and basin.y must differ, got {axes['x'].name!r} in both"]


class BasinConfig(fields_of(Stroboscopic), ManyRuns):  # type: ignore[misc]
    """Basins of attraction: `column`, `model`, `motion`, numbers of all runs, and the table `basin`."""

    basin: Starts = Starts()
    end_converged: bool = False

    @classmethod
    def of_saved(cls, provenance: Mapping[str, Any], axes: Mapping[str, Sequence[float]]) -> Self:
        """Make the description that repeats saved basins.

        Parameters
        ----------
        provenance
            Provenance of the basins.
        axes
            Coordinates of a grid: both names with their values, x first.

        Raises
        ------
        UnsupportedError
            If descriptions do not support the model or base motion of the basins.
        ParameterError
            If the initial conditions are neither on a grid nor drawn at random.
        """
        design = refuse_design(provenance, "grid", "random")
        if design["kind"] == "random":
            starts = {"random": design["count"], "seed": design["seed"], "over": design["values"]}
        else:
            listed = ({"name": name, "values": list(values)} for name, values in axes.items())
            starts = dict(zip("xy", listed, strict=False))
        kept = {"strobes": provenance["strobes"]} if provenance.get("strobes") else {}
        return cls.parse({**common_values(provenance), **kept, "basin": starts})

    def build(self) -> Setup:
        """Build model and motion; the options are arguments of `stylobate.studies.basins`.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems: list[str] = []
        arguments = self.basin.arguments(problems)
        problems += self.problems_of_the_length(())
        model, motion, options = self.common(problems)
        chosen = {} if self.strobes is None else {"strobes": self.strobes}
        chosen |= {"end_converged": True} if self.end_converged else {}
        return Setup(model, motion, {**arguments, **options, **chosen, "confidence": self.confidence})
