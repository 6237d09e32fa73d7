"""The scale of a record from which on a column slides on its base before it rocks."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes.assessment.inputs import Inputs
from stylobate.earthquakes.assessment.margins import least_slip_scale, standing_slip

STOUT = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
G, C = STOUT.gravity, STOUT.slenderness
NOISE = np.random.default_rng(7).normal(size=(200, 3)) * (2.0, 1.0, 1.5)


def test_the_scale_that_slides_is_the_one_at_which_a_standing_column_needs_the_friction():
    record, model = sb.Record(samples=NOISE, step=0.02), sb.Slender(STOUT)
    for friction in (0.05, 0.15, 0.3):
        scale = least_slip_scale(record, friction, STOUT)
        ratio = scale * np.hypot(*NOISE[:, :2].T) / (G + scale * NOISE[:, 2])
        assert ratio.max() == pytest.approx(friction, rel=1e-12)
        for factor, slips in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
            run = sb.simulate(model, record.scaled(scale * factor), duration=4.0, friction_coefficient=friction)
            assert not run.events
            assert bool(run.warnings) is slips


def test_without_a_vertical_component_it_is_the_peak_acceleration_that_decides():
    record = sb.Record(samples=NOISE[:, :2], step=0.02)
    peak = np.hypot(*NOISE[:, :2].T).max()
    assert least_slip_scale(record, 0.2, STOUT) == pytest.approx(0.2 * G / peak, rel=1e-14)


def test_only_a_column_that_slides_first_has_a_scale_at_which_it_slides_while_it_stands():
    record = sb.Record(samples=NOISE, step=0.02, name="noise")
    model = sb.Slender(STOUT)
    levels = {level: {"damping": eta} for level, eta in (("low", 0.01), ("central", 0.05), ("high", 0.1))}
    more = {"contact_laws": False, "variations": 0, "seed": 0, "width": 1e-2, "tail": 2.0, "least_records": 20}
    friction = {"rough": C, "smooth": 0.9 * C}
    inputs = Inputs.of(
        dict.fromkeys(friction, model), [record], levels, friction, [1.0], [0.5, 1.0], **more, options={}
    )
    assert inputs.sliding_first == ("smooth",)
    assert math.isnan(standing_slip(inputs, "rough", ["central"]).item())
    assert standing_slip(inputs, "smooth", ["central"]).item() == least_slip_scale(record, 0.9 * C, STOUT)


def test_the_peak_of_a_smooth_pulse_lies_between_the_looks():
    pulse = sb.Pulse.one_sine(acceleration=1.7, angular_frequency=9.0)
    assert least_slip_scale(pulse, 0.2, STOUT) == pytest.approx(0.2 * G / 1.7, rel=5e-4)


def test_a_base_at_rest_makes_nothing_slide():
    assert least_slip_scale(sb.Record(samples=np.zeros((5, 3)), step=0.1), 0.2, STOUT) == math.inf
