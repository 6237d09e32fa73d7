"""Blocks cut an array of runs into pieces that meet and do not overlap."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stylobate.studies.sweeps.chunks import Blocks, usual_size

SHAPES = st.lists(st.integers(0, 9), min_size=1, max_size=3).map(tuple)


@given(SHAPES, st.integers(1, 40))
def test_every_run_lies_in_one_block_and_no_block_is_too_large(shape, runs):
    visits = np.zeros(shape, int)
    blocks = Blocks.of(shape, runs)
    for index, block in enumerate(blocks):
        assert block.index == index
        assert visits[block.slices].size == block.size <= runs
        visits[block.slices] += 1
    assert np.all(visits == 1)
    assert len(blocks) == len(list(blocks))


@given(SHAPES, st.integers(1, 40))
def test_every_block_is_one_chunk_of_an_array_cut_at_the_edges(shape, runs):
    blocks = Blocks.of(shape, runs)
    for block in blocks:
        for part, edge, length in zip(block.slices, blocks.edges, shape, strict=True):
            assert part.start % edge == 0
            assert part.stop == min(part.start + edge, length)


@given(st.integers(1, 10**9))
def test_the_usual_blocks_are_neither_many_nor_few(runs):
    size = usual_size(runs)
    assert 1024 <= size <= 16384
    assert math.ceil(runs / size) <= max(64, runs / 16384 + 1)


def test_blocks_take_whole_rows_where_they_can():
    assert Blocks.of((1000, 1000), 4096).edges == (4, 1000)
    assert Blocks.of((10, 5000), 4096).edges == (1, 2500)
    assert Blocks.of((5, 4, 3), 12).edges == (1, 4, 3)


def test_there_is_no_block_beyond_the_last():
    with pytest.raises(IndexError):
        Blocks.of((4,), 2)[2]
