"""DeviceRelay: a pseudoterminal as a program's device; the display gets the program's writes one by one.

The program opens the pseudoterminal by its path, as it opened the device, and reads and writes whole words
there in raw mode. Every write is rounded down to whole words, as the driver did (Hardware: PRG DRIVER.c,
V8K), and goes to the display at a Unix socket. The replies come back.

A terminal hands over bytes, not writes. Measured on Linux 6.18: a write of up to 4,095 bytes is read whole if
it is read before the next write; 4,096 bytes are read as 4,095 and then 1; and 2,000 writes of a program that
does not wait were read in 80 pieces. Packet mode (TIOCPKT) marks no boundaries. Therefore the kernel gives
notice of every write before it begins: with a seccomp filter, Linux (5.5 and later) stops the program at each
`write` until we allow it. All bytes that were read before belong to earlier writes. This is exact for writes
of any size while only one process writes at a time. The program and its children need no change: they may be
statically linked, or 32-bit. A write takes about a tenth of a millisecond longer.

What is **not** modeled: the errors of a driver. PRG DRIVER.c fails with EIO after an illegal instruction, and
refuses a second open with EACCES. Here both succeed; RERR reads the status of the instruction.

What notices do **not** separate: simultaneous writes of two processes or threads, and writes by other calls
(`io_uring`). With the filter, the program gains no privileges from set-user-ID files. Children that outlive
us cannot write to any file (ENOSYS). A signal during a write that waits for permission ends the write with
EINTR, unless the signal's handler was installed with SA_RESTART.

C's stdio buffers a terminal by lines: a program that draws with `fwrite` ends a write at every byte 0A, even
in the middle of a word. Its writes are meant as a stream of bytes, and are relayed as a stream, without
notices.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import select
import struct
from contextlib import suppress
from typing import Final, NamedTuple

from ramtek_emu.errors import PortError
from ramtek_emu.host.port import Sign, UnixPort

# linux/filter.h, linux/seccomp.h, linux/prctl.h, linux/audit.h
INSTRUCTION: Final = struct.Struct("HBBI")
PROGRAM: Final = struct.Struct("HP")
LOAD: Final = 0x20
JUMP_IF_EQUAL: Final = 0x15
RETURN: Final = 0x06
NUMBER_PLACE: Final = 0
ARCHITECTURE_PLACE: Final = 4
ALLOW: Final = 0x7FFF0000
NOTIFY: Final = 0x7FC00000
NO_NEW_PRIVILEGES: Final = 38
SET_FILTER: Final = 1
NEW_LISTENER: Final = 8
RECEIVE: Final = 0xC0502100
ANSWER: Final = 0xC0182101
NOTICE_BYTES: Final = 80
IDENTITY: Final = struct.Struct("Q")
RESPONSE: Final = struct.Struct("QqiI")
CONTINUE: Final = 1


class Architecture(NamedTuple):
    """The number of an architecture in the filter, and its numbers of the calls `write` and `writev`."""

    audit: int
    write: int
    writev: int


class Machine(NamedTuple):
    """The number of the call `seccomp`, and the architectures of programs that run on a machine."""

    seccomp: int
    architectures: tuple[Architecture, ...]


MACHINES: Final = {
    "x86_64": Machine(317, (Architecture(0xC000003E, 1, 20), Architecture(0x40000003, 4, 146))),
    "aarch64": Machine(277, (Architecture(0xC00000B7, 64, 66), Architecture(0x40000028, 4, 146))),
}


def filter_of(machine: Machine) -> bytes:
    """The filter that gives notice of `write` and `writev` and lets everything else pass."""
    steps = [(LOAD, 0, 0, ARCHITECTURE_PLACE)]
    for architecture in machine.architectures:
        steps += [
            (JUMP_IF_EQUAL, 0, 5, architecture.audit),
            (LOAD, 0, 0, NUMBER_PLACE),
            (JUMP_IF_EQUAL, 2, 0, architecture.write),
            (JUMP_IF_EQUAL, 1, 0, architecture.writev),
            (RETURN, 0, 0, ALLOW),
            (RETURN, 0, 0, NOTIFY),
        ]
    steps.append((RETURN, 0, 0, ALLOW))
    return b"".join(INSTRUCTION.pack(*step) for step in steps)


def ask_for_notices() -> int:
    """Install the filter in this process; returns the file of the notices, for WriteNotices.

    The filter stays when the process executes a program. OSError if the system has no such filters.
    """
    machine = MACHINES.get(platform.machine())
    # The numbers of calls differ in a 32-bit Python.
    if platform.system() != "Linux" or machine is None or PROGRAM.size != 16:
        raise OSError(errno.ENOSYS, f"not on {platform.system()}, {platform.machine()}")
    library = ctypes.CDLL(None, use_errno=True)
    steps = filter_of(machine)
    filter_bytes = ctypes.create_string_buffer(steps, len(steps))
    program = ctypes.create_string_buffer(
        PROGRAM.pack(len(steps) // INSTRUCTION.size, ctypes.addressof(filter_bytes)), PROGRAM.size
    )
    zero = ctypes.c_ulong(0)
    if library.prctl(NO_NEW_PRIVILEGES, ctypes.c_ulong(1), zero, zero, zero) == 0:
        arguments = ctypes.c_ulong(SET_FILTER), ctypes.c_ulong(NEW_LISTENER), program
        number: int = library.syscall(ctypes.c_long(machine.seccomp), *arguments)
        if number >= 0:
            return number
    code = ctypes.get_errno()
    raise OSError(code, os.strerror(code))


class WriteNotices:
    """The notices of a program's writes; a write begins when it is allowed."""

    def __init__(self, number: int) -> None:
        self._number = number

    def fileno(self) -> int:
        """The file descriptor that becomes readable when a write is about to begin."""
        return self._number

    def next(self) -> int | None:
        """The identity of the next write; None if the program has ended meanwhile."""
        from fcntl import ioctl

        notice = bytearray(NOTICE_BYTES)
        try:
            ioctl(self._number, RECEIVE, notice)
        except OSError:
            return None
        identity: int = IDENTITY.unpack_from(notice)[0]
        return identity

    def allow(self, identity: int) -> None:
        """Let a write begin."""
        from fcntl import ioctl

        # A program that was killed is no longer waiting.
        with suppress(OSError):
            ioctl(self._number, ANSWER, RESPONSE.pack(identity, 0, 0, CONTINUE))

    def close(self) -> None:
        """Ask for no more notices."""
        os.close(self._number)


PIECE: Final = 1 << 16
"""The most bytes that are read or sent at once."""
FULL: Final = 1 << 18
"""The number of waiting bytes in one direction at which reading for that direction stops."""


class DeviceRelay:
    """Passes bytes between the terminal of a program and a display, until the program has ended."""

    def __init__(self, port: UnixPort, terminal: int, notices: WriteNotices | None) -> None:
        """Relay between the port and `terminal`, our side of the pseudoterminal; it is set not to block.

        Without notices, writes are not rounded down: they form a stream of bytes.
        """
        self._port, self._wire = port, port.wire
        self._terminal, self._notices = terminal, notices
        self._written = bytearray()
        """Bytes that the program wrote and that were not sent yet; during a write their number may be odd."""
        self._replies = bytearray()
        os.set_blocking(terminal, False)

    def relay(self, ended: int) -> None:
        """Relay until the file `ended` is readable: the program has ended. PortError if the display left.

        Then call `finish` to send the remaining bytes.
        """
        display, notices = self._wire.socket.fileno(), self._notices
        while True:
            takes_words, takes_replies = len(self._written) < FULL, len(self._replies) < FULL
            has_words, has_replies = len(self._written) > 1, len(self._replies) > 0
            polled = select.poll()
            polled.register(ended, select.POLLIN)
            polled.register(display, select.POLLIN * takes_replies | select.POLLOUT * has_words)
            polled.register(self._terminal, select.POLLIN * takes_words | select.POLLOUT * has_replies)
            if notices is not None and takes_words:
                polled.register(notices.fileno(), select.POLLIN)
            events = dict(polled.poll())
            self._serve_display(events.get(display, 0))
            if events.get(self._terminal, 0) & select.POLLOUT:
                with suppress(BlockingIOError):
                    del self._replies[: os.write(self._terminal, self._replies[:PIECE])]
            if events.get(self._terminal, 0) & select.POLLIN:
                self._take_written()
            if notices is not None and events.get(notices.fileno(), 0) & select.POLLIN:
                self._allow_next_write(notices)
            if ended in events:
                self._take_written()
                self._end_write()
                return

    def finish(self) -> None:
        """Send the remaining bytes of the program and drop replies. PortError if the display left."""
        while self._written:
            self._replies.clear()
            polled = select.poll()
            polled.register(self._wire.socket, select.POLLIN | select.POLLOUT)
            for _, events in polled.poll():
                self._serve_display(events)

    def _serve_display(self, events: int) -> None:
        """Receive replies and send words if the display is ready; PortError if it left."""
        try:
            if events & ~select.POLLOUT:
                data = self._wire.read(PIECE)
                if data is Sign.END:
                    raise self._lost()
                if not isinstance(data, Sign):
                    self._replies += data
            if events & select.POLLOUT:
                whole = len(self._written) & ~1
                del self._written[: self._wire.send(self._written[: min(PIECE, whole)])]
        except PortError:
            raise
        except OSError as cause:
            raise self._lost() from cause

    def _allow_next_write(self, notices: WriteNotices) -> None:
        identity = notices.next()
        if identity is not None:
            # Reading the terminal until it is empty gives all bytes of earlier writes.
            self._take_written()
            self._end_write()
            notices.allow(identity)

    def _take_written(self) -> None:
        while len(self._written) < 2 * FULL:
            try:
                self._written += os.read(self._terminal, PIECE)
            except OSError:
                return

    def _end_write(self) -> None:
        """Round the bytes of a finished write down to whole words."""
        if len(self._written) & 1:
            del self._written[-1]

    def _lost(self) -> PortError:
        return PortError(
            f"a display must stay at {self._port.address} while a program uses it, and it left; "
            "start the program again later"
        )
