"""The color mixing screen: the two colors of a surface, and the blend bar between them.

Paper: Figure 13. The light source color is above, the object color below, each with all its intensities at
the left of its bars; in the horizontal bar between them, intensity rises to the right. What is mixed is seen
at once: only entries change, and the words of the small picture stay. "This array is simply retransmitted to
the display after color mixing is completed."
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.mapping.color_blending import blend_from, blend_level
from autocolor.mapping.level_ranges import LevelRange
from autocolor.scene.columns.color_kinds import in_digits
from autocolor.scene.surfaces import Paint
from autocolor.screens.colors.color_section import LEFT, LIGHT_SOURCE, OBJECT, RIGHT_END, ColorSection
from autocolor.screens.colors.mixing_palette import Palette, palette_of
from autocolor.screens.colors.paint_choices import TOP as CHOICES_TOP
from autocolor.screens.colors.paint_choices import PaintChoices
from autocolor.screens.input.gestures import Gesture
from autocolor.screens.picture.surface_row import surface_row
from autocolor.screens.screen import Screen
from autocolor.screens.session import Session
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import HEIGHT, LIGHT_GRAY, WIDTH
from autocolor.widgets.column_rows import rows_of
from autocolor.widgets.items import CHARACTER, Item, fitted, image, text
from autocolor.widgets.level_bars import LevelBar
from autocolor.widgets.widget import MARGIN, ROW_LINES, TEXT_DOWN, Gap, Widget

LIGHT_TOP: Final = 8
BLEND_TOP: Final = 120
OBJECT_TOP: Final = 176
"""The first lines of the sections and of the bar, each with a heading of ROW_LINES."""

BLEND: Final = Area(LEFT, BLEND_TOP + ROW_LINES, RIGHT_END, OBJECT_TOP - 1)

SCALE: Final = 4
"""Lines and elements of the picture for one of the small picture."""
SMALL: Final = Area(
    LEFT, CHOICES_TOP + ROW_LINES, LEFT + WIDTH // SCALE - 1, CHOICES_TOP + ROW_LINES + HEIGHT // SCALE - 1
)


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
            surface_row(self.session, "The surface whose colors these are.", self._choose_surface),
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
        palette, told = self._palette, self._blend_told(surface.paint)
        return [
            *self.light.items(palette.light_ramp),
            *self.object.items(palette.object_ramp),
            text("blend", LEFT + MARGIN, BLEND_TOP + TEXT_DOWN, LIGHT_GRAY),
            text(told, RIGHT_END + 1 - CHARACTER * len(told), BLEND_TOP + TEXT_DOWN),
            text(
                fitted(surface.name, SMALL.width // CHARACTER - 1),
                LEFT + MARGIN,
                CHOICES_TOP + TEXT_DOWN,
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
                what = "level" if self.session.studio.image.normals is None else "normal"
                return f"{self.session.surface_name}, {what} {level} of {levels.levels - 1}"
        return f"Only {self.session.surface_name} is shown here"

    @property
    def _levels(self) -> LevelRange:
        return self.session.studio.level_ranges[self.session.surface_name]

    @property
    def _palette(self) -> Palette:
        ranges = tuple(self.session.studio.level_ranges.items())
        return palette_of(ranges, self.session.surface_name, len(self.choices.colors))

    def _small_picture(self) -> Item:
        """The chosen surface in the picture, at a quarter of its size; the same item until it changes."""
        words, stand_ins = self.session.studio.words, self._palette.shown
        if self._small is None or self._small[0] is not words or self._small[1] is not stand_ins:
            small = stand_ins[words[::SCALE, ::SCALE][: SMALL.height, : SMALL.width]]
            self._small = words, stand_ins, image(small, SMALL.left, SMALL.top)
        return self._small[2]

    def _blend_told(self, paint: Paint) -> str:
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
