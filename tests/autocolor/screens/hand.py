"""A hand on the joystick unit: a place, ENTER and TRACK, and nothing else."""

from __future__ import annotations

import numpy as np

from autocolor import Mesh, Scene, Surface, View, scene_of
from autocolor.arrays import Bytes, Words
from autocolor.scene.surfaces import Paint
from autocolor.screens.viewer import Viewer
from autocolor.studio import Studio
from autocolor.widgets.areas import Area
from autocolor.widgets.widget import Widget
from ramtek_emu import Ramtek9300, instructions
from tests.autocolor.meshes import cube

PAINTS = (Paint((176, 16, 32), (255, 250, 240), 0.4), Paint((30, 90, 200), (255, 255, 255), 0.7, 80.0))


def boxes_scene(count: int = 2, levels: int | None = None) -> Scene:
    """Cubes in rows, each of a surface of its own, named "box 0" and so on."""
    one = cube()
    across = int(np.ceil(np.sqrt(count)))
    places = [np.array([1.4 * (number % across), 1.4 * (number // across), 0]) for number in range(count)]
    nodes = len(one.coordinates)
    mesh = Mesh(
        np.concatenate([one.coordinates + place for place in places]),
        np.concatenate([one.node_numbers + nodes * number for number in range(count)]),
        np.repeat(np.arange(count), len(one.node_numbers)),
        tuple(f"box {number}" for number in range(count)),
    )
    surfaces = [
        Surface(f"box {number}", paint=PAINTS[number % 2], levels=levels if number == 0 else None)
        for number in range(count)
    ]
    view = View((-1.5 * across, -2 * across, 1.5 * across), target=(across / 2, across / 2, 0.3))
    return scene_of(mesh, surfaces=surfaces, view=view, name="boxes")


class Hand:
    """The hand, and what it sees."""

    def __init__(self, viewer: Viewer) -> None:
        assert isinstance(viewer.display, Ramtek9300)
        self.viewer = viewer
        self.display = viewer.display
        self.stick = viewer.display.joystick
        viewer.poll()

    def point(self, element: int, line: int) -> None:
        """Move to a place."""
        self.stick.move_to(element, line)
        self.viewer.poll()

    def pick(self, element: int, line: int) -> None:
        """Move to a place, and press ENTER."""
        self.point(element, line)
        self.stick.press_enter()
        self.viewer.poll()

    def drag(self, *places: tuple[int, int]) -> None:
        """Move to the first place, hold TRACK, move over the others, and let go."""
        self.point(*places[0])
        self.stick.track = True
        self.viewer.poll()
        for place in places[1:]:
            self.point(*place)
        self.stick.track = False
        self.viewer.poll()

    def pick_row(self, label: str) -> None:
        """Press ENTER in the middle of a widget or a row of the menu."""
        area = self.widget(label).area
        self.pick((area.left + area.right) // 2, (area.top + area.bottom) // 2)

    def widget(self, label: str) -> Widget:
        """The widget or the row of that key."""
        return next(each for each in self.viewer.board.widgets() if each.key == label)

    def turn_to(self, title: str) -> None:
        """Go to a screen by the rows of the menus."""
        if self.viewer.page != "picture":
            self.pick_row("< picture")
        self.point(639, 240)
        self.pick_row(title)

    def leave(self) -> None:
        """Go back to the picture, away from its menu, with no message."""
        self.turn_to_picture()
        self.viewer.tell("")

    def turn_to_picture(self) -> None:
        """Go back to the picture, away from its menu."""
        self.point(639, 240)
        self.pick_row("< picture")
        self.point(20, 20)

    # What is seen.

    def words(self, area: Area) -> Words:
        """The words of an area."""
        left, top, right, bottom = area
        return self.display.words[top : bottom + 1, left : right + 1]

    def colors(self, area: Area) -> Bytes:
        """The colors of an area."""
        colors: Bytes = self.display.entries[self.words(area)]
        return colors

    def spoil(self, area: Area, word: int = 5) -> None:
        """Fill an area behind the host's back: what is still so later was not written."""
        self.display.send(instructions.erase(area, word))

    def is_as_sent(self, scene: Scene) -> bool:
        """Whether words and entries are those of a display that was sent that scene alone."""
        fresh = Ramtek9300()
        Studio(scene, fresh)
        same_words = np.array_equal(self.display.words, fresh.words)
        return same_words and np.array_equal(self.display.entries, fresh.entries)
