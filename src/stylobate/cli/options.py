"""Options on a command line: those that the command has used, and how they override the values of a file."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from stylobate import config, results, studies
from stylobate.config.options import (
    MAX_NAMED_KINDS,
    PARTS,
    Chosen,
    Option,
    Part,
    kinds_in_files,
    listed,
    written,
)
from stylobate.errors import ConfigError, FileError, ParameterError
from stylobate.quantities import parameters_of

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo


# Every command reads its source and prints its result.
_USED_BY_ALL = ("source", "as_json")


@dataclass(frozen=True, slots=True)
class Options(Mapping[str, Any]):
    """All options of a command by name; reading the value of an option marks it as used.

    Parameters
    ----------
    command
        Name of the command.
    by_name
        The value of each option; the default of each option that is not stated.
    flags
        The flag of each stated option as the user wrote it, by name.
    declared
        The declarations of all options, by name.
    chosen
        The kinds that the command line and its file choose.
    with_units
        The texts of the options that were stated with a unit, by name.
    files
        The values of the TOML file on the command line, as they stand there; empty without one that can be read.
    """

    command: str
    by_name: Mapping[str, Any]
    flags: Mapping[str, str]
    declared: Mapping[str, Option] = field(default_factory=dict)
    chosen: Chosen = field(default_factory=Chosen)
    with_units: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[Path, Mapping[str, Any]] = field(default_factory=dict)
    _used: set[str] = field(default_factory=lambda: set(_USED_BY_ALL))

    def __getitem__(self, name: str) -> Any:
        """Return the value of an option and mark the option as used."""
        value = self.by_name[name]
        self._used.add(name)
        return value

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of all options."""
        return iter(self.by_name)

    def __len__(self) -> int:
        """Count the options."""
        return len(self.by_name)

    def stated(self, part: str) -> list[Option]:
        """List the options of a part of the configuration, such as "model", that have a value."""
        declared = (one for one in self.declared.values() if one.part == part)
        return [one for one in declared if self.by_name.get(one.name) is not None]

    def pick(self, *names: str) -> dict[str, Any]:
        """Return the values of the options of these names for a configuration, without options that have no value.

        A number with a unit stays the text that it is: configurations read such texts too.
        """
        return {name: self.with_units.get(name, self[name]) for name in names if self.by_name.get(name) is not None}

    def use(self, *names: str) -> None:
        """Mark the options of these names as used."""
        self._used.update(names)

    def without(self, *names: str) -> Self:
        """Return the options without these; both objects share the record of used options."""
        return replace(self, by_name={name: value for name, value in self.by_name.items() if name not in names})

    def refuse_unused(self, because: str = "") -> None:
        """Raise ConfigError with one line for each stated option that the command has not used."""
        unused = [name for name in self.flags if name not in self._used]
        if unused:
            reason = because and f" {because}"
            raise ConfigError([self.refusal(name, f"{self.command} does not use it{reason}") for name in unused])

    def refusal(self, name: str, problem: str, remedy: str = "Remove it.") -> str:
        """Write the error line for an option."""
        self._used.add(name)
        value = self.by_name[name]
        got = " ".join(map(str, value)) if isinstance(value, (tuple, list)) else repr(value)
        got = "" if isinstance(value, Path) else f" (got {got})"
        return f"{self.flags.get(name, name)}: {problem}{got}. {remedy}"

    def refusal_by_kind(self, option: Option, noun: str, kind: str) -> str:
        """Write the error line for a number that this kind of column, model or motion does not have."""
        chooser = next((one for one in self.declared.values() if one.part == option.part and one.number in _TAGS), None)
        offered = [one for one in option.kinds if chooser and one in chooser.kinds][:MAX_NAMED_KINDS]
        remedy = f"Remove it, or choose --{written(chooser.name)} {listed(offered)}." if chooser and offered else ""
        if option.number == "diameter" and "radius" in self.declared:
            remedy = f"{remedy.removesuffix('.')}. A column has --radius, half of its diameter.".lstrip(". ")
        return self.refusal(option.name, f"{noun} {written(kind)!r} does not use it", remedy or "Remove it.")


# The keys that choose a kind.
_TAGS = ("shape", "kind")
# The numbers that may be names of files.
_FILES = ("profile",)


def read_source(options: Options, source: Path | None = None) -> dict[str, Any]:
    """Read the plain values of a description, or of a saved run or verdict (.nc) to repeat it; none without a source.

    Parameters
    ----------
    options
        Options of the command.
    source
        The file; by default that of the options.

    Raises
    ------
    FileError
        If the file is missing, or is neither a description nor a saved run or verdict.

    Notes
    -----
    `relocated` finds records that were moved together with a saved run.
    """
    source = options["source"] if source is None else source
    if source is None:
        return {}
    if not source.is_file():
        raise FileError(f"cannot read {source}: No such file or directory")
    if source.suffix == ".nc":
        from stylobate.config.records import relocated

        saved = studies.load(source)
        loaded = saved if isinstance(saved, results.Verdict) else results.Run.load(source)
        return config.config_of(relocated(loaded.provenance, source.parent)).values()
    return config.read_config(source, options.files.get(source))


_TABLES = ("column", "model", "motion", "records")


def overlay(values: Mapping[str, Any], options: Options, fields: "Mapping[str, FieldInfo]") -> dict[str, Any]:
    """Override the values of a file by the options.

    Parameters
    ----------
    values
        Values from a TOML file, or empty.
    options
        All options of the command.
    fields
        Fields of the configuration; other options of the run are ignored.

    Raises
    ------
    ConfigError
        With one line for each option that the chosen column shape, model or base motion does not use.
    """
    result, problems = dict(values), list[str]()
    of_parts = {*_column(result, options, problems), *_model(result, options, fields, problems)}
    of_parts |= {*_motion(result, options, problems)}
    if problems:
        raise ConfigError(problems)
    chosen = options.pick(*(name for name in fields if name not in (*_TABLES, *of_parts)))
    for name, other in (("duration", "periods"), ("periods", "duration")):
        if name in chosen and other not in chosen:
            result.pop(other, None)  # either states the duration
    return result | chosen


def merge(values: dict[str, Any], name: str, options: Mapping[str, Any], tag: str = "") -> None:
    """Override the table `name` of `values` by options; another kind, at the key `tag`, replaces the table."""
    table = values.get(name, {})
    if not isinstance(table, Mapping):
        return
    replaced = tag in options and options[tag] != table.get(tag)
    merged = dict(options) if replaced else {**table, **options}
    if merged or name in values:
        values[name] = merged


def with_axes(
    values: Mapping[str, Any], options: Options, section: str, places: Iterable[str] = ("x", "y")
) -> dict[str, Any]:
    """Override the axes in the table `section` of `values` by the options of these `places` and of their spacing."""
    result, table = dict(values), values.get(section, {})
    if not isinstance(table, Mapping):
        return result
    table = dict(table)
    for place in places:
        if options[place] is not None:  # scales have no name
            table[place] = dict(zip(("number", "to", "from", "name"), reversed(options[place]), strict=False))
        axis, spacing = table.get(place), options.by_name[f"{place}_spacing"]
        if isinstance(axis, Mapping) and "values" not in axis and spacing is not None:  # listed values have no spacing
            table[place] = {**axis, "spacing": options[f"{place}_spacing"]}
    return {**result, section: table} if table else result


def _numbers(
    part: Part, kind: str | None, options: Options, problems: list[str], fields: Iterable[str] = ()
) -> tuple[dict[str, Any], list[str]]:
    """Return the stated numbers of a part, and the names of their options.

    An option that this kind does not use adds a line to `problems`, unless a run has a number of that name in its
    `fields`. If the kind is missing or unknown, all numbers are kept, and the configuration reports the mistake.
    """
    numbers, names = dict[str, Any](), list[str]()
    known = kind in part.kinds or part.table in options.chosen.classes
    for option in options.stated(part.table):
        name = option.name
        if option.number == part.tag or (option.kinds == ("record",) and kind in (None, "record")):
            continue
        if kind is None or kind in option.kinds or not known:
            value = options.pick(name)[name]
            is_word = option.type is str and option.number not in _FILES
            numbers[option.number] = value.replace("-", "_") if is_word else value
            names.append(name)
        elif name not in fields:
            problems.append(options.refusal_by_kind(option, part.noun, kind))
    return numbers, names


def _column(values: dict[str, Any], options: Options, problems: list[str]) -> list[str]:
    """Merge the column; options may change the shape of a file only if --shape states it."""
    from stylobate.config.parts import implied_shape

    part, stated = PARTS["column"], options.stated("column")
    if not stated:
        return []
    table = values.get("column")
    implied = implied_shape({one.number: options.by_name[one.name] for one in stated})
    shape = options["shape"]
    if shape is None and isinstance(table, Mapping):
        shape = table.get("shape", implied_shape(table) or "solid")
        if shape == "given" or implied not in (None, shape):
            raise ParameterError(
                f"column: the file describes another shape (got {shape!r}). "
                f"To replace it, add --shape {implied or 'solid'} and all of its numbers."
            )
        values["column"] = {**table, "shape": shape}  # an implied shape is kept
    shape = shape or implied or "solid"
    numbers, names = _numbers(part, shape, options, problems)
    merge(values, "column", {**numbers, "shape": shape}, tag="shape")
    return names


def _model(
    values: dict[str, Any], options: Options, fields: "Mapping[str, FieldInfo]", problems: list[str]
) -> list[str]:
    """Merge the model; a kind that differs from the kind in the file keeps the numbers that both have."""
    part, table = PARTS["model"], values.get("model", {})
    kind = None
    if "model" in options.declared and options.declared["model"].part:
        if options["model"] and isinstance(table, Mapping):
            kind = options.chosen.kinds.get("model", options["model"])
            values["model"] = table = {**_kept(table, kind, options), "kind": kind}
        kind = table.get("kind", fields["model"].default.kind) if isinstance(table, Mapping) else None
    numbers, names = _numbers(part, kind, options, problems, fields)
    merge(values, "model", numbers)
    return names


def _kept(table: Mapping[str, Any], kind: str, options: Options) -> dict[str, Any]:
    own = options.chosen.classes.get("model")
    makers = PARTS["model"].makers()
    make = own if own is not None else makers.get(kind)
    return {name: value for name, value in table.items() if make is None or name in parameters_of(make)}


def _motion(values: dict[str, Any], options: Options, problems: list[str]) -> list[str]:
    """Merge the base motion; a kind that differs from the kind in the file replaces the motion.

    Raises
    ------
    ParameterError
        If no options state its numbers, and the file describes another motion.
    """
    if "motion" not in options.declared:
        return []
    table = values.get("motion")
    before = table.get("kind") if isinstance(table, Mapping) else None
    kind = options.chosen.kinds.get("motion", options["motion"]) if options["motion"] else None
    if kind in kinds_in_files() and before != kind:
        raise ParameterError(
            f"--motion: no options state the numbers of this motion (got {options['motion']}). "
            f'Describe it in a file: [motion], kind = "{kind}".'
        )
    record = _record(table if isinstance(table, Mapping) else {}, options) if kind in (None, "record") else {}
    if kind is None and ("path" in record or "sample" in record):
        kind = "record"
    if kind is None and before != "record" and before is not None:
        record = {}
    numbers, names = _numbers(PARTS["motion"], kind or before, options, problems)
    merge(values, "motion", {**({"kind": kind} if kind else {}), **numbers, **record}, tag="kind")
    return names


def _record(table: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """Return the options of a record; only a record from files can lack a component."""
    if "record" not in options.declared:
        return {}
    stated = options.pick("units", "step", "response", "scale", "rotation", "tail")
    files = [str(path) for path in options["record"] or ()]
    if files:
        stated["path"] = files[0] if len(files) == 1 else files
    if options["sample_record"]:
        stated["sample"] = options["sample_record"]
    if options["record_direction"]:
        stated["directions"] = [_azimuth_or_name(text) for text in options["record_direction"]]
    if files or ("sample" not in stated and "path" in table):
        stated |= options.pick("one_component")
    return stated


def _azimuth_or_name(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
