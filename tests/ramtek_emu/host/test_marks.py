from __future__ import annotations

import socket
import time

import pytest

from ramtek_emu.host.marks import (
    Sign,
    expect_marks,
    read_packet,
    read_stream,
    send_packet_mark,
    send_stream_mark,
)


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
