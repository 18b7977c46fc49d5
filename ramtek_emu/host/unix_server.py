"""UnixServer: a display at a path, on a Unix domain socket that keeps the boundaries of writes (SEQPACKET).

Each packet is one write of the host and is rounded down to whole words alone, as the drivers of the time did
(Hardware: PRG DRIVER.c, V8K). Whoever may write to the file may draw: it is made for its owner only (0600).
"""

from __future__ import annotations

import os
import socket
import stat
from contextlib import suppress

from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import OutputError, OutputExistsError, reason_of
from ramtek_emu.host.connection import PacketConnection
from ramtek_emu.host.host_session import Record
from ramtek_emu.host.server import IDLE_SECONDS, LINE, PARTIAL_SECONDS, Server
from ramtek_emu.host.unix_port import packet_socket


class UnixServer(Server):
    """A display on a Unix socket; `address` is its path, which a host passes to UnixPort."""

    def __init__(
        self,
        display: Ramtek9300,
        path: str | os.PathLike[str],
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen.

        PortError where the system has no such sockets, OutputExistsError if the path is taken by anything but
        the socket of a server that is gone, OutputError if no socket can be made there.
        """
        self.address = os.fspath(path)
        listener = packet_socket()
        try:
            clear_the_way(self.address)
            # The socket's file gets the permissions of the socket; they are never wider.
            os.fchmod(listener.fileno(), stat.S_IRUSR | stat.S_IWUSR)
            listener.bind(self.address)
            listener.listen(LINE)
            self._file = identity(self.address)
        except OutputExistsError:
            listener.close()
            raise
        except (OSError, ValueError) as cause:
            listener.close()
            raise OutputError(
                f"a server's socket must be where one can be made, not at {self.address!r} "
                f"({reason_of(cause)}); choose another path"
            ) from cause
        super().__init__(
            display,
            listener,
            PacketConnection,
            idle_seconds=idle_seconds,
            partial_seconds=partial_seconds,
            record=record,
        )

    def close(self) -> None:
        """Disconnect the host, stop listening, and remove the socket's file if it is still ours."""
        super().close()
        with suppress(OSError):
            if identity(self.address) == self._file:
                os.unlink(self.address)


def clear_the_way(path: str) -> None:
    """Remove the socket of a server that is gone; OutputExistsError if anything else is at the path."""
    try:
        kind = os.lstat(path).st_mode
    except FileNotFoundError:
        return
    thing = "exists"
    if stat.S_ISSOCK(kind):
        thing = "belongs to a server that runs"
        # A socket of another type is refused by a server that runs, and does not disturb it.
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as asking:
            try:
                asking.connect(path)
            except ConnectionRefusedError:
                os.unlink(path)
                return
            except OSError:
                pass
    raise OutputExistsError(
        f"a server's socket must be a new file or the socket of a server that is gone, not {path}, "
        f"which {thing}; choose another path"
    )


def identity(path: str) -> tuple[int, int]:
    """What tells the file at a path from any other: its device and its number there."""
    file = os.lstat(path)
    return file.st_dev, file.st_ino
