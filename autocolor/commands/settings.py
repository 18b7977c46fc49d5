"""`--set KEY=VALUE`: setting fields of a scene by their names in a scene file.

A key is the path of a field, such as `lights.key.intensity`. A value is written as in a scene file, but needs
no quotes, and a list of names needs no brackets. `settings_after` lists keys and values for completion.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from itertools import accumulate
from typing import Any

from autocolor.checks import shown
from autocolor.commands.options import as_usage
from autocolor.errors import InputError, UsageError
from autocolor.files.settings import UNSET, field_and_value, field_of, place_of, scene_with, value_at
from autocolor.scene.color_scales import COLOR_SCALES
from autocolor.scene.columns import Row, Tier, keys_of
from autocolor.scene.kinds import Boolean, ColorKind, CurveKind, Instance, OneOf, color_names
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, RangesByName, Referring, RowList
from autocolor.scene.scalar import Scalar, ScaleKind
from autocolor.scene.scene import Scene, costs_at_least, unseen_recoloring, unset_paints
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
        edited = scene_with(scene, texts)
    except InputError as error:
        raise UsageError(f"--set: {problem}" for problem in error.problems) from None
    except UsageError as error:
        raise UsageError(f"--set {error}") from None
    tell_unset(scene, edited)
    return edited


def tell_unset(before: Scene, after: Scene) -> None:
    """Print a line on stderr for each surface whose ramp or two colors an edit replaces."""
    tell(*(f"autocolor: {sentence}" for sentence in unset_paints(before, after)))


def recolored(
    scene: Scene, surface: str | None, colors: Mapping[str, Any], settings: tuple[str, ...]
) -> Scene:
    """The scene with settings and other colors of a surface.

    Ramps and colors that are replaced are listed on stderr, and a recoloring that no picture shows. Raises
    UsageError if a setting needs a rendering.
    """
    edited = with_settings(scene, settings)
    if costs_at_least(scene, edited, Tier.MIX):
        raise UsageError(
            "--set: a setting of a picture must need no rendering, such as colors, the mapping, or limits and"
            " bands of a scalar; use it with `autocolor render`"
        )
    with as_usage():
        painted = edited if surface is None else edited.with_paint(surface, **colors)
    tell_unset(edited, painted)
    if surface is not None and (sentence := unseen_recoloring(edited, painted, surface)):
        tell(f"autocolor: {sentence}")
    return painted


def settings_after(scene: Scene, incomplete: str) -> list[str]:
    """The keys that begin with an incomplete key, each up to its next part; or the values of a whole key.

    The part of a table or a row ends in ".", that of a field in "=". A shell puts a space after a single
    candidate, so a single part is replaced by what follows it, and a single key stands beside its values.
    """
    key, equals, _ = incomplete.partition("=")
    if equals:
        return [f"{key}={value}" for value in _values(scene, key)]
    starts = dict.fromkeys(
        next((start for start in accumulate(parts) if len(start) > len(incomplete)), "")
        for parts in key_parts(Scene, scene)
    )
    found = [start for start in starts if start.startswith(incomplete)]
    if len(found) != 1:
        return found
    return [*(found if found[0].endswith("=") else ()), *settings_after(scene, found[0])]


def key_parts(cls: type[Row], row: Row | None) -> Iterator[tuple[str, ...]]:
    """The keys of the fields of a row, as parts. Fields of rows without a name are those of their class."""
    for key in keys_of(cls):
        column, value = field_and_value(cls, row, (key,))
        kind = None if column is None else column.kind
        if isinstance(kind, RowList) or (isinstance(kind, NamedRows) and value):
            yield from (
                (f"{key}.", f"{each.name}.", *rest) for each in value for rest in key_parts(type(each), each)
            )
        elif isinstance(kind, Nested):
            yield from ((f"{key}.", *rest) for rest in key_parts(kind.row_class, value))
        elif not isinstance(kind, Instance) and (key != "name" or cls is Scalar):
            yield (f"{key}=",)


def _values(scene: Scene, key: str) -> list[str]:
    """The values to complete for a field: its present value, and its choices."""
    place = place_of(scene, key)
    column, name = field_of(place), place.path[-1]
    if column is None:
        return []
    kind, value = column.kind, value_at(scene, place)
    plain = None if value is None else kind.to_plain(name, value).get(name)
    plain = UNSET if plain in (None, {}) else plain
    present = plain if isinstance(plain, str) else json.dumps(plain, separators=(",", ":"))
    choices: Iterable[str] = ()
    if isinstance(kind, (OneOf, CurveKind)):
        choices = kind.names
    elif isinstance(kind, OneRowOf):
        choices = kind.classes
    elif isinstance(kind, Boolean):
        choices = ("true", "false")
    elif isinstance(kind, ColorKind):
        choices = color_names()
    elif isinstance(kind, ScaleKind):
        choices = COLOR_SCALES
    elif (place.table, name) == ("scalar", "name"):
        choices = scene.scalar_names
    elif isinstance(kind, Referring) and not isinstance(kind, RangesByName):
        choices = [*kind.words, *(row.name for row in vars(scene)[kind.table])]
    is_present = value is not None or column.is_optional
    return list(dict.fromkeys([*([present] if is_present else ()), *choices]))
