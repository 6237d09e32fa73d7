"""Overturning intervals of the amplitude: closed forms of pulses, dense scans, and the scaling of size and time."""

import json
import math

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes import overturning_intervals
from stylobate.earthquakes.overturning_scales import Cases
from stylobate.errors import Interrupted, Outcome, ParameterError, UnlikelyInputWarning, UnsupportedError

C = 0.1
COLUMN = sb.Column.dimensionless(C)
LINEAR = sb.Slender(COLUMN)  # the linear block, with ω0 in the place of p, and without loss at impacts
VISCOUS = sb.Slender(COLUMN, damping=0.1)
SINE = sb.Pulse.one_sine(acceleration=C, angular_frequency=1.0)
FREQUENCIES = [2.0, 5.0, 10.0]


@pytest.fixture(scope="module")
def spectrum():
    over = {"angular_frequency": [3.0, 5.0, 6.0]}
    return overturning_intervals(VISCOUS, SINE, scales=np.geomspace(1.0, 15.0, 16), over=over)


def test_the_least_half_sine_is_that_of_theory():
    pulse = sb.Pulse.half_sine(acceleration=C, angular_frequency=1.0)
    over = {"angular_frequency": FREQUENCIES}
    found = overturning_intervals(LINEAR, pulse, scales=[1.0, 3.0, 9.0], over=over, width=1e-6, rtol=1e-10)
    least = sb.theory.half_sine_overturning(FREQUENCIES, 1.0)
    np.testing.assert_allclose(least, [1.80072, 3.28915, 5.78652], atol=5e-6)
    # Its bracket is 1e-6 wide, the runs err by less.
    assert (found["safe_below"][:, 0] < least * (1.0 + 1e-7)).all()
    assert (found["interval_from"][:, 0] > least * (1.0 - 1e-7)).all()
    assert (found["interval_from"][:, 0] <= found["safe_below"][:, 0] * (1.0 + 1e-6)).all()
    assert found["open_above"][:, 0].all()


@pytest.mark.slow  # a kernel of its own
def test_one_sine_overturns_a_block_between_two_amplitudes_and_above_a_third():
    column = sb.Column.dimensionless(1e-3)
    model, p = sb.PlanarRocking(column, restitution=0.9), column.frequency_parameter
    pulse = sb.Pulse.one_sine(acceleration=1e-3, angular_frequency=5.0 * p)
    found = overturning_intervals(model, pulse, scales=np.geomspace(1.0, 12.0, 12), width=1e-6, rtol=1e-10)
    # Errors of the order c², 1e-6.
    least = float(sb.theory.one_sine_overturning_without_impact(5.0, 1.0))
    interval = sb.theory.one_sine_overturning_after_impact(5.0, 1.0, restitution=0.9)
    np.testing.assert_allclose([found["interval_from"][0], found["interval_to"][0]], interval, rtol=5e-6)
    assert found["interval_from"][1] == pytest.approx(least, rel=5e-6)
    assert found["open_above"].values.tolist() == [False, True]


def test_a_dense_scan_agrees_with_the_intervals(spectrum):
    scales = np.geomspace(1.0, 15.0, 301)
    pulse = sb.Pulse.one_sine(acceleration=C, angular_frequency=5.0)
    dense = sb.simulate_ensemble(VISCOUS, pulse, duration=40.0, parameters={"scale": scales})
    fallen = dense["outcome"].to_numpy() == Outcome.OVERTURNED
    one = spectrum.sel(angular_frequency=5.0)
    inside, outside = np.zeros(301, dtype=bool), np.ones(301, dtype=bool)
    for interval in range(2):
        low, high, below, above = (
            one[name][interval].item() for name in ("interval_from", "interval_to", "safe_below", "safe_above")
        )
        inside |= (scales >= low) & (scales <= high)
        outside &= (scales <= below) | (scales >= above)
    np.testing.assert_array_equal(fallen[inside | outside], inside[inside | outside])
    assert np.count_nonzero(inside | outside) >= 298  # all but those between the ends of an edge
    assert int(one["intervals"]) == 2
    assert np.count_nonzero(np.diff(fallen)) == 3


def test_cases_with_fewer_intervals_than_others_have_empty_places():
    over = {"angular_frequency": [5.0, 12.0]}
    spectrum = overturning_intervals(VISCOUS, SINE, scales=np.geomspace(1.0, 15.0, 9), over=over)
    empty = spectrum["interval_from"].isnull()
    np.testing.assert_array_equal((~empty).sum("interval"), spectrum["intervals"])
    assert int(empty.sum()) > 0
    names = [name for name, one in spectrum.data_vars.items() if one.dims == spectrum["interval_from"].dims]
    for name in names:
        places = spectrum[name].to_numpy()[empty.to_numpy()]
        assert not places.any() if places.dtype == bool else np.isnan(places).all(), name


def test_a_gap_narrower_than_the_scan_is_found_by_the_direction(spectrum):
    pulse = sb.Pulse.one_sine(acceleration=C, angular_frequency=5.0)
    found = overturning_intervals(VISCOUS, pulse, scales=[1.0, 5.0, 12.0])
    fine = spectrum.sel(angular_frequency=5.0)
    assert int(found["intervals"]) == 2
    for name in ("interval_from", "interval_to"):
        np.testing.assert_allclose(found[name][:1], fine[name][:1], rtol=2e-3)
    assert found["interval_from"][1] == pytest.approx(fine["interval_from"][1].item(), rel=2e-3)


@pytest.mark.slow
def test_without_loss_the_direction_turns_where_theory_says_and_no_gap_opens():
    pulse = sb.Pulse.one_sine(acceleration=C, angular_frequency=5.0)
    least = float(sb.theory.one_sine_overturning_without_impact(5.0, 1.0))
    found = overturning_intervals(LINEAR, pulse, scales=[1.0, 4.0, 0.999 * least, 1.001 * least], width=1e-5)
    assert int(found["intervals"]) == int(found["reversals"]) == 1
    # At the edge itself a column takes its time: followed too briefly, it would seem safe.
    tail = 20.0 / LINEAR.column.frequency_parameter
    brief = overturning_intervals(LINEAR, pulse, scales=[4.0, 0.999 * least, 1.001 * least], width=1e-5, tail=tail)
    assert int(brief["intervals"]) == 2
    below = overturning_intervals(LINEAR, pulse, scales=[1.0, 4.0, 0.999 * least], width=1e-5)
    assert int(below["reversals"]) == 0


def test_a_smaller_width_lies_within_a_larger_one(spectrum):
    coarse = overturning_intervals(
        VISCOUS, SINE, scales=spectrum["scale"], over={"angular_frequency": [3.0, 5.0, 6.0]}, width=0.03
    )
    assert coarse.attrs["runs"] < spectrum.attrs["runs"]
    for found, width in ((coarse, 0.03), (spectrum, 1e-3)):
        closed = found["safe_below"].notnull()
        assert (found["interval_from"] <= found["safe_below"] * (1.0 + width)).where(closed, True).all()
        assert (found["interval_from"] > found["safe_below"]).where(closed, True).all()
    first = {"interval": 0}
    assert (coarse["safe_below"] <= spectrum["safe_below"]).isel(first).all()
    assert (coarse["interval_from"] >= spectrum["interval_from"]).isel(first).all()


def test_size_is_frequency_squared():
    stone = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.1)
    scales, sizes = np.geomspace(1.0, 12.0, 12), np.array([1.0, 2.0, 3.0])
    pulse = sb.Pulse.one_sine(acceleration=0.1 * 9.80665, angular_frequency=10.0)
    by_size = overturning_intervals(stone, pulse, scales=scales, over={"size": sizes})
    by_frequency = overturning_intervals(stone, pulse, scales=scales, over={"angular_frequency": 10.0 * np.sqrt(sizes)})
    assert by_size["intervals"].max() == 2
    np.testing.assert_allclose(by_size["frequency_ratio"], by_frequency["frequency_ratio"], rtol=1e-12)
    for name in ("interval_from", "interval_to", "safe_below", "safe_above"):
        # The same runs but for rounding: the same scales are tried, and the same found.
        np.testing.assert_allclose(by_size[name], by_frequency[name], rtol=1e-12)


def test_each_case_is_found_as_alone(spectrum):
    alone = overturning_intervals(VISCOUS, SINE, scales=spectrum["scale"], over={"angular_frequency": [6.0]})
    xr.testing.assert_equal(alone["outcome"], spectrum["outcome"].sel(angular_frequency=[6.0]))
    count = alone.sizes["interval"]
    for name in ("interval_from", "interval_to", "safe_below", "safe_above"):
        xr.testing.assert_equal(alone[name], spectrum[name].sel(angular_frequency=[6.0]).isel(interval=slice(count)))


def test_several_motions_are_those_one_by_one(spectrum):
    pulses = tuple(sb.Pulse.one_sine(acceleration=C, angular_frequency=w) for w in (3.0, 6.0))
    found = overturning_intervals(VISCOUS, sb.OneOf(motions=pulses), scales=spectrum["scale"], over={"motion": [1, 0]})
    chosen = spectrum.sel(angular_frequency=[6.0, 3.0])
    np.testing.assert_array_equal(
        found["interval_from"], chosen["interval_from"].isel(interval=slice(found.sizes["interval"]))
    )
    assert found["motion_name"].values.tolist() == ["motion 1", "motion 0"]
    np.testing.assert_allclose(found["frequency_ratio"], chosen["frequency_ratio"])


def test_coordinates_normalize_as_the_literature_does():
    column = sb.Column.solid(radius=0.5, height=5.0, density=2000.0)
    pulse = sb.Pulse.ricker(acceleration=2.0, angular_frequency=6.0)
    over = {"size": [1.0, 4.0], "slenderness": [0.1, 0.2]}
    found = overturning_intervals(sb.Slender(column, damping=0.1), pulse, scales=[0.1, 0.2], over=over)
    changed = column.with_slenderness(0.1).resized(4.0)
    here = found.sel(size=4.0, slenderness=0.1)
    assert here["frequency_parameter"].item() == pytest.approx(changed.frequency_parameter)
    assert here["acceleration_ratio"].item() == pytest.approx(2.0 / (9.80665 * 0.1))
    assert here["frequency_ratio"].item() == pytest.approx(6.0 / changed.frequency_parameter)
    assert here["tipping_angle"].item() == pytest.approx(math.atan(0.1))
    # Below g tan α nothing is released, and nothing overturns.
    assert int(found["intervals"].sum()) == 0
    assert (found["outcome"] == Outcome.AT_REST).all()


def test_a_record_overturns_in_intervals_too():
    samples = C * 9.80665 * np.sin(5.0 * np.arange(64) * math.pi / 158.0)
    record = sb.Record(samples=np.stack([samples, 0.3 * samples[::-1], 0.01 * samples], axis=1), step=0.02)
    stone = sb.Slender(sb.Column.solid(radius=0.2, height=4.0, density=2700.0), damping=0.1)
    found = overturning_intervals(
        stone, record, scales=np.geomspace(1.0, 10.0, 6), over={"size": [0.5, 1.0]}, width=0.01
    )
    assert (found["intervals"] >= 1).all()
    assert "frequency_ratio" not in found.coords
    # A larger column of the same shape needs more.
    assert float(found["interval_from"][1, 0]) > float(found["interval_from"][0, 0])


@pytest.mark.slow
def test_a_store_keeps_scan_and_edges(tmp_path):
    store, calls = tmp_path / "intervals.zarr", []
    question = {"scales": [1.0, 3.0, 6.0], "over": {"angular_frequency": [5.0]}, "store": store}
    first = overturning_intervals(VISCOUS, SINE, **question)
    again = overturning_intervals(
        VISCOUS, SINE, **question, resume=True, progress=lambda done, total: calls.append((done, total))
    )
    xr.testing.assert_identical(first, again)
    # Nothing is computed: each part is done as soon as it begins.
    assert len(calls) == len(list(store.glob("edges*"))) + 1
    with pytest.raises(sb.errors.FileError, match="exists"):
        overturning_intervals(VISCOUS, SINE, **question)


def test_after_an_interruption_the_intervals_are_those_of_the_scan():
    def stop(done, total):
        if done > 6:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as caught:
        overturning_intervals(VISCOUS, SINE, scales=np.geomspace(1.0, 9.0, 6), progress=stop)
    partial = caught.value.partial
    assert partial.attrs["kind"] == "overturning intervals"
    assert int(partial["computed"]) == 6
    assert int(partial["intervals"]) == 1


def test_provenance_repeats_the_question(spectrum):
    provenance = json.loads(spectrum.attrs["provenance"])
    assert provenance["motion"]["kind"] == "sinusoidal"
    assert provenance["tail"] is None
    assert provenance["width"] == 1e-3
    assert f"{15.0 ** (1 / 15):.4g}" in spectrum.attrs["resolution"]


@pytest.mark.parametrize(
    ("changed", "line"),
    [
        ({"scales": [1.0]}, r"scales must be two or more positive numbers, increasing; got \[1.0\]"),
        ({"scales": [0.0, 1.0]}, "scales must be two or more positive numbers"),
        ({"scales": [2.0, 1.0]}, "scales must be two or more positive numbers"),
        ({"over": {"scale": [1.0]}}, "over cannot name scale: give scales"),
        ({"over": {"duration": [1.0]}}, "over cannot name duration: give duration or tail"),
        ({"over": {"size": []}}, r"over\['size'\] must have at least one value"),
        ({"over": ["size"]}, "over must name parameters with their values"),
        ({"over": {"weight": [1.0]}}, "over: weight is not known here"),
        ({"width": 1e-12}, "width must be at least 1e-09"),
        ({"tail": 0.0}, "tail must be positive"),
        ({"tilt_limit": 0.1}, "tilt_limit must be left out"),
        ({"motion": sb.Harmonic.circular(acceleration=1.0, angular_frequency=2.0)}, "duration must be given"),
        ({"motion": None}, "motion must be a base motion"),
        ({"model": COLUMN}, "model must be a model"),
    ],
)
def test_bad_questions_are_told_by_name(changed, line):
    question = {"model": VISCOUS, "motion": SINE, "scales": [1.0, 2.0], **changed}
    with pytest.raises(ParameterError, match=f"^{line}"):
        overturning_intervals(question.pop("model"), question.pop("motion"), **question)


def test_a_record_has_no_frequency_to_vary():
    record = sb.Record(samples=[0.0, 1.0, 0.0], step=0.1)
    with pytest.raises(UnsupportedError, match="angular_frequency: the base motion has no such number"):
        overturning_intervals(VISCOUS, record, scales=[1.0, 2.0], over={"angular_frequency": [1.0]})


def test_a_radius_that_varies_alone_is_remarked_on_and_a_size_is_not():
    cases = [{"radius": [0.1]}, {"mass_height": [1.0], "damping": [0.1]}]
    for over in cases:
        message = f"^over: {next(iter(over))} varies without mass .* Vary size to scale a column"
        with pytest.warns(UnlikelyInputWarning, match=message):
            Cases.of(VISCOUS, SINE, over)
    for over in ({"size": [2.0]}, {"slenderness": [0.2]}, {"radius": [0.1], "transverse_inertia": [1.0]}):
        Cases.of(VISCOUS, SINE, over)


def test_the_tail_is_in_seconds_and_by_default_forty_over_p():
    pulse, scales = sb.Pulse.one_sine(acceleration=C, angular_frequency=5.0), [0.5, 1.0]
    over = {"size": [1.0, 4.0]}
    usual = overturning_intervals(LINEAR, pulse, scales=scales, over=over)
    p = LINEAR.column.frequency_parameter / np.array([1.0, 2.0])
    np.testing.assert_allclose(usual["end_time"].max("scale"), pulse.duration + 40.0 / p, rtol=1e-12)
    brief = overturning_intervals(LINEAR, pulse, scales=scales, over=over, tail=3.0)
    np.testing.assert_allclose(brief["end_time"].max("scale"), pulse.duration + 3.0, rtol=1e-12)


@pytest.mark.slow
def test_a_refined_scan_finds_below_its_first_interval_what_a_finer_scan_finds():
    column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
    quakes = sb.OneOf(motions=tuple(sb.sample_record("el centro 1940").trimmed(0.0, end) for end in (12.0, 9.0)))
    coarse, number = np.geomspace(0.2, 1.6, 22), 180
    fine = np.geomspace(0.2, 1.6, number)
    over = {"damping": [0.0, 0.005, 0.01, 0.02, 0.04], "motion": [0.0, 1.0]}

    def least(scales, **options):
        found = overturning_intervals(sb.Wobbling(column), quakes, scales=scales, over=over, width=0.2, **options)
        return found.isel(interval=0)["interval_from"].to_numpy()

    plain, refined, dense = least(coarse), least(coarse, fine_scales=number), least(fine)
    # The steps are narrower than the width, so no edge is bisected.
    np.testing.assert_allclose(refined, np.minimum(plain, dense), rtol=1e-12)
    assert (refined < 0.98 * plain).any()
