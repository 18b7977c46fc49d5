"""Screen: the interface of an interactive screen of the paper. Screens know the session, but not each other.

A screen tells what it looks like now, what can be pointed at, and what that does. When it is drawn and sent,
and who points (the mouse, the joystick unit, keys), is not its affair.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from autocolor.arrays import Bytes, Words
from autocolor.screens.input import Gesture
from autocolor.screens.session import Session
from autocolor.widgets.items import NIGHT, Item
from autocolor.widgets.widget import Widget


class Handle(NamedTuple):
    """A place on a screen that can be grabbed and put elsewhere; `label` is what the message line says.

    `key` is what the screen knows it by.
    """

    key: object
    element: int
    line: int
    label: str


class Screen:
    """A screen with nothing on it. `name` is how the session calls it, `title` how the user sees it."""

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    help: ClassVar[str] = ""
    """What one does there, for the message line."""
    has_menu: ClassVar[bool] = True
    """Whether the menu always stands beside it; else it comes on demand."""
    shows_picture: ClassVar[bool] = False
    """Whether its base is the picture at full size, so that keys that change the view are seen there."""
    shows_scene: ClassVar[bool] = True
    """Whether edits of the scene are seen there; else they lead back to the picture."""
    is_in_menu: ClassVar[bool] = True
    """Whether the main menu leads to it."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.is_under_menu = False
        """Whether the menu, which was asked for, stands over its right part."""

    # What is seen.

    def base(self) -> Words | int:
        """What is below everything: one word, or the words of a picture, the same array until it changes."""
        return NIGHT

    def items(self) -> Sequence[Item]:
        """What is drawn over the base, from the lowest to the highest; the widgets stand over them."""
        return ()

    def loads(self) -> Sequence[tuple[int, Bytes]]:
        """The entries that it borrows: runs of colors, (n, 3), from a first entry on."""
        return ()

    # What can be pointed at.

    def rows(self) -> Sequence[Widget]:
        """The rows of its menu."""
        return ()

    def widgets(self) -> Sequence[Widget]:
        """The widgets beside the menu, each with its area."""
        return ()

    def handles(self) -> Sequence[Handle]:
        """The places that can be grabbed."""
        return ()

    def hint(self, element: int, line: int) -> str:
        """What the message line says of a place where no widget and no handle is."""
        return self.help

    # What that does.

    def hold(self, handle: Handle) -> None:
        """A handle was picked or grabbed, and will be placed."""

    def place(self, handle: Handle, element: int, line: int) -> None:
        """Put what was grabbed at a place: once after a pick, at each movement during a drag."""

    def release(self) -> None:
        """What was held or grabbed is let go of."""

    def pick(self, gesture: Gesture) -> None:
        """A click, or ENTER, where no widget and no handle is."""

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        """A drag that began where no widget and no handle is has come from one place to another."""

    def wheel(self, gesture: Gesture) -> None:
        """The wheel was turned where no widget is."""

    def key(self, name: str, typed: str) -> bool:
        """A key that nothing else takes was pressed; returns False if it does nothing here."""
        return False

    def escape(self) -> bool:
        """Give up what was begun here; returns False if there is nothing, and the screen is left."""
        return False

    def idle(self) -> bool:
        """Do a part of what can wait while nothing moves; returns whether something looks different now."""
        return False

    def enter(self) -> None:
        """The screen is about to be shown."""

    def leave(self) -> None:
        """The screen is shown no more."""
