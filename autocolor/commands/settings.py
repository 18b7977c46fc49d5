"""`--set KEY=VALUE`: setting fields of a scene by their names in a scene file.

A key is the path of a field, such as `lights.key.intensity`. A value is written as in a scene file, but needs
no quotes, and a list of names needs no brackets. `keys_after` lists keys and values for completion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.checks import nearest
from autocolor.commands.options import as_usage
from autocolor.errors import InputError, UsageError
from autocolor.files.scene_toml.toml_text import parsed_toml
from autocolor.scene.color_scales import COLOR_SCALES
from autocolor.scene.columns import REFUSED, Column, Field, Kind, Row, fields_of, keys_of, to_plain
from autocolor.scene.kinds import ColorKind, Instance, OneOf, color_names
from autocolor.scene.row_kinds import (
    NamedRows,
    Nested,
    OneRowOf,
    RangesByName,
    References,
    Referring,
    RowList,
)
from autocolor.scene.scalar import Scalar, ScaleKind
from autocolor.scene.scene import Scene

UNSET: Final = "none"
"""The value that unsets a field."""

Changes = dict[str, Any]


class FieldsInside(dict[str, Any]):
    """Settings of fields inside a field; a plain dict is a table that sets the whole field."""


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with settings KEY=VALUE, such as `lights.key.intensity=2` or `lights.key.only_parts=hood`.

    `none` unsets an optional field, such as `view.target`. All settings of a row are applied together, so
    their order does not matter. If a field is set twice, the last value counts. Raises UsageError for an
    unknown key or an invalid value.
    """
    changes: dict[tuple[str, str], Changes] = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals or not key.strip():
            raise UsageError(
                f"--set must be KEY=VALUE, not {setting!r}; write it as in lights.key.intensity=2"
            )
        key, text = key.strip(), text.strip()
        place = place_of(scene, key)
        value = _value_at(scene, field_of(place), key, text)
        _put(changes.setdefault((place.table, place.name), {}), place.path, value, key)
    with as_usage("--set: "):
        for (table, name), fields in changes.items():
            scene = _replaced(scene, table, name, fields)
    return scene


def _replaced(scene: Scene, table: str, name: str, fields: Changes) -> Scene:
    """The scene with some fields of a row changed; the table "" is the scene itself."""
    edits: dict[str, Callable[..., Scene]] = {
        "": scene.replace,
        "scalar": scene.with_scalar,
        "view": scene.with_view,
        "views": partial(scene.with_named_view, name),
        "lights": partial(scene.with_light, name),
        "surfaces": partial(scene.with_surface, name),
        "parts": partial(scene.with_part, name),
    }
    return edits[table](**fields)


def _value_at(scene: Scene, field: Field | None, key: str, text: str) -> object:
    """The value of a text for a field. Raises UsageError if it unsets a field that must have a value."""
    kind = None if field is None else field.column.kind
    names = [row.name for row in vars(scene)[kind.table]] if isinstance(kind, Referring) else []
    if text.lower() == UNSET:
        refers = field is not None and field.is_optional and isinstance(kind, Referring)
        return None if refers and text not in names else _unset(field, key, text)
    value = value_of(text)
    return _names_of(value, names) if isinstance(kind, References) and isinstance(value, str) else value


def _names_of(text: str, existing: Sequence[str]) -> list[str]:
    """The names in a text: the whole text if a row has this name, else the names between commas.

    >>> _names_of("body", []), _names_of("[body, glass]", []), _names_of("a, b", ["a, b"])
    (['body'], ['body', 'glass'], ['a, b'])
    """
    if text in existing:
        return [text]
    listed = text[1:-1] if text.startswith("[") and text.endswith("]") else text
    return [name.strip().strip("\"'") for name in listed.split(",") if name.strip()]


def _unset(field: Field | None, key: str, text: str) -> object:
    """The value of a field that the text "none" unsets, or the text itself if it is a valid value.

    Raises UsageError if the field must have a value.
    """
    if field is None or field.column.kind.validated(text, (), []) is not REFUSED:
        return text
    if field.is_optional:
        return None
    default = None if field.default is None else field.default()
    # The default unsets a field if scene files leave it out: no limit of a flap, no flaps.
    if default is not None and field.column.kind.to_plain(key, default).get(key) in (None, {}):
        return default
    rule = field.column.kind.rule()
    raise UsageError(f"--set {key}: it {rule}, not none; only an optional field can be unset")


def value_of(text: str) -> Any:
    """The text parsed as a TOML value, or the text itself if it is not TOML.

    >>> value_of("2.5"), value_of("[1, 2]"), value_of("true"), value_of("#b01020")
    (2.5, [1, 2], True, '#b01020')
    """
    # In TOML, the # of a color begins a comment, and a line break ends the value.
    if not text or text.startswith("#") or not text.isprintable():
        return text
    try:
        return parsed_toml(f"value = {text}".encode(), "--set")["value"]
    except (InputError, UnicodeEncodeError):
        return text


def _put(fields: Changes, path: tuple[str, ...], value: Any, key: str) -> None:
    """Put a value at a path of nested dictionaries, which are created as needed.

    Raises UsageError if both a whole table and a field inside it are set: the result would depend on their
    order.
    """
    for name in path[:-1]:
        fields = fields.setdefault(name, FieldsInside())
        if not isinstance(fields, FieldsInside):
            raise UsageError(f"--set {key}: {name} is also set as a whole; leave one out")
    if isinstance(fields.get(path[-1]), FieldsInside):
        raise UsageError(f"--set {key}: some of its fields are also set; leave one out")
    fields[path[-1]] = value


EXAMPLES: Final = {
    "view": "view.angle=10",
    "views": "views.hood.angle=10",
    "scalar": "scalar.name=z",
    "lights": "lights.key.intensity=2",
    "surfaces": "surfaces.body.blend=0.3",
    "parts": "parts.hood.surface=body",
}

MOST_PARTS: Final = 4
"""Limit: names in the path from a row to a field."""


class SettingPlace(NamedTuple):
    """The place of a field: its table ("" for the scene itself), its row's name, the path in the row."""

    table: str
    name: str
    path: tuple[str, ...]


def place_of(scene: Scene, key: str) -> SettingPlace:
    """The place of a key. Raises UsageError if its table or row does not exist, or if it names no field."""
    kinds = _settable()
    table, _, rest = key.partition(".")
    kind = kinds.get(table)
    if kind is None or (rest and not isinstance(kind, (Nested, RowList))):
        wrong = table if kind is None else key
        raise UsageError(f"--set {key}: there is no field {wrong!r}{nearest(table, kinds)}")
    if not isinstance(kind, (Nested, RowList)):
        return SettingPlace("", "", (table,))
    row: Row | None = None
    if isinstance(kind, RowList):
        rows = {row.name: row for row in vars(scene)[table]}
        name, field = _name_and_rest(rest, rows)
        if name is None and "." in rest:
            wrong = rest.partition(".")[0]
            raise UsageError(f"--set {key}: there is no {table[:-1]} {wrong!r}{nearest(wrong, rows)}")
        row = None if name is None else rows[name]
    else:
        name, field = "", rest
    if key == table and fields_of(Scene)[table].is_optional:
        # The key is a whole row, which can be unset.
        return SettingPlace("", "", (table,))
    if name is None or not field:
        raise UsageError(f"--set {key}: it must name a field; write it as in {EXAMPLES[table]}")
    if field == "name" and isinstance(kind, RowList):
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    path = _path_in(row, field, key)
    if len(path) > MOST_PARTS:
        raise UsageError(f"--set {key}: there is no such field; write it as in {EXAMPLES[table]}")
    return SettingPlace(table, name, path)


def _name_and_rest(text: str, names: Iterable[str]) -> tuple[str | None, str]:
    """The longest name that a text begins with, or None, and the text after the name and a period.

    A name may contain periods, and may be quoted in the text.
    """
    written = {form: name for name in names for form in (name, f'"{name}"', f"'{name}'")}
    start = max((form for form in written if f"{text}.".startswith(f"{form}.")), key=len, default=None)
    return (None, "") if start is None else (written[start], text[len(start) + 1 :])


def _path_in(row: Row | None, field: str, key: str) -> tuple[str, ...]:
    """The path of a field in a row. Raises UsageError if a row of NamedRows on it does not exist."""
    outer, _, rest = field.partition(".")
    outer_field = None if row is None else fields_of(type(row)).get(outer)
    if row is None or outer_field is None or not isinstance(outer_field.column.kind, NamedRows) or not rest:
        return tuple(field.split("."))
    names = [inner_row.name for inner_row in vars(row)[outer]]
    name, inner = _name_and_rest(rest, names)
    if inner == "name":
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    if name is not None:
        return (outer, name, *inner.split(".")) if inner else (outer, name)
    if rest[0] in "\"'" and rest[0] == rest[-1]:
        return outer, rest[1:-1]
    wrong, _, inner = rest.partition(".")
    if inner:
        noun = outer_field.column.kind.row_class.noun
        advice = nearest(wrong, names) or f"; add a {noun} with all its keys in a table"
        raise UsageError(f"--set {key}: there is no {noun} {wrong!r}{advice}")
    return outer, wrong


def field_of(place: SettingPlace) -> Field | None:
    """The field at a place; None if its row has no such field."""
    kind = _settable().get(place.table)
    return _field_at(kind.row_class if isinstance(kind, (Nested, RowList)) else Scene, place.path)


def _settable() -> Mapping[str, Kind]:
    """The kinds of the fields of a scene that `--set` can change, by name."""
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items() if name != "name"}
    return {name: kind for name, kind in kinds.items() if not isinstance(kind, Instance)}


def _field_at(cls: type[Row], path: Sequence[str]) -> Field | None:
    """The field at a path of keys in a row of a class, or None."""
    key = keys_of(cls).get(path[0])
    if key is None:
        return None
    field = fields_of(cls)[key.field]
    kind = field.column.kind
    if isinstance(kind, OneRowOf) and path[0] != key.field:
        return _field_at(next(cls for cls in kind.classes.values() if path[0] in keys_of(cls)), path)
    if isinstance(kind, Nested) and kind.inline:
        return _field_at(kind.row_class, path)
    if len(path) == 1:
        return field
    if isinstance(kind, NamedRows):
        # The row itself is optional.
        whole = Field(Column(Nested(kind.row_class), field.column.tier, field.column.help), True, None)
        return whole if len(path) == 2 else _field_at(kind.row_class, path[2:])
    return _field_at(kind.row_class, path[1:]) if isinstance(kind, Nested) else None


def keys_after(scene: Scene, start: str) -> list[str]:
    """The keys that begin with `start`, which is empty or such a key itself.

    Keys of tables and rows end in ".", keys of fields in "=". After a field's key come its values: its
    choices, or its present value.
    """
    if start.endswith("="):
        return [f"{start}{value}" for value in _values(scene, start[:-1])]
    if not start:
        return [
            f"{name}." if isinstance(kind, (Nested, RowList)) else f"{name}="
            for name, kind in _settable().items()
        ]
    table, _, rest = start[:-1].partition(".")
    kind = _settable()[table]
    if isinstance(kind, RowList):
        names = [row.name for row in vars(scene)[table]]
        if not rest:
            return [f"{start}{name}." for name in names]
        if rest in names:
            (row,) = (row for row in vars(scene)[table] if row.name == rest)
            return _fields_after(start, kind.row_class, row)
    elif not rest and isinstance(kind, Nested):
        return _fields_after(start, kind.row_class)
    place = place_of(scene, start[:-1])
    field = field_of(place)
    inner = None if field is None else field.column.kind
    if isinstance(inner, NamedRows):
        present = vars(_row_at(scene, place))[place.path[0]]
        return [f"{start}{row.name}." for row in present]
    return _fields_after(start, inner.row_class) if isinstance(inner, Nested) else []


def _fields_after(start: str, cls: type[Row], row: Row | None = None) -> list[str]:
    """The keys of a class after a start; the key of NamedRows ends in "." if there are such rows."""
    keys = []
    for key in keys_of(cls):
        field = _field_at(cls, (key,))
        if field is None or (key == "name" and cls is not Scalar):
            continue
        has_rows = isinstance(field.column.kind, NamedRows) and row is not None and bool(vars(row)[key])
        keys.append(f"{start}{key}{'.' if has_rows or isinstance(field.column.kind, Nested) else '='}")
    return keys


def _row_at(scene: Scene, place: SettingPlace) -> Any:
    """The row of a place; the scene itself for its own fields, None for a row that does not exist."""
    if not place.table:
        return scene
    rows = vars(scene)[place.table]
    return next((row for row in rows if row.name == place.name), None) if place.name else rows


def _values(scene: Scene, key: str) -> list[str]:
    """The completions of a field's value: its choices, or its present value and the names of colors."""
    place = place_of(scene, key)
    field = field_of(place)
    if field is None:
        return []
    kind = field.column.kind
    if isinstance(kind, OneOf):
        return list(kind.names)
    if isinstance(kind, OneRowOf):
        return list(kind.classes)
    if isinstance(kind, ScaleKind):
        return list(COLOR_SCALES)
    if (place.table, place.path) == ("scalar", ("name",)):
        return list(scene.scalar_names)
    if isinstance(kind, Referring) and not isinstance(kind, RangesByName):
        return [*kind.words, *(row.name for row in vars(scene)[kind.table])]
    row = _row_at(scene, place)
    value: Any = {} if row is None else to_plain(row)
    for part in place.path:
        value = value.get(part) if isinstance(value, dict) else None
    if isinstance(value, bool):
        return ["true", "false"]
    present = [] if value is None or isinstance(value, (dict, list)) else [str(value)]
    return [*present, *color_names()] if isinstance(kind, ColorKind) else present
