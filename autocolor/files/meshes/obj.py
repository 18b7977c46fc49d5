"""Meshes in Wavefront OBJ files: read with their materials, and written.

These statements are used: `v` (what follows x y z, such as a weight or a color, is ignored); `f`, with node
numbers that count from 1 or, if negative, back from the latest node (texture and normal numbers are ignored);
`g`, `o` and `usemtl`, which name the parts and their materials; and `mtllib`, which names the libraries of
materials. A polygon may name nodes that are defined later. Quads stay quads, and shared nodes stay shared.

Texture coordinates and normals are ignored. Points, lines, curves and unknown statements are skipped and
counted. Lines may end with LF, CR LF or CR, may be continued with a backslash, and may start with spaces or
tabs.
"""

from __future__ import annotations

import dataclasses
import io
import math
import os
import re
from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PureWindowsPath
from typing import Any, Final

import numpy as np

from autocolor.arrays import Booleans, Bytes, Floats, Indices, Numbers, chunks, half_up
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import MOST_PROBLEMS, NUMBER, Problems
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, name_of, repaired
from autocolor.files.paths import path_within
from autocolor.files.reading import read_bytes, read_whole, shown, text_lines
from autocolor.scene.columns import replaced
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.geometry.polygon_split import MOST_CORNERS
from autocolor.scene.mesh import Mesh
from autocolor.scene.surfaces import Surface

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
    tables = read_plain_obj(data, statements)
    if tables is None or (tables.rows < 0).any():
        del tables
        statements = Statements(path.stem)
        tables = read_obj_lines(data, path.name, statements)
    del data
    parts = statements.parts()
    polygons = RawPolygons(
        tables.coordinates,
        tables.rows,
        tables.corner_counts,
        tables.part_numbers,
        tuple(parts),
        place_of=lambda row: f"line {tables.lines[row]}",
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


LONGEST_LINE: Final = 1 << 20
"""Limit: bytes of one statement, including its continuation lines."""


@dataclass(frozen=True, eq=False)
class ObjTables:
    """The nodes and polygons of an OBJ file.

    `coordinates` is (nodes, 3). `numbers` holds the node numbers of all polygons, concatenated, as in the
    file: from 1, or negative, counted back from the latest node. `corner_counts`, `part_numbers`,
    `nodes_before` (the number of nodes defined before the polygon) and `lines` have one element for each
    polygon.
    """

    coordinates: Floats
    numbers: Numbers
    corner_counts: Numbers
    part_numbers: Numbers
    nodes_before: Numbers
    lines: Numbers

    @cached_property
    def rows(self) -> Indices:
        """The row in `coordinates` of each corner; -1 if there is no such node."""
        rows = self.numbers - 1
        back = np.flatnonzero(self.numbers < 0)
        if len(back):
            rows[back] = np.repeat(self.nodes_before, self.corner_counts)[back] + self.numbers[back]
        rows[(rows < 0) | (rows >= len(self.coordinates))] = -1
        return rows.astype(np.intp, copy=False)


# The fast reader converts large blocks of plain lines to arrays at once.
#
# `read_plain_obj` returns the same tables as `read_obj_lines`. It returns None if the file has an indented
# statement, a comment after numbers, nodes both with and without colors, or any error. Measured: it reads one
# million quads in 1.3 s, the line-by-line reader in 7 s.

BLOCK: Final = 1 << 21
"""Bytes converted at a time: enough for numpy to be efficient, and few enough to save memory."""

NOT_IN_NODES: Final = b"0123456789+-.eE nNaAiIfF v\t\n"
"""Colors may be nan or inf."""

NOT_IN_POLYGONS: Final = b"0123456789-f \t\n"
TEXTURE_AND_NORMAL: Final = re.compile(rb"(?<=[0-9])/-?[0-9]*(?:/-?[0-9]*)?(?=[ \t\n])")


def read_plain_obj(data: bytes, statements: Statements) -> ObjTables | None:
    """The tables of an OBJ file whose lines end with line feeds; None if the file is not plain."""
    if b"\\\n" in data:
        return None
    node_count = 0
    first_line = 1
    nodes = [np.empty((0, 3))]
    tables: list[tuple[Numbers, ...]] = []
    for block in _blocks(data):
        text = np.frombuffer(block, np.uint8)
        ends = np.flatnonzero(text == ord("\n"))
        starts = np.concatenate([[0], ends[:-1] + 1])
        lengths = ends + 1 - starts
        if lengths.max() > LONGEST_LINE:
            return None

        # Classify the lines by their first bytes.
        first, second = text[starts], text[np.minimum(starts + 1, ends)]
        third = text[np.minimum(starts + 2, ends)]
        spaced = (second == ord(" ")) | (second == ord("\t"))
        is_node, is_polygon = (first == ord("v")) & spaced, (first == ord("f")) & spaced
        unused = (first == ord("v")) & ((second == ord("t")) | (second == ord("n"))) & (third <= ord(" "))
        unused |= (first == ord("#")) | (first == ord("\n"))

        coordinates = _coordinates(text, is_node, lengths)
        corners = _corners(text, is_polygon, lengths)
        others = np.flatnonzero(~(is_node | is_polygon | unused))
        polygons = np.flatnonzero(is_polygon)
        parts = _part_numbers(block, others, starts, ends, polygons, statements)
        if coordinates is None or corners is None or parts is None:
            return None
        nodes.append(coordinates)
        nodes_before = node_count + np.cumsum(is_node)[polygons]
        tables.append((*corners, parts, nodes_before, first_line + polygons))
        node_count += len(coordinates)
        first_line += len(ends)
    if not tables:
        return None
    return ObjTables(np.concatenate(nodes), *(np.concatenate(column) for column in zip(*tables, strict=True)))


def _blocks(data: bytes) -> Iterator[bytes]:
    """The file in blocks of complete lines; a line feed is added to the last line if it has none."""
    start = 0
    while start < len(data):
        end = data.find(b"\n", min(start + BLOCK, len(data)))
        block = data[start:] if end < 0 else data[start : end + 1]
        yield block if block.endswith(b"\n") else block + b"\n"
        start += len(block)


def _coordinates(text: Bytes, chosen: Booleans, lengths: Numbers) -> Floats | None:
    """The first three numbers of each chosen line, (n, 3); None if the lines are not plain.

    All lines must have the same number of numbers.
    """
    lines = text[np.repeat(chosen, lengths)]
    if not len(lines):
        return np.empty((0, 3))
    plain = lines.tobytes()
    counts = _words_a_line(lines)
    if plain.translate(None, NOT_IN_NODES) or plain.count(b"v") != len(counts):
        return None
    if counts[0] < 4 or (counts != counts[0]).any():
        return None
    words = plain.replace(b"v", b" ").decode("ascii").split()
    try:
        numbers = np.fromiter(map(float, words), np.float64, len(words))
    except ValueError:
        return None
    if counts[0] == 5 and not np.isfinite(numbers).all():
        return None
    coordinates = np.ascontiguousarray(numbers.reshape(len(counts), -1)[:, :3])
    return coordinates if (np.abs(coordinates) <= LARGEST_COORDINATE).all() else None


def _corners(text: Bytes, chosen: Booleans, lengths: Numbers) -> tuple[Numbers, Numbers] | None:
    """The node numbers of the chosen lines, and their count in each line; None if the lines are not plain."""
    lines = text[np.repeat(chosen, lengths)]
    if not len(lines):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    plain = lines.tobytes()
    if b"/" in plain:
        plain = TEXTURE_AND_NORMAL.sub(b"", plain)
        lines = np.frombuffer(plain, np.uint8)
    counts = _words_a_line(lines) - 1
    if plain.translate(None, NOT_IN_POLYGONS) or plain.count(b"f") != len(counts):
        return None
    if counts.max() > MOST_CORNERS:
        return None
    plain = plain.replace(b"f", b" ")
    if b"-" not in plain:
        # Measured: a seventh of the time of converting word by word. With digits alone, parsing cannot stop
        # early; a number that is too large becomes one that no node has, and no number at all becomes a 0.
        return np.fromstring(plain, np.int64, sep=" ")[: int(counts.sum())], counts
    words = plain.decode("ascii").split()
    try:
        return np.fromiter(map(int, words), np.int64, len(words)), counts
    except (ValueError, OverflowError):
        return None


def _words_a_line(lines: Bytes) -> Numbers:
    """The number of words in each line."""
    spaces = lines <= ord(" ")
    starts = ~spaces
    starts[1:] &= spaces[:-1]
    ends = np.flatnonzero(lines == ord("\n"))
    return np.add.reduceat(starts, np.concatenate([[0], ends[:-1] + 1]), dtype=np.int64)


def _part_numbers(
    block: bytes,
    others: Numbers,
    starts: Numbers,
    ends: Numbers,
    polygons: Numbers,
    statements: Statements,
) -> Numbers | None:
    """The part number of each polygon, from the names in the lines before it.

    None if another line is a node or a polygon, such as an indented one.
    """
    numbers = np.empty(len(polygons), np.int64)
    done = 0
    before = np.searchsorted(polygons, others).tolist()
    for upto, start, end in zip(before, starts[others].tolist(), ends[others].tolist(), strict=True):
        if upto > done:
            numbers[done:upto] = statements.part_number
            done = upto
        if not statements.read(block[start:end]):
            return None
    if len(polygons) > done:
        numbers[done:] = statements.part_number
    return numbers


# The patient reader goes line by line, and reports every problem with its line.

CORNER: Final = re.compile(rb"([+-]?[0-9]{1,18})(?:/[+-]?[0-9]*){0,2}")


class ObjLines:
    """Collects the tables and the problems of one file."""

    def __init__(self, place: str, statements: Statements) -> None:
        self.place = place
        self.statements = statements
        self.problems = Problems("line")
        self.coordinates = array("d")
        self.numbers = array("q")
        self.corner_counts = array("q")
        self.part_numbers = array("q")
        self.nodes_before = array("q")
        self.lines = array("q")
        self.line = 0

    def problem(self, sentence: str) -> None:
        """Note a problem of the current line."""
        self.problems.note(self.place, self.line, sentence)

    def node(self, words: list[bytes]) -> None:
        """Read the words after `v`: x y z. What follows is ignored, but a single weight must be a number."""
        if len(words) < 3:
            self.problem(f"a node must have three coordinates x y z, not {len(words)}; add what is missing")
            words = [*words, b"0", b"0", b"0"][:3]
        for row, word in enumerate(words[: 4 if len(words) == 4 else 3]):
            number = float(word) if NUMBER.fullmatch(word) else math.nan
            if row < 3 and not abs(number) <= LARGEST_COORDINATE:
                rule = "a coordinate must be a decimal number of at most 1e30 in size"
                self.problem(f"{rule}, not {shown(word)}; correct it")
            elif math.isnan(number):
                self.problem(f"the weight of a node must be a decimal number, not {shown(word)}; correct it")
            if row < 3:
                self.coordinates.append(number)

    def polygon(self, words: list[bytes]) -> None:
        """Read the words after `f`: corners. Their texture and normal numbers are ignored."""
        if len(words) > MOST_CORNERS:
            self.problem(
                f"a polygon must have at most {MOST_CORNERS:,} corners, not {len(words):,}; split it"
            )
            return
        for word in words:
            corner = CORNER.fullmatch(word)
            if corner is None:
                self.problem(
                    "a corner must be a node number, alone or with texture and normal numbers as in 7/1/3,"
                    f" not {shown(word)}; correct it"
                )
                return
        self.numbers.extend(int(word.split(b"/", 1)[0]) for word in words)
        self.corner_counts.append(len(words))
        self.part_numbers.append(self.statements.part_number)
        self.nodes_before.append(len(self.coordinates) // 3)
        self.lines.append(self.line)

    def tables(self) -> ObjTables:
        """The tables. Raises InputError if there was a problem or a corner names no node."""
        count = len(self.coordinates) // 3
        tables = ObjTables(
            np.array(self.coordinates).reshape(count, 3),
            *(
                np.frombuffer(column, np.int64) if column else np.empty(0, np.int64)
                for column in (
                    self.numbers,
                    self.corner_counts,
                    self.part_numbers,
                    self.nodes_before,
                    self.lines,
                )
            ),
        )
        missing = np.flatnonzero(tables.rows < 0)[: MOST_PROBLEMS * MOST_CORNERS]
        polygons = np.searchsorted(np.cumsum(tables.corner_counts), missing, side="right")
        polygons, first = np.unique(polygons, return_index=True)
        for corner, polygon in zip(missing[first].tolist(), polygons.tolist(), strict=True):
            self.line = self.lines[polygon]
            rule = f"from 1 to {count}" if count else "of the file, which has no nodes"
            if before := self.nodes_before[polygon]:
                rule += f" or from -{before} to -1"
            self.problem(f"a corner must be a node number {rule}, not {self.numbers[corner]}; correct it")
        self.problems.raise_any()
        return tables


def read_obj_lines(data: bytes, place: str, statements: Statements) -> ObjTables:
    """The tables of an OBJ file whose lines end with line feeds; `place` is its name in messages.

    Raises InputError with every problem, up to MOST_PROBLEMS.
    """
    reader = ObjLines(place, statements)
    for number, line in _statements(data, reader):
        reader.line = number
        if statements.read(line):
            continue
        words = line.split(b"#", 1)[0].split()
        if words[0] == b"v":
            reader.node(words[1:])
        else:
            reader.polygon(words[1:])
    return reader.tables()


def _statements(data: bytes, reader: ObjLines) -> Iterator[tuple[int, bytes]]:
    """Each statement and the number of its first line; a backslash at the end of a line continues it."""
    begun: list[bytes] = []
    first = size = 0
    for number, line in enumerate(io.BytesIO(data), start=1):
        first = first if begun else number
        size = size + len(line) if begun else len(line)
        if size > LONGEST_LINE:
            reader.line = first
            reader.problem(f"a line must have at most {LONGEST_LINE:,} bytes, not {size:,}; split it")
            reader.problems.raise_any()
        if line.endswith(b"\\\n"):
            begun.append(line[:-2])
            continue
        yield first, b" ".join([*begun, line]) if begun else line
        begun = []
    if begun:
        yield first, b" ".join(begun)


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

    def read(self, line: bytes) -> bool:
        """Process one line; returns False if it is a node or a polygon, which the caller must read."""
        words = line.split(None, 2)
        if not words or words[0].startswith(b"#"):
            return True
        keyword = words[0]
        if keyword in (b"v", b"f"):
            return False
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
        return True

    @property
    def sentences(self) -> tuple[str, ...]:
        """Messages about what was skipped."""
        return tuple(f"skipped {what}: {count:,}" for what, count in self.skipped.items())


# Material libraries of OBJ files (MTL): the surfaces that their materials describe.
#
# These statements are used: `newmtl` begins a material; `Kd` is the object color; the largest component of
# `Ks` is S, the specular reflectance, which is 0 without such a statement or where `illum` is 0 or 1; `Ns`
# is N, the exponent, at least 1. A material without specular reflectance keeps its object color at every
# level. D stays the default, because `Kd` is a color and no intensity. Textures and transparency are left
# out, and the report says so. Everything else is ignored.
#
# A library must be in the folder of the OBJ file, or below it. A library with another path, such as an
# absolute path, is looked for in the folder by its file name. The mesh is read despite problems in a library,
# and the report mentions them.

LARGEST_LIBRARIES: Final = 4 * 1024 * 1024
"""Limit: bytes of all libraries of a file, enough for ten thousand materials."""

MOST_LIBRARIES: Final = 100
MOST_LIBRARY_PROBLEMS: Final = 5
"""Limit: problems that are reported of one library; the others are counted."""

MOST_WORDS: Final = 8
"""Limit: words of a line that are read."""

LARGEST: Final = 1e6
"""Limit: above every coefficient and exponent of a material."""

TEXTURES: Final = re.compile(rb"map_\w+|bump|disp|decal|refl|norm", re.IGNORECASE)
TRANSPARENCY: Final = {b"d": 1.0, b"Tr": 0.0}
"""The statements of transparency, and their values for an opaque material."""

USED: Final = (b"Kd", b"Ks", b"Ns", b"illum")

WITHOUT_HIGHLIGHT: Final = (0.0, 1.0)
"""The illumination models, `illum`, in which nothing reflects specularly."""

LEAST_EXPONENT: Final = 1.0
"""Assumed: some programs write 0 for the roughest material, which would be a highlight all over."""


def read_materials(
    obj: Path, libraries: Sequence[bytes], wanted: Sequence[str]
) -> tuple[tuple[Surface, ...], tuple[str, ...]]:
    """The surfaces of the materials in `wanted`, and messages about what was left out or wrong.

    `libraries` are the arguments of its `mtllib` statements. If there is no such file, a file beside it with
    the same name and the suffix .mtl is read. If a material is defined twice, the first definition counts.
    """
    if not wanted:
        return (), ()
    missing: list[bytes] = []
    paths = _paths(obj, libraries, missing)
    sentences: list[str] = []
    surface_of: dict[str, Surface] = {}
    left = LARGEST_LIBRARIES
    for path in paths:
        if len(surface_of) == len(wanted):
            break
        try:
            data = read_bytes(path, left)
            left -= len(data)
            data = text_lines(data, path.name, "a material library")
        except InputError as error:
            sentences.append(f"the materials have default colors: {error}")
            continue
        surfaces, notes = materials_of(data, path.name, set(wanted))
        surface_of = {**surfaces, **surface_of}
        sentences.extend(notes)
    sentences.extend(
        f"the materials have default colors: there is no library {shown(name)} in the folder of {obj.name};"
        " copy it there"
        for name in missing[:MOST_LIBRARY_PROBLEMS]
    )
    undefined = [name for name in wanted if name not in surface_of]
    if surface_of and undefined:
        more = f" and {len(undefined) - 3:,} more" if len(undefined) > 3 else ""
        names = ", ".join(shown(name) for name in undefined[:3])
        sentences.append(f"no library defines material {names}{more}; default colors are used")
    return tuple(surface_of[name] for name in wanted if name in surface_of), tuple(sentences)


def _paths(obj: Path, libraries: Sequence[bytes], missing: list[bytes]) -> list[Path]:
    """The paths of the libraries, at most MOST_LIBRARIES; arguments without a file are added to `missing`."""
    folder = obj.parent
    paths: dict[str, Path] = {}
    for library in dict.fromkeys(libraries[:MOST_LIBRARIES]):
        # The argument is one name with spaces, or several names.
        path = _path(folder, library)
        several = [path] if path else [_path(folder, name) for name in library.split()[:MOST_LIBRARIES]]
        if not any(several):
            missing.append(library)
        paths.update({os.path.realpath(path): path for path in several if path is not None})
    if not paths:
        beside = _path(folder, os.fsencode(f"{obj.stem}.mtl"))
        paths = {} if beside is None else {"": beside}
        # The library may have been renamed together with the OBJ file.
        if beside is not None:
            missing.clear()
    return list(paths.values())[:MOST_LIBRARIES]


def _path(folder: Path, name: bytes) -> Path | None:
    """The path of a library within the folder; None if there is no such file."""
    text = name_of(name.strip().strip(b'"'))
    for candidate in dict.fromkeys((text, text.replace("\\", "/"), PureWindowsPath(text).name)):
        path = path_within([], folder, candidate)
        try:
            if path is not None and path.is_file():
                return path
        except (OSError, ValueError):
            pass
    return None


def materials_of(data: bytes, place: str, wanted: set[str]) -> tuple[Mapping[str, Surface], list[str]]:
    """The surfaces of the materials in `wanted` that a library defines, and what was left out or wrong."""
    problems: list[str] = []
    more_problems = 0
    textured: set[str] = set()
    transparent: set[str] = set()
    tables: dict[str, dict[bytes, list[float]]] = {}
    name, table = "", dict[bytes, list[float]]()
    for number, line in enumerate(io.BytesIO(data), start=1):
        words = line.split(b"#", 1)[0].split(None, MOST_WORDS)
        if not words:
            continue
        keyword = words[0]
        if keyword == b"newmtl":
            name = name_of(line.split(None, 1)[1]) if len(words) > 1 else ""
            table = tables.setdefault(name, {}) if name in wanted and name not in tables else {}
        elif keyword in USED or keyword in TRANSPARENCY:
            values = _numbers(words[1:], math.inf if keyword == b"Kd" else LARGEST)
            if values is None and len(problems) < MOST_LIBRARY_PROBLEMS:
                problems.append(
                    f"{place}, line {number}: {keyword.decode()} must have one number or three, from 0 to"
                    f" {LARGEST:g}, not {shown(b' '.join(words[1:]))}; the default is used"
                )
            elif values is None:
                more_problems += 1
            elif keyword in USED:
                table[keyword] = values
            elif values[0] != TRANSPARENCY[keyword]:
                transparent.add(name)
        elif TEXTURES.fullmatch(keyword):
            textured.add(name)
    left_out = (("the textures", textured & wanted), ("the transparency", transparent & wanted))
    sentences = [
        f"{place}: left out {what} of {len(names):,} material{'s' if len(names) > 1 else ''}"
        for what, names in left_out
        if names
    ]
    sentences.extend(problems)
    if more_problems:
        sentences.append(f"{place}: {more_problems:,} more such lines")
    return {name: _surface(name, values) for name, values in tables.items()}, sentences


def _numbers(words: list[bytes], most: float) -> list[float] | None:
    """The numbers of a statement, one or three; None if one is below 0 or not below `most`."""
    words = words[:3]
    if len(words) == 2 or not words or not all(NUMBER.fullmatch(word) for word in words):
        return None
    numbers = [float(word) for word in words]
    return numbers if all(0 <= number < most for number in numbers) else None


def _surface(name: str, values: Mapping[bytes, list[float]]) -> Surface:
    """The surface of a material; properties that it does not define have their defaults."""
    changes: dict[str, Any] = {}
    if b"Kd" in values:
        parts = [min(half_up(255 * min(part, 1.0)), 255) for part in values[b"Kd"]]
        changes["object_color"] = parts * 3 if len(parts) == 1 else parts
    has_highlight = values.get(b"illum", [2.0])[0] not in WITHOUT_HIGHLIGHT
    changes["specular"] = max(values.get(b"Ks", [0.0])) if has_highlight else 0.0
    if changes["specular"] == 0:
        changes["blend"] = 1.0
    if b"Ns" in values:
        changes["exponent"] = max(values[b"Ns"][0], LEAST_EXPONENT)
    return replaced(created_surface(name, COLORED_PAINT.object_color), changes)


ROWS_AT_ONCE: Final = 1 << 16
"""Rows that become text at once, so that there are few Python values at a time."""


def obj_text(mesh: Mesh, materials: Sequence[str] = (), library: str = "") -> bytes:
    """The mesh as an OBJ file in UTF-8, with an `o` for each part; its numbers read back equal.

    `materials` are the names of the materials of the parts, if any, and `library` is the file of materials.
    Reading it back gives the same mesh unless the reader repairs it: a polygon without area is dropped, parts
    are those of polygons and in their order, and names are printable, with no spaces around them.
    """
    return "\n".join(_lines(mesh, materials, library)).encode("utf-8", "replace") + b"\n"


def mtl_text(surfaces: Iterable[tuple[str, Surface]]) -> bytes:
    """Surfaces, each with the name of its material, as a material library that `read_obj` reads back.

    Diffuse reflectance, light color and other properties that a material does not have are left out.
    """
    lines = []
    for name, surface in surfaces:
        color = " ".join(f"{component / 255:.6g}" for component in surface.paint.color)
        specular = surface.reflectance.specular
        exponent = vars(surface.reflectance.model).get("exponent")
        lines += [_statement("newmtl", name), f"Kd {color}", f"Ks {specular!r} {specular!r} {specular!r}"]
        lines += ["illum 2"] if exponent is None else [f"Ns {exponent!r}", "illum 2"]
    return "\n".join([*lines, ""]).encode("utf-8", "replace")


def _statement(keyword: str, name: str) -> str:
    """The line that names something; a space after a last backslash keeps it from continuing the line."""
    return f"{keyword} {name} " if name.endswith("\\") else f"{keyword} {name}"


def _lines(mesh: Mesh, materials: Sequence[str], library: str) -> Iterator[str]:
    """The lines of nodes, then those of polygons, with the name of a part wherever it changes."""
    if library:
        yield f"mtllib {library}"
    for chunk in chunks(len(mesh.coordinates), ROWS_AT_ONCE):
        for x, y, z in mesh.coordinates[chunk].tolist():
            yield f"v {x!r} {y!r} {z!r}"
    before = -1
    for chunk in chunks(len(mesh.node_numbers), ROWS_AT_ONCE):
        parts = mesh.part_numbers[chunk].tolist()
        for part, corners in zip(parts, (mesh.node_numbers[chunk] + 1).tolist(), strict=True):
            if part != before:
                yield _statement("o", mesh.part_names[part])
                if materials:
                    yield _statement("usemtl", materials[part])
                before = part
            a, b, c, d = corners
            yield f"f {a} {b} {c}" if c == d else f"f {a} {b} {c} {d}"
