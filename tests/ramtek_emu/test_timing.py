from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import GMR_9300, ConfigurationError, Ramtek9300, Timing, instructions
from ramtek_emu.video.beam import Beam
from tests.ramtek_emu.strategies import SMALL, cuts, quick, sent_words, streams

TIMED = replace(GMR_9300, timing=Timing())


def colors(display: Ramtek9300) -> list[int]:
    """The red of each line, which must be the same all along it."""
    field = display.field()
    assert (field == field[:, :1]).all()
    reds: list[int] = field[:, 0, 0].tolist()
    return reds


def entry(red: int) -> NDArray[np.uint16]:
    return instructions.load_entries(0, [[red, 0, 0]])


def test_a_load_in_mid_field_shows_on_the_lines_below() -> None:
    display = Ramtek9300(TIMED)
    display.send(entry(50))
    display.send(sent_words([0x2A00, 200]))
    display.send(entry(90))
    assert colors(display) == [50] * 200 + [90] * 280
    # A field later it is everywhere.
    display.send(sent_words([0x2A00, 100]))
    assert colors(display) == [90] * 480


def test_a_load_in_the_retrace_shows_on_the_whole_field() -> None:
    display = Ramtek9300(TIMED)
    display.send(entry(50))
    display.send(sent_words([0x2A00, 300, 0x2901]))
    assert display.beam is not None
    assert display.beam.line == 480
    display.send(entry(90))
    assert colors(display) == [90] * 480


def test_several_loads_in_a_field_make_as_many_stripes() -> None:
    display = Ramtek9300(TIMED)
    display.send(sent_words([0x2901]))
    for number in range(8):
        display.send(sent_words([0x2A00, 60 * number]))
        display.send(entry(10 + number))
    assert colors(display) == [10 + line // 60 for line in range(480)]


def test_words_written_behind_the_beam_wait_for_the_next_field() -> None:
    display = Ramtek9300(TIMED)
    display.send(instructions.load_entries(0, [[0, 0, 0], [200, 0, 0]]))
    display.send(sent_words([0x2A00, 240]))
    display.send(instructions.erase((0, 200, 1, 299), 1))
    assert display.field()[:, 0, 0].tolist() == [0] * 240 + [200] * 60 + [0] * 180
    display.send(sent_words([0x2901]))
    assert display.field()[:, 0, 0].tolist() == [0] * 200 + [200] * 100 + [0] * 180


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


@pytest.mark.parametrize(
    ("rates", "sentence"),
    [
        ({"line": 0}, "line must be a whole number from 1 to 1000000000, not 0 (timing)"),
        ({"pixel": -1}, "pixel must be a whole number from 0 to 1000000000, not -1 (timing)"),
        ({"word": 0.5}, "word must be a whole number from 0 to 1000000000, not 0.5 (timing)"),
    ],
)
def test_rates_that_no_display_has_are_refused(rates: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ConfigurationError) as refusal:
        Timing(**rates)
    assert str(refusal.value) == f"{sentence}; give nanoseconds, lines or fields"


@quick
@given(streams(200), st.lists(st.integers(0, 200), max_size=5))
def test_the_same_stream_gives_the_same_field_however_it_is_cut(stream: list[int], places: list[int]) -> None:
    slow = Timing(instruction=400_000, word=20_000, pixel=9_000)
    configuration = replace(SMALL, timing=replace(slow, line=100_000, blanked_lines=2))
    whole, cut = Ramtek9300(configuration), Ramtek9300(configuration)
    whole.send(sent_words(stream))
    for piece in cuts(stream, places):
        cut.send(piece)
    assert (whole.field() == cut.field()).all()
    assert whole.scan_out.stamp == cut.scan_out.stamp
    # Looking takes no time.
    assert (whole.field() == cut.field()).all()
