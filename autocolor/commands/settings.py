"""`--set KEY=VALUE`: a scene with some of its fields changed, each named as in a scene file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from autocolor.scene.scene import Scene

PLAIN: Final = ("ambient", "scaling", "mapping", "contrast", "background")
EXAMPLES: Final = {
    "view": "view.angle=10",
    "lights": "lights.key.intensity=2",
    "surfaces": "surfaces.body.blend=0.3",
    "parts": "parts.hood.surface=body",
}

Changes = dict[str, Any]


def with_settings(scene: Scene, settings: tuple[str, ...]) -> Scene:
    """The scene with each KEY=VALUE set: `lights.key.intensity=2`, `view.angle=10`, `ambient=0.2`.

    A key is the path that it has in a scene file; a value is written as there, quotes may be left out. The
    settings of one row are made together, so that their order does not matter. Raises UsageError for a key
    that names nothing, InputError for a value that breaks a rule.
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
        if table == "":
            scene = scene.replace(**fields)
        elif table == "view":
            scene = scene.with_view(**fields)
        elif table == "lights":
            scene = scene.with_light(name, **fields)
        elif table == "surfaces":
            scene = scene.with_surface(name, **fields)
        else:
            scene = scene.with_part(name, **fields)
    return scene


def value_of(text: str) -> Any:
    """A value as a scene file has it; what is none is a text.

    >>> value_of("2.5"), value_of("[1, 2]"), value_of("true"), value_of("#b01020")
    (2.5, [1, 2], True, '#b01020')
    """
    from autocolor.files.scenes.toml_text import parsed_toml

    # A color begins as a comment does, and a line break would begin another key.
    if not text or text.startswith("#") or not text.isprintable():
        return text
    try:
        return parsed_toml(f"value = {text}".encode(), "--set")["value"]
    except (InputError, UnicodeEncodeError):
        return text


def _place(scene: Scene, key: str) -> tuple[str, str, list[str]]:
    """The table of a key ("" for none), the name of a row there ("" for none), and the path in it."""
    from autocolor.checks import nearest

    table, _, rest = key.partition(".")
    if table in PLAIN and not rest:
        return "", "", [table]
    if table not in EXAMPLES:
        known = (*PLAIN, *EXAMPLES)
        raise UsageError(f"--set {key}: there is nothing of this name to set{nearest(table, known)}")
    if table == "view" and rest:
        return table, "", [rest]
    # A name may itself hold points, or stand in quotes: take the longest that the table has.
    rows = [row.name for row in getattr(scene, table)] if table != "view" else []
    names = {written: row for row in rows for written in (row, f'"{row}"', f"'{row}'")}
    start = max((name for name in names if f"{rest}.".startswith(f"{name}.")), key=len, default=None)
    if start is None and "." in rest:
        wrong = rest.partition(".")[0]
        raise UsageError(f"--set {key}: there is no {table[:-1]} {wrong!r}{nearest(wrong, rows)}")
    field = "" if start is None else rest[len(start) + 1 :]
    if start is None or not field:
        raise UsageError(f"--set {key}: it must name one field; write it as in {EXAMPLES[table]}")
    return table, names[start], field.split(".") if table == "lights" else [field]


def _put(fields: Changes, path: list[str], value: Any, key: str) -> None:
    """Put a value where the path leads: a field, or a flap of a light, or a field of that."""
    if path == ["name"]:
        raise UsageError(f"--set {key}: a name stays; rename it in the scene file")
    if len(path) > (3 if path[0] == "flaps" else 1):
        raise UsageError(
            f"--set {key}: there is no such field; flaps alone have some, as in flaps.z.maximum=1"
        )
    for name in path[:-1]:
        if not isinstance(fields.get(name), dict):
            fields[name] = {}
        fields = fields[name]
    fields[path[-1]] = value
