"""Write the mesh files of the bracket: `python -m scenes.modeling.bracket.make [FOLDER]`.

bracket.ply holds the bracket with its parts and, at each node, the stress in MPa under the load of its
bearing; floor.obj is what it stands on. Each run makes the same files.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.skin import PARTS, both_halves, half_skin
from scenes.modeling.bracket.solid import half_solid
from scenes.modeling.bracket.stress import stress

FLOOR_RADII: Final = (0.0, 60.0, 120.0, 180.0, 250.0, 340.0, 450.0, 600.0)
FLOOR_SIDES: Final = 48
FLOOR_CENTER: Final = (50.0, 0.0)


def bracket_ply() -> str:
    """The PLY text of the bracket with its stress."""
    solid = half_solid()
    skin = half_skin(solid)
    nodes, corners, parts, rows = both_halves(solid.nodes, skin)
    return ply(nodes, corners, parts, stress(solid, skin)[rows])


def ply(nodes: Floats, corners: Indices, parts: Indices, stresses: Floats) -> str:
    """The PLY text of quads with a part each, and of nodes with a stress each."""
    order = np.argsort(parts, kind="stable")
    lines = ["ply", "format ascii 1.0", "comment a bearing bracket, in millimeters, and its stress in MPa"]
    lines += [f"comment part {number} {name}" for number, name in enumerate(PARTS)]
    lines += [f"element vertex {len(nodes)}"]
    lines += [
        f"property {kind} {name}" for kind, name in zip(["float"] * 4, ("x", "y", "z", "stress"), strict=True)
    ]
    lines += [f"element face {len(corners)}", "property list uchar int vertex_indices", "property int part"]
    lines += ["end_header"]
    # Adding zero makes -0 plain 0.
    places, values = np.round(nodes, 4) + 0.0, np.round(stresses, 2) + 0.0
    lines += [
        f"{x:.4f} {y:.4f} {z:.4f} {value:.2f}"
        for (x, y, z), value in zip(places.tolist(), values.tolist(), strict=True)
    ]
    lines += [
        f"4 {a} {b} {c} {d} {part}"
        for (a, b, c, d), part in zip(corners[order].tolist(), parts[order].tolist(), strict=True)
    ]
    return "\n".join(lines) + "\n"


def floor_obj() -> str:
    """The OBJ text of the floor, a disc."""
    angles = np.linspace(0, 2 * np.pi, FLOOR_SIDES, endpoint=False)
    lines = ["# the floor below the bracket", "g floor", f"v {FLOOR_CENTER[0]:.4f} {FLOOR_CENTER[1]:.4f} 0"]
    for radius in FLOOR_RADII[1:]:
        x = np.round(FLOOR_CENTER[0] + radius * np.cos(angles), 4) + 0.0
        y = np.round(FLOOR_CENTER[1] + radius * np.sin(angles), 4) + 0.0
        lines += [f"v {a:.4f} {b:.4f} 0" for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    for ring in range(len(FLOOR_RADII) - 1):
        for side in range(FLOOR_SIDES):
            after = (side + 1) % FLOOR_SIDES
            outer = 2 + ring * FLOOR_SIDES
            inner = [] if ring == 0 else [outer - FLOOR_SIDES + after, outer - FLOOR_SIDES + side]
            lines.append("f " + " ".join(map(str, [outer + side, outer + after, *(inner or [1])])))
    return "\n".join(lines) + "\n"


def main(folder: Path) -> None:
    """Write the mesh files into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bracket.ply").write_text(bracket_ply(), encoding="ascii", newline="\n")
    (folder / "floor.obj").write_text(floor_obj(), encoding="ascii", newline="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2] / "bracket")
