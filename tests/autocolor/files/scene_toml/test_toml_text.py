from __future__ import annotations

import tomllib

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor import InputError
from autocolor.errors import MissingInputError
from autocolor.files.scene_toml.toml_text import MOST_PROBLEMS, SceneProblems, parsed_toml, toml_value
from autocolor.scene.columns import Problem
from tests.tables import refused

LARGE = "scene.toml, line 2: a scene file must have at most 16 nested brackets, "

test_what_is_no_toml_is_refused = refused(
    lambda data: parsed_toml(data, "scene.toml"),
    [
        (
            b"a = 1\nb 2\n",
            "scene.toml: it must be valid TOML (Expected '=' after a key in a key/value pair (at line 2,"
            " column 3)); correct it",
        ),
        (
            b"a = 1\n\0",
            "scene.toml: a scene file must be text, not hold a NUL byte (line 2); save it as UTF-8 text",
        ),
        (b"a = 1\nb = '\xe4'", "scene.toml, line 2: a scene file must be text in UTF-8; save it as UTF-8"),
    ],
)


@pytest.mark.parametrize(
    "text",
    [
        "a = " + "[" * 17,
        "]]]]a = " + "[" * 17,
        "a" + ".a" * 8 + " = 1",
        "a = { b = [ { " + '"a".' * 8 + "b = 1 } ] }",
        "a" * 101 + " = 1",
        "a = -1" + "_1" * 2499,
    ],
)
def test_nesting_key_parts_and_words_are_bounded(text: str) -> None:
    with pytest.raises(InputError, match=f"^{LARGE}"):
        parsed_toml(f"\n{text}".encode(), "scene.toml")


def test_brackets_and_dots_in_texts_and_comments_do_not_count_and_limits_may_be_reached() -> None:
    brackets = "[" * 100 + "." * 100 + "1" * 200
    text = f"# {brackets}\na = '{brackets}'\nb = \"\\\"{brackets}\"\nc = '''\n'{brackets}'''\n"
    text += (
        f'd = """\n\\"""{brackets}"""\n' + "e = " + "[" * 16 + "]" * 16 + "\nf = [" + "[[]], " * 40 + "]\n"
    )
    text += "g" + ".b" * 7 + " = 1\n" + "h" * 100 + " = 1"
    assert {*parsed_toml(text.encode(), "x")} == {*"abcdefg", "h" * 100}


@given(st.binary(max_size=100) | st.text("ab.=[]{}\"'\\#,1-: \n\r\t", max_size=100).map(str.encode))
def test_any_bytes_are_parsed_or_refused(data: bytes) -> None:
    try:
        problems = SceneProblems("scene.toml", data, parsed_toml(data, "scene.toml"))
    except InputError:
        return
    problems.note(("a",), "must be so")


@given(st.text(st.characters(exclude_categories=["Cs"])))
@example("\x00\x1b\x7f\x85\u2028\u202e\U000e0001")
def test_any_text_is_written_so_that_it_can_be_printed_and_reads_back_equal(text: str) -> None:
    written = toml_value(text)
    assert written.isprintable()
    assert tomllib.loads(f"name = {written}") == {"name": text}


TEXT = """ambient = 1 # = [
scaling = '''
object'''
[view] # of [it]
eye = [1, 2, 3]

[[mesh]]
file = "car.obj"
[surfaces."my body"]
blend = 0.5
[[lights]]
name = "key # = ]"
position = [
  1, # east
  2, 3 ]
flaps.z = { minimum = 0 }
[lights.flaps.y]
on = true
[[lights]]
position = [1, 2, 3]
"""


def problems_of(text: str = TEXT) -> SceneProblems:
    return SceneProblems("scene.toml", text.encode(), tomllib.loads(text))


def sentences_of(problems: SceneProblems) -> tuple[str, ...]:
    with pytest.raises(InputError) as caught:
        problems.raise_any()
    return caught.value.problems


KEY = "lights[1] 'key # = ]'"


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        ((), ","),
        (("view", "eye"), ", line 5, view.eye"),
        (("surfaces", "my body", "blend"), ", line 10, [surfaces.my body]: blend"),
        (("lights", 0, "flaps", "y", "on"), f", line 18, {KEY}: flaps.y.on"),
        (("lights", 1, "name"), ", line 19, lights[2]: name"),
        (("parts", "hood", "surface"), ", [parts.hood]: surface"),
    ],
)
def test_a_problem_has_the_line_the_table_and_the_key(path: tuple[str | int, ...], sentence: str) -> None:
    problems = problems_of()
    problems.note_all([Problem(path[2:], "must be so")], path[:2])
    assert sentences_of(problems) == (f"scene.toml{sentence} must be so",)


def test_files_are_missing_input_only_where_nothing_else_is_wrong() -> None:
    missing = MissingInputError("car.obj: there is no such file")
    problems = problems_of()
    problems.note_file(("mesh", 0, "file"), missing)
    with pytest.raises(MissingInputError) as caught:
        problems.raise_any()
    assert str(caught.value) == "scene.toml, line 8: car.obj: there is no such file"
    problems.note(("ambient",), "must be so")
    with pytest.raises(InputError) as other:
        problems.raise_any()
    assert other.type is InputError
    assert len(other.value.problems) == 2


def test_a_report_has_at_most_so_many_problems_and_says_if_there_may_be_more() -> None:
    problems = problems_of()
    for _ in range(MOST_PROBLEMS - 1):
        problems.note(("ambient",), "must be so")
    assert len(sentences_of(problems)) == MOST_PROBLEMS - 1
    problems.note_file(("mesh", 0, "file"), InputError("car.obj: wrong" for _ in range(3)))
    sentences = sentences_of(problems)
    assert len(sentences) == MOST_PROBLEMS + 1
    assert sentences[-1] == "scene.toml: there may be more problems; correct these first"
