"""`stylobate lab` as a command."""

import os
import re
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import httpx
import pytest
from tests.lab.conformity import conforms

from stylobate.cli.main import run
from stylobate.lab import app, serving
from stylobate.lab.entrance import Entrance
from stylobate.lab.serving import listening, own_names


def started(*options):
    program = "import runpy; runpy.run_module('stylobate', run_name='__main__', alter_sys=True)"
    command = [sys.executable, "-c", program, "lab", "--no-browser", *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def told_address(process):
    """Return the address of a laboratory and its token."""
    return re.search(r"(http://\S+/)\?token=(\w+) ", process.stdout.readline()).groups()


def by(token):
    return {"authorization": f"Bearer {token}"}


@pytest.mark.posix
def test_it_tells_its_address_answers_there_and_ends_on_ctrl_c():
    process = started("--port", "0")
    try:
        address, token = told_address(process)
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", address)
        assert int(token, 16).bit_length() > 100  # of 128 random bits
        assert httpx.get(f"{address}api/about", headers=by(token)).status_code == 200
        assert httpx.get(f"{address}api/about").status_code == 401
        assert httpx.get(address, params={"token": token}).status_code == 303
        assert httpx.get(f"{address}api/nowhere?token={token}", headers=by(token)).status_code == 404
    finally:
        os.kill(process.pid, signal.SIGINT)
        printed, told = process.communicate(timeout=30)
    assert "Traceback" not in told
    assert token not in printed + told


CHOSEN = "chosen-for-the-class"


@pytest.mark.parametrize("options", [(), ("--token", "chosen-for-another")])
def test_a_chosen_token_is_passed_on_and_not_printed(monkeypatch, capsys, options):
    passed = {}
    monkeypatch.setattr(serving, "serve", lambda **given: passed.update(given))
    monkeypatch.setenv("STYLOBATE_LAB_TOKEN", CHOSEN)
    assert run(["lab", "--no-browser", *options]) == 0
    assert (passed["token"], passed["browser"]) == (options[1] if options else CHOSEN, False)
    passed["started"](f"http://127.0.0.1:8642/?token={passed['token']}")
    printed = capsys.readouterr().out
    assert "http://127.0.0.1:8642/ and asks for the token that you chose" in printed
    assert passed["token"] not in printed


def test_an_empty_variable_chooses_no_token(monkeypatch):
    passed = {}
    monkeypatch.setattr(serving, "serve", lambda **given: passed.update(given))
    monkeypatch.setenv("STYLOBATE_LAB_TOKEN", "")
    assert run(["lab"]) == 0
    assert (passed["token"], passed["browser"]) == (None, True)


@pytest.mark.parametrize("token", ["", "short", "words of a class"])
def test_a_token_that_is_easily_guessed_or_has_other_characters_is_refused(capsys, token):
    assert run(["lab", "--port", "0", "--no-browser", "--token", token]) == 2
    *_, last = capsys.readouterr().err.strip().splitlines()
    assert last.startswith("stylobate: token: must be 12 to 128 of the characters")
    assert not token or token not in last


def test_the_browser_is_given_an_address_that_is_valid_once(monkeypatch):
    """Other users of the machine see with which address a browser was started."""
    shown, opened, made = [], [], {}

    def create(**given):
        made.update(given)
        return SimpleNamespace(state=SimpleNamespace(entrance=Entrance(given["token"])))

    monkeypatch.setattr(app, "create_app", create)
    monkeypatch.setattr(serving, "server_of", lambda _: SimpleNamespace(run=lambda sockets: made["ready"]()))
    monkeypatch.setattr(serving.webbrowser, "open", opened.append)
    serving.serve(port=0, started=shown.append)
    (printed,), (address,) = shown, opened
    assert printed.endswith(f"/?token={made['token']}")
    assert address.partition("=")[0] == printed.partition("=")[0]
    assert made["token"] not in address


def stat(pid):
    """Return the fields that the system gives of a process, from its state on; of none if the process has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return ["Z", "0"]


def descendants(process):
    """Return the children of a process, their children, and so on."""
    parents = {int(entry.name): int(stat(entry.name)[1]) for entry in Path("/proc").glob("[0-9]*")}
    found = {process.pid}
    while new := {one for one, parent in parents.items() if parent in found} - found:
        found |= new
    return found - {process.pid}


COLUMN = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
    "tilt": [0.03, 0.0],
    "duration": 3000.0,
}
PLANE = {
    "x": {"name": "angular_frequency", "from": 0.5, "to": 4.0, "number": 150},
    "y": {"name": "acceleration", "from": 0.05, "to": 0.4, "number": 150},
}
# Forces that oscillate fast keep a run busy for half a minute.
LONG = {**COLUMN, "motion": {**COLUMN["motion"], "angular_frequency": 150.0}, "max_steps": 200_000}
LONG["model"] = {"kind": "sliding", "friction_coefficient": 0.02, "damping": 0.1}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads the states of processes from /proc")
def test_a_request_to_end_ends_connections_runs_maps_and_their_processes_at_once(slowness):
    process = started("--port", "0")
    with ExitStack() as held, ThreadPoolExecutor() as threads:
        address, token = told_address(process)
        client = held.enter_context(httpx.Client(base_url=address, timeout=120.0, headers=by(token)))
        job = {"kind": "map", "description": {**COLUMN, "map": PLANE}}
        jobs = [client.post("api/jobs", json=job).json()["id"] for _ in range(3)]
        for head in (b"GET / HTTP/1.1\r\n", b"POST /api/simulate HTTP/1.1\r\nContent-Length: 900\r\n\r\n{"):
            place = held.enter_context(socket.create_connection(("127.0.0.1", httpx.URL(address).port), timeout=60.0))
            place.sendall(head)
        runs = [threads.submit(client.post, "api/simulate", json=LONG) for _ in range(4)]  # one waits
        while client.get(f"api/jobs/{jobs[0]}").json()["done"] == 0:
            assert not any(run.done() for run in runs)
            time.sleep(0.05)
        processes = descendants(process)
        assert len(processes) >= 3
        limit = 2.0 * slowness()
        since = time.monotonic()
        process.send_signal(signal.SIGTERM)
        answers = [run.result() for run in runs]
        _, told = process.communicate(timeout=60)
        while any(stat(one)[0] != "Z" for one in processes):
            time.sleep(0.01)
        assert time.monotonic() - since < limit
    for answer in answers:
        conforms(answer)
        assert (answer.status_code, answer.json()) == (503, {"problems": ["the laboratory is ending. Start it again."]})
    assert "Traceback" not in told


@pytest.mark.posix
def test_at_an_address_for_other_machines_the_token_opens_it_under_the_names_of_this_machine():
    process = started("--port", "0", "--host", "0.0.0.0")  # noqa: S104
    try:
        told, token = told_address(process)
        address = httpx.URL(told)
        assert address.host == own_names()[0]
        local = f"http://127.0.0.1:{address.port}/api/about"
        for name, status in ((address.host, 200), (socket.gethostname(), 200), ("evil.example", 403)):
            headers = {"host": f"{name}:{address.port}", **by(token)}
            assert httpx.get(local, headers=headers).status_code == status
        assert httpx.get(local).status_code == 401
    finally:
        os.kill(process.pid, signal.SIGINT)
        _, told = process.communicate(timeout=60)
    assert "other machines can reach" in told
    assert "Traceback" not in told


def test_a_port_that_is_taken_is_told_in_one_line():
    with listening("127.0.0.1", 0) as place:
        process = started("--port", str(place.getsockname()[1]))
        _, told = process.communicate(timeout=60)
    assert process.returncode == 2
    last = told.strip().splitlines()[-1]
    assert "cannot listen on 127.0.0.1" in last
    assert "--port" in last


def test_a_port_that_is_none_is_told():
    process = started("--port", "70000")
    _, told = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "port must lie between 0 and 65535, got 70000" in told
