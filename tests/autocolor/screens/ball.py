"""A ball over a floor under a light with a cone and a flap, and the hand of a user before it."""

from __future__ import annotations

from pathlib import Path

from autocolor import Flap, Flaps, Light, Mesh, Scene, Surface, View, scene_of
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.small import grid, held, sphere

MIDDLE = 320, 240
"""The element and line of the middle of the picture, where the ball is nearest."""


def ball_scene() -> Scene:
    ball = sphere(48, 24)
    mesh = Mesh.joined(
        [
            Mesh(ball.coordinates, ball.node_numbers, ball.part_numbers, ("ball",)),
            grid(1, 1, (-3.0, -3.0, -1.0), (6.0, 0, 0), (0, 6.0, 0), "floor"),
        ]
    )
    return scene_of(
        mesh,
        surface_of_part={"ball": "paint", "floor": "floor"},
        surfaces=[Surface("paint"), Surface("floor")],
        lights=[
            Light(
                "key",
                (2.0, -5.0, 2.0),
                aim=(0.0, 0.0, 0.0),
                cone_angle=8.0,
                flaps=Flaps(z=Flap(minimum=-0.3)),
            ),
            Light("fill", (-4.0, -3.0, 1.0), intensity=0.3),
        ],
        view=View((0.0, -8.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0),
        name="ball",
    )


def hand_before(scene: Scene, folder: Path) -> Hand:
    """A hand on the unit of a display that shows a scene."""
    return Hand(Viewer(scene, Ramtek9300(), folder))


def seen_on(hand: Hand) -> tuple[bytes, bytes]:
    """The words and the entries of the display."""
    return held(hand.display)
