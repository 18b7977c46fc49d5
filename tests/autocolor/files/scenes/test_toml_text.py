from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.scenes.toml_text import key_lines, parsed_toml


def refusal(data: bytes | str) -> str:
    with pytest.raises(InputError) as caught:
        parsed_toml(data if isinstance(data, bytes) else data.encode(), "scene.toml")
    assert len(caught.value.problems) == 1
    return str(caught.value)


def test_toml_is_parsed() -> None:
    text = (
        'a = 1\r\n["b.c"."d \\" ["]\n"""'.replace('"""', "")
        + "e = '''x\n[y]'''\n# [[[[\nf = [[1.5, 2.5], []]\n"
    )
    assert parsed_toml(text.encode(), "x") == {
        "a": 1,
        "b.c": {'d " [': {"e": "x\n[y]", "f": [[1.5, 2.5], []]}},
    }


@pytest.mark.parametrize(
    ("text", "line", "place"),
    [
        ("a = 1\nb 2\n", 2, "column 3"),
        ("a = 1\na = 2\n", 2, "column 6"),
        ("\na = [1,\n\n", 2, "the end of the file"),
    ],
)
def test_a_syntax_error_is_one_sentence_with_its_line(text: str, line: int, place: str) -> None:
    sentence = refusal(text)
    assert sentence.startswith(f"scene.toml, line {line}: it must be valid TOML, but is not at {place} (")
    assert sentence.endswith("); correct the line")


def test_other_encodings_are_refused() -> None:
    assert refusal("a = 1".encode("utf-16")) == (
        "scene.toml: a scene file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    assert refusal(b"a = 1\nb = '\xe4'") == (
        "scene.toml, line 2: a scene file must be text in UTF-8, not bytes like 0xe4; save it as UTF-8"
    )
    assert refusal(b"a = 1\n\0") == (
        "scene.toml: a scene file must be text, not hold a NUL byte (line 2); save it as UTF-8 text"
    )


@pytest.mark.parametrize("brackets", ["[" * 1000, "[" * 1000 + "]" * 1000, "{a=" * 1000, "[{a=" * 500])
def test_deep_nesting_is_refused_before_parsing(brackets: str) -> None:
    assert refusal("b = 1\na = " + brackets) == (
        "scene.toml, line 2: brackets must be nested at most 16 deep, not deeper; flatten them"
    )


@pytest.mark.parametrize("key", ["a" + ".a" * 20_000, "a" + " . 'b'" * 20_000, '"a"' + '."b"' * 20_000])
@pytest.mark.parametrize("form", ["{} = 1", "[{}]", "[[{}]]", "a = {{ {} = 1 }}"])
def test_long_dotted_keys_are_refused_before_parsing(key: str, form: str) -> None:
    assert refusal("\n" + form.format(key)) == (
        "scene.toml, line 2: a key must have at most 8 parts between dots, not more; shorten it"
    )


@pytest.mark.parametrize("word", ["1" * 5000, "0x" + "f" * 4998, "-1" + "_1" * 2499, "1e" + "9" * 4998])
def test_endless_numbers_are_refused_before_parsing(word: str) -> None:
    assert refusal("a = " + word) == (
        "scene.toml, line 1: a number or a key must have at most 100 digits or letters, not 5,000; write it"
        " shorter, or in quotes"
    )


def test_brackets_and_dots_in_texts_and_comments_do_not_count() -> None:
    brackets = "[" * 100 + "." * 100 + "1" * 200
    text = f"# {brackets}\na = '{brackets}'\nb = \"\\\"{brackets}\"\nc = '''\n'{brackets}'''\n"
    text += f'd = """\n\\"""{brackets}"""\n'
    assert set(parsed_toml(text.encode(), "x")) == {"a", "b", "c", "d"}


def test_a_list_of_many_numbers_is_no_dotted_key() -> None:
    assert len(parsed_toml(b"a = [" + b"1.5, " * 1000 + b"]", "x")["a"]) == 1000


@pytest.mark.parametrize(
    "text", ["a = 'x", 'a = "x\\', 'a = """x', "a = '''x''", 'a = """""', "]]]]", '"' * 9999]
)
def test_open_ends_are_refused(text: str) -> None:
    assert refusal(text).startswith("scene.toml, line 1: it must be valid TOML")


@given(st.binary(max_size=100) | st.text("ab.=[]{}\"'\\#,1-: \n\r\t", max_size=100).map(str.encode))
def test_any_bytes_are_parsed_or_refused(data: bytes) -> None:
    try:
        parsed_toml(data, "scene.toml")
    except InputError:
        return
    key_lines(data)


def test_every_key_has_its_line() -> None:
    text = """
ambient = 1
"a = b" . c = 2
[view]
eye = [
    1,
    2,
]

[[lights]]
name = 'a' # comment
flaps.z = { on = true }
[[lights]]
name = '''
b'''
on = true
[surfaces."a.b"]
"""
    assert key_lines(text.encode()) == {
        ("ambient",): 2,
        ("a = b",): 3,
        ("a = b", "c"): 3,
        ("view",): 4,
        ("view", "eye"): 5,
        ("lights",): 10,
        ("lights", 0): 10,
        ("lights", 0, "name"): 11,
        ("lights", 0, "flaps"): 12,
        ("lights", 0, "flaps", "z"): 12,
        ("lights", 1): 13,
        ("lights", 1, "name"): 14,
        ("lights", 1, "on"): 16,
        ("surfaces",): 17,
        ("surfaces", "a.b"): 17,
    }
