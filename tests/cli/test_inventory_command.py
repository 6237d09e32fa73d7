"""`stylobate inventory`: a table in, a ranking out; studies with sites, interruption, saved results, refusals."""

import csv
import json
import signal

import numpy as np
import pytest

import stylobate as sb
from stylobate.cli.main import run
from stylobate.earthquakes.inventories import runs as runs_of_inventory

OBJECTS = """name,radius [mm],radius_spread [mm],height [m],density,damping,friction_coefficient,site,room
slim,80,4,1.2,2400,0.05,0.6,hill,1
stout,200,,0.8,2400,housner,0.6,hill,2
far,80,4,1.2,2400,0.05,0.6,plain,3
slippery,80,,0.5,2400,0.05,0.1,plain,4
"""
STUDY = """
objects = "objects.csv"
samples = 4
scales = [0.5, 1.0, 2.0]
tail = 3.0

[sites.hill]
records = {source = "quakes", units = "g", step = 0.02}
hazard = {intensity = [0.05, 0.2, 0.8], rate = [1e-2, 1e-3, 1e-5], units = "g", measure = "PGA", component = "RotD50"}

[sites.plain]
records = {source = "quakes/weak*.txt", units = "g", step = 0.02}
"""
READ = ("--records", "quakes", "--units", "g", "--step", "0.02")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "quakes").mkdir()
    time = 0.02 * np.arange(201)
    for place, peak in enumerate((0.35, 0.25, 0.02)):
        along = peak * np.sin(np.pi * time * (1.0 + 0.2 * place)) * np.sin(np.pi * time / 4.0)
        name = "weak" if peak < 0.1 else f"strong{place}"
        for component, share in (("NS", along), ("EW", 0.3 * along[::-1])):
            np.savetxt(tmp_path / "quakes" / f"{name}_{component}.txt", share)
    (tmp_path / "objects.csv").write_text(OBJECTS, encoding="utf-8")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    plain = OBJECTS.replace("site,", "").replace("hill,", "").replace("plain,", "")
    (tmp_path / "plain.csv").write_text(plain, encoding="utf-8")
    return tmp_path


def ranking(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_a_table_becomes_a_ranking_with_figure_and_numbers(folder, capsys):
    assert run(["inventory", "plain.csv", *READ, "--property-samples", "3", "--output", "more.csv"]) == 0
    shown = capsys.readouterr().out
    assert "columns carried through: room" in shown
    made = folder / "plain-inventory"
    assert {path.name for path in made.iterdir()} >= {"ranking.csv", "inventory.nc", "ranking.png", "store"}
    rows = ranking(made / "ranking.csv")
    assert [row["rank"] for row in rows] == ["1", "1", "3", ""]  # two overturn in every run
    assert rows[-1]["note"] == "withheld; slides before it rocks in 67 % of runs: µ = 0.1, r/h = 0.32"
    assert {row["name"]: row["room"] for row in rows} == {"slim": "1", "stout": "2", "far": "3", "slippery": "4"}
    assert (folder / "more.csv").read_bytes() == (made / "ranking.csv").read_bytes()
    found = sb.load(made / "inventory.nc")
    assert [float(row["probability of overturning"] or "nan") for row in rows] == pytest.approx(
        found["probability"].sel(limit_state="overturning", scale=1.0).to_numpy().tolist(), nan_ok=True
    )


def test_a_study_with_sites_counts_annual_rates_where_a_hazard_is_known(folder, capsys):
    assert run(["inventory", "study.toml", "--folder", "out", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["ranked_by"] == "probability"  # one site has no hazard curve
    by_name = {one["name"]: one for one in answer["objects"]}
    assert by_name["slim"]["annual rate of overturning [1/a]"] > 0.0
    assert by_name["far"]["annual rate of overturning [1/a]"] == ""
    assert by_name["far"]["probability of overturning at scale 1"] == 0.0
    assert by_name["slim"]["runs"] == 3 * 4 * 3
    assert by_name["far"]["runs"] == 1 * 4 * 3


def test_options_override_the_study_and_records_of_the_command_line_need_a_study_without_sites(folder, capsys):
    (folder / "one.toml").write_text('objects = "plain.csv"\nsamples = 50\nrecords = "none"\n', encoding="utf-8")
    assert run(["inventory", "one.toml", *READ, "--property-samples", "2", "--seed", "3", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["provenance"]["inventory"]["samples"] == 2
    assert answer["provenance"]["inventory"]["seed"] == 3
    assert run(["inventory", "study.toml", *READ]) == 2
    assert "records and sites: only one of them is allowed" in capsys.readouterr().err


def test_a_saved_inventory_is_shown_again_and_computes_nothing(folder, capsys, monkeypatch):
    assert run(["inventory", "plain.csv", *READ, "--property-samples", "2"]) == 0
    first = capsys.readouterr().out
    monkeypatch.setattr(sb.earthquakes, "inventory", None)
    saved = "plain-inventory/inventory.nc"
    assert run(["inventory", saved, "--figure", "again.png", "--output", "again.csv"]) == 0
    assert capsys.readouterr().out == first.partition("ranking: ")[0]
    assert (folder / "again.csv").read_bytes() == (folder / "plain-inventory" / "ranking.csv").read_bytes()
    assert run(["inventory", saved, "--seed", "4"]) == 2
    assert "--seed: inventory does not use it to show" in capsys.readouterr().err


def test_after_ctrl_c_the_same_command_continues(folder, capsys, monkeypatch):
    command = ["inventory", "plain.csv", *READ, "--property-samples", "2"]
    monkeypatch.setattr(runs_of_inventory, "_BLOCK", 1)
    whole = [*command, "--folder", "whole"]
    assert run(whole) == 0
    computed = []
    once = runs_of_inventory._Work.__call__

    def stopped(self, task, **how):
        computed.append(task.block.index)
        if len(computed) == 3:
            signal.raise_signal(signal.SIGINT)
        return once(self, task, **how)

    monkeypatch.setattr(runs_of_inventory._Work, "__call__", stopped)
    capsys.readouterr()
    assert run(command) == 130
    assert "computed objects are kept in plain-inventory/store; the same command continues" in capsys.readouterr().err
    assert run(command) == 0
    assert len(computed) == 5  # the third block again, and the last
    for name in ("ranking.csv", "inventory.nc"):
        assert (folder / "plain-inventory" / name).read_bytes() == (folder / "whole" / name).read_bytes()


@pytest.mark.parametrize(
    ("command", "line"),
    [
        (["none.csv", *READ], "cannot read none.csv: No such file or directory"),
        (["plain.csv"], "records: missing. Name a folder"),
        (["plain.csv", *READ, "--output", "ranking.pdf"], "--output: must end with .csv, .xlsx, .gpkg"),
        (["objects.csv", *READ, "--limit-state", "tilt"], "limit_state: unknown (got 'tilt')"),
        (["quakes/weak_NS.txt", *READ], "weak_NS.txt: the column name is missing"),
    ],
)
def test_mistakes_have_one_line_each(folder, capsys, command, line):
    assert run(["inventory", *command]) == 2
    errors = capsys.readouterr().err
    assert line in errors
    assert "Traceback" not in errors


def test_each_bad_row_has_a_line(folder, capsys):
    text = OBJECTS.replace("80,4,1.2", "x,4,1.2").replace("housner,0.6", "housner,-0.6")
    (folder / "objects.csv").write_text(text, encoding="utf-8")
    assert run(["inventory", "study.toml"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [line.partition("objects.csv, ")[2].partition(":")[0] for line in lines] == [
        "rows 2, 4, radius [mm]",
        "row 3, friction_coefficient",
    ]
