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
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Bytes, Floats, Indices, Numbers, chunks
from autocolor.checks import LARGEST_COORDINATE
from autocolor.files.meshes.mtl import read_materials, statement
from autocolor.files.meshes.number_text import COORDINATE, D_TO_E, MOST_PROBLEMS, Problems, decimal
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, name_of, repaired
from autocolor.files.reading import read_whole, shown, text_lines
from autocolor.scene.mesh import Mesh

NODE_LINE: Final = re.compile(rb"^[ \t]*v([ \t]+[-+.0-9][^\s]*){3}", re.MULTILINE)
"""A line that defines a node."""

GROWTH: Final = 6
"""Measured: how many times its size a file takes; a file of the shortest lines takes 9."""


def read_obj(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an OBJ file, and what was repaired or skipped.

    Raises InputError with every problem, each with its line, MissingInputError if the file does not exist.
    """
    data = text_lines(read_whole(path, GROWTH), path.name, "an OBJ file")
    statements = Statements(path.stem)
    tables = read_tables(data, path.name, statements)
    del data
    parts = statements.parts()
    polygons = RawPolygons(
        tables.coordinates,
        tables.node_rows,
        tables.corner_counts,
        tables.part_numbers,
        tuple(parts),
        place_of=lambda row: f"line {tables.lines[row]}",
        normals=tables.normals if tables.normal_numbers.any() else None,
        corner_normals=tables.normal_rows,
    )
    report = repaired(polygons, path.name, placement, skipped=statements.sentences)
    material_of_part = {part: material for part, material in parts.items() if material is not None}
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


@dataclass(frozen=True, eq=False)
class ObjTables:
    """The nodes, normals and polygons of an OBJ file.

    `coordinates` and `normals` are (rows, 3). `node_numbers` and `normal_numbers` are those of all corners,
    concatenated, as in the file: from 1, or negative, counted back from the latest; a normal number of 0 is
    none. `corner_counts`, `part_numbers`, `nodes_before`, `normals_before` (how many are defined before the
    polygon) and `lines` have one element for each polygon.
    """

    coordinates: Floats
    normals: Floats
    node_numbers: Numbers
    normal_numbers: Numbers
    corner_counts: Numbers
    part_numbers: Numbers
    nodes_before: Numbers
    normals_before: Numbers
    lines: Numbers

    @property
    def node_rows(self) -> Indices:
        """The row in `coordinates` of each corner; -1 if there is no such node."""
        return self._rows(self.node_numbers, self.nodes_before, len(self.coordinates))

    @property
    def normal_rows(self) -> Indices:
        """The row in `normals` of each corner; -1 if there is no such normal."""
        return self._rows(self.normal_numbers, self.normals_before, len(self.normals))

    def _rows(self, numbers: Numbers, before: Numbers, count: int) -> Indices:
        rows = numbers - 1
        back = np.flatnonzero(numbers < 0)
        if len(back):
            rows[back] = np.repeat(before, self.corner_counts)[back] + numbers[back]
        rows[(rows < 0) | (rows >= count)] = -1
        return rows.astype(np.intp, copy=False)


# Large blocks of lines become arrays at once. In a block with lines that are not plain, lines of its kind are
# read one by one, and every problem gets its line.

BLOCK: Final = 1 << 21
"""Bytes converted at a time: enough for numpy to be efficient, and few enough to save memory."""

IN_VECTORS: Final = b"0123456789+-.eEdD \t\n"
IN_POLYGONS: Final = b"0123456789+-/f \t\n"
COMMENT: Final = re.compile(rb"#[^\n]*")
INDENT: Final = re.compile(rb"^[ \t]+", re.MULTILINE)
CONTINUED: Final = re.compile(rb"(?:[^\n]*\\\n)++[^\n]*+\n?")
CORNER: Final = re.compile(rb"([+-]?[0-9]{1,18})(?:/[+-]?[0-9]*(?:/([+-]?[0-9]{0,18})[0-9]*)?)?")
MOST_DIGITS: Final = 18
"""Limit: any whole number with this many digits fits in 64 bits."""

Note = Callable[[int, str], None]
"""Notes a problem of a line."""


def read_tables(data: bytes, place: str, statements: Statements) -> ObjTables:
    """The tables of an OBJ file whose lines end with line feeds; `place` is its name in messages.

    Raises InputError with every problem, up to MOST_PROBLEMS.
    """
    if b"\\\n" in data:
        data = CONTINUED.sub(_on_one_line, data)
    if data[:1] in (b" ", b"\t") or b"\n " in data or b"\n\t" in data:
        data = INDENT.sub(b"", data)
    problems = Problems("line")
    note = partial(problems.note, place)
    nodes, normals, polygons = [np.empty((0, 3))], [np.empty((0, 3))], [[np.empty(0, np.int64)] * 7]
    node_count = normal_count = 0
    first_line = 1
    for block in _blocks(data):
        text = np.frombuffer(block, np.uint8)
        ends = np.flatnonzero(text == ord("\n"))
        starts = np.concatenate([[0], ends[:-1] + 1])

        # Classify the lines by their first bytes.
        first, second = text[starts], text[np.minimum(starts + 1, ends)]
        spaced, third_spaced = second <= ord(" "), text[np.minimum(starts + 2, ends)] <= ord(" ")
        is_v = first == ord("v")
        is_node, is_polygon = is_v & spaced, (first == ord("f")) & spaced
        is_normal = is_v & (second == ord("n")) & third_spaced
        unused = is_normal | (is_v & (second == ord("t")) & third_spaced)
        unused |= (first == ord("#")) | (first == ord("\n"))

        def of(chosen: Booleans, text: Bytes = text, lengths: Numbers = ends + 1 - starts) -> bytes:
            """The chosen lines."""
            return text[np.repeat(chosen, lengths)].tobytes()

        def numbered(chosen: Booleans, first_line: int = first_line) -> list[int]:
            """The numbers of the chosen lines."""
            return (np.flatnonzero(chosen) + first_line).tolist()

        plain = _vectors(of(is_node), b"v")
        if plain is None or not (np.abs(plain[0]) <= LARGEST_COORDINATE).all():
            plain = _nodes(of(is_node), numbered(is_node), note)
        statements.has_colors |= bool(plain[1].max(initial=0) >= WORDS_WITH_COLOR)
        nodes.append(plain[0])
        of_normals = _vectors(of(is_normal), b"vn")
        normals.append(_normals(of(is_normal)) if of_normals is None else of_normals[0])

        corners = _corners(of(is_polygon))
        if corners is None:
            corners = _patient_corners(of(is_polygon), numbered(is_polygon), note)
        others = np.flatnonzero(~(is_node | is_polygon | unused))
        rows = np.flatnonzero(is_polygon)
        parts = _part_numbers(block, others, starts, ends, rows, statements)
        nodes_before = node_count + np.cumsum(is_node)[rows]
        normals_before = normal_count + np.cumsum(is_normal)[rows]
        polygons.append([*corners, parts, nodes_before, normals_before, first_line + rows])
        node_count += len(nodes[-1])
        normal_count += len(normals[-1])
        first_line += len(ends)
    columns = (np.concatenate(column) for column in zip(*polygons, strict=True))
    tables = ObjTables(np.concatenate(nodes), np.concatenate(normals), *columns)
    _note_missing_nodes(tables, note)
    problems.raise_any()
    return tables


def _on_one_line(lines: re.Match[bytes]) -> bytes:
    """Continued lines as one, and empty lines after it, so that all others keep their numbers."""
    end = b"\n" if lines[0].endswith(b"\n") else b""
    joined = lines[0].removesuffix(b"\n").removesuffix(b"\\") if lines[0].endswith(b"\\\n") else lines[0]
    return joined.removesuffix(b"\n").replace(b"\\\n", b" ") + b"\n" * lines[0].count(b"\\\n") + end


def _blocks(data: bytes) -> Iterator[bytes]:
    """The file in blocks of complete lines; a line feed is added to the last line if it has none."""
    start = 0
    while start < len(data):
        end = data.find(b"\n", min(start + BLOCK, len(data)))
        block = data[start:] if end < 0 else data[start : end + 1]
        yield block if block.endswith(b"\n") else block + b"\n"
        start += len(block)


WORDS_WITH_COLOR: Final = 7
"""The least words of a node with a color, its keyword among them."""


def _vectors(plain: bytes, keyword: bytes) -> tuple[Floats, Numbers] | None:
    """The first three numbers of lines with a keyword, (n, 3), and how many words each line has.

    None if a line has other words than numbers, or too few.
    """
    if not plain:
        return np.empty((0, 3)), np.empty(0, np.int64)
    if b"#" in plain:
        plain = COMMENT.sub(b"", plain)
    counts = _words_a_line(np.frombuffer(plain, np.uint8))
    others = plain.translate(None, IN_VECTORS)
    if others != keyword * len(counts) or plain.count(keyword) != len(counts) or counts.min() < 4:
        return None
    if b"d" in plain or b"D" in plain:
        plain = plain.translate(D_TO_E)
    words = plain.replace(keyword, b" ").decode("ascii").split()
    try:
        numbers = np.fromiter(map(float, words), np.float64, len(words))
    except ValueError:
        return None
    if (counts == counts[0]).all():
        return np.ascontiguousarray(numbers.reshape(len(counts), -1)[:, :3]), counts
    # Some lines have a color or a weight.
    begins = np.cumsum(counts - 1) - (counts - 1)
    return numbers[begins[:, None] + np.arange(3)], counts


def _words_a_line(lines: Bytes) -> Numbers:
    """The number of words in each line."""
    spaces = lines <= ord(" ")
    starts = ~spaces
    starts[1:] &= spaces[:-1]
    ends = np.flatnonzero(lines == ord("\n"))
    return np.add.reduceat(starts, np.concatenate([[0], ends[:-1] + 1]), dtype=np.int64)


def _words_of_lines(plain: bytes) -> Iterator[list[bytes]]:
    """The words of each line after its keyword, without a comment."""
    return (line.split(b"#", 1)[0].split()[1:] for line in plain.split(b"\n")[:-1])


def _nodes(plain: bytes, lines: list[int], note: Note) -> tuple[Floats, Numbers]:
    """The nodes of lines, and how many words each has. After x y z only a single word must be a number."""
    nodes, counts = np.full((len(lines), 3), np.nan), np.zeros(len(lines), np.int64)
    for row, (line, words) in enumerate(zip(lines, _words_of_lines(plain), strict=True)):
        counts[row] = len(words) + 1
        if len(words) < 3:
            note(line, f"a node must have three coordinates x y z, not {len(words)}; add what is missing")
        for at, word in enumerate(words[:3]):
            nodes[row, at] = decimal(word)
            if not abs(nodes[row, at]) <= LARGEST_COORDINATE:
                note(line, f"{COORDINATE}, not {shown(word)}; correct it")
        if len(words) == 4 and np.isnan(decimal(words[3])):
            rule = "the weight of a node must be a decimal number"
            note(line, f"{rule}, not {shown(words[3])}; correct it")
    return nodes, counts


def _normals(plain: bytes) -> Floats:
    """The normals of lines; one that is no three numbers is NaN, which is a missing normal."""
    rows = [[decimal(word) for word in words[:3]] for words in _words_of_lines(plain)]
    return np.array([row if len(row) == 3 else [np.nan] * 3 for row in rows])


def _corners(plain: bytes) -> tuple[Numbers, Numbers, Numbers] | None:
    """The node and normal numbers of the corners of lines, and the count of corners in each line.

    None if a line has something else than corners such as 7, 7/1, 7//3 or 7/1/3.
    """
    none = np.empty(0, np.int64)
    if not plain:
        return none, none, none
    if b"#" in plain:
        plain = COMMENT.sub(b"", plain)
    counts = _words_a_line(np.frombuffer(plain, np.uint8)) - 1
    if plain.translate(None, IN_POLYGONS) or plain.count(b"f") != len(counts):
        return None
    plain = plain.replace(b"f", b" ")
    has_normals = b"/" in plain
    if has_normals:
        # A texture number that is left out becomes 0.
        plain = plain.replace(b"//", b"/0/")
    text = np.frombuffer(plain, np.uint8)
    is_space, is_slash = text <= ord(" "), text == ord("/")
    begins = ~(is_space | is_slash)
    begins[1:] &= (is_space | is_slash)[:-1]
    begins = np.flatnonzero(begins)
    if np.diff(begins, append=len(plain)).max(initial=0) > MOST_DIGITS:
        return None
    if has_normals:
        # Slashes must be between numbers.
        slashes = np.flatnonzero(is_slash)
        if (is_space | is_slash)[slashes - 1].any() or (is_space | is_slash)[slashes + 1].any():
            return None
        plain = plain.replace(b"/", b" ")
    if b"-" in plain or b"+" in plain:
        try:
            numbers = np.fromiter(map(int, plain.decode("ascii").split()), np.int64, len(begins))
        except ValueError:
            return None
    else:
        # Measured: a seventh of the time of converting word by word. With digits alone, parsing cannot stop.
        numbers = np.fromstring(plain, np.int64, sep=" ")[: len(begins)]
    if not has_normals:
        return numbers, np.zeros(len(numbers), np.int64), counts
    heads = np.flatnonzero(is_space[begins - 1])
    sizes = np.diff(heads, append=len(begins))
    if sizes.max(initial=0) > 3:
        return None
    normals = np.zeros(len(heads), np.int64)
    with_normal = np.flatnonzero(sizes == 3)
    normals[with_normal] = numbers[heads[with_normal] + 2]
    return numbers[heads], normals, counts


def _patient_corners(plain: bytes, lines: list[int], note: Note) -> tuple[Numbers, Numbers, Numbers]:
    """The same as `_corners`, line by line. A line with a problem has no corners."""
    nodes: list[int] = []
    normals: list[int] = []
    counts: list[int] = []
    for line, words in zip(lines, _words_of_lines(plain), strict=True):
        corners = [CORNER.fullmatch(word) for word in words]
        if None in corners:
            rule = "a corner must be a node number, alone or with texture and normal numbers as in 7/1/3"
            note(line, f"{rule}, not {shown(words[corners.index(None)])}; correct it")
        sound = [] if None in corners else [corner for corner in corners if corner is not None]
        nodes += [int(corner[1]) for corner in sound]
        normals += [int(corner[2]) if corner[2] and corner[2].strip(b"+-") else 0 for corner in sound]
        counts.append(len(sound))
    return np.array(nodes, np.int64), np.array(normals, np.int64), np.array(counts, np.int64)


def _part_numbers(
    block: bytes, others: Numbers, starts: Numbers, ends: Numbers, polygons: Numbers, statements: Statements
) -> Numbers:
    """The part number of each polygon, from the names in the other lines before it."""
    numbers = np.empty(len(polygons), np.int64)
    done = 0
    before = np.searchsorted(polygons, others).tolist()
    for upto, start, end in zip(before, starts[others].tolist(), ends[others].tolist(), strict=True):
        if upto > done:
            numbers[done:upto] = statements.part_number
            done = upto
        statements.read(block[start:end])
    if len(polygons) > done:
        numbers[done:] = statements.part_number
    return numbers


def _note_missing_nodes(tables: ObjTables, note: Note) -> None:
    """Note the first corner of each polygon that names no node."""
    missing = np.flatnonzero(tables.node_rows < 0)
    polygons = np.searchsorted(np.cumsum(tables.corner_counts), missing, side="right")
    polygons, first = np.unique(polygons, return_index=True)
    count = len(tables.coordinates)
    for corner, polygon in list(zip(missing[first].tolist(), polygons.tolist(), strict=True))[:MOST_PROBLEMS]:
        rule = f"from 1 to {count}" if count else "of the file, which has no nodes"
        if before := tables.nodes_before[polygon]:
            rule += f" or from -{before} to -1"
        number = tables.node_numbers[corner]
        note(int(tables.lines[polygon]), f"a corner must be a node number {rule}, not {number}; correct it")


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

SKIPPED: Final = {
    b"p": "points",
    b"l": "lines",
    **dict.fromkeys(
        b"vp deg bmat step cstype curv curv2 surf parm trim hole scrv sp end con ctech stech".split(),
        "statements of curves and curved surfaces",
    ),
}


class Statements:
    """The current group and material while a file is read, and counts of skipped statements."""

    def __init__(self, file_stem: str) -> None:
        self.file_stem = file_stem
        self.group: str | None = None
        self.material: str | None = None
        self.libraries: list[bytes] = []
        self.numbers: dict[tuple[str | None, str | None], int] = {}
        self.skipped: Counter[str] = Counter()
        self.unknown = ""
        self.has_colors = False

    @property
    def part_number(self) -> int:
        """The part number of the current group and material; a new pair gets the next number."""
        return self.numbers.setdefault((self.group, self.material), len(self.numbers))

    def parts(self) -> dict[str, str | None]:
        """The names of the parts in the order of their numbers, and the material of each, if any."""
        # First give out the names in the file, so that no extended name takes them.
        names: dict[tuple[str | None, str | None], str] = {}
        taken: set[str] = set()
        added = []
        for group, material in self.numbers:
            name = group or material or self.file_stem
            if name in taken:
                added.append((group, material))
            else:
                names[group, material] = name
                taken.add(name)
        for group, material in added:
            name = stem = f"{group} {material}" if group and material else group or material or self.file_stem
            number = 1
            while name in taken:
                number += 1
                name = f"{stem} {number}"
            names[group, material] = name
            taken.add(name)
        return {names[key]: key[1] for key in self.numbers}

    def read(self, line: bytes) -> None:
        """Process a line that is no node, normal or polygon."""
        words = line.split(None, 2)
        if not words or words[0].startswith(b"#"):
            return
        keyword = words[0]
        if keyword == b"g":
            self.group = name_of(words[1]) if len(words) > 1 else None
        elif keyword == b"o":
            self.group = name_of(line.split(None, 1)[1]) if len(words) > 1 else None
        elif keyword == b"usemtl":
            self.material = name_of(line.split(None, 1)[1]) if len(words) > 1 else None
        elif keyword == b"mtllib":
            self.libraries.extend(line.split(None, 1)[1:])
        elif keyword not in UNUSED:
            # Name only the first unknown statement, to keep the report short.
            if keyword not in SKIPPED and not self.unknown:
                self.unknown = f"unknown statements (the first is {shown(keyword)})"
            self.skipped[SKIPPED.get(keyword, self.unknown)] += 1

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
            corner_rows = [
                [
                    f"{node}//{normal + 1}" if normal >= 0 else str(node)
                    for node, normal in zip(*row, strict=True)
                ]
                for row in zip(corner_rows, own.numbers[chunk].tolist(), strict=True)
            ]
        for part, corners in zip(parts, corner_rows, strict=True):
            if part != before:
                yield statement("o", mesh.part_names[part])
                if materials:
                    yield statement("usemtl", materials[part])
                before = part
            a, b, c, d = corners
            yield f"f {a} {b} {c}" if c == d else f"f {a} {b} {c} {d}"
