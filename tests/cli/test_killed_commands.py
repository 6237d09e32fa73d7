"""Commands that are ended from outside.

Killed at random instants and started again, they leave the files of an undisturbed run. Asked to end, they end at once.
"""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from stylobate.cli.terminal import INTERRUPTED

CIRCLE = "--slenderness 0.1 --damping 0.1 --motion circular"
STUDY = """
title = "One column"
friction_coefficient = 0.6
date = "2026-01-01"
scales = [1.0]
variations = 20
planar = false
contact = false
tail = 5.0

[columns.tank]
shape = "solid"
radius = 0.2
height = 2.0
density = 2700.0

[model]
kind = "slender"

[dissipation]
low = {damping = 0.01}
central = {damping = 0.05}
high = {damping = 0.1}

[records]
source = "quakes/*.txt"
units = "g"
step = 0.02

[margin]
from = 0.5
to = 2.0
number = 20
"""
OBJECTS = "name,radius,radius_spread,height,density,damping,friction_coefficient\n" + "".join(
    f"object {place},{0.04 + 0.005 * place},0.02,0.6,2200,0.05,0.6\n" for place in range(12)
)
COMMANDS = {
    "map": f"map {CIRCLE} --x angular-frequency 2 6 120 --y acceleration 0.02 0.2 100 --periods 20 "
    "--output map.zarr --resume --figure map.png",
    "basin": f"basin {CIRCLE} --angular-frequency 2 --acceleration 0.065 --x tilt-x -0.1 0.1 100 "
    "--y tilt-y -0.1 0.1 100 --periods 20 --output basin.zarr --resume",
    "fragility": "fragility --radius 0.2 --height 2 --density 2700 --model slender --damping 0.05 "
    "--records quakes --units g --step 0.02 --scales 0.5 3 200 --output runs.zarr --resume",
    "assess": "assess study.toml",
    "inventory": "inventory objects.csv --records quakes --units g --step 0.02 --property-samples 200",
    "paper": "paper",
}
KILLS = {"map": 18, "basin": 14, "fragility": 12, "assess": 10, "inventory": 10, "paper": 10}


def write_inputs(folder):
    """Return the folder with nothing in it but what the commands read."""
    shutil.rmtree(folder, ignore_errors=True)
    quakes = folder / "quakes"
    quakes.mkdir(parents=True)
    time_of = 0.02 * np.arange(501)
    for number in range(6):
        along = (0.2 + 0.2 * number) * np.sin(np.pi * time_of * (1 + 0.3 * number)) * np.sin(np.pi * time_of / 10.0)
        for component, share in (("NS", along), ("EW", 0.1 * along[::-1])):
            np.savetxt(quakes / f"quake{number}a_{component}.txt", share)
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    (folder / "objects.csv").write_text(OBJECTS, encoding="utf-8")
    return folder


def start(command, folder):
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    return subprocess.Popen(
        [sys.executable, "-m", "stylobate", *COMMANDS[command].split()], cwd=folder, text=True, **pipes
    )


def files_of(folder):
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in folder.rglob("*")
        if file.is_file() and file.name != ".lock" and file.suffix != ".xlsx"  # a workbook has the time of its writing
    }


def ends(command, folder):
    with start(command, folder) as process:
        _, complaint = process.communicate()
    assert process.returncode == 0, complaint
    return files_of(folder)


def children_of(folder):
    """Return the processes that work in this folder."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cwd").resolve() == folder and (process / "stat").read_text().rpartition(")")[2][1] != "Z":
                found.append(process.name)
        except OSError:
            continue
    return found


@pytest.mark.posix
@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_killed_at_any_time_ends_with_the_same_bytes_when_it_is_started_again(command, tmp_path):
    folder = tmp_path / "work"  # always the same: results name the files of records
    ends(command, write_inputs(folder))  # whatever must be compiled
    since = time.monotonic()
    undisturbed = ends(command, write_inputs(folder))
    duration = time.monotonic() - since
    rng = np.random.default_rng(60)
    write_inputs(folder)
    for _ in range(KILLS[command]):
        process = start(command, folder)
        time.sleep(rng.uniform(0.0, duration))
        if process.poll() is None:
            os.kill(process.pid, signal.SIGKILL)
        killed = process.wait() != 0
        process.stderr.close()
        for _ in range(100):  # workers end with their parent
            if not children_of(folder):
                break
            time.sleep(0.1)
        assert not children_of(folder)
        if not killed or rng.random() < 0.5:  # half of them are killed again before they end
            assert ends(command, folder) == undisturbed
            write_inputs(folder)
    assert ends(command, folder) == undisturbed


@pytest.mark.posix
@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_asked_to_end_ends_with_its_workers_within_two_seconds(command, tmp_path, slowness):
    since = time.monotonic()
    ends(command, write_inputs(tmp_path))
    duration = time.monotonic() - since
    for share in (0.1, 0.25, 0.4):  # the first run had to compile
        write_inputs(tmp_path)
        process = start(command, tmp_path)
        time.sleep(share * duration)
        workers = children_of(tmp_path)
        limit = 2.0 * slowness()
        since = time.monotonic()
        process.terminate()
        while children_of(tmp_path):
            process.poll()
            assert time.monotonic() - since < limit, workers
            time.sleep(0.01)
        assert process.wait() == INTERRUPTED
        assert process.stderr.read().endswith("stylobate: interrupted\n")
        process.stderr.close()
