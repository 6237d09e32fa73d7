"""Components of one event become one record."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import FileError, ParameterError, UnlikelyInputWarning
from stylobate.records import Lengths, Steps

STEP = 0.01
COUNT = 200


def table(folder, name, values, step=STEP):
    path = folder / name
    path.write_text("".join(f"{step * i:.5f} {float(value)!r}\n" for i, value in enumerate(values)))
    return path


def at2(folder, name, values, component, step=STEP):
    header = ["PEER", f"Quake, 1/2/1990, Site, {component}", "ACCELERATION IN UNITS OF G"]
    lines = [*header, f"NPTS= {len(values)}, DT= {step} SEC", *map(repr, map(float, values))]
    (folder / name).write_text("\n".join(lines))
    return folder / name


@pytest.fixture
def waves():
    return np.random.default_rng(7).normal(scale=0.2, size=(3, COUNT))


def test_peer_names_make_one_event(tmp_path, waves):
    for name, values, component in zip(("000", "090", "-UP"), waves, ("0", "90", "UP"), strict=True):
        at2(tmp_path, f"RSN1_QUAKE_AB{name}.AT2", values, component)
    (record,) = sb.read_records(tmp_path)
    assert record.name == "RSN1_QUAKE_AB"
    north, east, up = waves * 9.80665
    # x north, y west, z up: right-handed
    np.testing.assert_allclose(record.samples, np.stack([north, -east, up], axis=-1), rtol=1e-14)


def test_a_component_that_points_down_is_turned(tmp_path, waves):
    table(tmp_path, "a_NS.txt", waves[0])
    table(tmp_path, "a_DWN.txt", waves[2])
    (record,) = sb.read_records(tmp_path, "m/s2", one_component=True)
    np.testing.assert_array_equal(record.samples[:, 2], -waves[2])


@pytest.mark.parametrize(
    ("first", "second"), [(0.0, 90.0), (90.0, 360.0), (35.0, 125.0), (10.0, 100.0), (20.0, 80.0), (230.0, 320.0)]
)
def test_components_at_any_azimuths_restore_the_motion_of_the_ground(tmp_path, waves, first, second):
    north, east = waves[:2]
    for name, azimuth in (("a.txt", first), ("b.txt", second)):
        angle = math.radians(azimuth)
        table(tmp_path, name, north * math.cos(angle) + east * math.sin(angle))
    names = {"a.txt": first, "b.txt": second}
    # the same event, whatever the names: a folder of its own for each pair
    for name in names:
        (tmp_path / name).rename(tmp_path / f"site_{'NS' if name == 'a.txt' else 'EW'}.txt")
    given = {"site_NS.txt": first, "site_EW.txt": second}
    (record,) = sb.read_records(tmp_path, "m/s2", directions=given)
    x = math.radians(min(first % 360.0, second % 360.0))
    y = x - math.pi / 2.0
    for axis, angle in ((0, x), (1, y)):
        expected = north * math.cos(angle) + east * math.sin(angle)
        np.testing.assert_allclose(record.samples[:, axis], expected, rtol=0.0, atol=1e-13)


def test_a_folder_of_several_events_gives_them_by_name(tmp_path, waves):
    for event in ("b", "a"):
        for name, values in zip(("NS", "EW"), waves[:2], strict=True):
            table(tmp_path, f"{event}_{name}.dat", values)
    table(tmp_path, "alone.dat", waves[2])
    (tmp_path / ".hidden").write_text("no record")
    with pytest.warns(
        UnlikelyInputWarning, match=r"alone: one horizontal component \(alone\.dat\)\. List the files of the event"
    ):
        records = sb.read_records(tmp_path, "g")
    assert [record.name for record in records] == ["a", "alone", "b"]
    assert [record.axes for record in records] == [("x", "y"), ("x",), ("x", "y")]


def test_lengths_that_differ_are_trimmed_or_padded_with_a_note(tmp_path, waves):
    paths = [table(tmp_path, "a_NS.txt", waves[0]), table(tmp_path, "a_EW.txt", waves[1][:-5])]
    with pytest.warns(UnlikelyInputWarning, match="a_NS.txt is trimmed"):
        (short,) = sb.read_records(paths, "m/s2")
    (long,) = sb.read_records(paths, "m/s2", lengths=Lengths.PAD)
    assert (len(short.samples), len(long.samples)) == (COUNT - 5, COUNT)
    assert not long.samples[-5:, 1].any()
    assert "trimmed to 195 samples: a_NS.txt 200, a_EW.txt 195" in short.provenance
    assert "padded with zeros to 200 samples: a_NS.txt 200, a_EW.txt 195" in long.provenance


def test_a_component_that_points_nowhere_is_asked_for_its_direction_in_words(tmp_path, waves):
    paths = [table(tmp_path, "a.txt", waves[0]), table(tmp_path, "a_EW.txt", waves[1])]
    with pytest.raises(FileError, match=r"a\.txt: its direction is unknown\. State directions, its azimuth"):
        sb.read_records(paths, "g")
    (record,) = sb.read_records(paths, "g", directions={"a.txt": 0.0})
    assert record.axes == ("x", "y")


def test_steps_that_differ_are_refused_or_resampled_to_the_finest(tmp_path, waves):
    paths = [table(tmp_path, "a_NS.txt", waves[0]), table(tmp_path, "a_EW.txt", waves[1], step=0.02)]
    with pytest.raises(
        FileError, match=r"a: time steps differ \(a_NS.txt 0.01 s, a_EW.txt 0.02 s\); state steps to be res"
    ):
        sb.read_records(paths, "g")
    with pytest.warns(UnlikelyInputWarning, match="a_EW.txt is trimmed"):
        (record,) = sb.read_records(paths, "g", steps=Steps.RESAMPLE)
    assert record.step == 0.01
    assert any("resampled from 0.02 s to 0.01 s" in line for line in record.provenance)


def test_what_cannot_be_put_together_is_told(tmp_path, waves):
    pair = [table(tmp_path, "a_NS.txt", waves[0]), table(tmp_path, "a_000.txt", waves[1])]
    with pytest.raises(
        FileError, match=r"a: horizontal components must be perpendicular, .* got a_.*\.txt \(.*, a_.*\.txt"
    ):
        sb.read_records(pair, "g")
    three = [*pair, table(tmp_path, "a_EW.txt", waves[2])]
    with pytest.raises(FileError, match=r"a: two horizontal components and a vertical one at most"):
        sb.read_records(three, "g")
    with pytest.raises(ParameterError, match=r"directions must name files that are read, got c\.txt"):
        sb.read_records(pair, "g", directions={"c.txt": 0.0})
    with pytest.raises(ParameterError, match=r"a direction must be an azimuth in degrees or \"up\", got 'sideways'"):
        sb.read_records(pair, "g", directions={"a_NS.txt": "sideways"})
    with pytest.raises(FileError, match="no files were given"):
        sb.read_records(tmp_path.glob("*.none"))
    (tmp_path / "empty").mkdir()
    with pytest.raises(FileError, match="the folder has no files"):
        sb.read_records(tmp_path / "empty", "g")


def test_components_that_begin_at_different_times_are_refused(tmp_path, waves):
    first = table(tmp_path, "a_NS.txt", waves[0])
    second = tmp_path / "a_EW.txt"
    second.write_text("".join(f"{1.0 + STEP * i:.5f} {value!r}\n" for i, value in enumerate(waves[1].tolist())))
    with pytest.raises(FileError, match="components begin at different times"):
        sb.read_records([first, second], "g")
