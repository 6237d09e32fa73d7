"""Columns of an assessment from a table of objects: the same as if a study stated them."""

import pytest

import stylobate as sb
from stylobate.earthquakes.config.assess import AssessConfig
from stylobate.errors import ConfigError

TABLE = """\
name;diameter [mm];height [cm];density;damping;friction_coefficient;room
amphora;125;55;2100;housner;0,6;12
urn;300;64;2000;0,2;0,5;15
"""
RECORDS = {"samples": ["el centro 1940"]}


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "objects.csv"
    path.write_text(TABLE, encoding="utf-8")
    return path


def test_a_table_is_the_study_that_states_its_columns(table):
    bodies = {
        "amphora": sb.Column.solid(radius=0.0625, height=0.55, density=2100.0),
        "urn": sb.Column.solid(radius=0.15, height=0.64, density=2000.0),
    }
    setup = AssessConfig.parse({"columns": str(table), "records": RECORDS}).build()
    assert {name: model.column for name, model in setup.columns.items()} == bodies
    assert setup.options["friction_coefficient"] == {"amphora": 0.6, "urn": 0.5}
    dampings = {
        name: [levels[level]["damping"] for level in ("low", "central", "high")]
        for name, levels in setup.options["dissipation"].items()
    }
    central = bodies["amphora"].housner_damping()
    assert dampings == {"amphora": pytest.approx([0.5 * central, central, 2.0 * central]), "urn": [0.1, 0.2, 0.4]}


def test_what_the_study_states_stands_above_the_table(table):
    dissipation = {level: {"damping": 0.05} for level in ("low", "central", "high")}
    stated = {"dissipation": dissipation, "friction_coefficient": 0.3, "sliding": False, "title": "Room 12"}
    setup = AssessConfig.parse({"columns": str(table), "records": RECORDS, **stated}).build()
    assert {name: setup.options[name] for name in stated} == stated
    table.write_text(
        TABLE.replace(";damping;friction_coefficient", "").replace(";housner;0,6", "").replace(";0,2;0,5", "")
    )
    bare = AssessConfig.parse({"columns": str(table), "records": RECORDS, **stated}).build()
    assert bare.columns == setup.columns


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("300;64", "300;x", r"objects.csv, row 3, height \[cm\]: must be a number"),
        (
            ";room\n",
            ";site\n",
            r"columns: the objects stand at several sites \(got 12, 15\). Assess each site by a table",
        ),
        ("300;64", "300;-64", r"objects.csv, row 3, height \[cm\]: height must be positive"),
        (";damping;", ";dampin;", "unknown column; did you mean damping"),
    ],
)
def test_a_mistake_in_the_table_is_one_line(table, old, new, line):
    table.write_text(TABLE.replace(old, new), encoding="utf-8")
    with pytest.raises(ConfigError, match=line):
        AssessConfig.parse({"columns": str(table), "records": RECORDS})


def test_the_path_of_the_table_is_relative_to_the_study(table):
    study = table.with_name("study.toml")
    study.write_text('columns = "objects.csv"\nrecords = {samples = ["el centro 1940"]}\n', encoding="utf-8")
    assert sb.config.read_config(study)["columns"] == str(table)
