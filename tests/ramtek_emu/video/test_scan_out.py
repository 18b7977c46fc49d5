from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import (
    FAMILY,
    GMR_9300,
    JPL_9460,
    NCAR_9460,
    PRINCETON_9300,
    Configuration,
    EntryFormat,
    Ramtek9300,
    Timing,
    instructions,
)
from ramtek_emu.memory.cursors import BLINK, VISIBLE, cross
from ramtek_emu.testing import rasters, streams, words
from ramtek_emu.video.scan_out import Mark, draw, gray_table, lines_with
from tests.ramtek_emu.displays import colored
from tests.ramtek_emu.strategies import SMALL, cuts, sent_words


@given(rasters(), st.integers(0, 2**32 - 1))
def test_the_field_is_each_word_s_entry(raster: NDArray[np.uint16], seed: int) -> None:
    colors = np.random.default_rng(seed).integers(0, 256, (1024, 3))
    display = Ramtek9300(SMALL)
    display.send(instructions.write_image(raster))
    display.send(instructions.load_entries(0, colors))
    entries = [(int(red), int(green), int(blue)) for red, green, blue in colors]
    twin = np.array([[entries[word] for word in line] for line in raster.tolist()])
    assert (display.field() == twin).all()
    pixels = np.zeros((9, 13), np.uint32)
    display.scan_out.scan_out_into(pixels)
    assert (pixels == (twin[..., 0] << 16 | twin[..., 1] << 8 | twin[..., 2])).all()


def test_recoloring_writes_no_word_and_changes_the_field() -> None:
    display = Ramtek9300()
    display.send(instructions.write_image(np.full((480, 640), 300)))
    written = display.frame_buffer.written
    display.send(instructions.load_entries(300, [[9, 8, 7]]))
    assert display.frame_buffer.written == written
    assert (display.field() == (9, 8, 7)).all()


PLACES = st.tuples(st.integers(0, 8), st.integers(0, 12))


LOADS = st.tuples(st.integers(0, 8), st.integers(-3, 18), st.sampled_from([0, 1, 5, 210, 2100]))
"""The line that shows a run of entries, the offset of the run, and its words."""


MEMORY_ACTIONS = st.one_of(
    st.tuples(st.just("load"), LOADS),
    st.tuples(st.just("load"), LOADS),
    st.tuples(st.just("write entries"), LOADS),
    st.tuples(st.just("write words"), st.tuples(PLACES, words())),
    st.tuples(st.just("cursor"), st.tuples(PLACES, st.integers(0, 1), st.integers(0, 3))),
    st.tuples(st.just("draw on it"), st.integers(0, 8)),
)


VIEW_ACTIONS = st.one_of(
    st.tuples(st.just("origin"), PLACES),
    st.tuples(st.just("origin"), st.just((0, 0))),
    st.tuples(st.just("zoom"), st.sampled_from([1, 1, 2])),
    st.tuples(st.just("count from the bottom"), st.booleans()),
    st.tuples(st.just("shape"), st.integers(0, 255)),
    st.tuples(st.just("blink"), st.booleans()),
    st.tuples(st.just("scan out another"), st.none()),
)


SCANNED_OUT = st.sampled_from([True, True, False])
"""Whether a field is made after the action."""


STEPS = st.lists(st.tuples(MEMORY_ACTIONS, SCANNED_OUT), min_size=10, max_size=30) | st.lists(
    st.tuples(MEMORY_ACTIONS | VIEW_ACTIONS, SCANNED_OUT), min_size=10, max_size=30
)


KINDS: list[dict[str, Any]] = [
    {},
    {"visible_lines": 7, "visible_elements": 10},
    {"entry_format": EntryFormat.WORD_12},
    {"monochrome": True},
    {"planes": 8},
    {"planes": 12},
    {"timing": Timing()},
    {"lines": 150, "elements": 40},
]


def do(display: Ramtek9300, name: str, value: Any) -> None:
    """An action that may change the field."""
    if name in ("load", "write entries"):
        line, offset, count = value
        data = np.random.default_rng(display.lookup_table.written).integers(0, 0x10000, count)
        address = 200 * line + offset
        if name == "load":
            display.send(np.array([0x0300, address & 0x7FF, 2 * count, *data], np.uint16))
        else:
            first = max(0, address // 2)
            display.send(
                instructions.load_entries(first, np.stack([data[: 1024 - first] & 0xFF] * 3, axis=1))
            )
    elif name == "write words":
        (line, element), word = value
        word &= display.configuration.largest_word
        display.send(instructions.erase((element, line, element + 3, line), word))
    elif name == "origin":
        display.send(instructions.set_parameters(origin=value))
    elif name == "zoom":
        display.send(instructions.zoom(value))
    elif name == "count from the bottom":
        display.processor.parameters.origin_at_bottom = value
    elif name == "cursor":
        (line, element), number, look = value
        visible, blinking = look != 0, look == 3
        display.send(instructions.write_cursor(number, element, line, visible=visible, blinking=blinking))
    elif name == "shape":
        display.cursors.set_shape(0, np.full((32, 4), value, np.uint8))
    elif name == "blink":
        display.scan_out.blink_is_on = value


def steps(*actions: tuple[str, Any, bool]) -> list[tuple[tuple[str, Any], bool]]:
    return [((name, value), is_scanned_out) for name, value, is_scanned_out in actions]


LOAD = "load", (3, 0, 2), True


# Words written between two loads show the second load, and a view that came back shows the next load.
@example({}, steps(("write words", ((2, 3), 300), True), LOAD, ("write words", ((7, 3), 300), True), LOAD))
@example(
    {},
    steps(
        ("blink", True, True), ("origin", (0, 4), False), ("scan out another", None, False),
        ("origin", (0, 0), False), LOAD,
    ),
)  # fmt: skip
@given(st.sampled_from(KINDS), STEPS)
def test_an_updated_field_equals_a_whole_scan_out(
    kind: dict[str, Any], steps: list[tuple[tuple[str, Any], bool]]
) -> None:
    configuration = replace(SMALL, **kind)
    display = Ramtek9300(configuration)
    # No two lines show the same entries.
    words = np.arange(9)[:, np.newaxis] * 100 + np.arange(13) % 8
    display.send(instructions.write_image(words & configuration.largest_word))
    scan_out, last = display.scan_out, None
    updated, fresh = (np.zeros((scan_out.lines, scan_out.elements), np.uint32) for _ in range(2))
    for (name, value), is_scanned_out in steps:
        if name == "draw on it":
            updated[value % len(updated)], last = 0xABCDEF, None
        elif name == "scan out another":
            scan_out.scan_out_into(fresh)
        else:
            do(display, name, value)
        if is_scanned_out:
            before, outside = updated.copy(), np.ones(len(updated), np.bool_)
            last, changed = scan_out.scan_out_changes_into(updated, last)
            for first, end in changed:
                outside[first:end] = False
            assert last == scan_out.stamp
            fresh[...] = 0x123456
            scan_out.scan_out_into(fresh)
            assert (updated == fresh).all()
            assert (updated == before)[outside].all()


def test_after_a_load_only_lines_that_may_show_its_entries_are_written() -> None:
    display = Ramtek9300()
    display.send(instructions.write_image(np.repeat(np.arange(480), 640).reshape(480, 640)))
    pixels = np.zeros((480, 640), np.uint32)
    last, _ = display.scan_out.scan_out_changes_into(pixels, None)
    for blue in (1, 2):
        pixels[...] = 0
        display.send(instructions.load_entries(200, [[0, 0, blue]] * 3))
        last, _ = display.scan_out.scan_out_changes_into(pixels, last)
        assert pixels[200:203].tolist() == [[blue] * 640] * 3
        assert last == display.scan_out.stamp
    display.send(instructions.load_entries(700, [[0, 0, 5]]))
    pixels[...] = 7
    assert display.scan_out.scan_out_changes_into(pixels, last) == (display.scan_out.stamp, ())
    assert (pixels == 7).all()
    display.scan_out.scan_out_changes_into(pixels, None)
    assert set(pixels[:, 0].tolist()) == {0, 2}


def test_a_moving_cursor_scans_out_only_its_old_and_new_lines() -> None:
    display = Ramtek9300()
    display.send(instructions.write_cursor(0, 100, 100))
    pixels = np.zeros((480, 640), np.uint32)
    last, _ = display.scan_out.scan_out_changes_into(pixels, None)
    display.joystick.move_to(300, 200)
    pixels[...] = 7
    last, changed = display.scan_out.scan_out_changes_into(pixels, last)
    assert changed == ((85, 117), (185, 217))
    written = (pixels != 7).any(axis=1)
    assert np.flatnonzero(written).tolist() == [*range(85, 117), *range(185, 217)]
    display.send(instructions.write_cursor(0, 300, 200, visible=False))
    assert display.scan_out.scan_out_changes_into(pixels, last)[1] == ((185, 217),)
    display.send(instructions.erase((0, 0, 0, 0), 5))
    assert display.scan_out.scan_out_changes_into(pixels, last)[1] == ((0, 480),)


def test_a_black_and_white_monitor_sees_the_low_eight_bits() -> None:
    display = Ramtek9300(replace(PRINCETON_9300, monochrome=True))
    # The first table of cmap: the entry of a word is the word.
    display.send(sent_words([0x0300, 0, 2048, *range(1024)]))
    display.send(instructions.write_image(np.arange(1024).reshape(2, 512)))
    field = display.field()[:2, :512].reshape(-1, 3)
    assert (field == (np.arange(1024) & 0xFF)[:, np.newaxis]).all()
    wide = Ramtek9300(replace(GMR_9300, monochrome=True))
    wide.send(instructions.load_entries(0, [[10, 20, 30]]))
    assert wide.field()[0, 0].tolist() == [30, 30, 30]


@pytest.mark.parametrize("configuration", [JPL_9460, NCAR_9460])
def test_four_sections_of_the_table_are_picked_by_the_pointer(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    for section in range(4):
        color = [10 * section + 1, 10 * section + 2, 10 * section + 3]
        # Section s lies at word (s - 1) * 200h; 1024 bytes each.
        display.send(
            sent_words([0x2901, 0x0300, 0x200 * section, 1024, *([color[1] << 8 | color[2], color[0]] * 256)])
        )
    for section in (2, 0, 3, 1):
        display.send(sent_words([0x0300, 0x200 * section, 0]))
        color = [10 * section + 1, 10 * section + 2, 10 * section + 3]
        assert display.field()[5, 5].tolist() == color
        packed = color[0] << 16 | color[1] << 8 | color[2]
        assert display.scan_out.table().tolist() == [packed] * 256


def test_a_cursor_is_drawn_on_the_field_and_not_in_the_memory() -> None:
    display = colored(Ramtek9300())
    plain = display.field()
    stamp = display.scan_out.stamp
    display.send(sent_words([0x1600, 300, 0x400 | 200]))
    assert display.scan_out.stamp != stamp
    assert not display.words.any()
    field = display.field()
    changed = (field != plain).any(axis=2)
    assert (changed[185:217, 285:317] == cross()).all()
    assert np.count_nonzero(changed) == np.count_nonzero(cross())
    assert (field[changed] == 255).all()
    display.send(sent_words([0x1600, 300, 200]))
    assert (display.field() == plain).all()


def test_a_cursor_is_dark_on_a_light_picture_and_clipped_at_the_edges() -> None:
    display = Ramtek9300()
    display.send(instructions.load_entries(0, [[250, 250, 250]]))
    for element, line in ((0, 0), (639, 479), (1023, 1023), (646, 100)):
        display.send(sent_words([0x1600, element, 0x400 | line]))
        field = display.field()
        assert set(np.unique(field)) <= {0, 250}
    display.send(sent_words([0x1600, 0, 0x400]))
    assert np.count_nonzero(display.field()[..., 0] == 0) == 12


TIMED = replace(FAMILY, timing=Timing())


def colors(display: Ramtek9300) -> list[int]:
    """The red component by lines; all pixels of a line must be equal."""
    field = display.field()
    assert (field == field[:, :1]).all()
    reds: list[int] = field[:, 0, 0].tolist()
    return reds


def entry(red: int) -> NDArray[np.uint16]:
    return instructions.load_entries(0, [[red, 0, 0]])


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
    # A field later, all lines show the last load.
    display.send(sent_words([0x2A00, 100]))
    assert colors(display) == [17] * 480


def test_words_written_behind_the_beam_wait_for_the_next_field() -> None:
    display = Ramtek9300(TIMED)
    display.send(instructions.load_entries(0, [[0, 0, 0], [200, 0, 0]]))
    display.send(sent_words([0x2A00, 240]))
    display.send(instructions.erase((0, 200, 1, 299), 1))
    assert display.field()[:, 0, 0].tolist() == [0] * 240 + [200] * 60 + [0] * 180
    display.send(sent_words([0x2901]))
    assert display.field()[:, 0, 0].tolist() == [0] * 200 + [200] * 100 + [0] * 180


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
    # Making a field takes no time.
    assert (whole.field() == cut.field()).all()


def test_visible_cursors_have_marks() -> None:
    display = Ramtek9300("NCAR_9460")
    cursors, scan_out = display.cursors, display.scan_out
    cursors.place(0, 5, 6, 0)
    cursors.place(1, 7, 8, VISIBLE)
    cursors.place(3, 9, 10, VISIBLE | BLINK)
    assert list(scan_out.stamp.marks) == [Mark(1, 7, 8, 0), Mark(3, 9, 10, 0)]
    scan_out.blink_is_on = False
    assert list(scan_out.stamp.marks) == [Mark(1, 7, 8, 0)]
    cursors.set_shape(2, np.zeros((1, 4), np.uint8))
    assert list(scan_out.stamp.marks) == [Mark(1, 7, 8, 1)]


@pytest.mark.parametrize(("element", "line"), [(20, 50), (0, 0), (39, 99), (60, 50), (20, 130)])
def test_a_mark_is_the_shape_in_black_or_white_on_its_lines(element: int, line: int) -> None:
    mark, shape = Mark(0, element, line, 0), cross()
    pixels = np.zeros((100, 40), np.uint32)
    pixels[:, ::2] = 0xFFFFFF
    before = pixels.copy()
    for first, end in ((0, 40), (40, 55), (55, 100)):
        draw(pixels[first:end], mark, shape, first)
    for y, x in np.ndindex(100, 40):
        row, column = y - line + 15, x - element + 15
        is_dot = 0 <= row < 32 and 0 <= column < 32 and shape[row, column]
        assert pixels[y, x] == (before[y, x] ^ 0xFFFFFF if is_dot else before[y, x])
    changed = np.flatnonzero((pixels != before).any(axis=1)).tolist()
    assert set(changed) <= set(range(*mark.lines))


@given(st.integers(0, 2**32 - 1), st.integers(0, 1023), st.integers(1, 12) | st.integers(1, 1024))
def test_the_lines_that_show_a_run_of_entries_are_found(seed: int, first: int, count: int) -> None:
    raster = np.random.default_rng(seed).integers(0, 1024, (60, 5), np.uint16)
    end = min(first + count, 1024)
    top, bottom = lines_with(raster, first, end)
    showing = [line for line, words in enumerate(raster.tolist()) if any(first <= w < end for w in words)]
    assert (top, bottom) == ((showing[0], showing[-1] + 1) if showing else (0, 0))


@pytest.mark.parametrize("timing", [None, Timing()])
def test_a_table_of_grays_shows_words_whose_entries_are_black(timing: Timing | None) -> None:
    display = Ramtek9300(replace(GMR_9300, timing=timing))
    assert not display.scan_out.is_dark
    display.send(instructions.write_image(np.arange(1024, dtype=np.uint16).reshape(32, 32)))
    assert display.scan_out.is_dark
    stamps = set()
    for name, some in (("gray", {1: 64, 512: 160, 1023: 255}), ("gray8", {255: 255, 256: 0, 513: 1})):
        display.scan_out.shown_table = name
        stamps.add(display.scan_out.stamp)
        assert not display.scan_out.is_dark
        words = display.field()[:32, :32].reshape(-1, 3)
        assert not words[0].any()
        assert all(words[word].tolist() == [gray] * 3 for word, gray in some.items())
    # The beam paints the monitor image in the colors of the display.
    display.send(instructions.erase())
    for _ in display.scan_out.follow_beam():
        pass
    assert not display.scan_out.state()["monitor_image"].any()
    display.scan_out.shown_table = ""
    assert len({*stamps, display.scan_out.stamp}) == 3
    assert not display.field().any()


def test_a_picture_with_a_lit_pixel_is_not_dark() -> None:
    display = Ramtek9300()
    display.send(instructions.write_image(np.array([[1, 2]], np.uint16)))
    display.send(instructions.load_entries(3, [[255, 255, 255]]))
    assert display.scan_out.is_dark
    display.send(instructions.load_entries(2, [[0, 0, 1]]))
    assert not display.scan_out.is_dark


def test_the_only_word_of_a_plane_is_white() -> None:
    assert gray_table("gray", 2).tolist() == [0, 0xFFFFFF]
    assert gray_table("gray", 1024)[[1, 2, 1023]].tolist() == [0x404040, 0x404040, 0xFFFFFF]
