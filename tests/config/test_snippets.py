"""A description as a program and as a file does what the description does."""

import tomllib

import numpy as np
import pytest
from PIL import Image

import stylobate as sb
from stylobate.config import SimulationConfig
from stylobate.config.snippets import as_python, as_toml
from stylobate.lab.options import presets

COLUMN = {"shape": "dimensionless", "slenderness": 0.1}
RICKER = {"kind": "ricker", "acceleration": 0.2, "angular_frequency": 3.0}
STRAIGHT = {"kind": "straight", "acceleration": 0.15, "angular_frequency": 2.0}

CASES = {
    "free": {"column": COLUMN, "tilt": [0.05, 0.01], "duration": 5.0},
    "column by its numbers": {
        "column": {
            "shape": "given",
            "radius": 0.1,
            "mass_height": 1.0,
            "mass": 2.0,
            "transverse_inertia": 0.7,
            "axial_inertia": 0.01,
            "gravity": 9.8,
        },
        "tilt": [0.05, 0.01],
        "duration": 3.0,
    },
    "model with numbers": {
        "column": {"shape": "frustum", "radius": 0.3, "top_radius": 0.2, "height": 2.0, "density": 2000.0},
        "model": {"kind": "slender_rolling", "damping": 0.1, "spin_damping": 0.2},
        "motion": {"kind": "orbit", "diameter": 0.4, "rpm": 40.0},
        "duration": 4.0,
    },
    "damping by a word": {
        "column": {"radius": 0.3, "height": 3.0, "density": 2700.0},
        "model": {"kind": "wobbling", "damping": "housner", "rolling_resistance": 0.01},
        "tilt": [0.05, 0.01],
        "duration": 3.0,
    },
    "column of parts": {
        "column": {
            "shape": "parts",
            "parts": [
                {"shape": "prism", "sides": 4, "side": 0.8, "height": 1.0, "density": 2300.0},
                {"shape": "frustum", "radius": 0.3, "top_radius": 0.2, "height": 1.5, "density": 2700.0},
            ],
            "elevations": [0.05, 1.05],
            "radius": 0.35,
        },
        "tilt": [0.05, 0.01],
        "duration": 3.0,
    },
    "rules": {"column": COLUMN, "motion": STRAIGHT, "duration": 30.0, "rules": {"periods": 4.0}},
    "waves in three directions": {
        "column": COLUMN,
        "motion": {"kind": "harmonic", "amplitude": [0.15, 0.1, 0.05], "angular_frequency": 2.0},
        "duration": 5.0,
    },
    "sum of copies": {
        "column": COLUMN,
        "motion": {
            "kind": "sum",
            "motions": [
                {"kind": "delayed", "delay": 0.5, "motion": STRAIGHT},
                {
                    "kind": "rotated",
                    "angle": 0.3,
                    "motion": {"kind": "ricker", "acceleration": 0.2, "angular_frequency": 3.0},
                },
                {"kind": "scaled", "factor": 0.5, "vertical": 0.2, "motion": STRAIGHT},
            ],
        },
        "duration": 6.0,
    },
    "out of level": {
        "column": COLUMN,
        "motion": {
            "kind": "offset",
            "offset_x": 0.01,
            "motion": {"kind": "offset", "offset_x": 0.002, "offset_y": 0.002, "motion": STRAIGHT},
        },
        "duration": 6.0,
    },
    "sweep": {
        "column": COLUMN,
        "motion": {"kind": "linear_sweep", "acceleration": 0.15, "frequencies": [0.1, 0.5], "length": 20.0},
        "duration": 6.0,
    },
    "sample record": {
        "column": {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2700.0},
        "model": {"kind": "wobbling", "damping": 0.05},
        "motion": {"kind": "record", "sample": "el centro 1940", "scale": 0.8, "rotation": 0.4},
        "duration": 4.0,
    },
    "processed record": {
        "column": {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2700.0},
        "motion": {
            "kind": "record",
            "sample": "el centro 1940",
            "processing": [{"method": "trimmed", "begin": 0.0, "end": 5.0}],
        },
        "duration": 4.0,
    },
}


def made(values):
    setup = SimulationConfig.parse(values).build()
    return sb.simulate(setup.model, setup.motion, **setup.options)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Programs draw into the folder they are run in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_by(program):
    names = {}
    exec(program, names)  # noqa: S102  it is what users are given
    return names["run"]


@pytest.mark.parametrize("name", CASES)
def test_the_program_makes_the_described_run(name):
    told, expected = run_by(as_python(SimulationConfig.parse(CASES[name]))), made(CASES[name])
    assert told.outcome is expected.outcome
    assert told.measures == pytest.approx(expected.measures, nan_ok=True)


# Others have the same kinds of column, model and motion.
ALIKE = ("circle-weak", "line-strong", "line-weak", "modulated")
PRESETS = [
    pytest.param(one, id=one.identity, marks=[pytest.mark.slow] if one.identity in ALIKE else []) for one in presets()
]


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS)
def test_the_program_of_a_preset_shows_what_the_preset_says_and_draws_it(preset, folder):
    run = run_by(as_python(SimulationConfig.parse(preset.description)))
    assert run.outcome.name == preset.outcome
    with Image.open(folder / "run.png") as drawn:
        assert np.ptp(np.asarray(drawn.convert("L"))) > 200  # from black ink to white paper


QUAKE, READ = {"kind": "record", "sample": "el centro 1940"}, "sb.sample_record('el centro 1940')"


@pytest.mark.parametrize(
    ("motion", "told"),
    [
        (QUAKE | {"scale": 1.0, "rotation": 0.0, "tail": 0.0}, READ),
        (QUAKE | {"scale": 1.0, "rotation": 0.4}, f"{READ}.rotated(0.4)"),
        ({"kind": "rotated", "angle": 0.0, "motion": {"kind": "delayed", "delay": 0.0, "motion": QUAKE}}, READ),
        ({"kind": "scaled", "factor": 1.0, "vertical": 1.0, "motion": QUAKE}, READ),
        (
            {"kind": "scaled", "factor": 2.0, "vertical": 1.0, "motion": QUAKE},
            f"{READ}.scaled(2.0, vertical=1.0)",
        ),
        (
            {"kind": "scaled", "factor": 1.0, "vertical": 0.0, "motion": QUAKE},
            f"{READ}.scaled(1.0, vertical=0.0)",
        ),
    ],
)
def test_what_changes_nothing_is_not_written(motion, told):
    program = as_python(SimulationConfig.parse({"column": COLUMN, "motion": motion, "duration": 5.0}))
    assert f"motion = {told}\n" in program


def test_a_processed_record_is_written_without_what_changes_nothing():
    motion = QUAKE | {"scale": 1.0, "rotation": 0.4, "processing": [{"method": "inverted"}]}
    program = as_python(SimulationConfig.parse({"column": COLUMN, "motion": motion, "duration": 5.0}))
    assert "'rotation': 0.4" in program
    assert "scale" not in program


@pytest.mark.parametrize("name", CASES)
def test_the_file_holds_the_same_values(name):
    assert tomllib.loads(as_toml(CASES[name])) == CASES[name]


def test_a_record_in_files_is_read_as_it_is_described(tmp_path):
    for part in ("NS", "EW"):
        lines = "\n".join(f"{0.01 * i:.2f} {0.1 * (-1) ** i:.3f}" for i in range(50))
        (tmp_path / f"quake_{part}.txt").write_text(lines)
    paths = [str(tmp_path / f"quake_{part}.txt") for part in ("NS", "EW")]
    motion = {"kind": "record", "path": paths, "units": "g", "scale": 2.0}
    description = SimulationConfig.parse({"column": COLUMN, "motion": motion, "duration": 1.0})
    program = as_python(description)
    assert "sb.read_records(" in program
    names = {}
    exec(program, names)  # noqa: S102
    assert np.array_equal(names["motion"].samples, description.build().motion.samples)
