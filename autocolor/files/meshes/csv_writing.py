"""Writing a mesh as two tables in CSV, as `csv_tables` reads them."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.arrays import Floats, chunks
from autocolor.files.meshes.csv_tables import CORNER, NODE_COLUMNS, POLYGON_COLUMNS, SCALAR
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON

ROWS_AT_ONCE: Final = 1 << 16
"""Rows that are made text at once, so that their Python values are few."""


def csv_tables_bytes(mesh: Mesh) -> tuple[bytes, bytes]:
    """The node table and the polygon table of a mesh with its scalars, in UTF-8.

    Numbers have all digits of double precision. Reading them back gives the same mesh unless the reader
    repairs it: a polygon without area is dropped, parts are those of polygons and in their order, and names
    are printable, at most 200 letters, with no spaces around them.
    """
    nodes = "\n".join(_node_lines(mesh))
    polygons = "\n".join(_polygon_lines(mesh))
    return nodes.encode("utf-8", "replace") + b"\n", polygons.encode("utf-8", "replace") + b"\n"


def _node_lines(mesh: Mesh) -> Iterator[str]:
    yield _header(mesh, NODE_COLUMNS, NODE)
    values = [each.values for each in mesh.scalars if each.of == NODE]
    for chunk in chunks(len(mesh.coordinates), ROWS_AT_ONCE):
        columns: list[Iterator[str]] = [
            map(repr, mesh.coordinates[chunk, axis].tolist()) for axis in range(3)
        ]
        columns += [_cells(each[chunk]) for each in values]
        for number, cells in enumerate(zip(*columns, strict=True), start=chunk.start + 1):
            yield f"{number},{','.join(cells)}"


def _polygon_lines(mesh: Mesh) -> Iterator[str]:
    yield _header(mesh, POLYGON_COLUMNS, POLYGON)
    values = [each.values for each in mesh.scalars if each.of == POLYGON]
    names = np.array([_row([name]) for name in mesh.part_names], object)
    for chunk in chunks(len(mesh.node_numbers), ROWS_AT_ONCE):
        corners = mesh.node_numbers[chunk] + 1
        is_triangle = corners[:, 2] == corners[:, 3]
        columns: list[Iterator[str]] = [map(str, corners[:, at].tolist()) for at in range(3)]
        columns.append(
            "" if triangle else str(corner)
            for triangle, corner in zip(is_triangle.tolist(), corners[:, 3].tolist(), strict=True)
        )
        columns += [_cells(each[chunk]) for each in values]
        parts = names[mesh.part_numbers[chunk]].tolist()
        for number, part, *cells in zip(range(chunk.start + 1, chunk.stop + 1), parts, *columns, strict=True):
            yield f"{number},{part},{','.join(cells)}"


def _header(mesh: Mesh, columns: tuple[str, ...], of: str) -> str:
    """The names of the columns; a scalar named like a column of the mesh is told from it."""
    names = [each.name for each in mesh.scalars if each.of == of]
    told = [
        f"{SCALAR}{name}"
        if name.casefold() in columns or CORNER.fullmatch(name) or name.startswith(SCALAR)
        else name
        for name in names
    ]
    return _row([*columns, *told])


def _row(cells: list[str]) -> str:
    """Cells as CSV, in quotes where that is needed."""
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(cells)
    return text.getvalue()


def _cells(values: Floats) -> Iterator[str]:
    """Values as cells; a missing one is empty."""
    return ("" if math.isnan(value) else repr(value) for value in values.tolist())
