"""Hazard curves in files: in SI whatever their unit, as rates or probabilities, and refused where they are unclear."""

import pytest

from stylobate.earthquakes.config.hazard import Hazard
from stylobate.errors import FileError, ParameterError

NUMBERS = "0.1,1e-2\n0.5,1e-3\n"
POISSON = "PGA RotD50 [g], probability in 50 years\n"
# The two ways in which OpenQuake has written its hazard curves.
OLD = "# source_model_tree_path=('b1',), gsim_tree_path=('b1',), investigation_time=50.0,imt=\"PGA\"\n"
NEW = "#,,,,,\"generated_by='OpenQuake engine 3.15', kind='mean', investigation_time=50.0, imt='SA(0.1)'\"\n"
SITES = (
    "lon,lat,depth,poe-0.1000000,poe-0.4000000,poe-0.6000000\n"
    "22.35000,37.95000,-0.10000,4.5E-01,5.5E-02,0.0E+00\n"
    "23.70000,38.00000,-0.10000,3.0E-01,2.0E-02,1.0E-03\n"
)


def points(tmp_path, content, **given):
    (tmp_path / "site.csv").write_text(content, encoding="utf-8")
    return Hazard.parse({"file": str(tmp_path / "site.csv"), **given}).points()


@pytest.mark.parametrize(
    ("header", "units", "factor", "measure", "component"),
    [
        ("PGA [g], annual rate [1/a]\n", "m s-2", 9.80665, "peak ground acceleration", None),
        ("PGA RotD50 [g], annual rate [1/a]\n", "m s-2", 9.80665, "peak ground acceleration", "RotD50"),
        ("PGA, geometric mean [g], rate\n", "m s-2", 9.80665, "peak ground acceleration", "geometric mean"),
        ("# of the site\nPGA (g); rate (1/yr)\n", "m s-2", 9.80665, "peak ground acceleration", None),
        (
            "# component: larger component\nPGA [g]; rate\n",
            "m s-2",
            9.80665,
            "peak ground acceleration",
            "larger component",
        ),
        ("# peak ground velocity [cm/s], rate\n", "m s-1", 0.01, "peak ground velocity", None),
        ("SA(0.50 s) RotD100 [cm/s²],rate\n", "m s-2", 0.01, "spectral acceleration at 0.5 s, 5 % damping", "RotD100"),
        ("Intensity [m/s2]\tlambda\n", "m s-2", 1.0, "", None),
        ("# Olympia, Greece\nPGA/(g tan α), rate\n", None, 1.0, "PGA/(g tan α)", None),
    ],
)
def test_intensities_are_in_si_whatever_the_unit_of_the_file(tmp_path, header, units, factor, measure, component):
    found = points(tmp_path, header + NUMBERS)
    assert found.intensity == pytest.approx((0.1 * factor, 0.5 * factor))
    assert found.exceedance == (1e-2, 1e-3)
    assert found.investigation_time is None
    assert (found.units, found.measure, found.component) == (units, measure, component)


@pytest.mark.parametrize(
    ("header", "time", "factor"),
    [
        ("PGA [g], probability in 50 years\n", 50.0, 1.0),
        ("PGA [g], PoE in 475 yr\n", 475.0, 1.0),
        ("PGA [g], probability of exceedance [50 years]\n", 50.0, 1.0),
        ("PGA [g], annual probability of exceedance\n", 1.0, 1.0),
        ("PGA [g], PoE in 50 years [%]\n", 50.0, 0.01),
        ("PGA [g], annual rate of exceedance [1/yr]\n", None, 1.0),
        ("PGA [g], annual frequency of exceedance\n", None, 1.0),
    ],
)
def test_a_header_tells_probabilities_apart_from_rates(tmp_path, header, time, factor):
    found = points(tmp_path, header + NUMBERS)
    assert found.investigation_time == time
    assert found.exceedance == pytest.approx((1e-2 * factor, 1e-3 * factor))


def test_a_description_states_what_its_file_does_not(tmp_path):
    found = points(
        tmp_path, "intensity, PoE\n" + NUMBERS, units="g", measure="PGA", component="rotd50", investigation_time=50
    )
    assert (found.units, found.measure) == ("m s-2", "peak ground acceleration")
    assert (found.component, found.investigation_time) == ("RotD50", 50.0)
    assert found.intensity == pytest.approx((0.980665, 4.903325))
    listed = Hazard.parse({"intensity": [50.0, 10.0], "rate": [1e-3, 1e-2], "units": "cm/s"}).points()
    assert (listed.intensity, listed.units) == (pytest.approx((0.1, 0.5)), "m s-1")
    listed = Hazard.parse({"intensity": [1.0, 2.0], "probability": [0.4, 0.1], "investigation_time": 50.0}).points()
    assert (listed.exceedance, listed.investigation_time) == ((0.4, 0.1), 50.0)


def test_the_order_of_the_points_does_not_matter(tmp_path):
    rising = points(tmp_path, POISSON + "0.1,0.6\n0.4,0.1\n0.8,0.02\n")
    assert points(tmp_path, POISSON + "0.8,0.02\n0.4,0.1\n0.1,0.6\n") == rising


@pytest.mark.parametrize(
    "numbers",
    ["0,05;0,02\n0,5;0,001\n", "0,05\t0,02\n0,5\t0,001\n", "0.05;0.02\n0.5;0.001\n", "0.05, 0.02\n0.5, 0.001\n"],
)
def test_commas_are_decimal_where_semicolons_or_tabs_separate(tmp_path, numbers):
    found = points(tmp_path, "PGA [m/s²]; annual rate\n" + numbers)
    assert (found.intensity, found.exceedance) == ((0.05, 0.5), (0.02, 0.001))


@pytest.mark.parametrize("remark", [OLD, NEW])
def test_a_hazard_curve_of_openquake_is_that_of_a_site(tmp_path, remark):
    for site in (1, (23.7, 38.01), [23.66, 38.0]):
        found = points(tmp_path, remark + SITES, site=site, component="RotD50")
        assert found.intensity == pytest.approx((0.980665, 3.92266, 5.88399))
        assert found.exceedance == (0.3, 0.02, 0.001)
        assert (found.investigation_time, found.units, found.component) == (50.0, "m s-2", "RotD50")
    assert found.measure == (
        "peak ground acceleration" if remark is OLD else "spectral acceleration at 0.1 s, 5 % damping"
    )


def test_a_table_of_openquake_with_one_site_needs_no_choice_and_its_velocities_are_in_cm_per_second(tmp_path):
    table = "# investigation_time=1.0, imt='PGV'\ncustom_site_id,lon,lat,depth,poe-1.0,poe-10.0\nrock,1,2,0,0.5,0.1\n"
    found = points(tmp_path, table)
    assert (found.intensity, found.units, found.investigation_time) == ((0.01, 0.1), "m s-1", 1.0)


@pytest.mark.parametrize(
    ("content", "given", "message"),
    [
        (SITES, {"site": 0}, "imt is not named above the header"),
        (OLD + SITES, {}, "site: missing, and the table holds 2 sites. Give a number from 0 to 1 or .* 22.35, 37.95"),
        (OLD + SITES.splitlines()[0] + "\n", {"site": 0}, "the table holds no site"),
        (OLD + SITES, {"site": 2}, r"site: no such number \(got 2\). Give one from 0 to 1"),
        (OLD + SITES, {"site": (10.0, 45.0)}, "site: none within 0.05° .* The nearest is at 22.35, 37.95"),
        (OLD + SITES + "1,2\n", {"site": 0}, "line 5: 6 values are needed"),
        (OLD.replace("PGA", "AvgSA") + SITES, {"site": 0}, "measure must be .* got 'AvgSA'"),
        (OLD.replace("investigation", "other") + SITES, {"site": 0}, "investigation_time: needed for probabilities"),
        ("PGA [g], rate\n" + NUMBERS, {"site": 0}, "site: the file holds one curve"),
        ("PGA [g], PoE\n" + NUMBERS, {}, "investigation_time: needed for probabilities"),
        ("PGA [g], rate\n" + NUMBERS, {"investigation_time": 50.0}, "investigation_time: not used with annual rates"),
        (
            POISSON + NUMBERS,
            {"investigation_time": 10.0},
            "investigation_time: the file states 50.0, the description 10.0",
        ),
        ("PGA [g], rate\n" + NUMBERS, {"units": "m/s²"}, "units: the file states 'g', the description 'm/s²'"),
        ("PGA [g], rate\n" + NUMBERS, {"measure": "PGV"}, "measure: the file states 'peak ground acceleration'"),
        (
            "PGA RotD50 [g], rate\n" + NUMBERS,
            {"component": "vector"},
            "component: the file states 'RotD50', .* 'RotD100'",
        ),
        ("PGA [g], rate\n" + NUMBERS, {"units": "volt"}, 'units must be "g"'),
        ("intensity, rate\n" + NUMBERS, {"measure": "magnitude"}, "measure must be 'peak ground acceleration'"),
        ("PGA GMRotI50 [g], rate\n" + NUMBERS, {}, r"component: unknown definition .* \(got 'GMRotI50'\)"),
        ("Sa(T1) [g], rate\n" + NUMBERS, {}, r"measure must be .* got 'Sa\(T1\)'"),
        (NUMBERS, {"units": "g"}, "the columns are not named, so rates cannot be told apart from probabilities"),
        ("PGA [furlong], rate\n" + NUMBERS, {}, r"the unit of the intensity must be g, .* got \[furlong\]"),
        (
            "PGA [g], return period [a]\n" + NUMBERS,
            {},
            r'the kind of the second column is unclear \(got "return period \[a\]"\)',
        ),
        ("PGA [g], annual exceedance\n" + NUMBERS, {}, "the kind of the second column is unclear"),
        ("PGA [g], rate in 50 years\n" + NUMBERS, {}, "the kind of the second column is unclear"),
        (
            "PGA [g], rate\n0.1,0.02\n0.8,0.03\n",
            {},
            "line 3: annual rate must not increase .* 0.03 at 0.8 g after 0.02 at 0.1 g",
        ),
        ("PGA [g], rate\n0.8,0.02\n\n0.8,0.01\n", {}, "line 4: intensity 0.8 g occurs twice"),
        ("PGA [g], rate\n0,0.02\n0.8,0.01\n", {}, r"line 2: intensity must be positive and finite \(got 0 g\)"),
        ("PGA [g], rate\n0.1,0.02\n0.8,0\n", {}, r"line 3: annual rate must be positive and finite \(got 0\)"),
        (POISSON + "0.1,63\n0.8,2\n", {}, r"line 2: probability must be between 0 and 1 \(got 63\). .*\[%\]"),
        (
            "PGA [g], rate\n0,05 0,02\n",
            {},
            "line 2: two numbers are needed, .* commas are decimal, separate the columns",
        ),
        ("PGA [g]; rate\n1,000; 0.02\n", {}, "line 2: two numbers are needed"),
    ],
)
def test_what_is_unclear_or_contradicts_itself_is_refused(tmp_path, content, given, message):
    with pytest.raises((FileError, ParameterError), match=message):
        points(tmp_path, content, **given)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "give either intensity and rate"),
        ({"intensity": [1.0, 2.0]}, "intensity and its rates must have equal numbers of values, got 2 and 0"),
        ({"rate": [1.0, 2.0], "file": "site.csv"}, "give either intensity and rate"),
        ({"intensity": [1.0], "rate": [0.1], "probability": [0.1]}, "rate and probability: only one is allowed"),
        (
            {"intensity": [1.0, 2.0], "rate": [0.1]},
            "intensity and its rates must have equal numbers of values, got 2 and 1",
        ),
        ({"intensity": [1.0, 2.0], "rate": [0.1, 0.2]}, "point 2: annual rate must not increase"),
        ({"intensity": [1.0, 2.0], "rate": [0.2, 0.1], "site": 0}, "site: applies to files only"),
    ],
)
def test_listed_points_that_are_no_curve_are_refused(given, message):
    with pytest.raises(ParameterError, match=message):
        Hazard.parse(given).points()


def test_the_names_of_the_columns_win_over_remarks_and_the_last_line_over_titles(tmp_path):
    for above in (
        "# PGA, rates from the model\n",
        "! SA(1 s) [g], annual rate\n",
        "Hazard of the site, rates of Poisson\n",
    ):
        found = points(tmp_path, above + POISSON + "0.1,0.5\n0.5,0.1\n")
        assert (found.exceedance, found.investigation_time) == ((0.5, 0.1), 50.0), above
        assert found.measure == "peak ground acceleration"
    remarks = "# SA(1 s) [g], annual rate\n# PGA [g], annual rate\n# by Roe, 2020\n"
    assert points(tmp_path, remarks + NUMBERS).measure == "peak ground acceleration"


@pytest.mark.parametrize(
    "second", ["rate in fifty years", "rate per decade", "probability in fifty years", "monthly rate"]
)
def test_exceedances_of_a_time_that_is_not_read_are_refused(tmp_path, second):
    with pytest.raises(FileError, match="the kind of the second column is unclear"):
        points(tmp_path, f"PGA [g], {second}\n{NUMBERS}", investigation_time=10.0)


@pytest.mark.parametrize("second", ["rate (per year)", "rate 1/yr", "events/year, as rate", "rate in one year"])
def test_spellings_of_a_year_are_annual_rates(tmp_path, second):
    assert points(tmp_path, f"PGA [g]; {second}\n{NUMBERS}").exceedance == (1e-2, 1e-3)


@pytest.mark.parametrize(
    "name",
    ["SA(0.5 s)", "sa(.5)", "PSA 0.5s", "Sa at 0.50 sec", "SA(0.5 s), 5 % damping", "Sa (0.5 s) (5% damped)"],
)
def test_a_spectral_acceleration_is_named_by_its_period_in_seconds(tmp_path, name):
    assert points(tmp_path, f"{name} [g]; rate\n{NUMBERS}").measure == "spectral acceleration at 0.5 s, 5 % damping"


@pytest.mark.parametrize(("name", "damping"), [("SA(0.5 s) 10 % damping", 10), ("SA(0.5 s, 2 %)", 2)])
def test_a_spectral_acceleration_may_state_its_damping(tmp_path, name, damping):
    measure = points(tmp_path, f"{name} [g]; rate\n{NUMBERS}").measure
    assert measure == f"spectral acceleration at 0.5 s, {damping} % damping"


@pytest.mark.parametrize(
    "name",
    ["Sa(2 Hz)", "SA(500 ms)", "SA(0.5-1.5 s)", "SA(0.5 s) vertical"],
)
def test_other_spectral_accelerations_are_refused_and_not_taken_for_one_of_a_period(tmp_path, name):
    with pytest.raises(
        FileError, match=r'a spectral acceleration, got .*\. Name its period in seconds, such as "SA\(0.5 s\)"$'
    ):
        points(tmp_path, f"{name} [g]; rate\n{NUMBERS}")
