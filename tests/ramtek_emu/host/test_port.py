from __future__ import annotations

import copy
import pickle
import socket
import threading
import time
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
    WordsError,
    instructions,
)
from ramtek_emu.host.port import (
    PacketConnection,
    Sign,
    SocketPort,
    expect_marks,
    host_and_port,
    read_packet,
    read_stream,
    send_packet_mark,
    send_stream_mark,
)
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


def test_a_recorder_tells_its_file_and_its_display(tmp_path: Path) -> None:
    with open(tmp_path / "words", "wb") as file:
        assert repr(Recorder(file)) == f"Recorder({tmp_path / 'words'})"
    assert repr(Recorder(BytesIO(), Ramtek9300())).startswith("Recorder(BytesIO, Ramtek9300(GMR_9300, ")


def connected_pair() -> tuple[socket.socket, socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        host = socket.create_connection(listener.getsockname())
        display, _ = listener.accept()
    expect_marks(display)
    return host, display


def test_a_mark_stands_at_its_place_between_the_bytes_of_a_stream() -> None:
    host, display = connected_pair()
    with host, display:
        host.sendall(b"before")
        send_stream_mark(host)
        host.sendall(b"after")
        host.shutdown(socket.SHUT_WR)
        time.sleep(0.1)
        found = [read_stream(display, 100) for _ in range(4)]
    assert found == [b"before", Sign.MARK, b"after", Sign.END]


def test_a_mark_stands_at_its_place_between_packets() -> None:
    host, display = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with host, display:
        host.send(b"be")
        host.send(b"fore")
        send_packet_mark(host)
        assert [read_packet(display, 100) for _ in range(3)] == [b"be", b"fore", Sign.MARK]
        send_packet_mark(host)
        host.send(b"after")
        host.close()
        assert [read_packet(display, 100) for _ in range(3)] == [Sign.MARK, b"after", Sign.END]


def test_nothing_to_read_is_told_by_an_error() -> None:
    host, display = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with host, display:
        display.setblocking(False)
        with pytest.raises(BlockingIOError):
            read_packet(display, 100)


def test_a_packet_loses_its_odd_byte_and_replies_keep_their_boundaries() -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = PacketConnection(there)
    with host, there:
        for packet in (b"abc", b"d", b"ef"):
            host.send(packet)
        assert [display.read() for _ in range(3)] == [b"ab", b"", b"ef"]
        display.reply(b"12")
        display.reply(b"")
        display.reply(b"3456")
        assert display.waiting == 6
        while display.has_to_send:
            display.send()
        assert [host.recv(100), host.recv(100)] == [b"12", b"3456"]
        host.close()
        assert display.read() is Sign.END


def test_the_answer_to_a_mark_takes_the_place_of_the_replies_that_wait() -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = PacketConnection(there)
    with host, there:
        display.reply(b"old")
        display.answer_mark()
        assert display.has_to_send
        display.reply(b"new")
        while display.has_to_send:
            display.send()
        assert [host.recv(100), host.recv(100)] == [b"", b"new"]


class PairedPort(SocketPort):
    """A port on one of two sockets of this process."""

    at_once = 4

    def _read(self) -> bytes | Sign:
        return self._socket.recv(100) or Sign.END

    def _send_mark(self) -> None:
        self._socket.send(b"mark")


def paired(timeout: float = 5.0) -> tuple[PairedPort, socket.socket]:
    ours, theirs = socket.socketpair()
    return PairedPort("here", ours, timeout), theirs


def test_words_are_sent_in_pieces_low_byte_first() -> None:
    port, display = paired()
    with display:
        port.send(np.array([0x0102, 0x0304, 0x0506], np.uint16))
        assert display.recv(100) == b"\x02\x01\x04\x03\x06\x05"
        display.send(b"\x08\x07\x0a")
        assert port.receive(1).tolist() == [0x0708]
        display.send(b"\x09")
        assert port.receive(1).tolist() == [0x090A]
    port._socket.close()


def test_a_display_that_takes_nothing_or_is_lost_is_told_as_such() -> None:
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


@pytest.mark.parametrize("seconds", [0, -1, float("nan"), float("inf"), None, "30", True])
def test_what_is_no_time_to_wait_is_refused(seconds: Any, tmp_path: Path) -> None:
    with pytest.raises(PortError, match="a timeout must be a number of seconds from 0 to 1,000,000"):
        TcpPort("tcp://127.0.0.1:1", seconds)
    with pytest.raises(PortError, match="a timeout must be a number of seconds from 0 to 1,000,000"):
        UnixPort(tmp_path / "display", seconds)


@pytest.mark.parametrize("count", [-1, 1.0, None, "1", True])
def test_what_is_no_number_of_words_to_receive_is_refused(count: Any) -> None:
    port, display = paired()
    with display, pytest.raises(ReplyError, match="the words received must be a whole number from 0 on"):
        port.receive(count)
    port._socket.close()


def test_a_port_without_a_display_is_refused_in_one_sentence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(PortError) as refusal:
        TcpPort(f"tcp://127.0.0.1:{port}")
    assert str(refusal.value) == (
        f"a display must listen at tcp://127.0.0.1:{port}, and it is not reached (connection refused); "
        "start `ramtek serve` there"
    )


@pytest.mark.parametrize(
    "address",
    ["", "127.0.0.1:1", "tcp://", "tcp://a", "tcp://a:0", "tcp://a:70000", "tcp://a:b", "tcp://a b:1", 9300],
)
def test_what_is_no_address_is_refused(address: Any) -> None:
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
    """A server that accepts nobody: whoever comes waits in its line."""
    return socket.create_server(("127.0.0.1", 0))


def test_a_display_that_does_not_get_to_the_end_is_told_when_closing() -> None:
    with silent_listener() as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        port = TcpPort(address, timeout=0.2)
        port.send(OUTLINE)
        with pytest.raises(PortError) as refusal:
            port.close()
    assert str(refusal.value) == (
        f"a display must get to the end of what it was sent within 0.2 seconds, and {address} has not: "
        "it may be serving another host first; give a longer timeout"
    )


@pytest.mark.parametrize("rudely", [False, True])
def test_a_host_that_is_turned_away_is_told_when_closing(rudely: bool) -> None:
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


def test_an_error_in_a_with_block_is_not_hidden_by_the_one_of_closing() -> None:
    with silent_listener() as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        with pytest.raises(ZeroDivisionError), TcpPort(address, timeout=0.1):
            raise ZeroDivisionError


def test_a_hard_reset_frees_a_display_that_waits_for_the_rest_of_an_instruction() -> None:
    with serving() as server, TcpPort(server.address) as port:
        port.send(instructions.load_entries(3, [[1, 2, 3]]))
        port.send(OUTLINE)
        server_words = server.display.words
        port.send(words("0802 0002 0009 1600 0064 0464 0B03 0040 0 0 9 9 C8 0A01 FFFE 1 2 3"))
        until(lambda: server.display.decoder.held_words == 5)
        port.reset()
        assert not server_words.any()
        assert server.display.decoder.held_words == 0
        assert not server.display.cursors[0].is_visible
        assert server.display.entries[3].tolist() == [1, 2, 3]
        # The replies of before are gone; the next are those of what is asked now.
        port.send(words("0902 0044 5 0 0 0 0 0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [5]


def test_many_resets_in_a_row_leave_the_words_between_them_whole() -> None:
    with serving() as server, TcpPort(server.address) as port:
        for number in range(50):
            port.send(words(f"0902 0044 {number + 1:X} 0 0 0 0 0B03 0040 0 0 0 0 2"))
            assert port.receive(1).tolist() == [number + 1]
            port.reset()
        assert not server.display.words.any()


def test_a_reset_that_is_not_answered_is_told() -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=0.2)
        with pytest.raises(PortError, match=r"a display must reset within 0\.2 seconds"):
            port.reset()
        with pytest.raises(PortError):
            port.close()


def test_a_reset_that_is_answered_late_still_drops_the_replies_of_before() -> None:
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


def test_replies_that_come_while_words_are_sent_are_kept_in_order() -> None:
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
        assert server.display.decoder.held_words == 0
        # Single bytes are no words at all.
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


def test_two_hundred_hosts_one_right_after_another_all_draw_at_a_unix_socket(tmp_path: Path) -> None:
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


def test_a_hard_reset_frees_a_display_that_waits_for_the_rest_of_an_instruction_2(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server, UnixPort(tmp_path / "display") as port:
        port.send(words("0902 0044 7 0 0 9 9 0B03 0040 0 0 9 9 C8 0A01 FFFE 1 2 3"))
        port.reset()
        assert not server.display.words.any()
        assert server.display.decoder.held_words == 0
        port.send(words("0902 0044 5 0 0 0 0 0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [5]


def test_more_hosts_than_the_line_holds_find_a_place_later(tmp_path: Path) -> None:
    path = tmp_path / "display"

    def draw(number: int) -> None:
        with UnixPort(path, timeout=20) as port:
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


def test_a_path_without_a_display_is_refused_in_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with pytest.raises(PortError) as refusal:
        UnixPort(path)
    assert str(refusal.value) == (
        f"a display must listen at {path}, and it is not reached (no such file or directory); "
        f"start `ramtek serve --unix {path}`"
    )
