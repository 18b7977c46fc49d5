"""The color mixing screen: the two colors of a surface, and the blend bar between them; or two of its ramp.

Paper: Figure 13. The light source color is above, the object color below, each with all its intensities at
the left of its bars; in the horizontal bar between them, intensity rises to the right. Mixing shows its
result at once: only entries change, and the words of the picture stay. "This array is simply retransmitted to
the display after color mixing is completed."

If the surface has a ramp, the bar between shows it, and its handle is at the chosen color. The sections have
the bars of two neighboring colors of the ramp: the higher one above, the lower one below.

Hue, saturation and value have bars below those of the paper. The picture below the bars shows the surface as
large as the screen allows, with the finish under the pointer; paints and colors can be taken from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import count
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Words
from autocolor.checks import Color
from autocolor.errors import InputError, UsageError
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
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.ranges import WORDS
from autocolor.scene.kinds import in_digits
from autocolor.scene.surfaces import MOST_RAMP_COLORS, Paint
from autocolor.scene.swatches import FINISHES, mixed
from autocolor.screens.cached import Cached
from autocolor.screens.input import Gesture
from autocolor.screens.picture.over_picture import surface_row
from autocolor.screens.screen import Content, Sample, Screen, Surroundings, surface_of
from autocolor.screens.session import BLENDING, Session
from autocolor.screens.surface.mixing_palette import Crop, MixingWords, crop_of, mixing_words
from autocolor.screens.surface.paint_choices import PaintChoices
from autocolor.screens.surface.painting import (
    FIRST_RAMP_COLORS,
    PaintColor,
    change_paint,
    color_of,
    colors_of,
    edit_paint,
    paint_rows,
    take_paint,
    with_finish,
    with_moved_color,
)
from autocolor.widgets.bars import ComponentBar, LevelBar, RampBar, level_strip
from autocolor.widgets.items import BLUE, CHARACTER, GREEN, LIGHT_GRAY, RED, WHITE, Area, Item, image, text
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN, ROW_LINES, TEXT_DOWN, Button, Entry, Gap, Widget

LEFT: Final = 8
LEFT_END: Final = 172
"""The columns of the shades."""

RIGHT: Final = 176
RIGHT_END: Final = 495
"""The column of the bars."""

BAR_LINES: Final = 11
"""The height of each of the seven bars of a color."""

SECTION_LINES: Final = 7 * BAR_LINES

BLEND_TOP: Final = WORK.top + 4 + SECTION_LINES + 1
BLEND: Final = Area(LEFT, BLEND_TOP + 12, RIGHT_END, BLEND_TOP + 42)
"""The blend bar, below its heading."""

TOPS: Final = BLEND.bottom + 3, WORK.top + 4
"""The first lines of the two sections, the lower section first, which has the object color."""

FINISHES_ROW: Final = Area(
    LEFT, TOPS[0] + SECTION_LINES + 2, RIGHT_END, TOPS[0] + SECTION_LINES + ROW_LINES + 1
)

PICTURE: Final = Area(LEFT, FINISHES_ROW.bottom + 3, RIGHT_END, WORK.bottom)
"""The room for the picture of the surface."""


HEX_LEFT: Final = LEFT_END + 1 - CHARACTER * len("#rrggbb") - 2 * MARGIN
"""The first element of the number of a color, at the end of its heading."""

PAINT: Final = "paint"
COLOR: Final = "color"
"""The things that can be taken from the picture."""

BARS: Final = (
    ("red", FULL, "", RED),
    ("green", FULL, "", GREEN),
    ("blue", FULL, "", BLUE),
    ("white", FULL, "", WHITE),
    ("hue", 360, " degrees", LIGHT_GRAY),
    ("saturation", 100, " percent", LIGHT_GRAY),
    ("value", 100, " percent", LIGHT_GRAY),
)
"""The bars of a color: the name, the largest number, the unit, and the word of each."""

WHITE_BAR: Final = 3
"""The place of the white bar; the bars up to it have whole numbers."""

TINTS: Final = "Tints and shades: adds the same to red, green and blue; each stops at its ends."


class Mixed(NamedTuple):
    """A color that a bar gave."""

    color: Color
    start: Color
    """The color with which the white bar was first moved.

    Assumed: so the bar brings back a color even if some components have reached 0 or 255 on the way.
    """
    hsv: Hsv
    """The numbers of the bars.

    Assumed: so a gray that the bars gave keeps its hue, and black keeps its saturation, too.
    """


class MixingScreen(Screen):
    """The colors of the chosen surface."""

    name = "mixing"
    title = "color mixing"
    word = "colors"
    help = "Drag the bars to mix colors; the bar between blends them, or picks from a ramp"

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.choices = PaintChoices(session, self._take)
        self._is_upper = False
        """Whether the color that swatches are for is in the upper section."""
        # A ramp that is switched on begins with the color at which the default blend begins.
        self._lower = FIRST_RAMP_COLORS // 2
        """The number in a ramp of the color in the lower section. The ramp may have become shorter."""
        self._grabbed: tuple[tuple[Color, ...], int] = (), 0
        """The ramp when a color of it was chosen last, and its number there: a drag moves that color."""
        self._mixed: dict[tuple[str, bool], Mixed] = {}
        """The color that the bars gave last, by the surface and whether it was in the upper section."""
        self._taking = ""
        """The thing that the user picks in the whole picture: PAINT, COLOR, or nothing."""
        self._image: Cached[DisplayImage] = Cached()
        self._stand_ins: Words = np.empty(0, np.uint16)
        """The words that stand for the words of the picture; the same array until they change."""
        self._picture: Cached[tuple[Crop, Item]] = Cached()

    def enter(self) -> None:
        self.choices.note_mixed()

    def leave(self) -> None:
        self._taking = ""
        self.choices.note_mixed()

    @property
    def _surface(self) -> str:
        return self.session.surface_name

    @property
    def _paint(self) -> Paint:
        return self.session.scene.surfaces[self._surface].paint

    @property
    def _levels(self) -> int:
        return self.session.studio.level_ranges[self._surface].levels

    def _in_section(self, is_upper: bool) -> PaintColor:
        """The color in the upper or the lower section."""
        paint = self._paint
        lower = 0 if paint.ramp is None else min(self._lower, len(paint.ramp) - 2)
        return PaintColor(paint, lower + is_upper)

    @property
    def _chosen(self) -> PaintColor:
        return self._in_section(self._is_upper)

    def _section_at(self, element: int, line: int) -> bool | None:
        """Whether a place is in the upper section; None beside both."""
        if self._taking or not LEFT <= element <= RIGHT_END:
            return None
        sections = zip((False, True), TOPS, strict=True)
        return next((is_upper for is_upper, top in sections if top <= line < top + SECTION_LINES), None)

    def build(self, around: Surroundings) -> Content:
        studio = self.session.studio
        if not self._surface:
            nothing = text("The scene has no surface in use.", LEFT, WORK.top + 4 + TEXT_DOWN, LIGHT_GRAY)
            return Content(items=[nothing])
        words = mixing_words(tuple(studio.level_ranges.items()), self._surface, len(self.choices.colors))
        finish = around.lit if around.lit in FINISHES and not self._taking else ""
        shown = self._image.of(lambda: self._image_with(finish), studio.display_image, finish)
        # A picture to take from is shown as it is.
        stand_ins = np.arange(WORDS, dtype=np.uint16) if self._taking else words.dimmed(shown.entries)
        if not np.array_equal(stand_ins, self._stand_ins):
            self._stand_ins = stand_ins
        draw = partial(self._draw, shown.words)
        crop, picture = self._picture.of(draw, shown.words, self._stand_ins, self._surface)
        light, object_color = (self._in_section(is_upper).color for is_upper in (True, False))
        table = words.table(shown.entries, light, object_color, self.choices.colors)
        return Content(
            items=[*(() if self._taking else self._items(words)), picture],
            loads=() if self._taking else [(0, table)],
            widgets=() if self._taking else self._widgets(words),
            rows=partial(self._rows, words),
            hint=partial(self._hint, crop),
            sample=partial(self._sample, crop),
            color_at=self._color_at,
            take_color=self._take_color,
            pick=partial(self._pick, crop),
            escape=self._end_taking,
        )

    def _image_with(self, finish: str) -> DisplayImage:
        """The image on the display; with a finish, as the chosen surface would look with it."""
        studio = self.session.studio
        try:
            return studio.image_of(with_finish(self.session, finish)) if finish else studio.display_image
        except InputError:
            # A click on the finish says why it cannot be shown.
            return studio.display_image

    def _draw(self, words: Words) -> tuple[Crop, Item]:
        """The part of a picture that is shown: the chosen surface, or the whole picture to take from it."""
        levels = self.session.studio.level_ranges[self._surface]
        is_shown, room = (words >= levels.first) & (words <= levels.last), PICTURE
        if self._taking:
            is_shown, room = np.ones(words.shape, np.bool_), WORK
        crop = crop_of(is_shown, room)
        return crop, image(self._stand_ins[crop.of(words)], crop.area.left, crop.area.top)

    def _rows(self, words: MixingWords) -> Sequence[Widget]:
        paint, turn = self._paint, self.session.turn_to
        switch, *blend = paint_rows(self.session, paint)
        return [
            surface_row(self.session, "The surface whose colors you mix.", self._choose_surface),
            Gap("colors gap"),
            switch,
            # With a ramp there are as many rows as without, so that the rows below stay in their places.
            *(blend if paint.ramp is None else self._ramp_rows(paint.ramp)),
            Button(
                "light blending",
                "Blend the two colors over the whole picture, on an upright bar.",
                "a ramp has no blend" if paint.ramp is not None else "",
                run=partial(turn, BLENDING),
            ),
            Gap("taking gap"),
            *(self._taking_row(thing) for thing in (PAINT, COLOR)),
            *(() if self._taking else self.choices.rows(words.swatches, self._chosen)),
        ]

    def _ramp_rows(self, ramp: tuple[Color, ...]) -> list[Widget]:
        lower, chosen = self._in_section(False).number, self._chosen.number
        between = mixed(ramp[lower], ramp[lower + 1], 0.5)
        many = f"a ramp has at most {MOST_RAMP_COLORS:,} colors; remove a color first"
        return [
            Button(
                "add color",
                f"Add a color to the ramp, between the colors {lower + 1} and {lower + 2}.",
                many if len(ramp) == MOST_RAMP_COLORS else "",
                run=lambda: self._give_ramp((*ramp[: lower + 1], between, *ramp[lower + 1 :]), lower + 1),
            ),
            Button(
                "remove color",
                f"Remove color {chosen + 1}, the chosen one, from the ramp.",
                "a ramp has at least 2 colors; to have none, switch the ramp off" if len(ramp) == 2 else "",
                run=lambda: self._give_ramp(ramp[:chosen] + ramp[chosen + 1 :], min(chosen, len(ramp) - 2)),
            ),
        ]

    def _taking_row(self, thing: str) -> Button:
        is_on, prompt = self._taking == thing, self._prompt(thing)

        def flip() -> None:
            self._taking = "" if is_on else thing
            if self._taking:
                self.session.tell(prompt)

        return Button(f"take {thing}", "Stop picking." if is_on else f"{prompt}.", run=flip, is_chosen=is_on)

    def _widgets(self, words: MixingWords) -> Sequence[Widget]:
        paint, levels = self._paint, self._levels
        shown = words.shown[self.session.studio.display_image.words_at_levels(self._surface)]
        if paint.ramp is not None:
            bar: LevelBar = RampBar(
                "ramp bar",
                "The ramp: pick a color to mix it, or drag it along the ramp.",
                area=BLEND,
                words=shown,
                value=self._chosen.number,
                most=len(paint.ramp) - 1,
                put=self._choose_color,
                move=self._move_color,
            )
        else:
            bar = LevelBar(
                "blend bar",
                "Above the handle the object color gives way to the light color.",
                area=BLEND,
                words=shown,
                value=blend_level(paint.blend, levels),
                most=levels - 1,
                put=lambda level: change_paint(self.session, blend=blend_from(level, levels)),
            )
        width = FINISHES_ROW.width // len(FINISHES)
        finishes = [
            Button(
                name,
                f"A click gives the surface this finish: {name}, in its object color.",
                area=FINISHES_ROW._replace(left=left, right=left + width - 1),
                run=partial(self._finish, name),
            )
            for name, left in zip(FINISHES, count(LEFT, width))
        ]
        return [*self._section(True, words), bar, *self._section(False, words), *finishes]

    def _section(self, is_upper: bool, words: MixingWords) -> list[Widget]:
        """The heading of a section with the number of its color, and its bars."""
        chosen, top = self._in_section(is_upper), TOPS[is_upper]
        heading, name = Area(LEFT, top, HEX_LEFT - 1, top + ROW_LINES - 1), chosen.name.capitalize()
        values = *chosen.color, white_of(chosen.color), *self._mixed_in(is_upper).hsv
        tops = range(top, top + SECTION_LINES, BAR_LINES)
        return [
            Button(
                chosen.label,
                f"{name}: click to pick swatches for it; Ctrl+C copies it.",
                area=heading,
                within="section",
                run=partial(self._choose, is_upper),
                is_chosen=is_upper == self._is_upper,
            ),
            Entry(
                chosen.label,
                f"{name} by its name or number, such as teal or #b01020.",
                area=heading._replace(left=HEX_LEFT, right=LEFT_END),
                within="number",
                value=in_digits(chosen.color),
                take=partial(self._give, is_upper),
            ),
            *(
                ComponentBar(
                    f"{chosen.label}, {bar}",
                    TINTS if bar == "white" else f"{bar.capitalize()} of {chosen.name}, 0 to {most}{unit}.",
                    area=Area(RIGHT, top, RIGHT_END, top + BAR_LINES - 1),
                    value=value,
                    high=most,
                    put=partial(self._put, is_upper, number),
                    word=word,
                    letter=bar[0].upper(),
                    strip=words.hues.tobytes() if bar == "hue" else b"",
                )
                for number, (top, (bar, most, unit, word), value) in enumerate(
                    zip(tops, BARS, values, strict=True)
                )
            ),
        ]

    def _items(self, words: MixingWords) -> Sequence[Item]:
        """The shades of the two colors, from the darkest at the left, and the heading of the bar between."""
        shades = zip(TOPS, (words.object_shades, words.light_shades), strict=True)
        paint, levels = self._paint, self._levels
        if self._surface in self.session.studio.display_image.bands:
            number = "not shown: a scalar colors the surface"
        elif paint.ramp is not None:
            number = self._chosen.name
        else:
            number = f"{paint.blend:.2f}, from level {blend_level(paint.blend, levels)} of {levels - 1}"
        line = BLEND_TOP + TEXT_DOWN
        return [
            *(
                level_strip(each.tobytes(), Area(LEFT, top + ROW_LINES, LEFT_END, top + SECTION_LINES - 1))
                for top, each in shades
            ),
            text("blend" if paint.ramp is None else "ramp", LEFT + MARGIN, line, LIGHT_GRAY),
            text(number, RIGHT_END + 1 - CHARACTER * len(number), line),
        ]

    def _hint(self, crop: Crop, element: int, line: int) -> str:
        sample = self._sample(crop, element, line)
        name = "" if sample is None else sample.surface
        if sample is not None and self._taking == COLOR:
            where = name or "the background"
            return f"pick {in_digits(sample.color)} of {where} as {self._chosen.name}; Esc ends"
        if self._taking and name in ("", self._surface):
            return self._prompt(self._taking)
        if self._taking:
            paint = self.session.scene.surfaces[name].paint
            colors = " and ".join(in_digits(color) for color in colors_of(paint))
            looks = f"{colors}, blend {paint.blend:.2f}"
            if paint.ramp is not None:
                looks = f"a ramp of {len(paint.ramp)} colors"
            return f"pick the paint of {name}: {looks}; Esc ends"
        if sample is not None and name == self._surface:
            meaning = self.session.studio.display_image.meaning
            return f"{name}, {meaning} {sample.level} of {self._levels - 1}"
        return f"{name}: click to mix its colors; P: take its paint" if name else self.help

    def _prompt(self, thing: str) -> str:
        """The message that says what a pick in the picture will do."""
        if thing == PAINT:
            return f"pick a surface: {self._surface} takes both its colors, blend and percentage; Esc ends"
        return f"pick a pixel: its color as you see it becomes {self._chosen.name}; Esc ends"

    def _sample(self, crop: Crop, element: int, line: int) -> Sample | None:
        pixel, studio = crop.pixel_at(element, line), self.session.studio
        if pixel is None:
            return None
        word = int(studio.words[pixel])
        name = surface_of(studio, word)
        red, green, blue = studio.entries[word].tolist()
        return Sample(name, (red, green, blue), word - studio.level_ranges[name].first if name else 0)

    def _pick(self, crop: Crop, gesture: Gesture) -> None:
        element, line = gesture.element, gesture.line
        sample, section = self._sample(crop, element, line), self._section_at(element, line)
        if self._taking:
            self._pick_to_take(sample)
        elif section is not None:
            self._choose(section)
        elif sample is not None and sample.surface:
            self._choose_surface(sample.surface)
            self.session.tell(f"surface {self._surface}")

    def _pick_to_take(self, sample: Sample | None) -> None:
        """Take the paint or the color of a sample. Raises UsageError beside the surfaces; picking goes on."""
        if sample is None or (self._taking == PAINT and not sample.surface):
            raise UsageError(f"no surface is there; {self._prompt(self._taking)}")
        if self._taking == PAINT:
            take_paint(self.session, sample.surface)
        else:
            self._take(sample.color)
        self._taking = ""

    def _end_taking(self) -> bool:
        was_taking, self._taking = bool(self._taking), ""
        return was_taking

    def _choose(self, is_upper: bool) -> None:
        self._is_upper = is_upper
        self.session.tell(f"swatches are for {self._chosen.name}")

    def _choose_surface(self, name: str) -> None:
        self.choices.note_mixed()
        self.session.choose_surface(name)

    def _choose_color(self, number: int) -> None:
        """Choose a color of the ramp, and show it with the color after it, or before it if it is the last."""
        ramp = self._paint.ramp or ()
        self._grabbed, self._lower = (ramp, number), min(number, len(ramp) - 2)
        self._choose(number == len(ramp) - 1)

    def _move_color(self, to: int) -> None:
        """Move the color that was chosen last to another place in the ramp."""
        grabbed = self._grabbed
        self._give_ramp(with_moved_color(*grabbed, to), to)
        self._grabbed = grabbed

    def _give_ramp(self, ramp: Sequence[Sequence[int]], number: int) -> None:
        """Give the surface another ramp, and choose a color of it."""
        change_paint(self.session, ramp=ramp)
        self._choose_color(number)

    def _finish(self, name: str) -> None:
        edit_paint(self.session, with_finish(self.session, name), f"{self._surface}: {name}")

    def _give(self, is_upper: bool, color: Sequence[int] | str) -> None:
        """Give a color of the chosen surface another value."""
        self._is_upper = is_upper
        change_paint(self.session, **self._chosen.change(color_of(self.session, color)))
        self.choices.mixed.add(self._chosen.color)

    def _color_at(self, element: int, line: int) -> Color:
        section = self._section_at(element, line)
        return self._in_section(self._is_upper if section is None else section).color

    def _take_color(self, color: Color | str, element: int, line: int) -> None:
        section = self._section_at(element, line)
        self._is_upper = self._is_upper if section is None else section
        self._take(color)

    def _take(self, color: Color | str, name: str = "") -> None:
        """Give the chosen color of the chosen surface a value, the color of a paint with a name."""
        self._give(self._is_upper, color)
        digits = in_digits(self._chosen.color)
        self.session.tell(f"{self._chosen.label}: {f'{name}, ' if name else ''}{digits}")

    def _mixed_in(self, is_upper: bool) -> Mixed:
        """The numbers of the bars of white, hue, saturation and value, from which they go on."""
        color, last = self._in_section(is_upper).color, self._mixed.get((self._surface, is_upper))
        return last if last is not None and last.color == color else Mixed(color, color, hsv_of(color))

    def _put(self, is_upper: bool, number: int, value: float) -> None:
        """Give a color the number of one of its bars. Raises UsageError for a number beyond the bar."""
        bar, most, *_ = BARS[number]
        is_whole = number <= WHITE_BAR
        if not 0 <= value <= most or (is_whole and value != int(value)):
            kind = "a whole number" if is_whole else "a number"
            raise UsageError(f"{bar} must be {kind} from 0 to {most}, not {value:g}; type another")
        color, start, hsv = self._mixed_in(is_upper)
        if number < WHITE_BAR:
            red, green, blue = (int(value) if each == number else color[each] for each in range(3))
            to = start = red, green, blue
            hsv = hsv_of(to)
        elif number == WHITE_BAR:
            to = with_white(start, int(value))
            hsv = hsv_of(to)
        else:
            hsv = hsv._replace(**{bar: value})
            to = start = color_of_hsv(hsv)
        self._mixed[self._surface, is_upper] = Mixed(to, start, hsv)
        self._give(is_upper, to)
