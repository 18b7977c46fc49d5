"""`--set KEY=VALUE`: changing fields of a scene, named as in a scene file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from autocolor.files.scenes.scene_report import SceneReport
    from autocolor.scene.scene import Scene

EXAMPLES: Final = {
    "view": "view.angle=10",
    "lights": "lights.key.intensity=2",
    "surfaces": "surfaces.body.blend=0.3",
    "parts": "parts.hood.surface=body",
}

MOST_PARTS: Final = 4
"""An upper bound on the parts of a field's path within its row."""

Changes = dict[str, Any]


class Inside(dict[str, Any]):
    """Fields that are set one by one inside a field, unlike a table that is its value."""


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with each KEY=VALUE set, such as `lights.key.intensity=2` or `ambient=0.2`.

    A key is the path of a field in a scene file. A value is written as in a scene file, but needs no quotes.
    The settings of one row are applied together, so that their order does not matter, except that the last
    value of a field counts. Raises UsageError for an unknown key, InputError for an invalid value.
    """
    changes: dict[tuple[str, str], Changes] = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise click.UsageError(
                f"--set must be KEY=VALUE, not {setting!r}; write it as in {EXAMPLES['lights']}"
            )
        table, name, path = _place(scene, key.strip())
        _put(changes.setdefault((table, name), {}), path, value_of(text.strip()), key.strip())
    for (table, name), fields in changes.items():
        scene = _changed(scene, table, name, fields)
    return scene


def created_again(report: SceneReport, edited: Scene) -> Scene:
    """The edited scene of a report, with its view and lights as they would be created for what was set.

    A view that was created frames the object again if other fields of it were set than where it is and looks
    to, or which parts are stage; lights that were created are created again if the latter were set.
    """
    from autocolor.scene.defaults import default_lights, framed

    original = report.scene
    is_same_object = [part.stage for part in original.parts] == [part.stage for part in edited.parts]
    before, view = original.view, edited.view
    is_placed = (before.eye, before.direction, before.target) != (view.eye, view.direction, view.target)
    if report.is_view_created and not is_placed and not (is_same_object and before == view):
        edited = edited.replace(view=framed(view, edited.object_coordinates))
    if report.are_lights_created and not is_same_object and edited.lights == original.lights:
        edited = edited.replace(lights=default_lights(edited.object_coordinates, edited.view))
    return edited


def _changed(scene: Scene, table: str, name: str, fields: Changes) -> Scene:
    """The scene with some of its own fields, or fields of one row, changed."""
    if table == "":
        return scene.replace(**fields)
    if table == "lights":
        return scene.with_light(name, **fields)
    if table == "surfaces":
        return scene.with_surface(name, **fields)
    if table == "parts":
        return scene.with_part(name, **fields)
    return scene.with_view(**fields)


def value_of(text: str) -> Any:
    """The text parsed as a TOML value, or the text itself if it is none.

    >>> value_of("2.5"), value_of("[1, 2]"), value_of("true"), value_of("#b01020")
    (2.5, [1, 2], True, '#b01020')
    """
    from autocolor.files.scenes.toml_text import parsed_toml

    # In TOML, the # of a color begins a comment, and a line break ends the value.
    if not text or text.startswith("#") or not text.isprintable():
        return text
    try:
        return parsed_toml(f"value = {text}".encode(), "--set")["value"]
    except (InputError, UnicodeEncodeError):
        return text


def _place(scene: Scene, key: str) -> tuple[str, str, list[str]]:
    """The table of a key, the name of the row, and the path in the row; "" for a name that is not needed."""
    from autocolor.checks import nearest
    from autocolor.scene.columns.column import fields_of
    from autocolor.scene.columns.row_kinds import Nested, Rows
    from autocolor.scene.columns.value_kinds import Instance
    from autocolor.scene.scene import Scene

    kinds = {name: field.column.kind for name, field in fields_of(Scene).items() if name != "name"}
    kinds = {name: kind for name, kind in kinds.items() if not isinstance(kind, Instance)}
    table, _, rest = key.partition(".")
    kind = kinds.get(table)
    if kind is None or (rest and not isinstance(kind, (Nested, Rows))):
        raise UsageError(f"--set {key}: there is no field of this name{nearest(table, kinds)}")
    if not isinstance(kind, (Nested, Rows)):
        return "", "", [table]
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
    if name is None or not field:
        raise UsageError(f"--set {key}: it must name one field; write it as in {EXAMPLES[table]}")
    if field == "name":
        raise UsageError(f"--set {key}: a name cannot be set; change it in the scene file")
    path = field.split(".")
    if len(path) > MOST_PARTS:
        raise UsageError(f"--set {key}: there is no such field; write it as in {EXAMPLES[table]}")
    return table, name, path


def _put(fields: Changes, path: list[str], value: Any, key: str) -> None:
    """Put a value at a path of nested dictionaries, which are created as needed.

    Raises UsageError where both a table and a field of it are set, because the result would depend on their
    order.
    """
    for name in path[:-1]:
        fields = fields.setdefault(name, Inside())
        if not isinstance(fields, Inside):
            raise UsageError(f"--set {key}: {name} is also set as a whole; leave one out")
    if isinstance(fields.get(path[-1]), Inside):
        raise UsageError(f"--set {key}: some of its fields are also set; leave one out")
    fields[path[-1]] = value
