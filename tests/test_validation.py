"""The comparisons that need neither data nor other programs, and what the tables and objects are made of."""

import math
import shutil
from html import escape

import numpy as np
import pytest
from validation import document, frozen, objects, problems
from validation.finding import FOLDER, Finding, Kind, table
from validation.objects import MeasuredObject

import stylobate as sb


@pytest.mark.slow
def test_runs_have_the_closed_forms_of_verification_problems():
    found = list(problems.findings())
    assert len(found) == 9
    assert not [one for one in found if not one.agrees]


def test_a_published_first_overturning_amplitude_is_found_again():
    finding = next(frozen.findings())
    assert finding.agrees, finding


def test_a_difference_beyond_the_bound_is_no_agreement():
    near = Finding("someone", "a number", 1.0, 1.0 + 5e-7, Kind.MATHEMATICS)
    far = Finding("someone", "a number", 1.0, 1.0 + 5e-6, Kind.MATHEMATICS)
    measured = Finding("someone", "a number", 1.0, 2.0, Kind.EXPERIMENT)
    assert [one.verdict for one in (near, far, measured)] == [
        "mathematics, 1e-06: agrees",
        "mathematics, 1e-06: **differs**",
        "experiment",
    ]


def test_the_document_has_each_row_of_the_tables_and_counts_the_classes(tmp_path):
    rows = [
        Finding("someone", "a number", 1.0, 1.0, Kind.MATHEMATICS),
        Finding("someone", "another number", 1.0, 2.0, Kind.CODE),
        Finding("someone", "a measured number", 1.0, 2.0, Kind.EXPERIMENT, remark="by its statistics"),
    ]
    (tmp_path / "problems.txt").write_text(table(rows[:1]), encoding="utf-8")
    (tmp_path / "engines.txt").write_text(table(rows[1:]), encoding="utf-8")
    written = document.write(tmp_path / "report.html", tmp_path).read_text("utf-8")
    for one in rows:
        assert one.compared in written
    assert written.count(document._TITLES["engines"]) == 1
    assert document._sources(tmp_path).rows == [["someone", "engines, problems"]]
    assert "<td>commit</td>" in written
    counts = document._summary(tmp_path).rows
    assert counts == [["code", "0", "1", "0"], ["experiment", "0", "0", "1"], ["mathematics", "1", "0", "0"]]


def test_the_document_has_all_tables_of_the_page(tmp_path):
    written = document.write(tmp_path / "report.html", FOLDER, ["problems"]).read_text("utf-8")
    for path in FOLDER.glob("*.txt"):
        assert path.stem in document._TITLES
        if "**differs**" in path.read_text("utf-8"):
            assert path.stem in document._REASONS
        last = path.read_text("utf-8").splitlines()[-1].split("|")[2].strip()
        assert escape(last)[:40] in written, path.stem
        assert path.stem == "problems" or path.stem in written.partition("Intended use")[0]


@pytest.mark.parametrize("one", objects.objects(), ids=lambda one: one.folder.name)
def test_each_object_states_numbers_that_its_model_can_vary(one):
    assert 0.5 < one.same_outcome <= 1.0
    assert 0.0 < one.tolerance < 0.1
    assert (one.folder / "page.md").read_text("utf-8").startswith(f"## {one.title[0].upper()}{one.title[1:]}\n")
    rest = sb.Pulse.one_sine(acceleration=1e-3, angular_frequency=6.0)
    blow = sb.Pulse.one_sine(acceleration=80.0, angular_frequency=3.0)
    low, high = one.probabilities([rest, blow])
    assert low == pytest.approx(0.5 * one.lapse)
    assert high == pytest.approx(1.0 - 0.5 * one.lapse)


@pytest.fixture
def own(tmp_path):
    """A folder as a user would make it: a block whose tests were simulated with another seed."""
    (tmp_path / "object.toml").write_text(
        """
title = "block of our own"
source = "ourselves"
tests = "tests.csv"
lapse = 0.02
same_outcome = 1.0
tolerance = 0.1

[column]
shape = "solid"
radius = 0.2
height = 2.4
density = 2700.0

[model]
kind = "wobbling"
damping = 0.05

[numbers]
slenderness = {mean = 0.1667, spread = 0.004, range = [0.15, 0.18]}
""",
        encoding="utf-8",
    )
    model = sb.Wobbling(sb.Column.solid(radius=0.2, height=2.4, density=2700.0), damping=0.05)
    rows = ["motion,overturned"]
    times = np.arange(0.0, 1.2, 0.01)
    for number, acceleration in enumerate((1.0, 2.0, 3.0, 5.0, 6.0, 8.0)):
        path = tmp_path / f"pulse_{number}.csv"
        values = acceleration * np.sin(2.0 * math.pi * times) * (times < 1.0)
        record = sb.Record(samples=np.column_stack([values, 0 * values, 0 * values]), step=0.01)
        sb.records.write_csv(record, path)
        fell = sb.simulate(model, record, duration=record.duration + 2.0).outcome is sb.Outcome.OVERTURNED
        rows.append(f"{path.name},{int(fell)}")
    (tmp_path / "tests.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return tmp_path


def test_a_folder_of_a_user_is_an_acceptance_test(own):
    finding = MeasuredObject.read(own).finding()
    assert finding.agrees
    wrong = (own / "tests.csv").read_text("utf-8")
    swapped = wrong.replace(",0", ",x").replace(",1", ",0").replace(",x", ",1")
    (own / "tests.csv").write_text(swapped, encoding="utf-8")
    assert not MeasuredObject.read(own).finding().agrees


def test_objects_whose_data_are_not_at_hand_are_left_out(own, monkeypatch, capsys):
    monkeypatch.delenv("STYLOBATE_SHAKE_TABLE", raising=False)
    away = own / "away"
    away.mkdir()
    shutil.copy(objects.FOLDER / "granite_1" / "object.toml", away / "object.toml")
    assert MeasuredObject.read(away).finding() is None
    assert "git" in capsys.readouterr().out
