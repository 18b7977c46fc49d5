"""The color mixing screen: the two colors of a surface, and the blend bar between them; or two of its ramp.

Paper: Figure 13. The light source color is above, the object color below, each with all its intensities at
the left of its bars; in the horizontal bar between them, intensity rises to the right. Mixing shows its
result at once: only entries change, and the words of the picture stay. "This array is simply retransmitted to
the display after color mixing is completed."

If the surface has a ramp, the bar between shows it, and its handle is at the chosen color. The sections have
the bars of two neighboring colors of the ramp: the higher one above, the lower one below.

Hue, saturation and value have bars below those of the paper. The picture below the bars shows the surface as
large as the screen allows; paints and colors can be taken from it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.errors import UsageError
from autocolor.mapping.colors import (
    FULL,
    Hsv,
    blend_from,
    blend_level,
    color_of_hsv,
    hsv_of,
    white_of,
    with_white,
)
from autocolor.mapping.ranges import LevelRange
from autocolor.scene.changes import PaintChanges
from autocolor.scene.kinds import in_digits
from autocolor.scene.surfaces import MOST_RAMP_COLORS, Paint
from autocolor.scene.swatches import mixed
from autocolor.screens.cached import Cached
from autocolor.screens.input import Gesture
from autocolor.screens.picture.over_picture import surface_row
from autocolor.screens.screen import Content, Sample, Screen, Surroundings, surface_of
from autocolor.screens.session import Session
from autocolor.screens.surface.mixing_palette import Crop, MixingWords, crop_of, mixing_words
from autocolor.screens.surface.paint_choices import PaintChoices
from autocolor.screens.surface.painting import (
    FIRST_RAMP_COLORS,
    change_paint,
    color_of,
    paint_rows,
    take_paint,
)
from autocolor.widgets.bars import ComponentBar, LevelBar, RampBar, level_strip
from autocolor.widgets.items import (
    BLUE,
    CHARACTER,
    GREEN,
    LIGHT_GRAY,
    RED,
    WHITE,
    Area,
    Item,
    image,
    text,
)
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import (
    MARGIN,
    ROW_LINES,
    TEXT_DOWN,
    Button,
    Entry,
    Gap,
    Widget,
)

LEFT: Final = 8
LEFT_END: Final = 172
"""The columns of the shades."""

RIGHT: Final = 176
RIGHT_END: Final = 495
"""The column of the bars."""

BAR_LINES: Final = 11
"""The height of each of the seven bars of a color."""

SECTION_LINES: Final = 7 * BAR_LINES

LIGHT_TOP: Final = WORK.top + 4
BLEND_TOP: Final = LIGHT_TOP + SECTION_LINES + 1
BLEND: Final = Area(LEFT, BLEND_TOP + 12, RIGHT_END, BLEND_TOP + 42)
"""The blend bar, below its heading."""

OBJECT_TOP: Final = BLEND.bottom + 3
FINISHES_TOP: Final = OBJECT_TOP + SECTION_LINES + 2
"""The first lines of the sections, of the heading of the bar between, and of the row of finishes."""

PICTURE: Final = Area(LEFT, FINISHES_TOP + ROW_LINES + 2, RIGHT_END, WORK.bottom)
"""The room for the picture of the surface."""

FINISHES_ROW: Final = Area(LEFT, FINISHES_TOP, RIGHT_END, FINISHES_TOP + ROW_LINES - 1)

HEX_ELEMENTS: Final = CHARACTER * len("#rrggbb") + 2 * MARGIN
"""The width of the number of a color at the end of its heading."""

COMPONENTS: Final = (("red", RED), ("green", GREEN), ("blue", BLUE))

OBJECT: Final = "object"
LIGHT_SOURCE: Final = "light source"
"""The names of the two colors for users."""

Ramp = tuple[Color, ...]

FEW: Final = "a ramp has at least 2 colors; to have none, switch the ramp off"
MANY: Final = f"a ramp has at most {MOST_RAMP_COLORS:,} colors; remove a color first"
"""Why a color of a ramp can be neither removed nor added."""

PAINT: Final = "paint"
COLOR: Final = "color"
"""The things that can be taken from the picture."""


class MixingScreen(Screen):
    """The colors of the chosen surface."""

    name = "mixing"
    title = "color mixing"
    word = "colors"
    help = "Drag the bars to mix colors; the bar between blends them, or picks from a ramp"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.light = ColorSection(session, LIGHT_SOURCE, LIGHT_TOP, self._paint, self._choose)
        self.object = ColorSection(session, OBJECT, OBJECT_TOP, self._paint, self._choose)
        self._chosen = self.object
        """The section of the color that swatches are for."""
        self.choices = PaintChoices(session, self._take)
        self._taking = ""
        """The thing that the user picks in the whole picture: PAINT, COLOR, or nothing."""
        self._crop: Cached[Crop] = Cached()
        self._picture: Cached[Item] = Cached()

    def enter(self) -> None:
        self.choices.begin()

    def leave(self) -> None:
        self._taking = ""
        self.choices.end()

    # Widgets and items.

    def build(self, around: Surroundings) -> Content:
        return Content(
            items=self._items(),
            loads=self._loads(),
            rows=self._rows,
            widgets=self._widgets(),
            hint=self._hint,
            sample=self._sample,
            color_at=self._color_at,
            take_color=self._take_color,
            pick=self._pick,
            escape=self._escape,
        )

    def _rows(self) -> Sequence[Widget]:
        surface = self.session.chosen_surface
        if surface is None:
            return []
        ramp = surface.paint.ramp
        switch, *blend = paint_rows(self.session, surface.paint)
        return [
            surface_row(self.session, "The surface whose colors you mix.", self._choose_surface),
            Gap("colors gap"),
            switch,
            self.light.row(surface.paint),
            self.object.row(surface.paint),
            # With a ramp there are as many rows as without, so that the rows below stay in their places.
            *(blend if ramp is None else self._ramp_rows(ramp)),
            Gap("taking gap"),
            *(self._taking_row(thing) for thing in (PAINT, COLOR)),
            *(() if self._taking else self._choice_rows(surface.paint)),
        ]

    def _choice_rows(self, paint: Paint) -> list[Widget]:
        chosen = self._chosen
        name, present = chosen.name_in(paint), chosen.color_of(paint)
        return self.choices.rows(self._mixing_words.swatches, name, present)

    def _ramp_rows(self, ramp: Ramp) -> list[Widget]:
        shown = self.object.number_in(ramp) + 1
        chosen = self._chosen.number_in(ramp) + 1
        return [
            Button(
                "add color",
                f"Add a color to the ramp, between the colors {shown} and {shown + 1}.",
                run=partial(self._add_color, ramp),
                why_not=MANY if len(ramp) == MOST_RAMP_COLORS else "",
            ),
            Button(
                "remove color",
                f"Remove color {chosen}, the chosen one, from the ramp.",
                run=partial(self._remove_color, ramp),
                why_not=FEW if len(ramp) == 2 else "",
            ),
        ]

    def _taking_row(self, thing: str) -> Button:
        is_on = self._taking == thing
        return Button(
            f"take {thing}",
            "Stop picking." if is_on else f"{self._prompt(thing)}.",
            run=self._escape if is_on else partial(self._begin_taking, thing),
            is_chosen=is_on,
        )

    def _widgets(self) -> Sequence[Widget]:
        surface = self.session.chosen_surface
        if surface is None or self._taking:
            return []
        mixing = self._mixing_words
        at_levels = self.session.studio.display_image.words_at_levels(surface.name)
        if surface.paint.ramp is not None:
            blend_bar: LevelBar = RampBar(
                "ramp bar",
                "The ramp: pick a color to mix it.",
                words=mixing.shown[at_levels],
                colors=len(surface.paint.ramp),
                color=self._chosen.number_in(surface.paint.ramp),
                choose=self._choose_color,
            )
        else:
            blend_bar = LevelBar(
                "blend bar",
                "Above the handle the object color gives way to the light color.",
                words=mixing.shown[at_levels],
                level=blend_level(surface.paint.blend, self._levels.levels),
                put=self._put_level,
            )
        return [
            *self.light.widgets(surface.paint, self._chosen is self.light, mixing.hues),
            blend_bar.at(BLEND),
            *self.object.widgets(surface.paint, self._chosen is self.object, mixing.hues),
            *self.choices.finishes(FINISHES_ROW),
        ]

    def _items(self) -> Sequence[Item]:
        surface = self.session.chosen_surface
        if surface is None:
            return [text("The scene has no surface in use.", LEFT, LIGHT_TOP + TEXT_DOWN, LIGHT_GRAY)]
        if self._taking:
            return [self._picture_item()]
        mixing, label, blend = self._mixing_words, *self._blend_text(surface.paint)
        return [
            *self.light.items(mixing.light_shades),
            *self.object.items(mixing.object_shades),
            text(label, LEFT + MARGIN, BLEND_TOP + TEXT_DOWN, LIGHT_GRAY),
            text(blend, RIGHT_END + 1 - CHARACTER * len(blend), BLEND_TOP + TEXT_DOWN),
            self._picture_item(),
        ]

    def _loads(self) -> Sequence[tuple[int, Bytes]]:
        surface = self.session.chosen_surface
        if surface is None or self._taking:
            return []
        light, object_color = (section.color_of(surface.paint) for section in (self.light, self.object))
        return self._mixing_words.loads(light, object_color, self.choices.colors)

    def _hint(self, element: int, line: int) -> str:
        sample = self._sample(element, line)
        if sample is None:
            return self._prompt(self._taking) if self._taking else self.help
        name = sample.surface
        is_chosen = name == self.session.surface_name
        if self._taking == COLOR:
            where = name or "the background"
            return f"pick {in_digits(sample.color)} of {where} as {self._chosen_name}; Esc ends"
        if self._taking and name and not is_chosen:
            paint = self.session.scene.surfaces[name].paint
            if paint.ramp is not None:
                return f"pick the paint of {name}: a ramp of {len(paint.ramp)} colors; Esc ends"
            colors = f"{in_digits(paint.object_color)} and {in_digits(paint.light_color)}"
            return f"pick the paint of {name}: {colors}, blend {paint.blend:.2f}; Esc ends"
        if self._taking:
            return self._prompt(PAINT)
        if is_chosen:
            meaning = self.session.studio.display_image.meaning
            return f"{name}, {meaning} {sample.level} of {self._levels.levels - 1}"
        return f"{name}: click to mix its colors; P: take its paint" if name else self.help

    def _prompt(self, thing: str) -> str:
        """The message that says what a pick in the picture will do."""
        name = self.session.surface_name
        if thing == PAINT:
            return f"pick a surface: {name} takes both its colors, blend and percentage; Esc ends"
        return f"pick a pixel: its color as you see it becomes {self._chosen_name}; Esc ends"

    @property
    def _chosen_name(self) -> str:
        surface = self.session.chosen_surface
        return "" if surface is None else self._chosen.name_in(surface.paint)

    @property
    def _levels(self) -> LevelRange:
        return self.session.studio.level_ranges[self.session.surface_name]

    @property
    def _mixing_words(self) -> MixingWords:
        ranges = tuple(self.session.studio.level_ranges.items())
        return mixing_words(ranges, self.session.surface_name, self.choices.count)

    @property
    def _present_crop(self) -> Crop:
        """The part of the picture that is shown: the chosen surface, or the whole picture to take from it."""
        words, levels = self.session.studio.words, self._levels

        def compute() -> Crop:
            if self._taking:
                return crop_of(np.ones(words.shape, np.bool_), WORK)
            return crop_of((words >= levels.first) & (words <= levels.last), PICTURE)

        return self._crop.of(compute, words, self._taking, self.session.surface_name)

    def _picture_item(self) -> Item:
        """The picture in the words that stand for its words; the same item until it changes."""
        studio, crop = self.session.studio, self._present_crop
        stand_ins = None if self._taking else self._mixing_words.dimmed(studio.entries)

        def draw() -> Item:
            words = crop.of(studio.words)
            return image(words if stand_ins is None else stand_ins[words], crop.area.left, crop.area.top)

        return self._picture.of(draw, crop, stand_ins)

    def _blend_text(self, paint: Paint) -> tuple[str, str]:
        """The heading of the bar between, and its number."""
        levels = self._levels.levels
        label = "blend" if paint.ramp is None else "ramp"
        if self.session.surface_name in self.session.studio.display_image.bands:
            return label, "not shown: a scalar colors the surface"
        if paint.ramp is not None:
            return label, f"color {self._chosen.number_in(paint.ramp) + 1} of {len(paint.ramp)}"
        return label, f"{paint.blend:.2f}, from level {blend_level(paint.blend, levels)} of {levels - 1}"

    def _sample(self, element: int, line: int) -> Sample | None:
        if self.session.chosen_surface is None:
            return None
        pixel, studio = self._present_crop.pixel_at(element, line), self.session.studio
        if pixel is None:
            return None
        word = int(studio.words[pixel])
        name = surface_of(studio, word)
        red, green, blue = studio.entries[word].tolist()
        return Sample(name, (red, green, blue), word - studio.level_ranges[name].first if name else 0)

    # Actions.

    def _pick(self, gesture: Gesture) -> None:
        element, line = gesture.element, gesture.line
        sample, section = self._sample(element, line), self._section_at(element, line)
        if self._taking:
            self._pick_to_take(sample)
        elif section is not None:
            self._choose(section)
        elif sample is not None and sample.surface:
            self._choose_surface(sample.surface)
            self.session.tell(f"surface {self.session.surface_name}")

    def _pick_to_take(self, sample: Sample | None) -> None:
        """Take the paint or the color of a sample. Raises UsageError beside the surfaces; picking goes on."""
        if sample is None or (self._taking == PAINT and not sample.surface):
            raise UsageError(f"no surface is there; {self._prompt(self._taking)}")
        if self._taking == PAINT:
            take_paint(self.session, sample.surface)
        else:
            self._take(sample.color)
        self._taking = ""

    def _begin_taking(self, thing: str) -> None:
        self._taking = thing
        self.session.tell(self._prompt(thing))

    def _escape(self) -> bool:
        was_taking, self._taking = bool(self._taking), ""
        return was_taking

    def _take_color(self, color: Color | str, element: int, line: int) -> None:
        section = self._section_at(element, line)
        if section is not None:
            self._chosen = section
        self._take(color)

    def _color_at(self, element: int, line: int) -> Color | None:
        surface, section = self.session.chosen_surface, self._section_at(element, line) or self._chosen
        return None if surface is None else section.color_of(surface.paint)

    def _section_at(self, element: int, line: int) -> ColorSection | None:
        sections = () if self._taking else (self.light, self.object)
        return next((section for section in sections if section.area.has(element, line)), None)

    def _choose(self, section: ColorSection) -> None:
        self._chosen = section
        self.session.tell(f"swatches are for {self._chosen_name}")

    def _choose_color(self, number: int) -> None:
        """Choose a color of the ramp, and show it with the color after it, or before it if it is the last."""
        surface = self.session.chosen_surface
        if surface is not None and surface.paint.ramp is not None:
            last = len(surface.paint.ramp) - 1
            self.light.lower = self.object.lower = min(number, last - 1)
            self._choose(self.light if number == last else self.object)

    def _add_color(self, ramp: Ramp) -> None:
        lower = self.object.number_in(ramp)
        color = mixed(ramp[lower], ramp[lower + 1], 0.5)
        change_paint(self.session, ramp=(*ramp[: lower + 1], color, *ramp[lower + 1 :]))
        self._choose_color(lower + 1)

    def _remove_color(self, ramp: Ramp) -> None:
        number = self._chosen.number_in(ramp)
        change_paint(self.session, ramp=ramp[:number] + ramp[number + 1 :])
        self._choose_color(min(number, len(ramp) - 2))

    def _choose_surface(self, name: str) -> None:
        self.choices.end()
        self.session.choose_surface(name)
        self.choices.begin()

    def _paint(self, section: ColorSection, color: Sequence[int] | str) -> None:
        """Give the chosen surface a color."""
        self._chosen = section
        surface = self.session.chosen_surface
        if surface is not None:
            change_paint(self.session, **section.change(surface.paint, color_of(self.session, color)))

    def _put_level(self, level: int) -> None:
        change_paint(self.session, blend=blend_from(level, self._levels.levels))

    def _take(self, color: Color | str, name: str = "") -> None:
        """Give the chosen color of the chosen surface a value, the color of a paint with a name."""
        self._paint(self._chosen, color)
        surface = self.session.chosen_surface
        if surface is not None:
            label = self._chosen.label_in(surface.paint)
            digits = in_digits(self._chosen.color_of(surface.paint))
            self.session.tell(f"{label}: {f'{name}, ' if name else ''}{digits}")


# A section: one of the two colors of the chosen surface, with its shades and bars.


class Raised(NamedTuple):
    """The last use of the white bar: a surface, its color before, and the color that the bar gave."""

    surface: str
    start: Color
    to: Color


class Mixed(NamedTuple):
    """The last use of the bars of hue, saturation and value, and the color that they gave."""

    hsv: Hsv
    to: Color


HSV: Final = (("hue", 360, "degrees"), ("saturation", 100, "percent"), ("value", 100, "percent"))
"""The names, the largest numbers and the units of the bars of `Hsv`."""


class ColorSection:
    """The shades and the bars of one color of a paint. `top` is the first line, `title` names the color.

    In a paint with a ramp it is a color of the ramp: the color with the number `lower`, from 0, or in the
    section of the light source the color after it.

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
        # A ramp that is switched on begins with the color at which the default blend begins.
        self.lower = FIRST_RAMP_COLORS // 2
        self._give, self._choose = partial(give, self), partial(choose, self)
        self._raised = Raised("", (0, 0, 0), (0, 0, 0))
        self._mixed = Mixed(Hsv(0, 0, 0), (0, 0, 0))
        self._heading = Area(LEFT, top, LEFT_END, top + ROW_LINES - 1)
        self.shades = Area(LEFT, top + ROW_LINES, LEFT_END, top + SECTION_LINES - 1)
        self.area = Area(LEFT, top, RIGHT_END, top + SECTION_LINES - 1)
        """The heading, the shades and the bars."""

    def color_of(self, paint: Paint) -> Color:
        """The color in a paint."""
        if paint.ramp is not None:
            return paint.ramp[self.number_in(paint.ramp)]
        return paint.object_color if self.title == OBJECT else paint.light_color

    def number_in(self, ramp: Ramp) -> int:
        """The number of the color in a ramp, from 0. The ramp may have become shorter."""
        return min(self.lower, len(ramp) - 2) + (self.title == LIGHT_SOURCE)

    def label_in(self, paint: Paint) -> str:
        """The label of the color of a paint: "object", or "color 2" of a ramp."""
        return self.title if paint.ramp is None else f"color {self.number_in(paint.ramp) + 1}"

    def name_in(self, paint: Paint) -> str:
        """The name of the color of a paint in a sentence: "the object color", or "color 2 of 5"."""
        if paint.ramp is None:
            return f"the {self.title} color"
        return f"{self.label_in(paint)} of {len(paint.ramp)}"

    def change(self, paint: Paint, color: Sequence[int] | str) -> PaintChanges:
        """The change of a paint that puts the color into it."""
        if paint.ramp is not None:
            number = self.number_in(paint.ramp)
            return {"ramp": (*paint.ramp[:number], color, *paint.ramp[number + 1 :])}
        return {"object_color": color} if self.title == OBJECT else {"light_color": color}

    def items(self, shades: Words) -> list[Item]:
        """The shades in their words, from the darkest at the left."""
        return [level_strip(shades.tobytes(), self.shades)]

    def widgets(self, paint: Paint, is_chosen: bool, hues: Words) -> list[Widget]:
        """The heading with the number of the color, and the bars; `hues` are the words of the hue bar."""
        color, label, name = self.color_of(paint), self.label_in(paint), self.name_in(paint)
        heading = SectionHeading(
            label,
            f"{_capitalized(name)}: click to pick swatches for it; Ctrl+C copies it.",
            run=self._choose,
            is_chosen=is_chosen,
        )
        bars = [
            ComponentBar(
                f"{label}, {component}",
                f"{component.capitalize()} of {name}, 0 to {FULL}.",
                value=color[number],
                put=partial(self._put_component, number),
                word=word,
                letter=component[0].upper(),
            )
            for number, (component, word) in enumerate(COMPONENTS)
        ]
        white = ComponentBar(
            f"{label}, white",
            "Tints and shades: adds the same to red, green and blue; each stops at its ends.",
            value=white_of(color),
            put=self._put_white,
            word=WHITE,
            letter="W",
        )
        hsv = self._hsv_of(color)
        by_hue = [
            ComponentBar(
                f"{label}, {part}",
                f"{part.capitalize()} of {name}, 0 to {most} {unit}.",
                value=hsv[number],
                high=most,
                put=partial(self._put_hsv, number),
                word=LIGHT_GRAY,
                letter=part[0].upper(),
                strip=hues.tobytes() if part == "hue" else b"",
            )
            for number, (part, most, unit) in enumerate(HSV)
        ]
        return [
            heading.at(self._heading._replace(right=LEFT_END - HEX_ELEMENTS)),
            self.row(paint, "heading").at(self._heading._replace(left=LEFT_END + 1 - HEX_ELEMENTS)),
            *(bar.at(self._bar_area(number)) for number, bar in enumerate([*bars, white, *by_hue])),
        ]

    def row(self, paint: Paint, within: str = "") -> Entry:
        """The row of a menu, or the number `within` the heading, over which the color is typed."""
        name = self.name_in(paint)
        help = f"{_capitalized(name)} by its name or number, such as teal or #b01020."
        value = in_digits(self.color_of(paint))
        label = self.title.split()[0] if paint.ramp is None else self.label_in(paint)
        return Entry(label, help, within=within, value=value, take=self._give)

    def _bar_area(self, number: int) -> Area:
        top = self.area.top + number * BAR_LINES
        return Area(RIGHT, top, RIGHT_END, top + BAR_LINES - 1)

    def _put_component(self, number: int, value: float) -> None:
        component, color = whole(COMPONENTS[number][0], value), self._present
        self._give((*color[:number], component, *color[number + 1 :]))

    def _put_white(self, value: float) -> None:
        """Raise or lower the color, again from the color with which the bar was first moved.

        Assumed: so the bar brings back a color even if some components have reached 0 or 255 on the way.
        """
        surface, color = self.session.surface_name, self._present
        if (surface, color) != (self._raised.surface, self._raised.to):
            self._raised = Raised(surface, color, color)
        to = with_white(self._raised.start, whole("white", value))
        self._raised = self._raised._replace(to=to)
        self._give(to)

    def _hsv_of(self, color: Color) -> Hsv:
        """The hue, saturation and value of a color. If the bars gave the color, these are their values.

        Assumed: so a gray that the bars gave keeps its hue, and black keeps its saturation, too.
        """
        return self._mixed.hsv if color == self._mixed.to else hsv_of(color)

    def _put_hsv(self, number: int, value: float) -> None:
        name, most, _ = HSV[number]
        if not 0 <= value <= most:
            raise UsageError(f"{name} must be a number from 0 to {most}, not {value:g}; type another")
        hsv = list(self._hsv_of(self._present))
        hsv[number] = value
        self._mixed = Mixed(Hsv(*hsv), color_of_hsv(Hsv(*hsv)))
        self._give(self._mixed.to)

    @property
    def _present(self) -> Color:
        """The color that the chosen surface has now."""
        return self.color_of(self.session.scene.surfaces[self.session.surface_name].paint)


def _capitalized(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}"


@dataclass(frozen=True)
class SectionHeading(Button):
    """The heading of a section. Its key differs from the key of a menu row with the same label."""

    @property
    def key(self) -> str:
        return f"{self.label} heading"


def whole(name: str, value: float) -> int:
    """The value of a component. Raises UsageError if it is not a whole number from 0 to 255."""
    if not 0 <= value <= FULL or value != int(value):
        raise UsageError(f"{name} must be a whole number from 0 to {FULL}, not {value:g}; type another")
    return int(value)
