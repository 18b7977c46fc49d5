"""`--set KEY=VALUE`: setting fields of a scene by their names in a scene file.

A key is the path of a field, such as `lights.key.intensity`. A value is written as in a scene file, but needs
no quotes, and a list of names needs no brackets. `keys_after` lists keys and values for completion.
"""

from __future__ import annotations

from typing import Any

from autocolor.checks import shown
from autocolor.commands.options import as_usage
from autocolor.errors import UsageError
from autocolor.files.settings import field_and_value, field_of, place_of, row_at, scene_with, settable_kinds
from autocolor.scene.color_scales import COLOR_SCALES
from autocolor.scene.columns import Row, keys_of, to_plain
from autocolor.scene.kinds import ColorKind, OneOf, color_names
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, RangesByName, Referring, RowList
from autocolor.scene.scalar import Scalar, ScaleKind
from autocolor.scene.scene import Scene, unset_paints
from ramtek_emu.command_line import tell


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with settings KEY=VALUE, such as `lights.key.intensity=2` or `lights.key.only_parts=hood`.

    `none` unsets an optional field, such as `view.target`. If a field is set twice, the last value counts.
    Ramps and colors that the settings replace are listed on stderr. Raises UsageError for an unknown key or
    an invalid value.
    """
    texts: dict[str, str] = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals or not key.strip():
            raise UsageError(
                f"--set must be KEY=VALUE, not {shown(setting)}; write it as in lights.key.intensity=2"
            )
        # The last of several names of a field counts, too: a name may be quoted.
        texts.pop(key.strip(), None)
        texts[key.strip()] = text.strip()
    try:
        with as_usage("--set: "):
            edited = scene_with(scene, texts)
    except UsageError as error:
        raise UsageError(
            problem if problem.startswith("--set: ") else f"--set {problem}" for problem in error.problems
        ) from None
    tell_unset(scene, edited)
    return edited


def tell_unset(before: Scene, after: Scene) -> None:
    """Print a line on stderr for each surface whose ramp or two colors an edit replaces."""
    tell(*(f"autocolor: {sentence}" for sentence in unset_paints(before, after)))


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
            for name, kind in settable_kinds().items()
        ]
    table, _, rest = start[:-1].partition(".")
    kind = settable_kinds()[table]
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
    inner = None if field is None else field.kind
    if isinstance(inner, NamedRows):
        present = vars(row_at(scene, place))[place.path[0]]
        return [f"{start}{row.name}." for row in present]
    return _fields_after(start, inner.row_class) if isinstance(inner, Nested) else []


def _fields_after(start: str, cls: type[Row], row: Row | None = None) -> list[str]:
    """The keys of a class after a start; the key of NamedRows ends in "." if there are such rows."""
    keys = []
    for key in keys_of(cls):
        field = field_and_value(cls, None, (key,))[0]
        if field is None or (key == "name" and cls is not Scalar):
            continue
        has_rows = isinstance(field.kind, NamedRows) and row is not None and bool(vars(row)[key])
        keys.append(f"{start}{key}{'.' if has_rows or isinstance(field.kind, Nested) else '='}")
    return keys


def _values(scene: Scene, key: str) -> list[str]:
    """The completions of a field's value: its choices, or its present value and the names of colors."""
    place = place_of(scene, key)
    field = field_of(place)
    if field is None:
        return []
    kind = field.kind
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
    row = row_at(scene, place)
    value: Any = {} if row is None else to_plain(row)
    for part in place.path:
        value = value.get(part) if isinstance(value, dict) else None
    if isinstance(value, bool):
        return ["true", "false"]
    present = [] if value is None or isinstance(value, (dict, list, tuple)) else [str(value)]
    return [*present, *color_names()] if isinstance(kind, ColorKind) else present
