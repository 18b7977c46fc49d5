"""The picture screen: the whole picture. Pointing names what is seen, dragging turns around the object."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Final

from autocolor.arrays import Words
from autocolor.screens.gestures import MIDDLE, Gesture, turn_between, wheel_ratio
from autocolor.screens.orbit import SIDES
from autocolor.screens.picture_edits import PictureEdits
from autocolor.screens.screen import Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.widget import Button, Choice, Gap, Steps, Switch, Widget

TURN: Final = 5.0
"""Degrees for each step of a menu row that turns."""

CLOSER: Final = 0.9
PAN: Final = 16.0
"""Elements or lines for each step of a menu row that moves the picture."""


class PictureScreen(Screen):
    """The picture, over which the menu comes on demand."""

    name = PICTURE
    title = "picture"
    help = "drag: turn; click: choose a surface; Tab or the right edge: the menu"
    has_menu = False
    shows_picture = True

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.edits = PictureEdits(session)

    def base(self) -> Words:
        return self.session.studio.words

    def rows(self) -> Sequence[Widget]:
        session, edits = self.session, self.edits
        return [
            Choice(
                "surface",
                "The surface that colors and reflectance are for; a click in the picture chooses, too.",
                names=tuple(session.studio.level_ranges),
                present=session.surface_name,
                choose=session.choose_surface,
            ),
            *self._light_rows(),
            Gap("view gap"),
            Choice("view", "The view from a side.", names=tuple(SIDES), present="", choose=self._see_from),
            Steps(
                "turn", "Turn around the object.", step=lambda n: edits.turn(n * TURN, 0), signs=("<", ">")
            ),
            Steps("rise", "Look from lower or from higher.", step=lambda n: edits.turn(0, n * TURN)),
            Steps("closer", "Move farther or closer.", step=lambda n: edits.move(CLOSER**n)),
            Steps(
                "move", "Move the picture sideways.", step=lambda n: edits.pan(n * PAN, 0), signs=("<", ">")
            ),
            Steps("lift", "Move the picture down or up.", step=lambda n: edits.pan(0, -n * PAN)),
            Button("rescale", "Fill the picture with the object.", run=edits.rescale),
            Button("rescale surface", "Fill the picture with the surface.", run=lambda: edits.rescale(True)),
        ]

    def _light_rows(self) -> list[Widget]:
        session = self.session
        return [
            Switch(
                light.name,
                f"Switch light {light.name} on or off; beside the box: choose it.",
                is_on=light.on,
                flip=partial(self.edits.switch_light, number),
                choose=partial(self._choose_light, light.name),
            )
            for number, light in enumerate(session.scene.lights)
        ]

    def _choose_light(self, name: str) -> None:
        self.session.choose_light(name)
        self.session.tell(f"light {name}")

    def _see_from(self, side: str) -> None:
        self.edits.see_from(list(SIDES).index(side))

    def hint(self, element: int, line: int) -> str:
        return self._told(element, line) or self.help

    def pick(self, gesture: Gesture) -> None:
        told = self._told(gesture.element, gesture.line)
        if told:
            self.session.choose_surface(
                self.session.surface_of(self.session.word_at(gesture.element, gesture.line))
            )
        self.session.tell(told or "the background")

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        if start.button == MIDDLE or start.shift:
            self.edits.pan(now.element - last.element, now.line - last.line)
        elif start.control:
            self.edits.move(wheel_ratio((last.line - now.line) / 8))
        else:
            self.edits.turn(*turn_between(last.element, last.line, now.element, now.line))

    def wheel(self, gesture: Gesture) -> None:
        self.edits.move(wheel_ratio(gesture.steps))

    def _told(self, element: int, line: int) -> str:
        """What is seen at a place: the surface and its level; nothing for the background."""
        word = self.session.word_at(element, line)
        name = self.session.surface_of(word)
        if not name:
            return ""
        first, levels = self.session.studio.level_ranges[name]
        return f"{name}, level {word - first} of {levels - 1}"
