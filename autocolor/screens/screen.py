"""Screen: the interface of an interactive screen of the paper. Screens know the session, but not each other.

A screen builds its content: how it looks now, its widgets and handles, and what gestures do there. It does
not know when it is drawn, nor whether the mouse, the joystick unit or a key points.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

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
    let_go: Callable[[], object] = lambda: None
    """Note that the handle is no longer picked or grabbed."""


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


def surface_at(studio: Studio, element: int, line: int) -> str:
    """The name of the surface at a place of the picture; no word is read from the display."""
    lines, elements = studio.words.shape
    if not (0 <= line < lines and 0 <= element < elements):
        return ""
    return surface_of(studio, int(studio.words[line, element]))


class Surroundings(NamedTuple):
    """The things around a screen when its content is built."""

    has_menu: bool = False
    """Whether the menu covers its right part."""
    has_panels: bool = True
    """Whether its panels are shown; else the user hides them to see the whole picture."""
    lit: str = ""
    """The key of the widget under the pointer; empty if there is none."""
    pointer: Place = Place(-1, -1)
    """The place of the pointer; negative where the menu or a message covers the screen."""


def take_no_color(color: Color | str, element: int, line: int) -> None:
    """Refuse a color, on a screen that takes none."""
    raise UsageError("this screen takes no color; turn to color mixing")


@dataclass(frozen=True)
class Content:
    """What a screen shows at one moment, and what gestures and keys do there."""

    base: Words | int = NIGHT
    """The base below all items: one word, or the words of a picture, the same array until it changes."""
    items: Sequence[Item] = ()
    """The items over the base, from the lowest to the highest; the widgets stand over them."""
    loads: Sequence[tuple[int, Bytes]] = ()
    """The runs of entries that it borrows: the first entry, and the colors, (n, 3)."""
    rows: Callable[[], Sequence[Widget]] = tuple
    """Gives the rows of its menu, when the menu is shown."""
    widgets: Sequence[Widget] = ()
    """The widgets beside the menu, each with its area."""
    handles: Sequence[Handle] = ()
    """The places that can be grabbed."""

    hint: Callable[[int, int], str] = lambda element, line: ""
    """Gives the text of the message line for a place without widget and handle; empty for the help."""
    sample: Callable[[int, int], Sample | None] = lambda element, line: None
    """Gives the pixel of the picture that is seen at a place; None where no picture is seen."""
    color_at: Callable[[int, int], Color | None] = lambda element, line: None
    """Gives the color to copy at a place; None for that of the sample."""
    take_color: Callable[[Color | str, int, int], object] = take_no_color
    """Takes a pasted or sampled color, with the pointer at a place. Raises UsageError if it cannot."""
    preferred: Callable[[Sequence[Handle], int, int], Sequence[Handle]] = lambda near, element, line: near
    """Gives the handles within reach of a place, nearest first, in the order in which they are taken."""

    pick: Callable[[Gesture], object] = lambda gesture: None
    """Handles a click or ENTER at a place without widget and handle."""
    drag: Callable[[Gesture, Gesture, Gesture], object] = lambda start, last, now: None
    """Follows a drag that began at a place without widget and handle."""
    wheel: Callable[[Gesture], object] = lambda gesture: None
    """Handles a turn of the wheel at a place without widget."""
    key: Callable[[str, str], bool] = lambda name, typed: False
    """Handles a key, by its name and the typed letter; returns False if it does nothing here."""
    escape: Callable[[], bool] = lambda: False
    """Cancels an action that was begun; returns False if there is none, and the screen is left."""
    idle: Callable[[], bool] = lambda: False
    """Does a part of the work that waits until nothing moves; returns whether the screen changed."""


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
    word: ClassVar[str] = ""
    """The word of the strip that leads to it, of at most seven letters; empty if none does."""

    def __init__(self, session: Session) -> None:
        self.session = session

    def build(self, around: Surroundings) -> Content:
        """The content of the screen now."""
        return Content()

    def enter(self) -> None:
        """Prepare to be shown."""

    def leave(self) -> None:
        """Clean up after being shown."""
