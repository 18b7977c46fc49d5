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

from autocolor.arrays import Booleans, Floats, Indices, runs

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

    @property
    def starts(self) -> Indices:
        """The place of the first corner of each polygon."""
        starts: Indices = np.cumsum(self.corner_counts) - self.corner_counts
        return starts

    def chosen(self, rows: Indices | Booleans) -> Flats:
        """Some of the polygons, in the order of the rows."""
        counts = self.corner_counts[rows]
        return Flats(self.corners[runs(self.starts[rows], counts)], counts, self.cells[rows])

    @staticmethod
    def joined(several: Sequence[Flats]) -> Flats:
        """The polygons of several, in the order of their rows; polygons without corners are left out."""
        corners, counts, cells = (
            np.concatenate([np.empty(0, np.intp), *(getattr(each, name) for each in several)])
            for name in ("corners", "corner_counts", "cells")
        )
        order = np.argsort(cells, kind="stable")
        return Flats(corners, counts, cells).chosen(order[counts[order] > 0])

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


def cell_surface(coordinates: Floats, flats: Flats, volumes: Sequence[Volumes]) -> CellSurface:
    """The surface of polygons and volume cells.

    With volume cells, nodes that the surface does not use are left out, and its corners are rows of the
    others.
    """
    volumes = [each for each in volumes if len(each.cells)]
    count = sum(len(each.cells) for each in volumes)
    if not count:
        return CellSurface(flats, np.arange(len(coordinates)), ())
    tables = [each.corners[:, np.array(FACES[each.shape])].reshape(-1, 4) for each in volumes]
    owners = [np.repeat(each.cells, len(FACES[each.shape])) for each in volumes]
    faces = Flats.of(np.concatenate(tables), np.concatenate(owners))
    small = np.flatnonzero(flats.corner_counts <= 4)
    groups = _groups([faces, flats.chosen(small)], len(coordinates))
    cells_at = np.bincount(groups[: len(faces.cells)], minlength=int(groups.max()) + 1)[groups]
    faces = faces.chosen(cells_at[: len(faces.cells)] == 1)
    centers = np.zeros((int(faces.cells.max(initial=0)) + 1, 3))
    for each in volumes:
        is_near = each.cells < len(centers)
        centers[each.cells[is_near]] = coordinates[each.corners[is_near]].mean(axis=1)
    faces = turned_outward(coordinates, faces, centers)
    # Leave out polygons that are faces, and the nodes within.
    sentences = []
    is_face = np.zeros(len(flats.cells), np.bool_)
    is_face[small] = cells_at[len(groups) - len(small) :] > 0
    if number := int(is_face.sum()):
        sentences.append(f"left out {number:,} polygon{'s' * (number > 1)} that are faces of volume cells")
    flats = Flats.joined([flats.chosen(~is_face), faces])
    nodes, corners = np.unique(flats.corners, return_inverse=True)
    sentences = [*surface_sentences(count, len(coordinates) - len(nodes)), *sentences]
    surface = Flats(corners.reshape(-1), flats.corner_counts, flats.cells)
    return CellSurface(surface, nodes, tuple(sentences))


def surface_sentences(cells: int, left: int) -> Iterator[str]:
    """Sentences about the outer surface of some volume cells, which leaves some nodes out."""
    yield f"took the outer surface of {cells:,} volume {'cell' if cells == 1 else 'cells'}"
    if left:
        yield f"left out {left:,} node{'s' * (left > 1)} that the surface does not use"


def turned_outward(coordinates: Floats, faces: Flats, centers: Floats) -> Flats:
    """The outer faces of volume cells, turned away from the centers of their cells, (cells, 3).

    The faces of a cell are turned together, if the volume between them and the center is negative.
    """
    starts, counts = faces.starts, faces.corner_counts
    owners = np.repeat(np.arange(len(counts)), counts)
    at = np.arange(len(owners))
    following = np.where(at + 1 == (starts + counts)[owners], starts[owners], at + 1)
    with np.errstate(all="ignore"):
        arms = coordinates[faces.corners] - centers[faces.cells[owners]]
        areas = np.add.reduceat(np.cross(arms, arms[following]), starts)
        volumes = np.bincount(faces.cells, (areas * arms[starts]).sum(axis=1), len(centers))
    mirrored = 2 * starts[owners] + counts[owners] - 1 - at
    is_turned = (volumes < 0)[faces.cells[owners]]
    return Flats(faces.corners[np.where(is_turned, mirrored, at)], counts, faces.cells)


def _groups(several: Sequence[Flats], nodes: int) -> Indices:
    """Numbers of polygons of up to four corners, equal for the same corners in any order."""
    counts = np.concatenate([each.corner_counts for each in several])
    corners = np.full((len(counts), 4), nodes, np.int64)
    corners[np.arange(4) < counts[:, None]] = np.concatenate([each.corners for each in several])
    corners.sort(axis=1)
    one, other = corners[:, 0] * (nodes + 1) + corners[:, 1], corners[:, 2] * (nodes + 1) + corners[:, 3]
    order = np.lexsort((one, other))
    differs = (np.diff(one[order]) != 0) | (np.diff(other[order]) != 0)
    groups = np.empty(len(order), np.intp)
    groups[order] = np.concatenate([[0], np.cumsum(differs)])
    return groups
