"""Meshes in Wavefront OBJ files: read with their materials, and written.

These statements are used: `v` x y z (a color after them is left out, a weight is ignored); `vn`, a normal;
`f`, with numbers of nodes and normals that count from 1 or, if negative, back from the latest; `g`, `o` and
`usemtl`, which name the parts and their materials; and `mtllib`, which names the libraries of materials. A
polygon may name nodes that are defined later. Quads stay quads, and shared nodes stay shared.

Texture coordinates are ignored. Points, lines, curves and unknown statements are skipped and counted. Lines
may end with LF, CR LF or CR, may be continued with a backslash, and may start with spaces or tabs.
"""

from __future__ import annotations

import dataclasses
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import compress, pairwise
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Bytes, Floats, Indices, Numbers, chunks
from autocolor.errors import InputError
from autocolor.files.meshes.mtl import read_materials, statement
from autocolor.files.meshes.number_text import NumberText, decimal
from autocolor.files.meshes.repair import (
    PLAIN,
    MeshReport,
    Placement,
    RawPolygons,
    different,
    name_of,
    repaired,
)
from autocolor.files.reading import read_whole, shown, text_lines
from autocolor.scene.mesh import Mesh

NODE_LINE: Final = re.compile(rb"^[ \t]*v([ \t]+[-+.0-9][^\s]*){3}", re.MULTILINE)
"""A line that defines a node."""

GROWTH: Final = 6
"""Measured: how many times its size a file takes; a file of the shortest lines takes 9."""


def read_obj(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an OBJ file, and what was repaired or skipped.

    Raises InputError with a line that is wrong, MissingInputError if the file does not exist.
    """
    data = text_lines(read_whole(path, GROWTH), path.name, "an OBJ file")
    statements = Statements(path.stem)
    polygons = read_polygons(data, path.name, statements)
    del data
    report = repaired(polygons, path.name, placement, skipped=statements.sentences)
    material_of_part = {part: name for part, name in statements.parts().items() if name is not None}
    wanted = tuple(dict.fromkeys(material_of_part.values()))
    surfaces, sentences = read_materials(path, statements.libraries, wanted)
    return dataclasses.replace(
        report,
        repairs=report.repairs + sentences,
        material_of_part=material_of_part,
        materials=surfaces,
    )


def begins_as_obj(head: bytes) -> bool:
    """Whether the first bytes of a file contain a line that defines a node, and no NUL byte."""
    return NODE_LINE.search(head) is not None and b"\0" not in head


# Large blocks of lines become arrays at once. The numbers of the lines of one kind in a block, such as nodes,
# are converted together: all other lines become empty, so that a wrong word gets its line.

BLOCK: Final = 1 << 21
"""Bytes converted at a time: enough for numpy to be efficient, and few enough to save memory."""

COMMENT: Final = re.compile(rb"#[^\n]*")
INDENT: Final = re.compile(rb"^[ \t]+", re.MULTILINE)
CONTINUED: Final = re.compile(rb"(?:[^\n]*\\\n)++[^\n]*+")

SPACE: Final = ord(" ")
FEED: Final = ord("\n")
SLASH: Final = ord("/")
NONE: Final = np.empty(0, np.int64)


def read_polygons(data: bytes, place: str, statements: Statements) -> RawPolygons:
    """The nodes and polygons of an OBJ file whose lines end with line feeds; `place` is its name in messages.

    Raises InputError with the first problem of a block.
    """
    if b"\\\n" in data:
        # Empty lines after a continued line keep the numbers of all others.
        data = CONTINUED.sub(
            lambda lines: lines[0].replace(b"\\\n", b" ") + b"\n" * lines[0].count(b"\\\n"), data
        )
    if data[:1] in (b" ", b"\t") or b"\n " in data or b"\n\t" in data:
        data = INDENT.sub(b"", data)
    nodes, normals, polygons = [np.empty((0, 3))], [np.empty((0, 3))], [[NONE] * 7]
    node_count = normal_count = 0
    first_line = 1
    data = data if data.endswith(b"\n") else data + b"\n"
    start = 0
    while start < len(data):
        end = data.find(b"\n", min(start + BLOCK, len(data) - 1)) + 1
        block, start = data[start:end], end
        letters = np.frombuffer(block, np.uint8)
        ends = np.flatnonzero(letters == FEED)
        starts = np.concatenate([[0], ends[:-1] + 1])

        # Classify the lines by their first bytes.
        first, second, third = (letters[np.minimum(starts + at, ends)] for at in range(3))
        is_v = first == ord("v")
        is_node, is_polygon = is_v & (second <= SPACE), (first == ord("f")) & (second <= SPACE)
        is_normal = is_v & (second == ord("n")) & (third <= SPACE)
        unused = is_normal | (is_v & (second == ord("t")) & (third <= SPACE))
        unused |= (first == ord("#")) | (first == FEED)

        lines = Lines(letters, starts, ends, place, first_line)
        vectors, sizes = lines.vectors(is_node)
        # Three numbers after the coordinates are a color; a single one is a weight.
        statements.has_colors |= bool(sizes.max(initial=0) >= 6)
        nodes.append(vectors)
        normals.append(lines.normals(is_normal))
        rows = np.flatnonzero(is_polygon)
        others = np.flatnonzero(~(is_node | is_polygon | unused))
        parts = _part_numbers(block, others, starts, ends, rows, statements)
        nodes_before = node_count + np.cumsum(is_node)[rows]
        normals_before = normal_count + np.cumsum(is_normal)[rows]
        polygons.append([*lines.corners(is_polygon), parts, nodes_before, normals_before, first_line + rows])
        node_count += len(nodes[-1])
        normal_count += len(normals[-1])
        first_line += len(ends)
    columns = (np.concatenate(column) for column in zip(*polygons, strict=True))
    node_numbers, normal_numbers, counts, part_numbers, nodes_before, normals_before, line_of = columns
    corners = _rows(node_numbers, nodes_before, counts, node_count)
    if len(corners) and corners.min() < 0:
        corner = int(corners.argmin())
        polygon = int(np.searchsorted(np.cumsum(counts), corner, side="right"))
        raise InputError(
            f"{place}, line {line_of[polygon]}: a corner must be one of the file's {node_count:,} nodes, or"
            f" count back to one, not {node_numbers[corner]}; correct it"
        )
    has_normals = bool(normal_numbers.any())
    return RawPolygons(
        np.concatenate(nodes),
        corners,
        counts,
        part_numbers,
        tuple(statements.parts()),
        place_of=lambda row: f"line {line_of[row]}",
        normals=np.concatenate(normals) if has_normals else None,
        corner_normals=_rows(normal_numbers, normals_before, counts, normal_count) if has_normals else None,
    )


def _rows(numbers: Numbers, before: Numbers, counts: Numbers, count: int) -> Indices:
    """The rows of the nodes or normals at all corners; -1 for a number that the file does not have.

    Numbers count from 1 or, if negative, back from the latest; `before` is how many are defined before each
    polygon, `counts` the corners of each, and `count` how many nodes or normals the file has.
    """
    rows = numbers - 1
    back = np.flatnonzero(numbers < 0)
    if len(back):
        rows[back] = np.repeat(before, counts)[back] + numbers[back]
    rows[(rows < 0) | (rows >= count)] = -1
    return rows.astype(np.intp, copy=False)


class Lines(NamedTuple):
    """A block of lines: its letters, where lines start and end, the file's name, the first line's number."""

    letters: Bytes
    starts: Numbers
    ends: Numbers
    place: str
    first_line: int

    def vectors(self, chosen: Booleans) -> tuple[Floats, Numbers]:
        """The coordinates of the chosen nodes, (n, 3), and how many numbers each has. Raises InputError."""
        if not chosen.any():
            return np.empty((0, 3)), NONE
        text, upto = self._numbers(self._only(chosen, 1), chosen)
        sizes = np.diff(upto, prepend=0)
        if sizes.min() < 3:
            rule = "a node must have three coordinates x y z"
            line = self.first_line + int(np.flatnonzero(chosen)[sizes.argmin()])
            raise InputError(f"{self.place}, line {line}: {rule}, not {sizes.min()}; add what is missing")
        return text.vectors(upto - sizes, len(text)), sizes

    def normals(self, chosen: Booleans) -> Floats:
        """The chosen normals, (n, 3); one that is no three numbers is NaN, which is a missing normal."""
        lines = self._only(chosen, 2)
        try:
            text, upto = self._numbers(lines, chosen)
            if (np.diff(upto, prepend=0) == 3).all():
                return text.values(0, len(text)).reshape(-1, 3)
        except InputError:
            pass
        words = [line.split() for line in compress(lines.split(b"\n"), chosen)]
        return np.array([[decimal(word) for word in row] if len(row) == 3 else [np.nan] * 3 for row in words])

    def corners(self, chosen: Booleans) -> tuple[Numbers, Numbers, Numbers]:
        """The node and normal numbers of all corners of the chosen polygons, and how many corners each has.

        Corners are such as 7, 7/1, 7//3 or 7/1/3; a normal number of 0 is none. Raises InputError.
        """
        if not chosen.any():
            return NONE, NONE, NONE
        # A texture number that is left out becomes 0.
        lines = self._only(chosen, 1).replace(b"//", b"/0/")
        text, upto = self._numbers(lines.replace(b"/", b" "), chosen)
        numbers = text.wholes(0, len(text), "a corner")
        if b"/" not in lines:
            return numbers, np.zeros(len(numbers), np.int64), np.diff(upto, prepend=0)
        letters = np.frombuffer(lines, np.uint8)
        slashes = np.flatnonzero(letters == SLASH)
        is_head = letters[text.starts - 1] != SLASH
        heads = np.flatnonzero(is_head)
        sizes = np.diff(heads, append=len(text))
        before = letters[slashes - 1]
        wrong = np.append(slashes[(before <= SPACE) | (before == SLASH)], text.starts[heads[sizes > 3]])
        if len(wrong):
            at = int(wrong[0])
            line = self.first_line + lines.count(b"\n", 0, at)
            word = shown(lines[at : at + 100].split(None, 1)[0])
            rule = "a corner must be a node number, alone or with texture and normal numbers as in 7/1/3"
            raise InputError(f"{self.place}, line {line}: {rule}, not {word}; correct it")
        normals = np.zeros(len(heads), np.int64)
        with_normal = np.flatnonzero(sizes == 3)
        normals[with_normal] = numbers[heads[with_normal] + 2]
        return numbers[heads], normals, np.diff(np.append(0, np.cumsum(is_head))[upto], prepend=0)

    def _only(self, chosen: Booleans, keyword: int) -> bytes:
        """The block with all lines but the chosen ones empty, without a keyword of so many letters."""
        text = self.letters[np.repeat(chosen, self.ends + 1 - self.starts) | (self.letters == FEED)]
        starts = np.append(0, np.flatnonzero(text == FEED) + 1)[:-1][chosen]
        for at in range(keyword):
            text[starts + at] = SPACE
        lines = text.tobytes()
        return COMMENT.sub(b"", lines) if b"#" in lines else lines

    def _numbers(self, lines: bytes, chosen: Booleans) -> tuple[NumberText, Numbers]:
        """The numbers of the lines, and how many there are up to the end of each chosen line."""
        text = NumberText(lines, self.place, self.first_line)
        ends = np.flatnonzero(np.frombuffer(lines, np.uint8) == FEED)
        return text, np.searchsorted(text.starts, ends[chosen])


def _part_numbers(
    block: bytes, others: Numbers, starts: Numbers, ends: Numbers, polygons: Numbers, statements: Statements
) -> Numbers:
    """The part number of each polygon, from the names in the other lines before it."""
    numbers = np.empty(len(polygons), np.int64)
    places = zip(starts[others].tolist(), ends[others].tolist(), strict=True)
    lines = [b"", *(block[start:end] for start, end in places)]
    bounds = [0, *np.searchsorted(polygons, others).tolist(), len(polygons)]
    for line, (first, end) in zip(lines, pairwise(bounds), strict=True):
        statements.read(line)
        if end > first:
            numbers[first:end] = statements.part_number
    return numbers


# Statements other than nodes and polygons: names of parts, materials, and statements that are skipped.
#
# A polygon belongs to the group of the latest `g` or `o` name before it; of several names after `g`, the
# first counts. `g` or `o` without a name ends the group. A group is a part. If its polygons have several
# materials, each material is a part, and all but the first add the material to the name: "hood", "hood
# chrome". Without a group the part has the name of the material, and without a material the file's name.

UNUSED: Final = frozenset(
    b"vt vn s mg maplib usemap lod bevel c_interp d_interp shadow_obj trace_obj".split()
)
"""Statements that are ignored without being counted."""

SKIPPED: Final = {b"p": "points", b"l": "lines"}

MOST_SKIPPED: Final = 5
"""Limit: kinds of skipped statements that are counted by their names."""


class Statements:
    """The current group and material while a file is read, and counts of skipped statements."""

    def __init__(self, file_stem: str) -> None:
        self.file_stem = file_stem
        self.group: str | None = None
        self.material: str | None = None
        self.libraries: list[bytes] = []
        self.numbers: dict[tuple[str | None, str | None], int] = {}
        self.skipped: Counter[str] = Counter()
        self.has_colors = False

    @property
    def part_number(self) -> int:
        """The part number of the current group and material; a new pair gets the next number."""
        return self.numbers.setdefault((self.group, self.material), len(self.numbers))

    def parts(self) -> dict[str, str | None]:
        """The names of the parts in the order of their numbers, and the material of each, if any."""
        names: list[str] = []
        for group, material in self.numbers:
            name = group or material or self.file_stem
            names.append(f"{name} {material}" if name in names and group and material else name)
        materials = (material for _, material in self.numbers)
        return dict(zip(different(names), materials, strict=True))

    def read(self, line: bytes) -> None:
        """Process a line that is no node, normal or polygon."""
        keyword, _, rest = line.replace(b"\t", b" ").strip().partition(b" ")
        if not keyword or keyword.startswith(b"#"):
            return
        if keyword == b"g":
            self.group = name_of(rest.split()[0]) if rest.strip() else None
        elif keyword == b"o":
            self.group = name_of(rest) or None
        elif keyword == b"usemtl":
            self.material = name_of(rest) or None
        elif keyword == b"mtllib" and rest:
            self.libraries.append(rest)
        elif keyword not in UNUSED:
            name = SKIPPED.get(keyword) or f"statements {shown(keyword)}"
            is_new = name not in self.skipped and len(self.skipped) >= MOST_SKIPPED
            self.skipped["other statements" if is_new else name] += 1

    @property
    def sentences(self) -> tuple[str, ...]:
        """Messages about what was skipped."""
        colors = ("left out the colors of nodes",) if self.has_colors else ()
        return (*(f"skipped {what}: {count:,}" for what, count in self.skipped.items()), *colors)


ROWS_AT_ONCE: Final = 1 << 16
"""Rows that become text at once, so that there are few Python values at a time."""


def obj_text(mesh: Mesh, materials: Sequence[str] = (), library: str = "") -> bytes:
    """The mesh as an OBJ file in UTF-8, with an `o` for each part and its own normals, if it has any.

    `materials` are the names of the materials of the parts, if any, and `library` is the file of materials.
    Its numbers read back equal, and so does the mesh unless the reader repairs it: a polygon without area is
    dropped, parts are those of polygons and in their order, and names are printable, with no spaces around.
    """
    return "\n".join(_lines(mesh, materials, library)).encode("utf-8", "replace") + b"\n"


def _lines(mesh: Mesh, materials: Sequence[str], library: str) -> Iterator[str]:
    """The lines of nodes, normals and polygons, with the name of a part wherever it changes."""
    if library:
        yield f"mtllib {library}"
    for chunk in chunks(len(mesh.coordinates), ROWS_AT_ONCE):
        for x, y, z in mesh.coordinates[chunk].tolist():
            yield f"v {x!r} {y!r} {z!r}"
    own = mesh.own_normals
    if own is not None:
        yield from (f"vn {x!r} {y!r} {z!r}" for x, y, z in own.vectors.tolist())
    before = -1
    for chunk in chunks(len(mesh.node_numbers), ROWS_AT_ONCE):
        parts = mesh.part_numbers[chunk].tolist()
        corner_rows = (mesh.node_numbers[chunk] + 1).tolist()
        if own is not None:
            normal_rows = (own.numbers[chunk] + 1).tolist()
            corner_rows = [
                [f"{node}//{normal}" if normal else str(node) for node, normal in zip(*rows, strict=True)]
                for rows in zip(corner_rows, normal_rows, strict=True)
            ]
        for part, corners in zip(parts, corner_rows, strict=True):
            if part != before:
                yield statement("o", mesh.part_names[part])
                if materials:
                    yield statement("usemtl", materials[part])
                before = part
            a, b, c, d = corners
            yield f"f {a} {b} {c}" if c == d else f"f {a} {b} {c} {d}"
