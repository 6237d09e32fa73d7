"""Units at the boundary: text and quantities become the declared SI numbers, to the bit, or are refused in one line."""

import inspect
import math
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pint
import pytest
import xarray as xr
from hypothesis import example, given
from hypothesis import strategies as st

import stylobate as sb
from stylobate import config, theory, units
from stylobate.base_motions import Record
from stylobate.base_motions.declared import MOTIONS
from stylobate.cli.main import run as run_command
from stylobate.column.shapes import SHAPES
from stylobate.errors import ParameterError, UnlikelyInputWarning, as_float
from stylobate.models.declared import MODELS
from stylobate.parameter_quantities import _QUANTITIES as VARIED
from stylobate.quantities import QUARTER_TURN, Quantity, parameters_of
from stylobate.run_arguments import run_numbers

Q = pint.UnitRegistry().Quantity

DECLARED = {
    **{f"{kind}.{name}": one for kind, make in SHAPES.items() for name, one in parameters_of(make).items()},
    **{f"{kind}.{name}": one for kind, make in MODELS.items() for name, one in parameters_of(make).items()},
    **{f"{kind}.{name}": one for kind, make in MOTIONS.items() for name, one in parameters_of(make).items()},
    **run_numbers(),
}
QUANTITIES = {**{name: one.quantity for name, one in DECLARED.items()}, **{f"over {n}": q for n, q in VARIED.items()}}


class Foreign:
    """A quantity of another package, in the form of astropy: `value`, `unit`, `to`."""

    def __init__(self, value, unit):
        self.value, self._unit = value, unit

    @property
    def unit(self):
        return self._unit

    def to(self, unit):
        raise TypeError(unit)


SAME = [
    # text, unit and number of pint, declared unit, number
    ("1.2 mm", 1.2, "mm", "m", 0.0012),
    ("1.1mm", 1.1, "mm", "m", 0.0011),
    ("30cm", 30, "cm", "m", 0.3),
    ("2 in", 2, "inch", "m", 0.0508),
    ("3 ft", 3, "foot", "m", 0.9144),
    ("25deg", 25, "degree", "rad", math.radians(25.0)),
    ("180 °", 180, "degree", "rad", math.pi),
    ("0.25 turn", 0.25, "turn", "rad", math.pi / 2.0),
    ("5 mrad", 5, "mrad", "rad", 0.005),
    ("50Hz", 50, "Hz", "rad/s", 2.0 * math.pi * 50.0),
    ("300 rpm", 300, "rpm", "rad/s", 10.0 * math.pi),
    ("300rpm", 300, "rpm", "Hz", 5.0),
    ("5 Hz", 5, "Hz", "1/min", 300.0),
    ("90 deg/s", 90, "degree/second", "rad/s", math.pi / 2.0),
    ("0.3g", 0.3, "standard_gravity", "m/s²", 2.941995),
    ("3 cm/s^2", 3, "cm/s**2", "m/s²", 0.03),
    ("3 gal", 3, "galileo", "m/s²", 0.03),
    ("5ms", 5, "ms", "s", 0.005),
    ("2 min", 2, "minute", "s", 120.0),
    ("500 g", 500, "gram", "kg", 0.5),
    ("2 t", 2, "metric_ton", "kg", 2000.0),
    ("1 lb", 1, "pound", "kg", 0.45359237),
    ("2.7 g/cm³", 2.7, "g/cm**3", "kg/m³", 2700.0),
    ("4 kg m2", 4, "kg*m**2", "kg m²", 4.0),
    ("3 N·s/m", 3, "N*s/m", "N s/m", 3.0),
    ("1200 mm/m", 1200, "mm/m", "", 1.2),
    ("5 %", 5, "percent", "", 0.05),
]


@pytest.mark.parametrize(("text", "number", "unit", "declared", "expected"), SAME)
def test_text_and_quantities_are_the_same_number_to_the_bit(text, number, unit, declared, expected):
    assert units.read(text, declared) == expected
    for quantity in (Q(number, unit), Q(np.float64(number), unit), Foreign(number, text.lstrip("0123456789. "))):
        if declared != "m/s²" or not isinstance(quantity, Foreign):  # there "g" is standard gravity in text only
            assert as_float("x", quantity, declared) == expected
    array = units.in_unit(Q([[number, 2 * number]], unit), declared)
    assert array.tolist() == [[expected, pytest.approx(2.0 * expected, rel=2e-16)]]
    assert units.in_unit([Q(number, unit), 7.0], declared) == [expected, 7.0]


@given(digits=st.integers(-(10**9), 10**9), exponent=st.integers(-12, 12))
@example(digits=11, exponent=-1)  # 1.1 * 0.001 is another float than 0.0011
def test_a_decimal_number_with_a_decimal_prefix_is_the_float_of_its_si_value(digits, exponent):
    text = f"{digits}e{exponent}"
    for unit, power in (("mm", -3), ("cm", -2), ("km", 3), ("µm", -6)):
        expected = float(f"{digits}e{exponent + power}")
        assert units.read(f"{text} {unit}", "m") == expected
    assert as_float("x", Q(float(text), "mm"), "m") == float(Fraction(repr(float(text))) / 1000)


@pytest.mark.parametrize("text", ["1e400 mm", "-1e999999999 km", "0e999999999 mm", "1e-400 mm"])
def test_numbers_beyond_floats_end_at_once(text):
    assert units.read(text, "m") in (math.inf, -math.inf, 0.0)


@pytest.mark.parametrize(
    ("text", "unit", "problem"),
    [
        ("5kg", "m", "must be in mm, cm, m, in or ft, got 5kg"),
        ("5 mmm", "m", "must be in mm, cm, m, in or ft, got 5 mmm. Did you mean mm?"),
        ("5 hz", "rad/s", "must be in Hz, rpm or rad/s, got 5 hz. Did you mean Hz?"),
        ("5 1/s", "Hz", "must be in Hz, rpm or rad/s, got 5 1/s"),
        ("3 kg", "m/s²", "must be in cm/s², m/s² or g, got 3 kg"),
        ("5 g", "s", "must be in s, ms or min, got 5 g"),
        ("5 mm", "", "must be a number without unit, got 5 mm"),
        ("5 deg", "", "must be a number without unit, got 5 deg"),
        ("wide", "m", "must be a number, with or without a unit, got 'wide'"),
        ("1/2", "m", "must be in mm, cm, m, in or ft, got 1/2"),
    ],
)
def test_another_dimension_or_an_unknown_unit_is_refused_with_the_usual_ones(text, unit, problem):
    with pytest.raises(units.UnitError) as caught:
        units.read(text, unit)
    assert str(caught.value) == problem


@pytest.mark.parametrize(
    ("value", "unit", "problem"),
    [
        (Q(25, "degree"), "m", "must be in mm, cm, m, in or ft, got 25 deg"),
        (Q(0.3, ""), "m", "must be in mm, cm, m, in or ft, got 0.3"),
        (Q(2.0, "gallon"), "m/s²", "must be in cm/s², m/s² or g, got 2.0 gal. Did you mean g?"),
        (Q(2.0, "gram"), "m/s²", "must be in cm/s², m/s² or g, got 2.0 g"),
        (Q(3.0, "count/second"), "rad/s", "must be in Hz, rpm or rad/s, got 3.0 count/s"),
        (Q([1.0, 2.0], "s"), "m", "must be in mm, cm, m, in or ft, got numbers in s"),
        (Q(1j, "mm"), "m", "must be real numbers, got 1j mm"),
        (xr.DataArray(Q([1.0, 2.0], "mm"), dims="run"), "m", "must not be a labelled array with a unit. Convert it to"),
        (Foreign(1.0, "parsec"), "m", "must be in mm, cm, m, in or ft, got 1.0 parsec"),
    ],
)
def test_a_quantity_that_is_not_converted_is_refused_and_never_stripped(value, unit, problem):
    with pytest.raises(ParameterError) as caught:
        as_float("length", value, unit)
    assert str(caught.value).startswith(f"length {problem}")


def test_units_that_only_the_package_of_the_quantity_knows_are_converted_by_it():
    assert units.in_unit(Q(1.0, "yard"), "m") == pytest.approx(0.9144, rel=1e-15)
    assert units.in_unit(Q(60.0, "arcminute"), "rad") == pytest.approx(math.radians(1.0), rel=1e-15)


def test_numbers_and_arrays_without_units_are_returned_as_they_are():
    for value in (1, 1.0, np.float32(1.0), np.ones(3), [1.0, 2], (1.0,), None, "text", xr.DataArray([1.0])):
        assert units.in_unit(value, "m") is value


def test_pint_is_recognised_without_being_imported():
    code = (
        "import stylobate as sb, sys; sb.Column.solid(radius=1, height=5, density=2000); print('pint' in sys.modules)"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "False"


# Declarations


def test_every_declared_unit_is_in_the_table_and_has_usual_ones():
    for name, quantity in QUANTITIES.items():
        assert units.size_of(quantity.unit) is not None, name
        assert units.read("1.5", quantity.unit) == 1.5
        if quantity.unit:
            usual = units._usual(quantity.unit)
            assert len(usual) > 1, f"{name}: no usual units beside {quantity.unit}"
            for unit in usual:
                assert units.read(f"2 {unit}", quantity.unit) > 0.0


ANGLES_THAT_GO_ROUND = {
    *("direction", "incline_direction", "phase", "start_phase", "phase_difference", "twist", "rotation", "angle"),
}
"""Phases, directions and rotations: larger ones are possible."""

SMALL = {"atol"}
"""Tolerances."""


def test_every_angle_is_bounded_by_a_quarter_turn_or_goes_round():
    angles = {name: one for name, one in QUANTITIES.items() if one.unit == "rad"}
    assert len(angles) > 20
    for name, quantity in angles.items():
        bounds = [one for one in (quantity.lt, quantity.le) if one is not None]
        own = name.rpartition(".")[2].removeprefix("over ")
        if own in SMALL:
            continue
        if bounds:
            assert bounds[0] <= QUARTER_TURN, name
            with pytest.raises(ParameterError, match=r"got 25\.0 rad\. For 25 deg give 0\.4363 rad\.$"):
                quantity.checked(own, 25.0)
        else:
            assert own in ANGLES_THAT_GO_ROUND, name
            with pytest.warns(UnlikelyInputWarning, match=r"45 rad is unlikely\. For 45 deg give 0\.7854 rad\.$"):
                assert quantity.checked(own, 45.0) == 45.0


# Python


def column(**stated):
    return sb.Column.solid(**{"radius": 0.03, "height": 0.2, "density": 884.0, **stated})


def bottle(radius, height, mass, stroke, frequency, angle, tilt, duration):
    model = sb.Sliding(sb.Column.solid(radius=radius, height=height, mass=mass), friction_coefficient=0.3)
    motion = sb.Harmonic.stroke(stroke=stroke, frequency=frequency, angle=angle)
    return sb.simulate(model, motion, tilt=tilt, duration=duration)


@pytest.mark.long
def test_the_same_run_to_the_bit_from_text_pint_and_si(tmp_path):
    plain = bottle(0.03, 0.2, 0.5, 0.0012, 50.0, 25.0 * math.pi / 180.0, (0.01, 0.0), 0.2)
    quantities = bottle(
        *(Q(3, "cm"), Q(200, "mm"), Q(500, "gram"), Q(1.2, "mm"), Q(3000, "rpm"), Q(25, "degree")),
        *(Q([10, 0], "mrad"), Q(200, "ms")),
    )
    path = tmp_path / "bottle.toml"
    path.write_text(
        'duration = "200 ms"\ntilt = ["10 mrad", 0.0]\n'
        'column = {radius = "30mm", height = "20 cm", mass = "500 g"}\n'
        'model = {kind = "sliding", friction_coefficient = "30 %"}\n'
        'motion = {kind = "stroke", stroke = "1.2 mm", frequency = "50Hz", angle = "25°"}\n',
        encoding="utf-8",
    )
    setup = config.SimulationConfig.parse(config.read_config(path)).build()
    described = sb.simulate(setup.model, setup.motion, **setup.options)
    options = [
        "--duration",
        "0.2s",
        "--tilt",
        "10mrad",
        "0",
        "--radius",
        "3cm",
        "--height",
        "200mm",
        "--mass",
        "0.5kg",
        "--model",
        "sliding",
    ]
    options += [
        "--friction-coefficient",
        "0.3",
        "--motion",
        "stroke",
        "--stroke",
        "1.2mm",
        "--frequency",
        "3000rpm",
        "--angle",
        "25deg",
    ]
    assert run_command(["simulate", *options, "--output", str(tmp_path / "run.nc")]) == 0
    for run in (quantities, described, sb.load(tmp_path / "run.nc")):
        assert run.provenance["motion"] == plain.provenance["motion"]
        assert run.provenance["column"] == plain.provenance["column"]
        for name in ("time", "tilt", "footprint"):
            assert run.data[name].to_numpy().tobytes() == plain.data[name].to_numpy().tobytes()


def test_quantities_are_converted_in_every_constructor_and_refused_with_their_names():
    """Each declared number is stated in a unit a thousand times smaller, and then in a unit of another dimension."""
    values = {
        "rad": 0.25,
        "m": 0.25,
        "kg": 1e3,
        "kg m²": 300.0,
        "Hz": 4.0,
        "rad/s": 8.0,
        "m/s²": 2.0,
        "s": 0.5,
        "": 0.75,
    }
    values |= {"kg/m³": 2700.0, "1/min": 90.0, "m/s": 0.5}
    more = {"inner_radius": 0.125, "mass_height": 0.125, "patch": 0.0, "cycles": 2, "oscillations": 4.0, "spin": 0.0}
    more |= {"static_friction_coefficient": 1.0, "axial_inertia": 1.0, "transverse_inertia": 1.5, "slenderness": 0.1}
    for make in (*SHAPES.values(), *MODELS.values(), *MOTIONS.values()):
        declared = parameters_of(make)
        takes = inspect.signature(make).parameters
        if not declared or {"self", "motion", "motions", "samples"} & set(takes):
            continue
        fixed = {"column": column()} if "column" in takes else {}
        stated = {
            name: more.get(name, values[one.quantity.unit])
            for name, one in declared.items()
            if not one.choices and not one.whole and (one.required or not one.optional)
            if not isinstance(one.default, str)
        }
        stated = {n: (v,) * k if (k := declared[n].quantity.components) > 1 else v for n, v in stated.items()}
        if make is SHAPES["solid"]:
            stated["density"] = 2700.0
        if "acceleration" not in stated and "displacement" in declared:
            stated["acceleration"] = 2.0
        plain = make(**fixed, **stated)
        for name, value in stated.items():
            unit = declared[name].quantity.unit
            size = units.size_of(unit)
            assert make(**fixed, **{**stated, name: in_thousandths(value, unit)}) == plain, (make, name)
            wrong = Q(value, "kelvin")
            with pytest.raises(ParameterError, match=rf"^{name}\b.* got .*K") as caught:
                make(**fixed, **{**stated, name: wrong})
            assert "\n" not in str(caught.value), size


def in_thousandths(value, unit):
    """Return a value as a quantity with a thousandth of the unit."""
    text = {"": "mm/m", "Hz": "mHz", "1/min": "turn/minute", "kg m²": "gram*m**2", "kg/m³": "gram/m**3", "kg": "gram"}
    text |= {"rad": "mrad", "m": "mm", "rad/s": "mrad/s", "m/s²": "mm/s**2", "s": "ms", "m/s": "mm/s"}
    factor = 1 if unit == "1/min" else 1000
    return Q(np.multiply(value, factor) if isinstance(value, tuple) else factor * value, text[unit])


MODEL = sb.Slender(sb.Column.solid(radius=0.5, height=5.0, density=2700.0), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=1.0, angular_frequency=4.0)


def test_ensembles_and_studies_convert_what_varies():
    over = {"acceleration": Q([0.05, 0.25], "standard_gravity"), "angular_frequency": [Q(30, "rpm"), Q(1, "Hz")]}
    plain = {"acceleration": [0.05 * 9.80665, 0.25 * 9.80665], "angular_frequency": [math.pi, 2.0 * math.pi]}
    found, expected = (
        sb.studies.overturning_map(MODEL, CIRCLE, over=one, duration=time)
        for one, time in ((over, Q(0.1, "minute")), (plain, 6.0))
    )
    xr.testing.assert_identical(found.drop_attrs(), expected.drop_attrs())
    runs = {
        "tilt": (Q([[1, 0], [2, 0]], "degree"), [[math.radians(1.0), 0.0], [math.radians(2.0), 0.0]]),
        "duration": (Q(500, "ms"), 0.5),
        "parameters": ({"radius": Q([40, 50], "cm")}, {"radius": [0.4, 0.5]}),
    }
    found, expected = (sb.simulate_ensemble(MODEL, CIRCLE, **{n: v[i] for n, v in runs.items()}) for i in (0, 1))
    xr.testing.assert_identical(found, expected)
    with pytest.raises(ParameterError, match=r"^radius must be in mm, cm, m, in or ft, got numbers in s$"):
        sb.simulate_ensemble(MODEL, CIRCLE, duration=1.0, parameters={"radius": Q([1, 2], "s")})
    with pytest.raises(
        ParameterError, match=r"^over\['tilt_x'\] must be in deg, rad, mrad or turn, got numbers in mm$"
    ):
        sb.studies.sweeps.Sweep.grid(MODEL, CIRCLE, over={"tilt_x": Q([1, 2], "mm")}, duration=1.0)


def test_changed_parameters_convert_and_a_frequency_counts_turns():
    pulse = sb.Pulse.gabor(velocity=0.5, frequency=1.0, oscillations=3.0)
    for changes in ({"angular_frequency": Q(120, "rpm")}, {"frequency": Q(120, "rpm")}, {"frequency": 2.0}):
        assert sb.with_parameters(MODEL, pulse, **changes)[1].waveform.frequency == pytest.approx(2.0, rel=1e-15)


def test_records_and_times_convert():
    samples = Q([0.0, 0.1, 0.0], "standard_gravity")
    record = Record(samples=samples, step=Q(5, "ms"))
    assert record.step == 0.005
    assert record.samples[:, 0].tolist() == [0.0, 0.980665, 0.0]
    assert Record.from_components(y=samples, step=0.005).samples[1, 1] == 0.980665
    assert record.delayed(Q(20, "ms")).start == 0.02
    assert record.trimmed(end=Q(5, "ms")).end == 0.005
    assert CIRCLE.acceleration(Q([500, 1000], "ms")).tolist() == CIRCLE.acceleration([0.5, 1.0]).tolist()
    with pytest.raises(ParameterError, match=r"^samples must be in cm/s², m/s² or g, got numbers in m$"):
        Record(samples=Q([0.0, 1.0], "m"), step=0.01)


OF_THEORY = {
    "nu": 1.4,
    "a0": 0.065,
    "a1": 0.065,
    "a2": 0.06,
    "phi2": 0.3,
    "c": 0.1,
    "eta": 0.1,
    "zeta": 0.2,
    "mu": 0.3,
    "tilt": 0.03,
    "rolling_rate": 0.4,
    "rate": 0.4,
    "spin": 0.1,
    "along": 0.8,
    "normal": 0.3,
    "friction": 0.4,
    "static_friction": 0.4,
    "kinetic_friction": 0.3,
    "incline": 0.05,
    "phase": 0.4,
    "speed": 0.5,
    "ratio": 0.5,
    "normal_restitution": 0.3,
    "restitution": 0.8,
    "amplitude": 0.5,
    "duration": 0.5,
    "tau": 0.5,
    "weight": 0.9,
    "patch": 0.05,
    "inertia_ratio": 0.7,
    "axial_ratio": 0.5,
    "spin_ratio": 0.1,
    "start_velocity": 0.1,
    "start_normal_velocity": 0.0,
    "omega": 1.1,
    "tolerance": 1e-12,
    "rest_speed": 1e-8,
}
FUNCTIONS = {name: one for name in theory.__all__ if inspect.isfunction(one := getattr(theory, name))}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_closed_forms_take_pure_numbers_and_refuse_other_quantities(name):
    function = FUNCTIONS[name]
    arguments = {one: OF_THEORY[one] for one in inspect.signature(function).parameters if one in OF_THEORY}
    assert arguments
    with np.printoptions(precision=17):
        expected = repr(function(**arguments))
        for one, value in arguments.items():
            assert repr(function(**{**arguments, one: Q(1000 * value, "mm/m")})) == expected, one
            for wrong in (Q(value, "s"), [Q(value, "s")]):
                with pytest.raises(ParameterError, match=rf"^{one}\b.*got "):
                    function(**{**arguments, one: wrong})


def test_closed_forms_take_angles_in_degrees():
    assert theory.throw_number(0.5, incline=Q(10, "degree")) == theory.throw_number(0.5, incline=math.radians(10.0))


# Unlikely numbers


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: column(radius=30.0, height=0.2), "radius: 30 m is unlikely. For 30 mm give 0.03 m."),
        (lambda: column(radius=20.0, height=200.0), "height: 200 m is unlikely. For 200 mm give 0.2 m."),
        (
            lambda: sb.Harmonic.stroke(stroke=1.2, frequency=50.0),
            "stroke: 1.2 m is unlikely, with an acceleration of 6039 g. For 1.2 mm give 0.0012 m.",
        ),
        (
            lambda: sb.Harmonic.orbit(diameter=25.0, rpm=300.0),
            "diameter: 25 m is unlikely, with an acceleration of 1258 g. For 25 mm give 0.025 m.",
        ),
        (
            lambda: sb.Harmonic.circular(acceleration=2e4, angular_frequency=300.0),
            "acceleration: 20000 m/s² is unlikely. For 20000 cm/s² give 200 m/s².",
        ),
        (
            lambda: sb.Harmonic.stroke(stroke=1e-12, frequency=1e6),
            "frequency: 1e+06 Hz is unlikely. Check its unit, such as Hz, rpm or rad/s.",
        ),
        (
            lambda: sb.Harmonic.straight(acceleration=1.0, angular_frequency=4.0, direction=90.0),
            "direction: 90 rad is unlikely. For 90 deg give 1.571 rad.",
        ),
    ],
)
def test_a_number_of_another_unit_is_questioned_once_at_the_line_that_states_it(make, message):
    with pytest.warns(UnlikelyInputWarning) as caught:
        make()
    assert [(str(one.message), one.filename) for one in caught] == [(message, __file__)]


def test_temples_pins_bottles_shaking_tables_and_dimensionless_columns_are_not_questioned():
    for radius, height in ((1.0, 20.0), (0.001, 0.01), (0.03, 0.2), (7.8, 57.0), (20.0, 15.0)):
        column(radius=radius, height=height, density=2700.0)
    for c in (1e-4, 0.1, 0.5):
        sb.Column.dimensionless(c)
    sb.Harmonic.stroke(stroke=2.0, frequency=1.0)  # a table for earthquakes
    sb.Harmonic.stroke(stroke=1e-5, frequency=400.0)  # a piezoelectric feeder
    sb.Harmonic.displacement_amplitude(amplitude=(0.5, 0.5, 0.0), angular_frequency=5.0)
    sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5, start_phase=4.0 * math.pi)


def test_studies_question_the_largest_value_once():
    over = {"acceleration": [1.0, 3e4], "damping": [0.1, 0.2]}
    with pytest.warns(UnlikelyInputWarning, match=r"^over\['acceleration'\]: 30000 m/s² is unlikely\.") as caught:
        sb.studies.sweeps.Sweep.grid(MODEL, CIRCLE, over=over, duration=1.0)
    assert len(caught) == 1


# The command line and files

PART = ["--radius", "30mm", "--height", "20cm", "--density", "884", "--friction-coefficient", "0.3"]


def test_degrees_are_refused_and_lengths_in_millimetres_questioned_on_the_command_line(capsys):
    conveyor = ["drift", *PART, *["--motion", "stroke", "--stroke", "1.2mm", "--frequency", "50"]]
    varied = ["--x", "friction-coefficient", "0.2", "0.3", "2", "--periods", "3", "--late", "2"]
    assert run_command([*conveyor, "--angle", "25", *varied]) == 2
    assert capsys.readouterr().err == (
        "stylobate: motion: angle must lie between -π/2 and π/2, got 25.0 rad. For 25 deg give 0.4363 rad.\n"
    )
    assert run_command([*conveyor, "--angle", "25deg", "--radius", "30", "--height", "200", *varied]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if "unlikely" in line] == [
        "stylobate: warning: radius: 30 m is unlikely. For 30 mm give 0.03 m.",
        "stylobate: warning: height: 200 m is unlikely. For 200 mm give 0.2 m.",
    ]


def test_axes_have_the_units_of_their_quantities():
    plane = {"x": {"name": "tilt-x", "from": "1deg", "to": "2 deg", "number": 2}}
    plane["y"] = {"name": "acceleration", "values": ["0.1 g", 3.0]}
    values = {
        "column": {"radius": 0.5, "height": 5.0, "density": 2700.0},
        "motion": {"kind": "circular", "angular_frequency": "30 rpm"},
        "duration": "1 min",
        "map": plane,
    }
    setup = config.study_config(sb.studies.overturning_map).parse(values).build()
    assert {name: axis.tolist() for name, axis in setup.options["over"].items()} == {
        "tilt_x": np.linspace(math.radians(1.0), math.radians(2.0), 2).tolist(),
        "acceleration": [0.980665, 3.0],
    }
    plane["x"]["to"] = "2 kg"
    with pytest.raises(sb.errors.ConfigError, match=r"^map\.x\.to must be in deg, rad, mrad or turn, got 2 kg$"):
        config.study_config(sb.studies.overturning_map).parse(values)


def test_each_wrong_unit_of_a_file_is_one_line_with_its_place():
    with pytest.raises(sb.errors.ConfigError) as caught:
        config.SimulationConfig.parse(
            {
                "column": {"radius": "30 mmm", "height": "0.2 s", "density": 884},
                "motion": {"kind": "circular", "acceleration": "1 g", "angular_frequency": "5 m"},
                "duration": "1 kg",
                "tilt": ["1 deg", "1 s"],
            }
        )
    assert sorted(caught.value.problems) == [
        "column.height must be in mm, cm, m, in or ft, got 0.2 s",
        "column.radius must be in mm, cm, m, in or ft, got 30 mmm. Did you mean mm?",
        "duration must be in s, ms or min, got 1 kg",
        "motion.angular_frequency must be in Hz, rpm or rad/s, got 5 m",
        "tilt must be in deg, rad, mrad or turn, got 1 s",
    ]


def test_processing_steps_and_tails_have_units():
    read = config.RecordMotion.parse(
        {"sample": "el centro 1940", "tail": "2 s", "processing": [{"method": "filtered", "lowpass": "0.02 kHz"}]}
    )
    assert (read.tail, read.processing[0].lowpass) == (2.0, 20.0)


def test_the_numbers_of_a_dimensionless_column_have_no_units_but_angles(capsys):
    case = ["--slenderness", "0.1", "--motion", "circular", "--angular-frequency", "2", "--duration", "5"]
    assert run_command(["simulate", *case, "--acceleration", "0.3g"]) == 2
    assert "motion.acceleration: the numbers of a dimensionless column have no unit (got '0.3g')" in (
        capsys.readouterr().err
    )
    assert run_command(["simulate", *case, "--acceleration", "0.3", "--tilt", "1deg", "0"]) == 0


@pytest.mark.parametrize("quantity", [Quantity(unit="m", gt=0.0), Quantity(unit="rad", ge=0.0, le=QUARTER_TURN)])
def test_a_declaration_accepts_the_same_numbers_in_any_unit(quantity):
    unit = {"m": "mm", "rad": "mrad"}[quantity.unit]
    for number in (1e-6, 0.5, 1.5):
        assert quantity.checked("x", Q(1e3 * number, unit)) == pytest.approx(number, rel=1e-15)
    for number in (-1.0, math.nan):
        with pytest.raises(ParameterError, match=r"^x must"):
            quantity.checked("x", Q(number, unit))
