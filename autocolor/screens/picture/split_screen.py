"""The split screen: the state to compare with at the left of a line, the present state at the right.

There is one lookup table for both pictures. If they have no more different colors than the surfaces have
words, both keep every color; else both share a palette, whose colors differ a little from their own. The
screen borrows the words of all surfaces: when it is left, the sheet restores every word and every entry.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.immutable import read_only
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.palette import in_palette
from autocolor.mapping.ranges import BACKGROUND, SURFACE_WORDS, WORDS
from autocolor.screens.cached import Cached
from autocolor.screens.comparing import BEFORE
from autocolor.screens.input import Gesture
from autocolor.screens.picture.over_picture import OverPicture
from autocolor.screens.screen import Content, Surroundings
from autocolor.screens.session import SPLIT, Session
from autocolor.widgets.items import BLACK, CHARACTER, HEIGHT, WHITE, WIDTH, Area, Item, filled, fitted, text
from autocolor.widgets.menu import WORK

FIRST: Final = BACKGROUND + 1
"""The first borrowed word."""

NOW: Final = "now"
"""The name of the present state beside the line."""

MIDDLE: Final = WIDTH // 2
TOP: Final = WORK.top + 8
MARGIN: Final = 8
"""Elements between the line and the names of the states, and the line of these names."""


class SplitScreen(OverPicture):
    """Two states of the scene, left and right of a line that follows drags and clicks."""

    name = SPLIT
    title = "split"
    help = "drag or click: move the line; Esc, or split again: the picture"
    has_menu = False
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._line = MIDDLE
        self._halves: Cached[Halves] = Cached()
        self._base: Cached[Words] = Cached()

    @property
    def halves(self) -> Halves:
        """The two pictures. Without another state, both are the present picture."""
        present = self.session.studio.display_image
        other = self.session.comparing.other_image or present
        return self._halves.of(lambda: halves_of(other, present), other, present)

    def enter(self) -> None:
        difference, off = self.session.comparing.difference, self.halves.off
        colors = f"each half at coarser levels: colors within {off} of 255" if off else "every color exact"
        self.session.tell(f"{difference}; {colors}; drag moves the line")

    def build(self, around: Surroundings) -> Content:
        # While the whole other state is shown, it looks as every screen over the picture.
        shown = super().build(around) if self.session.comparing.is_on else self._split()
        return Content(
            shown.base, shown.items, shown.loads, pick=self.pick, drag=lambda start, last, now: self.pick(now)
        )

    def _split(self) -> Content:
        halves, line = self.halves, self._line

        def draw() -> Words:
            return read_only(np.hstack([halves.left[:, :line], halves.right[:, line:]]))

        return Content(self._base.of(draw, halves, line), self._items_at_line(), [(FIRST, halves.colors)])

    def _items_at_line(self) -> Sequence[Item]:
        """The line, and the names of the states beside it."""
        line, other = self._line, self.session.comparing.other
        name = NOW if other is None else "before" if other.name == BEFORE else other.name
        left = fitted(name, max(0, line - 2 * MARGIN) // CHARACTER)
        right = fitted(NOW, max(0, WIDTH - line - 2 * MARGIN) // CHARACTER)
        return [
            filled(Area(line - 1, 0, line - 1, HEIGHT - 1), BLACK),
            filled(Area(line, 0, line, HEIGHT - 1), WHITE),
            text(left, line - MARGIN - CHARACTER * len(left), TOP, WHITE, BLACK),
            text(right, line + MARGIN, TOP, WHITE, BLACK),
        ]

    def pick(self, gesture: Gesture) -> None:
        """Move the line."""
        self._line = min(max(gesture.element, 1), WIDTH - 1)


class Halves(NamedTuple):
    """The words of two pictures, which share a palette of colors; `off` is the largest error of a color.

    The words are (lines, elements), from FIRST on; `colors` are (n, 3), their entries.
    """

    left: Words
    right: Words
    colors: Bytes
    off: int


def halves_of(left: DisplayImage, right: DisplayImage) -> Halves:
    """Two images in as many colors as the surfaces have words."""
    used = [np.unique(image.words) for image in (left, right)]
    # Every word counts the same, however many pixels show it: all gradients become coarser alike.
    colors = np.concatenate([image.entries[words] for image, words in zip((left, right), used, strict=True)])
    places, palette = in_palette(colors[np.newaxis], SURFACE_WORDS)
    off = np.abs(palette[places[0]].astype(np.int64) - colors).max(initial=0)
    halves = []
    for image, words, place in zip((left, right), used, np.split(places[0], [len(used[0])]), strict=True):
        word_of = np.zeros(WORDS, np.uint16)
        word_of[words] = FIRST + place
        halves.append(word_of[image.words])
    return Halves(halves[0], halves[1], palette, int(off))
