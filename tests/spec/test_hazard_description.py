"""Hazard curves in files: their intensities arrive in SI whatever their unit, and one that tells none has none."""

import pytest

from stylobate.errors import FileError, ParameterError
from stylobate.spec.hazard import Hazard

NUMBERS = "0.1,1e-2\n0.5,1e-3\n"


def points(tmp_path, header, **given):
    (tmp_path / "site.csv").write_text(header + NUMBERS, encoding="utf-8")
    return Hazard.parse({"file": str(tmp_path / "site.csv"), **given}).points()


@pytest.mark.parametrize(
    ("header", "units", "factor", "measure"),
    [
        ("PGA [g], annual rate [1/a]\n", "m s-2", 9.80665, "peak ground acceleration"),
        ("# of the site\nPGA (g); rate (1/yr)\n", "m s-2", 9.80665, "peak ground acceleration"),
        ("# peak ground velocity [cm/s], rate\n", "m s-1", 0.01, "peak ground velocity"),
        ("SA(0.50 s) [cm/s²],rate\n", "m s-2", 0.01, "spectral acceleration at 0.5 s"),
        ("Intensity [m/s2]\tlambda\n", "m s-2", 1.0, ""),
        ("PGA/(g tan α), rate\n", None, 1.0, "PGA/(g tan α)"),
        ("", None, 1.0, ""),
    ],
)
def test_intensities_are_in_si_whatever_the_unit_of_the_file(tmp_path, header, units, factor, measure):
    found = points(tmp_path, header)
    assert found.intensity == pytest.approx((0.1 * factor, 0.5 * factor))
    assert found.rate == (1e-2, 1e-3)
    assert (found.units, found.measure) == (units, measure)


def test_a_description_tells_what_its_file_does_not(tmp_path):
    found = points(tmp_path, "", units="g", measure="PGA")
    assert (found.units, found.measure) == ("m s-2", "peak ground acceleration")
    assert found.intensity == pytest.approx((0.980665, 4.903325))
    listed = Hazard.parse({"intensity": [10.0, 50.0], "rate": [1e-2, 1e-3], "units": "cm/s"}).points()
    assert (listed.intensity, listed.units) == (pytest.approx((0.1, 0.5)), "m s-1")


@pytest.mark.parametrize(
    ("header", "given", "message"),
    [
        ("PGA [g], rate\n", {"units": "m/s²"}, "the file tells units 'g', the description 'm/s²'"),
        ("PGA [g], rate\n", {"measure": "PGV"}, "the file tells measure 'peak ground acceleration'"),
        ("", {"units": "volt"}, 'units must be "g"'),
        ("", {"measure": "magnitude"}, "measure must be 'peak ground acceleration'"),
    ],
)
def test_what_is_told_twice_must_agree(tmp_path, header, given, message):
    with pytest.raises(ParameterError, match=message):
        points(tmp_path, header, **given)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("PGA [furlong], rate\n", r"the unit of the intensity must be g, .* got \[furlong\]"),
        ("PGA [g], return period [a]\n", r"the second column must be the annual rate .* got \[a\]"),
    ],
)
def test_columns_of_something_else_are_refused(tmp_path, header, message):
    with pytest.raises(FileError, match=message):
        points(tmp_path, header)
