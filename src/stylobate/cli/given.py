"""The options given on a command line, and which of them the command has used."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import wraps
from typing import Any, Self

import typer

from stylobate.errors import ConfigError

# Every command reads its source and prints its result.
_USED_BY_ALL = ("source", "as_json")

_VALUES = "stylobate.values"


def with_values(command: Callable[..., None]) -> Callable[..., None]:
    """Let `Given` read the values that this command is called with.

    The context holds them too, but not as the command gets them in every version of typer: paths are texts there.
    """

    @wraps(command)
    def called(**values: Any) -> None:
        if "context" in values:
            values["context"].meta[_VALUES] = {name: value for name, value in values.items() if name != "context"}
        command(**values)

    return called


@dataclass(frozen=True, slots=True)
class Given(Mapping[str, Any]):
    """All options of a command by name; to read the value of an option is to use the option.

    Parameters
    ----------
    command
        Name of the command.
    options
        Values by name, the default of each option that is not given.
    flags
        How each option that is given is written, by name.
    """

    command: str
    options: Mapping[str, Any]
    flags: Mapping[str, str]
    _used: set[str] = field(default_factory=lambda: set(_USED_BY_ALL))

    @classmethod
    def of(cls, context: typer.Context) -> Self:
        """Return the options of the command, made by `with_values`, that runs in this `context`."""
        flags = {
            str(option.name): option.opts[0]
            for option in context.command.params
            if getattr(context.get_parameter_source(str(option.name)), "name", "") == "COMMANDLINE"
        }
        return cls(str(context.info_name), context.meta[_VALUES], flags)

    def __getitem__(self, name: str) -> Any:
        """Return the value of an option, which is used then."""
        value = self.options[name]
        self._used.add(name)
        return value

    def __iter__(self) -> Iterator[str]:
        """Return an iterator over the names of all options."""
        return iter(self.options)

    def __len__(self) -> int:
        """Return how many options the command has."""
        return len(self.options)

    def use(self, *names: str) -> None:
        """Note that the command uses the options of these names."""
        self._used.update(names)

    def without(self, *names: str) -> Self:
        """Return the options but for these; what is used here is used there."""
        return replace(self, options={name: value for name, value in self.options.items() if name not in names})

    def refuse_unused(self, because: str = "") -> None:
        """Refuse the options that are given and that nothing has used: no option is dropped without a word.

        Raises
        ------
        ConfigError
            With one line for each of them.
        """
        unused = [name for name in self.flags if name not in self._used]
        if unused:
            raise ConfigError([self._refusal(name, because) for name in unused])

    def _refusal(self, name: str, because: str) -> str:
        from stylobate.config.models import kinds_with  # noqa: PLC0415  heavy imports wait until they are needed

        got = f"(got {self.options[name]!r})" if isinstance(self.options[name], (bool, int, float, str)) else ""
        flag = f"{self.flags[name]}:"
        kinds = " or ".join(kind.replace("_", "-") for kind in kinds_with(name))
        if kinds and not because:
            return f"{flag} only model {kinds} uses it in {self.command} {got}".rstrip() + (
                f". Choose --model {kinds}, or leave it out."
            )
        return f"{flag} {self.command} does not use it{because and ' ' + because} {got}".rstrip() + ". Leave it out."
