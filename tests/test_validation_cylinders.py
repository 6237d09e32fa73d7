"""The study of published cylinders on a small set of the same form: outcomes of single runs, and motions in files."""

import math
import shutil
import warnings

import numpy as np
import pytest
from scipy.io import savemat
from validation import cylinders

import stylobate as sb
from stylobate.errors import UnlikelyInputWarning
from stylobate.records import write_at2, write_csv

SIZES, ANGLES = (1.0, 3.0, 60.0), tuple(k * math.pi / 200.0 for k in (4, 12, 21, 22, 30))


def pulses(period, across):
    """Return a motion along both axes whose peak is that of the first published motion."""
    times = np.arange(0.0, 2.0 * period, 0.01)
    x = np.sin(2.0 * np.pi * times / period)
    y = across * np.sin(np.pi * times / period)
    return sb.Record(samples=np.stack([x, y], axis=1), step=0.01).scaled_to(cylinders.FIRST_PEAK)


RECORDS = {1: pulses(1.0, 0.3), 7: pulses(1.6, -0.8).scaled_to(1.5)}


def published(record):
    """Return the table of a motion, from single runs of columns described one by one."""
    rows = []
    for size in SIZES:
        for angle in ANGLES:
            column = sb.Column.solid(
                radius=size * math.sin(angle), height=2.0 * size * math.cos(angle), density=1000.0, gravity=9.81
            )
            run = sb.simulate(sb.Wobbling(column), record, duration=record.duration + 10.0)
            tilt = angle if run.outcome is sb.Outcome.OVERTURNED else run.measures["peak_tilt"]
            rows.append([size, angle, tilt, tilt / angle])
    return np.array(rows)


@pytest.fixture(scope="module")
def tables():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnlikelyInputWarning)  # the largest cylinders of the published grid are larger
        return {number: published(record) for number, record in RECORDS.items()}


@pytest.fixture
def folders(tables, tmp_path, monkeypatch):
    """The folder of the published tables and that of the motions, one of each kind."""
    clone, moved = tmp_path / "clone", tmp_path / "motions"
    (clone / "spectraOutput").mkdir(parents=True)
    for number, table in tables.items():
        savemat(clone / "spectraOutput" / f"{number}.mat", {"data": table})
    (moved / "7").mkdir(parents=True)
    write_csv(RECORDS[1], moved / "1.csv")
    for axis, azimuth in (("x", "090"), ("y", "000")):
        write_at2(RECORDS[7], moved / "7" / f"site_{azimuth}.AT2", axis=axis)
    monkeypatch.setenv(cylinders.PUBLISHED, str(clone))
    monkeypatch.setenv(cylinders.MOTIONS, str(moved))
    return clone, moved


def rewritten(clone, number, change):
    """Change the table of a motion."""
    path = clone / "spectraOutput" / f"{number}.mat"
    table = cylinders.loadmat(path)["data"]
    change(table)
    savemat(path, {"data": table})


@pytest.mark.long
def test_the_small_set_has_cylinders_that_stand_uplift_and_overturn(tables):
    ratios = np.concatenate([table[:, 3] for table in tables.values()])
    assert min((ratios == 0.0).sum(), ((ratios > 0.0) & (ratios < 1.0)).sum(), (ratios == 1.0).sum()) >= 3


def test_the_same_cylinders_and_motions_have_the_same_outcomes(folders):
    found = list(cylinders.findings())
    assert [one.agrees for one in found] == [True] * len(found)
    undamped = [one for one in found if "no damping" in one.compared]
    assert [(one.theirs, one.ours) for one in undamped] == [(30, 30)] * 3


def test_the_peak_tilts_of_the_ensemble_are_those_of_the_single_runs(tables):
    grid = cylinders.Tilts(np.array(SIZES), np.array(ANGLES), tables[1][:, 3].reshape(3, 5))
    ours = cylinders.simulate(grid, RECORDS[1], damped=False)
    standing = ~grid.overturned & (grid.peak > 1e-3)  # smaller ones pass the vertical too often to be repeated
    assert standing.any()
    np.testing.assert_allclose(ours.peak[standing], grid.peak[standing], rtol=1e-5)


def test_exchanged_motions_are_found_out(folders):
    _, moved = folders
    write_csv(RECORDS[7], moved / "1.csv")
    shutil.rmtree(moved / "7")
    write_csv(RECORDS[1], moved / "7.csv")
    found = list(cylinders.findings())
    (peak,) = (one for one in found if "cease to uplift" in one.compared)
    assert (peak.ours, peak.remark) == (0, "not those of 1, 7")
    assert not any(one.agrees for one in found if "same answer: uplift" in one.compared)


def test_cylinders_of_another_size_are_found_out(folders):
    clone, _ = folders

    def larger(table):
        table[:, 0] *= 4.0

    rewritten(clone, 1, larger)
    overturning = [one for one in cylinders.findings() if "overturning, no damping" in one.compared]
    assert not overturning[0].agrees
    assert "motion 1" in overturning[0].remark


def test_without_the_motions_the_laws_of_the_published_tables_remain(folders, monkeypatch, capsys):
    monkeypatch.delenv(cylinders.MOTIONS)
    found = list(cylinders.findings())
    assert [one.agrees for one in found] == [True] * 2
    assert "of 30 published runs" in found[0].remark
    assert "simulations left out" in capsys.readouterr().out


def test_an_uplift_that_depends_on_the_size_breaks_the_law(folders, monkeypatch):
    clone, _ = folders
    monkeypatch.delenv(cylinders.MOTIONS)

    def stands(table):
        table[5, 2:] = 0.0

    rewritten(clone, 7, stands)
    law = next(cylinders.findings())
    assert (law.theirs, law.ours, law.agrees) == (30, 29, False)


def test_an_uplift_beyond_the_published_peak_acceleration_is_found_out(folders, monkeypatch):
    clone, _ = folders
    monkeypatch.delenv(cylinders.MOTIONS)

    def uplifts(table):
        table[3::5, 2:] = 1e-3 * np.array([table[3, 1], 1.0])

    rewritten(clone, 1, uplifts)
    peak = list(cylinders.findings())[1]
    assert peak.ours == pytest.approx(9.81 * math.tan(ANGLES[3]))
    assert not peak.agrees


def test_without_any_data_the_frequency_parameter_remains(monkeypatch, capsys):
    monkeypatch.delenv(cylinders.PUBLISHED, raising=False)
    assert list(cylinders.findings()) == []
    assert cylinders.frequency_parameter().agrees
    assert "outcomes left out" in capsys.readouterr().out


def test_a_table_whose_columns_are_exchanged_is_refused(folders):
    clone, _ = folders

    def exchanged(table):
        table[:, 2:] = table[:, [3, 2]]

    rewritten(clone, 7, exchanged)
    with pytest.raises(ValueError, match=r"7\.mat: no table of R, α"):
        list(cylinders.findings())
