"""The answers of a report: probabilities over records, and the slip of columns that slide before they rock."""

from dataclasses import replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import assess, assessment_tables
from stylobate.earthquakes.assessment.report.answers import (
    answer_table,
    overturning_probability,
    probability_over_records,
)
from stylobate.earthquakes.assessment.report.sections import report_sections
from stylobate.earthquakes.assessment.report.sketch import objects_figure
from stylobate.studies.proportions import clustered_interval

from .two_columns import BODIES, DISSIPATION, made_record, section


@pytest.fixture(scope="module")
def sliding():
    return assess(
        {name: sb.Slender(body) for name, body in BODIES.items()},
        [made_record("strong", 3.0), made_record("weak & quiet", 0.2)],
        dissipation=DISSIPATION,
        friction_coefficient={"slim <1>": 0.6, "stout": 0.15},
        sliding=True,
        limit_states=[sb.earthquakes.LimitState(response="slip", limit=0.02)],
        margin_scales=np.geomspace(0.5, 3.0, 9),
        variations=12,
        planar=False,
        contact=False,
        tail=2.0,
    )


def test_slip_is_answered_on_the_first_page_and_tabulated_in_millimetres(sliding):
    slim, stout = answer_table(sliding, 1.0).rows
    own = sliding.data["sliding"].sel(column="stout", scale=1.0)
    assert stout[1] == "Slides before it rocks"
    strong = own.sel(record="strong")
    stated, low, high = (1000.0 * float(strong[f"peak_slip{end}"]) for end in ("", "_low", "_high"))
    interval = f"{low:.3g} to {high:.3g}, 90 % of its variations"
    assert stout[2].startswith(f"slips up to {stated:.3g} mm ({interval}) under strong; slip 20 mm: ")
    assert slim[1] != "Slides before it rocks"
    table = assessment_tables(sliding)["slip"]
    rows = {row[1]: dict(zip(table.header, row, strict=True)) for row in table.rows}
    assert {row[0] for row in table.rows} == {"stout"}
    for name, row in rows.items():
        assert row["peak slip [mm]"] == f"{1000.0 * float(own['peak_slip'].sel(record=name)):.3g}"
    states = assessment_tables(sliding)["slip-limits"]
    reached = {row[1]: dict(zip(states.header, row, strict=True))["state"] for row in states.rows}
    expected = {name: "reached" if float(own["peak_slip"].sel(record=name)) >= 0.02 else "not reached" for name in rows}
    assert reached == expected
    assert set(reached.values()) == {"reached", "not reached"}


def test_variations_whose_friction_reaches_the_slenderness_are_counted_and_may_rock(sliding):
    own = sliding.data["sliding"]
    few = own.assign(known_variations=own["known_variations"] * 0 + 9)
    _, stout = answer_table(replace(sliding, data={**sliding.data, "sliding": few}), 1.0).rows
    rocks = str(overturning_probability(sliding, "stout", 1.0))
    assert stout[2].endswith(f"but in 25 % of the variations friction reaches r/h, and it may rock: overturns {rocks}")
    assert "may rock" not in answer_table(sliding, 1.0).rows[1][2]
    rows = assessment_tables(sliding)["summary"].rows
    assert {row[0] for row in rows if "slides" in row} == {"stout"}


def test_runs_without_slip_of_a_column_that_slides_first_are_not_shown(sliding):
    _, table, *_ = section(sliding, "Outcomes at the stated scales")
    assert {row[0] for row in table.rows} == {"slim <1>"}
    words, table = section(sliding, "Margins")[:2]
    assert "Left out: stout, which slides before it rocks." in words
    assert {row[0] for row in table.rows} == {"slim <1>"}
    (body,) = objects_figure(sliding, ["stout"], ["stout"]).axes[0].patches
    assert body.get_xy()[:, 1].max() == BODIES["stout"].height
    of_slip = ("sliding", "slip_margins", "slip_paths")
    bare = replace(sliding, data={name: one for name, one in sliding.data.items() if name not in of_slip})
    assert any(one.heading == "Slip" for one in report_sections(sliding, assessment_tables(sliding), {}))
    assert not any(one.heading == "Slip" for one in report_sections(bare, assessment_tables(bare), {}))
    assert "slip" not in assessment_tables(bare)


def test_the_probability_counts_each_record_once_and_undecided_runs_on_both_sides():
    shares = np.array([1.0, 0.0, 0.5, 0.0])
    share, low, high = probability_over_records(shares, np.zeros(4))
    assert share == 0.375
    assert (low, high) == pytest.approx([float(end) for end in clustered_interval(shares)], rel=1e-12)
    unknown = np.array([0.0, 0.5, 0.0, 0.0])
    _, low_open, high_open = probability_over_records(shares, unknown)
    assert low_open == low
    assert high_open == pytest.approx(float(clustered_interval(shares + unknown)[1]), rel=1e-12)
    nothing = probability_over_records(np.zeros(2), np.ones(2))
    assert np.isnan(nothing[0])
    assert nothing[1] == 0.0
    assert nothing[2] == 1.0


@pytest.mark.parametrize("spread", [0.2, 1.0, 20.0])
def test_the_interval_of_the_probability_covers_it_however_much_records_differ(spread):
    rng, mean, count = np.random.default_rng(7), 0.3, 12
    covered = 0
    for _ in range(2000):
        shares = rng.binomial(200, rng.beta(spread * mean, spread * (1.0 - mean), count)) / 200.0
        _, low, high = probability_over_records(shares, np.zeros(count))
        covered += low <= mean <= high
    # Three standard deviations of the coverage of 2000 draws are 1.5 %; that of 12 trials of its own varies by 2 %.
    assert covered / 2000.0 >= 0.915
