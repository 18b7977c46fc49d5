"""A hand on the joystick unit that mixes colors, the boxes that it paints, and what it sees."""

from __future__ import annotations

import numpy as np

from autocolor import Mesh, Scene, Surface, View, scene_of
from autocolor.arrays import Bytes, Words
from autocolor.scene.surfaces import Paint
from autocolor.studio import Studio
from autocolor.widgets.items import Area
from autocolor.widgets.widget import Widget
from ramtek_emu import Ramtek9300, instructions
from tests.autocolor.screens.hand import Hand, has_the_same
from tests.small import cube

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

    def is_as_sent(self, scene: Scene) -> bool:
        """Whether words and entries are those of a display that was sent that scene alone."""
        fresh = Ramtek9300()
        Studio(scene, fresh)
        return has_the_same(self.display, fresh)
