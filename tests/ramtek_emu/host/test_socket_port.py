from __future__ import annotations

import socket
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ramtek_emu import PortError, ReplyError, TcpPort, UnixPort
from ramtek_emu.host.marks import Sign
from ramtek_emu.host.socket_port import SocketPort


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
