"""Reading the mesh of a store: the node table, the polygon table and the scalars.

Measured, for a million nodes and a million quads: `np.fromiter` over the chained rows reads them in 1.4 s;
`fetchall` and `np.array` take 3.6 s, chunks of `fetchmany` 3 s. To skip the numbers of rows without gaps, and
the types of tables that check them, saves 1 s. Two node numbers packed in one integer would save a tenth, and
a number in place of a part's name a tenth; neither is worth it.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers
from autocolor.checks import LARGEST_COORDINATE, nearest, shown
from autocolor.errors import InputError
from autocolor.files.store.schema import (
    MESH,
    NODES,
    POLYGONS,
    SCALARS,
    VALUES,
    FoundTable,
    FoundTables,
    require_columns,
    small_table,
)
from autocolor.files.store.sql_columns import NUMBER, quoted
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.mesh import CREASE_ANGLES, PART, Mesh
from autocolor.scene.scalar import MOST_SCALARS, NODE, POLYGON, MeshScalar

MOST_MESH_ROWS: Final = 32_000_000
"""Assumed: the nodes, and the polygons, of a store."""

MOST_PROBLEMS: Final = 20
CORNERS: Final = ("node1", "node2", "node3", "node4")
AXES: Final = ("x", "y", "z")


def mesh_of(connection: sqlite3.Connection, tables: FoundTables, part_names: tuple[str, ...] | None) -> Mesh:
    """The mesh of a store, whose parts have these names, or those that its polygons have if it is None.

    Raises InputError with what is wrong, row by row.
    """
    nodes, coordinates = _nodes(connection, tables[NODES])
    polygons, corners = _polygons(connection, tables[POLYGONS])
    problems: list[str] = []
    rows = [_rows_of(each, nodes) for each in corners]
    for corner, found in enumerate(rows):
        for row in np.flatnonzero(found < 0)[:MOST_PROBLEMS].tolist():
            told = f"({nodes[0]} to {nodes[-1]})" if len(nodes) else "(which is empty)"
            problems.append(
                f"{POLYGONS}, row {polygons[row]}: node {corners[corner][row]} is not in the node table"
                f" {told}; correct it"
            )
    if problems:
        raise InputError(problems[:MOST_PROBLEMS])
    part_numbers, names = _parts(connection, tables[POLYGONS], polygons, part_names)
    angle = _crease_angle(connection, tables)
    scalars = _scalars(connection, tables, {NODE: nodes, POLYGON: polygons})
    return Mesh(coordinates, np.stack(rows).T, part_numbers, names, angle, scalars)


def _nodes(connection: sqlite3.Connection, table: FoundTable) -> tuple[Numbers, Floats]:
    """The numbers of the nodes, rising, and their coordinates, (nodes, 3)."""
    require_columns(NODES, table.columns, ("node", *AXES))

    def check() -> None:
        _refuse_types(connection, NODES, "node", ("node",), "a whole number", "integer")
        _refuse_types(connection, NODES, "node", AXES, "a number", "real", "integer")

    numbers = _keys(connection, NODES, "node", table, check)
    query = f"SELECT x, y, z FROM {NODES} ORDER BY node"
    coordinates = _fetched(connection, query, np.float64, 3 * len(numbers), check).reshape(-1, 3)
    problems = [
        f"{NODES}, row {numbers[row]}: coordinates must be finite and at most 1e30 in size, not"
        f" {coordinates[row].tolist()}; correct them"
        for row in np.flatnonzero(~(np.abs(coordinates) <= LARGEST_COORDINATE).all(axis=1))[:MOST_PROBLEMS]
    ]
    if problems:
        raise InputError(problems)
    return numbers, coordinates


def _polygons(connection: sqlite3.Connection, table: FoundTable) -> tuple[Numbers, list[Numbers]]:
    """The numbers of the polygons, rising, and those of the nodes at each of four corners."""
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
    query = f"SELECT node1, node2, node3, {fourth} FROM {POLYGONS} ORDER BY polygon"
    corners = _fetched(connection, query, np.int64, 4 * len(numbers), check).reshape(-1, 4)
    return numbers, list(np.ascontiguousarray(corners.T))


def _parts(
    connection: sqlite3.Connection, table: FoundTable, polygons: Numbers, names: tuple[str, ...] | None
) -> tuple[Indices, tuple[str, ...]]:
    """The part number of each polygon, and the names of the parts."""
    if "part" not in table.columns:
        return np.zeros(len(polygons), np.intp), names or (PART,)
    rows = connection.execute(f"SELECT part FROM {POLYGONS} ORDER BY polygon")
    if names is None:
        found: dict[tuple[str], int] = {}
        numbers = np.fromiter((found.setdefault(row, len(found)) for row in rows), np.intp, len(polygons))
        return numbers, tuple(name for (name,) in found)
    number_of = {(name,): number for number, name in enumerate(names)}
    numbers = np.fromiter((number_of.get(row, -1) for row in rows), np.intp, len(polygons))
    problems = []
    for row in np.flatnonzero(numbers < 0)[:MOST_PROBLEMS].tolist():
        query = f"SELECT part FROM {POLYGONS} WHERE polygon = ?"
        (name,) = connection.execute(query, (int(polygons[row]),)).fetchone()
        problems.append(
            f"{POLYGONS}, row {polygons[row]}: part {shown(name)} is not in the part"
            f" table{nearest(name, names) or '; correct it, or add the part'}"
        )
    if problems:
        raise InputError(problems)
    return numbers, names


def _crease_angle(connection: sqlite3.Connection, tables: FoundTables) -> float:
    rows = small_table(connection, MESH, tables[MESH].columns, NUMBER) if MESH in tables else []
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
    connection: sqlite3.Connection, tables: FoundTables, numbers: Mapping[str, Numbers]
) -> tuple[MeshScalar, ...]:
    """The scalars of the mesh; a value that is NULL or not there is missing."""
    if SCALARS not in tables:
        return ()
    require_columns(SCALARS, tables[SCALARS].columns, ("name", "of"))
    rows = small_table(connection, SCALARS, tables[SCALARS].columns, NUMBER)
    if len(rows) > MOST_SCALARS:
        raise InputError(
            f"{SCALARS} must have at most {MOST_SCALARS:,} rows, not {len(rows):,}; leave some out"
        )
    scalars = []
    for row, each in enumerate(rows, 1):
        name, of = each["name"], each["of"]
        if not isinstance(name, str) or not name or of not in VALUES:
            raise InputError(
                f"{SCALARS}, row {row}: it must have a name, and be of {NODE!r} or {POLYGON!r}, not"
                f" {shown(name)} of {shown(of)}; correct it"
            )
        scalars.append(_scalar(connection, tables, name, str(of), numbers[str(of)]))
    return tuple(scalars)


def _scalar(
    connection: sqlite3.Connection, tables: FoundTables, name: str, of: str, numbers: Numbers
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
        found = np.fromiter(connection.execute(query, (name,)), [("key", np.int64), ("value", np.float64)])
        keys = found["key"]
        rows = _rows_of(keys, numbers)
        if (rows < 0).any():
            missing = int(keys[rows < 0][0])
            raise InputError(
                f"{table}, scalar {shown(name)}: {of} {missing} is not in the {of} table; remove its value"
            )
        values[rows] = found["value"]
    return MeshScalar(name, read_only(values), of)


def _rows_of(wanted: Numbers, numbers: Numbers) -> Indices:
    """The rows of rising numbers that are the wanted ones; -1 where there is none."""
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
    connection: sqlite3.Connection, name: str, key: str, table: FoundTable, check: Callable[[], None]
) -> Numbers:
    """The numbers of the rows of a table, rising; of a key without gaps only the ends are read."""
    if not table.is_strict:
        check()
    count, first, last = connection.execute(f"SELECT count(*), min({key}), max({key}) FROM {name}").fetchone()
    if count > MOST_MESH_ROWS:
        raise InputError(f"{name} must have at most {MOST_MESH_ROWS:,} rows, not {count:,}; leave rows out")
    if table.key == key and count and last - first == count - 1:
        return np.arange(first, last + 1, dtype=np.int64)
    numbers: Numbers = _fetched(
        connection, f"SELECT {key} FROM {name} ORDER BY {key}", np.int64, count, check
    )
    repeated = numbers[1:][numbers[1:] == numbers[:-1]]
    if len(repeated):
        raise InputError(
            f"{name}: a number must be that of one row, not of several as {repeated[0]} is; number them anew"
        )
    return numbers


def _fetched(
    connection: sqlite3.Connection, query: str, dtype: type, count: int, check: Callable[[], None]
) -> AnyArray:
    """The values of all rows of a query in one row. Raises InputError if they are not so many numbers."""
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
    """Raise InputError for the rows with a value of a type that is none of these."""
    listed = ", ".join(f"'{each}'" for each in types)
    wrong = " OR ".join(f"typeof({column}) NOT IN ({listed})" for column in columns)
    names = ", ".join((key, *columns))
    rows = connection.execute(f"SELECT {names} FROM {table} WHERE {wrong} LIMIT {MOST_PROBLEMS}").fetchall()
    problems = []
    for number, *values in rows:
        for column, value in zip(columns, values, strict=True):
            if _type_of(value) not in types:
                found = "missing" if value is None else shown(value)
                problems.append(
                    f"{table}, row {shown(number)}: {column} must be {rule}, not {found}; correct it"
                )
    if problems:
        raise InputError(problems)


def _type_of(value: object) -> str:
    if value is None:
        return "null"
    return {int: "integer", float: "real", str: "text"}.get(type(value), "blob")


# -------------------- mesh_inserts
# Writing the mesh of a store: the rows of the node table, the polygon table and the scalars.
#
# Measured, for a million nodes and a million quads: `executemany` of zipped columns writes them in 2.6 s,
# fifty rows a statement in 2.2 s, and `ignore_check_constraints` gains nothing.

CHUNK: Final = 1 << 16
"""Rows that are converted at once; all of them would take ten times the memory of the arrays."""


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
    """Insert rows of their number from 1, of values, (columns, rows), NaN as NULL, and of the same text."""

    def rows() -> Iterator[tuple[Any, ...]]:
        for first in range(0, values.shape[1], CHUNK):
            lists = values[:, first : first + CHUNK].tolist()
            count = len(lists[0])
            yield from zip(
                range(first + 1, first + 1 + count), *lists, *([text] * count for text in same), strict=True
            )

    connection.executemany(_inserting(table, columns), rows())
