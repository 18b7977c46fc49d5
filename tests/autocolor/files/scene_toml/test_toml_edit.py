from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor.files.scene_toml.toml_edit import TomlText, blocks_of, inline_items
from autocolor.files.scene_toml.toml_text import KeyPath, toml_key, toml_value

TABLES = ("view", "mesh", "parts", "surfaces", "lights")


keys = st.sampled_from(["a", "b", "a b", "#=]"])
leaves = st.integers(0, 99) | st.sampled_from(["x # y", "}", [1, 2]])
inner = st.dictionaries(keys, leaves, max_size=3)
rows = st.dictionaries(keys, leaves | inner, max_size=3)
documents = st.fixed_dictionaries(
    {},
    optional={
        "a": leaves,
        "other": inner,
        "view": rows,
        "parts": rows,
        "lights": st.lists(rows, min_size=1, max_size=3),
    },
)


@st.composite
def texts(draw: st.DrawFn, document: dict[str, Any]) -> str:
    """The document in a mixture of inline tables, dotted keys and headers, with comments and empty lines."""
    headers: list[str] = []

    def lines(path: tuple[str, ...], dotted: tuple[str, ...], table: dict[str, Any]) -> list[str]:
        found = []
        for key, value in table.items():
            here, name = (*path, key), ".".join(map(toml_key, (*dotted, key)))
            style = draw(st.sampled_from(["inline", "dotted", "header"]))
            if isinstance(value, dict) and value and style == "dotted":
                found += lines(here, (*dotted, key), value)
            elif isinstance(value, dict) and style == "header" and not dotted:
                below(here, value, f"[{'.'.join(map(toml_key, here))}]")
            elif key == "lights":
                for row in value:
                    below(here, row, "[[lights]]")
            else:
                found.append(f"{name}{draw(st.sampled_from(['=', ' = ']))}{toml_value(value)}")
                found[-1] += draw(st.sampled_from(["", " # why", "\n# about the next", "\n"]))
        return found

    def below(path: tuple[str, ...], table: dict[str, Any], header: str) -> None:
        place = len(headers)
        found = lines(path, (), table)
        headers[place:place] = [draw(st.sampled_from(["", "\n", "# above\n"])) + header, *found]

    first = lines((), (), document)
    return "\n".join([*first, *headers]) + draw(st.sampled_from(["", "\n"]))


def pruned(value: Any) -> Any:
    """The value without empty tables, of which a removal may leave some or not."""
    if isinstance(value, list):
        return [pruned(each) for each in value]
    if not isinstance(value, dict):
        return value
    found = {key: pruned(each) for key, each in value.items()}
    return {key: each for key, each in found.items() if each != {}}


@given(st.data())
def test_what_a_text_says_after_an_edit_is_what_a_document_says(data: st.DataObject) -> None:
    document: dict[str, Any] = data.draw(documents)
    text = data.draw(texts(document))
    assert pruned(tomllib.loads(text)) == pruned(document)
    edited, expected = TomlText(text, TABLES), copy.deepcopy(document)
    for _ in range(data.draw(st.integers(1, 4))):
        starts: list[KeyPath] = [(), ("other",), ("view",), ("parts",)]
        starts += [("lights", row) for row in range(len(document.get("lights", ())))]
        path = (*data.draw(st.sampled_from(starts)), *data.draw(st.lists(keys, min_size=1, max_size=2)))
        assume(path[0] in ("other", *TABLES) or len(path) == 1)
        table: Any = expected
        for part in path[:-1]:
            table = table[part] if isinstance(part, int) else table.setdefault(part, {})
            assume(isinstance(table, (dict, list)) and table != [1, 2])
        if data.draw(st.booleans()):
            table.pop(path[-1], None)
            edited.remove(path)
        else:
            table[path[-1]] = data.draw(leaves)
            edited.set(path, table[path[-1]])
        assert pruned(tomllib.loads(edited.text)) == pruned(expected)


def test_a_new_key_is_not_swallowed_by_a_comment_at_the_end_of_the_file() -> None:
    edited = TomlText("a = 0\n# a note", TABLES)
    edited.remove(("a",))
    edited.set(("b",), 1)
    assert edited.text == "# a note\nb = 1\n\n"


def after_setting(text: str, path: KeyPath, value: object) -> str:
    edited = TomlText(text, TABLES)
    edited.set(path, value)
    tomllib.loads(edited.text)
    return edited.text


def after_removing(text: str, path: KeyPath) -> str:
    edited = TomlText(text, TABLES)
    edited.remove(path)
    tomllib.loads(edited.text)
    return edited.text


@pytest.mark.parametrize(
    ("text", "path", "value", "expected"),
    [
        ("a  =  1 # one\n", ("a",), 2.5, "a  =  2.5 # one\n"),
        ("[view]\nangle = 1", ("view", "angle"), 2, "[view]\nangle = 2"),
        ("view.angle = 1\n", ("view", "angle"), 2, "view.angle = 2\n"),
        ("view = {eye=[1],angle=1 }", ("view", "angle"), 2, "view = {eye=[1],angle=2 }"),
        ("view = {eye=[1]}", ("view", "angle"), 2, "view = {eye=[1], angle = 2 }"),
        ("f = {x = {on=true}}", ("f", "x", "on"), False, "f = {x = {on=false}}"),
        ("f = {x.on = true}", ("f", "x"), {"on": False}, "f = { x = { on = false } }"),
        ("f = {}", ("f", "a b"), 1, 'f = { "a b" = 1 }'),
        ("[[lights]]\nname = 'a'\n[[lights]]\n", ("lights", 1, "on"), True,
         "[[lights]]\nname = 'a'\n[[lights]]\non = true\n"),
    ],
)  # fmt: skip
def test_a_value_is_changed_where_it_stands(text: str, path: KeyPath, value: object, expected: str) -> None:
    assert after_setting(text, path, value) == expected


@pytest.mark.parametrize(
    ("text", "path", "value", "expected"),
    [
        ("", ("a",), 1, "a = 1\n\n"),
        ("# Top.\n\n[view]\n", ("a",), 1, "# Top.\n\na = 1\n\n[view]\n"),
        ("b = 1\n\n[view]\n", ("a",), 1, "b = 1\na = 1\n\n[view]\n"),
        ("[view]\neye = 1", ("view", "a"), 1, "[view]\neye = 1\na = 1\n"),
        ("[view]", ("view", "a"), 1, "[view]\na = 1\n"),
        ("view.eye = 1\nb = 2\n", ("view", "a"), 1, "view.eye = 1\nview.a = 1\nb = 2\n"),
        ("[parts]\nhood.stage = true\n", ("parts", "a b", "surface"), "x",
         '[parts]\nhood.stage = true\n"a b".surface = "x"\n'),
        ("[parts.hood]\nstage = true\n[view]\n", ("parts", "a b", "surface"), "x",
         '[parts.hood]\nstage = true\n\n[parts."a b"]\nsurface = "x"\n\n[view]\n'),
        ("[[lights]]\nname = 'a'\n", ("lights", 99, "name"), "b",
         "[[lights]]\nname = 'a'\n\n[[lights]]\nname = \"b\"\n"),
        ("[[lights]]\n[lights.flaps.x]\non = true\n[[lights]]\n", ("lights", 0, "flaps", "z"), {"on": True},
         "[[lights]]\n[lights.flaps.x]\non = true\n[lights.flaps]\nz = { on = true }\n\n[[lights]]\n"),
        ("[[mesh]]\n[[lights]]\n", ("surfaces", "a", "blend"), 1,
         "[[mesh]]\n\n[surfaces.a]\nblend = 1\n\n[[lights]]\n"),
        ("exposure.a = [1, 2]\n", ("exposure", "b"), [3, 4], "exposure.a = [1, 2]\nexposure.b = [3, 4]\n"),
    ],
)  # fmt: skip
def test_a_new_key_goes_to_its_like(text: str, path: KeyPath, value: object, expected: str) -> None:
    assert after_setting(text, path, value) == expected


def test_a_value_takes_the_place_of_a_table() -> None:
    assert after_setting("[exposure]\na = [1, 2]\n", ("exposure",), "auto") == 'exposure = "auto"\n\n'
    assert after_setting("exposure.a = [1, 2]\nb = 1\n", ("exposure",), "x") == 'b = 1\nexposure = "x"\n'


@pytest.mark.parametrize(
    ("text", "path", "expected"),
    [
        ("# why\na = 1 # one\nb = 2\n", ("a",), "# why\nb = 2\n"),
        ("# of a\n\n# of view\n[view]\neye = 1\n", ("view",), "# of a\n"),
        ("# title\n[view]\neye = 1\n", ("view",), "# title\n"),
        ("a = 1\n\n# of view\n[view]\neye = 1\n", ("view",), "a = 1\n"),
        ("f = { a = 1, b = 2 }\n", ("f", "a"), "f = { b = 2 }\n"),
        ("f = { a = 1 }\n", ("f", "a"), "f = {}\n"),
        ("f = {x = {a=1, b=2}}\n", ("f", "x", "b"), "f = {x = { a = 1 }}\n"),
        ("f = {a=1}\n", ("f", "b"), "f = {a=1}\n"),
        ("[[lights]]\n[lights.flaps]\n\n[[lights]]\nname = 'b'\n", ("lights", 0), "[[lights]]\nname = 'b'\n"),
        ("parts.a.stage = true\nparts.b.stage = true\n", ("parts", "a"), "parts.b.stage = true\n"),
    ],
)
def test_what_is_removed_goes_and_the_comments_above_a_key_stay(
    text: str, path: KeyPath, expected: str
) -> None:
    assert after_removing(text, path) == expected


def test_rows_are_arranged_with_all_that_is_theirs() -> None:
    text = TomlText("[[lights]]\nname = 'a'\n[lights.flaps]\n\n# of b\n[[lights]]\nname = 'b'", TABLES)
    text.set(("lights", 99, "name"), "c")
    text.arrange("lights", [99, 1, 0])
    assert text.text == (
        "[[lights]]\nname = \"c\"\n\n# of b\n[[lights]]\nname = 'b'\n\n"
        "[[lights]]\nname = 'a'\n[lights.flaps]\n\n"
    )


def test_rows_in_order_are_left_as_they_are() -> None:
    given = "[surfaces.a]\n[surfaces.b]\n"
    text = TomlText(given, TABLES)
    text.arrange("surfaces", ["a", "b"])
    assert text.text == given


def test_the_text_tells_what_it_has() -> None:
    text = TomlText("a = 1\n[[lights]]\nflaps.x.on = true\n", TABLES)
    assert all(map(text.has, [("a",), ("lights", 0), ("lights", 0, "flaps")]))
    assert not any(map(text.has, [("b",), ("lights", 1), ("lights", 0, "name")]))


def test_line_ends_stay_those_of_the_file() -> None:
    text = TomlText("a = 1\r\nb = 2\r\n", TABLES)
    text.set(("c",), 3)
    assert text.text == "a = 1\r\nb = 2\r\nc = 3\r\n"


UNITS = {
    ("view",): "[view]",
    ("parts", "a"): "[parts.a]",
    ("parts", "b"): "[parts.b]",
    ("surfaces", "a"): "[surfaces.a]",
    ("surfaces", "b"): "[surfaces.b] # here",
    ("lights", 0): "[[lights]]",
    ("lights", 1): "[[lights]] # here",
}


def unit(path: KeyPath, value: object) -> str:
    return f"# of {path}\n{UNITS[path]}\nkey = {value} # in {path}\n"


@given(
    st.permutations(list(UNITS)).filter(
        lambda found: found.index(("lights", 0)) < found.index(("lights", 1))
    ),
    st.lists(st.sampled_from(list(UNITS)), max_size=3),
    st.lists(st.sampled_from(list(UNITS)), max_size=3),
    st.sampled_from(["", "\n"]),
)
def test_comments_stay_with_what_they_are_about_wherever_it_goes(
    order: list[KeyPath], changed: list[KeyPath], removed: list[KeyPath], between: str
) -> None:
    edited = TomlText("# Top.\n\n" + between.join(unit(path, 1) for path in order), TABLES)
    edited.set(("parts", "new", "key"), 3)
    edited.set(("ambient",), 4)
    for path in changed:
        edited.set((*path, "key"), 2)
    for path in removed:
        edited.remove(path)
    if not {("surfaces", "a"), ("surfaces", "b")} & set(removed):
        assert edited.arrange("surfaces", ["b", "a"])
    if not {("lights", 0), ("lights", 1)} & set(removed):
        assert edited.arrange("lights", [1, 0])
    assert edited.text.startswith("# Top.\n\nambient = 4\n")
    tomllib.loads(edited.text)
    for path in UNITS:
        assert (unit(path, 2 if path in changed else 1) in edited.text) == (path not in removed)
        assert edited.text.count(f"# of {path}") == (path not in removed)


def test_letters_that_mark_comments_inside_may_be_in_a_text() -> None:
    text = "a = 1\n# \ufdd0\n# two\n[view] # \ufdd0\ufdd1\ufdd1 #\n"
    assert after_setting(text, ("a",), 2) == text.replace("1", "2")


def test_a_line_of_a_string_is_no_comment_of_the_header_below() -> None:
    text = 'a = """\n# x\n# y"""\n# of view\n[view] # ]\nb = [\n# z\n1]\n[parts]\n'
    assert after_setting(text, ("view", "b"), 2) == text.replace("[\n# z\n1]", "2")
    assert after_removing(text, ("view",)) == 'a = """\n# x\n# y"""\n[parts]\n'


SCENES = sorted((Path(__file__).parents[4] / "scenes").rglob("scene.toml"))

TEXT = """\
# The title.

# Of the key.
ambient = 0.1 # dim
"quoted # = key".inner = { a = 1 }

[view]
# The last of the view.

# Of the light.
[[lights]] # one
name = "key"
flaps.x = { minimum = 1 }
[lights.flaps.y]
on = true
[[lights]]
position = [
  1, # east
  2, 3,
]
[parts."a b"]
"""

pieces = st.sampled_from(
    ["\n", "# comment\n", " # c\n", "a = 1\n", "b.c = [1,\n # x\n 2]\n", 'd = """x\n[y]\n"""', "[t]\n", "\t"]
)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.parent.name)
def test_the_blocks_of_a_scene_file_are_its_text(path: Path) -> None:
    text = path.read_text("utf-8")
    assert "".join(block.text for block in blocks_of(text)) == text


@given(st.lists(pieces).map("".join) | st.text("ab=[]{}'\"#\n., 1", max_size=30))
def test_no_letter_of_any_valid_text_is_lost(text: str) -> None:
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return
    assert "".join(block.text for block in blocks_of(text)) == text


def test_each_statement_has_its_path_and_its_value() -> None:
    found = {statement.path: statement.value for block in blocks_of(TEXT) for statement in block.statements}
    assert found == {
        ("ambient",): "0.1",
        ("quoted # = key", "inner"): "{ a = 1 }",
        ("lights", 0, "name"): '"key"',
        ("lights", 0, "flaps", "x"): "{ minimum = 1 }",
        ("lights", 0, "flaps", "y", "on"): "true",
        ("lights", 1, "position"): "[\n  1, # east\n  2, 3,\n]",
    }


def test_each_block_has_its_path() -> None:
    assert [block.path for block in blocks_of(TEXT)] == [
        (), ("view",), ("lights", 0), ("lights", 0, "flaps", "y"), ("lights", 1), ("parts", "a b"),
    ]  # fmt: skip


def test_a_comment_directly_above_a_header_belongs_to_it() -> None:
    _, view, light, *_ = blocks_of(TEXT)
    assert view.tail == "# The last of the view.\n\n"
    assert light.head == "# Of the light.\n[[lights]] # one\n"


def test_a_comment_at_the_top_belongs_to_the_file() -> None:
    root, view = blocks_of("# A scene.\n[view]\n")
    assert (root.tail, view.head) == ("# A scene.\n", "[view]\n")


def test_the_rest_of_a_line_is_kept_apart_from_the_value() -> None:
    (statement,) = blocks_of("a.b  =\t'#' # note")[0].statements
    assert (statement.key, statement.equals, statement.value, statement.after) == (
        "a.b", "  =\t", "'#'", " # note",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{}", []),
        ("{ }", []),
        ("{a=1}", [(("a",), "a", "1")]),
        (
            '{ a.b = [1, 2] , "c,d" = { e = "}" } }',
            [(("a", "b"), "a.b", "[1, 2]"), (("c,d",), '"c,d"', '{ e = "}" }')],
        ),
    ],
)
def test_the_items_of_an_inline_table_have_their_places(text: str, expected: list[object]) -> None:
    assert [(each.path, each.key, text[each.start : each.stop]) for each in inline_items(text)] == expected


@given(st.sets(st.integers(0, 5)), st.booleans())
def test_many_rows_are_removed_at_once_as_one_by_one(rows: set[int], top: bool) -> None:
    lights = "".join(
        f'# light {row}\n[[lights]]\nname = "{row}" # name\n\n[lights.flaps.x]\non = true\n'
        for row in range(6)
    )
    at_once, one_by_one = (TomlText("ambient = 1\n\n" * top + lights, ["view", "lights"]) for _ in range(2))
    at_once.remove(*(("lights", row) for row in rows))
    for row in sorted(rows):
        one_by_one.remove(("lights", row))
    assert at_once.text == one_by_one.text


def test_the_places_of_keys_are_noted_once_for_all_removed_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    text = TomlText("".join(f"[parts.p{row}]\nstage = true\n" for row in range(100)), ["parts"])
    noted: list[int] = []
    monkeypatch.setattr(text, "_index", lambda: noted.append(1))
    text.remove(*(("parts", f"p{row}") for row in range(50)))
    assert len(noted) == 1
