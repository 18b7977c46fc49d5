from __future__ import annotations

import os
from pathlib import Path, PureWindowsPath
from time import process_time

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor.errors import InputError, MissingInputError, UsageError
from autocolor.files.paths import check_stem, file_stem, free_path, path_within
from autocolor.files.reading import MOST_NESTED, bounded_json, read_bytes, read_whole
from tests.autocolor.files.refusals import refusal


def test_at_most_the_bytes_asked_for_are_read_without_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes(b"\xef\xbb\xbf" + bytes(997))
    assert read_bytes(path, 1000) == bytes(997)
    assert (
        refusal(read_bytes, path, 999)
        == "a.obj: a file must have at most 999 bytes, not more; split or simplify it"
    )


def test_gigabytes_of_zeros_are_refused_by_their_first_page(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.touch()
    os.truncate(path, 1 << 30)
    begun = process_time()
    with pytest.raises(InputError, match=r"^a\.obj: a file must not begin with 4,096 zero bytes; copy or"):
        read_whole(path, 3)
    assert process_time() - begun < 0.1
    with pytest.raises(InputError, match=r"^a\.obj: to read 1,073,741,824 bytes must take at most"):
        read_whole(path, 4)


def test_what_is_no_regular_file_is_refused_without_waiting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("zero").symlink_to("/dev/zero")
    os.mkfifo("pipe")
    for name in ("folder", "pipe", "zero"):
        kind = "a folder" if name == "folder" else "a pipe or a device"
        sentence = f"{name}: it must be a regular file, not {kind}; name a file"
        assert refusal(read_bytes, Path(name), 100) == sentence


def test_a_name_of_no_file_is_refused(tmp_path: Path) -> None:
    none = tmp_path / "none.obj"
    advice = "; check the name and its permissions"
    for path, sentence in (
        (Path("a\0b.obj"), "a file name must be valid on this system, not 'a\\x00b.obj'; correct it"),
        (Path("a" * 300), f"{'a' * 300}: it cannot be read (file name too long){advice}"),
        (none, f"{none}: there is no such file or folder; check the name"),
    ):
        assert refusal(read_bytes, path, 100) == sentence
    with pytest.raises(MissingInputError):
        read_bytes(Path(__file__) / "none.obj", 100)


def nested(depth: int) -> bytes:
    return b'{"[[": "\\"[[", "list": ' + b"[" * (depth - 1) + b"]" * (depth - 1) + b"}"


def test_json_may_be_nested_a_hundred_deep_and_have_as_many_values_as_allowed() -> None:
    assert bounded_json(nested(MOST_NESTED), 1000)
    assert bounded_json(b"[1, 2, {}]", 4) == [1, 2, {}]
    for data, sentence in (
        (nested(MOST_NESTED + 1), "values in more than 100 lists and tables"),
        (b"[" * 300_000, "values in more than 100 lists and tables"),
        (b"[1, 2, {}" + b", 1" * 1000 + b"]", "more than 1,000 values"),
        (b'"' + b'\\"' * 500_000, "Unterminated string starting at line 1, column 1"),
    ):
        begun = process_time()
        with pytest.raises(ValueError, match=f"^{sentence}$"):
            bounded_json(data, 1000 if b"1" in data[:99] else 1_000_000)
        assert process_time() - begun < 3


WRONG = ("/a.obj", "b/../../a", "C:a.obj", "up/b.obj", "a\\b.obj", "https://a.b/c.obj")


def test_names_of_other_places_are_refused_unless_files_outside_are_allowed(tmp_path: Path) -> None:
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "up").symlink_to(tmp_path)
    for right in ("a.obj", "parts/a.obj", "./a.obj", "a b.obj", "é.obj", "..a.obj"):
        assert path_within([], folder, right) == folder / right
    problems: list[str] = []
    for name in (*WRONG, "", "a\0b"):
        assert path_within(problems, folder, name) is None
        assert path_within([], folder, name, outside=True) == (folder / name if name in WRONG else None)
    rule = "must be the name of a file in the scene's folder, not"
    assert problems == [
        *(f"{rule} {name!r}; copy the file there" for name in WRONG),
        "must be the name of a file, not ''; correct it",
        "must be the name of a file, not 'a\\x00b'; correct it",
    ]


@given(st.text())
@example("../../x")
@example("a\\..\\b")
def test_any_name_becomes_a_file_in_the_folder_where_it_is_put(name: str) -> None:
    names = {"C:\\car": "C__car", "line\nbreak\x00": "line_break_", " купе é ": "купе é", "a/..": "scene"}
    # A space at the cut goes, too.
    names["a" * 99 + " b"] = "a" * 99
    assert {each: file_stem(each) for each in names} == names
    stem = file_stem(name)
    path = f"{stem}.png"
    assert Path(path).name == path
    assert PureWindowsPath(path).name == path
    assert path != ".png"
    assert len(path) <= 104
    assert not any(ord(letter) < 32 for letter in path)
    assert file_stem(stem) == stem
    if stem.isprintable() and not stem.startswith("."):
        check_stem(stem)


@pytest.mark.parametrize("name", ["", ".hidden", "a/b", "\u202ea", "x" * 101])
def test_a_name_that_cannot_be_the_stem_of_a_listed_file_is_refused(name: str) -> None:
    with pytest.raises(UsageError, match=r"^a name must be 1 to 100 characters, .*; choose another$"):
        check_stem(name)


def test_a_path_that_is_taken_gets_the_lowest_number_from_two(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    assert free_path(path) == path
    path.touch()
    assert free_path(path) == tmp_path / "rig-2.toml"
    (tmp_path / "rig-2.toml").mkdir()
    (tmp_path / "rig-3.toml").symlink_to(tmp_path / "nowhere")
    assert free_path(path) == tmp_path / "rig-4.toml"
