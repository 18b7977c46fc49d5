"""Meshes in PLY files: read in text or binary in either byte order, and written.

Nodes come from the element `vertex`, polygons from `face`, or from `tristrips` where there are no faces.
Other elements, and bytes after the last element, are skipped and counted. `ply_elements` reads the elements,
whose properties may have any type and any order.

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
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, chunks
from autocolor.checks import LARGEST_COORDINATE, listed, printable
from autocolor.errors import InputError
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.ply_elements import (
    FACE,
    STRIPS,
    VERTEX,
    ElementRows,
    Lists,
    parsed_header,
    read_binary,
    read_text,
)
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
from autocolor.scene.scalar import NODE, POLYGON, MeshScalar

AXES: Final = ("x", "y", "z")
CORNERS: Final = ("vertex_indices", "vertex_index")

GROWTH: Final = 8
"""Measured: how many times its size a file of triangles takes. A file of quads, with coordinates of 64 bits,
takes 5, and the words of a text are counted (see `NumberText`)."""

PART: Final = "part"
PARTS: Final = (PART, "material_index", "group")
"""Face properties that assign parts, in order of preference. The first one present is used."""

MOST_UNNAMED_PARTS: Final = 10_000
"""Limit: a property with more different values is a scalar."""

NORMALS: Final = (("nx", "ny", "nz"), ("normal_x", "normal_y", "normal_z"))

COLOR: Final = re.compile(r"[rgba]|((ambient|diffuse|specular)_)?(red|green|blue|alpha)")
NOT_SCALAR: Final = re.compile(
    rf"{COLOR.pattern}|(ambient|diffuse|specular)_(coeff|power)|n[xyz]|normal_[xyz]|[stuv]0?|texture_[stuv]"
    "|texcoord|texnumber|flags|[xyz]"
)
"""Properties that are not scalars: coordinates, normals, colors, texture coordinates and flags."""

NAMED_PART: Final = re.compile(r"part (\d{1,9}) (.+)")
NAMED_SCALAR: Final = re.compile(r"scalar (\S+) (.+)")
PLAIN_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_.\-]{0,63}")


class Comments(NamedTuple):
    """What comments name: parts by number, and scalars by their properties."""

    parts: Mapping[int, str]
    scalars: Mapping[str, str]


def named_in(comments: Sequence[str]) -> Comments:
    """The names in comments such as `part 0 hood` and `scalar value_0 von Mises`; others say nothing."""
    parts: dict[int, str] = {}
    scalars: dict[str, str] = {}
    for comment in comments:
        if match := NAMED_PART.fullmatch(comment):
            parts.setdefault(int(match[1]), name_of(match[2].encode()))
        elif match := NAMED_SCALAR.fullmatch(comment):
            scalars.setdefault(match[1], name_of(match[2].encode()))
    return Comments(parts, scalars)


def is_scalar(name: str, comments: Comments) -> bool:
    """Whether a number of vertices or faces is a scalar of the mesh."""
    return name in comments.scalars or NOT_SCALAR.fullmatch(name) is None


def property_of(scalar: str, number: int) -> str:
    """The property for a scalar: its name, or `value_N` if that is no plain word or has another meaning."""
    is_taken = NOT_SCALAR.fullmatch(scalar) or scalar in (*PARTS, *CORNERS) or scalar.startswith("value_")
    return scalar if PLAIN_NAME.fullmatch(scalar) and not is_taken else f"value_{number}"


def read_ply(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a PLY file, and what was repaired or skipped.

    Raises InputError, with the place of each problem, and MissingInputError if the file does not exist.
    """
    polygons, skipped = _read(path)
    return repaired(polygons, path.name, placement, skipped=tuple(skipped))


def _read(path: Path) -> tuple[RawPolygons, list[str]]:
    """The polygons of a file, and messages about skipped data. Returning frees the bytes of the file."""
    data = read_whole(path, GROWTH)
    header = parsed_header(data, path.name)
    elements, skipped = (read_binary if header.order else read_text)(data, header, path.name)
    comments = named_in(header.comments)
    polygons, messages = ply_polygons(elements, comments, path.name, path.stem)
    return polygons, [*messages, *skipped]


LARGEST_INDEX: Final = 1 << 53
"""Part numbers below this are exact in floating point."""


def ply_polygons(
    elements: dict[str, ElementRows], comments: Comments, place: str, stem: str
) -> tuple[RawPolygons, list[str]]:
    """The polygons of the elements of a file, and messages about elements and values that are skipped.

    `place` is the file's name in messages, `stem` the name of a single part. Raises InputError with the first
    problems of coordinates and of corners, each with its place.
    """
    vertices, faces, strips = (elements.get(name) for name in (VERTEX, FACE, STRIPS))
    coordinates = _coordinates(vertices, place)
    has_strips = strips is not None and strips.count > 0 and not (faces and faces.count)
    if has_strips:
        corners, counts = triangles_of_strips(*_corners(strips, len(coordinates), place, STRIPS))
        # Strips have corners alone: no parts and no scalars.
        faces = None
    else:
        corners, counts = _corners(faces, len(coordinates), place, FACE)
    used = (VERTEX, FACE, STRIPS) if has_strips else (VERTEX, FACE)
    messages = [
        f"skipped elements {name!r}: {rows.count:,}"
        for name, rows in reversed(elements.items())
        if name not in used and rows.count
    ]
    part = _part_property(faces, comments)
    part_numbers, names = _parts(faces, part, comments, stem, len(counts))
    scalars = FileScalars()
    for rows, of in ((vertices, NODE), (faces, POLYGON)):
        columns = {} if rows is None else rows.columns
        for name, column in columns.items():
            is_part = of == POLYGON and name == part
            if not isinstance(column, Lists) and not is_part and is_scalar(name, comments):
                scalars.add(comments.scalars.get(name, name), column, of)
        if any(COLOR.fullmatch(name) for name in columns.keys() - comments.scalars.keys()):
            messages.append(f"left out the colors of {of}s")
    normals = None if vertices is None else _normals(vertices, comments)
    polygons = RawPolygons(
        coordinates,
        corners,
        counts,
        part_numbers,
        names,
        scalars.scalars,
        # Lines would keep the text of the file in memory.
        lambda row: f"triangle {row} of {STRIPS}" if has_strips else f"{FACE} {row}",
        normals,
        None if normals is None else corners,
    )
    return polygons, [*messages, *scalars.messages]


def _coordinates(vertices: ElementRows | None, place: str) -> Floats:
    """The coordinates of the nodes, (nodes, 3)."""
    columns = {} if vertices is None else vertices.columns
    axes = [columns.get(axis) for axis in AXES]
    coordinates = np.empty((0 if vertices is None else vertices.count, 3))
    for row, axis in enumerate(axes):
        if axis is None or isinstance(axis, Lists):
            found = f"only {listed(list(columns)[:8])}" if columns else "none"
            raise InputError(
                f"{place}: an element 'vertex' must have the properties x, y and z, not {found};"
                " export it with coordinates"
            )
        with np.errstate(invalid="ignore"):
            coordinates[:, row] = axis
    # A comparison with NaN is false.
    if vertices is not None and not (np.abs(coordinates) <= LARGEST_COORDINATE).all():
        row, axis = np.argwhere(~(np.abs(coordinates) <= LARGEST_COORDINATE))[0].tolist()
        raise InputError(
            f"{vertices.place_of(row)}: a coordinate must be a finite number of at most 1e30 in size, not"
            f" {coordinates[row, axis]:g}; correct it"
        )
    return coordinates


def _normals(vertices: ElementRows, comments: Comments) -> Floats | None:
    """The normals of the nodes, (nodes, 3); None if there are none."""
    for names in NORMALS:
        columns = [vertices.columns.get(name) for name in names if name not in comments.scalars]
        numbers = [column for column in columns if column is not None and not isinstance(column, Lists)]
        if len(numbers) == 3:
            return np.stack(numbers, axis=1).astype(np.float64)
    return None


def _corners(rows: ElementRows | None, nodes: int, place: str, name: str) -> tuple[Indices, Indices]:
    """The rows in the node table of all corners, and how many corners each row of an element has."""
    if rows is None or not rows.count:
        return np.empty(0, np.intp), np.empty(0, np.intp)
    lists = next((rows.columns[name] for name in CORNERS if name in rows.columns), None)
    if not isinstance(lists, Lists):
        raise InputError(
            f"{place}: an element {name!r} must have a list 'vertex_indices', not"
            f" only {listed(list(rows.columns)[:8]) or 'none'}; export it with polygons"
        )
    values, counts = lists
    least = 0 if name == FACE else -1
    if len(values) and not (values.min() >= least and values.max() < nodes and _are_whole(values)):
        is_node = (values >= least) & (values < nodes) & (np.floor(values) == values)
        corner = int(np.flatnonzero(~is_node)[0])
        row = int(np.searchsorted(np.cumsum(counts), corner, side="right"))
        rule = f"from {least} to {nodes - 1:,}" if nodes else "of the file, which has no nodes"
        raise InputError(
            f"{rows.place_of(row)}: a corner must be a node number {rule}, not {values[corner]:.15g};"
            " correct it"
        )
    return values.astype(np.intp, copy=False), counts


def _are_whole(values: AnyArray) -> bool:
    return values.dtype.kind != "f" or bool((values == np.floor(values)).all())


def _part_property(faces: ElementRows | None, comments: Comments) -> str | None:
    """The face property that assigns parts; None if there is none."""
    for name in PARTS:
        column = None if faces is None else faces.columns.get(name)
        if column is None or isinstance(column, Lists) or name in comments.scalars or not len(column):
            continue
        if not (np.abs(column) < LARGEST_INDEX).all() or not _are_whole(column):
            continue
        different_numbers = np.unique(column)
        if len(different_numbers) <= MOST_UNNAMED_PARTS or (
            name == PART and all(number in comments.parts for number in different_numbers.tolist())
        ):
            return name
    return None


def _parts(
    faces: ElementRows | None, part: str | None, comments: Comments, stem: str, polygons: int
) -> tuple[Indices, tuple[str, ...]]:
    """The part number of each polygon, and the names of the parts."""
    if faces is None or part is None:
        names = [comments.parts[number] for number in sorted(comments.parts)] or [stem]
        return np.zeros(polygons, np.intp), different(names)
    column = faces.columns[part]
    assert not isinstance(column, Lists)
    used_numbers = np.unique(column.astype(np.int64))
    named = comments.parts if part == PART else {}
    numbers = np.union1d(used_numbers, np.array(sorted(named), np.int64))
    names = [named.get(number, f"{part} {number}") for number in numbers.tolist()]
    return np.searchsorted(numbers, column.astype(np.int64)).astype(np.intp), different(names)


def triangles_of_strips(numbers: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """The corners and the corner counts of the triangles of strips, as scanned models of the nineties have.

    `numbers` are the corners of all strips, with -1 where a strip ends. `counts` are the lengths of the lists
    in the file; a strip ends with its list, too. Every corner from the third of a strip on makes a triangle
    with the two before it. Every second triangle is turned, so that all wind alike. Triangles with equal
    corners are left out: they only lead to the next triangle.

    >>> triangles_of_strips(np.array([0, 1, 2, 3, -1, 4, 5, 6]), np.array([8]))[0].reshape(-1, 3).tolist()
    [[0, 1, 2], [2, 1, 3], [4, 5, 6]]
    """
    breaks = numbers < 0
    begins = np.zeros(len(numbers) + 1, np.bool_)
    begins[np.cumsum(counts) - counts] = True
    begins[1:] |= breaks
    begins = begins[:-1]
    # The place of each corner in its strip.
    places = np.arange(len(numbers))
    places -= np.maximum.accumulate(np.where(begins, places, 0))
    thirds = np.flatnonzero((places >= 2) & ~breaks)
    before, between, last = (numbers[thirds - back] for back in (2, 1, 0))
    turned = places[thirds] % 2 == 1
    triangles = np.stack([np.where(turned, between, before), np.where(turned, before, between), last], axis=1)
    differ = (before != between) & (between != last) & (last != before)
    visible = triangles[differ]
    return visible.ravel(), np.full(len(visible), 3, np.intp)


ROWS_AT_ONCE: Final = 1 << 16

Fields = list[tuple[str, str]]


def ply_bytes(mesh: Mesh) -> bytes:
    """The mesh as a binary PLY file, little endian, with its parts and scalars; its numbers read back equal.

    Coordinates and scalars are of type double. A comment names each part. With several parts, each face
    has its part number. A scalar whose name is no plain word or has another meaning in PLY is a property
    `value_N`, and a comment gives its name.

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
    # Rows begin as quads; then the last corner of each triangle is cut out.
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
    is_written = np.ones((len(rows), rows.itemsize), np.bool_)
    first = rows.dtype.fields["corner 3"][1]  # type: ignore[index]
    is_written[is_triangle, first : first + 4] = False
    return rows.view(np.uint8).reshape(is_written.shape)[is_written].tobytes()
