"""The text of a scene file: written for a scene, or an existing text edited until it gives the scene.

To edit, the text is read, and the differences between the scene that it gives and the wanted scene are
changed in it; everything else stays as it was written. This is repeated until both scenes are equal, because
omitted keys are created from the given ones: lights, for example, depend on the view.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count, takewhile
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.meshes.repair import COMPUTED
from autocolor.files.scene_toml.toml_edit import TomlText
from autocolor.files.scene_toml.toml_text import KeyPath, parsed_toml, table_text, toml_key
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
    tables = sparse_tables(scene) if without_defaults else to_plain(scene)
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
    defaults = {"up": "z", "scale": 1.0, "normals": COMPUTED, "crease_angle": CREASE_ANGLE}
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


# Editing a text.

MOST_ROUNDS: Final = 6
"""Limit: a text needs at most three rounds: for written keys, for their order, for created keys."""

NEW_ROW: Final = 1 << 20
"""The number of the first new row of a table such as `[[lights]]`; larger than any row of the text."""

ORDERED: Final = tuple(
    (name,) for name, field in fields_of(Scene).items() if isinstance(field.column.kind, RangesByName)
)
"""The paths of tables whose keys have an order, so that a new key must be the last key."""

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
        data = _edited(data, current, scene)
    return None


def completed(data: bytes, scene: Scene) -> bytes:
    """The text of a scene file that gives the scene, with all omitted keys and rows added."""
    document = parsed_toml(data, "scene.toml")
    text = TomlText(data.decode(), FILE_TABLES)
    tables: dict[str, Any] = to_plain(scene)
    _complete(text, (), document, _without_tables(tables))
    _complete(text, ("view",), document.get("view", {}), tables["view"])
    if "scalar" in tables:
        _complete(text, ("scalar",), document.get("scalar", {}), tables["scalar"])
    for table in ("parts", "surfaces"):
        for row in tables[table]:
            name = row.pop("name")
            _complete(text, (table, name), document.get(table, {}).get(name, {}), row)
    text.arrange("surfaces", [surface.name for surface in scene.surfaces])
    for table in ("views", "lights"):
        if text.has((table, 0)) or table not in document:
            written = document.get(table, [{}] * len(tables[table]))
            for number, row in enumerate(tables[table]):
                _complete(text, (table, number), written[number], row)
    return text.text.encode()


def _complete(text: TomlText, path: KeyPath, given: Tables, keys: Tables) -> None:
    """Set the keys of a table that the text omits."""
    for key, value in keys.items():
        if key not in given:
            _set_all(text, path, {key: value})
        elif isinstance(value, Mapping) and isinstance(given[key], Mapping):
            _complete(text, (*path, key), given[key], value)


def with_meshes(data: bytes, entries: tuple[Mapping[str, Any], ...]) -> bytes:
    """The text of a scene file with other `[[mesh]]` tables."""
    text = TomlText(data.decode(), FILE_TABLES)
    if not text.has(("mesh", 0)):
        # Remove an inline array of tables.
        text.remove(("mesh",))
    for row, entry in enumerate(entries):
        for key, value in sparse_entry(entry).items():
            text.set(("mesh", NEW_ROW + row, key), value)
    text.remove(*takewhile(text.has, (("mesh", row) for row in count())))
    return text.text.encode()


def with_crease_angle(data: bytes, angle: float) -> bytes:
    """The text of a scene file with a crease angle: in every `[[mesh]]` with the key, else in the first."""
    text = TomlText(data.decode(), FILE_TABLES)
    tables = parsed_toml(data, "scene.toml")["mesh"]
    rows = [row for row, table in enumerate(tables) if "crease_angle" in table] or [0]
    if text.has(("mesh", 0)):
        for row in rows:
            text.set(("mesh", row, "crease_angle"), angle)
    else:
        # The tables are one inline array.
        for row in rows:
            tables[row]["crease_angle"] = angle
        text.set(("mesh",), tables)
    return text.text.encode()


def without_parts(data: bytes, names: set[str]) -> bytes:
    """The text of a scene file without some parts."""
    text = TomlText(data.decode(), FILE_TABLES)
    text.remove(*(("parts", name) for name in names))
    return text.text.encode()


def _edited(data: bytes, old: Scene, new: Scene) -> bytes:
    """The text of the old scene, with all values that differ in the new scene changed."""
    document = parsed_toml(data, "scene.toml")
    text = TomlText(data.decode(), FILE_TABLES)
    before: dict[str, Any] = to_plain(old)
    after: dict[str, Any] = to_plain(new)
    sparse = sparse_tables(new)

    _change(text, (), _without_tables(before), _without_tables(after), after)
    if "view" in document:
        _change(text, ("view",), before["view"], after["view"], sparse["view"])
    elif before["view"] != after["view"]:
        _set_all(text, ("view",), sparse["view"])
    if "scalar" not in after:
        text.remove(("scalar",))
    elif "scalar" in before:
        _change(text, ("scalar",), before["scalar"], after["scalar"], sparse["scalar"])
    else:
        _set_all(text, ("scalar",), sparse["scalar"])
    for key in ("parts", "surfaces"):
        _change_named(text, document, key, before[key], after[key], sparse[key])
    for key in ("views", "lights"):
        if before[key] != after[key]:
            _change_rows(text, document, key, before[key], after[key], sparse[key])
    return text.text.encode()


def _without_tables(plain: Tables) -> Tables:
    """The keys of a scene that stand before all tables, with their values."""
    return {key: value for key, value in plain.items() if key not in (*FILE_TABLES, "name")}


def _change(text: TomlText, path: KeyPath, before: Tables, after: Tables, sparse: Tables) -> None:
    """Change the values that differ between two tables. New keys are written if the sparse table has them."""
    for key in before:
        if key not in after:
            text.remove((*path, key))
    for key, value in after.items():
        here = (*path, key)
        if key not in before:
            if key in sparse:
                _set_all(text, path, {key: sparse[key]})
        elif isinstance(value, Mapping) and isinstance(before[key], Mapping):
            names = [name for name in before[key] if name in value]
            if here not in ORDERED or names == list(value)[: len(names)]:
                _change(text, here, before[key], value, sparse.get(key, value))
            else:
                text.set(here, value)
        elif before[key] != value:
            text.set(here, value)


def _change_named(
    text: TomlText,
    document: Tables,
    table: str,
    before: list[dict[str, Any]],
    after: list[dict[str, Any]],
    sparse: list[dict[str, Any]],
) -> None:
    """Change the rows that differ in a table of rows by name; surfaces get the order of the scene."""
    written = document.get(table, {})
    olds = {row["name"]: row for row in before}
    names = [row["name"] for row in after]
    is_moved = table == "surfaces" and list(olds) != names
    text.remove(*((table, name) for name in olds.keys() - set(names)))
    for row, keys in zip(after, sparse, strict=True):
        name = row["name"]
        old = olds.get(name)
        if old is not None and (name in written or table == "parts"):
            _change(text, (table, name), old, row, keys)
        elif old != row or is_moved:
            _set_all(text, (table, name), without_name(keys))
    if is_moved and not text.arrange(table, names):
        # Rows without headers of their own cannot be moved, but new rows can follow them.
        remaining = [name for name in written if name in names]
        if remaining != names[: len(remaining)]:
            text.remove((table,))
            for name, keys in zip(names, sparse, strict=True):
                _set_all(text, (table, name), without_name(keys))


def _change_rows(
    text: TomlText,
    document: Tables,
    table: str,
    before: list[dict[str, Any]],
    after: list[dict[str, Any]],
    sparse: list[dict[str, Any]],
) -> None:
    """Change the rows that differ in a table such as `[[lights]]`; if the text has none, write all rows."""
    written = document.get(table, [])
    if not after or not text.has((table, 0)):
        text.remove((table,))
        # Without the key, lights would be created.
        if (after and written) or (not after and table == "lights"):
            text.set((table,), sparse)
        if written or not after:
            return
    olds = {row["name"]: row for row in before}
    number_of = {row["name"]: number for number, row in enumerate(written)}
    names = dict.fromkeys(row["name"] for row in after)
    if len(written) == len(names):
        # A row with another name in the same place was renamed.
        for old, new in zip(tuple(number_of), names, strict=True):
            if new not in number_of and old not in names:
                number_of[new], olds[new] = number_of.pop(old), olds[old]
    text.remove(*((table, number) for name, number in number_of.items() if name not in names))
    for row, keys in zip(after, sparse, strict=True):
        name = row["name"]
        if name in number_of:
            _change(text, (table, number_of[name]), olds[name], row, keys)
        else:
            number_of[name] = NEW_ROW + len(number_of)
            _set_all(text, (table, number_of[name]), keys)
    text.arrange(table, [number_of[name] for name in names])


def _set_all(text: TomlText, path: KeyPath, keys: Tables) -> None:
    """Set all keys of a table; a table of tables, such as flaps, has a line for each inner table."""
    for key, value in keys.items():
        if isinstance(value, Mapping) and all(isinstance(inner, Mapping) for inner in value.values()):
            for name, inner in value.items():
                text.set((*path, key, name), inner)
        else:
            text.set((*path, key), value)
