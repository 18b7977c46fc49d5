"""Parsing TOML with bounded time and memory, and finding the line of each key.

`tomllib` needs time and memory quadratic in the parts of a dotted key, and recurses into nested arrays. So
the text is first split into tokens by a regular expression, in linear time, and refused if it exceeds a
bound.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.reading import text_problem
from autocolor.scene.columns import Row, fields_of, from_plain, to_plain
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.lights import Flap, HalfSpace, Light
from autocolor.scene.row_kinds import NamedRows, Nested, RowList, without_name
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import View

LARGEST_TEXT: Final = 1 << 20
"""Largest size of a scene file, in bytes."""

MOST_NESTED: Final = 16
MOST_KEY_PARTS: Final = 8
LONGEST_WORD: Final = 100
"""Assumed: characters of a number or of a key without quotes; a scene needs a tenth of that."""

TOKEN: Final = re.compile(
    r"""
      (?P<comment> \#[^\n]* )
    | (?P<string> \"{3} (?: [^"\\] | \\. | \"{1,2}(?!\") )* (?: \"{3,5} | \Z )
                | '{3} (?: [^'] | '{1,2}(?!') )* (?: '{3,5} | \Z )
                | " (?: [^"\\\n] | \\[^\n] )* (?: " | (?=\n) | \Z | \\ )
                | ' [^'\n]* (?: ' | (?=\n) | \Z ) )
    | (?P<open> [\[{] ) | (?P<close> [\]}] )
    | (?P<newline> \n ) | (?P<comma> , ) | (?P<equals> = ) | (?P<dot> \. )
    | (?P<word> [^\s#"'\[\]{},=.]+ )
    | (?P<space> [^\S\n]+ )
    """,
    re.VERBOSE | re.DOTALL,
)

KeyPath = tuple[str | int, ...]


def parsed_toml(data: bytes, place: str, what: str = "a scene file") -> dict[str, Any]:
    """The parsed TOML text; `place` is the file's name in messages. Raises InputError with the line."""
    if problem := text_problem(data):
        raise InputError(f"{place}: {what} {problem}")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{place}, line {line}: {what} must be text in UTF-8, not bytes like"
            f" 0x{data[error.start]:02x}; save it as UTF-8"
        ) from None
    _check_bounds(text, place)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax_problem(str(error), text, place)) from None
    except (ValueError, ArithmeticError, LookupError, TypeError, RecursionError) as error:
        raise InputError(f"{place}: it must be valid TOML ({error}); correct it") from None


def _syntax_problem(message: str, text: str, place: str) -> str:
    """The parser's error message as one of ours, with file and line."""
    found = re.search(r" \(at line (\d+), column (\d+)\)$", message)
    if found:
        line, column = found[1], f"column {found[2]}"
        message = message[: found.start()]
    else:
        line, column = str(text.rstrip("\n").count("\n") + 1), "the end of the file"
        message = message.removesuffix(" (at end of document)")
    reason = message[:1].lower() + message[1:200]
    return f"{place}, line {line}: it must be valid TOML, but is not at {column} ({reason}); correct the line"


def _check_bounds(text: str, place: str) -> None:
    """Raise InputError for deep nesting, long dotted keys and long words, which are slow to parse."""
    nested = dots = 0
    for token in TOKEN.finditer(text):
        kind = token.lastgroup
        rule = ""
        if kind == "open":
            nested += 1
            if nested > MOST_NESTED:
                rule = f"brackets must be nested at most {MOST_NESTED} deep, not deeper; flatten them"
        elif kind == "close":
            nested = max(0, nested - 1)
        elif kind == "dot":
            dots += 1
            if dots >= MOST_KEY_PARTS:
                rule = f"a key must have at most {MOST_KEY_PARTS} parts between dots, not more; shorten it"
        elif kind == "word" and len(token[0]) > LONGEST_WORD:
            rule = (
                f"a number or a key must have at most {LONGEST_WORD} digits or letters, not"
                f" {len(token[0]):,}; write it shorter, or in quotes"
            )
        if rule:
            raise InputError(f"{place}, line {text.count(chr(10), 0, token.start()) + 1}: {rule}")
        if kind in ("open", "close", "newline", "comma", "equals"):
            dots = 0


def key_lines(data: bytes) -> dict[KeyPath, int]:
    """The line of each table and key of a valid TOML text, by its path; rows of arrays count from 0."""
    lines: dict[KeyPath, int] = {}
    rows: dict[KeyPath, int] = {}
    table: KeyPath = ()
    for line, statement in _statements(data.decode("utf-8", "replace").replace("\r\n", "\n")):
        array = statement.startswith("[[")
        header = statement.startswith("[")
        # Let the parser itself read the header or the key.
        path = only_path(statement if header else statement.split("=", 1)[0] + "= 0", statement)
        resolved: KeyPath = () if header else table
        for depth, part in enumerate(path):
            resolved = (*resolved, part)
            if array and depth == len(path) - 1:
                rows[resolved] = rows.get(resolved, -1) + 1
            if resolved in rows:
                lines.setdefault(resolved, line)
                resolved = (*resolved, rows[resolved])
            lines.setdefault(resolved, line)
        if header:
            table = resolved
    return lines


def only_path(text: str, statement: str) -> tuple[str, ...]:
    """The path of keys in a header, or in a statement whose value was removed."""
    try:
        value: Any = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        # An equals sign in a quoted key: parse the whole statement.
        try:
            value = tomllib.loads(statement)
        except tomllib.TOMLDecodeError:
            return ()
    path: list[str] = []
    while isinstance(value, (dict, list)) and value and len(path) < MOST_KEY_PARTS:
        if isinstance(value, list):
            value = value[0]
        else:
            key = next(iter(value))
            path.append(key)
            value = value[key]
    return tuple(path)


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Each header, and each key with its value, with the number of its first line."""
    line, first, nested = 1, 1, 0
    words: list[str] = []
    for token in TOKEN.finditer(text + "\n"):
        kind = token.lastgroup
        nested += (kind == "open") - (kind == "close")
        if kind == "newline" and nested <= 0:
            if words:
                yield first, "".join(words)
            words, nested = [], 0
        elif kind != "comment" and not (kind == "space" and not words):
            first = first if words else line
            words.append(token[0])
        line += token[0].count("\n")


# -------------------- scene_text
# Writing a scene as the text of a scene file; reading it back gives the same scene.

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
    tables = sparse_tables(scene) if without_defaults else to_plain(scene)
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items()}
    keys = {
        key: value
        for key, value in tables.items()
        if key != "name" and (not isinstance(kinds[key], (Nested, RowList)) or (key, value) == ("lights", []))
    }
    blocks = [table_text("", keys)] if keys else []
    nested = [name for name, kind in kinds.items() if isinstance(kind, Nested) and name in tables]
    blocks.extend(table_text(f"[{name}]", tables[name]) for name in nested)
    for row, files in enumerate(mesh_files):
        entry = {**files} if row else {**files, "crease_angle": scene.mesh.crease_angle}
        blocks.append(table_text("[[mesh]]", sparse_entry(entry) if without_defaults else entry))
    for name, kind in kinds.items():
        if isinstance(kind, RowList):
            blocks.extend(_rows(name, kind, tables[name]))
    return "\n".join(blocks)


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
    """The row as keys and plain values, without keys whose values are what they are if omitted."""
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
            inner = {each.name: sparse_row(each) for each in vars(row)[name]}
            keys[name] = {key: without_name(each) for key, each in inner.items()}
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
