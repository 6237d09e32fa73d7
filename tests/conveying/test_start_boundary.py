"""What begins to move first over slenderness: against runs of the whole model, and what comes after it."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.models import Contact
from stylobate.theory import FirstMotion

COLUMN = sb.Column.solid(radius=0.3, height=2.0, density=2700.0)
FREQUENCY = 4.0
# slenderness, μ, vertical over horizontal, incline
CASES = [
    (0.15, 0.4, 0.0, 0.0),
    (0.6, 0.4, 0.0, 0.0),
    (0.15, 0.4, 1.0, 0.0),
    (0.6, 0.4, 1.5, 0.0),
    (0.3, 0.5, 0.5, 0.1),
    (0.5, 0.3, 0.5, 0.1),
]


def model_of(c, mu, incline=0.0):
    # The way down is that of -x: the base accelerates uphill along +x.
    shaped = COLUMN.with_slenderness(c)
    return sb.Sliding(shaped, friction_coefficient=mu, incline=incline, incline_direction=math.pi)


def shaken(model, acceleration, ratio=0.0, periods=2.6, ramp=2.0):
    """Return a run from rest in which the amplitude grows slowly."""
    period = 2.0 * math.pi / FREQUENCY
    motion = sb.Harmonic(
        amplitude=(acceleration, 0.0, ratio * acceleration), angular_frequency=FREQUENCY, ramp=ramp * period
    )
    return sb.simulate(model, motion, duration=periods * period)


@pytest.mark.slow
@pytest.mark.parametrize(("c", "mu", "ratio", "incline"), CASES)
def test_runs_stay_below_and_begin_above_with_what_is_told(c, mu, ratio, incline):
    model = model_of(c, mu, incline)
    found = sb.conveying.start_boundary(model, slenderness=c, vertical_ratio=ratio).squeeze()
    least = float(found["acceleration"])
    below, above = (shaken(model, least * factor, ratio) for factor in (1.0 - 1e-3, 1.0 + 1e-2))
    assert not below.events
    assert below.measures["peak_tilt"] == 0.0
    begins = {FirstMotion.SLIDE: "slide", FirstMotion.ROCK: "uplift"}
    assert above.events[0].kind == begins[FirstMotion(int(found["first_motion"]))]


@pytest.mark.parametrize("excess", [1.1, 2.0, 5.0])
def test_what_slides_from_rest_never_tips_by_horizontal_motion(excess):
    found = sb.conveying.start_boundary(model_of(0.3, 0.25), slenderness=0.3).squeeze()
    run = shaken(model_of(0.3, 0.25), excess * float(found["rock"]))
    assert set(np.unique(run.data["contact"])) <= {Contact.RESTING, Contact.SLIDING}
    assert run.measures["peak_tilt"] == 0.0


def test_what_rocks_slips_on_its_rim_only_as_it_bears_more():
    model = model_of(0.1, 0.12)
    least = float(sb.conveying.start_boundary(model, slenderness=0.1).squeeze()["acceleration"])
    gently, hard = shaken(model, 1.001 * least), shaken(model, 3.0 * least)
    assert gently.measures["time_slipping"] == 0.0
    assert gently.measures["time_rolling"] > 0.0
    kinds = [event.kind for event in hard.events]
    assert kinds[0] == "uplift"
    assert "slip" in kinds
    assert hard.measures["time_sliding"] == 0.0


def test_the_first_motion_does_not_depend_on_ratio_or_incline_but_its_acceleration_does():
    found = sb.conveying.start_boundary(
        model_of(0.3, 0.3),
        slenderness=[0.1, 0.2, 0.4],
        friction_coefficient=[0.15, 0.3],
        vertical_ratio=[0.0, 0.5, 1.0],
        incline=[0.0, 0.05],
    )
    first = found["first_motion"]
    assert (first == first.isel(vertical_ratio=0, incline=0)).all()
    slips = found["slenderness"] > found["friction_coefficient"]
    np.testing.assert_array_equal(first.isel(vertical_ratio=0, incline=0) == FirstMotion.SLIDE, slips)
    held = np.minimum(found["slenderness"], found["friction_coefficient"]) * 9.80665
    level = found["acceleration"].sel(vertical_ratio=0.0, incline=0.0)
    np.testing.assert_allclose(level, held, rtol=1e-14)
    # On a slope what moves along with the push uphill adds weight as it loads: that may help.
    assert (found["acceleration"].sel(incline=0.0).diff("vertical_ratio") < 0.0).all()
    assert (found["acceleration"].sel(vertical_ratio=0.0).diff("incline") < 0.0).all()


def test_its_figure_draws_bold_what_happens_first():
    found = sb.conveying.start_boundary(
        model_of(0.3, 0.3), slenderness=np.linspace(0.05, 0.8, 61), friction_coefficient=[0.2, 0.5]
    )
    (axes,) = sb.plot(found).axes
    bold = [line for line in axes.lines if line.get_linewidth() > 2.0]
    assert len(bold) == 3
    for line, mu in zip(bold[1:], (0.2, 0.5), strict=True):
        shown = np.isfinite(line.get_ydata())
        np.testing.assert_array_equal(shown, found["slenderness"] > mu)
        np.testing.assert_allclose(line.get_ydata()[shown], mu * 9.80665, rtol=1e-14)
    filled = sb.plot(found.isel(friction_coefficient=[0])).axes[0]
    assert len(filled.collections) == 3
    with pytest.raises(ParameterError, match="up to 4 frictions"):
        sb.plot(sb.conveying.start_boundary(model_of(0.3, 0.3), slenderness=0.1, friction_coefficient=np.arange(1, 6)))


@pytest.mark.parametrize(
    ("change", "error", "told"),
    [
        ({"model": sb.Rolling(COLUMN)}, UnsupportedError, "model rolling does not slide"),
        ({"slenderness": []}, ParameterError, "slenderness must have at least one value"),
        ({"slenderness": -0.1}, ParameterError, "slenderness"),
        ({"incline": 2.0}, ParameterError, "incline must lie between 0 and 1.57"),
        ({"vertical_phase": math.nan}, ParameterError, "vertical_phase"),
    ],
)
def test_bad_questions_are_told(change, error, told):
    with pytest.raises(error, match=told):
        sb.conveying.start_boundary(**({"model": model_of(0.3, 0.3), "slenderness": 0.1} | change))
