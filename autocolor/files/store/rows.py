"""The rows of a store as a scene, and a scene as rows.

Measured, for a million nodes and a million quads: `np.fromiter` of whole rows takes 1.2 times as long as of
the numbers of all rows in one chain (1.4 s), which needs the row numbers, and a case for gaps among them,
apart. `fetchall` and `np.array` take 3.6 s, chunks of `fetchmany` 3 s. Two node numbers packed in one
integer would save a tenth, and numbers in place of part names another tenth; neither is worth it.
`executemany` of zipped columns writes the rows in 2.6 s, fifty rows a statement in 2.2 s, and
`ignore_check_constraints` gains nothing.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers
from autocolor.budget import require_memory
from autocolor.checks import LARGEST_COORDINATE, nearest, shown
from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_report import OMITTED, SceneReport, scene_report
from autocolor.files.store.schema import (
    AXES,
    MESH,
    NODES,
    NUMBER,
    POLYGONS,
    ROW_TABLES,
    SCALARS,
    SCENE,
    VALUES,
    RowTable,
    SqlValue,
    StoredTable,
    StoredTables,
    literal,
    plain_row,
    quoted,
    require_columns,
    row_values,
    rows_of_table,
)
from autocolor.immutable import read_only
from autocolor.scene.columns import Row, RowError, from_plain, replaced
from autocolor.scene.creation import PARTS, UNASSIGNED, SurfaceSource
from autocolor.scene.defaults import default_surface
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.mesh import CREASE_ANGLES, PART, Mesh
from autocolor.scene.scalar import MOST_SCALARS, NODE, POLYGON, MeshScalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface

BYTES_OF_ROW: Final = 120
"""Measured: bytes that a row of the nodes or polygons takes while it is read, however small it is stored."""

MOST_PROBLEMS: Final = 100
MOST_MESH_PROBLEMS: Final = 20
"""Limit: the problems of one kind in the tables of the mesh."""

CORNERS: Final = ("node1", "node2", "node3", "node4")


def report_of(
    connection: sqlite3.Connection, tables: StoredTables, name: str, surfaces: SurfaceSource
) -> SceneReport:
    """The scene of the tables of a store. Missing tables and rows are created.

    `name` is for a scene whose table gives no name. Raises InputError with every problem.
    """
    rows_of = {
        table: rows_of_table(connection, table, tables[table].columns)
        for table in ROW_TABLES
        if table in tables
    }
    problems: list[str] = []
    fields: dict[str, Any] = {"name": name}
    for table, rows in rows_of.items():
        is_single = ROW_TABLES[table].is_single
        if is_single and len(rows) > 1:
            problems.append(f"{table} must have one row, not {len(rows)}; leave one")
        elif table == SCENE and rows:
            fields.update({**OMITTED, **plain_row(ROW_TABLES[SCENE].columns, rows[0])})
        elif table not in ("parts", SCENE) and (rows or not is_single):
            values = _validated(ROW_TABLES[table], rows, problems)
            fields[table] = values[0] if is_single and values else values
    part_rows, surface_rows = rows_of.get("parts", []), rows_of.get("surfaces")
    parts = {str(row.get("name")): plain_row(ROW_TABLES["parts"].columns, row) for row in part_rows}
    if len(parts) < len(part_rows):
        problems.append("parts: names must be unique, not repeated; rename one")
    _validated(ROW_TABLES["parts"], part_rows, problems)
    if surface_rows is not None:
        unknown = _unknown_surfaces(part_rows, [str(row.get("name")) for row in surface_rows])
        problems.extend(islice(unknown, MOST_PROBLEMS))
    if problems:
        raise InputError(problems[:MOST_PROBLEMS])
    mesh = mesh_of(connection, tables, tuple(parts) if part_rows else None)
    for part in parts.values():
        part.pop("name", None)
    materials = {}
    if surface_rows is None:
        # Create the surfaces that only parts name, as the surfaces of materials are created.
        materials = {name: str(part.pop("surface")) for name, part in parts.items() if "surface" in part}
        if surfaces == PARTS:
            fields["surfaces"] = PARTS
    return scene_report([MeshReport(mesh, material_of_part=materials)], parts=parts, **fields)


def _unknown_surfaces(parts: list[dict[str, SqlValue]], surfaces: list[str]) -> Iterator[str]:
    """A problem for each part whose surface has no row.

    Tools leave foreign keys unchecked unless they are asked to check them, and SQLite's own error names no
    row, so references are checked here.
    """
    names = set(surfaces)
    for number, row in enumerate(parts, 1):
        surface = row.get("surface")
        if surface is not None and surface not in names:
            advice = nearest(str(surface), surfaces) or "; correct it"
            yield f"parts, row {number}: surface {shown(surface)} is not in the surface table{advice}"


def _validated(table: RowTable, rows: list[dict[str, SqlValue]], problems: list[str]) -> tuple[Row, ...]:
    """The valid rows of a table. The problems of other rows are added to `problems`, with their places."""
    validated: list[Row] = []
    for number, row in enumerate(rows, 1):
        values = plain_row(table.columns, row)
        try:
            if table.row_class is Surface and isinstance(values.get("name"), str):
                name = values.pop("name")
                validated.append(replaced(default_surface(name, number - 1), values))
            else:
                # A part without a surface gets one when the scene is made.
                start = {"surface": UNASSIGNED} if table.row_class is Part else {}
                validated.append(from_plain(table.row_class, {**start, **values}))
        except RowError as error:
            problems.extend(
                f"{table.name}, row {number}: {problem.sentence}" for problem in error.row_problems
            )
    return tuple(validated)


# The mesh.


class NumberColumn(NamedTuple):
    """A column of numbers in a table of the mesh: what a value must be, its types in SQL, and the dtype.

    `expression` is read in place of the column if it is given.
    """

    rule: str
    types: tuple[str, ...] = ("integer",)
    dtype: type = np.int64
    expression: str = ""


COORDINATE: Final = NumberColumn("a number", ("real", "integer"), np.float64)
CORNER: Final = NumberColumn("a node number")
FOURTH: Final = NumberColumn(
    "a node number, or NULL for a triangle", ("integer", "null"), np.int64, "ifnull(node4, node3)"
)
NUMBER_COLUMNS: Final = {
    NODES: {"node": NumberColumn("a whole number"), **dict.fromkeys(AXES, COORDINATE)},
    POLYGONS: {
        "polygon": NumberColumn("a whole number"),
        **dict.fromkeys(CORNERS[:3], CORNER),
        CORNERS[3]: FOURTH,
    },
    **{
        table: {
            of: NumberColumn(f"the number of a {of}"),
            "value": NumberColumn("a number, or NULL", ("real", "integer", "null"), np.float64),
        }
        for of, table in VALUES.items()
    },
}
"""The columns of numbers of the tables of the mesh. The first one counts the rows."""


def mesh_of(connection: sqlite3.Connection, tables: StoredTables, part_names: tuple[str, ...] | None) -> Mesh:
    """The mesh of a store. Without `part_names`, the polygons name the parts.

    Raises InputError with the problems, row by row.
    """
    nodes = _numbers_in(connection, tables, NODES)
    coordinates = np.stack([nodes[axis] for axis in AXES], axis=1)
    numbers = nodes["node"]
    is_wrong = ~(np.abs(coordinates) <= LARGEST_COORDINATE).all(axis=1)
    _raise_any(
        f"{NODES}, row {numbers[row]}: coordinates must be finite and at most 1e30 in size, not"
        f" {coordinates[row].tolist()}; correct them"
        for row in np.flatnonzero(is_wrong)
    )
    polygons = _numbers_in(connection, tables, POLYGONS)
    corners = np.stack([polygons[corner] for corner in CORNERS], axis=1)
    node_numbers = _rows_of(corners, numbers)
    there = f"({numbers[0]} to {numbers[-1]})" if len(numbers) else "(which is empty)"
    _raise_any(
        f"{POLYGONS}, row {polygons['polygon'][row]}: node {corners[row, corner]} is not in the node table"
        f" {there}; correct it"
        for row, corner in zip(*np.nonzero(node_numbers < 0), strict=True)
    )
    part_numbers, names = _parts(connection, tables[POLYGONS], len(polygons), part_names)
    angle = _crease_angle(connection, tables)
    scalars = _scalars(connection, tables, {NODE: numbers, POLYGON: polygons["polygon"]})
    return Mesh(coordinates, node_numbers, part_numbers, names, angle, scalars)


def _raise_any(problems: Iterable[str]) -> None:
    """Raise InputError with the different problems, if any."""
    # The third node of a triangle is its fourth too.
    if first := list(dict.fromkeys(islice(problems, 2 * MOST_MESH_PROBLEMS))):
        raise InputError(first[:MOST_MESH_PROBLEMS])


def _numbers_in(
    connection: sqlite3.Connection, tables: StoredTables, table: str, where: str = "", *values: str
) -> AnyArray:
    """The numbers of a table of the mesh, a structured array, with rising numbers of its rows.

    Only the nodes and polygons are NOT INDEXED: a damaged index could have other rows than its table.
    """
    stored, columns = tables[table], dict(NUMBER_COLUMNS[table])
    if CORNERS[3] in columns and CORNERS[3] not in stored.columns:
        columns[CORNERS[3]] = CORNER._replace(expression=CORNERS[2])
    key = next(iter(columns))
    needed = [name for name, column in columns.items() if not column.expression]
    require_columns(table, stored.columns, ("scalar", *needed) if where else needed)
    source = f"{table} {where}" if where else f"{table} NOT INDEXED"
    if not stored.is_strict:
        _refuse_types(connection, table, columns, stored)
    (count,) = connection.execute(f"SELECT count(*) FROM {source}", values).fetchone()
    require_memory(BYTES_OF_ROW * count, f"{table}: to read {count:,} rows", "leave rows out")
    expressions = ", ".join(column.expression or name for name, column in columns.items())
    dtype = [(name, column.dtype) for name, column in columns.items()]
    try:
        rows = connection.execute(f"SELECT {expressions} FROM {source} ORDER BY {key}", values)
        numbers = np.fromiter(rows, dtype, count)
    except (ValueError, TypeError):
        raise InputError(
            f"the store cannot be read ({table} has other rows than it counts); bring a copy back, or rescue"
            " it with `sqlite3 FILE .recover`"
        ) from None
    repeated = numbers[key][1:][numbers[key][1:] == numbers[key][:-1]]
    if len(repeated):
        raise InputError(
            f"{table}: rows must have different numbers, and {repeated[0]} is repeated; number them anew"
        )
    return numbers


def _refuse_types(
    connection: sqlite3.Connection, table: str, columns: Mapping[str, NumberColumn], stored: StoredTable
) -> None:
    """Raise InputError for the rows of a table with a value of another type."""
    key = next(iter(columns))
    rules = {name: (column.types, column.rule) for name, column in columns.items() if name in stored.columns}
    if table == POLYGONS and "part" in stored.columns:
        rules["part"] = ("text",), "the name of a part"
    wrong = {
        name: f"typeof({name}) NOT IN ({', '.join(map(literal, types))})"
        for name, (types, _) in rules.items()
    }
    listed = ", ".join(f"{name}, {condition}" for name, condition in wrong.items())
    query = f"SELECT {key}, {listed} FROM {table} NOT INDEXED WHERE {' OR '.join(wrong.values())}"
    _raise_any(
        f"{table}, row {shown(number)}: {name} must be {rule}, not"
        f" {'missing' if value is None else shown(value)}; correct it"
        for number, *pairs in connection.execute(query)
        for (name, (_, rule)), value, is_wrong in zip(rules.items(), pairs[::2], pairs[1::2], strict=True)
        if is_wrong
    )


def _parts(
    connection: sqlite3.Connection, table: StoredTable, count: int, names: tuple[str, ...] | None
) -> tuple[Indices, tuple[str, ...]]:
    """The part number of each polygon, and the names of the parts."""
    if "part" not in table.columns:
        return np.zeros(count, np.intp), names or (PART,)
    rows = connection.execute(f"SELECT part FROM {POLYGONS} NOT INDEXED ORDER BY polygon")
    number_of = {(name,): number for number, name in enumerate(names or ())}
    if names is None:
        numbers = (number_of.setdefault(row, len(number_of)) for row in rows)
    else:
        numbers = (number_of.get(row, -1) for row in rows)
    part_numbers = np.fromiter(numbers, np.intp, count)
    if (part_numbers < 0).any():
        query = f"SELECT polygon, part FROM {POLYGONS} WHERE part NOT IN (SELECT name FROM parts)"
        _raise_any(
            f"{POLYGONS}, row {polygon}: part {shown(name)} is not in the part"
            f" table{nearest(name, names or ()) or '; correct it, or add the part'}"
            for polygon, name in connection.execute(f"{query} ORDER BY polygon")
        )
    return part_numbers, tuple(name for (name,) in number_of)


def _crease_angle(connection: sqlite3.Connection, tables: StoredTables) -> float:
    rows = rows_of_table(connection, MESH, tables[MESH].columns) if MESH in tables else []
    if len(rows) > 1:
        raise InputError(f"{MESH} must have one row, not {len(rows)}; leave one")
    value = rows[0].get("crease_angle") if rows else None
    try:
        return CREASE_ANGLE if value is None else CREASE_ANGLES.accepted(value)
    except (TypeError, ValueError):
        raise InputError(
            f"{MESH}, row 1: crease_angle {CREASE_ANGLES.rule()}, not {shown(value)}; correct it"
        ) from None


def _scalars(
    connection: sqlite3.Connection, tables: StoredTables, numbers: Mapping[str, Numbers]
) -> tuple[MeshScalar, ...]:
    """The scalars of the mesh; a value is missing if it is NULL or has no row."""
    if SCALARS not in tables:
        return ()
    require_columns(SCALARS, tables[SCALARS].columns, ("name", "of"))
    rows = rows_of_table(connection, SCALARS, tables[SCALARS].columns)
    if len(rows) > MOST_SCALARS:
        raise InputError(
            f"{SCALARS} must have at most {MOST_SCALARS:,} rows, not {len(rows):,}; leave some out"
        )
    scalars = []
    for row, values in enumerate(rows, 1):
        name, of = values["name"], values["of"]
        if not isinstance(name, str) or not name or of not in VALUES:
            raise InputError(
                f"{SCALARS}, row {row}: it must have a name, and be of {NODE!r} or {POLYGON!r}, not"
                f" {shown(name)} of {shown(of)}; correct it"
            )
        scalars.append(_scalar(connection, tables, name, str(of), numbers[str(of)]))
    for table in VALUES.values():
        if table in tables and "scalar" in tables[table].columns:
            query = f"SELECT scalar FROM {table} WHERE scalar NOT IN (SELECT name FROM {SCALARS}) LIMIT 1"
            for (scalar,) in connection.execute(query):
                raise InputError(
                    f"{table}: scalar {shown(scalar)} is not in the {SCALARS} table; remove its values"
                )
    return tuple(scalars)


def _scalar(
    connection: sqlite3.Connection, tables: StoredTables, name: str, of: str, numbers: Numbers
) -> MeshScalar:
    table = VALUES[of]
    values = np.full(len(numbers), np.nan)
    if table in tables:
        pairs = _numbers_in(connection, tables, table, "WHERE scalar = ? AND value IS NOT NULL", name)
        rows = _rows_of(pairs[of], numbers)
        _raise_any(
            f"{table}, scalar {shown(name)}: {of} {number} is not in the {of} table; remove its value"
            for number in pairs[of][rows < 0]
        )
        values[rows] = pairs["value"]
    return MeshScalar(name, read_only(values), of)


def _rows_of(wanted: Numbers, numbers: Numbers) -> Indices:
    """The rows of wanted numbers among rising numbers; -1 for a number that is missing."""
    if not len(numbers):
        return np.full(wanted.shape, -1, np.intp)
    first, last = int(numbers[0]), int(numbers[-1])
    if last - first == len(numbers) - 1:
        # Without gaps, which is the usual case.
        is_there = (wanted >= first) & (wanted <= last)
        return np.where(is_there, wanted - first, -1)
    rows = np.minimum(np.searchsorted(numbers, wanted), len(numbers) - 1)
    return np.where(numbers[rows] == wanted, rows, -1)


# Inserting the rows of a scene.


def insert_rows(connection: sqlite3.Connection, scene: Scene, table: RowTable) -> None:
    """Insert the rows of a scene for one table, which is empty, in their order, counted from 1."""
    insert = _inserting(table.name, (NUMBER, *(column.name for column in table.columns)))
    for number, row in enumerate(_rows_in(scene, table), 1):
        connection.execute(insert, (number, *row_values(table.columns, row)))


def _rows_in(scene: Scene, table: RowTable) -> tuple[Row, ...]:
    if table.name == SCENE:
        return (scene,)
    value = vars(scene)[table.name]
    if table.is_single:
        return () if value is None else (value,)
    rows: tuple[Row, ...] = value
    return rows


CHUNK: Final = 1 << 16
"""Rows that are converted at once. To convert all rows would take ten times the memory of the arrays."""


def insert_mesh(connection: sqlite3.Connection, mesh: Mesh) -> None:
    """Insert the rows of a mesh into tables that are empty; rows are counted from 1."""
    _insert(connection, NODES, ("node", *AXES), mesh.coordinates.T)
    names = mesh.part_names
    corners = mesh.node_numbers.T

    def polygons() -> Iterator[tuple[Any, ...]]:
        for first in range(0, corners.shape[1], CHUNK):
            rows = slice(first, first + CHUNK)
            a, b, c, d = (corners[:, rows] + 1).tolist()
            fourth = (None if third == last else last for third, last in zip(c, d, strict=True))
            parts = map(names.__getitem__, mesh.part_numbers[rows].tolist())
            yield from zip(range(first + 1, first + 1 + len(a)), parts, a, b, c, fourth, strict=True)

    connection.executemany(_inserting(POLYGONS, ("polygon", "part", *CORNERS)), polygons())
    connection.execute(_inserting(MESH, (NUMBER, "crease_angle")), (1, mesh.crease_angle))
    for number, scalar in enumerate(mesh.scalars, 1):
        row = (number, scalar.name, scalar.of)
        connection.execute(_inserting(SCALARS, (NUMBER, "name", "of")), row)
        _insert(
            connection, VALUES[scalar.of], (scalar.of, "value", "scalar"), scalar.values[None], scalar.name
        )


def _inserting(table: str, columns: tuple[str, ...]) -> str:
    names = ", ".join(map(quoted, columns))
    return f"INSERT INTO {quoted(table)} ({names}) VALUES ({', '.join('?' * len(columns))})"


def _insert(
    connection: sqlite3.Connection, table: str, columns: tuple[str, ...], values: Floats, *same: str
) -> None:
    """Insert rows of a number from 1, values, (columns, rows), and the same texts; NaN becomes NULL."""

    def rows() -> Iterator[tuple[Any, ...]]:
        for first in range(0, values.shape[1], CHUNK):
            lists = values[:, first : first + CHUNK].tolist()
            count = len(lists[0])
            yield from zip(
                range(first + 1, first + 1 + count), *lists, *([text] * count for text in same), strict=True
            )

    connection.executemany(_inserting(table, columns), rows())
