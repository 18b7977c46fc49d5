"""The rows of a store as a scene, and a scene as rows.

Measured, for a million nodes and a million quads: `np.fromiter` of whole rows takes 1.7 s, `fetchall` and
`np.array` take 3.6 s, chunks of `fetchmany` 3 s. To look at all types takes half as long as
reading, so only tables of another definition than ours are looked at.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from itertools import count as counted
from itertools import islice
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Indices, Numbers
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE, nearest, shown
from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_report import OMITTED, SceneReport, scene_report
from autocolor.files.store.connections import DAMAGED
from autocolor.files.store.schema import (
    AXES,
    DEFINITIONS,
    MESH,
    NODES,
    NUMBER,
    POLYGONS,
    ROW_TABLES,
    SCALARS,
    SCENE,
    VALUES,
    RowTable,
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

BYTES_OF_ROW: Final = 120
"""Measured: bytes that a row of the nodes or polygons takes while it is read, however small it is stored."""

MOST_PROBLEMS: Final = 100
MOST_MESH_PROBLEMS: Final = 5
"""Limit: the problems of one kind in the tables of the mesh."""


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
        if table.name == SCENE:
            fields.update(*({**OMITTED, **row} for row in rows))
        elif table.name == PARTS:
            parts = {str(row.get("name")): row for row in rows}
            if len(parts) < len(rows):
                problems.append(f"{PARTS}: names must be unique, not repeated; rename one")
            _validated(table, rows, problems)
        elif rows or not table.is_single:
            values = _validated(table, rows, problems)
            fields[table.name] = values[0] if table.is_single and values else values
    if problems:
        raise InputError(problems[:MOST_PROBLEMS])
    mesh = mesh_of(connection, tables, tuple(parts))
    of_part = {name: {key: row[key] for key in row if key != "name"} for name, row in parts.items()}
    materials = {}
    if "surfaces" not in fields:
        # Create the surfaces that only parts name, as the surfaces of materials are created.
        materials = {name: str(row.pop("surface")) for name, row in of_part.items() if "surface" in row}
        if surfaces == PARTS:
            fields["surfaces"] = PARTS
    return scene_report([MeshReport(mesh, material_of_part=materials)], parts=of_part, **fields)


def _validated(table: RowTable, rows: list[dict[str, Any]], problems: list[str]) -> tuple[Row, ...]:
    """The valid rows of a table. The problems of other rows are added to `problems`, with their places."""
    validated: list[Row] = []
    for number, row in enumerate(rows):
        try:
            if table.row_class is Surface and isinstance(name := row.get("name"), str):
                validated.append(replaced(default_surface(name, number), row))
            else:
                # A part without a surface gets one when the scene is made.
                start = {"surface": UNASSIGNED} if table.row_class is Part else {}
                validated.append(from_plain(table.row_class, {**start, **row}))
        except RowError as error:
            found = (problem.sentence for problem in error.row_problems)
            problems.extend(f"{table.name}, row {number + 1}: {sentence}" for sentence in found)
    return tuple(validated)


# The mesh.


class NumberColumn(NamedTuple):
    """A column of numbers of the mesh: what a value must be, in words and in SQL, and its dtype."""

    rule: str
    condition: str = "typeof({}) = 'integer'"
    dtype: type = np.int64


COORDINATE: Final = NumberColumn(
    "a number of at most 1e30 in size",
    f"typeof({{0}}) IN ('real', 'integer') AND {{0}} BETWEEN -{LARGEST_COORDINATE} AND {LARGEST_COORDINATE}",
    np.float64,
)
CORNERS: Final = {
    **dict.fromkeys(("node1", "node2", "node3"), NumberColumn("a node number")),
    "node4": NumberColumn("a node number, or NULL for a triangle", "typeof({}) IN ('integer', 'null')"),
}
COLUMNS: Final[Mapping[str, Mapping[str, NumberColumn]]] = {
    NODES: {"node": NumberColumn("a whole number"), **dict.fromkeys(AXES, COORDINATE)},
    POLYGONS: {"polygon": NumberColumn("a whole number"), **CORNERS},
    **{
        table: {of: NumberColumn(f"the number of a {of}"), "value": COORDINATE}
        for of, table in VALUES.items()
    },
}
"""The columns of numbers of the tables of the mesh. The first one counts the rows."""


def mesh_of(connection: sqlite3.Connection, tables: StoredTables, part_names: tuple[str, ...]) -> Mesh:
    """The mesh of a store. If `part_names` is empty, the polygons name the parts.

    Raises InputError with the first problems, row by row.
    """
    nodes = _numbers_in(connection, tables, NODES)
    polygons = _numbers_in(connection, tables, POLYGONS)
    numbers = {NODE: nodes["node"], POLYGON: polygons["polygon"]}
    corners = np.stack([polygons[corner] for corner in CORNERS], axis=1)
    node_numbers = _rows_of(corners, numbers[NODE])
    _raise_any(
        f"{POLYGONS}, row {polygons['polygon'][row]}: node {corners[row, corner]} is not in the node table;"
        " correct it"
        for row, corner in zip(*np.nonzero(node_numbers < 0), strict=True)
    )
    part_numbers, names = np.zeros(len(polygons), np.intp), part_names or (PART,)
    if "part" in tables[POLYGONS]:
        part_numbers, names = _parts(connection, numbers[POLYGON], part_names)
    found = (row.get("crease_angle") for row in rows_of_table(connection, tables, MESH))
    angles: list[Any] = [angle for angle in found if angle is not None]
    return Mesh(
        np.stack([nodes[axis] for axis in AXES], axis=1),
        node_numbers,
        part_numbers,
        names,
        next(iter(angles), CREASE_ANGLE),
        tuple(_scalars(connection, tables, numbers)),
    )


def _raise_any(problems: Iterable[str]) -> None:
    """Raise InputError with the first different problems, if any."""
    # The third node of a triangle is its fourth too.
    if first := list(dict.fromkeys(islice(problems, 2 * MOST_MESH_PROBLEMS))):
        raise InputError(first[:MOST_MESH_PROBLEMS])


def _numbers_in(
    connection: sqlite3.Connection, tables: StoredTables, table: str, where: str = "", *values: str
) -> AnyArray:
    """The numbers of a table of the mesh, a structured array, with rising numbers of its rows."""
    columns = COLUMNS[table]
    key, *_ = columns
    stored = [name for name in columns if name != "node4" or name in tables[table]]
    require_names(f"{table} must have the columns", stored, tables[table])
    # A damaged index could have other rows than its table. The tables of scalars are indexes themselves.
    source = f"{table} {where or 'NOT INDEXED'}"

    def refuse() -> None:
        wrong = [f"NOT ({columns[name].condition.format(name)})" for name in stored]
        query = f"SELECT {key}, {', '.join(stored + wrong)} FROM {source} {'AND' if where else 'WHERE'}"
        _raise_any(
            f"{table}, row {shown(number)}: {name} must be {columns[name].rule}, not"
            f" {'missing' if value is None else shown(value)}; correct it"
            for number, *pairs in connection.execute(f"{query} ({' OR '.join(wrong)})", values)
            for name, value, is_wrong in zip(stored, pairs, pairs[len(stored) :], strict=False)
            if is_wrong
        )

    sql = connection.execute("SELECT sql FROM sqlite_master WHERE name = ?", (table,)).fetchone()
    if sql != (DEFINITIONS[table],):
        refuse()
    (count,) = connection.execute(f"SELECT count(*) FROM {source}", values).fetchone()
    require_memory(BYTES_OF_ROW * count, f"{table}: to read {count:,} rows", "leave rows out")
    fourth = {"node4": "ifnull(node4, node3)" if "node4" in stored else "node3"}
    rows = connection.execute(
        f"SELECT {', '.join(fourth.get(name, name) for name in columns)} FROM {source} ORDER BY {key}", values
    )
    try:
        numbers = np.fromiter(rows, [(name, column.dtype) for name, column in columns.items()], count)
    except (ValueError, TypeError):
        raise InputError(DAMAGED.format(f"a row of {table}")) from None
    if not all((np.abs(numbers[name]) <= LARGEST_COORDINATE).all() for name in columns):
        refuse()
    _raise_any(
        f"{table}: rows must have different numbers, and {number} is repeated; number them anew"
        for number in numbers[key][1:][np.diff(numbers[key]) == 0]
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
    rows = connection.execute(f"SELECT part FROM {POLYGONS} NOT INDEXED ORDER BY polygon")
    number_of: dict[Any, int] = {name: number for number, name in enumerate(names)}
    numbers = (number_of.setdefault(name, len(number_of)) for (name,) in rows)
    part_numbers = np.fromiter(numbers, np.intp)
    found = tuple(number_of)
    wrong = [number_of[name] for name in found if not isinstance(name, str) or (names and name not in names)]
    _raise_any(
        f"{POLYGONS}, row {polygons[row]}: part must be {'in the part table' if names else 'a name'}, not"
        f" {shown(name := found[part_numbers[row]])}{nearest(str(name), names) or '; correct it'}"
        for row in np.flatnonzero(np.isin(part_numbers, wrong))
    )
    return part_numbers, found


def _scalars(
    connection: sqlite3.Connection, tables: StoredTables, numbers: Mapping[Any, Numbers]
) -> Iterator[MeshScalar]:
    """The scalars of the mesh; a value is missing if it is NULL or has no row."""
    described: list[tuple[Any, Any]] = [
        (row.get("name"), row.get("of")) for row in rows_of_table(connection, tables, SCALARS)
    ]
    for name, of in described[: MOST_SCALARS + 1]:
        values = np.full(len(numbers.get(of, ())), np.nan)
        if of in VALUES and VALUES[of] in tables:
            pairs = _numbers_in(
                connection, tables, VALUES[of], "WHERE scalar = ? AND value IS NOT NULL", name
            )
            rows = _rows_of(pairs[of], numbers[of])
            _raise_any(
                f"{VALUES[of]}, scalar {shown(name)}: {of} {number} is not in the {of} table; remove it"
                for number in pairs[of][rows < 0]
            )
            values[rows] = pairs["value"]
        yield MeshScalar(name, read_only(values), of)
    known = [name for name, _ in described]
    for table in VALUES.values():
        if "scalar" in tables.get(table, ()):
            _raise_any(
                f"{table}: scalar {shown(scalar)} is not in the {SCALARS} table; remove its values"
                for (scalar,) in connection.execute(f"SELECT DISTINCT scalar FROM {table}")
                if scalar not in known
            )


# Inserting the rows of a scene.

CHUNK: Final = 1 << 16
"""Rows that are converted at once. To convert all rows would take ten times the memory of the arrays."""


def insert_rows(connection: sqlite3.Connection, scene: Scene) -> None:
    """Insert the rows of a scene into tables that are empty; rows are counted from 1."""
    mesh = scene.mesh
    for table in ROW_TABLES.values():
        value: Any = scene if table.name == SCENE else vars(scene)[table.name]
        rows = value if not table.is_single else [] if value is None else [value]
        values = ((number, *row_values(table.columns, row)) for number, row in enumerate(rows, 1))
        _insert(connection, table.name, (NUMBER, *(column.name for column in table.columns)), values)
    _insert(connection, NODES, ("node", *AXES), _numbered(*mesh.coordinates.T))
    connection.executemany(
        # A triangle repeats its third node.
        f"INSERT INTO {POLYGONS} (polygon, part, {', '.join(CORNERS)})"
        " VALUES (?1, ?2, ?3 + 1, ?4 + 1, ?5 + 1, nullif(?6, ?5) + 1)",
        _numbered(np.array(mesh.part_names, object)[mesh.part_numbers], *mesh.node_numbers.T),
    )
    _insert(connection, MESH, (NUMBER, "crease_angle"), [(1, mesh.crease_angle)])
    for number, scalar in enumerate(mesh.scalars, 1):
        _insert(connection, SCALARS, (NUMBER, "name", "of"), [(number, scalar.name, scalar.of)])
        # NaN becomes NULL.
        values = ((row, scalar.name, value) for row, value in _numbered(scalar.values))
        _insert(connection, VALUES[scalar.of], (scalar.of, "scalar", "value"), values)


def _insert(
    connection: sqlite3.Connection, table: str, columns: tuple[str, ...], rows: Iterable[tuple[Any, ...]]
) -> None:
    marks = ", ".join("?" * len(columns))
    connection.executemany(
        f"INSERT INTO {quoted(table)} ({', '.join(map(quoted, columns))}) VALUES ({marks})", rows
    )


def _numbered(*columns: AnyArray) -> Iterator[tuple[Any, ...]]:
    """The rows of some columns, each after its number from 1."""
    for first in range(0, len(columns[0]), CHUNK):
        chunk = (column[first : first + CHUNK].tolist() for column in columns)
        yield from zip(counted(first + 1), *chunk, strict=False)
