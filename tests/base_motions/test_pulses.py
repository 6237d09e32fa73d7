"""Pulses: each against its definition, calculus, bounds, and numbers worked out by hand or by sympy."""

import itertools
import math
from dataclasses import dataclass

import numpy as np
import pytest
import sympy
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import fixed_quad

import stylobate as sb
from stylobate.base_motions.pulses import Ricker, Waveform
from stylobate.errors import ParameterError

P = sb.Pulse
A, W, V, F = 2.0, 3.0, 0.8, 0.7

BY_ACCELERATION = {
    "half_sine": P.half_sine(acceleration=A, angular_frequency=W),
    "half_cosine": P.half_cosine(acceleration=A, angular_frequency=W),
    "one_sine": P.one_sine(acceleration=A, angular_frequency=W),
    "one_cosine": P.one_cosine(acceleration=A, angular_frequency=W),
    "sinusoidal": P.sinusoidal(acceleration=A, angular_frequency=W, phase=-0.4, cycles=2.3),
    "ricker": P.ricker(acceleration=A, angular_frequency=W),
    "antisymmetric_ricker": P.antisymmetric_ricker(acceleration=A, angular_frequency=W),
}
BY_VELOCITY = {
    "type_a": P.type_a(velocity=V, angular_frequency=W),
    "type_b": P.type_b(velocity=V, angular_frequency=W),
    "type_c1": P.type_c(velocity=V, angular_frequency=W),
    "type_c3": P.type_c(velocity=V, angular_frequency=W, cycles=3),
    "gabor": P.gabor(velocity=V, frequency=F, phase=0.4, oscillations=1.7),
    "long gabor": P.gabor(velocity=V, frequency=F, phase=-2.0, oscillations=6.0),
    "mavroeidis_papageorgiou": P.mavroeidis_papageorgiou(velocity=V, frequency=F, phase=0.4, oscillations=1.7),
    "long mavroeidis_papageorgiou": P.mavroeidis_papageorgiou(velocity=V, frequency=F, phase=1.6, oscillations=5.2),
}
ALL = BY_ACCELERATION | BY_VELOCITY

every_pulse = pytest.mark.parametrize("pulse", ALL.values(), ids=ALL)


def along(values):
    return values[..., 0]


def integrated(function, time, count):
    """Return the integral from 0 to `time`, by the Gauss rule of 20 nodes on `count` pieces."""
    edges = np.linspace(0.0, time, count + 1)
    return math.fsum(fixed_quad(function, a, b, n=20)[0] for a, b in itertools.pairwise(edges))


@every_pulse
def test_velocity_and_displacement_are_integrals_of_the_acceleration(pulse):
    end, largest = pulse.duration, pulse.peak_horizontal()
    speed, way = largest / pulse.highest_frequency, largest / pulse.highest_frequency**2
    for time in (0.13 * end, 0.5 * end, 0.77 * end, end):
        count = math.ceil(time * pulse.highest_frequency)
        velocity, displacement = (
            integrated(lambda t, values=values: along(values(t)), time, count)
            for values in (pulse.acceleration, pulse.velocity)
        )
        assert along(pulse.velocity(time)) == pytest.approx(velocity, abs=1e-13 * count * speed)
        assert along(pulse.displacement(time)) == pytest.approx(displacement, abs=1e-13 * count * way)


@every_pulse
def test_a_pulse_starts_from_rest_and_ends_in_uniform_motion(pulse):
    end = pulse.duration
    later = pulse.__class__(waveform=pulse.waveform, start=1.5)
    before, after = np.linspace(0.0, 1.5, 7)[:-1], 1.5 + end + np.array([0.0, 0.5, 3.0])
    for name in ("acceleration", "velocity", "displacement"):
        assert np.all(getattr(later, name)(before) == 0.0)
        np.testing.assert_allclose(
            getattr(later, name)(1.5 + 0.3 * end), getattr(pulse, name)(0.3 * end), rtol=1e-12, atol=1e-15
        )
    assert np.all(later.acceleration(after) == 0.0)
    left = later.velocity(after[0])
    np.testing.assert_allclose(later.velocity(after), np.tile(left, (3, 1)), rtol=0.0, atol=1e-14)
    travelled = later.displacement(after) - later.displacement(after[0])
    np.testing.assert_allclose(travelled, np.outer(after - after[0], left), rtol=0.0, atol=1e-14)
    inside = np.nextafter(1.5 + end, 0.0)
    for name in ("velocity", "displacement"):
        np.testing.assert_allclose(getattr(later, name)(inside), getattr(later, name)(after[0]), rtol=0.0, atol=1e-14)
    assert later.breaks == (1.5, later.duration) == (1.5, 1.5 + end)
    assert pulse.breaks == (end,)


@pytest.mark.parametrize("name", BY_ACCELERATION)
def test_the_acceleration_given_is_the_largest(name):
    pulse = BY_ACCELERATION[name]
    assert pulse.peak_horizontal() == pytest.approx(A, rel=1e-15)
    time = np.linspace(0.0, pulse.duration, 100_001)
    # At this spacing h samples miss a peak by (hω)²/8 of it at most, ω the highest frequency.
    missed = (pulse.highest_frequency * pulse.duration / 1e5) ** 2 / 8.0
    assert A * (1.0 - missed) <= np.abs(along(pulse.acceleration(time))).max() <= A * (1.0 + 1e-15)


drawn_pulses = st.one_of(
    st.sampled_from(list(ALL.values())),
    st.builds(
        P.mavroeidis_papageorgiou,
        velocity=st.floats(-2.0, 2.0).filter(lambda v: abs(v) > 1e-3),
        frequency=st.floats(0.3, 3.0),
        phase=st.floats(-4.0, 4.0),
        oscillations=st.floats(1.01, 6.0),
    ),
    st.builds(
        P.gabor,
        velocity=st.just(1.0),
        frequency=st.floats(0.3, 3.0),
        phase=st.floats(-4.0, 4.0),
        oscillations=st.floats(0.3, 6.0),
    ),
    st.builds(
        P.sinusoidal,
        acceleration=st.floats(-2.0, 2.0).filter(lambda a: abs(a) > 1e-3),
        angular_frequency=st.floats(0.3, 9.0),
        phase=st.floats(-7.0, 7.0),
        cycles=st.floats(0.05, 4.0),
    ),
)


@given(pulse=drawn_pulses, share=st.floats(-0.2, 1.1))
@example(pulse=P.sinusoidal(acceleration=-1.0, angular_frequency=1.0, phase=-1.0, cycles=0.5), share=-0.125)
@settings(max_examples=80)
def test_the_bounds_hold_from_any_time_on_and_are_met(pulse, share):
    pulse = P(waveform=pulse.waveform, direction=0.7, start=0.6, vertical=-0.3)
    since = max(0.0, 0.6 + share * pulse.waveform.duration)
    # A waveform may jump at its start and at its end, between two samples.
    jumps = [time for time in (pulse.start, np.nextafter(pulse.duration, 0.0)) if time >= since]
    time = np.append(np.linspace(since, max(since, pulse.duration), 20_001), jumps)
    acceleration = pulse.acceleration(time)
    largest, (low, high) = pulse.peak_horizontal(since), pulse.vertical_range(since)
    found = np.hypot(*acceleration.T[:2]).max()
    whole = pulse.peak_horizontal()
    assert found <= largest * (1.0 + 1e-15) + 1e-300
    assert low * (1.0 + 1e-15) <= acceleration[:, 2].min()
    assert acceleration[:, 2].max() <= high * (1.0 + 1e-15)
    # Of samples at the spacing h the nearest to a peak lies (hω)²/8 below it at most, ω² a bound of the curvature.
    missed = (6.0 * pulse.highest_frequency * pulse.waveform.duration / 20_000) ** 2 / 8.0 + 1e-6
    assert found >= largest - missed * whole
    assert acceleration[:, 2].min() <= low + missed * 0.3 * whole


@every_pulse
def test_nothing_comes_after_the_end(pulse):
    assert pulse.peak_horizontal(pulse.duration) == 0.0
    assert pulse.vertical_range(pulse.duration) == (0.0, 0.0)
    assert P(waveform=pulse.waveform, start=2.0).peak_horizontal(1.0) == pulse.peak_horizontal()


@pytest.mark.parametrize(
    ("name", "velocity", "displacement"),
    [
        ("half_sine", 2.0 * A / W, math.pi * A / W**2),
        ("half_cosine", 0.0, 2.0 * A / W**2),
        ("one_sine", 0.0, 2.0 * math.pi * A / W**2),
        ("one_cosine", 0.0, 0.0),
        ("type_a", 0.0, math.pi * V / W),
        ("type_b", 0.0, 0.0),
        ("type_c1", 0.0, 0.0),
        ("type_c3", 0.0, 0.0),
        ("ricker", 0.0, 0.0),
        ("antisymmetric_ricker", 0.0, 0.0),
    ],
)
def test_what_a_pulse_leaves_is_known(name, velocity, displacement):
    end = ALL[name].duration
    assert along(ALL[name].velocity(end)) == pytest.approx(velocity, abs=1e-12)
    # The cut of the antisymmetric wavelet shifts its end by 1e-12 A/ω² times the squared length in 1/ω.
    assert along(ALL[name].displacement(end)) == pytest.approx(displacement, abs=1e-11)


@pytest.mark.parametrize(
    ("name", "velocity", "acceleration"),
    [
        ("type_a", lambda t: 0.5 * V * (1.0 - np.cos(W * t)), 0.5 * W * V),
        ("type_b", lambda t: V * np.sin(W * t), W * V),
        ("type_c1", lambda t: V * (np.sin(W * t + 0.0697033 * np.pi) - np.sin(0.0697033 * np.pi)), W * V),
    ],
)
def test_velocity_pulses_are_those_of_the_literature(name, velocity, acceleration):
    pulse = BY_VELOCITY[name]
    time = np.linspace(0.0, pulse.duration, 31)
    np.testing.assert_allclose(along(pulse.velocity(time)), velocity(time), rtol=0.0, atol=1e-6 * V)
    assert pulse.peak_horizontal() == pytest.approx(acceleration, rel=1e-14)


@pytest.mark.parametrize(("cycles", "phase"), [(1, 0.0697), (2, 0.0410)])
def test_the_phase_that_closes_a_pulse_of_several_cycles_is_published(cycles, phase):
    waveform = P.type_c(velocity=V, angular_frequency=W, cycles=cycles).waveform
    assert waveform.phase / math.pi - 0.5 == pytest.approx(phase, abs=5e-5)
    assert waveform.cycles == pytest.approx(cycles + 0.5 - phase, abs=5e-5)


def test_ricker_wavelets_are_those_of_vassiliou_and_makris():
    period = 2.0 * math.pi / W
    pulse = BY_ACCELERATION["ricker"]
    t = np.linspace(-1.5, 1.5, 13) * period
    square = (t / period) ** 2
    symmetric = A * (1.0 - 2.0 * np.pi**2 * square) * np.exp(-(np.pi**2) * square)
    middle = 0.5 * pulse.duration
    np.testing.assert_allclose(along(pulse.acceleration(middle + t)), symmetric, rtol=0.0, atol=1e-14)
    pulse = BY_ACCELERATION["antisymmetric_ricker"]
    x2 = 4.0 * np.pi**2 * square / 3.0
    antisymmetric = A / 1.3801 * (x2 - 3.0) * 2.0 * np.pi * t / (math.sqrt(3.0) * period) * np.exp(-0.5 * x2)
    middle = 0.5 * pulse.duration
    np.testing.assert_allclose(along(pulse.acceleration(middle + t)), antisymmetric, rtol=5e-5, atol=1e-14)


@pytest.mark.parametrize("name", ["ricker", "antisymmetric_ricker"])
def test_the_spectrum_of_a_ricker_wavelet_is_largest_at_its_frequency_and_within_its_band(name):
    pulse = BY_ACCELERATION[name]
    time, step = np.linspace(0.0, pulse.duration, 4001, retstep=True)
    values = along(pulse.acceleration(time))

    def spectrum(w):
        return abs(np.exp(-1j * w * time) @ values) * step

    top = spectrum(W)
    assert top > max(spectrum(0.99 * W), spectrum(1.01 * W))
    assert spectrum(pulse.highest_frequency) < top / 2000.0


@pytest.mark.parametrize("name", ["ricker", "antisymmetric_ricker", "gabor", "long gabor"])
def test_a_wavelet_is_cut_where_nothing_is_left(name):
    pulse = ALL[name]
    ends = np.abs(along(pulse.acceleration([0.0, np.nextafter(pulse.duration, 0.0)])))
    assert np.all(ends < 1e-11 * pulse.peak_horizontal())
    fastest = np.abs(along(pulse.velocity(np.linspace(0.0, pulse.duration, 1001)))).max()
    assert abs(along(pulse.velocity(pulse.duration))) < 1e-12 * fastest


def test_a_gabor_wavelet_is_its_definition_and_moves_the_base_as_stated():
    pulse, gamma, phase = BY_VELOCITY["gabor"], 1.7, 0.4
    t = np.linspace(-1.0, 1.0, 9)
    expected = V * np.exp(-0.5 * (2.0 * np.pi * F * t / gamma) ** 2) * np.cos(2.0 * np.pi * F * t + phase)
    np.testing.assert_allclose(along(pulse.velocity(0.5 * pulse.duration + t)), expected, rtol=0.0, atol=1e-14)
    moved = math.sqrt(2.0 * math.pi) * gamma / (2.0 * math.pi * F) * math.exp(-0.5 * gamma**2) * math.cos(phase) * V
    assert along(pulse.displacement(pulse.duration)) == pytest.approx(moved, rel=1e-12)


@pytest.mark.parametrize("frequency", [0.3, 2.0])
@pytest.mark.parametrize("gamma", [1.05, 1.7, 6.0])
@pytest.mark.parametrize(("make", "room"), [(P.gabor, 1.5), (P.mavroeidis_papageorgiou, 1.05)])
def test_the_margin_of_two_turning_points_in_one_cell_is_that_of_the_third_derivative(make, room, gamma, frequency):
    """Between turning points h apart a cubic rises by h³/12 of its third derivative; all others rise less."""
    highest = 0.0
    for phase in np.linspace(0.0, math.pi, 7):
        wave = make(velocity=V, frequency=frequency, phase=phase, oscillations=gamma).waveform
        step = wave.duration / 20_000
        third = np.abs(np.diff(wave.derivative(step * np.arange(20_001), 2), 3)).max() / step**3
        # 1024 cells per shortest period, the last one whole.
        cell = wave.duration / math.ceil(1024 * wave.highest_frequency * wave.duration / (2.0 * math.pi))
        # A third difference over h³ is a third derivative; rounding adds 1e-16 (cells/ωT)³.
        assert third * cell**3 / 12.0 <= wave.margin * (1.0 + 1e-4)
        highest = max(highest, third * cell**3 / 12.0)
    # The bounds are sums of those of terms, which do not peak together.
    assert wave.margin <= room * highest


@pytest.mark.parametrize(("frequency", "gamma", "phase"), [(0.7, 1.7, 0.4), (0.25, 1.05, -1.5), (2.0, 3.0, 2.2)])
def test_the_pulse_of_mavroeidis_and_papageorgiou_is_that_of_their_paper(frequency, gamma, phase):
    # Their velocity differentiated and integrated by sympy, and their (2003) closed displacement after the end.
    tau, f, g, nu = sympy.symbols("tau f g nu", positive=True)
    bell = 2 * sympy.pi * f / g * tau
    velocity = sympy.Rational(1, 2) * (1 + sympy.cos(bell)) * sympy.cos(2 * sympy.pi * f * tau + nu)
    numbers = {f: sympy.Float(frequency, 30), g: sympy.Float(gamma, 30), nu: sympy.Float(phase, 30)}
    acceleration = sympy.diff(velocity, tau).subs(numbers)
    displacement = sympy.integrate(sympy.fu(velocity).subs(numbers), tau)
    pulse = P.mavroeidis_papageorgiou(velocity=V, frequency=frequency, phase=phase, oscillations=gamma)
    half = 0.5 * gamma / frequency
    assert pulse.duration == pytest.approx(2.0 * half, rel=1e-15)
    start = displacement.subs(tau, -half)
    for share in (-0.9, -0.35, 0.0, 0.2, 0.81):
        time = share * half
        now = half + time
        assert along(pulse.velocity(now)) == pytest.approx(
            V * float(velocity.subs(numbers).subs(tau, time)), abs=1e-13 * V
        )
        assert along(pulse.acceleration(now)) == pytest.approx(
            V * float(acceleration.subs(tau, time)), abs=1e-12 * V * pulse.highest_frequency
        )
        assert along(pulse.displacement(now)) == pytest.approx(
            V * float((displacement.subs(tau, time) - start).evalf(25)), abs=1e-12 * V * half
        )
    share = V / (4.0 * math.pi * frequency * (1.0 - gamma**2))
    ends = [share * math.sin(phase + side * math.pi * gamma) for side in (-1.0, 1.0)]
    assert along(pulse.displacement(pulse.duration)) == pytest.approx(ends[1] - ends[0], abs=1e-13)
    assert along(pulse.acceleration([0.0, np.nextafter(pulse.duration, 0.0)])) == pytest.approx([0.0, 0.0], abs=1e-12)


def test_pulses_scale_turn_wait_and_add():
    pulse = BY_ACCELERATION["one_cosine"]
    time = np.linspace(0.0, 4.0, 41)
    combined = (pulse + BY_ACCELERATION["ricker"]).scaled(-0.5).rotated(math.pi / 2.0).delayed(0.5)
    parts = pulse.acceleration(time - 0.5) + BY_ACCELERATION["ricker"].acceleration(time - 0.5)
    np.testing.assert_allclose(combined.acceleration(time)[:, 1], -0.5 * parts[:, 0], rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(combined.acceleration(time)[:, 0], 0.0, atol=1e-15)
    assert combined.peak_horizontal(8.5) == 0.0
    assert combined.breaks == (0.5, 0.5 + pulse.duration, 0.5 + BY_ACCELERATION["ricker"].duration)


def test_direction_and_vertical_share_set_the_line():
    pulse = P.half_sine(acceleration=2.0, angular_frequency=W, direction=math.pi / 6.0, vertical=0.5)
    peak = math.pi / (2.0 * W)
    np.testing.assert_allclose(pulse.acceleration(peak), [math.sqrt(3.0), 1.0, 1.0], rtol=1e-15)
    assert pulse.vertical_range() == (0.0, 1.0)
    assert pulse.scaled(-1.0).vertical_range() == (-1.0, 0.0)
    assert P.half_sine(acceleration=-2.0, angular_frequency=W).peak_horizontal() == 2.0
    (x, y), *rest = pulse.directions()
    assert not rest
    assert math.atan2(y, x) == pytest.approx(math.pi / 6.0, rel=1e-15)


def test_a_pulse_is_a_value():
    one, two = (P.ricker(acceleration=A, angular_frequency=W) for _ in range(2))
    assert one == two
    assert hash(one) == hash(two)
    assert one.waveform == Ricker(acceleration=A, angular_frequency=W)


@pytest.mark.parametrize("shape", [(), (0,), (4,), (2, 3)])
@every_pulse
def test_times_of_any_shape_give_vectors_of_that_shape(pulse, shape):
    for name in ("acceleration", "velocity", "displacement"):
        assert getattr(pulse, name)(np.ones(shape)).shape == (*shape, 3)


@pytest.mark.parametrize(
    ("make", "options", "name"),
    [
        (P.half_sine, {"acceleration": math.nan, "angular_frequency": 1.0}, "acceleration"),
        (P.half_sine, {"acceleration": 1.0, "angular_frequency": 0.0}, "angular_frequency"),
        (P.one_cosine, {"acceleration": 1.0, "angular_frequency": 1.0, "direction": math.inf}, "direction"),
        (P.one_sine, {"acceleration": 1.0, "angular_frequency": 1.0, "start": -1.0}, "start"),
        (P.one_sine, {"acceleration": 1.0, "angular_frequency": 1.0, "vertical": math.nan}, "vertical"),
        (P.sinusoidal, {"acceleration": 1.0, "angular_frequency": 1.0, "cycles": 0.0}, "cycles"),
        (P.sinusoidal, {"acceleration": 1.0, "angular_frequency": 1.0, "cycles": 1e18}, "cycles"),
        (P.sinusoidal, {"acceleration": 1.0, "angular_frequency": 1.0, "phase": math.inf}, "phase"),
        (P.type_a, {"velocity": math.nan, "angular_frequency": 1.0}, "velocity"),
        (P.type_b, {"velocity": 1.0, "angular_frequency": -1.0}, "angular_frequency"),
        (P.type_c, {"velocity": 1.0, "angular_frequency": 1.0, "cycles": 0}, "cycles"),
        (P.type_c, {"velocity": 1.0, "angular_frequency": 1.0, "cycles": 1.5}, "cycles"),
        (P.type_c, {"velocity": 1.0, "angular_frequency": 1.0, "cycles": 10**18}, "cycles"),
        (P.ricker, {"acceleration": 1.0, "angular_frequency": -2.0}, "angular_frequency"),
        (P.antisymmetric_ricker, {"acceleration": "x", "angular_frequency": 2.0}, "acceleration"),
        (P.gabor, {"velocity": 1.0, "frequency": 0.0, "oscillations": 1.0}, "frequency"),
        (P.gabor, {"velocity": 1.0, "frequency": 1.0, "oscillations": 0.0}, "oscillations"),
        (P.mavroeidis_papageorgiou, {"velocity": 1.0, "frequency": 1.0, "oscillations": 1.0}, "oscillations"),
        (P.gabor, {"velocity": 1.0, "frequency": 1.0, "oscillations": 1e9}, "oscillations"),
        (P.mavroeidis_papageorgiou, {"velocity": 1.0, "frequency": 1.0, "oscillations": 1e9}, "oscillations"),
        (P.mavroeidis_papageorgiou, {"velocity": 1.0, "frequency": -1.0, "oscillations": 2.0}, "frequency"),
        (P, {"waveform": math.sin}, "waveform"),
    ],
)
def test_impossible_numbers_are_refused_by_name(make, options, name):
    with pytest.raises(ParameterError, match=rf"^{name}\b") as caught:
        make(**options)
    assert "got" in str(caught.value)


def test_a_pulse_has_a_thousand_cycles_at_most():
    pulse = P.sinusoidal(acceleration=A, angular_frequency=2.0 * math.pi, cycles=1000)
    assert pulse.duration == pytest.approx(1000.0)
    with pytest.raises(ParameterError, match=r"at most 1000, since a pulse is short: use Harmonic .*, got 1000\.5"):
        P.sinusoidal(acceleration=A, angular_frequency=2.0 * math.pi, cycles=1000.5)


@dataclass(frozen=True, slots=True)
class Block(Waveform):
    """A constant acceleration for a time: a waveform of the user's own."""

    acceleration: float
    duration: float = 1.0
    highest_frequency: float = 1.0

    def derivative(self, time, order):
        return self.acceleration * time ** (2 - order) / (2.0, 1.0, 1.0)[order]

    def turning_points(self):
        return ()


def test_a_waveform_of_the_users_own_makes_a_pulse():
    pulse = P(waveform=Block(3.0, duration=2.0), start=1.0)
    np.testing.assert_allclose(along(pulse.displacement([1.0, 3.0, 4.0])), [0.0, 6.0, 12.0], rtol=1e-15)
    assert pulse.peak_horizontal(2.9) == 3.0


COLUMN = sb.Column.dimensionless(slenderness=0.1)


def test_one_run_and_an_ensemble_agree_on_half_a_sine():
    model = sb.Slender(COLUMN, damping=0.1)
    pulse = P.half_sine(acceleration=0.3, angular_frequency=5.0, start=0.2)
    scales = [0.3, 0.6, 1.0, 1.5]
    options = {"tilt": (0.0, 0.0), "duration": 6.0, "rtol": 1e-10}
    runs = sb.simulate_ensemble(model, pulse, **options, parameters={"scale": scales})
    alone = [sb.simulate(model, pulse.scaled(scale), **options) for scale in scales]
    assert [run.outcome for run in alone] == [sb.Outcome(runs["outcome"].values[index]) for index in range(4)]
    ends = [run.data["tilt"].to_numpy()[-1] for run in alone]
    np.testing.assert_allclose(runs["end_tilt"], ends, rtol=0.0, atol=1e-7)
    assert {run.outcome for run in alone} == {sb.Outcome.AT_REST, sb.Outcome.SURVIVED, sb.Outcome.OVERTURNED}


def test_a_pulse_too_weak_to_release_a_column_is_known_to_leave_it_at_rest():
    capacity = 0.1 * COLUMN.gravity
    below, above = (P.ricker(acceleration=share * capacity, angular_frequency=8.0) for share in (1.0, 1.5))
    runs = [sb.simulate(sb.Slender(COLUMN), pulse, duration=2.0) for pulse in (below, above)]
    assert runs[0].outcome is sb.Outcome.AT_REST
    assert "uplift" in [event.kind for event in runs[1].events]
    assert runs[0].decided_at == 0.0
