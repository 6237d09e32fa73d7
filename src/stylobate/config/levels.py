"""Dissipation levels of an assessment, and checks of their numbers."""

from collections.abc import Mapping

from stylobate.config.description import Config
from stylobate.config.suggestions import did_you_mean
from stylobate.errors import ParameterError, require_not_negative
from stylobate.models.declared import dissipation_names

LEVELS = ("low", "central", "high")
"""Required levels."""

OF_DISSIPATION = dissipation_names()
"""The numbers of a model that dissipate."""


def problems_of_the_levels(levels: Mapping[str, Mapping[str, float]], model: type[Config]) -> list[str]:
    """Return a line for each mistake in the numbers of the levels.

    Parameters
    ----------
    levels
        Low, central and high, and optionally others.
    model
        Description of the model to which the numbers belong.
    """
    problems = []
    for level, numbers in levels.items():
        for name, value in numbers.items():
            try:
                require_not_negative(f"dissipation.{level}.{name}", value)
            except ParameterError as error:
                problems.append(str(error))
            if name not in OF_DISSIPATION:
                remedy = did_you_mean(name, OF_DISSIPATION) or f"use {', '.join(OF_DISSIPATION)}"
                problems.append(f"dissipation.{level}.{name} is not known here; {remedy}")
    kind = model.model_fields["kind"].default
    problems += [
        f"dissipation: the model {kind} has no {name}; leave it out or choose another model"
        for name in OF_DISSIPATION
        if name not in model.model_fields and any(name in numbers for numbers in levels.values())
    ]
    return problems or [*_differing(levels), *_falling(levels)]


def _differing(levels: Mapping[str, Mapping[str, float]]) -> list[str]:
    """Return a line if the levels do not name the same numbers, or name none."""
    names = set(levels["central"])
    if names and all(set(level) == names for level in levels.values()):
        return []
    given = ", ".join(f"{level} {' and '.join(sorted(numbers)) or 'nothing'}" for level, numbers in levels.items())
    return [f"dissipation must state the same parameters at each level, one or more, got {given}"]


def _falling(levels: Mapping[str, Mapping[str, float]]) -> list[str]:
    """Return a line if the damping of a level is below that of a lower level."""
    dampings = [levels[name]["damping"] for name in LEVELS if "damping" in levels[name]]
    if len(dampings) < len(LEVELS) or dampings == sorted(dampings):
        return []
    given = ", ".join(f"{name} {value:g}" for name, value in zip(LEVELS, dampings, strict=True))
    return [f"dissipation: damping must not fall from low to central to high, got {given}"]
