"""The points of the scaling curves: scenes of many sizes, each on a display, and the edits timed on them.

The polygons are hills under the view and the lights that are created for them; the lights and the pictures
are those of the coupe. A display has the size of the picture, which for the largest ones is more than any
RAMTEK had.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, cycle
from pathlib import Path

import numpy as np

import autocolor
from autocolor.scene.creation import scene_of
from benchmarks.cases import Case
from benchmarks.hills import hills, side_of
from ramtek_emu import Configuration, Ramtek9300
from ramtek_emu.video.scan_out import Stamp

COUPE = Path(__file__).parent / "coupe"
"""A coupe of its own, which stays as it is, so that rates of today and of years ago compare."""
LINES = 480
STEP = 1e-3
"""How far eye and lights move for each edit, in units of the scene."""
APART = 0.05
"""How far lights stand from those they repeat, near enough to have as much to light."""

FRAME, ONE_LIGHT, ALL_LIGHTS = "whole frame", "one light moved", "all lights moved"
RECOLOR = "recolor, scan-out"
EDITS = (FRAME, ONE_LIGHT, ALL_LIGHTS, RECOLOR)


@dataclass(frozen=True)
class Quantity:
    """What grows from point to point: its sizes, and the scene and the lines of the picture for a size."""

    name: str
    sizes: tuple[int, ...]
    scene: Callable[[int], autocolor.Scene]
    lines: Callable[[int], int] = lambda size: LINES
    label: Callable[[int], str] = lambda size: f"{size:,}"

    def chosen(self, quick: bool) -> tuple[int, ...]:
        """The sizes to measure: all, or a few of the smaller ones."""
        return self.sizes[:-1:2] if quick else self.sizes


class Session:
    """A scene on a display, and the edits that are timed on it.

    An edit never sets what is set already, for one that changes nothing costs nothing.
    """

    def __init__(self, scene: autocolor.Scene, lines: int) -> None:
        elements = lines * 4 // 3
        configuration = Configuration(name=f"{elements} x {lines}", elements=elements, lines=lines, planes=10)
        self.display = Ramtek9300(configuration)
        self.studio = autocolor.Studio(scene, self.display)
        self.field = np.zeros((lines, elements), np.uint32)
        self.held: Stamp | None = None
        # Never the same twice, for what was made for a color before may be kept.
        self.colors = (f"#{number % 0x1000000:06x}" for number in count(0xB01020, 0x101))

    def scan_out(self) -> None:
        """Bring the field up to date, as a window does."""
        self.held, _ = self.display.scan_out.scan_out_changes_into(self.field, self.held)

    def frame(self) -> None:
        """Move the eye."""
        x, y, z = self.studio.scene.view.eye
        self.studio.view(eye=(x + STEP, y, z))

    def one_light(self) -> None:
        """Move the first light."""
        light = self.studio.scene.lights[0]
        self.studio.light(light.name, position=_aside(light, STEP).position)

    def all_lights(self) -> None:
        """Move every light."""
        scene = self.studio.scene
        self.studio.edit(scene.replace(lights=tuple(_aside(light, STEP) for light in scene.lights)))

    def recolor(self) -> None:
        """Recolor the first surface, up to the field."""
        self.studio.recolor(self.studio.scene.surfaces[0].name, object_color=next(self.colors))
        self.scan_out()

    def cases(self, prefix: str = "") -> Iterator[Case]:
        """The edits as cases, by their names after a prefix."""
        yield Case(prefix + FRAME, self.frame)
        yield Case(prefix + ONE_LIGHT, self.one_light)
        yield Case(prefix + ALL_LIGHTS, self.all_lights)
        # What a scan-out owes to words that were written before it is not the recoloring's: indices, and
        # the lines that show the surface.
        yield Case(prefix + RECOLOR, self.recolor, before=self.recolor)


def session(quantity: Quantity, size: int) -> Session:
    """The session at a point; everything is computed once and shown."""
    return Session(quantity.scene(size), quantity.lines(size))


def lit_by(scene: autocolor.Scene, lights: int) -> autocolor.Scene:
    """The scene with so many lights: its own in turns, those after the first turn a little aside."""
    return scene.replace(
        lights=tuple(
            _aside(light, number // len(scene.lights) * APART).replace(name=f"light {number + 1}")
            for number, light in zip(range(lights), cycle(scene.lights), strict=False)
        )
    )


def _aside(light: autocolor.Light, distance: float) -> autocolor.Light:
    x, y, z = light.position
    return light.replace(position=(x + distance, y, z))


QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity(
            "polygons",
            (1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000),
            lambda size: scene_of(hills(side_of(size))),
        ),
        Quantity(
            "lights", (1, 2, 4, 8, 16, 32, 64), lambda size: lit_by(autocolor.read_scene(COUPE), size)
        ),
        Quantity(
            "lines",
            (120, 240, 480, 960, 1920),
            lambda size: autocolor.read_scene(COUPE),
            lines=lambda size: size,
            label=lambda size: f"{size * 4 // 3} x {size}",
        ),
    )
}  # fmt: skip
