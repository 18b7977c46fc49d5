"""Screens over the picture: pointing names what is seen and chooses it, dragging turns around the object."""

from __future__ import annotations

from autocolor.arrays import Words
from autocolor.screens.gestures import MIDDLE, Gesture, turn_between, wheel_ratio
from autocolor.screens.picture_edits import PictureEdits
from autocolor.screens.screen import Screen
from autocolor.screens.session import Session


class OverPicture(Screen):
    """A screen whose base is the picture at full size."""

    shows_picture = True

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.edits = PictureEdits(session)

    def base(self) -> Words:
        return self.session.studio.words

    def hint(self, element: int, line: int) -> str:
        return self._told(element, line) or self.help

    def pick(self, gesture: Gesture) -> None:
        session = self.session
        session.choose_surface(session.surface_of(session.word_at(gesture.element, gesture.line)))
        session.tell(self._told(gesture.element, gesture.line) or "the background")

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
