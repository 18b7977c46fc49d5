from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.monitor.input_queue import Close, Input, InputQueue, Key, Pointer, Release


def after(*added: Input) -> list[Input]:
    """What waits after these inputs; a release is the release of a key."""
    queue = InputQueue()
    for user_input in added:
        if isinstance(user_input, Release):
            queue.release(user_input.name)
        else:
            queue.add(user_input)
    return [queue.take() for _ in range(len(queue))]


def move(element: int) -> Pointer:
    return Pointer(element, 1, "move")


def wheel(direction: str = "up", steps: int = 1, shift: bool = False, control: bool = False) -> Pointer:
    return Pointer(0, 0, f"wheel {direction}", steps=steps, shift=shift, control=control)


PRESS, LIFT = Pointer(2, 1, "press", 1), Pointer(4, 1, "release", 1)
LEFT, UP = Key("left"), Key("up")
AGAIN = Key("left", repeated=True)
ORDER: list[Input] = [Key("a", "a"), PRESS, Path("scene.toml"), Close(), PRESS, Close()]


@pytest.mark.parametrize(
    ("added", "waiting"),
    [
        pytest.param(ORDER, ORDER, id="all inputs in their order"),
        pytest.param(
            [LEFT, LEFT, UP, LEFT, LEFT, UP],
            [LEFT, UP, AGAIN, Key("up", repeated=True)],
            id="of the repeats of a key only the last",
        ),
        pytest.param(
            [LEFT, LEFT, UP, Release("left"), Release("left")],
            [LEFT, UP, Release("left")],
            id="after a release no repeat",
        ),
        pytest.param(
            [LEFT, Release("left"), LEFT],
            [LEFT, Release("left"), LEFT],
            id="a press after a release is no repeat",
        ),
        pytest.param(
            [move(1), move(2), PRESS, move(3), move(4), LIFT, move(5)],
            [move(2), PRESS, move(4), LIFT, move(5)],
            id="of places of the mouse in a row only the last",
        ),
        pytest.param(
            [wheel(), wheel(steps=2), wheel("down")],
            [wheel(steps=3), wheel("down")],
            id="the sum of the wheel",
        ),
        pytest.param(
            [wheel(), wheel(), wheel(shift=True), wheel(control=True), wheel()],
            [wheel(steps=2), wheel(shift=True), wheel(control=True), wheel()],
            id="movements with other modifiers are not one",
        ),
        pytest.param(
            [Key("8", "[", control=True, alt=True), Key("9", "9", control=True), Key("7", "7", alt=True)],
            [Key("8", "["), Key("9", "9", control=True), Key("7", "7", alt=True)],
            id="a character typed with AltGr has no Ctrl and Alt",
        ),
        pytest.param(
            [Key("z", "\x1a", control=True, alt=True), Key("f4", "", control=True, alt=True)],
            [Key("z", "\x1a", control=True, alt=True), Key("f4", "", control=True, alt=True)],
            id="a key that types no character keeps them",
        ),
    ],
)
def test_what_waits(added: list[Input], waiting: list[Input]) -> None:
    assert after(*added) == waiting


def test_when_the_keyboard_goes_elsewhere_nothing_is_down() -> None:
    queue = InputQueue()
    for user_input in (LEFT, LEFT, Pointer(0, 0, "press", 3), Key("right"), Key("right")):
        queue.add(user_input)
    assert queue.down == {"left", "right", 3}
    queue.release_everything()
    assert queue.down == frozenset()
    assert [queue.take() for _ in range(len(queue))] == [
        LEFT, Pointer(0, 0, "press", 3), Key("right"), Release("left"), Release("right"),
    ]  # fmt: skip


@given(st.lists(st.tuples(st.sampled_from(["down", "up", "move", "wheel"]), st.sampled_from("abc"))))
def test_the_pressed_keys_bound_the_waiting_inputs(events: list[tuple[str, str]]) -> None:
    queue = InputQueue()
    presses = 0
    for kind, name in events:
        if kind == "down":
            presses += name not in queue.down
            queue.add(Key(name))
        elif kind == "up":
            queue.release(name)
        else:
            queue.add(move(1) if kind == "move" else wheel())
    # All presses stay, and the releases of all keys that are up; a key has at most one repeat.
    waiting = [queue.take() for _ in range(len(queue))]
    keys = [key for key in waiting if isinstance(key, Key)]
    assert sum(isinstance(release, Release) for release in waiting) == presses - len(queue.down)
    assert sum(not key.repeated for key in keys) == presses
    repeats = [key.name for key in keys if key.repeated]
    assert len(repeats) == len(set(repeats))
    assert set(repeats) <= queue.down
