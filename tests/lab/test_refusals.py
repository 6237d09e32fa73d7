"""Nothing that is sent to the laboratory breaks it: refusals have a line, and never a traceback."""

import base64
import gzip
import json
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.lab.conftest import client_of, laboratory

from stylobate.lab import Limits, app
from stylobate.lab.limits import RefusedError
from stylobate.lab.requests import Uploads

SMALL = Limits(body=4000, unpacked=3000, cells=100, points=200, duration=50.0, run_time=10.0)


@pytest.fixture(scope="module")
def client():
    with laboratory(SMALL) as address, client_of(address) as found:
        found.post("/api/simulate", json={"column": {"shape": "dimensionless", "slenderness": 0.1}, "duration": 1.0})
        yield found


def problems_of(answer):
    assert answer.headers["content-type"] == "application/json"
    return answer.json()["problems"]


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1:1", "localhost.evil.example", ""])
def test_a_foreign_host_is_refused(client, host):
    answer = client.get("/api/about", headers={"host": host})
    assert answer.status_code in (400, 403)  # an empty Host is none of HTTP


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"])
def test_a_foreign_origin_is_refused(client, origin):
    answer = client.post("/api/simulate", json={}, headers={"origin": origin})
    assert answer.status_code == 403


def test_its_own_origin_is_welcome(client):
    answer = client.get("/api/about", headers={"origin": str(client.base_url).rstrip("/")})
    assert answer.status_code == 200


LINK = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}


def test_a_request_from_another_site_is_refused(client):
    assert client.get("/api/about", headers={"sec-fetch-site": "cross-site"}).status_code == 403
    assert client.get("/api/about", headers=LINK).status_code == 403
    for changed in ({"sec-fetch-dest": "iframe"}, {"sec-fetch-mode": "no-cors"}, {"origin": "http://evil.example"}):
        assert client.get("/", headers={**LINK, **changed}).status_code == 403


def test_a_link_on_another_site_opens_the_page(client):
    assert client.get("/", headers=LINK).status_code in (200, 503)  # 503 where the page is not built


def test_every_answer_allows_nothing_from_elsewhere(client):
    for path in ("/", "/api/about", "/nowhere"):
        headers = client.get(path).headers
        policy = headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy
        assert "http" not in policy
        assert headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    "path",
    [
        "/../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/..%2f..%2fetc%2fpasswd",
        "/page/index.html",
        "/main.js/../../app.py",
        "/app.py",
        "/presets.toml",
        "//etc/passwd",
        "/api/jobs/..%2f..%2fetc%2fpasswd",
        "/api/jobs/none/file",
    ],
)
def test_only_the_files_of_the_page_are_served(client, path):
    request = client.build_request("GET", "/")
    request.url = request.url.copy_with(raw_path=path.encode())
    answer = client.send(request)
    assert answer.status_code == 404
    assert "root:" not in answer.text


@pytest.mark.parametrize(
    ("content", "kind", "status"),
    [
        (b"{", "application/json", 400),
        (b"", "application/json", 400),
        (b"\xff\xfe", "application/json", 400),
        (b"[" * 3000, "application/json", 400),
        (b'{"duration": NaN}', "application/json", 400),
        (b"[]", "application/json", 422),
        (b'"text"', "application/json", 422),
        (b"{}", "text/plain", 415),
        (b"a=1", "application/x-www-form-urlencoded", 415),
        (b'{"a":"' + b"x" * 5000 + b'"}', "application/json", 413),
        (b'{"duration": ' + b"9" * 3000 + b"}", "application/json", 422),
        (b'{"duration": 1e999}', "application/json", 422),
    ],
)
@pytest.mark.parametrize("path", ["/api/simulate", "/api/response", "/api/describe", "/api/jobs", "/api/records"])
def test_malformed_bodies_are_refused(client, path, content, kind, status):
    if path == "/api/records" and status == 413:
        pytest.skip("records may be larger")
    answer = client.post(path, content=content, headers={"content-type": kind})
    assert answer.status_code in {status, 400, 422} if len(content) == 3014 else answer.status_code == status
    assert all("Traceback" not in line for line in problems_of(answer))


@pytest.mark.parametrize("nested", [lambda v: [v], lambda v: {"motion": v}])
def test_values_in_values_are_refused_beyond_a_depth(client, nested):
    value = 1.0
    for _ in range(300):
        value = nested(value)
    for path in ("/api/simulate", "/api/describe", "/api/jobs"):
        body = {"kind": "map", "description": {"tilt": value}} if path == "/api/jobs" else {"tilt": value}
        answer = client.post(path, json=body)
        assert answer.status_code == 422
        assert "depth of at most" in problems_of(answer)[0]


def test_a_body_of_untold_length_is_cut_at_the_limit(client):
    def endless():
        for _ in range(100):
            yield b"x" * 1000

    answer = client.post("/api/simulate", content=endless(), headers={"content-type": "application/json"})
    assert answer.status_code == 413


def test_another_method_is_refused(client):
    for method in ("PUT", "DELETE", "PATCH", "GET"):
        answer = client.request(method, "/api/simulate")
        assert answer.status_code == 405
        assert problems_of(answer)


@pytest.mark.parametrize("name", ["path", "file_sha256"])
@pytest.mark.parametrize("wrap", [lambda m: m, lambda m: {"kind": "sum", "motions": [m]}])
def test_no_file_of_this_machine_is_read(client, name, wrap):
    motion = wrap({"kind": "record", name: "/etc/passwd"})
    values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "motion": motion, "duration": 5.0}
    (problem,) = problems_of(client.post("/api/simulate", json=values))
    assert "Upload the record" in problem


def test_an_upload_that_is_not_here_is_told(client):
    motion = {"kind": "record", "upload": "0" * 64}
    values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "motion": motion, "duration": 5.0}
    (problem,) = problems_of(client.post("/api/simulate", json=values))
    assert "Upload its files again" in problem


@pytest.mark.parametrize(
    "plane",
    [
        {"map": {"x": {"name": "acceleration", "from": 0.1, "to": 0.2, "number": 11}, "y": {"values": [0.0] * 10}}},
        {"basin": {"random": 101, "over": {"tilt_x": [0.0, 0.1]}}},
    ],
)
def test_a_map_beyond_the_limit_is_refused(client, plane):
    values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "duration": 5.0, **plane}
    kind = next(iter(plane))
    (problem, *_) = problems_of(client.post("/api/jobs", json={"kind": kind, "description": values}))
    assert "100 runs" in problem


PULSE = {"kind": "sinusoidal", "acceleration": 1.0, "angular_frequency": 1.0}
QUAKE = {"kind": "record", "sample": "el centro 1940"}
SWEEP = {"kind": "linear_sweep", "acceleration": 1.0, "frequencies": [1.0, 1e9]}


@pytest.mark.parametrize(
    ("motion", "told"),
    [
        ({**PULSE, "cycles": 1e14}, "cycles must be positive and at most 1000"),
        (
            {"kind": "gabor", "velocity": 1.0, "frequency": 1.0, "oscillations": 1e12},
            "oscillations must be positive and at most 100",
        ),
        ({**SWEEP, "length": 1e6}, "motion.length may be at most 50 s"),
        ({**QUAKE, "tail": 1e12}, "motion.tail may be at most 50 s"),
        ({**QUAKE, "tail": "1e12"}, "motion.tail may be at most 50 s"),
        ({**QUAKE, "tail": "1" + "0" * 60}, "motion.tail must be zero or between 1e-30 and 1e+15 in size"),
        ({"kind": "sum", "motions": [{**QUAKE, "tail": 5e4}]}, "motion.motions.0.tail may be at most 50 s"),
        ({**QUAKE, "processing": [{"method": "padded", "before": 1e9}]}, "before may be at most 50 s"),
        ({**QUAKE, "processing": [{"method": "with_tail", "length": 1e9}]}, "length may be at most 50 s"),
        ({**QUAKE, "processing": [{"method": "filtered", "highpass": 0.1, "order": 10**6}]}, "order may be at most 20"),
        ({**QUAKE, "processing": [{"method": "baseline_corrected", "degree": 10**6}]}, "degree may be at most 20"),
        ({**PULSE, "acceleration": 1e40}, "motion.acceleration must be zero or between 1e-30 and 1e+15 in size"),
        ({**PULSE, "angular_frequency": 1e-300}, "motion.angular_frequency must be zero or between"),
    ],
)
def test_what_would_take_long_to_build_is_refused_at_once(client, motion, told):
    values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "motion": motion, "duration": 5.0}
    begun = time.process_time()  # of the server, which is in this process
    answers = [client.post(path, json=values) for path in ("/api/describe", "/api/simulate")]
    answers.append(client.post("/api/jobs", json={"kind": "animation", "description": values}))
    assert time.process_time() - begun < 2.0
    for answer in answers[:2] if "cycles" in told or "oscillations" in told else answers:
        assert answer.status_code == 422
        (problem,) = problems_of(answer)
        assert told in problem


def test_a_lack_of_memory_is_told(client, monkeypatch):
    def refuse(given):
        raise MemoryError

    monkeypatch.setattr(app, "described_case", refuse)
    answer = client.post("/api/describe", json={"column": {"slenderness": 0.1}, "duration": 5.0})
    assert answer.status_code == 422
    assert problems_of(answer) == ["out of memory: make the record, the duration or the grid smaller"]


def upload(client, name, content, **reading):
    files = [{"name": name, "content": base64.b64encode(content).decode()}]
    return client.post("/api/records", json={"files": files, "units": "g", **reading})


@pytest.mark.parametrize("step", [1e300, -1e300, 1e-300])
def test_a_time_step_of_no_record_is_refused(client, step):
    answer = upload(client, "made.txt", b"0.1\n0.2\n", step=step)
    assert answer.status_code == 422
    assert problems_of(answer)[0].startswith("step must be zero or between")


def test_a_packed_record_is_unpacked_to_the_limit_only(client):
    short, long = (gzip.compress(b"0.1\n" * times) for times in (200, 1000))
    assert upload(client, "short.txt.gz", short, step=0.01).status_code == 200
    (problem,) = problems_of(upload(client, "long.txt.gz", long, step=0.01))
    assert problem.startswith("long.txt.gz: more than 3000 bytes when unpacked")


def test_what_a_packed_record_costs_does_not_grow_with_what_it_holds(tmp_path):
    def cost(size):
        body = {"files": [{"name": "a.gz", "content": base64.b64encode(gzip.compress(b"0" * size)).decode()}]}
        begun = time.process_time()
        with pytest.raises(RefusedError):
            Uploads(tmp_path, limit=10**9, unpacked=10**6).add(body)
        return time.process_time() - begun

    assert cost(100_000_000) < 10.0 * cost(2_000_000) + 0.05  # fifty times as much


@pytest.mark.parametrize(("name", "text"), [("duration", "1000 h"), ("tilt", ["2 deg", 0.0])])
def test_numbers_with_a_unit_pass_no_limit(client, name, text):
    answer = client.post("/api/simulate", json={"column": {"slenderness": 0.1}, "duration": 1.0, name: text})
    assert answer.status_code == 422
    assert "the laboratory takes numbers in SI units" in answer.text


@pytest.mark.filterwarnings("ignore::stylobate.errors.UnlikelyInputWarning")
def test_numbers_beyond_those_of_the_machine_are_told(client):
    column = {"shape": "given", "radius": 1e15, "mass_height": 1e15, "mass": 1e15}
    inertia = {"transverse_inertia": 1e-30, "axial_inertia": 1e-30}
    answer = client.post(
        "/api/response",
        json={
            "column": {**column, **inertia},
            "motion": {"kind": "circular", "acceleration": 1e15, "angular_frequency": 1e15},
            "angular_frequency_range": [1e-30, 1e15],
        },
    )
    assert answer.status_code in (200, 422)


values_of_json = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=6,
)
NAMES = st.sampled_from(
    ["column", "model", "motion", "tilt", "tilt_rate", "duration", "rules", "samples", "map", "basin", "spin", "rtol"]
)
PARTS = st.sampled_from(
    [
        {"shape": "dimensionless", "slenderness": 0.1},
        {"shape": "solid", "radius": 0.1, "height": 1e300, "density": 1.0},
        {"kind": "slender", "damping": 0.1},
        {"kind": "sliding"},
        {"kind": "record", "sample": "el centro 1940", "tail": 1e12},
        {"kind": "record", "sample": 3},
        {"kind": "circular", "acceleration": 1e-300, "angular_frequency": 1e300},
        {"kind": "sum", "motions": [{"kind": "rest"}]},
        [0.01, 0.0],
        1e-3,
        "1",
    ]
)
bodies = st.dictionaries(NAMES, values_of_json | PARTS, max_size=6)


paths = st.sampled_from(["/api/simulate", "/api/describe", "/api/response", "/api/records", "map", "basin", "exact"])


def test_no_values_break_it(client):
    @settings(max_examples=150, deadline=None)
    @given(body=bodies, path=paths)
    def sent(body, path):
        if not path.startswith("/"):
            path, body = "/api/jobs", {"kind": path, "description": body}
        content = json.dumps(body).replace("Infinity", "1e999")
        answer = client.post(path, content=content, headers={"content-type": "application/json"})
        assert answer.status_code in (200, 202, 400, 413, 422, 429, 503)
        if answer.status_code >= 400:
            assert problems_of(answer)
            assert all(line and "\n" not in line and "Traceback" not in line for line in problems_of(answer))

    sent()
    assert client.get("/api/about").status_code == 200


@pytest.mark.parametrize("kind", ["os:system", "x.py:Y", "{folder}/x.py:Y", "stylobate.models.slender:Slender"])
@pytest.mark.parametrize("part", ["model", "motion", "a motion in a motion"])
def test_code_that_a_request_names_is_refused_and_never_loaded(client, tmp_path, part, kind):
    loaded = tmp_path / "loaded"
    (tmp_path / "x.py").write_text(f"open({str(loaded)!r}, 'w').close()\nclass Y: ...\n", encoding="utf-8")
    named = {"kind": kind.replace("{folder}", str(tmp_path))}
    inside = {"kind": "rotated", "angle": 0.1, "motion": named}
    change = {"motion": inside} if part == "a motion in a motion" else {part: named}
    body = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "duration": 1.0, **change}
    for path in ("/api/simulate", "/api/describe"):
        answer = client.post(path, json=body)
        assert 400 <= answer.status_code < 500
        assert "kind" in problems_of(answer)[0]
    job = client.post("/api/jobs", json={"kind": "animation", "description": body})
    assert 400 <= job.status_code < 500
    assert not loaded.exists()
