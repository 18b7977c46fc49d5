"""`--set KEY=VALUE`: setting fields of a scene by the names that they have in a scene file.

A key is the path of a field, such as `lights.key.intensity`. A value is written as in a scene file, but needs
no quotes, and a list of names needs no brackets. `keys_after` lists keys and values for completion.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
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
    """Fields that are set one by one inside a field, unlike a table that is its value."""


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with each KEY=VALUE set, such as `lights.key.intensity=2` or `lights.key.only_parts=hood`.

    `none` unsets a field that may be absent, such as `view.target`. The settings of one row are applied
    together, so that their order does not matter. If a field is set twice, the last value counts. Raises
    UsageError for an unknown key or an invalid value.
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
    """The scene with other values in some of its own fields, or in fields of one row."""
    if table == "":
        return scene.replace(**fields)
    if table == "lights":
        return scene.with_light(name, **fields)
    if table == "surfaces":
        return scene.with_surface(name, **fields)
    if table == "parts":
        return scene.with_part(name, **fields)
    if table == "scalar":
        return scene.with_scalar(**fields)
    return scene.with_view(**fields)


def _value_at(scene: Scene, field: Field | None, key: str, text: str) -> object:
    """The value for a field. Raises UsageError if the field must have a value and the text unsets it."""
    kind = None if field is None else field.column.kind
    names = [row.name for row in vars(scene)[kind.table]] if isinstance(kind, Referring) else []
    if text.lower() == UNSET:
        is_absent = field is not None and field.is_optional and isinstance(kind, Referring)
        return None if is_absent and text not in names else _unset(field, key, text)
    value = value_of(text)
    return _names_of(value, names) if isinstance(kind, References) and isinstance(value, str) else value


def _names_of(text: str, known: Sequence[str]) -> list[str]:
    """The names in a text: the whole text if it is a known name, else names between commas.

    >>> _names_of("body", []), _names_of("[body, glass]", []), _names_of("a, b", ["a, b"])
    (['body'], ['body', 'glass'], ['a, b'])
    """
    if text in known:
        return [text]
    listed = text[1:-1] if text.startswith("[") and text.endswith("]") else text
    return [name.strip().strip("\"'") for name in listed.split(",") if name.strip()]


def _unset(field: Field | None, key: str, text: str) -> object:
    """The value of a field that the text "none" unsets; the text itself if the field may have it as a value.

    Raises UsageError if the field must have a value.
    """
    if field is None or field.column.kind.validated(text, (), []) is not REFUSED:
        return text
    if field.is_optional:
        return None
    default = None if field.default is None else field.default()
    # An unset value is left out of a scene file: no limit of a flap, no flaps.
    if default is not None and field.column.kind.to_plain(key, default).get(key) in (None, {}):
        return default
    rule = field.column.kind.rule()
    raise UsageError(f"--set {key}: it {rule}, not none; only a field that may be absent can be unset")


def value_of(text: str) -> Any:
    """The text parsed as a TOML value, or the text itself if it is none.

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

    Raises UsageError where both a table and a field of it are set, because the result would depend on their
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
    "scalar": "scalar.name=z",
    "lights": "lights.key.intensity=2",
    "surfaces": "surfaces.body.blend=0.3",
    "parts": "parts.hood.surface=body",
}

MOST_PARTS: Final = 4
"""Limit: names in a field's path within its row."""


class SettingPlace(NamedTuple):
    """The place of a field: its table ("" for the scene itself), the name of its row, its path in the row."""

    table: str
    name: str
    path: tuple[str, ...]


def place_of(scene: Scene, key: str) -> SettingPlace:
    """The place of a key. Raises UsageError if its table or row does not exist, or if it names no field."""
    kinds = _settable()
    table, _, rest = key.partition(".")
    kind = kinds.get(table)
    if kind is None or (rest and not isinstance(kind, (Nested, RowList))):
        raise UsageError(f"--set {key}: there is no field of this name{nearest(table, kinds)}")
    if not isinstance(kind, (Nested, RowList)):
        return SettingPlace("", "", (table,))
    row: Row | None = None
    if isinstance(kind, RowList):
        rows = {each.name: each for each in vars(scene)[table]}
        name, field = _name_and_rest(rest, rows)
        if name is None and "." in rest:
            wrong = rest.partition(".")[0]
            raise UsageError(f"--set {key}: there is no {table[:-1]} {wrong!r}{nearest(wrong, rows)}")
        row = None if name is None else rows[name]
    else:
        name, field = "", rest
    if key == table and fields_of(Scene)[table].is_optional:
        # The whole row, which can be unset.
        return SettingPlace("", "", (table,))
    if name is None or not field:
        raise UsageError(f"--set {key}: it must name one field; write it as in {EXAMPLES[table]}")
    if field == "name" and isinstance(kind, RowList):
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    path = _path_in(row, field, key)
    if len(path) > MOST_PARTS:
        raise UsageError(f"--set {key}: there is no such field; write it as in {EXAMPLES[table]}")
    return SettingPlace(table, name, path)


def _name_and_rest(text: str, names: Iterable[str]) -> tuple[str | None, str]:
    """The name that a text begins with, or None, and the text after it and a period.

    A name may contain periods and may be quoted: the longest name that matches is taken.
    """
    written = {each: name for name in names for each in (name, f'"{name}"', f"'{name}'")}
    start = max((each for each in written if f"{text}.".startswith(f"{each}.")), key=len, default=None)
    return (None, "") if start is None else (written[start], text[len(start) + 1 :])


def _path_in(row: Row | None, field: str, key: str) -> tuple[str, ...]:
    """The path of a field in a row. Raises UsageError if a row by name on it does not exist."""
    outer, _, rest = field.partition(".")
    of_row = None if row is None else fields_of(type(row)).get(outer)
    if row is None or of_row is None or not isinstance(of_row.column.kind, NamedRows) or not rest:
        return tuple(field.split("."))
    names = [each.name for each in vars(row)[outer]]
    name, inner = _name_and_rest(rest, names)
    if inner == "name":
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    if name is not None:
        return (outer, name, *inner.split(".")) if inner else (outer, name)
    if rest[0] in "\"'" and rest[0] == rest[-1]:
        return outer, rest[1:-1]
    wrong, _, inner = rest.partition(".")
    if inner:
        advice = nearest(wrong, names) or "; give a new one whole, as a table"
        noun = of_row.column.kind.row_class.noun
        raise UsageError(f"--set {key}: there is no {noun} {wrong!r}{advice}")
    return outer, wrong


def field_of(place: SettingPlace) -> Field | None:
    """The field at a place; None if its row has no such field."""
    kind = _settable().get(place.table)
    return _field_at(kind.row_class if isinstance(kind, (Nested, RowList)) else Scene, place.path)


def _settable() -> Mapping[str, Kind]:
    """The kinds of the fields of a scene that can be set, by name."""
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
        inside = next(each for each in kind.classes.values() if path[0] in keys_of(each))
        return _field_at(inside, path)
    if isinstance(kind, Nested) and kind.inline:
        return _field_at(kind.row_class, path)
    if len(path) == 1:
        return field
    if isinstance(kind, NamedRows):
        # A row by name may be absent.
        whole = Field(Column(Nested(kind.row_class), field.column.tier, field.column.help), True, None)
        return whole if len(path) == 2 else _field_at(kind.row_class, path[2:])
    return _field_at(kind.row_class, path[1:]) if isinstance(kind, Nested) else None


def keys_after(scene: Scene, start: str) -> list[str]:
    """The keys that begin with `start`: keys of tables and rows end in ".", all others in "=".

    `start` is empty or such a key itself. A whole key is followed by its values: the choices of its field, or
    its present value.
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
    """The keys of a class after a start; the key of rows by name ends in "." if the row has any."""
    keys = {key: _field_at(cls, (key,)) for key in keys_of(cls)}
    found = []
    for key, field in keys.items():
        if field is None or (key == "name" and cls is not Scalar):
            continue
        goes_on = isinstance(field.column.kind, Nested)
        goes_on |= isinstance(field.column.kind, NamedRows) and row is not None and bool(vars(row)[key])
        found.append(f"{start}{key}{'.' if goes_on else '='}")
    return found


def _row_at(scene: Scene, place: SettingPlace) -> Any:
    """The row of a place; the scene itself for its own fields, None for a row that does not exist."""
    if not place.table:
        return scene
    rows = vars(scene)[place.table]
    return next((each for each in rows if each.name == place.name), None) if place.name else rows


def _values(scene: Scene, key: str) -> list[str]:
    """The values to offer for a field: its choices, or its present value and the names of colors."""
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
        return [*kind.words, *(each.name for each in vars(scene)[kind.table])]
    row = _row_at(scene, place)
    value: Any = {} if row is None else to_plain(row)
    for part in place.path:
        value = value.get(part) if isinstance(value, dict) else None
    if isinstance(value, bool):
        return ["true", "false"]
    present = [] if value is None or isinstance(value, (dict, list)) else [str(value)]
    return [*present, *color_names()] if isinstance(kind, ColorKind) else present
