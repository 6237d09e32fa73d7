"""The parts in which an ensemble is computed."""

import pytest

from stylobate.engine.ensemble import parts_of

COUNTS = [1, 100, 128, 300, 512, 5000, 100_000]


@pytest.mark.parametrize("threads", [1, 2, 16])
@pytest.mark.parametrize("count", COUNTS)
def test_parts_hold_every_run_once(count, threads):
    runs = [run for part in parts_of(count, threads) for run in range(part.start, part.stop)]
    assert runs == list(range(count))


@pytest.mark.parametrize("threads", [1, 2, 16])
@pytest.mark.parametrize("count", COUNTS)
def test_every_thread_has_a_part_where_there_are_128_runs_for_each(count, threads):
    assert len(parts_of(count, threads)) >= min(threads, count // 128)


def test_as_many_runs_as_512_on_one_thread_are_one_part():
    assert parts_of(512, 1) == [slice(0, 512)]
    assert parts_of(512, 2) == [slice(0, 256), slice(256, 512)]
