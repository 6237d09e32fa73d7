"""Rocking spectra: peaks of single runs, the conservation of energy, and the free period of Housner's block."""

import json
import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.earthquakes import rocking_spectrum
from stylobate.earthquakes.spectrum_study import peak_tilt_rate
from stylobate.errors import Outcome, ParameterError

C = 0.1
COLUMN = sb.Column.dimensionless(C)
STONE = sb.Slender(sb.Column.solid(radius=0.5, height=5.0, density=2000.0), damping=0.05)
PULSE = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)


@pytest.fixture(scope="module")
def spectrum():
    over = {"size": [0.2, 2.0, 5.0], "scale": [0.5, 1.0]}
    return rocking_spectrum(STONE, PULSE, over=over)


@pytest.mark.parametrize("size", [2.0, 5.0])
def test_peaks_are_those_of_a_single_run(spectrum, size):
    model, pulse = sb.with_parameters(STONE, PULSE, size=size)
    one = spectrum.sel(size=size, scale=1.0)
    run = sb.simulate(model, pulse, duration=float(one["end_time"]), samples=20_001)
    assert one["outcome"].item() == run.outcome
    alpha, p = model.column.tipping_angle, model.column.frequency_parameter
    assert one["peak_tilt_ratio"].item() == pytest.approx(run.measures["peak_tilt"] / alpha, rel=1e-6)
    largest = np.hypot(*run.data["tilt_rate"].to_numpy().T).max()
    assert one["peak_rate_ratio"].item() == pytest.approx(largest / p, rel=1e-3)
    assert one["rocking_period"].item() == pytest.approx(2.0 * math.pi / p)


@pytest.mark.slow
def test_peaks_in_space_are_those_of_a_single_run_too():
    time = 0.02 * np.arange(101)
    shake = 3.0 * np.sin(math.pi * time / 2.0) * np.array([np.cos(7.0 * time), np.sin(5.0 * time), 0.1 * np.cos(time)])
    record = sb.Record(samples=shake.T, step=0.02)
    one = rocking_spectrum(STONE, record, over={"size": [6.0]}).isel(size=0)
    model, record = sb.with_parameters(STONE, record, size=6.0)
    run = sb.simulate(model, record, duration=float(one["end_time"]), samples=20_001)
    assert not run.planar
    largest = np.hypot(*run.data["tilt_rate"].to_numpy().T).max()
    assert one["peak_rate_ratio"].item() == pytest.approx(largest / model.column.frequency_parameter, rel=2e-3)


def test_a_column_that_overturns_has_no_peaks_and_a_pulse_that_does_not_lift_it_none_above_zero(spectrum):
    fallen = spectrum["outcome"] == Outcome.OVERTURNED
    assert fallen.any()
    np.testing.assert_array_equal(spectrum["peak_tilt_ratio"].isnull(), fallen)
    np.testing.assert_array_equal(spectrum["peak_rate_ratio"].isnull(), fallen)
    low = spectrum["acceleration_ratio"].sel(scale=0.5) < 1.0
    assert low.all()
    assert (spectrum["peak_tilt_ratio"].sel(scale=0.5) == 0.0).all()
    assert (spectrum["peak_rate_ratio"].sel(scale=0.5) == 0.0).all()


def test_a_column_let_go_has_at_the_upright_the_rate_that_energy_gives():
    tilts = C * np.array([0.1, 0.5, 0.9])
    free = rocking_spectrum(sb.Slender(COLUMN), BASE_AT_REST, over={"tilt_x": tilts}, rtol=1e-10)
    rates = np.sqrt(2.0 * C * tilts - tilts**2) * COLUMN.frequency_scale
    found = free["peak_rate_ratio"] * free["frequency_parameter"]
    np.testing.assert_allclose(found, rates, rtol=1e-3)


def test_the_peak_rate_errs_by_the_second_order_of_the_step():
    start, errors = 0.7, []
    quarter = math.acosh(1.0 / (1.0 - start))
    for count in (31, 61, 121, 241):
        time = np.linspace(0.0, 1.37 * quarter, count)
        # Let go at `start`, upright at the quarter period with its largest rate, then on the other side.
        phase = np.where(time <= quarter, time, 2.0 * quarter - time)
        tilt = np.where(time <= quarter, 1.0, -1.0) * (1.0 - (1.0 - start) * np.cosh(phase))
        rate = -(1.0 - start) * np.sinh(phase)
        vectors = (np.stack([part, 0.0 * part], axis=-1) for part in (tilt, rate))
        errors.append(abs(float(peak_tilt_rate(time, *vectors)) - math.sqrt(1.0 - (1.0 - start) ** 2)))
    assert errors[-1] < 1e-3
    assert errors[-1] < errors[0] / 30.0


def test_what_was_not_followed_has_no_peak_rate():
    time = np.linspace(0.0, 1.0, 5)
    nothing = np.full((5, 2), np.nan)
    assert np.isnan(peak_tilt_rate(time, nothing, nothing))


# Published for p T = 4 acosh(1/(1 − θ0/α)).
@pytest.mark.parametrize(("ratio", "period"), [(0.1, 1.869), (0.5, 5.268), (0.9, 11.973)])
def test_free_rocking_of_a_block_has_the_period_of_housner(ratio, period):
    block = sb.PlanarRocking(sb.Column.dimensionless(1e-3), restitution=1.0)
    p, start = block.column.frequency_parameter, ratio * block.column.tipping_angle
    run = sb.simulate(block, tilt=(start, 0.0), duration=1.02 * period / p, samples=40_001, rtol=1e-11)
    tilt = run.data["tilt"].to_numpy()[:, 0]
    crossings = run.data["time"].to_numpy()[1:][np.diff(np.sign(tilt)) != 0.0]
    assert crossings.size == 2
    assert 2.0 * p * np.diff(crossings)[0] == pytest.approx(period, abs=1.5e-3)
    assert 4.0 * math.acosh(1.0 / (1.0 - ratio)) == pytest.approx(period, abs=5e-4)


def test_provenance_and_bad_questions():
    found = rocking_spectrum(STONE, PULSE, over={"size": [5.0]}, duration=3.0, samples=11)
    provenance = json.loads(found.attrs["provenance"])
    assert (provenance["duration"], provenance["samples"]) == (3.0, 11)
    assert "sampled_tilt" not in found
    with pytest.raises(ParameterError, match="over must name a parameter"):
        rocking_spectrum(STONE, PULSE, over={})
    with pytest.raises(ParameterError, match=r'over must name a parameter with its values, such as {"size": \[…\]}'):
        rocking_spectrum(STONE, PULSE)
    with pytest.raises(ParameterError, match="samples must be a whole number"):
        rocking_spectrum(STONE, PULSE, over={"size": [1.0]}, samples=1)
