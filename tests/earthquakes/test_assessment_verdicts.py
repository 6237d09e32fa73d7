"""One-line verdicts of an assessment: their classes, the records they name, and the displacements beside tilts."""

import itertools

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes.assessment.report.column_verdict import (
    VerdictClass,
    cases_of,
    column_verdict,
    least_overturning_scale,
)
from stylobate.earthquakes.assessment.report.wording import displacement, tilt_cells, tilt_words
from stylobate.results import Assessment
from stylobate.results.verdict import word_of
from stylobate.studies.proportions import fraction_interval

LEVELS, ACTS, RECORDS = ("low", "central", "high"), ("with", "without"), ("A", "B", "C")
CASES = (*LEVELS, "central, no vertical", *(f"{level}, other contact law" for level in LEVELS))
SCALES = (0.2, 0.95, 1.0, 1.05, 5.0)


def made(
    runs=(),
    *,
    uncertain=(),
    need=(),
    friction=0.6,
    contact=True,
    varied=None,
    open_runs=None,
    variations=200,
    laws=True,
    other_law=(),
    in_band=None,
    least=None,
    decided=None,
    slips=None,
    slid=None,
):
    """Return an assessment in which no record overturned the column "k" but in the runs that are named.

    Parameters
    ----------
    runs
        Record, dissipation, vertical and state of runs that did not stand.
    uncertain
        Records.
    need
        Record and friction needed.
    varied, open_runs
        Number of small variations that overturned the column, and that were not decided, by record.
    variations
        Number of small variations; without any there is no share.
    laws
        Whether the other contact law was run.
    other_law
        Record, level and outcome of the run with the other contact law at scale 1.
    in_band
        Share of overturning scales within 10 %, by record and case; 0 if only scales between the 41 overturned.
    least, decided
        Least overturning scale, and the largest up to which every run was decided, by record and case.
    slips
        Scale from which on a record makes the standing column slide, by record.
    slid
        Verdicts by the model that slides: state and whether it is numerically uncertain, by record.
    """
    dims = ("column", "record", "dissipation", "vertical", "scale")
    coords = {"column": ["k"], "record": list(RECORDS), "dissipation": list(LEVELS), "vertical": list(ACTS)}
    states = xr.DataArray(np.zeros((1, 3, 3, 2, 1), np.int8), dims=dims, coords={**coords, "scale": [1.0]})
    unsure, needed = states.copy(), states.astype(float) + 0.3
    for record, level, acts, state in runs:
        states.loc[{"record": record, "dissipation": level, "vertical": acts}] = state
    for record in uncertain:
        unsure.loc[{"record": record}] = 1
    for record, value in need:
        needed.loc[{"record": record, "dissipation": "high"}] = value
    peaks = {"peak_acceleration": ("record", [3.0, 1.0, 0.5]), "peak_acceleration_z": ("record", [1.0, 0.5, 0.0])}
    data = {
        "verdicts": xr.Dataset({"overturned": states, "uncertain": unsure, "friction_demand": needed}),
        "margins": margins_of(laws, other_law, in_band or {}, least or {}, decided or {}, slips or {}),
        "records": xr.Dataset(peaks, coords={"record": list(RECORDS)}),
        "columns": xr.Dataset(
            {
                "friction_coefficient": ("column", [friction]),
                "slenderness": ("column", [0.25]),
                "uplift_acceleration": ("column", [0.25 * 9.80665]),
            },
            coords={"column": ["k"]},
        ),
    }
    if variations:
        counts = [[(given or {}).get(name, 0) for name in RECORDS] for given in (varied, open_runs)]
        arrays = zip(("share", "open"), (np.array(counts[0]) / variations, np.array(counts[1])), strict=True)
        known = {"column": ["k"], "record": list(RECORDS), "scale": [1.0]}
        data["variations"] = xr.Dataset({name: (tuple(known), one.reshape(1, 3, 1)) for name, one in arrays}, known)
        words = [
            word_of(*fraction_interval(*one, variations, confidence=0.9)).value for one in zip(*counts, strict=True)
        ]
        data["variations"]["word"] = (tuple(known), np.reshape(words, (1, 3, 1)))
    if slid is not None:
        data["sliding"] = slid_by(slid)
    setting = {
        "friction_coefficient": {"k": friction},
        "contact": contact,
        "variations": variations,
        "contact_laws": laws,
        "margin_scales": [0.2, 5.0, 60],
        "scales": [1.0],
    }
    return Assessment(data=data, setting=setting)


def margins_of(laws, other_law, in_band, least, decided, slips):
    by_case = {"column": ["k"], "case": list(CASES), "record": list(RECORDS)}
    by_case["case"] = by_case["case"] if laws else by_case["case"][:4]
    empty = xr.DataArray(np.full((1, len(by_case["case"]), 3), np.nan), dims=tuple(by_case), coords=by_case)
    margins = {"least_overturning": empty, "decided_to": empty.fillna(5.0), "standing_slip": empty.copy()}
    for name, given in (("least_overturning", least), ("decided_to", decided)):
        for (record, case), scale in given.items():
            margins[name].loc[{"record": record, "case": case}] = scale
    for record, scale in slips.items():
        margins["standing_slip"].loc[{"record": record}] = scale
    shares = empty.fillna(0.0).expand_dims(scale=[1.0]).copy()
    near = shares.astype(np.int8)
    for (record, case), share in in_band.items():
        shares.loc[{"record": record, "case": case}] = share
        near.loc[{"record": record, "case": case}] = 1
    codes = empty.fillna(sb.Outcome.AT_REST).astype(np.int8).expand_dims(margin_scale=list(SCALES)).copy()
    for record, level, outcome in other_law:
        codes.loc[{"record": record, "case": f"{level}, other contact law", "margin_scale": 1.0}] = outcome
    margins |= {"band_share": shares, "in_band": near, "outcome": codes}
    return xr.Dataset(margins)


def slid_by(slid):
    known = {"column": ["k"], "record": list(RECORDS), "scale": [1.0]}
    values = np.array([[[slid.get(name, (0, 0))] for name in RECORDS]], dtype=np.int8)
    arrays = {name: (tuple(known), values[..., place]) for place, name in enumerate(("overturned", "uncertain"))}
    still = np.where(values[..., 0] == 0, 0.012, np.nan)
    return xr.Dataset({**arrays, "peak_slip": (tuple(known), still)}, coords=known)


FALLEN = [("A", level, acts, 1) for level in LEVELS for acts in ACTS]


def test_a_column_overturned_as_recorded_is_not_shown_safe_and_the_records_are_named():
    least = {("A", "central"): 0.9, ("B", "low"): 0.7}
    assessment = made([*FALLEN, ("B", "central", "with", 1)], least=least)
    found = column_verdict(assessment, "k", 1.0)
    assert found.line == "NOT shown safe: overturned at the recorded level under 2 of 3 records (A, B)."
    more = column_verdict(made([*FALLEN, ("B", "low", "with", 1)]), "k", 1.0)
    assert more.sentence == (
        "overturned at the recorded level under 1 of 3 records (A) and under 1 more, but not at central dissipation "
        "(B at low)."
    )
    least = "Smallest overturning scale of all cases: at most 0.7 (B, low dissipation)."
    assert least_overturning_scale(assessment, "k") == least


def test_a_column_overturned_at_one_stated_dissipation_only_is_not_shown_safe():
    found = column_verdict(made([("B", "low", "with", 1), ("B", "high", "with", 1)]), "k", 1.0)
    assert found.verdict is VerdictClass.OVERTURNED
    assert found.sentence == (
        "overturned at the recorded level under 1 of 3 records, but not at central dissipation (B at low and high)."
    )


def test_a_column_that_stood_in_every_run_survived_every_run():
    found = column_verdict(made(), "k", 1.0)
    assert found.verdict is VerdictClass.SURVIVED
    assert "under all 3 records, at every stated dissipation" in found.sentence
    assert found.sentence.endswith(
        "at every stated dissipation, with both contact laws, at every scale tried within 10 % and under each of 200 "
        "small variations."
    )
    one = column_verdict(made(laws=False, variations=20), "k", 1.0)
    assert one.verdict is VerdictClass.SURVIVED
    assert one.sentence.endswith(
        "at every stated dissipation, at every scale tried within 10 % and under each of 20 small variations."
    )
    assert least_overturning_scale(made(), "k") == "No scale up to 5 overturned it in any case."


@pytest.mark.parametrize(
    ("changed", "reservation"),
    [
        ({"runs": [("B", "central", "without", 1)]}, "overturned under B without the vertical component"),
        ({"runs": [("B", "central", "with", -1)]}, "not decided under B"),
        ({"runs": [("C", "high", "with", -1)]}, "some run was not decided under C"),
        ({"least": {("B", "high"): 0.8}}, "a smaller scale overturned it: 0.8 (B, high dissipation)"),
        ({"varied": {"C": 1}}, "small variations overturned it under C (0.5 % of them)"),
        ({"varied": {"B": 199, "C": 20}}, "small variations overturned it under B (99.5 % of them), C (10 % of them)"),
        ({"varied": {"B": 20}, "laws": False}, "small variations overturned it under B (10 % of them)"),
        ({"open_runs": {"C": 1}}, "a small variation was not decided under C"),
        ({"open_runs": dict.fromkeys(RECORDS, 200)}, "a small variation was not decided under A, B, C"),
        ({"in_band": {("B", "low"): 1 / 41}}, "a scale within 10 % overturned it under B (2 % of 41)"),
        (
            {"in_band": {("B", "low"): 1 / 41, ("B", "high, other contact law"): 0.5, ("C", "central"): 0.25}},
            "a scale within 10 % overturned it under B (50 % of 41), C (25 % of 41)",
        ),
        (
            {"in_band": {("A", "low, other contact law"): 0.0}},
            "a scale within 10 % overturned it under A (an interval between them)",
        ),
        (
            {"in_band": {("A", "central, no vertical"): np.nan}},
            "a scale within 10 % overturned it under A (an interval between them)",
        ),
        (
            {"least": {("B", "high, other contact law"): 0.8}},
            "a smaller scale overturned it: 0.8 (B, high dissipation, other contact law)",
        ),
        (
            {"decided": {("B", "high, other contact law"): 1.05}},
            "not every scale within 10 % was decided (only up to 1.05)",
        ),
        ({"decided": {("B", "high"): 0.4}}, "not every scale up to this one was decided (only up to 0.4)"),
        ({"decided": {("B", "high"): np.nan}}, "not every scale up to this one was decided"),
        (
            {"uncertain": ["A"], "variations": 20},
            "rounding or the rest threshold could alter the outcome under A",
        ),
        ({"need": [("A", 0.72)]}, "the base would slip under A (friction 0.72 needed)"),
        ({"variations": 0}, "small variations were not tried"),
        ({"contact": False}, "the friction needed was not computed"),
    ],
)
def test_whatever_leaves_a_survival_open_takes_it_out_of_the_class_of_survivals(changed, reservation):
    found = column_verdict(made(**changed), "k", 1.0)
    assert found.verdict is VerdictClass.OPEN
    assert f"Reservations: {reservation}." in found.sentence


def test_small_variations_settle_a_run_that_is_numerically_uncertain():
    assert column_verdict(made(uncertain=["A"]), "k", 1.0).verdict is VerdictClass.SURVIVED
    found = column_verdict(made(uncertain=["A", "B"], varied={"B": 12}), "k", 1.0)
    assert found.verdict is VerdictClass.OPEN
    assert "could alter the outcome under B" in found.sentence


def test_a_column_that_slides_before_it_rocks_is_not_described_where_a_record_can_make_it_slide():
    found = column_verdict(made(FALLEN, friction=0.2, slips={"A": 0.6, "B": 1.2, "C": 3.0}), "k", 1.0)
    assert found.verdict is VerdictClass.SLIDES
    assert not found.describes
    assert found.line.startswith("Slides before it rocks: μ = 0.2 < r/h = 0.25. ")
    assert "under 1 of 3 records (A)" in found.sentence
    assert found.sentence.endswith("Set sliding = true to compute its slip.")
    assert column_verdict(made(friction=0.2, slips={"A": 1.1, "B": 1.2, "C": 3.0}), "k", 1.0).describes


@pytest.mark.parametrize(
    ("least", "decided", "words"),
    [
        (2.0, 5.0, "Smallest overturning scale of all cases: at most 2 (B, low dissipation)."),
        (2.0, 3.0, "Smallest overturning scale of all cases: at most 2 (B, low dissipation)."),
        (
            2.0,
            0.4,
            "Smallest overturning scale of all cases: at most 2 (B, low dissipation); not every scale above 0.4 was "
            "decided.",
        ),
        (
            2.0,
            np.nan,
            "Overturned at scale 2 (B, low dissipation) or below; some run at the smallest scale was not decided.",
        ),
        (np.nan, 3.0, "No scale up to 3 overturned it in any case; not every scale above 3 was decided."),
        (
            np.nan,
            np.nan,
            "No decided run overturned it; some run at the smallest scale was not decided.",
        ),
    ],
)
def test_the_least_scale_is_stated_with_the_scales_that_were_not_decided(least, decided, words):
    found = made(least={("B", "low"): least}, decided={("C", "central"): decided})
    assert least_overturning_scale(found, "k") == words


@pytest.mark.parametrize(
    ("slid", "words"),
    [
        ({}, "With the sliding model it did not overturn, and slid by up to 12 mm."),
        (
            {"A": (-1, 0)},
            "With the sliding model it was not decided under A, did not overturn under B, C, and slid by up to 12 mm.",
        ),
        (
            {"A": (1, 0), "B": (-1, 0)},
            "With the sliding model it overturned under A, was not decided under B, did not overturn under C, and "
            "slid by up to 12 mm.",
        ),
        (dict.fromkeys(RECORDS, (-1, 0)), "With the sliding model it was not decided under A, B, C."),
        (
            {"C": (0, 1)},
            "With the sliding model it did not overturn, and slid by up to 12 mm. Rounding or the rest threshold could "
            "alter the outcome under C.",
        ),
    ],
)
def test_a_run_of_the_model_that_slides_counts_as_survival_only_if_it_is_decided(slid, words):
    found = column_verdict(made(friction=0.2, slips={"A": 0.6}, slid=slid), "k", 1.0)
    assert found.sentence.endswith(words)


def test_a_column_of_which_no_run_was_decided_is_not_described():
    everything = [(name, level, acts, -1) for name in RECORDS for level in LEVELS for acts in ACTS]
    assert column_verdict(made(everything), "k", 1.0).verdict is VerdictClass.NOT_DESCRIBED
    assert column_verdict(made(everything[1:]), "k", 1.0).verdict is VerdictClass.OPEN


def test_one_overturning_outweighs_all_undecided_runs():
    undecided = [(name, level, acts, -1) for name in RECORDS for level in LEVELS for acts in ACTS]
    found = column_verdict(made([*undecided, ("B", "low", "with", 1)]), "k", 1.0)
    assert found.verdict is VerdictClass.OVERTURNED
    assert "(B at low)" in found.sentence
    assert "Not decided: A, B, C." in found.sentence


@pytest.mark.parametrize("level", LEVELS)
def test_a_column_overturned_with_the_other_contact_law_only_is_not_shown_safe(level):
    overturned = sb.Outcome.OVERTURNED
    found = column_verdict(made(other_law=[("B", level, overturned)]), "k", 1.0)
    assert found.verdict is VerdictClass.OVERTURNED
    assert found.sentence == (
        f"overturned at the recorded level under 1 of 3 records with the other contact law only (B at {level})."
    )
    # A record that overturned it with the given law too is named once.
    both = column_verdict(made([("B", level, "with", 1)], other_law=[("B", level, overturned)]), "k", 1.0)
    assert both.sentence.count("B") == 1
    assert cases_of(made(other_law=[("B", level, sb.Outcome.FAILED)]), "k", 1.0).with_other_law == {}


def test_the_other_law_beside_the_given_one_and_the_largest_share_are_stated():
    runs = [*FALLEN, ("B", "low", "with", 1)]
    other = [("C", level, sb.Outcome.OVERTURNED) for level in LEVELS]
    found = column_verdict(made(runs, other_law=other, varied={"A": 90, "C": 130}), "k", 1.0)
    assert found.sentence == (
        "overturned at the recorded level under 1 of 3 records (A), under 1 more, but not at central dissipation "
        "(B at low) and under 1 of 3 records with the other contact law only (C at low, central and high). Up to 65 % "
        "of the small variations overturn it (C)."
    )


def test_nothing_that_overturned_leaves_the_class_of_survivals_at_any_record_level_or_law():
    for record, case in itertools.product(RECORDS, CASES):
        near = made(in_band={(record, case): 1 / 41})
        assert column_verdict(near, "k", 1.0).verdict is VerdictClass.OPEN
    for record, count in itertools.product(RECORDS, (1, 200)):
        assert column_verdict(made(varied={record: count}), "k", 1.0).verdict is VerdictClass.OPEN
    for record, level in itertools.product(RECORDS, LEVELS):
        other = made(other_law=[(record, level, sb.Outcome.OVERTURNED)])
        assert column_verdict(other, "k", 1.0).verdict is VerdictClass.OVERTURNED


def test_a_scale_that_was_decided_to_ten_percent_above_is_no_reservation():
    for decided in (1.1, 1.1 * 0.9999999999, 5.0):
        assert column_verdict(made(decided={("A", "low"): decided}), "k", 1.0).verdict is VerdictClass.SURVIVED
    assert column_verdict(made(decided={("A", "low"): 1.0999}), "k", 1.0).verdict is VerdictClass.OPEN


def test_a_record_is_named_once_where_it_overturns_with_and_without_its_vertical_component():
    runs = [*[("C", "low", acts, 1) for acts in ACTS], ("B", "high", "without", 1)]
    cases = cases_of(made(runs), "k", 1.0)
    assert cases.at_other_dissipation == {"C": ("low",)}
    assert cases.without_vertical == {"B": ("high",)}


def test_the_displacement_of_a_point_is_that_of_a_turn_about_the_rim():
    radius, height = 0.45, 6.0
    for angle in (0.0, 0.05, 0.15, 1.2):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        rim, point = np.array([radius, 0.0]), np.array([0.0, height])
        moved = rim + turn @ (point - rim)
        # Products of sin and cos with lengths up to 6 m: a few ulp of 6.
        np.testing.assert_allclose(displacement(angle, radius=radius, height=height), moved[0], atol=4e-15)


def test_tilts_are_shown_in_degrees_and_millimetres_of_the_top_or_of_the_centre_of_mass():
    body = xr.Dataset({"radius": 0.06, "height": np.nan, "mass_height": 0.28, "tipping_angle": np.arctan2(0.06, 0.28)})
    angle = 0.5 * float(body["tipping_angle"])
    moved = 1000.0 * displacement(angle, radius=0.06, height=0.28)
    assert tilt_cells(0.5, body) == ("0.5", f"{np.degrees(angle):.3g}", f"{moved:.3g}")
    assert "displaces its centre of mass by" in tilt_words(0.5, body)
    assert "displaces its top by" in tilt_words(0.5, body.assign(height=0.6))
    assert tilt_cells(np.inf, body) == ("overturned", "–", "–")
    assert tilt_cells(1e-6, body) == ("< 0.001", "< 0.01", "< 0.1")
    assert tilt_cells(0.0, body) == ("0", "0", "0")
