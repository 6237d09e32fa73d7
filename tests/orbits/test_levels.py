"""Periodic orbits at the other levels of the ladder: exact multipliers, boundaries by theory, impacts with loss."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import NoOrbitError, ParameterError
from stylobate.orbits import BifurcationKind

C, A0, ETA, NU = 0.1, 0.065, 0.1, 3.0
COLUMN = sb.Column.dimensionless(C)
CIRCLE = sb.Harmonic.circular(acceleration=A0, angular_frequency=NU)
PERIOD = 2.0 * math.pi / NU


def stable_one(branches):
    """Amplitude, phase and eigenvalues of the stable branch among those of a closed form."""
    (index,) = np.flatnonzero(branches.stable)
    return float(branches.amplitude[index]), float(branches.phase[index]), branches.eigenvalues[index]


def near(amplitude, phase):
    x, y = amplitude * math.cos(phase), amplitude * math.sin(phase)
    return [x, y, -NU * y, NU * x]


LEVELS = {
    "wobbling": (sb.Wobbling(COLUMN, damping=ETA), lambda nu: sb.theory.wobbling_rolling(nu, A0, c=C, eta=ETA)),
    **{
        f"rolling {zeta}": (
            sb.Rolling(COLUMN, damping=ETA, spin_damping=zeta),
            lambda nu, zeta=zeta: sb.theory.full_rolling(nu, A0, c=C, eta=ETA, zeta=zeta),
        )
        for zeta in (0.1, 1.0)
    },
}


# In quick runs the column that rolls stands for all: each model has a flow of its own to compile.
NAMES = [pytest.param(name, marks=[] if name.startswith("rolling") else pytest.mark.slow) for name in LEVELS]
SLENDER = pytest.param("slender rolling", marks=pytest.mark.slow)


@pytest.mark.parametrize("name", NAMES)
def test_multipliers_are_exponentials_of_the_eigenvalues_at_finite_tilt(name):
    model, theory = LEVELS[name]
    amplitude, phase, eigenvalues = stable_one(theory(NU))
    orbit = sb.orbits.periodic_orbit(model, CIRCLE, guess=near(amplitude, phase))
    assert orbit.mean_tilt == pytest.approx(amplitude, rel=1e-9)
    expected = np.exp(eigenvalues * PERIOD)
    for multiplier in orbit.multipliers:
        assert np.abs(expected - multiplier).min() < 1e-7  # the eigenvalues are those of differences
    assert orbit.stable


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_branches_keep_to_the_theory_and_lose_stability_where_it_says(name):
    # With a spin the half orbit closes by the half turn, which leaves the spin as it is.
    model, theory = LEVELS[name]
    amplitude, phase, _ = stable_one(theory(NU))
    orbit = sb.orbits.periodic_orbit(model, CIRCLE, guess=near(amplitude, phase))
    branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(0.95, 3.5))
    frequencies = branch.points["angular_frequency"].to_numpy()
    for k in range(0, frequencies.size, 9):
        known = theory(frequencies[k]).amplitude
        assert np.nanmin(np.abs(known - float(branch.points["mean_tilt"][k]))) < 1e-9
    (lost,) = branch.bifurcations
    assert lost.kind is BifurcationKind.NEIMARK_SACKER
    below, above = (theory(lost.parameter * (1.0 + off)) for off in (-1e-6, 1e-6))
    assert not below.stable.any()
    assert above.stable.sum() == 1


@pytest.mark.parametrize(
    ("model", "names"),
    [
        pytest.param(
            sb.PlanarRocking(COLUMN, damping=0.1),
            ("damping", "slenderness", "angular_frequency"),
            marks=pytest.mark.slow,
        ),
        (sb.PlanarRocking(COLUMN, damping=0.1, restitution=0.9), ("restitution", "slenderness")),
        pytest.param(
            sb.Wobbling(COLUMN, damping=0.1, restitution=0.9),
            ("restitution", "angular_frequency"),
            marks=pytest.mark.slow,
        ),
    ],
    ids=["Housner", "measured", "wobbling"],
)
def test_rocking_with_impacts_repeats_and_its_derivatives_are_exact(model, names):
    line = sb.Harmonic.straight(acceleration=0.2, angular_frequency=6.0)
    run = sb.simulate(model, line, tilt=(0.02, 0.0), duration=300.0, rtol=1e-10)
    orbit = sb.orbits.periodic_orbit(model, line, guess=run)
    assert orbit.planar
    assert orbit.stable
    assert run.measures["peak_tilt_late"] == pytest.approx(orbit.peak_tilt, rel=2e-4)
    flow, step = orbit.system.carry(orbit.state, 0.0, 1.0), 1e-6

    def end(state):
        return orbit.system.carry(state, 0.0, 1.0).end

    differences = [(end(orbit.state + step * e) - end(orbit.state - step * e)) / (2.0 * step) for e in np.eye(2)]
    np.testing.assert_allclose(flow.by_start, np.stack(differences, axis=1), rtol=0.0, atol=1e-7)
    for name in names:
        value, step = orbit.system.value_of(name), 1e-6
        told = orbit.system.carry(orbit.state, 0.0, 1.0, change=orbit.system.derivative(name)).by_parameter
        ends = [orbit.system.changed(**{name: value + off}).carry(orbit.state, 0.0, 1.0).end for off in (step, -step)]
        np.testing.assert_allclose(told, (ends[0] - ends[1]) / (2.0 * step), rtol=1e-6, atol=1e-7)


def test_the_product_of_multipliers_tells_what_impacts_and_friction_take():
    # Liouville: phase area shrinks by exp(−ηT/K) and by e² at each of the two impacts of a period.
    e, eta = 0.9, 0.1
    model = sb.PlanarRocking(COLUMN, damping=eta, restitution=e)
    line = sb.Harmonic.straight(acceleration=0.2, angular_frequency=6.0)
    run = sb.simulate(model, line, tilt=(0.02, 0.0), duration=300.0, rtol=1e-10)
    orbit = sb.orbits.periodic_orbit(model, line, guess=run)
    inertia = 1.0 + COLUMN.inertia_ratio * C**2
    expected = math.exp(-eta * 2.0 * math.pi / 6.0 / inertia) * e**4
    assert float(np.prod(orbit.multipliers).real) == pytest.approx(expected, rel=1e-8)


def test_orbits_that_pass_the_upright_with_loss_out_of_a_plane_are_refused():
    amplitude, phase, _ = stable_one(LEVELS["rolling 0.1"][1](NU))
    frictions = {"damping": ETA, "spin_damping": 0.1}
    model = sb.Rolling(COLUMN, **frictions, restitution=0.9, passage_tilt=2.0 * amplitude)
    with pytest.raises(NoOrbitError, match="so close that it loses energy"):
        sb.orbits.periodic_orbit(model, CIRCLE, guess=near(amplitude, phase))


def test_a_restitution_that_is_not_given_cannot_be_followed():
    line = sb.Harmonic.straight(acceleration=0.2, angular_frequency=6.0)
    model = sb.PlanarRocking(COLUMN, damping=0.1)
    orbit = sb.orbits.periodic_orbit(model, line, guess=sb.simulate(model, line, tilt=(0.02, 0.0), duration=200.0))
    with pytest.raises(ParameterError, match=r"^parameter restitution has no value in model planar rocking"):
        sb.orbits.continue_branch(orbit, "restitution", bounds=(0.8, 0.99))


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("name", [*NAMES, SLENDER])
def test_steady_rolling_of_every_level_needs_no_guess(name, sense):
    slender = sb.SlenderRolling(COLUMN, damping=ETA, spin_damping=0.1)
    model = slender if name == "slender rolling" else LEVELS[name][0]
    circle = sb.Harmonic.circular(acceleration=A0, angular_frequency=NU, sense=sense)
    orbit = sb.orbits.periodic_orbit(model, circle)
    if name == "slender rolling":
        known = float(sb.theory.free_twist_rolling(NU, A0, c=C, eta=ETA, zeta=0.1).amplitude)
    else:
        known = stable_one(LEVELS[name][1](NU))[0]
    assert orbit.mean_tilt == pytest.approx(known, rel=1e-9)
    assert orbit.turns == sense
    assert orbit.stable


def test_a_guess_may_tell_the_spin():
    model, theory = LEVELS["rolling 0.1"]
    branches = theory(NU)
    amplitude, phase, _ = stable_one(branches)
    spin = float(branches.spin[np.flatnonzero(branches.stable)[0]])
    orbit = sb.orbits.periodic_orbit(model, CIRCLE, guess=[*near(amplitude, phase), spin])
    assert orbit.state[4] == pytest.approx(spin, rel=1e-9)
    with pytest.raises(ParameterError, match=r"and perhaps the spin \[rad/s\]"):
        sb.orbits.periodic_orbit(model, CIRCLE, guess=[0.0] * 6)
    with pytest.raises(ParameterError, match=r"^guess must be four numbers"):
        sb.orbits.periodic_orbit(LEVELS["wobbling"][0], CIRCLE, guess=[0.0] * 5)
