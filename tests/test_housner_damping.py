"""Housner's damping of a column: its energy balance against integrated rocking, its limits and its refusals."""

import numpy as np
import pytest
from scipy.integrate import quad

import stylobate as sb
from stylobate.errors import ParameterError

STATUE = sb.Column(radius=0.25, mass_height=0.9, mass=420.0, transverse_inertia=95.0, axial_inertia=12.0)
MARBLE = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
TUB = sb.Column.solid(radius=1.0, height=2.0, density=1000.0)
AMPLITUDES = (0.25, 0.5, 0.75)


@pytest.mark.parametrize("column", [STATUE, MARBLE, TUB])
@pytest.mark.parametrize("amplitude", AMPLITUDES)
def test_housner_damping_takes_from_free_rocking_what_impacts_take(column, amplitude):
    steps = 8000
    options = {"tilt": (amplitude * column.tipping_angle, 0.0), "duration": 6.0 / column.frequency_parameter}
    options |= {"rtol": 1e-11, "samples": steps + 1}
    lossy = sb.simulate(sb.PlanarRocking(column), **options).data
    tilt, energy = lossy["tilt"][:, 0].to_numpy(), lossy["energy"].to_numpy()
    impact = np.flatnonzero(np.diff(np.sign(tilt)))[0]
    lost = energy[impact] - energy[impact + 1]
    # From the release to the vertical the damping couple, η ω0 J0 times the rate, would take half of that: ∫ θ̇ dθ.
    undamped = sb.simulate(sb.PlanarRocking(column, restitution=1.0), **options).data
    arc = slice(0, impact + 1)
    tilt, rate = (undamped[name][arc, 0].to_numpy() for name in ("tilt", "tilt_rate"))
    action = np.trapezoid(rate, tilt) - rate[-1] * tilt[-1]
    couple = column.housner_damping(amplitude) * column.frequency_scale * column.base_inertia
    assert 2.0 * couple * action == pytest.approx(lost, rel=100.0 / steps**2)


@pytest.mark.parametrize("column", [STATUE, MARBLE, TUB])
@pytest.mark.parametrize("amplitude", [1e-6, 0.5, 0.95])
def test_housner_damping_is_the_integral_over_a_quarter_cycle(column, amplitude):
    c, peak = column.slenderness, amplitude * column.tipping_angle

    def below(left):
        """Return U(A) − U(A − left), over m g h."""
        return 2.0 * np.sin(0.5 * left) * (c * np.cos(peak - 0.5 * left) - np.sin(peak - 0.5 * left))

    inertia = column.rim_inertia / column.base_inertia
    action, _ = quad(lambda s: np.sqrt(2.0 * below(s * s) / inertia) * 2.0 * s, 0.0, np.sqrt(peak), epsrel=1e-13)
    expected = (1.0 - column.housner_restitution**2) * below(peak) / (2.0 * action)
    assert column.housner_damping(amplitude) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("amplitude", AMPLITUDES)
def test_housner_damping_of_slender_columns_is_that_of_the_theory(amplitude):
    for c in (0.01, 0.02):
        column = sb.Column.dimensionless(c)
        e = float(sb.theory.housner_restitution(c, inertia_ratio=column.inertia_ratio))
        limit = float(sb.theory.equivalent_viscous_damping(amplitude * c, c=c, restitution=e))
        assert column.housner_damping(amplitude) == pytest.approx(limit, rel=c**2)


@pytest.mark.parametrize(("column", "values"), [(STATUE, (0.22, 0.15, 0.12)), (MARBLE, (0.115, 0.078, 0.063))])
def test_housner_damping_exceeds_its_slender_limit_by_the_order_of_the_square_of_c(column, values):
    exact = [column.housner_damping(amplitude) for amplitude in AMPLITUDES]
    np.testing.assert_allclose(exact, values, rtol=column.slenderness**2)


def test_a_column_too_flat_to_rock_back_loses_all():
    flat = sb.Column.solid(radius=2.0, height=1.0, density=1000.0)
    assert flat.housner_restitution == 0.0
    assert np.isfinite(flat.housner_damping())


@pytest.mark.parametrize("amplitude", [0.0, 1.0, -0.5, float("nan")])
def test_an_amplitude_outside_the_rocking_range_is_refused(amplitude):
    with pytest.raises(ParameterError, match=r"amplitude: must lie between 0 and 1"):
        MARBLE.housner_damping(amplitude)
