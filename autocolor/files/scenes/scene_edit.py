"""Changing the text of a scene file so that it gives another scene, and stays as it was written otherwise.

The text is read, and what the scene that it gives has otherwise than the wanted one is changed in it. This is
repeated until both are equal, because what a file does not say is created from what it says: lights, for
example, depend on the view.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.scenes.toml_edit import TomlText
from autocolor.files.scenes.toml_text import FILE_TABLES, KeyPath, parsed_toml, sparse_entry, sparse_tables
from autocolor.scene.columns import fields_of, to_plain, with_values
from autocolor.scene.row_kinds import RangesByName, without_name
from autocolor.scene.scene import Scene

MOST_ROUNDS: Final = 6
"""Assumed: three rounds are enough wherever any number is: one each for what is told, ordered and created."""

NEW_ROW: Final = 1 << 20
"""The number of the first row that is added to `[[lights]]` or `[[mesh]]`; the text has fewer."""

ORDERED: Final = tuple(
    (name,) for name, field in fields_of(Scene).items() if isinstance(field.column.kind, RangesByName)
)
"""The paths of tables whose keys have an order: a new one that is not the last cannot be added."""

ReadText = Callable[[bytes], Scene]
"""Reads the text of a scene file, with the mesh that it is to have; raises InputError."""

Tables = Mapping[str, Any]


def edited_to(data: bytes, scene: Scene, read: ReadText) -> bytes | None:
    """The text of a scene file, changed until it gives the scene, besides its mesh and its name.

    None if the text cannot be read, or if no change makes it give the scene.
    """
    for _ in range(MOST_ROUNDS):
        try:
            found = read(data)
        except InputError:
            return None
        if with_values(found, {"mesh": scene.mesh, "name": scene.name}).equals(scene):
            return data
        data = _changed(data, found, scene)
    return None


def completed(data: bytes, scene: Scene) -> bytes:
    """The text of a scene file that gives the scene, with the keys and rows added that it does not tell."""
    document = parsed_toml(data, "scene.toml")
    text = TomlText(data.decode(), FILE_TABLES)
    tables: dict[str, Any] = to_plain(scene)
    _complete(text, (), document, {key: tables[key] for key in tables if key not in (*FILE_TABLES, "name")})
    _complete(text, ("view",), document.get("view", {}), tables["view"])
    if "scalar" in tables:
        _complete(text, ("scalar",), document.get("scalar", {}), tables["scalar"])
    for table in ("parts", "surfaces"):
        for row in tables[table]:
            name = row.pop("name")
            _complete(text, (table, name), document.get(table, {}).get(name, {}), row)
    text.arrange("surfaces", [surface.name for surface in scene.surfaces])
    if text.has(("lights", 0)) or "lights" not in document:
        written = document.get("lights", [{}] * len(scene.lights))
        for number, row in enumerate(tables["lights"]):
            _complete(text, ("lights", number), written[number], row)
    return text.text.encode()


def _complete(text: TomlText, path: KeyPath, given: Tables, keys: Tables) -> None:
    """Set the keys of a table that are not given."""
    for key, value in keys.items():
        if key not in given:
            _set_all(text, path, {key: value})
        elif isinstance(value, Mapping) and isinstance(given[key], Mapping):
            _complete(text, (*path, key), given[key], value)


def with_meshes(data: bytes, entries: tuple[Mapping[str, Any], ...]) -> bytes:
    """The text of a scene file with other `[[mesh]]` tables."""
    text = TomlText(data.decode(), FILE_TABLES)
    if not text.has(("mesh", 0)):
        # They are written as one inline array, or not at all.
        text.remove(("mesh",))
    for row, entry in enumerate(entries):
        for key, value in sparse_entry(entry).items():
            text.set(("mesh", NEW_ROW + row, key), value)
    row = 0
    while text.has(("mesh", row)):
        text.remove(("mesh", row))
        row += 1
    return text.text.encode()


def with_crease_angle(data: bytes, angle: float) -> bytes:
    """The text of a scene file with a crease angle, in each `[[mesh]]` that gives one, else in the first."""
    text = TomlText(data.decode(), FILE_TABLES)
    tables = parsed_toml(data, "scene.toml")["mesh"]
    rows = [row for row, table in enumerate(tables) if "crease_angle" in table] or [0]
    if text.has(("mesh", 0)):
        for row in rows:
            text.set(("mesh", row, "crease_angle"), angle)
    else:
        # They are written as one inline array.
        for row in rows:
            tables[row]["crease_angle"] = angle
        text.set(("mesh",), tables)
    return text.text.encode()


def without_parts(data: bytes, names: set[str]) -> bytes:
    """The text of a scene file without some parts."""
    text = TomlText(data.decode(), FILE_TABLES)
    for name in names:
        text.remove(("parts", name))
    return text.text.encode()


def _changed(data: bytes, old: Scene, new: Scene) -> bytes:
    """The text with all that differs between the scene that it gives and another one."""
    document = parsed_toml(data, "scene.toml")
    text = TomlText(data.decode(), FILE_TABLES)
    before: dict[str, Any] = to_plain(old)
    after: dict[str, Any] = to_plain(new)
    told = sparse_tables(new)

    keys = [key for key in after if key not in (*FILE_TABLES, "name")]
    _change(text, (), {key: before[key] for key in keys}, {key: after[key] for key in keys}, after)
    if "view" in document:
        _change(text, ("view",), before["view"], after["view"], told["view"])
    elif before["view"] != after["view"]:
        _set_all(text, ("view",), told["view"])
    if "scalar" not in after:
        text.remove(("scalar",))
    elif "scalar" in before:
        _change(text, ("scalar",), before["scalar"], after["scalar"], told["scalar"])
    else:
        _set_all(text, ("scalar",), told["scalar"])
    for key in ("parts", "surfaces"):
        _change_named(text, document, key, before[key], after[key], told[key])
    if before["lights"] != after["lights"]:
        _change_lights(text, document, before["lights"], after["lights"], told["lights"])
    return text.text.encode()


def _change(text: TomlText, path: KeyPath, before: Tables, after: Tables, told: Tables) -> None:
    """Change what differs between two tables; of new keys, only those that must be told."""
    for key in before:
        if key not in after:
            text.remove((*path, key))
    for key, value in after.items():
        here = (*path, key)
        if key not in before:
            if key in told:
                _set_all(text, path, {key: told[key]})
        elif isinstance(value, Mapping) and isinstance(before[key], Mapping):
            kept = [name for name in before[key] if name in value]
            if here not in ORDERED or kept == list(value)[: len(kept)]:
                _change(text, here, before[key], value, told.get(key, value))
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
    told: list[dict[str, Any]],
) -> None:
    """Change what differs in a table of rows by name; surfaces are in the order of the scene."""
    written = document.get(table, {})
    olds = {row["name"]: row for row in before}
    names = [row["name"] for row in after]
    is_moved = table == "surfaces" and list(olds) != names
    for name in olds.keys() - set(names):
        text.remove((table, name))
    for row, keys in zip(after, told, strict=True):
        name = row["name"]
        old = olds.get(name)
        if old is not None and (name in written or table == "parts"):
            _change(text, (table, name), old, row, keys)
        elif old != row or is_moved:
            _set_all(text, (table, name), without_name(keys))
    if is_moved and not text.arrange(table, names):
        # Rows without headers of their own cannot be moved, but new ones stand after them.
        kept = [name for name in written if name in names]
        if kept != names[: len(kept)]:
            text.remove((table,))
            for name, keys in zip(names, told, strict=True):
                _set_all(text, (table, name), without_name(keys))


def _change_lights(
    text: TomlText,
    document: Tables,
    before: list[dict[str, Any]],
    after: list[dict[str, Any]],
    told: list[dict[str, Any]],
) -> None:
    """Change what differs in the table of lights, which are written all if the text has none."""
    written = document.get("lights", [])
    if not after or not text.has(("lights", 0)):
        text.remove(("lights",))
        if not after or written:
            text.set(("lights",), told)
            return
        written = []
    olds = {row["name"]: row for row in before}
    number_of = {row["name"]: number for number, row in enumerate(written)}
    names = [row["name"] for row in after]
    if len(written) == len(names):
        # A light of another name in the same place was renamed.
        for old, new in zip(tuple(number_of), names, strict=True):
            if new not in number_of and old not in names:
                number_of[new], olds[new] = number_of.pop(old), olds[old]
    for name, number in number_of.items():
        if name not in names:
            text.remove(("lights", number))
    for row, keys in zip(after, told, strict=True):
        name = row["name"]
        if name in number_of:
            _change(text, ("lights", number_of[name]), olds[name], row, keys)
        else:
            number_of[name] = NEW_ROW + len(number_of)
            _set_all(text, ("lights", number_of[name]), keys)
    text.arrange("lights", [number_of[name] for name in names])


def _set_all(text: TomlText, path: KeyPath, keys: Tables) -> None:
    """Set all keys of a table; a table of tables, such as flaps, has a line for each inner table."""
    for key, value in keys.items():
        if isinstance(value, Mapping) and all(isinstance(inner, Mapping) for inner in value.values()):
            for name, inner in value.items():
                text.set((*path, key, name), inner)
        else:
            text.set((*path, key), value)
