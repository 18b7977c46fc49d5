from __future__ import annotations

import itertools
import re
import tomllib
from collections.abc import Iterator
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.scene_toml.toml_edit import ORDERED, edited_toml
from autocolor.files.scene_toml.toml_text import toml_key, toml_value

COMMENT = re.compile(r"# [0-9]+")

names = st.sampled_from(["a", "b", "a b", "#=]", "c"])
leaves = st.integers(0, 99) | st.sampled_from(["x # y", "}", True]) | st.lists(st.integers(0, 9), max_size=3)
tables = st.dictionaries(names, leaves, max_size=3)
rows_by_name = st.dictionaries(names, tables, min_size=1, max_size=3)


@st.composite
def rows(draw: st.DrawFn) -> list[dict[str, Any]]:
    """Rows of an array, each with a name of its own."""
    found = draw(st.lists(names, max_size=3, unique=True))
    return [
        {"name": name, **draw(tables), **draw(st.fixed_dictionaries({}, optional={"flaps": rows_by_name}))}
        for name in found
    ]


documents = st.fixed_dictionaries(
    {},
    optional={
        "ambient": leaves,
        "exposure": tables,
        "view": tables.filter(bool),
        "parts": rows_by_name,
        "surfaces": rows_by_name,
        "lights": rows(),
    },
)


@st.composite
def texts(draw: st.DrawFn, document: dict[str, Any]) -> str:
    """The document in a mixture of layouts, with a comment of its own wherever comments may be."""
    number = itertools.count(1)

    def comment() -> str:
        return draw(st.sampled_from(["", f"  # {next(number)}"]))

    def inline(value: Any) -> str:
        if isinstance(value, list) and value and draw(st.booleans()):
            # On several lines, with comments between.
            items = [f"{inline(item)},{comment()}\n" for item in value[:-1]]
            last = f"{inline(value[-1])}{draw(st.sampled_from(['', ',']))}{comment()}\n"
            above = [f"  # {next(number)}\n" if draw(st.booleans()) else "" for _ in value]
            lines = "".join(f"{line}  {item}" for line, item in zip(above, [*items, last], strict=True))
            return f"[{comment()}\n{lines}]"
        if isinstance(value, list):
            return f"[{', '.join(map(inline, value))}]"
        if not isinstance(value, dict) or not value:
            return toml_value(value)
        space = draw(st.sampled_from(["", " "]))
        items = [f"{toml_key(key)}{space}={inline(inner)}" for key, inner in value.items()]
        return f"{{{space}{', '.join(items)}{space}}}"

    def lines(path: tuple[str, ...], dotted: tuple[str, ...], table: dict[str, Any]) -> list[str]:
        found = []
        for key, value in table.items():
            styles = ["inline"]
            if isinstance(value, dict) and value:
                styles += ["dotted", *([] if dotted else ["header"])]
            if key == "lights" and value:
                styles.append("header")
            style = draw(st.sampled_from(styles))
            if style == "header" and key == "lights":
                for row in value:
                    below((key,), row, "[[lights]]")
            elif style == "header":
                below((*path, key), value, f"[{'.'.join(map(toml_key, (*path, key)))}]")
            elif style == "dotted":
                found += lines((*path, key), (*dotted, key), value)
            else:
                name = ".".join(map(toml_key, (*dotted, key)))
                above = draw(st.sampled_from(["", f"# {next(number)}\n", "\n"]))
                found.append(f"{above}{name}{draw(st.sampled_from(['=', ' = ']))}{inline(value)}{comment()}")
        return found

    def below(path: tuple[str, ...], table: dict[str, Any], header: str) -> None:
        place = len(headers)
        headers[place:place] = [(header, lines(path, (), table))]

    headers: list[tuple[str, list[str]]] = []
    first = lines((), (), document)
    blocks = [
        "\n".join([draw(st.sampled_from(["", "\n", f"# {next(number)}\n"])) + header + comment(), *found])
        for header, found in headers
    ]
    return "\n".join([*first, *blocks]) + draw(st.sampled_from(["", "\n"]))


def edited(text: str, wanted: dict[str, Any]) -> str:
    """The text, edited to the wanted values, which it gives, also in the order of the ordered tables."""
    after = edited_toml(text.encode(), wanted)
    assert after is not None
    values = tomllib.loads(after.decode())
    assert values == wanted
    assert all(list(values.get(key, ())) == list(wanted.get(key, ())) for key in ORDERED)
    return after.decode()


def in_order_of(before: Any, after: Any) -> Any:
    """Values whose keys are in the order of older values, as those of a changed scene."""
    if isinstance(before, dict) and isinstance(after, dict):
        keys = [*(key for key in before if key in after), *(key for key in after if key not in before)]
        return {key: in_order_of(before.get(key), after[key]) for key in keys}
    return after


@given(st.data())
def test_any_text_is_edited_to_any_values(data: st.DataObject) -> None:
    before = data.draw(documents)
    text = data.draw(texts(before))
    assert tomllib.loads(text) == before
    # Keys of ordered tables are in the order of the text.
    before = tomllib.loads(text)
    assert edited(text, before) == text
    after = data.draw(documents)
    edited(text, after)
    # Comments stay where keys and items are only added.
    more = in_order_of(before, {**after, **before})
    assert [word for word in COMMENT.findall(text) if word not in edited(text, more)] == []


def numbered(value: Any, start: int, numbers: Iterator[int]) -> Any:
    """The values with other numbers instead of all leaves, which can be found in a text."""
    if isinstance(value, dict):
        return {
            key: inner if key == "name" else numbered(inner, start, numbers) for key, inner in value.items()
        }
    if isinstance(value, list):
        return [numbered(inner, start, numbers) for inner in value]
    return start + next(numbers)


@given(st.data())
def test_nothing_but_changed_values_is_changed(data: st.DataObject) -> None:
    document = data.draw(documents)
    before = numbered(document, 1000, itertools.count())
    text = data.draw(texts(before))
    after = in_order_of(tomllib.loads(text), numbered(document, 2000, itertools.count()))
    assert edited(text, after) == re.sub(r"\b1(\d\d\d)\b", r"2\1", text)


def test_lines_end_as_before() -> None:
    text = "# Mine.\r\nambient = 1 # dim\r\n[view]\r\neye = [\r\n  1, # x\r\n]\r\n"
    wanted = {"ambient": 2, "front": "x", "view": {"eye": [1, 2]}}
    assert edited(text, wanted) == text.replace("= 1 # dim", '= 2 # dim\r\nfront = "x"').replace(
        "# x\r\n", "# x\r\n  2,\r\n"
    )
