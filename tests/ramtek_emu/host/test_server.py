from __future__ import annotations

import itertools
import os
import select
import socket
import stat
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import OutputError, OutputExistsError, PortError, Ramtek9300, TcpPort, UnixPort, instructions
from ramtek_emu.arrays import Words
from ramtek_emu.host.port import break_off, packet_socket, prepared, write_socket
from ramtek_emu.host.server import REPLY_BYTES, Client, HostSession, TcpServer, UnixServer
from ramtek_emu.testing import streams
from tests.ramtek_emu.displays import smallest_slices
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import READ_EVERYTHING, serving, serving_at, until
from tests.ramtek_emu.strategies import SLICED, SMALL, drawing_instructions, sent_words
from tests.tables import refused


def connected(server: TcpServer) -> socket.socket:
    return socket.create_connection(("127.0.0.1", server.port), 60)


def packet(text: str) -> bytes:
    return words(text).astype("<u2").tobytes()


def test_a_host_that_takes_no_replies_is_read_no_further() -> None:
    with serving() as server, connected(server) as host:
        left = memoryview(np.tile(READ_EVERYTHING, 300_000).astype("<u2").tobytes())
        prepared(host)

        def is_stopped() -> bool:
            """Whether the server reads no more and the host can send no more; it sends until then."""
            nonlocal left
            sent = write_socket(host, left)
            left = left[sent:]
            return not sent and server._client is not None and server._client.waiting >= REPLY_BYTES

        until(is_stopped)
        assert len(left) > 0
        # The replies to a piece may exceed the bound.
        assert server._client is not None
        assert server._client.waiting < REPLY_BYTES + (1 << 17)


@pytest.mark.parametrize(
    ("partial", "rudely"), [("0A", False), ("0A03 0040 0000", True), ("0A01 FFFE 0001 0002", False)]
)
def test_a_host_that_vanishes_in_mid_instruction_leaves_the_display_to_the_next(
    partial: str, rudely: bool
) -> None:
    with serving() as server:
        with TcpPort(server.address) as first:
            first.send(words("0802 0002 0007"))
            first.send(OUTLINE)
            first.send(READ_EVERYTHING)
            until(server.display.words.any)
            with suppress(PortError):
                first.socket.setblocking(True)
                first.socket.sendall(packet(partial) + b"\x01")
            if rudely:
                break_off(first.socket)
            first.socket.close()
        until(lambda: not server.busy)
        assert server.display.decoder.pending_words == 0
        assert server.display.processor.waiting == 0
        before = server.display.words.copy()
        assert before.any()
        with TcpPort(server.address) as second:
            stream, count = next(instructions.read_image(100, 100, 1, 1))
            second.send(stream)
            assert second.receive(count).tolist() == [before[100, 100]]
            assert (server.display.words == before).all()


def test_a_second_host_waits_until_the_first_has_left() -> None:
    with serving() as server, TcpPort(server.address) as first:
        first.send(words("0700"))
        until(lambda: server.busy)
        with TcpPort(server.address) as second:
            second.send(words("0902 0044 7 5 0 5 0 0B03 0040 4 0 5 0 4"))
            first.send(words("0902 0044 3 4 0 4 0 0B03 0040 4 0 5 0 4"))
            assert first.receive(2).tolist() == [3, 0]
            assert server.served == 0
            first.close()
            assert second.receive(2).tolist() == [3, 7]
    assert server.served == 2


def mark(number: int) -> bytes:
    """A drawing of one pixel; its place is the number of the drawing."""
    return packet(f"0902 0044 {number + 1:X} {number:X} 9 {number:X} 9")


def draw_from_a_socket(server: TcpServer, number: int) -> None:
    with connected(server) as host:
        host.sendall(mark(number))


def draw_and_ask(server: TcpServer, number: int) -> None:
    with connected(server) as host:
        host.sendall(packet("0B03 0040 0 0 27F 1 0A00") + mark(number))


def draw_from_a_port(server: TcpServer, number: int) -> None:
    with TcpPort(server.address) as port:
        port.send(np.frombuffer(mark(number), "<u2").astype(np.uint16))


@pytest.mark.parametrize("draw", [draw_from_a_socket, draw_and_ask, draw_from_a_port])
def test_hosts_in_a_row_all_draw_also_if_they_leave_without_their_replies(
    draw: Callable[[TcpServer, int], None],
) -> None:
    with serving() as server:
        for number in range(60):
            draw(server, number)
        until(lambda: server.served == 60)
        assert server.display.words[9, :60].tolist() == list(range(1, 61))


@pytest.mark.parametrize("is_unix", [False, True])
def test_a_server_that_closes_before_all_is_drawn_is_lost_for_the_host(tmp_path: Path, is_unix: bool) -> None:
    path = tmp_path / "display"
    server = UnixServer(Ramtek9300(), path) if is_unix else TcpServer(Ramtek9300())
    port = UnixPort(path, timeout=60) if is_unix else TcpPort(server.address, timeout=60)
    until(server.step)
    # A silent host gives nothing to do.
    assert not server.step()
    port.send(np.tile(words("0902 0044 7 5 5 5 5"), 1000))
    until(lambda: server.step(0.1) and server.display.words[5, 5] == 7)
    server.close()
    with pytest.raises(PortError, match=r"and it left \("):
        port.close()


def test_a_host_that_was_turned_away_with_unread_replies_is_told_at_closing() -> None:
    with serving(idle_seconds=0.2) as server:
        port = TcpPort(server.address, timeout=60)
        port.send(instructions.read_cursor(0))
        until(lambda: server.served == 1)
        with pytest.raises(PortError, match="it closed the connection"):
            port.close()


def test_a_silent_host_holds_up_the_line_no_longer_than_its_limit() -> None:
    with serving(idle_seconds=0.3) as server, connected(server), connected(server):
        until(lambda: server.busy)
        # The third host has sent everything and left, so that it cannot be silent for too long.
        draw_from_a_socket(server, 1)
        until(lambda: server.served == 3)
        assert server.display.words[9, 1] == 2


def test_a_host_that_ends_its_side_still_gets_its_replies() -> None:
    with serving() as server, connected(server) as host:
        host.sendall(READ_EVERYTHING.astype("<u2").tobytes())
        host.shutdown(socket.SHUT_WR)
        host.settimeout(60)
        received = 0
        while data := host.recv(1 << 16):
            received += len(data)
        assert received == 2 * 640 * 480


# Sessions without a wire.


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
    assert session.display.decoder.pending_words == twin.decoder.pending_words
    assert session.odd_byte == odd_byte
    session.leave()
    assert not session.odd_byte
    assert session.display.decoder.pending_words == 0
    assert session.display.processor.waiting == 0


@given(streams(), st.integers(0, 200))
def test_a_recording_ends_with_a_whole_instruction(stream: list[int], cut: int) -> None:
    recorded: list[bytes] = []
    session = HostSession(Ramtek9300(SMALL), recorded.append)
    data = np.array(stream, "<u2").tobytes()
    for piece in (data[:cut], data[cut:]):
        for _ in session.feed(piece):
            again = Ramtek9300(SMALL)
            again.send(np.frombuffer(b"".join(recorded), "<u2").astype(np.uint16))
            assert again.decoder.pending_words == 0
    assert b"".join(recorded) == data[: len(data) - 2 * session.display.decoder.pending_words]


@pytest.fixture
def one_instruction_a_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ramtek_emu.host.server.SLICE_SECONDS", 0.0)


def recorded_session() -> tuple[HostSession, list[bytes]]:
    recorded: list[bytes] = []
    return HostSession(Ramtek9300(SMALL), recorded.append), recorded


LONG = packet("0E03 0002 9 18 0 0 C 0 C 1 0 1 0 2 C 2")
"""A WVL of six vertices in 16 words, which is drawn in slices of a line each."""
NO_OPERATION = packet("0700")
DOT = packet("0902 0044 7 5 5 5 5")
RESET = packet("0500")


@pytest.mark.usefixtures("one_instruction_a_piece")
@pytest.mark.parametrize("cut", [0, 2, 9, 30])
def test_a_half_drawn_instruction_is_not_executed_and_not_recorded(cut: int) -> None:
    session, recorded = recorded_session()
    list(session.feed(NO_OPERATION + LONG[:cut]))
    drawn = []
    with smallest_slices():
        for _ in session.feed(LONG[cut:] + NO_OPERATION):
            drawn.append(int(np.count_nonzero(session.display.words)))
            if len(drawn) <= 6:
                assert session.unexecuted == 17
                assert b"".join(recorded) == NO_OPERATION
    assert drawn[:6] == [1, 13, 14, 26, 27, 39]
    assert session.unexecuted == 0
    assert b"".join(recorded) == NO_OPERATION + LONG + NO_OPERATION


@pytest.mark.usefixtures("one_instruction_a_piece")
def test_a_reset_within_an_instruction_leaves_it_out_of_the_recording() -> None:
    session, recorded = recorded_session()
    list(session.feed(NO_OPERATION + LONG[:10]))
    with smallest_slices():
        pauses = session.feed(LONG[10:] + DOT)
        next(pauses)
        assert session.display.words.any()
        session.reset()
        assert not session.display.words.any()
        list(pauses)
    assert np.argwhere(session.display.words).tolist() == [[5, 5]]
    assert b"".join(recorded) == NO_OPERATION + RESET + DOT
    assert session.unexecuted == 0


@given(
    st.lists(drawing_instructions(SLICED) | streams(12).map(sent_words), min_size=1, max_size=4),
    st.integers(0, 400),
    st.sets(st.integers(0, 40), max_size=4),
)
def test_a_recording_with_resets_at_any_pause_gives_the_same_display(
    parts: list[Words], cut: int, resets: set[int]
) -> None:
    session, recorded = recorded_session()
    data = np.concatenate(parts).astype("<u2").tobytes()
    pause = 0
    with smallest_slices(), pytest.MonkeyPatch.context() as patch:
        patch.setattr("ramtek_emu.host.server.SLICE_SECONDS", 0.0)
        for piece in (data[:cut], data[cut:]):
            for _ in session.feed(piece):
                if pause in resets:
                    session.reset()
                pause += 1
    again = Ramtek9300(SMALL)
    again.send(np.frombuffer(b"".join(recorded), "<u2").astype(np.uint16))
    assert again.decoder.pending_words == 0
    assert (again.words == session.display.words).all()
    assert (again.entries == session.display.entries).all()
    assert again.processor.parameters == session.display.processor.parameters


@given(words=streams(), stops=st.lists(st.booleans(), max_size=12))
def test_a_stopped_session_executes_nothing(words: list[int], stops: list[bool]) -> None:
    recorded = bytearray()
    session = HostSession(Ramtek9300(SMALL), recorded.extend)
    waiting = session.feed(np.array(words, "<u2").tobytes())
    for session.is_stopped in stops:
        before = len(recorded)
        next(waiting, None)
        assert len(recorded) == before or not session.is_stopped
    session.is_stopped = False
    for _ in waiting:
        pass
    assert len(recorded) == 2 * max(0, *Ramtek9300(SMALL).send_stepwise(np.array(words, np.uint16)), 0)
    assert session.unexecuted == 0


# A host on a wire of packets.


@contextmanager
def host_and_client() -> Iterator[tuple[socket.socket, Client]]:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    client = Client(there, HostSession(Ramtek9300()), 10)
    with host:
        yield host, client
    client.close()


def serve_all(client: Client) -> None:
    """Read, execute and reply until nothing is left."""
    while client.step():
        pass


def test_a_host_that_takes_no_more_replies_is_still_drawn_for() -> None:
    with host_and_client() as (host, client):
        host.send(packet("0B03 0040 0 0 0 0 2"))
        host.send(DOT)
        host.close()
        until(lambda: not client.step() and client.ended)
        assert client.session.display.words[5, 5] == 7


@pytest.mark.usefixtures("one_instruction_a_piece")
def test_the_last_packets_of_a_host_that_left_without_its_replies_are_drawn_once() -> None:
    for more in (b"", DOT):
        with host_and_client() as (host, client):
            host.send(packet("0B03 0040 0 0 0 0 2") + more)
            # The reply is sent while the rest of the packet waits.
            while not select.select([host], [], [], 0)[0]:
                client.step()
            host.send(DOT)
            host.close()
            until(lambda: not client.step() and client.ended)
            assert client.session.display.words[5, 5] == 7
            assert 2 * client.session.display.words_received == 14 + len(more) + len(DOT)


@pytest.mark.usefixtures("one_instruction_a_piece")
def test_the_time_that_the_display_takes_is_no_silence_of_the_host(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 1000.0
    monkeypatch.setattr("ramtek_emu.host.server.time.monotonic", lambda: now)
    with host_and_client() as (host, client):
        draw = client.session.display.send_stepwise

        def slow(sent: Words) -> Iterator[int]:
            nonlocal now
            for place in draw(sent):
                now += 12
                yield place

        monkeypatch.setattr(client.session.display, "send_stepwise", slow)
        host.send(DOT + packet("0B03 0040 0 0 0 0 2"))
        while client.step():
            assert client.deadline > now
        assert now > 1020
        now += 11
        assert client.deadline < now


def test_replies_to_different_writes_are_in_different_packets_and_an_odd_byte_is_no_word() -> None:
    with host_and_client() as (host, client):
        for odd in (b"!", b""):
            host.send(DOT + packet("0B03 0040 5 5 5 5 2") + odd)
            host.send(packet("0B03 0040 5 5 6 5 4"))
        serve_all(client)
        assert [host.recv(100) for _ in range(4)] == [packet("7"), packet("7 0")] * 2


def test_replies_to_a_write_come_in_packets_of_at_most_64_kib(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server, packet_socket() as host:
        host.settimeout(60)
        host.connect(server.address)
        host.send(3 * packet("0B03 0040 0 0 27F 2E EB00"))
        lengths: list[int] = []
        while sum(lengths) < 3 * 0xEB00:
            lengths.append(len(host.recv(1 << 20)))
    assert len(lengths) > 2
    assert max(lengths) <= 1 << 16


# Addresses and files.


def test_a_port_that_is_taken_is_refused_in_one_sentence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        with pytest.raises(PortError) as taken:
            TcpServer(Ramtek9300(), port)
    assert f"a server must have a free port, and 127.0.0.1:{port} cannot be opened" in str(taken.value)


def test_a_port_accepts_the_address_of_a_server_on_ipv6() -> None:
    try:
        server = TcpServer(Ramtek9300(), host="::1")
    except PortError:
        pytest.skip("this machine has no IPv6")
    with server:
        assert server.address == f"tcp://[::1]:{server.port}"
        port = TcpPort(server.address)
        port.send(words("0902 0044 5 0 0 0 0"))
        while not server.display.words.any():
            server.step(0.1)
        port.socket.close()


def test_the_socket_is_its_owner_s_alone_and_goes_with_the_server(tmp_path: Path) -> None:
    path = tmp_path / "display"
    # The socket of a server that is gone is replaced.
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        listener.bind(str(path))
    before = os.umask(0)
    try:
        with UnixServer(Ramtek9300(), path) as server:
            assert server.address == str(path)
            assert stat.S_IMODE(path.stat().st_mode) == 0o600
    finally:
        os.umask(before)
    assert not path.exists()


@pytest.mark.parametrize("kind", ["file", "folder", "link", "server"])
def test_an_existing_file_at_the_path_is_left_alone(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "display"
    server = None
    if kind == "file":
        path.write_text("mine")
    elif kind == "folder":
        path.mkdir()
    elif kind == "link":
        path.symlink_to(tmp_path / "nothing")
    else:
        server = UnixServer(Ramtek9300(), path)
    before = path.lstat()
    with pytest.raises(OutputExistsError) as refusal:
        UnixServer(Ramtek9300(), path)
    assert str(refusal.value) == (
        "a server's socket must be a new file or the socket of a server that is gone, "
        f"not {path}, which {'belongs to a server that runs' if server else 'exists'}; choose another path"
    )
    assert path.lstat().st_ino == before.st_ino
    if server is not None:
        assert not server.step()
        server.close()


def test_a_server_leaves_a_file_that_took_the_place_of_its_socket(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with UnixServer(Ramtek9300(), path):
        path.unlink()
        path.write_text("mine")
    assert path.read_text() == "mine"


NOWHERE = "a server's socket must be where a socket can be made, not at {!r} ({}); choose another path"
test_a_path_where_no_socket_can_be_made = refused(
    lambda path: UnixServer(Ramtek9300(), path),
    [
        ("/no folder/display", NOWHERE.format("/no folder/display", "no such file or directory")),
        ("x" * 200, NOWHERE.format("x" * 200, "af_unix path too long")),
    ],
    OutputError,
)


def test_hosts_that_start_with_the_server_are_all_served(tmp_path: Path) -> None:
    path, failures = tmp_path / "display", []

    def draw(number: int) -> None:
        try:
            with UnixPort(path, timeout=60) as port:
                port.send(words(f"0902 0044 5 {number:X} 9 {number:X} 9"))
        except PortError as failure:
            failures.append(failure)

    hosts = [threading.Thread(target=draw, args=(number,)) for number in range(200)]
    for host in hosts:
        host.start()
    with serving_at(path) as server:
        for host in hosts:
            host.join()
        assert not failures
        assert (server.display.words[9, :200] == 5).all()
    assert os.listdir(tmp_path) == []


def test_a_name_appears_when_its_socket_listens_and_a_refused_server_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = os.link

    def observed(hidden: str, path: str) -> None:
        with packet_socket() as host:
            host.connect(hidden)
        # Another server takes the name meanwhile.
        Path(path).touch()
        link(hidden, path)

    monkeypatch.setattr(os, "link", observed)
    with pytest.raises(OutputExistsError):
        UnixServer(Ramtek9300(), tmp_path / "display")
    assert os.listdir(tmp_path) == ["display"]


def test_a_socket_takes_each_name_that_fits_and_no_other(tmp_path: Path) -> None:
    folder = tmp_path / ("x" * (104 - len(os.fsencode(tmp_path))))
    folder.mkdir()
    with UnixServer(Ramtek9300(), folder / "d"):
        UnixPort(folder / "d", timeout=60).socket.close()
    with pytest.raises(OutputError, match="path too long"):
        UnixServer(Ramtek9300(), folder / "\u00e9\u00e9")
    assert os.listdir(folder) == []
