"""Describe one run: from TOML, from the command line, or from a saved result."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Self

from pydantic import Field, model_validator

from stylobate.base_motions import BaseMotion
from stylobate.config.columns import ANY_COLUMN, ColumnConfig, is_dimensionless
from stylobate.config.description import Config, built
from stylobate.config.file_values import DEEPEST, check_file_values
from stylobate.config.models import DEFAULT_MODEL, ModelConfig, described_model
from stylobate.config.motions import AT_REST, MotionConfig, is_to_end
from stylobate.config.records import RecordMotion, anchored
from stylobate.config.run_numbers import fields_of, problems_of_the_numbers
from stylobate.errors import (
    ConfigError,
    FileError,
    ParameterError,
    UnsupportedError,
)
from stylobate.kinds import with_places
from stylobate.models import Model
from stylobate.results import OutcomeRules
from stylobate.run_arguments import SingleRun, duration_with_tail
from stylobate.units import has_unit, is_angle, split


@dataclass(frozen=True, slots=True)
class Setup:
    """Objects built from a description: model, motion and keyword arguments of the study."""

    model: Model
    motion: BaseMotion
    options: dict[str, Any]


class OneColumn(Config):
    """The case of one column: without units if it is dimensionless."""

    @model_validator(mode="before")
    @classmethod
    def _refuse_units(cls, values: Any) -> Any:
        """Refuse units, except of angles, in the case of a dimensionless column: its numbers have other ones."""
        if isinstance(values, Mapping) and is_dimensionless(values.get("column")):
            for place, text in _texts_with_units(values):
                raise ValueError(
                    f"{place}: the numbers of a dimensionless column have no unit (got {text!r}). {_SCALED}"
                )
        return values


_SCALED = "Give accelerations in g, times in 1/ω0 and frequencies in ω0, as plain numbers."


class Case(OneColumn):
    """The case of a run: `column`, `model` and `motion`."""

    column: ColumnConfig
    model: ModelConfig = described_model(DEFAULT_MODEL)
    motion: MotionConfig = AT_REST


def _texts_with_units(values: Any, place: str = "") -> Iterator[tuple[str, str]]:
    """Yield each text with a unit other than that of an angle or a share, at any depth, with its place."""
    if isinstance(values, Mapping):
        for name, one in values.items():
            yield from _texts_with_units(one, f"{place}.{name}" if place else str(name))
    elif isinstance(values, (list, tuple)):
        for one in values:
            yield from _texts_with_units(one, place)
    elif has_unit(values) and not is_angle(split(values)[1]):
        yield place, values


class SimulationConfig(fields_of(SingleRun, "duration"), Case):  # type: ignore[misc]
    """A run: `column`, `model`, `motion` and the arguments of `simulate`, with the same names.

    Under a record, a pulse or a sine sweep the duration is optional. The default is the duration of the motion and a
    free-vibration tail of 20/`column.frequency_parameter`.

    Parameters
    ----------
    column, model, motion
        Column, model and base motion.
    rules
        Numbers of `OutcomeRules`, by name.
    recheck
        Whether to repeat the run if rounding or the rest threshold could alter its outcome.
    """

    rules: dict[str, float] = Field(default_factory=dict)
    recheck: bool = True

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; those of other commands are ignored."""
        own = {name: value for name, value in values.items() if name not in OF_OTHER_COMMANDS}
        return super().parse(with_default_duration(own))

    def build(self) -> Setup:
        """Build the described objects.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems = problems_of_the_numbers(self)
        rules = built("rules", lambda: built_rules(self.rules), problems)
        model, motion = built_parts(self.column, self.model, self.motion, problems)
        options = self.model_dump(exclude={"column", "model", "motion"}) | {"rules": rules}
        if self.duration is None:
            options["duration"] = duration_with_tail(motion.duration, model.column.frequency_parameter)
        return Setup(model, motion, options)


def built_parts(
    column: ColumnConfig, model: ModelConfig, motion: MotionConfig, problems: Sequence[str]
) -> tuple[Model, BaseMotion]:
    """Build the model of the column and the motion.

    Raises
    ------
    ConfigError
        With one line for each invalid part, and the `problems` known before.
    """
    found: list[str] = []
    if isinstance(motion, RecordMotion) and model.kind == "planar_rocking":
        motion = motion.model_copy(update={"one_component": True})  # a planar column uses one component
    made = built("column", column.build, found)
    moved = built("motion", motion.build, found)
    modelled = built("model", lambda: model.build(made or ANY_COLUMN), found)
    if modelled is None or moved is None or found or problems:
        raise ConfigError([*found, *problems])
    return modelled, moved


def with_default_duration(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return `values` with `duration` None if it is missing and the motion ends; without `duration` otherwise."""
    if values.get("duration") is not None:
        return dict(values)
    others = {name: value for name, value in values.items() if name != "duration"}
    return others | ({"duration": None} if is_to_end(values.get("motion")) else {})


OF_OTHER_COMMANDS = (
    *("map", "basin", "drift", "upright", "spectrum", "fragility", "records", "hierarchy", "verdict", "periods"),
    *("method", "strobes", "confidence", "angular_frequency_range", "points", "end_converged"),
)
"""Keys of a description that are not arguments of a single run."""


def read_config(path: str | Path, values: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Read a TOML file as plain values; paths of records become relative to its folder.

    Parameters
    ----------
    path
        The file.
    values
        Its values, if they have been read already.

    Raises
    ------
    FileError
        If the file cannot be read or is not TOML.
    ConfigError
        If the file is nested too deeply, a kind is not a word, or a text contains a NUL character.
    """
    try:
        values = tomllib.loads(Path(path).read_text(encoding="utf-8")) if values is None else values
    except OSError as error:
        raise FileError(f"cannot read {path}: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(f"{path} is not a TOML file: {error}") from None
    except RecursionError:
        raise FileError(f"{path}: nested too deeply to be read. Describe it with at most {DEEPEST} levels.") from None
    check_file_values(values)
    folder = Path(path).parent
    found: dict[str, Any] = anchored(with_places(values, folder), folder)
    return found


def built_rules(rules: Mapping[str, Any]) -> OutcomeRules:
    """Build the rules with these numbers; raise ParameterError for an unknown name or an invalid number."""
    known = {field.name for field in fields(OutcomeRules)}
    unknown = [name for name in rules if name not in known]
    if unknown:
        raise ParameterError(f"{unknown[0]} is not known here; the rules are {', '.join(sorted(known))}")
    return OutcomeRules(**rules)


def config_of(provenance: Mapping[str, Any]) -> SimulationConfig:
    """Make the description that repeats a run from its `provenance`.

    Raises
    ------
    UnsupportedError
        If descriptions do not support the model or base motion of the run.
    """
    refuse_own_classes(provenance)
    return SimulationConfig.parse({name: value for name, value in with_places(provenance).items() if name != "version"})


def refuse_own_classes(provenance: Mapping[str, Any]) -> None:
    """Raise UnsupportedError if descriptions do not support the model or base motion of a run."""
    for name in ("model", "motion"):
        if provenance[name].get("kind") == "other":
            if "record" in provenance[name]:
                raise UnsupportedError(
                    f"the run was under the record {provenance[name]['record']!r}, made from samples that are not "
                    f"kept. Write the record to a file (sb.records.write_at2) and read it to repeat such a run."
                )
            raise UnsupportedError(
                f"the run used a {name} of its own, of which only the repr is kept: {provenance[name]['repr']}"
            )
