"""Converting the polygons of a file to a mesh of triangles and quads, with a message for each repair.

- A corner that repeats the previous one is removed: a quad becomes a triangle.
- A polygon with fewer than three corners left, or without area, is dropped.
- A polygon with more than four corners is split into quads and triangles.
- A polygon whose sides cross, such as a bow-tie or a pentagram, is split so that it is filled even-odd. Nodes
  are added, after all nodes of the file, with scalars and normals between those at the ends of the side.
- Warped and concave quads are kept, since the renderer fills them scan line by scan line; `scene.mesh_faults`
  finds them.
- A node that no polygon uses is dropped, with its scalars. Tables of nodes (CSV, npy, tables) keep theirs,
  because their rows have the user's own numbers.
- With `Placement.normals` FILE, each corner that is left keeps the file's normal (see `file_normals`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, chunks, cross, dot, underflowing, used_rows
from autocolor.checks import printable
from autocolor.errors import InputError
from autocolor.files.meshes.file_normals import file_normals
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.geometry.polygon_split import MOST_CORNERS, split_polygons
from autocolor.scene.kinds import Number
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import NODE, POLYGON, MeshScalar
from autocolor.scene.surfaces import Surface

UPS: Final = ("x", "y", "z")

COMPUTED: Final = "computed"
FILE: Final = "file"
NORMALS: Final = (COMPUTED, FILE)
"""The choices of normals: computed from the polygons, or the file's own."""

SCALES: Final = Number(at_least=0, at_most=1e30, above=True)
"""The factors that a mesh may be scaled by."""


@dataclass(frozen=True)
class Placement:
    """The axis of the file that is up, a factor for its coordinates, a crease angle or None, and the normals.

    `normals` is one of NORMALS. Where a file has no normals of its own, they are computed.
    """

    up: str = "z"
    scale: float = 1.0
    crease_angle: float | None = None
    normals: str = COMPUTED


PLAIN: Final = Placement()
"""The placement of a file in world coordinates."""


def placed(coordinates: Floats, placement: Placement) -> Floats:
    """The coordinates, (nodes, 3), in the world: the file's up axis turned to z, and scaled.

    The scaled coordinates may be too large for a mesh, which refuses them.
    """
    coordinates = turned_up(coordinates, placement.up)
    return coordinates if placement.scale == 1 else coordinates * placement.scale


def turned_up(vectors: Floats, up: str) -> Floats:
    """Points or directions, (n, 3), whose axis `up` is turned to z.

    Polygons keep their winding: with y up, (x, y, z) becomes (x, -z, y), a rotation about x; with x up it
    becomes (y, z, x).
    """
    if up == "y":
        vectors = vectors[:, [0, 2, 1]]
        vectors[:, 1] = 0.0 - vectors[:, 1]
    elif up == "x":
        vectors = vectors[:, [1, 2, 0]]
    return vectors


@dataclass(frozen=True, eq=False)
class RawPolygons:
    """Nodes and polygons of a file before repair: with any number of corners, possibly repeated.

    `coordinates` is (nodes, 3) float64. `corners` holds the rows in `coordinates` of all corners, polygon
    after polygon; they must be valid. `corner_counts` and `part_numbers`, indices of `part_names`, have one
    element for each polygon. `scalars` belong to nodes or polygons.

    `normals`, (normals, 3) float64, are the file's own, of any length, in the axes of the file;
    `corner_normals` has a row of `normals` for each of `corners`, or -1 where the file has none. Both are
    None for a file without normals.
    """

    coordinates: Floats
    corners: Indices
    corner_counts: Indices
    part_numbers: Indices
    part_names: tuple[str, ...]
    scalars: tuple[MeshScalar, ...] = ()
    normals: Floats | None = None
    corner_normals: Indices | None = None


@dataclass(frozen=True)
class MeshReport:
    """A mesh that was read, with messages about what was repaired or skipped.

    `material_of_part` has the names of materials by part name, where the file gives any; `materials` are the
    surfaces of the materials that the file describes.
    """

    mesh: Mesh
    repairs: tuple[str, ...] = ()
    material_of_part: Mapping[str, str] = field(default_factory=dict)
    materials: tuple[Surface, ...] = ()


AT_A_TIME: Final = 1 << 14
"""Polygons to check at once, so that the arrays fit in the processor cache."""

FLAT: Final = 1e-12
"""Assumed: a triangle has no area if twice its area is below this fraction of the squared polygon size."""


@underflowing
def repaired(
    polygons: RawPolygons,
    place: str,
    placement: Placement = PLAIN,
    *,
    skipped: tuple[str, ...] = (),
    unused_nodes: bool = False,
) -> MeshReport:
    """The mesh of the polygons, with messages about what was repaired.

    `place` is the file's name in messages; `skipped` are messages to put before those of the repairs. With
    `unused_nodes`, nodes that no polygon uses are kept. Raises InputError if no polygon is left.
    """
    if (most := int(polygons.corner_counts.max(initial=0))) > MOST_CORNERS:
        raise InputError(
            f"{place}, polygon {polygons.corner_counts.argmax() + 1:,}: a polygon must have at most"
            f" {MOST_CORNERS:,} corners, not {most:,}; split it"
        )
    coordinates = placed(polygons.coordinates, placement)
    repairs = list(skipped)
    corners, normals = polygons.corners, None
    if placement.normals == FILE and polygons.normals is not None:
        normals = polygons.corner_normals
    counts = polygons.corner_counts
    # The first corner of a polygon follows its last one.
    following = np.arange(1, len(corners) + 1)
    ends = np.cumsum(counts)
    following[ends[counts > 0] - 1] = (ends - counts)[counts > 0]
    differs = corners != corners[following]
    if not differs.all():
        owners = np.repeat(np.arange(len(counts)), counts)
        counts = np.bincount(owners[differs], minlength=len(counts))
        corners, normals = corners[differs], None if normals is None else normals[differs]
    vectors, scalars = polygons.normals, polygons.scalars
    try:
        if normals is None:
            pieces = split_polygons(coordinates, corners, counts)
        else:
            # Split the corners themselves, so that each piece knows the normals at its corners.
            pieces = split_polygons(coordinates[corners], np.arange(len(corners)), counts)
    except InputError as error:
        raise InputError(f"{place}: {error}") from None
    node_numbers, owners, added, crossed = pieces
    if normals is not None:
        if vectors is not None and len(crossed):
            vectors = np.concatenate([vectors, added.between(vectors[normals])])
            numbers = np.arange(-len(added.starts), 0) + len(vectors)
            numbers[(normals[added.starts] < 0) | (normals[added.ends] < 0)] = -1
            normals = np.append(normals, numbers)
        added = added._replace(starts=corners[added.starts], ends=corners[added.ends])
        corners = np.append(corners, np.arange(len(added.starts)) + len(coordinates))
        node_numbers, normals = corners[node_numbers], normals[node_numbers]
    if len(crossed):
        coordinates = np.concatenate([coordinates, added.between(coordinates)])
        scalars = tuple(added.with_scalar(each) for each in scalars)

    # Drop pieces without area.
    has_area = np.empty(len(node_numbers), np.bool_)
    for chunk in chunks(len(node_numbers), AT_A_TIME):
        has_area[chunk] = _have_area(coordinates, node_numbers[chunk])
    if not has_area.all():
        node_numbers, owners = node_numbers[has_area], owners[has_area]
        normals = None if normals is None else normals[has_area]
    is_kept = np.zeros(len(counts), np.bool_)
    is_kept[owners] = True
    is_crossed = np.zeros(len(counts), np.bool_)
    is_crossed[crossed] = True
    kinds = {
        "polygon with repeated corners {} repaired": (counts < polygons.corner_counts) & is_kept,
        "polygon with fewer than three different corners {} dropped": counts < 3,
        "polygon without area {} dropped": (counts >= 3) & ~is_kept,
        "polygon with more than four corners {} split": (counts > 4) & is_kept & ~is_crossed,
        "polygon whose sides cross {} split": is_crossed & is_kept,
    }
    repairs += [_counted(sentence, count) for sentence, rows in kinds.items() if (count := int(rows.sum()))]
    if not len(node_numbers):
        causes = "".join(f"; {repair}" for repair in repairs)
        raise InputError(f"{place}: a mesh must have a polygon with area, not none{causes}; add polygons")
    rows_of: dict[str, Indices | slice] = {NODE: slice(None), POLYGON: owners}
    is_used = used_rows(node_numbers.T, len(coordinates))
    dropped = 0 if unused_nodes else int(np.count_nonzero(~is_used))
    if dropped:
        rows_of[NODE] = np.flatnonzero(is_used)
        repairs.append(_counted("node that no polygon uses {} dropped", dropped))
        coordinates = coordinates[rows_of[NODE]]
        node_numbers = (np.cumsum(is_used) - 1)[node_numbers]
    own_normals = None
    if normals is not None and vectors is not None:
        vectors = turned_up(vectors, placement.up)
        own_normals, sentences = file_normals(coordinates, node_numbers, vectors, normals)
        repairs.extend(sentences)
    # A piece of a polygon has the scalars of the whole.
    scalars = tuple(
        MeshScalar(each.name, read_only(each.values[rows_of[each.of]]), each.of) for each in scalars
    )
    mesh = Mesh(
        coordinates,
        node_numbers,
        polygons.part_numbers[owners],
        polygons.part_names,
        CREASE_ANGLE if placement.crease_angle is None else placement.crease_angle,
        scalars,
        own_normals,
    )
    return MeshReport(mesh, tuple(f"{place}: {repair}" for repair in repairs))


def _counted(sentence: str, count: int) -> str:
    """The sentence with the count before the noun that it begins with, and its verb."""
    noun, _, rest = sentence.partition(" ")
    return f"{count:,} {noun}{'s' * (count > 1)} {rest.format('was' if count == 1 else 'were')}"


def _have_area(coordinates: Floats, node_numbers: Indices) -> Booleans:
    """Whether each polygon of (n, 4) has area: neither diagonal splits it into two flat triangles.

    A bow-tie whose halves cancel has area; a polygon that runs forth and back along one path has none. The
    size of a polygon is its longest edge or diagonal from the first corner; one below 1e-70 has no area.
    """
    first, *others = (coordinates.take(corners, axis=0).T for corners in node_numbers.T)
    one, two, three = (other - first for other in others)
    with np.errstate(over="ignore", invalid="ignore"):
        squares = np.maximum(np.maximum(dot(one, one), dot(two, two)), dot(three, three))
        least = (FLAT * squares) ** 2

        def is_large(edge: Floats, other: Floats) -> Booleans:
            normals = cross(edge, other)
            is_over: Booleans = dot(normals, normals) > least
            return is_over

        have_area = is_large(one, two)
        if (node_numbers[:, 2] != node_numbers[:, 3]).any():
            have_area |= is_large(two, three)
            have_area &= is_large(one, three) | is_large(two - one, three - one)
    return have_area


LONGEST_NAME: Final = 200
"""Limit: letters of a name of a part, a material or a scalar; further letters are left out."""


def name_of(data: bytes) -> str:
    """The name in bytes, as `printable_name`; bytes that are not UTF-8 are Latin-1."""
    try:
        return printable_name(data.decode("utf-8"))
    except UnicodeDecodeError:
        return printable_name(data.decode("latin-1"))


def printable_name(text: str) -> str:
    """The name without spaces around it, as printable text of at most LONGEST_NAME letters."""
    return printable(text.strip()[:LONGEST_NAME])


def different(names: Sequence[str], addition: str = "") -> tuple[str, ...]:
    """The names, made different: a repeated name gets an addition or a number.

    >>> different(["hood", "hood", "hood"])
    ('hood', 'hood 2', 'hood 3')
    """
    unique_names: dict[str, None] = {}
    counts: dict[str, int] = {}
    for name in names:
        unique = name if name not in unique_names else f"{name}{addition}"
        number = counts.get(name, 1)
        while unique in unique_names:
            number += 1
            unique = f"{name}{addition} {number}"
        counts[name] = number
        unique_names[unique] = None
    return tuple(unique_names)
