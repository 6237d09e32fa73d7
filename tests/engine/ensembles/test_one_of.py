"""Runs under different base motions in one ensemble are those under each of them alone."""

import math

import numpy as np
import pytest

import stylobate as sb

MODEL = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.05)


def noise(seed, samples, step):
    """Return a record of filtered noise in three directions that begins and ends at rest."""
    rng = np.random.default_rng(seed)
    window = np.hanning(samples)[:, np.newaxis]
    smooth = np.apply_along_axis(np.convolve, 0, rng.normal(size=(samples, 3)), np.hanning(9), mode="same")
    return sb.Record(samples=window * smooth * (2.0, 2.0, 0.5), step=step, name=f"noise {seed}")


RECORDS = tuple(noise(seed, 150 + 40 * seed, 0.02) for seed in range(3))


@pytest.fixture(scope="module")
def together():
    rng = np.random.default_rng(1)
    number = np.arange(24) % 3
    parameters = {
        "motion": number,
        "scale": rng.uniform(0.2, 2.0, 24),
        "rotation": rng.uniform(0.0, 6.0, 24),
        "delay": rng.choice([0.0, 0.013, 0.2], 24),
        "offset_x": rng.choice([0.0, 0.03], 24),
        "offset_y": rng.choice([0.0, -0.02], 24),
    }
    return parameters, sb.simulate_ensemble(MODEL, sb.OneOf(motions=RECORDS), duration=8.0, parameters=parameters)


def test_each_run_is_that_under_its_record_alone(together):
    parameters, runs = together
    moved = 0
    for number in range(24):
        record = RECORDS[int(parameters["motion"][number])]
        shaken = (
            record.scaled(parameters["scale"][number])
            .rotated(parameters["rotation"][number])
            .delayed(parameters["delay"][number])
            .offset(parameters["offset_x"][number], parameters["offset_y"][number])
        )
        alone = sb.simulate(MODEL, shaken, duration=8.0, recheck=False)
        run = runs.isel(run=number)
        assert sb.Outcome(int(run["outcome"])) == alone.outcome
        if alone.outcome is sb.Outcome.OVERTURNED:  # what is to come is bounded anew at knots, or as time goes on
            # Of a record with a constant acceleration the ensemble adds the bounds, which decides no earlier.
            added = parameters["offset_x"][number] or parameters["offset_y"][number]
            late = float(run["decided_at"]) - alone.decided_at
            assert -record.step < late < (math.inf if added else record.step)
        else:
            assert float(run["peak_tilt"]) == pytest.approx(alone.measures["peak_tilt"], rel=1e-5, abs=1e-9)
        moved += alone.outcome is not sb.Outcome.AT_REST or alone.measures["peak_tilt"] > 0.0
    assert moved > 12


def test_a_run_does_not_depend_on_the_other_records(together):
    parameters, runs = together
    for number in range(3):
        own = parameters["motion"] == number
        one = sb.simulate_ensemble(
            MODEL,
            RECORDS[number],
            duration=8.0,
            parameters={name: parameters[name][own] for name in parameters if name != "motion"},
        )
        for name in ("outcome", "peak_tilt", "end_tilt", "decided_at"):
            np.testing.assert_array_equal(runs[name].values[own], one[name].values)


def test_accelerations_are_those_of_each_record():
    peak = [0.5, 1.0]
    chosen = sb.OneOf(motions=RECORDS[:2])
    for number, record in enumerate(RECORDS[:2]):
        for wanted in peak:
            _, changed = sb.with_parameters(MODEL, chosen, motion=number, acceleration=wanted)
            assert changed.peak_horizontal() == pytest.approx(wanted)
            np.testing.assert_allclose(
                changed.acceleration(1.234), record.acceleration(1.234) * wanted / record.peak_horizontal()
            )


def test_what_is_linear_is_tabulated_exactly():
    from stylobate.engine.ensembles.polynomials import tabulated

    table = tabulated(RECORDS[0].rotated(0.3) + RECORDS[1].scaled(0.5), 10.0)
    assert table.degree == 1
    rng = np.random.default_rng(2)
    for time in rng.uniform(0.0, RECORDS[1].duration, 50):
        piece = np.searchsorted(table.rows[:, 0], time, side="right") - 1
        row, (constant, slope) = table.rows[piece], table.coefficients[piece].T
        u = (time - 0.5 * (row[0] + row[1])) / (0.5 * (row[1] - row[0]))
        expected = (RECORDS[0].rotated(0.3) + RECORDS[1].scaled(0.5)).acceleration(time)
        np.testing.assert_allclose(constant + slope * u, expected, atol=1e-12)


@pytest.mark.parametrize("number", [-1, 3, 0.5])
def test_there_is_no_motion_of_another_number(number):
    with pytest.raises(sb.errors.ParameterError, match="motion must be a whole number from 0 to 2, of 3 motions"):
        sb.simulate_ensemble(MODEL, sb.OneOf(motions=RECORDS), duration=1.0, parameters={"motion": [number]})


def test_one_motion_is_none_of_several():
    with pytest.raises(sb.errors.UnsupportedError, match="motion can be chosen in a OneOf only"):
        sb.simulate_ensemble(MODEL, RECORDS[0], duration=1.0, parameters={"motion": [0]})
    with pytest.raises(sb.errors.ParameterError, match="motions must be a base motion"):
        sb.OneOf(motions=(3.0,))
