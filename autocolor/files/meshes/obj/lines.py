"""The line-by-line OBJ reader, which reports every problem with its line."""

from __future__ import annotations

import io
import math
import re
from array import array
from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.obj.statements import Statements
from autocolor.files.meshes.obj.tables import LONGEST_LINE, ObjTables
from autocolor.files.reading import shown
from autocolor.scene.geometry.polygon_split import MOST_CORNERS

MOST_PROBLEMS: Final = 20
"""Assumed: problems reported for one mesh file; a file with more usually repeats the same one."""

NUMBER: Final = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
CORNER: Final = re.compile(rb"([+-]?[0-9]{1,18})(?:/[+-]?[0-9]*){0,2}")


class ObjLines:
    """Collects the tables and the problems of one file."""

    def __init__(self, place: str, statements: Statements) -> None:
        self.place = place
        self.statements = statements
        self.problems: list[tuple[int, str]] = []
        self.coordinates = array("d")
        self.numbers = array("q")
        self.corner_counts = array("q")
        self.part_numbers = array("q")
        self.nodes_before = array("q")
        self.polygon_lines = array("q")
        self.line = 0

    def problem(self, sentence: str) -> None:
        """Add a problem of the current line; raise InputError once there are MOST_PROBLEMS."""
        self.problems.append((self.line, f"{self.place}, line {self.line}: {sentence}"))
        if len(self.problems) >= MOST_PROBLEMS:
            self.raise_any()

    def raise_any(self) -> None:
        """Raise InputError with the problems found so far, if any, in line order."""
        if self.problems:
            raise InputError([sentence for _, sentence in sorted(self.problems)])

    def node(self, words: list[bytes]) -> None:
        """Read the words after `v`: x y z. A weight or color that follows must be numeric and is ignored."""
        if len(words) < 3:
            self.problem(f"a node must have three coordinates x y z, not {len(words)}; add what is missing")
            words = [*words, b"0", b"0", b"0"][:3]
        for row, word in enumerate(words):
            number = float(word) if NUMBER.fullmatch(word) else math.nan
            if row < 3 and not abs(number) <= LARGEST_COORDINATE:
                rule = "a coordinate must be a decimal number of at most 1e30 in size"
                self.problem(f"{rule}, not {shown(word)}; correct it")
            elif math.isnan(number):
                self.problem(f"what follows x y z must be decimal numbers, not {shown(word)}; correct it")
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
        self.polygon_lines.append(self.line)

    def tables(self) -> ObjTables:
        """The tables. Raises InputError if there was a problem or a corner names no node."""
        count = len(self.coordinates) // 3
        tables = ObjTables(
            np.array(self.coordinates).reshape(count, 3),
            *(
                np.frombuffer(column, np.int64) if column else np.empty(0, np.int64)
                for column in (self.numbers, self.corner_counts, self.part_numbers, self.nodes_before)
            ),
        )
        missing = np.flatnonzero(tables.rows < 0)[: MOST_PROBLEMS * MOST_CORNERS]
        polygons = np.searchsorted(np.cumsum(tables.corner_counts), missing, side="right")
        polygons, first = np.unique(polygons, return_index=True)
        for corner, polygon in zip(missing[first].tolist(), polygons.tolist(), strict=True):
            self.line = self.polygon_lines[polygon]
            rule = f"from 1 to {count}" if count else "of a node in the file, which has none"
            if before := self.nodes_before[polygon]:
                rule += f" or from -{before} to -1"
            self.problem(f"a corner must be a node number {rule}, not {self.numbers[corner]}; correct it")
        self.raise_any()
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
            reader.raise_any()
        if line.endswith(b"\\\n"):
            begun.append(line[:-2])
            continue
        yield first, b" ".join([*begun, line]) if begun else line
        begun = []
    if begun:
        yield first, b" ".join(begun)
