from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300
from ramtek_emu.host.host_session import HostSession
from tests.ramtek_emu.strategies import SMALL, quick, streams


def test_a_session_never_lets_more_replies_wait_than_the_display_holds() -> None:
    session = HostSession(Ramtek9300())
    asked = np.tile(np.array([0x0B01, 0xFFFE], np.uint16), 2000).astype("<u2").tobytes()
    count = sum(len(reply) for reply in session.feed(asked))
    assert count == 2000 * 0xFFFE
    assert session.words == 4000


@quick
@given(streams(), st.binary(max_size=1), st.lists(st.integers(0, 200), max_size=4))
def test_a_display_gets_the_words_whatever_pieces_their_bytes_come_in(
    stream: list[int], odd_byte: bytes, places: list[int]
) -> None:
    twin, session = Ramtek9300(SMALL), HostSession(Ramtek9300(SMALL))
    twin.send(np.array(stream, np.uint16))
    data = np.array(stream, "<u2").tobytes() + odd_byte
    edges = sorted({0, len(data), *(place % (len(data) + 1) for place in places)})
    pieces = [data[first:end] for first, end in itertools.pairwise(edges)]
    replies = b"".join(reply for piece in pieces for reply in session.feed(piece))
    assert np.frombuffer(replies, "<u2").tolist() == twin.receive(twin.processor.waiting).tolist()
    assert (session.display.words == twin.words).all()
    assert session.held_words == twin.decoder.held_words
    assert session.odd_byte == odd_byte
    assert session.unfinished == bool(odd_byte or twin.decoder.held_words)


@quick
@given(streams(), st.integers(0, 200))
def test_what_is_recorded_ends_with_a_whole_instruction(stream: list[int], cut: int) -> None:
    kept: list[bytes] = []
    session = HostSession(Ramtek9300(SMALL), kept.append)
    data = np.array(stream, "<u2").tobytes()
    for piece in (data[:cut], data[cut:]):
        for _ in session.feed(piece):
            again = Ramtek9300(SMALL)
            again.send(np.frombuffer(b"".join(kept), "<u2").astype(np.uint16))
            assert again.decoder.held_words == 0
    assert b"".join(kept) == data[: len(data) - 2 * session.held_words]


def test_a_host_that_leaves_takes_its_unfinished_words_and_replies_with_it() -> None:
    session = HostSession(Ramtek9300(SMALL))
    feeding = session.feed(np.array([0x0B01, 8, 0x0A01, 0xFFFF, 1], "<u2").tobytes() + b"!")
    next(feeding)
    assert session.unfinished
    assert session.display.processor.waiting == 4
    session.leave()
    assert not session.unfinished
    assert session.display.processor.waiting == 0
