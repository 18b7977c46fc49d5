"""The reference of scene files: every table and key, as the columns describe them.

`python -m docs.generate.columns > docs/COLUMNS.md` writes it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from autocolor.files.scene_toml.scene_meshes import MeshEntry
from autocolor.scene.columns import (
    MISSING,
    WORLD_UNITS,
    Column,
    Kind,
    Row,
    Tier,
    fields_of,
    keys_of,
    to_plain,
)
from autocolor.scene.kinds import Number
from autocolor.scene.lights import Flap, HalfSpace, Light
from autocolor.scene.row_kinds import Nested, OneRowOf
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import MOST_VIEWS, NamedView, View

ROOT = Path(__file__).resolve().parents[2]

HEAD = """# The columns

Every table of a scene and every key, as `scene.toml`, `--set`, Python and picture files have them. The page
is written from the columns in `autocolor/scene` by `python -m docs.generate.columns > docs/COLUMNS.md`.

A key that has no default must be given; one whose default is "absent" may be left out. "On a bar" is the
usual range of a number and its step where it is set by pointing, and what it starts with if it was absent;
typed numbers may be any that the value's own rule allows. The last column says what an edit of it costs:
"""

TABLES: tuple[tuple[str, str, type[Row]], ...] = (
    ("Keys outside of all tables", "", Scene),
    ("`[view]`", "", View),
    (
        "`[[views]]`",
        "Named views: rows with a name and the keys of `[view]`, in any number up to"
        f" {MOST_VIEWS}. Any of them can become the view; an edit of them costs nothing.",
        NamedView,
    ),
    ("`[scalar]`", "It colors the surfaces by a scalar of the mesh, or by a computed one.", Scalar),
    ("`[[mesh]]`", "A mesh: a `file`, or `nodes` and `polygons`.", MeshEntry),
    ("`[parts.NAME]`", "", Part),
    ("`[surfaces.NAME]`", "", Surface),
    ("`[[lights]]`", "", Light),
    ("`flaps.x`, `flaps.y`, `flaps.z` of a light", "", Flap),
    (
        "`half_spaces.NAME` of a light",
        "A half-space, such as `half_spaces.left = { point = [0, 0, 0], direction = [1, 0, 0] }`."
        " `--set` and Python change single keys of an existing half-space; `none`, in Python `None`, removes"
        " it.",
        HalfSpace,
    ),
)

LEFT_OUT = {
    Scene: ("mesh", "parts", "surfaces", "lights", "view", "views", "scalar", "name"),
    NamedView: tuple(keys_of(View)),
    Part: ("name",),
    Surface: ("name",),
    HalfSpace: ("name",),
}
"""What stands in a header, or has a table of its own."""

WORDS = "all words, the entries that differ"

COSTS = {
    Tier.NOTHING: ("nothing", "nothing"),
    Tier.ENTRIES: ("entries of the lookup table", "those entries, no word"),
    Tier.LEVELS: ("the levels", WORDS),
    Tier.MIX: ("the weighted sum of the lights", WORDS),
    Tier.LIGHT: ("one light, or all lights on one surface", WORDS),
    Tier.FRAME: ("everything", WORDS),
}
"""What an edit of each tier computes again, and what it sends to the display."""


def tiers() -> Iterator[str]:
    """The table of the costs of edits."""
    yield "| an edit costs | computed again | sent to the display |"
    yield "|---|---|---|"
    for tier, (computed, sent) in COSTS.items():
        yield f"| {tier.name.lower()} | {computed} | {sent} |"
    yield ""


def document() -> str:
    """The whole reference."""
    return "\n".join([HEAD, *tiers(), *(line for table in TABLES for line in lines_of(*table))]) + "\n"


def lines_of(title: str, text: str, cls: type[Row]) -> Iterator[str]:
    """The lines of one table."""
    yield f"## {title}\n"
    if text:
        yield f"{text}\n"
    yield "| key | what it is | unit | value | default | on a bar | an edit costs |"
    yield "|---|---|---|---|---|---|---|"
    for key, (column, field) in keys_of(cls).items():
        if key not in LEFT_OUT.get(cls, ()):
            rule = column.kind.rule().removeprefix("must be ")
            text = f"{column.help}{going_with(fields_of(cls)[field].kind, key)}"
            cells = (
                f"`{key}`",
                text,
                column.unit,
                rule,
                default(cls, key, field),
                on_a_bar(column),
                tier(column),
            )
            yield f"| {' | '.join(cells)} |"
    yield ""


def going_with(kind: Kind[Any], key: str) -> str:
    """A sentence with the variants that have the key, of inline rows too; nothing for any other key."""
    if isinstance(kind, Nested) and kind.inline:
        for name, field in fields_of(kind.row_class).items():
            if isinstance(field.kind, OneRowOf) and key != name:
                return going_with(field.kind, key)
    if not isinstance(kind, OneRowOf):
        return ""
    names = [repr(name) for name, cls in kind.classes.items() if key in keys_of(cls)]
    return f" Goes with {' or '.join(names)}." if names else ""


def on_a_bar(column: Column) -> str:
    """The usual range and the step of a number, and what it starts with when it is switched on, if absent."""
    bar = column.bar
    if bar is None and column.unit == WORLD_UNITS:
        is_length = isinstance(column.kind, Number) and column.kind.at_least == 0
        return "up to the size of the object" if is_length else "that of the object"
    if bar is None:
        return ""
    start = "" if column.start is None else f", from {column.start:g}"
    return f"{bar.low:g} to {bar.high:g} by {bar.step:g}{start}"


def tier(column: Column) -> str:
    """The cost of an edit, in lower case."""
    return column.tier.name.lower()


def default(cls: type[Row], key: str, field: str) -> str:
    """The default of a key, or nothing."""
    column = fields_of(cls)[field]
    if column.default is MISSING:
        return ""
    if column.default is None:
        return "absent"
    written = {**parameters(column.kind), **column.kind.to_plain(field, column.default)}
    return f"`{json.dumps(written[key])}`" if written.get(key) not in (None, {}) else "absent"


def parameters(kind: Kind[Any]) -> dict[str, object]:
    """The keys of each variant with their defaults, those of variants inside inline rows too."""
    if isinstance(kind, OneRowOf):
        return {key: value for cls in kind.classes.values() for key, value in to_plain(cls()).items()}
    inner = fields_of(kind.row_class).values() if isinstance(kind, Nested) and kind.inline else ()
    return {key: value for each in inner for key, value in parameters(each.kind).items()}


if __name__ == "__main__":
    sys.stdout.write(document())
