"""Long work in the background: what comes of it, and that it goes away."""

import multiprocessing
import time
from concurrent.futures import ThreadPoolExecutor

import anyio
import httpx
import numpy as np
import pytest
from tests.lab.conftest import client_of, laboratory

import stylobate as sb
from stylobate.lab import Limits
from stylobate.lab.grids import Refining
from stylobate.lab.jobs import Jobs
from stylobate.lab.messages import Finished

CIRCLE = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
}
PLANE = {
    "x": {"name": "angular_frequency", "from": 0.5, "to": 4.0, "number": 12},
    "y": {"name": "acceleration", "from": 0.05, "to": 0.4, "number": 9},
}
ENDLESS = {**CIRCLE, "duration": 3000.0, "tilt": [0.03, 0.0], "map": {p: {**PLANE[p], "number": 150} for p in "xy"}}


# Slides for ever, and takes seconds for as many steps as there may be.
SLIDING = {"kind": "sliding", "friction_coefficient": 0.02, "damping": 0.1}
FAST = {**CIRCLE["motion"], "angular_frequency": 150.0}
SLOW = {**CIRCLE, "model": SLIDING, "motion": FAST, "duration": 3000.0, "max_steps": 200_000}


def begun(client, kind, description):
    answer = client.post("/api/jobs", json={"kind": kind, "description": description})
    assert answer.status_code == 202, answer.text
    return answer.json()["id"]


def followed(client, identity, until=("done", "failed", "cancelled")):
    """Return the job when it has come to one of these states, with all its events."""
    events, after = [], 0
    while True:
        job = client.get(f"/api/jobs/{identity}", params={"after": after}).json()
        events += job["events"]
        after = job["next"]
        if job["state"] in until:
            return {**job, "events": events}
        time.sleep(0.05)


def test_a_map_fills_in_and_is_that_of_the_library(client):
    job = followed(client, begun(client, "map", {**CIRCLE, "duration": 40.0, "map": PLANE}))
    assert (job["state"], job["done"], job["total"]) == ("done", 108, 108)
    first, *parts = job["events"]
    assert first["axes"]["x"]["units"] == "rad s-1"
    strides = [part["stride"] for part in parts]
    assert strides == sorted(strides, reverse=True)  # from coarse to fine
    cells = {(i, j): code for part in parts for i, j, code in part["cells"]}
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    over = {"angular_frequency": np.linspace(0.5, 4.0, 12), "acceleration": np.linspace(0.05, 0.4, 9)}
    found = sb.studies.overturning_map(model, motion, over=over, duration=40.0)["outcome"].values
    assert cells == {(i, j): int(found[i, j]) for i in range(12) for j in range(9)}


def test_a_refined_sweep_is_the_plain_one():
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    over = {"tilt_x": np.linspace(-0.12, 0.12, 11), "tilt_y": np.linspace(-0.12, 0.12, 7)}
    seen = []
    executor = Refining(lambda stride, places, outcomes: seen.extend(map(tuple, places)))
    refined = sb.studies.overturning_map(model, None, over=over, duration=30.0, executor=executor)
    plain = sb.studies.overturning_map(model, None, over=over, duration=30.0)
    assert refined.equals(plain)
    assert sorted(seen) == [(i, j) for i in range(11) for j in range(7)]  # each once
    assert all(i % 8 == j % 8 == 0 for i, j in seen[:2])


def test_basins_tell_their_attractors(client):
    starts = {name: {"name": f"tilt_{name}", "from": -0.12, "to": 0.12, "number": 9} for name in "xy"}
    job = followed(client, begun(client, "basin", {**CIRCLE, "duration": 300.0, "basin": starts}))
    assert job["state"] == "done", job["problems"]
    names = {one["name"] for one in job["result"]["classes"]}
    assert {"at rest", "overturned"} <= names
    assert len(job["result"]["codes"]) == len(job["result"]["codes"][0]) == 9


@pytest.mark.slow
def test_exact_orbits_are_told_with_their_bifurcations(client):
    job = followed(client, begun(client, "exact", {**CIRCLE, "angular_frequency_range": [1.2, 2.0]}))
    assert job["state"] == "done", job["problems"]
    (family,) = job["result"]["families"]
    last = {name: values[-1] for name, values in family.items() if name != "name"}
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=last["angular_frequency"])
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    run = sb.simulate(model, motion, tilt=last["tilt"], tilt_rate=last["tilt_rate"], duration=10.0)
    for measure in ("minimum_tilt", "peak_tilt"):  # circular rolling: one tilt all the time
        assert run.measures[measure] == pytest.approx(last["mean_tilt"], rel=1e-5)
    (found,) = job["result"]["bifurcations"]
    assert found["angular_frequency"] == pytest.approx(sb.theory.critical_frequency(0.065, c=0.1, eta=0.1), abs=1e-6)


@pytest.mark.slow
def test_a_moving_picture_can_be_fetched(client):
    identity = begun(client, "animation", {**CIRCLE, "tilt": [0.05, 0.0], "duration": 1.0})
    assert followed(client, identity)["state"] == "done"
    answer = client.get(f"/api/jobs/{identity}/file")
    assert answer.headers["content-type"] == "image/gif"
    assert answer.content.startswith(b"GIF89a")


def test_a_mistake_is_told_before_the_job_begins(client):
    answer = client.post("/api/jobs", json={"kind": "map", "description": {**CIRCLE, "duration": 5.0}})
    assert answer.status_code == 422
    assert answer.json()["problems"] == ["map is missing"]


def test_what_the_study_refuses_is_told_by_the_job(client):
    plane = {"x": {"name": "nonsense", "from": 0.0, "to": 1.0, "number": 2}, "y": PLANE["y"]}
    job = followed(client, begun(client, "map", {**CIRCLE, "duration": 5.0, "map": plane}))
    assert job["state"] == "failed"
    assert any("nonsense" in line for line in job["problems"])


def test_a_cancelled_job_ends_and_leaves_room_for_the_next(client):
    for _ in range(3):  # more than run at once
        identity = begun(client, "map", ENDLESS)
        followed(client, identity, until=("running",))
        assert client.delete(f"/api/jobs/{identity}").json()["state"] == "cancelled"
    job = followed(client, begun(client, "map", {**CIRCLE, "duration": 5.0, "map": PLANE}))
    assert job["state"] == "done"


def test_a_single_run_does_not_wait_for_long_work():
    limits = Limits(jobs=2, waiting=1)
    with laboratory(limits) as address, client_of(address) as client:
        values = {**CIRCLE, "tilt": [0.03, 0.0], "duration": 5.0}
        client.post("/api/simulate", json=values)
        jobs = [begun(client, "map", ENDLESS) for _ in range(2)]
        for job in jobs:
            followed(client, job, until=("running",))
        third = begun(client, "map", ENDLESS)
        assert client.get(f"/api/jobs/{third}").json()["note"] == "waits for 2 other jobs"
        too_many = client.post("/api/jobs", json={"kind": "map", "description": ENDLESS})
        assert too_many.status_code == 429
        assert client.post("/api/simulate", json=values).status_code == 200
        assert client.get("/api/about").status_code == 200
        states = [client.get(f"/api/jobs/{job}").json()["state"] for job in jobs]
        assert states == ["running", "running"]  # it did not wait until they were done


def test_a_job_that_nobody_asks_for_is_dropped():
    with laboratory(Limits(abandoned=0.5)) as address, client_of(address) as client:
        identity = begun(client, "map", ENDLESS)
        time.sleep(1.5)
        assert client.get(f"/api/jobs/{identity}").status_code == 404


def test_a_run_beyond_its_time_and_one_without_a_process_get_two_answers():
    limits = Limits(runs=1, run_time=2.0, wait=0.5)
    with laboratory(limits) as address, client_of(address) as client, ThreadPoolExecutor() as pool:
        while client.post("/api/simulate", json={**CIRCLE, "duration": 1.0}).status_code == 503:
            pass  # the first process starts
        slow = pool.submit(client.post, "/api/simulate", json=SLOW)
        time.sleep(0.5)
        busy = client.post("/api/simulate", json={**CIRCLE, "duration": 1.0})
        assert (busy.status_code, "busy for 0.5 s" in busy.json()["problems"][0]) == (503, True)
        assert slow.result().status_code == 504
        assert "stopped after 2 s" in slow.result().json()["problems"][0]
        while (answer := client.post("/api/simulate", json={**CIRCLE, "duration": 1.0})).status_code == 503:
            pass
        assert answer.status_code == 200


def test_runs_that_nobody_waits_for_are_ended():
    limits = Limits(runs=1, run_time=300.0, wait=120.0)
    with laboratory(limits) as address, client_of(address) as client:
        client.post("/api/simulate", json={**CIRCLE, "duration": 1.0})
        with pytest.raises(httpx.ReadTimeout):
            client.post("/api/simulate", json=SLOW, timeout=1.0)
        assert client.post("/api/simulate", json={**CIRCLE, "duration": 1.0}).status_code == 200


def test_a_process_that_dies_is_told_and_replaced():
    limits = Limits(runs=1, run_time=300.0, wait=120.0)
    with (
        laboratory(limits) as address,
        client_of(address, timeout=300.0) as client,
        ThreadPoolExecutor() as pool,
    ):
        assert client.post("/api/simulate", json={**CIRCLE, "duration": 1.0}).status_code == 200
        answer = pool.submit(client.post, "/api/simulate", json=SLOW)
        time.sleep(1.0)
        for process in multiprocessing.active_children():
            process.kill()
        lost = answer.result()
        assert lost.status_code == 502
        (problem,) = lost.json()["problems"]
        assert "ended by signal 9" in problem
        assert "report" not in problem
        assert client.post("/api/simulate", json={**CIRCLE, "duration": 1.0}).status_code == 200


def test_runs_that_are_taken_back_one_after_the_other_keep_nobody_waiting():
    with laboratory(Limits(run_time=300.0)) as address, client_of(address) as client:
        assert client.post("/api/simulate", json={**CIRCLE, "duration": 1.0}).status_code == 200
        for _ in range(6):
            with pytest.raises(httpx.ReadTimeout):
                client.post("/api/simulate", json=SLOW, timeout=0.5)
        assert client.post("/api/simulate", json={**CIRCLE, "duration": 1.0}).status_code == 200


def test_exact_orbits_are_computed_once_for_the_same_question_and_maps_each_time():
    asked = []

    class Processes:
        async def perform(self, kind, values, heard):
            del heard
            asked.append((kind, values["a"]))
            return Finished(f"{kind} {values['a']}")

    async def follow():
        async with anyio.create_task_group() as group:
            jobs = Jobs(Processes(), Limits(), group)
            for kind, value in (("exact", 1), ("exact", 1), ("exact", 2), ("map", 1), ("map", 1)):
                identity = jobs.begin(kind, {"a": value})
                await anyio.wait_all_tasks_blocked()
                assert jobs[identity].result == f"{kind} {value}"

    anyio.run(follow)
    assert asked == [("exact", 1), ("exact", 2), ("map", 1), ("map", 1)]
