"""Legacy VTK files for the tests: the same content in text and binary, and in both forms of cells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

TYPES = {
    "int": ">i4", "float": ">f4", "double": ">f8", "vtktypeint64": ">i8", "unsigned_char": "u1",
    "short": ">i2", "unsigned_short": ">u2", "char": "i1", "unsigned_int": ">u4", "long": ">i8",
    "unsigned_long": ">u8", "vtkIdType": ">i4",
}  # fmt: skip

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]

Numbers = Sequence[object] | np.ndarray[tuple[int, ...], np.dtype[np.float64]]


class VtkWriter:
    """Builds the bytes of a file, in text unless `binary`; cells have OFFSETS from version 5.1 on."""

    def __init__(self, dataset: str, *, binary: bool = False, version: str = "3.0") -> None:
        self.binary = binary
        self.offsets = version >= "5.1"
        kind = "BINARY" if binary else "ASCII"
        self.data = f"# vtk DataFile Version {version}\ntitle\n{kind}\nDATASET {dataset}\n".encode()

    def line(self, text: str) -> VtkWriter:
        self.data += text.encode() + b"\n"
        return self

    def numbers(self, numbers: object, kind: str) -> VtkWriter:
        array = np.asarray(numbers).ravel()
        if self.binary:
            self.data += array.astype(TYPES[kind]).tobytes() + b"\n"
        else:
            self.data += (" ".join(map(str, array.tolist())) + "\n").encode()
        return self

    def points(self, points: object = SQUARE, kind: str = "float") -> VtkWriter:
        return self.line(f"POINTS {len(np.asarray(points))} {kind}").numbers(points, kind)

    def cells(self, keyword: str, cells: Sequence[Sequence[int]]) -> VtkWriter:
        every = [node for cell in cells for node in cell]
        if self.offsets:
            self.line(f"{keyword} {len(cells) + 1} {len(every)}").line("OFFSETS vtktypeint64")
            self.numbers(np.cumsum([0, *map(len, cells)]), "vtktypeint64")
            return self.line("CONNECTIVITY vtktypeint64").numbers(every, "vtktypeint64")
        counted = [number for cell in cells for number in (len(cell), *cell)]
        return self.line(f"{keyword} {len(cells)} {len(counted)}").numbers(counted, "int")

    def grid(self, cells: Sequence[tuple[int, Sequence[int]]]) -> VtkWriter:
        self.cells("CELLS", [nodes for _, nodes in cells])
        return self.line(f"CELL_TYPES {len(cells)}").numbers([kind for kind, _ in cells], "int")
