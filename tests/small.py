"""The small things that tests are made of: meshes, scenes, a scene's folder, studios, a stream.

Each is made here once. A test that needs another part, light or file changes a copy of these.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt

from autocolor import (
    Flap,
    Flaps,
    Light,
    Mesh,
    Reflectance,
    Scene,
    Studio,
    Surface,
    View,
    read_scene,
    scene_of,
)
from autocolor.checks import Vector
from autocolor.journal.places import checksum_of
from autocolor.scene.changes import SceneFields
from autocolor.scene.scalar import MeshScalar
from ramtek_emu import Configuration, Ramtek9300, instructions

SMALL = Configuration(name="small", elements=32, lines=24, planes=10)
"""A display for a picture whose size is not the subject."""

STRETCHED: SceneFields = {
    "scaling": "surface",
    "contrast": "stretch",
    "mapping": "linear",
    "interpolation": "scan line",
    "exposure": "auto",
}
"""How intensities are shown where a test rests on it: as in a scene file that does not say it."""


def grid(columns: int, rows: int, corner: Vector, across: Vector, up: Vector, name: str = "wall") -> Mesh:
    """A parallelogram of columns x rows quads, counterclockwise where `across` x `up` points to one."""
    along = np.arange(columns + 1) / columns
    upward = np.arange(rows + 1) / rows
    coordinates = (
        np.array(corner) + along[None, :, None] * np.array(across) + upward[:, None, None] * np.array(up)
    ).reshape(-1, 3)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1)
    return Mesh(coordinates, quads, np.zeros(len(quads), np.intp), (name,))


def wall(columns: int = 1, rows: int = 1, half: float = 1.0) -> Mesh:
    """A square in the plane y = 0 that faces -y."""
    return grid(columns, rows, (-half, 0.0, -half), (2 * half, 0.0, 0.0), (0.0, 0.0, 2 * half))


def wall_scene(
    mesh: Mesh | None = None,
    reflectance: Reflectance | None = None,
    view: View | None = None,
    two_sided: bool = True,
    **fields: object,
) -> Scene:
    """A wall, seen from straight before it unless a view is given; no ambient light unless given.

    Other parts than the wall have a surface of their own, and so do intensities, unless `fields` say it.
    """
    mesh = wall() if mesh is None else mesh
    return scene_of(
        mesh,
        surface_of_part={name: name for name in mesh.part_names},
        surfaces=[Surface("wall", reflectance or Reflectance(0.7, 0.5, 20.0), two_sided=two_sided)],
        view=view or View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0),
        **{**STRETCHED, "ambient": 0.0, **fields},  # type: ignore[arg-type]
    )


CUBE_NODES = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def uneven_wall(seed: int) -> Mesh:
    """A wall of 6 x 5 warped quads, six units wide."""
    flat = grid(6, 5, (-3, 0, -3), (6, 0, 0), (0, 0, 6))
    moved = flat.coordinates.copy()
    inner = (np.abs(moved[:, 0]) < 2.9) & (np.abs(moved[:, 2]) < 2.9)
    moved[inner] += np.random.default_rng(seed).uniform(-0.3, 0.3, (inner.sum(), 3))
    return Mesh(moved, flat.node_numbers, flat.part_numbers, flat.part_names)


def cube(size: float = 1.0) -> Mesh:
    """The cube from the origin to (size, size, size), facing outward."""
    return Mesh(
        np.array(CUBE_NODES, np.float64) * size, np.array(CUBE_QUADS), np.zeros(6, np.intp), ("cube",)
    )


def sphere(columns: int = 32, rows: int = 16, radius: float = 1.0) -> Mesh:
    """A sphere around the origin, of quads and of triangles at the poles, facing outward."""
    coordinates = [(0.0, 0.0, -radius)]
    for row in range(1, rows):
        low = math.pi * (row / rows - 0.5)
        for column in range(columns):
            turn = 2 * math.pi * column / columns
            coordinates.append(
                (
                    radius * math.cos(low) * math.cos(turn),
                    radius * math.cos(low) * math.sin(turn),
                    radius * math.sin(low),
                )
            )
    coordinates.append((0.0, 0.0, radius))
    last = len(coordinates) - 1

    def node(row: int, column: int) -> int:
        return 0 if row == 0 else last if row == rows else 1 + (row - 1) * columns + column % columns

    quads = []
    for row in range(rows):
        for column in range(columns):
            a, b = node(row, column), node(row, column + 1)
            c, d = node(row + 1, column + 1), node(row + 1, column)
            quads.append((d, a, b, b) if a != b and c == d else (a, c, d, d) if a == b else (a, b, c, d))
    return Mesh(np.array(coordinates), np.array(quads), np.zeros(len(quads), np.intp), ("sphere",))


LYING = """\
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v 0 5 0
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
f 1 2 7 6
f 2 3 8 7
f 3 4 9 8
f 4 1 6 9
f 6 7 8 9
"""
"""An OBJ file: a pyramid with y up, which lies on its side when it is read with z up."""


def ramp(count: int) -> npt.NDArray[np.float32]:
    """Intensities from 0 to 1."""
    return np.linspace(0, 1, count, dtype=np.float32)


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


TWO_PARTS = """\
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 1 1 0
v 1 1 1
g front.low
f 1 2 3 4
g side
f 2 5 6 3
"""
"""An OBJ file of two squares, which are two parts."""

TWO_PARTS_SCENE = """\
[[mesh]]
file = "two.obj"
[surfaces."front.low"]
object_color = "#102030"
[surfaces.side]
[[lights]]
name = "key"
position = [2.0, -3.0, 4.0]
aim = [0, 0, 0]
flaps.z = { minimum = 0.0, maximum = 0.5 }
[[lights]]
name = "key.2"
position = [-2.0, -3.0, 4.0]
"""
"""A scene file of them, with two lights."""


def scene_folder(folder: Path) -> Path:
    """A folder that is made with the scene file of two squares and their mesh."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "two.obj").write_text(TWO_PARTS)
    (folder / "scene.toml").write_text(TWO_PARTS_SCENE)
    return folder


KEY = Light(
    "key",
    (2, -3, 4),
    aim=(0.5, 0.5, 0.5),
    concentration=4,
    cone_angle=60,
    flaps=Flaps(x=Flap(-0.5, 1.5), z=Flap(maximum=0.75, on=False)),
)


def boxes() -> Scene:
    """A cube of two surfaces under two lights."""
    mesh = Mesh(cube().coordinates, cube().node_numbers, np.array([0, 0, 0, 1, 1, 1]), ("low", "high"))
    return scene_of(
        mesh,
        surfaces=[Surface("low"), Surface("high")],
        surface_of_part={"low": "low", "high": "high"},
        lights=[KEY, Light("fill", (-3, -3, 1), intensity=0.5)],
        view=View((-2, -3, 2), target=(0.5, 0.5, 0.5)),
        name="boxes",
    ).replace(**STRETCHED)


BOXES_STREAM = (
    instructions.erase((0, 0, 12, 8), 5),
    instructions.load_entries(5, [[10, 20, 30]]),
    instructions.erase((2, 2, 4, 4), 7),
    instructions.erase((3, 3, 9, 6), 5),
    instructions.load_entries(5, [[40, 50, 60]]),
)
"""Five instructions for a small display: areas over each other, and an entry that changes."""
