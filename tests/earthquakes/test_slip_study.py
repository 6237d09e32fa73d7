"""Slip of columns under scaled records: against `Sliding`, laws of the scales, fragility and annual rates."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes import LimitState, slip_analysis, slip_paths
from stylobate.earthquakes.slip_study import reached_by_slip
from stylobate.errors import ParameterError

COLUMN = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
C = COLUMN.slenderness
MODEL = sb.Sliding(COLUMN, friction_coefficient=0.15)
LIMITS = [
    LimitState(response="slip", limit=0.03),
    LimitState(response="residual", limit=0.02),
    LimitState(response="neighbours", limit=0.08),
    LimitState(response="edge", limit=0.15),
]


def quakes(count=4, components=3):
    noise = sb.records.EvolvingNoise(arias=0.8, duration_5_95=3.0, middle_time=2.0, frequency=2.0)
    rng = np.random.default_rng(3)
    return {
        f"q{place}": noise.record(rng, components=components, step=0.02).trimmed(0.0, 8.0) for place in range(count)
    }


def test_each_run_is_that_of_the_model_with_six_degrees_of_freedom():
    records = quakes(2)
    found = slip_analysis(MODEL, records, scales=[0.7, 1.5])
    for name, record in records.items():
        for scale in (0.7, 1.5):
            run = sb.simulate(MODEL, record.scaled(scale), duration=record.duration + 3.0)
            own = found.sel(record=name, scale=scale)
            places = run.data["footprint"].transpose("axis", "time").to_numpy()
            assert [float(own["residual_x"]), float(own["residual_y"])] == pytest.approx(places[:, -1], abs=1e-5)
            assert float(own["residual_slip"]) == pytest.approx(run.measures["residual_displacement"], abs=1e-5)
            assert float(own["peak_slip"]) == pytest.approx(np.hypot(*places).max(), abs=1e-4)
            assert float(own["slip_path"]) == pytest.approx(run.measures["slip_distance"], abs=1e-4)
            assert run.outcome == int(own["outcome"])


def test_limit_states_are_reached_where_the_slip_exceeds_them():
    found = slip_analysis(MODEL, quakes(), scales=np.geomspace(0.3, 3.0, 12), limit_states=LIMITS)
    assert found["limit_state"].values.tolist() == ["slip 30 mm", "residual 20 mm", "neighbours 80 mm", "edge 150 mm"]
    for limit in LIMITS:
        by = found["residual_slip" if limit.response.value == "residual" else "peak_slip"]
        own = found["reached"].sel(limit_state=limit.name)
        assert (own == 1).values.tolist() == (by >= limit.limit).values.tolist()
        assert {0, 1} <= set(np.unique(own))


def test_a_tilt_counts_for_neighbours_besides_the_slip():
    slip = xr.Dataset({name: ("run", [0.05, 0.05, np.nan]) for name in ("peak_slip", "residual_slip")})
    shifts = {"neighbours 80 mm": xr.DataArray([0.02, 0.04, 0.04], dims="run")}
    reached = reached_by_slip(slip, LIMITS, shifts)
    assert reached.sel(limit_state="neighbours 80 mm").values.tolist() == [0, 1, -1]
    assert reached.sel(limit_state="slip 30 mm").values.tolist() == [1, 1, -1]


def test_a_slip_can_fall_with_the_scale():
    # A second, opposite pulse brings the block back. The stronger both are, the farther it returns.
    step = 0.01
    push = np.sin(np.linspace(0.0, np.pi, 60))
    samples = np.concatenate([push, -push, np.zeros(10), -0.8 * push, 0.8 * push])
    record = sb.Record(samples=3.0 * samples, step=step)
    found = slip_analysis(MODEL, record, scales=np.linspace(0.5, 4.0, 200))
    assert (np.diff(found["residual_slip"].values) < 0.0).any()


def test_the_vertical_component_is_left_out_on_request():
    records = quakes(2)
    both = slip_analysis(MODEL, records, scales=[1.5], vertical=(True, False))
    flat = {name: record.scaled(1.0, vertical=0.0) for name, record in records.items()}
    alone = slip_analysis(MODEL, flat, scales=[1.5])
    assert both["peak_slip"].sel(vertical=False).values.tolist() == alone["peak_slip"].values.tolist()
    assert (both["peak_slip"].sel(vertical=True) != both["peak_slip"].sel(vertical=False)).all()


def test_a_base_that_falls_faster_than_g_is_not_known():
    records = quakes(1)
    scale = COLUMN.gravity / -records["q0"].samples[:, 2].min()
    found = slip_analysis(MODEL, records, scales=scale * np.array([0.999, 1.001]), limit_states=LIMITS)
    assert found["outcome"].values.tolist() == [[0, -1]]
    assert np.isnan(found["peak_slip"].values[0]).tolist() == [False, True]
    assert (found["reached"].isel(scale=1) == -1).all()
    assert int(found["computed"]) == 1


def test_samples_that_rock_first_are_not_known():
    frictions = [0.1, 0.999 * C, 1.001 * C]
    found = slip_analysis(
        MODEL, quakes(2), scales=[1.0], limit_states=LIMITS, parameters={"friction_coefficient": frictions}
    )
    known = found["peak_slip"].notnull().all(("record", "scale"))
    assert known.values.tolist() == [True, True, False]
    assert (found["reached"].isel(property_sample=2) == -1).all()
    fits = sb.earthquakes.fragility_of_runs(found)
    assert fits["runs_not_known"].values.tolist() == [2, 2, 2, 2]


def test_a_sample_of_the_friction_is_a_model_with_that_friction():
    varied = slip_analysis(MODEL, quakes(2), scales=[1.0, 2.0], parameters={"friction_coefficient": [0.1, 0.2]})
    for place, friction in enumerate((0.1, 0.2)):
        own = slip_analysis(sb.Sliding(COLUMN, friction_coefficient=friction), quakes(2), scales=[1.0, 2.0])
        assert varied["peak_slip"].isel(property_sample=place).values.tolist() == own["peak_slip"].values.tolist()


def test_size_and_dissipation_do_not_change_the_slip():
    large = sb.Sliding(sb.Column.solid(radius=1.5, height=9.0, density=900.0), friction_coefficient=0.15, damping=0.3)
    own, other = (slip_analysis(model, quakes(2), scales=[1.0]) for model in (MODEL, large))
    assert own["residual_slip"].identical(other["residual_slip"])


@pytest.mark.parametrize(
    ("model", "message"),
    [
        (sb.Wobbling(COLUMN), "model: must be Sliding"),
        (sb.Sliding(COLUMN, friction_coefficient=0.5), "friction_coefficient: must be below r/h = 0.3333"),
        (sb.Sliding(COLUMN, friction_coefficient=0.0), "friction_coefficient: must be positive"),
        (
            sb.Sliding(COLUMN, friction_coefficient=0.1, static_friction_coefficient=0.2),
            "static_friction_coefficient: must equal the kinetic 0.1",
        ),
        (sb.Sliding(COLUMN, friction_coefficient=0.1, incline=0.01), "incline: must be 0"),
    ],
)
def test_a_model_that_is_no_sliding_block_is_refused(model, message):
    for study in (lambda: slip_analysis(model, quakes(1), scales=[1.0]), lambda: slip_paths(model, quakes(1))):
        with pytest.raises(ParameterError, match=message):
            study()


def test_a_smooth_pulse_is_sampled_finely():
    pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    times = np.linspace(0.0, pulse.duration, 20_001)
    fine = sb.Record(samples=pulse.acceleration(times), step=times[1])
    own, exact = (float(slip_analysis(MODEL, motion, scales=[1.0])["peak_slip"][0]) for motion in (pulse, fine))
    assert own == pytest.approx(exact, rel=1e-4)


def test_the_counted_rate_of_one_record_is_that_of_the_hazard_at_its_scale():
    found = slip_analysis(MODEL, quakes(1), scales=np.geomspace(0.2, 5.0, 400), limit_states=LIMITS[:1])
    hazard = sb.earthquakes.HazardCurve(intensity=[0.1, 100.0], rate=[1e-1, 1e-7], units="m s-2", component="RotD50")
    rate = sb.earthquakes.empirical_rate(
        found["intensity"], found["reached"], hazard, record=found["record"], resamples=0
    )
    first = found["intensity"].values[0][found["peak_slip"].values[0] >= 0.03][0]
    # 1e-3/x² at the first scale that reaches it, up to the step between scales
    assert rate["annual_rate"].item() == pytest.approx(1e-3 / first**2, rel=2.0 * np.log(25.0) / 399)


def test_a_path_leads_from_the_start_to_the_residual_position():
    found, runs = slip_paths(MODEL, quakes(), limit_states=LIMITS), slip_analysis(MODEL, quakes(), scales=[1.0])
    for name in found["record"].values:
        one, run = found.sel(record=name), runs.sel(record=name, scale=1.0)
        x, y, time = (one[key].dropna("sample").values for key in ("slip_x", "slip_y", "time"))
        assert (x[0], y[0]) == (0.0, 0.0)
        assert [x[-1], y[-1]] == pytest.approx([float(run["residual_x"]), float(run["residual_y"])], abs=1e-9)
        # between samples it moves by half an acceleration times the square of half a step beyond
        assert np.hypot(x, y).max() == pytest.approx(float(run["peak_slip"]), abs=10.0 * 0.02**2 / 8.0)
        assert (np.diff(time) >= 0.0).all()
        assert len(x) <= 1001
    assert found["limit"].values.tolist() == [0.03, 0.02, 0.08, 0.15]


def test_figures_show_runs_and_paths_with_their_limits():
    for found in (
        slip_analysis(MODEL, quakes(), scales=np.geomspace(0.3, 3.0, 12), limit_states=LIMITS),
        slip_paths(MODEL, quakes(), limit_states=LIMITS),
    ):
        figure = sb.plot(found)
        words = [text.get_text() for text in figure.legends[0].get_texts()]
        assert {"q0", "q3", "slip 30 mm", "edge 150 mm"} <= set(words)
    axes = sb.plot(slip_paths(MODEL, quakes(), limit_states=LIMITS)).axes[0]
    assert sorted(patch.get_radius() for patch in axes.patches) == pytest.approx([20.0, 30.0, 80.0, 150.0])
