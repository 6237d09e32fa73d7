"""The column that can slip is another model where it does not: rolling, rubber, a planar block that rocks."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate import theory
from stylobate.models.sliding.balance import sense_of

COLUMN = sb.Column.dimensionless(slenderness=0.15, inertia_ratio=0.72, axial_ratio=0.6)
# No friction of either kind is ever all used by this.
ROUGH = 50.0
ROLLS = {"tilt": (0.08, 0.02), "tilt_rate": (0.03, -0.06)}
SHAKEN = sb.Harmonic.elliptic(amplitude=(0.07, 0.05), phase=0.9, angular_frequency=2.3) + sb.Harmonic.vertical(
    acceleration=0.2, angular_frequency=3.1
)
FRICTIONS = [{}, {"damping": 0.1}, {"spin_damping": 0.2}, {"rolling_resistance": 0.05}]
SEEN = np.linspace(0.5, 4.0, 8)
# The last 1e-6 of the way to the upright is told with constant speed, and misses as much of the energy at most.
CLOSED = 1e-6


def same(found, known, names, within):
    for name in names:
        np.testing.assert_allclose(found[name].to_numpy(), known[name].to_numpy(), rtol=0.0, atol=within, err_msg=name)


@pytest.mark.parametrize("friction", FRICTIONS, ids=lambda friction: next(iter(friction), "none"))
def test_where_nothing_slips_it_is_rolling(friction):
    options = {**ROLLS, "spin": 0.3, "duration": 4.0, "rtol": 1e-11}
    sliding = sb.Sliding(COLUMN, friction_coefficient=ROUGH, passage_tilt=1e-9, **friction)
    rolling = sb.Rolling(COLUMN, **friction)
    found, known = (sb.simulate(model, SHAKEN, **options).sample(SEEN) for model in (sliding, rolling))
    assert set(found["contact"].to_numpy()) == {2}
    same(found, known, ["tilt", "tilt_rate", "spin", "twist", "footprint", "energy"], 1e-9)
    same(found, known, ["normal_force", "friction_demand"], 1e-9)


@pytest.mark.parametrize("friction", FRICTIONS, ids=lambda friction: next(iter(friction), "none"))
def test_released_by_the_base_it_is_rolling(friction):
    shaking = sb.Harmonic.elliptic(amplitude=(0.25, 0.1), phase=0.5, angular_frequency=2.0, start_phase=-0.4 * math.pi)
    sliding = sb.Sliding(COLUMN, friction_coefficient=ROUGH, passage_tilt=1e-9, **friction)
    runs = [
        sb.simulate(model, shaking, duration=1.5, rtol=1e-11) for model in (sliding, sb.Rolling(COLUMN, **friction))
    ]
    assert [event.kind for event in runs[0].events] == [event.kind for event in runs[1].events] == ["uplift"]
    assert runs[0].events[0].time == pytest.approx(runs[1].events[0].time, abs=1e-13)
    # Both depart by the same series, which rolling resistance has no part in.
    found, known = (run.sample([0.7, 1.0, 1.5]) for run in runs)
    same(found, known, ["tilt", "tilt_rate", "spin", "twist", "footprint"], 1e-9)


@pytest.mark.parametrize("friction", [{}, {"damping": 0.1}], ids=["none", "damping"])
def test_a_patch_that_holds_rolls_as_on_rubber(friction):
    sliding = sb.Sliding(COLUMN, friction_coefficient=ROUGH, patch=3.0, passage_tilt=1e-9, **friction)
    rubber = sb.Wobbling(COLUMN, constraint="rubber", **friction)
    # Nothing turns about the vertical if w3 = w1 tan θ, w1 = −sin θ β̇.
    (x, y), (vx, vy) = ROLLS["tilt"], ROLLS["tilt_rate"]
    theta = math.hypot(x, y)
    spin = -math.sin(theta) * math.tan(theta) * (x * vy - y * vx) / theta**2
    found, known = (
        sb.simulate(model, SHAKEN, **ROLLS, **turning, duration=4.0, rtol=1e-11).sample(SEEN)
        for model, turning in ((sliding, {"spin": spin}), (rubber, {}))
    )
    assert set(found["contact"].to_numpy()) == {2}
    same(found, known, ["tilt", "tilt_rate", "normal_force"], 1e-9)


@pytest.mark.parametrize("direction", [0.0, 0.7])
def test_rocking_in_a_plane_is_planar_rocking_with_the_restitution_of_housner(direction):
    c, kappa = COLUMN.slenderness, COLUMN.inertia_ratio
    way = np.array([math.cos(direction), math.sin(direction)])
    sliding = sb.Sliding(COLUMN, friction_coefficient=ROUGH)
    planar = sb.PlanarRocking(COLUMN, restitution=float(theory.housner_restitution(c, inertia_ratio=kappa)))
    seen = np.linspace(0.3, 9.8, 25)
    runs = [sb.simulate(model, tilt=tuple(0.5 * c * way), duration=10.0, rtol=1e-11) for model in (sliding, planar)]
    assert sum(event.kind == "face_impact" for event in runs[0].events) > 2
    found, known = (run.sample(seen) for run in runs)
    same(found, known, ["tilt", "tilt_rate"], CLOSED)


def test_each_stroke_of_the_base_takes_the_energy_that_housner_has_it_take():
    c, kappa = COLUMN.slenderness, COLUMN.inertia_ratio
    run = sb.simulate(sb.Sliding(COLUMN, friction_coefficient=ROUGH), tilt=(0.5 * c, 0.0), duration=10.0, rtol=1e-11)
    housner = 1.0 - 2.0 * kappa * c**2 / (1.0 + kappa * c**2)
    strokes = [event.time for event in run.events if event.kind == "face_impact"]
    assert len(strokes) > 2
    for time in strokes:
        before, after = run.sample([time - 0.01, time + 0.01])["energy"].to_numpy()
        assert after / before == pytest.approx(housner**2, rel=CLOSED)


@pytest.mark.parametrize(("friction", "sticks"), [(1.05, True), (0.95, False)])
def test_a_stroke_sticks_with_the_friction_that_theory_requires(friction, sticks):
    # The impulse of a rim that stops leans by κc, and then the column has Housner's speed.
    c, kappa = COLUMN.slenderness, COLUMN.inertia_ratio
    # Rolling to the stroke needs less than the stroke: it comes from a small tilt.
    coefficient = friction * kappa * c
    run = sb.simulate(
        sb.Sliding(COLUMN, friction_coefficient=coefficient, static_friction_coefficient=ROUGH),
        tilt=(0.01 * c, 0.0), duration=0.3, rtol=1e-11, rest_energy=0.0,
    )  # fmt: skip
    stroke = next(event for event in run.events if event.kind == "face_impact")
    slip = run.sample([stroke.time + 1e-6])["slip_velocity"].to_numpy()
    assert (np.hypot(*slip[0]) < 1e-12) == sticks


@pytest.mark.parametrize(
    ("forcing", "mu", "frictions"),
    [(0.5, 0.05, {"zeta": 1.0}), (0.2, 0.1, {"zeta": 0.0, "patch": 0.1})],
    ids=["point", "patch"],
)
def test_steady_rolling_with_slip_stays(forcing, mu, frictions):
    column = sb.Column.dimensionless(slenderness=0.1)
    known = theory.slipping_rolling(3.0, forcing, mu=mu, c=0.1, eta=0.1, **frictions)
    branch = np.flatnonzero(known.stable)[-1]
    amplitude, phase = known.amplitude[branch], known.phase[branch]
    model = sb.Sliding(
        column, friction_coefficient=mu, damping=0.1, spin_damping=frictions["zeta"], patch=frictions.get("patch", 0.0)
    )
    d, n = np.array([math.cos(phase), math.sin(phase)]), np.array([-math.sin(phase), math.cos(phase)])
    slip = (known.slip_along[branch] * d + known.slip_across[branch] * n) * column.mass_height
    run = sb.simulate(
        model, sb.Harmonic.circular(acceleration=forcing, angular_frequency=3.0), tilt=tuple(amplitude * d),
        tilt_rate=tuple(3.0 * amplitude * n), spin=known.spin[branch], velocity=(*slip, 0.0), duration=6.0, rtol=1e-10,
    )  # fmt: skip
    assert not run.events
    data = run.data
    np.testing.assert_allclose(data["amplitude"], amplitude, rtol=1e-7)
    np.testing.assert_allclose(data["spin"], known.spin[branch], rtol=1e-7)
    np.testing.assert_allclose(np.hypot(*data["slip_velocity"].to_numpy().T), np.hypot(*slip), rtol=1e-7)
    np.testing.assert_allclose(data["normal_force"], 1.0, atol=1e-7)


def test_what_tips_before_it_slides_tips_though_it_would_slide_on():
    # Let go on a steep plane: pushed beyond what holds it, its base would slide on once it slid.
    kinetic, slenderness, static, incline = 0.14, 0.15, 0.25, 0.3
    assert kinetic < slenderness < static < math.tan(incline)
    model = sb.Sliding(
        sb.Column.dimensionless(slenderness=slenderness), friction_coefficient=kinetic,
        static_friction_coefficient=static, incline=incline,
    )  # fmt: skip
    run = sb.simulate(model, duration=20.0)
    assert run.outcome is sb.Outcome.OVERTURNED
    assert run.measures["time_rolling"] > 1.0


@pytest.mark.parametrize("normal", [0.0, -0.5])
def test_a_patch_that_the_plane_would_have_to_pull_gives_way_by_slip(normal):
    along, about = sense_of(0.2, 0.01, normal, 0.05, 0.3)
    assert along == pytest.approx(1.0, abs=1e-6)
    assert -1e-3 < about < 0.0
