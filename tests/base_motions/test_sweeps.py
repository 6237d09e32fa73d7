"""Sine sweeps: their frequency, their calculus, their bounds, and SciPy's closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import chirp
from scipy.special import fresnel, sici

import stylobate as sb
from stylobate.base_motions.sweeps import SweepLaw, SweepQuantity
from stylobate.errors import ParameterError

S = sb.SineSweep
UP, DOWN = {"frequencies": (0.5, 4.0), "length": 12.0}, {"frequencies": (4.0, 0.5), "length": 12.0}
SWEEPS = [
    make(**{quantity: 0.8}, **ends, start_phase=phase)
    for make in (S.linear, S.logarithmic)
    for quantity in ("acceleration", "displacement")
    for ends, phase in ((UP, 0.0), (DOWN, 1.0))
]


def differences(function, time, step):
    """Return the derivative of `function` by the central difference of the sixth order."""
    weights = {1: 45.0 / 60.0, 2: -9.0 / 60.0, 3: 1.0 / 60.0}
    return sum(w * (function(time + k * step) - function(time - k * step)) for k, w in weights.items()) / step


@pytest.mark.parametrize("sweep", SWEEPS)
def test_velocity_and_acceleration_are_derivatives(sweep):
    time = np.linspace(0.1, 11.9, 60)
    largest, step = sweep.peak_horizontal(), 0.02 / sweep.highest_frequency
    # The error of the difference is (ωh)⁶/140 of the slope at ω, and that of the rounding 1e-15 over ωh.
    np.testing.assert_allclose(
        differences(sweep.velocity, time, step), sweep.acceleration(time), rtol=0.0, atol=1e-9 * largest
    )
    slowest = 2.0 * math.pi * min(sweep.frequencies)
    np.testing.assert_allclose(
        differences(sweep.displacement, time, step), sweep.velocity(time), rtol=0.0, atol=1e-9 * largest / slowest
    )


@pytest.mark.parametrize(("law", "method"), [(S.linear, "linear"), (S.logarithmic, "logarithmic")])
@pytest.mark.parametrize("ends", [UP, DOWN])
def test_a_sweep_of_acceleration_is_the_chirp_of_scipy(law, method, ends):
    time = np.linspace(0.0, 11.99, 57)
    sweep = law(acceleration=0.8, **ends, start_phase=0.4, direction=math.pi / 2.0)
    expected = 0.8 * chirp(time, *ends["frequencies"][:1], 12.0, ends["frequencies"][1], method, math.degrees(0.4))
    np.testing.assert_allclose(sweep.acceleration(time)[:, 1], expected, rtol=0.0, atol=1e-12)


def test_the_velocity_of_a_linear_sweep_is_fresnels():
    # A cos(½κs²), s = t + Ω/κ: the phase is that less ½Ω²/κ.
    first, last, end = 0.5, 4.0, 12.0
    kappa, omega = 2.0 * math.pi * (last - first) / end, 2.0 * math.pi * first
    time = np.linspace(0.0, end, 25)
    sweep = S.linear(acceleration=0.8, **UP, start_phase=0.5 * omega**2 / kappa)
    _, cosine = fresnel(math.sqrt(kappa / math.pi) * (time + omega / kappa))
    grown = 0.8 * math.sqrt(math.pi / kappa) * (cosine - cosine[0])
    np.testing.assert_allclose(sweep.velocity(time)[:, 0] - sweep.velocity(0.0)[0], grown, rtol=0.0, atol=1e-13)


def test_the_velocity_of_a_logarithmic_sweep_is_a_cosine_integral():
    # With u = (Ω/g) exp(gt) and the phase u, ∫ cos u dt = ∫ cos u du/(gu).
    first, last, end = 0.5, 4.0, 12.0
    growth, omega = math.log(last / first) / end, 2.0 * math.pi * first
    time = np.linspace(0.0, end, 25)
    sweep = S.logarithmic(acceleration=0.8, **UP, start_phase=omega / growth)
    _, cosine = sici(omega / growth * np.exp(growth * time))
    grown = 0.8 * (cosine - cosine[0]) / growth
    np.testing.assert_allclose(sweep.velocity(time)[:, 0] - sweep.velocity(0.0)[0], grown, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("make", [S.linear, S.logarithmic])
@pytest.mark.parametrize("quantity", ["acceleration", "displacement"])
def test_a_sweep_that_does_not_change_is_harmonic(make, quantity):
    frequency = 1.3
    sweep = make(**{quantity: 0.8}, frequencies=(frequency, frequency), length=9.0, start_phase=0.3)
    if quantity == "acceleration":
        steady = sb.Harmonic.straight(acceleration=0.8, angular_frequency=2.0 * math.pi * frequency, start_phase=0.3)
    else:
        steady = sb.Harmonic.displacement_amplitude(
            amplitude=(0.8, 0.0, 0.0), angular_frequency=2.0 * math.pi * frequency, start_phase=0.3
        )
    time = np.linspace(0.0, 8.99, 31)
    for name in ("acceleration", "velocity", "displacement"):
        scale = np.abs(getattr(steady, name)(time)).max()
        np.testing.assert_allclose(
            getattr(sweep, name)(time), getattr(steady, name)(time), rtol=0.0, atol=1e-12 * scale
        )
    assert sweep.peak_horizontal() == pytest.approx(steady.peak_horizontal(), rel=1e-14)


def test_frequencies_go_as_the_law_says():
    time = [-1.0, 0.0, 4.0, 8.0, 12.0, 20.0]
    ends = {"acceleration": 1.0, "frequencies": (0.5, 4.0), "length": 12.0}
    np.testing.assert_allclose(S.logarithmic(**ends).frequency(time), [0.5, 0.5, 1.0, 2.0, 4.0, 4.0], rtol=1e-14)
    rise = 3.5 / 3.0
    np.testing.assert_allclose(
        S.linear(**ends).frequency(time), [0.5, 0.5, 0.5 + rise, 0.5 + 2.0 * rise, 4.0, 4.0], rtol=1e-14
    )


@given(index=st.integers(0, len(SWEEPS) - 1), since=st.floats(0.0, 14.5), vertical=st.floats(-1.0, 1.0))
def test_the_bounds_hold_from_any_time_on(index, since, vertical):
    given_sweep = SWEEPS[index]
    sweep = S(
        amplitude=given_sweep.amplitude,
        quantity=given_sweep.quantity,
        law=given_sweep.law,
        frequencies=given_sweep.frequencies,
        length=12.0,
        start=2.0,
        direction=0.4,
        vertical=vertical,
    )
    acceleration = sweep.acceleration(np.linspace(since, 15.0, 4001))
    low, high = sweep.vertical_range(since)
    assert np.hypot(*acceleration.T[:2]).max() <= sweep.peak_horizontal(since) * (1.0 + 1e-15)
    assert low * (1.0 + 1e-15) <= acceleration[:, 2].min()
    assert acceleration[:, 2].max() <= high * (1.0 + 1e-15)


@pytest.mark.parametrize("sweep", SWEEPS)
def test_the_bound_is_near_what_is_reached(sweep):
    found = np.abs(sweep.acceleration(np.linspace(0.0, 12.0, 50_001))[:, 0]).max()
    # Its last peak of displacement lies within half a cycle of the end with the higher frequency.
    slack = 1e-4 if sweep.quantity is SweepQuantity.ACCELERATION else 0.15
    assert found >= sweep.peak_horizontal() * (1.0 - slack)


@pytest.mark.parametrize("sweep", SWEEPS)
def test_before_and_after_the_base_moves_uniformly(sweep):
    late = S(
        amplitude=sweep.amplitude,
        quantity=sweep.quantity,
        law=sweep.law,
        frequencies=sweep.frequencies,
        length=12.0,
        start_phase=sweep.start_phase,
        start=1.5,
    )
    assert late.breaks == (1.5, 13.5)
    assert late.duration == 13.5
    assert np.all(late.acceleration([0.0, 1.4, 13.5, 17.0]) == 0.0)
    assert late.peak_horizontal(13.5) == 0.0
    scale = np.abs(late.velocity(np.linspace(1.5, 13.5, 101))).max()
    for edge in (1.5, 13.5):
        before, after = edge - 1e-9, edge + 1e-9
        np.testing.assert_allclose(
            late.velocity(before), late.velocity(after), rtol=0.0, atol=4e-9 * late.peak_horizontal()
        )
        np.testing.assert_allclose(late.displacement(before), late.displacement(after), rtol=0.0, atol=4e-9 * scale)
    np.testing.assert_allclose(
        late.displacement(1.0) - late.displacement(0.0), late.velocity(0.0), rtol=1e-12, atol=1e-15
    )
    np.testing.assert_allclose(
        late.displacement(15.0) - late.displacement(14.0), late.velocity(14.0), rtol=1e-12, atol=1e-12
    )


@pytest.mark.parametrize("shape", [(), (0,), (4,), (2, 3)])
@pytest.mark.parametrize("sweep", SWEEPS[::3])
def test_times_of_any_shape_give_vectors_of_that_shape(sweep, shape):
    for name in ("acceleration", "velocity", "displacement"):
        assert getattr(sweep, name)(np.ones(shape)).shape == (*shape, 3)


def test_a_sweep_moves_a_column():
    sweep = S.logarithmic(acceleration=0.25, frequencies=(0.1, 0.8), length=30.0)
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.2)
    run = sb.simulate(model, sweep, duration=30.0)
    assert "uplift" in [event.kind for event in run.events]


def test_a_law_may_be_named():
    sweep = S(amplitude=1.0, law="logarithmic", quantity="displacement", frequencies=(1.0, 2.0), length=3.0)
    assert sweep == S.logarithmic(displacement=1.0, frequencies=(1.0, 2.0), length=3.0)
    assert sweep.law is SweepLaw.LOGARITHMIC


GOOD = {"acceleration": 1.0, "frequencies": (1.0, 2.0), "length": 3.0}


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"acceleration": math.nan}, "acceleration"),
        ({"acceleration": None}, "acceleration"),
        ({"displacement": 1.0}, "acceleration"),
        ({"acceleration": None, "displacement": math.inf}, "displacement"),
        ({"frequencies": (0.0, 1.0)}, r"frequencies\[0\]"),
        ({"frequencies": (1.0, -1.0)}, r"frequencies\[1\]"),
        ({"frequencies": 1.0}, "frequencies"),
        ({"length": 0.0}, "length"),
        ({"direction": math.nan}, "direction"),
        ({"start_phase": math.nan}, "start_phase"),
        ({"start": -1.0}, "start"),
        ({"vertical": math.inf}, "vertical"),
    ],
)
@pytest.mark.parametrize("make", [S.linear, S.logarithmic])
def test_impossible_numbers_are_refused_by_name(make, change, name):
    with pytest.raises(ParameterError, match=rf"^{name}") as caught:
        make(**{**GOOD, **change})
    assert "got" in str(caught.value)


def test_an_unknown_law_is_refused():
    with pytest.raises(ParameterError, match=r"^law must be one of linear, logarithmic, got 'square'"):
        S(amplitude=1.0, law="square", frequencies=(1.0, 2.0), length=3.0)
