"""The text of a TOML file as blocks of statements; joined again they are the same text.

A block is a header and the statements below it; the first one has no header. Comments directly above a
header, with no empty line between, belong to it; a comment at the top of a file that is the only one above
the first header belongs to the file.

Measured and rejected: tomlkit leaves the comment above a header with the table before, gathers arrays of
tables that stand apart, writes an inline table anew for each change, and takes 21 s to save a file of a
megabyte; with what mends the first, there is as much code as here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from autocolor.files.scenes.toml_text import TOKEN, KeyPath, only_path

EMPTY_LINE: Final = re.compile(r"^[ \t\r]*\n", re.MULTILINE)


@dataclass(eq=False)
class Statement:
    """A key with its value, as written: `before` are the lines above it, `after` is the rest of its line.

    `path` leads from the file's root to the value; rows of arrays of tables count from 0.
    """

    path: KeyPath
    before: str
    key: str
    equals: str
    value: str
    after: str

    @property
    def text(self) -> str:
        """The statement as it is written, with the lines above it."""
        return f"{self.before}{self.key}{self.equals}{self.value}{self.after}"


@dataclass(eq=False)
class Block:
    """A header, with the comment above it, its statements, and the lines below them."""

    path: KeyPath
    head: str
    statements: list[Statement] = field(default_factory=list)
    tail: str = ""

    @property
    def text(self) -> str:
        """The block as it is written."""
        return self.head + "".join(statement.text for statement in self.statements) + self.tail


def blocks_of(text: str) -> list[Block]:
    """The blocks of a valid TOML text, whose lines end with line feeds."""
    blocks = [Block((), "")]
    rows: dict[KeyPath, int] = {}
    for lead, statement, equals, after in _pieces(text):
        if not statement:
            blocks[-1].tail = lead
        elif statement.startswith("["):
            array = statement.startswith("[[")
            # What is above the last empty line is of the block before.
            above = max((found.end() for found in EMPTY_LINE.finditer(lead)), default=0)
            if len(blocks) == 1 and not blocks[0].statements and not above:
                above = len(lead)
            blocks[-1].tail, comment = lead[:above], lead[above:]
            path = _resolved((), only_path(statement, statement), rows, array)
            blocks.append(Block(path, comment + statement + after))
        else:
            key = statement[:equals].rstrip()
            value = statement[equals + 1 :].lstrip()
            path = _resolved(blocks[-1].path, only_path(f"{key} = 0", statement), rows, False)
            between = statement[len(key) : len(statement) - len(value)]
            blocks[-1].statements.append(Statement(path, lead, key, between, value, after))
    return blocks


def _resolved(table: KeyPath, parts: tuple[str, ...], rows: dict[KeyPath, int], array: bool) -> KeyPath:
    """The path of a header or key in a table, with row numbers; a header of an array begins a row."""
    path = table
    for depth, part in enumerate(parts):
        path = (*path, part)
        if array and depth == len(parts) - 1:
            rows[path] = rows.get(path, -1) + 1
        if path in rows:
            path = (*path, rows[path])
    return path


def _pieces(text: str) -> Iterator[tuple[str, str, int, str]]:
    """Each statement: the lines above, its text, the place of its = in it, and the rest of its line.

    The last one is empty, with the lines above the end of the file.
    """
    start, first, stop, equals, nested = 0, -1, 0, 0, 0
    for token in TOKEN.finditer(text):
        kind = token.lastgroup
        nested += (kind == "open") - (kind == "close")
        if kind == "newline" and nested <= 0:
            if first >= 0:
                yield text[start:first], text[first:stop], equals, text[stop : token.end()]
                start, first, equals = token.end(), -1, 0
            nested = 0
        elif kind not in ("comment", "space", "newline"):
            first = token.start() if first < 0 else first
            stop = token.end()
            if kind == "equals" and not equals:
                equals = token.start() - first
    if first >= 0:
        yield text[start:first], text[first:stop], equals, text[stop:]
        start = len(text)
    yield text[start:], "", 0, ""


class InlineItem(NamedTuple):
    """An item of an inline table: the path of its key, its key as written, and the place of its value."""

    path: KeyPath
    key: str
    start: int
    stop: int


def inline_items(text: str) -> list[InlineItem]:
    """The items of an inline table, whose text is from its opening bracket to its closing one."""
    items: list[InlineItem] = []
    nested, first, equals, stop = 0, 1, 0, 0
    for token in TOKEN.finditer(text):
        kind = token.lastgroup
        nested += (kind == "open") - (kind == "close")
        if (kind == "comma" and nested == 1) or (kind == "close" and nested == 0):
            if equals:
                key = text[first : equals - 1].strip()
                start = equals + len(text[equals:stop]) - len(text[equals:stop].lstrip())
                items.append(InlineItem(only_path(f"{key} = 0", f"{key} = 0"), key, start, stop))
            first, equals = token.end(), 0
        elif kind == "equals" and nested == 1 and not equals:
            equals = token.end()
        elif kind != "space":
            stop = token.end()
    return items
