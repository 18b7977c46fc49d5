"""The data of nodes and cells in legacy VTK files: POINT_DATA and CELL_DATA.

Scalars, vectors, tensors and the arrays of fields are taken as `found_scalars` says. Normals, texture
coordinates, colors, numbers for identification, bits and texts are skipped.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final
from urllib.parse import unquote_to_bytes

from autocolor.arrays import Indices
from autocolor.errors import InputError
from autocolor.files.meshes.vtk.cursor import VtkCursor
from autocolor.files.reading import shown
from autocolor.files.repair.found_scalars import FoundScalars
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON

TABLES: Final = {b"POINT_DATA": NODE, b"CELL_DATA": POLYGON}

COMPONENTS: Final = {b"VECTORS": 3, b"TENSORS": 9, b"TENSORS6": 6}

IGNORED: Final = {b"NORMALS": 3, b"GLOBAL_IDS": 1, b"PEDIGREE_IDS": 1, b"EDGE_FLAGS": 1}

BITS: Final = b"bit"
STRING: Final = b"string"

MOST_ARRAYS: Final = 100_000


class Attributes:
    """Reads the data; `rows` are the rows of the nodes and of the polygons that are kept."""

    def __init__(self, cursor: VtkCursor, counts: Mapping[str, int], rows: Mapping[str, Indices]) -> None:
        self.cursor = cursor
        self.counts = counts
        self.rows = rows
        self.found = FoundScalars()
        self.of: str | None = None
        self.skipped: dict[str, int] = {}

    def read(self) -> None:
        """Read all data to the end of the file. Raises InputError.

        What follows an unknown keyword is skipped, since its size is not known.
        """
        while words := self.cursor.words():
            keyword = words[0].upper()
            if keyword in TABLES:
                self._begin(TABLES[keyword], words)
            elif keyword == b"METADATA":
                self.cursor.skip_metadata()
            elif keyword == b"FIELD":
                self.field(words)
            elif not self._attribute(keyword, words):
                self.found.sentences.append(f"skipped all from the unknown keyword {shown(words[0])} on")
                return

    @property
    def messages(self) -> tuple[str, ...]:
        """Sentences about what was left out."""
        skipped = (f"skipped {what}: {count:,}" for what, count in self.skipped.items())
        return (*self.found.messages, *skipped)

    def _begin(self, of: str, words: list[bytes]) -> None:
        """Begin the data of a table, whose count must be that of its rows."""
        what = words[0].decode("latin-1").upper()
        count = self.cursor.count(words[1] if len(words) > 1 else b"", f"the count of {what}")
        if count != self.counts[of]:
            raise InputError(
                f"{self.cursor.where}: {what} must be for all {self.counts[of]:,} of the file, not {count:,};"
                " correct the count"
            )
        self.of = of

    def _attribute(self, keyword: bytes, words: list[bytes]) -> bool:
        """Read one attribute; False if its keyword is unknown."""
        known = (b"SCALARS", b"COLOR_SCALARS", b"LOOKUP_TABLE", b"TEXTURE_COORDINATES")
        if keyword not in (*known, *COMPONENTS, *IGNORED):
            return False
        least = 3 if keyword not in known else {b"SCALARS": 3, b"TEXTURE_COORDINATES": 4}.get(keyword, 3)
        if len(words) < least:
            raise InputError(
                f"{self.cursor.where}: {words[0].decode('latin-1')} must be followed by {least - 1} words,"
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
        """Read the arrays of a field; those that do not belong to nodes or cells are skipped."""
        cursor = self.cursor
        arrays = cursor.count(words[2] if len(words) > 2 else b"", "the number of arrays of a FIELD")
        if arrays > MOST_ARRAYS:
            raise InputError(
                f"{cursor.where}: a FIELD must have at most {MOST_ARRAYS:,} arrays, not {arrays:,}; leave"
                " some out"
            )
        while arrays:
            header = cursor.words()
            if header and header[0].upper() == b"METADATA":
                cursor.skip_metadata()
                continue
            if len(header) < 4:
                raise InputError(
                    f"{cursor.where}: an array of a FIELD must have a name, two counts and a type, not"
                    f" {shown(b' '.join(header))}; correct it"
                )
            width, rows = (cursor.count(word, "a count of an array of a FIELD") for word in header[1:3])
            self._array(header[0], rows, width, header[3])
            arrays -= 1

    def _array(self, name: bytes, rows: int, width: int, kind: bytes, ignored: str = "") -> None:
        """Read one array, which is a scalar unless it is `ignored` or of another size."""
        cursor, kind = self.cursor, kind.lower()
        if kind == BITS:
            ignored = "arrays of bits"
        if kind == STRING:
            ignored = "arrays of texts"
            self._skip_texts(rows * width)
        elif kind == BITS and cursor.text is None:
            cursor.array(-(-rows * width // 8), b"unsigned_char", "bits")
        else:
            what = f"array {shown(name)}"
            values = cursor.array(rows * width, b"int" if kind == BITS else kind, what)
            if not ignored and (self.of is None or rows != self.counts[self.of]):
                ignored = "arrays that are of no node or cell"
            if not ignored and rows and width:
                assert self.of is not None
                text = unquote_to_bytes(name).decode("utf-8", "replace")
                self.found.add(text, values.reshape(rows, width), self.of, self.rows[self.of])
                return
        ignored = ignored or "empty arrays"
        self.skipped[ignored] = self.skipped.get(ignored, 0) + 1

    def _skip(self, count: int, in_text: bytes, in_binary: bytes, what: str) -> None:
        self.cursor.array(count, in_binary if self.cursor.text is None else in_text, what)
        self.skipped[what] = self.skipped.get(what, 0) + 1

    def _skip_texts(self, count: int) -> None:
        """Go past texts: lines, or in binary each after its length, of which two bits tell the size."""
        cursor = self.cursor
        for _ in range(count):
            if cursor.at >= len(cursor.data):
                raise InputError(
                    f"{cursor.where}: there must be {count:,} texts, not fewer; correct the count"
                )
            if cursor.text is not None:
                cursor.raw_line()
                continue
            size = {3: 1, 2: 2, 1: 4, 0: 8}[cursor.data[cursor.at] >> 6]
            head = int.from_bytes(cursor.data[cursor.at : cursor.at + size], "big")
            length = head & ((1 << (8 * size - 2)) - 1)
            cursor.at = min(cursor.at + size + length, len(cursor.data))
