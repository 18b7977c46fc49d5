"""Write the mesh files of the coupe: `python -m scenes.modeling.coupe.make [FOLDER]`.

The car is a sports coupe of the early 1980s with a long hood and a glass hatch, in meters: x runs from nose
to tail, y to the right, z up; the wheels stand on z = 0. Each run makes the same meshes to the last digit.

Assumed: the paper's mesh is GM's own design data; this car only has its kind and size, and about as many
nodes. The three files of the car are closed surfaces: the body with its recesses and wheel wells, the
lamps, and the wheels. Mirrors, moldings and other small things are solids that stick in the body and share
no node with it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from scenes.modeling.coupe import details, panels, wheels
from scenes.modeling.coupe.curves import spaced
from scenes.modeling.coupe.parts import Parts

# fmt: off
FILES = {
    "body.obj": (
        "hood", "fender_left", "fender_right", "door_left", "door_right", "quarter_left", "quarter_right",
        "sill_left", "sill_right", "wheel_arches", "front_fascia", "rear_fascia", "roof", "pillar_left",
        "pillar_right", "sail_left", "sail_right", "deck", "spoiler", "mirrors", "windshield", "window_left",
        "window_right", "hatch_glass", "mirror_glass", "glass_trim", "gaps", "cowl", "wipers", "handles",
        "moldings", "recesses", "turn_lamps", "wheel_wells", "underbody",
    ),
    "lamps.obj": (
        "grille", "lamp_frames", "head_lamps", "tail_lamps", "side_markers", "license_plate",
    ),
    "chassis.obj": ("tires", "wheels", "brakes"),
}
# fmt: on


def car() -> Parts:
    """Return all parts of the car."""
    parts = Parts()
    panels.build(parts)
    details.build(parts)
    wheels.build(parts)
    return parts


def ground() -> Parts:
    """Return the studio floor, a disc, and the dark patch of shade below the car.

    Both are sheets that nobody sees from below, so they are open along their rims.
    """
    parts = Parts()
    angle = np.linspace(0, 2 * np.pi, 33)[:, None]
    radius = spaced(0.0, 4.0, 11.0, counts=(3, 4))
    disc = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius * angle], axis=-1)
    parts.grid("floor", disc, outward=(0, 0, 1), mirror=False)
    # A superellipse, its nodes crowded toward the corners.
    angle = np.linspace(0, 2 * np.pi, 65)[:, None]
    angle = angle - 0.20 * np.sin(4 * angle)
    rounded = [np.sign(wave) * np.abs(wave) ** 0.4 for wave in (np.cos(angle), np.sin(angle))]
    share = np.array([0.0, 1.0])
    shade = np.stack(
        [2.1 * share * rounded[0], 0.83 * share * rounded[1], 0 * share * angle + 0.005], axis=-1
    )
    parts.grid("shade", shade, outward=(0, 0, 1), mirror=False)
    return parts


def meshes() -> dict[str, str]:
    """Return the text of each mesh file by its name."""
    parts = car()
    texts = {name: parts.obj(list(names), f"coupe, {name}") for name, names in FILES.items()}
    floor = ground()
    return {**texts, "floor.obj": floor.obj(list(floor.polygons), "coupe, studio floor")}


def main(folder: Path) -> None:
    """Write the mesh files into the folder."""
    for name, text in meshes().items():
        (folder / name).write_text(text, encoding="ascii", newline="\n")
    parts = car()
    counts = np.sum([parts.counts(list(names)) for names in FILES.values()], axis=0)
    print("nodes {}, polygons {}, distinct edges {}".format(*counts))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2] / "coupe")
