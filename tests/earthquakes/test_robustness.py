"""A verdict far from the boundary stands under every small change; one at the boundary falls."""

import json
import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import SMALL_PERTURBATIONS, incremental_dynamic_analysis, robustness
from stylobate.earthquakes.perturbations import (
    ComponentScaled,
    DissipationScaled,
    Filtered,
    PerturbationOf,
    Polarity,
    Resampled,
    RestEnergy,
    ScaledRecord,
    Shifted,
    SizeScaled,
    SlendernessScaled,
    ToleranceScaled,
    TurnedRecord,
    WithoutVertical,
)

MODEL = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0), damping=0.05)
PULSE = sb.Pulse.one_sine(acceleration=1.0, angular_frequency=6.0)


def overturns(scale):
    found = incremental_dynamic_analysis(MODEL, PULSE, scales=[scale])
    return bool(found["reached"].sel(limit_state="overturning").item() == 1)


@pytest.fixture(scope="module")
def boundary():
    low, high = 2.0, 20.0
    assert not overturns(low)
    assert overturns(high)
    while high / low > 1.0 + 1e-6:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if overturns(middle) else (middle, high)
    return low


def test_at_the_boundary_changes_flip_the_verdict_and_far_from_it_none_does(boundary):
    near = robustness(MODEL, PULSE, scale=boundary)
    assert not bool(near["repeatable"])
    flips = near["flips"].sel(limit_state="overturning").isel(record=0)
    for change in (ScaledRecord(1.02), ScaledRecord(1.05), SizeScaled(0.98), SlendernessScaled(0.99)):
        assert bool(flips.sel(change=change.name))
    for change in (ScaledRecord(0.98), SizeScaled(1.02), SlendernessScaled(1.01), Polarity(), TurnedRecord(0.05236)):
        assert not bool(flips.sel(change=change.name))
    assert 0.0 < float(near["share_flipped"].sel(limit_state="overturning").item()) < 1.0
    peaks = np.append(near["tilt_ratio"], near["tilt_ratio_as_given"])
    scatter = np.std(np.log(peaks[np.isfinite(peaks) & (peaks > 0.0)]), ddof=1)
    assert float(near["tilt_dispersion"].item()) == pytest.approx(scatter, rel=1e-12)
    for scale in (0.7 * boundary, 3.0 * boundary):
        far = robustness(MODEL, PULSE, scale=scale)
        assert bool(far["repeatable"])
        assert float(far["share_flipped"].sel(limit_state="overturning").item()) == 0.0
        assert bool(np.isinf(far["tilt_ratio_as_given"]).item()) == (scale > boundary)


def test_a_round_column_does_not_feel_the_direction_of_the_record(boundary):
    found = robustness(MODEL, PULSE, scale=0.9 * boundary, changes=[Polarity(), TurnedRecord(1.0), Shifted()])
    np.testing.assert_allclose(found["tilt_ratio"], float(found["tilt_ratio_as_given"].item()), rtol=1e-6)
    assert float(found["tilt_dispersion"].item()) < 1e-6


def test_each_change_is_the_run_of_what_it_changes():
    record = sb.Record(
        samples=np.hanning(60)[:, np.newaxis] * np.random.default_rng(2).normal(size=(60, 3)) * (5.0, 5.0, 0.8),
        step=0.02,
        name="noise",
    )
    tail = 3.0
    changed = {
        ScaledRecord(1.05): (MODEL, record.scaled(1.05)),
        TurnedRecord(0.3): (MODEL, record.rotated(0.3)),
        Polarity(): (MODEL, record.inverted()),
        WithoutVertical(): (MODEL, record.scaled(1.0, vertical=0.0)),
        ComponentScaled("y", 0.9): (MODEL, record.changed("", samples=record.samples * (1.0, 0.9, 1.0))),
        ComponentScaled("z", 0.5): (MODEL, record.scaled(1.0, vertical=0.5)),
        Shifted(0.25): (MODEL, record.delayed(0.005)),
        Resampled(0.5): (MODEL, record.resampled(0.01)),
        Filtered(lowpass=10.0): (MODEL, record.filtered(lowpass=10.0)),
        DissipationScaled(1.25): (sb.Slender(MODEL.column, damping=0.0625), record),
        SlendernessScaled(0.99): (sb.Slender(MODEL.column.with_slenderness(0.99 * 0.2), damping=0.05), record),
        SizeScaled(1.02): (sb.Slender(MODEL.column.resized(1.02), damping=0.05), record),
        ToleranceScaled(0.01): (MODEL, record),
    }
    found = robustness(MODEL, record, changes=list(changed), tail=tail)
    for change, (model, motion) in changed.items():
        own = found.sel(change=change.name, record="noise")
        both = {"changed": motion, "with a vertical component": record}
        alone = incremental_dynamic_analysis(
            model, both, scales=[1.0], tail=tail, rtol=1e-8 * change.tolerance_factor
        ).sel(record="changed")
        assert int(own["outcome"]) == int(alone["outcome"][0])
        assert float(own["tilt_ratio"]) == pytest.approx(float(alone["tilt_ratio"][0]), rel=1e-5)
    assert np.unique(found["tilt_ratio"].to_numpy().round(4)).size > 8
    assert found["tilt_ratio_low"].item() <= found["tilt_ratio"].min() <= found["tilt_ratio_high"].item()


def test_a_lower_rest_threshold_is_the_run_with_that_threshold():
    # Two bursts: what is left of the first when the second comes is forgotten, or not, by the threshold.
    time = 0.02 * np.arange(401)
    burst = np.where(time < 1.0, np.sin(np.pi * time) ** 2 * np.sin(3.0 * np.pi * time), 0.0)
    push = 2.8 * (burst + 0.8 * np.roll(burst, 150))
    record = sb.Record(samples=np.stack([push, 0.4 * np.abs(push)], axis=-1), step=0.02, name="twice")
    model = sb.Slender(MODEL.column, damping=0.6)
    values = (1e-2, 1e-6)
    found = robustness(model, {"twice": record}, changes=[RestEnergy(value) for value in values], tail=2.0)
    for value in values:
        alone = incremental_dynamic_analysis(model, {"twice": record}, scales=[1.0], tail=2.0, rest_energy=value)
        own = found.sel(change=f"rest energy {value:g}", record="twice")
        assert float(own["tilt_ratio"]) == pytest.approx(float(alone["tilt_ratio"].item()), rel=1e-12)
    assert np.ptp(found["tilt_ratio"].to_numpy()) > 1e-3
    assert {RestEnergy(1e-6), RestEnergy(1e-7)} <= set(SMALL_PERTURBATIONS)
    with pytest.raises(sb.errors.ParameterError, match="value must be zero or positive"):
        RestEnergy(-1.0)


def test_changes_that_do_not_apply_are_told_and_not_counted():
    found = robustness(sb.Slender(MODEL.column), {"pulse": PULSE}, scale=3.0)
    applies = found["applies"].sel(record="pulse")
    for change in (Resampled(), Filtered(lowpass=20.0), ComponentScaled("x", 1.05), DissipationScaled(0.8)):
        assert not bool(applies.sel(change=change.name))
    assert int(found["changes_compared"].sel(limit_state="overturning").item()) == int(applies.sum())
    assert set(found["change_of"].to_numpy()) == {one.value for one in PerturbationOf}
    assert found.sizes["change"] == len(SMALL_PERTURBATIONS)


def test_a_result_tells_from_what_it_was_made():
    changes = [ScaledRecord(1.02), Polarity()]
    found = robustness(MODEL, {"pulse": PULSE}, scale=0.5, changes=changes, tail=1.0, rtol=1e-6)
    provenance = json.loads(found.attrs["provenance"])
    assert provenance["model"] == {"kind": "slender", "damping": 0.05}
    assert provenance["motion"]["motions"][0]["angular_frequency"] == 6.0
    assert (provenance["scale"], provenance["tail"], provenance["rtol"], provenance["rotations"]) == (
        0.5,
        1.0,
        1e-6,
        [0.0],
    )
    assert provenance["changes"] == [repr(change) for change in changes]
    assert found.attrs["kind"] == "robustness"


@dataclass(frozen=True, slots=True)
class Dragged(sb.Slender):
    """A slender column with a number of its own that dissipates, and one that does not."""

    drag: Annotated[float, sb.Quantity(text="drag", ge=0.0, dissipates=True)] = 0.0
    stiffness: Annotated[float, sb.Quantity(text="stiffness", ge=0.0)] = 0.0


def test_every_number_that_a_model_declares_as_dissipating_is_scaled():
    column = sb.Column.dimensionless(0.1)
    assert DissipationScaled(2.0).changed_values(Dragged(column, drag=0.3, stiffness=0.4)) == {"drag": 0.6}
    part = sb.Sliding(column, normal_restitution=0.9, damping=0.1)
    assert DissipationScaled(0.5).changed_values(part) == pytest.approx({"normal_restitution": 0.95, "damping": 0.05})
    assert DissipationScaled(2.0).changed_values(sb.Sliding(column)) == {"normal_restitution": 0.0}


def test_restitution_is_a_dissipation_too():
    column = MODEL.column
    assert DissipationScaled(0.8).changed_values(sb.Wobbling(column, restitution=0.9)) == {
        "restitution": pytest.approx(0.92)
    }
    housner = sb.PlanarRocking(column).impact_restitution
    assert DissipationScaled(1.25).changed_values(sb.PlanarRocking(column, damping=0.1)) == {
        "damping": pytest.approx(0.125),
        "restitution": pytest.approx(1.0 - 1.25 * (1.0 - housner)),
    }
    assert DissipationScaled(0.8).changed_values(sb.Wobbling(column)) is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"changes": []}, "changes must hold at least one change"),
        ({"changes": [Polarity(), Polarity()]}, "each only once"),
        ({"changes": ["polarity"]}, "changes must be perturbations such as"),
        ({"scale": 0.0}, "scale must be positive"),
        ({"tilt_limit": 0.1}, "tilt_limit must be left out"),
    ],
)
def test_mistakes_are_told(change, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        robustness(MODEL, PULSE, **change)
