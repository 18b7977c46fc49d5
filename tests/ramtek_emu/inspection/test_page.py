"""The page of a session: its layout, its drawing and the places of the mouse on it."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import instructions
from ramtek_emu.configuration import CONFIGURATIONS
from ramtek_emu.inspection import panels
from ramtek_emu.inspection.histories import EntryRange
from ramtek_emu.inspection.page import EDGE, InspectorPage, PageLayout, layout_of
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.session import inspection_of, selection_text, tell, turn_to
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.memory.cursors import BLINK, VISIBLE
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.monitor.boxes import ADVANCE, BLACK, WHITE, PageBox
from ramtek_emu.monitor.pattern import pattern
from ramtek_emu.testing import streams
from tests.ramtek_emu.inspection.sessions import Steps, at_rest, session_of, text_of

BUTTONS = ("<", ">", "entries")


def page_of(session: Steps) -> InspectorPage:
    sizes = session.display.configuration
    layout = layout_of(sizes.shown_elements, sizes.shown_lines, sizes.cursors, BUTTONS)
    listing, history = (layout.boxes[name].rows - 1 for name in ("listing", "history"))
    session.state = replace(session.state, listing_rows=listing, history_rows=history)
    return InspectorPage(session.state, layout, BUTTONS, [("Esc", "back")], "a page")


def boxes_of(layout: PageLayout) -> dict[str, PageBox]:
    buttons = {f"button {number}": box for number, box in enumerate(layout.buttons)}
    return {"stage": layout.stage, **layout.boxes, **buttons, "bar": layout.bar}


def region(box: PageBox) -> Window:
    return Window(box.left, box.top, box.left + box.width - 1, box.top + box.height - 1)


def is_within(inner: PageBox, outer: PageBox) -> bool:
    return region(inner).intersection(region(outer)) == region(inner)


@functools.cache
def patterned(name: str) -> Steps:
    """A session at the end of the test pattern, whose state tests put back."""
    session = session_of(pattern(CONFIGURATIONS[name]), configuration=CONFIGURATIONS[name])
    session.go(session.state.length)
    return session


@given(elements=st.integers(1, 4096), lines=st.integers(1, 4096), cursors=st.integers(0, 8))
def test_no_part_of_a_page_covers_another(elements: int, lines: int, cursors: int) -> None:
    layout = layout_of(elements, lines, cursors, BUTTONS)
    boxes = boxes_of(layout)
    whole = PageBox(0, 0, layout.elements, layout.lines)
    assert [name for name, box in boxes.items() if not is_within(box, whole)] == []
    pairs = itertools.combinations(boxes.items(), 2)
    meet = [(a, b) for (a, one), (b, other) in pairs if not region(one).intersection(region(other)).is_empty]
    assert meet == []
    assert is_within(layout.field, layout.stage)
    assert layout.field[2:] == (elements * layout.zoom, lines * layout.zoom)
    assert boxes["listing"].rows >= 8
    assert boxes["history"].rows >= 4


@pytest.mark.parametrize(
    ("name", "most"), [("GMR_9300", (1216, 720)), ("NCAR_9460", (1920, 1080)), ("JPL_9460", (1216, 724))]
)
def test_a_page_fits_on_usual_screens(name: str, most: tuple[int, int]) -> None:
    sizes = CONFIGURATIONS[name]
    layout = layout_of(sizes.shown_elements, sizes.shown_lines, sizes.cursors, BUTTONS)
    assert layout.elements <= most[0]
    assert layout.lines <= most[1]


ACTIONS: st.SearchStrategy[Callable[[Steps], object]] = st.one_of(
    st.integers(0, 60).map(lambda number: lambda session: session.go(number)),
    st.sampled_from(["entries", "help"]).map(lambda page: lambda session: session.turn_to(page)),
    st.builds(
        lambda e, n, w: lambda session: session.select(Window(e, n, min(12, e + w), min(8, n + w))),
        st.integers(0, 12),
        st.integers(0, 8),
        st.integers(0, 4),
    ),
    st.integers(0, 900).map(lambda n: lambda session: session.select(EntryRange(n, n + 1 + n % 3))),
    st.just(lambda session: session.select(None)),
    st.just(lambda session: session.ask("WI")),
)


@given(words=streams(), actions=st.lists(ACTIONS, max_size=10))
def test_what_changes_is_drawn_as_the_whole_page_is(
    words: list[int], actions: list[Callable[[Steps], object]]
) -> None:
    session = session_of(words)
    page = page_of(session)
    shown = np.zeros((page.lines, page.elements), np.uint32)
    stamp = None
    for action in actions:
        action(session)
        at_rest(session)
        page.session = session.state
        before = shown.copy()
        stamp, runs = page.scan_out_changes_into(shown, stamp)
        assert stamp == page.stamp
        fresh = InspectorPage(session.state, page.layout, BUTTONS, [("Esc", "back")], "a page")
        whole = np.zeros_like(shown)
        fresh.scan_out_changes_into(whole, None)
        assert np.array_equal(shown, whole)
        unchanged = np.ones(len(shown), np.bool_)
        for first, end in runs:
            unchanged[first:end] = False
        assert np.array_equal(shown[unchanged], before[unchanged])
        assert page.scan_out_changes_into(shown, stamp) == (stamp, ())


def test_a_message_and_the_pointer_change_only_their_lines() -> None:
    session = session_of(pattern(), configuration=CONFIGURATIONS["GMR_9300"])
    page = page_of(session)
    shown = np.zeros((page.lines, page.elements), np.uint32)
    stamp, _ = page.scan_out_changes_into(shown, None)
    for state, name in (
        (tell(session.state, "a message"), "status"),
        (replace(tell(session.state, "a message"), pointed=Point(5, 5)), "pixels"),
    ):
        page.session = state
        box = page.layout.boxes[name]
        stamp, ((first, end),) = page.scan_out_changes_into(shown, stamp)
        assert box.top <= first < end <= box.top + box.height


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_the_longest_texts_of_cursors_pixels_and_messages_are_not_cut(name: str) -> None:
    session = session_of(configuration=CONFIGURATIONS[name])
    sizes = session.display.configuration
    for cursor in session.display.cursors.all:
        cursor.element, cursor.line, cursor.enter = sizes.elements - 1, sizes.lines - 1, True
        cursor.state = VISIBLE | BLINK
    session.display.cursors.track = True
    boxes = page_of(session).layout.boxes
    cursors = [text_of(line) for line in panels.cursors(session.state)]
    assert max(map(len, cursors)) <= boxes["cursors"].width // ADVANCE
    assert len(cursors) == boxes["cursors"].rows
    parameters = session.display.processor.parameters
    parameters.origin = Point(sizes.elements - 1, sizes.lines - 1)
    session.display.send(instructions.erase(word=sizes.largest_word))
    session.state = replace(session.state, pointed=Point(0, 0))
    last = Window(sizes.elements - 1, sizes.lines - 1, sizes.elements - 1, sizes.lines - 1)
    session.select(last)
    pixels = [text_of(line) for line in panels.pixels(session.state)]
    assert max(map(len, pixels)) <= boxes["pixels"].width // ADVANCE
    assert [pixel.split()[0] for pixel in pixels] == ["pointer", "selected", "screen"]
    assert len(pixels) == boxes["pixels"].rows
    whole = Window(sizes.elements - 100, sizes.lines - 100, sizes.elements - 1, sizes.lines - 1)
    session.select(whole)
    message = f"waiting for the host: a change of {selection_text(whole)} ... Esc stops"
    assert len(message) <= boxes["status"].width // ADVANCE


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_the_field_is_shown_at_a_whole_multiple(name: str) -> None:
    session = patterned(name)
    page = page_of(session)
    left, top, width, height = page.layout.field
    field = session.display.field()
    zoom = page.layout.zoom
    expected = field.repeat(zoom, axis=0).repeat(zoom, axis=1)
    page.blink_is_on = False
    page.draw()
    page.blink_is_on = True
    assert np.array_equal(page.colors()[top : top + height, left : left + width], expected)
    assert np.array_equal(page.field(), field)


def test_the_places_of_the_mouse_are_those_that_are_seen() -> None:
    session = session_of(pattern(), configuration=CONFIGURATIONS["GMR_9300"])
    page = page_of(session)
    for number, button in enumerate(page.layout.buttons):
        ends = Point(button.left, button.top), Point(button.left + button.width - 1, button.top + 14)
        assert [page.panel_at(place) for place in ends] == [("button", number)] * 2
        assert page.panel_at(Point(button.left + button.width, button.top)) == ("", 0)
    for name in ("listing", "history"):
        box = page.layout.boxes[name]
        for element in (box.left, box.left + box.width - 1):
            rows = [page.panel_at(Point(element, box.top + line))[1] for line in (0, 10, 11, 21, 22)]
            assert rows == [-1, -1, 0, 0, 1]
            assert page.panel_at(Point(element, box.top + box.height - 1)) == (name, box.rows - 2)
        assert page.panel_at(Point(box.left + box.width, box.top)) == ("", 0)
        assert page.panel_at(Point(box.left, box.top + box.height)) == ("", 0)
    assert page.panel_at(Point(643, 483)) == ("stage", 0)
    last = Point(page.elements - 1, page.lines - 1)
    assert page.panel_at(Point(644, 483)) == page.panel_at(last) == ("", 0)
    bar = page.layout.bar
    assert [page.panel_at(Point(100, bar.top + line))[0] for line in (-1, 0, 12, 13)] == [
        "",
        "bar",
        "bar",
        "",
    ]
    # Outside the field, the nearest place of the screen.
    assert page.field_place(Point(-5, 700)) == (0, 479)
    assert page.field_place(Point(641, 2)) == page.field_place(Point(642, -1)) == (639, 0)
    small = page_of(session_of())
    left, top, width, height = small.layout.field
    last = Point(left + width - 1, top + height - 1)
    assert small.field_place(last) == small.field_place(Point(last.element + 1, last.line + 1)) == (12, 8)
    assert small.field_place(Point(left + width - small.layout.zoom - 1, top)) == (11, 0)
    for number in range(session.state.length + 1):
        assert page.number_at(page.layout.bar.left + page.bar_place(number)) == number


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_every_entry_has_its_cell(name: str) -> None:
    session = patterned(name)
    page = page_of(session)
    page.session = turn_to(session.state, "entries")
    scan_out = session.display.scan_out
    shown = np.zeros((page.lines, page.elements), np.uint32)
    page.scan_out_changes_into(shown, None)
    words = set()
    for line in range(EDGE, page.layout.stage.height - EDGE, 5):
        for element in range(EDGE, page.layout.stage.width - EDGE, 5):
            entry = page.entry_at(Point(element, line))
            if entry is not None:
                words.add(word := entry.first - scan_out.first_entry)
                assert shown[line, element] == scan_out.table()[word]
    assert len(words) == len(scan_out.table())


def test_rings_are_around_the_pixels_that_an_instruction_writes() -> None:
    box = instructions.erase((100, 50, 109, 59), 5)
    replay = Replay(Stream(words=np.concatenate((box, box))))
    replay.go_to(2)
    session = Steps(inspection_of(replay))
    page = page_of(session)
    page.blink_is_on = False
    colors = page.colors().astype(int).sum(axis=2)[:, :, np.newaxis]
    left, top = 100 + EDGE, 50 + EDGE
    rings = [
        colors[top - distance : top + 10 + distance, left - distance : left + 10 + distance]
        for distance in (1, 2)
    ]
    for ring, color in zip(rings, (BLACK, WHITE), strict=True):
        parts = ring[0], ring[-1], ring[:, 0], ring[:, -1]
        assert {int(value) for part in parts for value in part.ravel()} == {sum(color.to_bytes(3, "big"))}
    page.blink_is_on = True
    field = page.colors()[EDGE : 480 + EDGE, EDGE : 640 + EDGE]
    assert np.array_equal(field, session.display.field())
