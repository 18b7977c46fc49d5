"""What is dragged on a board is tried in test_board.py; here, what is asked of the screen."""

from __future__ import annotations

from autocolor.screens.board.grip import Grip
from autocolor.screens.board.layout import Layout
from autocolor.screens.input.gestures import Gesture
from autocolor.screens.screen import Handle, Screen


class Told(Screen):
    """A screen that notes what it is asked for."""

    def __init__(self) -> None:
        self.did: list[object] = []

    def handles(self) -> list[Handle]:
        return [Handle("a", 100, 100, "a")]

    def hold(self, handle: Handle) -> None:
        self.did.append(("hold", handle.key))

    def place(self, handle: Handle, element: int, line: int) -> None:
        self.did.append(("place", handle.key, element, line))

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        self.did.append(("drag", start.element, last.element, now.element))


def test_a_handle_is_held_and_placed_and_the_screen_dragged_step_by_step() -> None:
    screen, grip = Told(), Grip()
    layout = Layout(screen, [], "", [])
    grip.grab(layout, Gesture("grab", 102, 100))
    grip.drag(layout, Gesture("drag", 110, 90))
    assert grip.is_on
    grip.release()
    grip.drag(layout, Gesture("drag", 120, 90))
    assert screen.did == [("hold", "a"), ("place", "a", 110, 90)]
    screen.did.clear()
    grip.grab(layout, Gesture("grab", 200, 200))
    for element in (210, 225):
        grip.drag(layout, Gesture("drag", element, 200))
    assert screen.did == [("drag", 200, 200, 210), ("drag", 200, 210, 225)]
