"""`stylobate records` lists what `read_records` joins, with the numbers of `intensity_measures`."""

import csv
import json

import numpy as np
import pytest

import stylobate as sb
from stylobate.cli.main import run
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.records import intensity_measures, intensity_table

READING = ["--units", "g", "--step", "0.01"]


@pytest.fixture
def quakes(tmp_path):
    folder = tmp_path / "quakes"
    folder.mkdir()
    rng = np.random.default_rng(5)
    for name in ("TAB-L1", "TAB-T1", "TAB-UP", "left", "right", "alone_NS"):
        np.savetxt(folder / f"{name}.txt", rng.normal(scale=0.1, size=300))
    return folder


def test_it_lists_each_component_with_its_file_and_its_measures(quakes, tmp_path, capsys):
    table, drawn = tmp_path / "table.csv", tmp_path / "records.png"
    files = ["--output", str(table), "--figure", str(drawn)]
    assert run(["records", f"{quakes}/TAB*", f"{quakes}/alone*", *READING, *files, "--json"]) == 0
    told = capsys.readouterr()
    (line,) = told.err.splitlines()
    assert line.startswith("stylobate: warning: alone: one horizontal component (alone_NS.txt)")
    listed = json.loads(told.out)
    expected = sb.read_records([f"{quakes}/TAB*", f"{quakes}/alone*"], "g", step=0.01, one_component=True)
    assert [one["name"] for one in listed["records"]] == ["TAB", "alone"] == [record.name for record in expected]
    for one, record in zip(listed["records"], expected, strict=True):
        measures = intensity_measures(record)
        assert [row["axis"] for row in one["components"]] == list(record.axes)
        for row, left in zip(one["components"], record.residual_velocity, strict=False):
            of_axis = measures.sel(axis=row["axis"])
            for name in ("pga", "pgv", "pgd", "arias", "duration_5_95"):
                assert row[name] == float(of_axis[name])
            assert row["pga_g"] == row["pga"] / STANDARD_GRAVITY
            assert row["residual_velocity"] == left
            assert (row["samples"], row["step"]) == (300, 0.01)
    assert [row["origin"].partition("from ")[2].split()[0] for row in listed["records"][0]["components"]] == [
        "TAB-L1.txt",
        "TAB-T1.txt",
        "TAB-UP.txt",
    ]
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(row["record"], row["axis"]) for row in rows] == [("TAB", "x"), ("TAB", "y"), ("TAB", "z"), ("alone", "x")]
    assert [float(row["PGA [g]"]) for row in rows[:3]] == [one["pga_g"] for one in listed["records"][0]["components"]]
    assert drawn.read_bytes().startswith(b"\x89PNG")


def test_it_lists_the_measures_of_the_horizontal_motion(quakes, tmp_path, capsys):
    openpyxl = pytest.importorskip("openpyxl")
    table, book = tmp_path / "table.csv", tmp_path / "book.xlsx"
    for output in (table, book):
        arguments = ["records", f"{quakes}/TAB*", *READING, "--period", "0.5", "--output", str(output), "--json"]
        assert run(arguments) == 0
    _, listed = capsys.readouterr().out.split("}\n{")
    (one,) = json.loads("{" + listed)["records"]
    (record,) = sb.read_records(f"{quakes}/TAB*", "g", step=0.01)
    median, largest = (intensity_table(record, period=0.5, component=component) for component in ("RotD50", "RotD100"))
    for name in ("pga", "pgv", "sa"):
        assert one["horizontal"][f"{name}_rotd50"] == pytest.approx(float(median[name][0]), rel=1e-12)
        assert one["horizontal"][f"{name}_rotd100"] == pytest.approx(float(largest[name][0]), rel=1e-12)
    for name in ("cav", "arias", "duration_5_95", "fiv3"):
        assert one["horizontal"][name] == pytest.approx(float(median[name][0]), rel=1e-12)
    with (tmp_path / "table-horizontal.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert float(row["Sa(0.5 s) RotD50 [g]"]) == pytest.approx(float(median["sa"][0]) / STANDARD_GRAVITY)
    sheets = openpyxl.load_workbook(book)
    assert sheets.sheetnames == ["components", "horizontal"]
    header, values = sheets["horizontal"].iter_rows(values_only=True)
    assert header == tuple(row)
    assert values[1:] == pytest.approx([float(row[name]) for name in header[1:]])
    assert sheets["components"].max_row == 4  # three components below the header


def test_it_lists_the_records_of_a_study_with_its_listed_events(quakes, capsys):
    study = quakes.parent / "study.toml"
    study.write_text(
        '[records]\nsource = ["quakes/TAB*.txt"]\nunits = "g"\nstep = 0.01\n[[records.event]]\n'
        'files = ["quakes/left.txt", "quakes/right.txt"]\ndirections = ["N10E", 100]\nname = "mine"\n',
        encoding="utf-8",
    )
    assert run(["records", str(study)]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    assert "2 records" in told.out
    assert "mine: x at azimuth 10°, from left.txt; y at azimuth 280°, from right.txt (azimuth 100°)" in told.out
    assert "of PGV. Correct the baseline" in told.out


def test_components_that_were_trimmed_are_noted(quakes, capsys):
    np.savetxt(quakes / "TAB-T1.txt", np.zeros(200) + 0.1)
    assert run(["records", f"{quakes}/TAB*", *READING]) == 0
    assert "TAB: trimmed to 200 samples: TAB-L1.txt 300, TAB-T1.txt 200" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "records: none were given"),
        (["quakes/*.none"], "quakes/*.none: no file has such a name"),
        (["quakes", "--output", "table.nc"], "--output must end with .csv or .xlsx, got 'table.nc'"),
        (["quakes", "--figure", "drawn.txt"], "--figure must end with"),
        (["a.toml", "quakes"], "SOURCE: a study must stand alone (got a.toml, quakes)"),
        (["empty.toml"], "the study has no records"),
    ],
)
def test_bad_questions_are_one_line(arguments, line, quakes, monkeypatch, capsys):
    monkeypatch.chdir(quakes.parent)
    (quakes.parent / "empty.toml").write_text("")
    assert run(["records", *arguments]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert line in told
