"""The exception tree, and the checks that raise it."""

import math

import numpy as np
import pytest

from stylobate import errors
from stylobate.errors import (
    DescriptionError,
    FileError,
    Outcome,
    ParameterError,
    StylobateError,
    UnsupportedError,
    require_finite,
    require_not_negative,
    require_positive,
    require_vector,
)


def test_every_exception_is_a_stylobate_error_and_bad_input_a_value_error():
    assert issubclass(ParameterError, StylobateError)
    assert issubclass(ParameterError, ValueError)
    assert issubclass(DescriptionError, ParameterError)
    assert issubclass(UnsupportedError, StylobateError)
    assert issubclass(FileError, StylobateError)
    assert not issubclass(FileError, ValueError)


def test_a_description_error_has_one_line_for_each_problem():
    error = DescriptionError(["column.radius is missing", "duration is missing"])
    assert error.problems == ("column.radius is missing", "duration is missing")
    assert str(error).splitlines() == list(error.problems)


@pytest.mark.parametrize(
    ("check", "accepted", "refused", "demand"),
    [
        (require_finite, [-1.0, 0, 5], [math.nan, math.inf, -math.inf], "must be finite"),
        (require_positive, [1e-300, 5], [0.0, -1.0, math.nan, math.inf], "must be positive"),
        (require_not_negative, [0.0, -0.0, 5], [-1e-300, math.nan, math.inf], "must be zero or positive"),
    ],
)
def test_checks_return_floats_or_name_argument_value_and_unit(check, accepted, refused, demand):
    for value in accepted:
        assert type(check("width", value, "m")) is float
        assert check("width", value, "m") == value
    for value in refused:
        with pytest.raises(ParameterError) as caught:
            check("width", value, "m")
        assert str(caught.value) == f"width {demand}, got {value!r} m"
    with pytest.raises(ParameterError, match=r"^width must be a real number, got \[1\]$"):
        check("width", [1], "m")


@pytest.mark.parametrize("value", ["5", "x", None, 1j, [1.0], {}, pytest.param(10**400, id="beyond floats")])
def test_what_is_no_real_number_is_refused(value):
    with pytest.raises(ParameterError, match=r"^width must be"):
        require_finite("width", value)


@pytest.mark.parametrize("value", [np.float32(0.5), np.int64(3), np.array(2.0), True])
def test_numbers_of_other_kinds_are_taken(value):
    assert require_finite("width", value) == float(value)


def test_vectors_are_checked_element_by_element():
    assert require_vector("tilt", np.array([1, 2]), 2) == (1.0, 2.0)
    assert require_vector("tilt", (number for number in (1, 2)), 2) == (1.0, 2.0)
    for value in ((1.0,), (1.0, 2.0, 3.0), 1.0, None):
        with pytest.raises(ParameterError, match=r"^tilt must have 2 numbers, got"):
            require_vector("tilt", value, 2)
    with pytest.raises(ParameterError, match=r"^tilt\[1\] must be finite, got nan rad$"):
        require_vector("tilt", (0.0, math.nan), 2, "rad")


def test_outcomes_are_ten_and_each_is_explained():
    assert [outcome.name for outcome in Outcome] == [
        "AT_REST",
        "ROCKING",
        "ROLLING",
        "MODULATED",
        "OVERTURNED",
        "STILL_MOVING",
        "LIMIT_REACHED",
        "LIFTED_OFF",
        "FAILED",
        "SLID",
    ]
    assert "StylobateError" in errors.__doc__
