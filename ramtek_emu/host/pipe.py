"""A display on a pipe: a host's words on one end, its replies on the other.

`serve_pipe` waits for the host, as a command does. `PolledPipe` never waits, so that a window can be drawn in
between: two threads do the waiting, and only whoever asks it touches the display.

A host that no longer takes its replies loses them; its words are still done (Assumed: a host that draws and
leaves wants its picture). What ends the input ends the session: an unfinished instruction and an odd last
byte are dropped.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator
from typing import Final

from ramtek_emu.host.host_session import HostSession

READ_BYTES: Final = 1 << 16
Read = Callable[[int], bytes]
Write = Callable[[bytes], object]


def serve_pipe(session: HostSession, read: Read, write: Write | None) -> None:
    """Do what comes from `read` until it gives nothing more; hand each reply to `write` at once.

    `read` returns what is there, at most as many bytes as it is asked for; without `write` replies are
    dropped.
    """
    while data := read(READ_BYTES):
        for reply in session.feed(data):
            if reply and write is not None:
                try:
                    write(reply)
                except ConnectionError:
                    # The host has gone.
                    write = None


class PolledPipe:
    """The same in slices of time; `ended` once the host has nothing more to send."""

    def __init__(self, session: HostSession, read: Read, write: Write | None = None) -> None:
        self.session = session
        self.ended = False
        self._data: queue.Queue[bytes] = queue.Queue(4)
        self._replies: queue.Queue[bytes] = queue.Queue(64)
        self._pending: Iterator[bytes] = iter(())
        self._reply = b""
        self._write = write
        threading.Thread(target=self._fill, args=(read,), daemon=True).start()
        if write is not None:
            threading.Thread(target=self._drain, daemon=True).start()

    def step(self) -> bool:
        """Do one piece of what has come; returns whether there was one, and room for its reply."""
        if self._reply:
            try:
                self._replies.put_nowait(self._reply)
            except queue.Full:
                return False
            self._reply = b""
        reply = next(self._pending, None)
        if reply is None:
            try:
                data = self._data.get_nowait()
            except queue.Empty:
                return False
            if not data:
                self.ended = True
                return False
            self._pending = self.session.feed(data)
        elif self._write is not None:
            self._reply = reply
        return True

    def serve_for(self, seconds: float) -> None:
        """Serve without waiting until nothing is left to do, or the time is over."""
        end = time.monotonic() + seconds
        while not self.ended and self.step() and time.monotonic() < end:
            pass

    def _fill(self, read: Read) -> None:
        data = b"-"
        while data:
            try:
                data = read(READ_BYTES)
            except (OSError, ValueError):
                data = b""
            self._data.put(data)

    def _drain(self) -> None:
        write = self._write
        while True:
            reply = self._replies.get()
            if write is not None:
                try:
                    write(reply)
                except (OSError, ValueError):
                    write = None
