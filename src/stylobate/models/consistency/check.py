"""Consistency checks of a model: all of them on request, the cheap ones before its first run."""

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from stylobate.errors import ModelError, ParameterError
from stylobate.models.consistency.claims import (
    balance_of,
    dissipation,
    loss_of_speed,
    problems_of_balance,
    problems_of_closed_form,
    problems_of_coming_to_rest,
    problems_of_departure,
    problems_of_loss,
    problems_of_no_return,
    problems_of_passage,
    problems_of_rest,
    steady_rolling,
)
from stylobate.models.consistency.equations import (
    compilation,
    lean_under_push,
    problems_in_planes,
    problems_of_compilation,
    problems_of_derivatives,
    problems_of_forces,
    problems_of_lift,
    problems_of_maps,
    problems_of_push,
    problems_of_tilt_rate,
    weight_under_lift,
)
from stylobate.models.consistency.samples import (
    Subject,
    problems_of_lengths,
    problems_of_members,
    problems_of_signatures,
)
from stylobate.models.model import Model


class Law(NamedTuple):
    """A comparison of a member with other members or with the equations.

    Parameters
    ----------
    member
        Name of the member.
    problems
        Function that yields a line for each contradiction.
    finding
        Text or function that states what holds without a contradiction; "" for a member without a claim.
    """

    member: str
    problems: Callable[[Subject], Iterator[str]]
    finding: str | Callable[[Subject], str]


# Each stage requires that the stages before it found no problem.
_STAGES: tuple[tuple[Law, ...], ...] = (
    (Law("name", problems_of_members, ""),),
    (Law("parameters", problems_of_signatures, "each function takes them as its last arguments"),),
    (Law("state_names", problems_of_lengths, "each function returns as many numbers as needed"),),
    (Law("start", problems_of_maps, "makes a state with the tilt and the rate that tilt_of returns"),),
)
_OF_EQUATIONS: tuple[Law, ...] = (
    Law("tilt_of", problems_of_tilt_rate, "returns the derivative of the tilt along rates"),
    Law("rates", problems_of_push, lean_under_push),
    Law("rates", problems_of_lift, weight_under_lift),
    Law("rates", problems_of_compilation, compilation),
)

# For models with one kind of contact.
_OF_ONE_CONTACT: tuple[Law, ...] = (
    Law("planar_rates", problems_in_planes, "agrees with rates"),
    Law("contact", problems_of_forces, "is defined for these rates"),
    Law("no_return_tilt", problems_of_no_return, "no tilt beyond it falls back"),
    Law("balance", problems_of_balance, balance_of),
    Law("departure", problems_of_departure, "follows rates"),
    Law("comes_to_rest", problems_of_coming_to_rest, dissipation),
    Law("rest_energy", problems_of_rest, "never grows in free motion near the vertical"),
    Law("impact_map", problems_of_loss, loss_of_speed),
    Law("closed_form", problems_of_closed_form, steady_rolling),
)
_THOROUGH: tuple[Law, ...] = (
    Law("jacobian", problems_of_derivatives, "contains the derivatives of rates"),
    Law("passage", problems_of_passage, "ends in the same state as rates"),
)


@dataclass(frozen=True, slots=True, repr=False)
class CheckReport:
    """What `check` has compared without a contradiction; it prints a line for each comparison.

    Parameters
    ----------
    model
        Name of the class of the model.
    findings
        A line for each comparison: the member, a colon, and what holds.
    """

    model: str
    findings: tuple[str, ...]

    def __repr__(self) -> str:
        """Return the name of the class and all findings, one in each line."""
        return "\n".join([f"{self.model}: no contradictions", *(f"  {line}" for line in self.findings)])


def check(model: Model) -> CheckReport:
    """Check that the members of a model agree with each other and with its equations of motion.

    Call it in a test of a model of your own. It compares, at random states:

    * the members that a model needs, static functions, and results that are finite numbers;
    * the number of arguments and results of each function with `parameters` and `state_names`;
    * `start`, `tilt_of` and `from_plane` with each other, and the rate of the tilt with `rates`;
    * compiled with plain `rates` and `planar_rates`;
    * `planar_rates`, `contact`, `jacobian`, `comes_to_rest` and `closed_form` with `rates`;
    * `no_return_tilt` and `balance` with the inequalities that prove them;
    * `departure`, `passage`, `rest_energy` and `impact_map` with `rates` near the vertical;
    * the side to which the column leans if the base accelerates with the law of inertia.

    The first run of a model of your own makes the cheap comparisons by itself. Of a model that switches between kinds
    of contact only the first four and the last are compared.

    Parameters
    ----------
    model
        The model, with nonzero numbers: the check cannot detect that a zero term is missing.

    Returns
    -------
    CheckReport
        A line for each comparison.

    Raises
    ------
    ModelError
        If a member is wrong; `problems` has a line for each wrong member.
    ParameterError
        If `model` is not a model.

    Examples
    --------
    >>> import stylobate as sb
    >>> report = sb.models.check(sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1))
    >>> print(report.findings[4])
    rates: if the base accelerates to +x, the column leans to −x
    """
    if not isinstance(model, Model):
        raise ParameterError(f"model: must be a model such as Slender(column) (got {model!r}). Pass an instance.")
    subject = Subject(model, _numbers(model), thorough=True)
    _refuse(model, _problems(subject))
    laws = (*(law for stage in _STAGES for law in stage), *_laws(subject))
    return CheckReport(type(model).__name__, tuple(filter(None, (_finding(subject, law) for law in laws))))


_CHECKED: dict[tuple[type[Model], Callable[..., Any] | None, tuple[float, ...]], None] = {}
_REMEMBERED = 4096


def check_once(model: Model) -> None:
    """Make the cheap comparisons of `check` once per class, rates and parameters, except for classes of the package."""
    kind = type(model)
    if kind.__module__.startswith("stylobate.models."):
        return
    key = (kind, getattr(kind, "rates", None), _numbers(model))
    if key in _CHECKED:
        return
    _refuse(model, _problems(Subject(model, key[2], thorough=False)))
    if len(_CHECKED) >= _REMEMBERED:
        _CHECKED.clear()
    _CHECKED[key] = None


def _numbers(model: Model) -> tuple[float, ...]:
    try:
        return tuple(float(number) for number in model.parameters)
    except (TypeError, ValueError):
        _refuse(model, [f"parameters: must be numbers (got {model.parameters!r}). Return a tuple of floats."])
        raise


def _refuse(model: Model, problems: list[str]) -> None:
    if problems:
        raise ModelError([f"{type(model).__name__}.{problem}" for problem in problems])


def _problems(subject: Subject) -> list[str]:
    for stage in _STAGES:
        found = _found(subject, stage)
        if found:
            return found
    return _found(subject, _laws(subject))


def _laws(subject: Subject) -> tuple[Law, ...]:
    """Return the laws after the stages."""
    if subject.model.switches:
        return _OF_EQUATIONS
    return (*_OF_EQUATIONS, *_OF_ONE_CONTACT, *(_THOROUGH if subject.thorough else ()))


def _finding(subject: Subject, law: Law) -> str:
    """Return the line of a law that holds; "" if the model makes no such claim."""
    if getattr(subject.model, law.member) is None:
        return ""
    with _without_warnings():
        finding = law.finding if isinstance(law.finding, str) else law.finding(subject)
    return f"{law.member}: {finding}" if finding else ""


def _found(subject: Subject, laws: tuple[Law, ...]) -> list[str]:
    """Return the problems that are found; only a thorough check reports functions that raise."""
    problems: list[str] = []
    for law in laws:
        try:
            with _without_warnings():
                problems += law.problems(subject)
        except Exception as error:  # noqa: BLE001  a user's function may raise anything
            if subject.thorough:
                name = _member(subject.model, error) or law.member
                problems.append(f"{name}: raises {type(error).__name__} at a random state ({error}).")
    return problems


@contextmanager
def _without_warnings() -> Iterator[None]:
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def _member(model: Model, error: BaseException) -> str:
    """Return the name of the member of a model that raised, itself or in a function that it calls; "" if none did."""
    members = {_code(value): name for cls in reversed(type(model).__mro__) for name, value in vars(cls).items()}
    trace = error.__traceback__
    while trace is not None:
        name = members.get(trace.tb_frame.f_code)
        if name:
            return name
        trace = trace.tb_next
    return ""


def _code(value: Any) -> Any:
    """Return the code of a function, static method or property; None for other values."""
    function = getattr(value, "__func__", None) or getattr(value, "fget", None) or value
    return getattr(function, "__code__", None)
