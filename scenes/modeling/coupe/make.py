"""Write the mesh files of the coupe: `python -m scenes.modeling.coupe.make [FOLDER]`.

The car is a sports coupe of the early 1980s with a long hood and a glass hatch, in meters: x runs from nose
to tail, y to the right, z up; the wheels stand on z = 0. Each run makes the same meshes to the last digit.

Assumed: the paper's mesh is GM's own design data; this car only has its kind and size, and twice as many
polygons. Lamps and wheels are closed surfaces. The body has openings for the windshield and the side windows,
and the cabin behind them. Mirrors, moldings and other small things are solids that stick in the body and
share no node with it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from scenes.modeling.coupe import details, panels, wheels
from scenes.modeling.coupe.parts import Parts

# fmt: off
FILES = {
    "body.obj": (
        "hood", "fender_left", "fender_right", "door_left", "door_right", "quarter_left", "quarter_right",
        "sill_left", "sill_right", "wheel_arches", "front_fascia", "rear_fascia", "roof", "pillar_left",
        "pillar_right", "sail_left", "sail_right", "deck", "mirrors", "windshield", "window_left",
        "window_right", "hatch_glass", "mirror_glass", "glass_trim", "gaps", "cowl", "wipers", "handles",
        "moldings", "recesses", "turn_lamps", "wheel_wells", "underbody",
    ),
    "lamps.obj": (
        "grille", "lamp_frames", "lamp_rims", "head_lamps", "tail_lamps", "side_markers", "license_plate",
        "letters",
    ),
    "cabin.obj": ("lining", "reveals", "dashboard", "shelf", "door_trim", "seats", "steering_wheel"),
    "chassis.obj": ("tires", "wheels", "brakes"),
}
# fmt: on


GROOVE = 0.008
"""The depth of the shut lines."""


def car() -> Parts:
    """Return all parts of the car."""
    parts = Parts()
    panels.build(parts)
    panels_ = [name for name in FILES["body.obj"] if name in parts.polygons and name != "gaps"]
    parts.sink("gaps", panels_, GROOVE)
    details.build(parts)
    wheels.build(parts)
    return parts


def meshes() -> dict[str, str]:
    """Return the text of each mesh file by its name. The scene computes the normals of lamps and wheels."""
    parts = car()
    apart = {"body.obj": ["gaps"], "cabin.obj": ["reveals"]}
    return {name: parts.obj(list(names), f"coupe, {name}", apart.get(name)) for name, names in FILES.items()}


def main(folder: Path) -> None:
    """Write the mesh files into the folder."""
    for name, text in meshes().items():
        (folder / name).write_text(text, encoding="ascii", newline="\n")
    parts = car()
    counts = np.sum([parts.counts(list(names)) for names in FILES.values()], axis=0)
    print("nodes {}, polygons {}, distinct edges {}".format(*counts))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2] / "coupe")
