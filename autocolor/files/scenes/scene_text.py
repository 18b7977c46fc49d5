"""Writing a scene as the text of a scene file; reading it back gives the same scene."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from autocolor.scene.columns.column import fields_of
from autocolor.scene.columns.row_kinds import Nested, Rows
from autocolor.scene.columns.rows import plain
from autocolor.scene.scene import Scene

BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]{1,100}")


def scene_text(scene: Scene, mesh_files: Sequence[Mapping[str, str]]) -> str:
    """The scene as TOML, with all its tables; `mesh_files` are its `[[mesh]]` tables (see SceneReport).

    The scene's name is not written, as it is given by the name of the folder or file.
    """
    tables = plain(scene)
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items()}
    keys = {
        key: value
        for key, value in tables.items()
        if key != "name" and (not isinstance(kinds[key], (Nested, Rows)) or (key, value) == ("lights", []))
    }
    blocks = [_table("", keys), _table("[view]", tables["view"])]
    for row, files in enumerate(mesh_files):
        angle = {} if row else {"crease_angle": scene.mesh.crease_angle}
        blocks.append(_table("[[mesh]]", {**files, **angle}))
    for name, kind in kinds.items():
        if isinstance(kind, Rows):
            blocks.extend(_rows(name, kind, tables[name]))
    return "\n".join(blocks)


def _rows(name: str, kind: Rows, rows: Any) -> Iterator[str]:
    """The rows of a table, as [name.ROW] tables or as [[name]] tables."""
    for keys in rows:
        if kind.by_name:
            others = {key: value for key, value in keys.items() if key != "name"}
            yield _table(f"[{name}.{_key(keys['name'])}]", others)
        else:
            yield _table(f"[[{name}]]", keys)


def _table(header: str, keys: Any) -> str:
    """A table with a line for each key; a table of tables, such as flaps, has a line for each inner table."""
    lines = [header] if header else []
    for key, value in keys.items():
        if isinstance(value, Mapping) and all(isinstance(inner, Mapping) for inner in value.values()):
            lines += [f"{key}.{_key(name)} = {_value(inner)}" for name, inner in value.items()]
        else:
            lines.append(f"{key} = {_value(value)}")
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if BARE_KEY.fullmatch(name) else _value(name)


def _value(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_value(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, (str, bool)):
        # TOML needs the escapes of JSON, and one for DEL.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)
