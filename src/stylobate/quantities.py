"""Declare a number once, at its field or argument: `Annotated[float, Quantity(symbol="η", …)]`.

Checks, bounds in studies, units and names in Datasets, the controls of the laboratory, and how an object shows itself
follow from the declaration: `parameters_of` reads it from a frozen dataclass or from a named constructor, `derived_of`
from the properties of a class.
"""

import inspect
import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from enum import Enum, StrEnum
from functools import cache, wraps
from types import NoneType
from typing import Annotated, Any, Literal, ParamSpec, TypeVar, get_args, get_origin

import numpy as np
import numpy.typing as npt

from stylobate.cards import CardSection, Row, card
from stylobate.compiler import marks
from stylobate.errors import (
    LARGEST,
    MOST_NUMBERS,
    Most,
    ParameterError,
    UnlikelyInputWarning,
    as_float,
    refuse_unknown_arguments,
    require_size,
    require_vector,
    require_whole,
    sizes,
)
from stylobate.kinds import new_of, place_of
from stylobate.text import four_digits
from stylobate.units import listed, meant, read_all

_P = ParamSpec("_P")
_T = TypeVar("_T")

# Members of a tuple of objects that a line or a card shows.
_SHOWN = 3

_CF_POWERS = str.maketrans({"²": "2", "³": "3"})

QUARTER_TURN = math.pi / 2.0
"""Bound of the angles that cannot reach it [rad]."""

# Angles of several turns in whole steps of 5 are more likely degrees.
_TURNS, _STEP = 15.0, 5.0
# A refused angle below this [rad] was meant in rad.
_FEWEST_DEGREES = 2.0


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Quantity:
    """Declaration of a number: symbol, unit, meaning and range of values.

    Parameters
    ----------
    symbol
        Symbol in equations, such as "η"; empty without symbol.
    unit
        Unit in text, such as "m/s²"; empty for a dimensionless number.
    text
        Meaning in a few words, as on an axis.
    ge, gt, le, lt
        Bounds: greater or equal, greater, less or equal, less.
    whole
        Whether only whole numbers are valid in studies.
    unlikely_above
        Magnitude above which a number is possible but more likely has another unit; None for no such limit.
    unlikely_below
        Magnitude below which a number is possible but more likely has another unit; None for no such limit.
    note
        Remedy, added to the bounds in a message.
    slider
        Range of a control; None if the range depends on the case.
    components
        Number of components.
    choices
        Allowed values; empty for any value within the bounds.
    dissipates
        Whether the number dissipates energy of the column.
    lossless
        Value of a dissipation parameter without energy loss.
    by_word
        Words that descriptions accept in place of the number, and the function that computes it for the column.
    in_repr
        Whether the `repr` of an object shows the number; its card always does.
    """

    symbol: str = ""
    unit: str = ""
    text: str = ""
    ge: float | None = None
    gt: float | None = None
    le: float | None = None
    lt: float | None = None
    whole: bool = False
    unlikely_above: float | None = None
    unlikely_below: float | None = None
    note: str = ""
    slider: tuple[float, float] | None = None
    components: int = 1
    choices: tuple[int, ...] = ()
    dissipates: bool = False
    lossless: float = 0.0
    by_word: Mapping[str, Callable[[Any], float]] = field(default_factory=dict, hash=False)
    in_repr: bool = True

    def __repr__(self) -> str:
        """Write the declaration as in signatures: symbol, unit and bounds."""
        unit = f"in {self.unit}" if self.unit else ""
        return " ".join(
            part for part in (self.symbol, unit, self.demand.removeprefix("be ").removeprefix("lie ")) if part
        )

    def __get_pydantic_core_schema__(self, source: Any, handler: Callable[[Any], Any]) -> Mapping[str, Any]:
        """Let fields of descriptions read numbers with a unit, such as "1.2 mm"; pydantic calls this."""
        reading = {"type": "no-info", "function": lambda value: read_all(value, self.unit)}
        return {"type": "function-before", "function": reading, "schema": handler(source)}

    @property
    def demand(self) -> str:
        """The range in words, behind "must"."""
        if self.le is not None and self.gt is not None:
            above = "be positive" if self.gt == 0.0 else f"be above {self.gt:g}"
            return f"{above} and at most {_bound(self.le)}"
        high = self.lt if self.le is None else self.le
        if high is not None:
            return f"lie between {_bound(self.ge or self.gt or 0.0)} and {_bound(high)}"
        if self.gt is not None:
            return "be positive" if self.gt == 0.0 else f"be above {self.gt:g}"
        if self.whole:
            return f"be a whole number from {self.ge or 0.0:g} on"
        if self.ge:
            return f"be {self.ge:g} or more"
        return "be finite" if self.ge is None else "be zero or positive"

    @property
    def cf_units(self) -> str:
        """The unit in netCDF files: "m s-2" for "m/s²", "1" for a dimensionless number."""
        above, _, below = self.unit.translate(_CF_POWERS).partition("/")
        inverse = (f"{part}-1" if part.isalpha() else f"{part[:-1]}-{part[-1]}" for part in below.split())
        return " ".join((*(one for one in above.split() if one != "1"), *inverse)) or "1"

    def plain(self, values: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Check which values `checked` returns without an error or a warning."""
        low, high = sizes(self.unit)
        size = np.abs(values)
        inside = self.accepts(values) & (size <= high)
        if self._above_zero:
            inside &= size >= low
        if self.unlikely_above is None:
            return inside if self.unit != "rad" else inside & ((size < _TURNS) | (values % _STEP != 0.0))
        return inside & (size >= (self.unlikely_below or 0.0)) & (size <= self.unlikely_above)

    @property
    def _above_zero(self) -> bool:
        return self.gt is not None and self.gt >= 0.0

    def shown(self, value: Any) -> str:
        """Format a value of the quantity, with four digits and its unit."""
        return f"{_shown(value)} {self.unit}".rstrip()

    def for_column(self, stated: Any, column: Any) -> Any:
        """Return the number that a description states: that of a word for this column, or the number itself."""
        found = self.by_word.get(stated) if isinstance(stated, str) else None
        return stated if found is None else found(column)

    def accepts(self, values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Check which values are inside the bounds; NaN and infinities are not."""
        array = np.asarray(values, dtype=float)
        inside: npt.NDArray[np.bool_] = np.isfinite(array)
        if self.ge is not None:
            inside &= array >= self.ge
        if self.gt is not None:
            inside &= array > self.gt
        if self.lt is not None:
            inside &= array < self.lt
        if self.whole:
            inside &= array % 1.0 == 0.0
        return inside & (array <= (LARGEST if self.le is None else self.le))

    def checked(self, name: str, value: Any) -> float:
        """Check `value` and return it as a float; a quantity of pint or astropy is converted.

        Raises
        ------
        ParameterError
            If the value is not a real number, has a unit of another dimension, is outside the bounds, or is too large
            to compute with.

        Warns
        -----
        UnlikelyInputWarning
            If the value was more likely meant in another unit.
        """
        number = as_float(name, value, self.unit)
        if not self._allows(number):
            raise ParameterError(self.refusal(name, number))
        require_size(name, number, self.unit, zero=not self._above_zero)
        self.question(name, number)
        return number

    def refusal(self, name: str, number: float) -> str:
        """Write the message for a number outside of the bounds."""
        demand = f"{self.demand}, {self.note}" if self.note else self.demand
        remedy = degrees_meant(number, self._allows) if self.unit == "rad" else ""
        return f"{name} must {demand}, got {number!r} {self.unit}".rstrip() + (f". {remedy}" if remedy else "")

    def question(self, name: str, number: float) -> None:
        """Issue an UnlikelyInputWarning for a number that was more likely meant in another unit."""
        if self.unlikely_above is None:
            unlikely = self.unit == "rad" and abs(number) >= _TURNS and number % _STEP == 0.0
        else:
            unlikely = not (self.unlikely_below or 0.0) <= abs(number) <= self.unlikely_above
        if unlikely:
            lowest, highest = self.unlikely_below or 0.0, _TURNS if self.unlikely_above is None else self.unlikely_above
            remedy = meant(number, self.unit, lambda value: lowest <= abs(value) <= highest)
            remedy = remedy or f"Check its unit, such as {listed(self.unit)}."
            question_input(f"{name}: {number:.6g} {self.unit} is unlikely. {remedy}")

    def _allows(self, number: float) -> bool:
        above = (self.ge is None or number >= self.ge) and (self.gt is None or number > self.gt)
        below = (self.le is None or number <= self.le) and (self.lt is None or number < self.lt)
        return above and below and math.isfinite(number)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A declared argument: a number or a choice."""

    name: str
    quantity: Quantity
    annotation: Any
    default: Any = inspect.Parameter.empty

    @property
    def required(self) -> bool:
        """Whether the argument has no default."""
        return self.default is inspect.Parameter.empty

    @property
    def choices(self) -> tuple[Any, ...]:
        """Allowed words or whole numbers; empty for any number within the bounds."""
        return get_args(self.annotation) if get_origin(self.annotation) is Literal else self.quantity.choices

    @property
    def whole(self) -> bool:
        """Whether the number is whole."""
        return self.annotation is int or int in get_args(self.annotation)

    @property
    def optional(self) -> bool:
        """Whether None is allowed."""
        return NoneType in get_args(self.annotation)

    def checked(self, value: Any) -> Any:
        """Check `value` and return it as a float, a tuple of floats, a whole number or a choice.

        Raises
        ------
        ParameterError
            If the value is not allowed.
        """
        if (value is None and self.optional) or (self.annotation is str and isinstance(value, str)):
            return value
        quantity = self.quantity
        if self.choices:
            if value in self.choices:
                return self.choices[self.choices.index(value)]
            remedy = f": {quantity.text}" if quantity.choices else ""
            raise ParameterError(f"{self.name} must be {' or '.join(map(repr, self.choices))}, got {value!r}{remedy}")
        if quantity.components > 1:
            numbers = require_vector(self.name, value, quantity.components, quantity.unit)
            return tuple(quantity.checked(f"{self.name}[{i}]", number) for i, number in enumerate(numbers))
        if self.whole and quantity.ge is not None:
            most = MOST_NUMBERS if quantity.le is None else Most(int(quantity.le), quantity.note)
            return require_whole(self.name, value, least=int(quantity.ge), most=most)
        if isinstance(self.annotation, type) and issubclass(self.annotation, StrEnum):
            return _member(self.annotation, self.name, value)
        return quantity.checked(self.name, value)


class Declared:
    """A frozen dataclass whose declared numbers are checked where it is made, and shown in its `repr` and its card."""

    __slots__ = ()

    def __init_subclass__(cls, **options: Any) -> None:
        """Keep the `repr` of declared numbers, in place of which a dataclass would write its own."""
        super().__init_subclass__(**options)
        if "__repr__" not in vars(cls):
            cls.__repr__ = cls.__repr__  # type: ignore[method-assign]  # a dataclass leaves a method of the class

    def __post_init__(self) -> None:
        """Check the numbers by their declarations, then all of them together by `validate`."""
        check_declared(self)
        self.validate()

    def validate(self) -> None:
        """Raise ParameterError for numbers that contradict each other; each number has been checked before."""

    @property
    def consistent(self) -> Any:
        """Whether `validate` accepts the numbers; for a value made by `unchecked` of arrays, an array of bools."""
        return True

    def _call(self) -> tuple[Callable[..., Any], Mapping[str, Any]]:
        """Return the constructor of the value, and its arguments: by default its class and its fields."""
        return type(self), _fields_of(self)

    def __repr__(self) -> str:
        """Write the value in one line: arguments other than defaults, with units, then the derived numbers."""
        make, arguments = self._call()
        declared, signature = parameters_of(make), inspect.signature(make).parameters
        given = {
            name: _with_unit(value, declared.get(name))
            for name, value in arguments.items()
            if name in signature and _in_repr(declared.get(name)) and not _is_default(value, signature[name].default)
        }
        # A method of another motion is written as its call.
        called = f"{arguments['motion']!r}.{make.__name__}" if "self" in signature else _name_of(make)
        derived = {
            one.quantity.symbol or one.name: one.quantity.shown(value)
            for one, value in self._derived()
            if _in_repr(one)
        }
        return f"{called}({'; '.join(_listed(numbers) for numbers in (given, derived) if numbers)})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        return card(self._title(), self._sections())

    def _title(self) -> str:
        make, _ = self._call()
        return type(self).__name__ if "self" in inspect.signature(make).parameters else _name_of(make)

    def _sections(self, *, derived: bool = True) -> list[CardSection]:
        """Return the rows of the card: the arguments, the derived numbers, then the rows of each object among both.

        Objects in an object with derived numbers show none of their own.
        """
        make, arguments = self._call()
        declared = parameters_of(make)
        inner = {name: value for name, value in arguments.items() if isinstance(value, Declared)}
        rows = [_row(name, value, declared.get(name)) for name, value in arguments.items() if name not in inner]
        numbers = [_row(one.name, value, one) for one, value in self._derived()] if derived else []
        sections = [CardSection("", rows), CardSection("derived", numbers)]
        for name, value in inner.items():
            own, *others = value._sections(derived=derived and not numbers)  # noqa: SLF001  of the same class, as below
            sections += [CardSection(f"{name}: {value._title()}", own.rows), *others]  # noqa: SLF001
        return sections

    def _derived(self) -> list[tuple["Parameter", Any]]:
        """Return the declared derived numbers with their values, without those that the object does not have."""
        kind: Any = type(self)
        values = ((one, getattr(self, name)) for name, one in derived_of(kind).items())
        called = ((one, value() if callable(value) else value) for one, value in values)
        return [(one, value) for one, value in called if value is not None and np.all(np.isfinite(value))]

    def __reduce_ex__(self, protocol: Any) -> Any:
        """Pickle a value of a class from a user's file by the place of the class; another process can load it then."""
        place = place_of(type(self))
        if not place.rpartition(":")[0].endswith(".py"):
            return object.__reduce_ex__(self, protocol)
        return new_of, (place,), self.__getstate__()


def cf_attributes(units: str, long_name: str) -> dict[str, str]:
    """Return the attributes of a variable of a Dataset by the CF conventions."""
    return {"units": units, "long_name": long_name}


def exact_repr(value: Any) -> str:
    """Write a value with all fields and all digits, for the provenance of a run that no description can repeat."""
    if isinstance(value, tuple):
        return f"({', '.join(map(exact_repr, value))})"
    if not isinstance(value, Declared) or vars(type(value))["__repr__"] is not vars(Declared)["__repr__"]:
        return repr(value)  # a class with a text of its own
    return f"{type(value).__qualname__}({_listed({name: exact_repr(one) for name, one in _fields_of(value).items()})})"


def _fields_of(value: Any) -> dict[str, Any]:
    if not is_dataclass(value):
        return {name: getattr(value, name) for name in parameters_of(value.__class__) if hasattr(value, name)}
    return {one.name: getattr(value, one.name) for one in fields(value) if one.init and one.repr}


def _listed(numbers: Mapping[str, str]) -> str:
    return ", ".join(f"{name}={value}" for name, value in numbers.items())


def _name_of(make: Callable[..., Any]) -> str:
    return make.__qualname__.rpartition("<locals>.")[2]


def _in_repr(parameter: "Parameter | None") -> bool:
    return parameter is None or parameter.quantity.in_repr


def _is_default(value: Any, default: Any) -> bool:
    return value is default or (isinstance(value, (int, float, str, tuple)) and value == default)


def _row(name: str, value: Any, parameter: "Parameter | None") -> Row:
    text = "–" if value is None else value if isinstance(value, str) else _with_unit(value, parameter)
    quantity = Quantity() if parameter is None else parameter.quantity
    return Row(name.replace("_", " "), text, quantity.symbol, quantity.text)


def _with_unit(value: Any, parameter: "Parameter | None") -> str:
    return _shown(value) if parameter is None or value is None else parameter.quantity.shown(value)


def _shown(value: Any) -> str:
    """Describe a value in one line."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return four_digits(value)
    if isinstance(value, (tuple, list)):
        listed = [_shown(one) for one in value[:_SHOWN]]
        more = [f"… {len(value) - _SHOWN} more"] if len(value) > _SHOWN else []
        return f"({', '.join([*listed, *more])})"
    if isinstance(value, np.ndarray):
        return f"array of shape {value.shape}"
    return " ".join((repr(value.value) if isinstance(value, Enum) else repr(value)).split())


@cache
def parameters_of(make: Callable[..., Any]) -> Mapping[str, Parameter]:
    """Return the declared arguments of a dataclass or of a named constructor, by name.

    Arguments without a `Quantity`, such as a model's column, are left out.
    """
    try:
        signature = inspect.signature(make, eval_str=True)
    except NameError:  # a name that is imported for type checking only
        signature = inspect.signature(make)
    arguments = signature.parameters.items()
    declared = (parameter_of(name, argument.annotation, argument.default) for name, argument in arguments)
    return {one.name: one for one in declared if one is not None}


@cache
def derived_of(kind: Any) -> Mapping[str, Parameter]:
    """Return the declared derived numbers of a class by name: its properties, and its methods that need no argument.

    A subclass that overrides such a property need not declare it again.
    """
    found: dict[str, Parameter] = {}
    for name, member in (item for base in reversed(kind.__mro__) for item in vars(base).items()):
        function = member.fget if isinstance(member, property) else member
        annotation = getattr(function, "__annotations__", {}).get("return")
        parameter = parameter_of(name, annotation, inspect.Parameter.empty)
        if parameter is not None:
            found[name] = parameter
    return found


def parameter_of(name: str, annotation: Any, default: Any) -> Parameter | None:
    """Read the parameter that an annotation declares; None if it declares no quantity."""
    quantity = _declared(annotation)
    return None if quantity is None else Parameter(name, quantity, _without_declaration(annotation), default)


@cache
def _argument_names(make: Callable[..., Any]) -> frozenset[str]:
    return frozenset(inspect.signature(make).parameters)


def is_declared(make: Callable[..., Any], *others: str) -> bool:
    """Return whether a dataclass is made by declared numbers and these `others` alone."""
    return is_dataclass(make) and _argument_names(make) <= {*parameters_of(make), *others}


@dataclass(frozen=True, slots=True)
class Stated:
    """The named constructor that made a value, and its arguments other than defaults."""

    constructor: str
    arguments: Mapping[str, Any]


def checked_arguments(make: Callable[_P, _T]) -> Callable[_P, _T]:
    """Check and convert the declared arguments of a named constructor, as `check_declared` does; a decorator.

    A value with a field `stated` keeps the arguments there. Of constructors that call each other, the outermost counts.
    """

    @wraps(make)
    def checking(*arguments: _P.args, **values: _P.kwargs) -> _T:
        refuse_unknown_arguments(make, values)
        declared = parameters_of(make)
        checked: Any = {name: declared[name].checked(one) if name in declared else one for name, one in values.items()}
        made = make(*arguments, **checked)
        if hasattr(made, "stated"):
            usual = {name: one.default for name, one in declared.items()}
            stated = {name: value for name, value in checked.items() if value != usual.get(name)}
            object.__setattr__(made, "stated", Stated(make.__name__, stated))
        return made

    return marks.stands_for(checking, make)


def stating(**facts: bool) -> Callable[[Callable[_P, _T]], Callable[_P, _T]]:
    """State facts of a named constructor that differ from those of its class; a decorator."""

    def state(make: Callable[_P, _T]) -> Callable[_P, _T]:
        vars(make).update(facts)
        return make

    return state


def states(make: object, fact: str) -> bool:
    """Return whether a class, or a named constructor or else its class, states a fact as `fact = True`."""
    return bool(getattr(make, fact, getattr(getattr(make, "__self__", make), fact, False)))


def check_declared(made: Any) -> None:
    """Check the declared numbers of a frozen dataclass and convert them to floats.

    Raises
    ------
    ParameterError
        If a number violates its declaration.
    """
    for name, parameter in parameters_of(made.__class__).items():
        object.__setattr__(made, name, parameter.checked(getattr(made, name)))


def unchecked(value: _T, **numbers: Any) -> _T:
    """Copy a frozen dataclass with these numbers, such as arrays of the numbers of many runs, without checks."""
    made = object.__new__(type(value))
    for one in fields(value):  # type: ignore[arg-type]  # a dataclass
        object.__setattr__(made, one.name, numbers.get(one.name, getattr(value, one.name)))
    return made


@marks.advice
def question_input(message: str) -> None:
    """Issue an UnlikelyInputWarning at the line outside of this package that states a number.

    A number that a named constructor passes on to another one is not questioned again.
    """
    frame, level, checks = inspect.currentframe(), 1, 0
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __package__:
        checks += frame.f_code.co_name in ("checking", "check_declared")  # one for each constructor
        frame, level = frame.f_back, level + 1
    if checks <= 1:
        warnings.warn(message, UnlikelyInputWarning, stacklevel=level if frame else 1)


def degrees_meant(number: float, fits: Callable[[float], bool] = lambda angle: abs(angle) < QUARTER_TURN) -> str:
    """Return a remedy for an angle [rad] that was meant in degrees; "" unless it `fits` then."""
    return meant(number, "rad", fits) if _FEWEST_DEGREES <= abs(number) < math.inf else ""


def _bound(number: float) -> str:
    return f"{math.copysign(1.0, number):g}"[:-1] + "π/2" if abs(number) == QUARTER_TURN else f"{number:g}"


def _member(kind: type[StrEnum], name: str, value: Any) -> StrEnum:
    try:
        return kind(value)
    except ValueError:
        raise ParameterError(f"{name} must be one of {', '.join(kind)}, got {value!r}") from None


def _declared(annotation: Any) -> Quantity | None:
    """Return the quantity of an annotation, or of a part of it as in `Damping | None`."""
    own = [one for one in getattr(annotation, "__metadata__", ()) if isinstance(one, Quantity)]
    parts = (_declared(part) for part in get_args(annotation))
    return next((one for one in (*own, *parts) if one is not None), None)


def _without_declaration(annotation: Any) -> Any:
    """Return the type alone."""
    if get_origin(annotation) is Annotated:
        return get_args(annotation)[0]
    if NoneType in get_args(annotation):
        return next(_without_declaration(one) for one in get_args(annotation) if one is not NoneType) | None
    return annotation
