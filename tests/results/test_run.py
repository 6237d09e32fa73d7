"""The result of a run: its data, saved and loaded, sampled, and run again."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import FileError, ParameterError, UnsupportedError

MODEL = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.7, angular_frequency=2.5, ramp=2.0).delayed(1.0) + sb.Harmonic.vertical(
    acceleration=0.5, angular_frequency=5.0
)


@pytest.fixture(scope="module")
def run():
    return sb.simulate(MODEL, MOTION, tilt=(0.03, 0.01), tilt_rate=(0.0, 0.05), duration=10.0)


@pytest.fixture(scope="module")
def standing():
    return sb.simulate(MODEL, None, duration=3.0)


def same(one, other):
    for name in ("outcome", "reason", "decided_at", "uncertain", "planar", "events"):
        assert getattr(one, name) == getattr(other, name), name
    assert dict(one.thresholds) == dict(other.thresholds)
    assert dict(one.measures) == dict(other.measures)
    assert dict(one.provenance) == dict(other.provenance)


@pytest.mark.parametrize("which", ["run", "standing"])
def test_a_saved_run_is_loaded_as_it_was(which, request, tmp_path):
    saved = request.getfixturevalue(which)
    path = saved.save(tmp_path / "run.nc")
    loaded = sb.load(path)
    same(loaded, saved)
    xr.testing.assert_identical(loaded.data, saved.data)
    assert loaded.data.resting.dtype == bool
    assert sb.load(str(path)).outcome is saved.outcome


def test_a_loaded_run_can_be_saved_again(run, tmp_path):
    first = sb.load(run.save(tmp_path / "first.nc"))
    second = sb.load(first.save(tmp_path / "second.nc"))
    same(first, second)
    xr.testing.assert_identical(first.data, second.data)


def test_saving_leaves_the_run_as_it_is(run, tmp_path):
    before = run.data.copy(deep=True)
    run.save(str(tmp_path / "run.nc"))
    xr.testing.assert_identical(run.data, before)


def test_the_dataset_of_a_run_is_made_when_it_is_used_and_stays_the_same():
    run = sb.simulate(MODEL, MOTION, tilt=(0.03, 0.01), duration=1.0)
    assert not isinstance(vars(run)["data"], xr.Dataset)
    sent = pickle.loads(pickle.dumps(run))  # noqa: S301  of our own
    run.data.attrs["note"] = "of the user"
    assert run.data is run.data
    assert run.data.attrs.pop("note") == "of the user"
    xr.testing.assert_identical(sent.data, run.data)
    with pytest.raises(dataclasses.FrozenInstanceError):
        run.data = run.data


def test_a_run_is_changed_into_one_with_another_dataset(run):
    last = run.data.isel(time=[-1])
    assert dataclasses.replace(run, data=last).data is last
    assert run.data.sizes["time"] > 1


def test_a_response_without_data_cannot_be_made(run):
    kept = {name: value for name, value in vars(run).items() if name != "data"}
    with pytest.raises(TypeError, match="'data'"):
        sb.Run(**kept)


def test_numbers_of_other_kinds_can_be_saved(tmp_path):
    limited = sb.simulate(MODEL, tilt=(0.03, 0.0), duration=1.0, tilt_limit=np.float32(0.5), max_steps=np.int64(1000))
    loaded = sb.load(limited.save(tmp_path / "run.nc"))
    same(loaded, limited)
    assert loaded.provenance["max_steps"] == 1000


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"tilt_limit": 0.04, "rtol": 1e-10},
        {"samples": 77},
        {"rules": sb.OutcomeRules(periods=3)},
    ],
    ids=["defaults", "limit and tolerance", "samples", "rules"],
)
def test_a_run_is_repeated_from_its_provenance(options, tmp_path):
    first = sb.simulate(MODEL, MOTION, tilt=(0.03, 0.01), duration=10.0, **options)
    loaded = sb.load(first.save(tmp_path / "run.nc"))
    setup = sb.config.config_of(loaded.provenance).build()
    again = sb.simulate(setup.model, setup.motion, **setup.options)
    same(again, first)
    xr.testing.assert_identical(again.data, first.data)


def test_sampling_at_the_times_of_the_data_gives_the_data(run):
    xr.testing.assert_allclose(run.sample(run.data.time), run.data, rtol=1e-12, atol=1e-15)


def test_samples_lie_between_the_samples_of_the_data(run):
    time = run.data.time.to_numpy()
    middle = run.sample(0.5 * (time[:-1] + time[1:]))
    step = time[1] - time[0]
    between = 0.5 * (run.data.tilt.to_numpy()[:-1] + run.data.tilt.to_numpy()[1:])
    # The mean of two neighbours is off by h²/8 times the second derivative, at most about 2ω0²c here.
    assert np.abs(middle.tilt.to_numpy() - between).max() < step**2
    assert float(run.sample(0.0).amplitude[0]) == pytest.approx(math.hypot(0.03, 0.01), rel=1e-14)
    assert run.sample(2.0).sizes["time"] == 1


@pytest.mark.parametrize("time", [-0.1, 10.1, math.nan, [0.0, 11.0]])
def test_times_outside_the_run_are_refused(run, time):
    with pytest.raises(ParameterError, match=r"^time must lie within the run, 0 to"):
        run.sample(time)


def test_a_loaded_run_cannot_be_sampled(run, tmp_path):
    with pytest.raises(UnsupportedError, match=r"a loaded result has the samples in .data only"):
        sb.load(run.save(tmp_path / "run.nc")).sample(1.0)


def write_foreign(path):
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(path, engine="h5netcdf")


def write_unfinished(path):
    xr.Dataset({"a": ("x", [1.0])}, attrs={"format": "stylobate run 1"}).to_netcdf(path, engine="h5netcdf")


@pytest.mark.parametrize(
    "write",
    [
        lambda path: path.write_text("no netCDF at all"),
        lambda path: path.write_bytes(b""),
        lambda path: path.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100)),
        lambda path: path.mkdir(),
        lambda _: None,
        write_foreign,
        write_unfinished,
    ],
    ids=["text", "empty", "broken", "folder", "missing", "foreign", "unfinished"],
)
def test_what_holds_no_run_is_a_file_error_that_names_it(write, tmp_path):
    path = tmp_path / "other.nc"
    write(path)
    with pytest.raises(FileError, match=r"other\.nc"):
        sb.load(path)


def test_a_truncated_file_is_a_file_error(run, tmp_path):
    path = run.save(tmp_path / "run.nc")
    path.write_bytes(path.read_bytes()[:5000])
    with pytest.raises(FileError, match=r"run\.nc"):
        sb.load(path)


def test_a_file_that_cannot_be_written_is_a_file_error(run, tmp_path):
    with pytest.raises(FileError, match=r"cannot write .*run\.nc"):
        run.save(tmp_path / "missing" / "run.nc")


def test_the_data_agree_among_themselves(run):
    data = run.data
    x, y = data.tilt.to_numpy().T
    np.testing.assert_allclose(np.hypot(x, y), data.amplitude, rtol=1e-14)
    np.testing.assert_allclose(np.cos(data.azimuth) * data.amplitude, x, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(np.sin(data.azimuth) * data.amplitude, y, rtol=0.0, atol=1e-15)
    assert np.abs(np.diff(data.azimuth)).max() < 1.0  # unwrapped
    np.testing.assert_allclose(data.base_acceleration, MOTION.acceleration(data.time), rtol=1e-15)
    square = data.amplitude_rate**2 + (data.amplitude * data.rolling_rate) ** 2
    np.testing.assert_allclose(square, (data.tilt_rate**2).sum("axis"), rtol=1e-10)
    np.testing.assert_allclose(np.hypot(*data.centre_of_pressure.to_numpy().T), 0.5, rtol=1e-12)
    for name in set(data.data_vars) - {"resting"}:
        assert data[name].attrs["units"], name
        assert data[name].attrs["long_name"], name
    # Sought between the samples: above the largest of them, by less than the parabola through 48 samples a swing.
    largest = float(data.amplitude.max())
    assert largest <= run.measures["peak_tilt"] <= largest * (1.0 + 0.5 * (math.pi / 48.0) ** 2)
    assert run.measures["turns"] == pytest.approx(float(data.azimuth[-1] - data.azimuth[0]) / (2.0 * math.pi))


def test_a_run_says_what_became_of_the_column(run):
    assert repr(run) == f"Run({run.outcome.name} at {run.decided_at:.6g} s: {run.reason})"


def test_the_result_of_a_study_is_told_from_a_run(tmp_path):
    path = tmp_path / "map.nc"
    xr.Dataset({"outcome": ("run", [0])}, attrs={"kind": "overturning map"}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match=r"of kind 'overturning map', not a run; stylobate\.load reads it$"):
        sb.Run.load(path)


def test_codes_are_those_of_outcomes():
    for code, outcome in enumerate(sb.Outcome):
        assert outcome == code
        assert sb.Outcome(np.int8(code)) is outcome
        assert sb.results.outcomes.outcome_label(code) == str(outcome) == f"{outcome}" == outcome.label
    assert sb.results.outcomes.outcome_label(-1) == "not computed"
    with pytest.raises(ValueError, match="is not a valid Outcome"):
        sb.Outcome(-1)


def test_outcomes_compare_with_the_codes_of_a_dataset():
    runs = sb.simulate_ensemble(MODEL, duration=0.5, tilt=[[0.01, 0.0], [0.3, 0.0]])
    np.testing.assert_array_equal(runs.outcome == sb.Outcome.OVERTURNED, [False, True])
    assert runs.outcome.dtype == np.int8
