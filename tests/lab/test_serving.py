"""`stylobate lab` as a command."""

import os
import re
import signal
import subprocess
import sys

import httpx

from stylobate.lab.serving import listening


def started(*options):
    command = [sys.executable, "-m", "stylobate", "lab", "--no-browser", *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_it_tells_its_address_answers_there_and_ends_on_ctrl_c():
    process = started("--port", "0")
    try:
        line = process.stdout.readline()
        address = re.search(r"http://127\.0\.0\.1:\d+/", line)[0]
        assert httpx.get(f"{address}api/about").status_code == 200
    finally:
        os.kill(process.pid, signal.SIGINT)
        _, told = process.communicate(timeout=30)
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
