from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, Ramtek9300, instructions
from ramtek_emu.arrays import Colors
from ramtek_emu.host.pipe import (
    PipeServer,
    every,
    is_load,
    paced,
    stream_fields,
    stream_pieces,
)
from ramtek_emu.host.server import HostSession
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.monitor.window import Monitor
from ramtek_emu.testing import streams
from tests.ramtek_emu.processes import stream
from tests.ramtek_emu.recorded_streams import OUTLINE, RECORDED, words
from tests.ramtek_emu.serving import until
from tests.ramtek_emu.strategies import SMALL


def pop_of(pieces: list[bytes]) -> Callable[[int], bytes]:
    """A `read` that returns the last of the pieces, and ignores its argument."""
    return lambda _: pieces.pop()


def test_the_last_replies_to_a_host_are_written_before_the_end() -> None:
    stream = np.concatenate((words("0902 0044 7 0 0 9 9"), next(instructions.read_image(0, 0, 10, 10))[0]))
    pieces, replies, is_over = [b"", stream.astype("<u2").tobytes()], [], threading.Event()

    def write(data: bytes) -> None:
        is_over.wait(60)
        replies.append(data)

    with PipeServer(Ramtek9300(), pop_of(pieces), write) as pipe:
        # A signal ends the wait, also before the host was served.
        pipe.finish(lambda: True)
        until(lambda: not pipe.step() and pipe.served == 1)
        pipe.finish(lambda: True)
        assert not replies
        is_over.set()
        pipe.finish(lambda: False)
    assert b"".join(replies) == 100 * b"\7\0"


def test_the_words_of_a_host_whose_replies_are_lost_are_executed() -> None:
    lost, sent = threading.Event(), iter([instructions.read_cursor(0), words("0902 0044 7 0 0 9 9")])

    def read(_: int) -> bytes:
        stream = next(sent, None)
        if stream is not None and stream[0] >> 8 == 9:
            lost.wait(60)
        return b"" if stream is None else stream.astype("<u2").tobytes()

    def write(_: bytes) -> None:
        lost.set()
        raise OSError("the disk is full")

    with PipeServer(Ramtek9300(), read, write) as pipe:
        until(lambda: not pipe.step() and pipe.served == 1)
        assert pipe.display.words[9, 9] == 7


def test_a_pipe_is_shown_in_slices_of_time_and_its_replies_come(on_screen: str) -> None:
    stream = np.concatenate((OUTLINE, next(instructions.read_image(100, 100, 3, 1))[0]))
    replies: list[bytes] = []
    left = [b"", stream.astype("<u2").tobytes()]
    display = Ramtek9300()
    pipe = PipeServer(display, lambda _: left.pop(), replies.append)
    monitor = Monitor(display, on_tick=lambda: pipe.serve_for(0.01))
    monitor.open()

    def has_ended() -> bool:
        monitor.step(5)
        return pipe.served == 1 and bool(replies)

    until(has_ended)
    assert b"".join(replies) == display.words[100, 100:103].astype("<u2").tobytes()
    monitor.close()
    pipe.close()


class Clock:
    """A clock that advances only by sleeping; it lists the sleeps."""

    def __init__(self) -> None:
        self.now = 100.0
        self.slept: list[float] = []

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        if seconds > 0:
            self.slept.append(seconds)
        self.now += seconds


def load(number: int) -> bytes:
    return stream(instructions.load_entries(number, [(number, 0, 0)]))


def in_pieces(data: bytes, cuts: list[int]) -> Callable[[int], bytes]:
    """A `read` that returns a stream in pieces, and ignores its argument."""
    places = [0, *sorted(cut % (len(data) + 1) for cut in cuts), len(data)]
    pieces = [data[start:end] for start, end in pairwise(places) if start < end]
    return lambda _: pieces.pop(0) if pieces else b""


def paced_pieces(read: Callable[[int], bytes], rate: int, clock: Clock) -> list[bytes]:
    """The pieces of a stream that is read at the pace of a host."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ramtek_emu.host.pipe.time", clock)
        return list(iter(partial(paced(read, rate, FAMILY), 1 << 16), b""))


cuts = st.lists(st.integers(0, 10_000), max_size=12)


@given(st.lists(st.binary(max_size=60) | st.integers(0, 9).map(load), max_size=9), cuts)
def test_a_paced_stream_is_the_stream_however_it_is_cut(parts: list[bytes], cuts: list[int]) -> None:
    data = b"".join(parts)
    assert b"".join(paced_pieces(in_pieces(data, cuts), 60, Clock())) == data


@given(cuts)
def test_each_load_but_the_first_waits_for_its_time(cuts: list[int]) -> None:
    drawing = stream(np.concatenate(RECORDED))
    clock = Clock()
    read = in_pieces(drawing + b"".join(map(load, range(5))), cuts)
    pieces = paced_pieces(read, 20, clock)
    loads = _loads(drawing) + 5
    assert len(clock.slept) == loads - 1
    assert np.allclose(clock.slept, 1 / 20)
    # Cut the stream after each load, so that the field is shown.
    assert pieces[-1] == load(4)[-len(pieces[-1]) :]


def _loads(data: bytes) -> int:
    words = np.frombuffer(data, "<u2").astype(np.uint16)
    return sum(instruction.format.name == "LAM" for instruction in Decoder().feed(words))


def test_a_late_load_does_not_hurry_the_next_loads() -> None:
    clock = Clock()
    data = [load(0), load(1), load(2)]

    def slow_read(_: int) -> bytes:
        clock.now += 3.0
        return data.pop(0) if data else b""

    paced_pieces(slow_read, 1, clock)
    assert clock.slept == []


def seen_load(number: int) -> bytes:
    """A load of the entry that an empty display shows everywhere."""
    return stream(instructions.load_entries(0, [(20 * number, 0, 0)]))


def fields_by_instruction(data: bytes) -> tuple[list[Colors], list[str]]:
    """The fields before a stream and after each of its instructions, with the names of the instructions."""
    display = Ramtek9300(SMALL)
    fields, names = [display.field()], []
    for item in items([data], SMALL):
        if item.instruction is None and item.note == "the stream ends within this instruction":
            break
        display.send(item.words)
        fields.append(display.field())
        names.append("" if item.instruction is None else item.instruction.format.name)
    return fields, names


long_streams = st.lists(
    streams(12).map(stream) | st.integers(0, 9).map(seen_load) | st.just(stream(OUTLINE)),
    min_size=1,
    max_size=6,
).map(b"".join)


@given(data=long_streams, cuts=cuts, count=st.integers(0, 4))
def test_a_film_of_a_stream_has_the_fields_after_its_instructions(
    data: bytes, cuts: list[int], count: int
) -> None:
    fields, names = fields_by_instruction(data)
    chosen = [n for n, name in enumerate(names, 1) if (n % count == 0 if count else name == "LAM")]
    expected = [fields[number] for number in chosen]
    if not expected or not np.array_equal(expected[-1], fields[-1]):
        expected.append(fields[-1])
    cut = stream_pieces(in_pieces(data, cuts), SMALL, every(count) if count else is_load)
    assert np.array_equal(list(stream_fields(HostSession(Ramtek9300(SMALL)), cut)), expected)


LOADS = [seen_load(number) for number in range(1, 7)]


def test_a_film_that_is_ended_has_the_field_at_its_end() -> None:
    session = HostSession(Ramtek9300(SMALL))
    cut = stream_pieces(in_pieces(b"".join(LOADS), []), SMALL, every(1))
    fields: list[Colors] = []
    for field in stream_fields(session, cut, lambda: len(fields) == 3):
        fields.append(field)
    assert len(fields) == 4
    assert np.array_equal(fields[-1], session.display.field())
    # The fourth load was executed before the end was noticed.
    assert 2 * session.display.words_received == sum(map(len, LOADS[:4]))
