"""The rows of a scene in a store: writing them, and making a scene of them and of its mesh."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scenes.scene_file import OMITTED
from autocolor.files.scenes.scene_report import SceneReport, scene_report
from autocolor.files.store.mesh_rows import mesh_of
from autocolor.files.store.schema import ROW_TABLES, SCENE, FoundTables, RowTable, small_table
from autocolor.files.store.sql_columns import NUMBER, SqlValue, quoted, row_table, row_values
from autocolor.scene.columns import Row, RowError, from_plain, replaced
from autocolor.scene.creation import PARTS, UNASSIGNED, SurfaceSource
from autocolor.scene.defaults import default_surface
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface

MOST_PROBLEMS: Final = 100


def insert_rows(connection: sqlite3.Connection, scene: Scene, table: RowTable) -> None:
    """Insert the rows of a scene for one table, which is empty, in their order, counted from 1."""
    columns = (NUMBER, *(column.name for column in table.columns))
    names = ", ".join(map(quoted, columns))
    insert = f"INSERT INTO {quoted(table.name)} ({names}) VALUES ({', '.join('?' * len(columns))})"
    for number, row in enumerate(_rows_of(scene, table), 1):
        values = row_values(row)
        connection.execute(insert, (number, *(values[column.name] for column in table.columns)))


def _rows_of(scene: Scene, table: RowTable) -> tuple[Row, ...]:
    if table.name == SCENE:
        return (scene,)
    value = vars(scene)[table.name]
    if table.is_single:
        return () if value is None else (value,)
    rows: tuple[Row, ...] = value
    return rows


def report_of(
    connection: sqlite3.Connection, tables: FoundTables, name: str, surfaces: SurfaceSource
) -> SceneReport:
    """The scene of the tables that a store has; those that it has not are created.

    `name` is that of a scene that has none in its table. Raises InputError with what is wrong.
    """
    found = {
        table: small_table(connection, table, tables[table].columns, NUMBER)
        for table in ROW_TABLES
        if table in tables
    }
    problems: list[str] = []
    fields: dict[str, Any] = {"name": name}
    for table, rows in found.items():
        if ROW_TABLES[table].is_single and len(rows) > 1:
            problems.append(f"{table} must have one row, not {len(rows)}; leave one")
        elif table == SCENE and rows:
            fields.update({**OMITTED, **row_table(Scene, rows[0])})
        elif table not in ("parts", SCENE) and (rows or not ROW_TABLES[table].is_single):
            values = _held(ROW_TABLES[table], rows, problems)
            fields[table] = values[0] if ROW_TABLES[table].is_single and values else values
    parts = {str(row.get("name")): row_table(Part, row) for row in found.get("parts", [])}
    if len(parts) < len(found.get("parts", [])):
        problems.append("parts: names must be unique, not repeated; rename one")
    _held(ROW_TABLES["parts"], found.get("parts", []), problems)
    if problems:
        raise InputError(problems[:MOST_PROBLEMS])
    mesh = mesh_of(connection, tables, tuple(parts) if found.get("parts") else None)
    return _report(mesh, parts, fields, "surfaces" in found, surfaces)


def _report(
    mesh: Mesh,
    parts: Mapping[str, dict[str, Any]],
    fields: dict[str, Any],
    has_surfaces: bool,
    surfaces: SurfaceSource,
) -> SceneReport:
    materials = {}
    if not has_surfaces:
        # Surfaces that only parts name are created, as those of materials are.
        materials = {part: str(table["surface"]) for part, table in parts.items() if "surface" in table}
        if surfaces == PARTS:
            fields["surfaces"] = PARTS
    given = {
        name: {
            key: value for key, value in table.items() if key != "name" and (key != "surface" or has_surfaces)
        }
        for name, table in parts.items()
    }
    return scene_report([MeshReport(mesh, material_of_part=materials)], parts=given, **fields)


def _held(table: RowTable, rows: list[dict[str, SqlValue]], problems: list[str]) -> tuple[Row, ...]:
    """The rows of a table; what is wrong with one is added to the problems, with its place."""
    held: list[Row] = []
    for number, row in enumerate(rows, 1):
        values = row_table(table.row_class, row)
        try:
            if table.row_class is Surface and isinstance(values.get("name"), str):
                name = values.pop("name")
                held.append(replaced(default_surface(name, number - 1), values))
            else:
                # A part without a surface gets one when the scene is made.
                start = {"surface": UNASSIGNED} if table.row_class is Part else {}
                held.append(from_plain(table.row_class, {**start, **values}))
        except RowError as error:
            problems.extend(f"{table.name}, row {number}: {each.sentence}" for each in error.row_problems)
    return tuple(held)
