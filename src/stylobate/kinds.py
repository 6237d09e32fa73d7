"""Kinds of models and base motions: a name and the place of a class or constructor, imported at first use.

The kind of a user's own class is its place: "file.py:Class" or "package.module:Class".
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
"""Name under which a module that was loaded from a user's file holds the path of that file."""


class Place(str):
    """The place of a user's own class that may be loaded, because it comes from a file or a result of the user.

    Other text in the form of a place, such as text in a network request, is an unknown kind.
    """

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Kinds(Mapping[str, Callable[..., Any]]):
    """The kinds of `what` by name: subclasses of the class at the place `base`, or named constructors.

    Parameters
    ----------
    what
        Noun in messages: "model" or "motion".
    base
        Place of the base class of all kinds.
    places
        Places of the package's kinds, by name.
    """

    what: str
    base: str
    places: Mapping[str, str]

    def __getitem__(self, kind: str) -> Callable[..., Any]:
        """Return the class or constructor of a kind: the package's by name, a user's own by its `Place`."""
        if not isinstance(kind, Place):
            found: Callable[..., Any] = loaded(self.places[kind])
            return found
        found = loaded(kind)
        owner = getattr(found, "__self__", found)
        if isinstance(owner, type) and issubclass(owner, loaded(self.base)):
            return found
        base = loaded(self.base).__name__
        raise ParameterError(f"{self.what}.kind: no {self.what} (got {str(kind)!r}). Name a subclass of {base}.")

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the package's kinds."""
        return iter(self.places)

    def __len__(self) -> int:
        """Return the number of the package's kinds."""
        return len(self.places)

    def __contains__(self, kind: object) -> bool:
        """Return whether the package has this kind."""
        return kind in self.places

    def name_of(self, make: Callable[..., Any]) -> str:
        """Return the kind that `make` makes: a name, or the place of a user's own class; "" for none."""
        place = place_of(make)
        return next((name for name, one in self.places.items() if one == place), place)


def place_of(make: Callable[..., Any]) -> str:
    """Return the place from which `make` can be loaded; "" for a definition in a function or a notebook."""
    module = sys.modules.get(make.__module__)
    if module is None or make.__module__ == "__main__":
        return ""
    found: Any = module
    for name in make.__qualname__.split("."):
        found = getattr(found, name, None)
    return f"{getattr(module, _FILE, make.__module__)}:{make.__qualname__}" if found == make else ""


def loaded(place: str) -> Any:
    """Import the object at "package.module:Name" or "path/to/file.py:Name".

    Raises
    ------
    ParameterError
        If there is no such object, or its file cannot be run.
    """
    where, _, names = place.rpartition(":")
    try:
        found: Any = _module_of_file(Path(where)) if where.endswith(".py") else import_module(where)
        for name in names.split("."):
            found = getattr(found, name)
    except Exception as error:
        raise ParameterError(
            f"kind: cannot load {str(place)!r} (got {type(error).__name__}: {error}). "
            "Write file.py:Class or package.module:Class."
        ) from error
    return found


def with_places(values: Any, folder: Path | None = None) -> Any:
    """Mark the kinds in plain values that are places as loadable; paths of files are relative to `folder`."""
    if isinstance(values, list):
        return [with_places(one, folder) for one in values]
    if not isinstance(values, Mapping):
        return values
    return {
        name: _placed(one, folder) if name == "kind" and isinstance(one, str) else with_places(one, folder)
        for name, one in values.items()
    }


def names_code(values: Any) -> bool:
    """Return whether a kind in plain values, at any depth, is the place of a user's own class."""
    if isinstance(values, Mapping):
        return ":" in str(values.get("kind", "")) or any(map(names_code, values.values()))
    return isinstance(values, list) and any(map(names_code, values))


def _placed(kind: str, folder: Path | None) -> str:
    where, _, name = kind.rpartition(":")
    if not where:
        return kind
    return Place(f"{((folder or Path()) / where).absolute()}:{name}" if where.endswith(".py") else kind)


def _module_of_file(path: Path) -> ModuleType:
    """Return the module of a file, which runs once per process."""
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
    """Create an object without state of the class at `place`, whose file this process may not have loaded."""
    return object.__new__(loaded(place))
