"""Incremental dynamic analyses are ensembles under scaled records, with intensity and limit states of each run."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import SpectralAcceleration, incremental_dynamic_analysis
from stylobate.earthquakes.intensities import Intensity
from stylobate.earthquakes.study_inputs import tail_of
from stylobate.studies.sweeps.store import open_sweep

MODEL = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0), damping=0.05)
SCALES = [0.6, 1.0, 1.4, 1.8, 2.4, 4.0]
PULSES = {
    "long": sb.Pulse.one_sine(acceleration=1.5, angular_frequency=4.0),
    "short": sb.Pulse.one_sine(acceleration=1.5, angular_frequency=12.0, direction=0.7),
}


def noise(seed, samples, step=0.02):
    """Return a record of filtered noise in three directions that begins and ends at rest."""
    rng = np.random.default_rng(seed)
    window = np.hanning(samples)[:, np.newaxis]
    smooth = np.apply_along_axis(np.convolve, 0, rng.normal(size=(samples, 3)), np.hanning(9), mode="same")
    return sb.Record(samples=window * smooth * (0.8, 0.8, 0.3), step=step, name=f"noise {seed}")


RECORDS = (noise(0, 120), noise(1, 160))


@pytest.fixture(scope="module")
def found():
    return incremental_dynamic_analysis(
        MODEL,
        RECORDS,
        scales=SCALES,
        rotations=(0.0, 1.1),
        vertical=(True, False),
        parameters={"damping": [0.02, 0.05, 0.1], "size": [0.9, 1.0, 1.1]},
    )


def test_runs_are_those_of_an_ensemble_under_the_scaled_records_bit_for_bit(found):
    for place, record in enumerate(RECORDS):
        part = found.isel(record=place, rotation=0, property_sample=1)
        for acts in (True, False):
            shaken = sb.OneOf(motions=(record, record.scaled(1.0, vertical=0.0)))
            runs = sb.simulate_ensemble(
                MODEL,
                shaken,
                duration=record.duration + tail_of(MODEL.column),
                parameters={"scale": SCALES, "motion": 0 if acts else 1, "rotation": 0.0, "size": 1.0},
            )
            own = part.sel(vertical=acts)
            for name in ("outcome", "peak_tilt", "end_tilt", "decided_at"):
                np.testing.assert_array_equal(own[name].values, runs[name].values)
    assert len(np.unique(found["outcome"])) > 1


def test_each_run_has_the_column_of_its_property_sample(found):
    rng = np.random.default_rng(5)
    for _ in range(2):
        i, j, k, m, n = (int(rng.integers(size)) for size in (2, 2, 2, 3, 4))
        run = found.isel(record=i, rotation=j, vertical=k, property_sample=m, scale=n)
        model, _ = sb.with_parameters(MODEL, RECORDS[i], damping=float(run["damping"]), size=float(run["size"]))
        vertical = 1.0 if bool(run["vertical"]) else 0.0
        scale = float(run["scale"])
        shaken = RECORDS[i].scaled(scale, vertical=scale * vertical).rotated(float(run["rotation"]))
        alone = sb.simulate(model, shaken, duration=float(run["followed"]))
        assert sb.Outcome(int(run["outcome"])) == alone.outcome
        if alone.outcome is not sb.Outcome.OVERTURNED:
            assert float(run["peak_tilt"]) == pytest.approx(alone.measures["peak_tilt"], rel=1e-4, abs=1e-9)
        assert float(run["followed"]) == pytest.approx(RECORDS[i].duration + 20.0 / model.column.frequency_parameter)


def test_without_its_vertical_component_a_record_is_that_record(found):
    flat = [record.changed("flat", samples=record.samples * (1.0, 1.0, 0.0)) for record in RECORDS]
    off = found.sel(vertical=False).isel(rotation=0, property_sample=1)
    both = incremental_dynamic_analysis(
        MODEL, [*flat, RECORDS[0].changed("", name="any with a vertical component")], scales=SCALES
    )
    np.testing.assert_array_equal(off["outcome"], both["outcome"][:2])
    np.testing.assert_array_equal(off["peak_tilt"], both["peak_tilt"][:2])
    on = found.sel(vertical=True).isel(rotation=0, property_sample=1)
    assert (on["peak_tilt"].values != off["peak_tilt"].values).any()


def test_turning_the_record_turns_the_answer_of_a_round_column(found):
    upright, turned = (found["tilt_ratio"].isel(rotation=place).to_numpy() for place in (0, 1))
    np.testing.assert_array_equal(np.isfinite(upright), np.isfinite(turned))
    rocking = np.isfinite(upright) & (upright > 0.0)
    off = np.abs(turned[rocking] / upright[rocking] - 1.0)
    # Passages near the upright magnify rounding.
    assert np.median(off) < 1e-7
    assert off.max() < 0.02


@pytest.mark.parametrize("angle", [0.4, 2.0, -3.0])
def test_the_direction_of_a_line_does_not_matter(angle):
    lines = {"along x": PULSES["short"].rotated(-0.7), "turned": PULSES["short"].rotated(angle)}
    along = incremental_dynamic_analysis(MODEL, lines, scales=[1.5, 2.0, 3.0, 4.0])
    np.testing.assert_array_equal(along["outcome"][0], along["outcome"][1])
    np.testing.assert_allclose(along["peak_tilt"][0], along["peak_tilt"][1], rtol=1e-6)
    assert 0.0 < float(along["tilt_ratio"][0, 1]) < 1.0


def test_limits_and_peaks_agree():
    runs = incremental_dynamic_analysis(MODEL, PULSES, scales=np.linspace(0.5, 5.0, 10))
    ratio, reached = runs["tilt_ratio"], runs["reached"]
    for state, least in (("tilt 0.1 α", 0.1), ("tilt 0.5 α", 0.5), ("overturning", 1e9)):
        np.testing.assert_array_equal(reached.sel(limit_state=state) == 1, ratio > least)
    np.testing.assert_allclose(runs["intensity"], np.outer([1.5, 1.5], runs["scale"]))


def test_what_was_not_asked_for_is_no_dimension():
    one = incremental_dynamic_analysis(MODEL, PULSES["short"], scales=2.0, parameters={"damping": 0.03})
    assert one["outcome"].dims == ("scale",)
    assert one["record"].item() == "motion 1"
    assert not {"property_sample", "damping"} & set(one.dims)
    several = incremental_dynamic_analysis(MODEL, [PULSES["short"]], scales=[1.0], parameters={"damping": [0.03]})
    assert several["outcome"].dims == ("record", "property_sample", "scale")
    assert several["damping"].values.tolist() == [0.03]
    np.testing.assert_array_equal(
        one["peak_tilt"],
        incremental_dynamic_analysis(
            sb.with_parameters(MODEL, PULSES["short"], damping=0.03)[0], PULSES["short"], scales=[2.0]
        )["peak_tilt"],
    )


def test_an_interrupted_analysis_goes_on_to_the_same_result(tmp_path):
    arguments = {"scales": np.linspace(0.5, 5.0, 6), "rotations": (0.0, 0.3), "parameters": {"damping": [0.02, 0.05]}}
    whole = incremental_dynamic_analysis(MODEL, PULSES, **arguments)

    def stop(done, total):
        if done > 0:
            raise KeyboardInterrupt

    path = tmp_path / "runs.zarr"
    with pytest.raises(sb.Interrupted) as stopped:
        incremental_dynamic_analysis(MODEL, PULSES, **arguments, store=path, progress=stop)
    assert stopped.value.partial.attrs["kind"] == "incremental dynamic analysis"
    assert stopped.value.partial["outcome"].shape == whole["outcome"].shape
    resumed = incremental_dynamic_analysis(MODEL, PULSES, **arguments, store=path, resume=True)
    assert open_sweep(path).attrs["runs_done"] == whole["outcome"].size
    for name in whole.data_vars:
        np.testing.assert_array_equal(resumed[name], whole[name])


def peak_of(component, values):
    """Return the peak of values along x and y, by rotating them degree by degree where the definition does."""
    x, y = values[:, 0], values[:, 1]
    angles = np.radians(np.arange(180))
    peaks = np.abs(np.outer(x, np.cos(angles)) + np.outer(y, np.sin(angles))).max(axis=0)
    along = [np.abs(x).max(), np.abs(y).max()]
    return {
        "RotD50": np.median(peaks),
        "RotD100": np.hypot(x, y).max(),
        "geometric mean": np.sqrt(along[0] * along[1]),
        "larger component": max(along),
    }[component]


@pytest.mark.parametrize("component", ["RotD50", "RotD100", "geometric mean", "larger component"])
def test_intensities_are_proportional_and_say_what_they_are(component):
    column, record = MODEL.column, RECORDS[0]
    strength = 9.80665 * 0.2
    velocity = record.velocity(np.linspace(0.0, record.duration, 20001))
    pga = peak_of(component, record.samples)
    peaks = {
        Intensity.PEAK_ACCELERATION: pga,
        Intensity.ACCELERATION_RATIO: pga / strength,
        "peak ground velocity": peak_of(component, velocity),
    }
    peaks[Intensity.VELOCITY_RATIO] = column.frequency_parameter * peaks["peak ground velocity"] / strength
    spectra = sb.records.response_spectra(record, [0.8])
    psa = spectra["psa"].sel(axis=["x", "y"])
    peaks[SpectralAcceleration(0.8)] = {
        "RotD50": float(spectra["rotd50"][0]),
        "RotD100": float(spectra["rotd100"][0]),
        "geometric mean": float(np.sqrt(psa.prod())),
        "larger component": float(psa.max()),
    }[component]
    for intensity, expected in peaks.items():
        runs = incremental_dynamic_analysis(MODEL, RECORDS, scales=[0.1, 0.2], intensity=intensity, component=component)
        np.testing.assert_allclose(runs["intensity"].sel(record="noise 0"), [0.1 * expected, 0.2 * expected], rtol=1e-3)
        assert runs["intensity"].attrs["long_name"] == runs.attrs["intensity"]
        assert runs.attrs["intensity"].endswith(f", {component}")
        assert runs["intensity"].attrs["component"] == component
    bigger = incremental_dynamic_analysis(
        MODEL, RECORDS, scales=[0.1], intensity="p PGV/(g tan α)", parameters={"size": [1.0, 4.0]}
    )["intensity"]
    np.testing.assert_allclose(bigger.isel(property_sample=1), bigger.isel(property_sample=0) / 2.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"scales": [1.0, 0.0]}, "scales must hold at least one number, all positive, got 0.0"),
        ({"scales": []}, "scales must hold at least one number"),
        ({"rotations": []}, "rotations must hold at least one angle"),
        ({"vertical": (True, True)}, "vertical must be True, False or"),
        ({"records": sb.Harmonic.circular(acceleration=1.0, angular_frequency=2.0)}, "records must end"),
        ({"records": []}, "records must hold at least one base motion"),
        ({"records": [RECORDS[0], RECORDS[0]]}, "records must differ in name, got 'noise 0' twice"),
        ({"records": 3.0}, "records must be a base motion"),
        ({"parameters": {"scale": [1.0]}}, "parameters cannot name scale: use the argument scales"),
        ({"parameters": {"damping": [0.1], "size": [1.0, 2.0]}}, "parameters must have equal numbers of values"),
        ({"intensity": "magnitude"}, "intensity must be 'peak ground acceleration'"),
        ({"component": "GMRotI50"}, r"component: unknown definition .* \(got 'GMRotI50'\)"),
        ({"tail": -1.0}, "tail must be zero or positive"),
        ({"tilt_limit": 0.1}, "tilt_limit must be left out"),
    ],
)
def test_mistakes_are_told(change, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        incremental_dynamic_analysis(MODEL, **{"records": PULSES, "scales": [1.0]} | change)
