"""Headings of tables of objects: the number or word that a column holds, its unit, and whether it is an uncertainty."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache

from stylobate.aliases import may_mean, meant_by, words_of
from stylobate.column.shapes import SHAPES_OF_PROFILES
from stylobate.config.parts import DIAMETERS
from stylobate.models.declared import MODELS, column_quantities
from stylobate.quantities import Quantity, parameters_of
from stylobate.text import similar
from stylobate.units import UnitError, read, spelled

FRICTION = "friction_coefficient"
WORDS = ("name", "site", "shape", "profile")
"""Columns of words."""
SPREAD = "_spread"
"""End of the name of a column with the uncertainty of a number."""
PER_CENT = "%"

_OF_FRICTION = Quantity(symbol="μ", text="friction coefficient of the contact", gt=0.0)
_SPREADS = ({"spread"}, {"standard", "deviation"})
# Words of an uncertainty that may be a bound, or two standard deviations.
_UNCERTAIN = {"±", "uncertainty", "tolerance", "error", "accuracy", "deviation", "std", "sd", "sigma", "spread"}
_BRACKETED = re.compile(r"[\[(]([^\])]*)[\])]")
# Between the words and the unit: a comma, a stroke, "in" or a blank.
_BETWEEN = re.compile(r"\s*[,/:]\s*|[\s_]+(?:in\s+)?")
# Headings of museums have many words that are somewhat like the name of a number.
_LIKENESS = 0.8


@dataclass(frozen=True, slots=True)
class Heading:
    """A known column: the number or word in it, its quantity and unit, and whether it holds an uncertainty.

    Parameters
    ----------
    text
        The heading in the table.
    name, quantity
        Name of the number or word, and the declaration of the number.
    unit
        Unit in the heading; empty without one.
    is_spread
        Whether the column holds the uncertainty of the number.
    is_alias
        Whether the heading states the name in other words.
    """

    text: str
    name: str
    quantity: Quantity
    unit: str = ""
    is_spread: bool = False
    is_alias: bool = False

    @property
    def number(self) -> str:
        """Name of the number as constructors have it: that of the radius for a diameter."""
        return DIAMETERS.get(self.name, self.name)

    @property
    def full_name(self) -> str:
        """The name, with its end for an uncertainty."""
        return f"{self.name}{SPREAD if self.is_spread else ''}"

    @classmethod
    def read(cls, text: str, model: str) -> "Heading | None":
        """Read a heading, such as "Weight (kg)" or "radius_spread [mm]"; None for one that is not understood."""
        known = quantities(model)
        words, unit = _split(text)
        found = cls._named(words, known)
        if found is not None:
            return replace(found, text=text, unit=unit)
        for before, last in () if unit else _last_units(text):
            found = cls._named(before, known)
            if found is not None and found.name not in WORDS and not replace(found, unit=last).problem_of_unit():
                return replace(found, text=text, unit=last)
        return None

    @classmethod
    def _named(cls, text: str, known: Mapping[str, Quantity]) -> "Heading | None":
        words = words_of(text)
        whole = "_".join(words)
        if whole in known:  # also the spread of an estimated inertia, which is a number of the column itself
            return cls(text, whole, known[whole])
        spread = next((one for one in _SPREADS if one <= set(words)), set())
        plain = " ".join(one for one in words if one not in spread)
        name = meant_by(plain) or plain.replace(" ", "_")
        if name not in known and (name not in WORDS or spread):
            return None
        if spread and name == FRICTION:
            return None
        found = cls(text, name, known.get(name, Quantity()), is_spread=bool(spread))
        return replace(found, is_alias=words != words_of(found.full_name))

    def problem_of_unit(self) -> str:
        """Describe the fault of a unit of another dimension; "" without a fault."""
        if not self.unit or (self.is_spread and self.unit == PER_CENT):
            return ""
        if self.name in WORDS:
            return "holds words, which have no unit. Remove the unit."
        try:
            read(f"1 {self.unit}", self.quantity.unit)
        except UnitError as error:
            return f"{error}. Correct the unit."
        return ""


def _split(text: str) -> tuple[str, str]:
    """Split a heading into its words and the unit in brackets; other brackets hold words."""
    units = [one for one in _BRACKETED.findall(text) if spelled(one)]
    words = _BRACKETED.sub(lambda one: " " if one[1] in units else f" {one[1]} ", text)
    return words, spelled(units[-1]) if units else ""


def unread_bracket(text: str, model: str) -> str:
    """Return the text in brackets that is no unit, behind a known name; "" without such a text."""
    named = Heading.read(_BRACKETED.sub(" ", text), model)
    return next((one for one in _BRACKETED.findall(text) if one.strip() and not spelled(one)), "") if named else ""


def misspelt(text: str, model: str) -> tuple[str, ...]:
    """Return the names of which a heading is most likely a misspelling."""
    words = " ".join(words_of(_split(text)[0]))
    uncertain = set(words.split()) & _UNCERTAIN
    plain = " ".join(one for one in words.split() if one not in _UNCERTAIN) if uncertain else words
    names = quantities(model)
    found = similar(plain, names, _LIKENESS) if plain and not may_mean(plain) else ()
    if not found and not uncertain:
        found = tuple(get_close_matches(plain, WORDS, n=1, cutoff=_LIKENESS))
    return tuple(f"{one}{SPREAD}" for one in found) if uncertain else found


def suggestions(text: str, model: str) -> tuple[str, ...]:
    """Return the names that a heading may mean by some of its words."""
    words = set(words_of(_split(text)[0]))
    uncertain = words & _UNCERTAIN
    plain = " ".join(words - _UNCERTAIN - ({"standard"} if uncertain else set()))
    exact = meant_by(plain) if uncertain else None
    found = (exact,) if exact else may_mean(plain)
    known = quantities(model)
    return tuple(f"{one}{SPREAD}" if uncertain else one for one in found if one in known)


def count_of_known(cells: Iterable[str]) -> int:
    """Count the cells that are headings in any table of objects, to find the row of headings."""
    words = ((_split(one)[0], *(before for before, _ in _last_units(one))) for one in cells)
    return len({name for one in words for part in one if (name := meant_by(part))})


def _last_units(text: str) -> list[tuple[str, str]]:
    """Return the ways to split a heading into words and a unit without brackets."""
    ends = ((text[: one.start()], spelled(text[one.end() :])) for one in _BETWEEN.finditer(text.strip()))
    return [(words, unit) for words, unit in ends if unit]


@cache
def quantities(model: str) -> dict[str, Quantity]:
    """Return the quantity of each number of a column or of this model."""
    of_model = {
        name: one.quantity for name, one in parameters_of(MODELS[model]).items() if not one.choices and name != "column"
    }
    return {**column_numbers(), **of_model, FRICTION: _OF_FRICTION}


@cache
def column_numbers() -> dict[str, Quantity]:
    """Return the quantity of each number that describes a column, those of its profile and diameters included."""
    of_profiles = {name: one for make in SHAPES_OF_PROFILES.values() for name, one in parameters_of(make).items()}
    of_column = {
        **column_quantities(),
        **{name: one.quantity for name, one in of_profiles.items() if name not in WORDS},
    }
    return {**of_column, **{name: of_column[radius] for name, radius in DIAMETERS.items()}}
