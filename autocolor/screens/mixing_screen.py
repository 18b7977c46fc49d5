"""The color mixing screen: the two colors of a surface, and the blend bar between them.

Paper: Figure 13. The light source color is above, the object color below, each with all its intensities at
the left of its bars; in the horizontal bar between them, intensity rises to the right. What is mixed is seen
at once: only entries change, and the words of the small picture stay. "This array is simply retransmitted to
the display after color mixing is completed."
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.files.state import note_color, recent_colors
from autocolor.immutable import read_only
from autocolor.mapping.colors import FULL, blend_from, blend_level, entries_of, white_of, with_white
from autocolor.mapping.ranges import WORDS, LevelRange, borrowed_words, without_words
from autocolor.scene.changes import PaintChanges
from autocolor.scene.kinds import in_digits
from autocolor.scene.surfaces import Paint, Surface
from autocolor.scene.swatches import COLUMNS, FINISHES, ROWS, finished, swatches
from autocolor.screens.input import Gesture
from autocolor.screens.picture.over_picture import surface_row
from autocolor.screens.screen import Screen
from autocolor.screens.session import Session
from autocolor.widgets.bars import ComponentBar, LevelBar, level_strip
from autocolor.widgets.items import (
    BLUE,
    CHARACTER,
    GREEN,
    HEIGHT,
    LIGHT_GRAY,
    NIGHT,
    RED,
    WHITE,
    WIDTH,
    Area,
    Item,
    fitted,
    image,
    text,
)
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import MARGIN, ROW_LINES, TEXT_DOWN, Button, Entry, Gap, Place, Widget

LEFT: Final = 8
LEFT_END: Final = 167
"""The column of the ramps."""

RIGHT: Final = 176
RIGHT_END: Final = 495
"""The column of the bars."""

BAR_LINES: Final = 24
"""The height of each of the four bars."""

LIGHT_TOP: Final = 8
BLEND_TOP: Final = 120
OBJECT_TOP: Final = 176
"""The first lines of the sections and of the bar, each with a heading of ROW_LINES."""

BLEND: Final = Area(LEFT, BLEND_TOP + ROW_LINES, RIGHT_END, OBJECT_TOP - 1)
"""The blend bar."""

TOP: Final = 296
"""The first line of the small picture's heading and of the choices."""

HALF: Final = (RIGHT_END + 1 - RIGHT) // 2
"""The elements of a heading, and of a finish."""

SWATCH_ELEMENTS: Final = 16
SWATCH_LINES: Final = 14
SWATCHES: Final = Area(RIGHT, TOP + ROW_LINES, RIGHT_END, TOP + ROW_LINES + ROWS * SWATCH_LINES - 1)
"""The field of swatches, and the size of a swatch."""

RECENT: Final = Area(RIGHT, 392, RIGHT_END, 415)
RECENT_ELEMENTS: Final = 26
"""The recent colors, and the width of a color."""

SCALE: Final = 4
"""Lines and elements of the picture for one of the small picture."""

SMALL: Final = Area(LEFT, TOP + ROW_LINES, LEFT + WIDTH // SCALE - 1, TOP + ROW_LINES + HEIGHT // SCALE - 1)
"""The small picture."""

COMPONENTS: Final = (("red", RED), ("green", GREEN), ("blue", BLUE))

OBJECT: Final = "object"
LIGHT_SOURCE: Final = "light source"
"""The names of the two colors for users."""


class MixingScreen(Screen):
    """The colors of the chosen surface."""

    name = "mixing"
    title = "color mixing"
    help = "Drag the bars to mix the colors; drag the bar between to blend them"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.light = ColorSection(session, LIGHT_SOURCE, LIGHT_TOP, self._paint, self._choose)
        self.object = ColorSection(session, OBJECT, OBJECT_TOP, self._paint, self._choose)
        self._chosen = self.object
        """The section of the color that swatches are for."""
        self.choices = PaintChoices(session, self._take)
        self._small: tuple[Words, Words, Item] | None = None

    def enter(self) -> None:
        self.choices.begin()

    def leave(self) -> None:
        self.choices.end()

    # What is seen.

    def rows(self) -> Sequence[Widget]:
        surface = self.session.chosen_surface
        if surface is None:
            return []
        colors = ("object_color", "light_color")
        rows = rows_of(surface.paint, self._put, self.session.world, leave_out=colors)
        return [
            surface_row(self.session, "The surface whose colors you mix.", self._choose_surface),
            Gap("colors gap"),
            self.light.row(surface.paint),
            self.object.row(surface.paint),
            # The names of the columns, such that they fit beside their numbers.
            *(replace(row, label=row.label.replace("percentage", "percent")) for row in rows),
        ]

    def widgets(self) -> Sequence[Widget]:
        surface = self.session.chosen_surface
        if surface is None:
            return []
        at_levels = self.session.studio.image.words_at_levels(surface.name)
        blend_bar = LevelBar(
            "blend bar",
            "Above the handle the object color gives way to the light color.",
            words=self._palette.shown[at_levels],
            level=blend_level(surface.paint.blend, self._levels.levels),
            put=self._put_level,
        )
        return [
            *self.light.widgets(surface.paint, self._chosen is self.light),
            blend_bar.at(BLEND),
            *self.object.widgets(surface.paint, self._chosen is self.object),
            *self.choices.widgets(surface, self._palette.swatches, self._chosen.title),
        ]

    def items(self) -> Sequence[Item]:
        surface = self.session.chosen_surface
        if surface is None:
            return [text("The scene has no surface in use.", LEFT, LIGHT_TOP + TEXT_DOWN, LIGHT_GRAY)]
        palette, blend = self._palette, self._blend_text(surface.paint)
        return [
            *self.light.items(palette.light_ramp),
            *self.object.items(palette.object_ramp),
            text("blend", LEFT + MARGIN, BLEND_TOP + TEXT_DOWN, LIGHT_GRAY),
            text(blend, RIGHT_END + 1 - CHARACTER * len(blend), BLEND_TOP + TEXT_DOWN),
            text(
                fitted(surface.name, SMALL.width // CHARACTER - 1),
                LEFT + MARGIN,
                TOP + TEXT_DOWN,
                LIGHT_GRAY,
            ),
            self._small_picture(),
            *self.choices.items(),
        ]

    def loads(self) -> Sequence[tuple[int, Bytes]]:
        surface = self.session.chosen_surface
        if surface is None:
            return []
        return self._palette.loads(surface.paint.light_color, surface.paint.object_color, self.choices.colors)

    def hint(self, element: int, line: int) -> str:
        if self.session.chosen_surface is None or not SMALL.has(element, line):
            return self.help
        words = self.session.studio.words[::SCALE, ::SCALE]
        down, across = line - SMALL.top, element - SMALL.left
        levels = self._levels
        if down < words.shape[0] and across < words.shape[1]:
            level = int(words[down, across]) - levels.first
            if 0 <= level < levels.levels:
                what = self.session.studio.image.meaning
                return f"{self.session.surface_name}, {what} {level} of {levels.levels - 1}"
        return f"Only {self.session.surface_name} is shown here"

    @property
    def _levels(self) -> LevelRange:
        return self.session.studio.level_ranges[self.session.surface_name]

    @property
    def _palette(self) -> Palette:
        ranges = tuple(self.session.studio.level_ranges.items())
        return palette_of(ranges, self.session.surface_name, self.choices.count)

    def _small_picture(self) -> Item:
        """The chosen surface in the picture, at a quarter of its size; the same item until it changes."""
        words, stand_ins = self.session.studio.words, self._palette.shown
        if self._small is None or self._small[0] is not words or self._small[1] is not stand_ins:
            small = stand_ins[words[::SCALE, ::SCALE][: SMALL.height, : SMALL.width]]
            self._small = words, stand_ins, image(small, SMALL.left, SMALL.top)
        return self._small[2]

    def _blend_text(self, paint: Paint) -> str:
        levels = self._levels.levels
        return f"{paint.blend:.2f}, from level {blend_level(paint.blend, levels)} of {levels - 1}"

    # What is done.

    def pick(self, gesture: Gesture) -> None:
        for section in (self.light, self.object):
            if section.ramp.has(gesture.element, gesture.line):
                self._choose(section)

    def _choose(self, section: ColorSection) -> None:
        self._chosen = section
        self.session.tell(f"swatches are for the {section.title}")

    def _choose_surface(self, name: str) -> None:
        self.choices.end()
        self.session.choose_surface(name)
        self.choices.begin()

    def _paint(self, section: ColorSection, color: Sequence[int] | str) -> None:
        """Give the chosen surface a color."""
        self._chosen = section
        self._put(section.change(color))

    def _put(self, changes: Mapping[str, Any]) -> None:
        self.session.edit(self.session.scene.with_paint(self.session.surface_name, **changes))

    def _put_level(self, level: int) -> None:
        self.session.paint(blend=blend_from(level, self._levels.levels))

    def _take(self, color: Color) -> None:
        self._paint(self._chosen, color)
        self.session.tell(f"{self._chosen.title}: {in_digits(color)}")


# A section: one of the two colors of the chosen surface, with its ramp and bars.


class Raised(NamedTuple):
    """The last use of the white bar: a surface, its color before, and the color that the bar gave."""

    surface: str
    start: Color
    to: Color


class ColorSection:
    """One color of a paint, by its title, and where it stands from a line on.

    `give` gives the chosen surface another color, `choose` makes this the section that swatches are for.
    """

    def __init__(
        self,
        session: Session,
        title: str,
        top: int,
        give: Callable[[ColorSection, Sequence[int] | str], object],
        choose: Callable[[ColorSection], object],
    ) -> None:
        self.session, self.title = session, title
        self._give, self._choose = partial(give, self), partial(choose, self)
        self._raised = Raised("", (0, 0, 0), (0, 0, 0))
        self._heading = Area(LEFT, top, LEFT_END, top + ROW_LINES - 1)
        self.ramp = Area(LEFT, top + ROW_LINES, LEFT_END, top + ROW_LINES + 4 * BAR_LINES - 1)

    def color_of(self, paint: Paint) -> Color:
        """The color in a paint."""
        return paint.object_color if self.title == OBJECT else paint.light_color

    def change(self, color: Sequence[int] | str) -> PaintChanges:
        """The change of a paint that puts the color into it."""
        return {"object_color": color} if self.title == OBJECT else {"light_color": color}

    def items(self, ramp: Words) -> list[Item]:
        """The ramp in its words, from the lowest intensity at the left."""
        return [level_strip(ramp.tobytes(), self.ramp)]

    def widgets(self, paint: Paint, is_chosen: bool) -> list[Widget]:
        """The heading, and the bars."""
        color = self.color_of(paint)
        help = f"The {self.title} color: click to pick swatches for it."
        heading = SectionHeading(
            self.title, help, run=self._choose, value=in_digits(color), is_chosen=is_chosen
        )
        bars = [
            ComponentBar(
                f"{self.title}, {name}",
                f"{name.capitalize()} of the {self.title} color, 0 to {FULL}.",
                value=color[number],
                put=partial(self._put_component, number),
                word=word,
                letter=name[0].upper(),
            )
            for number, (name, word) in enumerate(COMPONENTS)
        ]
        white = ComponentBar(
            f"{self.title}, white",
            "Tints and shades: adds the same to red, green and blue; each stops at its ends.",
            value=white_of(color),
            put=self._put_white,
            word=WHITE,
            letter="W",
        )
        return [
            heading.at(self._heading),
            *(bar.at(self._bar_area(number)) for number, bar in enumerate([*bars, white])),
        ]

    def row(self, paint: Paint) -> Entry:
        """The row of a menu in which the color is typed, by its name or number."""
        help = f"The {self.title} color by its name or number, such as teal or #b01020."
        return Entry(self.title.split()[0], help, value=in_digits(self.color_of(paint)), take=self._give)

    def _bar_area(self, number: int) -> Area:
        top = self.ramp.top + number * BAR_LINES
        return Area(RIGHT, top, RIGHT_END, top + BAR_LINES - 1)

    def _put_component(self, number: int, value: float) -> None:
        component, color = whole(COMPONENTS[number][0], value), self._present
        self._give((*color[:number], component, *color[number + 1 :]))

    def _put_white(self, value: float) -> None:
        """Raise or lower the color, again from the color with which the bar was first moved.

        Assumed: so the bar comes back to a color whose components were at their ends meanwhile.
        """
        surface, color = self.session.surface_name, self._present
        if (surface, color) != (self._raised.surface, self._raised.to):
            self._raised = Raised(surface, color, color)
        to = with_white(self._raised.start, whole("white", value))
        self._raised = self._raised._replace(to=to)
        self._give(to)

    @property
    def _present(self) -> Color:
        """The color that the chosen surface has now."""
        return self.color_of(self.session.scene.surface(self.session.surface_name).paint)


@dataclass(frozen=True)
class SectionHeading(Button):
    """The heading of a section. A row of the menu may have the same label, so its key differs."""

    @property
    def key(self) -> str:
        return f"{self.label} heading"


def whole(name: str, value: float) -> int:
    """The value of a component. Raises UsageError if it is not a whole number from 0 to 255."""
    if not 0 <= value <= FULL or value != int(value):
        raise UsageError(f"{name} must be a whole number from 0 to {FULL}, not {value:g}; type another")
    return int(value)


# The choices below the bars: finishes and recent colors, or a field of swatches.


class PaintChoices:
    """The finishes of the chosen surface, and colors; `take` is called with a color that is picked."""

    def __init__(self, session: Session, take: Callable[[Color], object]) -> None:
        self.session = session
        self._take = take
        self._has_swatches = False
        """Whether the field of swatches is shown, instead of finishes and recent colors."""
        self._recent: tuple[Color, ...] = ()
        self._before: dict[str, Paint] = {}
        """The paints of all surfaces when the mixing began."""

    @property
    def count(self) -> int:
        """The number of colors that can be picked."""
        return len(swatches() if self._has_swatches else self._recent)

    @property
    def colors(self) -> Bytes:
        """The colors that can be picked, (n, 3) uint8."""
        return swatches() if self._has_swatches else np.array(self._recent, np.uint8).reshape(-1, 3)

    def widgets(self, surface: Surface, words: Words, title: str) -> list[Widget]:
        """The headings and the choices. `words` show colors for the color that `title` names."""
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


GROUT: Final = 1
"""Lines and elements of the ground at the right and lower edge of each cell."""


@dataclass(frozen=True)
class SwatchField(Widget):
    """Cells, each filled with a word of its own, row by row from the upper left corner of the area.

    `take` is called with the number of the cell that is picked, and of each cell that a drag comes to. The
    cells may be fewer than fit.
    """

    words: Words = field(default_factory=lambda: np.empty(0, np.uint16))
    across: int = 1
    """Cells in a row."""
    width: int = 16
    height: int = 16
    """Elements and lines of a cell."""
    take: Callable[[int], object] = lambda _: None

    def items(self, lit: bool) -> list[Item]:
        return list(_cells(self.words.tobytes(), self.area, self.across, self.width, self.height))

    def cell_at(self, place: Place) -> int | None:
        """The number of the cell at a place, if there is one."""
        column, row = (
            (place.element - self.area.left) // self.width,
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


@lru_cache(maxsize=8)
def _cells(data: bytes, area: Area, across: int, width: int, height: int) -> tuple[Item, ...]:
    words = np.frombuffer(data, np.uint16)
    if not len(words):
        return ()
    rows = -(-len(words) // across)
    grid = np.full(rows * across, NIGHT, np.uint16)
    grid[: len(words)] = words
    cells = grid.reshape(rows, across).repeat(height, axis=0).repeat(width, axis=1)
    for edge in range(GROUT):
        cells[height - 1 - edge :: height] = NIGHT
        cells[:, width - 1 - edge :: width] = NIGHT
    return (image(cells, area.left, area.top),)


# The words that the screen borrows for the ramps of the two colors and for swatches. A surface may own nearly
# all words, so there are none for these colors between the surfaces; see `borrowed_words`. The chosen surface
# stays visible: where it has to lend words, too, they are spread so that each lent level is shown by its
# neighbor.

RAMP_STEPS: Final = 64
"""The intensities of a ramp, from black to the color itself."""

Ranges = tuple[tuple[str, LevelRange], ...]
"""The level ranges of the surfaces in use by name, so that they can be a key."""


class Palette(NamedTuple):
    """The words that show a surface and the colors beside it."""

    borrowed: Words
    """The words for colors, rising: two ramps of RAMP_STEPS each, then the swatches."""
    runs: tuple[slice, ...]
    """The parts of `borrowed` whose words follow each other."""
    shown: Words
    """The word that stands for each word of the picture, (1024,): NIGHT for words of other surfaces."""

    @property
    def light_ramp(self) -> Words:
        """The words of the intensities of the light color, from the lowest."""
        return self.borrowed[:RAMP_STEPS]

    @property
    def object_ramp(self) -> Words:
        """The words of the intensities of the object color, from the lowest."""
        return self.borrowed[RAMP_STEPS : 2 * RAMP_STEPS]

    @property
    def swatches(self) -> Words:
        """The words of the swatches."""
        return self.borrowed[2 * RAMP_STEPS :]

    def loads(self, light: Color, object_color: Color, swatches: Bytes) -> list[tuple[int, Bytes]]:
        """The entries of the words, as runs of colors from a first entry on; `swatches` has (n, 3)."""
        colors = np.concatenate([ramp_of(light), ramp_of(object_color), swatches])
        return [(int(self.borrowed[run.start]), colors[run]) for run in self.runs]


@lru_cache(maxsize=8)
def palette_of(ranges: Ranges, surface: str, swatches: int) -> Palette:
    """The palette for a surface in use and a number of swatches.

    Raises UsageError if there are not so many words to borrow.
    """
    levels = dict(ranges)[surface]
    borrowed = borrowed_words(dict(ranges), {surface}, 2 * RAMP_STEPS + swatches)
    ends = np.flatnonzero(np.diff(borrowed) != 1) + 1
    bounds = [0, *ends.tolist(), len(borrowed)]
    own = np.arange(levels.first, levels.last + 1, dtype=np.uint16)
    shown = np.full(WORDS, NIGHT, np.uint16)
    shown[own] = without_words(own, borrowed, {surface: levels})
    return Palette(borrowed, tuple(map(slice, bounds, bounds[1:])), read_only(shown))


def ramp_of(color: Color) -> Bytes:
    """The intensities of a color, (RAMP_STEPS, 3) uint8: step k is k / (RAMP_STEPS - 1) of it, half up.

    They are the entries of a surface of that color alone, with as many levels.
    """
    return entries_of(Paint(color, color, blend=1.0), RAMP_STEPS)
