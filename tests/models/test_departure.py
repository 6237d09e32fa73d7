"""How a column leaves its base: the series of every level against its equations, begun far nearer to the upright."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.models.model import Push

C = 0.2
COLUMN = sb.Column.dimensionless(C, 0.73, 0.5)
MODELS = {
    "slender": sb.Slender(COLUMN, damping=0.1),
    "slender rolling": sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.2),
    "wobbling": sb.Wobbling(COLUMN, damping=0.1),
    "rubber": sb.Wobbling(COLUMN, damping=0.1, constraint="rubber"),
    "rolling": sb.Rolling(COLUMN, damping=0.1, spin_damping=0.2),
}
BRAKED = {
    "wobbling": sb.Wobbling(COLUMN, damping=0.1, rolling_resistance=0.002),
    "rolling": sb.Rolling(COLUMN, damping=0.1, spin_damping=0.2, rolling_resistance=0.002),
}
CURVATURE = 0.4


def errors(model, excess, rate, turning, late, curvature=0.0):
    """Return the sizes of tilt, tilt rate and spin by series after `late`, and the error of each."""
    acceleration = C + excess

    def push(elapsed):  # mean rate over two thirds
        return Push((-1.0, 0.0), acceleration, excess, rate + curvature * elapsed / 3.0, turning)

    def pushed(tau):
        size = acceleration + (rate + 0.5 * curvature * tau) * tau
        return size * math.cos(turning * tau), size * math.sin(turning * tau), 0.0

    early = 2e-2 * late  # its error is lost in that of `late`
    begun = model.departure(push(early), early, *model.parameters)
    run = solve_ivp(
        lambda tau, y: model.rates(*y, *pushed(tau), *model.parameters), (early, late), begun, "DOP853",
        rtol=1e-12, atol=1e-25,
    )  # fmt: skip
    found = np.array(model.departure(push(late), late, *model.parameters))
    parts = [slice(0, 2), slice(2, 4), slice(4, None)][: 2 if model.spin_state is None else 3]
    return (
        np.array([np.linalg.norm(found[part]) for part in parts]),
        np.array([np.linalg.norm((found - run.y[:, -1])[part]) for part in parts]),
    )


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("turning", [2.0, -3.0])
def test_departure_by_a_jump_is_right_to_the_fourth_power_of_its_duration(name, turning):
    # Tilt Fδ²/2 + …δ³, off by δ⁴; the spin, δ², by δ³.
    model = MODELS[name]
    sizes, off = errors(model, 0.05, 0.1, turning, 1e-2, CURVATURE)
    _, twice = errors(model, 0.05, 0.1, turning, 2e-2, CURVATURE)
    powers = np.log2(twice / off)
    np.testing.assert_allclose(powers, [4.0, 3.0, 3.0][: powers.size], atol=0.25)
    assert np.all(off <= 2e-3 * sizes)


@pytest.mark.parametrize("model", [*MODELS.values(), *BRAKED.values()], ids=[*MODELS, *(f"braked {n}" for n in BRAKED)])
@pytest.mark.parametrize("excess", [0.0, 0.005])
def test_departure_along_a_curved_push_loses_no_speed(model, excess):
    # Off by δ⁴ in tilt and rate: the push F̈δ²/2 gives the speed δ³F̈/6, which a rate over the whole of δ has by half
    # too much. F̈ is CURVATURE. Rolling resistance is linear in the rate far below 1e-3.
    elapsed = 1e-3
    _, off = errors(model, excess, 0.1, 0.0, elapsed, CURVATURE)
    _, twice = errors(model, excess, 0.1, 0.0, 2.0 * elapsed, CURVATURE)
    assert np.all(np.log2(twice[:2] / off[:2]) > 3.75)
    assert off[1] < 0.05 * CURVATURE * elapsed**3 / 12.0


# The rubber column departs by the function of the wobbling one.
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name == "rubber" else name for name in MODELS]
)
def test_a_gradual_departure_leans_after_the_push_from_the_first(name):
    # The base acceleration grows through c: the tilt goes as δ³, its error as δ⁵; the spin as δ³, its error as δ⁴.
    model = MODELS[name]
    sizes, off = errors(model, 0.0, 0.1, 2.0, 1e-3)
    _, twice = errors(model, 0.0, 0.1, 2.0, 2e-3)
    powers = np.log2(twice / off)
    np.testing.assert_allclose(powers, [5.0, 4.0, 4.0][: powers.size], atol=0.35)
    assert np.all(off <= 2e-3 * sizes)


@pytest.mark.parametrize("name", MODELS)
def test_without_excess_a_column_stays(name):
    model = MODELS[name]
    state = model.departure(Push((-1.0, 0.0), C, 0.0, -0.1, 1.0), 1e-3, *model.parameters)
    assert not any(state)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("sense", [1, -1])
def test_a_column_shaken_off_its_base_does_not_depend_on_how_it_departs(name, sense):
    # The same run begun by the equations at a tilt of 1e-9: what the departure does is lost in its motion.
    model = MODELS[name]
    excess, nu, duration = 0.02, 2.0, 2.0
    motion = sb.Harmonic.circular(
        acceleration=(C + excess) * COLUMN.gravity, angular_frequency=nu * COLUMN.frequency_scale, sense=sense
    )
    run = sb.simulate(model, motion, duration=duration / COLUMN.frequency_scale, rtol=1e-11, samples=2)
    early = 1e-6
    push = Push((-1.0, 0.0), C + excess, excess, 0.0, sense * nu)
    begun = model.departure(push, early, *model.parameters)
    by_hand = solve_ivp(
        lambda tau, y: model.rates(
            *y, (C + excess) * math.cos(nu * tau), sense * (C + excess) * math.sin(nu * tau), 0.0,
            *model.parameters,
        ),
        (early, duration), begun, "DOP853", rtol=1e-12, atol=1e-22,
    )  # fmt: skip
    assert [event.kind for event in run.events] == ["uplift"]
    np.testing.assert_allclose(run.data["tilt"][-1], by_hand.y[:2, -1], rtol=0.0, atol=1e-9 * C)
    if model.spin_state is not None:
        spin = float(run.data["spin"][-1]) / COLUMN.frequency_scale
        assert abs(spin) > 0.01
        assert spin == pytest.approx(by_hand.y[4, -1], rel=2e-6)
