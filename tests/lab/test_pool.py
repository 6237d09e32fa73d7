"""The processes that compute for the laboratory."""

import multiprocessing
import os
import sys
import threading
from pathlib import Path

import anyio
import pytest

from stylobate.lab import pool as pool_module
from stylobate.lab.messages import Finished, Lost
from stylobate.lab.pool import Pool
from stylobate.lab.requests import Description

VALUES = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "tilt": [0.02, 0.0], "duration": 1.0}


def performed(limit=1, *, background=False):
    """Return how a run ended in a new pool, and what `/proc` says of each process that was started for it."""
    answers, stats = [], []

    async def perform():
        before = multiprocessing.active_children()
        async with anyio.create_task_group() as group:
            pool = Pool(limit, group, background)
            answers.append(await pool.perform("run", Description(VALUES, VALUES), lambda _: None))
            started = [process for process in multiprocessing.active_children() if process not in before]
            stats.extend(stat(process.pid) for process in started)
            pool.end()
            group.cancel_scope.cancel()

    anyio.run(perform)
    return answers[0], stats


def stat(pid):
    """Return the parent of a process, the processor time that it has used [s], and its niceness."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return int(fields[1]), (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), int(fields[16])


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc; only Linux has the fork server")
def test_a_process_is_forked_after_the_imports_and_one_run_starts_one_process():
    answer, ((server, used, _),) = performed(limit=3)
    assert isinstance(answer, Finished)
    assert server != os.getpid()
    assert used < 0.5 * stat(server)[1]  # the fork server has imported; the process has only run


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_processes_in_the_background_leave_the_processors_to_the_others():
    own = os.getpriority(os.PRIO_PROCESS, 0)
    (_, ((*_, usual),)), (_, ((*_, background),)) = performed(), performed(background=True)
    assert usual == own
    assert background == min(own + 10, 19)


def test_a_task_that_waits_for_a_process_is_lost_when_the_pool_ends():
    answers = []

    async def wait_for_the_end():
        with anyio.fail_after(60.0):
            await end_while_a_task_waits()

    async def end_while_a_task_waits():
        async with anyio.create_task_group() as group:
            pool = Pool(0, group)

            async def perform():
                answers.append(await pool.perform("run", None, lambda _: None))

            group.start_soon(perform)
            await anyio.wait_all_tasks_blocked()
            assert answers == []
            pool.end()

    anyio.run(wait_for_the_end)
    assert answers == [Lost(None)]


@pytest.mark.parametrize("error", [BlockingIOError, RuntimeError])
def test_a_process_that_cannot_be_started_is_reported(monkeypatch, caplog, error):
    def refuse(*, background):
        raise error

    monkeypatch.setattr(pool_module, "_process", refuse)
    assert performed() == (Lost(None), [])
    assert "could not be started" in caplog.text


def test_a_laboratory_that_a_process_starts_as_it_imports_the_users_program_is_refused(monkeypatch):
    monkeypatch.setattr(multiprocessing.current_process(), "_name", "stylobate lab")
    with pytest.raises(RuntimeError, match="__main__"):
        Pool(1, None).warm_up()


def test_a_start_that_hangs_does_not_delay_the_end(monkeypatch):
    end, waited = threading.Event(), []

    def hang(*, background):
        waited.append(end.wait(60.0))
        raise BlockingIOError

    async def begin_and_end():
        async with anyio.create_task_group() as group:
            Pool(1, group).warm_up()
            await anyio.sleep(0.01)
            group.cancel_scope.cancel()

    monkeypatch.setattr(pool_module, "_process", hang)
    anyio.run(begin_and_end)
    assert waited == []
    end.set()


def test_a_pipe_that_breaks_ends_its_process_only(monkeypatch):
    start = pool_module._process

    def broken(*, background):
        process, connection = start(background=background)
        connection.close()
        return process, connection

    answers = []

    async def perform():
        async with anyio.create_task_group() as group:
            pool = Pool(1, group)
            for process in (broken, start):
                monkeypatch.setattr(pool_module, "_process", process)
                answers.append(await pool.perform("run", Description(VALUES, VALUES), lambda _: None))
            pool.end()
            group.cancel_scope.cancel()

    anyio.run(perform)
    assert isinstance(answers[0], Lost)
    assert isinstance(answers[1], Finished)


def test_an_idle_process_that_dies_is_replaced_and_loses_no_task():
    answers = []

    async def perform():
        before = multiprocessing.active_children()
        async with anyio.create_task_group() as group:
            pool = Pool(1, group)
            for _ in range(2):
                answers.append(await pool.perform("run", Description(VALUES, VALUES), lambda _: None))
                (process,) = [one for one in multiprocessing.active_children() if one not in before]
                process.kill()
                await anyio.sleep(0.5)  # its end is heard
            group.cancel_scope.cancel()

    anyio.run(perform)
    assert [type(answer) for answer in answers] == [Finished, Finished]
