"""Cells of VTK's data sets by their types, as polygons and volume cells: for both file formats of VTK."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Indices, Numbers, runs
from autocolor.errors import InputError
from autocolor.files.meshes.cells import CORNERS, Flats, Volumes

# The types of cells by their numbers. Of cells of second and higher order only the corners are read.

STRIP_CELL: Final = 6
POLYGON_CELL: Final = 7

PIXEL: Final = 8
VOXEL: Final = 11
SHAPES: Final = {
    **dict.fromkeys((5, 22, 34, 69), "triangle"),
    **dict.fromkeys((PIXEL, 9, 23, 28, 30, 70), "quad"),
    **dict.fromkeys((10, 24, 71), "tetra"),
    **dict.fromkeys((VOXEL, 12, 25, 29, 33, 72), "hexahedron"),
    **dict.fromkeys((13, 26, 31, 32, 73), "wedge"),
    **dict.fromkeys((14, 27, 74), "pyramid"),
}
"""The shape that each type of cell becomes."""

FIRST_ORDER: Final = frozenset(range(15))

SKIPPED: Final = {
    0: "empty cells",
    **dict.fromkeys((1, 2), "vertices"),
    **dict.fromkeys((3, 4, 21, 35, 68), "lines"),
}

ORDERS: Final = {PIXEL: (0, 1, 3, 2), VOXEL: (0, 1, 3, 2, 4, 5, 7, 6)}
"""Pixels and voxels number their corners by axis, quads and hexahedra around."""


class CellLists(NamedTuple):
    """The node numbers of all cells, and the offset of each cell in them; the last offset is their end."""

    numbers: Numbers
    offsets: Numbers

    @property
    def sizes(self) -> Numbers:
        """The number of nodes of each cell."""
        return np.diff(self.offsets)


@dataclass
class VtkCells:
    """The polygons and volume cells of a file, and counts of its cells."""

    flats: list[Flats] = field(default_factory=list)
    volumes: list[Volumes] = field(default_factory=list)
    skipped: Counter[str] = field(default_factory=Counter)
    higher_order: int = 0
    count: int = 0

    @property
    def sentences(self) -> tuple[str, ...]:
        """Messages about skipped cells, and about cells that are read by their corners alone."""
        sentences = [f"skipped {what}: {count:,}" for what, count in self.skipped.items() if count]
        if self.higher_order:
            sentences.append(f"took the corners alone of cells of higher order: {self.higher_order:,}")
        return tuple(sentences)


def require_nodes(place: str, lists: CellLists, nodes: int) -> None:
    """Raise InputError unless all numbers are rows of a table of `nodes` nodes."""
    wrong = np.flatnonzero((lists.numbers < 0) | (lists.numbers >= nodes))
    if len(wrong):
        cell = int(np.searchsorted(lists.offsets, wrong[0], side="right")) - 1
        raise InputError(
            f"{place}: a node number must be from 0 to {nodes - 1:,}, not {lists.numbers[wrong[0]]}"
            f" (cell {cell:,}, counted from 0); correct it"
        )


def add_cells(cells: VtkCells, place: str, lists: CellLists, types: Numbers | int) -> None:
    """Add cells; `types` are the type of all cells or the types, cell by cell. Raises InputError."""
    sizes = lists.sizes
    for kind in np.unique(types).tolist():
        is_kind = np.broadcast_to(np.equal(types, kind), sizes.shape)
        chosen = np.flatnonzero(is_kind)
        rows = cells.count + chosen
        if kind == POLYGON_CELL:
            corners = lists.numbers if is_kind.all() else lists.numbers[np.repeat(is_kind, sizes)]
            cells.flats.append(Flats(corners.astype(np.intp), sizes[chosen], rows))
            cells.skipped["empty cells"] += int((sizes[chosen] == 0).sum())
        elif kind == STRIP_CELL:
            cells.flats.append(_triangles(lists, chosen, rows))
        elif shape := SHAPES.get(kind):
            _add_shaped(cells, place, lists, chosen, rows, kind, shape)
        else:
            cells.skipped[SKIPPED.get(kind, f"cells of type {kind}")] += len(rows)
    cells.count += len(sizes)


def _triangles(lists: CellLists, chosen: Indices, rows: Indices) -> Flats:
    """The triangles of the chosen strips; `rows` are the strips' rows among the cells of the file.

    Each node of a strip from the third on makes a triangle with the two nodes before it.
    """
    enough = lists.sizes[chosen] >= 3
    chosen, rows = chosen[enough], rows[enough]
    count = lists.sizes[chosen] - 2
    starts = runs(lists.offsets[chosen], count)
    # Every other triangle is turned over.
    odd = (starts - np.repeat(lists.offsets[chosen], count)) % 2
    table = np.stack([starts + odd, starts + 1 - odd, starts + 2], axis=1)
    return Flats.of(lists.numbers[table].astype(np.intp), np.repeat(rows, count))


def _add_shaped(
    cells: VtkCells,
    place: str,
    lists: CellLists,
    chosen: Indices,
    rows: Indices,
    kind: int,
    shape: str,
) -> None:
    """Add the chosen cells, of a shape with a fixed number of corners. Raises InputError."""
    corners = {"triangle": 3, "quad": 4, **CORNERS}[shape]
    is_first_order = kind in FIRST_ORDER
    sizes = lists.sizes[chosen]
    wrong = (sizes != corners) if is_first_order else (sizes < corners)
    if wrong.any():
        cell = int(chosen[wrong.argmax()])
        rule = f"{'' if is_first_order else 'at least '}{corners}"
        raise InputError(
            f"{place}, CELLS: a cell of type {kind} must have {rule} nodes, not {lists.sizes[cell]}"
            f" (cell {cell:,}, counted from 0); correct it"
        )
    order = np.array(ORDERS.get(kind, range(corners)))
    table = lists.numbers[lists.offsets[chosen][:, None] + order].astype(np.intp)
    if not is_first_order:
        cells.higher_order += len(rows)
    if shape in CORNERS:
        cells.volumes.append(Volumes(shape, table, rows))
    else:
        cells.flats.append(Flats.of(table, rows))
