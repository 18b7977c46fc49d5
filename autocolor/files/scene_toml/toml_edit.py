"""Editing the text of a TOML file until it gives other values; everything else stays as it is written.

The text is split into blocks of statements: a block is a header, with the comments directly above it, and the
keys below it. Statements and blocks are removed, added and moved here. A changed value is edited by tomlkit,
which keeps the comments, the order and the style within arrays and inline tables.

Measured and rejected: tomlkit for whole files. It leaves the comment above a header with the table before,
gathers arrays of tables that stand apart, writes wrong headers for tables inside of their rows, and takes
21 s for a file of a megabyte.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import InlineTable

from autocolor.files.scene_toml.toml_text import (
    TOKEN,
    KeyPath,
    Statement,
    statements_of,
    toml_key,
    toml_value,
)
from autocolor.logs import logger_of

LOG: Final = logger_of(__name__)

EMPTY_LINE: Final = re.compile(r"^[ \t\r]*\n", re.MULTILINE)

MISSING: Final = object()

Document = Mapping[str, Any]
"""The values of a TOML text: tables are dictionaries, arrays are lists."""


@dataclass(eq=False)
class Block:
    """A header, with the comment above it, its statements, and the lines below them.

    The first block of a text has no header. A block that is `apart` has an empty line above and below.
    """

    path: KeyPath
    head: str
    statements: list[Statement] = field(default_factory=list)
    tail: str = ""
    apart: bool = False

    @property
    def text(self) -> str:
        """The block as it is written."""
        return "".join([self.head, *(each.text for each in self.statements), self.tail])


def blocks_of(text: str) -> list[Block]:
    """The blocks of a valid TOML text, whose lines end with line feeds; joined they are the same text.

    Comments directly above a header, with no empty line between, belong to it. A comment at the top of a
    file, if it is the only comment above the first header, belongs to the file.
    """
    blocks = [Block((), "")]
    for statement in statements_of(text):
        above = statement.before
        if not statement.key:
            blocks[-1].tail = above
        elif statement.value:
            blocks[-1].statements.append(statement)
        else:
            start = max((line.end() for line in EMPTY_LINE.finditer(above)), default=0)
            if len(blocks) == 1 and not blocks[0].statements and not start:
                start = len(above)
            blocks[-1].tail = above[:start]
            blocks.append(Block(statement.path, above[start:] + statement.key + statement.after))
    return blocks


def row_numbers(old: Sequence[Document], new: Sequence[Document]) -> list[int | None]:
    """For each new row of an array the number of the old row of the same name; None for an added row.

    In an array of the same length, a row with a new name in the place of a removed name was renamed. Rows
    without names are the same rows in the same place.
    """
    olds = {row.get("name", number): number for number, row in enumerate(old)}
    names = [row.get("name", number) for number, row in enumerate(new)]
    if len(old) == len(new):
        renamed = [(name, was) for name, was in zip(names, tuple(olds), strict=False) if name not in olds]
        olds |= {name: olds[was] for name, was in renamed if was not in names}
    return [olds.get(name) for name in names]


def edited_toml(
    text: str, wanted: Document, tables: Sequence[str] = (), ordered: Sequence[str] = ()
) -> str | None:
    """The valid TOML text, edited until it gives the wanted values; None if no edit does.

    `tables` are the keys of tables that get headers of their own, in the order of new ones; `ordered` are the
    keys of tables whose keys have an order. Rows of an array are the same rows if they have the same name.
    """
    # Tuples become lists, as in what is read back.
    wanted = tomllib.loads(f"wanted = {toml_value(wanted)}")["wanted"]
    # Edit lines that end with line feeds; a file whose lines end otherwise gets them back.
    ends = "\r\n" if text.count("\r\n") == text.count("\n") > 0 else "\n"
    text = text.replace(ends, "\n")
    blocks = blocks_of(text)
    last = blocks[-1]
    blocks = _changed(blocks, tomllib.loads(text), wanted, tables)
    if blocks[-1] is not last:
        blocks[-1].tail = f"{blocks[-1].tail.rstrip()}\n" if blocks[-1].tail.strip() else ""
    for name in ordered:
        _remove_unordered(blocks, name, wanted)
    for name in tables:
        _add_blocks(blocks, name, wanted, tables)
        _arrange(blocks, name, wanted)
    _add_keys(blocks, wanted)
    edited = _joined(blocks)
    try:
        is_right = tomllib.loads(edited) == wanted
    except tomllib.TOMLDecodeError:
        is_right = False
    return edited.replace("\n", ends) if is_right else None


def _changed(blocks: Iterable[Block], old: Document, wanted: Document, tables: Sequence[str]) -> list[Block]:
    """The blocks and statements of wanted values, with these values and with the new numbers of rows."""
    numbers: dict[str | int, dict[int | None, int]] = {}
    for key, rows in old.items():
        new_rows: Any = wanted.get(key)
        numbers[key] = {}
        if _are_rows(rows) and _are_rows(new_rows):
            numbers[key] = {number: row for row, number in enumerate(row_numbers(rows, new_rows))}

    def renumbered(path: KeyPath) -> KeyPath:
        if len(path) < 2 or not isinstance(path[1], int):
            return path
        return (path[0], numbers[path[0]].get(path[1], -1), *path[2:])

    roots = {(name,) for name in tables}
    remaining = []
    for block in blocks:
        block.path = renumbered(block.path)
        if not isinstance(_at(wanted, block.path), dict):
            continue
        remaining.append(block)
        removed = set()
        for statement in block.statements:
            value = _at(old, statement.path)
            statement.path = renumbered(statement.path)
            new = _at(wanted, statement.path)
            # An empty table or array makes room for headers.
            if new is MISSING or (new and value in ([], {}) and statement.path in roots):
                removed.add(statement)
            elif repr(new) != repr(value):
                statement.value = _value_text(statement, value, new)
        _remove(block, removed)
    return remaining


def _at(value: Any, path: KeyPath) -> Any:
    """The value at a path, or MISSING; -1 is the number of a removed row."""
    for key in path:
        try:
            value = MISSING if key == -1 else value[key]
        except (LookupError, TypeError):
            return MISSING
    return value


def _are_rows(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(row, dict) for row in value)


def _remove(block: Block, removed: Collection[Statement]) -> None:
    """Remove statements of a block, but not the comments above them."""
    statements, above = [], ""
    for statement in block.statements:
        if statement in removed:
            above += statement.before
        else:
            statement.before, above = above + statement.before, ""
            statements.append(statement)
    block.statements, block.tail = statements, above + block.tail


def _remove_unordered(blocks: list[Block], name: str, wanted: Document) -> None:
    """Remove the keys of a table that have no headers, if the wanted keys do not begin with them in order."""
    paths = [path for block in blocks for path in (block.path, *(each.path for each in block.statements))]
    keys = list(dict.fromkeys(path[1] for path in paths if len(path) > 1 and path[0] == name))
    if keys != list(wanted.get(name, ()))[: len(keys)]:
        for block in blocks:
            if len(block.path) < 2:
                _remove(block, [each for each in block.statements if each.path[0] == name])


def _add_blocks(blocks: list[Block], name: str, wanted: Document, tables: Sequence[str]) -> None:
    """Add the blocks of new tables, unless the table is written without headers."""
    table = wanted.get(name)
    written = {each.path[0]: block for block in blocks for each in block.statements if len(block.path) < 2}
    if not table or name in written:
        return
    paths: list[KeyPath] = [(name,)]
    if isinstance(table, list):
        paths = [(name, row) for row in range(len(table))]
    elif all(isinstance(row, dict) for row in table.values()):
        paths = [(name, key) for key in table]
    present = {block.path[:2] for block in blocks}
    # After the last block of the same table, or of one that is written before it.
    last = {block.path[0]: place for place, block in enumerate(blocks) if block.path}
    before = [name, *reversed(tables[: tables.index(name)])]
    place = next((last[each] for each in before if each in last), 0)
    for path in paths:
        if path not in present:
            place += 1
            header = ".".join(toml_key(part) for part in path if isinstance(part, str))
            head = f"[[{header}]]\n" if isinstance(table, list) else f"[{header}]\n"
            blocks.insert(place, Block(path, head, apart=True))


def _arrange(blocks: list[Block], name: str, wanted: Document) -> None:
    """Move the rows of a table to the wanted order."""
    rows = [block for block in blocks if len(block.path) > 1 and block.path[0] == name]
    table = wanted.get(name, ())
    place_of = {
        key: place for place, key in enumerate(table if isinstance(table, dict) else range(len(table)))
    }
    firsts = [place_of[key] for key in dict.fromkeys(block.path[1] for block in rows)]
    if firsts != sorted(firsts):
        first, in_table = blocks.index(rows[0]), set(rows)
        others = [block for block in blocks if block not in in_table]
        rows.sort(key=lambda block: place_of[block.path[1]])
        for block in rows:
            block.apart = True
        blocks[:] = [*others[:first], *rows, *others[first:]]


def _add_keys(blocks: Iterable[Block], wanted: Document) -> None:
    """Add the wanted keys that no statement says."""
    block_at = {block.path: block for block in blocks}
    statements = {each.path for block in block_at.values() for each in block.statements}
    above = {path[:end] for path in (*block_at, *statements) for end in range(1, len(path))}

    def add(block: Block, path: KeyPath, value: Any) -> None:
        """Add the keys of a value; the block has the nearest header above it."""
        block = block_at.get(path, block)
        if path in block_at or path in above:
            rows = value.items() if isinstance(value, dict) else enumerate(value)
            for key, inner in rows:
                add(block, (*path, key), inner)
        elif path not in statements:
            if isinstance(value, dict) and value and all(isinstance(inner, dict) for inner in value.values()):
                # A table of tables, such as flaps, has a line for each inner table.
                for name, inner in value.items():
                    _add_key(block, (*path, name), inner)
            else:
                _add_key(block, path, value)

    add(block_at[()], (), wanted)


def _add_key(block: Block, path: KeyPath, value: Any) -> None:
    """Add a key below the other keys of its table, or below the header, or below the comment at the top."""
    row = len(block.statements)
    if len(path) > len(block.path) + 1:
        beside = [at for at, each in enumerate(block.statements) if each.path[: len(path) - 1] == path[:-1]]
        row = beside[-1] + 1 if beside else row
    before = ""
    if row:
        block.statements[row - 1].after = block.statements[row - 1].after.rstrip("\n") + "\n"
    elif block.head:
        block.head = block.head.rstrip("\n") + "\n"
    elif not block.statements:
        before, block.tail = block.tail, "\n"
        before += "\n" if before and not before.endswith("\n") else ""
    key = ".".join(toml_key(part) for part in path[len(block.path) :] if isinstance(part, str))
    block.statements.insert(row, Statement(path, before, f"{key} = ", toml_value(value), "\n"))


def _joined(blocks: Iterable[Block]) -> str:
    """The text of the blocks."""
    texts: list[str] = []
    before = Block((), "")
    for block in blocks:
        if texts and texts[-1]:
            is_apart = (block.apart or before.apart) and block.path[:2] != before.path[:2]
            line_end = "\n\n" if is_apart else "\n"
            while not texts[-1].endswith(line_end):
                texts[-1] += "\n"
        texts.append(block.text)
        before = block
    return "".join(texts)


# The text of a value.


def _value_text(statement: Statement, old: Any, new: Any) -> str:
    """The text of a value that was changed; its comments are lost if tomlkit cannot edit it."""
    if type(old) is not type(new) or not isinstance(new, (dict, list)) or not old or not new:
        return toml_value(new)
    try:
        document = tomlkit.parse(f"value = {statement.value}")
        _set(document, "value", old, new)
        text = tomlkit.dumps(document).removeprefix("value = ")
        given = tomllib.loads(f"value = {text}")["value"]
        if given == new and _keys(given) == _keys(new):
            return text
    except (TOMLKitError, LookupError, ValueError, TypeError, AttributeError):
        pass
    if any(token.lastgroup == "comment" for token in TOKEN.finditer(statement.value)):
        LOG.warning("%s: written anew, without its comments", statement.key.rstrip(" \t="))
    return toml_value(new)


def _keys(value: Any) -> Any:
    """The keys of the tables in a value, in their order."""
    if isinstance(value, dict):
        return [(key, _keys(inner)) for key, inner in value.items()]
    return [_keys(inner) for inner in value] if isinstance(value, list) else None


def _set(container: Any, key: str | int, old: Any, new: Any) -> None:
    """Set a value of a table or an array of tomlkit, from an old to a new value."""
    if repr(old) == repr(new):
        return
    if isinstance(old, dict) and isinstance(new, dict) and new:
        table = container[key]
        for name, value in old.items():
            if name in new:
                _set(table, name, value, new[name])
            else:
                del table[name]
        added = [name for name in new if name not in old]
        for name in added:
            table[name] = tomlkit.value(toml_value(new[name]))
        if added and isinstance(table, InlineTable):
            table.add(tomlkit.ws(" "))
    elif isinstance(old, list) and isinstance(new, list) and old and new:
        container[key] = tomlkit.value(_array_text(container[key], old, new))
    elif old != new:
        container[key] = tomlkit.value(toml_value(new))


def _array_text(array: Any, old: list[Any], new: list[Any]) -> str:
    """The text of an array of tomlkit with the new values."""
    numbers = _item_numbers(old, new)
    present = set(numbers)
    left: list[int | None] = [number for number in range(len(old)) if number in present]
    for place in reversed(range(len(old))):
        if place not in present:
            del array[place]
    added: list[Any] = []
    for place, number in enumerate(numbers):
        if number is None and place >= len(left):
            added.append(new[place])
        elif number is None:
            array.insert(place, tomlkit.value(toml_value(new[place])))
            left.insert(place, None)
        else:
            if left[place] != number:
                at = left.index(number)
                array.insert(place, array.pop(at))
                left.insert(place, left.pop(at))
            _set(array, place, old[number], new[place])
    text: str = array.as_string()
    for value in added:
        text = _appended(text, toml_value(value))
    return text


def _item_numbers(old: list[Any], new: list[Any]) -> list[int | None]:
    """For each new item of an array the number of the item that it was; None for an added item."""
    if _are_rows(old) and _are_rows(new):
        return row_numbers(old, new)
    least = min(len(old), len(new))
    if len(old) == len(new):
        return list(range(least))
    # Items were added or removed between the first and the last equal items.
    first = next((place for place in range(least) if old[place] != new[place]), least)
    rest = least - first
    last = next((place for place in range(rest) if old[-1 - place] != new[-1 - place]), rest)
    between: list[int | None] = [None] * (len(new) - first - last)
    return [*range(first), *between, *range(len(old) - last, len(old))]


def _appended(text: str, value: str) -> str:
    """The text of an array with a value after its last one, on a line of its own if the bracket has one.

    tomlkit writes the comma into a comment below the last value.
    """
    tokens = [
        token for token in TOKEN.finditer(text[:-1]) if token.lastgroup not in ("comment", "space", "newline")
    ]
    last = tokens[-1]
    has_comma = last.lastgroup == "comma"
    start, rest = text[: last.end()], text[last.end() : -1]
    start += "" if has_comma or len(tokens) == 1 else ","
    if "\n" not in rest:
        return f"{start} {value}{rest}]"
    line = start.rpartition("\n")[2]
    indent = line[: len(line) - len(line.lstrip())]
    above, _, end = rest.rpartition("\n")
    return f"{start}{above}\n{indent}{value}{',' * has_comma}\n{end}]"
