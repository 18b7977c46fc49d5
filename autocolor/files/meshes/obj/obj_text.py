"""Writing a mesh as the text of an OBJ file, and surfaces as that of a material library (MTL)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from autocolor.arrays import chunks
from autocolor.scene.mesh import Mesh
from autocolor.scene.surfaces import Surface

ROWS_AT_ONCE: Final = 1 << 16
"""Rows that are made text at once, so that their Python values are few."""


def obj_text(mesh: Mesh, materials: Sequence[str] = (), library: str = "") -> bytes:
    """The mesh as an OBJ file in UTF-8, with an `o` for each part; its numbers read back equal.

    `materials` are the names of the materials of the parts, if any, and `library` that of their file.
    Reading it back gives the same mesh unless the reader repairs it: a polygon without area is dropped, parts
    are those of polygons and in their order, and names are printable, with no spaces around them.
    """
    return "\n".join(_lines(mesh, materials, library)).encode("utf-8", "replace") + b"\n"


def mtl_text(surfaces: Iterable[tuple[str, Surface]]) -> bytes:
    """Surfaces, each with the name of its material, as a material library that `materials` reads back.

    Its diffuse reflectance, its light color and what else a material does not have is left out; so is the
    exponent of a reflection model that has none.
    """
    lines = []
    for name, surface in surfaces:
        color = " ".join(f"{component / 255:.6g}" for component in surface.paint.object_color)
        specular = surface.reflectance.specular
        exponent = vars(surface.reflectance.model).get("exponent")
        lines += [f"newmtl {name}", f"Kd {color}", f"Ks {specular!r} {specular!r} {specular!r}"]
        lines += ["illum 2"] if exponent is None else [f"Ns {exponent!r}", "illum 2"]
    return "\n".join([*lines, ""]).encode("utf-8", "replace")


def _lines(mesh: Mesh, materials: Sequence[str], library: str) -> Iterator[str]:
    """The lines of nodes, then those of polygons, with the name of a part wherever it changes."""
    if library:
        yield f"mtllib {library}"
    for chunk in chunks(len(mesh.coordinates), ROWS_AT_ONCE):
        for x, y, z in mesh.coordinates[chunk].tolist():
            yield f"v {x!r} {y!r} {z!r}"
    before = -1
    for chunk in chunks(len(mesh.node_numbers), ROWS_AT_ONCE):
        parts = mesh.part_numbers[chunk].tolist()
        for part, corners in zip(parts, (mesh.node_numbers[chunk] + 1).tolist(), strict=True):
            if part != before:
                yield f"o {mesh.part_names[part]}"
                if materials:
                    yield f"usemtl {materials[part]}"
                before = part
            a, b, c, d = corners
            yield f"f {a} {b} {c}" if c == d else f"f {a} {b} {c} {d}"
