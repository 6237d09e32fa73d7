"""Options on a command line, with a record of the options that the command has used."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from stylobate.cli.declarations import MAX_NAMED_KINDS, Option, listed, written
from stylobate.cli.own_classes import Chosen
from stylobate.errors import ConfigError

if TYPE_CHECKING:
    import typer

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
    """

    command: str
    by_name: Mapping[str, Any]
    flags: Mapping[str, str]
    declared: Mapping[str, Option] = field(default_factory=dict)
    chosen: Chosen = field(default_factory=Chosen)
    with_units: Mapping[str, Any] = field(default_factory=dict)
    _used: set[str] = field(default_factory=lambda: set(_USED_BY_ALL))

    @classmethod
    def of(
        cls,
        context: "typer.Context",
        command: str,
        values: Mapping[str, Any],
        declared: Mapping[str, Option],
        chosen: Chosen,
        with_units: Mapping[str, Any],
    ) -> Self:
        """Join the `values` that a command is called with and the flags on the command line."""
        flags = {
            str(option.name): option.opts[0]
            for option in context.command.params
            if getattr(context.get_parameter_source(str(option.name)), "name", "") == "COMMANDLINE"
        }
        return cls(command, values, flags, declared, chosen, with_units)

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
