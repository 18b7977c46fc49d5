"""A viewer with a screen of the tests, whose widgets set values that the tests look at."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autocolor.screens.board import Board
from autocolor.screens.input import Gesture
from autocolor.screens.screen import Handle, Screen
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import Bar
from autocolor.widgets.widget import Button, Entry, Gap, Widget
from ramtek_emu import HostPort, Ramtek9300
from tests.small import wall_scene


class Desk(Screen):
    """A screen with a bar for the ambient light, a button, a name, and a handle for each light."""

    name = "desk"
    title = "desk"
    help = "the desk"
    rows_more = 0

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

    def handles(self) -> Sequence[Handle]:
        x, y, _ = self.session.scene.view.eye
        return [
            Handle("eye", round(200 + 10 * x), round(200 + 10 * y), "the eye"),
            Handle("hidden", 508, 300, "?"),
        ]

    def place(self, handle: Handle, element: int, line: int) -> None:
        *_, z = self.session.scene.view.eye
        eye = ((element - 200) / 10, (line - 200) / 10, z)
        self.session.edit(self.session.scene.with_view(eye=eye))


def desk_viewer(folder: Path, display: HostPort | None = None) -> Viewer:
    """A viewer that shows the desk, without a message."""
    viewer = Viewer(wall_scene(), Ramtek9300() if display is None else display, folder=folder)
    viewer.screens["desk"] = Desk(viewer.session)
    viewer.session.turn_to("desk")
    viewer.tell("")
    return viewer


def point(viewer: Viewer, kind: str, element: int, line: int) -> None:
    """A gesture."""
    viewer.point(Gesture(kind, element, line))


def middle_of(board: Board, label: str) -> tuple[int, int]:
    """The middle of the widget with a label."""
    area = next(each.area for each in board.widgets() if each.label == label)
    return (area.left + area.right) // 2, (area.top + area.bottom) // 2
