"""Write the meshes of a row of turned objects on a floor: `python -m scenes.modeling.row [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np

from scenes.modeling.coupe.curves import Array, bspline

# Assumed: the paper names several objects of which a cone picks one out, but does not say which.
# fmt: off
PROFILES: Final = {
    "vase": [(0.0, 0.0), (0.24, 0.0), (0.26, 0.05), (0.42, 0.4), (0.46, 0.75), (0.16, 1.05), (0.17, 1.25),
             (0.3, 1.4)],
    "pawn": [(0.0, 0.0), (0.42, 0.0), (0.44, 0.12), (0.36, 0.2), (0.14, 0.35), (0.12, 0.85), (0.3, 0.9),
             (0.1, 0.95), (0.3, 1.02), (0.36, 1.25), (0.26, 1.44), (0.0, 1.5)],
    "bowl": [(0.0, 0.0), (0.22, 0.0), (0.24, 0.06), (0.1, 0.14), (0.1, 0.3), (0.42, 0.42), (0.52, 0.75),
             (0.5, 0.95)],
    "bottle": [(0.0, 0.0), (0.3, 0.0), (0.33, 0.05), (0.33, 0.4), (0.33, 0.85), (0.3, 1.05), (0.1, 1.2),
               (0.1, 1.5), (0.13, 1.56), (0.13, 1.62)],
    "top": [(0.0, 0.0), (0.03, 0.04), (0.12, 0.3), (0.5, 0.62), (0.52, 0.72), (0.3, 0.9), (0.06, 0.96),
            (0.05, 1.25), (0.07, 1.3), (0.0, 1.34)],
}
# fmt: on
"""Control points (radius, height) of the curves that are turned, from the middle of the foot upward.

Vase, bowl and bottle are shells, open at the top.
"""

APART: Final = 1.25
SIDES, RINGS = 36, 30
HALF_FLOOR, CELLS = (9.0, 6.0), (36, 24)


def turned(profile: list[tuple[float, float]]) -> tuple[Array, list[tuple[int, ...]]]:
    """Return the nodes, (n, 3), and the polygons of a curve turned around the z axis, its inside as well."""
    curve = bspline(profile, np.linspace(0, len(profile) - 3, RINGS + 1))
    around = np.linspace(0, 2 * np.pi, SIDES, endpoint=False)
    radius, height = curve[:, :1], np.repeat(curve[:, 1:], SIDES, axis=1)
    rings = np.stack([radius * np.cos(around), radius * np.sin(around), height], axis=-1)
    nodes = rings.reshape(-1, 3)
    polygons = [
        (low + side, low + (side + 1) % SIDES, low + SIDES + (side + 1) % SIDES, low + SIDES + side)
        for low in range(0, RINGS * SIDES, SIDES)
        for side in range(SIDES)
    ]
    merged = [tuple(dict.fromkeys(_merged(polygon, curve))) for polygon in polygons]
    used = sorted({node for polygon in merged for node in polygon})
    numbers = {node: number for number, node in enumerate(used)}
    return nodes[used], [tuple(numbers[node] for node in polygon) for polygon in merged]


def _merged(polygon: tuple[int, ...], curve: Array) -> list[int]:
    """Return the node numbers with those of a ring without radius as its first one."""
    return [node - node % SIDES if curve[node // SIDES, 0] < 1e-9 else node for node in polygon]


def row_obj() -> str:
    """Return the OBJ text: a part for each object."""
    lines, first = ["# a row of turned objects"], 1
    for place, (name, profile) in enumerate(PROFILES.items()):
        nodes, polygons = turned(profile)
        nodes = nodes + np.array([(place - (len(PROFILES) - 1) / 2) * APART, 0.0, 0.0])
        lines += [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in nodes.tolist()]
        lines.append(f"g {name}")
        lines += ["f " + " ".join(str(first + node) for node in polygon) for polygon in polygons]
        first += len(nodes)
    return "\n".join(lines) + "\n"


def floor_obj() -> str:
    """Return the OBJ text of the floor, cut in cells."""
    across, along = (
        np.linspace(-half, half, cells + 1) for half, cells in zip(HALF_FLOOR, CELLS, strict=True)
    )
    lines = ["# the floor below the row"] + [f"v {x:.4f} {y:.4f} 0" for y in along for x in across]
    lines.append("g floor")
    row = CELLS[0] + 1
    corners = [1 + j * row + i for j in range(CELLS[1]) for i in range(CELLS[0])]
    lines += [f"f {corner} {corner + 1} {corner + row + 1} {corner + row}" for corner in corners]
    return "\n".join(lines) + "\n"


def main(folder: Path) -> None:
    """Write row.obj and floor.obj into the folder."""
    (folder / "row.obj").write_text(row_obj(), encoding="ascii", newline="\n")
    (folder / "floor.obj").write_text(floor_obj(), encoding="ascii", newline="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "row")
