"""A hand on the joystick unit that mixes colors, the boxes that it paints, and what it sees."""

from __future__ import annotations

import numpy as np

from autocolor import Mesh, Scene, Surface, View, scene_of
from autocolor.arrays import Bytes, Words
from autocolor.scene.surfaces import Paint
from autocolor.widgets.items import Area
from autocolor.widgets.widget import Widget
from ramtek_emu import instructions
from tests.autocolor.screens.hand import Hand
from tests.small import cube

PAINTS = (Paint((176, 16, 32), (255, 250, 240), 0.4), Paint((30, 90, 200), (255, 255, 255), 0.7, 80.0))


def boxes_scene(count: int = 2, levels: int | None = None) -> Scene:
    """One or two cubes in a row, each of a surface of its own, "box 0" and "box 1"."""
    one, names = cube(), [f"box {number}" for number in range(count)]
    parts = np.zeros(len(one.node_numbers), np.intp)
    boxes = [
        Mesh(one.coordinates + np.array([1.4 * number, 0, 0]), one.node_numbers, parts, (name,))
        for number, name in enumerate(names)
    ]
    surfaces = [
        Surface(name, paint=PAINTS[number % 2], levels=levels if number == 0 else None)
        for number, name in enumerate(names)
    ]
    view = View((-1.5 * count, -2 * count, 1.5 * count), target=(count / 2, count / 2, 0.3))
    return scene_of(Mesh.joined(boxes), surfaces=surfaces, view=view, name="boxes")


class PaintingHand(Hand):
    """A hand that goes to other screens by their rows, and sees words, colors and the chosen paint."""

    @property
    def paint(self) -> Paint:
        """The paint of the chosen surface."""
        return self.viewer.studio.scene.surfaces[self.viewer.session.surface_name].paint

    def widget(self, label: str) -> Widget:
        """A widget that can be seen, by its key or its label."""
        keys = (each for each in self.viewer.board.widgets() if each.key == label)
        return next(keys, None) or super().widget(label)

    def turn_to(self, title: str) -> None:
        """Go to a screen by the strip. A row of color mixing leads to light blending."""
        super().turn_to("color mixing" if title == "light blending" else title)
        if title == "light blending":
            self.pick(title)

    def leave(self) -> None:
        """Go back to the picture, away from its menu, with no message."""
        self.turn_to("picture")
        self.move(20, 20)
        self.viewer.tell("")

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
