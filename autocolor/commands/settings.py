"""`--set KEY=VALUE`: changing fields of a scene, named as in a scene file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.commands.completion import complete_settings
from autocolor.commands.options import as_usage
from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from autocolor.files.scene_report import SceneReport
    from autocolor.scene.columns import Field
    from autocolor.scene.scene import Scene


UNSET: Final = "none"
"""The value that unsets a field."""

Changes = dict[str, Any]


class Inside(dict[str, Any]):
    """Fields that are set one by one inside a field, unlike a table that is its value."""


set_option = click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=complete_settings,
    help="Set a field of the scene, as in scene.toml; none unsets it; repeatable.",
)


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with each KEY=VALUE set, such as `lights.key.intensity=2` or `ambient=0.2`.

    A key is the path of a field in a scene file. A value is written as in a scene file, but needs no quotes,
    and a list of names no brackets: `lights.key.only_surfaces=body,glass`;
    `none` unsets a field that may be absent, such as `view.target`. The settings of one row are applied
    together, so that their order does not matter, except that the last value of a field counts. Raises
    UsageError for an unknown key or an invalid value.
    """
    from autocolor.commands.setting_keys import field_of, place_of

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
            scene = _changed(scene, table, name, fields)
    return scene


def reframed(report: SceneReport, aspect: float) -> SceneReport:
    """The report, its view framed for pictures of an aspect, width over height, if it was created."""
    import dataclasses

    from autocolor.scene.defaults import ASPECT, framed

    scene = report.scene
    if not report.is_view_created or aspect == ASPECT:
        return report
    view = framed(scene.view, scene.object_coordinates, aspect)
    return dataclasses.replace(report, scene=scene.replace(view=view))


def created_again(report: SceneReport, edited: Scene, aspect: float | None = None) -> Scene:
    """The edited scene of a report, with its view and lights as they would be created for what was set.

    A view that was created frames the object again if other fields of it were set than where it is and looks
    to, or which parts are stage; lights that were created are created again if the latter were set. `aspect`
    is that of the picture, by default the display's.
    """
    from autocolor.scene.defaults import ASPECT, default_lights, framed

    original = report.scene
    is_same_object = [part.stage for part in original.parts] == [part.stage for part in edited.parts]
    before, view = original.view, edited.view
    is_placed = (before.eye, before.direction, before.target) != (view.eye, view.direction, view.target)
    if report.is_view_created and not is_placed and not (is_same_object and before == view):
        edited = edited.replace(view=framed(view, edited.object_coordinates, aspect or ASPECT))
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
    if table == "scalar":
        return scene.with_scalar(**fields)
    return scene.with_view(**fields)


def _value_at(scene: Scene, field: Field | None, key: str, text: str) -> object:
    """The value for a field. Raises UsageError for a field that must have one and is to be unset."""
    from autocolor.scene.row_kinds import References, Referring

    kind = None if field is None else field.column.kind
    names = [row.name for row in vars(scene)[kind.table]] if isinstance(kind, Referring) else []
    if text.lower() == UNSET:
        is_absent = field is not None and field.is_optional and isinstance(kind, Referring)
        return None if is_absent and text not in names else _unset(field, key, text)
    value = value_of(text)
    return _names_of(value, names) if isinstance(kind, References) and isinstance(value, str) else value


def _names_of(text: str, known: Sequence[str]) -> list[str]:
    """The names in a text: one that is known, or else several between commas, in brackets or without.

    >>> _names_of("body", []), _names_of("[body, glass]", []), _names_of("a, b", ["a, b"])
    (['body'], ['body', 'glass'], ['a, b'])
    """
    if text in known:
        return [text]
    listed = text[1:-1] if text.startswith("[") and text.endswith("]") else text
    return [name.strip().strip("\"'") for name in listed.split(",") if name.strip()]


def _unset(field: Field | None, key: str, text: str) -> object:
    """What a field holds that is unset by a text; the text itself where that is a value, and for no field.

    Raises UsageError for a field that must have a value.
    """
    from autocolor.scene.columns import REFUSED

    if field is None or field.column.kind.held(text, (), []) is not REFUSED:
        return text
    if field.is_optional:
        return None
    default = None if field.default is None else field.default()
    # What a scene file leaves out is unset there: no limit of a flap, no flaps.
    if default is not None and field.column.kind.written(key, default).get(key) in (None, {}):
        return default
    rule = field.column.kind.rule()
    raise UsageError(f"--set {key}: it {rule}, not none; only a field that may be absent can be unset")


def value_of(text: str) -> Any:
    """The text parsed as a TOML value, or the text itself if it is none.

    >>> value_of("2.5"), value_of("[1, 2]"), value_of("true"), value_of("#b01020")
    (2.5, [1, 2], True, '#b01020')
    """
    from autocolor.files.scene_toml.toml_text import parsed_toml

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
        fields = fields.setdefault(name, Inside())
        if not isinstance(fields, Inside):
            raise UsageError(f"--set {key}: {name} is also set as a whole; leave one out")
    if isinstance(fields.get(path[-1]), Inside):
        raise UsageError(f"--set {key}: some of its fields are also set; leave one out")
    fields[path[-1]] = value
