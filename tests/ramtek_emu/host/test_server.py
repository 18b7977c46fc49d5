from __future__ import annotations

import socket
import threading
import time
from contextlib import suppress

import numpy as np
import pytest

from ramtek_emu import HostPort, PortError, Ramtek9300, TcpPort, instructions
from ramtek_emu.host.client import REPLY_BYTES
from ramtek_emu.host.tcp_server import TcpServer
from tests.ramtek_emu.recorded_streams import OUTLINE, RECORDED, words
from tests.ramtek_emu.serving import READ_EVERYTHING, serving, until


def connected(server: TcpServer) -> socket.socket:
    return socket.create_connection(("127.0.0.1", server.port), 5)


def closed(connection: socket.socket) -> bool:
    """Whether the other side closes the connection within five seconds."""
    connection.settimeout(5)
    with suppress(ConnectionError):
        return connection.recv(1) == b""
    return True


def test_a_host_draws_reads_back_and_draws_from_what_it_read() -> None:
    here = Ramtek9300()
    with serving() as server, TcpPort(server.address) as there:
        ports: tuple[HostPort, ...] = (here, there)
        for port in ports:
            port.send(OUTLINE)
            read = instructions.read_image(90, 40, 300, 200)
            lines = []
            for stream, count in read:
                port.send(stream)
                lines.append(port.receive(count))
            image = np.concatenate(lines).reshape(200, 300)
            assert image.any()
            port.send(instructions.write_image(image[::-1], 90, 250))
            port.send(instructions.read_entries(0, 4))
            assert port.receive(4).tolist() == [0, 0, 0, 0]
        there.send(instructions.read_image(0, 0, 1, 1).__next__()[0])
        there.receive(1)
        assert (server.display.words == here.words).all()


def test_everything_can_be_asked_before_anything_is_read() -> None:
    with serving() as server, TcpPort(server.address) as port:
        port.send(instructions.write_image(np.arange(480 * 640).reshape(480, 640) % 1024))
        for _ in range(8):
            port.send(READ_EVERYTHING)
        for _ in range(8):
            assert (port.receive(480 * 640) == np.arange(480 * 640) % 1024).all()


def test_a_host_that_takes_no_replies_is_read_no_further() -> None:
    with serving() as server, connected(server) as host:
        asked = np.tile(READ_EVERYTHING, 300_000).astype("<u2").tobytes()
        host.settimeout(0.5)
        with pytest.raises(TimeoutError):
            host.sendall(asked)
        assert server.busy
        # What waits is bounded: what the socket holds, one full buffer, and the replies of one piece.
        assert server._client is not None
        assert server._client.connection.waiting < REPLY_BYTES + (1 << 17)


def test_words_come_whole_however_the_bytes_are_cut() -> None:
    data = np.concatenate([OUTLINE, instructions.read_image(100, 100, 2, 1).__next__()[0]])
    with serving() as server, connected(server) as host:
        host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in data.astype("<u2").tobytes():
            host.sendall(bytes((byte,)))
        host.settimeout(5)
        reply = b""
        while len(reply) < 4:
            reply += host.recv(4)
        twin = Ramtek9300()
        twin.send(OUTLINE)
        assert (server.display.words == twin.words).all()
        assert reply == twin.words[100, 100:102].astype("<u2").tobytes()


@pytest.mark.parametrize("partial", ["0A", "0A01", "0A03 0040 0000", "0A01 FFFE 0001 0002", "0E01 0008 0001"])
@pytest.mark.parametrize("rudely", [False, True])
def test_a_host_that_vanishes_in_mid_instruction_leaves_the_display_to_the_next(
    partial: str, rudely: bool
) -> None:
    with serving() as server:
        with TcpPort(server.address) as first:
            first.send(words("0802 0002 0007"))
            first.send(OUTLINE)
            first.send(READ_EVERYTHING)
            data = words(partial).astype("<u2").tobytes() + b"\x01"
            until(server.display.words.any)
            with suppress(PortError):
                first._socket.setblocking(True)
                first._socket.sendall(data)
            if rudely:
                # Closed with a reset instead of a farewell.
                first._socket.setsockopt(
                    socket.SOL_SOCKET, socket.SO_LINGER, b"\x01\x00\x00\x00\x00\x00\x00\x00"
                )
            first._socket.close()
        until(lambda: not server.busy)
        assert server.display.decoder.held_words == 0
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
        first.send(instructions.no_operation())
        until(lambda: server.busy)
        with TcpPort(server.address) as second:
            second.send(words("0902 0044 7 5 0 5 0 0B03 0040 4 0 5 0 4"))
            first.send(words("0902 0044 3 4 0 4 0 0B03 0040 4 0 5 0 4"))
            assert first.receive(2).tolist() == [3, 0]
            assert server.served == 0
            first.close()
            assert second.receive(2).tolist() == [3, 7]
    assert server.served == 2


def mark(number: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    """A drawing of one pixel, whose place tells which."""
    return words(f"0902 0044 {number % 1000 + 1:X} {number:X} 9 {number:X} 9")


def draw_from_a_socket(server: TcpServer, number: int, *, more: bytes = b"") -> None:
    with connected(server) as host:
        host.sendall(mark(number).astype("<u2").tobytes() + more)


ALL_MARKS = [number + 1 for number in range(200)]


def test_two_hundred_hosts_one_right_after_another_all_draw() -> None:
    with serving() as server:
        for number in range(200):
            with TcpPort(server.address) as port:
                port.send(mark(number))
        assert server.display.words[9, :200].tolist() == ALL_MARKS
    assert server.served == 200


def test_a_server_that_closes_before_all_is_drawn_is_lost_for_the_host() -> None:
    server = TcpServer(Ramtek9300())
    port = TcpPort(server.address, timeout=20)
    port.send(np.tile(words("0902 0044 7 5 5 5 5"), 1000))
    errors: list[str] = []

    def close() -> None:
        try:
            port.close()
        except PortError as error:
            errors.append(str(error))

    host = threading.Thread(target=close)
    host.start()
    time.sleep(0.2)
    until(lambda: server.step(0.1) and server.display.words[5, 5] == 7)
    server.close()
    host.join()
    assert len(errors) == 1
    assert "and it left (connection reset by peer)" in errors[0]


def test_two_hundred_plain_sockets_one_right_after_another_all_draw() -> None:
    with serving() as server:
        for number in range(200):
            draw_from_a_socket(server, number)
        until(lambda: server.served == 200, 20)
        assert server.display.words[9, :200].tolist() == ALL_MARKS


def test_plain_sockets_that_ask_for_replies_and_leave_without_them_all_draw() -> None:
    with serving() as server:
        for number in range(200):
            asked = instructions.read_image(0, 0, 640, 2).__next__()[0].astype("<u2").tobytes()
            draw_from_a_socket(server, number, more=asked + mark(number + 200).astype("<u2").tobytes())
        until(lambda: server.served == 200, 20)
        assert np.count_nonzero(server.display.words[9]) == 400


def test_a_hundred_hosts_at_the_same_time_all_draw() -> None:
    with serving() as server:
        hosts = [connected(server) for _ in range(100)]
        for number, host in reversed(list(enumerate(hosts))):
            host.sendall(mark(number).astype("<u2").tobytes())
        for host in hosts:
            host.close()
        until(lambda: server.served == 100, 20)
        assert server.display.words[9, :100].tolist() == ALL_MARKS[:100]


def test_a_silent_host_holds_up_the_line_no_longer_than_its_limit() -> None:
    with serving(idle_seconds=0.3) as server, connected(server), connected(server):
        until(lambda: server.busy)
        begin = time.monotonic()
        with TcpPort(server.address) as port:
            port.send(mark(1))
        assert 0.2 < time.monotonic() - begin < 3
        assert server.display.words[9, 1] == 2


def test_a_silent_host_is_shown_out_and_one_that_leaves_an_instruction_unfinished_sooner() -> None:
    with serving(idle_seconds=0.3) as server:
        with connected(server) as host:
            assert closed(host)
        until(lambda: server.served == 1)
    with serving(partial_seconds=0.3) as server:
        with connected(server) as host:
            until(lambda: server.busy)
            time.sleep(0.5)
            host.sendall(b"\x00\x07")
            time.sleep(0.5)
            assert server.busy
            host.sendall(b"\x00")
            assert closed(host)
        until(lambda: server.served == 1)


def test_a_host_that_takes_no_replies_is_shown_out_after_a_while() -> None:
    with serving(idle_seconds=0.4) as server, connected(server) as host:
        asked = np.tile(READ_EVERYTHING, 1000).astype("<u2").tobytes()
        host.sendall(asked)
        until(lambda: server.served == 1)
        assert server.display.processor.waiting == 0


def test_random_bytes_over_tcp_leave_the_display_that_they_leave_here() -> None:
    draw = np.random.default_rng(9400)
    noise = draw.integers(0, 0x10000, 60_000).astype(np.uint16)
    twin = Ramtek9300()
    twin.send(noise)
    twin.decoder.clear()
    with serving() as server:
        with connected(server) as host:
            data = noise.astype("<u2").tobytes() + b"?"
            reader = threading.Thread(target=lambda: [None for _ in iter(lambda: host.recv(1 << 16), b"")])
            reader.start()
            for place in range(0, len(data), 4999):
                host.sendall(data[place : place + 4999])
            host.shutdown(socket.SHUT_WR)
            reader.join(20)
        until(lambda: server.served == 1)
        assert (server.display.words == twin.words).all()
        assert (server.display.entries == twin.entries).all()
        assert server.display.processor.parameters == twin.processor.parameters


def test_a_host_that_ends_its_side_still_gets_its_replies() -> None:
    with serving() as server, connected(server) as host:
        host.sendall(READ_EVERYTHING.astype("<u2").tobytes())
        host.shutdown(socket.SHUT_WR)
        host.settimeout(5)
        received = 0
        while data := host.recv(1 << 16):
            received += len(data)
        assert received == 2 * 640 * 480


@pytest.mark.parametrize("number", range(len(RECORDED)))
def test_a_recorded_stream_over_tcp_gives_the_same_display(number: int) -> None:
    twin = Ramtek9300()
    twin.send(RECORDED[number])
    with serving() as server, TcpPort(server.address) as port:
        port.send(RECORDED[number])
        port.send(words("0B03 0040 0 0 0 0 2"))
        port.receive(1)
        assert (server.display.words == twin.words).all()
        assert (server.display.entries == twin.entries).all()


def test_urgent_bytes_among_noise_leave_a_display_that_works() -> None:
    draw = np.random.default_rng(1978)
    with serving() as server:
        for _ in range(5):
            with connected(server) as host:
                reader = threading.Thread(target=read_all, args=(host,))
                reader.start()
                for _ in range(40):
                    host.sendall(draw.bytes(int(draw.integers(0, 4000))))
                    host.send(draw.bytes(1), socket.MSG_OOB)
                host.shutdown(socket.SHUT_WR)
                reader.join(20)
        with TcpPort(server.address) as port:
            port.reset()
            port.send(OUTLINE)
        twin = Ramtek9300()
        twin.send(OUTLINE)
        assert (server.display.words == twin.words).all()


def read_all(host: socket.socket) -> None:
    with suppress(ConnectionError):
        while host.recv(1 << 16):
            pass
