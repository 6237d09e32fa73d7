"""Annual rates in an assessment: those of an analysis of its own, any intensity, the study file and the report."""

import re

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import HazardCurve, assess, empirical_rate, incremental_dynamic_analysis
from stylobate.earthquakes.assessment.report.figures import report_pictures
from stylobate.earthquakes.assessment.report.tables import assessment_tables
from stylobate.earthquakes.config.assess import AssessConfig
from stylobate.errors import ConfigError

pytestmark = pytest.mark.long

BODY = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
DISSIPATION = {level: {"damping": eta} for level, eta in (("low", 0.02), ("central", 0.05), ("high", 0.1))}
SCALES = np.geomspace(0.4, 4.0, 12)


def quake(place):
    rng = np.random.default_rng(place)
    times = 0.02 * np.arange(200)
    shape = (times * np.exp(1.0 - times))[:, np.newaxis]
    noise = sb.Record(samples=4.0 * shape * rng.normal(size=(200, 2)), step=0.02, name=f"quake {place}")
    return noise.filtered(lowpass=4.0)


QUAKES = [quake(place) for place in range(4)]
ABOUT = {"units": "m s-2", "component": "RotD50"}
HAZARD = HazardCurve(
    intensity=[0.5, 2.0, 8.0, 30.0], rate=[2e-2, 2e-3, 1e-4, 2e-6], **ABOUT, quantity="peak ground acceleration"
)
SPECTRAL = HazardCurve(
    intensity=[0.5, 2.0, 8.0, 40.0],
    rate=[3e-2, 4e-3, 3e-4, 2e-6],
    **ABOUT,
    quantity="spectral acceleration at 0.5 s, 5 % damping",
)


def assessed(hazard, **more):
    return assess(
        {"slim": sb.Slender(BODY)},
        QUAKES,
        dissipation=DISSIPATION,
        friction_coefficient=0.6,
        scales=[0.1],
        margin_scales=SCALES,
        variations=0,
        planar=False,
        contact=False,
        contact_laws=False,
        tail=2.0,
        hazard=hazard,
        **more,
    )


@pytest.mark.parametrize(("hazard", "intensity"), [(HAZARD, "PGA"), (SPECTRAL, "SA(0.5 s)")])
def test_the_counted_rate_is_that_of_an_analysis_of_its_own(hazard, intensity):
    found = assessed(hazard, least_records=4).data["rates"].sel(column="slim")
    scales = np.unique([*SCALES, *0.1 * np.linspace(0.9, 1.1, 41)])
    runs = incremental_dynamic_analysis(
        sb.Slender(BODY, damping=0.05), QUAKES, scales=scales, tail=2.0, intensity=intensity
    )
    own = empirical_rate(runs["intensity"], runs["reached"], hazard, record=runs["record"], resamples=0)
    states = ["overturning"]
    np.testing.assert_allclose(
        found["annual_rate"].sel(limit_state=states), own["annual_rate"].sel(limit_state=states), rtol=1e-9
    )
    assert 0.0 < found["rate_low"].sel(limit_state="overturning") < found["rate_high"].sel(limit_state="overturning")
    assert np.isfinite(found["fitted_rate"].sel(limit_state="overturning"))


def test_few_records_have_a_counted_rate_alone_and_without_hazard_there_is_none():
    found = assessed(HAZARD, target_rate=1e-9)
    assert "fitted_rate" not in found.data["rates"]
    (row,) = [row for row in assessment_tables(found)["rates"].rows if row[1] == "overturning"]
    assert re.fullmatch(r"\d\.\d\de-\d\d", row[2])
    assert row[5] == ""
    assert row[-1] == "above the target of 1.0e-09 per year"
    assert {row[-1] for row in assessment_tables(found)["rates"].rows if row[1] != "overturning"} == {"–"}
    (above, below) = report_pictures(found)["rates-1"].figure.axes
    np.testing.assert_allclose(above.lines[0].get_xydata(), np.transpose([HAZARD.intensity, HAZARD.rate]), rtol=1e-12)
    own = found.data["rates"].sel(column="slim", limit_state="overturning")
    heights, edges, _ = below.patches[0].get_data()
    np.testing.assert_allclose(heights * np.diff(np.log(edges)), own["contribution"] / own["annual_rate"], rtol=1e-12)
    bare = assessed(None)
    assert "rates" not in bare.data
    assert "rates" not in assessment_tables(bare)


STUDY = {
    "columns": {"tank": {"shape": "solid", "radius": 0.2, "height": 2.0, "density": 2700.0}},
    "dissipation": DISSIPATION,
    "friction_coefficient": 0.6,
    "records": {"samples": ["el centro 1940"]},
}


def test_a_study_states_its_hazard(tmp_path):
    (tmp_path / "site.csv").write_text("SA(0.5 s) RotD50 [g], probability in 50 years\n0.05, 0.5\n0.5, 0.05\n")
    hazard = {"file": str(tmp_path / "site.csv")}
    options = AssessConfig.parse({**STUDY, "hazard": hazard, "target_rate": 1e-4, "years": 100.0}).build().options
    assert options["hazard"].quantity == "spectral acceleration at 0.5 s, 5 % damping"
    assert options["hazard"].units == "m s-2"
    assert (options["target_rate"], options["years"]) == (1e-4, 100.0)
    (tmp_path / "study.toml").write_text('hazard = {file = "site.csv"}\n')
    assert sb.config.read_config(tmp_path / "study.toml")["hazard"]["file"] == str(tmp_path / "site.csv")


def test_a_table_of_openquake_is_read_and_asked_for_its_component(tmp_path):
    path = tmp_path / "hazard_curve-mean-SA(0.5)_1.csv"
    path.write_text(
        "#,,,,,\"generated_by='OpenQuake engine 3.16', kind='mean', investigation_time=50.0, imt='SA(0.5)'\"\n"
        "lon,lat,depth,poe-0.05,poe-0.2,poe-0.8\n14.5,42.1,0.0,0.9,0.3,0.02\n"
    )
    with pytest.raises(ConfigError, match=r'^hazard: component: missing. State it, such as component = "RotD50"$'):
        AssessConfig.parse({**STUDY, "hazard": {"file": str(path)}}).build()
    hazard = {"file": str(path), "component": "geometric mean"}
    found = AssessConfig.parse({**STUDY, "hazard": hazard}).build().options["hazard"]
    np.testing.assert_allclose(found.intensity, 9.80665 * np.array([0.05, 0.2, 0.8]), rtol=1e-12)
    np.testing.assert_allclose(found.rate, -np.log1p(-np.array([0.9, 0.3, 0.02])) / 50.0, rtol=1e-12)
    assert (found.quantity, found.component) == ("spectral acceleration at 0.5 s, 5 % damping", "geometric mean")


@pytest.mark.parametrize(
    ("hazard", "line"),
    [
        ({"intensity": [0.1, 1.0], "rate": [1e-2, 1e-4], "units": "g"}, "hazard: measure: missing. State it, such as"),
        (
            {"intensity": [0.1, 1.0], "rate": [1e-2, 1e-4], "units": "g", "measure": "PGA"},
            "hazard: component: missing. State it, such as",
        ),
        (
            {"intensity": [0.1, 1.0], "rate": [1e-2, 1e-4], "units": "m/s", "measure": "PGA", "component": "RotD50"},
            "hazard uses an intensity in m/s, but the",
        ),
    ],
)
def test_a_hazard_that_lacks_something_is_refused(hazard, line):
    with pytest.raises(ConfigError) as raised:
        AssessConfig.parse({**STUDY, "hazard": hazard}).build()
    assert any(line in problem for problem in raised.value.problems)
