"""The surface of cells: polygons as they are, and the outer faces of volume cells.

A face of a volume cell is outer if no other cell has it. Faces are turned outward, since programs number the
corners of wedges either way round. A polygon that repeats a face of a volume cell is left out: programs often
write boundaries besides the volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, cross, dot, runs
from autocolor.files.foreign.mesh import ForeignRefusal

FACES: Final = {
    "tetra": ((0, 2, 1, 1), (0, 1, 3, 3), (1, 2, 3, 3), (2, 0, 3, 3)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4, 4), (1, 2, 4, 4), (2, 3, 4, 4), (3, 0, 4, 4)),
    "wedge": ((0, 2, 1, 1), (3, 4, 5, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": (
        (0, 3, 2, 1),
        (4, 5, 6, 7),
        (0, 1, 5, 4),
        (1, 2, 6, 5),
        (2, 3, 7, 6),
        (3, 0, 4, 7),
    ),
}
"""The faces of each volume cell, outward if its base is counterclockwise as seen from its top. The base is
the first face; a triangle repeats its last corner."""

CORNERS: Final = {"triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
"""The number of corners of each shape."""

Block = tuple[str, Indices, Indices]
"""Cells of one shape of CORNERS: the shape, their corners, (cells, corners), and their rows in the file."""


@dataclass(frozen=True, eq=False)
class Flats:
    """Polygons: all corners, one after the other, the number in each, and their rows among the cells."""

    corners: Indices
    corner_counts: Indices
    cells: Indices

    @property
    def starts(self) -> Indices:
        """The place of the first corner of each polygon."""
        starts: Indices = np.cumsum(self.corner_counts) - self.corner_counts
        return starts

    def chosen(self, rows: Indices | Booleans) -> Flats:
        """Some of the polygons, in the order of the rows; polygons without corners are left out."""
        rows = np.arange(len(self.cells))[rows]
        rows = rows[self.corner_counts[rows] > 0]
        counts = self.corner_counts[rows]
        return Flats(self.corners[runs(self.starts[rows], counts)], counts, self.cells[rows])

    @staticmethod
    def joined(several: Sequence[Flats]) -> Flats:
        """The polygons of several, in the order of their rows; polygons without corners are left out."""
        corners, counts, cells = (
            np.concatenate([np.empty(0, np.intp), *(getattr(each, name) for each in several)])
            for name in ("corners", "corner_counts", "cells")
        )
        return Flats(corners, counts, cells).chosen(np.argsort(cells, kind="stable"))

    @staticmethod
    def of(table: Indices, cells: Indices) -> Flats:
        """The polygons of a table, (polygons, corners). A quad that repeats its last corner is a triangle."""
        is_corner = np.ones(table.shape, np.bool_)
        if table.shape[1] == 4:
            is_corner[:, 3] = table[:, 3] != table[:, 2]
        return Flats(table[is_corner], is_corner.sum(axis=1), cells)


class CellSurface(NamedTuple):
    """The polygons of a surface, the row of each node in the file, and sentences about what was left out."""

    flats: Flats
    nodes: Indices
    sentences: tuple[str, ...]


def cell_surface(
    coordinates: Floats, blocks: Sequence[Block], flats: Sequence[Flats] = (), polyhedra: Sequence[Flats] = ()
) -> CellSurface:
    """The surface of cells; `polyhedra` are the faces of other volume cells, turned outward.

    With volume cells, nodes that the surface does not use are left out, and its corners are rows of the
    others. Raises ForeignRefusal for a corner that is no node.
    """
    cells = [Flats.of(corners, rows) for _, corners, rows in blocks]
    for each in (*cells, *flats, *polyhedra):
        wrong = each.corners[(each.corners < 0) | (each.corners >= len(coordinates))]
        if len(wrong):
            most = len(coordinates) - 1
            raise ForeignRefusal(f"cells must have nodes of the file, from 0 to {most:,}, not {wrong[0]}")
    flats = [*flats, *(each for each, block in zip(cells, blocks, strict=True) if block[0] not in FACES)]
    faces = [*polyhedra, *(_outward(coordinates, *block) for block in blocks if block[0] in FACES)]
    count = sum(int(np.count_nonzero(np.bincount(each.cells))) for each in faces)
    if not count:
        return CellSurface(Flats.joined(flats), np.arange(len(coordinates)), ())
    # Polygons with the same corners, in any order, have the same sum of random numbers.
    numbers = np.random.default_rng(0).integers(1 << 62, size=len(coordinates))
    faces.append(Flats.joined(flats))
    sums = [np.add.reduceat(numbers[each.corners], each.starts) for each in faces]
    groups = np.unique(np.concatenate(sums), return_inverse=True)[1].reshape(-1)
    *groups_of_faces, groups_of_flats = np.split(groups, np.cumsum([len(each) for each in sums])[:-1])
    owners = np.bincount(np.concatenate(groups_of_faces), minlength=int(groups.max()) + 1)
    is_face = owners[groups_of_flats] > 0
    outer = [each.chosen(owners[group] == 1) for each, group in zip(faces, groups_of_faces, strict=False)]
    surface = Flats.joined([*outer, faces[-1].chosen(~is_face)])
    nodes, corners = np.unique(surface.corners, return_inverse=True)
    sentences = surface_sentences(count, len(coordinates) - len(nodes))
    if number := int(is_face.sum()):
        sentences.append(f"left out polygons that are faces of volume cells: {number:,}")
    surface = Flats(corners.reshape(-1), surface.corner_counts, surface.cells)
    return CellSurface(surface, nodes, tuple(sentences))


def _outward(coordinates: Floats, shape: str, table: Indices, cells: Indices) -> Flats:
    """All faces of volume cells of a shape, turned outward."""
    base, top = np.split(coordinates[table], [len({*FACES[shape][0]})], axis=1)
    up = (top.mean(axis=1) - base.mean(axis=1)).T
    area = cross((base[:, 2] - base[:, 0]).T, (base[:, -1] - base[:, 1]).T)
    faces = table[:, np.array(FACES[shape])]
    is_turned = dot(area, up) < 0
    faces[is_turned] = faces[is_turned][..., [1, 0, 3, 2]]
    return Flats.of(faces.reshape(-1, 4), np.repeat(cells, faces.shape[1]))


def surface_sentences(cells: int, left: int) -> list[str]:
    """Sentences about the outer surface of some volume cells, which leaves some nodes out."""
    sentences = [f"took the outer surface of {cells:,} volume {'cell' if cells == 1 else 'cells'}"]
    if left:
        sentences.append(f"left out {left:,} node{'s' * (left > 1)} that the surface does not use")
    return sentences
