"""Studios on small displays, and what the displays hold."""

from __future__ import annotations

import numpy as np

from autocolor import Flap, Flaps, Light, Mesh, Scene, Studio, Surface, View, read_scene, scene_of
from autocolor.journal.places import checksum_of
from autocolor.scene.scalar import MeshScalar
from ramtek_emu import Configuration, Ramtek9300
from tests.autocolor.meshes import STRETCHED, cube, grid, sphere

SMALL = Configuration(name="small", elements=32, lines=24, planes=10)


def car() -> Scene:
    """A round body, a pane and wheels, under two lights of the studio, with a scalar that the body lacks."""
    mesh = Mesh.joined(
        [
            Mesh(
                sphere(16, 10).coordinates,
                sphere(16, 10).node_numbers,
                sphere(16, 10).part_numbers,
                ("hood",),
            ),
            grid(2, 2, (-1.3, -1.2, -0.4), (1.0, 0.2, 0), (0, 0, 1.0), "pane"),
            cube(1.2),
        ]
    )
    stress = np.where(mesh.part_numbers == 0, np.nan, mesh.coordinates[mesh.node_numbers[:, 0], 0])
    mesh = mesh.with_scalars(MeshScalar("stress", stress, "polygon"))
    return scene_of(
        mesh,
        surface_of_part={"hood": "body", "pane": "glass", "cube": "wheels"},
        surfaces=[Surface("body"), Surface("glass"), Surface("wheels")],
        lights=[
            Light("key", (2.0, -4.0, 3.0), aim=(0, 0, 0), concentration=5, cone_angle=60),
            Light("fill", (-3.0, -2.0, 1.0), 0.4, flaps=Flaps(z=Flap(-0.5, 0.9, on=False))),
        ],
        view=View((1.0, -4.0, 1.0), target=(0.0, 0.0, 0.0), field_of_view=40.0),
    ).replace(**STRETCHED)


def opened(scene: Scene | None = None) -> tuple[Studio, Ramtek9300]:
    display = Ramtek9300(SMALL)
    return Studio(car() if scene is None else scene, display), display


def held(display: Ramtek9300) -> tuple[bytes, bytes]:
    return display.words.tobytes(), display.entries.tobytes()


def fresh(scene: Scene) -> tuple[bytes, bytes]:
    return held(opened(scene)[1])


def is_true_to_its_file(studio: Studio) -> bool:
    """Whether the file of a scene that counts as saved gives that scene, whatever its name."""
    path = next(iter(studio.history.files), None)
    if studio.is_changed or path is None:
        return True
    return checksum_of(read_scene(path).replace(name=studio.scene.name)) == checksum_of(studio.scene)
