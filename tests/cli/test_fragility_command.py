"""`stylobate fragility` runs what is described, fits it, keeps the runs, and fits them anew."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.cli.main import run
from stylobate.earthquakes import (
    Counting,
    HazardCurve,
    LognormalSpread,
    NormalSpread,
    annual_rate,
    dispersion_parts,
    fragility_of_runs,
    incremental_dynamic_analysis,
    property_samples,
)
from stylobate.earthquakes.config.fragility import FragilityConfig
from stylobate.earthquakes.fragility_study import FragilityStudy, describe_parts
from stylobate.errors import ConfigError

COLUMN = ["--radius", "0.4", "--height", "4", "--density", "2700", "--damping", "0.05"]
MODEL = sb.Wobbling(sb.Column.solid(radius=0.4, height=4.0, density=2700.0), damping=0.05)
SCALES = ["--scales", "0.8", "8", "6"]
STUDY = """
records = "quakes"

[column]
shape = "solid"
radius = 0.4
height = 4.0
density = 2700.0

[model]
kind = "wobbling"
damping = 0.05

[fragility]
scales = { values = [0.8, 1.6, 3.2, 6.4] }
intensity = "PGA/(g tan α)"
samples = 3
seed = 2
resamples = 20
counting = "first"
tail = 2.0

[fragility.spreads]
damping = { kind = "lognormal", dispersion = 0.3 }
size = { kind = "normal", deviation = 0.02 }

[fragility.hazard]
file = "site.csv"
"""


@pytest.fixture
def folder(tmp_path):
    """Return a folder with records, the hazard of a site, and a study of them."""
    (tmp_path / "quakes").mkdir()
    for seed in range(4):
        rng = np.random.default_rng(seed)
        samples = np.hanning(80)[:, np.newaxis] * rng.normal(size=(80, 3)) * (1.5, 1.5, 0.3)
        record = sb.Record(samples=samples, step=0.02, name=f"q{seed}")
        sb.records.write_csv(record, tmp_path / "quakes" / f"q{seed}.csv")
    (tmp_path / "site.csv").write_text("intensity RotD50,rate\n# of the site\n0.5,1e-2\n2.0; 1e-3\n8.0 5e-5\n")
    (tmp_path / "bent.csv").write_text("PGA/(g tan α) RotD50, rate\n0.5,1e-3\n2.0,1e-2\n")
    (tmp_path / "velocity.csv").write_text("PGV [1], rate\n0.5,1e-2\n2.0,1e-3\n")
    (tmp_path / "weak.csv").write_text("PGA/(g tan α), rate\n0.001,1e-1\n0.01,1e-2\n")
    (tmp_path / "any.csv").write_text("intensity RotD50 [g], rate\n0.5,1e-2\n2.0,1e-3\n")
    (tmp_path / "vague.csv").write_text("0.5,1e-2\n2.0,1e-3\n")
    (tmp_path / "geometric.csv").write_text("PGA/(g tan α), geometric mean, rate\n0.5,1e-2\n2.0,1e-3\n")
    (tmp_path / "chances.csv").write_text("intensity RotD50, probability in 50 years\n0.5,0.4\n2.0,0.05\n8.0,0.0025\n")
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path


@pytest.mark.slow
def test_options_run_what_python_runs(folder, capsys, saved):
    drawn = [folder / "fits.png", folder / "runs.png"]
    made = ["--output", str(folder / "runs.nc"), "--figure", str(drawn[0]), "--runs-figure", str(drawn[1])]
    quakes = ["--records", str(folder / "quakes")]
    assert run(["fragility", *COLUMN, *quakes, *SCALES, "--resamples", "20", "--json", *made]) == 0
    told = json.loads(capsys.readouterr().out)
    records = {record.name: record for record in sb.read_records(folder / "quakes")}
    runs = incremental_dynamic_analysis(MODEL, records, scales=np.geomspace(0.8, 8.0, 6))
    np.testing.assert_array_equal(saved(folder / "runs.nc")["peak_tilt"], runs["peak_tilt"])
    fits = fragility_of_runs(runs)
    for place, row in enumerate(told["limit_states"]):
        expected = float(fits["median"][place])
        assert row["median"] == (pytest.approx(expected) if np.isfinite(expected) else None)
        assert row["runs_reached"] == int(fits["runs_reached"][place])
    assert told["records"] == sorted(records)
    yardstick = {one["amplitude"]: one["damping"] for one in told["housner_damping"]}
    assert yardstick == {amplitude: MODEL.column.housner_damping(amplitude) for amplitude in (0.25, 0.5, 0.75)}
    assert saved(folder / "runs.nc").attrs["housner_damping"].tolist() == list(yardstick.values())
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in drawn)


def test_a_described_study_is_that_of_its_parts(folder):
    description = FragilityConfig.parse(
        sb.config.read_config(folder / "study.toml")
        | {"fragility": sb.config.read_config(folder / "study.toml")["fragility"] | {"hazard": HAZARD}}
    )
    study = FragilityStudy.of(description.build())
    runs = study.runs()
    spreads = {"damping": LognormalSpread(0.3), "size": NormalSpread(0.02)}
    rng = np.random.default_rng(np.random.SeedSequence(2, spawn_key=(0,)))
    samples = property_samples(MODEL, spreads, count=3, rng=rng)
    for name, values in samples.items():
        np.testing.assert_array_equal(runs[name], values)
    same = incremental_dynamic_analysis(
        MODEL, study.records, scales=[0.8, 1.6, 3.2, 6.4], parameters=samples, tail=2.0, intensity="PGA/(g tan α)"
    )
    np.testing.assert_array_equal(runs["peak_tilt"], same["peak_tilt"])
    fits = study.fits(runs)
    assert fits.attrs["counting"] == Counting.FIRST.value
    curve = HazardCurve(**HAZARD, units="1", quantity="PGA/(g tan α)")
    rates = study.rates(runs, fits)
    np.testing.assert_array_equal(rates["annual_rate"], annual_rate(fits, curve)["annual_rate"])
    assert study.parts(runs).attrs["limit_state"] == "overturning"
    assert study.parts(runs.isel(property_sample=0)) is None
    two = runs.isel(record=slice(2), property_sample=slice(2), scale=slice(2))
    assert study.parts(two) is not None
    for name in ("record", "property_sample", "scale"):
        assert study.parts(two.isel({name: slice(1)})) is None
    for name in ("rotation", "vertical"):
        assert study.parts(two.expand_dims({name: [0.0]})) is None


HAZARD = {"intensity": [0.5, 2.0, 8.0], "rate": [1e-2, 1e-3, 5e-5], "component": "RotD50"}


@pytest.mark.slow
def test_saved_runs_are_fitted_anew_and_repeated(folder, capsys, saved, monkeypatch):
    monkeypatch.chdir(folder)
    assert run(["fragility", "study.toml", "--output", "runs.nc"]) == 0
    table = capsys.readouterr().out
    assert "damping of Housner's impacts: η = 0.12, 0.08, 0.064 at a peak tilt of ¼, ½, ¾ α_c" in table
    for words in ("overturning", "in 50 years", "4 records × 3 property samples × 4 scales", "runs counted first"):
        assert words in table
    assert run(["fragility", "runs.nc", "--counting", "as computed", "--resamples", "0", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["intervals"].startswith("profile likelihood")
    assert told["counting"] == "as computed"
    assert told["limit_states"][-1]["runs"] + told["limit_states"][-1]["runs_not_known"] == 48
    monkeypatch.chdir(folder.parent)
    other = folder / "other.nc"
    assert run(["fragility", str(folder / "runs.nc"), "--damping", "0.1", "--output", str(other)]) == 0
    capsys.readouterr()
    np.testing.assert_allclose(saved(other)["damping"], 2.0 * saved(folder / "runs.nc")["damping"])


@pytest.mark.slow
def test_a_rate_beyond_the_hazard_is_not_told_as_a_fact(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    assert run(["fragility", "study.toml", "--output", "runs.nc"]) == 0
    capsys.readouterr()
    assert run(["fragility", "runs.nc", "--hazard", "weak.csv", "--hazard-component", "RotD50"]) == 0
    told = capsys.readouterr().out
    assert "annual rate of 'overturning': withheld: the hazard curve ends at 0.01, and" in told
    assert "of the rate lies beyond; it is between" in told
    assert run(["fragility", "runs.nc", "--hazard", "weak.csv", "--hazard-component", "RotD50", "--json"]) == 0
    states = {one["name"]: one for one in json.loads(capsys.readouterr().out)["limit_states"]}
    assert states["overturning"]["annual_rate"] is states["overturning"]["probability"] is None
    assert states["overturning"]["rate_high"] < 0.011


@pytest.mark.slow
def test_probabilities_of_exceedance_are_read_as_such_and_the_table_says_so(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    assert run(["fragility", "study.toml", "--output", "runs.nc"]) == 0
    table = capsys.readouterr().out
    assert "over the PGA/(g tan α), RotD50" in table
    assert "hazard: PGA/(g tan α), RotD50\n" in table
    assert run(["fragility", "runs.nc", "--hazard", "chances.csv"]) == 0
    words = "rates from probabilities of exceedance in 50 years, taken as those of a Poisson process"
    assert words in capsys.readouterr().out
    openquake = "# investigation_time=50.0, imt='{}'\nlon,lat,depth,poe-0.1,poe-1.6,poe-25.6\n1,2,0,0.5,0.05,0.001\n"
    (folder / "site.csv").write_text(openquake.format("PGA"))
    pga = ["--intensity", "peak ground acceleration", "--hazard", "site.csv", "--hazard-component", "RotD50", "--json"]
    assert run(["fragility", "study.toml", *pga, "--hazard-site", "1,2"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["intensity"] == {"name": "peak ground acceleration, RotD50", "component": "RotD50", "units": "m s-2"}
    assert 0.0 < found["limit_states"][-1]["annual_rate"] < -np.log1p(-0.5) / 50.0


def test_a_dispersion_of_nothing_reads_as_none_seen():
    scale = np.geomspace(1.0, 10.0, 11)
    capacities = np.array([2.0, 3.0, 5.0])[:, np.newaxis, np.newaxis]
    reached = xr.DataArray(np.repeat(scale > capacities, 4, axis=1), dims=("record", "property_sample", "scale"))
    told = describe_parts(dispersion_parts(scale, reached, rng=np.random.default_rng(0)))
    hidden = np.log(10.0) / 10.0 / np.sqrt(12.0)
    assert f"none seen from properties (0 to {hidden:.3g})" in told
    assert "e-" not in told


def test_a_store_goes_on(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    command = ["fragility", "study.toml", "--output", "runs.zarr", "--json"]
    assert run(command) == 0
    first = json.loads(capsys.readouterr().out)
    assert run([*command, "--resume"]) == 0
    assert json.loads(capsys.readouterr().out) == first
    assert run(["fragility", "runs.zarr"]) == 2
    assert "which cannot be shown. Continue it with its description" in capsys.readouterr().err


def test_what_was_interrupted_is_fitted_as_far_as_it_is_known_and_goes_on(folder, capsys, interrupted, monkeypatch):
    monkeypatch.chdir(folder)
    command = ["fragility", "study.toml", "--property-samples", "40", "--threads", "1", "--json"]
    assert run([*command, "--output", "runs.zarr"]) == 130
    told = capsys.readouterr()
    assert "continues with --resume" in told.err
    partial = json.loads(told.out)
    assert 0 < partial["computed"] < 640
    assert partial["limit_states"][-1]["runs"] <= partial["computed"]
    interrupted.undo()
    monkeypatch.chdir(folder)
    assert run([*command, "--output", "runs.zarr", "--resume"]) == 0
    resumed = json.loads(capsys.readouterr().out)
    assert resumed["computed"] == resumed["runs"] == 640


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--spread", "damping"], "--spread must be a name and a dispersion, such as damping=0.4, got 'damping'"),
        (["--vertical", "maybe"], "--vertical must be on, off or both, got 'maybe'"),
        (["--hazard", "nowhere.csv"], "cannot read"),
        (["--hazard", "study.toml"], "study.toml holds no numbers"),
        (
            ["--intensity", "peak ground acceleration"],
            "fragility.hazard does not state the unit of its intensity; ",
        ),
        (["--hazard-units", "m/s"], "uses an intensity in m/s, but the fragility uses 'PGA/(g tan α)' in 1"),
        (["--hazard", "bent.csv"], "bent.csv, line 3: annual rate must not increase with intensity"),
        (["--hazard", "velocity.csv"], "fragility.hazard uses 'peak ground velocity', but the fragility uses"),
        (["--hazard", "vague.csv"], "vague.csv: the columns are not named, so rates cannot be told apart"),
        (["--hazard", "geometric.csv"], "fragility.hazard: horizontal component 'geometric mean', but the fragility"),
        (
            ["--component", "larger component"],
            "fragility.hazard: horizontal component 'RotD50', but the fragility uses",
        ),
        (
            ["--hazard", "weak.csv"],
            "fragility.hazard: horizontal component not stated, but the fragility uses 'RotD50'",
        ),
        (
            ["--intensity", "peak ground acceleration", "--hazard", "any.csv"],
            "fragility.hazard: intensity measure not stated. Name it in the first line of",
        ),
        (["--hazard-site", "here"], "--hazard-site: no number and no LON,LAT (got 'here')"),
        (["--hazard-component", "mean"], "component: unknown definition of the horizontal component (got 'mean')"),
        (["--spread", "colour=0.1"], "spreads: colour is not known here"),
        (["--property-samples", "0"], "fragility.samples and fragility.spreads need each other"),
        (["--intensity", "magnitude"], "intensity must be 'peak ground acceleration'"),
        (["--records", "nowhere"], "nowhere: cannot be read: No such file"),
        (["--figure", "f.doc"], "--figure must end with"),
    ],
)
def test_mistakes_are_told_in_one_line(folder, capsys, monkeypatch, options, message):
    monkeypatch.chdir(folder)
    assert run(["fragility", "study.toml", *options]) == 2
    told = capsys.readouterr().err.strip()
    assert message in told
    assert "\n" not in told


def test_curves_are_written_for_other_programs_without_those_that_have_no_fit(folder, caplog, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    arguments = ["fragility", "study.toml", "--intensity", "PGA", "--hazard", str(folder / "none.csv")]
    (folder / "none.csv").write_text("PGA RotD50 [g], annual rate [1/a]\n0.05, 0.01\n3, 0.00001\n")
    assert run([*arguments, "--export", "statue.xml", "--object", "statue", "--json"]) == 0
    text = (folder / "statue.xml").read_text(encoding="utf-8")
    assert 'id="statue"' in text
    states = json.loads(capsys.readouterr().out)["limit_states"]
    fitted = [one["name"] for one in states if one["status"] == "fitted"]
    assert text.count("<params") == len(fitted) > 0
    assert run([*arguments, "--export", "statue.xlsx"]) == 0
    assert (folder / "statue.xlsx").stat().st_size > 1000
    assert run(["fragility", "study.toml", "--object", "statue"]) == 2


@pytest.mark.parametrize("name", ["SA(0.5)", "Sa(0.5 s)", "spectral acceleration at 0.5 s, 5 % damping"])
def test_a_spectral_acceleration_is_named_alike_everywhere(folder, capsys, monkeypatch, name):
    monkeypatch.chdir(folder)
    (folder / "sa.csv").write_text("Sa(0.5 s) RotD50 [g], annual rate [1/a]\n0.05, 0.01\n0.5, 0.001\n3, 0.00001\n")
    arguments = ["fragility", "study.toml", "--intensity", name, "--hazard", "sa.csv", "--hazard-units", "g", "--json"]
    assert run(arguments) == 0
    told = json.loads(capsys.readouterr().out)
    assert "spectral acceleration at 0.5 s, 5 % damping" in json.dumps(told, ensure_ascii=False)
    assert told["limit_states"][-1]["annual_rate"] > 0.0


def test_a_description_tells_all_its_mistakes():
    values = {
        "column": {"shape": "dimensionless", "slenderness": 0.1},
        "records": {"source": "quakes"},
        "duration": 3.0,
        "fragility": {"scales": {"from": 1.0, "to": 2.0, "number": 0}, "samples": 3, "years": -1.0, "hazard": {}},
    }
    with pytest.raises(ConfigError) as told:
        FragilityConfig.parse(values).build()
    for words in ("duration is not supported", "number must be", "need each other", "years must be", "or a file"):
        assert words in str(told.value)
    assert "quakes: cannot be read: No such file" in str(told.value)


def test_names_that_are_not_known_are_told_as_they_stand_in_the_file():
    table = {
        "scales": {"values": [1.0, 2.0]},
        "smaples": 3,
        "intensity": {"perod": 1.0},
        "spreads": {"damping": {"kind": "lognormal", "dispersoin": 0.3}, "size": {"kind": "log"}},
    }
    column = {"shape": "dimensionless", "slenderness": 0.1}
    with pytest.raises(ConfigError) as told:
        FragilityConfig.parse({"column": column, "records": "quakes", "fragility": table})
    assert told.value.problems[:-1] == (
        "fragility.intensity.period is missing",
        "fragility.intensity.perod is not known here; did you mean period?",
        "fragility.spreads.damping.dispersion is missing",
        "fragility.spreads.damping.dispersoin is not known here; did you mean dispersion?",
        *(line for line in told.value.problems if "fragility.spreads.size: a spread must have a kind" in line),
    )
    assert told.value.problems[-1] == "fragility.smaples is not known here; did you mean samples?"


SLIDING = ["--model", "sliding", "--friction-coefficient", "0.06", "--limit-state", "slip=5 mm"]


def test_a_column_that_slides_first_has_the_fragility_of_its_slip(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    body = ["--radius", "0.4", "--height", "4", "--density", "2700", "--records", "quakes", *SCALES, *SLIDING]
    spread = ["--spread", "friction_coefficient=0.2", "--property-samples", "3"]
    assert run(["fragility", *body, *spread, "--output", "runs.nc", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [one["name"] for one in told["limit_states"]] == ["slip 5 mm"]
    assert told["runs"] == 4 * 3 * 6
    with xr.open_dataset("runs.nc") as runs:
        assert runs.attrs["kind"] == "slip analysis"
        assert (runs["reached"].sel(limit_state="slip 5 mm") == (runs["peak_slip"] >= 0.005)).all()
    # saved runs are fitted again, and another limit computes them again
    assert run(["fragility", "runs.nc", "--counting", "first"]) == 0
    assert "slip of a column that slides before it rocks" in capsys.readouterr().out
    assert run(["fragility", "runs.nc", "--limit-state", "edge=0.1", "--json"]) == 0
    assert [one["name"] for one in json.loads(capsys.readouterr().out)["limit_states"]] == ["edge 100 mm"]
    assert run(["fragility", *body, "--output", "runs.zarr"]) != 0
    assert "store: slip analyses keep none" in capsys.readouterr().err


def test_a_column_that_rocks_has_the_fragility_of_its_neighbours(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    limit = ["--limit-state", "neighbours=0.1@3"]
    assert run(["fragility", *COLUMN, "--records", "quakes", *SCALES, *limit, "--json"]) == 0
    names = [one["name"] for one in json.loads(capsys.readouterr().out)["limit_states"]]
    assert names[-2:] == ["overturning", "neighbours 100 mm at 3 m"]
    assert run(["fragility", *COLUMN, "--records", "quakes", *SCALES, "--limit-state", "slip=0.1"]) != 0
    assert "limit_states[0]: the model wobbling does not slip (got 'slip 100 mm')" in capsys.readouterr().err
