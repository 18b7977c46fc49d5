from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.inspection.states import Packer, State, packed_dots, size_of, thinned
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.testing import streams
from tests.ramtek_emu.strategies import SMALL


@given(st.lists(streams(), min_size=1, max_size=5))
def test_every_state_gives_its_display_back(rounds: list[list[int]]) -> None:
    display, packer = Ramtek9300(SMALL), Packer()
    states: list[State] = []
    expected: list[bytes] = []
    for words in rounds:
        display.send(np.array(words, np.uint16))
        display.receive(display.processor.waiting)
        states.append(packer.pack(display, len(states), None))
        expected.append(snapshot_bytes(display))
    for state, snapshot in zip(states, expected, strict=True):
        restored = state.display()
        assert snapshot_bytes(restored) == snapshot
        # A display of a state can be drawn on, and the state stays as it was.
        restored.send(instructions.reset())
        assert snapshot_bytes(state.display()) == snapshot


def test_states_share_what_stayed_the_same() -> None:
    display, packer = Ramtek9300(), Packer()
    display.send(instructions.write_image(np.random.default_rng(1).integers(0, 1024, (480, 640))))
    first = packer.pack(display, 0, None)
    same = packer.pack(display, 1, None)
    assert all(one is other for one, other in zip(first.arrays, same.arrays, strict=True))
    display.send(instructions.erase((0, 100, 9, 109), 3))
    second = packer.pack(display, 1, None)
    assert size_of([first]) > 300_000
    assert size_of([first, second]) - size_of([first]) < 60_000


@given(st.lists(st.none() | st.integers(0, 7), min_size=1, max_size=12))
def test_fewer_states_know_what_was_touched_before_them(places: list[int | None]) -> None:
    def dots(*touched: int) -> bytes:
        return packed_dots(np.isin(np.arange(8), touched).reshape(2, 4))

    states = [
        State(number, b"", (), None, None if place is None else dots(place))
        for number, place in enumerate(places)
    ]
    fewer = thinned(states)
    assert fewer[0] is states[0]
    assert [state.number for state in fewer[1:-1]] == list(range(2, len(states) - 1, 2))
    assert fewer[-1].number == states[-1].number
    for before, state in itertools.pairwise(fewer):
        between = places[before.number + 1 : state.number + 1]
        known = [place for place in between if place is not None]
        assert state.touched == (dots(*known) if len(known) == len(between) else None)
