"""The numbers of a run as fields of descriptions, and their checks."""

from typing import Annotated, Any

from stylobate.errors import ParameterError
from stylobate.quantities import Parameter
from stylobate.run_arguments import numbers_of, run_numbers


def fields_of(group: Any, *required: str) -> Any:
    """Make a base of a description that has the numbers of a group, with their defaults; those `required` have none."""
    declared = numbers_of(group)
    annotations = {name: Annotated[_kind(one), one.quantity] for name, one in declared.items()}
    defaults = {name: one.default for name, one in declared.items() if name not in required}
    return type(group.__name__, (), {"__annotations__": annotations, **defaults})


def _kind(number: Parameter) -> Any:
    components = number.quantity.components
    return tuple[(float,) * components] if components > 1 else number.annotation  # type: ignore[misc]


def problems_of_the_numbers(values: object) -> list[str]:
    """Check the numbers of a run that `values` has as attributes; return one line for each invalid number."""
    problems: list[str] = []
    for name, parameter in run_numbers().items():
        value = getattr(values, name, None)
        if value is None:
            continue
        try:
            parameter.checked(value)
        except ParameterError as error:
            problems.append(str(error))
    return problems
