from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Configuration, Ramtek9300, Timing, instructions
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.testing import streams
from tests.ramtek_emu.inspection.replays import moments, prepare, replay_of, states_every
from tests.ramtek_emu.strategies import SMALL

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
            assert replay.reply is not None
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
            replay.note(sent, display)
            expected[len(replay.stream)] = snapshot_bytes(display)
            if moves:
                display.joystick.move_to(len(sent) % 13, 3)
                display.joystick.press_enter()
                replay.note(np.zeros(0, np.uint16), display, has_moved=True)
                expected[len(replay.stream)] = snapshot_bytes(display)
            if resets:
                display.reset()
                pending = np.zeros(0, np.uint16)
                replay.note(instructions.reset(), display, has_moved=True)
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
