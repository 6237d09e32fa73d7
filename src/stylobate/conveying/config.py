"""Configurations of studies of conveyors: a drift, and the posture of a part."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

from pydantic import Field

from stylobate.config.axis import Axis
from stylobate.config.description import Config, Number, Radians, built
from stylobate.config.many_runs import ManyRuns, common_values, name_of, refuse_design, with_numbers_that_vary
from stylobate.config.simulation import Setup
from stylobate.conveying.posture import KIND, PERIODS, PHASES, TILTS
from stylobate.conveying.transport import CONFIDENCE, MOST_PERIODS, TOLERANCE

_PERIODS = 60.0
"""Default duration of a run in periods of its base motion."""


class Varied(Config):
    """One or two quantities that vary, and the periods of the means.

    Parameters
    ----------
    x
        Values of a quantity.
    y
        Values of a second quantity.
    late
        Number of last periods of the initial runs over which means are taken.
    tolerance
        Relative half-width of the interval of a speed.
    most_periods
        Maximum duration of a run in periods of its base motion.
    confidence
        Confidence level of the intervals.
    """

    x: Axis
    y: Axis | None = None
    late: int = 20
    tolerance: Number = TOLERANCE
    most_periods: Number = MOST_PERIODS
    confidence: Number = CONFIDENCE


class DriftConfig(ManyRuns):
    """Configuration of a drift: `column`, `model`, `motion`, options of all runs, and the table `drift`."""

    drift: Varied

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; a motion may omit a number that varies."""
        varied = values.get("drift")
        axes = varied if isinstance(varied, Mapping) else {}
        values = {"periods": _PERIODS, **values}
        return super().parse(with_numbers_that_vary(values, (name_of(axes.get("x")), name_of(axes.get("y")))))

    @classmethod
    def of_saved(cls, provenance: Mapping[str, Any], axes: Mapping[str, Sequence[float]]) -> Self:
        """Create the configuration that repeats a saved drift.

        Parameters
        ----------
        provenance
            Provenance of the drift.
        axes
            Coordinates of the drift: one or two names with their values, x first.

        Raises
        ------
        UnsupportedError
            If descriptions do not support the model or base motion of the drift.
        ParameterError
            If the runs are not on a grid.
        """
        refuse_design(provenance, "grid")
        values = common_values(provenance)
        late = int(dict(values.pop("rules", {})).get("periods", Varied.model_fields["late"].default))
        listed = ({"name": name, "values": list(values)} for name, values in axes.items())
        settings = {name: value for name, value in dict(provenance.get("drift", {})).items() if value is not None}
        return cls.parse({**values, "drift": {**dict(zip("xy", listed, strict=False)), "late": late, **settings}})

    def build(self) -> Setup:
        """Build model and motion; the options are arguments of `stylobate.conveying.drift`.

        Raises
        ------
        ConfigError
            With one line per invalid part.
        """
        axes = {place: axis for place, axis in (("x", self.drift.x), ("y", self.drift.y)) if axis is not None}
        problems: list[str] = []
        over = {axis.name: built(f"drift.{place}", axis.build, problems) for place, axis in axes.items()}
        if len(over) < len(axes):
            problems.append(f"drift.x and drift.y must differ, got {self.drift.x.name!r} in both")
        if self.duration is not None or self.periods is None:
            problems.append("duration: a drift lasts a number of periods. Set `periods` of its base motion instead.")
        if self.rules:
            problems.append(
                "rules: a drift has none. Set `late`, the number of last periods over which means are taken."
            )
        model, motion, options = self.common(problems)
        for name in ("duration", "rules"):
            del options[name]
        return Setup(model, motion, {"over": over, **self.drift.model_dump(exclude={"x", "y"}), **options})


class Starts(Config):
    """The initial tilts and phases of a part.

    Parameters
    ----------
    tilts
        Initial tilt angles [rad].
    phases
        Number of phases at which the vibration starts.
    friction
        Friction coefficients, each as probable; that of the model by default.
    azimuth
        Azimuth of the initial tilt [rad]; spread over all directions by default.
    confidence
        Confidence level of intervals.
    """

    tilts: tuple[Radians, ...] = TILTS
    phases: int = PHASES
    friction: tuple[Number, ...] | None = None
    azimuth: Radians | None = None
    confidence: Number = 0.9


class UprightConfig(ManyRuns):
    """Configuration of a posture: `column`, `model`, `motion`, options of all runs, and the table `upright`."""

    upright: Starts = Field(default_factory=Starts)

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`."""
        return super().parse({"periods": PERIODS, **values})

    @classmethod
    def of_saved(cls, provenance: Mapping[str, Any], axes: Mapping[str, Sequence[float]]) -> Self:
        """Create the configuration that repeats a saved posture.

        Parameters
        ----------
        provenance
            Provenance of the posture.
        axes
            Not used.

        Raises
        ------
        UnsupportedError
            If descriptions do not support the model or base motion of the posture.
        """
        del axes
        settings = dict(provenance[KIND])
        values = common_values(provenance)
        for name in ("tilt", "duration"):  # the table has them
            values.pop(name, None)
        return cls.parse({**values, "periods": settings.pop("periods"), "upright": settings})

    def build(self) -> Setup:
        """Build model and motion; the options are arguments of `stylobate.conveying.upright`.

        Raises
        ------
        ConfigError
            With one line per invalid part.
        """
        problems: list[str] = []
        if self.duration is not None or self.periods is None:
            problems.append("duration: runs last a number of periods. Set `periods` of the base motion instead.")
        if self.tilt != (0.0, 0.0):
            problems.append("tilt: runs start at the tilts of the table `upright`. Set `tilts` there instead.")
        model, motion, options = self.common(problems)
        for name in ("duration", "tilt"):
            del options[name]
        return Setup(model, motion, {**self.upright.model_dump(), **options})
