"""The types of changes: for each class of rows, which keys a change may have, and of which type each is.

They derive from the columns, and type checkers want them written out: `python -m docs.generate.changes`
writes `autocolor/scene/changes.py`. The shell's `>` would empty the file before it is imported here.
"""

from __future__ import annotations

from pathlib import Path

from autocolor.scene.columns import Row, fields_of, keys_of
from autocolor.scene.lights import Flap, Flaps, HalfSpace, Light, Links
from autocolor.scene.row_kinds import Nested, OneRowOf
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

HEAD = '''"""What a change of a row may say: its keys and their types, for editors and type checkers.

Written by `python -m docs.generate.changes` from the columns; do not edit it by hand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

from autocolor.scene.columns import Row
'''

MADE_FROM_THE_MESH = ("mesh", "parts", "surfaces")
"""The columns of a scene that `scene_of` makes from the mesh and the rows that it is given."""


def source() -> str:
    """The module of all types."""
    return HEAD + "".join(map(class_of_changes, CLASSES)) + classes_of_a_scene()


def class_of_changes(cls: type[Row]) -> str:
    """The type of the changes of one class of rows."""
    return written(f"{cls.__name__}Changes(TypedDict", f"Changes of a {cls.__name__}.", types_of(cls))


def classes_of_a_scene() -> str:
    """The type of what `scene_of` takes, and of the changes of a scene."""
    types = types_of(Scene)
    mesh = {name: types.pop(name) for name in MADE_FROM_THE_MESH}
    fields = written(
        "SceneFields(TypedDict", "Fields of a Scene besides its mesh, parts and surfaces.", types
    )
    return fields + written("SceneChanges(SceneFields", "Changes of a Scene.", mesh)


def types_of(cls: type[Row]) -> dict[str, str]:
    """The type of each field and key."""
    columns = {name: field.column for name, field in fields_of(cls).items()}
    columns |= {key: each.column for key, each in keys_of(cls).items()}
    may_be_none = optional_keys(cls)
    return {
        name: column.kind.accepts() + (" | None" if name in may_be_none else "")
        for name, column in columns.items()
    }


def optional_keys(cls: type[Row]) -> set[str]:
    """The keys of a class that may be None, those of rows inside it too."""
    found = {name for name, field in fields_of(cls).items() if field.is_optional}
    for field in fields_of(cls).values():
        kind = field.column.kind
        if isinstance(kind, OneRowOf):
            found = found.union(*map(optional_keys, kind.classes.values()))
        elif isinstance(kind, Nested) and kind.inline:
            found |= optional_keys(kind.row_class)
    return found


def written(name: str, text: str, types: dict[str, str]) -> str:
    """A class of the module."""
    lines = [f"\n\nclass {name}, total=False):", f'    """{text}"""', ""]
    return "\n".join(lines + [f"    {key}: {each}" for key, each in types.items()]) + "\n"


if __name__ == "__main__":
    WRITTEN.write_text(source(), encoding="utf-8")
