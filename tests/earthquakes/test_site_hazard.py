"""Hazard and fragility are brought together only where both state the same intensity measure."""

import pytest

from stylobate.earthquakes.config.hazard import Hazard
from stylobate.earthquakes.fragility_study import site_hazard
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure, SpectralAcceleration
from stylobate.errors import ParameterError

LISTED = {"intensity": [0.1, 0.5], "rate": [1e-2, 1e-3], "units": "g", "component": "RotD50"}


def curve(tmp_path, quantity, *, in_file, **given):
    values = {**LISTED, **given}
    if in_file:
        (tmp_path / "site.csv").write_text("intensity [g], rate\n0.1,1e-2\n0.5,1e-3\n")
        values = {"file": str(tmp_path / "site.csv"), "component": "RotD50", **given}
    return site_hazard(Hazard.parse(values).points(), IntensityMeasure(quantity))


@pytest.mark.parametrize("in_file", [True, False])
@pytest.mark.parametrize("quantity", [Intensity.PEAK_ACCELERATION, SpectralAcceleration(1.0)])
def test_a_hazard_must_state_its_intensity_measure_in_a_file_or_in_a_table(tmp_path, quantity, in_file):
    with pytest.raises(ParameterError, match=r"fragility.hazard: intensity measure not stated\. .* measure, such as"):
        curve(tmp_path, quantity, in_file=in_file)
    measure = "PGA" if quantity is Intensity.PEAK_ACCELERATION else "SA(1 s)"
    found = curve(tmp_path, quantity, in_file=in_file, measure=measure)
    assert found.quantity == quantity.value
    with pytest.raises(ParameterError, match="Provide both for the same intensity measure"):
        curve(tmp_path, quantity, in_file=in_file, measure="SA(0.5 s)")


def test_a_hazard_of_five_percent_damping_is_not_taken_for_another_damping(tmp_path):
    with pytest.raises(ParameterError, match=r"at 1 s, 5 % damping', but the fragility uses .* 2 % damping"):
        curve(tmp_path, SpectralAcceleration(1.0, damping=0.02), in_file=False, measure="SA(1 s)")


def test_a_hazard_must_state_its_unit(tmp_path):
    message = "fragility.hazard does not state the unit of its intensity; "
    with pytest.raises(ParameterError, match=message + 'give units, such as units = "g"'):
        curve(tmp_path, Intensity.PEAK_ACCELERATION, in_file=False, measure="PGA", units=None)
    path = tmp_path / "bare.csv"
    path.write_text("PGA RotD50, annual rate [1/a]\n0.1,1e-2\n0.5,1e-3\n")
    points = Hazard.parse({"file": str(path), "component": "RotD50", "measure": "PGA"}).points()
    with pytest.raises(ParameterError, match=message + r"name it in the first line of .*bare\.csv, such as"):
        site_hazard(points, IntensityMeasure(Intensity.PEAK_ACCELERATION))


def test_a_hazard_in_another_unit_than_the_fragility_is_refused(tmp_path):
    with pytest.raises(ParameterError, match=r"an intensity in .*, but the fragility uses .* in .*\. Provide both for"):
        curve(tmp_path, Intensity.PEAK_VELOCITY, in_file=False, measure="PGV")
