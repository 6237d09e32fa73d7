"""A declared number is checked, described and bounded by its declaration alone."""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stylobate as sb
from stylobate.errors import LARGEST, SMALLEST, ParameterError
from stylobate.quantities import Quantity, check_declared, parameters_of

Stiffness = Annotated[float, Quantity(symbol="k", unit="N/m", text="stiffness of the tether", ge=0.0, le=5.0)]
Shape = Annotated[Literal["linear", "cubic"], Quantity(text="law of the tether")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Tether:
    stiffness: Stiffness
    length: Annotated[float, Quantity(unit="m", gt=0.0)] | None = None
    law: Shape = "linear"
    colour: str = "red"

    def __post_init__(self):
        check_declared(self)


def made(*, stiffness: Stiffness, length: float = 1.0) -> Tether:
    return Tether(stiffness=stiffness, length=length)


def test_declarations_are_read_from_classes_and_from_constructors():
    declared = parameters_of(Tether)
    assert list(declared) == ["stiffness", "length", "law"]
    assert declared["stiffness"].required
    assert declared["length"].optional
    assert declared["law"].choices == ("linear", "cubic")
    assert list(parameters_of(made)) == ["stiffness"]
    assert parameters_of(made)["stiffness"].quantity is declared["stiffness"].quantity


def test_numbers_become_floats_and_what_may_be_left_out_stays_none():
    tether = Tether(stiffness=2)
    assert type(tether.stiffness) is float
    assert tether.length is None
    assert replace(tether, length=np.float32(0.5)).length == 0.5


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stiffness": -1}, "stiffness must lie between 0 and 5, got -1.0 N/m"),
        ({"stiffness": math.nan}, "stiffness must lie between 0 and 5, got nan N/m"),
        ({"stiffness": "2"}, "stiffness must be a real number, got '2'"),
        ({"stiffness": None}, "stiffness must be a real number, got None"),
        ({"length": 0.0}, "length must be positive, got 0.0 m"),
        ({"length": 0.5 * SMALLEST}, "length: too small to compute with"),
        ({"length": 2.0 * LARGEST}, "length: too large to compute with"),
        ({"law": "round"}, "law must be 'linear' or 'cubic', got 'round'"),
    ],
)
def test_a_value_outside_its_declaration_is_refused_in_one_line(change, message):
    with pytest.raises(ParameterError) as caught:
        Tether(**{"stiffness": 1.0, **change})
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("unit", "cf"),
    [("", "1"), ("m", "m"), ("m/s²", "m s-2"), ("kg m²", "kg m2"), ("rad/s", "rad s-1"), ("kg/m³", "kg m-3")],
)
def test_units_have_the_form_of_netcdf_files(unit, cf):
    assert Quantity(unit=unit).cf_units == cf


@given(
    low=st.sampled_from([None, 0.0, 2.0]),
    above=st.sampled_from([None, 0.0]),
    high=st.sampled_from([None, 3.0]),
    value=st.floats(-1e16, 1e16) | st.sampled_from([0.0, 2.0, 3.0, math.inf, math.nan]),
)
def test_what_studies_accept_is_what_a_single_value_is_checked_by(low, above, high, value):
    quantity = Quantity(ge=low, gt=above, le=high)
    if abs(value) < SMALLEST and value != 0.0:
        return  # refused by its size alone, which studies look at for the smallest and largest of their values
    try:
        quantity.checked("x", value)
    except ParameterError:
        assert not quantity.accepts(value) or abs(value) > LARGEST
    else:
        assert quantity.accepts(value)


def test_a_models_own_number_is_checked_by_its_declaration():
    @dataclass(frozen=True, slots=True, kw_only=True)
    class Tethered(sb.Slender):
        tether: Stiffness = 0.0

    column = sb.Column.dimensionless(0.1)
    assert Tethered(column=column, tether=1).tether == 1.0
    with pytest.raises(ParameterError, match=r"^tether must lie between 0 and 5, got 6\.0 N/m"):
        Tethered(column=column, tether=6)
    with pytest.raises(ParameterError, match=r"^column must be a Column"):
        Tethered(column=0.1)
