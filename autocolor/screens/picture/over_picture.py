"""Screens over the picture: pointing names a surface and a part, a click chooses them, a drag orbits.

As in 1983, the word that is read back from the display gives the surface and its level; the polygon at the
pixel gives the part.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, ClassVar, Final, NamedTuple

from autocolor.arrays import half_up
from autocolor.checks import Color
from autocolor.mapping.colors import entries_of
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import held_name
from autocolor.mapping.legend import CORNERS, GROUND, INK, Corner, Legend, legend
from autocolor.scene.defaults import TRIMMED
from autocolor.scene.kinds import in_digits
from autocolor.scene.scene import AUTO
from autocolor.scene.surfaces import Paint
from autocolor.screens.cached import Cached
from autocolor.screens.input import MIDDLE, Gesture, turn_between, wheel_ratio
from autocolor.screens.naming import name_view
from autocolor.screens.picture.picture_edits import ALL_HELD, PictureEdits
from autocolor.screens.screen import Content, Sample, Screen, Surroundings, surface_of
from autocolor.screens.session import EXPLAIN, Session
from autocolor.screens.steps import end_comparing
from autocolor.screens.surface.painting import change_paint, color_of
from autocolor.widgets.items import Area, Item, filled, text
from autocolor.widgets.menu import MENU
from autocolor.widgets.rows import rows_of
from autocolor.widgets.widget import Button, Choice, Entry, Pair, Switch, Widget
from ramtek_emu import instructions


class OverPicture(Screen):
    """A screen whose base is the picture at full size, or the picture of the state to compare with."""

    shows_picture = True
    corners: ClassVar[Sequence[Corner]] = CORNERS
    """The corners where the legend may stand until it is moved."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.edits = PictureEdits(session)
        self._items: Cached[Sequence[Item]] = Cached()
        self._legend: Legend | None = None
        """The legend that is shown."""
        self._grip: tuple[int, int] | None = None
        """From the pointer to the upper left corner of the legend, if the present drag moves the legend."""

    def build(self, around: Surroundings) -> Content:
        """The picture with the legend of a scalar, and the gestures that turn it."""
        other, present = self.other_image(around), self.session.studio.display_image
        image = other or present

        def draw() -> Sequence[Item]:
            free = (MENU.left, self.corners, MENU.top) if around.has_menu else (None, self.corners)
            self._legend = legend(image, *free)
            return legend_items(self._legend)

        return Content(
            base=image.words,
            items=self._items.of(draw, image, around.has_menu),
            loads=() if other is None else ((0, other.entries),),
            hint=self.hint,
            sample=self.sample,
            color_at=self._color_at,
            take_color=self._take_color,
            pick=self.pick,
            drag=self.drag,
            wheel=self.wheel,
        )

    def other_image(self, around: Surroundings) -> DisplayImage | None:
        """The image that is shown in place of the present one; None for the present one."""
        return self.session.comparing.image

    def hint(self, element: int, line: int) -> str:
        """The surface, the part and the level at a place."""
        pointed = self._pointed(element, line)
        if pointed is not None:
            return pointed.message
        return "the legend: drag it" if self._is_on_legend(element, line) else self.help

    def pick(self, gesture: Gesture) -> None:
        """Choose a surface, explain a pixel, or end comparing."""
        session = self.session
        if session.comparing.is_on:
            end_comparing(session)
            return
        lines, elements = session.studio.words.shape
        if (gesture.shift or session.explains) and gesture.line < lines and gesture.element < elements:
            session.explains, session.pixel = False, (gesture.line, gesture.element)
            session.turn_to(EXPLAIN)
            return
        pointed = self._pointed(gesture.element, gesture.line)
        if pointed is None:
            on_legend = self._is_on_legend(gesture.element, gesture.line)
            empty = "the backdrop" if session.scene.backdrop_colors else "the background"
            session.tell("the legend: drag it" if on_legend else empty)
            return
        session.choose_surface(pointed.surface)
        session.part_name = pointed.part
        session.tell(pointed.message)

    def sample(self, element: int, line: int) -> Sample | None:
        """The pixel of the picture at a place."""
        pointed, studio = self._pointed(element, line), self.session.studio
        if pointed is None:
            return None
        word = int(studio.words[line, element])
        red, green, blue = studio.entries[word].tolist()
        first = studio.level_ranges[pointed.surface].first
        return Sample(pointed.surface, (red, green, blue), word - first)

    def _color_at(self, element: int, line: int) -> Color | None:
        sample = self.sample(element, line)
        return None if sample is None else sample.color

    def _take_color(self, color: Color | str, element: int, line: int) -> None:
        name = self.session.surface_name
        change_paint(
            self.session,
            lambda paint: f"{name}: object color {in_digits(paint.object_color)}",
            object_color=color_of(self.session, color),
        )

    def _is_on_legend(self, element: int, line: int) -> bool:
        if self._legend is None or self.session.comparing.is_on:
            # The legend of another state cannot be moved.
            return False
        return self._legend.has(element, line)

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        """Turn around the object, move the picture, or move the legend."""
        if last is start:
            self._grip = None
            if self._legend is not None and self._is_on_legend(start.element, start.line):
                left, top, *_ = self._legend.swatches[0]
                self._grip = left - start.element, top - start.line
        if self._grip is not None and self._legend is not None:
            place = self._legend.place_at(now.element + self._grip[0], now.line + self._grip[1])
            self.session.edit(self.session.scene.with_scalar(legend_place=place))
        elif start.button == MIDDLE or start.shift:
            self.edits.pan(now.element - last.element, now.line - last.line)
        elif start.control:
            self.edits.move(wheel_ratio((last.line - now.line) / 8))
        else:
            self.edits.turn(*turn_between(last.element, last.line, now.element, now.line))

    def wheel(self, gesture: Gesture) -> None:
        """Move closer, or farther."""
        self.edits.move(wheel_ratio(gesture.steps))

    def _pointed(self, element: int, line: int) -> Pointed | None:
        """The surface and part at a place; None on the background, and where an item covers the picture."""
        session = self.session
        studio = session.studio
        lines, elements = studio.words.shape
        if line >= lines or element >= elements:
            # A display that is out of order may report any place, and any word there.
            return None
        word = word_at(session, element, line)
        name = surface_of(session.studio, word)
        if not name or session.comparing.is_on or word != studio.words[line, element]:
            return None
        seen = studio.seen_at(line, element)
        first, levels = studio.level_ranges[name]
        part = "" if seen is None else seen.part
        bands, scalar = studio.display_image.bands.get(name), studio.scene.scalar
        if bands is None or scalar is None:
            what = studio.display_image.meaning
            return Pointed(name, part, f"{what} {word - first} of {levels - 1}")
        values, block = studio.display_image.picture.scalar, studio.display_image.block
        value = float("nan") if values is None else float(values[line // block, element // block])
        shown = "missing" if math.isnan(value) else f"{value:.5g}"
        return Pointed(name, part, f"{scalar.name} {shown}, shade {(word - first) % bands.shades + 1}")


def word_at(session: Session, element: int, line: int) -> int:
    """The word of a pixel, read back from the display."""
    ((read, count),) = instructions.read_image(element, line, 1, 1)
    session.display.send(read)
    return int(session.display.receive(count)[0])


class Pointed(NamedTuple):
    """The surface and the part under the pointer, and the value of the word there, as text."""

    surface: str
    part: str
    read: str

    @property
    def names(self) -> list[str]:
        """The names of the part and the surface, or the one name of both."""
        return list(dict.fromkeys(filter(None, (self.part, self.surface))))

    @property
    def message(self) -> str:
        """The text for the message line."""
        return f"{' - '.join(self.names)}, {self.read}"


def legend_items(legend: Legend | None) -> Sequence[Item]:
    """The items that draw a legend; none without one."""
    if legend is None:
        return ()
    areas = [filled(Area(*swatch[:4]), swatch.word) for swatch in legend.swatches]
    return [*areas, *(text(each.text, each.left, each.top, INK, GROUND) for each in legend.labels)]


def paint_rows(session: Session, paint: Paint) -> list[Widget]:
    """The rows of the chosen surface's paint without its colors: whether it has a ramp, else the blend."""
    switch = Switch(
        "ramp",
        "A ramp of any colors from the lowest level to the highest, instead of two colors and their blend.",
        is_on=paint.ramp is not None,
        flip=partial(_flip_ramp, session, paint),
    )
    if paint.ramp is not None:
        return [switch]

    def put(changes: Mapping[str, Any]) -> None:
        change_paint(session, **changes)

    rows = rows_of(paint, put, session.world, leave_out=("object_color", "light_color"))
    # Shorten labels so that they fit beside their numbers.
    return [switch, *(replace(row, label=row.label.replace("percentage", "percent")) for row in rows)]


FIRST_RAMP_COLORS: Final = 6
"""Assumed: colors of a ramp that is switched on. The default blend, 0.6, begins at the fourth, so the surface
looks nearly as before."""


def _flip_ramp(session: Session, paint: Paint) -> None:
    """Give the chosen surface a ramp that looks like its paint, or two colors instead of its ramp."""
    if paint.ramp is not None:
        change_paint(session, ramp=None)
        return
    image, name = session.studio.display_image, session.surface_name
    entries = entries_of(paint, image.ranges[name].levels, image.floor_of(name))
    steps = FIRST_RAMP_COLORS - 1
    levels = [half_up(step * (len(entries) - 1) / steps) for step in range(steps + 1)]
    change_paint(session, ramp=entries[levels].tolist())


HELD: Final = "held"
MIXED: Final = "mixed"
"""Whether some of the ranges of surfaces are held."""


def exposure_row(edits: PictureEdits) -> Choice:
    """The row that says whether the ranges of the surfaces are held, and holds or releases all of them."""
    exposure = edits.session.scene.exposure
    words = [exposure] if isinstance(exposure, str) else []
    held = [bool(held_name(exposure, name)) for name in edits.session.studio.level_ranges]
    return Choice(
        "exposure",
        "Auto: ranges of intensities follow the picture. Held: ranges stay, so that less light is darker."
        " A percentage: the brightest pixels do not set a range.",
        names=tuple(dict.fromkeys((ALL_HELD, TRIMMED, AUTO, *words))),
        present=next(iter(words), ALL_HELD if all(held) else MIXED),
        choose=edits.choose_exposure,
    )


def stage_rows(edits: PictureEdits) -> list[Widget]:
    """The row of the stage of the object, and where there is a backdrop, the rows of its two colors."""
    session, colors = edits.session, edits.session.scene.backdrop_colors

    def put(changes: Mapping[str, Any]) -> None:
        session.edit(session.scene.replace(**changes))

    def entry(label: str, number: int) -> Entry:
        help = "The color behind everything at the top or the bottom of the picture, as a name or #rrggbb."
        others = colors[:number], colors[number + 1 :]
        return Entry(
            label,
            help,
            value=in_digits(colors[number]),
            take=lambda color: put({"backdrop": [*others[0], color, *others[1]]}),
        )

    row = rows_of(session.scene, put, session.world, columns=("stage",))
    return [*row, entry("backdrop", 0), entry("  bottom", 1)] if colors else row


def camera_rows(edits: PictureEdits) -> list[Widget]:
    """The rows of the named views: to take one, to save the present view, and to remove the shown one."""
    views = edits.session.scene.views
    save = "Save the present view under a new name, with the scene"
    if not views:
        return [Button("save view", f"{save}; the row camera comes back to it.", run=edits.save_view)]
    return [
        Choice(
            "camera",
            "Look through a saved view; a click on its name in the list renames it.",
            names=tuple(row.name for row in views),
            present=edits.camera,
            choose=edits.take_view,
            rename=partial(name_view, edits.session),
        ),
        Pair(
            "save view",
            f"{save}; or remove the camera that is shown.",
            run=edits.save_view,
            other="remove",
            run_other=edits.remove_view,
        ),
    ]


def surface_row(session: Session, help: str, choose: Callable[[str], object] | None = None) -> Choice:
    """A row with the surfaces in use; a choice goes to `choose`, or else to the session."""
    return Choice(
        "surface",
        help,
        names=tuple(session.studio.level_ranges),
        present=session.surface_name,
        choose=session.choose_surface if choose is None else choose,
    )
