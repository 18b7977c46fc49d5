"""Writing a mesh as a binary PLY file."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import chunks
from autocolor.checks import printable
from autocolor.files.meshes.ply.properties import AXES, FACE, PART, VERTEX, property_of
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON, MeshScalar

ROWS_AT_ONCE: Final = 1 << 16

Fields = list[tuple[str, str]]


def ply_bytes(mesh: Mesh) -> bytes:
    """The mesh as a binary PLY file, little endian, with its parts and scalars; its numbers read back equal.

    Coordinates and scalars are of type double. Each part is named in a comment, and each face has the number
    of its part where there are several. A scalar whose name is no word, or that of something else in PLY, is
    a property `value_N` with its name in a comment.

    Reading it back gives the same mesh unless the reader repairs it: a polygon without area is dropped, and
    names of parts and scalars are printable, of at most 200 letters, with no spaces around them.
    """
    nodes, polygons = len(mesh.coordinates), len(mesh.node_numbers)
    properties = [property_of(each.name, number) for number, each in enumerate(mesh.scalars)]
    of_nodes, of_polygons = (
        [(name, each) for name, each in zip(properties, mesh.scalars, strict=True) if each.of == of]
        for of in (NODE, POLYGON)
    )
    has_parts = len(mesh.part_names) > 1
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        "comment written by autocolor",
        *(f"comment part {number} {printable(name)}" for number, name in enumerate(mesh.part_names)),
        *(
            f"comment scalar {name} {printable(each.name)}"
            for name, each in zip(properties, mesh.scalars, strict=True)
            if name != each.name
        ),
        f"element {VERTEX} {nodes}",
        *(f"property double {name}" for name in (*AXES, *(name for name, _ in of_nodes))),
        f"element {FACE} {polygons}",
        "property list uchar int vertex_indices",
        *([f"property int {PART}"] if has_parts else []),
        *(f"property double {name}" for name, _ in of_polygons),
        "end_header\n",
    ]
    node_rows = np.empty(nodes, _dtype([(axis, "<f8") for axis in AXES], of_nodes))
    for axis, values in zip(AXES, mesh.coordinates.T, strict=True):
        node_rows[axis] = values
    for name, scalar in of_nodes:
        node_rows[name] = scalar.values
    faces = [_faces(mesh, chunk, of_polygons, has_parts) for chunk in chunks(polygons, ROWS_AT_ONCE)]
    return b"".join(["\n".join(lines).encode("utf-8", "replace"), node_rows.tobytes(), *faces])


def _dtype(fields: Fields, scalars: list[tuple[str, MeshScalar]]) -> np.dtype[np.void]:
    return np.dtype([*fields, *((name, "<f8") for name, _ in scalars)])


def _faces(mesh: Mesh, chunk: slice, scalars: list[tuple[str, MeshScalar]], has_parts: bool) -> bytes:
    """The rows of some polygons."""
    corners = mesh.node_numbers[chunk]
    is_triangle = corners[:, 2] == corners[:, 3]
    # Every row is made as long as that of a quad, and the last corner of a triangle cut out.
    fields: Fields = [("count", "u1"), *((f"corner {at}", "<i4") for at in range(4))]
    rows = np.empty(len(corners), _dtype([*fields, *([(PART, "<i4")] if has_parts else [])], scalars))
    rows["count"] = np.where(is_triangle, 3, 4)
    for at in range(4):
        rows[f"corner {at}"] = corners[:, at]
    if has_parts:
        rows[PART] = mesh.part_numbers[chunk]
    for name, scalar in scalars:
        rows[name] = scalar.values[chunk]
    if not is_triangle.any():
        return rows.tobytes()
    kept = np.ones((len(rows), rows.itemsize), np.bool_)
    first = rows.dtype.fields["corner 3"][1]  # type: ignore[index]
    kept[is_triangle, first : first + 4] = False
    return rows.view(np.uint8).reshape(kept.shape)[kept].tobytes()
