"""The description of the laboratory for programs: what it says is so, both ways."""

import copy
import runpy
import sys
import time
from pathlib import Path

import jsonschema_rs
import pytest
import schemathesis
from tests.lab.conformity import DOCUMENT, component, conforms, endpoint, mistakes

import stylobate as sb
from stylobate.config.parts import implied_shape
from stylobate.lab import Limits
from stylobate.lab.app import Api
from stylobate.lab.options import presets

OPERATIONS = [
    (path, method, told)
    for path, methods in DOCUMENT["paths"].items()
    for method, told in methods.items()
    if method != "parameters"
]
EXAMPLES = [
    pytest.param(path, example["value"], id=f"{told['operationId']}-{name}")
    for path, _, told in OPERATIONS
    if "requestBody" in told
    for name, example in told["requestBody"]["content"]["application/json"]["examples"].items()
]
COLUMN = {"shape": "dimensionless", "slenderness": 0.1}


def ended(client, identity):
    """Return all that a job has told when it has ended."""
    events, after = [], 0
    while True:
        job = client.get(f"/api/jobs/{identity}", params={"after": after}).json()
        events, after = events + job["events"], job["next"]
        if job["state"] not in ("waiting", "running"):
            return {**job, "events": events}
        time.sleep(0.05)


@pytest.fixture(scope="module")
def runs(client):
    """The answers to all presets."""
    return [client.post("/api/simulate", json=preset.description).json() for preset in presets()]


def test_the_document_is_openapi(client):
    answer = client.get("/api/schema").json()
    assert answer["openapi"] == "3.1.0"
    schemathesis.openapi.from_dict(answer).validate()
    for name, told in answer["components"]["schemas"].items():
        assert jsonschema_rs.meta.is_valid({"$schema": "https://json-schema.org/draft/2020-12/schema", **told}), name


def test_a_document_that_is_not_openapi_is_noticed():
    wrong = copy.deepcopy(DOCUMENT)
    del wrong["paths"]["/api/about"]["get"]["responses"]["200"]["description"]
    with pytest.raises(jsonschema_rs.ValidationError):
        schemathesis.openapi.from_dict(wrong).validate()


def test_every_component_is_used_and_known():
    text = str(DOCUMENT)
    names = set(DOCUMENT["components"]["schemas"])
    used = {part.split("'")[0] for part in text.split("#/components/schemas/")[1:]}
    assert used == names


def test_the_endpoints_that_are_described_are_those_there_are():
    routes = Api(Limits(), None, None, None).routes()
    there = {
        (route.path.replace(":str", ""), method.lower()) for route in routes for method in route.methods - {"HEAD"}
    }
    assert {(path, method) for path, method, _ in OPERATIONS} == there
    assert endpoint("GET", "/api/nowhere") is None


def test_the_runs_of_all_presets_are_as_described(runs):
    for run in runs:  # the client has compared each with the endpoint's schema; once more, by name
        assert not mistakes("#/components/schemas/Run", run)


@pytest.mark.parametrize("place", [(), ("drawn",), ("drawn", "column"), ("column",)], ids=".".join)
def test_a_name_of_a_run_that_changes_is_noticed(runs, place):
    run = runs[0]
    changed = copy.deepcopy(run)
    inside = changed
    for name in place:
        inside = inside[name]
    assert component("Run").is_valid(changed)
    for name in list(inside):
        value = inside.pop(name)
        inside[f"{name}_"] = value
        assert not component("Run").is_valid(changed), f"{name} may be called {name}_"
        del inside[f"{name}_"]
        inside[name] = value


@pytest.mark.parametrize("table", ["Measures", "Series"])
def test_the_measures_and_histories_that_are_described_are_told_of_some_run(runs, table):
    told = set().union(*(run[table.lower()] for run in runs))
    assert set(DOCUMENT["components"]["schemas"][table]["properties"]) <= told


@pytest.mark.parametrize(("path", "body"), EXAMPLES)
def test_every_example_is_accepted(client, path, body):
    answer = client.post(path, json=body)
    assert answer.is_success, answer.text
    if path != "/api/jobs":
        return
    job = ended(client, answer.json()["id"])
    assert job["state"] == "done", job["problems"]
    assert not mistakes("#/components/schemas/Job", job)
    picture = client.get(f"/api/jobs/{job['id']}/file")
    assert (picture.status_code == 200) is (body["kind"] == "animation") is (job["result"] is None)
    for name in list(job):
        assert not component("Job").is_valid({f"{own}_" if own == name else own: one for own, one in job.items()})


@pytest.mark.parametrize(("path", "body"), EXAMPLES)
def test_every_example_is_one_of_what_can_be_sent(path, body):
    content = DOCUMENT["paths"][path]["post"]["requestBody"]["content"]
    assert not mistakes(content["application/json"]["schema"]["$ref"], body)


def test_a_map_of_a_model_that_slides_is_as_described(client):
    plane = {"x": {"name": "angular_frequency", "from": 1.0, "to": 4.0, "number": 4}}
    values = {
        "column": COLUMN,
        "model": {"kind": "sliding"},
        "motion": {"kind": "circular", "acceleration": 0.1, "angular_frequency": 2.0},
        "duration": 5.0,
        "map": {**plane, "y": {"name": "acceleration", "values": [0.05, 0.2, 0.8]}},
    }
    job = ended(client, client.post("/api/jobs", json={"kind": "map", "description": values}).json()["id"])
    assert component("GridResult").is_valid(job["result"]), job["problems"]


def test_refusals_are_as_described(client):
    for path, method, told in OPERATIONS:
        answer = client.request(method, path.replace("{identity}", "none"), headers={"origin": "http://elsewhere"})
        assert answer.status_code == 403
        if "requestBody" in told:
            assert client.post(path, content=b"{", headers={"content-type": "text/plain"}).status_code == 415
            assert client.post(path, content=b"{", headers={"content-type": "application/json"}).status_code == 400
            assert client.post(path, json=[]).status_code == 422
    assert client.get("/api/jobs/none", params={"after": "all"}).status_code == 422


def test_an_answer_that_is_not_described_is_noticed(client):
    answer = client.post("/api/describe", json={"column": COLUMN, "duration": 1.0})
    answer.json = lambda: {"toml": "", "python": ""}
    with pytest.raises(AssertionError, match="column"):
        conforms(answer)
    answer.status_code = 418
    with pytest.raises(AssertionError, match="418"):
        conforms(answer)


MOTIONS = [
    {"kind": "rest"},
    {"kind": "circular", "acceleration": 0.1, "angular_frequency": 2.0, "sense": -1},
    {"kind": "elliptic", "amplitude": [0.1, 0.05], "phase": 1.0, "angular_frequency": 2.0},
    {"kind": "stroke", "stroke": 0.1, "frequency": 1.0, "direction": 0.5},
    {"kind": "orbit", "diameter": 0.1, "rpm": 30.0, "start_phase": 0.1, "ramp": 1.0},
    {"kind": "sinusoidal", "acceleration": 0.1, "angular_frequency": 2.0, "cycles": 2.5, "start": 1.0},
    {"kind": "type_c", "velocity": 0.1, "angular_frequency": 2.0, "cycles": 2},
    {"kind": "gabor", "velocity": 0.1, "frequency": 1.0, "oscillations": 2.0},
    {"kind": "linear_sweep", "acceleration": 0.1, "frequencies": [0.5, 2.0], "length": 10.0},
    {
        "kind": "record",
        "sample": "el centro 1940",
        "tail": 1.0,
        "processing": [{"method": "filtered", "highpass": 0.1}],
    },
    {"kind": "scaled", "motion": {"kind": "straight", "acceleration": 0.1, "angular_frequency": 1.0}, "factor": 2.0},
]
MODELS = [
    {"kind": "slender_rolling", "damping": 0.1, "spin_damping": 0.1, "couples": "isotropic"},
    {"kind": "wobbling", "damping": 0.1, "rolling_resistance": 0.01, "restitution": 0.9, "passage_tilt": 1e-3},
    {"kind": "sliding", "friction_coefficient": 0.4, "static_friction_coefficient": 0.5, "patch": 0.1},
    {"kind": "planar_rocking", "restitution": 0.9},
]
NEAR = [
    *(preset.description for preset in presets()),
    *({"column": COLUMN, "motion": motion, "duration": 5.0, "samples": 10, "max_steps": 100} for motion in MOTIONS),
    *({"column": COLUMN, "model": model, "duration": 5.0, "rules": {"rest_tilt": 1e-6}} for model in MODELS),
]


def called(body):
    return "-".join(body[part]["kind"] for part in ("model", "motion") if part in body)


def changed(values):
    """Yield copies in which one number is another, or one name is missing."""
    items = values.items() if isinstance(values, dict) else enumerate(values)
    for name, value in items:
        if isinstance(values, dict):
            yield {own: one for own, one in values.items() if own != name}
        others = [-1, 0, 0.5, 3, 1e40, 1e-40] if isinstance(value, (int, float)) else []
        others = changed(value) if isinstance(value, (dict, list)) else others
        for other in others:
            yield {**values, name: other} if isinstance(values, dict) else [*values[:name], other, *values[name + 1 :]]


@pytest.mark.parametrize("body", NEAR, ids=called)
def test_the_schema_excludes_nothing_that_the_laboratory_accepts(client, body):
    assert component("Simulation").is_valid(body)
    excluded = [one for one in changed(body) if not component("Simulation").is_valid(one)]
    assert excluded
    for one in excluded:
        # A model without its kind is a wobbling one, a column without its shape has the shape that its numbers imply:
        # a schema of one of several cannot say so.
        whole = {**one, **({"model": {"kind": "wobbling", **one["model"]}} if "model" in one else {})}
        if "column" in one:
            whole["column"] = {"shape": implied_shape(one["column"]) or "solid", **one["column"]}
        if not component("Simulation").is_valid(whole):
            assert client.post("/api/describe", json=one).status_code == 422, one


def test_the_types_of_the_page_follow_from_the_schema(monkeypatch, capsys):
    script = Path(__file__).parents[2] / "tools" / "page_types.py"
    monkeypatch.setattr(sys, "argv", [str(script), "--check"])
    assert runpy.run_path(str(script))["main"]() == 0, capsys.readouterr().out


def test_every_study_with_classes_is_a_grid_of_the_laboratory():
    public = {name: getattr(sb.studies, name) for name in sb.studies.__all__}
    with_classes = {name for name, one in public.items() if getattr(getattr(one, "study", None), "classes", ())}
    assert with_classes == set(sb.studies.GRIDS)
