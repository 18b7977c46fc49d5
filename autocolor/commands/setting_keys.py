"""The keys of `--set KEY=VALUE`: the field that each names, and the keys that a scene has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from autocolor.checks import nearest
from autocolor.errors import UsageError
from autocolor.scene.color_scales import COLOR_SCALES
from autocolor.scene.columns import Column, Field, Kind, Row, fields_of, keys_of, to_plain
from autocolor.scene.kinds import ColorKind, Instance, OneOf, color_names
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, RangesByName, Referring, RowList
from autocolor.scene.scalar import Scalar, ScaleKind
from autocolor.scene.scene import Scene

EXAMPLES: Final = {
    "view": "view.angle=10",
    "scalar": "scalar.name=z",
    "lights": "lights.key.intensity=2",
    "surfaces": "surfaces.body.blend=0.3",
    "parts": "parts.hood.surface=body",
}

MOST_PARTS: Final = 4
"""An upper bound on the parts of a field's path within its row."""


class Place(NamedTuple):
    """Where a key leads: a table ("" for the scene itself), the name of a row in it, a path in the row."""

    table: str
    name: str
    path: tuple[str, ...]


def place_of(scene: Scene, key: str) -> Place:
    """The place of a key. Raises UsageError if there is no such table or row, or if it is no single field."""
    kinds = _settable()
    table, _, rest = key.partition(".")
    kind = kinds.get(table)
    if kind is None or (rest and not isinstance(kind, (Nested, RowList))):
        raise UsageError(f"--set {key}: there is no field of this name{nearest(table, kinds)}")
    if not isinstance(kind, (Nested, RowList)):
        return Place("", "", (table,))
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
        return Place("", "", (table,))
    if name is None or not field:
        raise UsageError(f"--set {key}: it must name one field; write it as in {EXAMPLES[table]}")
    if field == "name" and isinstance(kind, RowList):
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    path = _path_in(row, field, key)
    if len(path) > MOST_PARTS:
        raise UsageError(f"--set {key}: there is no such field; write it as in {EXAMPLES[table]}")
    return Place(table, name, path)


def _name_and_rest(text: str, names: Iterable[str]) -> tuple[str | None, str]:
    """The name that a text begins with, None if it is none of them, and what follows it after a period.

    A name may contain periods and may be quoted: the longest one that matches is taken.
    """
    written = {each: name for name in names for each in (name, f'"{name}"', f"'{name}'")}
    start = max((each for each in written if f"{text}.".startswith(f"{each}.")), key=len, default=None)
    return (None, "") if start is None else (written[start], text[len(start) + 1 :])


def _path_in(row: Row | None, field: str, key: str) -> tuple[str, ...]:
    """The path of a field in a row. Raises UsageError for a row by name inside it that is not there."""
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


def field_of(place: Place) -> Field | None:
    """The field at a place; None if its row has none there."""
    kind = _settable().get(place.table)
    return _field_at(kind.row_class if isinstance(kind, (Nested, RowList)) else Scene, place.path)


def _settable() -> Mapping[str, Kind]:
    """The kinds of the fields of a scene that can be set, by name."""
    kinds = {name: field.column.kind for name, field in fields_of(Scene).items() if name != "name"}
    return {name: kind for name, kind in kinds.items() if not isinstance(kind, Instance)}


def _field_at(cls: type[Row], path: Sequence[str]) -> Field | None:
    """The field at a path of keys in a row of a class; None if there is none."""
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
        # Each row may be absent.
        whole = Field(Column(Nested(kind.row_class), field.column.tier, field.column.help), True, None)
        return whole if len(path) == 2 else _field_at(kind.row_class, path[2:])
    return _field_at(kind.row_class, path[1:]) if isinstance(kind, Nested) else None


def keys_after(scene: Scene, start: str) -> list[str]:
    """The keys that go on where a key starts: those of tables and rows end in ".", all others in "=".

    `start` is empty or such a key itself. After a whole key come the values that its field is known to take,
    and the one that it has.
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
    """The keys of a class after a start; rows by name go on where the row has some."""
    keys = {key: _field_at(cls, (key,)) for key in keys_of(cls)}
    found = []
    for key, field in keys.items():
        if field is None or (key == "name" and cls is not Scalar):
            continue
        goes_on = isinstance(field.column.kind, Nested)
        goes_on |= isinstance(field.column.kind, NamedRows) and row is not None and bool(vars(row)[key])
        found.append(f"{start}{key}{'.' if goes_on else '='}")
    return found


def _row_at(scene: Scene, place: Place) -> Any:
    """The row of a place; the scene itself for its own fields, None for a row that it has not."""
    if not place.table:
        return scene
    rows = vars(scene)[place.table]
    return next((each for each in rows if each.name == place.name), None) if place.name else rows


def _values(scene: Scene, key: str) -> list[str]:
    """The values to offer for a field: its choices, or the value that it has, and the names of colors."""
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
