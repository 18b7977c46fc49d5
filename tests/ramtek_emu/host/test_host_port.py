from __future__ import annotations

import copy
import pickle
import socket
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ramtek_emu import (
    HostPort,
    PortError,
    Ramtek9300,
    Recorder,
    ReplyError,
    TcpPort,
    WordsError,
    instructions,
)
from ramtek_emu.host.host_port import host_and_port
from ramtek_emu.host.server import Server
from tests.ramtek_emu.recorded_streams import words
from tests.ramtek_emu.serving import serving


def test_a_recording_holds_every_word_low_byte_first() -> None:
    file = BytesIO()
    port: HostPort = Recorder(file)
    port.send(np.array([0x0802, 0x0002], np.uint16))
    port.send(np.array([0x1234], np.uint16))
    assert file.getvalue() == b"\x02\x08\x02\x00\x34\x12"


def test_a_recording_played_again_gives_the_same_words() -> None:
    file, display = BytesIO(), Ramtek9300()
    port = Recorder(file, display)
    port.send(instructions.write_text("again", 30, 40, 9, 3))
    again = Ramtek9300()
    again.send(np.frombuffer(file.getvalue(), "<u2"))
    assert display.words.any()
    assert (again.words == display.words).all()


def test_a_recording_answers_through_the_port_behind_it() -> None:
    port = Recorder(BytesIO(), Ramtek9300())
    port.send(np.array([0x0B03, 0x0040, 0, 0, 1, 0, 4], np.uint16))
    assert port.receive(2).tolist() == [0, 0]
    with pytest.raises(ReplyError) as refusal:
        Recorder(BytesIO()).receive(2)
    assert str(refusal.value) == (
        "a recording must have a display behind it to give words, not none (2 asked); give Recorder a port"
    )


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([70000], "a word of a stream must be 0 to 65535, not 70000 (word 0); mask it to 16 bits"),
        ([1, -1], "a word of a stream must be 0 to 65535, not -1 (word 1); mask it to 16 bits"),
        ([[1]], "a stream of words must be one row, not of shape (1, 1); flatten it first"),
        ([1.5], "a stream of words must be whole numbers, not float64; convert them first, rounding half up"),
        ("text", "a stream of words must be whole numbers, not text; pass a list or an array of them"),
    ],
)
def test_what_is_no_stream_of_words_is_refused_by_name(words: Any, sentence: str) -> None:
    display = Ramtek9300()
    for port in (display, Recorder(BytesIO())):
        with pytest.raises(WordsError) as refusal:
            port.send(words)
        assert str(refusal.value) == sentence


def test_streams_of_either_byte_order_and_any_whole_type_are_taken() -> None:
    for stream in ([0x0802, 2, 5], np.array([0x0802, 2, 5], ">u2"), np.array([0x0802, 2, 5], np.int64)):
        display = Ramtek9300()
        display.send(np.asarray(stream))
        assert display.processor.parameters.foreground == 5
    Ramtek9300().send(np.array([]))


def test_a_port_without_a_display_is_refused_in_one_sentence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        with pytest.raises(PortError) as taken:
            Server(Ramtek9300(), port)
    assert f"a server must have a port to itself, and 127.0.0.1:{port} cannot be had" in str(taken.value)
    with pytest.raises(PortError) as refusal:
        TcpPort(f"tcp://127.0.0.1:{port}")
    assert str(refusal.value) == (
        f"a display must listen at tcp://127.0.0.1:{port}, and it is not reached (connection refused); "
        "start `ramtek serve` there"
    )


@pytest.mark.parametrize(
    "address",
    ["", "127.0.0.1:1", "tcp://", "tcp://a", "tcp://a:0", "tcp://a:70000", "tcp://a:b", "tcp://a b:1"],
)
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(PortError) as refusal:
        host_and_port(address)
    assert str(refusal.value) == (
        f"an address must be tcp://host:port with a port from 1 to 65535, not {address!r}; write it so"
    )


def test_words_that_do_not_come_are_refused_after_a_while() -> None:
    with serving() as server, TcpPort(server.address, timeout=0.2) as port:
        port.send(words("0B03 0040 0 0 0 0 2"))
        with pytest.raises(ReplyError) as refusal:
            port.receive(3)
        assert "within 0.2 seconds, not 3 of which 1 came" in str(refusal.value)
        assert port.receive(1).tolist() == [0]
        with pytest.raises(ReplyError):
            port.receive(-1)
    with pytest.raises(PortError, match="must be open"):
        port.send(words("0700"))


def test_a_connection_cannot_be_copied_or_pickled_and_says_why() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        with TcpPort(address) as port:
            for attempt in (copy.copy, copy.deepcopy, pickle.dumps):
                with pytest.raises(TypeError) as refusal:
                    attempt(port)
                assert str(refusal.value) == (
                    f"a connection must stay in its process, not be copied or pickled ({address}); "
                    "open another TcpPort there"
                )
            assert repr(port) == f"TcpPort({address}, open)"
        assert repr(port) == f"TcpPort({address}, closed)"


def test_a_recorder_tells_its_file_and_its_display(tmp_path: Path) -> None:
    with open(tmp_path / "words", "wb") as file:
        assert repr(Recorder(file)) == f"Recorder({tmp_path / 'words'})"
    assert repr(Recorder(BytesIO(), Ramtek9300())).startswith("Recorder(BytesIO, Ramtek9300(GMR_9300, ")
