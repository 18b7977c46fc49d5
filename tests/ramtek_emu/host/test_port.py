from __future__ import annotations

import select
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
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
    UnixPort,
    instructions,
)
from ramtek_emu.host.port import SocketPort, host_and_port, packet_socket
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import READ_EVERYTHING, serving, serving_at
from tests.tables import refused


def test_a_recording_holds_every_word_low_byte_first_and_answers_through_its_display() -> None:
    file = BytesIO()
    port: HostPort = Recorder(file, Ramtek9300())
    port.send([0x0902, 0x0044, 5, 0, 0, 0, 0])  # type: ignore[arg-type]
    port.send(np.array([0x0B03, 0x0040, 0, 0, 1, 0, 4], ">u2"))
    assert file.getvalue()[:6] == b"\x02\x09\x44\x00\x05\x00"
    assert len(file.getvalue()) == 28
    assert port.receive(2).tolist() == [5, 0]


SEND: list[tuple[Any, str]] = [
    ([70000], "a word of a stream must be 0 to 65535, not 70000 (word 0); mask it to 16 bits"),
    ([1, -1], "a word of a stream must be 0 to 65535, not -1 (word 1); mask it to 16 bits"),
    ([[1]], "a stream of words must be one row, not of shape (1, 1); flatten it first"),
]
test_a_display_refuses_wrong_streams = refused(lambda given: Ramtek9300().send(given), SEND)
test_a_recorder_refuses_wrong_streams = refused(lambda given: Recorder(BytesIO()).send(given), SEND)

ADDRESS = "an address must be tcp://host:port with a port from 1 to 65535, not {!r}; write it so"
COUNT = (
    "the words received must be a whole number from 0 on, not {!r}; ask for as many as an instruction replies"
)
ADDRESSES = ["", "127.0.0.1:1", "tcp://a", "tcp://a:0", "tcp://a:65536", "tcp://a:b", "tcp://a b:1", 9]


def receive(count: Any) -> None:
    with paired() as (port, _):
        port.receive(count)


test_wrong_addresses = refused(host_and_port, [(value, ADDRESS.format(value)) for value in ADDRESSES])
test_wrong_numbers_of_words = refused(
    receive, [(value, COUNT.format(value)) for value in (-1, 1.0, None, "1", True)]
)


def test_addresses_up_to_their_limits() -> None:
    assert [host_and_port(f"tcp://a:{port}") for port in (1, 65535)] == [("a", 1), ("a", 65535)]


@contextmanager
def paired(timeout: float = 5.0) -> Iterator[tuple[SocketPort, socket.socket]]:
    """A port, and the display's end of its connection."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        ours = socket.create_connection(listener.getsockname())
        theirs, _ = listener.accept()
    with ours, theirs:
        port = SocketPort("here", ours, timeout)
        port.at_once = 1 << 16
        yield port, theirs


def test_words_are_sent_in_pieces_low_byte_first() -> None:
    with paired() as (port, display):
        port.at_once = 4
        port.send(np.array([0x0102, 0x0304, 0x0506], np.uint16))
        assert display.recv(6, socket.MSG_WAITALL) == b"\x02\x01\x04\x03\x06\x05"
        display.send(b"\x08\x07\x0a")
        assert port.receive(1).tolist() == [0x0708]
        display.send(b"\x09")
        assert port.receive(1).tolist() == [0x090A]


def test_a_display_that_reads_nothing_or_is_lost_is_a_port_error() -> None:
    with paired(0.1) as (port, display):
        with pytest.raises(PortError, match=r"a display must take words within 0\.1 seconds"):
            port.send(np.zeros(10_000_000, np.uint16))
        display.close()
        with pytest.raises(PortError, match="it left"):
            port.send(np.zeros(10_000_000, np.uint16))
        with pytest.raises(PortError, match="it left"):
            port.close()
        port.close()
        with pytest.raises(PortError, match="must be open"):
            port.send(np.zeros(1, np.uint16))


def test_words_that_come_one_by_one_are_refused_after_a_while_too() -> None:
    stop = threading.Event()
    with paired(0.2) as (port, display):

        def trickle() -> None:
            while not stop.wait(0.02):
                display.send(b"x")

        thread = threading.Thread(target=trickle)
        thread.start()
        with pytest.raises(ReplyError, match=r"must come within 0\.2 seconds, not 1000"):
            port.receive(1000)
        stop.set()
        thread.join()


def test_a_system_without_packet_sockets_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(socket, "SOCK_SEQPACKET")
    with pytest.raises(PortError) as refusal:
        packet_socket()
    assert refusal.value.exit_code == 69
    assert str(refusal.value) == (
        "a system must have Unix sockets that keep the boundaries of writes (SOCK_SEQPACKET), and this one "
        "does not; use TCP or a pipe"
    )


def test_a_port_without_a_display_is_refused(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
    path = str(tmp_path / "display")
    for port, where, reason, command in (
        (TcpPort, address, "connection refused", "`ramtek serve` there"),
        (UnixPort, path, "no such file or directory", f"`ramtek serve --unix {path}`"),
    ):
        with pytest.raises(PortError) as refusal:
            port(where)
        assert str(refusal.value) == (
            f"a display must listen at {where}, and it is not reached ({reason}); start {command}"
        )


def test_words_that_do_not_come_are_refused_after_a_while() -> None:
    with serving() as server, TcpPort(server.address) as port:
        port.send(words("0B03 0040 0 0 0 0 2"))
        select.select([port.socket], [], [])
        port.timeout = 0.2
        with pytest.raises(ReplyError) as refusal:
            port.receive(3)
        assert "within 0.2 seconds, not 3 of which 1 came" in str(refusal.value)
        assert port.receive(1).tolist() == [0]
        port.timeout = 60
    with pytest.raises(PortError, match="must be open"):
        port.send(words("0700"))


def test_after_closing_everything_is_drawn_and_replies_that_nobody_took_are_dropped() -> None:
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    with serving() as server:
        for shift in range(3):
            with TcpPort(server.address) as port:
                port.send(READ_EVERYTHING)
                port.send(instructions.write_image((picture + shift) % 1024))
            assert (server.display.words == (picture + shift) % 1024).all()
        port.close()


@contextmanager
def waiting_in_line(timeout: float = 0.2) -> Iterator[tuple[TcpPort, socket.socket]]:
    """A port to a server that accepts no host, and the socket of the server."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout), listener


def test_closing_reports_a_display_that_does_not_execute_all_words() -> None:
    with waiting_in_line() as (port, _):
        port.send(OUTLINE)
        with pytest.raises(PortError) as refusal:
            port.close()
        assert str(refusal.value) == (
            f"a display must execute all words within 0.2 seconds, and {port.address} has not: "
            "it may be serving another host first; give a longer timeout"
        )


@pytest.mark.parametrize("rudely", [False, True])
def test_closing_reports_that_the_host_was_turned_away(rudely: bool) -> None:
    with waiting_in_line(5) as (port, listener):
        connection, _ = listener.accept()
        if rudely:
            # With unread words, closing resets the connection.
            port.send(OUTLINE)
            connection.recv(1)
        connection.close()
        with pytest.raises(PortError, match=r"a display must stay at .*, and it left"):
            port.close()
        port.close()


def test_an_error_of_closing_does_not_hide_an_error_in_the_with_block() -> None:
    with waiting_in_line() as (port, _), pytest.raises(ZeroDivisionError), port:
        raise ZeroDivisionError


def test_replies_that_arrive_during_sending_stay_in_order(tmp_path: Path) -> None:
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    with serving_at(tmp_path / "display"), UnixPort(tmp_path / "display") as port:
        threads = threading.active_count()
        port.send(instructions.write_image(picture))
        for _ in range(4):
            port.send(READ_EVERYTHING)
        for _ in range(4):
            assert (port.receive(480 * 640) == picture.reshape(-1)).all()
        assert threading.active_count() == threads


NAME = bytes.fromhex("030c 4000 0000 0000 4001 0900 0600 5645 4e45 3231 00")
"""A text instruction of 21 bytes, as a program of the time wrote it."""


def test_each_write_is_rounded_down_to_whole_words_alone(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server, UnixPort(tmp_path / "display") as port:
        port.write(NAME)
        port.write(bytes.fromhex("0017"))
        assert port.receive(2).tolist() == [0, 0]
        assert server.display.words.any()
        assert server.display.decoder.pending_words == 0
        # A write of a single byte has no word.
        for byte in b"\x02\x09\x44":
            port.write(bytes((byte,)))
        port.write(b"\0\7" * (1 << 15))
        port.send(words("0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [server.display.words[0, 0]]
        port.write(b"\0\7" * (1 << 15) + NAME)
        port.write(bytes.fromhex("0017"))
        assert port.receive(2).tolist() == [0, 0]


def test_a_recorder_without_a_display_gives_no_words() -> None:
    with pytest.raises(ReplyError) as refusal:
        Recorder(BytesIO()).receive(2)
    assert str(refusal.value) == (
        "a recording must have a display behind it to give words, not none (2 asked); give Recorder a port"
    )
