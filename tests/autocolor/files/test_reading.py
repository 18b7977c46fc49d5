from __future__ import annotations

import os
import socket
from pathlib import Path
from time import process_time

import pytest

from autocolor.errors import InputError, MissingInputError
from autocolor.files.reading import MOST_NESTED, bounded_json, nesting, read_bytes, shown, text_problem


def test_a_byte_order_mark_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes(b"\xef\xbb\xbfv 1 2 3")
    assert read_bytes(path, 100) == b"v 1 2 3"


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError) as caught:
        read_bytes(tmp_path / "a.obj", 100)
    assert str(caught.value) == f"{tmp_path / 'a.obj'}: there is no such file or folder; check the name"


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    path = tmp_path / "x.obj"
    path.mkdir()
    with pytest.raises(InputError) as caught:
        read_bytes(path, 100)
    assert str(caught.value) == f"{path}: it must be a regular file, not a folder; name a file"


def test_a_pipe_is_refused_without_waiting(tmp_path: Path) -> None:
    path = tmp_path / "x.obj"
    os.mkfifo(path)
    with pytest.raises(InputError, match="it must be a regular file, not a pipe"):
        read_bytes(path, 100)


def test_a_socket_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as opened:
        opened.bind("x.obj")
        with pytest.raises(InputError, match="it must be a regular file, not a socket"):
            read_bytes(Path("x.obj"), 100)


def test_a_device_is_refused() -> None:
    with pytest.raises(InputError, match="it must be a regular file, not a device"):
        read_bytes(Path("/dev/zero"), 100)


def test_a_file_larger_than_allowed_is_refused_after_that_many_bytes(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes(bytes(1001))
    with pytest.raises(InputError) as caught:
        read_bytes(path, 1000)
    assert str(caught.value) == "a.obj: a file must have at most 1,000 bytes, not more; split or simplify it"


def test_a_name_with_a_nul_byte_or_of_endless_length_is_refused() -> None:
    for name in ("a\0b.obj", "a" * 5000):
        with pytest.raises(InputError):
            read_bytes(Path(name), 100)


def test_a_loop_of_links_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.symlink_to(path)
    with pytest.raises(InputError, match="it cannot be read"):
        read_bytes(path, 100)


def test_what_is_no_text_is_said() -> None:
    assert text_problem(b"v 1 2 3\n") is None
    assert text_problem("v".encode("utf-16")) == "must be text in UTF-8, not UTF-16; save it as UTF-8"
    assert text_problem(b"v\nv\0") == "must be text, not hold a NUL byte (line 2); save it as UTF-8 text"


def test_what_is_shown_is_short() -> None:
    assert shown("a" * 1_000_000) == repr("a" * 40) + "..."
    assert shown(b"\xff\n") == repr("\\xff\n")


@pytest.mark.parametrize("depth", [MOST_NESTED - 1, MOST_NESTED, MOST_NESTED + 1])
def test_json_is_refused_that_is_nested_too_deeply(depth: int) -> None:
    data = b'{"[[": "\\"[[", "list": ' + b"[" * (depth - 1) + b"]" * (depth - 1) + b"}"
    assert nesting(data) == depth
    if depth <= MOST_NESTED:
        assert bounded_json(data, 1000)
        return
    with pytest.raises(ValueError, match="values in more than 100 lists and tables"):
        bounded_json(data, 1000)


@pytest.mark.parametrize("data", [b'"' + b'\\"' * 500_000, b'[{"' * 300_000, b'"\\'])
def test_any_json_is_counted_in_one_pass(data: bytes) -> None:
    begun = process_time()
    nesting(data)
    assert process_time() - begun < 3
