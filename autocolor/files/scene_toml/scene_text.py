"""The text of a scene file: written for a scene, or an existing text edited until it gives the scene.

To edit, the text is read, and the differences between the scene that it gives and the wanted scene are
changed in its values; `toml_edit` makes the text give these values, and everything else stays as it was
written. This is repeated until both scenes are equal, because omitted keys are created from the given ones:
lights, for example, depend on the view.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.scene_toml.toml_edit import edited_toml, row_numbers
from autocolor.files.scene_toml.toml_text import parsed_toml, table_text, toml_key
from autocolor.scene.columns import Row, fields_of, from_plain, to_plain, with_values
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.lights import Flap, HalfSpace, Light
from autocolor.scene.row_kinds import NamedRows, Nested, RangesByName, RowList, without_name
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import NamedView, View

FILE_TABLES: Final = ("view", "views", "scalar", "mesh", "parts", "surfaces", "lights")
"""The tables of a scene file, in the order in which they are written."""

ALWAYS_WRITTEN: Final[dict[type[Row], tuple[str, ...]]] = {
    Part: ("name", "surface"),
    # Surfaces without an object color are given different colors.
    Surface: ("name", "object_color"),
    Light: ("name", "position"),
    View: ("eye", "direction", "target"),
    NamedView: ("name", "eye", "direction", "target"),
    Flap: (),
    HalfSpace: ("name", "point", "direction"),
    Scalar: ("name",),
}
"""The keys that are also written with `without_defaults`."""


def scene_text(
    scene: Scene, mesh_files: Sequence[Mapping[str, str]], *, without_defaults: bool = False
) -> str:
    """The scene as TOML, with all its tables; `mesh_files` are its `[[mesh]]` tables (see SceneReport).

    Keys whose values are their defaults can be left out. The scene's name is not written, as it is given by
    the name of the folder or file.
    """
    tables = sparse_tables(scene) if without_defaults else _plain(scene)
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items()}
    keys = {
        key: value
        for key, value in tables.items()
        if key != "name" and (not isinstance(kinds[key], (Nested, RowList)) or (key, value) == ("lights", []))
    }
    blocks = [table_text("", keys)] if keys else []
    for name in FILE_TABLES:
        kind = kinds[name]
        if name == "mesh":
            blocks.extend(_mesh_tables(scene, mesh_files, without_defaults))
        elif isinstance(kind, RowList):
            blocks.extend(_rows(name, kind, tables[name]))
        elif name in tables:
            blocks.append(table_text(f"[{name}]", tables[name]))
    return "\n".join(blocks)


def _mesh_tables(
    scene: Scene, mesh_files: Sequence[Mapping[str, str]], without_defaults: bool
) -> Iterator[str]:
    """The `[[mesh]]` tables; the first one has the crease angle."""
    for row, files in enumerate(mesh_files):
        entry = {**files} if row else {**files, "crease_angle": scene.mesh.crease_angle}
        yield table_text("[[mesh]]", sparse_entry(entry) if without_defaults else entry)


def sparse_tables(scene: Scene) -> dict[str, Any]:
    """The tables of a scene as keys and plain values, without keys whose values are their defaults."""
    tables: dict[str, Any] = {}
    for name, field in fields_of(Scene).items():
        value, kind = vars(scene)[name], field.column.kind
        if isinstance(kind, RowList):
            tables[name] = [sparse_row(row) for row in value]
        elif isinstance(kind, Nested) and value is not None:
            tables[name] = sparse_row(value)
        elif field.default is None or value != field.default():
            tables.update(kind.to_plain(name, value))
    return tables


def sparse_entry(entry: Mapping[str, Any]) -> dict[str, Any]:
    """A `[[mesh]]` table without keys whose values are their defaults."""
    defaults = {"up": "z", "scale": 1.0, "crease_angle": CREASE_ANGLE}
    return {key: value for key, value in entry.items() if value != defaults.get(key)}


def sparse_row(row: Row) -> dict[str, object]:
    """The row as keys and plain values, without keys whose values are their defaults."""
    keys = to_plain(row)
    always = ALWAYS_WRITTEN[type(row)]
    given = {key: keys[key] for key in always if key in keys}
    model = {key: keys[key] for key in ("model",) if key in keys}
    default = to_plain(from_plain(type(row), given))
    of_model = to_plain(from_plain(type(row), {**given, **model}))
    if isinstance(row, Light):
        keys["flaps"] = {axis: sparse_row(flap) for axis, flap in vars(row.flaps).items() if flap is not None}
    for name, field in fields_of(type(row)).items():
        if isinstance(field.column.kind, NamedRows) and name in keys:
            keys[name] = {inner.name: without_name(sparse_row(inner)) for inner in vars(row)[name]}
    return {
        key: value
        for key, value in keys.items()
        if key in always or value != (default if key in model else of_model).get(key)
    }


def _rows(name: str, kind: RowList, rows: Any) -> Iterator[str]:
    """The rows of a table, as [name.ROW] tables or as [[name]] tables."""
    for keys in rows:
        if kind.by_name:
            yield table_text(f"[{name}.{toml_key(keys['name'])}]", without_name(keys))
        else:
            yield table_text(f"[[{name}]]", keys)


def _plain(scene: Scene) -> dict[str, Any]:
    """The scene as keys and plain values; a light without flaps has no table of them."""
    tables: dict[str, Any] = to_plain(scene)
    lights = [{key: value for key, value in light.items() if value != {}} for light in tables["lights"]]
    return {**tables, "lights": lights}


# Editing a text.

MOST_ROUNDS: Final = 6
"""Limit: a text needs at most three rounds: for written keys, for their order, for created keys."""

ORDERED: Final = (
    "surfaces",
    *(name for name, field in fields_of(Scene).items() if isinstance(field.column.kind, RangesByName)),
)
"""The tables whose keys have an order."""

ReadText = Callable[[bytes], Scene]
"""Reads the text of a scene file for a given mesh; raises InputError."""

Tables = Mapping[str, Any]


def edited_to(data: bytes, scene: Scene, read: ReadText) -> bytes | None:
    """The text of a scene file, edited until it gives the scene; its mesh and its name may differ.

    None if the text cannot be read, or if no edit makes it give the scene.
    """
    for _ in range(MOST_ROUNDS):
        try:
            current = read(data)
        except InputError:
            return None
        if with_values(current, {"mesh": scene.mesh, "name": scene.name}).equals(scene):
            return data
        edited = with_document(data, _changed_document(parsed_toml(data, "scene.toml"), current, scene))
        if edited is None:
            return None
        data = edited
    return None


def with_document(data: bytes, document: Tables) -> bytes | None:
    """The text of a scene file, edited until it gives these values; None if no edit does."""
    text = edited_toml(data.decode(), document, FILE_TABLES, ORDERED)
    return None if text is None else text.encode()


def completed(document: Tables, scene: Scene) -> dict[str, Any]:
    """The values of a scene file that gives the scene, with all omitted keys and rows added."""
    tables = _plain(scene)
    rows = {key: {row["name"]: without_name(row) for row in tables[key]} for key in ("parts", "surfaces")}
    tables = {key: value for key, value in {**tables, **rows}.items() if key != "name" and value != []}
    # Rows stay in the order of the scene.
    whole = _filled(document, tables)
    return {**whole, "surfaces": {name: whole["surfaces"][name] for name in tables["surfaces"]}}


def _filled(written: Any, keys: Any) -> Any:
    """Values with all keys that they omit."""
    if isinstance(written, Mapping) and isinstance(keys, Mapping):
        added = {key: value for key, value in keys.items() if key not in written}
        return {
            **{key: _filled(value, keys[key]) if key in keys else value for key, value in written.items()},
            **added,
        }
    if isinstance(written, list) and isinstance(keys, list) and len(written) == len(keys):
        return [_filled(value, row) for value, row in zip(written, keys, strict=True)]
    return written


def with_meshes(document: Tables, entries: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The values of a scene file with other `[[mesh]]` tables."""
    return {**document, "mesh": [sparse_entry(entry) for entry in entries]}


def with_crease_angle(document: Tables, angle: float) -> dict[str, Any]:
    """The values of a scene file with a crease angle: in every `[[mesh]]` with the key, else in the first."""
    tables = document["mesh"]
    has_key = [row for row, table in enumerate(tables) if "crease_angle" in table] or [0]
    meshes = [
        {**table, "crease_angle": angle} if row in has_key else table for row, table in enumerate(tables)
    ]
    return {**document, "mesh": meshes}


def _changed_document(document: Tables, old: Scene, new: Scene) -> dict[str, Any]:
    """The values of the text of the old scene, with those changed that differ in the new scene."""
    before, after = _plain(old), _plain(new)
    sparse = sparse_tables(new)
    tables = {"name": None, **dict.fromkeys(FILE_TABLES)}
    wanted = _changed(
        document,
        {key: value for key, value in before.items() if key not in tables},
        {key: value for key, value in after.items() if key not in tables},
        after,
    )
    for key in ("view", "scalar"):
        if key not in after:
            wanted.pop(key, None)
        elif key in before and key in document:
            wanted[key] = _changed(document[key], before[key], after[key], sparse[key])
        elif before.get(key) != after[key]:
            wanted[key] = sparse[key]
    for key in ("parts", "surfaces"):
        wanted[key] = _changed_named(document.get(key, {}), key, before[key], after[key], sparse[key])
    for key in ("views", "lights"):
        if before[key] != after[key]:
            wanted[key] = _changed_rows(document.get(key, []), before[key], after[key], sparse[key])
    # Without the key, lights would be created.
    return {
        key: value
        for key, value in wanted.items()
        if value or key not in FILE_TABLES or key == "lights" or value == document.get(key)
    }


def _changed(written: Tables, before: Tables, after: Tables, sparse: Tables) -> dict[str, Any]:
    """A written table with the values changed that differ between two tables.

    New keys are added if the sparse table has them.
    """
    table = {key: value for key, value in written.items() if key in after or key not in before}
    for key, value in after.items():
        if key not in before:
            if key in sparse:
                table[key] = sparse[key]
        elif isinstance(value, Mapping) and isinstance(given := written.get(key, {}), Mapping):
            inner = _changed(given, before[key], value, sparse.get(key, value))
            if key in ORDERED:
                inner = {name: inner.get(name, value[name]) for name in value}
            if inner or key in written:
                table[key] = inner
        elif before[key] != value:
            table[key] = value
    return table


def _changed_named(
    written: Tables,
    table: str,
    before: list[dict[str, Any]],
    after: list[dict[str, Any]],
    sparse: list[dict[str, Any]],
) -> dict[str, Any]:
    """A table of rows by name with the rows changed that differ; surfaces get the order of the scene."""
    olds = {row["name"]: row for row in before}
    names = [row["name"] for row in after]
    is_moved = table == "surfaces" and list(olds) != names
    rows = {}
    for row, keys in zip(after, sparse, strict=True):
        name = row["name"]
        old = olds.get(name)
        if old is not None and (name in written or table == "parts"):
            changed = _changed(
                written.get(name, {}), without_name(old), without_name(row), without_name(keys)
            )
            if changed or name in written:
                rows[name] = changed
        elif old != row or is_moved:
            rows[name] = without_name(keys)
    if table == "surfaces":
        return rows
    return {**{name: rows[name] for name in written if name in rows}, **rows}


def _changed_rows(
    written: list[dict[str, Any]],
    before: list[dict[str, Any]],
    after: list[dict[str, Any]],
    sparse: list[dict[str, Any]],
) -> list[dict[str, Any]]:
    """The rows of an array with the rows changed that differ; all rows, if none are written."""
    return [
        keys if number is None else _changed(written[number], before[number], row, keys)
        for number, row, keys in zip(row_numbers(written, after), after, sparse, strict=True)
    ]
