"""Reading a mesh from a VTP file: VTK's XML format of polygons, which PyVista writes by default.

- Numbers are text, base64, or appended after the document as base64 or raw bytes, in either byte order. They
  may be compressed with zlib or LZMA. LZ4 is refused, because Python cannot unpack it.
- Polygons and triangle strips are read; vertices and lines are skipped and counted. All pieces of a file are
  one mesh and one part, of the file's name.
- The data of points and cells are scalars of the mesh (see `file_scalars`). Normals, texture coordinates,
  colors, numbers for identification, bits and texts are skipped and counted.

A document with a DOCTYPE is refused, so it has no entities that could grow.
"""

from __future__ import annotations

import binascii
import re
import zlib
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Final
from xml.parsers import expat

import numpy as np

from autocolor.arrays import AnyArray, Floats
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE
from autocolor.errors import InputError
from autocolor.files.meshes.cells import Flats
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.number_text import NumberText
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.meshes.vtk_cells import (
    POLYGON_CELL,
    SKIPPED,
    STRIP_CELL,
    CellLists,
    VtkCells,
    add_cells,
    require_nodes,
)
from autocolor.files.reading import read_whole, shown, text_problem
from autocolor.scene.scalar import NODE, POLYGON

GROWTH: Final = 10
"""Measured: a binary file takes 5 to 8 times its size, and a text 4; with scalars of single bytes, more."""

BEGINNING: Final = re.compile(
    rb"\s*(?:<\?xml[^<>]*>\s*)?(?><!--.*?-->\s*)*+<VTKFile\s[^<>]*type=[\"']PolyData", re.DOTALL
)


def read_vtp(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a VTP file with its scalars, and what was repaired or skipped. Raises InputError."""
    file = VtpFile(read_whole(path, GROWTH), path.name)
    coordinates: list[Floats] = []
    cells, nodes = VtkCells(), 0
    for piece in file.document.pieces:
        count = piece.count("Points")
        coordinates.append(file.coordinates(piece, count))
        for section, kind in CELLS.items():
            number = piece.count(section)
            if kind in SKIPPED:
                cells.skipped[SKIPPED[kind]] += number
                cells.count += number
            elif number:
                lists = file.cell_lists(piece, section, number, count)
                add_cells(cells, path.name, lists._replace(numbers=lists.numbers + nodes), kind)
        nodes += count
    flats = Flats.joined(cells.flats)
    scalars = FileScalars()
    for of, section, rows in ((NODE, "PointData", None), (POLYGON, "CellData", flats.cells)):
        for name, values in file.data_of(section):
            scalars.add(name, values, of, rows)
    table = RawPolygons(
        np.concatenate([np.empty((0, 3)), *coordinates]),
        flats.corners,
        flats.corner_counts,
        np.zeros(len(flats.cells), np.intp),
        (path.stem,),
        scalars.scalars,
    )
    skipped = (f"skipped {what}: {count:,}" for what, count in file.document.skipped.items())
    return repaired(table, path.name, placement, skipped=(*cells.sentences, *scalars.messages, *skipped))


def begins_as_vtp(head: bytes) -> bool:
    """Whether a file begins as a VTP file does."""
    return BEGINNING.match(head) is not None


# The document: its elements, and where their text is in the file.

MOST_ELEMENTS: Final = 100_000
"""Limit: elements of a file."""

LONGEST_TAG: Final = 1 << 16
"""Limit: bytes of a tag with its attributes."""

OVERLONG_TAG: Final = re.compile(rb"<[^<>]{%d}" % LONGEST_TAG)
APPENDED_DATA: Final = re.compile(rb"<AppendedData[^<>]*>(?=\s*_)")

IGNORED: Final = {
    "Normals": "normals",
    "Tangents": "tangents",
    "TCoords": "texture coordinates",
    "GlobalIds": "arrays of numbers for identification",
    "PedigreeIds": "arrays of numbers for identification",
    "EdgeFlag": "arrays of numbers for identification",
}
"""The roles of arrays that are skipped. The attributes of an element name the arrays of each role."""


@dataclass
class DataArray:
    """An element of numbers: its attributes, the line of its text, and where its text is in the file."""

    attributes: Mapping[str, str]
    line: int
    texts: list[slice] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The name, empty if it has none."""
        return self.attributes.get("Name", "")


@dataclass
class Piece:
    """A piece of the data: its attributes, and its arrays by section and name.

    It has at most `most` points or cells of a kind.
    """

    attributes: Mapping[str, str]
    place: str
    most: int
    sections: dict[str, dict[str, DataArray]] = field(default_factory=dict)

    def count(self, section: str) -> int:
        """The number of points or cells that the piece has in a section. Raises InputError."""
        text = self.attributes.get(f"NumberOf{section}", "0").strip()
        if not (text.isascii() and text.isdigit() and len(text) <= 18 and int(text) <= self.most):
            raise InputError(
                f"{self.place}: NumberOf{section} must be a whole number from 0 to {self.most:,}, for the"
                f" size of the file, not {shown(text)}; correct it"
            )
        return int(text)


class Document:
    """The elements of a file, up to the appended data. Raises InputError if they are no PolyData."""

    def __init__(self, data: bytes, name: str) -> None:
        self.name = name
        self.size = len(data)
        self.root: Mapping[str, str] = {}
        self.pieces: list[Piece] = []
        self.encoding = ""
        self.skipped: Counter[str] = Counter()
        self._path: list[str] = []
        self._elements = 0
        self._array: DataArray | None = None
        self._ignored: dict[str, str] = {}
        self._text_start: int | None = None
        start = data.find(b"<AppendedData")
        tag = None if start < 0 else APPENDED_DATA.match(data, start)
        if start >= 0 and tag is None:
            raise InputError(f"{name}: AppendedData must begin with '_'; write the file again")
        end = len(data) if tag is None else tag.end()
        self.appended_start = end if tag is None else data.index(b"_", end) + 1
        if problem := text_problem(data[:end]):
            raise InputError(f"{name}: a VTP file {problem}")
        if overlong := OVERLONG_TAG.search(data, 0, end):
            line = data.count(b"\n", 0, overlong.start()) + 1
            raise InputError(
                f"{name}, line {line}: a tag must have at most {LONGEST_TAG:,} bytes, not more; correct it"
            )
        self._parser = parser = expat.ParserCreate("UTF-8")
        parser.StartDoctypeDeclHandler = self._refuse_doctype
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        try:
            parser.Parse(data[:end], tag is None)
        except expat.ExpatError as error:
            reason = expat.ErrorString(error.code)
            raise InputError(
                f"{name}, line {error.lineno}: a VTP file must be XML ({reason}); write it again"
            ) from None

    def _refuse_doctype(self, *_: object) -> None:
        raise self._error("a VTP file must have no DOCTYPE; remove it")

    def _error(self, sentence: str) -> InputError:
        return InputError(f"{self.name}, line {self._parser.CurrentLineNumber}: {sentence}")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._end_text()
        self._elements += 1
        if self._elements > MOST_ELEMENTS:
            raise self._error(
                f"a VTP file must have at most {MOST_ELEMENTS:,} elements, not more; simplify it"
            )
        self._path.append(tag)
        match self._path:
            case [_]:
                kind = attributes.get("type", "")
                if tag != "VTKFile" or kind != "PolyData":
                    raise self._error(
                        f"it must be a VTKFile of type 'PolyData', not {shown(tag)} of type {shown(kind)};"
                        " take its surface"
                    )
                self.root = attributes
            case ["VTKFile", "AppendedData"]:
                self.encoding = attributes.get("encoding", "")
            case ["VTKFile", "PolyData", "Piece"]:
                place = f"{self.name}, line {self._parser.CurrentLineNumber}"
                self.pieces.append(Piece(attributes, place, LARGEST_GROWTH * self.size))
            case ["VTKFile", "PolyData", "Piece", section]:
                self.pieces[-1].sections.setdefault(section, {})
                self._ignored = {attributes[role]: IGNORED[role] for role in IGNORED if role in attributes}
            case ["VTKFile", "PolyData", *_, "FieldData", _]:
                self.skipped["arrays that are of no node or cell"] += 1
            case ["VTKFile", "PolyData", "Piece", section, "DataArray" | "Array"]:
                array = DataArray(attributes, self._parser.CurrentLineNumber)
                if ignored := self._ignored.get(array.name, _ignored(tag, attributes)):
                    self.skipped[ignored] += 1
                else:
                    self.pieces[-1].sections[section][array.name] = self._array = array
                    self._parser.CharacterDataHandler = self._start_text

    def _end(self, _: str) -> None:
        self._end_text()
        self._path.pop()
        if self._array is not None and len(self._path) < 5:
            self._array = self._parser.CharacterDataHandler = None
        elif self._array is not None and len(self._path) == 5:
            self._parser.CharacterDataHandler = self._start_text

    def _start_text(self, _: str) -> None:
        """Note where a text begins: the parser then passes over the rest of the text at its own speed."""
        assert self._array is not None
        self._text_start = self._parser.CurrentByteIndex
        if not self._array.texts:
            self._array.line = self._parser.CurrentLineNumber
        self._parser.CharacterDataHandler = None

    def _end_text(self) -> None:
        if self._array is not None and self._text_start is not None:
            self._array.texts.append(slice(self._text_start, self._parser.CurrentByteIndex))
        self._text_start = self._parser.CharacterDataHandler = None


def _ignored(tag: str, attributes: Mapping[str, str]) -> str:
    """What messages call the arrays that are skipped for their type; empty for an array that is read."""
    kind = attributes.get("type", "")
    if tag == "Array" or kind == "String":
        return "arrays of texts"
    if kind == "Bit":
        return "arrays of bits"
    is_color = kind == "UInt8" and attributes.get("NumberOfComponents", "1").strip() in ("3", "4")
    return "arrays of colors" if is_color else ""


# The numbers of an array.

TYPES: Final = {
    **{f"Int{8 * size}": f"i{size}" for size in (1, 2, 4, 8)},
    **{f"UInt{8 * size}": f"u{size}" for size in (1, 2, 4, 8)},
    **{f"Float{8 * size}": f"f{size}" for size in (4, 8)},
}
"""The types in a file, as those of numpy."""

BYTE_ORDERS: Final = {"LittleEndian": "<", "BigEndian": ">"}
HEADER_TYPES: Final = {"UInt32": "u4", "UInt64": "u8"}

LARGEST_GROWTH: Final = 200
"""Limit: how many times larger than a file its unpacked numbers may be."""

LARGEST_DICTIONARY: Final = 1 << 27
"""Limit: bytes to unpack a block with LZMA; its highest level takes half of this."""

CELLS: Final = {"Verts": 1, "Lines": 3, "Polys": POLYGON_CELL, "Strips": STRIP_CELL}
"""The type of the cells in each section, in the order of the data of cells."""

IN_BASE64: Final = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/="
PADDED: Final = re.compile(rb"[^=]*=*")
SPACES: Final = b" \t\r\n"


class VtpFile:
    """Reads the arrays of a file. All methods raise InputError."""

    def __init__(self, data: bytes, name: str) -> None:
        self.data = data
        self.name = name
        self.document = Document(data, name)
        self._appended_size = self._unpacked = 0
        root = self.document.root
        self._order = BYTE_ORDERS[self._choice("byte_order", "LittleEndian", BYTE_ORDERS)]
        header = self._choice("header_type", "UInt32", HEADER_TYPES)
        self._header = np.dtype(self._order + HEADER_TYPES[header])
        self._compressor = root.get("compressor", "")

    def _choice(self, attribute: str, default: str, choices: Mapping[str, str]) -> str:
        """The value of an attribute of the root element."""
        value = self.document.root.get(attribute, default)
        if value not in choices:
            raise InputError(
                f"{self.name}: {attribute} must be {' or '.join(choices)}, not {shown(value)}; write it again"
            )
        return value

    def coordinates(self, piece: Piece, count: int) -> Floats:
        """The coordinates of the points of a piece, (count, 3)."""
        array = next(iter(piece.sections.get("Points", {}).values()), None)
        if array is None or not count:
            if count:
                raise InputError(f"{piece.place}: a piece with points must have Points, not none; add them")
            return np.empty((0, 3))
        if self._components(array) != 3:
            raise self._error(array, "Points must have three components; correct it")
        values = self._numbers(array, 3 * count).astype(np.float64)
        wrong = np.flatnonzero(~(np.abs(values) <= LARGEST_COORDINATE))
        if len(wrong):
            raise self._error(
                array,
                f"a coordinate must be finite and at most 1e30 in size, not {values[wrong[0]]:g} (number"
                f" {wrong[0] + 1:,}); correct it",
            )
        return values.reshape(-1, 3)

    def cell_lists(self, piece: Piece, section: str, count: int, nodes: int) -> CellLists:
        """The node numbers of the cells of a section, each a row of the `nodes` points of the piece."""
        arrays = piece.sections.get(section, {})
        if not {"connectivity", "offsets"} <= set(arrays):
            raise InputError(
                f"{piece.place}: the {section} of a piece must have the arrays 'connectivity' and 'offsets';"
                " write the file again"
            )
        ends = self._wholes(arrays["offsets"], count)
        if ends[0] < 0 or (np.diff(ends) < 0).any():
            raise self._error(arrays["offsets"], "offsets must rise from 0 on; correct them")
        lists = CellLists(self._wholes(arrays["connectivity"], int(ends[-1])), np.concatenate([[0], ends]))
        require_nodes(f"{self.name}, {section}", lists, nodes)
        return lists

    def data_of(self, section: str) -> Iterator[tuple[str, AnyArray]]:
        """The names and values, (rows, components), of the arrays that all pieces have in a section."""
        parts = ["Points"] if section == "PointData" else list(CELLS)
        rows = [(piece, sum(map(piece.count, parts))) for piece in self.document.pieces]
        rows = [(piece, count) for piece, count in rows if count]
        sections = [piece.sections.get(section, {}) for piece, _ in rows]
        for name, number in Counter(name for each in sections for name in each).items():
            arrays = [each[name] for each in sections] if number == len(sections) else []
            widths = set(map(self._components, arrays))
            if len(widths) != 1 or 0 in widths:
                self.document.skipped["arrays that differ between pieces, or are empty"] += 1
                continue
            (width,) = widths
            values = [
                self._numbers(array, count * width) for array, (_, count) in zip(arrays, rows, strict=True)
            ]
            yield name, np.concatenate(values).reshape(-1, width)

    def _components(self, array: DataArray) -> int:
        text = array.attributes.get("NumberOfComponents", "1").strip()
        if not (text.isascii() and text.isdigit() and len(text) <= 9):
            raise self._error(
                array, f"NumberOfComponents must be a whole number, not {shown(text)}; correct it"
            )
        return int(text)

    def _error(self, array: DataArray, sentence: str) -> InputError:
        return InputError(f"{self.name}, line {array.line}, array {shown(array.name)}: {sentence}")

    def _wholes(self, array: DataArray, count: int) -> AnyArray:
        """The whole numbers of an array, int64."""
        numbers = self._numbers(array, count)
        if numbers.dtype.kind not in "iu":
            raise self._error(array, "its type must be Int64 or another of whole numbers; correct it")
        return numbers.astype(np.int64)

    def _numbers(self, array: DataArray, count: int) -> AnyArray:
        """The `count` numbers of an array."""
        kind = array.attributes.get("type", "")
        if kind not in TYPES:
            raise self._error(
                array, f"its type must be one of {', '.join(TYPES)}, not {shown(kind)}; write the file again"
            )
        dtype = np.dtype(self._order + TYPES[kind])
        form = array.attributes.get("format", "ascii")
        if form not in ("ascii", "binary", "appended"):
            raise self._error(
                array,
                f"its format must be ascii, binary or appended, not {shown(form)}; write the file again",
            )
        text = b" ".join(self.data[each] for each in array.texts)
        if form == "ascii":
            words = NumberText(text, self.name, array.line)
            self._require_count(array, len(words), count, "numbers")
            if dtype.kind == "f":
                # A single number is the same as in a binary file.
                with np.errstate(over="ignore"):
                    return words.values(0, count).astype(dtype)
            return words.wholes(0, count, f"a number of the array {shown(array.name)}")
        stored = self._decoded(array, text) if form == "binary" else self._appended(array)
        return np.frombuffer(self._bytes(array, memoryview(stored), count * dtype.itemsize), dtype)

    def _require_count(self, array: DataArray, given: int, count: int, what: str) -> None:
        if given != count:
            raise self._error(
                array,
                f"it must have {count:,} {what}, not {given:,}; the file is cut short or its counts are"
                " wrong",
            )

    def _decoded(self, array: DataArray, text: bytes) -> bytes:
        """The bytes of base64. A header may be encoded and padded by itself."""
        text = text.translate(None, SPACES)
        if wrong := text.translate(None, IN_BASE64):
            raise self._error(array, f"it must be base64, not have {shown(wrong[:1])}; write it again")
        try:
            return b"".join(binascii.a2b_base64(part) for part in PADDED.findall(text))
        except ValueError:
            raise self._error(
                array, "it must be base64 of whole bytes, not cut short; write it again"
            ) from None

    def _appended(self, array: DataArray) -> bytes | memoryview:
        """The appended bytes of an array, up to the next array that is read."""
        document, offset = self.document, _offset(array)
        if offset is None:
            text = array.attributes.get("offset", "")
            raise self._error(array, f"its offset must be a whole number, not {shown(text)}; correct it")
        if document.encoding not in ("raw", "base64"):
            raise InputError(
                f"{self.name}: the encoding of AppendedData must be raw or base64, not"
                f" {shown(document.encoding)}; write it again"
            )
        start = document.appended_start + offset
        following = bisect_right(self._starts, start)
        end = min([*self._starts[following : following + 1], self._end_of_appended])
        self._appended_size += max(end - start, 0)
        if self._appended_size > len(self.data):
            raise self._error(array, "its offset must be its own, not another array's; write the file again")
        if document.encoding == "raw":
            return memoryview(self.data)[start:end]
        return self._decoded(array, self.data[start:end])

    @cached_property
    def _starts(self) -> list[int]:
        """Where the appended arrays begin in the file, sorted."""
        offsets = {
            _offset(array)
            for piece in self.document.pieces
            for section in piece.sections.values()
            for array in section.values()
        }
        return sorted(self.document.appended_start + offset for offset in offsets if offset is not None)

    @cached_property
    def _end_of_appended(self) -> int:
        end = -1 if self.document.encoding == "raw" else self.data.find(b"<", self.document.appended_start)
        return len(self.data) if end < 0 else end

    def _bytes(self, array: DataArray, stored: memoryview, size: int) -> bytes | memoryview:
        """The `size` bytes of an array, unpacked. `stored` has a header, the data, and perhaps more.

        The header is the number of bytes. If the numbers are packed, it is the number of blocks, the bytes of
        a block, the bytes of a shorter last block or 0, and the packed bytes of each block.
        """
        width = self._header.itemsize
        is_packed = bool(self._compressor)
        if not size and len(stored) < width:
            return b""
        header = self._header_of(array, stored, 3 if is_packed else 1)
        if not is_packed:
            self._require_count(array, header[0], size, "bytes")
            self._require_room(array, width + size, len(stored))
            return stored[width : width + size]
        blocks, block, last = header
        self._require_room(array, width * (3 + blocks), len(stored))
        packed = self._header_of(array, stored, 3 + blocks)[3:]
        start = width * (3 + blocks)
        self._require_room(array, start + sum(packed), len(stored))
        unpacked = blocks * block - (block - last if last and blocks else 0)
        self._require_count(array, unpacked, size, "bytes")
        self._unpacked += size
        if self._unpacked > LARGEST_GROWTH * len(self.data):
            raise self._error(
                array,
                f"the unpacked numbers of a file of its size must have at most"
                f" {LARGEST_GROWTH * len(self.data):,} bytes, not more; write it without compression",
            )
        require_memory(GROWTH * self._unpacked, f"{self.name}: to unpack it", "split or simplify it")
        pieces = []
        for number, length in enumerate(packed, 1):
            most = last if last and number == blocks else block
            pieces.append(self._unpacked_block(array, stored[start : start + length], most))
            start += length
        return b"".join(pieces)

    def _header_of(self, array: DataArray, stored: memoryview, count: int) -> list[int]:
        """The numbers of the header of an array."""
        self._require_room(array, count * self._header.itemsize, len(stored))
        numbers: list[int] = np.frombuffer(stored, self._header, count).tolist()
        return numbers

    def _require_room(self, array: DataArray, size: int, stored: int) -> None:
        if size > stored:
            raise self._error(
                array,
                f"it must have {size:,} bytes, not {stored:,}; the file is cut short or its counts are wrong",
            )

    def _unpacked_block(self, array: DataArray, packed: memoryview, size: int) -> bytes:
        """The `size` bytes of a packed block. At most one byte more is ever unpacked."""
        if self._compressor not in UNPACKERS:
            raise self._error(
                array,
                f"its compressor must be {' or '.join(UNPACKERS)}, not {shown(self._compressor)}; write the"
                " file with zlib",
            )
        try:
            unpacked, is_whole = UNPACKERS[self._compressor](packed, size + 1)
        except ValueError as error:
            raise self._error(
                array, f"a packed block must be whole, not wrong ({error}); write it again"
            ) from None
        if len(unpacked) != size or not is_whole:
            raise self._error(
                array, f"a packed block must have {size:,} bytes, not fewer or more; write it again"
            )
        return unpacked


def _offset(array: DataArray) -> int | None:
    """The offset of an array in the appended data; None unless the attribute is a whole number."""
    text = array.attributes.get("offset", "").strip()
    return int(text) if text.isascii() and text.isdigit() and len(text) <= 18 else None


def unpacked_zlib(packed: memoryview, most: int) -> tuple[bytes, bool]:
    """At most `most` bytes of a packed block, and whether there are no more. Raises ValueError."""
    try:
        inflate = zlib.decompressobj()
        return inflate.decompress(packed, most), inflate.eof
    except zlib.error as error:
        raise ValueError(str(error)) from None


def unpacked_lzma(packed: memoryview, most: int) -> tuple[bytes, bool]:
    """At most `most` bytes of a packed block, and whether there are no more. Raises ValueError."""
    # Few files need it.
    import lzma

    try:
        decompressor = lzma.LZMADecompressor(memlimit=LARGEST_DICTIONARY)
        return decompressor.decompress(packed, most), decompressor.eof
    except lzma.LZMAError as error:
        raise ValueError(str(error)) from None


UNPACKERS: Final = {"vtkZLibDataCompressor": unpacked_zlib, "vtkLZMADataCompressor": unpacked_lzma}
"""The functions that unpack a block, by the names of compressors."""
