"""Counts of an assessment's summary: those of a reader who goes through the verdicts record by record."""

import itertools
import math

import numpy as np
import pytest
import xarray as xr

from stylobate.earthquakes.assessment.summary import summary_of

COLUMNS, SCALES, RECORDS = ("slim", "stout"), (0.5, 1.0), tuple("ABCDEFGHIJKL")
LEVELS, ACTS = ("low", "central", "high"), ("with", "without")
CASES = (*LEVELS, "central, no vertical")


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

    changes = {name: runs[name] for name in ("column", "scale", "record", "dissipation")}
    planar = {name: runs[name] for name in ("column", "scale", "record")}
    tilts = numbers(planar, 0.2)
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
                "bands": drawn(margins, (0, 1, 2), (0.4, 0.4, 0.2)),
                "stands_again": drawn(margins, (0, 1, 2), (0.4, 0.4, 0.2)),
                "unknown": drawn(margins, (0, 1, 2), (0.4, 0.4, 0.2)),
                "decided_to": numbers(margins, 0.04),
            }
        ),
        "robustness": xr.Dataset(
            {"flipped": drawn(changes, (0, 1, 2), (0.8, 0.1, 0.1)), "undecided": drawn(changes, (0, 1), (0.9, 0.1))}
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
        small = {record: parts["robustness"].sel(at | {"record": record}) for record in RECORDS}
        expected = {
            "stood": sum(value == 0 for value in central.values()),
            "overturned": sum(value == 1 for value in central.values()),
            "undecided": sum(value == -1 for value in central.values()),
            "overturned_in_some": sum(1 in values for values in of.values()),
            "undecided_in_some": sum(-1 in values for values in of.values()),
            "uncertain_in_some": len({name for (name, *_), value in unsure.items() if value}),
            "on_dissipation": sum({0, 1} <= values for values in levels.values()),
            "on_vertical": sum({0, 1} <= values for values in lifts.values()),
            "not_robust": sum(bool((one["flipped"] > 0).any()) for one in small.values()),
            "changes_undecided": sum(bool((one["undecided"] > 0).any()) for one in small.values()),
            "planar_differs": sum(
                central[record] != -1 and not math.isnan(tilt) and math.isinf(tilt) != (central[record] == 1)
                for record, tilt in planar.items()
            ),
        }
        found = {name: int(summary[name].sel(at)) for name in expected}
        assert found == expected
        seen |= {name for name, count in expected.items() if 0 < count < len(RECORDS)}
    assert seen == expected.keys()


def test_records_are_counted_by_their_margins(assessment):
    parts, summary = assessment
    for column in COLUMNS:
        margins = parts["margins"].sel(column=column)
        central = [margins.sel(case="central", record=record) for record in RECORDS]
        assert int(summary["never_overturned"].sel(column=column)) == sum(int(one["bands"]) == 0 for one in central)
        assert int(summary["stands_again"].sel(column=column)) == sum(int(one["stands_again"]) > 0 for one in central)
        assert int(summary["scan_undecided"].sel(column=column)) == sum(int(one["unknown"]) > 0 for one in central)
        # Undefined if one is, unlike Python's min.
        assert float(summary["decided_to"].sel(column=column)) == pytest.approx(
            np.min([float(one["decided_to"]) for one in central]), nan_ok=True
        )
        slides = [not math.isnan(value) for value in margins["standing_slip"].values.ravel()]
        assert bool(summary["slides_first"].sel(column=column)) == any(slides)
        pairs = zip(margins["least_slipping"].values.ravel(), margins["least_overturning"].values.ravel(), strict=True)
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
        assert float(summary["friction_to_margin"].sel(column=column)) == margins["friction_to_margin"].values.max()
        assert float(summary["least_slipping"].sel(column=column)) == np.nanmin(margins["least_slipping"].values)
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
