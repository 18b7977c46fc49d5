"""Writing a scene as the text of a scene file; reading it back gives the same scene."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from autocolor.scene.columns.column import Row, fields_of
from autocolor.scene.columns.named_row_kinds import NamedRows, without_name
from autocolor.scene.columns.row_kinds import Nested, Rows
from autocolor.scene.columns.rows import made, plain
from autocolor.scene.geometry.node_normals import CREASE_ANGLE
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.half_spaces import HalfSpace
from autocolor.scene.lights.light import Light
from autocolor.scene.scalars.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import View

BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]{1,100}")


FILE_TABLES: Final = ("view", "scalar", "mesh", "parts", "surfaces", "lights")
"""The tables of a scene file, in the order in which they are written."""

ALWAYS_WRITTEN: Final[dict[type[Row], tuple[str, ...]]] = {
    Part: ("name", "surface"),
    # A surface without an object color is given one in turn.
    Surface: ("name", "object_color"),
    Light: ("name", "position"),
    View: ("eye", "direction", "target"),
    Flap: (),
    HalfSpace: ("name", "point", "direction"),
    Scalar: ("name",),
}
"""The keys that are written even if `without_defaults` leaves out others."""


def scene_text(
    scene: Scene, mesh_files: Sequence[Mapping[str, str]], *, without_defaults: bool = False
) -> str:
    """The scene as TOML, with all its tables; `mesh_files` are its `[[mesh]]` tables (see SceneReport).

    Keys whose values are their defaults can be left out. The scene's name is not written, as it is given by
    the name of the folder or file.
    """
    tables = sparse_tables(scene) if without_defaults else plain(scene)
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items()}
    keys = {
        key: value
        for key, value in tables.items()
        if key != "name" and (not isinstance(kinds[key], (Nested, Rows)) or (key, value) == ("lights", []))
    }
    blocks = [table_text("", keys)] if keys else []
    nested = [name for name, kind in kinds.items() if isinstance(kind, Nested) and name in tables]
    blocks.extend(table_text(f"[{name}]", tables[name]) for name in nested)
    for row, files in enumerate(mesh_files):
        entry = {**files} if row else {**files, "crease_angle": scene.mesh.crease_angle}
        blocks.append(table_text("[[mesh]]", sparse_entry(entry) if without_defaults else entry))
    for name, kind in kinds.items():
        if isinstance(kind, Rows):
            blocks.extend(_rows(name, kind, tables[name]))
    return "\n".join(blocks)


def sparse_tables(scene: Scene) -> dict[str, Any]:
    """The tables of a scene as keys and plain values, without keys whose values are their defaults."""
    tables: dict[str, Any] = {}
    for name, field in fields_of(Scene).items():
        value, kind = vars(scene)[name], field.column.kind
        if isinstance(kind, Rows):
            tables[name] = [sparse_row(row) for row in value]
        elif isinstance(kind, Nested) and value is not None:
            tables[name] = sparse_row(value)
        elif field.default is None or value != field.default():
            tables.update(kind.written(name, value))
    return tables


def sparse_entry(entry: Mapping[str, Any]) -> dict[str, Any]:
    """A `[[mesh]]` table without keys whose values are their defaults."""
    defaults = {"up": "z", "scale": 1.0, "crease_angle": CREASE_ANGLE}
    return {key: value for key, value in entry.items() if value != defaults.get(key)}


def sparse_row(row: Row) -> dict[str, object]:
    """The row as keys and plain values, without keys whose values are what they are if omitted."""
    keys = plain(row)
    always = ALWAYS_WRITTEN[type(row)]
    given = {key: keys[key] for key in always if key in keys}
    model = {key: keys[key] for key in ("model",) if key in keys}
    default, of_model = plain(made(type(row), given)), plain(made(type(row), {**given, **model}))
    if isinstance(row, Light):
        keys["flaps"] = {axis: sparse_row(flap) for axis, flap in vars(row.flaps).items() if flap is not None}
    for name, field in fields_of(type(row)).items():
        if isinstance(field.column.kind, NamedRows) and name in keys:
            inner = {each.name: sparse_row(each) for each in vars(row)[name]}
            keys[name] = {key: without_name(each) for key, each in inner.items()}
    return {
        key: value
        for key, value in keys.items()
        if key in always or value != (default if key in model else of_model).get(key)
    }


def _rows(name: str, kind: Rows, rows: Any) -> Iterator[str]:
    """The rows of a table, as [name.ROW] tables or as [[name]] tables."""
    for keys in rows:
        if kind.by_name:
            yield table_text(f"[{name}.{toml_key(keys['name'])}]", without_name(keys))
        else:
            yield table_text(f"[[{name}]]", keys)


def table_text(header: str, keys: Any) -> str:
    """A table with a line for each key; a table of tables, such as flaps, has a line for each inner table."""
    lines = [header] if header else []
    for key, value in keys.items():
        if isinstance(value, Mapping) and all(isinstance(inner, Mapping) for inner in value.values()):
            lines += [f"{key}.{toml_key(name)} = {toml_value(inner)}" for name, inner in value.items()]
        else:
            lines.append(f"{key} = {toml_value(value)}")
    return "\n".join(lines) + "\n"


def toml_key(name: str) -> str:
    """The name as a key of TOML, in quotes if it needs them."""
    return name if BARE_KEY.fullmatch(name) else toml_value(name)


def toml_value(value: object) -> str:
    """The plain value as TOML; a number is written so that it reads back equal."""
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, Mapping) and not value:
        return "{}"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{toml_key(key)} = {toml_value(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, (str, bool)):
        # TOML needs the escapes of JSON, and one for DEL.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)
