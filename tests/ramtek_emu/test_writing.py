from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from ramtek_emu import OutputError, OutputExistsError, Ramtek9300, WriteError, write_snapshot, writing
from ramtek_emu.png import png_bytes
from ramtek_emu.writing import Output, refuse_output, write_atomically, write_numbered

FIELD = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)


def test_saving_again_replaces_the_file_unless_overwrite_is_false(tmp_path: Path) -> None:
    path = tmp_path / "field.png"
    path.write_bytes(b"old")
    path.chmod(0o640)
    with pytest.raises(OutputExistsError) as refusal:
        write_atomically(path, png_bytes(FIELD), overwrite=False)
    assert str(refusal.value) == (
        f"an output must be a new file, not {path}, which exists; choose another name, or overwrite it"
        " with --force (overwrite=True in Python)"
    )
    assert path.read_bytes() == b"old"
    write_atomically(path, png_bytes(FIELD), overwrite=True)
    assert path.read_bytes() == png_bytes(FIELD)
    # A file that is replaced keeps its permissions.
    assert path.stat().st_mode & 0o777 == 0o640
    assert os.listdir(tmp_path) == ["field.png"]


def test_saving_through_a_link_keeps_the_link(tmp_path: Path) -> None:
    target, link = tmp_path / "target.png", tmp_path / "link.png"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_atomically(link, png_bytes(FIELD), overwrite=True)
    assert link.is_symlink()
    assert target.read_bytes() == png_bytes(FIELD)


def test_a_file_system_without_links_gets_the_picture_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(1, "no links here")

    monkeypatch.setattr(os, "link", refuse)
    write_atomically(tmp_path / "field.png", png_bytes(FIELD), overwrite=False)
    assert os.listdir(tmp_path) == ["field.png"]


def test_after_a_failed_write_the_old_file_is_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "field.png"
    path.write_bytes(b"old")

    def full_disk(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(WriteError, match="no space left on device"):
        write_atomically(path, png_bytes(FIELD), overwrite=True)
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["field.png"]


@pytest.mark.parametrize("sync", [False, True])
@pytest.mark.parametrize("overwrite", [False, True])
def test_only_a_synced_file_waits_for_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sync: bool, overwrite: bool
) -> None:
    path = tmp_path / "field.png"
    if overwrite:
        path.write_bytes(b"old")
    synced: list[int] = []
    monkeypatch.setattr(os, "fsync", synced.append)
    write_atomically(path, b"new", overwrite=overwrite, sync=sync)
    assert len(synced) == (2 if sync else 0)
    assert path.read_bytes() == b"new"
    assert os.listdir(tmp_path) == ["field.png"]


def test_an_output_is_written_piece_by_piece_and_appears_when_kept(tmp_path: Path) -> None:
    path = tmp_path / "words.ramtek"
    path.write_bytes(b"old")
    with Output(path, overwrite=True) as output:
        output.write(b"new")
    # It was not kept.
    assert path.read_bytes() == b"old"
    path.unlink()
    with Output(path, overwrite=False) as output:
        output.write(b"one ")
        assert not path.exists()
        output.write(b"two")
        output.write_at(1, b"NE")
        output.write(b"!")
        output.keep()
    assert path.read_bytes() == b"oNE two!"
    assert os.listdir(tmp_path) == ["words.ramtek"]


def test_a_file_may_have_the_longest_name(tmp_path: Path) -> None:
    path = tmp_path / ("\u4e2d" * 85)
    write_atomically(path, b"new", overwrite=False)
    assert path.read_bytes() == b"new"


def test_a_file_that_came_to_exist_meanwhile_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "words.ramtek"
    with Output(path, overwrite=False) as output:
        path.write_bytes(b"another's")
        with pytest.raises(OutputExistsError):
            output.keep()
    assert path.read_bytes() == b"another's"
    assert os.listdir(tmp_path) == ["words.ramtek"]


def test_impossible_outputs_are_refused_before_anything_is_done(tmp_path: Path) -> None:
    refuse_output(tmp_path / "new.png", overwrite=False)
    for place, sentence in (
        (tmp_path, f"an output must be a file, not the folder {tmp_path}; add a file name"),
        (Path("/dev/null"), "an output must be a file, not the device /dev/null; choose another name"),
        (Path("a\0b"), "a file name must be valid on this system, not 'a\\x00b'; choose another name"),
        (
            tmp_path / "none" / "a.png",
            f"an output must have a folder to be in, and there is no folder {tmp_path / 'none'}; make it, or "
            "choose another place",
        ),
        (
            tmp_path / ("x" * 300),
            f"an output must have a place, and at {tmp_path / ('x' * 300)} it cannot be made (file name too"
            " long); choose another name",
        ),
    ):
        with pytest.raises(OutputError) as refusal:
            refuse_output(place, overwrite=True)
        assert str(refusal.value) == sentence
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("write", "thing"),
    [
        (lambda path: Ramtek9300().save_png(path), "a picture"),
        (partial(write_snapshot, Ramtek9300()), "a snapshot"),
    ],
)
def test_a_picture_and_a_snapshot_are_written_to_png_files_alone(
    tmp_path: Path, write: Callable[[Path], None], thing: str
) -> None:
    for name in ("a.jpg", "a"):
        with pytest.raises(OutputError) as refusal:
            write(tmp_path / name)
        sentence = f"{thing} must be written to a file that ends in .png, not to {tmp_path / name}; rename it"
        assert str(refusal.value) == sentence
    assert os.listdir(tmp_path) == []
    write(tmp_path / "a.PNG")
    with pytest.raises(OutputExistsError):
        write(tmp_path / "a.PNG")


def test_what_a_killed_program_left_stays_and_hinders_nobody(tmp_path: Path) -> None:
    code = (
        "import os, signal, sys\nfrom ramtek_emu.writing import Output\n"
        "with Output(sys.argv[1], overwrite=True) as output:\n"
        "    output.write(b'words' * 10_000)\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path / "a"], check=False)
    (left,) = tmp_path.iterdir()
    assert re.fullmatch(r"\.a\.[0-9a-f]{8}\.part", left.name)
    assert left.read_bytes().startswith(b"words")
    write_atomically(tmp_path / "a", b"new", overwrite=False)
    assert sorted(os.listdir(tmp_path)) == [left.name, "a"]


def test_paths_of_the_same_file_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "link").symlink_to("a.png")
    (tmp_path / "folder").symlink_to(".")
    for other in ("a.png", "./a.png", str(tmp_path / "a.png"), "link", "folder/a.png"):
        assert writing.same_outputs(("b.png", "a.png", other)) == ("a.png", other)
    assert writing.same_outputs(("a.png", "b.png", "c/a.png")) is None
    (tmp_path / "a.png").touch()
    os.link("a.png", "hard")
    assert writing.same_outputs(("hard", "a.png")) == ("hard", "a.png")


def test_a_number_whose_name_is_in_use_by_anything_is_skipped(tmp_path: Path) -> None:
    (tmp_path / "a-0001.png").mkdir()
    (tmp_path / "a-0002.png").symlink_to("nowhere")
    assert write_numbered(b"new", tmp_path, "a", ".png").name == "a-0003.png"
