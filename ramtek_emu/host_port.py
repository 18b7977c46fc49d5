"""HostPort: all that a host sees of a display, two methods wide; and the port that writes to a file.

Streams lie in files in the memory order of the PDP-11 and the VAX: low byte first (Hardware: PRG, JPL, whose
programs hand the words of their memory to the interface as they are).
"""

from typing import BinaryIO, Protocol

import numpy as np
from numpy.typing import NDArray

from .checks import checked_stream
from .errors import ReplyError

Words = NDArray[np.uint16]


class HostPort(Protocol):
    """Where a host sends instruction words and receives what they ask for; `Ramtek9300` is one."""

    def send(self, words: Words) -> None:
        """Send 16-bit words; an instruction may be cut anywhere between two sends."""

    def receive(self, count: int) -> Words:
        """The next `count` words that the display has to give, uint16; ReplyError when it has fewer."""
        ...


class Recorder:
    """A host port that writes every word to a file, and passes it on to another port if there is one."""

    def __init__(self, file: BinaryIO, port: HostPort | None = None) -> None:
        self._file = file
        self._port = port

    def send(self, words: Words) -> None:
        """Write the words to the file, low byte first, and pass them on."""
        stream = checked_stream(words)
        self._file.write(stream.astype("<u2", copy=False).tobytes())
        if self._port is not None:
            self._port.send(stream)

    def receive(self, count: int) -> Words:
        """The words that the other port gives; ReplyError when there is none: a file answers nothing."""
        if self._port is None:
            raise ReplyError(
                f"a recording must have a display behind it to give words, not none ({count} asked); "
                "give Recorder a port"
            )
        return self._port.receive(count)
