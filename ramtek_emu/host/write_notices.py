"""WriteNotices: the kernel tells before a program writes, so that one write can be told from the next.

A terminal hands over bytes, not writes: what a program wrote twice in quick succession is read at once. With
a seccomp filter, Linux (5.5 and later) stops each `write` of the program before it begins and lets it go on
when we say so. Everything that arrived until then belongs to the writes before it. The program and its
children need not know: they may be statically linked, or of 32 bits. A write takes about a tenth of a
millisecond longer.

What this does **not** do: writes of two processes or threads at the same time are not told apart, nor those
by other calls (`io_uring`). With the filter, the program gains no privileges from set-user-ID files; children
that outlive us cannot write any more, to any file (ENOSYS); and a signal that comes while a write waits to
begin ends it with EINTR, unless its handler was installed with SA_RESTART.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import struct
from contextlib import suppress
from typing import Final, NamedTuple

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
    """What a program of one kind calls, by number."""

    audit: int
    write: int
    writev: int


class Machine(NamedTuple):
    """The number of the call `seccomp`, and the kinds of programs that run on a machine."""

    seccomp: int
    architectures: tuple[Architecture, ...]


MACHINES: Final = {
    "x86_64": Machine(317, (Architecture(0xC000003E, 1, 20), Architecture(0x40000003, 4, 146))),
    "aarch64": Machine(277, (Architecture(0xC00000B7, 64, 66), Architecture(0x40000028, 4, 146))),
}


def filter_of(machine: Machine) -> bytes:
    """The filter that tells of `write` and `writev` and lets everything else pass."""
    steps = [(LOAD, 0, 0, ARCHITECTURE_PLACE)]
    for each in machine.architectures:
        steps += [
            (JUMP_IF_EQUAL, 0, 5, each.audit),
            (LOAD, 0, 0, NUMBER_PLACE),
            (JUMP_IF_EQUAL, 2, 0, each.write),
            (JUMP_IF_EQUAL, 1, 0, each.writev),
            (RETURN, 0, 0, ALLOW),
            (RETURN, 0, 0, NOTIFY),
        ]
    steps.append((RETURN, 0, 0, ALLOW))
    return b"".join(INSTRUCTION.pack(*step) for step in steps)


def ask_for_notices() -> int:
    """Tell of all writes of this process from now on; returns the file to give to WriteNotices.

    The filter stays when a program is run in this process. OSError where the system does not offer it.
    """
    machine = MACHINES.get(platform.machine())
    # A Python of 32 bits has other numbers than the machine it runs on.
    if platform.system() != "Linux" or machine is None or PROGRAM.size != 16:
        raise OSError(errno.ENOSYS, f"not on {platform.system()}, {platform.machine()}")
    library = ctypes.CDLL(None, use_errno=True)
    steps = filter_of(machine)
    kept = ctypes.create_string_buffer(steps, len(steps))
    program = ctypes.create_string_buffer(
        PROGRAM.pack(len(steps) // INSTRUCTION.size, ctypes.addressof(kept)), PROGRAM.size
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
    """The writes of a program that are about to begin."""

    def __init__(self, number: int) -> None:
        self._number = number

    def fileno(self) -> int:
        """The number of the file that can be read when a write is about to begin."""
        return self._number

    def next(self) -> int | None:
        """What identifies the next write; None if the program has gone meanwhile."""
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
