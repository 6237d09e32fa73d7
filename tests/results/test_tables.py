"""Results as tables in pandas: one row per run or sample, a column per number."""

import csv

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.results import to_dataframe, write_table
from stylobate.text import unit_in_text

COLUMN = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
MODEL = sb.Rolling(COLUMN, damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=3.0, angular_frequency=3.0)
PULSES = {f"pulse {k}": sb.Pulse.one_sine(acceleration=a, angular_frequency=4.0) for k, a in enumerate((3.0, 4.0, 6.0))}
SCALES = [0.5, 1.0, 1.5]


def test_a_run_has_a_row_for_each_sample_and_all_its_numbers():
    run = sb.simulate(MODEL, CIRCLE, duration=4.0, samples=101)
    table = run.to_dataframe()
    assert table.index.name == "time"
    np.testing.assert_array_equal(table.index, run.data["time"])
    components = {name: [str(dim) for dim in one.dims if dim != "time"] for name, one in run.data.data_vars.items()}
    assert table.shape == (
        run.data.sizes["time"],
        sum(int(np.prod([run.data.sizes[dim] for dim in dims])) for dims in components.values()),
    )
    for axis in "xy":
        np.testing.assert_array_equal(table[f"tilt_{axis}"], run.data["tilt"].sel(axis=axis))
        np.testing.assert_array_equal(
            table[f"base_acceleration_{axis}"], run.data["base_acceleration"].sel(direction=axis)
        )
    np.testing.assert_array_equal(table["amplitude"], run.data["amplitude"])


def test_a_verdict_has_a_row_for_each_variation_with_its_values():
    found = sb.verdict(MODEL, PULSES["pulse 1"], runs=12)
    table = found.to_dataframe()
    assert len(table) == 12
    assert (table["overturned"] == 1).mean() == found.share
    for name in found.data["variation"].to_numpy():
        np.testing.assert_array_equal(table[f"value_{name}"], found.data["value"].sel(variation=name))


def test_an_ensemble_has_a_row_for_each_run_without_its_histories():
    runs = sb.simulate_ensemble(
        MODEL, CIRCLE, duration=4.0, parameters={"acceleration": [0.5, 3.0, 6.0]}, samples=7, strobes=2
    )
    table = to_dataframe(runs)
    assert table["outcome"].tolist() == [sb.Outcome(code).name for code in runs["outcome"].to_numpy()]
    assert table["acceleration"].tolist() == [0.5, 3.0, 6.0]
    np.testing.assert_array_equal(table["end_tilt_y"], runs["end_tilt"].sel(axis="y"))
    assert not [name for name in table if name.startswith(("sampled", "strobe"))]
    single = to_dataframe(sb.simulate_ensemble(MODEL, CIRCLE, duration=4.0))
    assert len(single) == 1


def test_studies_over_several_dimensions_have_a_row_for_each_combination():
    runs = sb.earthquakes.incremental_dynamic_analysis(MODEL, PULSES, scales=SCALES)
    table = to_dataframe(runs)
    assert table.index.names == ["record", "scale"]
    assert len(table) == len(PULSES) * len(SCALES)
    assert table.loc[("pulse 2", 1.5), "intensity"] == float(runs["intensity"].sel(record="pulse 2", scale=1.5))
    assert set(table["reached_overturning"]) <= {"REACHED", "NOT_REACHED", "NOT_KNOWN"}
    by_scale = to_dataframe(runs, over=["scale", "record"])
    assert by_scale.index.names == ["scale", "record"]
    assert by_scale.loc[(1.5, "pulse 2"), "intensity"] == table.loc[("pulse 2", 1.5), "intensity"]


def test_a_fragility_has_a_row_for_each_limit_state_or_for_each_point_of_its_curves():
    intensity = np.repeat(np.linspace(1.0, 3.0, 9), 8)
    reached = np.random.default_rng(1).uniform(size=intensity.size) < (intensity - 0.5) / 3.0
    fits = sb.earthquakes.fit_fragility(intensity, reached)
    table = to_dataframe(fits)
    assert len(table) == fits["median"].size
    assert table["median"].tolist() == fits["median"].to_numpy().ravel().tolist()
    assert table["status"].tolist() == ["FITTED"]
    over = [*fits["median"].dims, "curve"]
    curves = to_dataframe(fits, over=over)
    assert len(curves) == fits["probability"].size
    np.testing.assert_array_equal(curves["probability"], fits["probability"].to_numpy().ravel())


def test_a_dimension_that_is_missing_suggests_the_nearest():
    runs = sb.earthquakes.incremental_dynamic_analysis(MODEL, PULSES, scales=SCALES)
    with pytest.raises(ParameterError, match=r"^over: .*\(got 'records'\)\. did you mean record\?"):
        to_dataframe(runs, over="records")


def test_tables_state_the_units_of_columns_and_index():
    run = sb.simulate(MODEL, CIRCLE, duration=4.0)
    units = run.to_dataframe().attrs["units"]
    assert units["time"] == "s"
    assert units["tilt_x"] == run.data["tilt"].attrs["units"]
    record = sb.sample_record()
    table = record.to_dataframe()
    np.testing.assert_array_equal(table.to_numpy(), record.samples)
    np.testing.assert_array_equal(table.index, record.times)
    assert table.attrs["units"] == {"time": "s", "x": "m s-2", "y": "m s-2", "z": "m s-2"}


def test_an_orbit_is_a_table_over_one_period_and_a_branch_has_a_row_per_orbit():
    circle = sb.Harmonic.circular(acceleration=0.8, angular_frequency=3.0)
    column = sb.Column.solid(radius=0.35, height=5.2, density=2700.0)
    model = sb.Slender(column, damping=0.1)
    orbit = sb.orbits.periodic_orbit(model, circle)
    table = orbit.to_dataframe()
    step = orbit.period / len(table)
    np.testing.assert_allclose(np.diff(table.index), step)
    assert tuple(table[["tilt_x", "tilt_y"]].iloc[0]) == pytest.approx(tuple(orbit.tilt))
    # Central differences of the tilts are the rates, up to the square of the step.
    tilt, rate = table["tilt_x"].to_numpy(), table["tilt_rate_x"].to_numpy()
    slope = (np.roll(tilt, -1) - np.roll(tilt, 1)) / (2.0 * step)
    bound = np.abs(np.gradient(np.gradient(rate, step), step)).max() * step**2
    assert np.abs(slope - rate).max() <= bound
    branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(2.9, 3.1))
    rows = branch.to_dataframe()
    assert len(rows) == len(branch.path)
    np.testing.assert_array_equal(rows["angular_frequency"], [point.value for point in branch.path])
    assert rows.attrs["units"]["mean_tilt"] == "rad"


@pytest.mark.parametrize("ending", [".csv", ".xlsx"])
def test_a_written_table_has_the_rows_and_units_of_the_dataframe(tmp_path, ending):
    runs = sb.simulate_ensemble(MODEL, CIRCLE, duration=4.0, parameters={"acceleration": [0.05, 0.15]})
    table = to_dataframe(runs).reset_index()
    path = write_table(runs, tmp_path / f"runs{ending}")
    if ending == ".csv":
        header, *rows = csv.reader(path.read_text(encoding="utf-8").splitlines())
    else:
        sheet = pytest.importorskip("openpyxl").load_workbook(path).active
        header, *rows = sheet.iter_rows(values_only=True)
    assert [name.partition(" [")[0] for name in header] == list(table.columns)
    units = {name: unit.strip("]") for name, _, unit in (one.partition(" [") for one in header)}
    assert units["peak_tilt"] == unit_in_text(runs["peak_tilt"].attrs["units"])
    for name, *cells in zip(table.columns, *rows, strict=True):
        for cell, value in zip(cells, table[name], strict=True):
            if ending == ".csv":
                assert cell == str(value)
            else:
                assert cell is None if isinstance(value, float) and not np.isfinite(value) else cell == value


def test_a_table_of_another_ending_is_refused(tmp_path):
    runs = sb.simulate_ensemble(MODEL, CIRCLE, duration=1.0)
    with pytest.raises(sb.errors.ParameterError, match=r"path: must end with \.csv or \.xlsx \(got '.*runs\.ods'\)"):
        write_table(runs, tmp_path / "runs.ods")
