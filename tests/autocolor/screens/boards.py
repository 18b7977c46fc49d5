"""Screens that are made for tests: a desk with all kinds of rows, and a room with lists and sections."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autocolor.arrays import Bytes
from autocolor.errors import UsageError
from autocolor.screens.screen import Content, Handle, Screen, Surroundings
from autocolor.screens.session import Session
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import Area, Item
from autocolor.widgets.menu import Section
from autocolor.widgets.widget import Button, Choice, Entry, Gap, Widget
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.small import wall_scene

EYE = 200, 160
"""The element and line of the desk's handle."""


class Desk(Screen):
    """A screen with a bar for the ambient light, a button, a name, and handles, some of them covered."""

    name = "desk"
    title = "desk"
    help = "the desk"
    rows_more = 0

    def build(self, around: Surroundings) -> Content:
        return Content(
            items=self.items(), loads=self.loads(), rows=self.rows, handles=self._handles(), key=self.key
        )

    def items(self) -> Sequence[Item]:
        return ()

    def loads(self) -> Sequence[tuple[int, Bytes]]:
        return ()

    def key(self, name: str, typed: str) -> bool:
        return False

    def rows(self) -> Sequence[Widget]:
        scene = self.session.scene
        return [
            Bar(
                "ambient",
                "The light from everywhere.",
                value=scene.ambient,
                put=lambda value: self.session.edit(self.session.scene.replace(ambient=value)),
            ),
            Gap("a gap"),
            Button("do it", why_not="not today"),
            Entry(
                "name",
                value=scene.name,
                take=lambda name: self.session.edit(self.session.scene.replace(name=name)),
            ),
            *[Button(f"row {number}") for number in range(self.rows_more)],
        ]

    def _handles(self) -> Sequence[Handle]:
        x, y, _ = self.session.scene.view.eye
        return [
            Handle("eye", round(200 + 10 * x), round(200 + 10 * y), "the eye", place=self._place),
            Handle("hidden", 508, 300, "?", place=self._place),
            Handle("low", 100, 455, "the low handle", place=self._place),
        ]

    def _place(self, element: int, line: int) -> None:
        if element > 490:
            raise UsageError("an eye must be elsewhere")
        *_, z = self.session.scene.view.eye
        eye = ((element - 200) / 10, (line - 200) / 10, z)
        self.session.edit(self.session.scene.with_view(eye=eye))


def desk_hand(folder: Path, display: Ramtek9300 | None = None) -> Hand:
    """A hand before the desk, without a message."""
    hand = Hand(Viewer(wall_scene(), Ramtek9300() if display is None else display, folder))
    hand.viewer.screens["desk"] = Desk(hand.viewer.session)
    hand.go_to("desk")
    return hand


NAMES = ("matte", "gloss", "chrome", "satin", "glass")


class Room(Screen):
    """A screen over the picture with a list, sections, and a panel."""

    name = "room"
    title = "room"
    help = "the room"
    shows_picture = True

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.chosen = "chrome"
        self.rows_of: dict[str, int] = {"near": 3, "far": 15, "farther": 15}
        self.did: list[object] = []

    def build(self, around: Surroundings) -> Content:
        return Content(
            base=self.session.studio.words,
            rows=self._rows,
            widgets=[self._button("panel").at(Area(8, 8, 99, 23))] if around.has_panels else (),
            handles=[Handle("covered", 470, 30, "?"), Handle("free", 300, 200, "a handle")],
            pick=lambda gesture: self.did.append("pick"),
            drag=lambda start, last, now: self.did.append((start.element, last.element, now.element)),
        )

    def _rows(self) -> list[Widget]:
        def choose(name: str) -> None:
            if name == "glass":
                raise UsageError("a finish must not be glass; choose another")
            self.chosen = name

        rows: list[Widget] = [
            Choice("finish", "The finish.", names=NAMES, present=self.chosen, choose=choose),
            Choice("page", names=("1", "2", "3", "4"), present="1", choose=self.did.append, turns_pages=True),
        ]
        for title, count in self.rows_of.items():
            rows += [Section(title), *(self._button(f"{title} {number}") for number in range(count))]
        return rows

    def _button(self, label: str) -> Button:
        return Button(label, run=lambda: self.did.append(label))
