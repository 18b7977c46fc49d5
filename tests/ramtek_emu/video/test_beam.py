from __future__ import annotations

import itertools
from dataclasses import replace

from ramtek_emu import GMR_9300, Ramtek9300, Timing
from ramtek_emu.video.beam import Beam
from tests.ramtek_emu.strategies import sent_words

TIMED = replace(GMR_9300, timing=Timing())


def test_waiting_takes_time_and_only_with_a_beam() -> None:
    beam = Beam(Timing(), 480)
    beam.wait_for_line(480)
    assert beam.line == 480
    before = beam.nanoseconds
    beam.wait_for_line(480)
    assert beam.nanoseconds == before
    beam.wait_for_line(3)
    assert (beam.line, beam.field_number) == (3, 1)
    display = Ramtek9300()
    display.send(sent_words([0x2901, 0x2A00, 200, 0x2A00, 0xFFFF]))
    assert display.beam is None


def test_cursors_blink_with_the_fields() -> None:
    display = Ramtek9300(TIMED)
    display.send(sent_words([0x1600, 300, 0xC00 | 200]))
    seen = []
    for _ in range(60):
        display.send(sent_words([0x2A00, 0, 0x2901]))
        seen.append(bool(display.field().any()))
    assert seen[:15] == [True] * 15 or sum(seen[:15]) == 14
    assert 28 <= sum(seen) <= 32
    assert sum(a != b for a, b in itertools.pairwise(seen)) in (3, 4)
