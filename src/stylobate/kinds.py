"""Kinds of models and base motions: a name and the place of what makes one, imported when it is first used.

A class of the user's own is a kind by its place: "file.py:Class" or "package.module:Class".
"""

import hashlib
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

from stylobate.errors import ParameterError

_FILE = "__stylobate_file__"
"""The name under which a module that was loaded from a file of the user's holds the path of that file."""


class Place(str):
    """The place of a class of the user's own, which may be loaded: it stands in a file or a result of the user's.

    Any other text that has the form of a place, such as one in a request over the network, is a kind that is not known.
    """

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Kinds(Mapping[str, Callable[..., Any]]):
    """The kinds of `what`: classes below the one at the place `base`, or named constructors, by name.

    Parameters
    ----------
    what
        In words: "model" or "motion".
    base
        The place of the class below which all kinds are.
    places
        Of the kinds of the package, by name.
    """

    what: str
    base: str
    places: Mapping[str, str]

    def __getitem__(self, kind: str) -> Callable[..., Any]:
        """Return what makes this kind: one of the package by name, or a class of the user's own by its `Place`."""
        if not isinstance(kind, Place):
            found: Callable[..., Any] = loaded(self.places[kind])
            return found
        found = loaded(kind)
        owner = getattr(found, "__self__", found)
        if isinstance(owner, type) and issubclass(owner, loaded(self.base)):
            return found
        base = loaded(self.base).__name__
        message = f"{self.what}.kind: no {self.what} (got {str(kind)!r}). Name a subclass of {base}."
        raise ParameterError(message)

    def __iter__(self) -> Iterator[str]:
        """Return the names of the package's kinds."""
        return iter(self.places)

    def __len__(self) -> int:
        """Return how many kinds the package has."""
        return len(self.places)

    def __contains__(self, kind: object) -> bool:
        """Return whether the package has this kind."""
        return kind in self.places

    def name_of(self, make: Callable[..., Any]) -> str:
        """Return the kind that is made by `make`: the name, or the place of a class of the user's own; "" for none."""
        place = place_of(make)
        return next((name for name, one in self.places.items() if one == place), place)


def place_of(make: Callable[..., Any]) -> str:
    """Return the place from which `make` can be loaded; "" for none, as of what a function or a notebook defines."""
    module = sys.modules.get(make.__module__)
    if module is None or make.__module__ == "__main__":
        return ""
    found: Any = module
    for name in make.__qualname__.split("."):
        found = getattr(found, name, None)
    return f"{getattr(module, _FILE, make.__module__)}:{make.__qualname__}" if found == make else ""


def loaded(place: str) -> Any:
    """Return what stands at "package.module:Name" or "path/to/file.py:Name".

    Raises
    ------
    ParameterError
        If there is nothing, or its file cannot be run.
    """
    where, _, names = place.rpartition(":")
    try:
        found: Any = _module_of_file(Path(where)) if where.endswith(".py") else import_module(where)
        for name in names.split("."):
            found = getattr(found, name)
    except Exception as error:
        message = (
            f"kind: cannot load {str(place)!r} (got {type(error).__name__}: {error}). "
            "Write file.py:Class or package.module:Class."
        )
        raise ParameterError(message) from error
    return found


def with_places(values: Any, folder: Path | None = None) -> Any:
    """Return plain values in which kinds that are places may be loaded; files are found from `folder` on."""
    if isinstance(values, list):
        return [with_places(one, folder) for one in values]
    if not isinstance(values, Mapping):
        return values
    return {
        name: _placed(one, folder) if name == "kind" and isinstance(one, str) else with_places(one, folder)
        for name, one in values.items()
    }


def names_code(values: Any) -> bool:
    """Return whether a kind in plain values, at any depth, is the place of a class of the user's own."""
    if isinstance(values, Mapping):
        return ":" in str(values.get("kind", "")) or any(map(names_code, values.values()))
    return isinstance(values, list) and any(map(names_code, values))


def _placed(kind: str, folder: Path | None) -> str:
    where, _, name = kind.rpartition(":")
    if not where:
        return kind
    return Place(f"{((folder or Path()) / where).absolute()}:{name}" if where.endswith(".py") else kind)


def _module_of_file(path: Path) -> ModuleType:
    """Return the module in a file, which is run once in a process."""
    path = path.absolute()
    name = f"_stylobate_{hashlib.sha256(str(path).encode()).hexdigest()[:16]}"
    if name not in sys.modules:
        spec = spec_from_file_location(name, path)
        assert spec is not None
        assert spec.loader is not None
        module = module_from_spec(spec)
        setattr(module, _FILE, str(path))
        sys.modules[name] = module  # dataclasses and pickle look the module up by its name
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


def new_of(place: str) -> Any:
    """Return a value without a state of the class at `place`, in a process that may not have loaded its file."""
    return object.__new__(loaded(place))
