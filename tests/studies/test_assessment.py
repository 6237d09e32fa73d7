"""The assessment of columns: its answers are those of single runs, whatever the order, interrupted or not."""

import logging
from functools import partial

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import FileError, ParameterError, SeldomMeant
from stylobate.results import Assessment
from stylobate.studies import ScaledRecord, SlendernessScaled, assess
from stylobate.studies.assessment import robust
from stylobate.studies.shaking.remarks import remark_on

DISSIPATION = {"low": {"damping": 0.01}, "central": {"damping": 0.05}, "high": {"damping": 0.1}}
CHANGES = (ScaledRecord(0.95), ScaledRecord(1.05), SlendernessScaled(0.99))


def model(radius):
    return sb.Slender(sb.Column.solid(radius=radius, height=2.0, density=2700.0))


def record(name, peak, frequency):
    """Two seconds of a wave along x, a weaker one along y."""
    time = 0.02 * np.arange(101)
    wave = np.sin(np.pi * time / 2.0) * np.sin(2.0 * np.pi * frequency * time)
    return sb.Record(samples=peak * np.stack([wave, 0.4 * wave**2], axis=-1), step=0.02, name=name)


RECORDS = [record("strong", 8.0, 1.0), record("middle", 3.0, 1.5), record("weak", 0.3, 1.0)]


def assessed(columns=("slim", "stout"), records=RECORDS, **more):
    radii = {"slim": 0.2, "stout": 0.45}
    options = {"changes": CHANGES, "planar": False, "contact": False, "scales": [0.5, 1.0], "tail": 2.0} | more
    return assess(
        {name: model(radii[name]) for name in columns},
        records,
        dissipation=DISSIPATION,
        friction_coefficient=0.6,
        margin_scales=np.geomspace(0.5, 3.0, 9),
        **options,
    )


@pytest.fixture(scope="module")
def found():
    return assessed()


def test_verdicts_are_those_of_single_runs(found):
    verdicts = found.data["verdicts"]
    for name, one in (("strong", RECORDS[0]), ("weak", RECORDS[2])):
        for level, numbers in DISSIPATION.items():
            column = sb.Slender(model(0.2).column, **numbers)
            run = sb.simulate(column, one, duration=one.duration + 2.0)
            told = verdicts.sel(column="slim", record=name, dissipation=level, vertical="with", scale=1.0)
            assert int(told["overturned"]) == (run.outcome is sb.Outcome.OVERTURNED)
            if run.outcome is not sb.Outcome.OVERTURNED:
                ratio = run.measures["largest_tilt"] / column.column.tipping_angle
                assert float(told["tilt_ratio"]) == pytest.approx(ratio, rel=1e-5, abs=1e-9)


def test_what_always_overturns_and_what_never_moves_are_told_so(found):
    alone = assessed(columns=("slim",), records=RECORDS[:1], scales=[1.0])
    summary = alone.data["summary"].sel(column="slim", scale=1.0)
    assert (int(summary["overturned"]), int(summary["stood"])) == (1, 0)
    assert float(summary["least_overturning"]) <= 1.0
    quiet = found.data["verdicts"].sel(record="weak")
    assert (quiet["overturned"] == 0).all()
    assert (quiet["tilt_ratio"] == 0.0).all()
    margins = found.data["margins"].sel(record="weak")
    assert (margins["bands"] == 0).all()
    assert np.isnan(margins["least_overturning"]).all()
    assert (found.data["summary"]["never_overturned"] >= 1).all()


def test_the_margin_parts_scales_that_overturn_from_those_that_do_not(found):
    own = found.data["margins"].sel(column="slim", case="central", record="strong")
    column = sb.Slender(model(0.2).column, damping=0.05)
    for name, outcome in (("least_overturning", True), ("largest_below", False)):
        scale = float(own[name])
        if np.isfinite(scale):
            run = sb.simulate(column, RECORDS[0].scaled(scale), duration=RECORDS[0].duration + 2.0)
            assert (run.outcome is sb.Outcome.OVERTURNED) is outcome
    assert found.data["summary"]["governing"].sel(column="slim").item() == "strong"


def test_the_order_of_records_and_columns_changes_no_number(found):
    other = assessed(columns=("stout", "slim"), records=RECORDS[::-1])
    for name, data in found.data.items():
        xr.testing.assert_identical(
            other.data[name].sel(column=["slim", "stout"]) if "column" in data.dims else data, data
        )


def test_an_assessment_is_saved_and_shown_again(found, tmp_path):
    again = Assessment.load(found.save(tmp_path / "a.nc"))
    assert again.setting == found.setting
    for name, data in found.data.items():
        xr.testing.assert_equal(again.data[name], data)
    sb.simulate(model(0.2), None, duration=1.0).save(tmp_path / "run.nc")
    with pytest.raises(FileError, match="holds no assessment"):
        Assessment.load(tmp_path / "run.nc")


def test_interrupted_work_goes_on_where_it_was(found, tmp_path, caplog):
    seen = []

    def stop(what, done, total):
        del done, total
        seen.append(what)
        if "small changes" in what:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        assessed(columns=("slim",), store=tmp_path / "store", progress=stop)
    kept = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "store").glob("*.nc")}
    assert len(kept) == 4  # verdicts, and margins at three levels
    whole = assessed(columns=("slim",), store=tmp_path / "store")
    assert {name: (tmp_path / "store" / name).stat().st_mtime_ns for name in kept} == kept
    for name in ("verdicts", "margins", "robustness", "summary"):
        xr.testing.assert_equal(whole.data[name], found.data[name].sel(column=["slim"]))
    assert not caplog.messages
    with caplog.at_level(logging.INFO, logger="stylobate"):
        assessed(columns=("slim",), store=tmp_path / "store")
    assert caplog.messages == [f"7 of 7 parts were kept in {tmp_path / 'store'} and not computed again"]
    # Another record is another part.
    assessed(columns=("slim",), records=[*RECORDS[:2], RECORDS[2].scaled(1.1)], store=tmp_path / "store", changes=())
    assert len(list((tmp_path / "store").glob("*.nc"))) > len(kept) + 4


def test_records_are_computed_some_at_a_time_and_the_whole_is_that_of_all_at_once(monkeypatch):
    one_by_one = partial(assessed, columns=("slim",), records=RECORDS[:2], planar=True, changes=CHANGES[:1])
    whole = one_by_one()
    monkeypatch.setattr(robust, "_TOGETHER", 1)
    parts = one_by_one()
    for name in ("robustness", "planar", "summary"):
        xr.testing.assert_equal(parts.data[name], whole.data[name])
        for one, told in whole.data[name].items():
            assert parts.data[name][one].attrs.get("long_name") == told.attrs.get("long_name")


def test_what_is_perhaps_in_another_unit_or_one_event_is_remarked():
    tower, column = (sb.Column.solid(radius=0.1 * height, height=height, density=2700.0) for height in (61.0, 6.0))
    with pytest.warns(SeldomMeant) as told:
        remark_on({"tower": tower, "column": column}, ["Aigio", "aigio", "Kobe"])
    assert [str(one.message).partition(";")[0] for one in told] == [
        "tower: a height of 61 m",
        "records: 'Aigio' and 'aigio' differ by case only and are taken as different ones",
    ]


def test_small_changes_flip_what_lies_at_the_margin_and_nothing_far_from_it(found):
    least = float(found.data["margins"].sel(column="slim", case="central", record="middle")["least_overturning"])
    close = assessed(columns=("slim",), records=RECORDS[1:2], scales=[0.5, 1.01 * least])
    flips = close.data["robustness"]["flips"].sel(column="slim", record="middle")
    assert flips.sel(scale=1.01 * least, change="scale -5 %").item() == 1
    assert (flips.sel(scale=0.5) == 0).all()
    assert int(close.data["summary"]["not_robust"].sel(column="slim", scale=1.01 * least)) == 1


def test_many_records_give_a_fragility_and_few_give_none(found):
    assert "fragility" not in found.data
    many = [record(f"record {place}", 2.0 + 0.6 * place, 1.0 + 0.1 * place) for place in range(4)]
    fitted = assessed(columns=("slim",), records=many, changes=(), least_records=4).data["fragility"]
    states = fitted.sel(column="slim")
    assert int(states.sel(limit_state="overturning")["runs"]) == 40  # the scan, and scale 1
    assert int(states.sel(limit_state="uplift")["runs_reached"]) >= int(
        states.sel(limit_state="overturning")["runs_reached"]
    )


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"dissipation": {}}, "dissipation is missing"),
        ({"dissipation": None}, "dissipation is missing"),
        ({"friction_coefficient": None}, "friction_coefficient is missing"),
        ({"dissipation": {"low": {"damping": 0.1}}}, "central and high must be stated too"),
        ({"dissipation": {**DISSIPATION, "high": {"restitution": 0.5}}}, "the same numbers at each level"),
        (
            {"dissipation": {level: {"restitution": 0.5} for level in DISSIPATION}},
            "the model slender has no restitution",
        ),
        ({"dissipation": {level: {"radius": 0.5} for level in DISSIPATION}}, "radius is none"),
        ({"friction_coefficient": 0.0}, "friction_coefficient must be positive"),
        ({"friction_coefficient": {"other": 0.5}}, "'other' is no column"),
        ({"scales": []}, "scales must be positive numbers"),
        ({"margin_scales": [1.0]}, "margin_scales must be positive numbers, 2 or more"),
        (
            {"columns": {"planar": sb.PlanarRocking(sb.Column.dimensionless(0.1))}},
            "must be a model of a column in space",
        ),
    ],
)
def test_what_cannot_be_assessed_is_one_line(change, told):
    arguments = {
        "columns": {"slim": model(0.2)},
        "records": RECORDS,
        "dissipation": DISSIPATION,
        "friction_coefficient": 0.6,
    } | change
    with pytest.raises(ParameterError, match=told) as caught:
        assess(arguments.pop("columns"), arguments.pop("records"), **arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_what_the_contact_must_bear_and_the_planar_answer_are_told():
    whole = assessed(columns=("slim",), contact=True, planar=True)
    verdicts = whole.data["verdicts"].sel(column="slim", dissipation="central", vertical="with", scale=0.5)
    run = sb.simulate(sb.Slender(model(0.2).column, damping=0.05), RECORDS[1].scaled(0.5), duration=4.0)
    if "largest_friction_demand" in run.measures:
        told = float(verdicts["friction_demand"].sel(record="middle"))
        assert told == pytest.approx(run.measures["largest_friction_demand"], rel=0.02)
    margins = whole.data["margins"].sel(column="slim", case="central")
    assert np.isfinite(margins["friction_demand"].sel(record="strong")).all()
    need, least = (margins[name].sel(record="strong") for name in ("friction_demand", "least_overturning"))
    below = need.where(need["margin_scale"] < least)
    assert float(margins["friction_to_margin"].sel(record="strong")) == pytest.approx(float(below.max()))
    slipping = need["margin_scale"].to_numpy()[need.to_numpy() > 0.6]
    told = float(margins["least_slipping"].sel(record="strong"))
    assert told == slipping[0] if slipping.size else np.isnan(told)
    assert set(whole.data["planar"].dims) == {"column", "record", "scale"}
    assert np.isfinite(float(whole.data["summary"]["friction_demand"].max()))
