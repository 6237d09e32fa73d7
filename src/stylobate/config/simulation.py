"""Describe one run, or the case that many runs share: from TOML, from the command line, or from a saved result."""

import math
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import islice
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from stylobate.base_motions import BaseMotion
from stylobate.config.description import WANTED, Config, built
from stylobate.config.parts import (
    ANY_COLUMN,
    AT_REST,
    DEFAULT_MODEL,
    STEADY_MODEL,
    ColumnConfig,
    ModelConfig,
    MotionConfig,
    SteadyModelConfig,
    described_model,
    is_dimensionless,
    is_to_end,
    made_by,
    moves,
)
from stylobate.config.records import RecordMotion, anchored
from stylobate.errors import ConfigError, FileError, ParameterError, UnsupportedError
from stylobate.kinds import with_places
from stylobate.models import Model
from stylobate.parameter_quantities import known_names
from stylobate.quantities import Parameter, parameters_of
from stylobate.results import OutcomeRules
from stylobate.run_arguments import SharedByRuns, SingleRun, duration_with_tail, numbers_of, run_numbers
from stylobate.text import did_you_mean
from stylobate.units import has_unit, is_angle, split

DEEPEST = 60
"""Maximum depth of nested tables and lists: each level of a motion takes several calls, and Python allows 1000."""

# Keys whose word chooses one of several descriptions.
_CHOOSING = ("kind", "shape", "method")
_SHOWN, _LONGEST = 4, 60


def check_file_values(values: Mapping[str, Any]) -> None:
    """Raise ConfigError for values that no description can have, with one line for each mistake."""
    problems = list(islice(_problems(values), _SHOWN))
    if problems:
        raise ConfigError(problems)


def _problems(values: Mapping[str, Any]) -> Iterator[str]:
    waiting: list[tuple[str, str, Any, int]] = [("", "", values, 0)]
    while waiting:
        place, key, value, depth = waiting.pop()
        shown = repr(place[:_LONGEST])[1:-1]
        if depth > DEEPEST:
            yield f"{shown}…: nested too deeply (got more than {DEEPEST} levels). Describe it with fewer."
            return
        if "\0" in key or (isinstance(value, str) and "\0" in value):
            yield f"{shown}: holds a NUL character (got {(key if chr(0) in key else value)[:_LONGEST]!r}). Remove it."
        elif key in _CHOOSING and not isinstance(value, str):
            yield f"{shown}: must be a word (got {_short(value)}). Write it in quotation marks."
        members = value.items() if isinstance(value, Mapping) else enumerate(value) if isinstance(value, list) else ()
        waiting += [
            (f"{place}.{name}" if place else str(name), str(name), one, depth + 1) for name, one in reversed([*members])
        ]


def _short(value: Any) -> str:
    if isinstance(value, Mapping):
        return "a table"
    return "a list" if isinstance(value, list) else repr(value)[:_LONGEST]


def fields_of(group: Any, *required: str) -> Any:
    """Make a base of a description that has the numbers of a group, with their defaults; those `required` have none."""
    declared = numbers_of(group)
    annotations = {name: Annotated[_kind(one), one.quantity] for name, one in declared.items()}
    defaults = {name: one.default for name, one in declared.items() if not (one.required or name in required)}
    return type(group.__name__, (), {"__annotations__": annotations, **defaults})


def _kind(number: Parameter) -> Any:
    components = number.quantity.components
    return tuple[(float,) * components] if components > 1 else number.annotation  # type: ignore[misc]


def problems_of_the_numbers(values: object) -> list[str]:
    """Check the numbers of a run that `values` has as attributes; return one line for each invalid number."""
    problems: list[str] = []
    for name, parameter in run_numbers().items():
        value = getattr(values, name, None)
        if value is None:
            continue
        try:
            parameter.checked(value)
        except ParameterError as error:
            problems.append(str(error))
    return problems


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


class CaseConfig(OneColumn):
    """The case of a run: `column`, `model` and `motion`."""

    column: ColumnConfig
    model: ModelConfig = described_model(DEFAULT_MODEL)
    motion: MotionConfig = AT_REST


class SteadyCase(CaseConfig):
    """The case of steady rolling, whose closed forms are those of the slender model; its base moves."""

    model: SteadyModelConfig = described_model(STEADY_MODEL)
    motion: MotionConfig


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


class SimulationConfig(fields_of(SingleRun, "duration"), CaseConfig):  # type: ignore[misc]
    """A run: `column`, `model`, `motion` and the arguments of `simulate`, with the same names.

    Under a base motion that ends or has a period the duration is optional; the default is that of `simulate`.

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
        return super().parse(with_default_duration(own, optional=moves))

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
        if self.duration is None and 0.0 < motion.duration < math.inf:
            options["duration"] = duration_with_tail(motion.duration, model.column.frequency_parameter)
        elif self.duration is None and (motion.duration == 0.0 or motion.period is None):
            raise ConfigError([f"duration is missing{WANTED['duration']}"])
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


def with_default_duration(
    values: Mapping[str, Any], *, optional: Callable[[object], bool] = is_to_end
) -> dict[str, Any]:
    """Return `values` with `duration` None if it is missing and `optional` for the motion, else without `duration`."""
    if values.get("duration") is not None:
        return dict(values)
    others = {name: value for name, value in values.items() if name != "duration"}
    return others | ({"duration": None} if optional(values.get("motion")) else {})


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
    stated = {name: one for name, one in with_places(provenance).items() if name not in ("version", "processor")}
    return SimulationConfig.parse(stated)


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


class ManyRuns(fields_of(SharedByRuns), CaseConfig):  # type: ignore[misc]
    """The case that all runs share, with the argument names of `simulate_ensemble`.

    Parameters
    ----------
    column, model, motion
        Column, model and base motion.
    demands
        Whether to report the contact demand of each run.
    recheck
        Whether to repeat runs whose outcome rounding or the rest threshold could alter.
    rules
        Numbers of `OutcomeRules`, by name.
    """

    demands: bool = False
    recheck: bool = False
    rules: dict[str, float] = Field(default_factory=dict)

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`; those of other commands are ignored."""
        of_others = {*OF_OTHER_COMMANDS, *numbers_of(SingleRun)} - set(cls.model_fields)
        return super().parse({name: value for name, value in values.items() if name not in of_others})

    def values(self) -> dict[str, Any]:
        """Return the description as plain values for JSON and TOML, without keys that are None."""
        return self.model_dump(mode="json", exclude_none=True, by_alias=True)

    def common(self, problems: list[str], varying: Sequence[str] = ()) -> tuple[Model, BaseMotion, dict[str, Any]]:
        """Build model, motion and the arguments that all runs share, except those `varying`.

        Raises
        ------
        ConfigError
            With one line for each invalid part, and the `problems` known before.
        """
        problems += problems_of_the_numbers(self)
        rules = built("rules", lambda: built_rules(self.rules), problems)
        model, motion = built_parts(self.column, self.model, self.motion, problems)
        options = {name: getattr(self, name) for name in _SHARED} | {"rules": rules or OutcomeRules()}
        if self._lasts_as_its_motion(varying):
            options["duration"] = duration_with_tail(motion.duration, model.column.frequency_parameter)
        return model, motion, options

    def problems_of_the_length(self, names: tuple[str, ...]) -> list[str]:
        """Return a line unless one of `duration` and `periods` is given, or a duration among the `names` that vary.

        A motion that ends needs no duration: see `SimulationConfig`.
        """
        if self._lasts_as_its_motion(names):
            return []
        given = [name for name in ("duration", "periods") if getattr(self, name) is not None]
        given += ["a duration that varies"] if "duration" in names else []
        if len(given) == 1:
            return []
        got = " and ".join(given) or "none of them"
        return [f"duration [s], periods or a duration that varies is needed, one of them; got {got}"]

    def _lasts_as_its_motion(self, names: Sequence[str]) -> bool:
        open_end = self.duration is None and self.periods is None and "duration" not in names
        return open_end and is_to_end(self.motion)


# Values of numbers that vary, by unit.
_STAND_INS = {"m": 1e-3}

_SHARED = (*numbers_of(SharedByRuns), "demands", "recheck")


def with_numbers_that_vary(values: Mapping[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    """Return `values` with a number for each missing required number of the motion that varies over the runs.

    Raises
    ------
    ConfigError
        If a required number of the motion is missing, and a name that varies is unknown: it may be misspelt.
    """
    motion = values.get("motion")
    if not isinstance(motion, Mapping) or (make := made_by(motion.get("kind"))) is None:
        return dict(values)
    declared = parameters_of(make)
    missing = [name for name, one in declared.items() if one.required and name not in motion and name not in names]
    if missing and not _has_own_class(values.get("model")):
        problems = [
            _unknown(name, missing) for name in names if name and name not in known_names() and name not in declared
        ]
        if problems:
            raise ConfigError(problems)
    # If the motion has a path or a velocity, the acceleration depends on the frequency, which is then required.
    by_path = any(one.quantity.unit in ("m", "m/s") for one in declared.values())
    needed = [name for name in names if name in declared and declared[name].required]
    # With an amplitude of 1 m/s² scaling to an acceleration is exact; no base moves by 1 m.
    needed = [name for name in needed if not (by_path and name == "angular_frequency")]
    given = {name: _STAND_INS.get(declared[name].quantity.unit, 1.0) for name in needed}
    return {**values, "motion": {**given, **values["motion"]}}


def _has_own_class(model: object) -> bool:
    return isinstance(model, Mapping) and ":" in str(model.get("kind"))


def _unknown(name: str, missing: Sequence[str]) -> str:
    """Return the line on an unknown name in place of a number of the motion that is `missing`."""
    remedy = did_you_mean(name, known_names()) or f"the base motion needs {' and '.join(missing)}"
    return f"{name} is not known here; {remedy}"


def common_values(provenance: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values that all runs of a saved sweep shared, from its `provenance`.

    Raises
    ------
    UnsupportedError
        If descriptions do not support the model or base motion of the sweep.
    """
    refuse_own_classes(provenance)
    known = ("column", "model", "motion", "rules", *_SHARED, "end_converged")
    return {name: with_places(provenance[name]) for name in known if provenance.get(name) is not None}


def name_of(axis: object) -> str:
    """Return the name in the plain values of an axis, as in Python; "" without a name."""
    name = axis.get("name") if isinstance(axis, Mapping) else None
    return name.replace("-", "_") if isinstance(name, str) else ""


def refuse_design(provenance: Mapping[str, Any], *known: str) -> Mapping[str, Any]:
    """Return the design of a saved sweep, or raise ParameterError if its kind is not among those `known`."""
    design: Mapping[str, Any] = provenance.get("design") or {"kind": "ensemble"}
    if design["kind"] not in known:
        raise ParameterError(
            f"the runs belong to a design {design['kind']!r}; only {' and '.join(known)} can be repeated"
        )
    return design
