"""Parsing TOML with bounded time and memory, and finding the line of each key.

`tomllib` needs time and memory quadratic in the parts of a dotted key, and recurses into nested arrays. So
the text is first split into tokens by a regular expression, in linear time, and refused if it exceeds a
bound.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.reading import text_problem

LARGEST_TEXT: Final = 1 << 20
"""Largest size of a scene file, in bytes."""

MOST_NESTED: Final = 16
MOST_KEY_PARTS: Final = 8
LONGEST_WORD: Final = 100
"""Assumed: characters of a number or of a key without quotes; a scene needs a tenth of that."""

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
        raise InputError(
            f"{place}, line {line}: {what} must be text in UTF-8, not bytes like"
            f" 0x{data[error.start]:02x}; save it as UTF-8"
        ) from None
    _check_bounds(text, place)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax_problem(str(error), text, place)) from None
    except (ValueError, ArithmeticError, LookupError, TypeError, RecursionError) as error:
        raise InputError(f"{place}: it must be valid TOML ({error}); correct it") from None


def _syntax_problem(message: str, text: str, place: str) -> str:
    """The parser's error message as one of ours, with file and line."""
    found = re.search(r" \(at line (\d+), column (\d+)\)$", message)
    if found:
        line, column = found[1], f"column {found[2]}"
        message = message[: found.start()]
    else:
        line, column = str(text.rstrip("\n").count("\n") + 1), "the end of the file"
        message = message.removesuffix(" (at end of document)")
    reason = message[:1].lower() + message[1:200]
    return f"{place}, line {line}: it must be valid TOML, but is not at {column} ({reason}); correct the line"


def _check_bounds(text: str, place: str) -> None:
    """Raise InputError for deep nesting, long dotted keys and long words, which are slow to parse."""
    nested = dots = 0
    for token in TOKEN.finditer(text):
        kind = token.lastgroup
        rule = ""
        if kind == "open":
            nested += 1
            if nested > MOST_NESTED:
                rule = f"brackets must be nested at most {MOST_NESTED} deep, not deeper; flatten them"
        elif kind == "close":
            nested = max(0, nested - 1)
        elif kind == "dot":
            dots += 1
            if dots >= MOST_KEY_PARTS:
                rule = f"a key must have at most {MOST_KEY_PARTS} parts between dots, not more; shorten it"
        elif kind == "word" and len(token[0]) > LONGEST_WORD:
            rule = (
                f"a number or a key must have at most {LONGEST_WORD} digits or letters, not"
                f" {len(token[0]):,}; write it shorter, or in quotes"
            )
        if rule:
            raise InputError(f"{place}, line {text.count(chr(10), 0, token.start()) + 1}: {rule}")
        if kind in ("open", "close", "newline", "comma", "equals"):
            dots = 0


def key_lines(data: bytes) -> dict[KeyPath, int]:
    """The line of each table and key of a valid TOML text, by its path; rows of arrays count from 0."""
    lines: dict[KeyPath, int] = {}
    rows: dict[KeyPath, int] = {}
    table: KeyPath = ()
    for line, statement in _statements(data.decode("utf-8", "replace").replace("\r\n", "\n")):
        array = statement.startswith("[[")
        header = statement.startswith("[")
        # Let the parser itself read the header or the key.
        path = only_path(statement if header else statement.split("=", 1)[0] + "= 0", statement)
        resolved: KeyPath = () if header else table
        for depth, part in enumerate(path):
            resolved = (*resolved, part)
            if array and depth == len(path) - 1:
                rows[resolved] = rows.get(resolved, -1) + 1
            if resolved in rows:
                lines.setdefault(resolved, line)
                resolved = (*resolved, rows[resolved])
            lines.setdefault(resolved, line)
        if header:
            table = resolved
    return lines


def only_path(text: str, statement: str) -> tuple[str, ...]:
    """The path of keys in a header, or in a statement whose value was removed."""
    try:
        value: Any = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        # An equals sign in a quoted key: parse the whole statement.
        try:
            value = tomllib.loads(statement)
        except tomllib.TOMLDecodeError:
            return ()
    path: list[str] = []
    while isinstance(value, (dict, list)) and value and len(path) < MOST_KEY_PARTS:
        if isinstance(value, list):
            value = value[0]
        else:
            key = next(iter(value))
            path.append(key)
            value = value[key]
    return tuple(path)


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Each header, and each key with its value, with the number of its first line."""
    line, first, nested = 1, 1, 0
    words: list[str] = []
    for token in TOKEN.finditer(text + "\n"):
        kind = token.lastgroup
        nested += (kind == "open") - (kind == "close")
        if kind == "newline" and nested <= 0:
            if words:
                yield first, "".join(words)
            words, nested = [], 0
        elif kind != "comment" and not (kind == "space" and not words):
            first = first if words else line
            words.append(token[0])
        line += token[0].count("\n")
