"""Screen: the interface of an interactive screen of the paper. Screens know the session, but not each other.

A screen says how it looks now, which widgets and handles it has, and what a gesture does. It does not know
when it is drawn, nor whether the mouse, the joystick unit or a key points.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar, NamedTuple, TypeVar

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.screens.input import Gesture
from autocolor.screens.session import Session
from autocolor.studio import Studio
from autocolor.widgets.items import NIGHT, Area, Item
from autocolor.widgets.widget import NOWHERE, Place, Widget


class Handle(NamedTuple):
    """A place on a screen that can be grabbed and put elsewhere.

    By its `key` the handle is recognized when it is made again; `label` is for the message line. Its `sign`
    is a numeral on the screen that can be grabbed in its place.
    """

    key: object
    element: int
    line: int
    label: str
    sign: Area = NOWHERE
    place: Callable[[int, int], object] = lambda element, line: None
    """Put the handle at an element and a line: once after a pick, at each movement of a drag."""
    hold: Callable[[], object] = lambda: None
    """Note that the handle was picked or grabbed; `place` will move it."""


class Sample(NamedTuple):
    """A pixel of the picture: its surface, its color, and its level.

    On the background the surface is empty and the level is 0.
    """

    surface: str
    color: Color
    level: int


def surface_of(studio: Studio, word: int) -> str:
    """The name of the surface that owns a word; empty for the background and the words of screens."""
    ranges = studio.level_ranges.items()
    return next((name for name, levels in ranges if levels.first <= word <= levels.last), "")


class Screen:
    """An empty screen. The session calls it by its `name`, the user sees its `title`."""

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    help: ClassVar[str] = ""
    """What to do on the screen, for the message line."""
    has_menu: ClassVar[bool] = True
    """Whether the menu is always shown beside it; else the menu comes on demand."""
    shows_picture: ClassVar[bool] = False
    """Whether its base is the picture at full size."""
    shows_scene: ClassVar[bool] = True
    """Whether edits of the scene are seen on it; else an edit leads back to the picture."""
    is_in_menu: ClassVar[bool] = True
    """Whether the main menu leads to it."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.is_under_menu = self.has_menu
        """Whether the menu covers its right part."""
        self.has_panels = True
        """Whether its panels are shown; else the user hides them to see the whole picture."""
        self.lit = ""
        """The key of the widget under the pointer; empty if there is none."""
        self.pointer = Place(-1, -1)
        """The place of the pointer on the last page; negative where something covers the screen."""

    # How it looks.

    def base(self) -> Words | int:
        """The base below all items: one word, or the words of a picture, the same array until it changes."""
        return NIGHT

    def items(self) -> Sequence[Item]:
        """The items over the base, from the lowest to the highest; the widgets stand over them."""
        return ()

    def loads(self) -> Sequence[tuple[int, Bytes]]:
        """The runs of entries that it borrows: the first entry, and the colors, (n, 3)."""
        return ()

    # Widgets and handles.

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
        """The text of the message line for a place without widget and handle."""
        return self.help

    # Colors.

    def sample(self, element: int, line: int) -> Sample | None:
        """The pixel of the picture that is seen at a place; None where no picture is seen."""
        return None

    def color_at(self, element: int, line: int) -> Color | None:
        """The color to copy at a place; None if there is none."""
        return None

    def take_color(self, color: Color | str, element: int, line: int) -> None:
        """Take a pasted or sampled color, with the pointer at a place. Raises UsageError if it cannot."""
        raise UsageError("this screen takes no color; turn to color mixing")

    def surface_at(self, element: int, line: int) -> str:
        """The name of the surface that the picture has at a place; no word is read from the display."""
        studio = self.session.studio
        lines, elements = studio.words.shape
        if not self.shows_picture or not (0 <= line < lines and 0 <= element < elements):
            return ""
        return surface_of(studio, int(studio.words[line, element]))

    # Gestures and keys.

    def preferred(self, near: Sequence[Handle], element: int, line: int) -> Sequence[Handle]:
        """The handles within reach of a place, nearest first, in the order in which they are taken."""
        return near

    def release(self) -> None:
        """Let go of the handle."""

    def pick(self, gesture: Gesture) -> None:
        """Handle a click or ENTER at a place without widget and handle."""

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        """Follow a drag that began at a place without widget and handle."""

    def wheel(self, gesture: Gesture) -> None:
        """Handle a turn of the wheel at a place without widget."""

    def key(self, name: str, typed: str) -> bool:
        """Handle a key; returns False if it does nothing here."""
        return False

    def escape(self) -> bool:
        """Cancel an action that was begun; returns False if there is none, and the screen is left."""
        return False

    def idle(self) -> bool:
        """Do a part of the work that waits until nothing moves; returns whether the screen changed."""
        return False

    def enter(self) -> None:
        """Prepare to be shown."""

    def leave(self) -> None:
        """Clean up after being shown."""


class Pages(Screen):
    """A screen of text in pages: a click, the wheel, Space, Page Up and Page Down turn to another page."""

    has_menu = False
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.page = 0
        """The number of the page, which grows and falls without end; see `page_of`."""

    def enter(self) -> None:
        self.page = 0

    def pick(self, gesture: Gesture) -> None:
        self.page += 1

    def wheel(self, gesture: Gesture) -> None:
        self.page += 1 if gesture.steps < 0 else -1

    def key(self, name: str, typed: str) -> bool:
        step = {"space": 1, "page down": 1, "page up": -1}.get(name, 0)
        self.page += step
        return step != 0


AnyRow = TypeVar("AnyRow")


def page_of(rows: Sequence[AnyRow], number: int, rows_a_page: int) -> tuple[Sequence[AnyRow], str]:
    """The rows of a page, counted from 0, and how to turn it; the text is empty if all rows are on one page.

    After the last page comes the first.
    """
    pages = max(1, -(-len(rows) // rows_a_page))
    first = number % pages * rows_a_page
    turn = f"page {number % pages + 1} of {pages}; a click, the wheel or Space: the next page"
    return rows[first : first + rows_a_page], turn if pages > 1 else ""
