"""The types of changes: for each class of rows, which keys a change may have, and of which type each is.

They derive from the columns, and type checkers want them written out: `python -m docs.generate.changes`
writes `autocolor/scene/changes.py`. The shell's `>` would empty the file before it is imported here.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from autocolor.scene.columns import Column, Kind, Row, fields_of, keys_of
from autocolor.scene.kinds import OneOf
from autocolor.scene.lights import Flap, Flaps, HalfSpace, Light, Links
from autocolor.scene.row_kinds import NamedRows, Nested
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Paint, Part, Reflectance, Surface
from autocolor.scene.view import NamedView, View

ROOT = Path(__file__).resolve().parents[2]
WRITTEN = ROOT / "autocolor" / "scene" / "changes.py"

CLASSES: tuple[type[Row], ...] = (
    Flap,
    Flaps,
    HalfSpace,
    Links,
    Light,
    Part,
    Reflectance,
    Paint,
    Surface,
    View,
    NamedView,
    Scalar,
)

HEAD = '''"""The keys of a change of a row, and the types of their values, for editors and type checkers.

The keys of an inline row, such as the paint of a surface, are those of its own changes. Written by
`python -m docs.generate.changes` from the columns; do not edit it by hand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

from autocolor.scene.columns import Row
'''

ACCEPTED = {
    "Number": "float",
    "Whole": "int",
    "Boolean": "bool",
    "Text": "str",
    "VectorKind": "Sequence[float]",
    "LimitsKind": "Sequence[float]",
    "PlaceKind": "Sequence[float]",
    "CurveKind": "str | Sequence[Sequence[float]]",
    "AngleCurveKind": "Sequence[Sequence[float]]",
    "ColorKind": "str | Sequence[int]",
    "EndColor": "str | Sequence[int]",
    "ColorsKind": "str | Sequence[str | Sequence[int]]",
    "ScaleKind": "str | Sequence[str | Sequence[int]]",
    "Instance": "object",
    "OneRowOf": "str | Row",
    "RowList": "Sequence[Row]",
    "Reference": "str",
    "References": "Sequence[str]",
    "RangesByName": "str | Mapping[str, Sequence[float]] | Sequence[tuple[str, Sequence[float]]]",
}
"""The types of the values that a kind accepts, by the name of the kind's class."""

MADE_FROM_THE_MESH = ("mesh", "parts", "surfaces")
"""The columns of a scene that `scene_of` makes from the mesh and the rows that it is given."""


def source() -> str:
    """The module of all types."""
    return HEAD + "".join(map(class_of_changes, CLASSES)) + classes_of_a_scene()


def class_of_changes(cls: type[Row]) -> str:
    """The type of the changes of one class of rows; the keys of inline rows are inherited."""
    kinds: list[Any] = [column.kind for column in fields_of(cls).values() if is_inline(column)]
    inline = [f"{kind.row_class.__name__}Changes" for kind in kinds]
    return written(f"{cls.__name__}Changes", ", ".join(inline) or "TypedDict", types_of(cls))


def classes_of_a_scene() -> str:
    """The type of the fields that `scene_of` takes, and of the changes of a scene."""
    types = types_of(Scene)
    mesh = {name: types.pop(name) for name in MADE_FROM_THE_MESH}
    return written("SceneFields", "TypedDict", types) + written("SceneChanges", "SceneFields", mesh)


def types_of(cls: type[Row]) -> dict[str, str]:
    """The type of each field and key, without the keys of inline rows."""
    fields = fields_of(cls)
    own = {key: at.column for key, at in keys_of(cls).items() if not is_inline(fields[at.field])}
    return {
        key: accepted(column.kind) + (" | None" if column.is_optional else "")
        for key, column in {**fields, **own}.items()
    }


def is_inline(column: Column) -> bool:
    """Whether a column has rows whose keys stand among those of the containing row."""
    return isinstance(column.kind, Nested) and column.kind.inline


def accepted(kind: Kind[Any]) -> str:
    """The type of the values that a kind accepts, as an annotation."""
    if isinstance(kind, OneOf):
        return f"Literal[{', '.join(map(json.dumps, kind.names))}]"
    if isinstance(kind, Nested):
        return f"Row | {kind.row_class.__name__}Changes"
    if isinstance(kind, NamedRows):
        return f"Mapping[str, Row | {kind.row_class.__name__}Changes | None] | Sequence[Row]"
    return ACCEPTED[type(kind).__name__]


def written(name: str, base: str, types: dict[str, str]) -> str:
    """A class of the module."""
    lines = [
        f"\n\nclass {name}({base}, total=False):",
        *(f"    {key}: {kind}" for key, kind in types.items()),
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    WRITTEN.write_text(source(), encoding="utf-8")
