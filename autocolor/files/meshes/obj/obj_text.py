"""Writing a mesh as the text of an OBJ file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from autocolor.arrays import chunks
from autocolor.scene.mesh import Mesh

ROWS_AT_ONCE: Final = 1 << 16
"""Rows that are made text at once, so that their Python values are few."""


def obj_text(mesh: Mesh) -> bytes:
    """The mesh as an OBJ file in UTF-8, with an `o` for each part; its numbers read back equal.

    Reading it back gives the same mesh unless the reader repairs it: a polygon without area is dropped, parts
    are those of polygons and in their order, and names are printable, with no spaces around them.
    """
    return "\n".join(_lines(mesh)).encode("utf-8", "replace") + b"\n"


def _lines(mesh: Mesh) -> Iterator[str]:
    """The lines of nodes, then those of polygons, with the name of a part wherever it changes."""
    for chunk in chunks(len(mesh.coordinates), ROWS_AT_ONCE):
        for x, y, z in mesh.coordinates[chunk].tolist():
            yield f"v {x!r} {y!r} {z!r}"
    before = -1
    for chunk in chunks(len(mesh.node_numbers), ROWS_AT_ONCE):
        parts = mesh.part_numbers[chunk].tolist()
        for part, corners in zip(parts, (mesh.node_numbers[chunk] + 1).tolist(), strict=True):
            if part != before:
                yield f"o {mesh.part_names[part]}"
                before = part
            a, b, c, d = corners
            yield f"f {a} {b} {c}" if c == d else f"f {a} {b} {c} {d}"
