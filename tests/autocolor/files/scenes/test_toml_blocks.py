from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.scenes.toml_blocks import blocks_of, inline_items

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
