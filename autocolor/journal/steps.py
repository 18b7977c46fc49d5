"""The steps of a journal, taken again from their lines.

Only the calls that `script` writes are known, and their arguments must be plain values; nothing is run.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import History
from autocolor.journal.lines import Called, called, dotted, expression_of, plain_value, refuse
from autocolor.journal.opening import opened
from autocolor.journal.places import Source
from autocolor.journal.script import FIRST_MESH, ROW_METHODS, SHORT
from autocolor.scene.columns.column import fields_of
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import AUTO, Scene
from autocolor.scene.surfaces import Paint

STUDIO_METHODS: Final = {**{short: method for method, short in SHORT.items()}, "recolor": "with_surface"}
SCENE_METHODS: Final = ("replace", *ROW_METHODS.values(), *SHORT, "without_scalar")

SOURCE_OPTIONS: Final = frozenset(Source._fields) - {"path"}
"""The keywords of a call that reads a scene."""

NAMED: Final = frozenset((*ROW_METHODS.values(), "with_new_light", "without_light"))
"""The methods whose one argument without a keyword is the name of a row."""


def source_in(arguments: Sequence[ast.expr], options: Mapping[str, Any], line: str) -> Source:
    """The source that the one argument of a call and its options give."""
    paths = [plain_value(value, line) for value in arguments]
    scale = options.get("scale", 1.0)
    words = [*paths, *(value for key, value in options.items() if key != "scale")]
    is_number = isinstance(scale, (int, float)) and not isinstance(scale, bool)
    if len(paths) != 1 or not is_number or not all(isinstance(each, str) for each in words):
        refuse(line)
    return Source(paths[0], **options)


class Steps:
    """Takes the steps of lines, one after the other, in a history."""

    def __init__(self, history: History) -> None:
        self._history = history
        self._meshes: dict[str, Mesh] = {}

    def take(self, line: str) -> None:
        """Take the step of a line. Raises AutocolorError if it is unknown or refused."""
        call = called(expression_of(line), line)
        name = call.name.removeprefix("studio.")
        if call.name != f"studio.{name}":
            refuse(line)
        if name in ("undo", "redo"):
            self._move(name, call, line)
        elif name in ("keep_variant", "show_variant", "drop_variant"):
            self._variant(name, call, line)
        elif name == "mark_saved":
            self._mark_saved(call, line)
        elif name == "open":
            self._open(call, line)
        else:
            scene, same_step = self._edited(name, call, line)
            # As in a studio, an edit that changes nothing is no step.
            if not scene.equals(self._history.scene):
                self._history.take(scene, same_step)

    def _move(self, name: str, call: Called, line: str) -> None:
        if call.arguments or call.keywords:
            refuse(line)
        if not (self._history.to_undo if name == "undo" else self._history.to_redo):
            raise InputError(f"there must be a step to {name}, and there is none; remove the line")
        if name == "undo":
            self._history.undo()
        else:
            self._history.redo()

    def _variant(self, name: str, call: Called, line: str) -> None:
        named = [plain_value(value, line) for value in call.arguments]
        if call.keywords or len(named) != 1 or not isinstance(named[0], str):
            refuse(line)
        if name == "keep_variant":
            self._history.keep(named[0])
        elif name == "drop_variant":
            self._history.drop(named[0])
        elif not self._history.variants[named[0]].scene.equals(self._history.scene):
            self._history.show(named[0])

    def _mark_saved(self, call: Called, line: str) -> None:
        given = [plain_value(value, line) for value in call.arguments]
        files = given[0] if len(given) == 1 else None
        if call.keywords or not isinstance(files, dict):
            refuse(line)
        if not all(isinstance(each, str) for each in (*files, *files.values())):
            refuse(line)
        self._history.mark_saved(files)

    def _open(self, call: Called, line: str) -> None:
        options = {key: plain_value(value, line) for key, value in call.keywords.items()}
        tables, checksum = options.pop("tables", None), options.pop("checksum", None)
        is_known = options.keys() <= SOURCE_OPTIONS and isinstance(tables, (dict, type(None)))
        if not is_known or not all(isinstance(key, str) for key in tables or ()):
            refuse(line)
        source = source_in(call.arguments, options, line)
        self._history.open(opened(source, tables, checksum), source)

    def _edited(self, name: str, call: Called, line: str) -> tuple[Scene, bool]:
        """The scene that an edit gives, and whether it belongs to the step before."""
        scene = self._history.scene
        if name == "release_exposure" and not (call.arguments or call.keywords):
            return scene.replace(exposure=AUTO), False
        if name == "hold_exposure" and len(call.arguments) == 1 and not call.keywords:
            return scene.replace(exposure=plain_value(call.arguments[0], line)), False
        if name == "scalar" and [plain_value(value, line) for value in call.arguments] == [None]:
            return self._changed("without_scalar", call._replace(arguments=[]), line), False
        if name in STUDIO_METHODS:
            if name == "recolor" and not call.keywords.keys() <= fields_of(Paint).keys():
                refuse(line)
            return self._changed(STUDIO_METHODS[name], call, line), False
        if name != "edit" or len(call.arguments) != 1 or not call.keywords.keys() <= {"same_step"}:
            refuse(line)
        same_step = any(plain_value(value, line) is True for value in call.keywords.values())
        inner = called(call.arguments[0], line)
        method = inner.name.removeprefix("studio.scene.")
        if inner.name != f"studio.scene.{method}" or method not in SCENE_METHODS:
            refuse(line)
        return self._changed(method, inner, line), same_step

    def _changed(self, method: str, call: Called, line: str) -> Scene:
        """The scene that a method makes of the current one, by plain values and a mesh."""
        names = [plain_value(value, line) for value in call.arguments]
        mesh = call.keywords.get("mesh") if method == "replace" else None
        changes = {key: plain_value(value, line) for key, value in call.keywords.items() if value is not mesh}
        if mesh is not None:
            changes["mesh"] = self._mesh(mesh, line)
        if len(names) != (method in NAMED) or not all(isinstance(name, str) for name in names):
            refuse(line)
        if method in ("without_light", "without_scalar") and changes:
            refuse(line)
        scene: Scene = getattr(self._history.scene, method)(*names, **changes)
        return scene

    def _mesh(self, node: ast.expr, line: str) -> Mesh:
        """The mesh that an expression gives: the first one, or that of a scene, which is read once."""
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Call) and node.attr == "mesh":
            call = called(node.value, line)
            if call.name != "autocolor.read_scene" or call.keywords:
                refuse(line)
            path = source_in(call.arguments, {}, line).path
            if path not in self._meshes:
                self._meshes[path] = read_scene(path).mesh
            return self._meshes[path]
        if dotted(node, line) != FIRST_MESH:
            refuse(line)
        return self._history.start.mesh
