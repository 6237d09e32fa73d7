"""Objects of an inventory: the numbers of a column with their uncertainty, and the runs that are drawn from them."""

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product
from typing import Any, TypeAlias

import numpy as np

from stylobate.column import Column
from stylobate.config.description import Config
from stylobate.config.parts import ColumnConfig, ModelConfig
from stylobate.earthquakes.fragility import HazardCurve
from stylobate.earthquakes.property_spreads import Spread, inertia_spreads, shares_of
from stylobate.earthquakes.study_inputs import Records
from stylobate.errors import ConfigError, ParameterError, UnlikelyInputWarning, require_positive
from stylobate.models import Model
from stylobate.models.declared import MODELS
from stylobate.quantities import Quantity, parameters_of, unchecked
from stylobate.studies.sweeps.designs import Floats
from stylobate.text import did_you_mean

Draws: TypeAlias = Mapping[str, Floats]
"""Numbers of column and model of the runs by name, each of shape (runs,)."""

OF_RUNS = tuple(name for name, one in parameters_of(Column).items() if one.required or name == "gravity")
"""The numbers of a column that its motion depends on: all but the height of the body."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InventorySite:
    """Base motions of a site, and the hazard there.

    Parameters
    ----------
    records
        Base motions that end: a sequence, or a mapping from names.
    hazard
        Hazard curve of the site; with it the annual rate of each limit state is counted.
    """

    records: Records
    hazard: HazardCurve | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class InventoryObject:
    """One object of an inventory.

    Parameters
    ----------
    name
        Name, unique in the inventory. The samples of an object depend on its name and the seed, and not on its row.
    column
        Numbers of the column by the names of description files, such as `radius` (or `diameter`), `height`, `density`.
    model
        Numbers of the model by name, such as {"damping": 0.05}. The word "housner" is Housner's damping of the column.
    friction_coefficient
        Friction coefficient of the contact.
    spreads
        Distribution of each uncertain number of `column` or `model`, by its name. The column is built again from each
        sample, so that its mass and its moments of inertia follow.
    site
        Name of the site; may be left out if there is one site.
    carried
        Further cells of the row by the names of their columns, which the ranking repeats.
    geometry, crs
        Geometry as well-known binary, and its coordinate reference system; empty without one.
    where
        Place of the row, for messages.
    """

    name: str
    column: Mapping[str, Any]
    model: Mapping[str, Any] = field(default_factory=dict)
    friction_coefficient: float
    spreads: Mapping[str, Spread] = field(default_factory=dict)
    site: str = ""
    carried: Mapping[str, str] = field(default_factory=dict)
    geometry: bytes = b""
    crs: str = ""
    where: str = ""

    @property
    def place(self) -> str:
        """Place of the row, or the name, for messages."""
        return self.where or f"object {self.name!r}"

    def prepared(self, kind: str) -> "PreparedObject":
        """Build the model of this kind with the nominal numbers.

        Raises
        ------
        ConfigError
            With one line for each invalid number; each begins with the place of the row.
        """
        try:
            described = _Parts.parse({"column": dict(self.column), "model": {"kind": kind, **self.model}})
            stated = described.column.numbers()
            model = described.model.build(described.column.build())
            friction = require_positive("friction_coefficient", self.friction_coefficient)
            prepared = PreparedObject(
                given=self,
                model=model,
                shape=described.column.shape,
                make=described.column.constructor,
                numbers={name: value for name, value in stated.items() if value is not None},
                friction=friction,
            )
            prepared.check_names()
        except ConfigError as error:
            raise ConfigError([f"{self.place}: {_without_part(line)}" for line in error.problems]) from None
        except ParameterError as error:
            raise ConfigError([f"{self.place}: {error}"]) from None
        except ArithmeticError:
            line = "its numbers are too large or too small to compute with. Check their units."
            raise ConfigError([f"{self.place}: {line}"]) from None
        return prepared


class _Parts(Config):
    """Column and model of an object."""

    column: ColumnConfig
    model: ModelConfig


def _without_part(line: str) -> str:
    """Return a line on a mistake without the name of the part, which a table does not have."""
    return line.removeprefix("column.").removeprefix("model.")


@dataclass(frozen=True, slots=True, kw_only=True)
class PreparedObject:
    """An object with its nominal model, from which samples are drawn.

    Parameters
    ----------
    given
        The object as given.
    model
        The nominal model.
    shape
        Shape of its column, as in files.
    make
        Constructor of its column.
    numbers
        Arguments of the constructor: numbers, and the kind of a profile.
    friction
        Friction coefficient.
    site
        Name of the site whose records the object meets.
    """

    given: InventoryObject
    model: Model
    shape: str
    make: Callable[..., Column]
    numbers: Mapping[str, Any]
    friction: float
    site: str = ""

    @property
    def name(self) -> str:
        """Name of the object."""
        return self.given.name

    @property
    def of_model(self) -> tuple[str, ...]:
        """The numbers of the model that the object states."""
        return tuple(self.given.model)

    @property
    def spreads(self) -> Mapping[str, Spread]:
        """Distribution of each uncertain number: those given, and those of estimated moments of inertia."""
        return {**inertia_spreads(self.model.column), **self.given.spreads}

    @property
    def estimated(self) -> str:
        """Note on estimated moments of inertia; empty for stated or computed ones."""
        own = self.model.column.profile
        return f"{own.spread_in_words} ({own.name})" if own is not None and own.is_estimated else ""

    def check_names(self) -> None:
        """Raise ParameterError for a word of the model, or a spread of an unknown number or that is no distribution."""
        for name in self.of_model:
            if not isinstance(getattr(self.model, name), (int, float)):
                raise ParameterError(f"{name}: must be a number (got {getattr(self.model, name)!r}). Leave it out.")
        known = {*(name for name, one in self.numbers.items() if not isinstance(one, str)), *self.of_model}
        for name, spread in self.given.spreads.items():
            if name not in known:
                remedy = did_you_mean(name, known) or f"Use {', '.join(sorted(known))}."
                raise ParameterError(f"spread of {name}: the object has no such number; {remedy}")
            if not hasattr(spread, "draw"):
                raise ParameterError(
                    f"spread of {name}: must be a distribution (got {spread!r}). Pass one such as LognormalSpread(0.1)."
                )

    def samples(self, runs: int, seed: int) -> dict[str, Floats]:
        """Draw the uncertain numbers, each of shape (runs,); empty without spreads."""
        estimated = {name: getattr(self.model.column, name) for name in self.spreads if name not in self.given.spreads}
        nominal = {**estimated, **self.numbers, **{name: getattr(self.model, name) for name in self.of_model}}
        return {
            name: spread.draw(nominal[name], shares_of(f"{self.name}: {name}", runs=runs, seed=seed))
            for name, spread in self.spreads.items()
        }

    def check_samples(self, runs: int, seed: int) -> None:
        """Raise ConfigError if a sample is no column, or no number of the model.

        The constraints between the numbers of a column are monotonic or concave in each of them. So all samples fit if
        all combinations of the smallest and largest samples do; otherwise all samples are built.
        """
        drawn = self.samples(runs, seed)
        ends = {name: (float(values.min()), float(values.max())) for name, values in drawn.items()}
        try:
            with unquestioned():
                for name in sorted(set(ends) & set(self.of_model)):
                    for value in ends[name]:
                        _quantity(self.model, name).checked(name, value)
            lengths = {name: both for name, both in ends.items() if name in self.numbers}
            corners = [dict(zip(lengths, values, strict=True)) for values in product(*lengths.values())]
            if lengths and not all(self._fits(one) for one in corners):
                self.draws(runs, seed)
        except (ParameterError, ArithmeticError) as error:
            names = " and ".join(f"{name}_spread" for name in self.given.spreads)
            line = f"{self.given.place}: {names}: a sample is impossible ({error}). Reduce the spread."
            raise ConfigError([line]) from None

    def _fits(self, numbers: Mapping[str, float]) -> bool:
        try:
            with unquestioned():
                self._column(numbers)
        except (ParameterError, ArithmeticError):
            return False
        return True

    def _column(self, numbers: Mapping[str, float]) -> Column:
        return self.make(**{**self.numbers, **numbers})

    def draws(self, runs: int, seed: int) -> dict[str, Floats]:
        """Return the numbers of column and model of each run, with `slenderness` and `frequency_parameter`.

        Raises
        ------
        ParameterError
            If a sample is no column.
        """
        drawn = self.samples(runs, seed)
        of_column = {name: values for name, values in drawn.items() if name in self.numbers}
        own = (*OF_RUNS, "slenderness", "frequency_parameter")
        if of_column:
            rows = zip(*(values.tolist() for values in of_column.values()), strict=True)
            with unquestioned():
                columns = [self._column(dict(zip(of_column, row, strict=True))) for row in rows]
            table = np.array([[getattr(column, name) for name in own] for column in columns])
        else:
            table = np.tile([float(getattr(self.model.column, name)) for name in own], (runs, 1))
        fixed = {name: np.full(runs, getattr(self.model, name), dtype=float) for name in self.of_model}
        sampled = {name: values for name, values in drawn.items() if name in self.of_model}
        bodies = dict(zip(own, table.T.copy(), strict=True))
        return {**self._with_estimated(bodies, drawn), **fixed, **sampled}

    def _with_estimated(self, bodies: Draws, drawn: Draws) -> Draws:
        """Multiply the moments of inertia that are estimated for each sample by the errors that were drawn."""
        factors = {
            name: drawn[name] / getattr(self.model.column, name)
            for name in self.spreads
            if name not in self.given.spreads
        }
        if not factors:
            return bodies
        changed = {**bodies, **{name: bodies[name] * factor for name, factor in factors.items()}}
        # The room between both moments differs between samples of other numbers.
        changed["axial_inertia"] = np.minimum(changed["axial_inertia"], 2.0 * changed["transverse_inertia"])
        of_columns = unchecked(self.model.column, **{name: changed[name] for name in OF_RUNS})
        return {**changed, "frequency_parameter": np.asarray(of_columns.frequency_parameter)}

    @property
    def base(self) -> Model:
        """The nominal model without the height of the body, which would bound the samples of other objects."""
        with unquestioned():
            changed: Model = replace(self.model, column=replace(self.model.column, height=None))  # type: ignore[type-var]
        return changed


@contextmanager
def unquestioned() -> Iterator[None]:
    """Ignore warnings about unlikely numbers, for samples of numbers that have been questioned."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnlikelyInputWarning)
        yield


def require_model(kind: str) -> None:
    """Raise ParameterError unless the package has a three-dimensional model of this kind that never slips."""
    known = [name for name, make in MODELS.items() if name != "sliding" and not getattr(make, "planar_only", False)]
    if kind not in known:
        raise ParameterError(
            f"model: must be three-dimensional with permanent contact (got {kind!r}). Use {', '.join(known)}."
        )


def name_of_constructor(make: Callable[..., Column]) -> str:
    """Return the name of a constructor, with the arguments that it already has, such as the corners of a profile."""
    return f"{make.func.__qualname__} {make.args} {make.keywords}" if isinstance(make, partial) else make.__qualname__


def _quantity(model: Model, name: str) -> Quantity:
    return parameters_of(type(model))[name].quantity
