"""A pulse whose frequency varies: each run is that under the pulse of its frequency."""

from dataclasses import dataclass

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions.base import AngularFrequency
from stylobate.base_motions.declared import with_numbers
from stylobate.base_motions.pulses import Waveform
from stylobate.engine.ensembles.polynomials import tabulated, tabulated_alike
from stylobate.errors import ParameterError, UnsupportedError

MODEL = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.05)
P = sb.Pulse
PULSES = {
    "one sine": P.one_sine(acceleration=2.5, angular_frequency=4.0, vertical=0.3),
    "late sine": P.sinusoidal(acceleration=2.5, angular_frequency=4.0, phase=0.4, cycles=1.6, start=0.7),
    "ricker": P.ricker(acceleration=2.5, angular_frequency=4.0, direction=0.6),
    "gabor": P.gabor(velocity=0.6, frequency=0.7, phase=0.4, oscillations=1.7),
    "turned": P.type_b(velocity=0.7, angular_frequency=4.0).rotated(0.3).scaled(1.2),
}
FREQUENCIES = np.array([9.0, 2.5, 4.0, 6.0, 2.5])
# Of the peak acceleration: what each of two tables may miss the motion by.
FITTED = 2e-10

every_pulse = pytest.mark.parametrize("pulse", PULSES.values(), ids=PULSES)


def acceleration_of(table, time):
    """Return the acceleration that a table tells, shape (3, n)."""
    piece = np.searchsorted(table.rows[:, 0], time, side="right") - 1
    begin, end = table.rows[piece, :2].T
    place = (time - 0.5 * (begin + end)) / (0.5 * (end - begin))
    powers = place[:, np.newaxis] ** np.arange(table.degree + 1)
    return np.einsum("nap,np->an", table.coefficients[piece], powers)


@every_pulse
def test_each_run_is_that_under_the_pulse_of_its_frequency(pulse):
    runs = sb.simulate_ensemble(MODEL, pulse, duration=7.0, parameters={"angular_frequency": FREQUENCIES})
    moved = 0
    for run, frequency in zip((runs.isel(run=i) for i in range(runs.sizes["run"])), FREQUENCIES, strict=True):
        alone = sb.simulate(
            MODEL, with_numbers(pulse, {"angular_frequency": float(frequency)}), duration=7.0, recheck=False
        )
        assert sb.Outcome(int(run["outcome"])) == alone.outcome
        if alone.outcome is not sb.Outcome.OVERTURNED:  # else it ends with a step of the method's
            assert float(run["peak_tilt"]) == pytest.approx(alone.measures["peak_tilt"], rel=1e-6, abs=1e-9)
        moved += alone.measures["peak_tilt"] > 0.0
    assert moved >= 3


@every_pulse
@pytest.mark.parametrize("end", [0.4, 6.0])
def test_a_stretched_table_is_that_of_the_pulse_itself_whatever_its_end(pulse, end):
    members = [with_numbers(pulse, {"angular_frequency": frequency}) for frequency in (2.5, 4.0, 9.0)]
    time = np.linspace(0.0, end, 500)[:-1]
    for member, table in zip(members, tabulated_alike(members, end), strict=True):
        size = member.peak_horizontal(0.0)
        assert np.abs(acceleration_of(table, time) - member.acceleration(time).T).max() <= FITTED * size
        own = tabulated(member, end)
        assert table.rows[-1, 1] >= end
        assert table.rows[0, 2:5] == pytest.approx(own.rows[0, 2:5], rel=1e-9)


@dataclass(frozen=True)
class Hump(Waveform):
    """Of a height that falls with its frequency, and a shape that goes with it: no two are alike."""

    angular_frequency: AngularFrequency

    duration = 2.0
    highest_frequency = 12.0

    def derivative(self, time, order):
        assert order == 2
        return np.sin(np.pi * time / 2.0) ** 2 * np.exp(-self.angular_frequency * time)

    def turning_points(self):
        time = np.linspace(0.0, 2.0, 20001)
        values = self.derivative(time, 2)
        best = int(values.argmax())
        return ((float(time[best]), float(values[best])),)


def test_a_pulse_that_is_another_at_each_frequency_is_not_stretched():
    members = [with_numbers(P(waveform=Hump(1.0)), {"angular_frequency": frequency}) for frequency in (1.0, 3.0)]
    time = np.linspace(0.01, 1.99, 200)
    for member, table in zip(members, tabulated_alike(members, 3.0), strict=True):
        wanted = member.waveform.derivative(time, 2)
        assert np.abs(acceleration_of(table, time)[0] - wanted).max() <= FITTED * wanted.max()


def test_the_frequency_of_a_pulse_is_changed_and_told_by_its_name():
    pulse = PULSES["late sine"].scaled(2.0)
    _, faster = sb.with_parameters(MODEL, pulse, angular_frequency=8.0)
    assert faster.duration - 0.7 == pytest.approx(0.5 * (pulse.duration - 0.7))
    assert faster.peak_horizontal(0.0) == pytest.approx(pulse.peak_horizontal(0.0))


def test_a_map_over_the_frequency_of_a_pulse_has_its_runs():
    over = {"angular_frequency": [2.5, 9.0], "acceleration": [0.5, 4.0, 12.0]}
    plane = sb.studies.overturning_map(MODEL, PULSES["one sine"], over=over, duration=5.0)
    found = plane["outcome"].transpose("angular_frequency", "acceleration").values
    for row, frequency in zip(found, over["angular_frequency"], strict=True):
        for code, acceleration in zip(row, over["acceleration"], strict=True):
            one = P.one_sine(acceleration=acceleration, angular_frequency=frequency, vertical=0.3)
            assert sb.Outcome(code) == sb.simulate(MODEL, one, duration=5.0, recheck=False).outcome
    assert len(np.unique(found)) > 1


def test_what_has_no_frequency_is_refused_with_a_word():
    record = sb.sample_record()
    with pytest.raises(UnsupportedError, match=r"angular_frequency: the base motion has no .* It has none"):
        sb.simulate_ensemble(MODEL, record, duration=1.0, parameters={"angular_frequency": [2.0]})
    with pytest.raises(ParameterError, match="angular_frequency must be positive"):
        sb.simulate_ensemble(MODEL, PULSES["ricker"], duration=1.0, parameters={"angular_frequency": [0.0]})
    over = {"angular_frequency": [2.0], "acceleration": [1.0]}
    with pytest.raises(ParameterError, match="periods needs a periodic base motion"):
        sb.studies.overturning_map(MODEL, PULSES["ricker"], over=over, periods=3.0)
    with pytest.raises(
        UnsupportedError,
        match=r"start_phase: the base motion has no such number .* Its numbers are acceleration, angular_freq",
    ):
        sb.simulate_ensemble(MODEL, PULSES["ricker"], duration=1.0, parameters={"start_phase": [0.0]})
