"""Maps that the page computes in its workers, against those of the server."""

import numpy as np
import pytest
from tests.lab.browser import new_page, shown
from tests.lab.static.cases import BLOCK, EL_CENTRO, MAP
from tests.lab.test_jobs import followed

MAPPED = """async (asked) => {
    const job = await window.stylobate.source.startJob("map", asked);
    for (;;) {
        const report = await job.report(0);
        if (report.state !== "running") return report;
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
}"""


def without_workers(page):
    """Wait until a page has no worker; return whether it has none."""
    for _ in range(100):
        if not page.workers:
            return True
        page.wait_for_timeout(50)
    return False


@pytest.mark.parametrize("start", [None, "upper"])
def test_computed_maps_are_those_of_the_server(start, place, browser, client):
    page = new_page(browser)
    page.goto(place)
    shown(page)
    asked = {"description": MAP, **({} if start is None else {"start": start})}
    with page.expect_worker() as worker:
        found = page.evaluate(MAPPED, asked)
    assert worker.value.url.startswith("blob:" if place.startswith("file:") else place)
    assert without_workers(page)  # they end with the map
    page.close()
    known = followed(client, client.post("/api/jobs", json={"kind": "map", **asked}).json()["id"])
    assert found["result"]["codes"] == known["result"]["codes"]
    (ours, _), (theirs, _) = (one["events"][:2] for one in (found, known))
    assert ours["names"] == theirs["names"]
    for axis in "xy":
        values = [one["axes"][axis].pop("values") for one in (ours, theirs)]
        assert values[0] == pytest.approx(values[1])
        assert ours["axes"][axis] == theirs["axes"][axis]
    shares = [{one["name"]: one["share"] for one in job["result"]["classes"] if one["share"]} for job in (found, known)]
    assert shares[0] == pytest.approx(shares[1])
    assert (found["done"], found["total"]) == (72, 72)


@pytest.mark.parametrize(
    ("kind", "motion", "axes"),
    [
        ("slender", {"kind": "one_sine", "angular_frequency": 6.0}, {"acceleration": (2.0, 9.0), "height": (1.5, 4.0)}),
        ("wobbling", EL_CENTRO, {"scale": (0.4, 2.4), "damping": (0.005, 0.05)}),
    ],
)
def test_computed_maps_under_pulses_and_records_are_those_of_the_server(kind, motion, axes, page_of_sources, client):
    (x, across), (y, up) = axes.items()
    plan = {
        "x": {"name": x, "from": across[0], "to": across[1], "number": 6},
        "y": {"name": y, "from": up[0], "to": up[1], "number": 5},
    }
    start = {"acceleration": 2.0} if kind == "slender" else {"scale": 1.0}
    asked = {
        "description": {
            "column": BLOCK,
            "model": {"kind": kind, "damping": 0.02},
            "motion": {**motion, **start},
            "map": plan,
        }
    }
    found = page_of_sources.evaluate(MAPPED, asked)
    known = followed(client, client.post("/api/jobs", json={"kind": "map", **asked}).json()["id"])
    assert (found["state"], found["problems"]) == ("done", [])
    codes, theirs = (np.array(one["result"]["codes"]) for one in (found, known))
    assert len(set(theirs.ravel().tolist())) > 1
    np.testing.assert_array_equal(codes, theirs)


def test_a_cancelled_map_stops_at_once(place, browser):
    page = new_page(browser)
    page.goto(place)
    shown(page)
    axes = {axis: {**one, "number": 40} for axis, one in MAP["map"].items()}
    stopped, later = page.evaluate(
        """async (asked) => {
            const job = await window.stylobate.source.startJob("map", asked);
            while ((await job.report(0)).done === 0) await new Promise((resolve) => setTimeout(resolve, 5));
            await job.cancel();
            const stopped = await job.report(0);
            await new Promise((resolve) => setTimeout(resolve, 300));
            return [stopped, await job.report(0)];
        }""",
        {"description": {**MAP, "periods": 400, "map": axes}},
    )
    assert stopped["state"] == later["state"] == "cancelled"
    assert stopped["done"] == later["done"] < 40 * 40
    assert without_workers(page)
    page.close()


NO_WORKERS = {
    "forbidden": "window.Worker = class { constructor() { throw new Error('forbidden'); } };",
    "not loaded": "window.Worker = class extends window.Worker { constructor() { super('missing.js'); } };",
    "without modules": "Worker.prototype.postMessage = ((post) => function (data) {"
    " post.call(this, 'runs' in data ? data : {}); })(Worker.prototype.postMessage);",
}


def test_several_workers_share_a_map(served, browser):
    maps = []
    for cores in (2, 4):
        page = new_page(browser)
        page.add_init_script(f"Object.defineProperty(navigator, 'hardwareConcurrency', {{ value: {cores} }});")
        workers = []
        page.on("worker", lambda worker, workers=workers: workers.append(worker.url))
        page.goto(served)
        shown(page)
        maps.append(page.evaluate(MAPPED, {"description": MAP})["result"])
        assert len(workers) == cores - 1
        page.close()
    assert maps[0] == maps[1]


@pytest.mark.parametrize("script", NO_WORKERS.values(), ids=NO_WORKERS)
def test_a_page_whose_workers_cannot_start_computes_maps_itself(script, served, browser):
    maps = []
    for one in ("", script):
        page = new_page(browser)
        page.add_init_script(one)
        page.goto(served)
        shown(page)
        maps.append(page.evaluate(MAPPED, {"description": MAP})["result"])
        page.close()
    assert maps[0] == maps[1]
