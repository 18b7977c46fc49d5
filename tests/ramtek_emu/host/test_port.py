from __future__ import annotations

import copy
import math
import pickle
import select
import socket
import threading
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ramtek_emu import (
    HostPort,
    PortError,
    Ramtek9300,
    RamtekError,
    Recorder,
    ReplyError,
    TcpPort,
    UnixPort,
    WordsError,
    instructions,
)
from ramtek_emu.host.port import Sign, SocketPort, Wire, checked_timeout, host_and_port, packet_socket
from ramtek_emu.host.server import Server, TcpServer
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import READ_EVERYTHING, serving, serving_at, until


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
def test_wrong_streams_are_refused(words: Any, sentence: str) -> None:
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


def test_the_repr_of_a_recorder_names_its_file_and_its_display(tmp_path: Path) -> None:
    with open(tmp_path / "words", "wb") as file:
        assert repr(Recorder(file)) == f"Recorder({tmp_path / 'words'})"
    assert repr(Recorder(BytesIO(), Ramtek9300())).startswith("Recorder(BytesIO, Ramtek9300(GMR_9300, ")


Pair = Callable[[], tuple[socket.socket, socket.socket]]


def tcp_pair() -> tuple[socket.socket, socket.socket]:
    """The two ends of a TCP connection."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        host = socket.create_connection(listener.getsockname())
        display, _ = listener.accept()
    return host, display


def unix_pair() -> tuple[socket.socket, socket.socket]:
    """The two ends of a Unix socket of packets."""
    return socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)


def signs_and_bytes(wire: Wire) -> list[bytes | Sign]:
    """Everything that arrives on a wire until its end; parts of a stream are joined."""
    given: list[bytes | Sign] = []
    while Sign.END not in given:
        data = wire.read(100)
        if data is Sign.NOTHING:
            select.select([wire.socket], [], [])
        elif isinstance(data, bytes) and given and isinstance(given[-1], bytes) and not wire.keeps_writes:
            given[-1] += data
        else:
            given.append(data)
    return given


@pytest.mark.parametrize("pair", [tcp_pair, unix_pair])
def test_a_mark_stands_at_its_place_between_the_bytes(pair: Pair) -> None:
    ends = pair()
    host, display = map(Wire, ends)
    with ends[0], ends[1]:
        for word in (b"be", b"fore"):
            host.send(word)
        assert host.send_mark()
        host.send(b"after")
        host.socket.shutdown(socket.SHUT_WR)
        given = signs_and_bytes(display)
    before = [b"be", b"fore"] if host.keeps_writes else [b"before"]
    assert given == [*before, Sign.MARK, b"after", Sign.END]


@pytest.mark.parametrize("pair", [tcp_pair, unix_pair])
def test_a_wire_never_waits(pair: Pair) -> None:
    ends = pair()
    host, display = map(Wire, ends)
    with ends[0], ends[1]:
        assert display.read(100) is Sign.NOTHING
        while host.send(bytes(1 << 14)) or host.send_mark():
            pass
        ends[1].close()
        with pytest.raises(ConnectionError):
            send_for_ever(host)


def send_for_ever(wire: Wire) -> None:
    while True:
        select.select([], [wire.socket], [])
        wire.send(b"lost")


def paired(timeout: float = 5.0) -> tuple[SocketPort, socket.socket]:
    """A port, and the display's end of its connection."""
    ours, theirs = tcp_pair()
    port = SocketPort("here", ours, timeout)
    port.at_once = 1 << 16
    return port, theirs


def test_words_are_sent_in_pieces_low_byte_first() -> None:
    port, display = paired()
    port.at_once = 4
    with display:
        port.send(np.array([0x0102, 0x0304, 0x0506], np.uint16))
        assert display.recv(6, socket.MSG_WAITALL) == b"\x02\x01\x04\x03\x06\x05"
        display.send(b"\x08\x07\x0a")
        assert port.receive(1).tolist() == [0x0708]
        display.send(b"\x09")
        assert port.receive(1).tolist() == [0x090A]
    port.wire.socket.close()


def test_a_display_that_reads_nothing_or_is_lost_is_a_port_error() -> None:
    port, display = paired(0.1)
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


def receive(count: Any) -> None:
    port, display = paired()
    try:
        port.receive(count)
    finally:
        port.wire.socket.close()
        display.close()


TIMEOUT = "a timeout must be a number of seconds from 0 to 1,000,000, not {!r}; choose another"
ADDRESS = "an address must be tcp://host:port with a port from 1 to 65535, not {!r}; write it so"
COUNT = (
    "the words received must be a whole number from 0 on, not {!r}; ask for as many as an instruction replies"
)
REFUSED: list[tuple[Callable[[Any], object], list[Any], str]] = [
    (lambda value: TcpPort("tcp://127.0.0.1:1", value), [0, -1, float("nan"), None, "30", True], TIMEOUT),
    (lambda value: UnixPort("nowhere", value), [0, float("inf"), "30", True], TIMEOUT),
    (
        host_and_port,
        ["", "127.0.0.1:1", "tcp://", "tcp://a", "tcp://a:0", "tcp://a:70000", "tcp://a:b", "tcp://a b:1", 9],
        ADDRESS,
    ),
    (receive, [-1, 1.0, None, "1", True], COUNT),
]
"""A call with one argument, refused arguments, and the sentence of the refusal."""


@pytest.mark.parametrize(
    ("call", "value", "sentence"),
    [(call, value, sentence) for call, values, sentence in REFUSED for value in values],
)
def test_a_wrong_argument_is_refused(call: Callable[[Any], object], value: Any, sentence: str) -> None:
    with pytest.raises(RamtekError) as refusal:
        call(value)
    assert str(refusal.value) == sentence.format(value)


def test_a_system_that_makes_no_packet_socket_is_told_with_its_reason(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(*_: int) -> None:
        raise OSError(97, "Address family not supported")

    monkeypatch.setattr(socket, "socket", refuse)
    with pytest.raises(PortError, match=r"does not \(address family not supported\); use TCP"):
        packet_socket()


def test_a_timeout_is_more_than_0_and_at_most_a_million_seconds() -> None:
    for seconds in (5e-324, 1, 999_999, 1_000_000):
        assert checked_timeout(seconds) == seconds
    for wrong in (0, -1, math.nextafter(1e6, math.inf), math.nan, math.inf, True, "1"):
        with pytest.raises(
            PortError, match=r"a timeout must be a number of seconds from 0 to 1,000,000, not"
        ):
            checked_timeout(wrong)


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
        select.select([port.wire.socket], [], [])
        port.timeout = 0.2
        with pytest.raises(ReplyError) as refusal:
            port.receive(3)
        assert "within 0.2 seconds, not 3 of which 1 came" in str(refusal.value)
        assert port.receive(1).tolist() == [0]
        port.timeout = 60
    with pytest.raises(PortError, match="must be open"):
        port.send(words("0700"))


def test_a_server_that_sends_without_end_fills_no_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ramtek_emu.host.port.MOST_UNREAD", 1000)
    port, display = paired()
    display.sendall(bytes(1002))
    with pytest.raises(PortError, match="sent 1,000 bytes more; check the address"):
        port.receive(502)
    port.wire.socket.close()
    display.close()


def test_words_that_come_one_by_one_are_refused_after_a_while_too() -> None:
    port, display = paired(0.2)
    stop = threading.Event()

    def trickle() -> None:
        while not stop.wait(0.02):
            display.send(b"x")

    thread = threading.Thread(target=trickle)
    thread.start()
    with pytest.raises(ReplyError, match=r"must come within 0\.2 seconds, not 1000"):
        port.receive(1000)
    stop.set()
    thread.join()
    port.wire.socket.close()
    display.close()


def test_after_closing_everything_that_was_sent_is_drawn() -> None:
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    with serving() as server:
        for shift in range(5):
            with TcpPort(server.address) as port:
                port.send(instructions.write_image((picture + shift) % 1024))
            assert (server.display.words == (picture + shift) % 1024).all()


def test_closing_drops_the_replies_that_nobody_took_and_loses_no_word() -> None:
    with serving() as server:
        with TcpPort(server.address) as port:
            port.send(np.concatenate((READ_EVERYTHING, READ_EVERYTHING, OUTLINE)))
        assert server.display.words.any()
        port.close()


def silent_listener() -> socket.socket:
    """A server that accepts no host: hosts wait in its line."""
    return socket.create_server(("127.0.0.1", 0))


def test_closing_reports_a_display_that_does_not_execute_all_words() -> None:
    with silent_listener() as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        port = TcpPort(address, timeout=0.2)
        port.send(OUTLINE)
        with pytest.raises(PortError) as refusal:
            port.close()
    assert str(refusal.value) == (
        f"a display must execute all words within 0.2 seconds, and {address} has not: "
        "it may be serving another host first; give a longer timeout"
    )


@pytest.mark.parametrize("rudely", [False, True])
def test_closing_reports_that_the_host_was_turned_away(rudely: bool) -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=5)
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
    with silent_listener() as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        with pytest.raises(ZeroDivisionError), TcpPort(address, timeout=0.1):
            raise ZeroDivisionError


@pytest.mark.parametrize("kind", ["tcp", "unix"])
def test_a_hard_reset_frees_a_display_that_waits_for_the_rest_of_an_instruction(
    kind: str, tmp_path: Path
) -> None:
    path = tmp_path / "display"
    with serving() if kind == "tcp" else serving_at(path) as server, port_to(server) as port:
        port.send(instructions.load_entries(3, [[1, 2, 3]]))
        port.send(OUTLINE)
        server_words = server.display.words
        port.send(words("0802 0002 0009 1600 0064 0464 0B03 0040 0 0 9 9 C8 0A01 FFFE 1 2 3"))
        until(lambda: server.display.decoder.pending_words == 5)
        port.reset()
        assert not server_words.any()
        assert server.display.decoder.pending_words == 0
        assert not server.display.cursors[0].is_visible
        assert server.display.entries[3].tolist() == [1, 2, 3]
        # The replies before the reset are gone; the next reply answers the next instruction.
        port.send(words("0902 0044 5 0 0 0 0 0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [5]


def port_to(server: Server) -> SocketPort:
    return TcpPort(server.address) if isinstance(server, TcpServer) else UnixPort(server.address)


def test_many_resets_in_a_row_leave_the_words_between_them_whole() -> None:
    with serving() as server, TcpPort(server.address) as port:
        for number in range(50):
            port.send(words(f"0902 0044 {number + 1:X} 0 0 0 0 0B03 0040 0 0 0 0 2"))
            assert port.receive(1).tolist() == [number + 1]
            port.reset()
        assert not server.display.words.any()


def test_a_reset_without_an_answer_is_a_port_error() -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=0.2)
        with pytest.raises(PortError, match=r"a display must reset within 0\.2 seconds"):
            port.reset()
        with pytest.raises(PortError):
            port.close()


def test_a_late_answer_to_a_reset_still_drops_the_earlier_replies() -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=0.2)
        connected, _ = listener.accept()
        with connected:
            with pytest.raises(PortError):
                port.reset()
            connected.sendall(b"\1\0")
            connected.send(b"\0", socket.MSG_OOB)
            connected.sendall(b"\7\0")
            port.timeout = 10
            assert port.receive(1).tolist() == [7]
    with pytest.raises(PortError):
        port.close()


def test_replies_that_arrive_during_sending_stay_in_order() -> None:
    with serving() as server, TcpPort(server.address) as port:
        threads = threading.active_count()
        for _ in range(4):
            port.send(READ_EVERYTHING)
        assert not port.receive(4 * 480 * 640).any()
        assert threading.active_count() == threads


def test_a_connection_cannot_be_copied_or_pickled_and_says_why() -> None:
    with serving() as server:
        address = server.address
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


NAME = bytes.fromhex("030c 4000 0000 0000 4001 0900 0600 5645 4e45 3231 00")
"""A text instruction of 21 bytes, as a program of the time wrote it."""


def test_each_write_is_rounded_down_to_whole_words_alone(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server, UnixPort(tmp_path / "display") as port:
        assert len(NAME) == 21
        port.write(NAME)
        port.write(bytes.fromhex("0017"))
        assert port.receive(2).tolist() == [0, 0]
        assert server.display.words.any()
        assert server.display.decoder.pending_words == 0
        # A write of a single byte has no word.
        for byte in b"\x02\x09\x44":
            port.write(bytes((byte,)))
        port.send(words("0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [server.display.words[0, 0]]


def test_a_whole_picture_goes_both_ways(tmp_path: Path) -> None:
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    with serving_at(tmp_path / "display"), UnixPort(tmp_path / "display") as port:
        port.send(instructions.write_image(picture))
        for _ in range(3):
            port.send(READ_EVERYTHING)
        for _ in range(3):
            assert (port.receive(480 * 640) == picture.reshape(-1)).all()


def test_two_hundred_hosts_in_a_row_all_draw_at_a_unix_socket(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with serving_at(path) as server:
        for number in range(0, 200, 2):
            with UnixPort(path) as port:
                port.send(words(f"0902 0044 {number + 1:X} {number:X} 9 {number:X} 9"))
            with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as host:
                host.connect(str(path))
                drawing = words(f"0902 0044 {number + 2:X} {number + 1:X} 9 {number + 1:X} 9")
                host.send(drawing.astype("<u2").tobytes())
        until(lambda: server.served == 200)
        assert server.display.words[9, :200].tolist() == list(range(1, 201))


def test_more_hosts_than_the_line_holds_find_a_place_later(tmp_path: Path) -> None:
    path = tmp_path / "display"

    def draw(number: int) -> None:
        with UnixPort(path, timeout=60) as port:
            port.send(words(f"0902 0044 5 {number:X} 9 {number:X} 9"))

    with serving_at(path) as server:
        first = UnixPort(path)
        until(lambda: server.busy)
        hosts = [threading.Thread(target=draw, args=(number,)) for number in range(150)]
        for host in hosts:
            host.start()
        first.close()
        for host in hosts:
            host.join()
        assert (server.display.words[9, :150] == 5).all()


def test_a_write_that_is_too_long_for_a_packet_is_refused(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display"), UnixPort(tmp_path / "display") as port:
        with pytest.raises(PortError) as refusal:
            port.write(bytes(65537))
        assert str(refusal.value) == (
            "a write must be at most 65536 bytes, not 65537; divide it at an even place"
        )
