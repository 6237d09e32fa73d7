"""How long a run lasts where nobody says, and what is told of a column that moves at its end."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.run_arguments import FREE_TAIL

COLUMN = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
P = COLUMN.frequency_parameter
MODELS = [sb.Slender(COLUMN, damping=0.02), sb.Wobbling(COLUMN, damping=0.02), sb.Rolling(COLUMN, damping=0.02)]
SINE = sb.Pulse.one_sine(acceleration=4.0, angular_frequency=6.0)


@pytest.mark.parametrize("motion", [SINE, sb.Record(samples=[0.0, 1.0, 0.0], step=0.1), 0.3 * SINE.delayed(0.5)])
def test_without_a_duration_a_run_outlasts_a_motion_that_ends_by_twenty_time_scales(motion):
    run = sb.simulate(MODELS[0], motion)
    assert run.provenance["duration"] == pytest.approx(motion.duration + FREE_TAIL / P, rel=1e-14)


@pytest.mark.parametrize(
    ("motion", "what"),
    [
        (None, "a base at rest"),
        (
            sb.Harmonic.circular(acceleration=1.0, angular_frequency=2.0)
            + sb.Harmonic.straight(acceleration=0.1, angular_frequency=math.sqrt(2.0)),
            "a base motion that never ends and has no period",
        ),
    ],
)
def test_a_motion_that_neither_ends_nor_repeats_wants_a_duration(motion, what):
    with pytest.raises(ParameterError, match=f"^duration must be given, in s, with {what}, such as duration=60.0"):
        sb.simulate(MODELS[0], motion)


# The wobbling column has the balance of the rolling one, and a test of its energy below.
QUICK = [
    pytest.param(model, id=model.name, marks=[pytest.mark.slow] if isinstance(model, sb.Wobbling) else [])
    for model in MODELS
]


@pytest.mark.parametrize("model", QUICK)
def test_what_is_told_to_be_safe_never_overturns_and_what_overturns_later_was_told_to_be_open(model):
    told = set()
    for scale in (0.6, 0.9, 1.2, 1.5, 1.8):
        motion = SINE.scaled(scale)
        for share in (0.5, 1.0, 1.5):
            run = sb.simulate(model, motion, duration=share * motion.duration)
            if run.outcome not in {Outcome.STILL_MOVING, Outcome.SURVIVED}:
                continue
            later = sb.simulate(model, motion, duration=motion.duration + 60.0 / P).outcome
            safe = run.outcome is Outcome.SURVIVED
            assert safe == ("cannot overturn any more" in run.reason)
            told.add((safe, later is Outcome.OVERTURNED))
            assert safe != run.reason.endswith("it may overturn later: simulate longer")
            assert not (share < 1.0 and safe)
    assert (True, True) not in told
    assert {(True, False), (False, True)} <= told


def test_the_energy_told_is_that_over_the_energy_of_the_balance():
    model = sb.Wobbling(COLUMN)
    let_go, alpha = 0.5 * COLUMN.tipping_angle, COLUMN.tipping_angle
    run = sb.simulate(model, tilt=(let_go, 0.0), tilt_rate=(0.0, 1e-3), duration=1.0)
    # Without friction it keeps the height R (cos(α − θ) − cos α) of its start.
    share = (math.cos(alpha - let_go) - math.cos(alpha)) / (1.0 - math.cos(alpha))
    assert f"it has {100.0 * share:.2g} % of the energy required" in run.reason


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS[:2])
def test_a_base_out_of_level_lowers_the_energy_that_overturns(model):
    told = set()
    for push in (0.0, 0.02 * COLUMN.gravity):
        for share in (0.3, 0.5, 0.7, 0.9, 0.95):
            start = {"tilt": (-share * COLUMN.tipping_angle, 0.0), "tilt_rate": (0.0, 0.0)}
            pulse = sb.Pulse.one_sine(acceleration=1e-6, angular_frequency=50.0).offset(-push)
            lossless = type(model)(COLUMN)
            early, later = (sb.simulate(lossless, pulse, **start, duration=d) for d in (0.2, 40.0))
            safe, fell = early.outcome is Outcome.SURVIVED, later.outcome is Outcome.OVERTURNED
            told.add((push > 0.0, safe, fell))
    assert not {(False, True, True), (True, True, True)} & told
    assert {(False, True, False), (True, True, False), (True, False, True)} <= told


def test_a_column_beyond_its_balance_is_not_told_to_be_safe():
    falling = sb.simulate(MODELS[1], tilt=(1.0001 * COLUMN.tipping_angle, 0.0), tilt_rate=(-1e-3, 0.0), duration=0.01)
    assert falling.outcome is Outcome.STILL_MOVING
    assert falling.reason.endswith("it may overturn later: simulate longer")


def test_times_before_and_after_the_base_motion_are_told_in_seconds():
    weak = 0.6 * SINE
    before, after = (sb.simulate(MODELS[0], weak, duration=weak.duration + t).reason for t in (-0.25, 0.25))
    assert "0.25 s before the base motion ends" in before
    assert "0.25 s after the base motion ended" in after


def test_a_column_that_stands_before_the_end_of_its_pulse_is_not_told_to_be_safe():
    vase = sb.Rolling(sb.Column.frustum(radius=0.05, top_radius=0.09, height=0.45, density=1800.0), damping=0.03)
    pulse = sb.Pulse.ricker(acceleration=5.0, angular_frequency=2.0)
    early = sb.simulate(vase, pulse, duration=4.0)
    assert early.outcome is sb.Outcome.AT_REST
    assert "before the base motion stops; it may still be uplifted: follow it longer" in early.reason
    assert sb.simulate(vase, pulse).outcome is sb.Outcome.OVERTURNED


slender_rates, slender_planar = sb.Slender.rates, sb.Slender.planar_rates


class Leaning(sb.Slender):
    """A slender column on a base that gives way, or holds it: the moment −kα of a spring beside that of the weight."""

    k = -0.5
    contact = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, k):
        _, _, bx, by = slender_rates(x, y, vx, vy, ax, ay, az, c, eta, 0.75)
        return vx, vy, bx - k * x, by - k * y

    @staticmethod
    def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, k):
        return rate, slender_planar(tilt, rate, side, horizontal, vertical, c, eta)[1] - k * tilt

    @staticmethod
    def no_return_tilt(largest, least, c, eta, k):
        return math.inf if 1.0 + least <= k else (c * (1.0 + least) + largest) / (1.0 + least - k)

    @property
    def parameters(self):
        return self.column.slenderness, self.damping, self.k


class Balanced(Leaning):
    """The same with its own energy and balance, c/(1 − k)."""

    def energy(self, states):
        stored = 0.5 * self.k * (states[0] ** 2 + states[1] ** 2)
        return sb.Slender.energy(self, states) + stored * self.column.base_inertia / self.time_scale**2

    @property
    def balance(self):
        c, unit = self.column.slenderness, self.column.base_inertia / self.time_scale**2
        return sb.models.Balance(tilt=c / (1.0 - self.k), energy=0.5 * c * c * unit / (1.0 - self.k))


def pushed_outwards(cls, share_of_bare_balance):
    # ½Ȧ² + cA − ½A² is this share of ½c².
    column = sb.Column.dimensionless(0.1)
    rate = math.sqrt(0.01 * share_of_bare_balance - 0.2 * 0.02 + 0.02**2)
    start = {"tilt": (0.02, 0.0), "tilt_rate": (rate, 0.0)}
    return sb.simulate(cls(column), **start, duration=0.2), sb.simulate(cls(column), **start, duration=20.0)


@pytest.mark.slow
def test_a_model_of_other_equations_does_not_inherit_the_claim_that_it_cannot_overturn_any_more():
    early, later = pushed_outwards(Leaning, 0.91)
    assert early.reason.endswith("it may overturn later: simulate longer")
    assert later.outcome is Outcome.OVERTURNED


def test_a_model_that_states_its_own_balance_makes_the_claim_where_it_is_true():
    sb.models.check(Balanced(COLUMN))
    early, later = pushed_outwards(Balanced, 0.91)
    assert early.reason.endswith("it may overturn later: simulate longer")
    assert later.outcome is Outcome.OVERTURNED
    early, later = pushed_outwards(Balanced, 0.6)
    share = (0.6 * 0.5 * 0.01 - 0.5 * 0.5 * 0.02**2) / (0.5 * 0.01 / 1.5)
    assert f"cannot overturn any more: it has {100.0 * share:.2g} % of the energy required" in early.reason
    assert later.outcome is Outcome.STILL_MOVING


@pytest.mark.slow
def test_a_model_that_can_never_overturn_can_say_so():
    class Held(Balanced):
        k = 1.2

        @property
        def balance(self):
            return sb.models.Balance(tilt=math.inf, energy=math.inf)

    sb.models.check(Held(COLUMN))
    run = sb.simulate(Held(sb.Column.dimensionless(0.1)), tilt=(0.3, 0.0), tilt_rate=(0.0, 0.3), duration=1.0)
    assert "cannot overturn any more: it has 0 % of the energy required" in run.reason


ISOTROPIC = sb.SlenderRolling(COLUMN, damping=0.02, spin_damping=0.02, couples="isotropic")


@pytest.mark.slow
@pytest.mark.parametrize(
    "model",
    [*QUICK, *(pytest.param(one, id=one.name) for one in (sb.PlanarRocking(COLUMN, restitution=1.0), ISOTROPIC))],
)
def test_ensembles_and_single_runs_agree_on_who_survived(model):
    motion = (
        SINE if model.planar_only else SINE + sb.Pulse.one_sine(acceleration=1.0, angular_frequency=5.0, direction=1.0)
    )
    scales, delays = np.linspace(0.2, 1.6, 24), np.tile([0.0, 0.5], 12)
    durations = delays + motion.duration + np.tile([3.0, 0.5, 0.2, -0.3], 6)
    varied = {"scale": scales, "delay": delays, "size": np.linspace(0.9, 1.1, 24)}
    runs = sb.simulate_ensemble(model, motion, duration=durations, parameters=varied)
    alone = []
    for number, duration in enumerate(durations):
        values = {name: values[number] for name, values in varied.items()}
        alone.append(sb.simulate(*sb.with_parameters(model, motion, **values), duration=duration).outcome)
    assert runs["outcome"].values.tolist() == alone
    assert (Outcome.SURVIVED in alone) == (model is not ISOTROPIC)
    assert {Outcome.STILL_MOVING, Outcome.OVERTURNED} <= set(alone)


def test_a_run_as_long_as_its_base_motion_has_outlived_it():
    runs = sb.simulate_ensemble(MODELS[0], 0.6 * SINE, duration=SINE.duration)
    assert runs["outcome"] == sb.simulate(MODELS[0], 0.6 * SINE, duration=SINE.duration).outcome == Outcome.SURVIVED


def test_a_column_that_moves_freely_has_no_base_motion_to_survive():
    start = {"tilt": (0.1 * COLUMN.tipping_angle, 0.0), "duration": 0.2}
    run = sb.simulate(MODELS[0], **start)
    assert run.outcome == sb.simulate_ensemble(MODELS[0], **start)["outcome"] == Outcome.STILL_MOVING
    assert "cannot overturn any more" in run.reason


def test_a_column_that_came_to_rest_after_its_base_motion_is_at_rest():
    run = sb.simulate(sb.Wobbling(COLUMN, damping=0.3), 0.6 * SINE, duration=60.0)
    assert any(event.kind == "rest" for event in run.events)
    assert run.outcome is Outcome.AT_REST


def test_basins_under_a_pulse_list_the_columns_that_survived():
    found = sb.studies.basins(MODELS[0], 0.6 * SINE, over={"tilt_x": [0.0, 0.01], "tilt_y": [0.0, 0.02]}, duration=3.0)
    assert "survived" in found["attractor_kind"]
    assert sb.plot(found).legends
