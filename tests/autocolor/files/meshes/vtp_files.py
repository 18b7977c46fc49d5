"""A writer of small VTP files in every encoding, for the tests of their reader."""

from __future__ import annotations

import base64
import lzma
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

TYPES = {"Int8": "i1", "UInt8": "u1", "Int32": "i4", "Int64": "i8", "Float32": "f4", "Float64": "f8"}
SECTIONS = ("Verts", "Lines", "Strips", "Polys")
PACKED: dict[str, Callable[[bytes], bytes]] = {
    "": bytes,
    "vtkZLibDataCompressor": zlib.compress,
    "vtkLZMADataCompressor": lzma.compress,
}
"""The functions that pack a block, by the names of compressors."""


@dataclass
class VtpWriter:
    """How a file is encoded, and its pieces so far.

    `format` is ascii, binary or appended, `encoding` that of appended data; blocks have `block` bytes.
    """

    format: str = "ascii"
    encoding: str = "raw"
    compressor: str = ""
    order: str = "<"
    header: str = "u4"
    block: int = 24
    pieces: list[str] = field(default_factory=list)
    appended: bytes = b""

    def stored(self, data: bytes) -> bytes:
        """The header and the numbers as they are stored; in base64, packed numbers have a header alone."""
        header_type = self.order + self.header
        if not self.compressor:
            return self.encoded(np.array([len(data)], header_type).tobytes() + data)
        blocks = [data[at : at + self.block] for at in range(0, len(data), self.block)]
        packed = [PACKED[self.compressor](each) for each in blocks]
        header = [len(blocks), self.block, len(data) % self.block, *map(len, packed)]
        return self.encoded(np.array(header, header_type).tobytes()) + self.encoded(b"".join(packed))

    def encoded(self, data: bytes) -> bytes:
        """The bytes in base64, unless they are appended as they are."""
        is_raw = self.format == "appended" and self.encoding == "raw"
        return data if is_raw else base64.b64encode(data)

    def array(self, name: str, kind: str, values: object, width: int = 1, inside: str = "") -> str:
        """An element of numbers, with the text `inside` after its own."""
        numbers = np.asarray(values).ravel().astype(self.order + TYPES[kind])
        head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" format="{self.format}"'
        if self.format == "appended":
            offset = len(self.appended)
            self.appended += self.stored(numbers.tobytes())
            return f'{head} offset="{offset}">{inside}</DataArray>\n'
        text = self.stored(numbers.tobytes()).decode() if self.format == "binary" else ""
        if self.format == "ascii":
            rows = numbers.reshape(-1, max(width, 1)).tolist()
            text = "\n".join(" ".join(map(repr, row)) for row in rows)
        return f"{head}>\n {text}\n{inside}</DataArray>\n"

    def piece(
        self, points: object, kind: str = "Float32", sections: str = "", **cells: list[list[int]]
    ) -> VtpWriter:
        """Add a piece with points, and cells by the lists of their node numbers; `sections` are its data."""
        nodes = np.asarray(points).reshape(-1, 3)
        inside = '<InformationKey name="k" location="l"><Value index="0"> 7 </Value></InformationKey>'
        lists = ""
        for name in SECTIONS:
            of_section = cells.get(name, [])
            if of_section:
                every = [node for cell in of_section for node in cell]
                numbers = self.array("connectivity", "Int64", every)
                ends = self.array("offsets", "Int32", np.cumsum([len(cell) for cell in of_section]))
                lists += f"<{name}>{numbers}{ends}</{name}>\n"
        counts = " ".join(f'NumberOf{name}="{len(cells.get(name, []))}"' for name in SECTIONS)
        array = self.array("Points", kind, nodes, 3, inside)
        self.pieces.append(
            f'<Piece NumberOfPoints="{len(nodes)}" {counts}>\n{sections}<Points>{array}</Points>\n'
            f"{lists}</Piece>\n"
        )
        return self

    @property
    def data(self) -> bytes:
        """The whole file."""
        order = {"<": "LittleEndian", ">": "BigEndian"}[self.order]
        header = {"u4": "UInt32", "u8": "UInt64"}[self.header]
        compressor = f' compressor="{self.compressor}"' if self.compressor else ""
        head = (
            f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="{order}"'
            f' header_type="{header}"{compressor}>\n<PolyData>\n{"".join(self.pieces)}</PolyData>\n'
        )
        if self.format != "appended":
            return f"{head}</VTKFile>\n".encode()
        start = f'<AppendedData encoding="{self.encoding}">\n _'
        return (head + start).encode() + self.appended + b"\n</AppendedData>\n</VTKFile>\n"
