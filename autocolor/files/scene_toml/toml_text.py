"""TOML: parsing in bounded time and memory, the lines of keys and of problems, and writing values.

`tomllib` needs time and memory quadratic in the parts of a dotted key, and recurses into nested arrays. So
the text is first split into tokens by a regular expression, in linear time, and refused if it exceeds a
bound.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any, Final, NamedTuple

from autocolor.checks import shown
from autocolor.errors import InputError, MissingInputError
from autocolor.files.reading import text_problem
from autocolor.scene.columns import Problem

LARGEST_TEXT: Final = 1 << 20
"""Limit: size of a scene file, in bytes."""

MOST_NESTED: Final = 16
MOST_KEY_PARTS: Final = 8
LONGEST_WORD: Final = 100
"""Limit: characters of a number or of a key without quotes; a scene needs a tenth of that."""

TOKEN: Final = re.compile(
    r"""
      (?P<comment> \#[^\n]* )
    | (?P<string> \"{3} (?: [^"\\] | \\. | \"{1,2}(?!\") )* (?: \"{3,5} | \Z )
                | '{3} (?: [^'] | '{1,2}(?!') )* (?: '{3,5} | \Z )
                | " (?: [^"\\\n] | \\[^\n] )* (?: " | (?=\n) | \Z | \\ )
                | ' [^'\n]* (?: ' | (?=\n) | \Z ) )
    | (?P<open> [\[{] ) | (?P<close> [\]}] )
    | (?P<newline> \n ) | (?P<comma> , ) | (?P<equals> = ) | (?P<dot> \. )
    | (?P<word> [^\s#"'\[\]{},=.]+ )
    | (?P<space> [^\S\n]+ )
    """,
    re.VERBOSE | re.DOTALL,
)

KeyPath = tuple[str | int, ...]


def parsed_toml(data: bytes, place: str, what: str = "a scene file") -> dict[str, Any]:
    """The parsed TOML text; `place` is the file's name in messages. Raises InputError with the line."""
    if problem := text_problem(data):
        raise InputError(f"{place}: {what} {problem}")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(f"{place}, line {line}: {what} must be text in UTF-8; save it as UTF-8") from None
    nested, parts = 0, 1
    for token in TOKEN.finditer(text):
        kind = token.lastgroup
        nested = max(0, nested + (kind == "open") - (kind == "close"))
        parts = parts + (kind == "dot") if kind in ("dot", "word", "string", "space") else 1
        is_long = kind == "word" and len(token[0]) > LONGEST_WORD
        if nested > MOST_NESTED or parts > MOST_KEY_PARTS or is_long:
            raise InputError(
                f"{place}, line {text.count(chr(10), 0, token.start()) + 1}: {what} must have at most"
                f" {MOST_NESTED} nested brackets, {MOST_KEY_PARTS} parts of a key and words of {LONGEST_WORD}"
                " letters; write it simpler"
            )
    try:
        return tomllib.loads(text)
    except (ValueError, ArithmeticError, LookupError, TypeError) as error:
        raise InputError(f"{place}: it must be valid TOML ({str(error)[-200:]}); correct it") from None


class Statement(NamedTuple):
    """A header, or a key with its value: where its line or lines start and end in the text.

    `path` leads from the file's root to the value or the table; rows of arrays of tables count from 0.
    """

    path: KeyPath
    start: int
    end: int
    is_header: bool


def statements_of(text: str) -> Iterator[Statement]:
    """The headers and keys of a valid TOML text whose lines end with line feeds."""
    table: KeyPath = ()
    rows: dict[KeyPath, int] = {}
    first, stop, equals, nested = -1, 0, 0, 0
    for token in TOKEN.finditer(f"{text}\n"):
        kind = token.lastgroup
        nested += (kind == "open") - (kind == "close")
        if kind not in ("comment", "space", "newline"):
            first = token.start() if first < 0 else first
            stop = token.end()
            equals = token.start() if kind == "equals" and not equals else equals
        elif kind == "newline" and nested <= 0 and first >= 0:
            is_header = text[first] == "["
            if is_header:
                path = table = _path((), text[first:stop], rows, text.startswith("[[", first))
            else:
                path = _path(table, f"{text[first:equals]} = 0", rows, False)
            yield Statement(path, first, min(token.end(), len(text)), is_header)
            first, equals = -1, 0


def _path(table: KeyPath, text: str, rows: dict[KeyPath, int], is_row: bool) -> KeyPath:
    """The path of a header or a key in a table, with row numbers; the parser itself reads the keys.

    `rows` has the number of the last row of each array of tables.
    """
    value: Any = tomllib.loads(text)
    path = table
    while value:
        key, value = next(iter(value.items()))
        path = (*path, key)
        value = value[0] if isinstance(value, list) else value
        if is_row and not value:
            rows[path] = rows.get(path, -1) + 1
        if path in rows:
            path = (*path, rows[path])
    return path


# Writing.

BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]{1,100}")


def key_text(path: KeyPath, value: object) -> str:
    """The line of a key; of a table of tables, such as flaps, a line for each inner table."""
    if isinstance(value, Mapping) and value and all(isinstance(inner, Mapping) for inner in value.values()):
        return "".join(key_text((*path, name), inner) for name, inner in value.items())
    return f"{'.'.join(toml_key(str(name)) for name in path)} = {toml_value(value)}\n"


def toml_key(name: str) -> str:
    """The name as a key of TOML, in quotes if it needs them."""
    return name if BARE_KEY.fullmatch(name) else toml_value(name)


def toml_value(value: object) -> str:
    """The plain value as TOML; a number is written so that it reads back equal."""
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, Mapping) and not value:
        return "{}"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{toml_key(key)} = {toml_value(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, (str, bool)):
        if isinstance(value, str) and any("\ud800" <= letter <= "\udfff" for letter in value):
            raise InputError(f"a text in a file must be valid in UTF-8, not {shown(value)}; rename it")
        # TOML has the escapes of JSON. What can be printed stays legible.
        letters = json.dumps(value, ensure_ascii=False)
        return "".join(each if each.isprintable() else f"\\U{ord(each):08x}" for each in letters)
    return repr(value)


# The problems of a file, with their lines, tables and keys.

MOST_PROBLEMS: Final = 100


class SceneProblems:
    """Collects the problems of one scene file and raises them in line order."""

    def __init__(self, place: str, data: bytes, document: dict[str, Any]) -> None:
        self.place = place
        self.data = data
        self.document = document
        self.messages: list[tuple[int, str, bool]] = []

    @property
    def full(self) -> bool:
        """Whether the report has reached its largest number of problems."""
        return len(self.messages) >= MOST_PROBLEMS

    @cached_property
    def _lines(self) -> dict[KeyPath, int]:
        """The line of each table and key, by its path; rows of arrays count from 0."""
        text = self.data.decode().replace("\r\n", "\n")
        lines: dict[KeyPath, int] = {}
        line, before = 1, 0
        for statement in statements_of(text):
            line += text.count("\n", before, statement.start)
            before = statement.start
            for end in range(1, len(statement.path) + 1):
                lines.setdefault(statement.path[:end], line)
        return lines

    def note(self, path: KeyPath, text: str) -> None:
        """Add a problem of the value at a path."""
        self.note_all([Problem(path, text)])

    def note_all(self, problems: Iterable[Problem], path: KeyPath = ()) -> None:
        """Add problems of the table at a path."""
        self.messages += [(*self._message(problem.under(path)), False) for problem in problems]
        del self.messages[MOST_PROBLEMS:]

    def note_file(self, path: KeyPath, error: InputError) -> None:
        """Add the problems of a mesh file; their messages name the file. `path` is the key that names it."""
        is_missing = isinstance(error, MissingInputError)
        line = self._line(path)
        start = f"{self.place}, line {line}: " if is_missing else ""
        self.messages += [(line, f"{start}{sentence}", is_missing) for sentence in error.problems]
        del self.messages[MOST_PROBLEMS:]

    def raise_any(self) -> None:
        """Raise InputError with all problems, if any; MissingInputError if only files are missing."""
        sentences = [sentence for _, sentence, _ in sorted(self.messages, key=lambda message: message[0])]
        if self.full:
            sentences.append(f"{self.place}: there may be more problems; correct these first")
        if sentences:
            all_missing = all(is_missing for *_, is_missing in self.messages)
            raise MissingInputError(sentences) if all_missing else InputError(sentences)

    def _message(self, problem: Problem) -> tuple[int, str]:
        """The line of a problem, and its sentence with the file, the line, the table and the key."""
        path = problem.path
        table, key = (*path, "", "")[:2]
        where, depth = "", 0
        if isinstance(key, int):
            name = row.get("name") if isinstance(row := self.document[str(table)][key], dict) else None
            where, depth = f"{table}[{key + 1}]{f' {name[:60]!r}' if isinstance(name, str) else ''}: ", 2
        elif table in ("surfaces", "parts") and len(path) > 1:
            where, depth = f"[{table}.{key[:60]}]: ", 2
        line = self._line(path)
        sentence = problem._replace(path=path[depth:]).sentence
        return line, f"{self.place}{f', line {line}' if line else ''}, {where}{sentence}"

    def _line(self, path: KeyPath) -> int:
        """The line of a path, or of the nearest table around it; 0 if the file has neither."""
        around = [path[:end] for end in range(len(path), 0, -1)]
        return next((self._lines[table] for table in around if table in self._lines), 0)
