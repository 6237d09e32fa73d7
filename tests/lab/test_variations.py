"""Small variations of one case."""

import numpy as np
import pytest

from stylobate.lab.options import lessons, presets
from stylobate.lab.variations import RUNS, variations

CASES = {one.identity: one.description for one in (*presets(), *lessons())}


def varied(name, **changes):
    return variations({**CASES[name], **changes}, lambda _: None)


def test_an_earthquake_at_the_edge_overturns_some_variations_and_not_others():
    found = varied("temple")
    shares = {one.name: one.share for one in found.classes}
    assert set(shares) == {"overturned", "survived"}
    assert sum(shares.values()) == pytest.approx(1.0)
    for one in found.classes:
        assert 0.0 <= one.low < one.share < one.high <= 1.0
    assert found.outcomes.count("OVERTURNED") == round(shares["overturned"] * RUNS)


def test_a_steady_motion_stays_what_it_is():
    (only,) = varied("circle-strong").classes
    assert (only.name, only.share) == ("rolling", 1.0)


@pytest.mark.parametrize("name", [*CASES])
def test_each_case_has_variations_and_their_tilts(name):
    found = varied(name)
    assert {"slenderness", "scale"} <= {one.name for one in found.varied}
    assert all(0.0 < one.deviation < 0.15 for one in found.varied)
    assert len(found.tilts) == len(found.times) == len(found.outcomes) == found.runs == RUNS
    times, tilts = np.array(found.times, dtype=float), np.array(found.tilts, dtype=float)
    known = ~np.isnan(times)
    assert np.all(tilts[known] >= 0.0)
    if np.any(CASES[name].get("tilt", 0.0)):
        start = np.hypot(*CASES[name]["tilt"])
        assert np.ptp(tilts[:, 0]) > 0.0
        np.testing.assert_allclose(tilts[:, 0], start, rtol=0.05)
