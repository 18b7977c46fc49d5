"""The choices of color mixing: finishes, and in the menu recent colors, swatches and the paints of a file.

The paints of a palette file have pages before the swatches, in cells of twice the size if they are few.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.files.palette_file import Palette
from autocolor.files.state import note_color, recent_colors
from autocolor.scene.kinds import in_digits
from autocolor.scene.swatches import COLUMNS, ROWS, swatches
from autocolor.screens.session import Session
from autocolor.screens.surface.painting import PaintColor, colors_of
from autocolor.widgets.items import NIGHT, Item, image
from autocolor.widgets.widget import Gap, Place, Widget, page_choice

CELL_ELEMENTS: Final = 12
CELL_LINES: Final = 10
"""The size of a swatch. The hues go down, so that the field fits into the menu."""

MOST_RECENT: Final = ROWS
"""Recent colors in their row, which is as wide as the swatches."""

PAGE: Final = ROWS * COLUMNS
"""The most paints of a page."""

FEW_PAINTS: Final = PAGE // 4
"""The paints that fit in cells of twice the size."""


class ColorPage(NamedTuple):
    """A page of colors to pick: its title, the colors (n, 3) uint8, row by row, and their names."""

    title: str
    colors: Bytes
    names: Sequence[str]
    size: int = 1
    """Whether its cells are of the usual size, 1, or of twice that size, 2."""


class PaintChoices:
    """The colors to choose from. `take` is called with a color, and its name, which may be empty."""

    def __init__(self, session: Session, take: Callable[[Color, str], object]) -> None:
        self.session = session
        self._take = take
        self._recent: tuple[Color, ...] = ()
        self._turned: tuple[Palette | None, int] = None, 0
        """Paints, and the number of the page to which the user turned while they were shown."""
        self._taken = 0
        """The number of the color that was taken last, on its page."""
        self.mixed: set[Color] = set()
        """The colors that were given to surfaces one by one, since they were last noted."""

    @property
    def page_number(self) -> int:
        """The number of the page that is shown, from 0; new paints begin with their first page."""
        paints, number = self._turned
        return number if paints is self.session.paints else 0

    @property
    def page(self) -> ColorPage:
        """The page that is shown; after the last page of paints, the swatches."""
        paints, file = self.session.paints, self.session.paints_name
        count, first = 0 if paints is None else len(paints), self.page_number * PAGE
        if paints is None or first >= count:
            hues_down = swatches().reshape(ROWS, COLUMNS, 3).swapaxes(0, 1).reshape(-1, 3)
            return ColorPage("the swatches", hues_down, ("",) * PAGE)
        end = min(first + PAGE, count)
        title = f"paints {first + 1:,} to {end:,} of {file}" if count > PAGE else f"the paints of {file}"
        colors = np.array(paints.colors[first:end], np.uint8)
        return ColorPage(title, colors, paints.names[first:end], 2 if count <= FEW_PAINTS else 1)

    @property
    def colors(self) -> Bytes:
        """The colors that can be picked, (n, 3) uint8: the page's colors, and then the recent colors."""
        return np.concatenate([self.page.colors, np.array(self._recent, np.uint8).reshape(-1, 3)])

    def rows(self, words: Words, chosen: PaintColor) -> list[Widget]:
        """The rows of the colors for the chosen color of the surface; `words` show the colors."""
        page, paints = self.page, self.session.paints
        count, pages = len(page.colors), 1 + (0 if paints is None else -(-len(paints) // PAGE))

        def hint(number: int) -> str:
            name, color = self._color(number)
            return f"{f'{name}, ' if name else ''}{in_digits(color)}: click it for {chosen.name}"

        recent = SwatchField(
            "recent colors",
            f"The colors that were mixed last; click one for {chosen.name}.",
            words=words[count:],
            across=MOST_RECENT,
            take=lambda number: self._take_number(count + number),
            hint_of=lambda number: hint(count + number),
        )
        turning = page_choice(
            f"Shown: {page.title}. A click turns to the next page, at the left end to the page before.",
            self.page_number,
            pages,
            self._turn,
        )
        field = SwatchField(
            "paints",
            f"Paints for {chosen.name}: click one, or drag over them.",
            words=words[:count],
            row_lines=COLUMNS * CELL_LINES,
            across=ROWS // page.size,
            width=page.size * CELL_ELEMENTS,
            height=page.size * CELL_LINES,
            take=self._take_number,
            step=partial(self._step, chosen.color),
            hint_of=hint,
        )
        gap = (recent, Gap("recent gap")) if self._recent else ()
        return [Gap("swatches gap"), *gap, *([turning] if pages > 1 else []), field]

    def _turn(self, number: int) -> None:
        self._turned, self._taken = (self.session.paints, number), 0
        self.session.tell(f"shown: {self.page.title}")

    def note_mixed(self) -> None:
        """Note the mixed colors that surfaces have as recent colors, and look up the recent colors."""
        for surface in self.session.scene.surfaces:
            for color in dict.fromkeys(colors_of(surface.paint)):
                if color in self.mixed:
                    note_color(color)
        self.mixed.clear()
        self._recent = recent_colors()[:MOST_RECENT]

    def _color(self, number: int) -> tuple[str, Color]:
        """The name and the value of one of `colors`; recent colors have no name."""
        names, (red, green, blue) = self.page.names, self.colors[number].tolist()
        return names[number] if number < len(names) else "", (red, green, blue)

    def _take_number(self, number: int) -> None:
        self._taken = number
        name, color = self._color(number)
        self._take(color, name)

    def _step(self, present: Color, step: int) -> None:
        """Take the color that is a step further on the page than the present one.

        If several paints have the present color, the paint that was taken last counts as the present paint.
        """
        colors = self.page.colors
        places = np.flatnonzero((colors == present).all(axis=1)).tolist() or [-1 if step > 0 else len(colors)]
        number = self._taken if self._taken in places else places[0]
        self._take_number((number + step) % len(colors))


@dataclass(frozen=True)
class SwatchField(Widget):
    """Cells, each filled with a word of its own, row by row from the top of the area.

    `take` is called with the number of a cell that is picked, or that a drag reaches. There may be fewer
    cells than fit.
    """

    words: Words = field(default_factory=lambda: np.empty(0, np.uint16))
    across: int = 1
    """Cells in a row."""
    width: int = CELL_ELEMENTS
    height: int = CELL_LINES
    """Elements and lines of a cell."""
    take: Callable[[int], object] = lambda _: None
    step: Callable[[int], object] = lambda _: None
    """Called with 1 or -1, to take the next cell or the one before, by a key or the wheel."""
    hint_of: Callable[[int], str] = lambda _: ""
    """Gives the text of the message line for a cell."""
    row_lines: int = CELL_LINES

    def hint_at(self, place: Place) -> str:
        number = self.cell_at(place)
        return super().hint_at(place) if number is None else self.hint_of(number)

    @property
    def _left(self) -> int:
        """The first element of the cells, which are in the middle of the area."""
        return self.area.left + (self.area.width - self.across * self.width) // 2

    def items(self, lit: bool) -> list[Item]:
        return [_cells(self.words.tobytes(), self._left, self.area.top, self.across, self.width, self.height)]

    def cell_at(self, place: Place) -> int | None:
        """The number of the cell at a place, if there is one."""
        column = (place.element - self._left) // self.width
        row = (place.line - self.area.top) // self.height
        number = row * self.across + column
        return number if 0 <= column < self.across and 0 <= number < len(self.words) else None

    def pick(self, place: Place) -> object:
        number = self.cell_at(place)
        return None if number is None else self.take(number)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.pick(place)

    def nudge(self, steps: float) -> object:
        return self.step(1 if steps > 0 else -1)


@lru_cache(maxsize=8)
def _cells(data: bytes, left: int, top: int, across: int, width: int, height: int) -> Item:
    words = np.frombuffer(data, np.uint16)
    grid = np.full(-(-len(words) // across) * across, NIGHT, np.uint16)
    grid[: len(words)] = words
    cells = grid.reshape(-1, across).repeat(height, axis=0).repeat(width, axis=1)
    # The ground shows between the cells, at the right and lower edge of each cell.
    cells[height - 1 :: height] = NIGHT
    cells[:, width - 1 :: width] = NIGHT
    return image(cells, left, top)
