from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300, ReplyError
from ramtek_emu.instruction_set.instruction import normal
from ramtek_emu.instruction_set.table import Flags
from tests.ramtek_emu.displays import sent
from tests.ramtek_emu.strategies import SMALL


def test_asking_for_more_than_waits_is_refused_by_name() -> None:
    display = sent("0B03 0040 0000 0000 0003 0000 0008")
    with pytest.raises(ReplyError) as refusal:
        display.receive(5)
    assert str(refusal.value) == (
        "the words received must be 0 to 4, which wait, not 5; send an instruction that reads them first"
    )
    assert display.receive(3).tolist() == [0, 0, 0]
    assert display.receive(1).tolist() == [0]


def test_unread_replies_do_not_fill_the_memory() -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array([0x0B01, 0xFFFF] * 400, np.uint16))
    assert display.processor.waiting == 1 << 22


@given(st.lists(st.integers(0, 9), max_size=6), st.lists(st.integers(0, 12), max_size=8))
def test_replies_are_read_in_order_however_many_words_are_taken(sizes: list[int], takes: list[int]) -> None:
    processor = Ramtek9300(SMALL).processor
    whole: list[int] = []
    for size in sizes:
        reply = np.arange(len(whole), len(whole) + size, dtype=np.uint16)
        whole += reply.tolist()
        processor.reply(reply)
    for count in takes:
        count = min(count, processor.waiting)
        taken, whole = whole[:count], whole[count:]
        assert processor.take_reply(count).tolist() == taken
        assert processor.waiting == len(whole)


def test_the_swap_flag_changes_the_two_colors() -> None:
    processor = Ramtek9300(SMALL).processor
    processor.parameters.foreground, processor.parameters.background = 7, 2
    assert processor.colors(normal("ERS", {})) == (7, 2)
    assert processor.colors(normal("ERS", {}, flags=Flags.SWAP)) == (2, 7)


@given(st.lists(st.tuples(*[st.integers(-0x8000, 0x7FFF)] * 2), min_size=1, max_size=5))
def test_relative_points_are_counted_on_in_registers_of_16_bits(points: list[tuple[int, int]]) -> None:
    processor = Ramtek9300(SMALL).processor
    element = line = 0
    expected = []
    for across, down in points:
        element, line = (
            (element + across + 0x8000) % 0x10000 - 0x8000,
            (line + down + 0x8000) % 0x10000 - 0x8000,
        )
        expected.append([element, line])
    assert processor.placed(np.array(points, np.int64), Flags.RELATIVE).tolist() == expected


def test_many_short_replies_take_little_more_memory_than_their_words() -> None:
    display = Ramtek9300()
    asked = np.full(2_000, 0x1700, np.uint16)
    display.send(asked)
    tracemalloc.start()
    display.send(asked)
    grown, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert display.processor.waiting == 8_000
    assert grown < 40_000


def test_replies_belong_to_the_host_that_received_them() -> None:
    display = Ramtek9300()
    display.send(np.full(4, 0x1700, np.uint16))
    words = display.receive(3)
    words[:] = 5
    assert display.receive(5).tolist() == [0] * 5
