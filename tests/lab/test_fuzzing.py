"""Whatever the laboratory's own description allows is sent to it: each answer is as described, and none is a fault."""

import json

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from tests.lab.conftest import client_of, laboratory

from stylobate.errors import LARGEST as MOST
from stylobate.errors import SMALLEST as LEAST
from stylobate.lab import Limits
from stylobate.lab.app import schema
from stylobate.lab.openapi import EXAMPLES
from stylobate.lab.options import presets

SMALL = Limits(body=20_000, cells=200, points=100, duration=5.0, steps=1000, run_time=4.0, waiting=1000)
# A run with numbers of any size may take all the time that runs have; these end, most of them.
LEAST_OF_A_RUN, MOST_OF_A_RUN = 1e-2, 1e2

# Numbers of any size are sent; the page shows the warnings about them.
pytestmark = [pytest.mark.long, pytest.mark.filterwarnings("ignore::stylobate.errors.UnlikelyInputWarning")]

few = settings(
    derandomize=True,
    database=None,
    deadline=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)


@pytest.fixture(scope="module")
def client():
    with laboratory(SMALL) as address, client_of(address) as found:
        assert found.post("/api/simulate", json=BODIES[0]).status_code == 200
        yield found


def within(value, least, most):
    """Return a schema whose numbers have narrower bounds."""
    if isinstance(value, list):
        return [within(one, least, most) for one in value]
    if not isinstance(value, dict):
        return value
    narrower = {LEAST: least, MOST: most, -MOST: -most}
    return {
        name: narrower.get(one, one) if name in ("minimum", "maximum") else within(one, least, most)
        for name, one in value.items()
    }


def operations(least, most, security):
    document = {**within(schema(SMALL), least, most), "security": security}
    return {found.ok().label: found.ok() for found in schemathesis.openapi.from_dict(document).get_all_operations()}


# What computes: a run, or the orbit on which a start lies.
COMPUTING = ("POST /api/simulate", "POST /api/start")
# The client states the token; tokens that are drawn would ask each endpoint without arguments many times.
OF_ANY_SIZE, OF_RUNS = operations(LEAST, MOST, []), operations(LEAST_OF_A_RUN, MOST_OF_A_RUN, [])


def check(answer):
    """Raise where an answer is a fault; the client has compared it with the description."""
    assert "Traceback" not in answer.text
    assert answer.status_code < 500 or "was stopped after" in answer.text, answer.text
    if answer.status_code >= 400:
        assert all(line and "\n" not in line for line in answer.json()["problems"])


def send(client, operation, case):
    path = operation.path.replace("{identity}", "none")
    answer = (
        client.request(operation.method, path, json=case.body)
        if operation.body
        else client.request(operation.method, path, params=case.query)
    )
    check(answer)
    if answer.status_code == 202:
        place = f"/api/jobs/{answer.json()['id']}"
        for one in (client.get(place), client.delete(place), client.get(f"{place}/file")):
            check(one)


def test_tokens_that_the_schema_allows_are_asked_for_and_no_guess_is_right(client):
    secured = operations(LEAST, MOST, schema(SMALL)["security"])

    @settings(few, max_examples=2)
    @given(st.data())
    def sent(data):
        for operation in secured.values():
            case = data.draw(operation.as_strategy())
            shown = case.headers["Authorization"]
            assert shown.startswith("Bearer ")
            path = operation.path.replace("{identity}", "none")
            answer = client.request(operation.method, path, headers={"authorization": shown.rstrip()})
            assert answer.status_code == 401

    sent()


def fuzz(client, operation, examples):
    @settings(few, max_examples=examples)
    @given(operation.as_strategy())
    def sent(case):
        send(client, operation, case)

    sent()


@pytest.mark.parametrize("label", [label for label in OF_ANY_SIZE if label not in COMPUTING])
def test_what_the_schema_allows_is_answered_as_it_says(client, label):
    fuzz(client, OF_ANY_SIZE[label], 20)


@pytest.mark.parametrize("label", COMPUTING)
def test_runs_that_the_schema_allows_are_answered_as_it_says(client, label):
    fuzz(client, OF_RUNS[label], 15)


@pytest.mark.slow
@pytest.mark.parametrize("label", [label for label in OF_ANY_SIZE if label not in COMPUTING])
def test_much_that_the_schema_allows_is_answered_as_it_says(client, label):
    fuzz(client, OF_ANY_SIZE[label], 1000)


@pytest.mark.slow
@pytest.mark.parametrize("label", COMPUTING)
@pytest.mark.parametrize("operations", [OF_ANY_SIZE, OF_RUNS], ids=["any size", "of runs"])
def test_many_runs_that_the_schema_allows_are_answered_as_it_says(client, operations, label):
    fuzz(client, operations[label], 300)


# Near misses: what can be sent, with one value in it another.
BODIES = [{**preset.description, "duration": 2.0} for preset in presets()]
REQUESTS = [
    *(("/api/simulate", body) for body in BODIES),
    *(("/api/describe", body) for body in BODIES),
    *(("/api/response", body) for body in EXAMPLES["Response"].values()),
    *(("/api/start", body) for body in EXAMPLES["SteadyRollingStart"].values()),
    *(("/api/jobs", body) for body in EXAMPLES["JobConfig"].values()),
]
ODD = st.sampled_from(
    [
        None,
        True,
        "",
        "1e3",
        "nan",
        [],
        {},
        [[]],
        0,
        -1,
        1e-300,
        1e300,
        1e15,
        -1e15,
        1e-30,
        2**64,
        1e18,
        1e9,
        3,
        0.5,
        1e6,
    ]
)


def places(values, path=()):
    """Yield the path of each value."""
    items = values.items() if isinstance(values, dict) else enumerate(values) if isinstance(values, list) else ()
    for name, value in items:
        yield (*path, name)
        yield from places(value, (*path, name))


def replaced(values, path, other):
    name, *rest = path
    items = dict(values) if isinstance(values, dict) else list(values)
    items[name] = replaced(items[name], rest, other) if rest else other
    return items


@st.composite
def near_misses(draw):
    path, body = draw(st.sampled_from(REQUESTS))
    for _ in range(draw(st.integers(1, 2))):
        body = replaced(body, draw(st.sampled_from(list(places(body)))), draw(ODD))
    return path, body


def send_near_misses(client, examples):
    @settings(few, max_examples=examples)
    @given(near_misses())
    def sent(request):
        path, body = request
        answer = client.post(path, content=json.dumps(body), headers={"content-type": "application/json"})
        check(answer)
        if answer.status_code == 202:
            check(client.delete(f"/api/jobs/{answer.json()['id']}"))

    sent()


def test_near_misses_are_answered_as_described(client):
    send_near_misses(client, 60)


@pytest.mark.slow
def test_many_near_misses_are_answered_as_described(client):
    send_near_misses(client, 1500)
