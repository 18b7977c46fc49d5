"""A display on pipes: the words of the host come in on one, the replies go out on the other.

`serve_pipe` blocks until the host sends something, as a command does. `PolledPipe` never blocks, so that a
window can be drawn in between: two threads read and write the pipes, and only the caller uses the display.

A host that no longer takes its replies loses them, but its words are still executed (Assumed: a host that
draws and leaves wants its picture). The session ends with the input; an unfinished instruction and an odd
last byte are dropped.
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
    """Execute what `read` returns until it returns nothing; pass each reply to `write` at once.

    `read` returns the bytes that are available, at most as many as it is asked for. Without `write`, replies
    are dropped.
    """
    while data := read(READ_BYTES):
        for reply in session.feed(data):
            if reply and write is not None:
                try:
                    write(reply)
                except ConnectionError:
                    # The host has closed its end.
                    write = None


class PolledPipe:
    """Serves pipes in slices of time; `ended` is set when the host has closed its end."""

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

    @property
    def has_replied(self) -> bool:
        """Whether the host has got all replies, or no longer takes them."""
        return self._write is None or not (self._reply or self._replies.unfinished_tasks)

    def step(self) -> bool:
        """Execute one piece; returns False if none has arrived, or if its reply must wait."""
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
        """Serve, without blocking, until there is nothing left to do or the time is over."""
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
            self._replies.task_done()
