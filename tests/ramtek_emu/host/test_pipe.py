from __future__ import annotations

import random
import time
from collections.abc import Callable

import numpy as np

from ramtek_emu import GMR_9300, Ramtek9300, instructions
from ramtek_emu.host.host_session import HostSession
from ramtek_emu.host.pipe import PolledPipe, serve_pipe
from ramtek_emu.monitor.window import Monitor
from tests.ramtek_emu.processes import stream
from tests.ramtek_emu.recorded_streams import OUTLINE, RECORDED


def pop_of(pieces: list[bytes]) -> Callable[[int], bytes]:
    """A reader that gives the last of the pieces, whatever is asked."""
    return lambda _: pieces.pop()


def test_a_thousand_mutated_streams_are_played_and_leave_a_display_that_works() -> None:
    draw = random.Random(1983)
    display = Ramtek9300()
    real = [stream(each[:600]) for each in RECORDED] + [stream(instructions.write_text("mutated", 9, 9))]
    session = HostSession(display)
    for _ in range(1000):
        data = bytearray(draw.choice(real))
        for _ in range(draw.randint(1, 12)):
            place = draw.randrange(len(data))
            change = draw.randrange(3)
            if change == 0:
                data[place] = draw.randrange(256)
            elif change == 1:
                del data[place : place + draw.randint(1, 4)]
            else:
                data[place:place] = draw.randbytes(draw.randint(1, 4))
            data = data or bytearray(b"\0")
        pieces = [b"", bytes(data[50:]), bytes(data[:50])]
        serve_pipe(session, pop_of(pieces), None)
        assert display.processor.waiting == 0
    assert int(display.words.max()) <= GMR_9300.largest_word
    session.leave()
    twin = Ramtek9300()
    for one in (display, twin):
        one.send(instructions.reset())
        one.send(OUTLINE)
    assert (display.words == twin.words).all()


def test_a_pipe_is_shown_in_slices_of_time_and_its_replies_come(on_screen: str) -> None:
    stream = np.concatenate((OUTLINE, next(instructions.read_image(100, 100, 3, 1))[0]))
    replies: list[bytes] = []
    left = [b"", stream.astype("<u2").tobytes()]
    display = Ramtek9300()
    pipe = PolledPipe(HostSession(display), lambda _: left.pop(), replies.append)
    monitor = Monitor(display, on_tick=lambda: pipe.serve_for(0.01))
    monitor.open()
    end = time.monotonic() + 5
    while not (pipe.ended and replies) and time.monotonic() < end:
        monitor.step(5)
    assert b"".join(replies) == display.words[100, 100:103].astype("<u2").tobytes()
    monitor.close()
