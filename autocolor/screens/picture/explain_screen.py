"""The explain screen: why a pixel of the picture looks as it does, with the pixels around it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Words
from autocolor.explanation.explain import explain
from autocolor.explanation.text import LABEL, TextRow, rows_of_text
from autocolor.screens.cached import Cached
from autocolor.screens.input import Gesture
from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.screens.session import EXPLAIN, Session
from autocolor.widgets.items import (
    CHARACTER,
    LIGHT_GRAY,
    WHITE,
    WIDTH,
    YELLOW,
    Area,
    Item,
    fitted,
    image,
    outline,
    text,
)
from autocolor.widgets.menu import WORK

LEFT: Final = 4
TOP: Final = WORK.top + 2
STEP: Final = 13
"""The upper left of the rows, and the lines from row to row."""

SIDE: Final = 7
"""Elements and lines of a pixel under the magnifier."""

ACROSS: Final = 4
DOWN: Final = 2
"""Pixels of the magnifier beside the explained pixel on each side, and above and below it."""

MAGNIFIER: Final = Area(WIDTH - 8 - SIDE * (2 * ACROSS + 1), TOP, WIDTH - 9, TOP + SIDE * (2 * DOWN + 1) - 1)

STEPS: Final = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1)}
"""The keys that explain a neighbor: the lines and elements to it."""


class ExplainScreen(Screen):
    """The explanation of the session's pixel; edits of the scene change it at once."""

    name = EXPLAIN
    title = "explain"
    help = "why this pixel looks so; a click at the upper right: a neighbor"
    has_menu = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._items: Cached[Sequence[Item]] = Cached()

    def enter(self) -> None:
        keys = "; arrows, too; Esc: back"
        more = keys if self.session.has_keyboard else "; the right edge: the menu"
        self.session.tell(f"{self.help}{more}", persistent=True)

    def build(self, around: Surroundings) -> Content:
        """The rows of the explanation, and the magnifier."""
        studio, pixel = self.session.studio, self.session.pixel

        def draw() -> Sequence[Item]:
            rows = rows_of_text(explain(studio.sight, studio.display_image, *pixel))
            row_items = [item for number, row in enumerate(rows) for item in items_of_row(row, number)]
            return [*row_items, *magnifier_items(studio.words, *pixel)]

        return Content(
            items=self._items.of(draw, studio.display_image, pixel), pick=self._pick, key=self._key
        )

    def _pick(self, gesture: Gesture) -> None:
        if MAGNIFIER.has(gesture.element, gesture.line):
            down, across = gesture.line - MAGNIFIER.top, gesture.element - MAGNIFIER.left
            self._step(down // SIDE - DOWN, across // SIDE - ACROSS)

    def _key(self, name: str, typed: str) -> bool:
        if name in STEPS:
            self._step(*STEPS[name])
        return name in STEPS

    def _step(self, down: int, across: int) -> None:
        """Explain a neighbor of the pixel, if it is in the picture."""
        (lines, elements), (line, element) = self.session.studio.words.shape, self.session.pixel
        if 0 <= line + down < lines and 0 <= element + across < elements:
            self.session.pixel = line + down, element + across


def items_of_row(row: TextRow, number: int) -> list[Item]:
    """A row of an explanation, counted from the top; it ends before the magnifier."""
    top, left = TOP + STEP * number, LEFT + CHARACTER * LABEL
    right = MAGNIFIER.left - CHARACTER if top <= MAGNIFIER.bottom else WIDTH
    says = fitted(row.says, (right - left) // CHARACTER)
    is_quiet = row.label in ("", "light")
    ink = YELLOW if number == 0 else LIGHT_GRAY if is_quiet else WHITE
    return [text(row.label, LEFT, top, LIGHT_GRAY), text(says, left, top, ink)]


def magnifier_items(words: Words, line: int, element: int) -> list[Item]:
    """The pixels around a pixel, each a square in its own word; the pixel itself has an outline.

    Beside the picture, the pixels at its edge are repeated.
    """
    lines = np.clip(np.arange(line - DOWN, line + DOWN + 1), 0, words.shape[0] - 1)
    elements = np.clip(np.arange(element - ACROSS, element + ACROSS + 1), 0, words.shape[1] - 1)
    around = words[np.ix_(lines, elements)].repeat(SIDE, axis=0).repeat(SIDE, axis=1)
    left, top = MAGNIFIER.left + SIDE * ACROSS, MAGNIFIER.top + SIDE * DOWN
    frame = Area(left - 1, top - 1, left + SIDE, top + SIDE)
    return [image(around, MAGNIFIER.left, MAGNIFIER.top), outline(frame, YELLOW)]
