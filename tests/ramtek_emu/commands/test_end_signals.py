from __future__ import annotations

import os
import signal
import threading
import time

import pytest

from ramtek_emu.commands.end_signals import end_signals


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_read_that_waits_and_every_one_after_it(number: signal.Signals) -> None:
    read_end, write_end = os.pipe()
    before = signal.getsignal(number)
    with end_signals() as signals:
        read = signals.until_received(lambda most: os.read(read_end, most))
        os.write(write_end, b"words")
        assert read(5) == b"words"
        assert not signals.received
        threading.Timer(0.2, os.kill, (os.getpid(), number)).start()
        begin = time.monotonic()
        assert read(5) == b""
        assert time.monotonic() - begin < 5
        assert signals.received
        os.write(write_end, b"words")
        assert read(5) == b""
    assert signal.getsignal(number) is before
    os.close(read_end)
    os.close(write_end)


def test_a_read_that_fails_is_the_end() -> None:
    with end_signals() as signals:
        assert signals.until_received(lambda most: os.read(-1, most))(5) == b""
