"""The choices of color mixing: finishes, and in the menu recent colors, swatches and the paints of a file.

The paints of a palette file have pages before the swatches, in cells of twice the size if they are few.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import ClassVar, Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.files.palette_file import Palette
from autocolor.files.state import note_color, recent_colors
from autocolor.scene.kinds import in_digits
from autocolor.scene.surfaces import Paint
from autocolor.scene.swatches import COLUMNS, FINISHES, ROWS, swatches
from autocolor.screens.cached import Cached
from autocolor.screens.session import Session
from autocolor.screens.surface.painting import finish
from autocolor.widgets.items import NIGHT, Area, Item, image
from autocolor.widgets.widget import Button, Gap, Place, Widget, page_choice

CELL_ELEMENTS: Final = 12
CELL_LINES: Final = 10
"""The size of a swatch. The hues go down, so that the field fits into the menu."""

MOST_RECENT: Final = ROWS
"""Recent colors in their row, which is as wide as the swatches."""


FEW_PAINTS: Final = ROWS * COLUMNS // 4
"""The paints that fit in cells of twice the size."""


class ColorPage(NamedTuple):
    """A page of colors to pick: its title, the colors (n, 3) uint8, row by row, and their names."""

    title: str
    colors: Bytes
    names: Sequence[str] = ()
    is_large: bool = False


def pages_of_paints(paints: Palette | None, file: str) -> list[ColorPage]:
    """The pages of the paints of a file, if there are paints, and last the page of the swatches."""
    pages, size = [], ROWS * COLUMNS
    count = 0 if paints is None else len(paints)
    for first in range(0, count, size):
        assert paints is not None
        end = min(first + size, count)
        title = f"paints {first + 1:,} to {end:,} of {file}" if count > size else f"the paints of {file}"
        colors, names = np.array(paints.colors[first:end], np.uint8), paints.names[first:end]
        pages.append(ColorPage(title, colors, names, count <= FEW_PAINTS))
    hues_down = swatches().reshape(ROWS, COLUMNS, 3).swapaxes(0, 1).reshape(-1, 3)
    return [*pages, ColorPage("the swatches", hues_down)]


class PaintChoices:
    """The finishes of the chosen surface, and colors.

    `take` is called with a color that is picked, and its name, which may be empty.
    """

    def __init__(self, session: Session, take: Callable[[Color, str], object]) -> None:
        self.session = session
        self._take = take
        self._recent: tuple[Color, ...] = ()
        self._pages: Cached[list[ColorPage]] = Cached()
        self._turned: tuple[Palette | None, int] = None, 0
        """Paints, and the number of the page to which the user turned while they were shown."""
        self._taken = 0
        """The number of the color that was taken last, on its page."""
        self._before: dict[str, Paint] = {}
        """The paints of all surfaces when the mixing began."""

    @property
    def pages(self) -> list[ColorPage]:
        """The pages of colors."""
        paints, file = self.session.paints, self.session.paints_name
        return self._pages.of(lambda: pages_of_paints(paints, file), paints)

    @property
    def page_number(self) -> int:
        """The number of the page that is shown, from 0; new paints begin with their first page."""
        paints, number = self._turned
        return number if paints is self.session.paints else 0

    @property
    def page(self) -> ColorPage:
        """The page that is shown."""
        return self.pages[self.page_number]

    @property
    def count(self) -> int:
        """The number of colors that can be picked."""
        return len(self.page.colors) + len(self._recent)

    @property
    def colors(self) -> Bytes:
        """The colors that can be picked, (n, 3) uint8: the page's colors, and then the recent colors."""
        return np.concatenate([self.page.colors, np.array(self._recent, np.uint8).reshape(-1, 3)])

    def rows(self, words: Words, name: str, present: Color) -> list[Widget]:
        """The rows of the colors; `words` show the colors.

        `name` is the name of the color of the surface to choose, and `present` is its present value.
        """
        page, pages = self.page, len(self.pages)
        count, size = len(page.colors), 2 if page.is_large else 1
        recent = SwatchField(
            "recent colors",
            f"The colors that were mixed last; click one for {name}.",
            words=words[count:],
            across=MOST_RECENT,
            take=self._take_recent,
        )
        turning = page_choice(
            f"Shown: {page.title}. A click turns to the next page, at the left end to the page before.",
            self.page_number,
            pages,
            self._turn,
        )
        paints = PaintField(
            "paints",
            f"Paints for {name}: click one, or drag over them.",
            words=words[:count],
            across=ROWS // size,
            width=size * CELL_ELEMENTS,
            height=size * CELL_LINES,
            take=self._take_number,
            step=partial(self._step, present),
            hint_of=partial(self._hint_of, name) if page.names else None,
        )
        gap = (recent, Gap("recent gap")) if self._recent else ()
        return [Gap("swatches gap"), *gap, *([turning] if pages > 1 else []), paints]

    def _hint_of(self, name: str, number: int) -> str:
        paint, (red, green, blue) = self.page.names[number], self.page.colors[number].tolist()
        return f"{f'{paint}, ' if paint else ''}{in_digits((red, green, blue))}: click it for {name}"

    def _turn(self, number: int) -> None:
        self._turned, self._taken = (self.session.paints, number), 0
        self.session.tell(f"shown: {self.page.title}")

    def finishes(self, row: Area) -> list[Widget]:
        """The finishes, side by side in a row."""
        width = row.width // len(FINISHES)
        area = row._replace(right=row.left + width - 1)
        return [
            Button(
                name,
                f"Let the surface look like {name}, in its object color.",
                area=area._replace(left=area.left + number * width, right=area.right + number * width),
                run=partial(finish, self.session, name),
            )
            for number, name in enumerate(FINISHES)
        ]

    def begin(self) -> None:
        """Mixing begins: note the paints, and look up the recent colors."""
        self._before = {each.name: each.paint for each in self.session.scene.surfaces}
        self._recent = recent_colors()[:MOST_RECENT]

    def end(self) -> None:
        """Mixing ends: note the new colors of the surfaces as recent colors."""
        for surface in self.session.scene.surfaces:
            before, now = self._before.get(surface.name, surface.paint), surface.paint
            olds, news = (paint.ramp or (paint.light_color, paint.object_color) for paint in (before, now))
            if (before.ramp is None) == (now.ramp is None):
                # Adding or removing a color of a ramp moves the others, which are not new.
                mixed = [color for color in dict.fromkeys(news) if color not in olds]
                for color in mixed[-MOST_RECENT:]:
                    note_color(color)

    def _take_recent(self, number: int) -> None:
        self._take(self._recent[number], "")

    def _take_number(self, number: int) -> None:
        page, self._taken = self.page, number
        red, green, blue = page.colors[number].tolist()
        self._take((red, green, blue), page.names[number] if page.names else "")

    def _step(self, present: Color, step: int) -> None:
        """Take the color that is a step further on the page than the present one.

        If several paints have the present color, the paint that was taken last counts as the present paint.
        """
        is_present = (self.page.colors == present).all(axis=1)
        if is_present.any():
            places = np.flatnonzero(is_present).tolist()
            number = self._taken if self._taken in places else places[0]
            self._take_number((number + step) % len(is_present))
        else:
            self._take_number(0 if step > 0 else len(is_present) - 1)


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
    hint_of: Callable[[int], str] | None = None
    """Gives the text of the message line for a cell; without it, the help is for all cells."""
    row_lines: ClassVar[int] = CELL_LINES

    def hint_at(self, place: Place) -> str:
        number = self.cell_at(place)
        return self.hint if number is None or self.hint_of is None else self.hint_of(number)

    @property
    def _left(self) -> int:
        """The first element of the cells, which are in the middle of the area."""
        return self.area.left + (self.area.width - self.across * self.width) // 2

    def items(self, lit: bool) -> list[Item]:
        place = self._left, self.area.top
        return list(_cells(self.words.tobytes(), place, self.across, self.width, self.height))

    def cell_at(self, place: Place) -> int | None:
        """The number of the cell at a place, if there is one."""
        column, row = (
            (place.element - self._left) // self.width,
            (place.line - self.area.top) // self.height,
        )
        number = row * self.across + column
        is_there = 0 <= column < self.across and 0 <= number < len(self.words)
        return number if is_there else None

    def pick(self, place: Place) -> object:
        number = self.cell_at(place)
        return None if number is None else self.take(number)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.pick(place)

    def nudge(self, steps: float) -> object:
        return self.step(1 if steps > 0 else -1)


@dataclass(frozen=True)
class PaintField(SwatchField):
    """A page of colors as a row of the menu."""

    row_lines: ClassVar[int] = COLUMNS * CELL_LINES


@lru_cache(maxsize=8)
def _cells(data: bytes, place: tuple[int, int], across: int, width: int, height: int) -> tuple[Item, ...]:
    words = np.frombuffer(data, np.uint16)
    if not len(words):
        return ()
    rows = -(-len(words) // across)
    grid = np.full(rows * across, NIGHT, np.uint16)
    grid[: len(words)] = words
    cells = grid.reshape(rows, across).repeat(height, axis=0).repeat(width, axis=1)
    # The ground shows between the cells, at the right and lower edge of each cell.
    cells[height - 1 :: height] = NIGHT
    cells[:, width - 1 :: width] = NIGHT
    return (image(cells, *place),)
