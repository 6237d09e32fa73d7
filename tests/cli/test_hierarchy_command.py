"""`stylobate hierarchy`, and models and their frictions on the command line."""

import json

import pytest

import stylobate as sb
from stylobate.cli.main import run

COLUMN = ["--slenderness", "0.1", "--damping", "0.1"]
MOTION = ["--motion", "circular", "--acceleration", "0.065", "--angular-frequency", "1.8"]
START = ["--tilt", "0.04", "0", "--tilt-rate", "0", "0.07", "--duration", "10"]
CASE = [*COLUMN, *MOTION, *START]
SAMPLE = ["--random", "3", "--over", "tilt-x", "0", "1"]
RANGES = ["--angular-frequency-range", "1", "2", "--bounds", "0.1", "0.2"]
LINE = ["--motion", "straight", "--acceleration", "0.15", "--angular-frequency", "3"]


def told(capsys):
    return json.loads(capsys.readouterr().out)


def test_ladder_prints_what_ladder_finds(capsys):
    assert run(["hierarchy", *CASE, "--spin-damping", "0.1", "--json"]) == 0
    printed = told(capsys)
    found = sb.studies.model_hierarchy(
        sb.Column.dimensionless(0.1),
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8),
        damping=0.1,
        spin_damping=0.1,
        tilt=(0.04, 0.0),
        tilt_rate=(0.0, 0.07),
        duration=10.0,
    )
    assert printed["model"] == found["model"].to_numpy().tolist()
    assert printed["peak_tilt"] == found["peak_tilt"].to_numpy().tolist()
    assert printed["deviation"] == found["deviation"].to_numpy().tolist()


def test_the_table_has_a_row_for_each_level_and_says_how_they_converge(capsys, tmp_path):
    drawn, saved = tmp_path / "hierarchy.png", tmp_path / "hierarchy.nc"
    arguments = [*CASE, "--scaled-to", "0.05", "--scaled-to", "0.2", "--friction-coefficient", "0.05"]
    assert run(["hierarchy", *arguments, "--figure", str(drawn), "--output", str(saved)]) == 0
    printed = capsys.readouterr().out
    assert "the distance of wobbling from slender is proportional to c to the power 2.0" in printed
    assert "rolling: it would slip" in printed
    assert drawn.stat().st_size > 10_000
    assert saved.stat().st_size > 10_000


@pytest.mark.slow
def test_demands_without_bound_are_told_in_words_and_are_null_in_json(tmp_path, capsys):
    description = tmp_path / "thrown.toml"
    description.write_text(
        "tilt = [0.05, 0.0]\ntilt_rate = [0.0, 0.03]\nduration = 5.0\n"
        'column = { shape = "dimensionless", slenderness = 0.1 }\nmodel = { kind = "slender", damping = 0.1 }\n'
        'motion = { kind = "oblique", acceleration = 1.6, angular_frequency = 3.0, angle = 1.2 }\n'
    )
    assert run(["hierarchy", str(description)]) == 0
    (slender,) = [line for line in capsys.readouterr().out.splitlines() if line.startswith("│ slender  ")]
    assert slender.count("unbounded") == 2
    printed = {}
    for command in ("hierarchy", "simulate"):
        assert run([command, str(description), "--json"]) == 0
        printed[command] = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)  # Infinity is no JSON
    assert printed["hierarchy"]["peak_friction_demand"][0] is None
    assert printed["simulate"]["measures"]["peak_friction_demand"] is None


def test_a_file_of_simulate_serves_the_ladder(tmp_path, capsys):
    description = tmp_path / "run.toml"
    description.write_text(
        'duration = 5.0\ntilt = [0.04, 0.0]\n[column]\nshape = "dimensionless"\nslenderness = 0.1\n'
        '[model]\nkind = "rolling"\ndamping = 0.1\nspin_damping = 0.2\nrolling_resistance = 0.0\n'
        '[hierarchy]\nslenderness = [0.1, 0.2]\nreference = "slender rolling"\n'
    )
    assert run(["hierarchy", str(description), "--json"]) == 0
    printed = told(capsys)
    assert printed["slenderness"] == [0.1, 0.2]
    assert printed["attributes"]["reference"] == "slender rolling"
    assert run(["simulate", str(description), "--json"]) == 0
    assert told(capsys)["provenance"]["model"]["spin_damping"] == 0.2


@pytest.mark.parametrize(
    ("options", "model"),
    [
        (["--model", "slender"], sb.Slender),
        (["--model", "slender-rolling", "--spin-damping", "0.2"], sb.SlenderRolling),
        (["--model", "wobbling", "--constraint", "rubber", "--rolling-resistance", "0.01"], sb.Wobbling),
        (["--model", "rolling", "--restitution", "0.9", "--passage-tilt", "0.002"], sb.Rolling),
        (["--model", "wobbling", "--constraint", "pure-tilt"], sb.Wobbling),
    ],
)
def test_models_and_their_frictions_are_options(options, model, capsys):
    assert run(["simulate", *CASE, *options, "--json"]) == 0
    described = told(capsys)["provenance"]["model"]
    assert described.pop("kind") == model.name.replace(" ", "_")
    given = dict(zip(options[::2], options[1::2], strict=True))
    for option, value in given.items():
        if option != "--model":
            kept = described[option.removeprefix("--").replace("-", "_")]
            assert str(kept).replace("_", "-") == value


def test_planar_rocking_and_its_restitution(capsys):
    case = [*COLUMN, *LINE, "--tilt", "0.03", "0", "--duration", "5", "--model", "planar-rocking", "--json"]
    assert run(["simulate", *case]) == 0
    assert "restitution" not in told(capsys)["provenance"]["model"]
    assert run(["simulate", *case, "--restitution", "0.8"]) == 0
    assert told(capsys)["provenance"]["model"]["restitution"] == 0.8


def test_the_restitution_of_impacts_of_a_sliding_column_has_a_name_of_its_own(capsys):
    case = [*COLUMN, "--tilt", "0.03", "0", "--duration", "1", "--model", "sliding", "--json"]
    assert run(["simulate", *case, "--normal-restitution", "0.3"]) == 0
    assert told(capsys)["provenance"]["model"]["normal_restitution"] == 0.3
    assert run(["simulate", *case, "--restitution", "0.3"]) == 2
    assert "--restitution: model 'sliding' does not use it (got " in capsys.readouterr().err


def test_a_run_begins_with_spin_twist_and_position(capsys):
    options = ["--model", "rolling", "--spin", "0.2", "--twist", "0.3", "--position", "0.01", "0.02"]
    assert run(["simulate", *CASE, *options, "--json"]) == 0
    provenance = told(capsys)["provenance"]
    assert (provenance["spin"], provenance["twist"], provenance["position"]) == (0.2, 0.3, [0.01, 0.02])


def test_demands_and_warnings_are_printed(capsys):
    options = ["--model", "rolling", "--spin-damping", "0.1", "--friction-coefficient", "0.02"]
    assert run(["simulate", *CASE, *options]) == 0
    table = capsys.readouterr().out
    assert all(text in table for text in ("required friction coefficient", "minimum normal force", "it would slip"))
    assert run(["simulate", *CASE, *options, "--json"]) == 0
    printed = told(capsys)
    assert printed["warnings"][0].startswith("it would slip")
    assert printed["measures"]["peak_friction_demand"] > 0.02


def test_another_model_keeps_what_it_knows_of_the_file(tmp_path, capsys):
    saved = tmp_path / "run.nc"
    options = ["--model", "rolling", "--spin-damping", "0.1", "--output", str(saved), "--json"]
    assert run(["simulate", *CASE, *options]) == 0
    capsys.readouterr()
    assert run(["simulate", str(saved), "--model", "slender", "--json"]) == 0
    assert told(capsys)["provenance"]["model"] == {"kind": "slender", "damping": 0.1}


def test_maps_take_models(capsys):
    axes = ["--x", "angular-frequency", "2", "3", "2", "--y", "acceleration", "0.05", "0.2", "2"]
    model = ["--model", "slender-rolling", "--tilt", "0.01", "0", "--spin", "0.2"]
    assert run(["map", *COLUMN, *MOTION[:2], *axes, *model, "--duration", "5", "--json"]) == 0
    provenance = told(capsys)["provenance"]
    assert (provenance["model"]["kind"], provenance["spin"]) == ("slender_rolling", 0.2)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["simulate", *CASE, "--spin-damping", "0.1"], "--spin-damping: model 'wobbling' does not use it (got "),
        (
            ["simulate", *CASE, "--model", "slender", "--constraint", "rubber"],
            "--constraint: model 'slender' does not use it (got ",
        ),
        (
            ["map", *CASE, "--normal-restitution", "0", "--x", "size", "1", "2", "2", "--y", "damping", "0", "1", "2"],
            "--normal-restitution: model 'wobbling' does not use it (got ",
        ),
        (
            ["basin", *CASE, "--model", "slender-rolling", "--restitution", "1", *SAMPLE],
            "--restitution: model 'slender-rolling' does not use it (got ",
        ),
        (
            ["response", *COLUMN, *MOTION[:4], "--rolling-resistance", "1", "--angular-frequency-range", "1", "2"],
            "--rolling-resistance: model 'slender' does not use it (got ",
        ),
        (
            ["response", *COLUMN, *MOTION[:4], "--model", "rolling", "--angular-frequency-range", "1", "2"],
            "got rolling. Use theory.full_rolling for its steady rolling, or orbits.continue_branch for its orbits",
        ),
        (
            ["boundary", *COLUMN, *LINE[:4], *RANGES, "--model", "planar-rocking"],
            "no steady rolling of this planar rocking model under horizontal motion; give orbits.periodic_orbit a run",
        ),
        (["simulate", *CASE, "--model", "tumbling"], "model.kind must be one of 'slender', 'slender_rolling'"),
        (["simulate", *CASE, "--model", "wobbling", "--constraint", "x"], "input should be 'pure_tilt' or 'rubber'"),
        (["simulate", *CASE, "--spin", "1"], "spin must be left out: the column of model wobbling cannot turn"),
        (["simulate", *CASE, "--model", "slender", "--twist", "1"], "twist must be left out"),
        (["simulate", *CASE, "--model", "planar-rocking"], "must lie in one vertical plane"),
        (["simulate", *CASE, "--friction-coefficient", "0"], "friction_coefficient must be positive, got 0.0"),
        (["hierarchy", *CASE, "--reference", "sliding"], "reference must be a model of this case"),
        (["hierarchy", *CASE, "--scaled-to", "-1"], "--scaled-to must be followed by a positive slenderness, got -1.0"),
        (
            ["hierarchy", *CASE, "--tilt", "1.2", "0", "--scaled-to", ".2"],
            "becomes (2.4, 0) rad at slenderness",
        ),
        (["hierarchy", *CASE, "--model", "rolling"], "--model: hierarchy runs all models (got 'rolling'). Remove it."),
        (["hierarchy", *COLUMN], "duration is missing"),
        (["hierarchy", *CASE, "--passage-tilt", "1"], "No such option"),
    ],
)
def test_what_a_model_does_not_know_is_one_line(arguments, line, capsys):
    assert run(arguments) == 2
    printed = capsys.readouterr().err.strip().splitlines()
    assert len(printed) == 1
    assert line in printed[0]


def test_a_friction_that_levels_do_not_share_is_refused(tmp_path, capsys):
    description = tmp_path / "run.toml"
    description.write_text(
        'duration = 5.0\n[column]\nshape = "dimensionless"\nslenderness = 0.1\n'
        '[model]\nkind = "rolling"\npassage_tilt = 0.001\n'
    )
    assert run(["hierarchy", str(description)]) == 2
    assert (
        "model.passage_tilt: the models of the hierarchy share damping, spin_damping, rolling_resistance, restitution "
        "only (got 0.001). Remove it." in capsys.readouterr().err
    )


def test_a_number_of_a_model_of_ones_own_is_refused_as_one_that_levels_do_not_share(tmp_path, capsys):
    (tmp_path / "mine.py").write_text(
        "from dataclasses import dataclass\nfrom typing import Annotated\nimport stylobate as sb\n\n\n"
        "@dataclass(frozen=True, slots=True)\nclass Dragged(sb.Slender):\n"
        '    """A slender column with drag."""\n\n'
        '    drag: Annotated[float, sb.Quantity(text="drag", ge=0.0, dissipates=True)] = 0.0\n'
    )
    description = tmp_path / "run.toml"
    description.write_text(
        'duration = 5.0\n[column]\nshape = "dimensionless"\nslenderness = 0.1\n'
        '[model]\nkind = "mine.py:Dragged"\ndamping = 0.1\ndrag = 0.2\n'
    )
    assert run(["hierarchy", str(description)]) == 2
    message = capsys.readouterr().err
    assert "model.drag: the models of the hierarchy share damping, " in message
    assert "(got 0.2). Remove it." in message


def test_a_slenderness_in_a_file_is_named(tmp_path, capsys):
    description = tmp_path / "run.toml"
    description.write_text(
        'duration = 5.0\n[column]\nshape = "dimensionless"\nslenderness = 0.1\n[hierarchy]\nslenderness = [0.1, -1.0]\n'
    )
    assert run(["hierarchy", str(description)]) == 2
    assert capsys.readouterr().err == "stylobate: hierarchy: slenderness must be positive, got -1.0\n"
