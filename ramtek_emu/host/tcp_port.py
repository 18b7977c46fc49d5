"""TcpPort: a host port to a display behind a TCP port, such as `ramtek serve --port` opens."""

from __future__ import annotations

import re
import socket
from typing import Final

from ramtek_emu.errors import PortError, reason_of
from ramtek_emu.host.marks import Sign, expect_marks, marks_are_known, read_stream, send_stream_mark
from ramtek_emu.host.socket_port import SocketPort, checked_timeout

ADDRESS: Final = re.compile(r"(?i:tcp)://(?P<host>\[[0-9A-Fa-f:.%\w]+\]|[^\s:/\[\]@]+):(?P<port>[0-9]{1,5})")


class TcpPort(SocketPort):
    """A host port to the display at `tcp://host:port`.

    Words are transferred low byte first. If the display serves another host, this one waits in line: what it
    sends is kept and executed when its turn comes. `receive` waits up to `timeout` seconds, and so does
    `close`, which a `with` block calls at its end: until the display has executed everything.
    """

    at_once = 1 << 18

    def __init__(self, address: str, timeout: float = 30.0) -> None:
        host, port = host_and_port(address)
        timeout = checked_timeout(timeout)
        try:
            connected = socket.create_connection((host, port), timeout)
        except (OSError, UnicodeError) as cause:
            raise PortError(
                f"a display must listen at {address}, and it is not reached ({reason_of(cause)}); "
                "start `ramtek serve` there"
            ) from cause
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        expect_marks(connected)
        super().__init__(address, connected, timeout)

    def _read(self) -> bytes | Sign:
        return read_stream(self._socket, self.at_once)

    def _send_mark(self) -> None:
        if not marks_are_known():
            raise PortError(
                "a hard reset over TCP must be asked for on Linux, and this is another system; "
                "use the joystick unit of `ramtek serve --joystick`"
            )
        send_stream_mark(self._socket)


def host_and_port(address: str) -> tuple[str, int]:
    """The host and the port of `tcp://host:port`; PortError if the address is not of that form.

    >>> host_and_port("tcp://127.0.0.1:9300"), host_and_port("TCP://[::1]:9300")
    (('127.0.0.1', 9300), ('::1', 9300))
    """
    found = ADDRESS.fullmatch(address) if isinstance(address, str) else None
    if found is None or not 1 <= int(found["port"]) <= 0xFFFF:
        raise PortError(
            f"an address must be tcp://host:port with a port from 1 to 65535, not {address!r}; write it so"
        )
    return found["host"].strip("[]"), int(found["port"])
