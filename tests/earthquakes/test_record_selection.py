"""Records that fit a target spectrum: factors by least squares, bounds, order, and the study that is written."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import stylobate as sb
from stylobate.base_motions import Record
from stylobate.earthquakes import select_records
from stylobate.errors import ParameterError
from stylobate.records import response_spectra
from stylobate.results.report_details import DesignSpectrum

pytestmark = pytest.mark.long

TARGET = DesignSpectrum(period=(0.05, 0.15, 0.5, 2.5), acceleration=(4.0, 9.0, 9.0, 1.8))


@pytest.fixture(scope="module")
def quakes():
    rng = np.random.default_rng(11)
    times = 0.01 * np.arange(1500)
    shape = (times / 3.0 * np.exp(1.0 - times / 3.0))[:, np.newaxis]
    noise = [Record(samples=shape * rng.normal(size=(1500, 2)), step=0.01, name=f"quake {k}") for k in range(6)]
    return [one.filtered(lowpass=4.0 + k) for k, one in enumerate(noise)]


@pytest.fixture(scope="module")
def found(quakes):
    return select_records(quakes, TARGET, number=3, periods=(0.2, 2.0), scales=(0.5, 8.0))


def test_factors_have_the_least_squares_of_the_logarithms(quakes, found):
    natural = found["period"].to_numpy()
    wanted = np.interp(natural, TARGET.period, TARGET.acceleration)
    for quake in quakes:
        spectrum = response_spectra(quake, natural)["rotd50"].to_numpy()

        def misfit(log_factor, spectrum=spectrum):
            return np.sqrt(np.mean((log_factor + np.log(spectrum / wanted)) ** 2))

        best = minimize_scalar(misfit, bounds=(np.log(0.5), np.log(8.0)), method="bounded", options={"xatol": 1e-10})
        one = found.sel(record=quake.name)
        assert one["scale"].item() == pytest.approx(np.exp(best.x), rel=1e-5)
        assert one["misfit"].item() == pytest.approx(best.fun, rel=1e-8)


def test_those_with_the_least_misfit_are_chosen_and_their_mean_is_measured(found):
    misfit, chosen = found["misfit"].to_numpy(), found["chosen"].to_numpy()
    assert np.all(np.diff(misfit) >= 0.0)
    assert chosen.tolist() == [True] * 3 + [False] * 3
    mean = found["spectral_acceleration"].to_numpy()[chosen].mean(axis=0)
    np.testing.assert_allclose(found["mean"], mean)
    ratio = mean / found["target"].to_numpy()
    assert (found.attrs["least_ratio"], found.attrs["largest_ratio"]) == (ratio.min(), ratio.max())


def test_factors_keep_their_bounds_and_scaled_copies_are_one_record(quakes, found):
    narrow = select_records(quakes, TARGET, number=3, periods=(0.2, 2.0), scales=(1.0, 1.1))
    assert narrow["scale"].to_numpy().max() <= 1.1
    np.testing.assert_array_equal(narrow["at_bound"], np.isin(narrow["scale"], [1.0, 1.1]))
    halves = [quake.scaled(0.5) for quake in quakes]
    again = select_records(halves, TARGET, number=3, periods=(0.2, 2.0), scales=(1.0, 16.0))
    np.testing.assert_allclose(again["scale"], 2.0 * found["scale"], rtol=1e-10)
    assert again["record"].values.tolist() == found["record"].values.tolist()
    without = select_records(quakes, TARGET, number=5, without=[str(found["record"][0].item())])
    assert found["record"][0].item() not in without["record"]


def test_it_is_drawn(found, tmp_path):
    sb.plot(found).savefig(tmp_path / "selection.png")
    assert (tmp_path / "selection.png").stat().st_size > 10_000


def test_mistakes_are_one_line(quakes):
    for change, line in (
        ({"number": 7}, "number must be at most 6, the number of candidates, got 7"),
        ({"periods": (0.2, 3.0)}, r"periods must lie within those of the target, 0\.05 s to 2\.5 s, got 0\.2 s to 3 s"),
        ({"periods": (2.0, 0.2)}, "periods must rise, got 2 to 0.2"),
        ({"scales": (1.0,)}, "scales must be two numbers, the least and the largest"),
        ({"without": ["quake 9"]}, r"without: no record has this name \(got 'quake 9'\)"),
        ({"component": "mean"}, "unknown definition of the horizontal component"),
    ):
        with pytest.raises(ParameterError, match=line):
            select_records(quakes, TARGET, **{"number": 2, **change})
    with pytest.raises(ParameterError, match="records: two of them are called 'quake 0'"):
        select_records([quakes[0], quakes[0]], TARGET, number=1)
