"""Exceptions, the checks that raise them, and the outcomes of a run.

::

    StylobateError
    ├── ParameterError (ValueError)    a number or an option that no column, motion or run can have
    │   ├── ConfigError           the same in a TOML or JSON description: one line for each mistake
    │   └── ModelError                 a model whose members contradict each other: one line for each mistake
    ├── UnsupportedError               a study that the model does not support
    ├── NoOrbitError                   no periodic orbit was reached from a guess
    ├── UnknownNameError (KeyError)    a name that a result does not have
    ├── FileError                      a file that cannot be read or written
    └── WorkerLostError                a worker process that ended before its result

    Interrupted (KeyboardInterrupt)    Ctrl-C in the middle of many runs; carries what had been computed
    UnlikelyInputWarning (UserWarning)          input that is possible, but is more likely a mistake
    EndedEarlyWarning (UserWarning)             a run that ended before its numbers were known: they are NaN

Misuse raises an exception. A physical result, numerical failure included, is an `Outcome`.
"""

import inspect
import math
import warnings
from collections.abc import Callable, Iterable, Sequence
from enum import IntEnum
from functools import cache
from typing import Any, NamedTuple

from stylobate import units
from stylobate.text import UNPRINTABLE, did_you_mean

SMALLEST, LARGEST = 1e-30, 1e15
"""Limits for the size of a number other than zero: numbers of columns are far inside, and no product overflows."""


class Most(NamedTuple):
    """Maximum of a count, and the reason for it."""

    number: int
    reason: str


MOST_NUMBERS = Most(10_000_000, "each number takes memory")
MOST_RUNS = Most(10**12, "a million runs per second take 12 days")
MOST_STEPS = Most(2**31 - 1, "steps are counted in 32 bits")
MOST_THREADS = Most(4096, "no machine has more cores")
LARGEST_SEED = Most(2**63, "seeds have 63 bits")

# Units of quantities that grow with the third to fifth power of a length.
_SIZES = dict.fromkeys(("kg", "kg m²", "kg m2"), (1e-150, 1e150))


class StylobateError(Exception):
    """Base class of the exceptions that stylobate raises."""


class ParameterError(StylobateError, ValueError):
    """Invalid argument of a column, base motion or run; the message names argument, value and remedy."""


class _ProblemsError(ParameterError):
    """Several mistakes at once."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))


class ConfigError(_ProblemsError):
    """A TOML or JSON description with mistakes.

    Attributes
    ----------
    problems
        One line for each mistake.
    """


class ModelError(_ProblemsError):
    """A model of a user's own whose members contradict each other or its equations.

    Attributes
    ----------
    problems
        One line for each mistake.
    """


class UnsupportedError(StylobateError):
    """A study or run asks for something the model does not provide."""


class NoOrbitError(StylobateError):
    """No periodic orbit was reached from a guess; the message says how the search ended."""


class UnknownNameError(StylobateError, KeyError):
    """A name that a result does not have; the message suggests the most similar one."""

    __str__ = Exception.__str__  # a KeyError quotes its message


class FileError(StylobateError):
    """A file that cannot be read or written; the message names it."""


class WorkerLostError(StylobateError):
    """A worker process died before its result, for example because memory ran out."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C interrupted a computation of many runs.

    Attributes
    ----------
    partial
        The result so far, an xarray.Dataset; runs that were not computed have outcome −1 and NaN. None if Ctrl-C came
        before the first result, during imports or compilation.
    """

    def __init__(self, message: str, partial: Any) -> None:
        super().__init__(message)
        self.partial = partial


class UnlikelyInputWarning(UserWarning):
    """Input that is possible but unlikely; the message names it and the remedy."""


class EndedEarlyWarning(UserWarning):
    """A run that ended before its numbers were known, so that they are NaN; the message names outcome and time."""


class Named:
    """An enumeration whose members equal their names in text: `run.outcome == "AT_REST"`, or "at rest".

    Comparison with a text that names no member warns. In sets and as keys members differ from their names.
    """

    name: str
    value: Any

    def __eq__(self, other: object) -> bool:
        return self._names(other) if isinstance(other, str) else super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        return not self._names(other) if isinstance(other, str) else super().__ne__(other)

    def __hash__(self) -> int:
        return super().__hash__()

    def _names(self, text: str) -> bool:
        names: Any = type(self).__members__  # type: ignore[attr-defined]
        known = {text: member for member in names.values() for text in member.texts}
        if text not in known:
            remedy = did_you_mean(text, known) or f"use one of {', '.join(names)}"
            message = f"{type(self).__name__}: compared with a text that names none (got {text!r}); {remedy}"
            warnings.warn(message, UnlikelyInputWarning, stacklevel=3)
        return known.get(text) is self

    @property
    def label(self) -> str:
        """The label in text, such as "at rest"."""
        return self.name.lower().replace("_", " ")

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts that the member equals: its name, its label, and its value if that is a text."""
        return (self.name, self.label, *([self.value] if isinstance(self.value, str) else []))


class Outcome(Named, IntEnum):
    """Outcome of a run: a code, as in arrays and files, with a label. It equals its name and its label in text.

    Examples
    --------
    >>> import stylobate as sb
    >>> print(sb.Outcome(4), sb.Outcome.OVERTURNED.name, int(sb.Outcome.OVERTURNED))
    overturned OVERTURNED 4
    """

    AT_REST = 0
    """The column stands on its base and the base motion cannot uplift it, or it stood to the end of the run."""
    ROCKING = 1
    """Periodic motion; the contact point does not travel round the rim."""
    ROLLING = 2
    """Periodic motion; the contact point travels once round the rim in each period of the base motion."""
    MODULATED = 3
    """Rolling at the mean rate of the base motion with a modulated tilt; the motion does not repeat."""
    OVERTURNED = 4
    """The column cannot come back; if the model has no proof of this, it passed a stated limit."""
    STILL_MOVING = 5
    """No other outcome by the end of the run: the column may overturn later, or its motion is free or not steady."""
    LIMIT_REACHED = 6
    """The tilt reached the limit that the user set."""
    LIFTED_OFF = 7
    """The base dropped away, and the contact would need tension. A model that can fly continues to the end."""
    FAILED = 8
    """The integration failed; `reason` of the run states the cause."""
    SLID = 9
    """The column stands upright to the end, and its base slides."""
    SURVIVED = 10
    """The column survived a base motion that ends: it still moves, and has too little energy to overturn.

    A column that has come to rest by the end of the run is AT_REST; a column that may overturn later is STILL_MOVING.
    """
    STOPPED = 11
    """A terminal event function ended the run: see `EventFunction`."""
    PERIODIC = 12
    """Periodic motion that is neither rolling nor rocking: it repeats after one to eight periods of the base motion."""
    APERIODIC = 13
    """Stationary motion that does not repeat and does not roll at the mean rate of the base motion.

    It is chaotic, or quasi-periodic, such as rolling at another mean rate.
    """

    def __str__(self) -> str:
        return self.label

    def __repr__(self) -> str:
        return f"<Outcome.{self.name}: {self.label!r}>"

    def __format__(self, spec: str) -> str:
        return format(self.label, spec)


def refuse_unknown_arguments(function: Callable[..., Any], names: Iterable[str]) -> None:
    """Raise TypeError, with a suggestion, if the function has no keyword argument of one of these names."""
    known = _argument_names(function)
    for name in names:
        if known and name not in known:
            question = did_you_mean(name, known)
            raise TypeError(
                f"{function.__qualname__}() got an unexpected keyword argument {name!r}; {question}".rstrip("; ")
            )


@cache
def _argument_names(function: Callable[..., Any]) -> frozenset[str]:
    """Return the names of the arguments; empty if any name is accepted."""
    arguments = inspect.signature(function).parameters
    accepts_any = any(one.kind is one.VAR_KEYWORD for one in arguments.values())
    return frozenset(() if accepts_any else arguments)


def require_finite(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a float, or raise ParameterError unless it is a finite real number."""
    number = as_float(name, value, unit)
    if not math.isfinite(number):
        raise ParameterError(f"{name} must be finite, got {_quantity(number, unit)}")
    require_size(name, number, unit)
    return number


def require_positive(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a float, or raise ParameterError unless it is finite and above zero."""
    number = as_float(name, value, unit)
    if not (math.isfinite(number) and number > 0.0):
        raise ParameterError(f"{name} must be positive, got {_quantity(number, unit)}")
    require_size(name, number, unit, zero=False)
    return number


def _accepted(_name: str, value: float, _unit: str = "") -> float:
    """Return `value`: what compiled code does in place of a check of its arguments."""
    return value


vars(require_positive)["compiled"] = _accepted


def require_not_negative(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a float, or raise ParameterError unless it is finite and zero or above."""
    number = as_float(name, value, unit)
    if not (math.isfinite(number) and number >= 0.0):
        raise ParameterError(f"{name} must be zero or positive, got {_quantity(number, unit)}")
    require_size(name, number, unit)
    return number


def require_vector(name: str, value: Sequence[float], length: int, unit: str = "") -> tuple[float, ...]:
    """Return `value` as a tuple of `length` finite floats, or raise ParameterError."""
    value = as_numbers(name, value, unit)
    try:
        numbers = () if isinstance(value, (str, bytes)) else tuple(value)
    except TypeError:
        numbers = ()
    if len(numbers) != length:
        raise ParameterError(f"{name} must have {length} numbers, got {value!r}")
    return tuple(require_finite(f"{name}[{i}]", number, unit) for i, number in enumerate(numbers))


def require_whole(name: str, value: int, *, least: int, most: Most = MOST_NUMBERS) -> int:
    """Return `value` as an int, or raise ParameterError unless it is a whole number from `least` to `most`."""
    number = as_float(name, value)
    if not (number >= least and number.is_integer()):
        raise ParameterError(f"{name} must be a whole number of at least {least}, got {value!r}")
    if number > most.number:
        raise ParameterError(f"{name}: too large (got {value!r}). Give at most {most.number}: {most.reason}.")
    return int(value)


def require_name(where: str, name: str) -> str:
    """Return a name, or raise ParameterError unless it is a text that is not blank and can be printed."""
    if not isinstance(name, str) or not name.strip():
        raise ParameterError(f"{where}: must be a text that is not empty (got {name!r}). State a name.")
    return require_printable(where, name)


def require_printable(where: str, text: str) -> str:
    """Return `text`, or raise ParameterError if it holds a character that cannot be printed, such as a control."""
    if found := UNPRINTABLE.search(text):
        raise ParameterError(f"{where}: holds a character that cannot be printed (got {found[0]!r}). Remove it.")
    return text


def sizes(unit: str) -> tuple[float, float]:
    """Return the smallest and the largest magnitude of a number of this unit whose products do not overflow."""
    return _SIZES.get(unit, (SMALLEST, LARGEST))


def require_size(name: str, number: float, unit: str = "", *, zero: bool = True) -> None:
    """Raise ParameterError for a number so large or small that its products overflow; with `zero` only if large."""
    low, high = sizes(unit)
    if (zero or abs(number) >= low) and abs(number) <= high:
        return
    problem, limit = ("too large", f"at most {high:g}") if abs(number) > high else ("too small", f"at least {low:g}")
    of = f" {unit}" if unit else ""
    raise ParameterError(
        f"{name}: {problem} to compute with (got {_quantity(number, unit)}). Give {limit}{of}; check the unit."
    )


def as_float(name: str, value: Any, unit: str = "") -> float:
    """Return `value` as a float, or raise ParameterError unless it is a real number; NaN and infinities pass.

    A quantity of pint or astropy is converted to `unit`.
    """
    if type(value) is not float:
        value = as_numbers(name, value, unit)
    try:
        # The sum rejects strings, even those that spell a number.
        return float(value + 0.0)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError(f"{name} must be a real number, got {value!r}") from None


def as_numbers(name: str, value: Any, unit: str = "") -> Any:
    """Convert a quantity of pint or astropy, or a list of them, to numbers in `unit`; other values are unchanged.

    Raises
    ------
    ParameterError
        If the quantity has another dimension or an unknown unit.
    """
    try:
        return units.in_unit(value, unit)
    except units.UnitError as error:
        raise ParameterError(f"{name} {error}") from None


def _quantity(value: float, unit: str) -> str:
    return f"{float(value)!r} {unit}".rstrip()
