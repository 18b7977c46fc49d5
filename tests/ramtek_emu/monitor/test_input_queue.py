from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.monitor.input_queue import Close, Input, InputQueue, Key, Pointer, Release


def taken(queue: InputQueue) -> list[Input]:
    return [queue.take() for _ in range(len(queue))]


def test_inputs_are_taken_in_their_order() -> None:
    queue = InputQueue()
    inputs: list[Input] = [Key("a", "a"), Pointer(1, 2, False, "press", 1), Path("scene.toml"), Close()]
    for user_input in inputs:
        queue.add(user_input)
    assert taken(queue) == inputs
    with pytest.raises(IndexError):
        queue.take()


def test_of_the_repeats_of_a_key_only_the_last_waits() -> None:
    queue = InputQueue()
    for name in ("left", "left", "up", "left", "left", "up"):
        queue.add(Key(name))
    assert taken(queue) == [Key("left"), Key("up"), Key("left", repeated=True), Key("up", repeated=True)]


def test_a_released_key_leaves_its_first_press_and_the_release_and_no_repeat() -> None:
    queue = InputQueue()
    queue.add(Key("left"))
    queue.add(Key("left"))
    queue.add(Key("up"))
    queue.release("left")
    assert taken(queue) == [Key("left"), Key("up"), Release("left")]
    assert queue.down == {"up"}
    # A second release, as when the keyboard comes back, finds no key down.
    queue.release("left")
    assert taken(queue) == []
    # The next press is no repeat.
    queue.add(Key("left"))
    assert taken(queue) == [Key("left")]


def test_of_successive_places_of_the_mouse_only_the_last_waits() -> None:
    queue = InputQueue()
    for user_input in (
        Pointer(1, 1, False, "move"),
        Pointer(2, 1, False, "move"),
        Pointer(2, 1, False, "press", 1),
        Pointer(3, 1, False, "move"),
        Pointer(4, 1, False, "move"),
        Pointer(4, 1, False, "release", 1),
        Pointer(5, 1, False, "move"),
    ):
        queue.add(user_input)
    assert [
        (pointer.element, pointer.action) for pointer in taken(queue) if isinstance(pointer, Pointer)
    ] == [
        (2, "move"),
        (2, "press"),
        (4, "move"),
        (4, "release"),
        (5, "move"),
    ]


def test_steps_of_the_wheel_are_added_up() -> None:
    queue = InputQueue()
    for action, steps in (("wheel up", 1), ("wheel up", 2), ("wheel down", 1)):
        queue.add(Pointer(0, 0, False, action, steps=steps))
    assert taken(queue) == [Pointer(0, 0, False, "wheel up", steps=3), Pointer(0, 0, False, "wheel down")]


def test_movements_with_other_modifiers_are_not_one() -> None:
    queue = InputQueue()
    for shift in (False, False, True, True, False):
        queue.add(Pointer(0, 0, False, "wheel up", shift=shift))
    assert [(pointer.steps, pointer.shift) for pointer in taken(queue) if isinstance(pointer, Pointer)] == [
        (2, False),
        (2, True),
        (1, False),
    ]


def test_when_the_keyboard_goes_elsewhere_nothing_is_down() -> None:
    queue = InputQueue()
    for user_input in (
        Key("left"),
        Key("left"),
        Pointer(0, 0, False, "press", 3),
        Key("right"),
        Key("right"),
    ):
        queue.add(user_input)
    assert queue.down == {"left", "right", 3}
    queue.release_everything()
    assert queue.down == frozenset()
    assert taken(queue) == [
        Key("left"),
        Pointer(0, 0, False, "press", 3),
        Key("right"),
        Release("left"),
        Release("right"),
    ]


def test_a_character_typed_with_altgr_has_no_ctrl_and_alt() -> None:
    queue = InputQueue()
    for key in (
        Key("8", "[", control=True, alt=True),
        Key("z", "\x1a", control=True, alt=True),
        Key("f4", "", control=True, alt=True),
    ):
        queue.add(key)
    assert taken(queue) == [
        Key("8", "["),
        Key("z", "\x1a", control=True, alt=True),
        Key("f4", "", control=True, alt=True),
    ]


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
            queue.add(Pointer(0, 0, False, "move" if kind == "move" else "wheel up"))
    # All presses stay, and the releases of all keys that are up; a key has at most one repeat.
    waiting = taken(queue)
    keys = [key for key in waiting if isinstance(key, Key)]
    releases = [release for release in waiting if isinstance(release, Release)]
    assert len(releases) == presses - len(queue.down)
    assert sum(not key.repeated for key in keys) == presses
    repeats = [key.name for key in keys if key.repeated]
    assert len(repeats) == len(set(repeats))
    assert set(repeats) <= queue.down
