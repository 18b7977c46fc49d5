"""The reference of scene files: every table and key, as the columns describe them.

`python -m docs.generate.columns > docs/COLUMNS.md` writes it.
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from autocolor.files.scene_toml.scene_meshes import MeshEntry
from autocolor.scene.columns import (
    MISSING,
    Column,
    Kind,
    Row,
    Tier,
    fields_of,
    keys_of,
    to_plain,
)
from autocolor.scene.lights import Flap, HalfSpace, Light
from autocolor.scene.row_kinds import Nested, OneRowOf
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import MOST_VIEWS, NamedView, View

ROOT = Path(__file__).resolve().parents[2]

HEAD = """# The columns

Every key of a scene, for `scene.toml`, `--set`, Python and picture files. Written by `python -m
docs.generate.columns > docs/COLUMNS.md`.

After a key come its value and its default. A key with neither a default nor the word "optional" is required;
of choices, the first is the default. Angles are in degrees, positions and lengths in world units. A
**vector** is a list of three finite numbers up to 1e36. A **color** is `"#rrggbb"`, a name such as `"red"`,
or three whole numbers from 0 to 255. A **name** has at least one character.

Words in italics say what an edit computes again:
"""

TABLES: tuple[tuple[str, str, type[Row]], ...] = (
    ("Keys outside of all tables", "", Scene),
    ("`[view]`", "", View),
    (
        "`[[views]]`",
        f"Up to {MOST_VIEWS} named views, with the keys of `[view]`.",
        NamedView,
    ),
    ("`[scalar]`", "", Scalar),
    ("`[[mesh]]`", "A mesh: a `file`, or `nodes` and `polygons`.", MeshEntry),
    ("`[parts.NAME]`", "", Part),
    ("`[surfaces.NAME]`", "", Surface),
    ("`[[lights]]`", "", Light),
    ("`flaps.x`, `flaps.y`, `flaps.z` of a light", "", Flap),
    (
        "`half_spaces.NAME` of a light",
        "For example `half_spaces.left = { point = [0, 0, 0], direction = [1, 0, 0] }`. "
        "`none` removes a half-space.",
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

SHORT = (
    (r"three finite numbers of at most 1e36", "vector"),
    (r'"#rrggbb", a name such as "red", or three whole numbers from 0 to 255', "color"),
    (r"true or false", "boolean"),
    (r"a string of at least one character", "name"),
    (r"a list of names", "names"),
    (r"a finite number of at least 0", "0 or more"),
    (r"a finite number", "number"),
    (r"a number from ", ""),
    (r"a number above", "above"),
    (r"a whole number from", "whole number,"),
    (r"a list of (\d+) ", r"\1 "),
    (r"two finite numbers, the second above the first", "two rising numbers"),
    (
        r"'auto', a percentage .*",
        "'auto', '50 %' to '100 %', or ranges such as { object = [0.0, 1.3] }",
    ),
    (
        r"2 to 91 points .*",
        "2 to 91 points: angles rise from 0 to 90, shares are 0 to 1, the first from 0.001",
    ),
    (r"the name of a color scale, or a list of", "a name, or"),
    (r"a table of ", ""),
)
"""Rules of values, and how the page writes them."""

COSTS = {
    Tier.ENTRIES: "some entries of the lookup table; no word is sent",
    Tier.LEVELS: "the levels; from here on, all words are sent",
    Tier.MIX: "the sum of the lights",
    Tier.LIGHT: "one light, or all lights on one surface",
    Tier.FRAME: "everything",
}
"""What an edit of each tier computes again; Tier.NOTHING says it already."""


def document() -> str:
    """The whole reference."""
    costs = "".join(f"- *{tier.name.lower()}*: {what}\n" for tier, what in COSTS.items())
    return "\n".join([HEAD, costs, *(line for table in TABLES for line in lines_of(*table))])


def lines_of(title: str, text: str, cls: type[Row]) -> Iterator[str]:
    """The lines of one table: its usual tier, and a definition of each key."""
    columns = {key: at for key, at in keys_of(cls).items() if key not in LEFT_OUT.get(cls, ())}
    usual = Counter(column.tier for column, _ in columns.values()).most_common(1)[0][0]
    yield f"## {title}\n"
    yield f"{text} Edits: *{usual.name.lower()}*\n".lstrip()
    for key, (column, field) in columns.items():
        given = ", ".join(filter(None, (value_of(column), default(cls, key, field))))
        cost = "" if column.tier == usual else f" (*{column.tier.name.lower()}*)"
        of = going_with(fields_of(cls)[field].kind, key)
        yield f"**`{key}`**{of}: {given}. {column.help}{cost}\n"


def value_of(column: Column) -> str:
    """The rule of a value in short, and its unit if the head does not say it."""
    rule = column.kind.rule().removeprefix("must be ")
    for long, short in SHORT:
        rule = re.sub(f"^{long}", short, rule)
    return f"{rule} {column.unit}" if column.unit == "percent" else rule


def going_with(kind: Kind[Any], key: str) -> str:
    """The variants that have the key, of inline rows too, in brackets; nothing for any other key."""
    if isinstance(kind, Nested) and kind.inline:
        for name, field in fields_of(kind.row_class).items():
            if isinstance(field.kind, OneRowOf) and key != name:
                return going_with(field.kind, key)
    if not isinstance(kind, OneRowOf):
        return ""
    names = [name for name, cls in kind.classes.items() if key in keys_of(cls)]
    return f" ({', '.join(names)})" if names else ""


def default(cls: type[Row], key: str, field: str) -> str:
    """The default of a key, or that it is optional; nothing if it is required, or for the first choice."""
    column = fields_of(cls)[field]
    if column.default is MISSING:
        return ""
    if column.default is None:
        return "optional"
    written = {**parameters(column.kind), **column.kind.to_plain(field, column.default)}.get(key)
    if written in (None, {}):
        return "optional"
    is_first = value_of(keys_of(cls)[key].column).startswith(repr(written))
    return "" if is_first else f"default `{json.dumps(written)}`"


def parameters(kind: Kind[Any]) -> dict[str, object]:
    """The keys of each variant with their defaults, those of variants inside inline rows too."""
    if isinstance(kind, OneRowOf):
        return {key: value for cls in kind.classes.values() for key, value in to_plain(cls()).items()}
    inner = fields_of(kind.row_class).values() if isinstance(kind, Nested) and kind.inline else ()
    return {key: value for each in inner for key, value in parameters(each.kind).items()}


if __name__ == "__main__":
    sys.stdout.write(document())
