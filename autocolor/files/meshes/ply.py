"""Meshes in PLY files: read in text or binary in either byte order, and written.

Nodes come from the element `vertex`, polygons from `face`. Other elements, and bytes after the last element,
are skipped and counted. `ply_elements` reads the elements, whose properties may have any type and any order.

A property `part`, `material_index` or `group` of faces is a part number. A comment such as `part 0 hood`
names a part; without comments, parts are named after the property. All other numbers of vertices and faces
are scalars, but for the normals of vertices, colors, which are left out, and texture coordinates, which are
ignored. NaN is a missing value.

A mesh is written in binary, little endian.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
from autocolor.checks import LARGEST_COORDINATE, listed, printable
from autocolor.errors import InputError
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.ply_elements import ElementRows, Lists, read_elements
from autocolor.files.meshes.repair import (
    PLAIN,
    MeshReport,
    Placement,
    RawPolygons,
    different,
    name_of,
    repaired,
)
from autocolor.files.reading import read_whole
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import NODE, POLYGON

VERTEX: Final = "vertex"
FACE: Final = "face"
STRIPS: Final = "tristrips"
NO_ROWS: Final = ElementRows(0, {})
AXES: Final = ("x", "y", "z")
CORNERS: Final = ("vertex_indices", "vertex_index")

GROWTH: Final = 8
"""Measured: how many times its size a file of triangles takes. A file of quads, with coordinates of 64 bits,
takes 5, and the words of a text are counted (see `NumberText`)."""

PART: Final = "part"
PARTS: Final = (PART, "material_index", "group")
"""Face properties that assign parts, in order of preference. The first one present is used."""

MOST_PARTS: Final = 10_000
"""Limit: a property with more different values is a scalar, unless comments name all its parts."""

LARGEST_INDEX: Final = 1 << 53
"""Part numbers below this are exact in floating point."""

NORMAL: Final = ("nx", "ny", "nz")

COLOR: Final = re.compile(r"[rgba]|((ambient|diffuse|specular)_)?(red|green|blue|alpha)")
NOT_SCALAR: Final = re.compile(
    rf"{COLOR.pattern}|(ambient|diffuse|specular)_(coeff|power)|n[xyz]|[stuv]0?|texture_[stuv]"
    "|texcoord|texnumber|flags|[xyz]"
)
"""Properties that are not scalars: coordinates, normals, colors, texture coordinates and flags."""

NAMED_PART: Final = re.compile(rb"part (\d{1,9}) (.+)")
NAMED_SCALAR: Final = re.compile(rb"scalar (\S+) (.+)")
PLAIN_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_.\-]{0,63}")


def named_in(comments: Sequence[bytes]) -> tuple[dict[int, str], dict[str, str]]:
    """The names of parts and of scalars in comments such as `part 0 hood` and `scalar value_0 von Mises`."""
    parts: dict[int, str] = {}
    scalars: dict[str, str] = {}
    for comment in comments:
        if match := NAMED_PART.fullmatch(comment):
            parts.setdefault(int(match[1]), name_of(match[2]))
        elif match := NAMED_SCALAR.fullmatch(comment):
            scalars.setdefault(name_of(match[1]), name_of(match[2]))
    return parts, scalars


def read_ply(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a PLY file, and what was repaired or skipped.

    Raises InputError, with the place of each problem, and MissingInputError if the file does not exist.
    """
    polygons, skipped = _read(path)
    return repaired(polygons, path.name, placement, skipped=tuple(skipped))


def _read(path: Path) -> tuple[RawPolygons, list[str]]:
    """The polygons of a file, and messages about skipped data. Returning frees the bytes of the file."""
    data = read_whole(path, GROWTH)
    elements, comments, skipped = read_elements(data, path.name)
    named_parts, named = named_in(comments)
    vertices, faces = (elements.get(name, NO_ROWS) for name in (VERTEX, FACE))
    if STRIPS in elements and not faces.length:
        raise InputError(f"{path.name}: elements {STRIPS!r} are not read; export it with faces")
    coordinates = _coordinates(vertices, path.name)
    corners, counts = _corners(faces, len(coordinates), path.name)
    messages = [
        f"skipped elements {name!r}: {rows.length:,}"
        for name, rows in reversed(elements.items())
        if name not in (VERTEX, FACE) and rows.length
    ]
    part, part_numbers, part_names = _parts(faces, named_parts, named, path.stem)
    scalars = FileScalars()
    for rows, of in ((vertices, NODE), (faces, POLYGON)):
        for name in rows.columns:
            is_scalar = name in named or not NOT_SCALAR.fullmatch(name)
            if is_scalar and not (of == POLYGON and name == part):
                for column in _numbers(rows, [name]):
                    scalars.add(named.get(name, name), column, of)
        if any(COLOR.fullmatch(name) for name in rows.columns.keys() - named.keys()):
            messages.append(f"left out the colors of {of}s")
    axes = _numbers(vertices, [name for name in NORMAL if name not in named])
    normals = np.stack(axes, axis=1).astype(np.float64) if len(axes) == 3 else None
    polygons = RawPolygons(
        coordinates,
        corners,
        counts,
        part_numbers,
        part_names,
        scalars.scalars,
        normals,
        None if normals is None else corners,
    )
    return polygons, [*messages, *scalars.messages, *skipped]


def _numbers(rows: ElementRows, names: Sequence[str]) -> list[AnyArray]:
    """The columns with these names that an element has, without lists."""
    columns = (rows.columns.get(name) for name in names)
    return [column for column in columns if column is not None and not isinstance(column, Lists)]


def _coordinates(vertices: ElementRows, place: str) -> Floats:
    """The coordinates of the nodes, (nodes, 3)."""
    axes = _numbers(vertices, AXES)
    if len(axes) < 3:
        raise InputError(
            f"{place}: an element 'vertex' must have the numbers x, y and z, not only"
            f" {_listed(vertices)}; export it with coordinates"
        )
    with np.errstate(invalid="ignore"):
        coordinates = np.stack(axes, axis=1, dtype=np.float64, casting="unsafe")
    # A comparison with NaN is false.
    wrong = np.argwhere(~(np.abs(coordinates) <= LARGEST_COORDINATE))
    if len(wrong):
        row, axis = wrong[0].tolist()
        raise InputError(
            f"{place}, {VERTEX} {row}: a coordinate must be a finite number of at most 1e30 in size, not"
            f" {coordinates[row, axis]:g}; correct it"
        )
    return coordinates


def _listed(rows: ElementRows) -> str:
    return listed([*rows.columns][:8] or ["none"])


def _corners(faces: ElementRows, nodes: int, place: str) -> tuple[Indices, Indices]:
    """The rows in the node table of all corners, and how many corners each face has."""
    if not faces.length:
        return np.empty(0, np.intp), np.empty(0, np.intp)
    lists = next((faces.columns[name] for name in CORNERS if name in faces.columns), None)
    if not isinstance(lists, Lists):
        raise InputError(
            f"{place}: an element 'face' must have a list 'vertex_indices', not only"
            f" {_listed(faces)}; export it with polygons"
        )
    values, counts = lists
    is_node = np.ones(1, np.bool_)
    if values.dtype.kind == "f" or (len(values) and not 0 <= values.min() <= values.max() < nodes):
        is_node = (values >= 0) & (values < nodes) & (np.floor(values) == values)
    if not is_node.all():
        corner = int(is_node.argmin())
        row = int(np.searchsorted(np.cumsum(counts), corner, side="right"))
        raise InputError(
            f"{place}, {FACE} {row}: a corner must be the number of one of {nodes:,} nodes, from 0 on, not"
            f" {values[corner]:.15g}; correct it"
        )
    return values.astype(np.intp, copy=False), counts


def _parts(
    faces: ElementRows, named: Mapping[int, str], scalars: Mapping[str, str], stem: str
) -> tuple[str | None, Indices, tuple[str, ...]]:
    """The face property that assigns parts, if any, the part number of each face, and the names of parts."""
    for name in PARTS:
        for column in _numbers(faces, [name] if name not in scalars else []):
            values = np.unique(column).tolist()
            parts = named if name == PART else {}
            is_whole = all(abs(value) < LARGEST_INDEX and value == int(value) for value in values)
            if is_whole and (len(values) <= MOST_PARTS or parts.keys() >= set(values)):
                numbers = sorted({*map(int, values), *parts})
                names = different([parts.get(number, f"{name} {number}") for number in numbers])
                return name, np.searchsorted(numbers, column).astype(np.intp, copy=False), names
    names = different([named[number] for number in sorted(named)] or [stem])
    return None, np.zeros(faces.length, np.intp), names


def property_of(scalar: str, number: int) -> str:
    """The property for a scalar: its name, or `value_N` if that is no plain word or has another meaning."""
    is_taken = NOT_SCALAR.fullmatch(scalar) or scalar in (*PARTS, *CORNERS) or scalar.startswith("value_")
    return scalar if PLAIN_NAME.fullmatch(scalar) and not is_taken else f"value_{number}"


def ply_bytes(mesh: Mesh) -> bytes:
    """The mesh as a binary PLY file, little endian, with its parts and scalars; its numbers read back equal.

    Coordinates and scalars are of type double. A comment names each part. With several parts, each face
    has its part number. A scalar whose name is no plain word or has another meaning in PLY is a property
    `value_N`, and a comment gives its name.

    Reading it back gives the same mesh unless the reader repairs it: a polygon without area is dropped, and
    names of parts and scalars are printable, of at most 200 letters, with no spaces around them.
    """
    nodes, polygons = len(mesh.coordinates), len(mesh.node_numbers)
    properties = {property_of(each.name, number): each for number, each in enumerate(mesh.scalars)}
    of_nodes, of_polygons = (
        {name: each.values for name, each in properties.items() if each.of == of} for of in (NODE, POLYGON)
    )
    parts = {PART: mesh.part_numbers} if len(mesh.part_names) > 1 else {}
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        "comment written by autocolor",
        *(f"comment part {number} {printable(name)}" for number, name in enumerate(mesh.part_names)),
        *(
            f"comment scalar {name} {printable(each.name)}"
            for name, each in properties.items()
            if name != each.name
        ),
        f"element {VERTEX} {nodes}",
        *(f"property double {name}" for name in (*AXES, *of_nodes)),
        f"element {FACE} {polygons}",
        "property list uchar int vertex_indices",
        *(f"property int {name}" for name in parts),
        *(f"property double {name}" for name in of_polygons),
        "end_header\n",
    ]
    columns = {**dict(zip(AXES, mesh.coordinates.T, strict=True)), **of_nodes}
    node_rows = np.empty(nodes, [(name, "<f8") for name in columns])
    for name, values in columns.items():
        node_rows[name] = values
    types = [("count", "u1"), *((f"corner {at}", "<i4") for at in range(4))]
    types += [*((name, "<i4") for name in parts), *((name, "<f8") for name in of_polygons)]
    pieces = ["\n".join(lines).encode("utf-8", "replace"), node_rows.tobytes()]
    is_triangle = mesh.node_numbers[:, 2] == mesh.node_numbers[:, 3]
    # Rows begin as quads; then the last corner of each triangle is cut out.
    rows = np.empty(polygons, types)
    rows["count"] = np.where(is_triangle, 3, 4)
    for at, corners in enumerate(mesh.node_numbers.T):
        rows[f"corner {at}"] = corners
    for name, values in {**parts, **of_polygons}.items():
        rows[name] = values
    is_written = np.ones((polygons, rows.itemsize), np.bool_)
    is_written[is_triangle, 13:17] = False
    pieces.append(rows.view(np.uint8).reshape(is_written.shape)[is_written].tobytes())
    return b"".join(pieces)
