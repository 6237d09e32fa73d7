"""Models and base motions of a user's own: chosen by their place, with the options that they declare."""

import json

import pytest

import stylobate as sb
from stylobate.cli.main import run

CASE = [*("--slenderness", "0.1", "--tilt", "0.03", "0.01", "--duration", "5")]
DRIVEN = [*("--motion", "circular", "--acceleration", "0.06", "--angular-frequency", "1.8")]

MODULE = '''
from dataclasses import dataclass
from typing import Annotated

from stylobate import Harmonic, Slender
from stylobate.quantities import Quantity


@dataclass(frozen=True, slots=True, kw_only=True)
class Tethered(Slender):
    """A slender column on a tether."""

    stiffness: Annotated[float, Quantity(symbol="k", text="stiffness of the tether", ge=0.0)] = 0.0
    tilt: Annotated[float, Quantity(unit="rad", text="tilt of the tether")] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Twice(Harmonic):
    """A harmonic motion with another number."""

    loudness: Annotated[float, Quantity(text="loudness")] = 1.0
'''


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(MODULE, encoding="utf-8")
    return tmp_path


@pytest.fixture
def arguments_of_simulate(monkeypatch):
    """Return what a run would be made with, instead of running it."""
    calls = []

    def stop(model, motion, **options):
        calls.append((model, motion))
        raise KeyboardInterrupt

    monkeypatch.setattr("stylobate.engine.simulate", stop)
    return calls


def test_a_model_of_ones_own_has_the_options_that_it_declares(folder, arguments_of_simulate):
    own = ["--model", "mine.py:Tethered", "--stiffness", "0.2", "--model-tilt", "0.4", "--damping", "0.1"]
    assert run(["simulate", *CASE, *DRIVEN, *own]) == 130
    ((model, _),) = arguments_of_simulate
    assert type(model).__name__ == "Tethered"
    assert (model.stiffness, model.tilt, model.damping) == (0.2, 0.4, 0.1)


def test_a_base_motion_of_ones_own_has_the_options_that_it_declares(folder, arguments_of_simulate):
    own = ["--motion=mine.py:Twice", "--loudness", "3", "--amplitude", "0.1", "0.2", "0.3", "--angular-frequency", "2"]
    assert run(["simulate", *CASE, *own]) == 130
    ((_, motion),) = arguments_of_simulate
    assert (motion.loudness, motion.amplitude, motion.angular_frequency) == (3.0, (0.1, 0.2, 0.3), 2.0)


def test_a_class_that_the_file_names_has_its_options_too(folder, arguments_of_simulate):
    (folder / "run.toml").write_text(
        'duration = 5.0\ncolumn.slenderness = 0.1\nmodel = {kind = "mine.py:Tethered", stiffness = 0.2}\n'
    )
    assert run(["simulate", "run.toml", "--stiffness", "0.3"]) == 130
    ((model, _),) = arguments_of_simulate
    assert model.stiffness == 0.3


def test_help_shows_the_options_of_a_class_of_ones_own(folder, capsys):
    assert run(["simulate", "--model", "mine.py:Tethered", "--help"]) == 0
    assert "stiffness of the tether k" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    ("own", "line"),
    [
        (
            ["--model", "mine.py:Tethered", "--patch", "1"],
            "--patch: model '",
        ),
        (["--model", "mine.py:Nothing"], "kind: cannot load '"),
        (["--model", "mine.py:Twice"], "model.kind: no model (got '"),
        (["--motion", "missing.py:Twice"], "kind: cannot load '"),
        (["--motion", "no_such_module:Twice"], "kind: cannot load 'no_such_module:Twice'"),
        (["--model", "mine.py:Tethered", "--stiffness", "-1"], "model: stiffness must be zero or positive, got -1.0"),
        (["--stiffness", "1"], "No such option '--stiffness'"),
    ],
)
def test_mistakes_in_a_class_of_ones_own_are_one_line(folder, own, line, capsys):
    assert run(["simulate", *CASE, *own]) == 2
    (printed,) = capsys.readouterr().err.splitlines()
    assert printed.startswith(f"stylobate: {line}")


@pytest.mark.parametrize(
    "options",
    [
        ["--inertia-ratio", "0.7", "--axial-ratio", "0.4"],
        ["--model", "slender-rolling", "--couples", "isotropic"],
        ["--atol", "1e-6"],
    ],
)
def test_every_declared_number_has_an_option(options, capsys):
    assert run(["simulate", *CASE, *options, "--json"]) == 0
    provenance = json.loads(capsys.readouterr().out)["provenance"]
    if "--atol" in options:
        assert provenance["atol"] == 1e-6
    elif "--couples" in options:
        assert provenance["model"]["couples"] == "isotropic"
    else:
        column = sb.Column.dimensionless(0.1, 0.7, 0.4)
        assert provenance["column"]["axial_inertia"] == column.axial_inertia


def test_a_motion_in_space_takes_three_amplitudes(capsys):
    harmonic = [*("--motion", "harmonic", "--amplitude", "0.01", "0.02", "0.03", "--angular-frequency", "2")]
    assert run(["simulate", *CASE, *harmonic, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["provenance"]["motion"]["amplitude"] == [0.01, 0.02, 0.03]
