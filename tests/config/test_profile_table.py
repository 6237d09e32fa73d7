"""Columns by their profile in files, on the command line and in saved results."""

import json
import math

import pytest

import stylobate as sb
from stylobate.cli.main import run as cli
from stylobate.config import SimulationConfig, config_of, read_config
from stylobate.config.profile_table import Corners
from stylobate.config.snippets import as_python
from stylobate.errors import ConfigError, FileError

AMPHORA = {"radius": 0.11, "height": 0.95, "mass_height": 0.52, "mass": 14.0}
BELL = [0.0, 0.2, 0.3], [0.15, 0.1, 0.02]


def built(column):
    return SimulationConfig.parse({"column": column, "duration": 1.0}).column.build()


@pytest.fixture
def bell(tmp_path):
    path = tmp_path / "church-bell.csv"
    path.write_text("height [mm];diameter [cm];wall\n0;30;0,01\n200;20;0,01\n300;4;0,01\n", encoding="utf-8")
    return path


def test_a_table_of_corners_has_units_diameters_and_walls(bell):
    corners = Corners.read(bell)
    assert corners.heights == pytest.approx(BELL[0])
    assert corners.radii == pytest.approx(BELL[1])
    assert corners.inner_radii == pytest.approx([0.14, 0.09, 0.01])


def test_a_file_of_a_description_is_relative_to_its_folder(bell):
    study = bell.parent / "study.toml"
    study.write_text(f'duration = 1.0\n[column]\nprofile = "{bell.name}"\ndensity = 8700.0\n', encoding="utf-8")
    column = SimulationConfig.parse(read_config(study)).column.build()
    inner = [one - 0.01 for one in BELL[1]]
    drawn = sb.Column.from_profile(*BELL, inner_radii=inner, density=8700.0, profile=bell.name)
    assert column.transverse_inertia == pytest.approx(drawn.transverse_inertia)
    assert column.profile.name == bell.name


def test_corners_can_be_listed_in_a_description():
    column = built({"heights": ["0 mm", 0.2, 0.3], "radii": BELL[1], "density": 8700.0})
    assert column == sb.Column.from_profile(*BELL, density=8700.0)


def test_a_kind_of_profile_is_estimated_in_a_description():
    described = {**AMPHORA, "profile": "amphora", "max_diameter": "40 cm"}
    assert built(described) == sb.Column.estimated(**AMPHORA, profile="amphora", max_radius=0.2)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("height,wall\n0,1\n1,1\n", "the column radius is missing. Write it in the first line"),
        ("height,raduis\n0,1\n1,1\n", "heading 'raduis': unknown column; did you mean radius?"),
        ("height,radius\n0,1\n1,x\n", "line 3: must be a number, with or without a unit, got 'x m'. Correct the cell."),
    ],
)
def test_a_table_with_a_mistake_is_refused(tmp_path, text, message):
    path = tmp_path / "bell.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileError) as caught:
        Corners.read(path)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("column", "message"),
    [
        (AMPHORA, "column.transverse_inertia and axial_inertia are missing. State profile (cylinder, cone, vase, "),
        ({**AMPHORA, "axial_inertia": 0.1}, "column.transverse_inertia is missing. State it, or in place of both"),
        ({**AMPHORA, "max_radius": 0.2}, "column.profile is missing: the kind of profile, cylinder, cone, "),
        ({"profile": "", "density": 1.0, "heights": []}, "column: profile: missing. Name the file of its table"),
    ],
)
def test_missing_moments_of_inertia_name_the_remedy(column, message):
    with pytest.raises(ConfigError) as caught:
        SimulationConfig.parse({"column": column, "duration": 1.0}).build()
    (line,) = caught.value.problems
    assert line.startswith(message)


@pytest.fixture(scope="module")
def run():
    """A run of an estimated column."""
    model = sb.Wobbling(sb.Column.estimated(**AMPHORA, profile="amphora"), damping=0.1)
    return sb.simulate(model, tilt=(0.02, 0.0), duration=0.1)


def test_the_provenance_of_a_run_repeats_its_profile(run):
    again = config_of(json.loads(json.dumps(run.provenance))).build()
    assert again.model == sb.Wobbling(sb.Column.estimated(**AMPHORA, profile="amphora"), damping=0.1)


def test_the_program_of_a_run_makes_its_profile_again(run, bell):
    made = {}
    exec(as_python(config_of(run.provenance)).partition("model =")[0], made)  # noqa: S102  our own text
    assert made["column"] == sb.Column.estimated(**AMPHORA, profile="amphora")
    described = {"column": {"profile": str(bell), "mass": 20.0}, "duration": 1.0}
    exec(as_python(SimulationConfig.parse(described)).partition("model =")[0], made)  # noqa: S102  our own text
    assert made["column"] == built(described["column"])


def test_the_command_line_takes_a_kind_or_a_file(capsys, bell):
    def told(*options):
        code = cli(["simulate", *options, "--duration", "0.1"])
        return code, "".join(capsys.readouterr())

    four = [part for name, value in AMPHORA.items() for part in (f"--{name.replace('_', '-')}", str(value))]
    code, text = told(*four)
    assert code != 0
    assert "State profile (cylinder, cone, vase," in " ".join(text.split())
    assert "amphora, inertia estimated, ±10 %" in told(*four, "--profile", "amphora")[1]
    assert "mass 20 kg" in told("--profile", str(bell), "--mass", "20")[1]
    assert math.isclose(built({"profile": str(bell), "mass": 20.0}).mass, 20.0)
