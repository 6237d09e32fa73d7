"""Descriptions: TOML text to objects, objects to descriptions and back, and mistakes one to a line."""

import json
import math
from dataclasses import dataclass

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.base_motions.combined import Sum
from stylobate.base_motions.pulses import Waveform
from stylobate.config import SimulationConfig, config_of, read_config, study_config
from stylobate.errors import ConfigError, FileError, ParameterError, UnsupportedError
from stylobate.models.declared import MODELS as KINDS
from stylobate.provenance import provenance_of_run

H, P, SineSweep = sb.Harmonic, sb.Pulse, sb.SineSweep
STONE = '[column]\nshape = "solid"\nradius = 0.5\nheight = 10.0\ndensity = 2700.0\n'
TIME = np.linspace(0.0, 5.0, 23)

MOTIONS = {
    'kind = "rest"': BASE_AT_REST,
    'kind = "circular"\nacceleration = 0.65\nangular_frequency = 1.8\nsense = -1\nramp = 2.0': H.circular(
        acceleration=0.65, angular_frequency=1.8, sense=-1, ramp=2.0
    ),
    'kind = "straight"\nacceleration = 0.65\nangular_frequency = 1.8\ndirection = 0.3\nstart_phase = 1.0': H.straight(
        acceleration=0.65, angular_frequency=1.8, direction=0.3, start_phase=1.0
    ),
    'kind = "elliptic"\namplitude = [0.1, 0.2]\nphase = 0.4\nangular_frequency = 2': H.elliptic(
        amplitude=(0.1, 0.2), phase=0.4, angular_frequency=2.0
    ),
    'kind = "vertical"\nacceleration = 1\nangular_frequency = 2': H.vertical(acceleration=1.0, angular_frequency=2.0),
    'kind = "displacement_amplitude"\namplitude = [0.1, 0.2, 0.3]\nphase = [0, 1, 2]\nangular_frequency = 2': (
        H.displacement_amplitude(amplitude=(0.1, 0.2, 0.3), phase=(0.0, 1.0, 2.0), angular_frequency=2.0)
    ),
    'kind = "stroke"\nstroke = 0.04\nfrequency = 5\ndirection = 0.3': H.stroke(
        stroke=0.04, frequency=5.0, direction=0.3
    ),
    'kind = "orbit"\ndiameter = 0.02\nrpm = 300\nsense = -1': H.orbit(diameter=0.02, rpm=300.0, sense=-1),
    'kind = "harmonic"\namplitude = [0.1, 0.2, 0.3]\nphase = [0, 1, 2]\nangular_frequency = 2': H(
        amplitude=(0.1, 0.2, 0.3), phase=(0.0, 1.0, 2.0), angular_frequency=2.0
    ),
    'kind = "half_sine"\nacceleration = 2\nangular_frequency = 3\ndirection = 0.3\nstart = 1\nvertical = 0.5': (
        P.half_sine(acceleration=2.0, angular_frequency=3.0, direction=0.3, start=1.0, vertical=0.5)
    ),
    'kind = "half_cosine"\nacceleration = 2\nangular_frequency = 3': P.half_cosine(
        acceleration=2.0, angular_frequency=3.0
    ),
    'kind = "one_sine"\nacceleration = 2\nangular_frequency = 3': P.one_sine(acceleration=2.0, angular_frequency=3.0),
    'kind = "one_cosine"\nacceleration = 2\nangular_frequency = 3': P.one_cosine(
        acceleration=2.0, angular_frequency=3.0
    ),
    'kind = "sinusoidal"\nacceleration = 2\nangular_frequency = 3\nphase = 0.2\ncycles = 2.5': P.sinusoidal(
        acceleration=2.0, angular_frequency=3.0, phase=0.2, cycles=2.5
    ),
    'kind = "type_a"\nvelocity = 0.4\nangular_frequency = 3': P.type_a(velocity=0.4, angular_frequency=3.0),
    'kind = "type_b"\nvelocity = 0.4\nangular_frequency = 3': P.type_b(velocity=0.4, angular_frequency=3.0),
    'kind = "type_c"\nvelocity = 0.4\nangular_frequency = 3\ncycles = 2': P.type_c(
        velocity=0.4, angular_frequency=3.0, cycles=2
    ),
    'kind = "ricker"\nacceleration = 2\nangular_frequency = 3': P.ricker(acceleration=2.0, angular_frequency=3.0),
    'kind = "antisymmetric_ricker"\nacceleration = 2\nangular_frequency = 3': P.antisymmetric_ricker(
        acceleration=2.0, angular_frequency=3.0
    ),
    'kind = "gabor"\nvelocity = 0.4\nfrequency = 1.5\noscillations = 2': P.gabor(
        velocity=0.4, frequency=1.5, oscillations=2.0
    ),
    'kind = "mavroeidis_papageorgiou"\nvelocity = 0.4\nfrequency = 1.5\noscillations = 2\nphase = 1': (
        P.mavroeidis_papageorgiou(velocity=0.4, frequency=1.5, oscillations=2.0, phase=1.0)
    ),
    'kind = "linear_sweep"\nacceleration = 0.4\nfrequencies = [0.5, 4]\nlength = 4\nstart_phase = 1': SineSweep.linear(
        acceleration=0.4, frequencies=(0.5, 4.0), length=4.0, start_phase=1.0
    ),
    'kind = "logarithmic_sweep"\ndisplacement = 0.4\nfrequencies = [4, 0.5]\nlength = 4\nstart = 0.5': (
        sb.SineSweep.logarithmic(displacement=0.4, frequencies=(4.0, 0.5), length=4.0, start=0.5)
    ),
    'kind = "sum"\nmotions = [{kind = "rest"}, {kind = "orbit", diameter = 0.02, rpm = 300}]': Sum(
        motions=(BASE_AT_REST, H.orbit(diameter=0.02, rpm=300.0))
    ),
    'kind = "scaled"\nfactor = 2\nmotion = {kind = "vertical", acceleration = 1, angular_frequency = 2}': H.vertical(
        acceleration=1.0, angular_frequency=2.0
    ).scaled(2.0),
    'kind = "scaled"\nfactor = 2\nvertical = 0\nmotion = {kind = "vertical", acceleration=1, angular_frequency=3}': (
        H.vertical(acceleration=1.0, angular_frequency=3.0).scaled(2.0, vertical=0.0)
    ),
    'kind = "rotated"\nangle = 0.3\nmotion = {kind = "orbit", diameter = 0.02, rpm = 300}': H.orbit(
        diameter=0.02, rpm=300.0
    ).rotated(0.3),
    'kind = "delayed"\ndelay = 1.5\nmotion = {kind = "orbit", diameter = 0.02, rpm = 300}': H.orbit(
        diameter=0.02, rpm=300.0
    ).delayed(1.5),
}

COLUMNS = {
    'shape = "solid"\nradius = 0.5\nheight = 10\ndensity = 2700': sb.Column.solid(
        radius=0.5, height=10.0, density=2700.0
    ),
    'shape = "hollow"\nradius = 0.5\ninner_radius = 0.4\nheight = 10\ndensity = 2700': sb.Column.hollow(
        radius=0.5, inner_radius=0.4, height=10.0, density=2700.0
    ),
    'shape = "frustum"\nradius = 0.5\ntop_radius = 0.4\nheight = 10\ndensity = 2700\ngravity = 1.6': sb.Column.frustum(
        radius=0.5, top_radius=0.4, height=10.0, density=2700.0, gravity=1.6
    ),
    'shape = "dimensionless"\nslenderness = 0.1': sb.Column.dimensionless(0.1),
    'shape = "given"\nradius = 0.5\nmass_height = 5\nmass=1e3\ntransverse_inertia=8e3\naxial_inertia=125': sb.Column(
        radius=0.5, mass_height=5.0, mass=1e3, transverse_inertia=8e3, axial_inertia=125.0
    ),
    "sides = 6\nside = 0.4\nheight = 2\nmass = 1500": sb.Column.prism(sides=6, side=0.4, height=2.0, mass=1500.0),
    'shape = "prism"\nsides = 4\nside = "60 cm"\nheight = 2\ndensity = 2300\ncircle = "circumscribed"': sb.Column.prism(
        sides=4, side=0.6, height=2.0, density=2300.0, circle="circumscribed"
    ),
    'diameter = 2\nheight = 3\nwall_thickness = "6 mm"\ndensity = 7850\nliquid_depth = 2.5\nliquid = "level"': (
        sb.Column.tank(radius=1.0, height=3.0, wall_thickness=0.006, density=7850.0, liquid_depth=2.5, liquid="level")
    ),
    "parts = [{diameter = 0.8, height = 1, density = 2300}, {sides = 4, side = 0.4, height = 1.5, density = 2700}]": (
        sb.Column.from_parts(
            [
                sb.Column.solid(radius=0.4, height=1.0, density=2300.0),
                sb.Column.prism(sides=4, side=0.4, height=1.5, density=2700.0),
            ]
        )
    ),
    'diameter = 1\nelevations = ["10 cm"]\nparts = [{radius = 0.4, height = 1, density = 2300}]': sb.Column.from_parts(
        [sb.Column.solid(radius=0.4, height=1.0, density=2300.0)], elevations=[0.1], radius=0.5
    ),
}


def described(text, tmp_path):
    path = tmp_path / "run.toml"
    path.write_text(text, encoding="utf-8")
    return SimulationConfig.parse(read_config(path))


@pytest.mark.parametrize("text", MOTIONS)
def test_every_kind_of_motion_can_be_written(text, tmp_path):
    setup = described(f"duration = 5.0\n{STONE}[motion]\n{text}", tmp_path).build()
    assert setup.motion == MOTIONS[text]


@pytest.mark.parametrize("text", COLUMNS)
def test_every_shape_of_column_can_be_written(text, tmp_path):
    setup = described(f"duration = 5.0\n[column]\n{text}", tmp_path).build()
    assert setup.model == sb.Wobbling(COLUMNS[text])
    assert setup.motion == BASE_AT_REST


def test_a_mistake_in_a_part_of_a_column_is_named_with_its_place():
    stone = {"radius": 0.4, "height": 1.0, "density": 2300.0}
    with pytest.raises(ConfigError) as caught:
        SimulationConfig.parse(
            {"column": {"parts": [stone, {**stone, "hight": 2.0}, {"radius": 0.4}]}, "duration": 1.0}
        )
    lines = str(caught.value)
    assert "column.parts.1.hight does not belong" in lines
    assert "column.parts.2.height is missing" in lines
    with pytest.raises(ConfigError, match=r"^column: parts\[1\]: has no height"):
        SimulationConfig.parse({"column": {"parts": [stone, {"slenderness": 0.1}]}, "duration": 1.0}).build()


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=lambda motion: type(motion).__name__)
def test_a_motion_described_and_built_again_is_the_same(motion):
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.3)
    stored = json.loads(json.dumps(provenance_of_run(model, motion, duration=5.0, tilt=(0.1, 0.2))))
    setup = config_of(stored).build()
    assert setup.motion == motion
    np.testing.assert_array_equal(setup.motion.displacement(TIME), motion.displacement(TIME))
    assert setup.model == model
    assert (setup.options["duration"], setup.options["tilt"]) == (5.0, (0.1, 0.2))


@pytest.mark.parametrize("kind", KINDS)
def test_damping_in_a_word_is_the_number_of_the_column_where_the_model_is_made(kind):
    values = {"column": {"radius": 0.3, "height": 3.0, "density": 2700.0}, "tilt": (0.05, 0.0), "duration": 1.0}
    setup = SimulationConfig.parse({**values, "model": {"kind": kind, "damping": "housner"}}).build()
    assert setup.model.damping == setup.model.column.housner_damping(0.5)
    stored = json.loads(json.dumps(provenance_of_run(setup.model, setup.motion, duration=1.0)))
    assert stored["model"]["damping"] == setup.model.damping
    assert config_of(stored).build().model == setup.model


def test_the_models_of_the_hierarchy_share_the_number_of_a_word():
    values = {"column": {"radius": 0.3, "height": 3.0, "density": 2700.0}, "tilt": (0.05, 0.0), "duration": 1.0}
    setup = study_config(sb.studies.model_hierarchy).parse({**values, "model": {"damping": "housner"}}).build()
    assert setup.options["damping"] == setup.model.damping == setup.model.column.housner_damping()


@pytest.mark.parametrize("stated", ["housnr", "", [0.1], None])
def test_neither_a_number_nor_a_word_is_one_line(stated):
    with pytest.raises(ConfigError) as caught:
        SimulationConfig.parse(BASE | {"model": {"kind": "rolling", "damping": stated}})
    assert caught.value.problems == (f"model.damping: must be a number or 'housner', got {stated!r}",)


def test_all_arguments_of_a_run_can_be_written(tmp_path):
    text = "tilt = [0.01, 0.02]\ntilt_rate = [0.0, 1]\nduration = 5\nrtol = 1e-9\natol = 1e-12\ntilt_limit = 0.5\n"
    text += (
        "rest_energy = 1e-5\nmax_steps = 1000\nsamples = 51\n" + STONE + '[model]\nkind = "slender"\ndamping = 0.1\n'
    )
    setup = described(text, tmp_path).build()
    assert setup.model.damping == 0.1
    run = sb.simulate(setup.model, setup.motion, **setup.options)
    assert run.data.sizes["time"] == 51
    assert run.provenance["rtol"] == 1e-9


BASE = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "duration": 1.0}
CIRCULAR = {"kind": "circular", "acceleration": 1.0, "angular_frequency": 1.0}


@pytest.mark.parametrize(
    ("change", "fields"),
    [
        ({"duration": "long"}, ["duration"]),
        ({"duration": None}, ["duration"]),
        ({"colour": 1}, ["colour"]),
        ({"tilt": [0.1]}, ["tilt.1"]),
        ({"tilt": ["x", 0.0]}, ["tilt.0"]),
        ({"tilt": 0.1}, ["tilt"]),
        ({"max_steps": 1.5}, ["max_steps"]),
        ({"column": 3}, ["column"]),
        ({"column": {}}, ["column.height", "column.radius"]),
        ({"column": {"shape": "cube"}}, ["column.shape"]),
        ({"column": {"shape": "solid", "radius": 0.5, "hight": 3.0, "density": "x"}}, None),
        ({"model": {"damping": "x"}}, ["model.damping"]),
        ({"model": {"friction": 0.1}}, ["model.friction"]),
        ({"model": {"kind": "fat"}}, ["model.kind"]),
        ({"model": 3}, ["model"]),
        ({"motion": {"kind": "wild"}}, ["motion.kind"]),
        ({"motion": {"acceleration": 1.0}}, ["motion.kind"]),
        ({"motion": {**CIRCULAR, "acceleration": "x"}}, ["motion.acceleration"]),
        ({"motion": {**CIRCULAR, "sens": 1}}, ["motion.sens"]),
        ({"motion": {"kind": "circular"}}, ["motion.acceleration", "motion.angular_frequency"]),
        (
            {"motion": {"kind": "sum", "motions": [CIRCULAR, {"kind": "orbit", "rpm": 3}]}},
            ["motion.motions.1.diameter"],
        ),
        ({"motion": {"kind": "sum", "motions": [3]}}, ["motion.motions.0"]),
        ({"motion": {"kind": "rotated", "angle": 1.0, "motion": {"kind": "x"}}}, ["motion.motion.kind"]),
        (
            {"motion": {"kind": "elliptic", "amplitude": [1, "x"], "phase": 0, "angular_frequency": 1}},
            ["motion.amplitude.1"],
        ),
        ({"motion": {"kind": "scaled", "motion": CIRCULAR}}, ["motion.factor"]),
        (
            {"motion": {"kind": "half_sine", "velocity": 1.0, "acceleration": 1.0}},
            ["motion.angular_frequency", "motion.velocity"],
        ),
        ({"motion": {"kind": "type_c", "velocity": 1.0, "angular_frequency": 1.0, "cycles": 1.5}}, ["motion.cycles"]),
    ],
)
def test_each_mistake_is_one_line_that_names_its_field(change, fields):
    with pytest.raises(ConfigError) as caught:
        SimulationConfig.parse({**BASE, **change})
    fields = ["column.density", "column.height", "column.hight"] if fields is None else fields
    problems = caught.value.problems
    assert sorted(line.split(" ")[0].rstrip(":") for line in problems) == fields
    assert str(caught.value).splitlines() == list(problems)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ConfigError) as caught:
        SimulationConfig.parse({"column": {"shape": "cube"}, "motion": {"kind": "circular"}, "tilt": [1, "x"], "a": 0})
    names = [line.split(" ")[0].rstrip(":") for line in caught.value.problems]
    assert sorted(names) == sorted(["column.shape", "motion.acceleration", "motion.angular_frequency", "tilt.1", "a"])


@pytest.mark.parametrize(
    ("change", "starts"),
    [
        (
            {"column": {"shape": "dimensionless", "slenderness": -0.1}},
            ["column: slenderness must be positive, got -0.1"],
        ),
        (
            {"column": {"shape": "solid", "radius": 1e200, "height": 1e200, "density": 1e200}},
            ["column: radius: too large to compute with (got 1e+200 m). Give at most 1e+15 m; check the unit."],
        ),
        ({"model": {"damping": -1.0}}, ["model: damping must be zero or positive, got -1.0"]),
        ({"motion": {**CIRCULAR, "sense": 3}}, ["motion: sense must be 1 or -1, got 3: +1 anticlockwise"]),
        ({"motion": {**CIRCULAR, "angular_frequency": 0.0}}, ["motion: angular_frequency must be positive, got 0.0"]),
        (
            {"motion": {"kind": "gabor", "velocity": 1.0, "frequency": 1.0, "oscillations": 0.0}},
            ["motion: oscillations must be positive and at most 100"],
        ),
        (
            {"motion": {"kind": "linear_sweep", "frequencies": [1.0, 2.0], "length": 9.0}},
            ["motion: acceleration or displacement must be given, one of them"],
        ),
        (
            {
                "column": {"shape": "dimensionless", "slenderness": math.nan},
                "motion": {**CIRCULAR, "ramp": -1.0},
            },
            ["column: slenderness must be positive, got nan", "motion: ramp must be zero or positive, got -1.0"],
        ),
    ],
)
def test_what_cannot_be_built_is_one_line_for_each_part(change, starts):
    description = SimulationConfig.parse({**BASE, **change})
    with pytest.raises(ConfigError) as caught:
        description.build()
    problems = caught.value.problems
    assert len(problems) == len(starts)
    assert all(line.startswith(start) for line, start in zip(problems, starts, strict=True))


@pytest.mark.parametrize("content", [b"duration = ", b"\xff\xfe", b"a = 1\na = 2"])
def test_what_is_no_toml_is_a_file_error_that_names_the_file(content, tmp_path):
    path = tmp_path / "run.toml"
    path.write_bytes(content)
    with pytest.raises(FileError, match=r"run\.toml is not a TOML file"):
        read_config(path)


def test_a_missing_file_is_a_file_error_that_names_it(tmp_path):
    with pytest.raises(FileError, match=r"cannot read .*none\.toml: No such file"):
        read_config(tmp_path / "none.toml")


def test_a_motion_of_the_users_own_runs_and_its_provenance_says_it_cannot_be_repeated():
    class Own(sb.BaseMotion):
        def derivative(self, time, order):
            t = np.asarray(time, dtype=float)
            return ((-1.0) ** order * np.exp(-t) * 0.01, np.zeros_like(t), np.zeros_like(t))

        def peak_horizontal(self, since=0.0):
            return 0.01 * math.exp(-since)

        def vertical_range(self, since=0.0):
            del since
            return 0.0, 0.0

        def directions(self):
            return ((1.0, 0.0),)

    run = sb.simulate(sb.Slender(sb.Column.dimensionless(0.1)), Own(), tilt=(0.01, 0.0), duration=1.0)
    assert run.planar
    assert run.provenance["motion"]["kind"] == "other"
    with pytest.raises(UnsupportedError, match="only the repr is kept"):
        config_of(run.provenance)


def test_a_pulse_of_the_users_own_waveform_keeps_only_its_repr():
    @dataclass(frozen=True, slots=True)
    class Bump(Waveform):
        duration: float = 1.0
        highest_frequency: float = 1.0

        def derivative(self, time, order):
            return 0.01 * time ** (2 - order) / (2.0, 1.0, 1.0)[order]

        def turning_points(self):
            return ()

    model = sb.Slender(sb.Column.dimensionless(0.1))
    stored = provenance_of_run(model, sb.Pulse(waveform=Bump()), duration=5.0, tilt=(0.1, 0.2))
    assert stored["motion"]["kind"] == "other"
    assert "Bump" in stored["motion"]["repr"]


@pytest.mark.parametrize("diameter", [0.6, "60 cm", "600 mm", "0.6"])
def test_files_may_state_diameters_in_place_of_radii(diameter):
    numbers = {"height": 3.0, "density": 2500.0}
    described = {"motion": {"kind": "rest"}, "duration": 1.0}
    found = SimulationConfig.parse({"column": {"diameter": diameter, **numbers}, **described}).column.build()
    assert found == sb.Column.solid(radius=0.3, **numbers)
    hollow = SimulationConfig.parse({"column": {"diameter": diameter, "inner_diameter": 0.5, **numbers}, **described})
    assert hollow.column.build() == sb.Column.hollow(radius=0.3, inner_radius=0.25, **numbers)
    with pytest.raises(ParameterError, match="column: diameter and radius must not both be given"):
        SimulationConfig.parse({"column": {"diameter": diameter, "radius": 0.3, **numbers}, **described})
    with pytest.raises(ConfigError, match=r"column\.radius"):
        SimulationConfig.parse({"column": {"diameter": "wide", **numbers}, **described})
