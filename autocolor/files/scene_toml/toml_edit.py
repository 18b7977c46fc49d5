"""Editing the text of a TOML file until it gives other values; everything else stays as it is written.

The text is cut into blocks: a header, with the comments directly above it, and the keys below it. Blocks and
keys are removed, added and moved here. A key whose value changes is edited by tomlkit, which keeps the
comments, the order and the style, also within arrays. tomllib reads each edited key, and the whole text.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import InlineTable

from autocolor.files.scene_toml.toml_text import KeyPath, key_text, statements_of, toml_key, toml_value
from autocolor.logs import logger_of

LOG: Final = logger_of(__name__)

EMPTY_LINE: Final = re.compile(r"^[ \t\r]*\n", re.MULTILINE)

FILE_TABLES: Final = ("view", "views", "scalar", "mesh", "parts", "surfaces", "lights")
"""The tables of a scene file that get headers of their own, in the order in which they are written."""

ORDERED: Final = ("surfaces", "exposure")
"""The tables whose keys have an order."""

Document = Mapping[str, Any]
"""The values of a TOML text: tables are dictionaries, arrays are lists."""


class WrittenKey(NamedTuple):
    """A key with its value, and the comments and empty lines above it; the path is from the block's table."""

    path: KeyPath
    above: str
    written: str


@dataclass(eq=False)
class Block:
    """A header, with the comment above it, its keys, and the lines below them.

    The first block of a text has no header. A block that is `apart` has an empty line above and below.
    """

    path: KeyPath
    head: str
    keys: list[WrittenKey] = field(default_factory=list)
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
            blocks[-1].keys.append(WrittenKey(statement.path[len(blocks[-1].path) :], above, written))
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
    numbers: list[int | None] = [
        left[key].pop(0) if left.get(key := _identity(item)) else None for item in new
    ]
    if len(old) == len(new):
        others = iter(sorted(set(range(len(old))) - set(numbers)))
        numbers = [next(others) if number is None else number for number in numbers]
    return numbers


def _identity(item: Any) -> str:
    """What tells that an item is the same: its name, or its value."""
    return str(item["name"]) if isinstance(item, dict) and "name" in item else repr(item)


def edited_toml(data: bytes, wanted: Document) -> bytes | None:
    """The valid TOML text, edited until it gives the wanted values; None if no edit does.

    Rows of an array are the same rows if they have the same name. Raises InputError for a text in the values
    that UTF-8 lacks.
    """
    # Tuples become lists, as in what is read back.
    wanted = tomllib.loads(f"wanted = {toml_value(wanted)}")["wanted"]
    # Edit lines that end with line feeds; a file whose lines end otherwise gets them back.
    text = data.decode()
    ends = "\r\n" if text.count("\r\n") == text.count("\n") > 0 else "\n"
    text = text.replace(ends, "\n")
    old = tomllib.loads(text)
    # Tables whose keys do not get their order when keys are edited and added are written anew.
    moved: Collection[str] = ()
    for _ in range(2):
        edited = text if repr(old) == repr(wanted) else _edited_text(text, old, wanted, moved)
        try:
            values = tomllib.loads(edited)
        except tomllib.TOMLDecodeError:
            values = {}
        moved = [name for name in ORDERED if _keys(values.get(name)) != _keys(wanted.get(name))]
        if values == wanted and not moved:
            return edited.replace("\n", ends).encode()
    return None


def _keys(value: Any) -> list[Any]:
    """The keys of a table in their order, or the numbers of the rows of an array; none of another value."""
    return list(value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ())


def _edited_text(text: str, old: Document, wanted: Document, moved: Collection[str]) -> str:
    """The text with the wanted values, unless an edit fails; keys of moved tables are written anew."""
    blocks = blocks_of(text)
    before = _numbered(blocks, old, wanted)
    blocks = [block for block in blocks if isinstance(_at(wanted, block.path), dict)]
    # Tables without headers: keys of the file, or keys below one header for all rows.
    inline = {(*block.path, *key.path)[0] for block in blocks if len(block.path) < 2 for key in block.keys}
    for block in blocks:
        if repr(_at(before, block.path)) != repr(_at(wanted, block.path)):
            block.keys = [_with_value(key, block.path, wanted, moved) for key in block.keys]
    for name in FILE_TABLES:
        if name not in inline or name in moved:
            _add_blocks(blocks, name, wanted.get(name))
        _arrange(blocks, name, _keys(wanted.get(name)))
    given = {block.path for block in blocks}
    given |= {(*block.path, *key.path) for block in blocks for key in block.keys if key.written}
    above = {path[:end] for path in given for end in range(1, len(path) + 1)}
    for block in blocks:
        table = _at(wanted, block.path)
        added = [
            key_text(path[len(block.path) :], value) for path, value in _new(table, block.path, given, above)
        ]
        if added and not block.keys and not block.path:
            # New keys of a file go below the comment at its top.
            block.head, block.tail = block.tail, "\n"
        block.keys += [WrittenKey((), "", text) for text in added]
    return _joined(blocks)


def _numbered(blocks: Sequence[Block], old: Document, wanted: Document) -> Document:
    """The old values with rows that have headers in their new places; blocks get these numbers, or -1."""
    before = dict(old)
    for name in {str(block.path[0]) for block in blocks if len(block.path) > 1 and block.path[1] == 0}:
        rows = wanted.get(name)
        numbers = item_numbers(old[name], rows) if isinstance(rows, list) else []
        before[name] = [None if number is None else old[name][number] for number in numbers]
        places = {number: place for place, number in enumerate(numbers)}
        for block in blocks:
            if block.path[0:1] == (name,) and isinstance(block.path[1], int):
                block.path = (name, places.get(block.path[1], -1), *block.path[2:])
    return before


def _at(value: Any, path: KeyPath) -> Any:
    """The value at a path, None if there is none; -1 is the number of a removed row."""
    for key in path:
        try:
            value = None if key == -1 else value[key]
        except (LookupError, TypeError):
            return None
    return value


def _add_blocks(blocks: list[Block], name: str, table: Any) -> None:
    """Add the blocks of new tables below those of the same key, or at the end."""
    paths: list[KeyPath] = [(name, key) for key in _keys(table)]
    if isinstance(table, dict) and not all(isinstance(row, dict) for row in table.values()):
        paths = [(name,)]
    present = {block.path[:2] for block in blocks}
    place = max(
        (number for number, block in enumerate(blocks, 1) if block.path[:1] == (name,)), default=len(blocks)
    )
    header = "[[{}]]\n" if isinstance(table, list) else "[{}]\n"
    blocks[place:place] = [
        Block(
            path,
            header.format(".".join(toml_key(part) for part in path if isinstance(part, str))),
            apart=True,
        )
        for path in paths
        if path not in present
    ]


def _arrange(blocks: list[Block], name: str, keys: Sequence[Any]) -> None:
    """Move the rows of a table to the order of their keys."""
    rows = [block for block in blocks if len(block.path) > 1 and block.path[0] == name]
    order = {key: row for row, key in enumerate(keys)}
    arranged = sorted(rows, key=lambda block: order[block.path[1]])
    if arranged != rows:
        first = blocks.index(rows[0])
        others = [block for block in blocks if block not in rows]
        for block in rows:
            block.apart = True
        blocks[:] = [*others[:first], *arranged, *others[first:]]


def _new(
    table: Document, path: KeyPath, given: Collection[KeyPath], above: Collection[KeyPath]
) -> Iterator[tuple[KeyPath, Any]]:
    """The paths and values of a table at a path that the text does not have.

    `given` are the paths of headers and keys, `above` are these paths and those of the tables around them.
    """
    for key, value in table.items():
        inner = (*path, key)
        if inner not in above:
            yield inner, value
        elif inner not in given and isinstance(value, dict):
            yield from _new(value, inner, given, above)


def _joined(blocks: Sequence[Block]) -> str:
    """The text of the blocks."""
    text = ""
    before = Block((), "")
    for block in blocks:
        is_apart = (block.apart or before.apart) and block.path[:2] != before.path[:2]
        if text and is_apart:
            text = f"{text.rstrip(chr(10))}\n\n"
        for part in (block.head, *(key.above + key.written for key in block.keys), block.tail):
            text += "\n" if text and part and not text.endswith("\n") else ""
            text += part
        before = block
    return text


# One key.


def _with_value(key: WrittenKey, table: KeyPath, wanted: Document, moved: Collection[str]) -> WrittenKey:
    """The key of a table with its wanted value; without text if it has none, or is to be written anew."""
    path = (*table, *key.path)
    new = _at(wanted, path)
    if new is None:
        return key._replace(written="")
    for name in reversed(key.path):
        new = {name: new}
    old = tomllib.loads(key.written)
    if path[0] not in moved or len(table) > 1:
        if repr(old) == repr(new):
            return key
        with suppress(TOMLKitError, LookupError, ValueError, TypeError, AttributeError):
            document = tomlkit.parse(key.written)
            _set_keys(document, old, new)
            edited = tomlkit.dumps(document)
            if tomllib.loads(edited) == new:
                return key._replace(written=edited)
    if "#" in key.written:
        LOG.warning("%s is written anew, without its comments", ".".join(map(str, path)))
    return key._replace(written="")


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
    elif isinstance(old, list) and isinstance(new, list) and old and new:
        _set_items(container[key], old, new)
    elif old != new or isinstance(old, bool) != isinstance(new, bool):
        container[key] = tomlkit.value(toml_value(new))


def _set_items(array: Any, old: list[Any], new: list[Any]) -> None:
    """Change the items of an array of tomlkit from old to new values."""
    stay: dict[int, int] = {}
    last = -1
    for place, number in enumerate(item_numbers(old, new)):
        # An item that moves before another one is written anew.
        if number is not None and number > last:
            stay[place] = last = number
    for number in sorted({*range(len(old))} - {*stay.values()}, reverse=True):
        del array[number]
    for place, item in enumerate(new):
        if place in stay:
            _set(array, place, old[stay[place]], item)
        else:
            array.insert(place, tomlkit.value(toml_value(item)))
