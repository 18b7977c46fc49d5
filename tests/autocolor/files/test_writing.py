from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from autocolor.errors import AutocolorError, OutputError, WriteError
from autocolor.files.writing import write_atomically, write_together


def test_a_new_file_has_the_bytes_and_nothing_stands_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    write_atomically(path, b"new", overwrite=False)
    assert path.read_bytes() == b"new"
    assert os.listdir(tmp_path) == ["a.npz"]


def test_an_existing_file_is_refused_without_overwrite(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(b"old")
    with pytest.raises(OutputError) as caught:
        write_atomically(path, b"new", overwrite=False)
    assert str(caught.value) == (
        f"an output must be a new file, not {path}, which exists; choose another name, or overwrite it"
        " with --force (overwrite=True in Python)"
    )
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["a.npz"]


def test_a_link_to_nothing_exists(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    path.symlink_to(tmp_path / "b.npz")
    with pytest.raises(OutputError, match="exists"):
        write_atomically(path, b"new", overwrite=False)


def test_overwriting_replaces_and_keeps_the_permissions(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(b"old")
    path.chmod(0o640)
    write_atomically(path, b"new", overwrite=True)
    assert path.read_bytes() == b"new"
    assert path.stat().st_mode & 0o777 == 0o640


def test_overwriting_through_a_link_keeps_the_link(tmp_path: Path) -> None:
    target, link = tmp_path / "a.npz", tmp_path / "b.npz"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_atomically(link, b"new", overwrite=True)
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


def test_a_missing_folder_is_no_place(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="there is no folder"):
        write_atomically(tmp_path / "none" / "a.npz", b"new", overwrite=True)


def test_a_folder_is_no_output(tmp_path: Path) -> None:
    with pytest.raises(OutputError) as caught:
        write_atomically(tmp_path, b"new", overwrite=True)
    assert str(caught.value) == f"an output must be a file, not the folder {tmp_path}; add a file name"


def test_a_name_with_a_nul_byte_or_of_endless_length_is_no_place(tmp_path: Path) -> None:
    for name in ("a\0b", "a" * 5000):
        with pytest.raises(OutputError):
            write_atomically(tmp_path / name, b"new", overwrite=True)


@pytest.mark.parametrize(
    ("number", "kind"),
    [
        (errno.ENOSPC, WriteError),
        (errno.EIO, WriteError),
        (errno.EDQUOT, WriteError),
        (errno.EROFS, OutputError),
        (errno.EACCES, OutputError),
    ],
)
@pytest.mark.parametrize("call", ["fsync", "replace", "open"])
def test_after_a_failure_the_old_file_is_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, kind: type[AutocolorError], call: str
) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(b"old")

    def fail(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(os, call, fail)
    with pytest.raises(kind) as caught:
        write_atomically(path, b"new", overwrite=True)
    monkeypatch.undo()
    assert os.strerror(number).lower() in str(caught.value)
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["a.npz"]


def test_an_interruption_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(tmp_path / "a.npz", b"new", overwrite=False)
    assert os.listdir(tmp_path) == []


def test_a_file_system_without_links_gets_the_file_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EPERM, "no links here")

    monkeypatch.setattr(os, "link", refuse)
    write_atomically(tmp_path / "a.npz", b"new", overwrite=False)
    assert os.listdir(tmp_path) == ["a.npz"]


def test_a_file_that_came_meanwhile_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.npz"
    link = os.link

    def late(source: str, target: str) -> None:
        path.write_bytes(b"other")
        link(source, target)

    monkeypatch.setattr(os, "link", late)
    with pytest.raises(OutputError, match="exists"):
        write_atomically(path, b"new", overwrite=False)
    assert path.read_bytes() == b"other"


def test_files_written_together_get_their_names_when_all_are_whole(tmp_path: Path) -> None:
    seen: list[list[str]] = []

    def pieces(fails: bool) -> Iterator[bytes]:
        yield b"one"
        if fails:
            raise WriteError("the disk is full")
        yield b"two"

    def look() -> None:
        seen.append([path.name for path in tmp_path.iterdir() if path.suffix == ".npy"])

    files = [tmp_path / "a.npy", tmp_path / "b.npy"]
    with pytest.raises(WriteError, match="the disk is full"):
        write_together([(path, pieces(path == files[1])) for path in files], overwrite=False)
    assert list(tmp_path.iterdir()) == []
    write_together([(path, pieces(False)) for path in files], overwrite=False, before_names=look)
    assert seen == [[]]
    assert [path.read_bytes() for path in files] == [b"onetwo"] * 2
    with pytest.raises(OutputError, match="an output must be a new file"):
        write_together([(files[0], [b""])], overwrite=False)
    assert files[0].read_bytes() == b"onetwo"
