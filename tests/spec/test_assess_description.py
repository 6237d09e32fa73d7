"""Studies of columns under records in a file: what they say, what is missing, and the example of the package."""

from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import DescriptionError
from stylobate.spec import AssessDescription, read_description

COLUMN = {"shape": "solid", "radius": 0.2, "height": 2.0, "density": 2700.0}
DISSIPATION = {level: {"damping": eta} for level, eta in (("low", 0.01), ("central", 0.05), ("high", 0.1))}
STUDY = {
    "columns": {"tank": COLUMN},
    "dissipation": DISSIPATION,
    "friction_coefficient": 0.6,
    "records": {"samples": ["el centro 1940"]},
}
EXAMPLE = Path(__file__).parents[2] / "examples" / "assess" / "study.toml"


def test_a_study_describes_the_arguments_of_assess():
    margin = {"from": 0.5, "to": 2.0, "number": 3}
    setup = AssessDescription.parse({**STUDY, "margin": margin, "scales": [1.0, 2.0], "robustness": False}).build()
    assert isinstance(setup.columns["tank"], sb.Wobbling)
    assert setup.columns["tank"].column == sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
    assert setup.records == {"el centro 1940": sb.sample_record("el centro 1940")}
    np.testing.assert_allclose(setup.options["margin_scales"], [0.5, 1.0, 2.0])
    assert setup.options["dissipation"] == DISSIPATION
    assert setup.options["changes"] == ()
    usual = AssessDescription.parse(STUDY).build().options
    assert (usual["margin_scales"][0], usual["margin_scales"].size) == (0.2, 60)
    assert "changes" not in usual


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"dissipation": None}, ["dissipation is missing: how fast a column in space loses energy"]),
        ({"friction_coefficient": None}, ["friction_coefficient is missing: the friction between"]),
        (
            {"dissipation": None, "columns": {"tank": {**COLUMN, "hight": 1}}},
            ["columns.tank.hight is not known here", "dissipation is missing"],
        ),
        ({"dissipation": {"low": {"damping": 0.1}}}, ["dissipation: central and high must be stated too"]),
        ({"columns": {"tank": {**COLUMN, "radius": "x"}}}, ["columns.tank.radius:"]),
        ({"columns": {"tank": {"radius": 1.0}}}, ["columns.tank.shape is missing"]),
        ({"records": {"source": "x", "unit": "g"}}, ["records.unit is not known here"]),
        ({"columns": None}, ["columns is missing"]),
        (
            {"mragin": {}, "scale": [1.0]},
            ["mragin is not known here; did you mean margin?", "scale is not known here; did"],
        ),
        (
            {"columns": {"tank": {**COLUMN, "hieght": 1}}},
            ["columns.tank.hieght is not known here; did you mean height?"],
        ),
        ({"friction_coefficient": {"tank": "x"}}, ["friction_coefficient.tank: input should be a valid number"]),
    ],
)
def test_what_is_missing_or_unknown_is_one_line_each(change, told):
    values = {name: value for name, value in {**STUDY, **change}.items() if value is not None}
    with pytest.raises(DescriptionError) as caught:
        AssessDescription.parse(values)
    assert len(caught.value.problems) == len(told)
    assert all(line.startswith(start) for line, start in zip(caught.value.problems, told, strict=True))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"columns": {}}, "columns must hold at least one"),
        ({"columns": {"tank": {**COLUMN, "radius": -1.0}}}, "columns.tank: radius must be positive"),
        ({"model": {"damping": 0.1}}, "model.damping is told by dissipation"),
        ({"width": 0.0}, "width must be positive"),
        ({"margin": {"from": -1.0}}, "margin: from must be positive"),
        ({"margin": {"from": 5.0, "to": 3.0}}, "margin.from must be less than margin.to, got 5 and 3"),
        ({"margin": {"number": 1}}, "margin.number must be 2 or more, got 1"),
        ({"model": {"kind": "sliding", "friction_coefficient": 0.5}}, "model.kind must be one that holds the contact"),
        (
            {"dissipation": {**DISSIPATION, "low": {"damping": 0.5}}},
            "dissipation: damping must not fall from low to central to high, got low 0.5, central 0.05, high 0.1",
        ),
        (
            {"dissipation": {level: {"restitution": 0.5} for level in DISSIPATION}, "model": {"kind": "slender"}},
            "dissipation: the model slender has no restitution; leave it out",
        ),
        (
            {"dissipation": {**DISSIPATION, "low": {"restitution": 0.5}}},
            "dissipation must name the same numbers at each level, one or more, got low restitution, central damping",
        ),
        ({"records": {"samples": ["kobe"]}}, "name must be one of 'el centro 1940'"),
        ({"records": "nowhere/*.AT2"}, "nowhere/*.AT2: no file has such a name"),
    ],
)
def test_what_cannot_be_built_is_told(change, told):
    with pytest.raises(DescriptionError) as caught:
        AssessDescription.parse({**STUDY, **change}).build()
    assert len(caught.value.problems) == 1
    assert caught.value.problems[0].startswith(told)


def test_all_that_cannot_be_built_is_told_at_once():
    wrong = {
        "scales": [-1.0],
        "margin": {"from": -1.0},
        "friction_coefficient": {"tanc": 0.6},
        "tail": -2.0,
        "dissipation": {**DISSIPATION, "low": {"dampign": 0.1}},
        "records": "nowhere/*.AT2",
    }
    with pytest.raises(DescriptionError) as caught:
        AssessDescription.parse({**STUDY, **wrong}).build()
    assert set(caught.value.problems) == {
        "margin: from must be positive, got -1.0",
        "dissipation.low.dampign is not known here; did you mean damping?",
        "tail must be zero or positive, got -2.0 s",
        "scales must be positive, got -1.0",
        "friction_coefficient: 'tanc' is no column; did you mean tank?",
        "friction_coefficient: 'tank' has none; state one for each column",
        "nowhere/*.AT2: no file has such a name",
    }


def test_files_of_records_are_told_from_the_folder_of_the_study(tmp_path, monkeypatch):
    (tmp_path / "quakes").mkdir()
    np.savetxt(tmp_path / "quakes" / "a_NS.txt", [0.0, 0.1, 0.0])
    text = '[records]\nsource = "quakes/*.txt"\nunits = "g"\nstep = 0.02\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    (tmp_path / "short.toml").write_text('records = ["quakes/a_NS.txt"]\n', encoding="utf-8")
    monkeypatch.chdir("/")
    values = read_description(tmp_path / "study.toml")
    (record,) = AssessDescription.parse({**STUDY, **values}).build().records.values()
    assert record == sb.read_record(tmp_path / "quakes" / "a_NS.txt", "g", step=0.02)
    assert read_description(tmp_path / "short.toml") == {"records": [str(tmp_path / "quakes" / "a_NS.txt")]}


def test_the_example_runs_in_a_small_version():
    values = read_description(EXAMPLE)
    trimmed = [
        {"method": "trimmed", "begin": 1.0, "end": 3.0},
        {"method": "scaled", "factor": 1.0, "vertical": 0.0},
    ]
    small = {
        "model": {"kind": "slender"},
        "records": {**values["records"], "processing": trimmed},
        "margin": {"from": 0.5, "to": 2.0, "number": 3},
        **dict.fromkeys(("robustness", "planar", "contact"), False),
        "tail": 1.0,
    }
    assert AssessDescription.parse(values).build().records.keys() == {"el centro 1940"}
    setup = AssessDescription.parse({**values, **small}).build()
    found = sb.studies.assess(setup.columns, setup.records, **setup.options)
    assert found.data["verdicts"]["overturned"].sizes == {
        "column": 2,
        "record": 1,
        "dissipation": 3,
        "vertical": 1,
        "scale": 2,
    }
    assert found.setting["title"] == values["title"]
