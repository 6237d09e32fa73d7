"""A block on a vibrating plane: every piece of its motion obeys its law, and a time-stepping scheme moves alike."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial.legendre import leggauss

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.theory import BlockPhase, SlidingRegime, block_cycle, hopping_speed, horizontal_sliding, mean_block_speed
from stylobate.theory.block_motion import HarmonicForce

EPS = float(np.finfo(float).eps)
TURN = 2.0 * math.pi
NODES, WEIGHTS = leggauss(40)  # exact to rounding for one harmonic over a period or two

# along, normal, friction, restitution, phase, incline
HORIZONTAL = (0.5, 0.0, 0.3, 0.0, 0.0, 0.0)
PRESSED = (0.7, 0.4, 0.4, 0.0, 0.0, 0.0)  # oblique, throw number below 1
UPHILL = (0.8, 0.5, 0.3, 0.0, -0.4, 0.1)
DOWNHILL = (0.8, 0.5, 0.4, 0.0, 0.7, 0.1)
THROWN = (1.0, 1.5, 0.4, 0.0, 0.0, 0.0)  # throw number above 1
THROWN_UPHILL = (1.0, 2.0, 0.4, 0.0, 0.0, 0.1)
BOUNCING = (1.0, 1.3, 0.4, 0.3, 0.5, 0.1)
CASES = [HORIZONTAL, PRESSED, UPHILL, DOWNHILL, THROWN, THROWN_UPHILL, BOUNCING]

motions = st.tuples(
    st.floats(0.0, 2.0),
    st.floats(0.0, 3.0),
    st.floats(0.05, 1.0),
    st.floats(0.0, 0.6),
    st.floats(-3.0, 3.0),
    st.floats(-0.3, 0.3),
)


def cycle_of(case, **options):
    along, normal, friction, restitution, phase, incline = case
    return block_cycle(
        along,
        normal,
        static_friction=friction,
        normal_restitution=restitution,
        phase=phase,
        incline=incline,
        **options,
    )


def forces(case, tau):
    """T if the block sticks, and N in contact."""
    along, normal, _, _, phase, incline = case
    return math.sin(incline) + along * np.cos(tau), math.cos(incline) + normal * np.cos(tau + phase)


def integral(function, start, end):
    """Integral over a segment, period by period."""
    edges = np.linspace(start, end, 2 + int((end - start) / TURN))
    middle, half = 0.5 * (edges[1:] + edges[:-1])[:, np.newaxis], 0.5 * np.diff(edges)[:, np.newaxis]
    return float(np.sum(half * WEIGHTS * function(middle + half * NODES)))


def accelerations(case, segment, kinetic):
    """u̇ and s̈ in a segment as functions of τ, written as in the table of the phases."""
    factor = {BlockPhase.FORWARD: -kinetic, BlockPhase.BACKWARD: kinetic, BlockPhase.FLIGHT: 0.0}

    def along_plane(tau):
        pull, load = forces(case, tau)
        return 0.0 * tau if segment.phase is BlockPhase.STICK else factor[segment.phase] * load - pull

    def off_plane(tau):
        return -forces(case, tau)[1] if segment.phase is BlockPhase.FLIGHT else 0.0 * tau

    return along_plane, off_plane


def size(case):
    return 1.0 + case[0] + case[1]


def certify(case, kinetic, segment):
    """Check that a segment obeys its law from its start to its end and that nothing ends it before."""
    along_plane, off_plane = accelerations(case, segment, kinetic)
    lasts = segment.end - segment.start
    rounding = 1e-12 * size(case) * (1.0 + lasts) ** 2 * (1.0 + segment.end)
    u0, u1 = segment.velocity
    assert u1 - u0 == pytest.approx(integral(along_plane, segment.start, segment.end), abs=rounding)
    moved = u0 * lasts + integral(lambda tau: (segment.end - tau) * along_plane(tau), segment.start, segment.end)
    assert segment.travel == pytest.approx(moved, abs=rounding)
    rise0, rise1 = segment.normal_velocity
    assert rise1 - rise0 == pytest.approx(integral(off_plane, segment.start, segment.end), abs=rounding)
    tau = np.linspace(segment.start, segment.end, 101)[1:-1]
    pull, load = forces(case, tau)
    if segment.phase is not BlockPhase.FLIGHT:
        assert np.all(load >= -rounding)
    if segment.phase is BlockPhase.STICK:
        assert np.all(np.abs(pull) <= case[2] * load + rounding)
    if segment.phase in {BlockPhase.FORWARD, BlockPhase.BACKWARD}:
        sense = 1.0 if segment.phase is BlockPhase.FORWARD else -1.0
        u = [u0 + integral(along_plane, segment.start, end) for end in tau[::10]]
        assert np.all(sense * np.array(u) >= -rounding)


def landings(cycle):
    """Pairs of segments with a landing between them, cyclic if the motion repeats."""
    following = (*cycle.segments[1:], cycle.segments[0])
    pairs = list(zip(cycle.segments, following, strict=True))[: None if cycle.repeats else -1]
    return [(one, two) for one, two in pairs if one.normal_velocity[1] < 0.0 <= two.normal_velocity[0]]


@given(case=motions, ratio=st.floats(0.5, 1.0))
def test_every_segment_obeys_its_law(case, ratio):
    cycle = cycle_of(case, kinetic_friction=ratio * case[2], cycles=30)
    for segment in cycle.segments[:40]:
        certify(case, ratio * case[2], segment)
    for before, after in zip(cycle.segments[:-1], cycle.segments[1:], strict=True):
        assert before.end == after.start
        assert before.phase is not after.phase or before.phase is BlockPhase.FLIGHT


@given(case=motions)
def test_a_flight_leaves_the_plane_and_ends_where_it_first_comes_back(case):
    cycle = cycle_of(case, cycles=30)
    inside = [segment for segment in cycle.segments[1:-1] if segment.phase is BlockPhase.FLIGHT]
    for flight in inside[:20]:
        _, off_plane = accelerations(case, flight, case[2])

        def gap(end, flight=flight, law=off_plane):
            thrown = flight.normal_velocity[0] * (end - flight.start)
            return thrown + integral(lambda tau: (end - tau) * law(tau), flight.start, end)

        rounding = 1e-13 * size(case) * (1.0 + flight.end) ** 2
        assert gap(flight.end) == pytest.approx(0.0, abs=rounding)
        between = np.linspace(flight.start, flight.end, 41)[1:-1]
        assert min(gap(end) for end in between) > -rounding


@given(case=motions, ratio=st.floats(0.5, 1.0))
def test_landings_rebound_by_the_restitution_and_friction_only_takes_from_the_slip(case, ratio):
    cycle = cycle_of(case, kinetic_friction=ratio * case[2], cycles=30)
    for before, after in landings(cycle):
        speed, rebound = -before.normal_velocity[1], after.normal_velocity[0]
        assert speed > 0.0
        if rebound == 0.0:
            assert case[3] * speed < 1e-9  # the stated small speed
        else:
            assert rebound == pytest.approx(case[3] * speed, rel=8.0 * EPS)
        u0, u1 = before.velocity[1], after.velocity[0]
        assert u0 * u1 >= 0.0
        assert abs(u1) <= abs(u0)
        taken = abs(u0) - abs(u1)
        assert taken <= ratio * case[2] * (speed + rebound) + 4.0 * EPS * abs(u0)
        assert u1 == 0.0 or taken == pytest.approx(ratio * case[2] * (speed + rebound), abs=8.0 * EPS * abs(u0))


def contact_force(case, segment, kinetic):
    """T and N in a segment as functions of τ."""
    along_plane, off_plane = accelerations(case, segment, kinetic)
    return (
        lambda tau: along_plane(tau) + forces(case, tau)[0],
        lambda tau: off_plane(tau) + forces(case, tau)[1],
    )


def base_velocity(case, tau):
    return case[0] * np.sin(tau), case[1] * np.sin(tau + case[4])


def friction_loss(case, segment, kinetic):
    """μk ∫ N |u| over a segment."""
    if segment.phase not in {BlockPhase.FORWARD, BlockPhase.BACKWARD}:
        return 0.0
    law, _ = accelerations(case, segment, kinetic)

    def power(tau):
        u = [segment.velocity[0] + integral(law, segment.start, end) for end in tau.ravel()]
        return kinetic * forces(case, tau)[1] * np.abs(np.reshape(u, tau.shape))

    return integral(power, segment.start, segment.end)


@pytest.mark.parametrize("case", CASES)
def test_over_a_cycle_the_contact_carries_the_weight(case):
    cycle = cycle_of(case)
    assert cycle.repeats
    tangential, normal = 0.0, 0.0
    for segment in cycle.segments:
        friction, load = contact_force(case, segment, case[2])
        tangential += integral(friction, segment.start, segment.end)
        normal += integral(load, segment.start, segment.end)
    for before, after in landings(cycle):
        tangential += after.velocity[0] - before.velocity[1]
        normal += after.normal_velocity[0] - before.normal_velocity[1]
    # Every segment is right to rounding, the repetition to 1e-13.
    tolerance = 1e-12 * size(case) * len(cycle.segments)
    assert tangential == pytest.approx(TURN * cycle.period * math.sin(case[5]), abs=tolerance)
    assert normal == pytest.approx(TURN * cycle.period * math.cos(case[5]), abs=tolerance)


@pytest.mark.parametrize("case", CASES)
def test_over_a_cycle_the_work_of_the_base_is_what_slip_and_landings_take_and_the_climb(case):
    cycle = cycle_of(case)
    work, slip, struck = 0.0, 0.0, 0.0
    for segment in cycle.segments:
        friction, load = contact_force(case, segment, case[2])

        def power(tau, friction=friction, load=load):
            along, off = base_velocity(case, tau)
            return friction(tau) * along + load(tau) * off

        work += integral(power, segment.start, segment.end)
        loss = friction_loss(case, segment, case[2])
        assert loss >= 0.0
        slip += loss
    for before, after in landings(cycle):
        along, off = base_velocity(case, before.end)
        (u0, u1), (rise0, rise1) = (
            (before.velocity[1], after.velocity[0]),
            (before.normal_velocity[1], after.normal_velocity[0]),
        )
        work += (u1 - u0) * along + (rise1 - rise0) * off
        loss = 0.5 * (u0**2 - u1**2 + rise0**2 - rise1**2)
        assert loss > 0.0
        struck += loss
    climb = math.sin(case[5]) * cycle.mean_speed * TURN * cycle.period
    assert work == pytest.approx(slip + struck + climb, abs=1e-12 * size(case) ** 2 * len(cycle.segments))


@pytest.mark.parametrize("case", CASES)
def test_a_mirrored_plane_conveys_the_other_way_and_a_delay_changes_nothing(case):
    along, normal, friction, restitution, phase, incline = case
    speed = cycle_of(case).mean_speed
    # As sensitive as bouncing makes it: the mirror image differs by rounding of cos(τ + π) and the rest rule.
    near = 1e-7 if restitution else 1e-12
    mirrored = cycle_of((-along, normal, friction, restitution, phase, -incline)).mean_speed
    assert mirrored == pytest.approx(-speed, abs=1e-13)
    delayed = cycle_of((-along, -normal, friction, restitution, phase, incline)).mean_speed
    assert delayed == pytest.approx(speed, abs=near)


@pytest.mark.parametrize(("along", "normal"), [(0.7, 0.0), (2.0, 0.0), (0.0, 0.8), (0.0, 1.5), (0.3, 0.0)])
def test_a_symmetric_motion_conveys_nothing(along, normal):
    cycle = block_cycle(along, normal, static_friction=0.4, kinetic_friction=0.3, start_velocity=0.2)
    assert cycle.repeats
    # A motion that never sticks comes to its cycle by the factor exp(−O(μ/a)) in a period, 1e-13 off some ten times.
    assert cycle.mean_speed == pytest.approx(0.0, abs=1e-11)


def time_stepped(case, steps, cycles, settled):
    """Mean speed by Moreau's time-stepping: no events, one complementarity problem in each step."""
    along, normal, friction, restitution, phase, incline = case
    h = TURN / steps
    gravity, weight = math.sin(incline), math.cos(incline)
    u = rise = gap = moved = 0.0
    for step in range(cycles * steps):
        if step == settled * steps:
            moved = 0.0
        tau = (step + 0.5) * h
        pull, load = h * (gravity + along * math.cos(tau)), h * (weight + normal * math.cos(tau + phase))
        before, u, fell, rise = u, u - pull, rise, rise - load
        if gap + 0.5 * h * fell <= 0.0:
            impulse = max(0.0, -rise - restitution * fell)
            rise += impulse
            u += max(-friction * impulse, min(friction * impulse, -u))
        moved += 0.5 * h * (before + u)
        gap += 0.5 * h * (fell + rise)
    return moved / (TURN * (cycles - settled))


def stepping_error(case, steps):
    """Error of the mean speed by time-stepping: the contact acts on the motion along the plane through T alone.

    Each switch of a period comes at most a step late. Until then T is wrong by no more than twice μN, in a landing by
    1 + e times that, and the velocity stays wrong for at most a period.
    """
    switches = 6 if case is BOUNCING else 4  # small bounces add up geometrically, to less than two
    return switches * 2.0 * case[2] * (1.0 + case[3]) * size(case) * TURN / steps


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("steps", [1000, 16000])
def test_time_stepping_conveys_as_fast(case, steps):
    cycle = cycle_of(case)
    assert cycle.period == 1
    assert time_stepped(case, steps, 10, 8) == pytest.approx(cycle.mean_speed, abs=stepping_error(case, steps))


@pytest.mark.parametrize("case", [UPHILL, DOWNHILL, BOUNCING])
def test_time_stepping_tells_frictions_apart(case):
    less = (*case[:2], 0.9 * case[2], *case[3:])
    assert abs(time_stepped(less, 16000, 10, 8) - cycle_of(case).mean_speed) > 10.0 * stepping_error(case, 16000)


AMPLITUDES = [0.31, 0.4, 0.55, 0.56, 0.8, 3.0]


@pytest.mark.parametrize("kinetic", [0.3, 0.2, 0.05])
@pytest.mark.parametrize("a0", AMPLITUDES)
def test_on_a_horizontal_plane_the_pieces_make_the_closed_forms(a0, kinetic):
    motion = horizontal_sliding(a0, static_friction=0.3, kinetic_friction=kinetic)
    cycle = block_cycle(a0, static_friction=0.3, kinetic_friction=kinetic)
    [forward] = [segment for segment in cycle.segments if segment.phase is BlockPhase.FORWARD]
    near = 1e-13 * (1.0 + a0) * 30.0 * a0 / kinetic  # a motion without stops comes to its cycle as exp(−O(μ/a))
    assert forward.start == pytest.approx(float(motion.onset), abs=near)
    assert forward.end - forward.start == pytest.approx(float(motion.slip_duration), abs=near)
    assert forward.travel == pytest.approx(float(motion.stroke), abs=near)
    assert (cycle.fraction[BlockPhase.STICK] == 0.0) == (motion.regime == SlidingRegime.SLIDES)
    # The velocity at the end of the acceleration, cos τ = −μk/a0 after π.
    peak = math.pi + math.acos(kinetic / a0)
    law, _ = accelerations((a0, 0.0, 0.3, 0.0, 0.0, 0.0), forward, kinetic)
    assert integral(law, forward.start, peak) == pytest.approx(float(motion.peak_velocity), abs=near)


@pytest.mark.parametrize("a0", AMPLITUDES)
def test_the_base_gives_what_horizontal_sliding_dissipates(a0):
    case, kinetic = (a0, 0.0, 0.3, 0.0, 0.0, 0.0), 0.2
    work = 0.0
    for segment in cycle_of(case, kinetic_friction=kinetic).segments:
        friction, _ = contact_force(case, segment, kinetic)
        work += integral(lambda tau, push=friction: push(tau) * a0 * np.sin(tau), segment.start, segment.end)
    motion = horizontal_sliding(a0, static_friction=0.3, kinetic_friction=kinetic)
    assert work == pytest.approx(float(motion.dissipation), abs=1e-11)


@pytest.mark.parametrize(("static", "kinetic"), [(1.0, 1.0), (0.4, 0.3), (0.4, 0.05)])
def test_sliding_without_stops_begins_at_its_amplitude(static, kinetic):
    critical = float(theory.sliding_amplitude(static_friction=static, kinetic_friction=kinetic))
    around = critical * (1.0 + np.array([-1e-9, 1e-9]))
    motion = horizontal_sliding(around, static_friction=static, kinetic_friction=kinetic)
    assert motion.regime.tolist() == [SlidingRegime.STICK_SLIP, SlidingRegime.SLIDES]
    for part in (motion.slip_duration, motion.peak_velocity, motion.stroke):
        assert part[0] == pytest.approx(part[1], rel=1e-4)  # the onset of slip bends like a square root at most
    stuck = [
        block_cycle(a0, static_friction=static, kinetic_friction=kinetic).fraction[BlockPhase.STICK]
        for a0 in critical * (1.0 + np.array([-1e-6, 1e-6]))
    ]
    assert stuck[0] > 0.0
    assert stuck[1] == 0.0


def test_the_known_ratio_of_friction_and_acceleration():
    ratio = 1.0 / float(theory.sliding_amplitude(static_friction=1.0))
    assert ratio == pytest.approx(2.0 / math.sqrt(4.0 + math.pi**2), rel=4.0 * EPS)
    assert ratio == pytest.approx(0.5370, abs=5e-5)


def test_a_block_on_a_weakly_shaken_plane_sticks():
    cycle = block_cycle(0.3, static_friction=0.3, incline=0.0)
    assert cycle.fraction[BlockPhase.STICK] == 1.0
    assert cycle.switches == ()
    assert horizontal_sliding(0.3, static_friction=0.3).regime == SlidingRegime.STICKS


@pytest.mark.parametrize("duration", [0.05, 0.3, 0.5, 0.9, 0.999])
@pytest.mark.parametrize("incline", [0.0, 0.2])
def test_a_flight_lasts_as_its_throw_number_tells(duration, incline):
    gamma = float(theory.flight_throw_number(duration))
    cycle = block_cycle(0.3, gamma * math.cos(incline), static_friction=0.5, incline=incline, phase=1.0)
    assert cycle.period == 1
    # dn/dΓ is at most 1/(Γ − 1) for these.
    assert cycle.fraction[BlockPhase.FLIGHT] == pytest.approx(duration, abs=8.0 * EPS * gamma / (gamma - 1.0))


def test_the_throw_number_of_a_flight_has_its_limits_and_no_seam():
    assert float(theory.flight_throw_number(1.0)) == pytest.approx(math.sqrt(1.0 + math.pi**2), rel=4.0 * EPS)
    assert float(theory.flight_throw_number(0.0)) == 1.0
    seam = 0.3 / TURN * (1.0 + np.array([-1e-12, 1e-12]))
    below, above = np.sqrt(theory.flight_throw_number(seam) ** 2 - 1.0)
    # The closed form loses as much as x⁴/24 is smaller than 1, and Γ² − 1 as much as it is smaller than Γ².
    assert below == pytest.approx(above, rel=EPS * 24.0 / 0.3**4 + 2e-12 + 4.0 * EPS * 16.0 / 0.3**2)


HOPPING = [(0.8, 2.4, 0.3, 0.2, -0.6, -0.1), (1.0, 3.4, 0.3, 0.0, 0.3, 0.2), (1.0, 2.9, 0.3, 0.05, 0.0, 0.0)]


def hopping_of(case):
    along, normal, friction, restitution, phase, incline = case
    options = {"normal_restitution": restitution, "kinetic_friction": friction, "phase": phase, "incline": incline}
    return float(hopping_speed(along, normal, **options))


def ripples(case):
    """By how much the error of a hopping motion exceeds what it still changes in a period, from its multipliers."""
    _, normal, _, e, _, incline = case
    gamma, rising = normal / math.cos(incline), math.pi * (1.0 - e) / (1.0 + e)
    trace = 1.0 + e**2 - (1.0 + e) ** 2 * math.sqrt(gamma**2 - rising**2)
    return 10.0 / (1.0 - np.abs(np.roots([1.0, -trace, e**2])).max())


@pytest.mark.parametrize("periods", [1, 2])
def test_inelastic_hops_last_whole_periods_on_their_plateau_and_nowhere_else(periods):
    # A flight of n periods that leaves where it lands has the speed nπ of its base, and is stable up to the second end.
    first, last = (math.hypot(start, periods * math.pi) for start in (1.0, 2.0))
    for normal in (first + 0.02, 0.5 * (first + last), last - 0.02):
        cycle = block_cycle(0.0, normal, static_friction=0.3, cycles=3000)
        assert cycle.period == periods
        assert cycle.fraction[BlockPhase.FLIGHT] == pytest.approx(1.0, abs=1e-9)
    below, above = (
        block_cycle(0.0, normal, static_friction=0.3, cycles=3000) for normal in (first - 0.02, last + 0.02)
    )
    assert below.fraction[BlockPhase.FLIGHT] < 1.0 - 1e-4
    assert above.period == 2 * periods


@pytest.mark.parametrize("case", HOPPING)
def test_hopping_from_rest_conveys_as_the_bouncing_ball_tells(case):
    cycle = cycle_of(case)
    assert cycle.period == 1
    assert cycle.fraction[BlockPhase.FLIGHT] == pytest.approx(1.0, abs=1e-12)
    assert cycle.mean_speed == pytest.approx(hopping_of(case), abs=1e-13 * size(case) * ripples(case))


@pytest.mark.parametrize(
    ("normal", "e", "incline"), [(1.3, 0.5, 0.0), (0.3, 0.9, 0.1), (0.19, 0.9, -0.1), (2.4, 0.2, 0.2)]
)
def test_hopping_goes_on_when_it_is_begun_also_where_a_block_at_rest_would_stay(normal, e, incline):
    # Thrown from the plane at the phase 0.02 after the landing of the bouncing ball, at its speed.
    rising = math.pi * (1.0 - e) / (1.0 + e)
    phase = math.pi - math.asin(rising * math.cos(incline) / normal) + 0.02
    case = (1.0, normal, 0.3, e, phase, incline)
    cycle = cycle_of(case, start_normal_velocity=TURN * math.cos(incline) * e / (1.0 + e))
    assert cycle.period == 1
    assert len(landings(cycle)) == 1
    assert cycle.mean_speed == pytest.approx(hopping_of(case), abs=1e-13 * size(case) * ripples(case))


def test_hopping_ends_where_its_period_doubles():
    e = 0.2
    flip = math.hypot(math.pi * (1.0 - e) / (1.0 + e), 2.0 * (1.0 + e**2) / (1.0 + e) ** 2)
    known = hopping_speed(1.0, flip * np.array([0.99999, 1.00001]), normal_restitution=e, kinetic_friction=0.3)
    assert np.isfinite(known).tolist() == [True, False]
    once, twice = (block_cycle(0.5, flip * part, static_friction=0.3, normal_restitution=e) for part in (0.99, 1.01))
    assert (once.period, twice.period) == (1, 2)
    assert twice.segments[-1].end == pytest.approx(2.0 * TURN)
    assert twice.mean_speed == pytest.approx(sum(segment.travel for segment in twice.segments) / (2.0 * TURN))


def test_hopping_needs_friction_to_hold_and_a_flight_clear_of_the_plane():
    assert np.isnan(hopping_speed(1.0, 2.4, normal_restitution=0.2, kinetic_friction=0.1, incline=0.2))
    without_rebound = math.sqrt(1.0 + math.pi**2) * np.array([1.0 - 1e-7, 1.0 + 1e-7])
    known = hopping_speed(1.0, without_rebound, normal_restitution=0.0, kinetic_friction=0.3)
    assert np.isfinite(known).tolist() == [False, True]
    begins = math.pi * 0.99 / 1.01  # with little rebound the block soon touches again
    assert np.isnan(hopping_speed(1.0, 1.001 * begins, normal_restitution=0.01, kinetic_friction=0.3))


def test_bounces_shrink_by_the_restitution_and_end_within_the_bounce_time():
    e, normal = 0.5, 0.5
    cycle = block_cycle(0.0, normal, static_friction=0.3, normal_restitution=e, start_normal_velocity=0.01, cycles=1)
    flights = [segment for segment in cycle.segments if segment.phase is BlockPhase.FLIGHT]
    lasts = np.array([flight.end - flight.start for flight in flights])
    # Each is 2v/N to a relative error of the time since τ = 0 times N'/N, which is at its largest 0.5/1.5 of that.
    np.testing.assert_allclose(lasts[1:] / lasts[:-1], e, atol=0.5 * lasts.sum())
    whole = lasts[0] + float(theory.bounce_time(0.01, normal_restitution=e, weight=1.0 + normal))
    assert lasts.sum() == pytest.approx(whole, rel=lasts.sum())
    assert float(theory.bounce_time(1.0, normal_restitution=e)) == pytest.approx(sum(2.0 * e**k for k in range(1, 60)))


def test_the_rest_speed_matters_no_more_than_its_bounces_last():
    coarse, fine = (cycle_of(BOUNCING, rest_speed=speed) for speed in (1e-5, 1e-9))
    left_out = float(theory.bounce_time(1e-5 / BOUNCING[3], normal_restitution=BOUNCING[3], weight=0.1))
    assert len(coarse.segments) < len(fine.segments)
    assert coarse.mean_speed == pytest.approx(fine.mean_speed, abs=size(BOUNCING) * left_out)


@pytest.mark.parametrize("incline", [0.5, -0.5])
def test_a_block_that_nothing_holds_slides_ever_faster(incline):
    cycle = block_cycle(0.5, 0.2, static_friction=0.3, incline=incline, cycles=50)
    assert not cycle.repeats
    assert cycle.cycles == 50
    assert cycle.mean_speed == -math.copysign(math.inf, incline)


def test_a_block_that_is_not_at_rest_yet_is_not_said_to_escape():
    cycle = block_cycle(0.5, static_friction=0.3, incline=0.1, start_velocity=-50.0, cycles=5)
    assert not cycle.repeats
    assert cycle.fraction[BlockPhase.BACKWARD] == 1.0
    assert -50.0 < cycle.mean_speed < -40.0


@pytest.mark.parametrize("friction", [0.0, 0.3, 0.7])
def test_a_normal_motion_throws_without_slip_at_any_phase(friction):
    gamma = float(theory.flight_throw_number(0.4))
    for phase in np.linspace(-3.0, 3.0, 61):
        cycle = block_cycle(0.0, gamma, static_friction=friction, phase=phase)
        assert cycle.fraction[BlockPhase.FLIGHT] == pytest.approx(0.4, abs=1e-13)
        assert cycle.fraction[BlockPhase.STICK] == pytest.approx(0.6, abs=1e-13)


def test_static_friction_holds_what_kinetic_would_not():
    held = {"static_friction": 0.8, "kinetic_friction": 0.3, "incline": 0.5}
    assert block_cycle(0.1, **held).fraction[BlockPhase.STICK] == 1.0
    assert block_cycle(0.1, **held, start_velocity=-1.0, cycles=50).mean_speed == -math.inf


def test_a_block_starts_where_start_of_motion_tells():
    friction, shape = 0.4, (0.8, 0.6)
    ground = {"phase": 0.5, "incline": 0.1}
    start = theory.start_of_motion(*shape, c=9.0, friction=friction, **ground)
    still, moving = (
        block_cycle(*(factor * start.amplitude * part for part in shape), static_friction=friction, **ground)
        for factor in (1.0 - 1e-9, 1.0 + 1e-9)
    )
    assert still.fraction[BlockPhase.STICK] == 1.0
    assert moving.fraction[BlockPhase.BACKWARD] + moving.fraction[BlockPhase.FORWARD] > 0.0


def test_speeds_of_many_blocks_are_those_of_each():
    normal = np.array([[0.3], [1.5]])
    friction = np.array([0.2, 0.4, 0.8])
    speed = mean_block_speed(1.0, normal, static_friction=friction, kinetic_friction=0.2)
    assert speed.shape == (2, 3)
    each = block_cycle(1.0, 1.5, static_friction=0.8, kinetic_friction=0.2).mean_speed
    assert speed[1, 2] == each
    assert isinstance(mean_block_speed(0.1, static_friction=0.2), float)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"static_friction": -0.1}, "static_friction must be zero or positive"),
        ({"static_friction": 0.1, "kinetic_friction": 0.2}, "kinetic_friction must be at most static_friction = 0.1"),
        ({"static_friction": 0.1, "normal_restitution": 1.0}, "normal_restitution must be below 1"),
        ({"static_friction": 0.1, "incline": 1.6}, "incline must lie between"),
        ({"static_friction": 0.1, "rest_speed": 0.0}, "rest_speed must be positive"),
        ({"static_friction": 0.1, "cycles": 0}, "cycles must be a whole number of at least 1"),
    ],
)
def test_misuse_is_named(options, message):
    with pytest.raises(ParameterError, match=message):
        block_cycle(1.0, **options)
    with pytest.raises(ParameterError, match="kinetic_friction must be at most static_friction"):
        horizontal_sliding(1.0, static_friction=0.1, kinetic_friction=0.2)


def test_a_force_that_fell_a_rounding_ago_falls_now():
    force = HarmonicForce(0.0, 1.0)
    assert force.next_fall(0.5 * math.pi + 1e-15) == 0.0
    assert force.next_fall(0.5 * math.pi + 1e-9) == pytest.approx(TURN, abs=2e-9)
