"""The grip: the widget, the handle or the screen that is dragged, from the grab to the drop."""

from __future__ import annotations

from autocolor.screens.board.layout import Layout
from autocolor.screens.input.gestures import MIDDLE, Gesture
from autocolor.screens.screen import Handle, Screen
from autocolor.widgets.widget import Place, Widget


class Grip:
    """What is dragged, if anything."""

    def __init__(self) -> None:
        self._grabbed: Widget | Handle | Screen | None = None
        self._start = self._last = Gesture("grab", -1, -1)

    @property
    def is_on(self) -> bool:
        """Whether something is dragged."""
        return self._grabbed is not None

    def release(self) -> None:
        """Let go."""
        self._grabbed = None

    def grab(self, layout: Layout, gesture: Gesture) -> None:
        """Grab what is at the place of a gesture: a widget that can be used, a handle, or the screen."""
        self._start = self._last = gesture
        place = gesture.element, gesture.line
        # Modifiers and the middle button are for the screen.
        is_plain = not gesture.shift and not gesture.control and gesture.button != MIDDLE
        widget, handle = layout.widget_at(*place), layout.handle_at(*place) if is_plain else None
        if widget is not None:
            self._grabbed = None if widget.why_not else widget
        elif handle is not None:
            self._grabbed = handle
            layout.screen.hold(handle)
        else:
            self._grabbed = None if layout.is_covered(*place) else layout.screen

    def drag(self, layout: Layout, gesture: Gesture) -> None:
        """Drag to the place of a gesture."""
        last, self._last = self._last, gesture
        if isinstance(self._grabbed, Widget):
            # The scene has changed since the widget was made; and it may be gone.
            self._grabbed = layout.now(self._grabbed)
            if self._grabbed is not None:
                self._grabbed.drag(place_of(self._start), place_of(last), place_of(gesture))
        elif isinstance(self._grabbed, Handle):
            layout.screen.place(self._grabbed, gesture.element, gesture.line)
        elif self._grabbed is not None:
            self._grabbed.drag(self._start, last, gesture)


def place_of(gesture: Gesture) -> Place:
    """The place of a gesture."""
    return Place(gesture.element, gesture.line)
