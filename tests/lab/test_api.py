"""What the laboratory answers is what the library computes."""

import base64
import io
import math
import zipfile

import numpy as np
import pytest

import stylobate as sb
from stylobate.column.shapes import SHAPES
from stylobate.config import SimulationConfig, study_config
from stylobate.lab.options import presets
from stylobate.lab.tasks import speed_of_pictures

# Numbers are sent in nine digits.
SENT = 1e-8

FREE = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "tilt": [0.05, 0.01], "duration": 20.0}
CIRCLE = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
}


def described_run(values):
    setup = SimulationConfig.parse(values).build()
    return sb.simulate(setup.model, setup.motion, **setup.options)


def test_a_run_is_that_of_the_library(client):
    values = {**CIRCLE, "tilt": [0.04, 0.0], "tilt_rate": [0.0, 0.07], "duration": 30.0, "samples": 700}
    told, run = client.post("/api/simulate", json=values).json(), described_run(values)
    assert (told["outcome"], told["reason"]) == (run.outcome.name, run.reason)
    assert told["measures"]["peak_tilt"] == run.measures["peak_tilt"]
    assert told["series"]["amplitude"] == pytest.approx(run.data["amplitude"].values.tolist(), rel=SENT, abs=1e-12)
    assert told["series"]["time"][-1] == pytest.approx(30.0)


def test_numbers_that_are_not_finite_are_null(client):
    told = client.post("/api/simulate", json=FREE).json()
    assert math.isnan(described_run(FREE).data["azimuth"].values[-1]) is (told["series"]["azimuth"][-1] is None)
    assert all(value is None or math.isfinite(value) for value in told["thresholds"].values())


@pytest.mark.parametrize("preset", presets(), ids=lambda preset: preset.identity)
def test_every_preset_shows_what_it_says(client, preset):
    told = client.post("/api/simulate", json=preset.description).json()
    assert told["outcome"] == preset.outcome, told.get("problems", told.get("reason"))


def test_the_spin_up_is_certain_and_keeps_its_contact():
    preset = next(one for one in presets() if one.identity == "spin-up")
    run = described_run(preset.description)
    assert (run.uncertain, run.warnings) == (False, ())


def test_another_start_of_the_spin_up_comes_to_rest_in_few_steps():
    preset = next(one for one in presets() if one.identity == "spin-up")
    run = described_run({**preset.description, "tilt": [0.03, 0.0], "duration": 60.0})
    assert run.outcome is sb.Outcome.AT_REST
    assert run.measures["steps"] < 5000


def test_the_python_of_a_run_makes_the_same_run(client, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where it draws the run
    names = {}
    told = client.post("/api/simulate", json={**CIRCLE, "tilt": [0.04, 0.0], "duration": 10.0}).json()
    exec(told["python"], names)  # noqa: S102  it is what users are given
    assert names["run"].outcome.name == told["outcome"]
    assert names["run"].measures["peak_tilt"] == told["measures"]["peak_tilt"]


def test_a_description_is_told_without_a_run(client):
    told = client.post("/api/describe", json={**CIRCLE, "duration": 5.0}).json()
    assert "sb.Harmonic.circular(" in told["python"]
    assert told["column"]["slenderness"] == pytest.approx(0.1)
    assert told["column"]["uplift_acceleration"] == pytest.approx(0.1)


def test_response_curves_are_those_of_theory(client):
    values = {**CIRCLE, "angular_frequency_range": [0.5, 4.0], "points": 50}
    told = client.post("/api/response", json=values).json()
    assert study_config(sb.studies.response_curves).parse(values).points == len(told["angular_frequency"]) == 50
    steady = sb.theory.steady_rolling(np.linspace(0.5, 4.0, 50), 0.065, c=0.1, eta=0.1)
    upper = next(one for one in told["branches"] if one["branch"] == "upper")
    known = np.isfinite(steady.upper.amplitude)
    amplitudes = np.array([np.nan if value is None else value for value in upper["amplitude"]])
    assert np.array_equal(np.isfinite(amplitudes), known)
    assert amplitudes[known] == pytest.approx(steady.upper.amplitude[known], rel=SENT)
    assert np.array_equal(np.array(upper["stable"])[known], steady.upper.stable[known])


@pytest.mark.parametrize("branch", ["upper", "lower"])
def test_a_start_on_a_branch_is_that_of_theory(client, branch):
    told = client.post("/api/start", json={**CIRCLE, "branch": branch}).json()
    setup = SimulationConfig.parse({**CIRCLE, "duration": 1.0}).build()
    start = sb.studies.steady_start(setup.model, setup.motion, branch=branch)
    assert told == {
        "tilt": pytest.approx(start["tilt"]),
        "tilt_rate": pytest.approx(start["tilt_rate"]),
        "spin": 0.0,
        "warnings": [],
    }


def test_a_start_on_a_branch_that_is_not_there_is_refused_in_one_line(client):
    weak = {
        **CIRCLE,
        "model": {"kind": "slender", "damping": 0.5},
        "motion": {**CIRCLE["motion"], "acceleration": 1e-3},
    }
    for case in (weak, {**CIRCLE, "motion": {"kind": "rest"}}, {**CIRCLE, "model": {"kind": "planar_rocking"}}):
        answer = client.post("/api/start", json=case)
        assert answer.status_code == 422
        assert len(answer.json()["problems"]) == 1


def test_a_record_of_one_component_says_so_once(client):
    told = client.post("/api/records", json={"files": [at2("a_000.AT2", "Quake, 1/2/1990, Here, 0")]}).json()
    assert told["warnings"] == [
        "a_000: one horizontal component (a_000.AT2). List the files of the event together, or set one_component if "
        "one is meant"
    ]
    assert shaken(client, told)["warnings"] == []


def test_components_of_two_stations_are_joined_with_a_warning(client):
    files = [at2("a_000.AT2", "Quake, 1/2/1990, Here, 0"), at2("b_090.AT2", "Quake, 1/2/1990, There, 90")]
    told = client.post("/api/records", json={"files": files}).json()
    (warning,) = told["warnings"]
    assert "the headers name different events or stations: a_000.AT2 (quake, 1/2/1990, here)" in warning
    assert shaken(client, told)["warnings"][0] == warning


def test_a_record_that_is_trimmed_or_strong_is_remarked_on_without_folders(client):
    files = [
        at2("a_000.AT2", "Quake, 1/2/1990, Here, 0", samples=60),
        at2("a_090.AT2", "Quake, 1/2/1990, Here, 90", scale=9.0),
    ]
    trimmed, strong = sorted(client.post("/api/records", json={"files": files}).json()["warnings"])
    assert "a_090.AT2 is trimmed" in trimmed
    assert strong.startswith("a_090.AT2: its peak is")


def at2(name, title, samples=100, scale=1.0):
    """Return a file with one component, as it is uploaded."""
    values = scale * np.sin(0.3 * np.arange(samples))
    header = (
        f"PEER NGA STRONG MOTION DATABASE RECORD\n{title}\nACCELERATION IN UNITS OF G\nNPTS= {samples}, DT= .02 SEC"
    )
    content = "\n".join([header, *(f"{value:.6e}" for value in values)]).encode()
    return {"name": name, "content": base64.b64encode(content).decode()}


def shaken(client, told):
    """Return a run under an uploaded record."""
    column = {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2700.0}
    motion = {"kind": "record", "upload": told["upload"], "scale": 0.01}
    return client.post("/api/simulate", json={"column": column, "motion": motion}).json()


def archive(*files):
    """Return a zip archive of files as it is uploaded."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as made:
        for file in files:
            made.writestr(f"PEER/{file['name']}", base64.b64decode(file["content"]))
    return {"name": "PEER.zip", "content": base64.b64encode(content.getvalue()).decode()}


def test_an_archive_is_read_by_its_records_and_named_in_the_program(client):
    one, other, third = (
        at2(f"RSN{number}_Q_A{way}.AT2", f"Quake, 1/2/1990, Here, {way}", scale=scale)
        for number, way, scale in ((1, "000", 0.5), (1, "090", 0.4), (2, "000", 0.3))
    )
    velocities = {**one, "name": "RSN1_Q_A000.VT2"}
    search = {"name": "_SearchResults.csv", "content": base64.b64encode(b"Result,of,a,search\n").decode()}
    body = {"files": [archive(one, other, third, velocities, search)]}
    told = client.post("/api/records", json=body).json()
    assert told["records"] == ["RSN1_Q_A", "RSN2_Q_A"]
    assert told["name"] == "RSN1_Q_A"
    assert told["peaks"] == client.post("/api/records", json={"files": [one, other]}).json()["peaks"]
    assert "'PEER.zip/PEER/RSN1_Q_A000.AT2'" in shaken(client, told)["python"]
    second = client.post("/api/records", json={**body, "record": "RSN2_Q_A"}).json()
    assert second["peaks"]["x"] == pytest.approx(0.3 * 9.80665, rel=1e-3)
    assert second["upload"] != told["upload"]
    assert shaken(client, told)["column"]  # the first is still stored


@pytest.mark.parametrize(
    ("files", "record", "reason"),
    [
        (lambda one: [archive(one)], "RSN9", "record: not in PEER.zip (got 'RSN9'). Use one of a"),
        (lambda one: [archive(one), one], None, "PEER.zip: an archive beside other files. Upload it alone."),
        (lambda one: [archive()], None, "PEER.zip"),
        (
            lambda one: [{**archive(one), "content": archive(one)["content"][:400]}],
            None,
            "PEER.zip: cannot be unpacked",
        ),
    ],
)
def test_an_archive_without_such_a_record_is_refused_in_one_line(client, files, record, reason):
    body = {"files": files(at2("a_000.AT2", "Quake, 1/2/1990, Here, 0")), "record": record}
    answer = client.post("/api/records", json=body)
    assert answer.status_code == 422
    (problem,) = answer.json()["problems"]
    assert problem.startswith(reason)
    assert "/tmp" not in problem  # noqa: S108  no folder of this machine is told


def test_an_uploaded_record_moves_the_base(client):
    time = np.arange(0.0, 3.0, 0.01)
    acceleration = 0.3 * np.sin(8.0 * time)
    content = "\n".join(f"{t:.2f} {a:.6f}" for t, a in zip(time, acceleration, strict=True)).encode()
    files = [{"name": "made.txt", "content": base64.b64encode(content).decode()}]
    told = client.post("/api/records", json={"files": files, "units": "g"}).json()
    assert told["samples"] == len(time)
    assert told["peaks"]["x"] == pytest.approx(9.80665 * np.abs(acceleration).max(), rel=1e-5)
    column = {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2700.0}
    motion = {"kind": "record", "upload": told["upload"], "scale": 1.5}
    run = client.post(
        "/api/simulate", json={"column": column, "motion": motion, "model": {"kind": "wobbling", "damping": 0.05}}
    ).json()
    assert run["measures"]["peak_tilt"] > 0.0
    assert "read_record('made.txt', units='g').scaled(1.5)" in run["python"]


@pytest.mark.parametrize(
    ("name", "content", "units", "reason"),
    [
        ("quake.AT2", b"rubbish\r\n", None, "quake.AT2, line 1: not a number: 'rubbish'"),
        ("quake.txt", b"0.00 0.1\n0.01 nan\n0.02 0.1\n", "g", "line 2"),
        ("quake.txt", b"0.00 0.1\n0.01 0.2\n0.02 0.1\n", None, "unit"),
        ("../quake.txt", b"0 0\n", "g", "without a folder"),
        ("quake.txt", b"", "g", "quake.txt"),
    ],
)
def test_a_broken_record_is_refused_with_one_line(client, name, content, units, reason):
    files = [{"name": name, "content": base64.b64encode(content).decode()}]
    answer = client.post("/api/records", json={"files": files, "units": units})
    assert answer.status_code == 422
    (problem,) = answer.json()["problems"]
    assert reason in problem
    assert "/tmp" not in problem  # noqa: S108  no folder of this machine is told


def test_each_mistake_is_told_on_a_line_as_on_the_command_line(client):
    values = {"column": {"shape": "solid", "radius": -1.0, "height": 3.0, "density": 2700.0}, "duration": -2.0}
    answer = client.post("/api/simulate", json=values)
    assert answer.status_code == 422
    assert sorted(answer.json()["problems"]) == [
        "column: radius must be positive, got -1.0 m",
        "duration must be positive, got -2.0 s",
    ]


@pytest.mark.parametrize("preset", presets(), ids=lambda preset: preset.identity)
def test_pictures_of_every_preset_show_each_swing_of_the_base(preset):
    setup = SimulationConfig.parse(preset.description).build()
    end = float(described_run(preset.description).data["time"][-1])
    pictures_in_a_second = 25.0 / speed_of_pictures(setup, end)
    assert pictures_in_a_second * end <= 1400.5
    if setup.motion.period is not None:
        assert pictures_in_a_second * setup.motion.period >= 4.0


def test_the_page_offers_the_shapes_of_plain_numbers_and_runs_those_of_files(client):
    assert {one["kind"] for one in client.get("/api/about").json()["shapes"]} == set(SHAPES)
    stone = {"shape": "prism", "sides": 4, "side": 0.6, "height": 2.0, "density": 2700.0}
    body = {"column": {"shape": "parts", "parts": [stone, stone]}, "tilt": [0.02, 0.0], "duration": 1.0}
    answer = client.post("/api/simulate", json=body).json()
    made = sb.Column.prism(sides=4, side=0.6, height=4.0, density=2700.0)
    assert answer["column"]["slenderness"] == pytest.approx(made.slenderness, rel=SENT)


def test_it_tells_under_which_motions_a_run_needs_no_duration(client):
    moves = {kind["kind"]: kind["moves"] for kind in client.get("/api/about").json()["motions"]}
    assert {kind for kind, does in moves.items() if not does} == {"rest"}
