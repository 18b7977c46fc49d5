from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, PRINCETON_9300, Configuration, Ramtek9300, Timing, instructions
from ramtek_emu.inspection.differences import first_difference, first_different_instruction
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.states import Packer, size_of
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.disassembler import items
from ramtek_emu.memory.frame_buffer import WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Window
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.testing import streams
from tests.ramtek_emu.inspection.replays import moments, prepare, replay_of, states_every
from tests.ramtek_emu.strategies import SMALL, cuts, masks, scan_codes, windows

TIMED = Configuration(name="TIMED", elements=13, lines=9, planes=10, timing=Timing())


@pytest.mark.parametrize("configuration", [SMALL, TIMED])
@given(
    words=streams(),
    numbers=st.lists(st.integers(0, 60), min_size=1, max_size=8),
    most_bytes=st.sampled_from([0, 1 << 30]),
    is_prepared=st.booleans(),
)
def test_any_moment_equals_a_fresh_display(
    configuration: Configuration, words: list[int], numbers: list[int], most_bytes: int, is_prepared: bool
) -> None:
    with states_every(0, most_bytes):
        replay = replay_of(words, configuration)
        if is_prepared:
            prepare(replay)
            assert replay.prepared == len(replay.stream)
        expected = moments(replay)
        for number in numbers:
            number %= len(replay.stream) + 1
            replay.go_to(number)
            snapshot, reply = expected[number]
            assert replay.number == number
            assert snapshot_bytes(replay.display) == snapshot
            assert replay.reply.tolist() == reply.tolist()


def test_states_stay_within_their_bytes_and_the_first_and_last_stay() -> None:
    words = np.concatenate(
        [instructions.write_image(np.random.default_rng(n).integers(0, 1024, (9, 13))) for n in range(40)]
    )
    with states_every(0, most_bytes=20_000):
        replay = replay_of(words.tolist())
        prepare(replay)
        assert replay.state_bytes <= 20_000
    assert [replay.state_before(0).number, replay.prepared] == [0, len(replay.stream)]


@given(st.lists(st.tuples(streams(), st.booleans(), st.booleans()), max_size=6), st.sampled_from([0, 1e9]))
def test_a_running_display_is_noted_with_what_moved_beside_its_instructions(
    rounds: list[tuple[list[int], bool, bool]], seconds: float
) -> None:
    display = Ramtek9300(SMALL)
    with states_every(seconds):
        replay = Replay(Stream(SMALL), display)
        expected = {0: snapshot_bytes(display)}
        pending = np.zeros(0, np.uint16)
        for words, moves, resets in rounds:
            # The words of an instruction that is not complete yet arrive, and replies wait.
            display.send(np.array(words, np.uint16))
            pending = np.concatenate((pending, np.array(words, np.uint16)))
            whole = Stream(SMALL, pending)
            sent, pending = np.split(pending, whole.ends[-1:])
            last, end = len(replay.stream), replay.stream.ends[-1]
            replay.append(sent)
            replay.note(display)
            if replay.stream.ends[last] != end:
                # A row of illegal words has grown.
                del expected[last]
            expected[len(replay.stream)] = snapshot_bytes(display)
            if moves:
                display.joystick.move_to(len(sent) % 13, 3)
                display.joystick.press_enter()
                replay.note(display, has_moved=True)
                expected[len(replay.stream)] = snapshot_bytes(display)
            if resets:
                display.reset()
                pending = np.zeros(0, np.uint16)
                replay.append(instructions.reset())
                replay.note(display, has_moved=True)
                expected[len(replay.stream)] = snapshot_bytes(display)
    for number in reversed(expected):
        replay.go_to(number)
        assert snapshot_bytes(replay.display) == expected[number]


def test_a_replay_goes_on_from_the_display_that_is_given_and_leaves_it_alone() -> None:
    start = Ramtek9300(SMALL)
    words = instructions.erase((5, 5, 6, 6), 9)
    start.send(instructions.erase((0, 0, 3, 3), 5))
    # The first words of the first instruction have come.
    start.send(words[:3])
    before = snapshot_bytes(start)
    replay = Replay(Stream(SMALL, words), start)
    prepare(replay)
    replay.stream.append(instructions.erase((7, 5, 8, 6), 4))
    prepare(replay)
    assert replay.prepared == 2
    counts = []
    for number in (2, 1, 0):
        replay.go_to(number)
        counts.append(np.bincount(replay.display.words.ravel(), minlength=10)[[4, 5, 9]].tolist())
        # What is done to the display is not done to the states.
        replay.display.frame_buffer.fill(replay.display.frame_buffer.window, 1)
    assert counts == [[4, 16, 4], [0, 16, 4], [0, 16, 0]]
    assert snapshot_bytes(start) == before


@pytest.mark.parametrize("configuration", [FAMILY, PRINCETON_9300])
@given(words=streams(), places=st.lists(st.integers(0, 60), max_size=5))
def test_instructions_are_counted_as_the_listing_shows_them(
    configuration: Configuration, words: list[int], places: list[int]
) -> None:
    stream = Stream(configuration)
    for part in cuts(words, places):
        stream.append(part)
    data = np.array(words, "<u2").tobytes()
    listed = [item for item in items([data], configuration) if "the stream ends" not in item.note]
    assert len(stream) == len(listed)
    for number, item in enumerate(listed, 1):
        assert list(stream.item(number).lines()) == list(item.lines())
    assert stream.words.tolist() == words
    assert stream.words_between(0, len(stream)).tolist() == words[: stream.ends[-1]]


def test_states_share_what_stayed_the_same() -> None:
    display, packer = Ramtek9300(), Packer()
    display.send(instructions.write_image(np.random.default_rng(1).integers(0, 1024, (480, 640))))
    dots = np.zeros((480, 640), np.bool_)
    first = packer.pack(display, 0, dots)
    same = packer.pack(display, 1, dots)
    assert size_of([first, same]) - size_of([first]) == len(same.data) + 480 * 80
    display.send(instructions.erase((0, 100, 9, 109), 3))
    second = packer.pack(display, 1, dots)
    assert size_of([first]) > 300_000
    assert size_of([first, second]) - size_of([first]) < 100_000


@given(st.data(), windows(), scan_codes, masks, windows())
def test_a_scan_touches_the_words_that_it_writes(
    data: st.DataObject, window: Window, code: int, mask: int, enabled: Window
) -> None:
    along = data.draw(st.integers(1, 40))
    dots = data.draw(st.none() | st.lists(st.booleans(), min_size=along, max_size=along))
    written = []
    touched = np.zeros((9, 13), np.bool_)
    # A word that becomes 0 whether it was 0 or all ones before is written.
    for before in (0, 0x3FF):
        frame_buffer = Ramtek9300(SMALL).frame_buffer
        frame_buffer.fill(frame_buffer.window, before)
        frame_buffer.touched = touched = np.zeros((9, 13), np.bool_)
        frame_buffer.write_scan(
            window,
            SCAN_ORDERS[code],
            SCAN_ORDERS[code].corner(window),
            np.zeros(along, np.uint16),
            WriteEnable(mask, enabled),
            None if dots is None else np.array(dots),
        )
        written.append(frame_buffer.words.copy())
    assert (touched == ((written[0] ^ written[1]) != 0x3FF)).all()


@given(streams(), streams(), streams())
def test_the_first_difference(begin: list[int], one: list[int], other: list[int]) -> None:
    first, second = replay_of(begin + one), replay_of(begin + other)
    found = first_difference(first.stream, second.stream)
    pairs = [moments(first), moments(second)]
    silence = np.zeros(0, np.uint16)
    expected = None
    for number in range(max(map(len, pairs))):
        # A display whose stream has ended stays as it is, and replies nothing.
        sides = [side[number] if number < len(side) else (side[-1][0], silence) for side in pairs]
        if sides[0][0] != sides[1][0] or sides[0][1].tolist() != sides[1][1].tolist():
            expected = number
            break
    assert (None if found is None else found.number) == expected
    assert found is None or found.where


@given(streams(), st.integers(0, 60))
def test_the_first_different_instruction(words: list[int], number: int) -> None:
    stream = Stream(SMALL, np.array(words, np.uint16))
    number %= len(stream) + 1
    shorter = Stream(SMALL, stream.words_between(0, number))
    assert first_different_instruction(stream, shorter) == number + 1
    assert first_different_instruction(stream, stream) == len(stream) + 1


def test_a_difference_says_where() -> None:
    alike = instructions.erase((0, 0, 12, 8), 5)
    first = Stream(SMALL, np.concatenate((alike, instructions.erase((2, 1, 4, 3), 6))))
    second = Stream(SMALL, np.concatenate((alike, instructions.erase((2, 1, 4, 2), 6))))
    start = Ramtek9300(SMALL)
    before = snapshot_bytes(start)
    found = first_difference(first, second, start)
    assert found is not None
    assert found.where["words"] == {
        "count": 3,
        "window": [2, 3, 4, 3],
        "line": 3,
        "element": 2,
        "values": [6, 5],
    }
    assert snapshot_bytes(start) == before
    table = [Stream(SMALL, instructions.load_entries(7, [(red, 0, 0)])) for red in (1, 2)]
    found = first_difference(table[0], table[1])
    assert found is not None
    assert found.where == {"entries": {"count": 1, "first": 7, "values": ["#010000", "#020000"]}}
