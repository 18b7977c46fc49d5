"""The rows of a store as a scene, and a scene as rows.

Measured, for a million nodes and a million quads: `np.fromiter` over the chained rows reads them in 1.4 s;
`fetchall` and `np.array` take 3.6 s, chunks of `fetchmany` 3 s. Not reading row numbers without gaps, and not
checking the types of STRICT tables, saves 1 s. Two node numbers packed in one integer would save a tenth, and
numbers in place of part names another tenth; neither is worth it. `executemany` of zipped columns writes the
rows in 2.6 s, fifty rows a statement in 2.2 s, and `ignore_check_constraints` gains nothing.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping
from itertools import chain, islice
from typing import Any, Final

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

PYTHON_TYPES: Final = {"integer": int, "real": float, "text": str, "null": type(None)}
"""The types of values in Python, by their names in SQLite."""

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
        table: rows_of_table(connection, table, tables[table].columns, NUMBER)
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
    part_rows = rows_of.get("parts", [])
    parts = {str(row.get("name")): plain_row(ROW_TABLES["parts"].columns, row) for row in part_rows}
    if len(parts) < len(part_rows):
        problems.append("parts: names must be unique, not repeated; rename one")
    _validated(ROW_TABLES["parts"], part_rows, problems)
    if "surfaces" in rows_of:
        problems.extend(islice(_unknown_surfaces(part_rows, rows_of["surfaces"]), MOST_PROBLEMS))
    if problems:
        raise InputError(problems[:MOST_PROBLEMS])
    mesh = mesh_of(connection, tables, tuple(parts) if part_rows else None)
    return _report(mesh, parts, fields, "surfaces" in rows_of, surfaces)


def _unknown_surfaces(parts: list[dict[str, SqlValue]], surfaces: list[dict[str, SqlValue]]) -> Iterator[str]:
    """A problem for each part whose surface has no row.

    Tools leave foreign keys unchecked unless they are asked to check them, and SQLite's own error names no
    row, so references are checked here.
    """
    names = {str(row.get("name")): None for row in surfaces}
    for number, row in enumerate(parts, 1):
        surface = row.get("surface")
        if surface is not None and surface not in names:
            advice = nearest(str(surface), names) or "; correct it"
            yield f"parts, row {number}: surface {shown(surface)} is not in the surface table{advice}"


def _report(
    mesh: Mesh,
    parts: Mapping[str, dict[str, Any]],
    fields: dict[str, Any],
    has_surfaces: bool,
    surfaces: SurfaceSource,
) -> SceneReport:
    materials = {}
    if not has_surfaces:
        # Create the surfaces that only parts name, as the surfaces of materials are created.
        materials = {part: str(table["surface"]) for part, table in parts.items() if "surface" in table}
        if surfaces == PARTS:
            fields["surfaces"] = PARTS
    skipped = ("name",) if has_surfaces else ("name", "surface")
    part_fields = {
        name: {key: value for key, value in table.items() if key not in skipped}
        for name, table in parts.items()
    }
    return scene_report([MeshReport(mesh, material_of_part=materials)], parts=part_fields, **fields)


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


def mesh_of(connection: sqlite3.Connection, tables: StoredTables, part_names: tuple[str, ...] | None) -> Mesh:
    """The mesh of a store. Without `part_names`, the polygons name the parts.

    Raises InputError with the problems, row by row.
    """
    nodes, coordinates = _nodes(connection, tables[NODES])
    polygons, corners = _polygons(connection, tables[POLYGONS])
    problems: list[str] = []
    rows = [_rows_of(corner, nodes) for corner in corners]
    for corner, node_rows in enumerate(rows):
        for row in np.flatnonzero(node_rows < 0)[:MOST_MESH_PROBLEMS].tolist():
            numbers = f"({nodes[0]} to {nodes[-1]})" if len(nodes) else "(which is empty)"
            problems.append(
                f"{POLYGONS}, row {polygons[row]}: node {corners[corner][row]} is not in the node table"
                f" {numbers}; correct it"
            )
    _raise_any(problems)
    part_numbers, names = _parts(connection, tables[POLYGONS], polygons, part_names)
    angle = _crease_angle(connection, tables)
    scalars = _scalars(connection, tables, {NODE: nodes, POLYGON: polygons})
    return Mesh(coordinates, np.stack(rows).T, part_numbers, names, angle, scalars)


def _raise_any(problems: list[str]) -> None:
    """Raise InputError with the different problems, if any."""
    if problems:
        # The third node of a triangle is its fourth too.
        raise InputError(list(dict.fromkeys(problems))[:MOST_MESH_PROBLEMS])


def _nodes(connection: sqlite3.Connection, table: StoredTable) -> tuple[Numbers, Floats]:
    """The numbers of the nodes, rising, and their coordinates, (nodes, 3)."""
    require_columns(NODES, table.columns, ("node", *AXES))

    def check() -> None:
        _refuse_types(connection, NODES, "node", ("node",), "a whole number", "integer")
        _refuse_types(connection, NODES, "node", AXES, "a number", "real", "integer")

    numbers = _keys(connection, NODES, "node", table, check)
    query = f"SELECT x, y, z FROM {NODES} NOT INDEXED ORDER BY node"
    coordinates = _fetched(connection, query, np.float64, 3 * len(numbers), check).reshape(-1, 3)
    problems = [
        f"{NODES}, row {numbers[row]}: coordinates must be finite and at most 1e30 in size, not"
        f" {coordinates[row].tolist()}; correct them"
        for row in np.flatnonzero(~(np.abs(coordinates) <= LARGEST_COORDINATE).all(axis=1))[
            :MOST_MESH_PROBLEMS
        ]
    ]
    _raise_any(problems)
    return numbers, coordinates


def _polygons(connection: sqlite3.Connection, table: StoredTable) -> tuple[Numbers, list[Numbers]]:
    """The numbers of the polygons, rising, and the numbers of the nodes at each of four corners."""
    require_columns(POLYGONS, table.columns, ("polygon", *CORNERS[:3]))
    has_fourth = CORNERS[3] in table.columns

    def check() -> None:
        _refuse_types(connection, POLYGONS, "polygon", ("polygon",), "a whole number", "integer")
        _refuse_types(connection, POLYGONS, "polygon", CORNERS[:3], "a node number", "integer")
        if has_fourth:
            rule = "a node number, or NULL for a triangle"
            _refuse_types(connection, POLYGONS, "polygon", CORNERS[3:], rule, "integer", "null")
        if "part" in table.columns:
            _refuse_types(connection, POLYGONS, "polygon", ("part",), "the name of a part", "text")

    numbers = _keys(connection, POLYGONS, "polygon", table, check)
    fourth = "ifnull(node4, node3)" if has_fourth else "node3"
    query = f"SELECT node1, node2, node3, {fourth} FROM {POLYGONS} NOT INDEXED ORDER BY polygon"
    corners = _fetched(connection, query, np.int64, 4 * len(numbers), check).reshape(-1, 4)
    return numbers, list(np.ascontiguousarray(corners.T))


def _parts(
    connection: sqlite3.Connection, table: StoredTable, polygons: Numbers, names: tuple[str, ...] | None
) -> tuple[Indices, tuple[str, ...]]:
    """The part number of each polygon, and the names of the parts."""
    if "part" not in table.columns:
        return np.zeros(len(polygons), np.intp), names or (PART,)
    rows = connection.execute(f"SELECT part FROM {POLYGONS} NOT INDEXED ORDER BY polygon")
    if names is None:
        number_of: dict[tuple[str], int] = {}
        numbers = np.fromiter(
            (number_of.setdefault(row, len(number_of)) for row in rows), np.intp, len(polygons)
        )
        return numbers, tuple(name for (name,) in number_of)
    number_of = {(name,): number for number, name in enumerate(names)}
    numbers = np.fromiter((number_of.get(row, -1) for row in rows), np.intp, len(polygons))
    problems = []
    for row in np.flatnonzero(numbers < 0)[:MOST_MESH_PROBLEMS].tolist():
        query = f"SELECT part FROM {POLYGONS} WHERE polygon = ?"
        (name,) = connection.execute(query, (int(polygons[row]),)).fetchone()
        problems.append(
            f"{POLYGONS}, row {polygons[row]}: part {shown(name)} is not in the part"
            f" table{nearest(name, names) or '; correct it, or add the part'}"
        )
    _raise_any(problems)
    return numbers, names


def _crease_angle(connection: sqlite3.Connection, tables: StoredTables) -> float:
    rows = rows_of_table(connection, MESH, tables[MESH].columns, NUMBER) if MESH in tables else []
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
    rows = rows_of_table(connection, SCALARS, tables[SCALARS].columns, NUMBER)
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
        require_columns(table, tables[table].columns, ("scalar", of, "value"))
        for column, rule, types in (
            (of, f"the number of a {of}", ("integer",)),
            ("value", "a number, or NULL", ("real", "integer", "null")),
        ):
            _refuse_types(connection, table, of, (column,), rule, *types)
        query = f"SELECT {of}, value FROM {table} WHERE scalar = ? AND value IS NOT NULL ORDER BY {of}"
        # A double does not hold every whole number.
        pairs = np.fromiter(connection.execute(query, (name,)), [("key", np.int64), ("value", np.float64)])
        keys = pairs["key"]
        rows = _rows_of(keys, numbers)
        if (rows < 0).any():
            missing = int(keys[rows < 0][0])
            raise InputError(
                f"{table}, scalar {shown(name)}: {of} {missing} is not in the {of} table; remove its value"
            )
        values[rows] = pairs["value"]
    return MeshScalar(name, read_only(values), of)


def _rows_of(wanted: Numbers, numbers: Numbers) -> Indices:
    """The rows of wanted numbers among rising numbers; -1 for a number that is missing."""
    if not len(numbers):
        return np.full(len(wanted), -1, np.intp)
    first, last = int(numbers[0]), int(numbers[-1])
    if last - first == len(numbers) - 1:
        # Without gaps, which is the usual case.
        is_there = (wanted >= first) & (wanted <= last)
        return np.where(is_there, wanted - first, -1)
    rows = np.minimum(np.searchsorted(numbers, wanted), len(numbers) - 1)
    return np.where(numbers[rows] == wanted, rows, -1)


def _keys(
    connection: sqlite3.Connection, name: str, key: str, table: StoredTable, check: Callable[[], None]
) -> Numbers:
    """The numbers of the rows of a table, rising. If they have no gaps, only the first and last are read.

    NOT INDEXED: a damaged index could have other rows than its table.
    """
    if not table.is_strict:
        check()
    query = f"SELECT count(*), min({key}), max({key}) FROM {name} NOT INDEXED"
    count, first, last = connection.execute(query).fetchone()
    require_memory(BYTES_OF_ROW * count, f"{name}: to read {count:,} rows", "leave rows out")
    if table.key == key and count and last - first == count - 1:
        return np.arange(first, last + 1, dtype=np.int64)
    query = f"SELECT {key} FROM {name} NOT INDEXED ORDER BY {key}"
    numbers: Numbers = _fetched(connection, query, np.int64, count, check)
    repeated = numbers[1:][numbers[1:] == numbers[:-1]]
    if len(repeated):
        raise InputError(
            f"{name}: rows must have different numbers, and {repeated[0]} is repeated; number them anew"
        )
    return numbers


def _fetched(
    connection: sqlite3.Connection, query: str, dtype: type, count: int, check: Callable[[], None]
) -> AnyArray:
    """The values of all rows of a query, in one array. Raises InputError unless they are `count` numbers."""
    try:
        return np.fromiter(chain.from_iterable(connection.execute(query)), dtype, count)
    except (ValueError, TypeError):
        check()
        raise InputError(
            "the store cannot be read (it has fewer rows than it counts); bring a copy back, or rescue it"
            " with `sqlite3 FILE .recover`"
        ) from None


def _refuse_types(
    connection: sqlite3.Connection, table: str, key: str, columns: tuple[str, ...], rule: str, *types: str
) -> None:
    """Raise InputError for the rows with a value of another type."""
    listed = ", ".join(f"'{name}'" for name in types)
    wrong = " OR ".join(f"typeof({column}) NOT IN ({listed})" for column in columns)
    names = ", ".join((key, *columns))
    query = f"SELECT {names} FROM {table} NOT INDEXED WHERE {wrong} LIMIT {MOST_MESH_PROBLEMS}"
    problems = []
    for number, *values in connection.execute(query).fetchall():
        for column, value in zip(columns, values, strict=True):
            if not isinstance(value, tuple(PYTHON_TYPES[name] for name in types)):
                text = "missing" if value is None else shown(value)
                problems.append(
                    f"{table}, row {shown(number)}: {column} must be {rule}, not {text}; correct it"
                )
    _raise_any(problems)


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
