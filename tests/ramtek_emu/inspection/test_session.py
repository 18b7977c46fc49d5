"""Sessions without a window: of streams, and of running displays whose hosts can be stopped."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.inspection import panels
from ramtek_emu.inspection import session as module
from ramtek_emu.inspection.histories import EntryRange, finished, history_of, next_change
from ramtek_emu.inspection.listing import moved
from ramtek_emu.inspection.session import inspection_of, memory_window, parameter_texts
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.testing import streams
from tests.ramtek_emu.inspection.replays import moments, replay_of, states_every
from tests.ramtek_emu.inspection.sessions import Served, Steps, at_rest, session_of, text_of
from tests.ramtek_emu.strategies import SMALL, cuts
from tests.small import BOXES_STREAM

STEPS = st.one_of(
    st.tuples(st.just("go"), st.integers(-2, 70)),
    st.tuples(st.just("step"), st.integers(-12, 12)),
    st.tuples(st.just("next_change"), st.booleans()),
    st.tuples(st.just("select"), st.builds(Window, st.just(3), st.just(2), st.integers(3, 12), st.just(8))),
    st.tuples(st.just("select"), st.builds(Window, st.just(3), st.just(2), st.just(3), st.just(2))),
    st.tuples(st.just("select"), st.builds(lambda n: EntryRange(n, n + 1), st.integers(0, 1023))),
    st.tuples(st.just("click"), st.just("history"), st.integers(0, 3)),
    st.tuples(st.just("click"), st.just("listing"), st.integers(0, 30)),
)


@example(words=[0x0400, 0, 0x0300], steps=[("go", 1)], width=50)
@given(words=streams(), steps=st.lists(STEPS, max_size=12), width=st.integers(50, 90))
def test_after_any_steps_display_and_panels_are_of_that_instruction(
    words: list[int], steps: list[tuple[str, object]], width: int
) -> None:
    session = at_rest(Steps(inspection_of(replay_of(words))))
    expected = moments(session.replay)
    listed = list(items([np.array(words, "<u2").tobytes()], SMALL))
    for name, *values in steps:
        getattr(session, name)(*values)
        at_rest(session)
        number = session.state.number
        assert session.state.target == number
        assert snapshot_bytes(session.display) == expected[number][0]
        texts = [text_of(line) for line in panels.words_of_the_instruction(session.state, 1000, width)]
        assert all(len(text) <= width for text in texts)
        reply = expected[number][1]
        assert any(text.startswith("reply") for text in texts) == bool(len(reply))
        if number:
            lines = " ".join(listed[number - 1].lines()).split()
            assert " ".join(texts).split()[: len(lines)] == lines
        marked = [text_of(line) for line in panels.listing(session.state) if text_of(line).startswith(">")]
        assert all(int(text[1:].split()[0]) == number for text in marked)
        values_shown = [text_of(line[1:]).strip("* ") for line in panels.parameters(session.state)]
        fresh = parameter_texts(session.display)
        assert values_shown[: len(fresh)] == list(fresh.values())


@given(words=streams(), places=st.lists(st.integers(0, 60), min_size=1, max_size=4))
def test_the_histories_and_the_next_change_are_those_of_the_stream(
    words: list[int], places: list[int]
) -> None:
    with states_every(0):
        session = at_rest(Steps(inspection_of(replay_of(words))))
        for place in places:
            session.go(place)
            line, element = place % 9, place % 13
            session.select(Window(element, line, element, line))
            at_rest(session)
            number = session.state.number
            history = finished(history_of(session.replay, Window(element, line, element, line), number))
            assert session.state.writes == tuple(history)
            change = finished(next_change(session.replay, Window(element, line, element, line), number))
            session.next_change()
            assert at_rest(session).state.number == (number if change is None else change)
            session.select(EntryRange(place, place + 1))
            at_rest(session)
            loads = finished(history_of(session.replay, EntryRange(place, place + 1), session.state.number))
            assert session.state.writes == tuple(loads)


def test_the_history_of_a_pixel_leads_through_the_stream() -> None:
    session = session_of(*BOXES_STREAM)
    session.go(5)
    session.select(Window(4, 4, 4, 4))
    assert [text_of(line).split()[:4] for line in panels.history(at_rest(session).state)] == [
        ["4", "0007", "to", "0005"],
        ["3", "0005", "to", "0007"],
        ["1", "0000", "to", "0005"],
    ]
    session.click("history", 0)
    assert session.state.number == 4


def test_the_history_of_an_entry_shows_its_colors() -> None:
    session = session_of(*BOXES_STREAM)
    session.go(5)
    session.select(EntryRange(5, 6))
    assert [text_of(line).strip(">").split()[:4] for line in panels.history(at_rest(session).state)] == [
        ["5", "#0A141E", "to", "#28323C"],
        ["2", "#000000", "to", "#0A141E"],
    ]
    session.go(2)
    for _ in range(2):
        session.next_change()
        assert at_rest(session).state.number == 5
    assert session.state.message == "no change of entry 5 after instruction 5"


def test_the_next_change_of_a_rectangle_skips_writes_of_the_same_words() -> None:
    session = session_of(*BOXES_STREAM)
    session.select(Window(8, 4, 9, 6))
    session.go(1)
    session.next_change()
    assert at_rest(session).state.message == "no change of rectangle 8,4..9,6 after instruction 1"
    session.select(Window(2, 2, 2, 2))
    session.next_change()
    assert at_rest(session).state.number == 3


def test_a_text_of_the_listing_is_found_forward_and_back() -> None:
    session = session_of(*BOXES_STREAM)
    session.ask("ers")
    numbers = []
    for back in (False, False, False, False, True, True, True):
        session.enter(back)
        numbers.append(at_rest(session).state.number)
    assert numbers == [1, 3, 4, 4, 3, 1, 1]
    assert session.state.message == "no ers before instruction 1"
    for text, number in (("ERS BACK=7", 3), ("ERS WIN=", 4), ("LAM", 5), ("BACK=", 5), ("WI WIN=", 5)):
        session.ask(text)
        session.enter()
        assert at_rest(session).state.number == number, text


def test_a_text_is_found_in_the_whole_listing_of_an_instruction() -> None:
    session = session_of(instructions.write_image(np.arange(117).reshape(9, 13)))
    session.ask("0073 0074")
    session.enter()
    assert at_rest(session).state.number == 1


def test_equal_polls_are_a_single_row() -> None:
    poll, other = instructions.read_cursor(0), instructions.read_cursor(1)
    image = [0x0E01, 4 * len(poll), *np.tile(poll, 2)]
    session = session_of(image, np.tile(poll, 700), other, BOXES_STREAM[0], BOXES_STREAM[0])
    for number, marked in (
        (0, "0 the start"),
        (2, "2 RCSS x 700"),
        (600, "600 RCSS x 700"),
        (702, "702 RCSS #1"),
    ):
        session.go(number)
        at_rest(session)
        rows = [" ".join(text_of(line).split()) for line in panels.listing(session.state)]
        assert len(rows) == 6
        assert next(row for row in rows if row.startswith(">")).strip("> ").startswith(marked)
    session.click("listing", 2)
    assert session.state.number == 2
    stream = session.replay.stream
    assert [moved(stream, *steps) for steps in ((0, 2), (2, 1), (500, 2), (704, -2), (703, -2))] == [
        2, 702, 703, 702, 2,
    ]  # fmt: skip


@given(words=streams(), number=st.integers(1, 60))
def test_the_words_that_an_instruction_writes_are_noted(words: list[int], number: int) -> None:
    session = at_rest(Steps(inspection_of(replay_of(words))))
    session.go(number)
    at_rest(session)
    number = session.state.number
    for line, element in ((0, 0), (3, 5), (8, 12)):
        writes = finished(history_of(session.replay, Window(element, line, element, line), number))
        written = session.replay.written
        is_written = written is not None and bool(written[line, element])
        assert is_written == (number in [write.number for write in writes])


@given(words=streams(), number=st.integers(1, 60))
def test_the_change_before_is_the_last_of_all_changes_until_then(words: list[int], number: int) -> None:
    with states_every(0):
        session = at_rest(Steps(inspection_of(replay_of(words))))
    window, changes, last = Window(2, 2, 5, 5), [], 0
    while (change := finished(next_change(session.replay, window, last))) is not None:
        changes.append(last := change)
    session.go(number)
    number = at_rest(session).state.number
    session.select(window)
    session.next_change(True)
    assert at_rest(session).state.number == max([c for c in changes if c < number], default=number)


def test_a_typed_number_is_gone_to() -> None:
    session = session_of(*BOXES_STREAM)
    session.ask("3")
    assert text_of(panels.status(session.state)) == "go to, or find with (Shift+) Enter: 3_  "
    session.enter()
    assert session.state.number == 3


def test_escape_leaves_what_was_begun_last() -> None:
    session = session_of(*BOXES_STREAM)
    session.select(Window(1, 1, 2, 2))
    session.turn_to("entries")
    session.ask()
    left = []
    for _ in range(3):
        session.escape()
        left.append((session.state.typed, session.state.page, session.state.selection is None))
    assert left == [(None, "entries", False), (None, "", False), (None, "", True)]


@pytest.fixture
def far(monkeypatch: pytest.MonkeyPatch) -> Steps:
    """A session that goes to instruction 100, and whose ticks do as little as they can."""
    monkeypatch.setattr(module, "PIECE_SECONDS", 0.0)
    session = Steps(inspection_of(replay_of(np.tile(instructions.erase((0, 0, 3, 3), 5), 100).tolist())))
    session.go(100)
    assert (session.state.number, session.state.target) == (0, 100)
    return session


def test_a_far_instruction_is_gone_to_when_states_are_prepared(far: Steps) -> None:
    assert text_of(panels.status(far.state)).startswith("preparing")
    ticks = 0
    while far.is_busy:
        far.tick()
        ticks += 1
    assert far.state.number == 100
    assert ticks > 10
    assert far.display.words[3, 3] == 5


def test_a_click_before_the_states_are_prepared_asks_about_the_instruction_to_come(
    far: Steps,
) -> None:
    far.select(Window(1, 1, 1, 1))
    assert (far.state.number, far.state.writes) == (0, None)
    assert len(at_rest(far).state.writes or ()) == far.state.number == 100


def test_escape_before_the_states_are_prepared_lists_the_instruction_that_is_shown(
    far: Steps,
) -> None:
    assert module.shown_rows(far.state)[0].start > 0
    far.escape()
    assert (far.state.number, far.state.target, module.shown_rows(far.state)[0].start) == (0, 0, 0)


def test_stepping_needs_no_prepared_states() -> None:
    session = Steps(inspection_of(replay_of(np.concatenate(BOXES_STREAM).tolist())))
    session.step(1)
    assert (session.state.number, session.replay.prepared) == (1, 0)


def test_a_rectangle_of_the_screen_is_one_of_the_memory() -> None:
    session = session_of(*BOXES_STREAM)
    places = Point(5, 4), Point(2, 1)
    assert memory_window(session.display, *places) == (2, 1, 5, 4)
    session.display.send(np.concatenate((instructions.set_parameters(origin=(3, 2)), instructions.zoom(2))))
    assert memory_window(session.display, *places) == (4, 2, 5, 4)
    # Half a word at the right edge of the screen is a word.
    assert memory_window(session.display, Point(12, 0), Point(3, 8)) == (4, 2, 9, 6)
    session.display.processor.parameters.origin_at_bottom = True
    # The screen has nine lines: lines 1 to 4 are 7 to 4 from the bottom.
    assert memory_window(session.display, *places) == (4, 4, 5, 5)


def test_lists_show_the_rows_around_the_current_instruction() -> None:
    session = session_of(np.tile(instructions.erase((0, 0, 3, 3), 5), 8))
    session.state = replace(session.state, listing_rows=6, history_rows=5)
    session.go(8)
    session.select(Window(1, 1, 1, 1))
    at_rest(session)
    seen = []
    for number in (8, 6, 5, 3, 0):
        session.go(number)
        listed = [int(text_of(line)[1:].split()[0]) for line in panels.listing(session.state)]
        history = [int(text_of(line)[1:].split()[0]) for line in panels.history(session.state)]
        assert (len(listed), len(history)) == (6, 5)
        seen.append((listed[0], history[0]))
    assert seen == [(3, 8), (3, 7), (3, 6), (1, 5), (0, 5)]
    # The rows that are clicked are those that are seen; a row below the last is none.
    numbers = []
    for panel, row in (("history", 4), ("listing", 6), ("listing", 2)):
        session.click(panel, row)
        numbers.append(session.state.number)
    assert numbers == [1, 1, 2]


# Running displays.


@given(
    words=streams(),
    places=st.lists(st.integers(0, 60), max_size=3),
    actions=st.lists(st.sampled_from(["pause", "go_on", "on", "back", "tick"]), max_size=12),
)
@example(words=[0xFFFF] * 4, places=[1, 2], actions=[])
def test_a_paused_display_executes_nothing_and_all_of_it_in_the_end(
    words: list[int], places: list[int], actions: list[str]
) -> None:
    served = Served(Ramtek9300(SMALL))
    session, sent = served.inspection, 0
    stream = session.replay.stream
    for piece in cuts(words, places):
        served.send(piece)
        sent += len(piece)
        expected = moments(replay_of(words[:sent]))
        for action in actions:
            is_paused, done = not session.state.is_following, len(stream.words)
            if action in ("on", "back"):
                session.step(1 if action == "on" else -1)
            else:
                getattr(session, action)()
            assert session.state.is_following or len(stream.words) == done or not is_paused
            number = session.state.number
            if not session.state.is_following and (
                number < len(stream) or not served.host_session.unexecuted
            ):
                assert snapshot_of_whole(session) == expected[number][0]
        session.go_on()
        served.execute()
        session.pause()
        for number in {len(expected) - 1, max(0, len(expected) - 2)}:
            session.go(number)
            assert snapshot_of_whole(session) == expected[number][0]
            assert snapshot_bytes(session.replay.display) == expected[number][0]
    expected = moments(replay_of(words))
    assert len(stream) == len(expected) - 1
    assert served.replies == b"".join(reply.astype("<u2").tobytes() for _, reply in expected)


def snapshot_of_whole(session: Steps) -> bytes:
    """The snapshot of the display, without the words of an incomplete instruction and their count."""
    display = copy.deepcopy(session.display)
    display.decoder.clear()
    display.words_received = int(session.replay.stream.ends[session.state.number])
    return snapshot_bytes(display)
