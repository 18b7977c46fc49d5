"""The text of a scene file: written for a scene, or an existing text edited until it gives the scene.

To edit, the text is read, and the differences between the scene that it gives and the wanted scene are
changed in its values; `toml_edit` makes the text give these values, and everything else stays as it was
written. This is repeated until both scenes are equal, because omitted keys are created from the given ones:
lights, for example, depend on the view.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.files.scene_toml.toml_edit import FILE_TABLES, ORDERED, edited_toml, item_numbers
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT, parsed_toml
from autocolor.scene.columns import MISSING, Row, difference, fields_of, from_plain, to_plain, with_values
from autocolor.scene.row_kinds import RowList, without_name
from autocolor.scene.scene import Scene

BY_NAME: Final = ("parts", "surfaces")
"""The tables of a scene file whose rows are tables by name; rows of other tables have the key `name`."""

ALWAYS_WRITTEN: Final = ("eye", "direction", "target", "object_color")
"""Keys that are always written: a view needs them, and surfaces without a color are given different ones."""


def scene_text(scene: Scene, mesh_files: Sequence[Mapping[str, Any]]) -> str:
    """The scene as TOML, with all keys but its name; `mesh_files` are its `[[mesh]]` tables."""
    entries = with_crease_angle(mesh_files, scene.mesh.crease_angle)
    return (edited_toml(b"", {**tables_of(scene), "mesh": entries}) or b"").decode()


def with_crease_angle(entries: Sequence[Mapping[str, Any]], angle: float) -> list[dict[str, Any]]:
    """`[[mesh]]` tables with a crease angle: in each table that has the key, else in the first table."""
    tables = [dict(entry) for entry in entries]
    for table in [table for table in tables if "crease_angle" in table] or tables[:1]:
        table["crease_angle"] = angle
    return tables


def tables_of(scene: Scene, *, sparse: bool = False) -> dict[str, Any]:
    """The tables of a scene as keys and plain values: parts and surfaces by name.

    If `sparse`, keys whose values are their defaults are left out; empty tables of a light always are.
    """
    keys_of_row = sparse_row if sparse else _plain_row
    tables = to_plain(scene)
    del tables["name"]
    for name, field in fields_of(Scene).items():
        value = vars(scene)[name]
        if name in BY_NAME:
            tables[name] = {row.name: without_name(keys_of_row(row)) for row in value}
        elif isinstance(field.kind, RowList):
            tables[name] = [keys_of_row(row) for row in value]
        elif sparse and field.default is not MISSING and value == field.default:
            tables.pop(name, None)
        elif isinstance(value, Row) and name in tables:
            tables[name] = keys_of_row(value)
    # Without the key, lights would be created.
    return {key: value for key, value in tables.items() if value not in ([], {}) or key == "lights"}


def _plain_row(row: Row) -> dict[str, object]:
    return {key: value for key, value in to_plain(row).items() if value != {}}


def sparse_row(row: Row) -> dict[str, object]:
    """The row as keys and plain values, without keys whose values are their defaults."""
    keys = to_plain(row)
    required = [name for name, field in fields_of(type(row)).items() if field.default is MISSING]
    given = {key: keys[key] for key in (*required, *ALWAYS_WRITTEN) if key in keys}
    changes = difference(from_plain(type(row), given), row)
    for key, value in vars(row).items():
        if isinstance(value, Row) and key in keys:
            keys[key] = sparse_row(value)
        elif isinstance(value, tuple) and value and isinstance(value[0], Row):
            keys[key] = {inner.name: without_name(sparse_row(inner)) for inner in vars(row)[key]}
    return {key: value for key, value in keys.items() if key in given or key in changes}


# Editing a text.

MOST_ROUNDS: Final = 6
"""Limit: a text needs at most three rounds: for written keys, for their order, for created keys."""

Tables = Mapping[str, Any]


def edited_to(data: bytes | None, scene: Scene, path: Path, reports: list[MeshReport]) -> bytes | None:
    """The text of a scene file, edited until it gives the scene; its mesh and its name may differ.

    `reports` are the meshes that the text names. None if there is no text, or if it cannot be read, or is too
    long, or if no edit makes it give the scene.
    """
    for _ in range(MOST_ROUNDS):
        if data is None or len(data) > LARGEST_TEXT:
            return None
        try:
            current = read_scene_file(path, data=data, meshes=reports).scene
        except InputError:
            return None
        if with_values(current, {"mesh": scene.mesh, "name": scene.name}).equals(scene):
            return data
        document = parsed_toml(data, path.name)
        wanted = _changed(document, tables_of(current), tables_of(scene), tables_of(scene, sparse=True))
        data = edited_toml(data, wanted)
    return None


def _changed(written: Tables, before: Tables, after: Tables, sparse: Tables) -> dict[str, Any]:
    """A written table with the values changed that differ between two tables.

    New keys are added if the sparse table has them. A table that is not written is added with its sparse
    values, so that it is valid alone.
    """
    table = {key: value for key, value in written.items() if key in after or key not in before}
    for key, value in after.items():
        given = written.get(key, {} if key in BY_NAME else None)
        if repr(before.get(key)) == repr(value):
            continue
        if key not in before:
            if key in sparse:
                table[key] = sparse[key]
        elif isinstance(value, Mapping) and isinstance(before[key], Mapping) and isinstance(given, Mapping):
            fresh = sparse.get(key, value)
            table[key] = inner = _changed(given, before[key], value, fresh)
            if key in ORDERED and list(before[key]) != list(value):
                table[key] = {name: inner.get(name, fresh.get(name, value[name])) for name in value}
        elif isinstance(value, list) and key in FILE_TABLES:
            numbers = item_numbers(given or (), value)
            table[key] = [
                row if number is None else _changed(given[number], before[key][number], whole, row)
                for number, whole, row in zip(numbers, value, sparse.get(key, ()), strict=True)
            ]
        else:
            table[key] = sparse.get(key, value) if isinstance(value, Mapping) else value
    return table
