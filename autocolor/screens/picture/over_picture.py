"""Screens over the picture: pointing names a surface and a part, a click chooses them, a drag orbits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import ClassVar, Final

from autocolor.checks import Color
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import held_name
from autocolor.mapping.legend import CORNERS, Corner, Legend, legend
from autocolor.scene.defaults import TRIMMED
from autocolor.scene.kinds import in_digits
from autocolor.scene.scene import AUTO
from autocolor.screens.cached import Cached
from autocolor.screens.input import MIDDLE, Gesture, turn_between, wheel_ratio
from autocolor.screens.naming import name_view
from autocolor.screens.picture import picture_edits as edits
from autocolor.screens.screen import Content, Handle, Sample, Screen, Surroundings, surface_at
from autocolor.screens.session import EXPLAIN, Session
from autocolor.screens.steps import end_comparing
from autocolor.screens.surface.painting import change_paint, color_of
from autocolor.sending import drawn_legend
from autocolor.widgets.items import Area, Item
from autocolor.widgets.menu import MENU
from autocolor.widgets.widget import Button, Choice, Pair, Switch, Widget, titled


class OverPicture(Screen):
    """A screen whose base is the picture at full size, or the picture of the state to compare with."""

    shows_picture = True
    corners: ClassVar[Sequence[Corner]] = CORNERS
    """The corners where the legend may stand until it is moved."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._legend: Cached[tuple[Sequence[Item], Sequence[Handle]]] = Cached()

    def build(self, around: Surroundings) -> Content:
        """The picture with the legend of a scalar, and the gestures that turn it."""
        other, present = self.other_image(around), self.session.studio.display_image
        image = other or present

        def draw() -> tuple[Sequence[Item], Sequence[Handle]]:
            free = (MENU.left, self.corners, MENU.top) if around.has_menu else (None, self.corners)
            found = legend(image, *free)
            if found is None:
                return (), ()
            area = Area(*found.swatches[0][:4])
            place = partial(self._place_legend, found)
            # The handle is at the upper left corner of the legend, and everywhere on it.
            handle = Handle("legend", area.left, area.top, "the legend", area, place)
            return [Item(area, drawn_legend(found).tobytes(), is_solid=True)], [handle]

        items, handles = self._legend.of(draw, image, around.has_menu)
        return Content(
            base=image.words,
            items=items,
            loads=() if other is None else ((0, other.entries),),
            # The legend of another state cannot be moved.
            handles=handles if other is None else (),
            hint=self.hint,
            sample=self.sample,
            take_color=self._take_color,
            pick=self.pick,
            drag=self.drag,
            wheel=self.wheel,
        )

    def _place_legend(self, legend: Legend, element: int, line: int) -> None:
        place = legend.place_at(element, line)
        self.session.edit(self.session.scene.with_scalar(legend_place=place))

    def other_image(self, around: Surroundings) -> DisplayImage | None:
        """The image that is shown in place of the present one; None for the present one."""
        return self.session.comparing.image

    def hint(self, element: int, line: int) -> str:
        """The surface, the part and the level at a place."""
        names, value = self.pointed(element, line)
        return f"{' - '.join(names)}, {value}" if names else self.help

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
        names, value = self.pointed(gesture.element, gesture.line)
        if not names:
            session.tell("the backdrop" if session.scene.backdrop_colors else "the background")
            return
        session.part_name = names[0]
        session.choose_surface(names[-1])
        session.tell(f"{' - '.join(names)}, {value}")

    def sample(self, element: int, line: int) -> Sample | None:
        """The pixel of the picture at a place."""
        studio = self.session.studio
        name = surface_at(studio, element, line)
        if not name or self.session.comparing.is_on:
            return None
        word = int(studio.words[line, element])
        red, green, blue = studio.entries[word].tolist()
        return Sample(name, (red, green, blue), word - studio.level_ranges[name].first)

    def _take_color(self, color: Color | str, element: int, line: int) -> None:
        name = self.session.surface_name
        change_paint(
            self.session,
            lambda paint: f"{name}: object color {in_digits(paint.object_color)}",
            object_color=color_of(self.session, color),
        )

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        """Turn around the object, or move the picture."""
        if start.button == MIDDLE or start.shift:
            edits.pan(self.session, now.element - last.element, now.line - last.line)
        elif start.control:
            edits.move(self.session, wheel_ratio((last.line - now.line) / 8))
        else:
            edits.turn(self.session, *turn_between(last.element, last.line, now.element, now.line))

    def wheel(self, gesture: Gesture) -> None:
        """Move closer, or farther."""
        edits.move(self.session, wheel_ratio(gesture.steps))

    def pointed(self, element: int, line: int) -> tuple[list[str], str]:
        """The names of the part and the surface at a place, or the one name of both, and the value there.

        There are no names on the background, and while another state is shown.
        """
        sample, studio = self.sample(element, line), self.session.studio
        if sample is None:
            return [], ""
        seen, image, scalar = studio.seen_at(line, element), studio.display_image, studio.scene.scalar
        name, level = sample.surface, sample.level
        names = list(dict.fromkeys([seen.part, name] if seen is not None else [name]))
        bands = image.bands.get(name)
        if bands is None or scalar is None:
            return names, f"{image.meaning} {level} of {image.ranges[name].levels - 1}"
        values, block = image.picture.scalar, image.block
        value = float("nan") if values is None else float(values[line // block, element // block])
        shown = "missing" if math.isnan(value) else f"{value:.5g}"
        return names, f"{scalar.name} {shown}, shade {level % bands.shades + 1}"


HELD: Final = "held"
MIXED: Final = "mixed"
"""Whether some of the ranges of surfaces are held."""


def exposure_row(session: Session) -> Choice:
    """The row that says whether the ranges of the surfaces are held, and holds or releases all of them."""
    exposure = session.scene.exposure
    words = [exposure] if isinstance(exposure, str) else []
    held = [bool(held_name(exposure, name)) for name in session.studio.level_ranges]
    return Choice(
        "exposure",
        "Auto: ranges of intensities follow the picture. Held: ranges stay, so that less light is darker."
        " A percentage: the brightest pixels do not set a range.",
        names=tuple(dict.fromkeys((edits.ALL_HELD, TRIMMED, AUTO, *words))),
        present=next(iter(words), edits.ALL_HELD if all(held) else MIXED),
        choose=partial(edits.choose_exposure, session),
    )


def camera_rows(session: Session) -> list[Widget]:
    """The rows of the named views: to take one, to save the present view, and to remove the shown one."""
    views, help = session.scene.views, "Save the present view under a new name, with the scene"
    save = partial(edits.save_view, session)
    if not views:
        return [Button("save view", f"{help}; the row camera comes back to it.", run=save)]
    return [
        Choice(
            "camera",
            "Look through a saved view; a click on its name in the list renames it.",
            names=tuple(row.name for row in views),
            present=edits.present_camera(session),
            choose=partial(edits.take_view, session),
            rename=partial(name_view, session),
        ),
        Pair(
            "save view",
            f"{help}; or remove the camera that is shown.",
            run=save,
            other="remove",
            run_other=partial(edits.remove_view, session),
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


def light_switches(
    session: Session, chosen: str, choose: Callable[[str], object], has_numbers: bool = False
) -> list[Switch]:
    """The rows of all lights, with `has_numbers` after their numbers; `choose` is called with a name."""
    return [
        Switch(
            f"{number + 1} {light.name}" if has_numbers else light.name,
            f"Switch {titled('light', light.name)} on or off; beside the box: choose it.",
            is_on=light.on,
            flip=partial(edits.switch_light, session, number),
            choose=partial(choose, light.name),
            is_chosen=light.name == chosen,
        )
        for number, light in enumerate(session.scene.lights)
    ]
