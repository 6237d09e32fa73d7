"""Tables of objects, one object in each row.

A column of a known name holds a number of the object, in the unit of its heading, such as `radius [mm]`; a column such
as `radius_spread` holds the uncertainty of the number. All other columns are carried through to the ranking. One pass
over headings, columns and cells collects all faults.
"""

import math
import re
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stylobate.aliases import meant_by, order_of, words_of
from stylobate.config.parts import DIAMETERS
from stylobate.config.profile_table import is_table
from stylobate.earthquakes.inventories.faults import Faults
from stylobate.earthquakes.inventories.headings import (
    FRICTION,
    PER_CENT,
    SPREAD,
    WORDS,
    Heading,
    column_numbers,
    misspelt,
    quantities,
    suggestions,
    unread_bracket,
)
from stylobate.earthquakes.inventories.objects import InventoryObject, require_model, unquestioned
from stylobate.earthquakes.inventories.rows import ObjectTable, Row
from stylobate.earthquakes.property_spreads import LognormalSpread, NormalSpread, Spread
from stylobate.errors import ConfigError, ParameterError, UnlikelyInputWarning
from stylobate.quantities import Quantity
from stylobate.text import did_you_mean, shortened
from stylobate.units import UnitError, is_number, read, spelled, split

_DECISIVE = ("damping",)
"""Numbers of models whose default, no loss of energy, no object has."""
_NEEDED = ("name", FRICTION, *_DECISIVE)
_SIZES = (("radius", "diameter"), ("height", "mass_height"), ("density", "mass"))
"""Columns of which each object needs one."""
_EITHER = ("density", "mass")
"""Numbers of which a default does not join the other one."""
_SHAPED = {"shape", "slenderness", "profile"}
"""Columns that imply other numbers than these."""
_SHAPING = {"shape", "profile", "mass_height", "inner_radius", "inner_diameter", "top_radius", "top_diameter"}
"""Numbers and words by which an object is not a solid cylinder, or is meant to be one."""
_ESTIMATES, _OF_ESTIMATES = {"profile", "mass_height"}, {"max_radius", "max_diameter"}
"""Columns without which the others, which many tables have, are of no use: they are then carried through."""
_LARGEST_SPREAD = 2.0
"""A standard deviation of a logarithm above this has most likely another unit."""

_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?(?:\s*[^\d\s,.].*)?")
_THOUSANDS = re.compile(r"\s*[-+]?\d{1,3}(?:,\d{3})+(?:\s*[^\d\s,.].*)?")
_MISSING = re.compile(r"(?P<name>\w+) is missing|density or mass: .*got neither.*")
_TOTALS = {"total", "totals", "sum", "mean", "average", "summe", "gesamt", "totale", "somma", "somme", "moyenne"}


def read_inventory(
    path: str | Path,
    *,
    model: str = "wobbling",
    defaults: Mapping[str, Any] | None = None,
    carry: Collection[str] = (),
) -> tuple[InventoryObject, ...]:
    r"""Read the objects of an inventory from a table, one in each row.

    Columns of these names are read, and of their usual aliases, such as weight for `mass` or Ø for `diameter`; capitals
    and separators do not count. A heading that only resembles a name is a mistake:

    * `name`, needed and different for each object, and `site`.
    * The numbers of a column as in description files: `radius` or `diameter`, `height`, `density` or `mass`,
      `inner_radius`, `mass_height` …, and `shape` if they do not imply it.
    * `profile`: the kind of profile from which moments of inertia are estimated, such as amphora, or the file of a
      drawn profile, relative to the table.
    * The numbers of the model: `damping`, needed, where the word housner is Housner's damping of the column …
    * `friction_coefficient`, needed.
    * The uncertainty of numbers of column and model, such as `radius_spread` or `damping_spread`. Without a unit or in
      % it is the standard deviation of the logarithm, of a lognormal distribution with the number as its median. In a
      unit of the number, such as `radius_spread [mm]`, it is the standard deviation of a normal distribution about it.

    Units stand in the heading, such as `radius [mm]` or `Weight (kg)`, or in the cell; numbers without a unit are in SI
    units. Commas are decimal if no number of the column has a point. All other columns are carried through. Lines above
    the headings and other sheets of a workbook are left out with a warning.

    Parameters
    ----------
    path
        CSV file (separated by commas, semicolons or tabs), Excel workbook or GeoPackage; a path such as
        objects.xlsx/SHEET or objects.gpkg/LAYER names the sheet or layer, by default the first.
    model
        Kind of the model for which the numbers are checked.
    defaults
        Values for empty cells and missing columns, by name.
    carry
        Headings of columns to carry through although they are or resemble a known name.

    Returns
    -------
    tuple
        The objects, in the order of the rows. `read_as` of each states which headings are aliases, and of what.

    Raises
    ------
    ConfigError
        With one line for each mistake of headings, columns and cells: row, column, value and remedy.
    FileError
        If the file cannot be read.
    UnsupportedError
        If the package is missing that reads workbooks or GeoPackages.

    Examples
    --------
    >>> from pathlib import Path
    >>> folder = getfixture("tmp_path")
    >>> table = folder / "vases.csv"
    >>> _ = table.write_text(
    ...     "name;radius [mm];radius_spread [mm];height [cm];density;damping;friction_coefficient;room\n"
    ...     "amphora;62,5;0,5;55;2100;housner;0,6;12\n"
    ... )
    >>> (amphora,) = read_inventory(table)
    >>> amphora.column, amphora.spreads, amphora.carried
    ({'radius': 0.0625, 'height': 0.55, 'density': 2100.0}, {'radius': NormalSpread(deviation=0.0005, mean=None,
    least=0.0, most=inf)}, {'room': '12'})
    """
    require_model(model)
    table = ObjectTable.read(Path(path))
    faults = Faults(table.path.name)
    columns = _Columns.of(table, model, carry, defaults or {}, faults)
    given = _Defaults.of(defaults or {}, model, faults)
    reading = _Reading(table, model, columns, given, _doubts_on_commas(table, columns.known), faults)
    reading.require_columns()
    objects = [reading.object_of(row) for row in reading.rows_of_objects()]
    reading.require_distinct(objects)
    if faults:
        raise ConfigError(faults.lines())
    reading.warn_of_cylinders(objects)
    return tuple(objects)


@dataclass(frozen=True, slots=True)
class _Columns:
    """The columns of a table.

    Parameters
    ----------
    known
        The known headings by their texts.
    others
        Headings of the columns that are carried through.
    meant
        The names that refused headings may mean.
    ill
        Known headings with a wrong unit, whose cells cannot be read.
    """

    known: Mapping[str, Heading]
    others: tuple[str, ...]
    meant: frozenset[str]
    ill: frozenset[str]

    @classmethod
    def of(
        cls, table: ObjectTable, model: str, carry: Collection[str], defaults: Collection[str], faults: Faults
    ) -> "_Columns":
        """Read the headings, and collect their faults."""
        for problem in table.problems:
            faults.add(problem)
        for text in carry:
            if text not in table.headings:
                remedy = did_you_mean(text, table.headings) or f"Use one of {shortened(map(repr, table.headings))}."
                faults.add_line(f"carry: no such heading in {table.path.name} (got {text!r}); {remedy}")
        read = {text: None if text in carry else Heading.read(text, model) for text in table.headings if text}
        known = _used({text: one for text, one in read.items() if one is not None}, defaults)
        held = {_held_by(one.full_name) for one in known.values()}
        meant: set[str] = set()
        for text, one in read.items():
            if one is not None or text in carry:
                continue
            names_meant = misspelt(text, model)
            if not names_meant:
                names_meant = suggestions(text, model)
                if not names_meant or held & set(map(_held_by, names_meant)):
                    continue
            meant |= set(names_meant)
            if f"{FRICTION}{SPREAD}" in names_meant:
                remedy = f"Remove the column, or name it in {_carry(text)}."
                faults.add_heading(text, f"the friction coefficient has no uncertainty here. {remedy}")
                continue
            bracket = unread_bracket(text, model)
            what = f"neither a unit nor a known word (got {bracket!r})" if bracket else "unknown column"
            faults.add_heading(
                text, f"{what}; did you mean {' or '.join(names_meant)}? Rename it, or name it in {_carry(text)}."
            )
        ill = {text: problem for text, one in known.items() if (problem := one.problem_of_unit())}
        for text, problem in ill.items():
            faults.add_heading(text, problem)
        _refuse_doubled(known.values(), faults)
        return cls(known, tuple(text for text in read if text not in known), frozenset(meant), frozenset(ill))


def _used(understood: Mapping[str, Heading], defaults: Collection[str]) -> dict[str, Heading]:
    """Leave out further names of the objects, and columns of estimates where nothing is estimated."""
    names = [one for one in understood.values() if one.name == "name"]
    first = min(names, key=lambda one: order_of(one.text), default=None)
    known = {text: one for text, one in understood.items() if one.name != "name" or one is first}
    if _ESTIMATES & {*defaults, *(one.name for one in known.values())}:
        return known
    return {text: one for text, one in known.items() if one.name not in _OF_ESTIMATES}


def _refuse_doubled(known: Iterable[Heading], faults: Faults) -> None:
    by_name: dict[str, list[str]] = {}
    for one in known:
        by_name.setdefault(f"{one.number}{SPREAD if one.is_spread else ''}", []).append(one.text)
    for name, texts in by_name.items():
        if len(texts) > 1:
            got = ", ".join(map(repr, texts))
            faults.add(f"two columns hold {name} (got {got}). Remove one, or name it in {_carry(texts[-1])}.")


def _carry(heading: str) -> str:
    return f"carry (on the command line --carry {heading!r}) to carry it through"


def _state(name: str, quantity: Quantity) -> str:
    """Return the remedy for a number that is missing."""
    word = next(iter(quantity.by_word), "")
    filling = f"Write the word {word} or a measured value" if word else "Fill it"
    return f"{filling}, or state {name} in defaults (on the command line --default {name}={word or 'NUMBER'})."


@dataclass(frozen=True, slots=True)
class _Defaults:
    """Values for empty cells and missing columns by name, and the names of those with a fault."""

    values: Mapping[str, Any]
    wrong: frozenset[str]

    @classmethod
    def of(cls, defaults: Mapping[str, Any], model: str, faults: Faults) -> "_Defaults":
        """Read the defaults like cells, by any of their names, and collect their faults."""
        known = quantities(model)
        found: dict[str, Any] = {}
        wrong: set[str] = set()
        for given, value in defaults.items():
            name = given if given in known else meant_by(given) or given
            if name not in known and name not in WORDS:
                remedy = did_you_mean(given, {*known, *WORDS}) or "remove it."
                faults.add_line(f"defaults: unknown (got {given!r}); {remedy}")
                continue
            text = str(value)
            is_decimal = _DECIMAL_COMMA.fullmatch(text) and not _THOUSANDS.fullmatch(text)
            try:
                heading = Heading(given, name, known.get(name, Quantity()))
                found[name] = _value(text.replace(",", ".") if is_decimal and name in known else text, heading)
            except (ParameterError, UnitError) as error:
                faults.add_line(f"defaults.{given}: {error}. Correct it.")
                wrong.add(_number(name))
        return cls(found, frozenset(wrong))


@dataclass(slots=True)
class _Reading:
    """One pass over the rows of a table."""

    table: ObjectTable
    model: str
    columns: _Columns
    given: _Defaults
    doubts: Mapping[str, str]
    faults: Faults

    @property
    def _held(self) -> set[str]:
        """The names of the columns and defaults."""
        return {*self.given.values, *(one.name for one in self.columns.known.values() if not one.is_spread)}

    @property
    def _sized(self) -> bool:
        held = self._held
        return bool(held & _SHAPED) or all(held & set(group) for group in _SIZES)

    def require_columns(self) -> None:
        """Collect the columns that are missing, unless a refused heading may mean them."""
        known, held = quantities(self.model), self._held
        sizes = () if held & _SHAPED else _SIZES
        for group in (*((name,) for name in _NEEDED if name in known or name in WORDS), *sizes):
            if not {*held, *self.columns.meant, *self.given.wrong} & set(group):
                self._add_missing(*group)

    def _add_missing(self, *names: str) -> None:
        quantity = quantities(self.model).get(names[0])
        remedy = "" if quantity is None else f" {_state(names[0], quantity).replace('Fill it', 'Add it')}"
        self.faults.add(f"the column {' or '.join(names)} is missing.{remedy or ' Add it.'}")

    def rows_of_objects(self) -> Iterator[Row]:
        """Yield the rows of objects; others, such as units, sums and remarks, are faults."""
        for number, text in self.table.row_problems:
            self.faults.add_cell(number, "", text)
        for place, row in enumerate(self.table.rows):
            problem = self._no_object(row, first=place == 0, last=place == len(self.table.rows) - 1)
            if problem:
                self.faults.add_cell(row.number, "", problem)
            else:
                yield row

    def _no_object(self, row: Row, *, first: bool, last: bool) -> str:
        numbers = [text for text, one in self.columns.known.items() if one.name not in WORDS]
        cells = [row.cells[text] for text in numbers if row.cells[text]]
        units = [spelled(one.strip("[]() ")) for one in cells]
        if first and units and all(units) and not any(map(is_number, cells)):
            got = shortened(map(repr, cells))
            return f"units in a row of their own (got {got}). Write each in its heading, and remove the row."
        filled = [one for one in row.cells.values() if one]
        if last and filled and set(words_of(filled[0])[:1]) & _TOTALS:
            return f"a sum, and no object (got {filled[0]!r}). Remove the row."
        if len(filled) == 1 and len(numbers) > 1:
            return f"one cell only, and no object (got {filled[0]!r}). Remove the row, or fill its cells."
        return ""

    def object_of(self, row: Row) -> InventoryObject:
        """Read the object of a row; its wrong cells are collected, and are then not in the object."""
        values: dict[str, Any] = {}
        spreads: dict[str, Spread] = {}
        wrong: set[str] = set()
        for text, heading in self.columns.known.items():
            cell = row.cells[text]
            if not cell or text in self.columns.ill:
                wrong |= {heading.number} if cell and not heading.is_spread else set()
                continue
            try:
                plain = self._plain(cell, heading)
                if heading.is_spread:
                    spread = _spread(plain, heading)
                    spreads |= {} if spread is None else {heading.number: spread}
                else:
                    values[heading.name] = _value(plain, heading)
            except (ParameterError, UnitError) as error:
                self.faults.add_cell(row.number, text, f"{error}. Correct the cell.")
                wrong |= set() if heading.is_spread else {heading.number}
        stated = {*map(_number, values), *wrong}
        stated |= set(_EITHER) if stated & set(_EITHER) else set()
        values |= {name: value for name, value in self.given.values.items() if _number(name) not in stated}
        wrong |= self.given.wrong - stated
        for name in _NEEDED:
            if name not in values and name not in wrong:
                self._add_empty(row, name)
        of_column = (*column_numbers(), "shape", "profile")
        folder = self.table.path.parent
        found = InventoryObject(
            name=str(values.get("name", "")),
            column={name: _placed(name, value, folder) for name, value in values.items() if name in of_column},
            model={name: one for name, one in values.items() if name not in (*of_column, *WORDS, FRICTION)},
            friction_coefficient=values.get(FRICTION, 1.0),
            spreads=spreads,
            site=str(values.get("site", "")),
            carried={text: row.cells[text] for text in self.columns.others},
            read_as={text: one.full_name for text, one in self.columns.known.items() if one.is_alias},
            geometry=row.geometry,
            crs=self.table.crs,
            where=f"{self.table.path.name}, row {row.number}",
        )
        self._check(row, found, wrong)
        return found

    def _check(self, row: Row, found: InventoryObject, wrong: set[str]) -> None:
        """Collect the faults of the numbers together; beside wrong cells only what is missing."""
        if not self._sized:
            return
        unstated = {*wrong, *map(_number, self.columns.meant), *set(_NEEDED).difference(found.model)}
        usable = {name: one for name, one in found.spreads.items() if name not in unstated}
        try:
            with unquestioned():  # the study questions the numbers
                replace(found, spreads=usable).prepared(self.model)
        except ConfigError as error:
            for line in error.problems:
                text = line.removeprefix(f"{found.where}: ")
                missing = _MISSING.match(text)
                if missing is None:
                    if not wrong:
                        self.faults.add_cell(row.number, "", text)
                    continue
                names = {missing["name"]} if missing["name"] else set(_EITHER)
                if not names & wrong:
                    self._add_empty(row, next(one for one in sorted(names) if one in self._held or len(names) == 1))

    def _add_empty(self, row: Row, name: str) -> None:
        """Collect an empty cell; once for the table if it has no such column, unless a refused heading may mean it."""
        quantity = quantities(self.model).get(name)
        if (name not in WORDS and quantity is None) or row.number in self.table.of_merged:
            return
        column = next(
            (text for text, one in self.columns.known.items() if one.number == name and not one.is_spread), ""
        )
        if column:
            remedy = "Fill it." if quantity is None else _state(self.columns.known[column].name, quantity)
            self.faults.add_cell(row.number, column, f"the cell is empty. {remedy}")
        elif name not in map(_number, self.columns.meant):
            self._add_missing(name)

    def _plain(self, cell: str, heading: Heading) -> str:
        """Return a cell with a decimal point.

        Raises
        ------
        ParameterError
            If its comma may be decimal or separate thousands.
        """
        if heading.name in WORDS or not _DECIMAL_COMMA.fullmatch(cell):
            return cell
        if doubt := self.doubts[heading.text]:
            raise ParameterError(f"{doubt} (got {cell!r})")
        return cell.replace(",", ".")

    def warn_of_cylinders(self, objects: Iterable[InventoryObject]) -> None:
        """Warn of objects that are weighed but have no centre of mass: most stand less firmly than a solid cylinder."""
        rows = [
            one.where.rpartition(" ")[2] for one in objects if "mass" in one.column and not _SHAPING & set(one.column)
        ]
        if rows:
            warnings.warn(
                f"{self.table.path.name}, {'row' if len(rows) == 1 else 'rows'} {shortened(rows)}: without a centre of "
                "mass these objects are taken as solid cylinders, although a vessel or a statue may overturn earlier. "
                "State mass_height and profile, or the shape solid.",
                UnlikelyInputWarning,
                stacklevel=3,
            )

    def require_distinct(self, objects: Iterable[InventoryObject]) -> None:
        """Collect names that several objects have."""
        rows: dict[str, list[int]] = {}
        for one in objects:
            rows.setdefault(one.name, []).append(int(one.where.rpartition(" ")[2]))
        column = next((text for text, one in self.columns.known.items() if one.name == "name"), "name")
        other = next((one for one in self.columns.others if meant_by(one) == "name"), "")
        remedy = f", or name {column!r} in {_carry(column)}: then {other!r} names the objects" if other else ""
        for name, own in rows.items():
            for row in own if name and len(own) > 1 else ():
                self.faults.add_cell(
                    row, column, f"{len(own)} objects have this name (got {name!r}). Give each its own{remedy}."
                )


def _placed(name: str, value: Any, folder: Path) -> Any:
    """Return the value of a cell; the file of a profile is relative to the folder of the table."""
    return str(folder / value) if name == "profile" and is_table(value) else value


def _doubts_on_commas(table: ObjectTable, known: Mapping[str, Heading]) -> dict[str, str]:
    """Return for each column of numbers why its commas are not decimal; "" where they are."""
    numbers = {text: [row.cells[text] for row in table.rows] for text, one in known.items() if one.name not in WORDS}
    with_points = {text for text, cells in numbers.items() if any(map(_has_point, cells))}
    doubts = dict.fromkeys(with_points, "a decimal comma beside decimal points in other cells")
    for text in numbers.keys() - with_points:
        commas = filter(_DECIMAL_COMMA.fullmatch, numbers[text])
        unclear = with_points and all(map(_THOUSANDS.fullmatch, commas))
        doubts[text] = "a comma that is decimal or separates thousands" if unclear else ""
    return doubts


def _number(name: str) -> str:
    return DIAMETERS.get(name, name)


def _held_by(name: str) -> str:
    """Return the name of the number that a column of this name holds, with its end for an uncertainty."""
    number = name.removesuffix(SPREAD)
    return f"{_number(number)}{name[len(number) :]}"


def _has_point(cell: str) -> bool:
    return "." in split(cell)[0] and is_number(cell)


def _value(cell: str, heading: Heading) -> Any:
    """Read a word, or a number in SI units."""
    if heading.name in WORDS:
        return cell
    quantity = heading.quantity
    if cell.lower() in quantity.by_word:
        return cell.lower()
    number, unit = split(cell)
    if not is_number(number):
        words = "".join(f" or {one!r}" for one in quantity.by_word)
        raise ParameterError(
            f"must be a number{words or ', with or without a unit' * bool(quantity.unit)}, got {cell!r}"
        )
    value = read(f"{number} {unit or heading.unit}".strip(), quantity.unit)
    with unquestioned():  # the study questions the numbers
        return quantity.checked(heading.name, value)


def _spread(cell: str, heading: Heading) -> Spread | None:
    """Read an uncertainty; None for 0. Without a unit or in % it is relative, otherwise absolute."""
    quantity = heading.quantity
    number, own = split(cell)
    unit = own or heading.unit
    relative = unit in ("", PER_CENT, "1")
    value = read(f"{number} {unit}".strip(), "" if relative else quantity.unit)
    if not 0.0 <= value < math.inf:
        raise ParameterError(f"{heading.name}{SPREAD} must be zero or positive, got {cell!r}")
    if relative and value >= _LARGEST_SPREAD:
        raise ParameterError(
            f"{heading.name}{SPREAD} is relative and must be below {_LARGEST_SPREAD:g}, got {cell!r}; state its "
            f"unit in the heading, such as {heading.name}{SPREAD} [{quantity.unit or PER_CENT}]"
        )
    if value == 0.0:
        return None
    if relative:
        return LognormalSpread(value)
    return NormalSpread(0.5 * value if heading.name in DIAMETERS else value)
