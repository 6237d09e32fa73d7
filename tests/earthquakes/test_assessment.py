"""The assessment of columns: its answers are those of single runs, whatever the order, interrupted or not."""

import dataclasses
import itertools
import logging
import math
from functools import partial

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes import LogUniformSpread, UniformSpread, assess, incremental_dynamic_analysis
from stylobate.earthquakes.assessment import verdicts as planar
from stylobate.earthquakes.assessment.inputs import Inputs
from stylobate.earthquakes.assessment.margins import _in_band, governing_record
from stylobate.earthquakes.assessment.records import record_properties
from stylobate.earthquakes.assessment.report.column_verdict import VerdictClass, column_verdict
from stylobate.earthquakes.assessment.sliding import sliding_model
from stylobate.earthquakes.study_inputs import remark_on
from stylobate.errors import FileError, ParameterError, UnlikelyInputWarning
from stylobate.records.intensities import drifts
from stylobate.results import Assessment
from stylobate.results.verdict import word_of
from stylobate.studies.proportions import fraction_interval

pytestmark = pytest.mark.long

DISSIPATION = {"low": {"damping": 0.01}, "central": {"damping": 0.05}, "high": {"damping": 0.1}}


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
    options = {"variations": 0, "contact_laws": False, "planar": False, "contact": False} | more
    usual = {"dissipation": DISSIPATION, "friction_coefficient": 0.6, "scales": [0.5, 1.0], "tail": 2.0}
    return assess(
        {name: model(radii[name]) for name in columns},
        records,
        margin_scales=np.geomspace(0.5, 3.0, 9),
        **{**usual, **options},
    )


FULL = {"variations": 20, "contact_laws": True}


@pytest.fixture(scope="module")
def found():
    return assessed(**FULL)


def test_columns_have_their_own_levels_of_dissipation_and_words_are_numbers_of_the_column():
    own = {"high": {"damping": 0.9}, "low": {"damping": 0.2}, "central": {"damping": "housner"}}
    columns = {name: model(radius) for name, radius in (("slim", 0.2), ("stout", 0.45))}
    options = {"friction_coefficient": 0.6, "margin_scales": [0.5, 1.0], "planar": False, "tail": 1.0}
    options |= {"variations": 0, "contact_laws": False, "contact": False}
    found = assess(columns, RECORDS[:1], dissipation={**DISSIPATION, "stout": own}, **options)
    housner = columns["stout"].column.housner_damping()
    expected = {"low": {"damping": 0.2}, "central": {"damping": housner}, "high": {"damping": 0.9}}
    assert found.setting["dissipation"] == {"slim": DISSIPATION, "stout": expected}
    for name, levels in found.setting["dissipation"].items():
        alone = assess({name: columns[name]}, RECORDS[:1], dissipation=levels, **options)
        tilts = found.data["verdicts"]["tilt_ratio"].sel(column=[name])
        np.testing.assert_array_equal(tilts, alone.data["verdicts"]["tilt_ratio"])
        assert list(tilts["dissipation"].values) == list(DISSIPATION)
    rows = sb.earthquakes.assessment_tables(found)["dissipation"].rows
    assert ("stout", "central", "damping", f"{housner:.4g}") in rows


def test_verdicts_are_those_of_single_runs(found):
    verdicts = found.data["verdicts"]
    for name, one in (("strong", RECORDS[0]), ("weak", RECORDS[2])):
        for level, numbers in DISSIPATION.items():
            column = sb.Slender(model(0.2).column, **numbers)
            run = sb.simulate(column, one, duration=one.duration + 2.0)
            verdict = verdicts.sel(column="slim", record=name, dissipation=level, vertical="with", scale=1.0)
            assert int(verdict["overturned"]) == (run.outcome is sb.Outcome.OVERTURNED)
            if run.outcome is not sb.Outcome.OVERTURNED:
                ratio = run.measures["peak_tilt"] / column.column.tipping_angle
                assert float(verdict["tilt_ratio"]) == pytest.approx(ratio, rel=1e-5, abs=1e-9)


def test_the_setting_names_the_tail(found):
    assert found.setting["tail"] == 2.0
    free = assessed(columns=("slim",), records=RECORDS[2:], scales=[1.0], tail=None)
    assert (free.setting["tail"], free.setting["tail_over_p"]) == ("20/p", 20.0)


def test_what_always_overturns_and_what_never_moves_are_told_so(found):
    alone = assessed(columns=("slim",), records=RECORDS[:1], scales=[1.0])
    summary = alone.data["summary"].sel(column="slim", scale=1.0)
    assert (int(summary["overturned"]), int(summary["stood"])) == (1, 0)
    assert float(summary["least_overturning"]) <= 1.0
    quiet = found.data["verdicts"].sel(record="weak")
    assert (quiet["overturned"] == 0).all()
    assert (quiet["tilt_ratio"] == 0.0).all()
    margins = found.data["margins"].sel(record="weak")
    assert (margins["intervals"] == 0).all()
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
    other = assessed(columns=("stout", "slim"), records=RECORDS[::-1], **FULL)
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


@pytest.mark.slow
def test_interrupted_work_goes_on_where_it_was_and_computes_no_part_twice(found, tmp_path, caplog, monkeypatch):
    monkeypatch.setattr(planar, "_TOGETHER", 1)
    store = tmp_path / "store"
    work = partial(assessed, columns=("slim",), records=RECORDS[:2], store=store, **FULL)
    begun, again = [], []

    def stop(what, done, total):
        del done, total
        begun.append(what)
        # The second part of the small variations ends the first attempt.
        if len({name for name in begun if "small variations" in name}) == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work(progress=stop)
    kept = {path.name: path.stat().st_mtime_ns for path in store.glob("*.nc")}
    # Spectra, verdicts, margins at three levels with two contact laws, and the first part of the small variations.
    assert len(kept) == 9 == len(set(begun)) - 1
    whole = work(progress=lambda what, *_: again.append(what))
    assert {name: (store / name).stat().st_mtime_ns for name in kept} == kept
    assert set(begun) & set(again) == {begun[-1]}
    for name in ("verdicts", "margins", "variations"):
        expected = found.data[name].sel(column=["slim"], record=["middle", "strong"])
        xr.testing.assert_equal(whole.data[name], expected)
    assert not caplog.messages
    with caplog.at_level(logging.INFO, logger="stylobate"):
        work(progress=lambda *_: pytest.fail("computed again"))
    # Eight parts, two records at two scales, and the histories.
    assert caplog.messages == [f"13 of 13 parts were read from {store} and not computed again"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "parts"),
    [
        ({"variations": 5}, {"small variations"}),
        ({"seed": 1}, {"small variations"}),
        (
            {"records": [RECORDS[1].scaled(1.1)]},
            {"small", "margins", "spectra", "verdicts", "histories"},
        ),
        ({"dissipation": {**DISSIPATION, "high": {"damping": 0.2}}}, {"small", "margins", "verdicts", "histories"}),
    ],
)
def test_a_part_of_another_input_is_another_part(change, parts, tmp_path):
    usual = {"columns": ("slim",), "records": RECORDS[1:2], "scales": [1.0], "variations": 4, "store": tmp_path}
    assessed(**usual)
    seen = []
    assessed(**{**usual, **change}, progress=lambda what, *_: seen.append(what))
    assert all(any(part in name for part in parts) for name in seen), seen
    assert all(any(part in name for name in seen) for part in parts), seen


@pytest.mark.slow
def test_records_are_computed_some_at_a_time_and_the_whole_is_that_of_all_at_once(monkeypatch):
    few = partial(assessed, columns=("slim",), records=RECORDS[:2], planar=True, variations=4)
    announced = {"whole": [], "parts": []}
    whole = few(progress=lambda *one: announced["whole"].append(one))
    monkeypatch.setattr(planar, "_TOGETHER", 1)
    parts = few(progress=lambda *one: announced["parts"].append(one))
    for name in ("variations", "planar", "summary"):
        xr.testing.assert_equal(parts.data[name], whole.data[name])
        for one, array in whole.data[name].items():
            assert parts.data[name][one].attrs.get("long_name") == array.attrs.get("long_name")
    for which, records in (("whole", {"middle to strong"}), ("parts", {"strong", "middle"})):
        names, done, totals = zip(*announced[which], strict=True)
        for subject in ("planar", "small variations"):
            own = [name for name in names if name.startswith(f"slim: {subject}")]
            assert {name.rpartition(", ")[2] for name in own} == records
        # A column has one history or two; the other runs are known.
        assert done[-1] - 1 <= totals[-1] <= done[-1]
        # Two components and the three-dimensional column, two records, two scales.
        counts = [count for name, count, _ in announced[which] if name.startswith("slim: planar")]
        assert max(counts) - min(counts) == 12


def test_what_is_perhaps_in_another_unit_or_one_event_is_remarked():
    tower, column = (sb.Column.solid(radius=0.1 * height, height=height, density=2700.0) for height in (61.0, 6.0))
    with pytest.warns(UnlikelyInputWarning) as caught:
        remark_on({"tower": tower, "column": column}, ["Aigio", "aigio", "Kobe"])
    assert [str(one.message).partition(". ")[0] for one in caught] == [
        "tower: unlikely height (got 61 m)",
        "records: 'Aigio' and 'aigio' differ by case only and count as different records",
    ]


def test_a_height_that_is_not_given_is_judged_by_the_centre_of_mass():
    def body(height):
        """Return a column of inertias alone; the centre of mass of a solid one is half its height."""
        solid = sb.Column.solid(radius=0.1 * height, height=height, density=2700.0)
        return dataclasses.replace(solid, height=None)

    remark_on({"low": body(59.0)}, [])  # warnings are errors
    with pytest.warns(UnlikelyInputWarning, match=r"high: unlikely height of the centre of mass \(got 30\.5 m\)"):
        remark_on({"high": body(61.0)}, [])


def test_fewer_than_52_variations_leave_every_case_undecided():
    for overturned, word in ((0, "stands"), (1, "overturns")):
        for runs, expected in ((51, "undecided"), (52, word)):
            low, high = fraction_interval(overturned * runs, 0, runs, confidence=0.9)
            assert word_of(low, high).value == expected


BARE = {
    "contact_laws": True,
    "variations": 0,
    "seed": 0,
    "width": 1e-2,
    "tail": 2.0,
    "least_records": 20,
    "options": {},
}


def inputs_of(columns, records, **more):
    return Inputs.of(columns, records, DISSIPATION, 0.6, [1.0], [0.5, 1.0, 3.0], **{**BARE, **more})


RISING = sb.Record(
    samples=np.concatenate([RECORDS[1].samples[:, :2], 2.0 * np.hanning(101)[:, np.newaxis]], axis=-1),
    step=0.02,
    name="rising",
)


def overturned(column, motion, scales, vertical=True):
    runs = incremental_dynamic_analysis(column, motion, scales=scales, tail=2.0, vertical=vertical)
    return runs["reached"].sel(limit_state="overturning").values


def test_the_band_share_is_the_share_of_overturning_runs_at_41_scales_within_ten_percent():
    assessment = assessed(columns=("slim",), records=[RISING, RECORDS[1]], scales=[0.5, 1.3], contact_laws=True)
    shares = assessment.data["margins"]["band_share"].sel(column="slim")
    laws = {"": sb.Slender, ", other contact law": sb.SlenderRolling}
    cases = {
        f"{level}{law}": laws[law](model(0.2).column, **DISSIPATION[level]) for law in laws for level in DISSIPATION
    }
    cases["central, no vertical"] = cases["central"]
    assert sorted(shares["case"].values) == sorted(cases)
    for (case, column), record, scale in itertools.product(cases.items(), (RISING, RECORDS[1]), (0.5, 1.3)):
        near = overturned(column, record, scale * np.linspace(0.9, 1.1, 41), vertical=not case.endswith("vertical"))
        assert float(shares.sel(case=case, record=record.name, scale=scale)) == np.mean(near == 1)
    assert ((shares.sel(scale=1.3) > 0.0) & (shares.sel(scale=1.3) < 1.0)).any()
    assert (shares.sel(scale=0.5) == 0.0).all()
    other = shares.sel(case="central, no vertical", record="rising"), shares.sel(case="central", record="rising")
    assert not np.array_equal(*other)


def test_a_scale_that_overturns_between_the_41_is_within_ten_percent_too():
    inputs = inputs_of({"slim": model(0.2)}, [RECORDS[0]])
    near = inputs.margin_scales[inputs.around(1.0)]
    np.testing.assert_allclose(near, np.linspace(0.9, 1.1, 41), rtol=1e-9)
    intervals = {(near[3] * 1.001, near[3] * 1.002): 1, (near[-1] * 1.001, 3.0): 0, (0.5, near[0] * 0.999): 0}
    intervals |= {(near[-1], 3.0): 1, (0.5, near[0]): 1, (0.5, 3.0): 1, (np.nan, np.nan): 0}
    for (low, high), inside in intervals.items():
        margins = xr.Dataset({"interval_from": ("interval", [low]), "interval_to": ("interval", [high])})
        assert _in_band(inputs, margins).values.tolist() == [inside]


MARGINS = ("least_overturning", "least_lasting", "largest_below", "decided_to", "intervals", "unknown", "stands_again")
MARGINS = (
    *MARGINS,
    "outcome",
    "tilt_ratio",
    "band_share",
    "in_band",
    "interval_from",
    "interval_to",
    "safe_below",
    "safe_above",
)


def own_margins(assessment, column, record, **case):
    margins = assessment.data["margins"][list(MARGINS)].sel(column=column, record=record, **case, drop=True)
    return margins.dropna("interval", how="all")


# The kernel with contact demands rounds otherwise: tilts agree to the tolerance of the integration.
@pytest.mark.parametrize(("more", "rtol"), [({"planar": True}, 0.0), ({"contact": True}, 1e-8)])
def test_the_margin_of_a_record_depends_on_nothing_but_record_and_column(found, more, rtol):
    alone = assessed(columns=("slim",), records=RECORDS[1:2], **more)
    for level in DISSIPATION:
        own, expected = (own_margins(one, "slim", "middle", case=level) for one in (alone, found))
        xr.testing.assert_allclose(own, expected, rtol=rtol, atol=0.0)


def test_margins_with_the_other_contact_law_are_those_of_the_other_model(found):
    other = assess(
        {"slim": sb.SlenderRolling(model(0.2).column)},
        RECORDS[:2],
        dissipation=DISSIPATION,
        margin_scales=np.geomspace(0.5, 3.0, 9),
        friction_coefficient=0.6,
        scales=[0.5, 1.0],
        tail=2.0,
        contact=False,
        planar=False,
        variations=0,
    )
    for level, record in itertools.product(DISSIPATION, ("strong", "middle")):
        pair = level, f"{level}, other contact law"
        for mine, its in (pair, pair[::-1]):
            expected = own_margins(other, "slim", record, case=its)
            xr.testing.assert_equal(own_margins(found, "slim", record, case=mine), expected)
    tilts = found.data["margins"]["tilt_ratio"].sel(column="slim", record="middle")
    rolling = tilts.sel(case="central, other contact law")
    moving = np.isfinite(rolling) & (rolling > 0.1)
    assert (abs(rolling / tilts.sel(case="central") - 1.0) > 1e-3).where(moving, False).any()


def test_without_a_second_model_or_if_not_wanted_there_is_one_contact_law():
    class Own(sb.Slender):
        """A model of the user."""

    levels = tuple(DISSIPATION)
    both = tuple(f"{level}, other contact law" for level in levels)
    slim, own = model(0.2), Own(model(0.2).column)
    assert inputs_of({"slim": slim}, RECORDS).cases == (*levels, *both)
    assert inputs_of({"slim": slim}, RECORDS, contact_laws=False).cases == levels
    assert inputs_of({"slim": slim, "own": own}, RECORDS).cases == levels
    assert inputs_of({"slim": slim}, [RISING]).cases == (*levels, "central, no vertical", *both)


def check_shares(found, verdict):
    assert (float(found["share"]), str(found["word"].item())) == (verdict.share, verdict.word.value)
    assert (float(found["share_low"]), float(found["share_high"])) == verdict.interval
    assert found["deciding"].item() == verdict.deciding
    laws = dict(zip(found["contact_law"].values, found["law_share"].values, strict=True))
    assert laws == pytest.approx(dict(verdict.share_by_model), nan_ok=True)
    state = verdict.data["overturned"].values
    counts = [int(found[name]) for name in ("overturned", "open", "runs")]
    assert counts == [np.sum(state == 1), np.sum(state == -1), state.size]
    tilts = np.sort(verdict.data["tilt_ratio"].values[state >= 0])  # of the decided runs
    for name, at in (("low", 0.05), ("median", 0.5), ("high", 0.95)):
        assert float(found[f"tilt_ratio_{name}"]) == tilts[math.ceil(at * (tilts.size - 1))]


def test_shares_are_those_of_verdicts_with_the_damping_from_the_lowest_to_the_highest_level():
    # A further level, and the levels in no order: the damping varies over all of them.
    levels = {
        "low": {"damping": 0.02},
        "central": {"damping": 0.05},
        "high": {"damping": 0.1},
        "none": {"damping": 0.008},
    }
    more = {"records": RECORDS[:2], "columns": ("slim",), "dissipation": levels, "seed": 3}
    variations = {"dissipation": None, "damping": LogUniformSpread(0.008, 0.1)}
    assessment = assessed(scales=[0.5, 1.3], variations=30, contact_laws=True, **more)
    shares = assessment.data["variations"].sel(column="slim")
    column = sb.Slender(model(0.2).column, damping=0.05)
    for record, scale in itertools.product(RECORDS[:2], (0.5, 1.3)):
        verdict = sb.verdict(column, record.scaled(scale), variations=variations, runs=30, seed=3, tail=2.0)
        check_shares(shares.sel(record=record.name, scale=scale), verdict)
    assert 0.0 < float(shares["share"].sel(record="middle", scale=1.3)) < 1.0
    alone = assessed(scales=[1.3], variations=30, **more).data["variations"].sel(column="slim", scale=1.3)
    verdict = sb.verdict([column], RECORDS[1].scaled(1.3), variations=variations, runs=30, seed=3, tail=2.0)
    check_shares(alone.sel(record="middle"), verdict)
    assert list(alone["contact_law"].values) == ["slender"]


def test_a_level_without_damping_begins_the_range_and_a_column_varies_over_its_own_levels():
    free = {"low": {"damping": 0.0}, "central": {"damping": 0.05}, "high": {"damping": 0.1}}
    levels = {**DISSIPATION, "stout": free}
    assessment = assessed(records=RECORDS[:1], scales=[1.0], variations=20, dissipation=levels, tail=1.0)
    spreads = {"slim": LogUniformSpread(0.01, 0.1), "stout": UniformSpread(0.0, 0.1)}
    for (name, spread), radius in zip(spreads.items(), (0.2, 0.45), strict=True):
        column = sb.Slender(model(radius).column, damping=0.05)
        variations = {"dissipation": None, "damping": spread}
        verdict = sb.verdict([column], RECORDS[0], variations=variations, runs=20, tail=1.0)
        check_shares(assessment.data["variations"].sel(column=name, record="strong", scale=1.0), verdict)


def test_variations_disagree_near_the_margin_and_agree_far_from_it(found):
    least = float(found.data["margins"].sel(column="slim", case="central", record="middle")["least_overturning"])
    close = assessed(columns=("slim",), records=RECORDS[1:2], scales=[0.5, 1.005 * least, 2.5 * least], variations=60)
    shares = close.data["variations"].sel(column="slim", record="middle")
    assert list(shares["word"].values) == ["stands", "undecided", "overturns"]
    assert list(shares["share"].values[[0, 2]]) == [0.0, 1.0]
    assert list(close.data["summary"]["variations_disagree"].sel(column="slim").values) == [0, 1, 0]
    assert list(close.data["summary"]["undecided_word"].sel(column="slim").values) == [0, 1, 0]


def test_the_rest_threshold_is_an_option_of_all_runs():
    # Two bursts: what is left of the first when the second comes is forgotten, or not, by the threshold.
    time = 0.02 * np.arange(401)
    burst = np.where(time < 1.0, np.sin(np.pi * time) ** 2 * np.sin(3.0 * np.pi * time), 0.0)
    push = 2.8 * (burst + 0.8 * np.roll(burst, 150))
    twice = sb.Record(samples=np.stack([push, 0.4 * np.abs(push)], axis=-1), step=0.02, name="twice")
    column = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0))
    tilts = {}
    for value in (1e-2, 1e-7):
        found = assess(
            {"column": column},
            [twice],
            dissipation={level: {"damping": eta} for level, eta in (("low", 0.5), ("central", 0.6), ("high", 0.7))},
            friction_coefficient=0.6,
            margin_scales=[0.8, 1.0],
            variations=0,
            contact_laws=False,
            planar=False,
            contact=False,
            tail=2.0,
            rest_energy=value,
        )
        assert found.setting["options"] == {"rest_energy": repr(value)}
        own = found.data["verdicts"]["tilt_ratio"].sel(dissipation="central", vertical="with", scale=1.0).item()
        shown = found.data["histories"]["peak_tilt_ratio"].sel(run="stated").item()
        scanned = found.data["margins"]["tilt_ratio"].sel(case="central", margin_scale=1.0).item()
        assert own == pytest.approx(shown, rel=1e-7)
        assert own == pytest.approx(scanned, rel=1e-7)
        tilts[value] = own
        run = sb.simulate(sb.Slender(column.column, damping=0.6), twice, duration=10.0, rest_energy=value)
        assert own == pytest.approx(run.measures["peak_tilt"] / column.column.tipping_angle, rel=1e-5)
    assert abs(tilts[1e-2] - tilts[1e-7]) > 1e-3


LIFTING = sb.Record(
    samples=np.stack([RECORDS[1].samples[:, 0], RECORDS[1].samples[:, 1], 4.0 * np.hanning(101) * -1.0], axis=-1),
    step=0.02,
    name="lifting",
)


def test_runs_that_lift_off_are_undecided_and_end_what_is_known():
    assessment = assessed(columns=("slim", "stout"), records=[LIFTING], scales=[0.5, 2.9])
    # The base falls faster than g from the scale g / sup(−a_z) on.
    limit = 9.80665 / 4.0
    margins = assessment.data["margins"].sel(case="central", record="lifting")
    for column in ("slim", "stout"):
        own = margins.sel(column=column)
        decided = (own["outcome"] != sb.Outcome.LIFTED_OFF).values
        assert int(own["unknown"]) == np.count_nonzero(~decided) > 0
        last = float(own["decided_to"])
        assert limit <= float(own["undecided_to"][0]) == own["margin_scale"].values[-1]
        assert last == float(own["undecided_from"][0])
        # Edges are halved to 0.5 %; a column that overturned before the base falls is decided beyond the limit.
        assert last >= limit / 1.005
        assert np.isnan(float(own["safe_above"].max())) or float(own["safe_above"].max()) <= last
        assert (own["interval_to"].fillna(0.0) <= last).all()
    verdicts = assessment.data["verdicts"].sel(column="stout", dissipation="central", vertical="with", record="lifting")
    assert int(verdicts["overturned"].sel(scale=2.9)) == -1
    assert sb.Outcome(int(verdicts["outcome"].sel(scale=2.9))) is sb.Outcome.LIFTED_OFF
    summary = assessment.data["summary"].sel(column="stout")
    assert (int(summary["undecided"].sel(scale=2.9)), int(summary["stood"].sel(scale=2.9))) == (1, 0)
    assert int(summary["scan_undecided"]) == 1
    assert float(summary["decided_to"]) == float(margins["decided_to"].sel(column="stout"))


def test_variations_and_near_scales_that_lift_off_are_counted_as_open():
    # 2.4 stays below the limit 2.45 from which on the base falls faster than g; 5 % more does not.
    calm = sb.Record(samples=LIFTING.samples * (0.05, 0.05, 1.0), step=LIFTING.step)
    assessment = assessed(columns=("stout",), records={"calm": calm}, variations=40, scales=[2.4])
    shares = assessment.data["variations"].isel(column=0, scale=0, record=0)
    assert (int(shares["overturned"]), float(shares["share"])) == (0, 0.0)
    assert 0 < int(shares["open"]) < 40
    # Each undecided run might have overturned.
    assert float(shares["share_high"]) > int(shares["open"]) / 40
    assert np.isfinite(float(shares["tilt_ratio_high"]))
    assert shares["word"].item() == "undecided"
    band = assessment.data["margins"]["band_share"].isel(column=0, scale=0, record=0)
    assert (band == 0.0).all()  # of the decided ones
    found = column_verdict(assessment, "stout", 2.4)
    assert found.verdict is VerdictClass.OPEN
    assert "a small variation was not decided under calm" in found.sentence
    assert "not every scale within 10 % was decided (only up to 2.45)" in found.sentence


def test_the_margin_is_drawn_by_its_two_runs_and_the_stated_one(found):
    runs, margins = found.data["histories"].sel(column="slim"), found.data["margins"].sel(column="slim", case="central")
    own = margins.sel(record=found.data["summary"]["governing"].sel(column="slim").item())
    stands, overturns = runs.sel(run="stands"), runs.sel(run="overturns")
    assert float(overturns["scale"]) == float(own["least_overturning"])
    assert (int(overturns["overturned"]), float(overturns["peak_tilt_ratio"])) == (1, np.inf)
    if np.isfinite(float(own["largest_below"])):
        assert float(stands["scale"]) == float(own["largest_below"])
        assert int(stands["overturned"]) == 0
    assert float(runs["scale"].sel(run="stated")) == 1.0
    never = found.data["histories"].sel(column="stout")
    if (found.data["margins"]["intervals"].sel(column="stout") == 0).all():
        assert np.isnan(never["scale"].sel(run="overturns"))
        assert float(never["scale"].sel(run="stands")) == found.data["margins"]["margin_scale"].values[-1]
        assert float(never["peak_tilt_ratio"].sel(run="stands")) > 0.0


def judged(states, least, tilt):
    """Return verdicts and margins of the records a, b, c, in a case at low and one at central dissipation."""
    records = ["a", "b", "c"]
    levels = {"record": records, "dissipation": ["low", "central"], "vertical": ["with"], "scale": [1.0]}
    dims = tuple(levels)
    verdicts = xr.Dataset(
        {
            "overturned": (dims, np.array(states).reshape(3, 2, 1, 1)),
            "tilt_ratio": (dims, np.repeat(tilt, 2).reshape(3, 2, 1, 1).astype(float)),
        },
        levels,
    )
    margins = xr.Dataset(
        {
            "least_overturning": (("record", "case"), np.array(least, dtype=float)),
            "tilt_ratio": (("case", "record", "margin_scale"), np.zeros((2, 3, 1))),
        },
        {"record": records, "case": ["low", "central"]},
    )
    return verdicts, margins


@pytest.mark.parametrize(
    ("states", "least", "governs"),
    [
        # b overturned as recorded; a has a lower least scale in a narrow interval.
        ([[0, 0], [1, 1], [0, 0]], [[0.7, 0.7], [0.9, 0.9], [1.2, 1.2]], "b"),
        # b overturned as recorded at low dissipation only; a not as recorded.
        ([[0, 0], [1, 0], [0, 0]], [[0.7, 0.7], [0.9, 1.4], [1.2, 1.2]], "b"),
        # c overturned as recorded in the central case, b at low dissipation.
        ([[0, 0], [1, 0], [1, 1]], [[0.7, 0.7], [0.5, 1.4], [0.9, 0.95]], "c"),
        # None as recorded: the least scale.
        ([[0, 0], [0, 0], [0, 0]], [[np.nan, np.nan], [2.0, 2.5], [1.9, 2.6]], "b"),
        # None at all: the peak tilt.
        ([[0, 0], [0, 0], [0, -1]], [[np.nan, np.nan]] * 3, "b"),
    ],
)
def test_a_record_that_overturned_as_recorded_governs_before_one_that_did_not(states, least, governs):
    verdicts, margins = judged(states, least, [0.1, 0.2, np.nan])
    assert governing_record(verdicts, margins, 0) == governs


def test_a_column_whose_friction_is_below_its_slenderness_slides_before_it_rocks():
    # c is 0.2 and 0.45, the friction 0.3: the stout one slides.
    assessment = assessed(friction_coefficient=0.3, records=RECORDS[:2], scales=[1.0])
    assert assessment.data["summary"]["slides_first"].sel(column=["slim", "stout"]).values.tolist() == [0, 1]
    margins = assessment.data["margins"]
    assert margins["standing_slip"].sel(column="slim").isnull().all()
    for record in RECORDS[:2]:
        own = margins.sel(column="stout", record=record.name, case="central")
        push = np.hypot(*record.samples[:, :2].T).max()
        assert float(own["standing_slip"]) == pytest.approx(0.3 * 9.80665 / push, rel=1e-12)
        inside = float(own["standing_slip"]) <= margins["margin_scale"].values[-1]
        assert float(own["least_slipping"]) == float(own["standing_slip"]) if inside else True


@pytest.mark.slow
def test_what_slides_first_is_followed_by_the_model_that_slides():
    # 0.3 g needs 2.94 m/s²: the weak record never gets there.
    assessment = assessed(friction_coefficient=0.3, records=[RECORDS[0], RECORDS[2]], scales=[1.0], sliding=True)
    sliding = assessment.data["sliding"].isel(scale=0)
    assert (sliding["overturned"].sel(column="slim") == -1).all()
    strong, weak = (sliding.sel(column="stout", record=name) for name in ("strong", "weak"))
    assert float(weak["slip_path"]) == float(weak["peak_slip"]) == float(weak["time_sliding"]) == 0.0
    assert float(strong["slip_path"]) >= float(strong["peak_slip"]) >= float(strong["residual_slip"]) > 0.0
    assert 0.0 < float(strong["time_sliding"]) < 4.0
    assert int(strong["overturned"]) in (0, 1)
    assert assessment.setting["sliding"] is True


def test_the_model_that_slides_has_the_dissipation_of_the_column_stated_or_not():
    column = model(0.45).column
    slid = sliding_model(sb.Wobbling(column, damping=0.05, rolling_resistance=0.01, restitution=0.9), 0.3)
    assert (slid.damping, slid.rolling_resistance, slid.friction_coefficient) == (0.05, 0.01, 0.3)
    assert sliding_model(sb.Slender(column, damping=0.02), 0.3).damping == 0.02


def test_a_record_drifts_where_one_of_its_components_does():
    # 0.00056 m/s² over ten seconds leave 7 % of the PGV along y, 0.5/2π, and 3 % of that of the vector.
    wave = np.cos(0.02 * np.pi * np.arange(1001))
    straight, leaning = (
        sb.Record(samples=np.stack([wave, 0.5 * wave + offset], axis=-1), step=0.01) for offset in (0.0, 5.6e-4)
    )
    inputs = Inputs.of(
        {"slim": model(0.2)},
        {"leaning": leaning, "straight": straight},
        DISSIPATION,
        0.6,
        [1.0],
        [0.5, 1.0],
        **BARE,
    )
    found = record_properties(inputs)
    assert found["drifts"].sel(record=["leaning", "straight"]).values.tolist() == [1, 0]
    assert float((found["residual_velocity"] / found["peak_velocity"]).max()) < 0.05
    assert [bool(drifts(one)) for one in (leaning, straight)] == [True, False]


def test_many_records_give_a_fragility_and_few_give_none(found):
    assert "fragility" not in found.data
    many = [record(f"record {place}", 2.0 + 0.6 * place, 1.0 + 0.1 * place) for place in range(4)]
    fitted = assessed(columns=("slim",), records=many, least_records=4).data["fragility"]
    states = fitted.sel(column="slim")
    assert states["curve_intensity"].attrs["component"] == states["median"].attrs["component"] == "RotD50"
    assert int(states.sel(limit_state="overturning")["runs"]) == 36  # nine scales
    assert int(states.sel(limit_state="tilt 0.001 α")["runs_reached"]) >= int(
        states.sel(limit_state="overturning")["runs_reached"]
    )
    # Runs near the stated scales would give these scales more weight.
    xr.testing.assert_identical(
        fitted, assessed(columns=("slim",), records=many, least_records=4, scales=[0.8]).data["fragility"]
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"dissipation": {}}, "dissipation is missing"),
        ({"dissipation": None}, "dissipation is missing"),
        ({"friction_coefficient": None}, "friction_coefficient is missing"),
        ({"dissipation": {"low": {"damping": 0.1}}}, "central and high must be stated too"),
        ({"dissipation": {"slin": DISSIPATION}}, "dissipation: 'slin' is no column; did you mean slim"),
        (
            {
                "dissipation": {"slim": DISSIPATION, "low": {"damping": 0.1}},
                "columns": {"slim": model(0.2), "a": model(0.3)},
            },
            "central and high must be stated too for 'a'",
        ),
        (
            {"dissipation": {**DISSIPATION, "low": {"damping": "hausner"}}},
            "dissipation.low.damping must be a real number",
        ),
        ({"dissipation": {**DISSIPATION, "high": {"restitution": 0.5}}}, "the same parameters at each level"),
        (
            {"dissipation": {level: {"restitution": 0.5} for level in DISSIPATION}},
            "the model slender has no restitution",
        ),
        ({"dissipation": {level: {"radius": 0.5} for level in DISSIPATION}}, "radius is no parameter of dissipation"),
        ({"friction_coefficient": 0.0}, "friction_coefficient must be positive"),
        ({"friction_coefficient": {"other": 0.5}}, "'other' is no column"),
        ({"scales": []}, "scales must be positive numbers"),
        ({"variations": -1}, "variations must be a whole number of at least 0"),
        ({"variations": 1}, "variations: must be 0 or at least 2 .got 1.. Pass a few hundred"),
        ({"seed": -1}, "seed must be a whole number of at least 0"),
        ({"margin_scales": [1.0]}, "margin_scales must be positive numbers, 2 or more"),
        (
            {"columns": {"planar": sb.PlanarRocking(sb.Column.dimensionless(0.1))}},
            "must be a three-dimensional model",
        ),
    ],
)
def test_what_cannot_be_assessed_is_one_line(change, message):
    arguments = {
        "columns": {"slim": model(0.2)},
        "records": RECORDS,
        "dissipation": DISSIPATION,
        "friction_coefficient": 0.6,
    } | change
    with pytest.raises(ParameterError, match=message) as caught:
        assess(arguments.pop("columns"), arguments.pop("records"), **arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_what_the_contact_must_bear_and_the_planar_answer_are_told():
    whole = assessed(columns=("slim",), contact=True, planar=True)
    verdicts = whole.data["verdicts"].sel(column="slim", dissipation="central", vertical="with", scale=0.5)
    run = sb.simulate(sb.Slender(model(0.2).column, damping=0.05), RECORDS[1].scaled(0.5), duration=4.0)
    if "peak_friction_demand" in run.measures:
        value = float(verdicts["friction_demand"].sel(record="middle"))
        assert value == pytest.approx(run.measures["peak_friction_demand"], rel=0.02)
    margins = whole.data["margins"].sel(column="slim", case="central")
    assert np.isfinite(margins["friction_demand"].sel(record="middle")).all()
    need, least = (margins[name].sel(record="middle") for name in ("friction_demand", "least_overturning"))
    below = need.where(need["margin_scale"] < least)
    assert float(margins["friction_to_margin"].sel(record="middle")) == pytest.approx(float(below.max()))
    slipping = need["margin_scale"].to_numpy()[need.to_numpy() > 0.6]
    value = float(margins["least_slipping"].sel(record="middle"))
    assert value == slipping[0] if slipping.size else np.isnan(value)
    assert set(whole.data["planar"].dims) == {"column", "record", "scale"}
    assert np.isfinite(float(whole.data["summary"]["friction_demand"].max()))
