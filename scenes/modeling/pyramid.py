"""Write the mesh of the pyramid on a plane: `python -m scenes.modeling.pyramid [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

# Assumed: the paper gives no measures of Figure 4.
HALF_BASE, HEIGHT = 1.2, 2.0
HALF_PLANE, CELLS = 6.0, 24


def pyramid_obj() -> str:
    """Return the OBJ text: a part for the four sides and one for the plane, cut in cells."""
    nodes = [(-HALF_BASE, -HALF_BASE, 0.0), (HALF_BASE, -HALF_BASE, 0.0), (HALF_BASE, HALF_BASE, 0.0)]
    nodes += [(-HALF_BASE, HALF_BASE, 0.0), (0.0, 0.0, HEIGHT)]
    sides = [(1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]
    first, row = len(nodes) + 1, CELLS + 1
    step = 2 * HALF_PLANE / CELLS
    nodes += [(i * step - HALF_PLANE, j * step - HALF_PLANE, 0.0) for j in range(row) for i in range(row)]
    corners = [first + j * row + i for j in range(CELLS) for i in range(CELLS)]
    cells = [(corner, corner + 1, corner + row + 1, corner + row) for corner in corners]
    lines = ["# a pyramid on a plane"]
    lines += [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in nodes]
    for name, polygons in (("pyramid", sides), ("plane", cells)):
        lines.append(f"g {name}")
        lines += ["f " + " ".join(map(str, polygon)) for polygon in polygons]
    return "\n".join(lines) + "\n"


def main(folder: Path) -> None:
    """Write pyramid.obj into the folder."""
    (folder / "pyramid.obj").write_text(pyramid_obj(), encoding="ascii", newline="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "pyramid")
