"""Counts of an assessment's summary: those of a reader who goes through the verdicts record by record."""

import itertools
import math

import numpy as np
import pytest
import xarray as xr

from stylobate import Outcome
from stylobate.earthquakes.assessment.assess import summary_of

COLUMNS, SCALES, RECORDS = ("slim", "stout"), (0.5, 1.0), tuple("ABCDEFGHIJKL")
LEVELS, ACTS = ("low", "central", "high"), ("with", "without")
OTHERS = tuple(f"{level}, other contact law" for level in LEVELS)
CASES = (*LEVELS, "central, no vertical", *OTHERS)
SCAN = (0.3, 0.5, 0.501, 1.0, 2.0)
WORDS = ("stands", "undecided", "overturns")


def random_assessment(seed):
    """Return the parts of an assessment with outcomes of all kinds: 0 stood, 1 overturned, −1 not decided."""
    rng = np.random.default_rng(seed)
    runs = {"column": COLUMNS, "scale": SCALES, "record": RECORDS, "dissipation": LEVELS, "vertical": ACTS}
    margins = {"column": COLUMNS, "case": CASES, "record": RECORDS}

    def drawn(over, values, probabilities):
        shape = tuple(map(len, over.values()))
        return xr.DataArray(rng.choice(values, shape, p=probabilities), coords={k: list(v) for k, v in over.items()})

    def numbers(over, missing=0.0):
        shape = tuple(map(len, over.values()))
        values = np.where(rng.random(shape) < missing, np.nan, rng.uniform(0.2, 3.0, shape))
        return xr.DataArray(values, coords={k: list(v) for k, v in over.items()})

    each = {name: runs[name] for name in ("column", "scale", "record")}
    tilts, overturned = numbers(each, 0.2), drawn(each, (0, 3, 20), (0.3, 0.4, 0.3))
    outcomes = (Outcome.AT_REST, Outcome.OVERTURNED, Outcome.LIFTED_OFF)
    scan, near = {**margins, "margin_scale": SCAN}, {**margins, "scale": SCALES}
    return {
        "verdicts": xr.Dataset(
            {
                "overturned": drawn(runs, (-1, 0, 1), (0.1, 0.7, 0.2)),
                "uncertain": drawn(runs, (0, 1), (0.9, 0.1)),
                "tilt_ratio": numbers(runs),
                "friction_demand": numbers(runs),
            }
        ),
        "margins": xr.Dataset(
            {
                "least_overturning": numbers(margins, 0.5),
                "least_slipping": numbers(margins, 0.7),
                "standing_slip": numbers(margins, 0.97),
                "friction_to_margin": numbers(margins),
                "intervals": drawn(margins, (0, 1, 2), (0.4, 0.4, 0.2)),
                "stands_again": drawn(margins, (0, 1, 2), (0.4, 0.4, 0.2)),
                "unknown": drawn(margins, (0, 1, 2), (0.4, 0.4, 0.2)),
                "decided_to": numbers(margins, 0.04),
                "outcome": drawn(scan, [int(one) for one in outcomes], (0.9, 0.05, 0.05)),
                "in_band": drawn(near, (0, 1), (0.95, 0.05)),
            }
        ),
        "variations": xr.Dataset(
            {
                "overturned": overturned,
                "runs": xr.full_like(overturned, 20),
                "word": drawn(each, WORDS, (0.4, 0.3, 0.3)),
            }
        ),
        "planar": xr.Dataset({"planar_tilt_ratio": tilts.where(tilts < 2.0, np.inf).where(tilts.notnull())}),
    }


@pytest.fixture(scope="module", params=[1, 2])
def assessment(request):
    parts = random_assessment(request.param)
    return parts, summary_of(parts, ["C", ""])


def test_records_are_counted_by_their_outcomes(assessment):
    parts, summary = assessment
    seen = set()
    for column, scale in itertools.product(COLUMNS, SCALES):
        at = {"column": column, "scale": scale}
        state, unsure = ({} for _ in range(2))
        for record, level, acts in itertools.product(RECORDS, LEVELS, ACTS):
            run = parts["verdicts"].sel(at | {"record": record, "dissipation": level, "vertical": acts})
            state[record, level, acts], unsure[record, level, acts] = int(run["overturned"]), int(run["uncertain"])
        central = {record: state[record, "central", "with"] for record in RECORDS}
        of = {record: [value for (name, *_), value in state.items() if name == record] for record in RECORDS}
        levels = {record: {state[record, level, "with"] for level in LEVELS} for record in RECORDS}
        lifts = {record: {state[record, "central", acts] for acts in ACTS} for record in RECORDS}
        planar = {
            record: float(parts["planar"]["planar_tilt_ratio"].sel(at | {"record": record})) for record in RECORDS
        }
        varied = {record: parts["variations"].sel(at | {"record": record}) for record in RECORDS}
        margins = {record: parts["margins"].sel(column=column, record=record) for record in RECORDS}
        laws = {
            record: {int(one["outcome"].sel(case=case, margin_scale=scale)) for case in OTHERS}
            for record, one in margins.items()
        }
        expected = {
            "stood": sum(value == 0 for value in central.values()),
            "overturned": sum(value == 1 for value in central.values()),
            "undecided": sum(value == -1 for value in central.values()),
            "overturned_in_some": sum(1 in values for values in of.values()),
            "undecided_in_some": sum(-1 in values for values in of.values()),
            "uncertain_in_some": len({name for (name, *_), value in unsure.items() if value}),
            "on_dissipation": sum({0, 1} <= values for values in levels.values()),
            "on_vertical": sum({0, 1} <= values for values in lifts.values()),
            "overturned_other_law": sum(int(Outcome.OVERTURNED) in values for values in laws.values()),
            "in_band": sum(1 in one["in_band"].sel(scale=scale).values for one in margins.values()),
            "variations_disagree": sum(0 < int(one["overturned"]) < 20 for one in varied.values()),
            "undecided_word": sum(one["word"].item() == "undecided" for one in varied.values()),
            "planar_differs": sum(
                central[record] != -1 and not math.isnan(tilt) and math.isinf(tilt) != (central[record] == 1)
                for record, tilt in planar.items()
            ),
        }
        found = {name: int(summary[name].sel(at)) for name in expected}
        assert found == expected
        seen |= {name for name, count in expected.items() if 0 < count < len(RECORDS)}
    assert seen == expected.keys()


def test_counts_of_what_was_not_computed_are_left_out():
    parts = random_assessment(4)
    whole = summary_of(parts, ["A", "A"])
    few = {name: one for name, one in parts.items() if name in ("verdicts", "margins")}
    few["margins"] = few["margins"].sel(case=[case for case in CASES if case not in OTHERS])
    left = {"planar_differs", "variations_disagree", "undecided_word", "overturned_other_law"}
    assert set(whole) - set(summary_of(few, ["A", "A"])) == left


def test_records_are_counted_by_their_margins(assessment):
    parts, summary = assessment
    for column in COLUMNS:
        margins = parts["margins"].sel(column=column)
        central = [margins.sel(case="central", record=record) for record in RECORDS]
        assert int(summary["never_overturned"].sel(column=column)) == sum(int(one["intervals"]) == 0 for one in central)
        assert int(summary["stands_again"].sel(column=column)) == sum(int(one["stands_again"]) > 0 for one in central)
        assert int(summary["scan_undecided"].sel(column=column)) == sum(int(one["unknown"]) > 0 for one in central)
        # Undefined if one is, unlike Python's min.
        assert float(summary["decided_to"].sel(column=column)) == pytest.approx(
            np.min([float(one["decided_to"]) for one in central]), nan_ok=True
        )
        slides = [not math.isnan(value) for value in margins["standing_slip"].values.ravel()]
        assert bool(summary["slides_first"].sel(column=column)) == any(slides)
        own = margins.sel(case=[case for case in CASES if case not in OTHERS])
        pairs = zip(own["least_slipping"].values.ravel(), own["least_overturning"].values.ravel(), strict=True)
        first = [slip < fall or math.isnan(fall) for slip, fall in pairs if not math.isnan(slip)]
        assert bool(summary["slips_first"].sel(column=column)) == any(first)


def test_extremes_are_those_of_the_stated_cases_and_the_first_record_is_named(assessment):
    parts, summary = assessment
    for column in COLUMNS:
        verdicts, margins = parts["verdicts"].sel(column=column), parts["margins"].sel(column=column)
        central = verdicts["tilt_ratio"].sel(dissipation="central", vertical="with")
        for scale in SCALES:
            at = {"column": column, "scale": scale}
            assert float(summary["peak_tilt_ratio"].sel(at)) == central.sel(scale=scale).values.max()
            demand = verdicts["friction_demand"].sel(scale=scale)
            assert float(summary["friction_demand"].sel(at)) == demand.values.max()
            for record in RECORDS:
                own = demand.sel(record=record).values.max()
                assert float(summary["friction_by_record"].sel(at | {"record": record})) == own
        found = {name: float(summary[name].sel(column=column)) for name in ("least_overturning", "least_of_all")}
        least = margins["least_overturning"]
        assert found["least_overturning"] == np.nanmin(least.sel(case="central").values)
        assert found["least_of_all"] == np.nanmin(least.values)
        name = str(summary["least_record"].sel(column=column).values)
        assert float(least.sel(case="central", record=name)) == found["least_overturning"]
        laws = {"": [case for case in CASES if case not in OTHERS], "_other_law": list(OTHERS)}
        need = margins["friction_to_margin"].sel(case=laws[""])
        assert float(summary["friction_to_margin"].sel(column=column)) == need.values.max()
        for law, cases in laws.items():
            least_slipping = np.nanmin(margins["least_slipping"].sel(case=cases).values)
            assert float(summary[f"least_slipping{law}"].sel(column=column)) == least_slipping
    assert list(summary["governing"].values) == ["C", ""]


def test_a_column_that_nothing_overturns_has_no_least_record_and_a_slip_at_the_same_scale_is_not_earlier():
    parts = random_assessment(3)
    margins = parts["margins"]
    margins["least_overturning"].loc[{"column": "slim"}] = np.nan
    margins["least_slipping"].loc[{"column": "slim"}] = np.nan
    margins["least_overturning"].loc[{"column": "stout"}] = 0.7
    margins["least_slipping"].loc[{"column": "stout"}] = 0.7
    summary = summary_of(parts, ["A", "A"])
    assert list(summary["least_record"].values) == ["", "A"]
    assert list(summary["slips_first"].values) == [0, 0]
    margins["least_slipping"].loc[{"column": "stout", "case": "low", "record": "B"}] = 0.69
    assert list(summary_of(parts, ["A", "A"])["slips_first"].values) == [0, 1]
    margins["least_slipping"].loc[{"column": "stout", "case": "low", "record": "B"}] = 0.71
    margins["least_slipping"].loc[{"column": "stout", "case": OTHERS[0], "record": "B"}] = 0.3
    summary = summary_of(parts, ["A", "A"])
    assert list(summary["slips_first"].values) == [0, 0]
    np.testing.assert_array_equal(summary["least_slipping_other_law"], [np.nan, 0.3])
    assert float(summary["least_slipping"].sel(column="stout")) == 0.7
