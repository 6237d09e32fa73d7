"""Load models and base motions of a user's own by their place: `mine.py:Tethered` or `mypackage.module:Tethered`."""

import importlib
import importlib.util
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from stylobate.errors import ParameterError, StylobateError

_S = TypeVar("_S")


@dataclass(frozen=True, slots=True)
class Chosen:
    """The kinds that a command line and its file choose.

    Parameters
    ----------
    kinds
        By part, "model" or "motion"; a part whose kind is not chosen is missing.
    classes
        The classes of a user's own among them, by part.
    """

    kinds: Mapping[str, str] = field(default_factory=dict)
    classes: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, kinds: Mapping[str, str], folder: Path = Path()) -> "Chosen":
        """Load the classes among these kinds; their files are relative to `folder`.

        Raises
        ------
        ParameterError
            If a place holds no such class.
        """
        return cls(kinds, {part: load(kind, part, folder) for part, kind in kinds.items() if ":" in kind})

    def setup(self, config: Any, values: Mapping[str, Any]) -> Any:
        """Build the objects that the `values` of a configuration of this class describe."""
        return self.with_own_parts(config.parse(self.with_stand_ins(values)).build(), values)

    def with_stand_ins(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values of a configuration with a kind of the package for each class of the user's own."""
        return {**values, **{part: dict(_STAND_INS[part]) for part in self.classes}}

    def with_own_parts(self, setup: _S, values: Mapping[str, Any]) -> _S:
        """Return a setup with the user's own model or base motion in place of the stand-ins.

        Raises
        ------
        ParameterError
            If the class refuses the numbers.
        """
        for part, make in self.classes.items():
            numbers = {name: value for name, value in values.get(part, {}).items() if name != "kind"}
            column = (setup.model.column,) if part == "model" else ()  # type: ignore[attr-defined]
            try:
                setup = replace(setup, **{part: make(*column, **numbers)})  # type: ignore[type-var]
            except (TypeError, ParameterError) as error:
                message = f"{part}: {error}"
                raise ParameterError(message) from None
        return setup


_STAND_INS = {"model": {"kind": "slender"}, "motion": {"kind": "rest"}}


def load(place: str, part: str, folder: Path = Path()) -> Any:
    """Load the class at a place.

    Raises
    ------
    ParameterError
        If the file, the module or the class is missing, or it is another kind of class.
    """
    where, _, name = place.rpartition(":")
    try:
        module = _of_file(folder / where) if where.endswith(".py") else importlib.import_module(where)
    except StylobateError:
        raise
    except Exception as error:  # noqa: BLE001  a user's code raises anything
        message = f"--{part}: {where} cannot be imported ({type(error).__name__}: {error}). Correct it, or the place."
        raise ParameterError(message) from None
    named = getattr(module, name, None)
    if not (isinstance(named, type) and issubclass(named, _base(part))):
        message = f"--{part}: no class of a {part} (got {place!r}). Name it as FILE.py:CLASS or MODULE:CLASS."
        raise ParameterError(message)
    return named


def _of_file(path: Path) -> ModuleType:
    """Import a file once; classes of a file that is loaded twice would differ."""
    name = f"stylobate_own_{path.stem}_{abs(hash(path.resolve()))}"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, path)
        if spec is None or spec.loader is None or not path.is_file():
            raise FileNotFoundError(2, "No such file", str(path))
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


def _base(part: str) -> type:
    if part == "model":
        from stylobate.models import Model  # noqa: PLC0415

        return Model
    from stylobate.base_motions import BaseMotion  # noqa: PLC0415

    return BaseMotion
