"""Tables of objects, one object in each row.

A column of a known name holds a number of the object, in the unit of its heading, such as `radius [mm]`; a column such
as `radius_spread` holds the uncertainty of the number. All other columns are carried through to the ranking.
"""

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from stylobate.column import SHAPES_OF_PROFILES
from stylobate.config.parts import DIAMETERS
from stylobate.config.profile_table import is_table
from stylobate.earthquakes.inventories.objects import InventoryObject, require_model, unquestioned
from stylobate.earthquakes.inventories.rows import ObjectTable, Row
from stylobate.earthquakes.property_spreads import LognormalSpread, NormalSpread, Spread
from stylobate.errors import ConfigError, ParameterError
from stylobate.models.declared import MODELS, column_quantities
from stylobate.quantities import Quantity, parameters_of
from stylobate.records.tables import NAME_AND_UNIT
from stylobate.text import did_you_mean
from stylobate.units import UnitError, is_number, read, split

_OF_FRICTION = Quantity(symbol="μ", text="friction coefficient of the contact", gt=0.0)
_WORDS = ("name", "site", "shape", "profile")
"""Columns of words."""
_FRICTION = "friction_coefficient"
_NEEDED = ("name", _FRICTION)
SPREAD = "_spread"
"""End of the name of a column with the uncertainty of a number."""
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?(?:\s*[^\d\s,.].*)?")
_PER_CENT = "%"


@dataclass(frozen=True, slots=True)
class Heading:
    """A known column: the number or word in it, its quantity and unit, and whether it holds an uncertainty."""

    text: str
    name: str
    quantity: Quantity
    unit: str = ""
    is_spread: bool = False

    @property
    def number(self) -> str:
        """Name of the number as constructors have it: that of the radius for a diameter."""
        return DIAMETERS.get(self.name, self.name)


def read_inventory(
    path: str | Path,
    *,
    model: str = "wobbling",
    defaults: Mapping[str, Any] | None = None,
    carry: Collection[str] = (),
) -> tuple[InventoryObject, ...]:
    r"""Read the objects of an inventory from a table, one in each row.

    Columns of these names are read; capitals do not count, and blanks are underscores:

    * `name`, needed, and `site`.
    * The numbers of a column as in description files: `radius` or `diameter`, `height`, `density` or `mass`,
      `inner_radius`, `mass_height` …, and `shape` if they do not imply it.
    * `profile`: the kind of profile from which moments of inertia are estimated, such as amphora, or the file of a
      drawn profile, relative to the table.
    * The numbers of the model, such as `damping`, where the word housner is Housner's damping of the column.
    * `friction_coefficient`, needed.
    * The uncertainty of numbers of column and model, such as `radius_spread` or `damping_spread`. Without a unit or in
      % it is the standard deviation of the logarithm, of a lognormal distribution with the number as its median. In a
      unit of the number, such as `radius_spread [mm]`, it is the standard deviation of a normal distribution about it.

    Units stand in the heading, such as `radius [mm]`, or in the cell; numbers without a unit are in SI units. Commas
    are decimal if no number of the table has a point. All other columns are carried through.

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
        Headings of columns to carry through although they resemble a known name.

    Returns
    -------
    tuple
        The objects, in the order of the rows.

    Raises
    ------
    ConfigError
        With one line for each mistake: place of the row, column, value and remedy.
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
    known, others = _headings(table, model, carry)
    given = dict(defaults or {})
    _require_columns(table, known, given, model)
    commas = _has_decimal_commas(table, known)
    problems = list(table.problems)
    objects = []
    for row in table.rows:
        one = _object(row, known, others, given, table, problems, commas=commas)
        if one is None:
            continue
        try:
            with unquestioned():  # the study questions the numbers
                one.prepared(model)
        except ConfigError as error:
            problems += error.problems
        objects.append(one)
    if problems:
        raise ConfigError(problems)
    return tuple(objects)


@cache
def _quantities(model: str) -> dict[str, Quantity]:
    """Return the quantity of each number of a column or of this model."""
    of_model = {
        name: one.quantity for name, one in parameters_of(MODELS[model]).items() if not one.choices and name != "column"
    }
    of_column = {**column_quantities(), **_of_profiles()}
    diameters = {name: of_column[radius] for name, radius in DIAMETERS.items()}
    return {**of_column, **diameters, **of_model, _FRICTION: _OF_FRICTION}


def _of_profiles() -> dict[str, Quantity]:
    """Return the quantity of each further number of a column that is described by its profile."""
    own = {name: one for make in SHAPES_OF_PROFILES.values() for name, one in parameters_of(make).items()}
    return {name: one.quantity for name, one in own.items() if name not in _WORDS}


def _headings(table: ObjectTable, model: str, carry: Collection[str]) -> tuple[dict[str, Heading], tuple[str, ...]]:
    """Return the known headings, and those of the columns that are carried through."""
    quantities = _quantities(model)
    names = {*_WORDS, *quantities, *(f"{name}{SPREAD}" for name in quantities if name != _FRICTION)}
    known: dict[str, Heading] = {}
    others, problems = list[str](), list[str]()
    for text in filter(None, table.headings):
        match = NAME_AND_UNIT.fullmatch(text)
        plain, unit = (match["name"], match["unit"] or "") if match else (text, "")
        name = re.sub(r"[\s\-]+", "_", plain.strip().lower())
        if text in carry or (name not in names and not did_you_mean(name, names)):
            others.append(text)
        elif name not in names:
            problems.append(
                f"{table.path.name}, heading {text!r}: unknown column; {did_you_mean(name, names)} Rename it, "
                "or name it in carry to carry it through."
            )
        else:
            number = name if name in quantities else name.removesuffix(SPREAD)
            quantity = quantities.get(number, Quantity())
            known[text] = Heading(text, number, quantity, unit.strip(), is_spread=number != name)
            problems += _problem_of_unit(table, known[text])
    doubled = [(one.name, one.is_spread) for one in known.values()]
    problems += [
        f"{table.path.name}: two columns hold {name}{SPREAD if spread else ''}. Remove one."
        for name, spread in dict.fromkeys(one for one in doubled if doubled.count(one) > 1)
    ]
    if problems:
        raise ConfigError(problems)
    return known, tuple(others)


def _problem_of_unit(table: ObjectTable, heading: Heading) -> list[str]:
    """Return a line if the unit of a heading is unknown or has another dimension than its number."""
    if not heading.unit or (heading.is_spread and heading.unit == _PER_CENT):
        return []
    where = f"{table.path.name}, heading {heading.text!r}"
    if heading.name in _WORDS:
        return [f"{where}: holds words, which have no unit. Remove the unit."]
    try:
        read(f"1 {heading.unit}", heading.quantity.unit)
    except UnitError as error:
        return [f"{where}: {error}. Correct the unit."]
    return []


def _require_columns(table: ObjectTable, known: Mapping[str, Heading], given: Mapping[str, Any], model: str) -> None:
    names = {one.name for one in known.values() if not one.is_spread}
    own = {*_WORDS, *_quantities(model)}
    problems = [
        f"{table.path.name}: the column {name} is missing. Add it"
        + ("." if name == "name" else f", or state {name} in defaults.")
        for name in (*_NEEDED, *_DECISIVE)
        if name not in names and name not in given and (name in own)
    ]
    problems += [
        f"defaults: unknown (got {name!r}); {did_you_mean(name, own) or 'remove it.'}"
        for name in given
        if name not in own
    ]
    if problems:
        raise ConfigError(problems)


_DECISIVE = ("damping",)
"""Numbers of models whose default, no loss of energy, no object has."""


def _has_decimal_commas(table: ObjectTable, known: Mapping[str, Heading]) -> bool:
    """Return whether commas in the numbers of a table are decimal: some number has one, and none has a point."""
    numbers = [row.cells[text] for row in table.rows for text, one in known.items() if one.name not in _WORDS]
    return any(map(_DECIMAL_COMMA.fullmatch, numbers)) and not any("." in split(one)[0] for one in numbers)


def _object(
    row: Row,
    known: Mapping[str, Heading],
    others: Sequence[str],
    given: Mapping[str, Any],
    table: ObjectTable,
    problems: list[str],
    *,
    commas: bool,
) -> InventoryObject | None:
    """Make the object of a row; None, with a line in `problems` for each mistake, if a cell is wrong."""
    before = len(problems)
    values: dict[str, Any] = dict(given)
    spreads: dict[str, Spread] = {}
    for text, heading in known.items():
        cell = row.cells[text]
        if not cell:
            continue
        try:
            if heading.is_spread:
                spread = _spread(cell, heading, commas=commas)
                if spread is not None:
                    spreads[heading.number] = spread
            else:
                values[heading.name] = _value(cell, heading, commas=commas)
        except (ParameterError, UnitError) as error:
            problems.append(f"{row.place}, {text}: {error}. Correct the cell.")
    for name in _NEEDED:
        if name not in values and len(problems) == before:
            problems.append(f"{row.place}, {name}: the cell is empty. Fill it.")
    if len(problems) > before:
        return None
    of_column = (*column_quantities(), *_of_profiles(), *DIAMETERS, "shape", "profile")
    return InventoryObject(
        name=str(values["name"]),
        column={name: _placed(name, value, table.path.parent) for name, value in values.items() if name in of_column},
        model={name: one for name, one in values.items() if name not in (*of_column, *_WORDS, _FRICTION)},
        friction_coefficient=values[_FRICTION],
        spreads=spreads,
        site=str(values.get("site", "")),
        carried={text: row.cells[text] for text in others},
        geometry=row.geometry,
        crs=table.crs,
        where=row.place,
    )


def _placed(name: str, value: Any, folder: Path) -> Any:
    """Return the value of a cell; the file of a profile is relative to the folder of the table."""
    return str(folder / value) if name == "profile" and is_table(value) else value


def _plain(cell: str, *, commas: bool) -> str:
    """Return a cell with a decimal point.

    Raises
    ------
    ParameterError
        If its comma may be decimal or separate thousands.
    """
    if "," not in cell:
        return cell
    if commas and _DECIMAL_COMMA.fullmatch(cell):
        return cell.replace(",", ".")
    if _DECIMAL_COMMA.fullmatch(cell):
        raise ParameterError(f"a decimal comma beside decimal points in other cells (got {cell!r})")
    return cell


def _value(cell: str, heading: Heading, *, commas: bool) -> Any:
    """Read a word, or a number in SI units."""
    if heading.name in _WORDS:
        return cell
    quantity = heading.quantity
    if cell.lower() in quantity.by_word:
        return cell.lower()
    number, unit = split(_plain(cell, commas=commas))
    if quantity.by_word and not is_number(number):
        words = " or ".join(map(repr, quantity.by_word))
        raise ParameterError(f"must be a number or {words}, got {cell!r}")
    value = read(f"{number} {unit or heading.unit}".strip(), quantity.unit)
    with unquestioned():  # the study questions the numbers
        return quantity.checked(heading.name, value)


def _spread(cell: str, heading: Heading, *, commas: bool) -> Spread | None:
    """Read an uncertainty; None for 0. Without a unit or in % it is relative, otherwise absolute."""
    quantity = heading.quantity
    number, own = split(_plain(cell, commas=commas))
    unit = own or heading.unit
    relative = unit in ("", _PER_CENT, "1")
    value = read(f"{number} {unit}".strip(), "" if relative else quantity.unit)
    if not 0.0 <= value < math.inf:
        raise ParameterError(f"{heading.name}{SPREAD} must be zero or positive, got {cell!r}")
    if relative and value >= _LARGEST_SPREAD:
        raise ParameterError(
            f"{heading.name}{SPREAD} is relative and must be below {_LARGEST_SPREAD:g}, got {cell!r}; state its "
            f"unit in the heading, such as {heading.name}{SPREAD} [{quantity.unit or _PER_CENT}]"
        )
    if value == 0.0:
        return None
    if relative:
        return LognormalSpread(value)
    return NormalSpread(0.5 * value if heading.name in DIAMETERS else value)


_LARGEST_SPREAD = 2.0
"""A standard deviation of a logarithm above this has most likely another unit."""
