from __future__ import annotations

import os
import socket
from pathlib import Path
from time import process_time

import pytest

from autocolor.errors import InputError, MissingInputError
from autocolor.files.reading import MOST_NESTED, bounded_json, nesting, read_bytes, shown, text_problem


def test_at_most_the_bytes_asked_for_are_read_without_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes(b"\xef\xbb\xbf" + bytes(997))
    assert read_bytes(path, 1000) == bytes(997)
    with pytest.raises(InputError) as caught:
        read_bytes(path, 999)
    assert str(caught.value) == "a.obj: a file must have at most 999 bytes, not more; split or simplify it"


def test_what_is_no_regular_file_is_refused_without_waiting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("zero").symlink_to("/dev/zero")
    os.mkfifo("pipe")
    with socket.socket(socket.AF_UNIX) as opened:
        opened.bind("socket")
        for name, kind in (("folder", "folder"), ("pipe", "pipe"), ("socket", "socket"), ("zero", "device")):
            with pytest.raises(InputError) as caught:
                read_bytes(Path(name), 100)
            assert str(caught.value) == f"{name}: it must be a regular file, not a {kind}; name a file"


def test_a_name_of_no_file_is_refused(tmp_path: Path) -> None:
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    advice = "; check the name and its permissions"
    for path, sentence in (
        (Path("a\0b.obj"), "a file name must be valid on this system, not 'a\\x00b.obj'; correct it"),
        (Path("a" * 300), f"{'a' * 300}: it cannot be read (file name too long){advice}"),
        (loop, f"{loop}: it cannot be read (too many levels of symbolic links){advice}"),
    ):
        with pytest.raises(InputError) as caught:
            read_bytes(path, 100)
        assert str(caught.value) == sentence
    for path in (tmp_path / "none.obj", Path(__file__) / "none.obj"):
        with pytest.raises(MissingInputError) as caught:
            read_bytes(path, 100)
        assert str(caught.value) == f"{path}: there is no such file or folder; check the name"


def test_what_is_no_text_is_said() -> None:
    assert text_problem(b"v 1 2 3\n") is None
    assert text_problem("v".encode("utf-16")) == "must be text in UTF-8, not UTF-16; save it as UTF-8"
    assert text_problem(b"v\nv\0") == "must be text, not hold a NUL byte (line 2); save it as UTF-8 text"


def test_what_is_shown_is_short() -> None:
    assert shown("a" * 1_000_000) == repr("a" * 40) + "..."
    assert shown(b"\xff\n") == repr("\\xff\n")


def test_json_may_be_nested_a_hundred_deep_and_have_as_many_values_as_allowed() -> None:
    for depth in (MOST_NESTED, MOST_NESTED + 1):
        data = b'{"[[": "\\"[[", "list": ' + b"[" * (depth - 1) + b"]" * (depth - 1) + b"}"
        assert nesting(data) == depth
        if depth == MOST_NESTED:
            assert bounded_json(data, 1000)
            continue
        with pytest.raises(ValueError, match=r"^values in more than 100 lists and tables$"):
            bounded_json(data, 1000)
    assert bounded_json(b"[1, 2, {}]", 4) == [1, 2, {}]
    with pytest.raises(ValueError, match=r"^more than 3 values$"):
        bounded_json(b"[1, 2, {}]", 3)


@pytest.mark.parametrize("data", [b'"' + b'\\"' * 500_000, b'[{"' * 300_000, b'"\\'])
def test_any_json_is_counted_in_one_pass(data: bytes) -> None:
    begun = process_time()
    nesting(data)
    assert process_time() - begun < 3
