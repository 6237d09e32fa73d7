"""Describe an overturning map: the case that all runs share, and two quantities with their values."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

from stylobate.base_motions.declared import is_pulse, with_numbers
from stylobate.config.axis import Axis
from stylobate.config.description import Config, built
from stylobate.config.many_runs import ManyRuns, common_values, name_of, refuse_design, with_numbers_that_vary
from stylobate.config.simulation import Setup
from stylobate.run_arguments import duration_with_tail


class Plane(Config):
    """The two quantities that vary over an overturning map.

    Parameters
    ----------
    x, y
        Values of a quantity: a table as below.
    """

    x: Axis
    y: Axis


class MapConfig(ManyRuns):
    """An overturning map: `column`, `model`, `motion`, numbers of all runs, and the table `map`."""

    map: Plane
    end_converged: bool = False

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; a motion may omit a number that varies."""
        plane = values.get("map")
        axes = plane if isinstance(plane, Mapping) else {}
        return super().parse(with_numbers_that_vary(values, (name_of(axes.get("x")), name_of(axes.get("y")))))

    @classmethod
    def of_saved(cls, provenance: Mapping[str, Any], axes: Mapping[str, Sequence[float]]) -> Self:
        """Make the description that repeats a saved map.

        Parameters
        ----------
        provenance
            Provenance of the map.
        axes
            Coordinates of the map: both names with their values, x first.

        Raises
        ------
        UnsupportedError
            If descriptions do not support the model or base motion of the map.
        ParameterError
            If the runs are not on a grid.
        """
        refuse_design(provenance, "grid")
        listed = ({"name": name, "values": list(values)} for name, values in axes.items())
        return cls.parse({**common_values(provenance), "map": dict(zip("xy", listed, strict=False))})

    def build(self) -> Setup:
        """Build model and motion; the options are arguments of `stylobate.studies.overturning_map`.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        x, y = self.map.x, self.map.y
        problems: list[str] = []
        over = {axis.name: built(f"map.{place}", axis.build, problems) for place, axis in (("x", x), ("y", y))}
        if x.name == y.name:
            problems.append(f"map.x and map.y must differ, got {x.name!r} in both")
        problems += self.problems_of_the_length((x.name, y.name))
        model, motion, options = self.common(problems, (x.name, y.name))
        frequencies = over.get("angular_frequency")
        if frequencies is not None and self.duration is None and self.periods is None and is_pulse(motion):
            # Each run lasts to the end of its pulse; the pulse of the lowest frequency is the longest.
            longest = with_numbers(motion, {"angular_frequency": float(frequencies.min())})
            options["duration"] = duration_with_tail(longest.duration, model.column.frequency_parameter)
        early = {"end_converged": True} if self.end_converged else {}
        return Setup(model, motion, {"over": over, **options, **early})
