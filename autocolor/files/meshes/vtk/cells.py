"""Cells of legacy VTK files, by their types: polygons, volume cells, and what is skipped.

Of cells of second and higher order the corners are taken, not the nodes between them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Indices, Numbers, runs
from autocolor.errors import InputError
from autocolor.files.meshes.vtk.cursor import VtkCursor
from autocolor.files.repair.cells import CORNERS, Flats, Volumes

STRIP: Final = 6
POLYGON: Final = 7

TRIANGLES: Final = (5, 22, 34, 69)
QUADS: Final = (9, 23, 28, 30, 70)
PIXEL: Final = 8
SOLIDS: Final = {
    "tetra": (10, 24, 71),
    "hexahedron": (12, 25, 29, 33, 72),
    "wedge": (13, 26, 31, 32, 73),
    "pyramid": (14, 27, 74),
}
VOXEL: Final = 11

FIRST_ORDER: Final = frozenset(range(15))

SKIPPED: Final = {
    0: "empty cells",
    1: "vertices",
    2: "vertices",
    3: "lines",
    4: "lines",
    21: "lines",
    35: "lines",
    68: "lines",
}

ORDERS: Final = {PIXEL: (0, 1, 3, 2), VOXEL: (0, 1, 3, 2, 4, 5, 7, 6)}
"""Pixels and voxels number their corners by axis, quads and hexahedra around."""


class CellLists(NamedTuple):
    """The node numbers of all cells, and where those of each begin; the last element is their end."""

    numbers: Numbers
    offsets: Numbers

    @property
    def sizes(self) -> Numbers:
        """The number of nodes of each cell."""
        return np.diff(self.offsets)


@dataclass
class Cells:
    """Polygons and volume cells of a file, sentences about cells, and how many cells there are."""

    flats: list[Flats] = field(default_factory=list)
    volumes: list[Volumes] = field(default_factory=list)
    skipped: dict[str, int] = field(default_factory=dict)
    higher_order: int = 0
    count: int = 0

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was skipped, and of how many cells the corners were taken."""
        found = [f"skipped {what}: {count:,}" for what, count in self.skipped.items()]
        if self.higher_order:
            found.append(f"took the corners alone of cells of higher order: {self.higher_order:,}")
        return tuple(found)

    def skip(self, what: str, count: int) -> None:
        """Count cells that are skipped."""
        if count:
            self.skipped[what] = self.skipped.get(what, 0) + count


def read_cell_lists(cursor: VtkCursor, words: list[bytes], nodes: int) -> CellLists:
    """The node lists after a line such as `POLYGONS cells size`. Raises InputError.

    Up to version 5.0 each list is its length and its nodes; from 5.1 on there are OFFSETS and CONNECTIVITY.
    """
    what = words[0].decode("latin-1")
    if len(words) < 3:
        raise InputError(f"{cursor.where}: {what} must have two counts, not {len(words) - 1}; correct it")
    cells, size = (cursor.count(word, f"a count of {what}") for word in words[1:3])
    if cursor.peek() == b"OFFSETS":
        lists = _offset_lists(cursor, cells, size, what)
    else:
        lists = _counted_lists(cursor, cells, size, what)
    wrong = np.flatnonzero((lists.numbers < 0) | (lists.numbers >= nodes))
    if len(wrong):
        cell = int(np.searchsorted(lists.offsets, wrong[0], side="right")) - 1
        raise InputError(
            f"{cursor.name}, {what}: a node number must be from 0 to {nodes - 1:,}, not"
            f" {lists.numbers[wrong[0]]} (cell {cell:,}, counted from 0); correct it"
        )
    return lists


def _offset_lists(cursor: VtkCursor, count: int, size: int, what: str) -> CellLists:
    if not count:
        # Some versions write no offset at all where there is no cell.
        return CellLists(np.empty(0, np.int64), np.zeros(1, np.int64))
    offsets = cursor.wholes(count, _kind_of(cursor, what), f"OFFSETS of {what}")
    if cursor.peek() != b"CONNECTIVITY":
        raise InputError(f"{cursor.where}: after OFFSETS there must be CONNECTIVITY; correct the file")
    numbers = cursor.wholes(size, _kind_of(cursor, what), f"CONNECTIVITY of {what}")
    if not len(offsets) or offsets[0] != 0 or offsets[-1] != size or (np.diff(offsets) < 0).any():
        raise InputError(
            f"{cursor.name}, {what}: OFFSETS must rise from 0 to the size of CONNECTIVITY, {size:,}; correct"
            " them"
        )
    return CellLists(numbers, offsets)


def _kind_of(cursor: VtkCursor, what: str) -> bytes:
    """The type on a line such as `OFFSETS vtktypeint64`."""
    words = cursor.words()
    if len(words) < 2:
        raise InputError(f"{cursor.where}: {what} must have types of its arrays; correct it")
    return words[1]


def _counted_lists(cursor: VtkCursor, cells: int, size: int, what: str) -> CellLists:
    if cells > size:
        raise InputError(
            f"{cursor.where}: {what} must have at least as many numbers as cells, {cells:,}, not {size:,};"
            " correct it"
        )
    numbers = cursor.wholes(size, b"int", what)
    width = int(numbers[0]) + 1 if size else 0
    if cells and width > 0 and cells * width == size and (numbers[::width] == width - 1).all():
        table = np.ascontiguousarray(numbers.reshape(cells, width)[:, 1:])
        return CellLists(table.ravel(), np.arange(cells + 1) * (width - 1))
    is_count = np.zeros(size, np.bool_)
    sizes = np.empty(cells, np.int64)
    # A view gives Python numbers one by one, where a list would take a multiple of the memory.
    view, at = memoryview(numbers.data), 0
    for cell in range(cells):
        length = view[at] if at < size else 0
        if at >= size or length < 0 or at + 1 + length > size:
            raise InputError(
                f"{cursor.name}, {what}: a cell must have as many nodes as its count says, not"
                f" {max(size - at - 1, 0):,} after {length} (cell {cell:,}, counted from 0); correct it"
            )
        is_count[at] = True
        sizes[cell] = length
        at += length + 1
    if at != size:
        raise InputError(
            f"{cursor.name}, {what}: its {cells:,} cells must fill {size:,} numbers, not {at:,}; correct its"
            " counts"
        )
    return CellLists(numbers[~is_count], np.concatenate([[0], np.cumsum(sizes)]))


def add_polygons(cells: Cells, lists: CellLists) -> None:
    """Add polygons of any number of corners."""
    sizes = lists.sizes
    rows = cells.count + np.arange(len(sizes))
    cells.flats.append(Flats(lists.numbers.astype(np.intp), sizes, rows))
    cells.skip("empty cells", int((sizes == 0).sum()))
    cells.count += len(sizes)


def add_strips(cells: Cells, lists: CellLists) -> None:
    """Add triangle strips: each node from the third on makes a triangle with the two before it."""
    rows = cells.count + np.arange(len(lists.sizes))
    cells.flats.append(_triangles(lists, np.arange(len(rows)), rows))
    cells.count += len(rows)


def _triangles(lists: CellLists, chosen: Indices, rows: Indices) -> Flats:
    """The triangles of the strips that are chosen; `rows` are their rows among the cells."""
    enough = lists.sizes[chosen] >= 3
    chosen, rows = chosen[enough], rows[enough]
    count = lists.sizes[chosen] - 2
    starts = runs(lists.offsets[chosen], count)
    # Every other triangle is turned over.
    odd = (starts - np.repeat(lists.offsets[chosen], count)) % 2
    table = np.stack([starts + odd, starts + 1 - odd, starts + 2], axis=1)
    return Flats.of(lists.numbers[table].astype(np.intp), np.repeat(rows, count))


def add_typed(cells: Cells, cursor: VtkCursor, lists: CellLists, types: Numbers) -> None:
    """Add the cells of an unstructured grid, each of its type. Raises InputError."""
    sizes = lists.sizes
    if len(types) != len(sizes):
        raise InputError(
            f"{cursor.name}: there must be as many CELL_TYPES as CELLS, {len(sizes):,}, not {len(types):,};"
            " correct the file"
        )
    for kind in np.unique(types).tolist():
        rows = np.flatnonzero(types == kind)
        if kind == POLYGON:
            corners = lists.numbers[np.repeat(types == kind, sizes)]
            cells.flats.append(Flats(corners.astype(np.intp), sizes[rows], rows))
            cells.skip("empty cells", int((sizes[rows] == 0).sum()))
        elif kind == STRIP:
            cells.flats.append(_triangles(lists, rows, rows))
        elif shape := _shape_of(kind):
            _add_shaped(cells, cursor, lists, rows, kind, shape)
        else:
            cells.skip(SKIPPED.get(kind, f"cells of type {kind}"), len(rows))
    cells.count += len(sizes)


def _shape_of(kind: int) -> str:
    """The shape that a type is read as; empty if it is skipped."""
    if kind in TRIANGLES:
        return "triangle"
    if kind in QUADS or kind == PIXEL:
        return "quad"
    if kind == VOXEL:
        return "hexahedron"
    return next((shape for shape, kinds in SOLIDS.items() if kind in kinds), "")


def _add_shaped(
    cells: Cells, cursor: VtkCursor, lists: CellLists, rows: Indices, kind: int, shape: str
) -> None:
    corners = {"triangle": 3, "quad": 4, **CORNERS}[shape]
    sizes = lists.sizes[rows]
    wrong = (sizes != corners) if kind in FIRST_ORDER else (sizes < corners)
    if wrong.any():
        cell = int(rows[wrong.argmax()])
        rule = f"{'' if kind in FIRST_ORDER else 'at least '}{corners}"
        raise InputError(
            f"{cursor.name}, CELLS: a cell of type {kind} must have {rule} nodes, not {lists.sizes[cell]}"
            f" (cell {cell:,}, counted from 0); correct it"
        )
    order = np.array(ORDERS.get(kind, range(corners)))
    table = lists.numbers[lists.offsets[rows][:, None] + order].astype(np.intp)
    if kind not in FIRST_ORDER:
        cells.higher_order += len(rows)
    if shape in CORNERS:
        cells.volumes.append(Volumes(shape, table, rows))
    else:
        cells.flats.append(Flats.of(table, rows))
