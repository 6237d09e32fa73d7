"""Studies of columns under records in a file: what they say, what is missing, and the example of the package."""

from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.config import read_config
from stylobate.earthquakes.config.assess import AssessConfig, DesignSpectrumConfig
from stylobate.errors import ConfigError, FileError, UnlikelyInputWarning

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
    setup = AssessConfig.parse({**STUDY, "margin": margin, "scales": [1.0, 2.0], "contact_laws": False}).build()
    assert isinstance(setup.columns["tank"], sb.Wobbling)
    assert setup.columns["tank"].column == sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
    assert setup.records == {"el centro 1940": sb.sample_record("el centro 1940")}
    np.testing.assert_allclose(setup.options["margin_scales"], [0.5, 1.0, 2.0])
    assert setup.options["dissipation"] == DISSIPATION
    assert setup.options["contact_laws"] is False
    usual = AssessConfig.parse(STUDY).build().options
    assert (usual["margin_scales"][0], usual["margin_scales"][-1], usual["margin_scales"].size) == (0.2, 5.0, 300)
    assert (usual["contact_laws"], usual["variations"], usual["seed"]) == (True, 200, 0)
    assert (usual["rest_energy"], usual["sliding"]) == (None, False)
    more = {"variations": 0, "seed": 3, "rest_energy": 1e-6, "sliding": True}
    asked = AssessConfig.parse({**STUDY, **more}).build().options
    assert {name: asked[name] for name in more} == more


def test_the_levels_of_a_column_are_its_own_or_those_of_all():
    own = {level: {"damping": eta} for level, eta in (("low", 0.1), ("central", "housner"), ("high", 0.9))}
    columns = {"tank": COLUMN, "tub": {**COLUMN, "radius": 0.4}}
    setup = AssessConfig.parse({**STUDY, "columns": columns, "dissipation": {**DISSIPATION, "tub": own}}).build()
    assert setup.options["dissipation"] == {**DISSIPATION, "tub": own}


@pytest.mark.parametrize(
    ("change", "messages"),
    [
        ({"dissipation": None}, ["dissipation is missing: it decides the outcome"]),
        ({"friction_coefficient": None}, ["friction_coefficient is missing: the friction between"]),
        (
            {"dissipation": None, "columns": {"tank": {**COLUMN, "hight": 1}}},
            ["columns.tank.hight is not known here", "dissipation is missing"],
        ),
        (
            {"dissipation": {**DISSIPATION, "low": {"damping": "x"}}},
            ["dissipation.low.damping: must be a number or 'housner', got 'x'"],
        ),
        (
            {"dissipation": {"tank": {**DISSIPATION, "low": {"damping": []}}}},
            ["dissipation.tank.low.damping: must be a number or 'housner', got []"],
        ),
        ({"columns": {"tank": {**COLUMN, "radius": "x"}}}, ["columns.tank.radius:"]),
        ({"columns": {"tank": {"radius": 1.0}}}, ["columns.tank.height is missing"]),
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
def test_what_is_missing_or_unknown_is_one_line_each(change, messages):
    values = {name: value for name, value in {**STUDY, **change}.items() if value is not None}
    with pytest.raises(ConfigError) as caught:
        AssessConfig.parse(values)
    assert len(caught.value.problems) == len(messages)
    assert all(line.startswith(start) for line, start in zip(caught.value.problems, messages, strict=True))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"columns": {}}, "columns must hold at least one"),
        ({"columns": {"tank": {**COLUMN, "radius": -1.0}}}, "columns.tank: radius must be positive"),
        ({"model": {"damping": 0.1}}, "model.damping: `dissipation` sets it"),
        ({"width": 0.0}, "width must be positive"),
        ({"rest_energy": -1.0}, "rest_energy must be zero or positive, got -1.0"),
        ({"variations": -1}, "variations must be a whole number of at least 0, got -1"),
        ({"variations": 1}, "variations: must be 0 or at least 2 (got 1). Pass a few hundred, or 0 for none."),
        ({"seed": -1}, "seed must be a whole number of at least 0, got -1"),
        ({"margin": {"from": -1.0}}, "margin: from must be positive"),
        ({"margin": {"from": 5.0, "to": 3.0}}, "margin.from must be less than margin.to, got 5 and 3"),
        ({"margin": {"number": 1}}, "margin.number must be 2 or more, got 1"),
        ({"model": {"kind": "sliding", "friction_coefficient": 0.5}}, "model.kind: must assume permanent contact"),
        (
            {"dissipation": {**DISSIPATION, "low": {"damping": 0.5}}},
            "dissipation: damping of 'tank' must not fall from low to central to high, got low 0.5, central 0.05, high",
        ),
        (
            {"dissipation": {**DISSIPATION, "high": {"damping": "housner"}, "central": {"damping": 0.2}}},
            "dissipation: damping of 'tank' must not fall from low to central to high, got low 0.01, central 0.2, high",
        ),
        ({"dissipation": {"low": {"damping": 0.1}}}, "dissipation: central and high must be stated too. State it for"),
        (
            {"dissipation": {"tank": {"low": {"damping": 0.1}}}},
            "dissipation: central and high must be stated too for 'tank'",
        ),
        ({"dissipation": {"tanc": DISSIPATION}}, "dissipation: 'tanc' is no column; did you mean tank?"),
        (
            {"dissipation": {"tank": {**DISSIPATION, "low": {"dampign": 0.1}}}},
            "dissipation.tank.low.dampign is not known here; did you mean damping?",
        ),
        (
            {"dissipation": {level: {"restitution": "housner" if level == "low" else 0.9} for level in DISSIPATION}},
            "dissipation.low.restitution must be a real number",
        ),
        (
            {"dissipation": {level: {"restitution": 0.5} for level in DISSIPATION}, "model": {"kind": "slender"}},
            "dissipation: the model slender has no restitution; leave it out",
        ),
        (
            {"dissipation": {**DISSIPATION, "low": {"restitution": 0.5}}},
            "dissipation must state the same parameters at each level, one or more, got low restitution",
        ),
        ({"records": {"samples": ["kobe"]}}, "name must be one of 'el centro 1940'"),
        ({"records": "nowhere/*.AT2"}, "nowhere/*.AT2: no file has such a name"),
    ],
)
def test_each_part_that_cannot_be_built_has_a_message(change, message):
    with pytest.raises(ConfigError) as caught:
        AssessConfig.parse({**STUDY, **change}).build()
    assert len(caught.value.problems) == 1
    assert caught.value.problems[0].startswith(message)


def test_all_that_cannot_be_built_is_told_at_once():
    wrong = {
        "scales": [-1.0],
        "margin": {"from": -1.0},
        "friction_coefficient": {"tanc": 0.6},
        "tail": -2.0,
        "dissipation": {**DISSIPATION, "low": {"dampign": 0.1}},
        "records": "nowhere/*.AT2",
    }
    with pytest.raises(ConfigError) as caught:
        AssessConfig.parse({**STUDY, **wrong}).build()
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
    text = '[records]\nsource = "quakes/*.txt"\nunits = "g"\nstep = 0.02\none_component = true\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    (tmp_path / "short.toml").write_text('records = ["quakes/a_NS.txt"]\n', encoding="utf-8")
    monkeypatch.chdir("/")
    values = read_config(tmp_path / "study.toml")
    (record,) = AssessConfig.parse({**STUDY, **values}).build().records.values()
    assert record == sb.read_record(tmp_path / "quakes" / "a_NS.txt", "g", step=0.02)
    assert read_config(tmp_path / "short.toml") == {"records": [str(tmp_path / "quakes" / "a_NS.txt")]}


def test_the_report_notes_that_a_component_is_alone(tmp_path):
    np.savetxt(tmp_path / "a_NS.txt", [0.0, 0.1, 0.0])
    records = {"source": str(tmp_path), "units": "g", "step": 0.02}
    with pytest.warns(UnlikelyInputWarning, match="a: one horizontal component"):
        setup = AssessConfig.parse({**STUDY, "records": records, "notes": ["mine"]}).build()
    mine, remark = setup.options["notes"]
    assert mine == "mine"
    assert remark.startswith("Warning: a: one horizontal component (a_NS.txt)")


def test_the_example_runs_in_a_small_version():
    values = read_config(EXAMPLE)
    trimmed = [
        {"method": "trimmed", "begin": 1.0, "end": 3.0},
        {"method": "scaled", "factor": 1.0, "vertical": 0.0},
    ]
    small = {
        "model": {"kind": "slender"},
        "records": {**values["records"], "processing": trimmed},
        "margin": {"from": 0.5, "to": 2.0, "number": 3},
        "variations": 0,
        **dict.fromkeys(("contact_laws", "planar", "contact"), False),
        "tail": 1.0,
    }
    assert AssessConfig.parse(values).build().records.keys() == {"el centro 1940"}
    setup = AssessConfig.parse({**values, **small}).build()
    found = sb.earthquakes.assess(setup.columns, setup.records, **setup.options)
    assert found.data["verdicts"]["overturned"].sizes == {
        "column": 2,
        "record": 1,
        "dissipation": 3,
        "vertical": 1,
        "scale": 2,
    }
    assert found.setting["title"] == values["title"]


SPECTRUM = {"units": "g", "points": [[0.0, 0.3], [0.5, 0.75], [2.0, 0.19]], "name": "site", "damping": 0.05}


def test_details_of_the_report_are_passed_on():
    more = {"author": "N. Author", "project": "7", "date": "2026-05-14", "spectral_period": 0.5}
    about = {"el centro 1940": "M 6.9"}
    given = {**STUDY, **more, "about_records": about, "design_spectrum": SPECTRUM}
    details = AssessConfig.parse(given).build().options["details"]
    assert (details.author, details.project, details.date) == ("N. Author", "7", "2026-05-14")
    assert (details.spectral_period, details.about_records) == (0.5, about)
    assert details.design_spectrum.period == (0.0, 0.5, 2.0)
    assert details.design_spectrum.acceleration == tuple(value * 9.80665 for value in (0.3, 0.75, 0.19))
    assert details.design_spectrum.name == "site"


def test_a_design_spectrum_is_read_from_a_file_beside_the_study(tmp_path):
    lines = "# of the site\nperiod [s], Sa [cm/s²]\n0.0, 250\n0.5; 600\n2.0 150\n"
    (tmp_path / "spectrum.csv").write_text(lines, encoding="utf-8")
    (tmp_path / "study.toml").write_text('[design_spectrum]\nfile = "spectrum.csv"\n', encoding="utf-8")
    read = read_config(tmp_path / "study.toml")
    details = AssessConfig.parse({**STUDY, **read}).build().options["details"]
    assert details.design_spectrum.period == (0.0, 0.5, 2.0)
    np.testing.assert_allclose(details.design_spectrum.acceleration, [2.5, 6.0, 1.5], rtol=1e-15)


def _spectrum(tmp_path, content):
    (tmp_path / "spectrum.csv").write_text(content, encoding="utf-8")
    return DesignSpectrumConfig.parse({"file": str(tmp_path / "spectrum.csv"), "units": "m/s²"}).build()


@pytest.mark.parametrize(
    "content",
    ["0;0,2\n0,5;0,75\n", "T [s]; Sa [m/s²]\n0;0,2\n0,5;0,75\n", "T (s)\tSa (m/s²)\n0\t0.2\n0.5\t0.75\n"],
)
def test_a_design_spectrum_may_have_decimal_commas(tmp_path, content):
    found = _spectrum(tmp_path, content)
    assert (found.period, found.acceleration) == ((0.0, 0.5), (0.2, 0.75))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("T [ms], Sa [m/s²]\n0,0.2\n500,0.75\n", r"line 1: the first column must be the period in s \(got \[ms\]\)"),
        ("f [Hz]; Sa\n1;0.2\n5;0.75\n", r"line 1: the first column must be the period in s \(got \[Hz\]\)"),
        ("0;0,2\n0.5;0.75\n", r"line 1: .* Write decimal points"),
    ],
)
def test_a_design_spectrum_in_another_unit_or_with_unclear_commas_is_refused(tmp_path, content, message):
    with pytest.raises(FileError, match=message):
        _spectrum(tmp_path, content)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"design_spectrum": {}}, "design_spectrum: give either points or file."),
        ({"design_spectrum": {**SPECTRUM, "units": None}}, "design_spectrum.units: the unit of the accelerations is"),
        ({"design_spectrum": {**SPECTRUM, "units": "furlong"}}, "design_spectrum.units: unknown unit (got 'furlong')."),
        ({"design_spectrum": {**SPECTRUM, "points": [[0.0, 1.0]]}}, "design_spectrum: at least two points are needed"),
        (
            {"design_spectrum": {**SPECTRUM, "points": [[0.5, 1.0], [0.5, 2.0]]}},
            "design_spectrum: periods must increase (got 0.5 s after 0.5 s).",
        ),
        (
            {"design_spectrum": {**SPECTRUM, "points": [[0.0, -1.0], [0.5, 2.0]]}},
            "design_spectrum: acceleration must be zero or positive",
        ),
        ({"design_spectrum": {"file": "nowhere.csv"}}, "nowhere.csv: cannot be read"),
        ({"spectral_period": 0.0}, "spectral_period must be positive, got 0.0 s"),
        ({"about_records": {"el centro 1949": "M 7"}}, "about_records: 'el centro 1949' is no record; did you mean"),
    ],
)
def test_details_that_cannot_be_are_one_line_each(change, line):
    with pytest.raises(ConfigError) as caught:
        AssessConfig.parse({**STUDY, **change}).build()
    assert len(caught.value.problems) == 1
    assert caught.value.problems[0].startswith(line)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("period [s], Sa [g]\n0.0, 0.3, 1\n", "line 2: two numbers are needed, period [s] and spectral acceleration"),
        ("period [s], Sa [g]\n0.0, x\n", "line 2: not a number: 'x'"),
        ("period [s], Sa [m/s²]\n0.0, 3\n1.0, 2\n", "'g' contradicts 'm/s²'"),
    ],
)
def test_what_is_wrong_in_a_file_of_a_design_spectrum_is_one_line(text, line, tmp_path):
    path = tmp_path / "spectrum.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError) as caught:
        AssessConfig.parse({**STUDY, "design_spectrum": {"file": str(path), "units": "g"}}).build()
    (problem,) = caught.value.problems
    assert line in problem
