"""Curves for other programs: read back as those programs do, they give the probabilities of the fit."""

import csv
import json
import math
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import scipy
import xarray as xr
from scipy.stats import lognorm, norm

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.earthquakes import export_fragility, fit_fragility, lognormal_fragility
from stylobate.errors import ParameterError

PGA = {"units": "m s-2", "long_name": "peak ground acceleration, RotD50", "component": "RotD50"}
SA = {**PGA, "long_name": "spectral acceleration at 0.5 s, 5 % damping, RotD50"}
PGV = {**PGA, "units": "m s-1", "long_name": "peak ground velocity, RotD50"}
X = np.array([0.1, 0.3, 0.7])  # g


def fitted(about=PGA, medians=(2.0, 4.5)):
    rng = np.random.default_rng(1)
    levels = xr.DataArray(np.geomspace(0.5, 30.0, 14), dims="scale", attrs=about)
    capacity = np.exp(rng.normal(0.0, 0.35, (40, 1)))
    states = xr.DataArray(
        np.array([levels.values > median * capacity for median in medians]),
        dims=("limit_state", "record", "scale"),
        coords={"limit_state": ["tilt 0.1 α", "overturning"]},
    )
    return fit_fragility(levels, states)


@pytest.fixture(scope="module")
def found():
    return fitted()


def expected(found, x, factor=STANDARD_GRAVITY):
    ratio = np.log(np.multiply.outer(1.0 / found["median"].to_numpy(), factor * np.asarray(x)))
    return norm.cdf(ratio / found["dispersion"].to_numpy()[:, np.newaxis])


def of_nrml(path):
    root = ET.parse(path).getroot()  # noqa: S314  written by the test
    space = {"n": "http://openquake.org/xmlns/nrml/0.5"}
    model = root.find("n:fragilityModel", space)
    function = model.find("n:fragilityFunction", space)
    return model.find("n:limitStates", space).text.split(), function, space


def test_nrml_states_mean_and_deviation_of_the_lognormal_curve(found, tmp_path):
    names, function, space = of_nrml(export_fragility(found, tmp_path / "f.xml", name="my statue"))
    assert names == ["tilt_0-dot-1_-alpha-", "overturning"]
    assert function.attrib == {"id": "my_statue", "format": "continuous", "shape": "logncdf"}
    imls = function.find("n:imls", space).attrib
    assert imls["imt"] == "PGA"
    assert float(imls["minIML"]) < 0.05
    assert float(imls["maxIML"]) > 5.0
    for state, chances in zip(function.findall("n:params", space), expected(found, X), strict=True):
        mean, deviation = float(state.attrib["mean"]), float(state.attrib["stddev"])
        share = math.sqrt(math.log1p((deviation / mean) ** 2))
        curve = lognorm(share, scale=mean * math.exp(-0.5 * share**2))
        np.testing.assert_allclose(curve.cdf(X), chances, rtol=1e-10)


def test_discrete_nrml_has_the_points_of_the_curves(found, tmp_path):
    path = export_fragility(found, tmp_path / "f.xml", name="statue", discrete=True)
    names, function, space = of_nrml(path)
    levels = np.array(function.find("n:imls", space).text.split(), dtype=float)
    assert np.all(np.diff(levels) > 0.0)
    for state, chances in zip(function.findall("n:poes", space), expected(found, levels), strict=True):
        np.testing.assert_allclose(np.array(state.text.split(), dtype=float), chances, atol=1e-12)
    assert len(names) == 2


def test_the_table_of_pelicun_has_medians_in_g(found, tmp_path):
    path = export_fragility(found, tmp_path / "f.csv", name="statue")
    with path.open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert (row["ID"], row["Demand-Type"], row["Demand-Unit"]) == ("statue", "Peak Ground Acceleration", "g")
    assert row["Demand-Directional"] == "1"  # pelicun multiplies other demands by 1.2
    for place, chances in enumerate(expected(found, X), start=1):
        median, dispersion = (float(row[f"LS{place}-Theta_{k}"]) for k in range(2))
        np.testing.assert_allclose(norm.cdf(np.log(X / median) / dispersion), chances, rtol=1e-10)
    described = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))["statue"]["LimitStates"]
    assert described["LS2"] == {"DS2": {"Description": "overturning"}}


def test_the_expressions_of_in_core_are_the_curves(found, tmp_path):
    whole = json.loads(export_fragility(found, tmp_path / "f.json", name="statue").read_text(encoding="utf-8"))
    assert (whole["demandTypes"], whole["demandUnits"]) == (["PGA"], ["g"])
    for place, (curve, chances) in enumerate(zip(whole["fragilityCurves"], expected(found, X), strict=True)):
        assert curve["returnType"]["description"] == f"LS_{place}"
        (rule,) = curve["rules"]
        for x, chance in zip(X, chances, strict=True):
            value = eval(rule["expression"], {"scipy": scipy, "math": math, "demand": x})  # noqa: S307
            assert value == pytest.approx(chance, rel=1e-10)


@pytest.mark.parametrize(
    ("about", "factor", "names"),
    [
        (SA, STANDARD_GRAVITY, ("SA(0.5)", "Spectral Acceleration|0.5", "0.5 SA")),
        (PGV, 0.01, ("PGV", "Peak Ground Velocity", "PGV")),
    ],
)
def test_other_intensities_have_the_names_and_units_of_each_program(about, factor, names, tmp_path):
    found = fitted(about)
    _, function, space = of_nrml(export_fragility(found, tmp_path / "f.xml", name="statue"))
    assert function.find("n:imls", space).attrib["imt"] == names[0]
    with export_fragility(found, tmp_path / "f.csv", name="statue").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert row["Demand-Type"] == names[1]
    assert float(row["LS1-Theta_0"]) == pytest.approx(found["median"][0].item() / factor)
    whole = json.loads(export_fragility(found, tmp_path / "f.json", name="statue").read_text(encoding="utf-8"))
    assert whole["demandTypes"] == [names[2]]


def test_a_workbook_has_every_number(found, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    sheet = openpyxl.load_workbook(export_fragility(found, tmp_path / "f.xlsx", name="statue"))["fragility"]
    header, *rows = sheet.iter_rows(values_only=True)
    assert [row[0] for row in rows] == ["tilt 0.1 α", "overturning"]
    at = header.index("median [m/s²]")
    assert [row[at] for row in rows] == found["median"].values.tolist()


def test_what_no_program_could_use_is_refused(found, tmp_path):
    never = fitted(medians=(2.0, 1e4))
    with pytest.raises(
        ParameterError, match=r"fits: 'overturning' has no curve \(none reached\)\. Choose limit states"
    ):
        export_fragility(never, tmp_path / "f.xml", name="statue")
    assert export_fragility(never.sel(limit_state=["tilt 0.1 α"]), tmp_path / "f.xml", name="statue").is_file()
    ratio = lognormal_fragility(2.0, 0.4)
    with pytest.raises(ParameterError, match="intensity"):
        export_fragility(ratio, tmp_path / "f.xml", name="statue")
    soft = fitted({**SA, "long_name": SA["long_name"].replace("5 %", "2 %")})
    with pytest.raises(ParameterError, match="intensity: other programs do not know it"):
        export_fragility(soft, tmp_path / "f.xml", name="statue")
    with pytest.raises(ParameterError, match=r"path must end with \.xml, \.csv, \.json or \.xlsx"):
        export_fragility(found, tmp_path / "f.txt", name="statue")
    with pytest.raises(ParameterError, match="discrete: applies to NRML"):
        export_fragility(found, tmp_path / "f.csv", name="statue", discrete=True)
    with pytest.raises(ParameterError, match="fits must come from fit_fragility"):
        export_fragility({}, tmp_path / "f.xml", name="statue")
