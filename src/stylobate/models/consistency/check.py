"""Consistency checks of a model: all of them on request, the cheap ones before its first run."""

import warnings
from collections.abc import Callable, Iterator

import numpy as np

from stylobate.errors import ModelError, ParameterError
from stylobate.models.consistency.derivatives import problems_of_derivatives
from stylobate.models.consistency.forces import problems_of_forces
from stylobate.models.consistency.near_vertical import (
    problems_of_departure,
    problems_of_loss,
    problems_of_passage,
    problems_of_rest,
)
from stylobate.models.consistency.overturning import problems_of_balance, problems_of_no_return
from stylobate.models.consistency.plane import problems_in_planes, problems_of_maps
from stylobate.models.consistency.samples import Subject
from stylobate.models.consistency.signatures import problems_of_lengths, problems_of_signatures
from stylobate.models.model import Model

Examination = Callable[[Subject], Iterator[str]]

# Each stage requires that the stages before it found no problem.
_STAGES: tuple[tuple[Examination, ...], ...] = ((problems_of_signatures,), (problems_of_lengths,), (problems_of_maps,))

# For models with one kind of contact.
_OF_EQUATIONS: tuple[Examination, ...] = (
    problems_in_planes,
    problems_of_forces,
    problems_of_no_return,
    problems_of_balance,
    problems_of_departure,
    problems_of_rest,
    problems_of_loss,
)
_THOROUGH: tuple[Examination, ...] = (problems_of_derivatives, problems_of_passage)


def check(model: Model) -> None:
    """Check that the members of a model agree with each other and with its equations of motion.

    Call it in a test of a model of your own. It compares, at random states: the number of arguments and results of
    each function with `parameters` and `state_names`; `start`, `tilt_of` and `from_plane`; `planar_rates` with `rates`;
    `no_return_tilt` and `balance` with the inequalities that prove them; `departure`, `passage` and `rest_energy` near
    the vertical, `impact_map`, and `jacobian` with `rates`. The first run of a model of your own makes the cheap
    comparisons by itself.

    Parameters
    ----------
    model
        The model, with nonzero numbers: the check cannot detect that a zero term is missing.

    Raises
    ------
    ModelError
        If a member is wrong; `problems` has a line for each wrong member.
    ParameterError
        If `model` is not a model.

    Examples
    --------
    >>> import stylobate as sb
    >>> sb.models.check(sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1))
    """
    if not isinstance(model, Model):
        message = f"model: must be a model such as Slender(column) (got {model!r}). Pass an instance."
        raise ParameterError(message)
    _refuse(model, _problems(Subject(model, _numbers(model), thorough=True)))


_CHECKED: dict[tuple[type[Model], tuple[float, ...]], None] = {}
_REMEMBERED = 4096


def check_once(model: Model) -> None:
    """Make the cheap comparisons of `check` once per class and parameters, except for classes of the package."""
    kind = type(model)
    if kind.__module__.startswith("stylobate.models."):
        return
    key = (kind, _numbers(model))
    if key in _CHECKED:
        return
    _refuse(model, _problems(Subject(model, key[1], thorough=False)))
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
    further = () if subject.model.switches else _OF_EQUATIONS
    return _found(subject, (*further, *(_THOROUGH if subject.thorough and further else ())))


def _found(subject: Subject, examinations: tuple[Examination, ...]) -> list[str]:
    """Return the problems that examinations find; only a thorough check reports functions that raise."""
    problems: list[str] = []
    for examine in examinations:
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                problems += examine(subject)
        except Exception as error:  # noqa: BLE001  a user's function may raise anything
            if subject.thorough:
                problems.append(f"{_member(error)}: raises {type(error).__name__} at a random state ({error}).")
    return problems


def _member(error: BaseException) -> str:
    """Return the name of the function that raised."""
    trace, name = error.__traceback__, ""
    while trace is not None:
        name, trace = trace.tb_frame.f_code.co_name, trace.tb_next
    return name
