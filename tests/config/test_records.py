"""Descriptions of records: what they build, what a saved result remembers, and what they refuse."""

import json
import pickle

import numpy as np
import pytest

import stylobate as sb
from stylobate.config import (
    RecordMotion,
    RecordsConfig,
    SimulationConfig,
    config_of,
    read_config,
    study_config,
)
from stylobate.config.parts import describe_motion
from stylobate.errors import ConfigError, FileError, ParameterError, UnlikelyInputWarning, UnsupportedError
from stylobate.provenance import provenance_of_run

MODEL = sb.Slender(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.05)
COLUMN = '[column]\nshape = "solid"\nradius = 0.3\nheight = 3.0\ndensity = 2700.0\n'

PROCESSING = {
    "trimmed": ({"begin": 0.5, "end": 2.0}, lambda r: r.trimmed(0.5, 2.0)),
    "resampled": ({"step": 0.005}, lambda r: r.resampled(0.005)),
    "filtered": ({"highpass": 0.5, "order": 2}, lambda r: r.filtered(highpass=0.5, order=2)),
    "baseline_corrected": ({"degree": 2}, lambda r: r.baseline_corrected(2)),
    "inverted": ({}, lambda r: r.inverted()),
    "rotated": ({"angle": 0.3}, lambda r: r.rotated(0.3)),
    "delayed": ({"delay": 0.25}, lambda r: r.delayed(0.25)),
    "padded": ({"before": 0.1}, lambda r: r.padded(before=0.1)),
    "with_tail": ({"length": 1.0}, lambda r: r.with_tail(1.0)),
    "scaled": ({"factor": 1.5, "vertical": 0.0}, lambda r: r.scaled(1.5, vertical=0.0)),
    "scaled_to": ({"peak": 3.0}, lambda r: r.scaled_to(3.0)),
}


@pytest.fixture
def quakes(tmp_path):
    """Two events of two components and one of three, in g, 0.01 s apart."""
    folder = tmp_path / "quakes"
    folder.mkdir()
    rng = np.random.default_rng(1)
    for name in ("first_NS", "first_EW", "first_UP", "second_NS", "second_EW"):
        np.savetxt(folder / f"{name}.txt", rng.normal(scale=0.1, size=250))
    return folder


def described(text, folder):
    path = folder / "run.toml"
    path.write_text(text, encoding="utf-8")
    return SimulationConfig.parse(read_config(path))


def test_a_record_described_is_the_record_read_in_python_wherever_the_program_runs(quakes, tmp_path):
    setup = described(
        f'duration = 3.0\n{COLUMN}[motion]\nkind = "record"\nunits = "g"\nstep = 0.01\nscale = 2.0\nrotation = 0.3\n'
        'tail = 0.5\npath = ["quakes/first_NS.txt", "quakes/first_EW.txt", "quakes/first_UP.txt"]\n'
        'processing = [{method = "filtered", highpass = 0.2, lowpass = 20.0}]\n',
        tmp_path,
    ).build()
    (read,) = sb.read_records(quakes.glob("first*"), "g", step=0.01)
    expected = read.filtered(highpass=0.2, lowpass=20.0).scaled(2.0).rotated(0.3).with_tail(0.5)
    assert setup.motion == expected
    assert setup.motion.provenance == expected.provenance
    assert setup.motion.name == expected.name


def test_a_single_file_is_read_as_read_record_reads_it(quakes):
    path = quakes / "second_EW.txt"
    found = RecordMotion(path=str(path), units="cm/s2", step=0.02, axis="y").build()
    assert found == sb.read_record(path, "cm/s2", step=0.02, axis="y")
    assert RecordMotion(sample="el centro 1940").build() == sb.sample_record("el centro 1940")


@pytest.mark.parametrize("method", PROCESSING)
def test_every_method_can_be_described_and_what_was_done_in_python_is_remembered(method, quakes):
    options, apply = PROCESSING[method]
    raw = RecordMotion(path=str(quakes / "second_NS.txt"), units="g", step=0.01, one_component=True)
    step = {"method": method, **options}
    in_file = RecordMotion.parse({**raw.values(), "processing": [step]}).build()
    in_python = apply(raw.build())
    expected = apply(sb.read_record(quakes / "second_NS.txt", "g", step=0.01))
    for found in (in_file, in_python, describe_motion(in_python).build(), pickle.loads(pickle.dumps(in_python))):  # noqa: S301  our own
        assert found == expected
        assert found.provenance == expected.provenance


@pytest.mark.slow
def test_a_saved_run_rebuilds_its_record_and_refuses_a_changed_file(quakes):
    path = quakes / "second_NS.txt"
    record = RecordMotion(path=str(path), units="g", step=0.01, scale=0.5, one_component=True).build().inverted()
    run = sb.simulate(MODEL, record, duration=1.0)
    stored = json.loads(json.dumps(dict(run.provenance)))
    assert config_of(stored).build().motion == record
    path.write_text(path.read_text() + "0.0\n")
    with pytest.raises(ConfigError, match="has changed since the result was saved: its SHA-256 was"):
        config_of(stored).build()
    path.unlink()
    with pytest.raises(FileError, match=r"cannot read .*second_NS\.txt"):
        config_of(stored).build()


def test_several_records_are_one_motion_of_a_saved_result(quakes):
    records = RecordsConfig(source=str(quakes), units="g", step=0.01).build()
    shaken = sb.OneOf(motions=tuple(records.values()), chosen=1).scaled(0.7)
    stored = json.loads(json.dumps(provenance_of_run(MODEL, shaken, duration=1.0)))
    assert config_of(stored).build().motion == shaken


def test_records_read_in_python_are_read_again_from_their_files(quakes):
    one = sb.read_record(quakes / "second_NS.txt", "g", step=0.01, axis="y").scaled(2.0, vertical=1.0)
    (several,) = sb.read_records(
        {"mine": [quakes / "second_NS.txt", quakes / "second_EW.txt"]},
        "g",
        step=0.01,
        directions={"second_NS.txt": 30.0, "second_EW.txt": 120.0},
    )
    for record in (one, several.filtered(highpass=0.2), sb.sample_record("el centro 1940 corrected").scaled(0.5)):
        stored = json.loads(json.dumps(provenance_of_run(MODEL, record, duration=1.0)))
        again = config_of(stored).build().motion
        assert (again, again.name, again.provenance) == (record, record.name, record.provenance)


def test_a_run_under_a_record_made_from_samples_cannot_be_repeated():
    record = sb.Record(samples=[0.0, 1.0, 0.0], step=0.01, name="triangle").scaled(2.0)
    stored = provenance_of_run(MODEL, record, duration=1.0)
    assert stored["motion"]["processing"] == ["scaled by 2.0"]
    assert stored["motion"]["digest"] == record.digest
    with pytest.raises(UnsupportedError, match=r"the record 'triangle', made from samples that are not kept\. Write"):
        config_of(stored)


def test_a_change_of_the_samples_themselves_forgets_the_files(quakes):
    record = sb.read_record(quakes / "second_NS.txt", "g", step=0.01)
    assert record.origin is not None
    assert record.changed("by hand", samples=record.samples * 2.0).origin is None


def test_without_a_duration_a_run_outlasts_its_record_by_twenty_time_scales(quakes):
    motion = {
        "kind": "record",
        "path": str(quakes / "second_NS.txt"),
        "units": "g",
        "step": 0.01,
        "one_component": True,
    }
    column = {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2700.0}
    expected = 2.49 + 20.0 / MODEL.column.frequency_parameter
    run = SimulationConfig.parse({"column": column, "motion": motion}).build()
    assert run.options["duration"] == pytest.approx(expected, rel=1e-14)
    plane = {"x": {"name": "scale", "values": [1.0]}, "y": {"name": "damping", "values": [0.1]}}
    late = {"kind": "delayed", "delay": 1.0, "motion": motion}
    over = study_config(sb.studies.overturning_map).parse({"column": column, "motion": late, "map": plane}).build()
    assert over.options["duration"] == pytest.approx(expected + 1.0, rel=1e-14)
    with pytest.raises(ConfigError, match="duration is missing"):
        SimulationConfig.parse({"column": column, "motion": {"kind": "rest"}})


def test_the_records_of_a_folder_are_those_that_read_records_finds(quakes):
    expected = sb.read_records(quakes, "g", step=0.01)
    for source in (str(quakes), str(quakes / "*.txt"), tuple(str(path) for path in quakes.iterdir())):
        found = RecordsConfig(source=source, units="g", step=0.01).build()
        assert list(found) == [record.name for record in expected] == ["first", "second"]
        assert tuple(found.values()) == expected
    turned = {"second_NS.txt": 30, "second_EW.txt": 120}
    (first, second) = RecordsConfig(source=str(quakes), units="g", step=0.01, directions=turned).build().values()
    assert (first, second) == sb.read_records(quakes, "g", step=0.01, directions=turned)
    sample = RecordsConfig(samples=("el centro 1940",), only=("el centro 1940",)).build()
    assert sample == {"el centro 1940": sb.sample_record("el centro 1940")}


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({}, r"either path \(one file, or the files of one event\) or sample must be given"),
        ({"path": "a", "sample": "el centro 1940"}, "either path .* or sample must be given"),
        ({"path": ["a", "b", "c", "d"]}, "path must name one to three files of one event, got 4"),
        ({"sample": "el centro 1940", "units": "g"}, "units does not belong to a sample"),
        (
            {"path": ["first_NS.txt", "second_NS.txt"], "units": "g", "step": 0.01},
            "must be perpendicular, or nearly so",
        ),
        ({"path": "first_NS.txt", "step": 0.01}, "the file names no unit: state units"),
        ({"path": "first_NS.txt", "units": "furlong", "step": 0.01}, "units must be"),
        ({"path": "first_NS.txt", "units": "g"}, "a single column has no time step"),
        ({"path": "none.txt"}, "cannot read"),
        ({"path": ["first_NS.txt", "first_EW.txt"], "axis": "x"}, "axis does not belong to files"),
    ],
)
def test_what_is_no_record_is_told_in_one_line(values, told, quakes):
    path = values.get("path", [])
    at = [str(quakes / name) for name in ([path] if isinstance(path, str) else path)]
    files = {"path": at[0] if isinstance(path, str) else at} if at else {}
    with pytest.raises((ParameterError, FileError), match=told) as caught:
        RecordMotion.parse({**values, **files}).build()
    assert "\n" not in str(caught.value)


def test_each_record_that_cannot_be_read_is_one_line(quakes):
    (quakes / "README").write_text("not a record")
    with (
        pytest.warns(UnlikelyInputWarning, match="quakes: 1 file holds no record and is left out: README"),
        pytest.raises(ConfigError) as caught,
    ):
        RecordsConfig(source=str(quakes), step=0.01).build()
    assert len(caught.value.problems) == 2
    with pytest.raises(ConfigError, match=r"no record has this name \(got 'third'\). Choose from first, second"):
        RecordsConfig(source=str(quakes / "*.txt"), units="g", step=0.01, only=("third",)).build()
    with pytest.raises(ConfigError, match="no file has such a name"):
        RecordsConfig(source=str(quakes / "*.AT2")).build()
    with pytest.raises(ConfigError, match="none were given"):
        RecordsConfig().build()


def test_mistakes_name_their_fields():
    with pytest.raises(ConfigError) as caught:
        SimulationConfig.parse(
            {
                "column": {"shape": "dimensionless", "slenderness": 0.1},
                "motion": {
                    "kind": "record",
                    "path": "a",
                    "unit": "g",
                    "processing": [{"method": "filtered", "low": 1}],
                },
            }
        )
    assert sorted(line.split(" ")[0] for line in caught.value.problems) == ["motion.processing.0.low", "motion.unit"]


def test_events_that_a_study_lists_are_those_that_read_records_is_given(quakes):
    np.savetxt(quakes / "left.txt", np.sin(np.arange(50.0)))
    np.savetxt(quakes / "right.txt", np.cos(np.arange(50.0)))
    files = [str(quakes / "left.txt"), str(quakes / "right.txt")]
    event = {"files": files, "directions": [0, "E"], "name": "mine"}
    source = str(quakes)  # the listed files are in it, and are not read twice
    description = RecordsConfig.parse({"source": source, "event": [event], "units": "g", "step": 0.01})
    found = description.build()
    expected = sb.read_records(
        {"mine": files, "first": f"{quakes}/first*", "second": f"{quakes}/second*"},
        "g",
        step=0.01,
        directions={"left.txt": 0, "right.txt": 90},
    )
    assert tuple(found.values()) == tuple(sorted(expected, key=lambda record: record.name))
    assert list(found) == ["first", "mine", "second"]
    again = json.loads(json.dumps(describe_motion(found["mine"]).values()))
    assert RecordMotion.parse(again).build() == found["mine"]
    assert RecordMotion.parse(again).build().name == "mine"
    short = {**event, "directions": [0]}
    with pytest.raises(ConfigError, match=r"directions: one for each file is needed \(got 1 for 2 files\)"):
        RecordsConfig.parse({"event": [short], "units": "g", "step": 0.01}).build()


def test_files_of_listed_events_are_found_from_the_folder_of_the_study(quakes, tmp_path):
    text = '[records]\nunits = "g"\nstep = 0.01\n[[records.event]]\nfiles = ["quakes/first_*.txt"]\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    values = read_config(tmp_path / "study.toml")["records"]
    (record,) = RecordsConfig.parse(values).build().values()
    assert (record,) == sb.read_records(quakes.glob("first*"), "g", step=0.01)


def test_a_component_alone_is_remarked_on_wherever_it_is_described(quakes):
    path = str(quakes / "second_NS.txt")
    reading = {"units": "g", "step": 0.01}
    for build in (
        RecordMotion(path=path, **reading).build,
        RecordsConfig(source=path, **reading).build,
    ):
        with pytest.warns(UnlikelyInputWarning, match="one horizontal component"):
            build()
    assert RecordMotion(path=path, one_component=True, **reading).build().axes == ("x",)
    assert list(RecordsConfig(source=path, one_component=True, **reading).build()) == ["second"]


@pytest.mark.parametrize("chosen", sb.records.RecordFormat)
def test_every_format_of_records_can_be_described(tmp_path, chosen):
    path = tmp_path / "study.toml"
    path.write_text(f'kind = "record"\npath = "a.txt"\nformat = "{chosen.name.lower()}"\n', encoding="utf-8")
    assert RecordMotion.parse(read_config(path)).format == chosen.name.lower()
