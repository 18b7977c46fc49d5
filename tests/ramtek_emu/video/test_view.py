from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import FAMILY, Ramtek9300, Timing, instructions
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.memory.scan_orders import Point
from ramtek_emu.video.beam import Beam
from ramtek_emu.video.view import PLAIN_VIEW, pixel_at, screen_at, shown_at, view_of
from tests.ramtek_emu.strategies import SMALL, sent_words


def twin_field(
    words: NDArray[np.uint16],
    shown: tuple[int, int],
    origin: tuple[int, int],
    zoom: tuple[int, int],
    up: bool,
) -> list[list[int]]:
    """The words that the screen shows, pixel by pixel."""
    lines, elements = words.shape
    field = []
    for line in range(shown[0]):
        from_origin = shown[0] - 1 - line if up else line
        row = (origin[1] + from_origin // zoom[1]) % lines
        field.append([int(words[row, (origin[0] + x // zoom[0]) % elements]) for x in range(shown[1])])
    return field


@given(
    st.integers(1, 13), st.integers(1, 9), st.tuples(*[st.integers(-0x8000, 0x7FFF)] * 2),
    st.tuples(*[st.integers(1, 16)] * 2), st.booleans(),
)  # fmt: skip
def test_the_field_follows_origin_zoom_and_video_origin(
    elements: int, lines: int, origin: tuple[int, int], zoom: tuple[int, int], up: bool
) -> None:
    display = Ramtek9300(replace(SMALL, visible_elements=elements, visible_lines=lines))
    words = np.arange(117).reshape(9, 13)
    display.send(instructions.load_entries(0, np.repeat(np.arange(117)[:, np.newaxis], 3, axis=1)))
    display.send(instructions.write_image(words))
    display.field()
    display.send(instructions.set_parameters(origin=origin))
    display.send(sent_words([0x2600, zoom[1] - 1 << 8 | zoom[0] - 1, 0x2700 | up]))
    twin = twin_field(display.words, (lines, elements), origin, zoom, up)
    assert display.field()[..., 0].tolist() == twin
    display.send(sent_words([0x0802, 0x0040, 3, 3, 9, 7, 0x0902, 4, 99]))
    twin = twin_field(display.words, (lines, elements), origin, zoom, up)
    assert display.field()[..., 0].tolist() == twin


coordinates = st.integers(-0x8000, 0x7FFF)
views = st.tuples(
    st.builds(Point, coordinates, coordinates), st.tuples(*[st.integers(1, 16)] * 2), st.booleans()
)


def parameters_of(view: tuple[Point, tuple[int, int], bool]) -> Parameters:
    parameters = Parameters.at_reset(SMALL)
    parameters.origin, parameters.zoom, parameters.origin_at_bottom = view
    return parameters


@given(views)
def test_arrays_of_places_give_the_pixels_of_single_places(
    view: tuple[Point, tuple[int, int], bool],
) -> None:
    parameters = parameters_of(view)
    elements, lines = pixel_at(parameters, SMALL, np.arange(13), np.arange(2, 9))
    assert elements.tolist() == [pixel_at(parameters, SMALL, element, 0)[0] for element in range(13)]
    assert lines.tolist() == [pixel_at(parameters, SMALL, 0, line)[1] for line in range(2, 9)]


@given(views, st.integers(0, 12), st.integers(0, 8))
def test_where_a_pixel_is_shown_that_pixel_is_found(
    view: tuple[Point, tuple[int, int], bool], element: int, line: int
) -> None:
    parameters = parameters_of(view)
    assert pixel_at(parameters, SMALL, *screen_at(parameters, SMALL, element, line)) == (element, line)


def test_after_reset_the_screen_shows_the_memory_as_it_lies() -> None:
    parameters = Parameters.at_reset(SMALL)
    assert view_of(parameters) == PLAIN_VIEW
    assert [shown_at(place, 0, 1, 13) for place in range(13)] == list(range(13))


TIMED = replace(FAMILY, timing=Timing())


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
    assert (beam.lines_done, beam.line) == (done, done % (lines + blanked))


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
