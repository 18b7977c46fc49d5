from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from autocolor.mapping.pacing import BLOCKS, PICTURE_SECONDS, block_for, blocks_of

SECONDS = st.floats(0, 10)


@given(st.integers(1, 5000), st.integers(1, 5000))
def test_blocks_divide_the_raster(lines: int, elements: int) -> None:
    blocks = blocks_of(lines, elements)
    assert blocks[0] == 1
    assert all(lines % block == 0 and elements % block == 0 for block in blocks)


@given(st.sampled_from(BLOCKS), SECONDS)
def test_a_block_is_expected_to_be_fast_enough_or_is_the_largest(block: int, seconds: float) -> None:
    chosen = block_for(BLOCKS, block, seconds)
    assert seconds * block / chosen <= PICTURE_SECONDS or chosen == BLOCKS[-1]


@given(st.sampled_from(BLOCKS), SECONDS)
def test_a_block_that_is_fast_enough_gets_no_larger(block: int, seconds: float) -> None:
    if seconds <= PICTURE_SECONDS:
        assert block_for(BLOCKS, block, seconds) <= block


def test_the_block_rests_where_the_time_falls_with_the_lines() -> None:
    for whole in (0.001, 0.02, 0.03, 0.04, 0.06, 0.1, 0.13, 0.2, 1.0):
        block = block_for(BLOCKS, 1, whole)
        for _ in range(5):
            after = block_for(BLOCKS, block, whole / block)
            assert after == block
