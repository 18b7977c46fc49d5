from __future__ import annotations

import itertools
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import GMR_9300, Ramtek9300, Timing
from ramtek_emu.video.beam import Beam
from tests.ramtek_emu.strategies import sent_words

TIMED = replace(GMR_9300, timing=Timing())


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


@given(st.integers(1, 50), st.integers(0, 9), st.integers(1, 1000), st.integers(0, 10**7))
def test_the_time_gives_the_line_of_the_beam(
    lines: int, blanked: int, line_time: int, nanoseconds: int
) -> None:
    beam = Beam(Timing(line=line_time, blanked_lines=blanked), lines)
    beam.nanoseconds = nanoseconds
    done = nanoseconds // line_time
    assert (beam.lines_done, beam.line, beam.field_number) == (
        done, done % (lines + blanked), done // (lines + blanked),
    )  # fmt: skip


@given(st.integers(0, 10**6), st.integers(0, 11))
def test_a_wait_ends_where_its_line_begins_and_takes_less_than_a_field(nanoseconds: int, line: int) -> None:
    beam = Beam(Timing(line=1000, blanked_lines=2), 10)
    beam.nanoseconds = nanoseconds
    was_on_it = beam.line == line
    beam.wait_for_line(line)
    assert beam.line == line
    assert 0 <= beam.nanoseconds - nanoseconds < 12_000
    assert beam.nanoseconds == nanoseconds if was_on_it else beam.nanoseconds % 1000 == 0


def test_an_instruction_takes_time_for_itself_its_words_and_its_pixels() -> None:
    beam = Beam(Timing(instruction=7, word=100, pixel=1000), 480)
    beam.charge(words=3, pixels=2)
    beam.charge(words=0, pixels=0)
    assert beam.nanoseconds == 7 + 300 + 2000 + 7
