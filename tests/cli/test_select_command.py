"""`stylobate select` chooses records by a target spectrum, and writes them as the records of a study."""

import csv
import json

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions import Record
from stylobate.cli.main import run
from stylobate.config import RecordsConfig, read_config
from stylobate.records import write_csv


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(3)
    (tmp_path / "quakes").mkdir()
    for place in range(4):
        noise = Record(samples=rng.normal(size=(800, 2)), step=0.01, name="quake").filtered(lowpass=5.0 + place)
        write_csv(noise, tmp_path / "quakes" / f"quake {place}.csv")
    (tmp_path / "design.csv").write_text("period [s], Sa [g]\n0.05,0.4\n0.15,0.9\n0.5,0.9\n2.5,0.2\n")
    return tmp_path


CHOICE = ["select", "quakes", "--target", "design.csv", "--number", "2"]


def test_the_chosen_records_are_a_study(folder, capsys):
    files = ["--output", "study.toml", "--figure", "match.png"]
    assert run([*CHOICE, *files, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    chosen = [one for one in told["records"] if one["chosen"]]
    assert len(chosen) == 2 < len(told["records"])
    assert 0.0 < told["least_ratio"] < told["largest_ratio"]
    assert 'files = ["quakes/quake ' in (folder / "study.toml").read_text()
    records = RecordsConfig.parse(read_config(folder / "study.toml")["records"]).build()
    for one in chosen:
        own = sb.read_record(folder / "quakes" / f"{one['record']}.csv").scaled(one["factor"])
        np.testing.assert_array_equal(records[one["record"]].samples, own.samples)
    assert (folder / "match.png").read_bytes().startswith(b"\x89PNG")


def test_the_table_has_all_candidates_with_their_spectra(folder, capsys):
    assert run([*CHOICE, "--output", "table.csv", "--periods", "0.3", "1.5", "--factors", "0.9", "1.1"]) == 0
    told = capsys.readouterr().out
    assert "2 records of 4 chosen" in told
    assert "mean of the chosen spectra over the target" in told
    with (folder / "table.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4
    assert {row["chosen"] for row in rows} == {"True", "False"}
    assert all(0.9 <= float(row["factor"]) <= 1.1 for row in rows)
    assert "Sa(0.3 s) [g]" in rows[0]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["select", "quakes"], "--target: missing. Name a file of two columns: period [s], Sa [g]"),
        ([*CHOICE, "--output", "a.nc"], "--output must end with .toml, .csv or .xlsx, got 'a.nc'"),
        ([*CHOICE[:-1], "5"], "number must be at most 4, the number of candidates, got 5"),
        ([*CHOICE, "--without", "quake"], "without: no record has this name (got 'quake')"),
        (
            ["select", "--sample-records", "el centro 1940", *CHOICE[2:4], "--number", "1", "--output", "a.toml"],
            "--output: 'el centro 1940' comes with the package and has no files",
        ),
    ],
)
@pytest.mark.usefixtures("folder")
def test_mistakes_are_one_line(arguments, line, capsys):
    assert run(arguments) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert line in told
