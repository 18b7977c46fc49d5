"""Ctrl+C and termination signals, which end a server without an error."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ramtek_emu.host.pipe import Read


class EndSignals:
    """Remembers Ctrl+C or a termination signal."""

    def __init__(self) -> None:
        self.received = False
        self._waiting = False

    def receive(self, *_: object) -> None:
        """Remember the signal, and interrupt a read that is waiting."""
        self.received = True
        if self._waiting:
            raise InterruptedError

    def until_received(self, read: Read) -> Read:
        """A function like `read` that returns nothing after the signal, or if reading fails."""

        def read_until_received(most: int) -> bytes:
            try:
                self._waiting = True
                return b"" if self.received else read(most)
            except OSError:
                # Also raised by a terminal or a socket whose other end was closed.
                return b""
            finally:
                self._waiting = False

        return read_until_received


@contextmanager
def end_signals() -> Iterator[EndSignals]:
    """Handle Ctrl+C and termination signals within a `with` block."""
    signals = EndSignals()
    before = {number: signal.signal(number, signals.receive) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield signals
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
