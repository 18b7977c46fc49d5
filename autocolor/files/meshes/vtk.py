"""Reading a mesh from a legacy VTK file, versions 1.0 to 5.1, in text or binary.

- POLYDATA: polygons and triangle strips; vertices and lines are skipped and counted.
- UNSTRUCTURED_GRID: polygons of all kinds, and the outer surface of volume cells (see `cells`).
- STRUCTURED_GRID, RECTILINEAR_GRID and STRUCTURED_POINTS: the quads of one layer, or of the outer surface of
  a volume.

The data of nodes and cells are scalars of the mesh (see `file_scalars`). The file is one part, of its name.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Final, NamedTuple
from urllib.parse import unquote_to_bytes

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.cells import CellSurface, Flats, cell_surface, surface_sentences
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.meshes.vtk_cells import (
    POLYGON_CELL,
    STRIP_CELL,
    CellLists,
    VtkCells,
    add_cells,
    require_nodes,
)
from autocolor.files.reading import HEAD, read_whole, shown
from autocolor.scene.scalar import NODE, POLYGON

GROWTH: Final = 10
"""Measured: how many times its size a binary file takes; a text takes about as much."""

FIRST_LINE: Final = re.compile(rb"# vtk DataFile Version [1-5]\.[0-9]+", re.IGNORECASE)


def read_vtk(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a legacy VTK file with its scalars, and what was repaired. Raises InputError."""
    data = read_whole(path, GROWTH)
    if b"\n" not in data[:HEAD] and b"ASCII" in data[:HEAD]:
        data = data.replace(b"\r", b"\n")
    cursor = VtkCursor(data, path.name)
    dataset = _dataset(cursor)
    before = Attributes(cursor, {}, {})
    coordinates, (flats, nodes, sentences), counts = (read_grid if dataset in GRIDS else read_cells)(
        cursor, dataset, before
    )
    attributes = Attributes(cursor, counts, {NODE: nodes, POLYGON: flats.cells})
    attributes.skipped.update(before.skipped)
    attributes.read()
    table = RawPolygons(
        coordinates,
        flats.corners,
        flats.corner_counts,
        np.zeros(len(flats.cells), np.intp),
        (path.stem,),
        attributes.scalars.scalars,
    )
    return repaired(table, path.name, placement, skipped=(*sentences, *attributes.messages))


def _dataset(cursor: VtkCursor) -> bytes:
    """The type of the data set, after the three lines before it. Raises InputError."""
    first = cursor.raw_line()
    if not FIRST_LINE.match(first):
        raise InputError(
            f"{cursor.name}, line 1: a legacy VTK file must begin '# vtk DataFile Version 1.0' to 5.1, not"
            f" {shown(first)}; write it as legacy VTK"
        )
    cursor.raw_line()
    kind = cursor.raw_line().strip().upper()
    if kind not in (b"ASCII", b"BINARY"):
        raise InputError(f"{cursor.name}, line 3: it must be ASCII or BINARY, not {shown(kind)}; correct it")
    words = cursor.words()
    if len(words) < 2 or words[0].upper() != b"DATASET":
        raise InputError(
            f"{cursor.name}, line 4: it must be DATASET and its type, not {shown(b' '.join(words))};"
            f" correct it"
        )
    if kind == b"ASCII":
        cursor.as_text()
    return words[1].upper()


class VtkSurface(NamedTuple):
    """The surface of a data set, the coordinates of its nodes, and the counts of nodes and cells in the file.

    `counts` has the keys NODE and POLYGON.
    """

    coordinates: Floats
    surface: CellSurface
    counts: Mapping[str, int]


def read_cells(cursor: VtkCursor, dataset: bytes, before: Attributes) -> VtkSurface:
    """The surface of POLYDATA or an UNSTRUCTURED_GRID. `before` skips a FIELD. Raises InputError."""
    if dataset not in (b"POLYDATA", b"UNSTRUCTURED_GRID"):
        datasets = ", ".join(["POLYDATA", "UNSTRUCTURED_GRID", *(each.decode() for each in GRIDS)])
        raise cursor.error(f"the DATASET must be one of {datasets}, not {shown(dataset)}; take its surface")
    coordinates: Floats | None = None
    cells, lists = VtkCells(), None
    while (keyword := cursor.peek()) and keyword not in TABLES:
        words = cursor.words()
        if keyword == b"METADATA":
            cursor.skip_metadata()
        elif keyword == b"FIELD":
            before.field(words)
        elif keyword == b"POINTS":
            coordinates = read_points(cursor, words)
        elif coordinates is None:
            raise cursor.error(f"there must be POINTS before {shown(words[0])}; correct the file")
        elif keyword in IN_POLYDATA:
            cell_lists = read_cell_lists(cursor, words, len(coordinates))
            add_cells(cells, cursor.name, cell_lists, IN_POLYDATA[keyword])
        elif keyword == b"CELLS":
            lists = read_cell_lists(cursor, words, len(coordinates))
        elif keyword == b"CELL_TYPES" and lists is not None:
            count = cursor.count(words[1] if len(words) > 1 else b"", "the count of CELL_TYPES")
            types = cursor.wholes(count, b"int", "CELL_TYPES")
            if count != len(lists.sizes):
                raise InputError(
                    f"{cursor.name}: there must be as many CELL_TYPES as CELLS, {len(lists.sizes):,}, not"
                    f" {count:,}; correct the file"
                )
            add_cells(cells, cursor.name, lists, types)
            lists = None
        else:
            raise cursor.error(f"there must be no {shown(words[0])} in {dataset.decode()}; correct the file")
    if coordinates is None:
        raise InputError(f"{cursor.name}: a data set must have POINTS, not none; add them")
    if lists is not None:
        raise InputError(f"{cursor.name}: there must be CELL_TYPES after CELLS; add them")
    surface = cell_surface(coordinates, Flats.joined(cells.flats), cells.volumes)
    return VtkSurface(
        coordinates[surface.nodes],
        surface._replace(sentences=(*cells.sentences, *surface.sentences)),
        {NODE: len(coordinates), POLYGON: cells.count},
    )


def read_points(cursor: VtkCursor, words: list[bytes]) -> Floats:
    """The coordinates after a line such as `POINTS 8 float`, (nodes, 3). Raises InputError."""
    if len(words) < 3:
        raise cursor.error("POINTS must have a count and a type; correct it")
    count = cursor.count(words[1], "the count of POINTS")
    return cursor.coordinates(3 * count, words[2], "POINTS").reshape(-1, 3)


def begins_as_vtk(head: bytes) -> bool:
    """Whether a file begins as legacy VTK does."""
    return FIRST_LINE.match(head) is not None


LONGEST_LINE: Final = 4096
"""Limit: bytes of a line of keywords."""
LONGEST_METADATA: Final = 10_000
"""Limit: lines of a METADATA section."""

SPACES: Final = b" \t\r\n\f\v"

TYPES: Final = {
    b"char": "i1", b"unsigned_char": "u1", b"short": ">i2", b"unsigned_short": ">u2",
    b"int": ">i4", b"unsigned_int": ">u4", b"long": ">i8", b"unsigned_long": ">u8",
    b"float": ">f4", b"double": ">f8",
    b"vtktypeint8": "i1", b"vtktypeuint8": "u1", b"vtktypeint16": ">i2", b"vtktypeuint16": ">u2",
    b"vtktypeint32": ">i4", b"vtktypeuint32": ">u4", b"vtktypeint64": ">i8", b"vtktypeuint64": ">u8",
    b"vtktypefloat32": ">f4", b"vtktypefloat64": ">f8",
    # All versions that write this name write 32 bits.
    b"vtkidtype": ">i4",
}  # fmt: skip
"""The types in a file, in lower case, as those of numpy."""


class VtkCursor:
    """A place, `at`, in the bytes of a file: it reads lines of keywords, and arrays in text or binary.

    `name` is the file's name in messages.
    """

    def __init__(self, data: bytes, name: str) -> None:
        self.data = data
        self.name = name
        self.at = self.begun = 0
        self.text: NumberText | None = None

    def as_text(self) -> None:
        """Read arrays as text from here on."""
        self.text = NumberText(self.data, self.name)

    @property
    def where(self) -> str:
        """The latest line of keywords, for a message: its number in a text file, its byte in a binary one."""
        if self.text is None:
            return f"{self.name}, byte {self.begun:,}"
        line = self.data.count(b"\n", 0, self.begun) + 1
        return f"{self.name}, line {line}"

    def error(self, sentence: str) -> InputError:
        """The error about the latest line of keywords."""
        return InputError(f"{self.where}: {sentence}")

    def raw_line(self) -> bytes:
        """The next line, without its end; empty at the end of the file. Raises InputError."""
        end = self.data.find(b"\n", self.at, self.at + LONGEST_LINE)
        if end < 0:
            if len(self.data) - self.at >= LONGEST_LINE:
                raise self.error(f"a line of keywords must have less than {LONGEST_LINE:,} bytes; correct it")
            end = len(self.data)
        line = self.data[self.at : end]
        self.at = min(end + 1, len(self.data))
        return line.rstrip()

    def words(self) -> list[bytes]:
        """The words of the next line with words; none at the end of the file. Raises InputError."""
        while self.at < len(self.data) and self.data[self.at] in SPACES:
            self.at += 1
        self.begun = self.at
        return self.raw_line().split()

    def peek(self) -> bytes:
        """The first word of the next line, in capitals, without going on."""
        before = self.at, self.begun
        words = self.words()
        self.at, self.begun = before
        return words[0].upper() if words else b""

    def skip_metadata(self) -> None:
        """Go past a METADATA section, which an empty line ends."""
        for _ in range(LONGEST_METADATA):
            if self.at >= len(self.data) or not self.raw_line():
                return
        raise self.error("METADATA must end with an empty line; remove it")

    def count(self, word: bytes, what: str) -> int:
        """A count of at most 18 digits. Raises InputError."""
        if not word.isdigit() or len(word) > 18:
            raise self.error(f"{what} must be a whole number from 0 on, not {shown(word)}; correct it")
        return int(word)

    def array(self, count: int, kind: bytes, what: str) -> AnyArray:
        """The next numbers, floating-point or whole as their type, `kind`. Raises InputError."""
        dtype = np.dtype(TYPES.get(kind.lower(), "V"))
        if dtype.kind == "V":
            raise self.error(
                f"the type of the {what} must be int, float, double or another of numbers, not"
                f" {shown(kind)}; write it as double"
            )
        if self.text is None:
            size = count * dtype.itemsize
            if size > len(self.data) - self.at:
                left = len(self.data) - self.at
                raise self.error(
                    f"the {what} must have {size:,} bytes, not {left:,}; the file is cut short"
                    " or its counts are wrong"
                )
            array = np.frombuffer(self.data, dtype, count, self.at)
            self.at += size
            return array
        first = int(np.searchsorted(self.text.starts, self.at))
        left = len(self.text) - first
        if count > left:
            raise self.error(
                f"the {what} must have {count:,} numbers, not {left:,}; the file is cut short"
                " or its counts are wrong"
            )
        values: AnyArray
        if dtype.kind == "f":
            values = self.text.values(first, count)
        else:
            values = self.text.wholes(first, count, f"a number of the {what}")
        if count:
            last = int(self.text.starts[first + count - 1])
            following = first + count
            end = int(self.text.starts[following]) if following < len(self.text) else len(self.data)
            self.at = last + len(self.data[last:end].rstrip(SPACES))
        return values

    def wholes(self, count: int, kind: bytes, what: str) -> Numbers:
        """The next whole numbers, int64. Raises InputError, also for a floating-point type."""
        array = self.array(count, kind, what)
        if array.dtype.kind not in "iu":
            raise self.error(
                f"the type of the {what} must be one of whole numbers, not {shown(kind)}; write it as int"
            )
        return array.astype(np.int64)

    def coordinates(self, count: int, kind: bytes, what: str) -> Floats:
        """The next numbers as float64, all finite and at most 1e30 in size. Raises InputError."""
        start = self.where
        values = self.array(count, kind, what).astype(np.float64)
        wrong = np.flatnonzero(~(np.abs(values) <= LARGEST_COORDINATE))
        if len(wrong):
            raise InputError(
                f"{start}: a coordinate must be finite and at most 1e30 in size, not {values[wrong[0]]:g}"
                f" (number {wrong[0] + 1:,} of the {what}); correct it"
            )
        return values


# Lists of cells.

IN_POLYDATA: Final = {
    b"VERTICES": 1,
    b"LINES": 3,
    b"TRIANGLE_STRIPS": STRIP_CELL,
    b"POLYGONS": POLYGON_CELL,
}
"""The type of the cells in each section of POLYDATA."""


def read_cell_lists(cursor: VtkCursor, words: list[bytes], nodes: int) -> CellLists:
    """The node lists after a line such as `POLYGONS cells size`. Raises InputError.

    Up to version 5.0 each cell is its number of nodes and its nodes; from 5.1 on, OFFSETS and CONNECTIVITY.
    """
    what = words[0].decode("latin-1")
    if len(words) < 3:
        raise cursor.error(f"{what} must have two counts, not {len(words) - 1}; correct it")
    cells, size = (cursor.count(word, f"a count of {what}") for word in words[1:3])
    read = _offset_lists if cursor.peek() == b"OFFSETS" else _counted_lists
    lists = read(cursor, cells, size, what)
    require_nodes(f"{cursor.name}, {what}", lists, nodes)
    return lists


def _offset_lists(cursor: VtkCursor, count: int, size: int, what: str) -> CellLists:
    if not count:
        # If there are no cells, some versions write no offsets.
        return CellLists(np.empty(0, np.int64), np.zeros(1, np.int64))
    offsets = cursor.wholes(count, _kind_of(cursor, what), f"OFFSETS of {what}")
    if cursor.peek() != b"CONNECTIVITY":
        raise cursor.error("after OFFSETS there must be CONNECTIVITY; correct the file")
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
        raise cursor.error(f"{what} must have types of its arrays; correct it")
    return words[1]


def _counted_lists(cursor: VtkCursor, cells: int, size: int, what: str) -> CellLists:
    if cells > size:
        raise cursor.error(
            f"{what} must have at least as many numbers as cells, {cells:,}, not {size:,}; correct it"
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


# Grids of nodes in rows. A grid of one layer is a surface of quads that turn from the first axis to the
# second. A grid of several layers is a volume, whose quads turn outward.

GRIDS: Final = (b"STRUCTURED_GRID", b"RECTILINEAR_GRID", b"STRUCTURED_POINTS")

AXES: Final = (b"X_COORDINATES", b"Y_COORDINATES", b"Z_COORDINATES")
NODES_OF_ANY_GRID: Final = 250_000
"""Limit: nodes on the surface of a grid. A file of more bytes may have as many nodes as bytes."""

BYTES_OF_NODE: Final = 340
"""Measured: bytes that a node of a surface takes. A small file that gives only axes can have many nodes."""

VECTORS: Final = (b"ORIGIN", b"SPACING", b"ASPECT_RATIO")


def read_grid(cursor: VtkCursor, dataset: bytes, before: Attributes) -> VtkSurface:
    """The layer of a grid, or the outer surface of its volume. `before` skips a FIELD. Raises InputError."""
    dimensions: tuple[int, ...] | None = None
    points: Floats | None = None
    axes: dict[bytes, Floats] = {}
    vectors: dict[bytes, Floats] = {}
    while (keyword := cursor.peek()) and keyword not in TABLES:
        words = cursor.words()
        if keyword == b"METADATA":
            cursor.skip_metadata()
        elif keyword == b"FIELD":
            before.field(words)
        elif keyword == b"DIMENSIONS":
            dimensions = _dimensions(cursor, words, dataset)
        elif keyword in VECTORS and len(words) == 4:
            vectors[keyword] = _vector(cursor, words)
        elif keyword in AXES and len(words) == 3:
            what = keyword.decode()
            count = cursor.count(words[1], f"the count of {what}")
            axes[keyword] = cursor.coordinates(count, words[2], what)
        elif keyword == b"POINTS" and len(words) == 3:
            points = read_points(cursor, words)
        else:
            raise cursor.error(
                f"there must be no {shown(b' '.join(words))} in {dataset.decode()}; correct the file"
            )
    if dimensions is None:
        raise InputError(f"{cursor.name}: a {dataset.decode()} must have DIMENSIONS, not none; add them")
    nodes, cells, within = (
        math.prod(max(size - less, least) for size in dimensions) for less, least in ((0, 0), (1, 1), (2, 0))
    )
    on_surface = nodes - within
    most = max(len(cursor.data), NODES_OF_ANY_GRID)
    if on_surface > most:
        raise InputError(
            f"{cursor.name}: the surface of a {dataset.decode()} must have at most {most:,} nodes, for the"
            f" size of the file, not {on_surface:,}; take fewer"
        )
    require_memory(BYTES_OF_NODE * on_surface, f"{cursor.name}: to read {on_surface:,} nodes", "take fewer")
    table, owners = _grid_quads(dimensions)
    rows = np.arange(nodes) if on_surface == nodes else np.unique(table)
    if points is None:
        coordinates = _points(cursor, dataset, dimensions, axes, vectors, rows)
        if not (np.abs(coordinates) <= LARGEST_COORDINATE).all():
            raise InputError(
                f"{cursor.name}: coordinates must be at most 1e30 in size; correct ORIGIN and SPACING"
            )
    elif len(points) != nodes:
        raise InputError(
            f"{cursor.name}: a {dataset.decode()} must have the {nodes:,} nodes of its DIMENSIONS, not"
            f" {len(points):,}; correct them"
        )
    else:
        coordinates = points[rows]
    sentences: tuple[str, ...] = ()
    if 1 not in dimensions:
        sentences = tuple(surface_sentences(cells, within))
        table = np.searchsorted(rows, table)
        if _volume(coordinates, table) < 0:
            table = table[:, ::-1]
    surface = CellSurface(Flats.of(table, owners), rows, sentences)
    return VtkSurface(coordinates, surface, {NODE: nodes, POLYGON: cells})


def _grid_quads(dimensions: tuple[int, ...]) -> tuple[Indices, Indices]:
    """The quads of a layer, or of the six sides of a volume, and the row of the cell of each quad.

    Quads are (quads, 4), rows of all nodes. Those of a volume turn outward if its axes are right-handed.
    """
    cells = [max(size - 1, 1) for size in dimensions]
    steps, cell_steps = (np.array([1, each[0], each[0] * each[1]]) for each in (dimensions, cells))

    def side(one: int, other: int, node: int = 0, cell: int = 0) -> tuple[Indices, Indices]:
        """The quads that turn from an axis to another, from the node and the cell in the corner on."""
        columns, rows = np.arange(dimensions[one] - 1), np.arange(dimensions[other] - 1)[:, None]
        first, owners = (
            (start + each[one] * columns + each[other] * rows).ravel()
            for start, each in ((node, steps), (cell, cell_steps))
        )
        around = np.array([0, steps[one], steps[one] + steps[other], steps[other]])
        return first[:, None] + around, owners

    if 1 in dimensions:
        one, other = sorted(sorted(range(3), key=lambda axis: dimensions[axis] == 1)[:2])
        return side(one, other)
    sides = []
    for axis in range(3):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        last = cells[axis]
        sides += [side(other, one), side(one, other, last * steps[axis], (last - 1) * cell_steps[axis])]
    return np.concatenate([quads for quads, _ in sides]), np.concatenate([owners for _, owners in sides])


def _volume(coordinates: Floats, quads: Indices) -> float:
    """A number with the sign of the volume in a closed surface: positive if its quads turn outward."""
    size = np.ptp(coordinates, axis=0).max() or 1.0
    a, b, c, d = np.moveaxis(((coordinates - coordinates.mean(axis=0)) / size)[quads], 1, 0)
    return float((np.cross(c - a, d - b) * (a + b + c + d)).sum())


def _dimensions(cursor: VtkCursor, words: list[bytes], dataset: bytes) -> tuple[int, ...]:
    """The numbers of nodes along the three axes. Raises InputError."""
    sizes = tuple(cursor.count(word, "a number of DIMENSIONS") for word in words[1:])
    if len(sizes) != 3 or 0 in sizes:
        raise cursor.error(
            f"a {dataset.decode()} must have three numbers of nodes, as in DIMENSIONS 5 4 1, not"
            f" {shown(b' '.join(words))}; correct them"
        )
    return sizes


def _vector(cursor: VtkCursor, words: list[bytes]) -> Floats:
    """The three numbers after a keyword. Raises InputError."""
    line = cursor.data.count(b"\n", 0, cursor.begun) + 1
    return NumberText(b" ".join(words[1:]), cursor.name, line).coordinates(0, 3)


def _points(
    cursor: VtkCursor,
    dataset: bytes,
    dimensions: tuple[int, ...],
    axes: dict[bytes, Floats],
    vectors: dict[bytes, Floats],
    rows: Indices,
) -> Floats:
    """The coordinates of some nodes of a grid with straight axes, by their rows. Raises InputError."""
    if dataset == b"STRUCTURED_POINTS":
        origin = vectors.get(b"ORIGIN", np.zeros(3))
        spacing = vectors.get(b"SPACING", vectors.get(b"ASPECT_RATIO", np.ones(3)))
        with np.errstate(over="ignore"):
            places = [
                start + step * np.arange(size)
                for start, step, size in zip(origin, spacing, dimensions, strict=True)
            ]
    else:
        places = [axes.get(axis, np.empty(0)) for axis in AXES]
        if dataset != b"RECTILINEAR_GRID" or tuple(map(len, places)) != dimensions:
            what = "POINTS" if dataset == b"STRUCTURED_GRID" else "coordinates of each of its DIMENSIONS"
            raise InputError(f"{cursor.name}: a {dataset.decode()} must have {what}; add them")
    wide, high, _ = dimensions
    x, y, z = rows % wide, rows // wide % high, rows // (wide * high)
    return np.stack([place[at] for place, at in zip(places, (x, y, z), strict=True)], axis=1)


# The data of nodes and cells. Scalars, vectors, tensors and the arrays of fields become scalars of the mesh.
# Normals, texture coordinates, colors, numbers for identification, bits and texts are skipped and counted.

TABLES: Final = {b"POINT_DATA": NODE, b"CELL_DATA": POLYGON}

COMPONENTS: Final = {b"VECTORS": 3, b"TENSORS": 9, b"TENSORS6": 6}

IGNORED: Final = {b"NORMALS": 3, b"GLOBAL_IDS": 1, b"PEDIGREE_IDS": 1, b"EDGE_FLAGS": 1}

MOST_ARRAYS: Final = 100_000
"""Limit: arrays of a FIELD."""


class Attributes:
    """Collects the scalars of a file; `rows` are the rows in the file of the mesh's nodes and polygons."""

    def __init__(self, cursor: VtkCursor, counts: Mapping[str, int], rows: Mapping[str, Indices]) -> None:
        self.cursor = cursor
        self.counts = counts
        self.rows = rows
        self.scalars = FileScalars()
        self.of: str | None = None
        self.skipped: Counter[str] = Counter()

    def read(self) -> None:
        """Read all data up to the end of the file, or up to an unknown keyword. Raises InputError."""
        while words := self.cursor.words():
            keyword = words[0].upper()
            if keyword in TABLES:
                self._begin(TABLES[keyword], words)
            elif keyword == b"METADATA":
                self.cursor.skip_metadata()
            elif keyword == b"FIELD":
                self.field(words)
            elif not self._attribute(keyword, words):
                self.scalars.sentences.append(f"skipped all from the unknown keyword {shown(words[0])} on")
                return

    @property
    def messages(self) -> tuple[str, ...]:
        """Sentences about what was left out."""
        skipped = (f"skipped {what}: {count:,}" for what, count in self.skipped.items())
        return (*self.scalars.messages, *skipped)

    def _begin(self, of: str, words: list[bytes]) -> None:
        """Begin the data of nodes or cells; the count must be their number in the file."""
        what = words[0].decode("latin-1").upper()
        count = self.cursor.count(words[1] if len(words) > 1 else b"", f"the count of {what}")
        if count != self.counts[of]:
            raise self.cursor.error(
                f"{what} must be for all {self.counts[of]:,} of the file, not {count:,}; correct the count"
            )
        self.of = of

    def _attribute(self, keyword: bytes, words: list[bytes]) -> bool:
        """Read one attribute; False if its keyword is unknown."""
        others = (b"SCALARS", b"COLOR_SCALARS", b"LOOKUP_TABLE", b"TEXTURE_COORDINATES")
        if keyword not in (*others, *COMPONENTS, *IGNORED):
            return False
        least = 4 if keyword == b"TEXTURE_COORDINATES" else 3
        if len(words) < least:
            raise self.cursor.error(
                f"{words[0].decode('latin-1')} must be followed by {least - 1} words,"
                f" not {len(words) - 1}; correct it"
            )
        name, rows = words[1], self.counts[self.of or NODE]
        if keyword == b"LOOKUP_TABLE":
            self._skip(4 * self.cursor.count(words[2], "a count"), b"float", b"unsigned_char", "color tables")
        elif keyword == b"COLOR_SCALARS":
            width = self.cursor.count(words[2], "a count")
            self._skip(rows * width, b"float", b"unsigned_char", "arrays of colors")
        elif keyword == b"TEXTURE_COORDINATES":
            width = self.cursor.count(words[2], "a count")
            self._array(name, rows, width, words[3], "texture coordinates")
        elif keyword == b"SCALARS":
            width = self.cursor.count(words[3], "a number of components") if len(words) > 3 else 1
            if self.cursor.peek() == b"LOOKUP_TABLE":
                self.cursor.words()
            self._array(name, rows, width, words[2])
        elif keyword in COMPONENTS:
            self._array(name, rows, COMPONENTS[keyword], words[2])
        else:
            what = "normals" if keyword == b"NORMALS" else "arrays of numbers for identification"
            self._array(name, rows, IGNORED[keyword], words[2], what)
        return True

    def field(self, words: list[bytes]) -> None:
        """Read the arrays of a FIELD. Arrays that belong to no node or cell are skipped."""
        cursor = self.cursor
        arrays = cursor.count(words[2] if len(words) > 2 else b"", "the number of arrays of a FIELD")
        if arrays > MOST_ARRAYS:
            raise self.cursor.error(
                f"a FIELD must have at most {MOST_ARRAYS:,} arrays, not {arrays:,}; leave some out"
            )
        while arrays:
            header = cursor.words()
            if header and header[0].upper() == b"METADATA":
                cursor.skip_metadata()
                continue
            if len(header) < 4:
                raise self.cursor.error(
                    f"an array of a FIELD must have a name, two counts and a type, not"
                    f" {shown(b' '.join(header))}; correct it"
                )
            width, rows = (cursor.count(word, "a count of an array of a FIELD") for word in header[1:3])
            self._array(header[0], rows, width, header[3])
            arrays -= 1

    def _array(self, name: bytes, rows: int, width: int, kind: bytes, ignored: str = "") -> None:
        """Add an array as a scalar, or skip it if it is `ignored` or of another size."""
        cursor, kind = self.cursor, kind.lower()
        if kind == b"bit":
            ignored = "arrays of bits"
        if kind == b"string":
            ignored = "arrays of texts"
            self._skip_texts(rows * width)
        elif kind == b"bit" and cursor.text is None:
            cursor.array(-(-rows * width // 8), b"unsigned_char", "bits")
        else:
            what = f"array {shown(name)}"
            values = cursor.array(rows * width, b"int" if kind == b"bit" else kind, what)
            if not ignored and (self.of is None or rows != self.counts[self.of]):
                ignored = "arrays that are of no node or cell"
            if not ignored and rows and width:
                assert self.of is not None
                text = unquote_to_bytes(name).decode("utf-8", "replace")
                self.scalars.add(text, values.reshape(rows, width), self.of, self.rows[self.of])
                return
        ignored = ignored or "empty arrays"
        self.skipped[ignored] += 1

    def _skip(self, count: int, in_text: bytes, in_binary: bytes, what: str) -> None:
        self.cursor.array(count, in_binary if self.cursor.text is None else in_text, what)
        self.skipped[what] += 1

    def _skip_texts(self, count: int) -> None:
        """Go past texts: lines, or in binary a length and a text. A length's first two bits give its size."""
        cursor = self.cursor
        for _ in range(count):
            if cursor.at >= len(cursor.data):
                raise self.cursor.error(f"there must be {count:,} texts, not fewer; correct the count")
            if cursor.text is not None:
                cursor.raw_line()
                continue
            size = {3: 1, 2: 2, 1: 4, 0: 8}[cursor.data[cursor.at] >> 6]
            head = int.from_bytes(cursor.data[cursor.at : cursor.at + size], "big")
            length = head & ((1 << (8 * size - 2)) - 1)
            cursor.at = min(cursor.at + size + length, len(cursor.data))
