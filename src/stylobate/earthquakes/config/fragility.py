"""Description of a fragility: records, scales, uncertain properties, fit and hazard."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from stylobate.base_motions import Record
from stylobate.config.axis import Scales
from stylobate.config.description import Config, Radians, Seconds, built
from stylobate.config.record_collection import RecordsConfig
from stylobate.config.simulation import ManyRuns
from stylobate.earthquakes.config.hazard import Hazard, HazardPoints
from stylobate.earthquakes.config.limit_states import LimitStateConfig, built_limit_states
from stylobate.earthquakes.config.verdict import AnySpread
from stylobate.earthquakes.fragility.displacement_limits import LimitState
from stylobate.earthquakes.property_spreads import inertia_spreads
from stylobate.errors import (
    LARGEST_SEED,
    ConfigError,
    FileError,
    ParameterError,
    require_finite,
    require_not_negative,
    require_positive,
    require_whole,
)
from stylobate.models import Model


class Spectral(Config):
    """Spectral acceleration as the intensity measure.

    Parameters
    ----------
    period
        Period of the oscillator [s].
    damping
        Damping ratio of the oscillator.
    """

    period: Seconds
    damping: float = 0.05


def _as_intensity(values: Any) -> Any:
    if isinstance(values, (str, Spectral)):
        return values
    if isinstance(values, Mapping):
        return Spectral.model_validate(values)
    message = "must be a name, or a table with a period such as {period = 0.5}"
    raise PydanticCustomError("intensity", message)


class Fragility(Config):
    """Scales, uncertain properties, fit and hazard of a fragility.

    Parameters
    ----------
    scales
        Factors of the records: a table as below, without a name.
    intensity
        Name of an intensity measure, such as "PGA" or "SA(0.5 s)"; or a table with the `period` [s] and `damping` of a
        spectral acceleration.
    component
        Horizontal component of the intensity: "RotD50", "RotD100", "geometric mean" or "larger component".
    rotations
        Rotations of each record about the vertical [rad].
    vertical
        Whether the vertical component acts; list both values to run with and without it.
    tail
        Free-vibration time after a record [s]; 20/`column.frequency_parameter` by default.
    samples
        Number of samples of the uncertain properties, estimated moments of inertia among them.
    spreads
        Distribution of each uncertain property, by its name: tables as below.
    seed
        Seed of samples and resamples.
    counting
        Which scales count as reached: those computed, or all above the first that reached the limit state.
    confidence
        Confidence level of intervals.
    resamples
        Number of bootstrap resamples of the records; 0 for profile likelihood.
    limit_states
        Limits of the displacement: a list of tables as below. With the model `sliding` the column slides before it
        rocks, and its slip is computed in place of runs that rock. Other models have limits of "neighbours" only.
    hazard
        Hazard curve of the site: a table as below.
    years
        Period of the stated probability [years].
    target_rate
        Annual rate that is accepted [1/year]: with a hazard, the result states whether the rates are below it.
    """

    scales: Scales
    intensity: Annotated[str | Spectral, BeforeValidator(_as_intensity)] = "peak ground acceleration"
    component: str = "RotD50"
    rotations: tuple[Radians, ...] = (0.0,)
    vertical: tuple[bool, ...] = (True,)
    tail: Seconds | None = None
    samples: int = 0
    spreads: dict[str, AnySpread] = Field(default_factory=dict)
    seed: int = 0
    counting: Literal["as computed", "first"] = "as computed"
    confidence: float = 0.95
    resamples: int = 1000
    limit_states: tuple[LimitStateConfig, ...] = ()
    hazard: Hazard | None = None
    years: float = 50.0
    target_rate: float | None = None


@dataclass(frozen=True, slots=True)
class FragilitySetup:
    """Objects that a description of a fragility describes.

    Parameters
    ----------
    model
        The model of the column.
    records
        Records by name.
    table
        The described table `fragility`.
    scales
        Factors of the records.
    hazard
        Points of the hazard curve, or None.
    options
        Arguments that all runs share.
    limit_states
        Limit states of displacement.
    """

    model: Model
    records: Mapping[str, Record]
    table: Fragility
    scales: tuple[float, ...]
    hazard: HazardPoints | None
    options: dict[str, Any]
    limit_states: tuple[LimitState, ...] = ()


class FragilityConfig(ManyRuns):
    """A fragility: `column`, `model`, `records`, numbers of all runs, and the table `fragility`."""

    records: RecordsConfig
    fragility: Fragility

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; `records` may be the folder alone.

        Raises
        ------
        ConfigError
            With one line for each mistake.
        """
        records = values.get("records")
        if isinstance(records, (str, list, tuple)):
            values = {**values, "records": {"source": records}}
        return super().parse(values)

    def build(self, *, read: bool = True) -> FragilitySetup:
        """Build model, records and options; without records if not `read`.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        table, problems = self.fragility, self._problems()
        scales = built("fragility.scales", table.scales.build, problems)
        hazard = None if table.hazard is None else _points(table.hazard, problems)
        limits = built_limit_states("fragility.limit_states", table.limit_states, problems)
        records = self._records(problems) if read else {}
        model, _, options = self.common(problems, ("duration",))
        given = {name: one for name, one in options.items() if one is not None}
        assert scales is not None
        return FragilitySetup(model, records, table, tuple(scales.tolist()), hazard, given, limits)

    def _records(self, problems: list[str]) -> dict[str, Record]:
        try:
            return self.records.build()
        except ConfigError as error:
            problems += error.problems
            return {}

    def _problems(self) -> list[str]:
        table = self.fragility
        problems = [
            f"{name} is not supported by a fragility: runs end with their record and fragility.tail. Remove it."
            for name in ("duration", "periods")
            if getattr(self, name) is not None
        ]
        if self.tilt_limit is not None:
            problems.append("tilt_limit must be left out: a run stopped there may or may not overturn")
        if bool(table.samples) != bool(table.spreads) and not (table.samples and self._is_estimated()):
            problems.append("fragility.samples and fragility.spreads need each other. Give both or neither.")
        checks = {
            "samples": lambda: require_whole("samples", table.samples, least=0),
            "seed": lambda: require_whole("seed", table.seed, least=0, most=LARGEST_SEED),
            "resamples": lambda: require_whole("resamples", table.resamples, least=0),
            "years": lambda: require_positive("years", table.years, "a"),
            "target_rate": lambda: require_positive("target_rate", table.target_rate or 1.0, "1/a"),
            "tail": lambda: require_not_negative("tail", table.tail or 0.0, "s"),
            "rotations": lambda: [require_finite("rotations", angle, "rad") for angle in table.rotations],
        }
        for name, check in checks.items():
            built(f"fragility.{name}", check, problems)
        return problems

    def _is_estimated(self) -> bool:
        """Return whether moments of inertia of the column are estimated, so that samples need no stated spread."""
        column = built("column", self.column.build, [])
        return column is not None and bool(inertia_spreads(column))


def _points(hazard: Hazard, problems: list[str]) -> HazardPoints | None:
    try:
        return hazard.points()
    except (ParameterError, FileError) as error:
        problems.append(f"fragility.hazard: {error}")
        return None
