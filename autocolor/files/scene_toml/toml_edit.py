"""Editing the text of a TOML file until it gives other values; everything else stays as it is written.

The text is cut into blocks: a header, with the comments directly above it, and the keys below it. Blocks are
removed, added and moved here. The keys of a block whose values change are edited by tomlkit, which keeps the
comments, the order and the style, also within arrays. tomllib reads each edited block, and the whole text.

Measured and rejected: tomlkit for whole files. It leaves the comment above a header with the table before,
gathers arrays of tables that stand apart, writes wrong headers for tables inside of their rows, and takes
21 s for a file of a megabyte.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import InlineTable

from autocolor.files.scene_toml.toml_text import (
    TOKEN,
    KeyPath,
    statements_of,
    table_text,
    toml_key,
    toml_value,
)
from autocolor.logs import logger_of

LOG: Final = logger_of(__name__)

EMPTY_LINE: Final = re.compile(r"^[ \t\r]*\n", re.MULTILINE)

Document = Mapping[str, Any]
"""The values of a TOML text: tables are dictionaries, arrays are lists."""


@dataclass(eq=False)
class Block:
    """A header, with the comment above it, its keys, and the lines below them.

    The first block of a text has no header. A block that is `apart` has an empty line above and below.
    """

    path: KeyPath
    head: str
    keys: str = ""
    tail: str = ""
    apart: bool = False


def blocks_of(text: str) -> list[Block]:
    """The blocks of a valid TOML text, whose lines end with line feeds; joined they are the same text.

    Comments directly above a header, with no empty line between, belong to it. A comment at the top of a
    file, if it is the only comment above the first header, belongs to the file.
    """
    blocks = [Block((), "")]
    end = 0
    for statement in statements_of(text):
        above, written = text[end : statement.start], text[statement.start : statement.end]
        end = statement.end
        if statement.is_header:
            start = max((line.end() for line in EMPTY_LINE.finditer(above)), default=0)
            if len(blocks) == 1 and not blocks[0].keys and not start:
                start = len(above)
            blocks[-1].tail = above[:start]
            blocks.append(Block(statement.path, above[start:] + written))
        else:
            blocks[-1].keys += above + written
    blocks[-1].tail = text[end:]
    return blocks


def item_numbers(old: Sequence[Any], new: Sequence[Any]) -> list[int | None]:
    """For each new item of an array the number of the item that it was; None for an added item.

    Tables are the same if they have the same name, other items if they are equal. Of as many items as before,
    those that are left were changed, or renamed.
    """
    if len(old) == len(new) and not any(isinstance(item, dict) for item in old):
        return list(range(len(old)))
    left: dict[object, list[int]] = {}
    for number, item in enumerate(old):
        left.setdefault(_identity(item), []).append(number)
    numbers = [left[key].pop(0) if left.get(key := _identity(item)) else None for item in new]
    others = iter(
        sorted(number for numbers in left.values() for number in numbers) if len(old) == len(new) else ()
    )
    return [next(others, None) if number is None else number for number in numbers]


def _identity(item: Any) -> str:
    """What tells that an item is the same: its name, or its value."""
    return str(item["name"]) if isinstance(item, dict) and "name" in item else repr(item)


def edited_toml(
    text: str, wanted: Document, tables: Sequence[str] = (), ordered: Collection[str] = ()
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
    old = tomllib.loads(text)
    if repr(old) == repr(wanted):
        return text.replace("\n", ends)
    # Keys without headers that have another order are removed, and added again; if need be all of them.
    moved = {name for name in ordered if not _begins(wanted.get(name), old.get(name))}
    for again in (moved, ordered):
        edited = _edited_text(text, old, wanted, tables, again)
        try:
            values = tomllib.loads(edited)
        except tomllib.TOMLDecodeError:
            continue
        if values == wanted and all(_begins(wanted.get(name), values.get(name)) for name in ordered):
            return edited.replace("\n", ends)
    return None


def _edited_text(
    text: str, old: Document, wanted: Document, tables: Sequence[str], moved: Collection[str]
) -> str:
    """The text with the wanted values, unless an edit fails; keys of moved tables are added anew."""
    blocks = blocks_of(text)
    last = blocks[-1]
    blocks = _wanted_blocks(blocks, old, wanted)
    if blocks[-1] is not last:
        blocks[-1].tail = f"{blocks[-1].tail.rstrip()}\n" if blocks[-1].tail.strip() else ""
    # Tables without headers: keys of the file, or keys below one header for all rows.
    inline = {name for name, value in tomllib.loads(blocks[0].keys).items() if value}
    inline |= {str(block.path[0]) for block in blocks if len(block.path) == 1 and block.keys}
    for name in tables:
        if name not in inline or name in moved:
            _add_blocks(blocks, name, wanted.get(name), tables[: tables.index(name)])
        _arrange(blocks, name, wanted)
    above = {block.path[:end] for block in blocks for end in range(1, len(block.path) + 1)}
    headers = {block.path for block in blocks}
    for block in blocks:
        _edit_keys(block, _own_values(_at(wanted, block.path), block.path, headers, above), moved)
    return _joined(blocks)


def _wanted_blocks(blocks: Sequence[Block], old: Document, wanted: Document) -> list[Block]:
    """The blocks of tables that stay, with the new numbers of rows."""
    numbers: dict[str | int, dict[Any, int]] = {}
    for key, rows in old.items():
        if isinstance(rows, list) and isinstance(new := wanted.get(key), list):
            numbers[key] = {number: row for row, number in enumerate(item_numbers(rows, new))}
    for block in blocks:
        if len(block.path) > 1 and isinstance(block.path[1], int):
            name, number, *rest = block.path
            block.path = (name, numbers.get(name, {}).get(number, -1), *rest)
    return [block for block in blocks if isinstance(_at(wanted, block.path), dict)]


def _at(value: Any, path: KeyPath) -> Any:
    """The value at a path, None if there is none; -1 is the number of a removed row."""
    for key in path:
        try:
            value = None if key == -1 else value[key]
        except (LookupError, TypeError):
            return None
    return value


def _add_blocks(blocks: list[Block], name: str, table: Any, before: Sequence[str]) -> None:
    """Add the blocks of new tables below those of the same key, or of the nearest key before it."""
    paths: list[KeyPath] = [(name,)] if table else []
    if isinstance(table, list):
        paths = [(name, row) for row in range(len(table))]
    elif table and all(isinstance(row, dict) for row in table.values()):
        paths = [(name, key) for key in table]
    present = {block.path[:2] for block in blocks}
    last = {block.path[0]: place for place, block in enumerate(blocks) if block.path}
    place = next((last[each] for each in (name, *reversed(before)) if each in last), 0)
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
    keys: Iterable[str | int] = table if isinstance(table, dict) else range(len(table))
    order = {key: row for row, key in enumerate(keys)}
    arranged = sorted(rows, key=lambda block: order[block.path[1]])
    if arranged != rows:
        first = blocks.index(rows[0])
        others = [block for block in blocks if block not in rows]
        for block in rows:
            block.apart = True
        blocks[:] = [*others[:first], *arranged, *others[first:]]


def _own_values(
    table: Document, path: KeyPath, headers: Collection[KeyPath], above: Collection[KeyPath]
) -> dict[str, Any]:
    """The values of a table at a path that no other block has; `above` are the paths of blocks and above."""
    values = {}
    for key, value in table.items():
        inner = (*path, key)
        if inner not in above:
            values[key] = value
        elif inner not in headers and isinstance(value, dict):
            values[key] = _own_values(value, inner, headers, above)
    return {key: value for key, value in values.items() if value != {} or (*path, key) not in above}


def _edit_keys(block: Block, wanted: Document, moved: Collection[str]) -> None:
    """Edit the keys of a block until they give the wanted values; keys of moved tables are added anew."""
    old = tomllib.loads(block.keys)
    if repr(old) == repr(wanted):
        return
    if block.path:
        moved = old.keys() if len(block.path) == 1 and block.path[0] in moved else ()
    kept = {key: value for key, value in wanted.items() if key in old and key not in moved}
    keys = _edited(block.keys, old, kept)
    if keys is None:
        name = block.head.strip().rpartition("\n")[2] or "keys at the top"
        LOG.warning("%s: some values are written anew, without their comments", name)
        keys, kept = _edited_singly(block.keys, old, kept)
    added = {key: value for key, value in wanted.items() if key not in kept}
    if added:
        if not keys and not block.path:
            # New keys of a file go below the comment at its top.
            keys, block.tail = block.tail, "\n"
        block.head = f"{block.head.rstrip()}\n" if block.head else ""
        keys = f"{keys}{'' if not keys or keys.endswith(chr(10)) else chr(10)}{table_text('', added)}"
    block.keys = keys


def _begins(wanted: Any, old: Any) -> bool:
    """Whether the wanted keys begin with those old keys that stay, in their order."""
    if not isinstance(wanted, dict) or not isinstance(old, dict):
        return True
    left = [key for key in old if key in wanted]
    return left == list(wanted)[: len(left)]


def _joined(blocks: Sequence[Block]) -> str:
    """The text of the blocks."""
    text = ""
    before = Block((), "")
    for block in blocks:
        if text:
            is_apart = (block.apart or before.apart) and block.path[:2] != before.path[:2]
            line_end = "\n\n" if is_apart else "\n"
            while not text.endswith(line_end):
                text += "\n"
        text += block.head + block.keys + block.tail
        before = block
    return text


# The keys of one block.


def _edited(text: str, old: Document, new: Document) -> str | None:
    """The text edited by tomlkit; None if tomlkit cannot edit it."""
    try:
        document = tomlkit.parse(text)
        _set_keys(document, old, new)
        edited = tomlkit.dumps(document)
        return edited if tomllib.loads(edited) == new else None
    except (TOMLKitError, LookupError, ValueError, TypeError, AttributeError):
        return None


def _edited_singly(text: str, old: Document, new: Document) -> tuple[str, dict[str, Any]]:
    """The text edited key by key, and the new values that it gives: of those keys that tomlkit can edit."""
    now = dict(old)
    for key in old:
        without = {name: value for name, value in now.items() if name != key}
        for values in [{**now, key: new[key]}, without] if key in new else [without]:
            if repr(now) == repr(values):
                break
            if (edited := _edited(text, now, values)) is not None:
                text, now = edited, values
                break
        else:
            return "", {}
    return text, now


def _set_keys(table: Any, old: Document, new: Document) -> None:
    """Change the keys of a table of tomlkit from old to new values."""
    # Keys are removed last: tomlkit does not find all dotted keys below a removed key.
    for key, value in old.items():
        if key in new:
            _set(table, key, value, new[key])
    for key in old:
        if key not in new:
            del table[key]
    added = [key for key in new if key not in old]
    for key in added:
        table[key] = tomlkit.value(toml_value(new[key]))
    if added and isinstance(table, InlineTable):
        table.add(tomlkit.ws(" "))


def _set(container: Any, key: str | int, old: Any, new: Any) -> None:
    """Set a value of a table or an array of tomlkit."""
    if isinstance(old, dict) and isinstance(new, dict) and old.keys() & new.keys():
        _set_keys(container[key], old, new)
    elif old != new or isinstance(old, bool) != isinstance(new, bool):
        is_array = isinstance(old, list) and isinstance(new, list) and old and new
        text = _array_text(container[key], old, new) if is_array else toml_value(new)
        container[key] = tomlkit.value(text)


def _array_text(array: Any, old: list[Any], new: list[Any]) -> str:
    """The text of an array of tomlkit with the new values."""
    numbers = item_numbers(old, new)
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
