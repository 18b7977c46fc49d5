"""Reading a journal: the session that its lines give, without running it.

Each line is one statement. Only the calls that `script` writes are known, and their arguments must be plain
values; anything else is refused, with its line.
"""

from __future__ import annotations

import ast
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

from autocolor.checks import listed, shown
from autocolor.errors import AutocolorError, InputError, MissingInputError, UsageError
from autocolor.files.reading import read_bytes
from autocolor.files.scene_sources import read_scene
from autocolor.journal.history import History
from autocolor.journal.script import HEADER, ROW_METHODS, SHORT, STUDIO, Source, checksum_of
from autocolor.scene.columns.column import fields_of
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Paint

LARGEST_JOURNAL: Final = 64 << 20
"""Assumed: bytes; some hundred thousand steps."""

LONGEST_LINE: Final = 1 << 20
"""Assumed: characters; a step that changes some thousand rows."""

MOST_STEPS: Final = 1_000_000
LONGEST_PROBLEM: Final = 400

STUDIO_METHODS: Final = {short: method for method, short in SHORT.items()}
SCENE_METHODS: Final = ("replace", *ROW_METHODS.values(), *SHORT)

MADE_BY: Final = ("read_scene", "replace", "a checksum")
"""The lines between the header and the studio."""

NAMED: Final = frozenset((*ROW_METHODS.values(), "with_new_light", "without_light"))
"""The methods whose one argument without a keyword is the name of a row."""


class Session(NamedTuple):
    """What a journal tells: the history of a session, and what its first scene was read from."""

    history: History
    source: Source


class Called(NamedTuple):
    """A call in a line: what is called, its arguments, those with a keyword apart."""

    name: str
    arguments: list[ast.expr]
    keywords: dict[str, ast.expr]


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
    (first, read), (second, replaced), (third, checksum) = lines[len(HEADER) : begun]
    with _in_line(name, first):
        source = _source(read)
        start = read_scene(source.path, up=source.up, surfaces=source.surfaces)
    with _in_line(name, second):
        start = _with_tables(start, replaced)
    with _in_line(name, third):
        if _plain(_value_of(checksum, "checksum"), checksum) != checksum_of(start):
            raise InputError(
                f"{source.path} must hold the mesh with which the session began, and it was changed since;"
                " bring the old file back"
            )
    history = History(start)
    for number, line in lines[begun + 1 :]:
        with _in_line(name, number):
            _take(history, line)
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


def _source(line: str) -> Source:
    """What the first scene is read from."""
    called = _called(_value_of(line, "scene"), line)
    options = {key: _plain(value, line) for key, value in called.keywords.items()}
    paths = [_plain(value, line) for value in called.arguments]
    is_known = called.name == "autocolor.read_scene" and options.keys() <= {"up", "surfaces"}
    if (
        not is_known
        or len(paths) != 1
        or not all(isinstance(each, str) for each in (*paths, *options.values()))
    ):
        _refuse(line)
    return Source(paths[0], **options)


def _with_tables(scene: Scene, line: str) -> Scene:
    """The first scene of a session: its tables, with the mesh of the scene that was read."""
    called = _called(_value_of(line, "scene"), line)
    if called.name != "scene.replace":
        _refuse(line)
    return _edited(scene, "replace", called, line)


def _take(history: History, line: str) -> None:
    """Take the step of a line."""
    called = _called(_expression(line), line)
    method = called.name.removeprefix("studio.")
    if called.name in ("studio.undo", "studio.redo") and not called.arguments and not called.keywords:
        if not (history.to_undo if method == "undo" else history.to_redo):
            raise InputError(f"there must be a step to {method}, and there is none; remove the line")
        if method == "undo":
            history.undo()
        else:
            history.redo()
        return
    same_step = False
    if called.name == "studio.recolor":
        if not called.keywords.keys() <= fields_of(Paint).keys():
            _refuse(line)
        scene = _edited(history.scene, "with_surface", called, line)
    elif called.name == f"studio.{method}" and method in STUDIO_METHODS:
        scene = _edited(history.scene, STUDIO_METHODS[method], called, line)
    elif called.name == "studio.edit" and len(called.arguments) == 1:
        if not called.keywords.keys() <= {"same_step"}:
            _refuse(line)
        same_step = any(_plain(value, line) is True for value in called.keywords.values())
        inner = _called(called.arguments[0], line)
        method = inner.name.removeprefix("studio.scene.")
        if inner.name != f"studio.scene.{method}" or method not in SCENE_METHODS:
            _refuse(line)
        scene = _edited(history.scene, method, inner, line)
    else:
        _refuse(line)
    # As in a studio, an edit that changes nothing is no step.
    if not scene.equals(history.scene):
        history.take(scene, same_step)


def _edited(scene: Scene, method: str, called: Called, line: str) -> Scene:
    """The scene that a method makes of another, by plain values."""
    names = [_plain(value, line) for value in called.arguments]
    changes = {key: _plain(value, line) for key, value in called.keywords.items()}
    if len(names) != (method in NAMED) or not all(isinstance(name, str) for name in names):
        _refuse(line)
    if method == "without_light" and changes:
        _refuse(line)
    edited: Scene = getattr(scene, method)(*names, **changes)
    return edited


def _value_of(line: str, name: str) -> ast.expr:
    """The value that a line assigns to a name."""
    statement = _statement(line)
    if not isinstance(statement, ast.Assign) or [ast.unparse(each) for each in statement.targets] != [name]:
        _refuse(line)
    return statement.value


def _expression(line: str) -> ast.expr:
    statement = _statement(line)
    if not isinstance(statement, ast.Expr):
        _refuse(line)
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
        _refuse(line)
    return statement


def _called(node: ast.expr, line: str) -> Called:
    """The call that an expression is, of a name with dots, without * and **."""
    if not isinstance(node, ast.Call) or any(keyword.arg is None for keyword in node.keywords):
        _refuse(line)
    parts: list[str] = []
    function = node.func
    while isinstance(function, ast.Attribute):
        parts.append(function.attr)
        function = function.value
    if not isinstance(function, ast.Name):
        _refuse(line)
    keywords = {str(keyword.arg): keyword.value for keyword in node.keywords}
    return Called(".".join([function.id, *reversed(parts)]), node.args, keywords)


def _plain(node: ast.expr, line: str) -> Any:
    """The plain value of an argument."""
    try:
        return ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError):
        _refuse(line)


def _refuse(line: str) -> NoReturn:
    raise UsageError(
        f"it must be a call that autocolor writes, with plain values, not {shown(line)}; remove it"
    )
