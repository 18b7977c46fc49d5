from __future__ import annotations

import ast
from typing import get_type_hints

from autocolor.scene.changes import SceneChanges, SceneFields
from autocolor.scene.columns import fields_of, keys_of
from autocolor.scene.scene import Scene
from docs.generate.changes import CLASSES, WRITTEN, source, types_of


def test_the_types_are_those_of_the_columns() -> None:
    written = WRITTEN.read_text("utf-8")
    is_current = ast.dump(ast.parse(written)) == ast.dump(ast.parse(source()))
    assert is_current, "run: python -m docs.generate.changes"


def test_every_field_and_every_key_has_a_type() -> None:
    for cls in CLASSES:
        assert set(types_of(cls)) == {*fields_of(cls), *keys_of(cls)}


def test_a_change_of_a_scene_may_say_more_than_what_makes_one_of_a_mesh() -> None:
    assert set(get_type_hints(SceneChanges)) == set(fields_of(Scene))
    assert set(get_type_hints(SceneChanges)) - set(get_type_hints(SceneFields)) == {
        "mesh",
        "parts",
        "surfaces",
    }
