"""Round bodies that others measured: closed forms of spinning cylinders, cans that turn and disks that settle."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from validation import round_bodies as round_

import stylobate as sb


@pytest.mark.parametrize(("ratio", "tilt"), [(2.0, 0.3), (0.4, 0.2), (2.0, 1.3)])
def test_the_centre_of_mass_of_the_spinning_cylinder_stays_at_rest(ratio, tilt):
    column = round_.cylinder(ratio)
    rate = round_.centred_rate(column, tilt)
    # Short enough for the unstable motion: deviations grow from rounding.
    run = sb.simulate(sb.Rolling(column), **round_.centred_start(column, tilt), duration=1.0 / rate, rtol=1e-12)
    tilts, azimuth = run.data["amplitude"].to_numpy(), run.data["azimuth"].to_numpy()
    lever = column.mass_height * np.sin(tilts) - column.radius * np.cos(tilts)
    centre = run.data["contact_point"].to_numpy() + lever[:, None] * np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    assert np.ptp(centre, axis=0) / column.radius == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("ratio", [0.5, 1.5])
def test_no_steady_spin_exists_between_the_tipping_angle_and_that_of_fast_spin(ratio):
    column = round_.cylinder(ratio)
    low, high = sorted((column.tipping_angle, round_.fast_tilt(column)))
    tilts = np.linspace(0.01, 0.5 * np.pi - 0.01, 301)
    exists = np.isfinite([round_.centred_rate(column, tilt) for tilt in tilts])
    assert (exists == ((tilts < low) | (tilts > high))).all()
    assert 0 < exists.sum() < exists.size


def test_the_forbidden_range_vanishes_where_all_inertias_are_equal():
    column = round_.cylinder(round_.critical_height_ratio())
    assert column.transverse_inertia == pytest.approx(column.axial_inertia, rel=1e-6)


@pytest.mark.parametrize("lever", [0.002, 0.004])
def test_a_disk_with_rolling_resistance_has_the_exponents_of_its_closed_form(lever):
    run = round_.settle(rolling_resistance=lever, decades=1.0)
    # Finite tilts change the law by a fraction of the order of the tilt, 0.05, squared, and by h/r, 0.005.
    assert run.loss_power == pytest.approx(round_.RESISTANCE.power, abs=5e-3)
    assert run.inverse_rate_slope == pytest.approx(-lever / 3.0, rel=5e-3)
    root = np.sqrt(run.energy)  # θ ∝ (t_f − t)²
    line = np.polyfit(run.times, root, 1)
    assert np.polyval(line, run.times) == pytest.approx(root, abs=5e-3 * root[0])


def test_a_disk_with_damping_never_ends():
    for tilt in (0.05, 0.0125):  # the deviation is of the order of the tilt
        power = round_.settle(tilt=tilt, damping=1.0, decades=1.0).loss_power
        assert power == pytest.approx(-2.0, abs=0.2 * tilt)


@pytest.mark.parametrize("loss", round_.LOSSES, ids=lambda loss: loss.name)
def test_the_exponents_solve_the_balance_of_energy(loss):
    before = np.logspace(-3.0, 0.0, 2001)
    tilt = before**loss.tilt_exponent
    decay = np.gradient(np.log(tilt), np.log(before)) * tilt / before  # −dθ/dt
    power = np.polyfit(np.log(tilt**-0.5), np.log(decay), 1)[0]
    assert power == pytest.approx(loss.power, abs=1e-9)
    assert loss.rate_exponent == pytest.approx(-0.5 * loss.tilt_exponent)


def test_the_angle_of_turn_does_not_depend_on_the_axial_inertia():
    far, near = (abs(np.subtract(*round_.turns(offset))) for offset in (1e-2, 1e-4))
    assert near < 0.05 * far < 0.001


def test_the_pages_state_the_exponents_of_the_laws():
    docs = Path(__file__).parents[1] / "docs"
    if not docs.is_dir():
        pytest.skip("the documentation is not here")
    settling = (docs / "results" / "validation-measurements.md").read_text("utf-8")
    kitchen = (docs / "how-to" / "kitchen-experiments.md").read_text("utf-8")
    for loss in round_.LOSSES:
        numbers = (loss.power, loss.tilt_exponent, loss.rate_exponent)
        cells = " | ".join(str(Fraction(number).limit_denominator(9)).replace("-", "−") for number in numbers)
        assert f"| {cells} |" in settling
        n = 2.0 + loss.power
        assert f"| {n:g} | {2.0**-n:.3f} |" in kitchen
