"""TcpServer: a display at `tcp://host:port`.

Words come as a stream of bytes: TCP does not tell where one write of a host ended and the next began. A
program that relied on each write being rounded down to whole words needs `UnixServer`.
"""

from __future__ import annotations

import socket
from typing import Final

from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import PortError, reason_of
from ramtek_emu.host.connection import StreamConnection
from ramtek_emu.host.host_session import Record
from ramtek_emu.host.server import IDLE_SECONDS, LINE, PARTIAL_SECONDS, Server

LOOPBACK: Final = "127.0.0.1"


class TcpServer(Server):
    """A display on TCP. `port` is the port it listens on, even if 0 asked for any free one."""

    def __init__(
        self,
        display: Ramtek9300,
        port: int = 0,
        host: str = LOOPBACK,
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen; PortError if the port cannot be had."""
        try:
            family = socket.AF_INET6 if ":" in host else socket.AF_INET
            listener = socket.create_server((host, port), family=family, backlog=LINE)
        except (OSError, OverflowError, UnicodeError) as cause:
            raise PortError(
                f"a server must have a port to itself, and {host}:{port} cannot be had ({reason_of(cause)}); "
                "choose another, or 0 for any"
            ) from cause
        super().__init__(
            display,
            listener,
            StreamConnection,
            idle_seconds=idle_seconds,
            partial_seconds=partial_seconds,
            record=record,
        )
        self.host = host
        self.port: int = listener.getsockname()[1]

    @property
    def address(self) -> str:
        """The address that a host passes to TcpPort."""
        return f"tcp://{f'[{self.host}]' if ':' in self.host else self.host}:{self.port}"
