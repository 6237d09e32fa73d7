"""Inventories: numbers of each object as computed by themselves, intervals, order of rows, resumption, sites, rates."""

import zlib
from dataclasses import replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import (
    HazardCurve,
    InventoryObject,
    InventorySite,
    LognormalSpread,
    NormalSpread,
    empirical_rate,
    export_inventory,
    incremental_dynamic_analysis,
    inventory,
)
from stylobate.earthquakes.inventories import runs as runs_of_inventory
from stylobate.earthquakes.property_spreads import shares_of
from stylobate.errors import ConfigError, Interrupted, Outcome, ParameterError, UnlikelyInputWarning
from stylobate.results.storage import write_netcdf

TILTS = np.array([1e-3, 0.1, 0.5, 1.0])


def quake(place, peak=4.0):
    rng = np.random.default_rng(place)
    times = 0.02 * np.arange(200)
    shape = (times * np.exp(1.0 - times))[:, np.newaxis]
    noise = sb.Record(samples=peak * shape * rng.normal(size=(200, 2)), step=0.02, name=f"quake {place}")
    return noise.filtered(lowpass=4.0)


QUAKES = [quake(place) for place in range(5)]
SLIM = InventoryObject(
    name="slim",
    column={"radius": 0.1, "height": 1.4, "density": 2700.0},
    model={"damping": 0.05},
    friction_coefficient=0.6,
    spreads={"radius": NormalSpread(0.01), "height": LognormalSpread(0.05), "damping": LognormalSpread(0.4)},
    carried={"room": "12"},
)
TUBE = InventoryObject(
    name="tube",
    column={"radius": 0.12, "inner_radius": 0.1, "height": 1.2, "density": 2300.0},
    model={"damping": "housner"},
    friction_coefficient=0.5,
    spreads={"inner_radius": NormalSpread(0.003)},
)
STOUT = InventoryObject(
    name="stout",
    column={"radius": 0.2, "height": 0.9, "density": 2000.0},
    model={"damping": 0.05},
    friction_coefficient=0.6,
)
OBJECTS = [STOUT, SLIM, TUBE]
TAIL = 3.0


def ranked(objects=OBJECTS, sites=QUAKES, **more):
    return inventory(objects, sites, **{"samples": 4, "tail": TAIL, "progress": False, **more})


def drawn(one, number, nominal, records, samples, seed):
    """Return the samples of a number over record and sample."""
    shares = shares_of(f"{one.name}: {number}", runs=records * samples, seed=seed)
    return one.spreads[number].draw(nominal, shares).reshape(records, samples)


def test_probabilities_and_tilts_are_those_of_an_analysis_of_each_sample():
    samples, seed = 4, 7
    found = ranked(samples=samples, seed=seed, scales=[0.5, 1.0]).sel(object="slim")
    radius, height, damping = (
        drawn(SLIM, name, nominal, len(QUAKES), samples, seed)
        for name, nominal in (("radius", 0.1), ("height", 1.4), ("damping", 0.05))
    )
    reached, tilts = np.empty((5, 2, len(QUAKES), samples)), np.empty((2, len(QUAKES), samples))
    for r, motion in enumerate(QUAKES):
        for s in range(samples):
            body = sb.Column.solid(radius=radius[r, s], height=height[r, s], density=2700.0)
            own = incremental_dynamic_analysis(
                sb.Wobbling(body, damping=damping[r, s]), motion, scales=[0.5, 1.0], tail=TAIL, demands=True
            )
            reached[:, :, r, s] = own["reached"] == 1
            tilts[:, r, s] = own["tilt_ratio"]
    assert 0.0 < reached[-1, 1].mean() < 1.0
    np.testing.assert_array_equal(found["probability"], reached.mean(axis=-1).mean(axis=-1))
    ordered = np.sort(tilts.reshape(2, -1))
    np.testing.assert_allclose(found["tilt_median"], ordered[:, 9], rtol=1e-9)  # the 10th of 20
    np.testing.assert_allclose(found["tilt_84"], ordered[:, 16], rtol=1e-9)  # the 17th: 16.8 of 20


def test_a_certain_object_has_one_run_for_each_record_as_computed_by_itself():
    found = ranked(scales=[2.0]).sel(object="stout")
    model = sb.Wobbling(sb.Column.solid(radius=0.2, height=0.9, density=2000.0), damping=0.05)
    runs = [
        sb.simulate_ensemble(model, motion.scaled(2.0), duration=motion.duration + TAIL, demands=True)
        for motion in sorted(QUAKES, key=lambda one: one.name)
    ]
    assert int(found["runs"]) == len(QUAKES)
    tilt = np.array([one["peak_tilt"].item() for one in runs]) / np.arctan(model.column.slenderness)
    fallen = np.array([one["outcome"].item() == Outcome.OVERTURNED for one in runs])
    expected = [np.mean(fallen | (tilt > one)) for one in TILTS] + [fallen.mean()]
    np.testing.assert_array_equal(found["probability"].isel(scale=0), expected)
    demands = np.sort([one["peak_friction_demand"].item() for one in runs])
    np.testing.assert_allclose(found["friction_demand_median"], demands[2], rtol=1e-6)
    assert found["slip_share"].item() == np.mean(demands > 0.6)


def test_the_order_of_rows_and_other_objects_change_no_number():
    found, other = ranked(), ranked(OBJECTS[::-1], QUAKES[::-1])
    assert found.identical(other)
    alone = ranked([TUBE])
    for name in ("probability", "tilt_84", "friction_demand_median", "probability_high"):
        np.testing.assert_array_equal(found[name].sel(object="tube"), alone[name].sel(object="tube"))


def test_objects_are_ranked_by_probability_then_by_tilt():
    found = ranked()
    chosen = found["probability"].sel(limit_state="overturning", scale=1.0).to_numpy()
    tilt = found["tilt_median"].sel(scale=1.0).to_numpy()
    assert sorted(zip(-chosen, -tilt, strict=True)) == list(zip(-chosen, -tilt, strict=True))
    assert found["rank"].to_numpy().tolist() == [1, 2, 3]
    by_tilt = ranked(limit_state="tilt 0.1 α")["probability"].sel(limit_state="tilt 0.1 α", scale=1.0)
    assert np.all(np.diff(by_tilt) <= 0.0)


def test_objects_that_are_equal_share_a_rank():
    twins = [replace(SLIM, name=name, spreads={}) for name in ("b", "a")]
    found = ranked([*twins, STOUT])
    assert dict(zip(found["object"].values.tolist(), found["rank"].values.tolist(), strict=True)) == {
        "a": 1,
        "b": 1,
        STOUT.name: 3,
    }


def test_intervals_contain_the_probability_and_shrink_with_records():
    few = ranked([SLIM], QUAKES[:2])
    many = ranked([SLIM], [quake(place) for place in range(12)])
    width = {}
    for name, one in (("few", few), ("many", many)):
        low, middle, high = (one[f"probability{end}"] for end in ("_low", "", "_high"))
        assert bool(((low <= middle) & (middle <= high)).all())
        width[name] = (high - low).sel(limit_state="overturning").item()
    assert width["many"] < 0.75 * width["few"]


def test_an_object_that_slides_before_it_rocks_has_no_rank_and_no_probability():
    slippery = replace(SLIM, name="slippery", friction_coefficient=0.1)  # r/h = 0.143
    found = ranked([STOUT, slippery])
    assert found["object"].to_numpy().tolist()[-1] == "slippery"
    one = found.sel(object="slippery", scale=1.0)
    assert float(one["friction_demand_median"]) > 0.1
    share = float(one["sliding_share"])
    shape = (len(QUAKES), 4, 0)
    c = 2.0 * drawn(slippery, "radius", 0.1, *shape) / drawn(slippery, "height", 1.4, *shape)
    assert 0.5 < share == np.mean(c > 0.1)
    assert int(one["rank"]) == 0
    assert np.isnan(one["probability"].sel(limit_state="overturning"))
    least, most = (float(one[f"probability_{end}"].sel(limit_state="overturning")) for end in ("least", "most"))
    assert most - least == pytest.approx(share, abs=1e-12)


def test_a_run_that_needs_less_friction_than_it_has_neither_slides_nor_rocks():
    weak = [quake(place, peak=0.05) for place in range(3)]
    found = ranked([replace(SLIM, friction_coefficient=0.1)], weak).isel(object=0, scale=0)
    assert float(found["friction_demand_84"]) < 0.1 < float(found["slenderness"])
    assert found["probability_most"].to_numpy().tolist() == [0.0] * 5
    assert (int(found["rank"]), float(found["sliding_share"]), float(found["slip_share"])) == (1, 0.0, 0.0)


def test_undecided_runs_widen_the_bounds_and_withhold_the_probability():
    found = ranked([SLIM], max_steps=10).sel(object="slim", scale=1.0, limit_state="overturning")
    assert float(found["undecided_share"]) > 0.05
    assert np.isnan(found["probability"])
    width = float(found["probability_most"] - found["probability_least"])
    assert width == pytest.approx(float(found["undecided_share"]))
    assert float(found["probability_low"]) <= float(found["probability_least"])
    assert float(found["probability_high"]) >= float(found["probability_most"])


HAZARD = HazardCurve(
    intensity=[0.5, 2.0, 8.0, 30.0],
    rate=[2e-2, 2e-3, 1e-4, 2e-6],
    units="m s-2",
    component="RotD50",
    quantity="peak ground acceleration",
)


def test_annual_rates_are_those_counted_from_the_runs_of_the_object():
    scales = np.geomspace(0.5, 3.0, 4)
    site = InventorySite(records=QUAKES, hazard=HAZARD)
    found = ranked([replace(STOUT, column={"radius": 0.1, "height": 1.2, "density": 2000.0})], site, scales=scales)
    assert found.attrs["ranked_by"] == "annual_rate"
    model = sb.Wobbling(sb.Column.solid(radius=0.1, height=1.2, density=2000.0), damping=0.05)
    runs = incremental_dynamic_analysis(model, QUAKES, scales=scales, tail=TAIL, demands=True)
    rng = np.random.default_rng((0, zlib.crc32(b"stout")))
    own = empirical_rate(runs["intensity"], runs["reached"], HAZARD, record=runs["record"], rng=rng)
    for name in ("annual_rate", "rate_low", "rate_high", "rate_least", "rate_most"):
        np.testing.assert_allclose(found[name].isel(object=0), own[name], rtol=1e-12, err_msg=name)
    assert found["annual_rate"].sel(limit_state="overturning").item() > 0.0


def test_each_object_meets_the_records_of_its_site():
    sites = {
        "hill": InventorySite(records=QUAKES[:2]),
        "plain": InventorySite(records=[quake(place, peak=0.5) for place in range(3)]),
    }
    objects = [replace(SLIM, name="above", site="hill"), replace(SLIM, name="below", site="plain")]
    found = ranked(objects, sites)
    assert found["object"].to_numpy().tolist() == ["above", "below"]
    assert found["runs"].to_numpy().tolist() == [8, 12]
    above = ranked([replace(SLIM, name="above", site="of no importance with one site")], QUAKES[:2])
    assert above["site"].item().startswith("of no importance")
    np.testing.assert_array_equal(found["probability"].sel(object="above"), above["probability"].sel(object="above"))


def test_an_interrupted_study_resumes_to_the_same_bytes(tmp_path, monkeypatch):
    monkeypatch.setattr(runs_of_inventory, "_BLOCK", 1)  # each object is a block
    whole = ranked()

    def stop(done, total):
        if done > 20:  # after the 20 runs of the first object
            raise KeyboardInterrupt

    with pytest.raises(Interrupted, match=r"stopped after \d of 3 objects; the same call with store="):
        ranked(store=tmp_path / "store", progress=stop)
    kept = list((tmp_path / "store").glob("*.nc"))
    assert 0 < len(kept) < 3
    before = {path: path.stat().st_mtime_ns for path in kept}
    files = []
    for found, name in ((ranked(store=tmp_path / "store"), "resumed"), (whole, "whole")):
        write_netcdf(found, tmp_path / f"{name}.nc")
        export_inventory(found, tmp_path / f"{name}.csv")
        files.append([(tmp_path / f"{name}{end}").read_bytes() for end in (".nc", ".csv")])
    assert files[0] == files[1]
    assert {path: path.stat().st_mtime_ns for path in kept} == before
    assert sb.load(tmp_path / "resumed.nc").identical(whole)


def test_a_change_of_one_row_computes_that_object_only(tmp_path):
    ranked(store=tmp_path)
    known = set(tmp_path.glob("*.nc"))
    thicker = replace(TUBE, column={**TUBE.column, "inner_radius": 0.09})
    ranked([STOUT, SLIM, replace(thicker, friction_coefficient=0.4)], store=tmp_path)
    assert [path.name[:5] for path in set(tmp_path.glob("*.nc")) - known] == ["tube-"]
    again = set(tmp_path.glob("*.nc"))
    ranked([replace(SLIM, friction_coefficient=0.3)], store=tmp_path, confidence=0.9)  # evaluated, not computed
    assert set(tmp_path.glob("*.nc")) == again


def test_blocks_of_any_size_give_the_same_numbers(monkeypatch):
    whole = ranked()
    monkeypatch.setattr(runs_of_inventory, "_BLOCK", 25)
    assert ranked(executor=sb.studies.Threads(1)).identical(whole)


@pytest.mark.parametrize(
    ("objects", "line"),
    [
        (
            [replace(SLIM, where="t.csv, row 3"), replace(SLIM, where="t.csv, row 9")],
            "t.csv, row 9: the name 'slim' is",
        ),
        ([replace(SLIM, site="hil")], "object 'slim': site: unknown (got 'hil'); did you mean hill?"),
        ([replace(SLIM, friction_coefficient=0.0)], "object 'slim': friction_coefficient must be positive, got 0.0"),
        ([replace(SLIM, model={"dampin": 0.1}, spreads={})], "object 'slim': dampin does not belong to model"),
        ([replace(SLIM, spreads={"heigth": LognormalSpread(0.1)})], "spread of heigth: the object has no such number"),
        ([replace(SLIM, spreads={"height": 0.1})], "spread of height: must be a distribution (got 0.1)"),
        ([replace(TUBE, spreads={"radius": NormalSpread(0.05)})], "radius_spread: a sample is impossible"),
        ([replace(SLIM, model={"constraint": "rubber"}, spreads={})], "constraint: must be a number (got 'rubber')"),
    ],
)
def test_an_invalid_object_has_a_line_and_nothing_is_computed(objects, line):
    sites = {"hill": InventorySite(records=QUAKES[:1])}
    with pytest.raises(ConfigError) as error:
        ranked(objects, sites, samples=20)
    assert any(line in one for one in error.value.problems), error.value.problems


def test_all_invalid_objects_are_listed_at_once():
    bad = [replace(SLIM, name=f"bad {place}", friction_coefficient=-1.0) for place in range(3)]
    with pytest.raises(ConfigError) as error:
        ranked([STOUT, *bad])
    assert len(error.value.problems) == 3


@pytest.mark.parametrize(
    ("more", "line"),
    [
        ({"model": "sliding"}, "model: must be three-dimensional with permanent contact"),
        ({"model": "planar_rocking"}, "model: must be three-dimensional"),
        ({"limit_state": "tilt 0.5"}, "limit_state: unknown (got 'tilt 0.5'); did you mean tilt 0.5 α?"),
        ({"scales": []}, "scales: must be positive numbers"),
        ({"samples": 0}, "samples"),
        ({"tilt_limit": 0.1}, "tilt_limit must be left out"),
        ({"sites": InventorySite(records=QUAKES, hazard=HAZARD)}, "scales: a hazard curve needs two or more"),
    ],
)
def test_an_argument_out_of_range_is_refused(more, line):
    with pytest.raises(ParameterError, match="^" + line.partition(" (")[0].replace(".", r"\.")):
        ranked(**more)


def test_an_unlikely_number_is_questioned_with_its_row():
    long = replace(STOUT, column={"radius": 40.0, "height": 90.0, "density": 2000.0}, where="t.csv, row 4")
    with pytest.warns(UnlikelyInputWarning, match=r"^t\.csv, row 4: radius"):
        ranked([long], QUAKES[:1])
