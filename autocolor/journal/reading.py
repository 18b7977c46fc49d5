"""Reading a journal: the session that its lines give, without running it.

Each line is one statement. Only the calls that `script` writes are known, and their arguments must be plain
values; anything else is refused, with its line.
"""

from __future__ import annotations

import ast
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

from autocolor.checks import listed, shown
from autocolor.errors import AutocolorError, InputError, MissingInputError, UsageError
from autocolor.files.reading import read_bytes
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import History
from autocolor.journal.opening import check_sum, opened, place_again
from autocolor.journal.places import Source, place_of
from autocolor.journal.script import FIRST_MESH, HEADER, ROW_METHODS, SHORT, STUDIO
from autocolor.scene.columns import fields_of
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import AUTO, Scene
from autocolor.scene.surfaces import Paint

# -------------------- lines
# The lines of a journal as Python statements: calls of names with plain values, which are never run.

LONGEST_LINE: Final = 1 << 20
"""Assumed: characters; a step that changes some thousand rows."""


class Called(NamedTuple):
    """A call in a line: what is called, its arguments, those with a keyword apart."""

    name: str
    arguments: list[ast.expr]
    keywords: dict[str, ast.expr]


def value_of(line: str, name: str) -> ast.expr:
    """The value that a line assigns to a name."""
    statement = _statement(line)
    if not isinstance(statement, ast.Assign) or [ast.unparse(each) for each in statement.targets] != [name]:
        refuse(line)
    return statement.value


def expression_of(line: str) -> ast.expr:
    """The expression that a line is."""
    statement = _statement(line)
    if not isinstance(statement, ast.Expr):
        refuse(line)
    return statement.value


def _statement(line: str) -> ast.stmt:
    """The one statement of a line."""
    if len(line) > LONGEST_LINE:
        raise InputError(f"it must be at most {LONGEST_LINE:,} characters, not {len(line):,}; remove it")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            (statement,) = ast.parse(line).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        refuse(line)
    return statement


def called(node: ast.expr, line: str) -> Called:
    """The call that an expression is, of a name with dots, without * and **."""
    if not isinstance(node, ast.Call) or any(keyword.arg is None for keyword in node.keywords):
        refuse(line)
    if any(isinstance(argument, ast.Starred) for argument in node.args):
        refuse(line)
    keywords = {str(keyword.arg): keyword.value for keyword in node.keywords}
    return Called(dotted(node.func, line), node.args, keywords)


def dotted(node: ast.expr, line: str) -> str:
    """The name with dots that an expression is."""
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    if not isinstance(node, ast.Name):
        refuse(line)
    return ".".join([node.id, *reversed(parts)])


def plain_value(node: ast.expr, line: str) -> Any:
    """The plain value of an argument."""
    try:
        return ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError):
        refuse(line)


def refuse(line: str) -> NoReturn:
    """Raise UsageError: a line is nothing that a journal has."""
    raise UsageError(
        f"it must be a call that autocolor writes, with plain values, not {shown(line)}; remove it"
    )


# -------------------- steps
# The steps of a journal, taken again from their lines.
#
# Only the calls that `script` writes are known, and their arguments must be plain values; nothing is run.

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


LARGEST_JOURNAL: Final = 64 << 20
"""Assumed: bytes; some hundred thousand steps."""

MOST_STEPS: Final = 1_000_000
LONGEST_PROBLEM: Final = 400

MADE_BY: Final = ("read_scene", "replace", "a checksum")
"""The lines between the header and the studio."""


class Session(NamedTuple):
    """What a journal tells: the history of a session, and what its first scene was read from."""

    history: History
    source: Source


def read_journal(path: str | os.PathLike[str]) -> Session:
    """The session of a journal, which is not run: `Studio(read_journal(path).history, display)` goes on.

    The mesh with which it began is read again. Raises InputError if a line is no known call with plain
    values, if a step is refused, or if the mesh is not the same as then; MissingInputError if a file is
    missing.
    """
    name = Path(path).name
    data = read_bytes(Path(path), LARGEST_JOURNAL)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{name}: a journal must be text in UTF-8; choose another file") from None
    return session_of(text, name)


def session_of(text: str, name: str = "journal") -> Session:
    """The session of the text of a journal; see `read_journal`. `name` is what messages call it."""
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.startswith("#")]
    if len(lines) > MOST_STEPS:
        raise InputError(f"{name}: a journal must have at most {MOST_STEPS:,} lines, not {len(lines):,}")
    given = [line for _, line in lines]
    if tuple(given[: len(HEADER)]) != HEADER or STUDIO not in given:
        raise InputError(f"{name}: a journal must begin as autocolor writes it; choose another file")
    begun = given.index(STUDIO)
    if begun != len(HEADER) + len(MADE_BY):
        raise InputError(f"{name}: a journal must make its scene by {listed(MADE_BY)}; choose another file")
    (first, made), (second, replaced), (third, checksum) = lines[len(HEADER) : begun]
    with _in_line(name, first):
        source = _source(called(value_of(made, "scene"), made), made)
        place = place_of(source)
        read = read_scene(source.path, up=source.up, scale=source.scale, surfaces=source.surfaces)
    with _in_line(name, second):
        start = _with_tables(read, replaced)
    with _in_line(name, third):
        check_sum(start, plain_value(value_of(checksum, "checksum"), checksum), source)
    history = History(start, place_again(place, start, read))
    steps = Steps(history)
    for number, line in lines[begun + 1 :]:
        with _in_line(name, number):
            steps.take(line)
    return Session(history, source)


@contextmanager
def _in_line(name: str, number: int) -> Iterator[None]:
    """Raise errors as InputError with the number of the line."""
    try:
        yield
    except AutocolorError as error:
        kind = MissingInputError if isinstance(error, MissingInputError) else InputError
        problem = str(error).replace("\n", "; ")
        raise kind(f"{name}, line {number}: {problem[:LONGEST_PROBLEM]}") from None


def _source(call: Called, line: str) -> Source:
    """What the first scene is read from."""
    options = {key: plain_value(value, line) for key, value in call.keywords.items()}
    if call.name != "autocolor.read_scene" or not options.keys() <= SOURCE_OPTIONS:
        refuse(line)
    return source_in(call.arguments, options, line)


def _with_tables(scene: Scene, line: str) -> Scene:
    """The first scene of a session: its tables, with the mesh of the scene that was read."""
    call = called(value_of(line, "scene"), line)
    if call.name != "scene.replace" or call.arguments:
        refuse(line)
    return scene.replace(**{key: plain_value(value, line) for key, value in call.keywords.items()})
