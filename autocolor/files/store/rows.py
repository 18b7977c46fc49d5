"""The rows of a store as a scene, and a scene as rows."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from itertools import count as counted
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Indices, Numbers
from autocolor.checks import LARGEST_COORDINATE, nearest, shown
from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_report import OMITTED, SceneReport, scene_report
from autocolor.files.store.connections import DAMAGED
from autocolor.files.store.schema import (
    AXES,
    DEFINITIONS,
    NODES,
    POLYGONS,
    ROW_TABLES,
    VALUES,
    StoredTables,
    plain_row,
    quoted,
    require_names,
    row_values,
    rows_of_table,
)
from autocolor.immutable import read_only
from autocolor.scene.columns import Row, RowError, from_plain, replaced
from autocolor.scene.creation import PARTS, UNASSIGNED, SurfaceSource
from autocolor.scene.defaults import default_surface
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.mesh import PART, Mesh
from autocolor.scene.scalar import MOST_SCALARS, NODE, POLYGON, MeshScalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface

CORNERS: Final = ("node1", "node2", "node3", "node4")


def report_of(
    connection: sqlite3.Connection, tables: StoredTables, name: str, surfaces: SurfaceSource
) -> SceneReport:
    """The scene of the tables of a store. Missing tables and rows are created.

    `name` is for a scene whose table gives no name. Raises InputError with every problem.
    """
    fields: dict[str, Any] = {"name": name}
    problems: list[str] = []
    parts: dict[str, dict[str, Any]] = {}
    for table in ROW_TABLES.values():
        if table.name not in tables:
            continue
        rows = [plain_row(table.columns, row) for row in rows_of_table(connection, tables, table.name)]
        if table.name == "scene":
            fields.update(*({**OMITTED, **row} for row in rows))
            continue
        validated: list[Row] = []
        for number, row in enumerate(rows):
            try:
                if table.row_class is Surface and isinstance(called := row.get("name"), str):
                    validated.append(replaced(default_surface(called, number), row))
                else:
                    # A part without a surface gets one when the scene is made.
                    start = {"surface": UNASSIGNED} if table.row_class is Part else {}
                    validated.append(from_plain(table.row_class, {**start, **row}))
            except RowError as error:
                found = (problem.sentence for problem in error.row_problems)
                problems.extend(f"{table.name}, row {number + 1}: {sentence}" for sentence in found)
        if table.name == PARTS:
            parts = {str(row.get("name")): row for row in rows}
            if len(parts) < len(rows):
                problems.append(f"{PARTS}: names must be unique, not repeated; rename one")
        elif rows or not table.is_single:
            fields[table.name] = validated[0] if table.is_single and validated else tuple(validated)
    if problems:
        raise InputError(problems[:100])
    mesh = mesh_of(connection, tables, tuple(parts))
    of_part = {name: {key: row[key] for key in row if key != "name"} for name, row in parts.items()}
    materials = {}
    if "surfaces" not in fields:
        # Create the surfaces that only parts name, as the surfaces of materials are created.
        materials = {name: str(row.pop("surface")) for name, row in of_part.items() if "surface" in row}
        if surfaces == PARTS:
            fields["surfaces"] = PARTS
    return scene_report([MeshReport(mesh, material_of_part=materials)], parts=of_part, **fields)


COLUMNS: Final[Mapping[str, Mapping[str, Any]]] = {
    NODES: {"node": int, **dict.fromkeys(AXES, float)},
    POLYGONS: dict.fromkeys(("polygon", *CORNERS), int),
    **{table: {of: int, "value": float} for of, table in VALUES.items()},
}
"""The columns of numbers of the tables of the mesh, and their types. The first one counts the rows."""


def mesh_of(connection: sqlite3.Connection, tables: StoredTables, part_names: tuple[str, ...]) -> Mesh:
    """The mesh of a store. If `part_names` is empty, the polygons name the parts.

    Raises InputError with the first problem.
    """
    nodes = _numbers_in(connection, tables, NODES)
    polygons = _numbers_in(connection, tables, POLYGONS)
    numbers = {NODE: nodes["node"], POLYGON: polygons["polygon"]}
    corners = np.stack([polygons[corner] for corner in CORNERS], axis=1)
    node_numbers = _rows_of(corners, numbers[NODE])
    for row, corner in np.argwhere(node_numbers < 0):
        raise InputError(
            f"{POLYGONS}, row {polygons['polygon'][row]}: node {corners[row, corner]} is not in the node"
            " table; correct it"
        )
    part_numbers, names = np.zeros(len(polygons), np.intp), part_names or (PART,)
    if "part" in tables[POLYGONS]:
        part_numbers, names = _parts(connection, numbers[POLYGON], part_names)
    angles = [row.get("crease_angle") for row in rows_of_table(connection, tables, "mesh")]
    return Mesh(
        np.stack([nodes[axis] for axis in AXES], axis=1),
        node_numbers,
        part_numbers,
        names,
        next((angle for angle in angles if angle is not None), CREASE_ANGLE),  # type: ignore[arg-type]
        tuple(_scalars(connection, tables, numbers)),
    )


def _numbers_in(
    connection: sqlite3.Connection, tables: StoredTables, table: str, where: str = "", *values: str
) -> AnyArray:
    """The numbers of a table of the mesh, a structured array, with rising numbers of its rows."""
    types = COLUMNS[table]
    columns = [*types]
    require_names(f"{table} must have the columns", columns, tables[table])
    # A triangle repeats its third node. A damaged index could have other rows than its table. The tables of
    # scalars are indexes themselves.
    asked = ", ".join(columns).replace("node4", "ifnull(node4, node3)")
    query = f"SELECT {asked} FROM {table} {where or 'NOT INDEXED'} ORDER BY {columns[0]}"

    def refuse_wrong() -> None:
        for row in connection.execute(query, values):
            for (name, kind), value in zip(types.items(), row, strict=True):
                if not isinstance(value, (int, kind)) or abs(value) > LARGEST_COORDINATE:
                    rule = (
                        "a whole number"
                        if kind is int
                        else f"a number of at most {LARGEST_COORDINATE:g} in size"
                    )
                    given = "missing" if value is None else shown(value)
                    place = f"{table}, row {shown(row[0])}"
                    raise InputError(f"{place}: {name} must be {rule}, not {given}; correct it")

    # STRICT tables have the right types, but not the right sizes.
    sql = connection.execute("SELECT sql FROM sqlite_master WHERE name = ?", (table,)).fetchone()
    if sql != (DEFINITIONS[table],):
        refuse_wrong()
    try:
        numbers = np.fromiter(connection.execute(query, values), [*types.items()])
    except (ValueError, TypeError):
        raise InputError(DAMAGED.format(f"a row of {table}")) from None
    if not all((np.abs(numbers[name]) <= LARGEST_COORDINATE).all() for name in columns):
        refuse_wrong()
    for number in numbers[columns[0]][1:][np.diff(numbers[columns[0]]) == 0]:
        raise InputError(
            f"{table}: rows must have different numbers, and {number} is repeated; number them anew"
        )
    return numbers


def _rows_of(wanted: Numbers, numbers: Numbers) -> Indices:
    """The rows of wanted numbers among rising numbers; -1 for a number that is missing."""
    if not len(numbers):
        return np.full(wanted.shape, -1, np.intp)
    rows = np.minimum(np.searchsorted(numbers, wanted), len(numbers) - 1)
    return np.where(numbers[rows] == wanted, rows, -1)


def _parts(
    connection: sqlite3.Connection, polygons: Numbers, names: tuple[str, ...]
) -> tuple[Indices, tuple[str, ...]]:
    """The part number of each of the polygons, and the names of the parts, new ones if `names` is empty."""
    number_of: dict[Any, int] = {name: number for number, name in enumerate(names)}
    rows = connection.execute(f"SELECT part FROM {POLYGONS} NOT INDEXED ORDER BY polygon")
    part_numbers = np.fromiter((number_of.setdefault(name, len(number_of)) for (name,) in rows), np.intp)
    for name, number in number_of.items():
        if not isinstance(name, str) or (names and number >= len(names)):
            rule = "in the part table" if names else "a name"
            raise InputError(
                f"{POLYGONS}, row {polygons[np.argmax(part_numbers == number)]}: part must be {rule}, not"
                f" {shown(name)}{nearest(str(name), names) or '; correct it'}"
            )
    return part_numbers, tuple(number_of)


def _scalars(
    connection: sqlite3.Connection, tables: StoredTables, numbers: Mapping[Any, Numbers]
) -> Iterator[MeshScalar]:
    """The scalars of the mesh; a value is missing if it is NULL or has no row."""
    described: list[tuple[Any, Any]] = [
        (row.get("name"), row.get("of")) for row in rows_of_table(connection, tables, "mesh_scalars")
    ]
    for name, of in described[: MOST_SCALARS + 1]:
        values = np.full(len(numbers.get(of, ())), np.nan)
        if of in VALUES and VALUES[of] in tables:
            where = "WHERE scalar = ? AND value IS NOT NULL"
            pairs = _numbers_in(connection, tables, VALUES[of], where, name)
            rows = _rows_of(pairs[of], numbers[of])
            for number in pairs[of][rows < 0]:
                raise InputError(
                    f"{VALUES[of]}, scalar {shown(name)}: {of} {number} is not in the {of} table; remove it"
                )
            values[rows] = pairs["value"]
        yield MeshScalar(name, read_only(values), of)
    for table in VALUES.values():
        if "scalar" in tables.get(table, ()):
            for (scalar,) in connection.execute(f"SELECT DISTINCT scalar FROM {table}"):
                if scalar not in dict(described):
                    raise InputError(
                        f"{table}: scalar {shown(scalar)} is not in the mesh_scalars table; remove its values"
                    )


CHUNK: Final = 1 << 16
"""Rows that are converted at once. To convert all rows would take ten times the memory of the arrays."""


def insert_rows(connection: sqlite3.Connection, scene: Scene) -> None:
    """Insert the rows of a scene into new tables; rows are counted from 1."""

    def insert(table: str, marks: str, rows: Iterable[tuple[Any, ...]]) -> None:
        connection.executemany(f"INSERT INTO {quoted(table)} VALUES ({marks})", rows)

    mesh = scene.mesh
    for table in ROW_TABLES.values():
        value: Any = scene if table.name == "scene" else vars(scene)[table.name]
        rows = value if not table.is_single else [] if value is None else [value]
        values = ((number, *row_values(table.columns, row)) for number, row in enumerate(rows, 1))
        insert(table.name, "?" + ", ?" * len(table.columns), values)
    insert(NODES, "?, ?, ?, ?", _numbered(*mesh.coordinates.T))
    part_names = np.array(mesh.part_names, object)[mesh.part_numbers]
    # A triangle repeats its third node.
    marks = "?1, ?2, ?3 + 1, ?4 + 1, ?5 + 1, nullif(?6, ?5) + 1"
    insert(POLYGONS, marks, _numbered(part_names, *mesh.node_numbers.T))
    insert("mesh", "1, ?", [(mesh.crease_angle,)])
    for number, scalar in enumerate(mesh.scalars, 1):
        insert("mesh_scalars", "?, ?, ?", [(number, scalar.name, scalar.of)])
        # NaN becomes NULL.
        values = ((scalar.name, row, value) for row, value in _numbered(scalar.values))
        insert(VALUES[scalar.of], "?, ?, ?", values)


def _numbered(*columns: AnyArray) -> Iterator[tuple[Any, ...]]:
    """The rows of some columns, each after its number from 1."""
    for first in range(0, len(columns[0]), CHUNK):
        chunk = (column[first : first + CHUNK].tolist() for column in columns)
        yield from zip(counted(first + 1), *chunk, strict=False)
