"""The surface of cells: polygons as they are, and the outer faces of volume cells.

A face of a volume cell is outer if no other cell has it. Faces are turned outward by the volume of their
cell, since programs number the corners of wedges either way round. A polygon that repeats a face of a volume
cell is left out: programs often write boundaries besides the volume.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Numbers, chunks, runs

AT_A_TIME: Final = 1 << 15

FACES: Final = {
    "tetra": ((0, 1, 3, 3), (1, 2, 3, 3), (2, 0, 3, 3), (0, 2, 1, 1)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4, 4), (1, 2, 4, 4), (2, 3, 4, 4), (3, 0, 4, 4)),
    "wedge": ((0, 1, 2, 2), (3, 5, 4, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "hexahedron": (
        (0, 4, 7, 3),
        (1, 2, 6, 5),
        (0, 1, 5, 4),
        (3, 7, 6, 2),
        (0, 3, 2, 1),
        (4, 5, 6, 7),
    ),
}
"""The faces of each shape, all turned the same way; a triangle repeats its last corner."""

CORNERS: Final = {"tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}


@dataclass(frozen=True, eq=False)
class Volumes:
    """Volume cells of one shape of FACES: their corners, (cells, corners), and their rows in the file."""

    shape: str
    corners: Indices
    cells: Indices


@dataclass(frozen=True, eq=False)
class Flats:
    """Polygons: all corners, one after the other, the number in each, and their rows among the cells."""

    corners: Indices
    corner_counts: Indices
    cells: Indices

    @staticmethod
    def joined(several: Sequence[Flats]) -> Flats:
        """The polygons of several, in the order of their rows; polygons without corners are left out."""
        counts = np.concatenate([np.empty(0, np.intp), *(each.corner_counts for each in several)])
        corners = np.concatenate([np.empty(0, np.intp), *(each.corners for each in several)])
        cells = np.concatenate([np.empty(0, np.intp), *(each.cells for each in several)])
        starts = np.cumsum(counts) - counts
        order = np.argsort(cells, kind="stable")
        order = order[counts[order] > 0]
        return Flats(corners[runs(starts[order], counts[order])], counts[order], cells[order])

    @staticmethod
    def of(table: Indices, cells: Indices) -> Flats:
        """The polygons of a table, (polygons, corners). A quad that repeats its last corner is a triangle."""
        counts = np.full(len(table), table.shape[1], np.intp)
        if table.shape[1] != 4:
            return Flats(table.ravel(), counts, cells)
        is_corner = np.ones(table.shape, np.bool_)
        is_corner[:, 3] = table[:, 3] != table[:, 2]
        return Flats(table[is_corner], is_corner.sum(axis=1), cells)


class CellSurface(NamedTuple):
    """The polygons of a surface, the row of each node in the file, and sentences about what was left out."""

    flats: Flats
    nodes: Indices
    sentences: tuple[str, ...]


def cell_surface(coordinates: Floats, flats: Flats, volumes: Sequence[Volumes]) -> CellSurface:
    """The surface of polygons and volume cells.

    With volume cells, nodes that the surface does not use are left out, and its corners are rows of the
    others.
    """
    volumes = [each for each in volumes if len(each.cells)]
    count = sum(len(each.cells) for each in volumes)
    if not count:
        return CellSurface(flats, np.arange(len(coordinates)), ())
    faces, owners = _faces(coordinates, volumes)
    keys = _keys(faces, len(coordinates))
    order = np.lexsort(keys)
    differs = (np.diff(keys[0][order]) != 0) | (np.diff(keys[1][order]) != 0)
    is_outer = np.concatenate([[True], differs]) & np.concatenate([differs, [True]])
    outer = np.sort(order[is_outer])
    # Leave out polygons that are faces.
    sentences = []
    is_face = _are_among(flats, keys, len(coordinates))
    if number := int(is_face.sum()):
        sentences.append(f"left out {number:,} polygon{'s' * (number > 1)} that are faces of volume cells")
        flats = _chosen(flats, ~is_face)
    flats = Flats.joined([flats, Flats.of(faces[outer], owners[outer])])
    # Leave out the nodes within.
    is_used = np.zeros(len(coordinates), np.bool_)
    is_used[flats.corners] = True
    sentences = [*surface_sentences(count, int((~is_used).sum())), *sentences]
    row_of = np.cumsum(is_used) - 1
    surface = Flats(row_of[flats.corners], flats.corner_counts, flats.cells)
    return CellSurface(surface, np.flatnonzero(is_used), tuple(sentences))


def surface_sentences(cells: int, left: int) -> Iterator[str]:
    """Sentences about the outer surface of some volume cells, which leaves some nodes out."""
    yield f"took the outer surface of {cells:,} volume {'cell' if cells == 1 else 'cells'}"
    if left:
        yield f"left out {left:,} node{'s' * (left > 1)} that the surface does not use"


def _faces(coordinates: Floats, volumes: Sequence[Volumes]) -> tuple[Indices, Indices]:
    """All faces of the cells, (faces, 4), turned outward, and the row of each face's cell."""
    faces, owners = [], []
    for each in volumes:
        template = np.array(FACES[each.shape])
        table = np.empty((len(each.corners), len(template), 4), np.intp)
        for chunk in chunks(len(each.corners), AT_A_TIME):
            faces_of_cells = each.corners[chunk][:, template]
            inward = _volumes(coordinates[each.corners[chunk]], template) < 0
            # A triangle repeats its last corner: swapping the first two turns it.
            triangles = template[:, 2] == template[:, 3]
            turned = np.where(
                triangles[:, None], faces_of_cells[..., [1, 0, 2, 3]], faces_of_cells[..., ::-1]
            )
            table[chunk] = np.where(inward[:, None, None], turned, faces_of_cells)
        faces.append(table.reshape(-1, 4))
        owners.append(np.repeat(each.cells, len(template)))
    return np.concatenate(faces), np.concatenate(owners)


def _volumes(corners: Floats, template: Indices) -> Floats:
    """Six times the volumes of cells, (cells, corners, 3), by their faces."""
    size = np.ptp(corners, axis=1).max(axis=1)
    size[size == 0] = 1.0
    corners = (corners - corners.mean(axis=1, keepdims=True)) / size[:, None, None]
    a, b, c, d = (corners[:, template[:, at]] for at in range(4))
    sums: Floats = (np.cross(c - a, d - b) * (a + b + c + d)).sum(axis=(1, 2))
    return sums


def _keys(faces: Indices, nodes: int) -> tuple[Numbers, Numbers]:
    """Two numbers for each face, equal for faces with the same corners in any order."""
    corners = np.sort(faces, axis=1).astype(np.int64)
    # Which corner a triangle repeats must not matter.
    is_triangle = faces[:, 2] == faces[:, 3]
    corners[is_triangle, :3] = np.sort(faces[is_triangle, :3], axis=1)
    corners[is_triangle, 3] = nodes
    return corners[:, 0] * (nodes + 1) + corners[:, 1], corners[:, 2] * (nodes + 1) + corners[:, 3]


def _are_among(flats: Flats, keys: tuple[Numbers, Numbers], nodes: int) -> Booleans:
    """Which polygons have the corners of a face."""
    are_among = np.zeros(len(flats.cells), np.bool_)
    starts = np.cumsum(flats.corner_counts) - flats.corner_counts
    small = np.flatnonzero((flats.corner_counts == 3) | (flats.corner_counts == 4))
    if not len(small):
        return are_among
    table = flats.corners[
        starts[small, None] + np.minimum(np.arange(4), flats.corner_counts[small, None] - 1)
    ]
    own = _keys(table, nodes)
    pairs = np.stack([np.concatenate(each) for each in zip(keys, own, strict=True)])
    order = np.lexsort((np.arange(pairs.shape[1]), pairs[0], pairs[1]))
    same = np.zeros(len(order), np.bool_)
    same[1:] = (np.diff(pairs[:, order], axis=1) == 0).all(axis=0)
    # The first of a run of equal keys is a face if any is, since faces come before polygons.
    firsts = np.maximum.accumulate(np.where(same, 0, np.arange(len(order))))
    is_known = order[firsts] < len(keys[0])
    mine = order >= len(keys[0])
    are_among[small[order[mine] - len(keys[0])]] = is_known[mine]
    return are_among


def _chosen(flats: Flats, chosen: Booleans) -> Flats:
    return Flats(
        flats.corners[np.repeat(chosen, flats.corner_counts)],
        flats.corner_counts[chosen],
        flats.cells[chosen],
    )
