"""Meshes in Wavefront OBJ files, and their materials in a library beside them: read and written.

These statements are used: `v` x y z (a color after them is left out, a weight is ignored); `vn`, a normal;
`f`, with numbers of nodes and normals that count from 1 or, if negative, back from the latest; `g`, `o` and
`usemtl`, which name the parts and their materials; and `mtllib`, which names the libraries of materials. A
polygon may name nodes that are defined later. Quads stay quads, and shared nodes stay shared.

Texture coordinates are ignored. Points, lines, curves and unknown statements are skipped and counted. Lines
may end with LF, CR LF or CR, may be continued with a backslash, and may start with spaces or tabs.
"""

from __future__ import annotations

import dataclasses
import io
import os
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import compress
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Numbers
from autocolor.errors import InputError
from autocolor.files.meshes.mtl import materials_of, mtl_text, read_materials, statement
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
from autocolor.files.paths import free_path
from autocolor.files.reading import read_whole, shown, text_lines
from autocolor.files.writing import refuse_output, write_atomically
from autocolor.scene.creation import SHARED
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Surface

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
        repairs=sentences + report.repairs,
        material_of_part=material_of_part,
        materials=surfaces,
    )


def begins_as_obj(head: bytes) -> bool:
    """Whether the first bytes of a file contain a line that defines a node, and no NUL byte."""
    return NODE_LINE.search(head) is not None and b"\0" not in head


BLOCK: Final = 1 << 21
"""Bytes of lines whose numbers become arrays at a time: enough for numpy to be efficient, and few enough to
save memory."""

COMMENT: Final = re.compile(rb"#[^\n]*")
INDENT: Final = re.compile(rb"^ +", re.MULTILINE)
CONTINUED: Final = re.compile(rb"(?:[^\n]*\\\n)++[^\n]*+")

OTHER: Final = 0
NODE: Final = 1
NORMAL: Final = 2
POLYGON: Final = 3
UNUSED: Final = 4
KINDS: Final = {
    **{b"": UNUSED, b"v": NODE, b"vn": NORMAL, b"f": POLYGON},
    **dict.fromkeys(
        b"vt s mg maplib usemap lod bevel c_interp d_interp shadow_obj trace_obj".split(), UNUSED
    ),
}
"""The kinds of the statements; those that are UNUSED are ignored without being counted."""


def read_polygons(data: bytes, place: str, statements: Statements) -> RawPolygons:
    """The nodes and polygons of an OBJ file whose lines end with line feeds; `place` is its name in messages.

    Raises InputError with the first problem of a block.
    """
    if b"\\\n" in data:
        # Empty lines after a continued line keep the numbers of all others.
        data = CONTINUED.sub(
            lambda lines: lines[0].replace(b"\\\n", b" ") + b"\n" * lines[0].count(b"\\\n"), data
        )
    data = data.replace(b"\t", b" ")
    if data[:1] == b" " or b"\n " in data:
        data = INDENT.sub(b"", data)
    none = np.empty(0, np.int64)
    nodes, normals, polygons = [np.empty((0, 3))], [np.empty((0, 3))], [[none] * 7]
    node_count = normal_count = 0
    first_line = 1
    stream = io.BytesIO(data)
    while rows := (stream.read(BLOCK) + stream.readline()).splitlines():
        kinds = bytes([KINDS.get(row.partition(b" ")[0], OTHER) for row in rows])
        lines = Lines(rows, kinds, place, first_line)
        vectors, sizes = lines.vectors()
        # Three numbers after the coordinates are a color; a single one is a weight.
        statements.has_colors |= bool(sizes.max(initial=0) >= 6)
        nodes.append(vectors)
        normals.append(lines.normals())
        chosen = lines.are(POLYGON)
        # The part changes at other statements alone.
        others = np.append(np.flatnonzero(lines.are(OTHER)), len(rows))
        ends = np.append(0, np.cumsum(chosen))[others].tolist()
        parts = np.zeros(ends[-1], np.int64)
        for line, begin, end in zip(others.tolist(), [0, *ends], ends, strict=False):
            if begin < end:
                parts[begin:end] = statements.part_number
            statements.read(b"".join(rows[line : line + 1]))
        nodes_before = node_count + np.cumsum(lines.are(NODE))[chosen]
        normals_before = normal_count + np.cumsum(lines.are(NORMAL))[chosen]
        line_of = first_line + np.flatnonzero(chosen)
        polygons.append([*lines.corners(), parts, nodes_before, normals_before, line_of])
        node_count += len(nodes[-1])
        normal_count += len(normals[-1])
        first_line += len(rows)
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
    """Some lines, their KINDS, the file's name, and the number of the first line."""

    rows: list[bytes]
    kinds: bytes
    place: str
    first_line: int

    def are(self, kind: int) -> Booleans:
        """Which lines are of a kind."""
        are: Booleans = np.frombuffer(self.kinds, np.uint8) == kind
        return are

    def vectors(self) -> tuple[Floats, Numbers]:
        """The coordinates of the nodes, (n, 3), and how many numbers each has. Raises InputError."""
        text, sizes = self._numbers(self._text(NODE), NODE)
        if not len(sizes):
            return np.empty((0, 3)), sizes
        if sizes.min() < 3:
            line = self.first_line + int(np.flatnonzero(self.are(NODE))[sizes.argmin()])
            rule = "a node must have three coordinates x y z"
            raise InputError(f"{self.place}, line {line}: {rule}, not {sizes.min()}; add what is missing")
        return text.vectors(np.cumsum(sizes) - sizes, len(text)), sizes

    def normals(self) -> Floats:
        """The normals, (n, 3); one that is no three numbers is NaN, which is a missing normal."""
        lines = self._text(NORMAL)
        with suppress(InputError):
            text, sizes = self._numbers(lines, NORMAL)
            if (sizes == 3).all():
                return text.values(0, len(text)).reshape(-1, 3)
        words = [line.split() for line in compress(lines.split(b"\n"), self.are(NORMAL))]
        return np.array([[decimal(word) for word in row] if len(row) == 3 else [np.nan] * 3 for row in words])

    def corners(self) -> tuple[Numbers, Numbers, Numbers]:
        """The node and normal numbers of all corners of the polygons, and how many corners each has.

        Corners are such as 7, 7/1, 7//3 or 7/1/3; a normal number of 0 is none. Raises InputError.
        """
        # A texture number that is left out becomes 0.
        lines = self._text(POLYGON).replace(b"//", b"/0/")
        text, sizes = self._numbers(lines.replace(b"/", b" "), POLYGON)
        numbers = text.wholes(0, len(text), "a corner")
        if b"/" not in lines:
            return numbers, np.zeros(len(numbers), np.int64), sizes
        letters = np.frombuffer(lines, np.uint8)
        slashes = np.flatnonzero(letters == ord("/"))
        before = letters[slashes - 1]
        is_head = letters[text.starts - 1] != ord("/")
        heads = np.flatnonzero(is_head)
        lengths = np.diff(heads, append=len(text))
        wrong = np.append(
            slashes[(before <= ord(" ")) | (before == ord("/"))], text.starts[heads[lengths > 3]]
        )
        if len(wrong):
            at = int(wrong[0])
            line = self.first_line + lines.count(b"\n", 0, at)
            word = shown(lines[at : at + 100].split(None, 1)[0])
            rule = "a corner must be a node number, alone or with texture and normal numbers as in 7/1/3"
            raise InputError(f"{self.place}, line {line}: {rule}, not {word}; correct it")
        normals = np.zeros(len(heads), np.int64)
        normals[lengths == 3] = numbers[heads[lengths == 3] + 2]
        heads_before = np.append(0, np.cumsum(is_head))
        return numbers[heads], normals, np.diff(heads_before[np.cumsum(sizes)], prepend=0)

    def _text(self, kind: int) -> bytes:
        """The lines of a kind without their keywords; other lines are empty, so that a word has its line."""
        cut = 2 if kind == NORMAL else 1
        if kind not in self.kinds:
            return b"\n" * len(self.rows)
        lines = [row[cut:] if each == kind else b"" for each, row in zip(self.kinds, self.rows, strict=True)]
        text = b"\n".join([*lines, b""])
        return COMMENT.sub(b"", text) if b"#" in text else text

    def _numbers(self, lines: bytes, kind: int) -> tuple[NumberText, Numbers]:
        """The numbers of the lines of a kind, and how many there are in each."""
        text = NumberText(lines, self.place, self.first_line)
        ends = np.flatnonzero(np.frombuffer(lines, np.uint8) == ord("\n"))[self.are(kind)]
        return text, np.diff(np.searchsorted(text.starts, ends), prepend=0)


# Statements other than nodes and polygons: names of parts, materials, and statements that are skipped.
#
# A polygon belongs to the group of the latest `g` or `o` name before it; of several names after `g`, the
# first counts. `g` or `o` without a name ends the group. A group is a part. If its polygons have several
# materials, each material is a part, and all but the first add the material to the name: "hood", "hood
# chrome". Without a group the part has the name of the material, and without a material the file's name.


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
        keyword, _, rest = line.strip().partition(b" ")
        if keyword == b"g":
            self.group = name_of(rest.split()[0]) if rest.strip() else None
        elif keyword == b"o":
            self.group = name_of(rest) or None
        elif keyword == b"usemtl":
            self.material = name_of(rest) or None
        elif keyword == b"mtllib" and rest:
            self.libraries.append(rest)
        elif keyword and not keyword.startswith(b"#"):
            self.skipped[{b"p": "points", b"l": "lines"}.get(keyword, "unknown statements")] += 1

    @property
    def sentences(self) -> tuple[str, ...]:
        """Messages about what was skipped."""
        colors = ("left out the colors of nodes",) if self.has_colors else ()
        return (*(f"skipped {what}: {count:,}" for what, count in self.skipped.items()), *colors)


def obj_text(mesh: Mesh, materials: Sequence[str] = (), library: str = "") -> bytes:
    """The mesh as an OBJ file in UTF-8, with an `o` for each part and its own normals, if it has any.

    `materials` are the names of the materials of the parts, if any, and `library` is the file of materials.
    Its numbers read back equal, and so does the mesh unless the reader repairs it: a polygon without area is
    dropped, parts are those of polygons and in their order, and names are printable, with no spaces around.
    """
    lines = [f"mtllib {library}"] * bool(library)
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.coordinates.tolist()]
    corners = mesh.node_numbers + 1
    own = mesh.own_normals
    if own is not None:
        lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in own.vectors.tolist()]
    before = -1
    for row, part in enumerate(mesh.part_numbers.tolist()):
        if part != before:
            lines.append(statement("o", mesh.part_names[part]))
            lines += [statement("usemtl", materials[part])] if materials else []
            before = part
        nodes = corners[row].tolist()
        words = [str(node) for node in nodes]
        if own is not None:
            numbers = (own.numbers[row] + 1).tolist()
            words = [f"{node}//{n}" if n else node for node, n in zip(words, numbers, strict=True)]
        lines.append(f"f {' '.join(words[:3] if nodes[2] == nodes[3] else words)}")
    return "\n".join([*lines, ""]).encode("utf-8", "replace")


def write_obj(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
    """Write the mesh of a scene to an OBJ file, and its surfaces to a library beside it; returns both.

    There is no library if one surface was created for all parts. Raises OutputError or WriteError.
    """
    refuse_output(path, overwrite=overwrite)
    if [surface.name for surface in scene.surfaces] == [SHARED]:
        write_atomically(path, obj_text(scene.mesh), overwrite=overwrite)
        return [path]
    library = path.with_suffix(".mtl")
    names = material_names(surface.name for surface in scene.surfaces)
    surface_of = {part.name: part.surface for part in scene.parts}
    materials = [names[surface_of[part]] for part in scene.mesh.part_names]
    data = mtl_text((names[surface.name], surface) for surface in scene.surfaces)
    refuse_output(library, overwrite=overwrite)
    # An old OBJ file may name the old library. The new OBJ file names a spare library until that is replaced.
    has_old = os.path.lexists(path) and os.path.lexists(library)
    libraries = [free_path(library), library] if has_old else [library]
    for written in libraries:
        was_there = os.path.lexists(written)
        write_atomically(written, data, overwrite=overwrite)
        try:
            write_atomically(path, obj_text(scene.mesh, materials, written.name), overwrite=overwrite)
        except BaseException:
            if not was_there:
                with suppress(OSError):
                    os.unlink(written)
            raise
    if has_old:
        os.unlink(libraries[0])
    return [path, library]


def material_names(surfaces: Iterable[str]) -> dict[str, str]:
    """Unique material names for surfaces: their own names, without characters that MTL cannot hold."""
    surfaces = list(surfaces)
    names = [name_of(surface.encode("utf-8", "replace")) or "surface" for surface in surfaces]
    return dict(zip(surfaces, different(names), strict=True))


def beyond_materials(surfaces: Iterable[Surface]) -> list[str]:
    """The names of the surfaces that a material library cannot hold whole."""
    surface_of = {str(number): surface for number, surface in enumerate(surfaces)}
    read_back, _ = materials_of(mtl_text(surface_of.items()), "", {*surface_of})
    return [
        surface.name
        for number, surface in surface_of.items()
        if read_back[number].replace(name=surface.name) != surface
    ]
