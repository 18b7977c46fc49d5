"""HostPort: the two methods by which a host uses a display; and the port to a file.

Files hold streams in the byte order of the PDP-11 and the VAX, low byte first (Hardware: PRG, JPL, whose
programs hand the words of their memory to the interface as they are).
"""

from __future__ import annotations

from typing import BinaryIO, Protocol

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_stream
from ramtek_emu.errors import ReplyError


class HostPort(Protocol):
    """Takes the words of a host, and returns the replies; `Ramtek9300` is a host port."""

    def send(self, words: Words) -> None:
        """Send 16-bit words; an instruction may be spread over several calls."""

    def receive(self, count: int) -> Words:
        """The next `count` words of the replies, uint16; ReplyError if there are fewer."""
        ...


class Recorder:
    """A host port that writes all words to a file, and passes them on to another port if one is given."""

    def __init__(self, file: BinaryIO, port: HostPort | None = None) -> None:
        self._file = file
        self._port = port

    def __repr__(self) -> str:
        file = getattr(self._file, "name", type(self._file).__name__)
        return f"Recorder({file}{'' if self._port is None else f', {self._port!r}'})"

    def send(self, words: Words) -> None:
        """Write the words to the file, low byte first, and pass them on."""
        stream = checked_stream(words)
        self._file.write(stream.astype("<u2", copy=False).tobytes())
        if self._port is not None:
            self._port.send(stream)

    def receive(self, count: int) -> Words:
        """The words that the other port returns; ReplyError if there is no other port."""
        if self._port is None:
            raise ReplyError(
                f"a recording must have a display behind it to give words, not none ({count} asked); "
                "give Recorder a port"
            )
        return self._port.receive(count)
