"""The text of a scene file: written for a scene, or an existing text edited until it gives the scene.

To edit, the text is read, and the differences between the scene that it gives and the wanted scene are
changed in its values; `toml_edit` makes the text give these values, and everything else stays as it was
written. This is repeated until both scenes are equal, because omitted keys are created from the given ones:
lights, for example, depend on the view.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.meshes.repair import COMPUTED
from autocolor.files.scene_toml.toml_edit import edited_toml, item_numbers
from autocolor.files.scene_toml.toml_text import parsed_toml, table_text, toml_key
from autocolor.scene.columns import MISSING, Row, fields_of, from_plain, to_plain, with_values
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.lights import Light
from autocolor.scene.row_kinds import NamedRows, Nested, RangesByName, RowList, without_name
from autocolor.scene.scene import Scene

FILE_TABLES: Final = ("view", "views", "scalar", "mesh", "parts", "surfaces", "lights")
"""The tables of a scene file, in the order in which they are written."""

BY_NAME: Final = ("parts", "surfaces")
"""The tables of a scene file whose rows are tables by name; rows of other tables have the key `name`."""

ALWAYS_WRITTEN: Final = ("eye", "direction", "target", "object_color")
"""Keys that are always written: a view needs them, and surfaces without a color are given different ones."""


def scene_text(
    scene: Scene, mesh_files: Sequence[Mapping[str, str]], *, without_defaults: bool = False
) -> str:
    """The scene as TOML, with all its tables; `mesh_files` are its `[[mesh]]` tables (see SceneReport).

    Keys whose values are their defaults can be left out. The scene's name is not written, as it is given by
    the name of the folder or file.
    """
    tables = tables_of(scene, sparse=without_defaults)
    entries: list[dict[str, Any]] = [dict(files) for files in mesh_files]
    if entries:
        # The first table has the crease angle.
        entries[0]["crease_angle"] = scene.mesh.crease_angle
    tables["mesh"] = [sparse_entry(entry) for entry in entries] if without_defaults else entries
    keys = {
        key: value
        for key, value in tables.items()
        if key not in FILE_TABLES or (key, value) == ("lights", [])
    }
    blocks = [table_text("", keys)] if keys else []
    for name in FILE_TABLES:
        table = tables.get(name)
        if isinstance(table, list):
            blocks += [table_text(f"[[{name}]]", row) for row in table]
        elif name in BY_NAME:
            blocks += [table_text(f"[{name}.{toml_key(key)}]", row) for key, row in tables[name].items()]
        elif table is not None:
            blocks.append(table_text(f"[{name}]", table))
    return "\n".join(blocks)


def tables_of(scene: Scene, *, sparse: bool = False) -> dict[str, Any]:
    """The tables of a scene as keys and plain values: parts and surfaces by name.

    If `sparse`, keys whose values are their defaults are left out; empty tables of a light always are.
    """
    keys_of_row = sparse_row if sparse else _plain_row
    tables: dict[str, Any] = {}
    for name, field in fields_of(Scene).items():
        value, kind = vars(scene)[name], field.kind
        if name in BY_NAME:
            tables[name] = {row.name: without_name(keys_of_row(row)) for row in value}
        elif isinstance(kind, RowList):
            tables[name] = [keys_of_row(row) for row in value]
        elif isinstance(kind, Nested) and value is not None:
            tables[name] = keys_of_row(value)
        elif name != "name" and not (value == field.default and (sparse or value is None)):
            tables.update(kind.to_plain(name, value))
    return tables


def _plain_row(row: Row) -> dict[str, object]:
    return {key: value for key, value in to_plain(row).items() if value != {}}


def sparse_entry(entry: Mapping[str, Any]) -> dict[str, Any]:
    """A `[[mesh]]` table without keys whose values are their defaults."""
    defaults = {"up": "z", "scale": 1.0, "normals": COMPUTED, "crease_angle": CREASE_ANGLE}
    return {key: value for key, value in entry.items() if value != defaults.get(key)}


def sparse_row(row: Row) -> dict[str, object]:
    """The row as keys and plain values, without keys whose values are their defaults."""
    keys = to_plain(row)
    required = [name for name, field in fields_of(type(row)).items() if field.default is MISSING]
    always = (*required, *ALWAYS_WRITTEN)
    given = {key: keys[key] for key in always if key in keys}
    model = {key: keys[key] for key in ("model",) if key in keys}
    default = to_plain(from_plain(type(row), given))
    of_model = to_plain(from_plain(type(row), {**given, **model}))
    if isinstance(row, Light):
        keys["flaps"] = {axis: sparse_row(flap) for axis, flap in vars(row.flaps).items() if flap is not None}
    for name, field in fields_of(type(row)).items():
        if isinstance(field.kind, NamedRows) and name in keys:
            keys[name] = {inner.name: without_name(sparse_row(inner)) for inner in vars(row)[name]}
    return {
        key: value
        for key, value in keys.items()
        if key in always or value != (default if key in model else of_model).get(key)
    }


# Editing a text.

MOST_ROUNDS: Final = 6
"""Limit: a text needs at most three rounds: for written keys, for their order, for created keys."""

ORDERED: Final = (
    "surfaces",
    *(name for name, field in fields_of(Scene).items() if isinstance(field.kind, RangesByName)),
)
"""The tables whose keys have an order."""

Tables = Mapping[str, Any]


def edited_to(
    data: bytes, scene: Scene, read: Callable[[bytes], Scene], *, complete: bool = False
) -> bytes | None:
    """The text of a scene file, edited until it gives the scene; its mesh and its name may differ.

    `read` reads a text for the scene's mesh, or raises InputError. If `complete`, all keys and rows are
    written, with values as in a new file. None if the text cannot be read, or if no edit makes it give the
    scene.
    """
    edited: bytes | None = data
    for _ in range(MOST_ROUNDS):
        if edited is None:
            return None
        try:
            current = read(edited)
        except InputError:
            return None
        document = parsed_toml(edited, "scene.toml")
        is_same = with_values(current, {"mesh": scene.mesh, "name": scene.name}).equals(scene)
        if is_same and not complete:
            return edited
        if is_same:
            wanted = {**document, **tables_of(scene)}
        else:
            wanted = _changed(document, tables_of(current), tables_of(scene), tables_of(scene, sparse=True))
        # Without the key, lights would be created.
        given = {
            key: value for key, value in wanted.items() if value != [] or key == "lights" or key in document
        }
        before, edited = edited, with_document(edited, given)
        if is_same and edited == before:
            return edited
    return None


def with_document(data: bytes, document: Tables) -> bytes | None:
    """The text of a scene file, edited until it gives these values; None if no edit does."""
    text = edited_toml(data.decode(), document, FILE_TABLES, ORDERED)
    return None if text is None else text.encode()


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
            inner = _changed(given, before[key], value, sparse.get(key, value))
            if key in ORDERED and list(before[key]) != list(value):
                inner = {
                    name: inner.get(name, sparse.get(key, value).get(name, value[name])) for name in value
                }
            table[key] = inner
        elif isinstance(value, list) and key in FILE_TABLES:
            table[key] = [
                row if number is None else _changed(given[number], before[key][number], whole, row)
                for number, whole, row in zip(
                    item_numbers(given or (), value), value, sparse[key], strict=True
                )
            ]
        else:
            table[key] = sparse.get(key, value) if isinstance(value, Mapping) else value
    return table
