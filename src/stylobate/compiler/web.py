"""Modules of WebAssembly: LLVM's object code with its functions exported.

An object file of one module is a module of WebAssembly already: its functions have their final numbers, and its
constant tables lie at the beginning of the memory. It lacks exports, and has sections for linkers. A page supplies
memory, a pointer into it for the stack, and the mathematical functions that it imports, all under the name "env".

Sections and symbols: WebAssembly core specification 2.0, section 5.5; conventions of LLVM's "Linking.md".
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from stylobate.errors import UnsupportedError

_HEADER = b"\0asm\x01\0\0\0"
_CUSTOM, _IMPORT, _EXPORT, _CODE, _DATA, _DATA_COUNT = 0, 2, 7, 10, 11, 12
_SYMBOLS, _FUNCTION = 8, 0
# Flags of a symbol: not defined here, and with a name all the same.
_UNDEFINED, _NAMED = 0x10, 0x40


class Section(NamedTuple):
    """A section of a module: its number and its content."""

    number: int
    content: bytes


def module_of(code: bytes, exports: Sequence[str]) -> bytes:
    """Return the module of an object file that exports these functions.

    Raises
    ------
    UnsupportedError
        If a constant of the object file is an address, or no function has a name in `exports`.
    """
    sections = list(_sections(code))
    if any(section.number == _CUSTOM and _Reader(section.content).text() == "reloc.DATA" for section in sections):
        raise UnsupportedError("code whose constants hold addresses needs a linker")
    defined = _functions(sections)
    if missing := [name for name in exports if name not in defined]:
        raise UnsupportedError(
            f"exports: must be functions of the code (got {missing[0]!r}). Choose of {sorted(defined)}."
        )
    entries = b"".join(_text(name) + bytes([_FUNCTION]) + _number(defined[name]) for name in exports)
    exported = Section(_EXPORT, _number(len(exports)) + entries)
    kept = [section for section in sections if section.number != _CUSTOM] + [exported]
    kept.sort(key=lambda section: _CODE - 0.5 if section.number == _DATA_COUNT else section.number)
    return _HEADER + b"".join(bytes([number]) + _number(len(content)) + content for number, content in kept)


def imports_of(module: bytes) -> list[str]:
    """Return the names of the functions that a module imports."""
    reader = _Reader(next(section.content for section in _sections(module) if section.number == _IMPORT))
    names = []
    for _ in range(reader.number()):
        reader.text()
        name, kind = reader.text(), reader.byte()
        match kind:
            case 0:  # a function, by the number of its type
                names.append(name)
                reader.number()
            case 2:  # memory, with its limits
                limits = reader.byte()
                for _ in range(1 + (limits & 1)):
                    reader.number()
            case 3:  # a global, with its type and whether it changes
                reader.byte()
                reader.byte()
            case _:
                raise UnsupportedError(f"a module that imports a table cannot be read (got {name!r})")
    return names


def _sections(module: bytes) -> Iterator[Section]:
    reader = _Reader(module[len(_HEADER) :])
    while reader.left():
        number = reader.byte()
        yield Section(number, reader.take(reader.number()))


def _functions(sections: Sequence[Section]) -> dict[str, int]:
    """Return the numbers of the functions that an object file defines, by name."""
    found: dict[str, int] = {}
    for section in sections:
        reader = _Reader(section.content)
        if section.number != _CUSTOM or reader.text() != "linking":
            continue
        reader.number()  # version
        while reader.left():
            kind, content = reader.byte(), reader.take(reader.number())
            if kind == _SYMBOLS:
                found |= dict(_symbols(_Reader(content)))
    return found


def _symbols(reader: "_Reader") -> Iterator[tuple[str, int]]:
    """Yield names and numbers of the functions of a symbol table that are defined."""
    for _ in range(reader.number()):
        kind, flags = reader.byte(), reader.number()
        defined = not flags & _UNDEFINED
        match kind:
            case 1:  # data: segment, offset and size
                reader.text()
                for _ in range(3 if defined else 0):
                    reader.number()
            case 3:  # a section
                reader.number()
            case _:
                number = reader.number()
                name = reader.text() if defined or flags & _NAMED else ""
                if kind == _FUNCTION and defined:
                    yield name, number


class _Reader:
    """Bytes that are read from the start."""

    def __init__(self, content: bytes) -> None:
        self._content, self._place = content, 0

    def left(self) -> bool:
        return self._place < len(self._content)

    def take(self, count: int) -> bytes:
        taken = self._content[self._place : self._place + count]
        self._place += count
        return taken

    def byte(self) -> int:
        return self.take(1)[0]

    def number(self) -> int:
        """Read an unsigned number in groups of seven bits, the lowest first."""
        value, shift = 0, 0
        while True:
            group = self.byte()
            value |= (group & 0x7F) << shift
            if group < 0x80:  # noqa: PLR2004  the last group
                return value
            shift += 7

    def text(self) -> str:
        return self.take(self.number()).decode("utf-8")


def _number(value: int) -> bytes:
    groups = []
    while True:
        value, group = value >> 7, value & 0x7F
        groups.append(group | (0x80 if value else 0))
        if not value:
            return bytes(groups)


def _text(text: str) -> bytes:
    encoded = text.encode("utf-8")
    return _number(len(encoded)) + encoded
