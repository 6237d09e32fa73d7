"""Description of a spectrum: the common case, one or two quantities with their values, and the scales."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Self

from stylobate.config.axis import Axis
from stylobate.config.description import Config, Seconds, built
from stylobate.config.many_runs import ManyRuns, common_values, name_of, with_numbers_that_vary
from stylobate.config.simulation import Setup


class Scales(Axis):
    """Factors of the base motion, spaced or listed."""

    name: str = "scale"
    spacing: Literal["linear", "log"] = "log"


class Spectrum(Config):
    """Quantities that vary, and scales of the base motion.

    Parameters
    ----------
    x, y
        Values of a quantity: a table as below. Without `x` the result has one column.
    scales
        Factors of the base motion: a table as below, without a name. Required except with `rocking`.
    rocking
        Whether to compute a rocking spectrum: peak tilts and tilt rates at the scale of the motion.
    width
        Relative width to which the ends of overturning intervals are located; 0.001 by default.
    fine_scales
        Number of scales over the same range of which those below the smallest overturning one are run too; none by
        default.
    tail
        Free-vibration time after the base motion [s]; 40/`column.frequency_parameter` by default.
    """

    x: Axis | None = None
    y: Axis | None = None
    scales: Scales | None = None
    rocking: bool = False
    width: float | None = None
    fine_scales: int | None = None
    tail: Seconds | None = None


class SpectrumConfig(ManyRuns):
    """A spectrum: `column`, `model`, `motion`, numbers of all runs, and the table `spectrum`.

    Without a `duration` runs continue for `spectrum.tail` [s] after the end of the base motion.
    """

    spectrum: Spectrum

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; a motion may omit a number that varies.

        A motion that is scaled may also omit its acceleration, which is then 1 m/s².
        """
        table = values.get("spectrum")
        table = table if isinstance(table, Mapping) else {}
        varied = tuple(name_of(table.get(place)) for place in "xy")
        scaled = () if table.get("rocking") else ("acceleration",)
        own = {name: value for name, value in values.items() if name != "periods"}  # other commands use periods
        return super().parse(with_numbers_that_vary(own, (*varied, *scaled)))

    @classmethod
    def of_saved(cls, provenance: Mapping[str, Any], axes: Mapping[str, Sequence[float]], *, rocking: bool) -> Self:
        """Make the description that repeats a saved spectrum.

        Parameters
        ----------
        provenance
            Provenance of the spectrum.
        axes
            Coordinates of the spectrum: one or two names with their values, and the scale.
        rocking
            Whether it is a rocking spectrum.

        Raises
        ------
        UnsupportedError
            If descriptions do not support the model or base motion of the spectrum.
        """
        over = {name: list(values) for name, values in axes.items() if rocking or name != "scale"}
        listed = ({"name": name, "values": values} for name, values in over.items())
        table: dict[str, Any] = {**dict(zip("xy", listed, strict=False)), "rocking": rocking}
        table |= {
            name: provenance[name] for name in ("width", "fine_scales", "tail") if provenance.get(name) is not None
        }
        if not rocking:
            table["scales"] = {"values": list(axes["scale"])}
        return cls.parse({**common_values(provenance), "spectrum": table})

    def build(self) -> Setup:
        """Build model and motion; the options are arguments of `overturning_intervals`, or of `rocking_spectrum`.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        table, problems = self.spectrum, self._problems()
        axes = {place: axis for place, axis in (("x", table.x), ("y", table.y)) if axis is not None}
        over = {axis.name: built(f"spectrum.{place}", axis.build, problems) for place, axis in axes.items()}
        chosen: dict[str, Any] = {"over": over}
        if table.scales is not None:
            chosen["scales"] = built("spectrum.scales", table.scales.build, problems)
        chosen |= {
            name: getattr(table, name) for name in ("width", "fine_scales", "tail") if getattr(table, name) is not None
        }
        model, motion, options = self.common(problems, ("duration",))
        del options["periods"]
        return Setup(model, motion, {**options, **chosen})

    def _problems(self) -> list[str]:
        table = self.spectrum
        problems: list[str] = []
        if table.tail is not None and self.duration is not None:
            problems.append(
                f"spectrum.tail: contradicts duration (got a duration of {self.duration!r} s and a tail of "
                f"{table.tail!r} s). Remove one of them."
            )
        if table.rocking:
            problems += [
                f"spectrum.{name} is not supported by a rocking spectrum. Remove it."
                for name in ("scales", "width", "fine_scales")
                if getattr(table, name) is not None
            ]
            if table.x is None:
                problems.append("spectrum.x is missing. State a quantity that varies, such as size.")
        elif table.scales is None:
            problems.append("spectrum.scales are missing: factors of the base motion, such as from 0.2 to 5, number 40")
        if table.x is not None and table.y is not None and table.x.name == table.y.name:
            problems.append(f"spectrum.x and spectrum.y must differ, got {table.x.name!r} in both")
        return problems
