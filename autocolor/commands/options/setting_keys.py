"""The keys of `--set KEY=VALUE`: the field that each names, and the keys that a scene has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from autocolor.checks import nearest
from autocolor.errors import UsageError
from autocolor.scene.columns.color_kinds import ColorKind, color_names
from autocolor.scene.columns.column import Field, Kind, Row, fields_of, keys_of
from autocolor.scene.columns.row_kinds import Nested, Rows, Variant
from autocolor.scene.columns.rows import plain
from autocolor.scene.columns.value_kinds import Choice, Instance
from autocolor.scene.scalars.color_scales import COLOR_SCALES
from autocolor.scene.scalars.scalar_kinds import ScaleKind
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
    if kind is None or (rest and not isinstance(kind, (Nested, Rows))):
        raise UsageError(f"--set {key}: there is no field of this name{nearest(table, kinds)}")
    if not isinstance(kind, (Nested, Rows)):
        return Place("", "", (table,))
    names = {"": ""}
    if isinstance(kind, Rows):
        # A name may contain periods and may be quoted: take the longest one that matches.
        rows = [row.name for row in vars(scene)[table]]
        names = {written: row for row in rows for written in (row, f'"{row}"', f"'{row}'")}
        start = max((name for name in names if f"{rest}.".startswith(f"{name}.")), key=len, default=None)
        if start is None and "." in rest:
            wrong = rest.partition(".")[0]
            raise UsageError(f"--set {key}: there is no {table[:-1]} {wrong!r}{nearest(wrong, rows)}")
        name, field = (None, "") if start is None else (names[start], rest[len(start) + 1 :])
    else:
        name, field = "", rest
    if key == table and fields_of(Scene)[table].is_optional:
        # The whole row, which can be unset.
        return Place("", "", (table,))
    if name is None or not field:
        raise UsageError(f"--set {key}: it must name one field; write it as in {EXAMPLES[table]}")
    if field == "name" and isinstance(kind, Rows):
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    path = tuple(field.split("."))
    if len(path) > MOST_PARTS:
        raise UsageError(f"--set {key}: there is no such field; write it as in {EXAMPLES[table]}")
    return Place(table, name, path)


def field_of(place: Place) -> Field | None:
    """The field at a place; None if its row has none there."""
    kind = _settable().get(place.table)
    return _field_at(kind.row_class if isinstance(kind, (Nested, Rows)) else Scene, place.path)


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
    if isinstance(kind, Variant) and path[0] != key.field:
        inside = next(each for each in kind.classes.values() if path[0] in keys_of(each))
        return _field_at(inside, path)
    if isinstance(kind, Nested) and kind.inline:
        return _field_at(kind.row_class, path)
    if len(path) == 1:
        return field
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
            f"{name}." if isinstance(kind, (Nested, Rows)) else f"{name}="
            for name, kind in _settable().items()
        ]
    table, _, rest = start[:-1].partition(".")
    kind = _settable()[table]
    if isinstance(kind, Rows):
        names = [row.name for row in vars(scene)[table]]
        if not rest:
            return [f"{start}{name}." for name in names]
        if rest in names:
            return _fields_after(start, kind.row_class, leave_out=("name",))
    elif not rest and isinstance(kind, Nested):
        return _fields_after(start, kind.row_class)
    place = place_of(scene, start[:-1])
    field = field_of(place)
    inner = None if field is None else field.column.kind
    return _fields_after(start, inner.row_class) if isinstance(inner, Nested) else []


def _fields_after(start: str, cls: type[Row], leave_out: Sequence[str] = ()) -> list[str]:
    keys = {key: _field_at(cls, (key,)) for key in keys_of(cls) if key not in leave_out}
    return [
        f"{start}{key}{'.' if isinstance(field.column.kind, Nested) else '='}"
        for key, field in keys.items()
        if field is not None
    ]


def _values(scene: Scene, key: str) -> list[str]:
    """The values to offer for a field: its choices, or the value that it has, and the names of colors."""
    place = place_of(scene, key)
    field = field_of(place)
    if field is None:
        return []
    kind = field.column.kind
    if isinstance(kind, Choice):
        return list(kind.names)
    if isinstance(kind, Variant):
        return list(kind.classes)
    if isinstance(kind, ScaleKind):
        return list(COLOR_SCALES)
    if (place.table, place.path) == ("scalar", ("name",)):
        return list(scene.scalar_names)
    row: Any = scene
    if place.table:
        rows = vars(scene)[place.table]
        row = next((each for each in rows if each.name == place.name), None) if place.name else rows
    value: Any = {} if row is None else plain(row)
    for part in place.path:
        value = value.get(part) if isinstance(value, dict) else None
    if isinstance(value, bool):
        return ["true", "false"]
    present = [] if value is None or isinstance(value, (dict, list)) else [str(value)]
    return [*present, *color_names()] if isinstance(kind, ColorKind) else present
