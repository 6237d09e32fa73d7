"""Columns, models, motions and results are values: equal by content, copied, pickled, shown in a line and a card."""

import copy
import pickle
import re
from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import cache
from html.parser import HTMLParser
from typing import Annotated

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.quantities import Quantity, exact_repr
from stylobate.results import Assessment
from stylobate.results.findings import ClaimStatus, Finding, PaperCheck, PaperSection
from stylobate.results.verdict import percent
from stylobate.text import four_digits

THIRD = 1.0 / 3.0
COLUMN = sb.Column.solid(radius=THIRD, height=10.0 * THIRD, density=2700.0)
MODEL = sb.Wobbling(COLUMN, damping=THIRD)
SMALL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=THIRD, angular_frequency=1.0 + THIRD)
PULSE = sb.Pulse.ricker(acceleration=5.0 + THIRD, angular_frequency=3.0 + THIRD)
RECORD = sb.Record(samples=np.outer([0.0, THIRD, 2.0, -1.0], [1.0, 0.5, 0.1]), step=0.02, name="<four> & samples")


@dataclass(frozen=True, slots=True, kw_only=True)
class Tethered(sb.Slender):
    """A model of a user's own."""

    tether: Annotated[float, Quantity(symbol="k", unit="N/m", text="stiffness of the tether")] = 0.0


@cache
def run(duration=5.0):
    return sb.simulate(MODEL, CIRCLE.scaled(10.0), duration=duration)


@cache
def orbit(acceleration=0.065):
    motion = sb.Harmonic.circular(acceleration=acceleration, angular_frequency=2.0)
    return sb.orbits.periodic_orbit(SMALL, motion)


@cache
def branch(acceleration=0.065):
    return sb.orbits.continue_branch(orbit(acceleration), "angular_frequency", bounds=(1.35, 2.05))


@cache
def curve(highest=0.066):
    bounds = ((1.39, 1.41), (0.064, highest))
    return sb.orbits.bifurcation_curve(branch().bifurcations[0], "acceleration", bounds=bounds)


@cache
def verdict(seed=0):
    return sb.verdict(MODEL, PULSE, runs=10, seed=seed)


def assessment(fallen=1):
    counts = {name: (("column", "scale"), [[number]]) for name, number in (("overturned", fallen), ("undecided", 0))}
    summary = xr.Dataset(counts, coords={"column": ["<east>"], "scale": [1.0]})
    setting = {"title": "Two & three", "columns": {"<east>": {}}, "records": {"a": {}, "b": {}}, "scales": [1.0]}
    return Assessment(data={"summary": summary}, setting=setting)


def check(measured="0.1"):
    found = Finding("section 2", "a statement", measured, ClaimStatus.HOLDS)
    return PaperCheck({"Two": PaperSection((found,), {"figure": xr.Dataset({"a": ("x", [1.0, np.nan])})})})


CASES = {
    "column": (COLUMN, COLUMN.resized(2.0)),
    "dimensionless column": (SMALL.column, sb.Column.dimensionless(slenderness=0.2)),
    "wobbling": (MODEL, replace(MODEL, damping=0.2)),
    "sliding": (sb.Sliding(COLUMN), sb.Sliding(COLUMN, friction_coefficient=0.4)),
    "own model": (Tethered(column=COLUMN, tether=THIRD), Tethered(column=COLUMN, tether=0.5)),
    "harmonic": (CIRCLE, replace(CIRCLE, start_phase=1.0)),
    "pulse": (PULSE, replace(PULSE, start=1.0)),
    "waveform": (PULSE.waveform, replace(PULSE.waveform, acceleration=1.0)),
    "sine sweep": tuple(sb.SineSweep.linear(acceleration=a, frequencies=(1.0, 8.0), length=60.0) for a in (THIRD, 1.0)),
    "record": (RECORD, RECORD.inverted()),
    "scaled": (RECORD.scaled(THIRD), RECORD.scaled(0.5)),
    "rotated": (PULSE.rotated(THIRD), PULSE.rotated(0.5)),
    "offset": (PULSE.offset(THIRD), PULSE.offset(0.5)),
    "sum": (PULSE + CIRCLE, CIRCLE + PULSE),
    "base at rest": (sb.base_motions.BASE_AT_REST, PULSE),
    "one of": tuple(sb.OneOf(motions=(PULSE, CIRCLE, RECORD, PULSE), chosen=k) for k in (0, 1)),
    "rules": (sb.OutcomeRules(), sb.OutcomeRules(periods=3)),
    "event": (sb.Event("rest", 1.0), sb.Event("rest", 2.0)),
}
RESULTS = {
    "run": (run, 6.0),
    "orbit": (orbit, 0.066),
    "branch": (branch, 0.066),
    "curve": (curve, 0.067),
    "verdict": (verdict, 1),
    "assessment": (assessment, 2),
    "check of a paper": (check, "0.2"),
}
COPIES = {"copy": copy.copy, "deep copy": copy.deepcopy, "pickle": lambda one: pickle.loads(pickle.dumps(one))}  # noqa: S301
NAMES = [*CASES, *RESULTS]
every_value = pytest.mark.parametrize("name", NAMES)


def of(name):
    """Return a value, and another of its class."""
    if name in CASES:
        return CASES[name]
    make, other = RESULTS[name]
    return make(), make(other)


@every_value
def test_a_value_equals_itself_and_differs_from_another(name):
    value, other = of(name)
    assert value == value  # noqa: PLR0124  contents are compared
    assert value != other
    assert value != repr(value)


@pytest.mark.parametrize("way", COPIES)
@every_value
def test_copies_are_equal_and_of_the_same_class(name, way):
    value, other = of(name)
    again = COPIES[way](value)
    assert type(again) is type(value)
    assert again == value
    assert again != other
    assert repr(again) == repr(value)


@every_value
def test_equal_values_have_one_hash_or_none(name):
    value, _ = of(name)
    if name in RESULTS:  # they hold arrays
        assert not isinstance(value, Hashable)
        with pytest.raises(TypeError, match="unhashable"):
            hash(value)
    else:
        assert hash(value) == hash(copy.deepcopy(value))


def test_a_single_number_in_an_array_tells_results_apart():
    data = run().data.copy(deep=True)
    data["tilt"][-1, 0] += 1e-15
    assert replace(run(), data=data) != run()
    assert replace(verdict(), data=verdict().data.assign_attrs(note="another")) != verdict()
    chain = orbit().chain
    other = replace(chain, states=np.nextafter(chain.states, 1.0))
    assert replace(orbit(), chain=other) != orbit()


def test_a_copied_run_keeps_its_dense_output_and_shares_no_samples():
    again = copy.deepcopy(run())
    xr.testing.assert_identical(again.sample([0.1]), run().sample([0.1]))
    again.data["tilt"][0, 0] = 9.0
    assert again != run()


SHOWN = [name for name in NAMES if name not in ("rules", "event", "check of a paper")]
NUMBER = re.compile(r"(?<![\w.])-?(\d+(?:\.\d+)?(?:e[+-]\d+)?)(?![\w.])")


def digits_of(number):
    return len(number.partition("e")[0].replace(".", "").strip("0"))


@pytest.mark.parametrize("name", SHOWN)
def test_one_line_shows_a_value_with_four_digits(name):
    line = repr(of(name)[0])
    assert "\n" not in line
    assert "object at 0x" not in line
    assert "array(" not in line
    without_hashes = re.sub(r"[0-9a-f]{12}", "", line)
    assert max(map(digits_of, NUMBER.findall(without_hashes)), default=0) <= 4


def test_a_column_shows_its_sizes_and_what_decides():
    assert repr(COLUMN) == (
        "Column(radius=0.3333 m, mass_height=1.667 m, mass=3142 kg, height=3.333 m; c=0.2, ω0=2.093 rad/s)"
    )
    assert repr(SMALL) == (
        "Slender(column=Column(radius=0.075 m, mass_height=0.75 m, mass=1 kg, gravity=1 m/s²; c=0.1, ω0=1 rad/s), "
        "damping=0.1)"
    )


def test_a_motion_shows_the_constructor_and_the_numbers_that_made_it():
    assert repr(PULSE) == "Pulse.ricker(acceleration=5.333 m/s², angular_frequency=3.333 rad/s)"
    assert repr(PULSE.scaled(2.0).rotated(THIRD)) == f"{PULSE!r}.scaled(factor=2, vertical=2).rotated(angle=0.3333 rad)"
    assert repr(of("one of")[0]).count("Pulse") == 1  # the others are counted
    assert "… 1 more" in repr(of("one of")[0])


@dataclass(frozen=True)
class Rising(sb.base_motions.pulses.Waveform):
    """A waveform of a user's own."""

    steepness: float = 1.0
    duration: float = 1.0
    highest_frequency: float = 1.0

    def derivative(self, time, order):
        return self.steepness * time ** (2 - order) / (2.0, 1.0, 1.0)[order]

    def turning_points(self):
        return ()


def test_provenance_keeps_all_digits_of_what_has_no_description():
    pulse = sb.Pulse(waveform=Rising(steepness=THIRD), direction=THIRD)
    assert "steepness=0.3333)" in repr(pulse)
    made = sb.simulate(SMALL, pulse, duration=1.0)
    assert made.provenance["motion"]["repr"] == exact_repr(pulse)
    assert eval(exact_repr(pulse), {"Pulse": sb.Pulse, "Rising": Rising}) == pulse  # noqa: S307
    assert eval(exact_repr(MODEL), {"Wobbling": sb.Wobbling, "Column": sb.Column}) == MODEL  # noqa: S307


class Cells(HTMLParser):
    """The rows of a card; a tag that is not closed in order fails."""

    def __init__(self, html):
        super().__init__()
        self.rows, self.open, self.styles = [], [], []
        self.feed(html)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        self.styles.append(dict(attributes).get("style", ""))
        if tag == "tr":
            self.rows.append([])
        elif tag in ("th", "td"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "tr" in self.open:
            self.rows[-1][-1] += data


@pytest.mark.parametrize("name", SHOWN)
def test_a_card_is_a_table_without_colours_and_addresses_of_its_own(name):
    html = of(name)[0]._repr_html_()
    card = Cells(html)
    assert html.startswith("<table")
    assert not re.search(r"https?:|url\(|<script|<img|<style|#[0-9a-fA-F]{3}\b|rgba?\(", html)
    coloured = [style for style in card.styles if re.search(r"(?<!-)color:(?!inherit)|background:(?!none)", style)]
    assert not coloured


def card_of(value):
    return {row[0]: row[1:] for row in Cells(value._repr_html_()).rows}


def test_the_card_of_a_column_has_names_symbols_units_and_derived_numbers():
    card = card_of(COLUMN)
    assert card["radius"] == ["r", "0.3333 m"]
    assert card["transverse inertia"][0] == "It"
    assert card["slenderness"] == ["c", "0.2"]
    assert card["frequency scale"] == ["ω0", f"{four_digits(COLUMN.frequency_scale)} rad/s"]
    assert card["frequency parameter"] == ["p", f"{four_digits(COLUMN.frequency_parameter)} rad/s"]
    assert {*card_of(COLUMN)} < {*card_of(MODEL)}


def test_the_card_of_a_motion_has_its_peak_period_and_duration():
    assert card_of(CIRCLE)["peak horizontal"][1] == "0.3333 m/s²"
    assert card_of(CIRCLE)["period"][1] == f"{four_digits(CIRCLE.period)} s"
    assert "duration" not in card_of(CIRCLE)  # it never ends
    assert card_of(PULSE)["duration"][1] == f"{four_digits(PULSE.duration)} s"


def test_the_card_of_a_run_has_outcome_reason_thresholds_and_whether_it_is_uncertain():
    card = card_of(run())
    assert card["outcome"][-1] == run().outcome.label
    assert card["because"][-1] == run().reason
    assert card["uncertain"][-1] == "no"
    assert card["no return tilt"][-1] == f"{four_digits(run().thresholds['no_return_tilt'])} rad"


def test_thresholds_are_folded_and_an_infinite_one_is_none():
    html = run()._repr_html_()
    shown, folded = html.split("<details>")
    assert "no return tilt" not in shown
    assert "no return tilt" in folded
    assert {"outcome", "because", "peak tilt", "events"} <= {row[0] for row in Cells(shown).rows}
    assert "inf" not in " ".join(row[-1] for row in Cells(html).rows).split()


def test_cards_of_a_bifurcation_a_hazard_curve_and_a_known_orbit_have_names_and_units():
    (hopf,) = (one for one in branch().bifurcations if one.kind == "Neimark-Sacker")
    assert card_of(hopf)["angular frequency"][-1] == "1.397 rad/s"
    assert card_of(hopf)["loss of stability"][-1] == "supercritical"
    curve = sb.earthquakes.HazardCurve(intensity=[1.0, 4.0], rate=[1e-2, 1e-4], units="m s-2", quantity="PGA")
    assert card_of(curve)["PGA"][-1] == "1 to 4 m/s²"
    assert card_of(curve)["annual rate of exceedance"][-1] == "0.01 to 0.0001 1/a"
    known = sb.KnownOrbit(
        tilt=(0.1, 0.0), tilt_rate=(0.0, 0.2), multiplier=0.5, turns=1.0, mean_tilt=np.array([0.1, 0.2, 0.3])
    )
    assert card_of(known)["tilt rate"][-1] == "0, 0.2 rad/s"
    assert card_of(known)["mean tilt"][-1] == "array of shape (3,) rad"


def test_the_card_of_a_verdict_has_share_interval_and_the_share_of_each_contact_law():
    card, found = card_of(verdict()), verdict()
    assert card["verdict"][-1] == found.word.value
    assert card["share of overturning"][-1].startswith(f"{percent(found.share)} of 10 variations")
    for law, share in found.share_by_model.items():
        assert card[law][-1].startswith(f"{percent(share)} (")


def test_cards_of_orbits_and_branches_state_stability_and_bifurcations():
    assert card_of(orbit())["stability"][-1] == "stable"
    assert card_of(branch())["Neimark-Sacker"][-1] == "1.397 rad/s, supercritical"
    assert card_of(curve())["points"][-1] == str(len(curve().path))
    assert card_of(assessment())["<east>"][-1] == "1 of 2 overturn"


def test_text_of_the_user_is_escaped():
    assert "&lt;four&gt; &amp; samples" in RECORD._repr_html_()
    assert card_of(RECORD)["name"][-1] == RECORD.name
