"""Assessment of columns that slide before they rock: slip, intervals, limits, margins, fragility, rates and report."""

import math
from dataclasses import replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import LimitState, slip_analysis
from stylobate.earthquakes.assessment.report.column_verdict import VerdictClass, column_verdict
from stylobate.earthquakes.assessment.report.sliding_tables import (
    limit_table,
    sliding_columns,
    slip_pictures,
    slip_summary_table,
    slip_table,
)
from stylobate.earthquakes.fragility.empirical_rate import compared_with_target
from stylobate.errors import ParameterError

pytestmark = pytest.mark.long

FRICTION, VARIATIONS, WIDTH = 0.15, 60, 1e-3
STOUT = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
SLIM = sb.Column.solid(radius=0.2, height=4.0, density=2700.0)
LIMITS = [
    LimitState(response="slip", limit=0.02),
    LimitState(response="residual", limit=0.01),
    LimitState(response="neighbours", limit=0.06),
]
LEVELS = {level: {"damping": value} for level, value in (("low", 0.05), ("central", 0.1), ("high", 0.2))}
HAZARD = sb.earthquakes.HazardCurve(
    intensity=[0.1, 100.0],
    rate=[1e-1, 1e-7],
    units="m s-2",
    quantity="peak ground acceleration",
    component="RotD50",
)


def quakes():
    noise = sb.records.EvolvingNoise(arias=0.5, duration_5_95=2.0, middle_time=1.5, frequency=2.5)
    rng = np.random.default_rng(4)
    return {f"q{place}": noise.record(rng, components=3, step=0.02).trimmed(0.0, 5.0) for place in range(3)}


def assessed(**changes):
    options = {
        "dissipation": LEVELS,
        "friction_coefficient": FRICTION,
        "margin_scales": np.geomspace(0.4, 4.0, 12),
        "variations": VARIATIONS,
        "width": WIDTH,
        "tail": 2.0,
        "planar": False,
        "contact": False,
        "contact_laws": False,
        "sliding": True,
        "limit_states": LIMITS,
        "hazard": HAZARD,
        "least_records": 3,
        "rtol": 1e-5,
    }
    columns = {"stout": sb.Slender(STOUT), "slim": sb.Slender(SLIM)}
    return sb.earthquakes.assess(columns, quakes(), **{**options, **changes})


@pytest.fixture(scope="module")
def found():
    return assessed()


def test_the_slip_at_the_stated_scales_is_that_of_the_sliding_block(found):
    slips = slip_analysis(sb.Sliding(STOUT, friction_coefficient=FRICTION), quakes(), scales=[1.0])
    own = found.data["sliding"].sel(column="stout")
    for name in ("peak_slip", "residual_slip", "residual_x", "residual_y", "slip_path", "time_sliding"):
        assert own[name].values == pytest.approx(slips[name].values, rel=1e-12)
    assert (own["overturned"] == 0).all()
    assert (own["tilt_ratio"] == 0.0).all()
    x, y = own["residual_x"], own["residual_y"]
    assert own["residual_azimuth"].values == pytest.approx(np.arctan2(y, x).values)


def test_a_column_that_rocks_first_has_no_slip(found):
    slim = found.data["sliding"].sel(column="slim")
    assert (slim["overturned"] == -1).all()
    assert (slim["outcome"] == -1).all()
    assert slim["peak_slip"].isnull().all()
    assert (slim["reached"] == -1).all()
    assert found.data["slip_margins"]["least_reaching"].sel(column="slim").isnull().all()
    assert sliding_columns(found) == ("stout",)


def test_small_variations_surround_the_stated_slip(found):
    own = found.data["sliding"].sel(column="stout", scale=1.0)
    assert (own["known_variations"] == VARIATIONS).all()
    for name in ("peak_slip", "residual_slip"):
        low, median, high = (own[f"{name}_{end}"] for end in ("low", "median", "high"))
        assert (low < median).all()
        assert (median < high).all()
    assert (own["peak_slip_low"] < own["peak_slip"]).all()
    assert (own["peak_slip"] < own["peak_slip_high"]).all()
    # rotations of the record of 3 degrees turn the residual slip at least as much
    assert (own["azimuth_within"] > math.radians(2.0)).all()
    pooled = [float(own[f"all_peak_slip_{end}"]) for end in ("low", "median", "high")]
    assert float(own["peak_slip_low"].min()) <= pooled[0] < pooled[1] < pooled[2] <= float(own["peak_slip_high"].max())


def test_without_dispersion_and_variation_of_friction_the_interval_is_narrower(found):
    certain = assessed(friction_dispersion=0.0, hazard=None, least_records=20).data["sliding"].sel(column="stout")
    spread = found.data["sliding"].sel(column="stout")
    widths = [one["peak_slip_high"] - one["peak_slip_low"] for one in (certain, spread)]
    assert (widths[0] < widths[1]).all()


def test_the_margin_is_the_smallest_scale_of_the_scan_that_reaches_the_limit(found):
    margins = found.data["slip_margins"].sel(column="stout")
    model = sb.Sliding(STOUT, friction_coefficient=FRICTION)
    compared = 0
    for name, record in quakes().items():
        for limit in LIMITS:
            least = float(margins["least_reaching"].sel(record=name, limit_state=limit.name))
            if math.isnan(least):
                continue
            by = "residual_slip" if limit.name.startswith("residual") else "peak_slip"
            beside = slip_analysis(model, record, scales=[least * (1.0 - 1.1 * WIDTH), least])[by].values
            assert beside[1] >= limit.limit > beside[0]
            scan = margins["reached"].sel(record=name, limit_state=limit.name)
            assert least <= float(scan["margin_scale"].values[scan.values == 1][0])
            compared += 1
    assert compared >= 6


def test_fragility_and_rates_of_a_column_that_slides_are_those_of_its_slip(found):
    of_slip = [limit.name for limit in LIMITS]
    fits, rates = found.data["fragility"], found.data["rates"]
    runs = fits["runs"].sel(column="stout")
    others = [name for name in fits["limit_state"].values if name not in of_slip]
    assert (runs.sel(limit_state=others) == 0).all()
    assert (runs.sel(limit_state=of_slip) > 0).all()
    assert rates["annual_rate"].sel(column="stout", limit_state=others).isnull().all()
    assert (rates["annual_rate"].sel(column="stout", limit_state=of_slip) > 0.0).all()
    # the rate of each record is about the hazard at its smallest reaching scale, if slip grows with the scale
    margins = found.data["slip_margins"].sel(column="stout", limit_state=of_slip[0])
    peaks = found.data["records"]["median_peak_acceleration"]
    about = 1e-3 / (margins["least_reaching"] * peaks) ** 2
    rate = float(rates["annual_rate"].sel(column="stout", limit_state=of_slip[0]))
    if not (margins["falls_back"] > 0.0).any():
        step = (4.0 / 0.4) ** (1.0 / 11)
        assert rate == pytest.approx(float(about.mean()), rel=step - 1.0)


def test_a_column_that_rocks_reaches_its_neighbours_by_tilt_and_has_no_other_limit(found):
    rates = found.data["rates"]["annual_rate"].sel(column="slim")
    assert rates.sel(limit_state=["slip 20 mm", "residual 10 mm"]).isnull().all()
    assert float(rates.sel(limit_state="neighbours 60 mm")) >= float(rates.sel(limit_state="overturning"))


def test_limits_change_no_other_result(found):
    plain = assessed(sliding=False, limit_states=(), hazard=None, least_records=20, variations=0)
    assert "sliding" not in plain.data
    assert plain.data["verdicts"].equals(found.data["verdicts"])
    own = found.data["margins"]["reached"].sel(limit_state=plain.data["margins"]["limit_state"])
    assert own.equals(plain.data["margins"]["reached"])


def test_a_column_keeps_limits_of_its_own():
    own = {"slim": [LimitState(response="neighbours", limit=0.05)], "stout": LIMITS[:1]}
    found = assessed(limit_states=own, variations=0)
    reached = found.data["sliding"]["reached"].sel(column="stout")
    assert (reached.sel(limit_state="neighbours 50 mm") == -1).all()
    assert (reached.sel(limit_state="slip 20 mm") >= 0).all()
    assert found.data["sliding"]["peak_slip_low"].isnull().all()
    with pytest.raises(ParameterError, match="limit_states: 'stot' is no column; did you mean stout"):
        assessed(limit_states={"stot": LIMITS})


def test_a_run_that_lifts_off_is_that_of_the_model_that_slides():
    record = quakes()["q0"]
    jolt = record.scaled(1.0, vertical=-1.2 * STOUT.gravity / record.samples[:, 2].min())
    model = sb.Sliding(STOUT, friction_coefficient=FRICTION, damping=0.1)
    run = sb.simulate(model, jolt, duration=jolt.duration + 2.0, rtol=1e-6)
    assert run.measures["time_flying"] > 0.0
    peak = np.hypot(*run.data["footprint"].transpose("axis", "time").to_numpy()).max()
    found = sb.earthquakes.assess(
        {"stout": sb.Slender(STOUT)},
        {"jolt": jolt},
        dissipation=LEVELS,
        friction_coefficient=FRICTION,
        margin_scales=[0.5, 1.0],
        variations=4,
        tail=2.0,
        planar=False,
        contact=False,
        contact_laws=False,
        sliding=True,
        limit_states=[LimitState(response="neighbours", limit=factor * peak) for factor in (0.99, 1.01)],
        rtol=1e-6,
    )
    own = found.data["sliding"].isel(column=0, record=0, scale=0)
    assert float(own["residual_slip"]) == pytest.approx(run.measures["residual_displacement"], rel=1e-9)
    assert own["reached"].values.tolist() == [1, 0]
    assert int(own["known_variations"]) == 0
    margins = found.data["slip_margins"].isel(column=0, record=0)
    assert float(margins["decided_to"]) < 1.0


def test_the_verdict_states_the_slip_and_the_limits(found):
    verdict = column_verdict(found, "stout", 1.0)
    assert verdict.verdict is VerdictClass.SLIDES
    own = found.data["sliding"].sel(column="stout", scale=1.0)
    assert verdict.line.startswith("Slides before it rocks: μ = 0.15 < r/h = 0.333.")
    assert f"slid by up to {1000.0 * float(own['peak_slip'].max()):.3g} mm." in verdict.sentence
    assert "Under 90 % of the small variations of record and friction it slides by" in verdict.sentence
    for limit in LIMITS:
        reached = own["reached"].sel(limit_state=limit.name)
        words = "reached under" if (reached == 1).any() else "not reached"
        assert f"{limit.name} {words}" in verdict.sentence


def test_tables_and_pictures_show_the_columns_that_slide(found):
    rows = slip_table(found).rows
    assert [row[:3] for row in rows] == [("stout", name, "1") for name in quakes()]
    own = found.data["sliding"].sel(column="stout", record="q0", scale=1.0)
    assert rows[0][3] == f"{1000.0 * float(own['peak_slip']):.3g}"
    assert len(slip_summary_table(found).rows) == 1
    limits = limit_table(found).rows
    assert len(limits) == 3 * len(LIMITS)
    assert {row[4] for row in limits} <= {"reached", "not reached"}
    assert set(slip_pictures(found, "stout")) == {"slip", "slip-paths"}
    assert slip_pictures(found, "slim") == {}
    bare = replace(
        found, data={name: one for name, one in found.data.items() if "slip" not in name and name != "sliding"}
    )
    assert (slip_table(bare).rows, limit_table(bare).rows, sliding_columns(bare)) == ([], [], ())


@pytest.mark.slow
def test_an_assessment_with_slip_is_saved_and_its_report_is_written(found, tmp_path):
    loaded = sb.results.Assessment.load(found.save(tmp_path / "found.nc"))
    assert loaded == found
    report = sb.earthquakes.assessment_report(loaded, tmp_path / "report", progress=False)
    assert "Slides before it rocks" in report.read_text(encoding="utf-8")


def test_a_rate_that_is_not_known_is_neither_below_nor_above_the_target():
    assert compared_with_target(math.nan, math.nan, math.nan, 1e-4).startswith("not known")
