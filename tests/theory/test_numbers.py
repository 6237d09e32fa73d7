"""Numbers give numbers, and arrays give arrays, in every public closed form."""

import inspect
from dataclasses import fields, is_dataclass
from enum import Enum

import numpy as np
import pytest

from stylobate import theory

NUMBERS = {
    "a0": 0.065,
    "a1": 0.13,
    "along": 1.0,
    "amplitude": 0.05,
    "c": 0.1,
    "duration": 0.5,
    "eta": 0.1,
    "friction": 0.3,
    "kinetic_friction": 0.2,
    "mu": 0.1,
    "normal": 1.3,
    "normal_restitution": 0.5,
    "nu": 1.8,
    "omega": 2.0,
    "rate": 1.0,
    "ratio": 2.0,
    "restitution": 0.9,
    "rolling_rate": 1.0,
    "speed": 0.1,
    "static_friction": 0.3,
    "tau": 0.3,
    "tilt": 0.05,
    "zeta": 0.1,
}
# These take single numbers only.
OF_ONE = {"block_cycle", "modulated_rolling"}
FUNCTIONS = [name for name in theory.__all__ if inspect.isfunction(getattr(theory, name))]


def arguments_of(name, wrap=float):
    parameters = inspect.signature(getattr(theory, name)).parameters.values()
    return {one.name: wrap(NUMBERS[one.name]) for one in parameters if one.default is one.empty}


def leaves(value):
    """Yield the numbers and arrays of a result, in order."""
    if is_dataclass(value):
        for one in fields(value):
            yield from leaves(getattr(value, one.name))
    elif isinstance(value, tuple):
        for one in value:
            yield from leaves(one)
    elif not isinstance(value, (str, Enum)):
        yield value


@pytest.mark.parametrize("name", FUNCTIONS)
def test_numbers_give_python_numbers(name):
    found = list(leaves(getattr(theory, name)(**arguments_of(name))))
    assert found
    for one in found:
        assert type(one) in (float, bool, int) or (type(one) is np.ndarray and one.ndim > 0)


@pytest.mark.parametrize("kind", [np.float64, np.array])
@pytest.mark.parametrize("name", sorted({*FUNCTIONS} - OF_ONE))
def test_a_number_of_numpy_counts_as_a_number(name, kind):
    given = leaves(getattr(theory, name)(**arguments_of(name, kind)))
    for one, known in zip(given, leaves(getattr(theory, name)(**arguments_of(name))), strict=True):
        assert type(one) is type(known)
        np.testing.assert_array_equal(one, known)


@pytest.mark.parametrize("name", sorted({*FUNCTIONS} - OF_ONE))
def test_arrays_give_arrays_whose_entries_are_the_numbers(name):
    function = getattr(theory, name)
    single = list(leaves(function(**arguments_of(name))))
    several = list(leaves(function(**arguments_of(name, lambda number: np.full(2, number)))))
    for one, row in zip(single, several, strict=True):
        if name in ("steady_rolling", "averaged_rolling") and type(row) is int:
            continue  # the sense, which is an argument
        assert type(row) is np.ndarray
        np.testing.assert_allclose(row[0], one, rtol=1e-12, atol=1e-15)
        np.testing.assert_array_equal(row[0], row[1])


@pytest.mark.parametrize("name", [name for name in theory.__all__ if is_dataclass(getattr(theory, name))])
def test_methods_of_results_without_arguments_give_numbers_too(name):
    makers = {"BlockCycle": "block_cycle", "PlanarOrbit": "planar_forced_response"}
    if name not in makers:
        assert not [
            one
            for one in vars(getattr(theory, name))
            if one[0] != "_" and callable(getattr(theory, name).__dict__[one])
        ]
        return
    found = getattr(theory, makers[name])(**arguments_of(makers[name]))
    for one in leaves(found.fast.start() if name == "PlanarOrbit" else (found.repeats, *found.switches)):
        assert type(one) in (float, bool)
