"""The choices below the bars of color mixing: finishes and recent colors, or a field of swatches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.files.state.recent import note_color, recent_colors
from autocolor.scene.paints.finishes import FINISHES, finished
from autocolor.scene.paints.swatches import COLUMNS, ROWS, swatches
from autocolor.scene.surfaces import Paint, Surface
from autocolor.screens.colors.color_section import RIGHT, RIGHT_END
from autocolor.screens.session import Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import LIGHT_GRAY
from autocolor.widgets.items import Item, text
from autocolor.widgets.swatch_fields import SwatchField
from autocolor.widgets.widget import MARGIN, ROW_LINES, Button, Widget

TOP: Final = 296
"""The line of the headings."""

HALF: Final = (RIGHT_END + 1 - RIGHT) // 2
"""The elements of a heading, and of a finish."""

SWATCH_ELEMENTS: Final = 16
SWATCH_LINES: Final = 14
SWATCHES: Final = Area(RIGHT, TOP + ROW_LINES, RIGHT_END, TOP + ROW_LINES + ROWS * SWATCH_LINES - 1)

RECENT: Final = Area(RIGHT, 392, RIGHT_END, 415)
RECENT_ELEMENTS: Final = 26


class PaintChoices:
    """The finishes of the chosen surface, and colors, which `take` is called with when they are picked."""

    def __init__(self, session: Session, take: Callable[[Color], object]) -> None:
        self.session = session
        self._take = take
        self._has_swatches = False
        """Whether the field of swatches is shown, instead of finishes and recent colors."""
        self._recent: tuple[Color, ...] = ()
        self._before: dict[str, Paint] = {}
        """The paints of all surfaces when the mixing began."""

    @property
    def colors(self) -> Bytes:
        """The colors that can be picked, (n, 3) uint8."""
        return swatches() if self._has_swatches else np.array(self._recent, np.uint8).reshape(-1, 3)

    def widgets(self, surface: Surface, words: Words, title: str) -> list[Widget]:
        """The headings and what is chosen by them; `words` show the colors, `title` is what they are for."""
        headings = [
            Button(
                "finishes",
                "Kinds of surfaces, and the colors that were mixed last.",
                area=half_row(0, 0),
                run=partial(self._show, False),
                is_chosen=not self._has_swatches,
            ),
            Button(
                "swatches",
                f"A field of {len(swatches())} paints to pick from.",
                area=half_row(0, 1),
                run=partial(self._show, True),
                is_chosen=self._has_swatches,
            ),
        ]
        if not self._has_swatches:
            return [*headings, *self._finishes(surface), *self._recent_colors(words, title)]
        field = SwatchField(
            "paints",
            f"Paints for the {title}: click one, or drag over them.",
            area=SWATCHES,
            words=words,
            across=COLUMNS,
            width=SWATCH_ELEMENTS,
            height=SWATCH_LINES,
            take=self._take_number,
        )
        return [*headings, field]

    def items(self) -> list[Item]:
        """The heading of the recent colors, if they are shown."""
        if self._has_swatches or not self._recent:
            return []
        return [text("recent colors", RIGHT + MARGIN, RECENT.top - 12, LIGHT_GRAY)]

    def begin(self) -> None:
        """Mixing begins: note the paints, and look up the recent colors."""
        self._before = {each.name: each.paint for each in self.session.scene.surfaces}
        self._recent = recent_colors()

    def end(self) -> None:
        """Mixing ends: the colors that surfaces were given are recent ones."""
        for surface in self.session.scene.surfaces:
            before, now = self._before.get(surface.name, surface.paint), surface.paint
            if before.light_color != now.light_color:
                note_color(now.light_color)
            if before.object_color != now.object_color:
                note_color(now.object_color)

    def _finishes(self, surface: Surface) -> Sequence[Widget]:
        return [
            Button(
                name,
                f"Let the surface look like {name}, in its object color.",
                area=half_row(1 + number // 2, number % 2),
                run=partial(self._finish, surface, name),
            )
            for number, name in enumerate(FINISHES)
        ]

    def _recent_colors(self, words: Words, title: str) -> Sequence[Widget]:
        if not self._recent:
            return []
        return [
            SwatchField(
                "recent colors",
                f"The colors that were mixed last; click one for the {title}.",
                area=RECENT,
                words=words,
                across=len(self._recent),
                width=RECENT_ELEMENTS,
                height=RECENT.height,
                take=self._take_number,
            )
        ]

    def _show(self, has_swatches: bool) -> None:
        self._has_swatches = has_swatches

    def _take_number(self, number: int) -> None:
        red, green, blue = self.colors[number].tolist()
        self._take((red, green, blue))

    def _finish(self, surface: Surface, name: str) -> None:
        self.session.change_surface(surface.name, **finished(surface, name))
        self.session.tell(f"{surface.name}: {name}")


def half_row(row: int, column: int) -> Area:
    """The left or the right half of a row, counted from the headings."""
    left, top = RIGHT + column * HALF, TOP + row * ROW_LINES
    return Area(left, top, left + HALF - 1, top + ROW_LINES - 1)
