"""Editing values in the text of a TOML file; everything else stays as it is written.

A changed value replaces the old value in its place, also inside an inline table. A new key is written below
the other keys of its table, or into a new table after tables of the same kind. Removing a key removes the
rest of its line, but not the comments above it. Removing a table removes the comments above its header.

The text is split into blocks of statements; joined again they are the same text. A block is a header and the
statements below it; the first block has no header. Comments directly above a header, with no empty line
between, belong to it. A comment at the top of a file, if it is the only comment above the first header,
belongs to the file.

Measured and rejected: tomlkit leaves the comment above a header with the table before, gathers arrays of
tables that stand apart, writes an inline table anew for each change, and takes 21 s to save a file of a
megabyte; with repairs for the first fault, there is as much code as here.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from autocolor.files.scene_toml.toml_text import (
    TOKEN,
    KeyPath,
    key_path,
    resolved_path,
    statements_of,
    toml_key,
    toml_value,
)

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
    for lead, statement, equals, after in statements_of(text):
        if not statement:
            blocks[-1].tail = lead
        elif statement.startswith("["):
            array = statement.startswith("[[")
            # The lines above the last empty line belong to the block before.
            above = max((line.end() for line in EMPTY_LINE.finditer(lead)), default=0)
            if len(blocks) == 1 and not blocks[0].statements and not above:
                above = len(lead)
            blocks[-1].tail, comment = lead[:above], lead[above:]
            path = resolved_path((), key_path(statement), rows, array)
            blocks.append(Block(path, comment + statement + after))
        else:
            key = statement[:equals].rstrip()
            value = statement[equals + 1 :].lstrip()
            path = resolved_path(blocks[-1].path, key_path(f"{key} = 0"), rows, False)
            between = statement[len(key) : len(statement) - len(value)]
            blocks[-1].statements.append(Statement(path, lead, key, between, value, after))
    return blocks


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
                items.append(InlineItem(key_path(f"{key} = 0"), key, start, stop))
            first, equals = token.end(), 0
        elif kind == "equals" and nested == 1 and not equals:
            equals = token.end()
        elif kind != "space":
            stop = token.end()
    return items


class TomlText:
    """A valid TOML text to be edited.

    `tables` are the names of the tables that get headers of their own, in the order of new ones.

    A path leads from the root to a value. A row of an array of tables keeps the number that it has in the
    original text; a new row has any other number.
    """

    def __init__(self, text: str, tables: Sequence[str]) -> None:
        # Edit lines that end with line feeds; a file whose lines end otherwise gets them back.
        self._ends = "\r\n" if text.count("\r\n") == text.count("\n") > 0 else "\n"
        self._tables = tables
        self._blocks = blocks_of(text.replace(self._ends, "\n"))

        self._index()

    @property
    def text(self) -> str:
        """The edited text."""
        return "".join(block.text for block in self._blocks).replace("\n", self._ends)

    def has(self, path: KeyPath) -> bool:
        """Whether the text has a key or a table at a path or below it; inline tables are not searched."""
        return path in self._paths

    def set(self, path: KeyPath, value: Any) -> None:
        """Set the value at a path. A missing key is added."""
        for end in range(1, len(path) + 1):
            statement = self._statement_at.get(path[:end])
            if statement is not None:
                rest = path[end:]
                statement.value = _inline(statement.value, rest, value) if rest else toml_value(value)
                return
        self.remove(path)
        self._add(path, value)

    def remove(self, *paths: KeyPath) -> None:
        """Remove the keys and tables at some paths and below them, if any.

        Remove many paths in one call: each call goes through the whole text.
        """
        for path in paths:
            for end in range(1, len(path)):
                statement = self._statement_at.get(path[:end])
                if statement is not None:
                    statement.value = _inline_without(statement.value, path[end:])
        removed = self._paths.intersection(paths)
        if not removed:
            return

        def is_removed(path: KeyPath) -> bool:
            return any(path[:end] in removed for end in range(1, len(path) + 1))

        last = self._blocks[-1]
        self._blocks = [block for block in self._blocks if not is_removed(block.path)]
        for block in self._blocks:
            statements, above = [], ""
            for statement in block.statements:
                if is_removed(statement.path):
                    above += statement.before
                else:
                    statement.before, above = above + statement.before, ""
                    statements.append(statement)
            block.statements, block.tail = statements, above + block.tail
        if self._blocks[-1] is not last:
            end_block = self._blocks[-1]
            end_block.tail = f"{end_block.tail.rstrip()}\n" if end_block.tail.strip() else ""
        self._index()

    def arrange(self, table: str, keys: Sequence[str | int]) -> bool:
        """Sort the rows of a table by these names or numbers; returns whether every row has a header."""
        rows = [block for block in self._blocks if len(block.path) > 1 and block.path[0] == table]
        place_of = {key: place for place, key in enumerate(keys)}
        ordered = sorted(
            (block for block in rows if block.path[1] in place_of), key=lambda block: place_of[block.path[1]]
        )
        if len(ordered) == len(rows) and ordered != rows:
            place = self._blocks.index(rows[0])
            in_table = set(rows)
            others = [block for block in self._blocks if block not in in_table]
            self._blocks = [*others[:place], *ordered, *others[place:]]
            self._end_with_empty_lines(place - 1, place + len(rows) - 1)
        return {block.path[1] for block in rows} == set(keys)

    def _index(self) -> None:
        """Note the place of every path. Without this, editing many keys takes the square of their number."""
        self._paths: set[KeyPath] = {()}
        self._statement_at: dict[KeyPath, Statement] = {}
        self._block_at: dict[KeyPath, Block] = {}
        for block in self._blocks:
            self._block_at.setdefault(block.path, block)
            self._note(block.path)
            for statement in block.statements:
                self._statement_at[statement.path] = statement
                self._note(statement.path)

    def _note(self, path: KeyPath) -> None:
        self._paths.update(path[:end] for end in range(1, len(path) + 1))

    def _add(self, path: KeyPath, value: Any) -> None:
        """Add a key that the text does not have."""
        table = path[:-1]
        block = self._block_at.get(table)
        if block is None and table in self._paths:
            # Insert the key next to dotted keys of the same table.
            for block in self._blocks:
                beside = [row for row, each in enumerate(block.statements) if _is_below(each.path, table)]
                if beside and _is_below(table, block.path):
                    self._insert(block, beside[-1] + 1, path, value)
                    return
            # The text has only headers of tables inside this table.
            block = self._new_block(table)
        if block is None:
            above = (self._block_at.get(table[:end]) for end in range(len(table) - 1, 0, -1))
            block = next((each for each in above if each is not None), None)
            if path[0] not in self._tables:
                block = block or self._blocks[0]
            elif block is None or self._has_headers(block):
                block = self._new_block(table)
        self._insert(block, len(block.statements), path, value)

    def _has_headers(self, block: Block) -> bool:
        """Whether tables inside of a block's table have headers of their own."""
        return any(_is_below(each.path, block.path) and each is not block for each in self._blocks)

    def _insert(self, block: Block, row: int, path: KeyPath, value: Any) -> None:
        """Write a new key as a statement of a block, at a row of its statements."""
        before = ""
        if row:
            block.statements[row - 1].after = block.statements[row - 1].after.rstrip("\n") + "\n"
        elif block.head:
            block.head = block.head.rstrip("\n") + "\n"
        elif not block.statements:
            # Below the comment at the top of the file.
            before, block.tail = block.tail, "\n"
            if before and not before.endswith("\n"):
                before += "\n"
        key = ".".join(toml_key(part) for part in path[len(block.path) :] if isinstance(part, str))
        statement = Statement(path, before, key, " = ", toml_value(value), "\n")
        block.statements.insert(row, statement)
        self._statement_at[path] = statement
        self._note(path)

    def _new_block(self, path: KeyPath) -> Block:
        """A new table without keys."""
        keys = [part for part in path if isinstance(part, str)]
        name = ".".join(map(toml_key, keys))
        block = Block(path, f"[[{name}]]\n" if isinstance(path[-1], int) else f"[{name}]\n")
        place = self._place_before(path, keys[0])
        self._blocks.insert(place + 1, block)
        self._block_at[path] = block
        self._note(path)
        self._end_with_empty_lines(place, place + 1)
        return block

    def _place_before(self, path: KeyPath, table: str) -> int:
        """The row of the block after which a new block goes.

        This is the last block whose path begins as the new path does, for as many parts as possible. If no
        block begins so, it is the last block of a table that is written before this table.
        """
        starts = [path[:end] for end in range(len(path), 0, -1) if path[:end] in self._paths]
        earlier = self._tables[: self._tables.index(table)]
        for start in (*starts, *((each,) for each in reversed(earlier))):
            for row in range(len(self._blocks) - 1, 0, -1):
                if _is_below(self._blocks[row].path, start):
                    return row
        return 0

    def _end_with_empty_lines(self, first: int, last: int) -> None:
        """End some blocks with an empty line, unless the next block belongs to the same row."""
        rows = self._blocks[first : last + 1]
        for block, following in zip(rows, self._blocks[first + 1 : last + 2], strict=False):
            is_same_row = len(block.path) > 1 and block.path[:2] == following.path[:2]
            text = block.text
            if text and not is_same_row and not text.endswith("\n\n"):
                block.tail += "\n" if text.endswith("\n") else "\n\n"
            elif text and not text.endswith("\n"):
                block.tail += "\n"


def _is_below(path: KeyPath, above: KeyPath) -> bool:
    """Whether a path is equal to another path, or below it."""
    return path[: len(above)] == above


def _inline(text: str, path: KeyPath, value: Any) -> str:
    """The text of an inline table after a value inside it was set. A missing key is added."""
    items = inline_items(text)
    for item in items:
        if _is_below(path, item.path):
            inner, rest = text[item.start : item.stop], path[len(item.path) :]
            written = _inline(inner, rest, value) if rest else toml_value(value)
            return text[: item.start] + written + text[item.stop :]
    text = _inline_without(text, path)
    key = ".".join(toml_key(str(part)) for part in path)
    start = f"{text[:-1].rstrip()}," if inline_items(text) else "{"
    return f"{start} {key} = {toml_value(value)} }}"


def _inline_without(text: str, path: KeyPath) -> str:
    """The text of an inline table without the keys at a path inside it and below, if any."""
    items = inline_items(text)
    others = []
    for item in items:
        inner, rest = text[item.start : item.stop], path[len(item.path) :]
        if rest and _is_below(path, item.path):
            return text[: item.start] + _inline_without(inner, rest) + text[item.stop :]
        if not _is_below(item.path, path):
            others.append(f"{item.key} = {inner}")
    if len(others) == len(items):
        return text
    return f"{{ {', '.join(others)} }}" if others else "{}"
