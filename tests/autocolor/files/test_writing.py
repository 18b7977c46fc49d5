from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from itertools import count
from pathlib import Path

import pytest
from click.testing import CliRunner

from autocolor import read_scene
from autocolor.commands.autocolor import autocolor
from autocolor.errors import InputError, OutputError, WriteError
from autocolor.files import writing
from autocolor.files.opening import kind_of
from autocolor.files.reading import read_bytes
from autocolor.files.writing import (
    read_table,
    read_together,
    refuse_output,
    table_exists,
    write_atomically,
    write_together,
)
from tests.kills import KINDS, Killed, killed, mesh_sum, steps


@pytest.mark.parametrize("name", ["old.npz", "none/a.npz", "", "a\0b", "a" * 5000])
def test_what_is_no_place_for_a_file_is_refused_at_once(tmp_path: Path, name: str) -> None:
    (tmp_path / "old.npz").write_bytes(b"old")
    for write in (refuse_output, partial(write_atomically, data=b"")):
        with pytest.raises(OutputError):
            write(tmp_path / name, overwrite=False)
    assert (tmp_path / "old.npz").read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["old.npz"]


# Folders of tables.

NAMES = ("nodes.npy", "polygons.npy", "parts.npy", "scalars/1.npy")


def tables_of(folder: Path, *, old: bool) -> None:
    """Save a set of tables: the old has a table that the new lacks, and the new has one in a folder."""
    names = [*NAMES[:2], NAMES[2] if old else NAMES[3]]
    files = [(name, (b"old" if old else b"new") + name.encode()) for name in names]
    files.append(("tables.json", json.dumps(names).encode()))
    write_together(folder, files, others=NAMES[2:], overwrite=True)


def names_in(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if not path.is_dir())


def content_of(folder: Path) -> dict[str, bytes]:
    """The content of the tables of a folder, as our readers find them."""

    def read() -> dict[str, bytes]:
        assert table_exists(folder, "tables.json")
        names = json.loads(read_table(folder, "tables.json", bytes_of))
        return {name: read_table(folder, name, bytes_of) for name in names}

    return read_together(folder, "tables.json", read)


def bytes_of(path: Path) -> bytes:
    return read_bytes(path, 1000)


def test_tables_written_together_get_their_names_and_other_files_stay(tmp_path: Path) -> None:
    folder = tmp_path / "tables"
    tables_of(folder, old=True)
    (folder / "notes.txt").write_text("mine")
    (folder / "nodes.npy").chmod(0o600)
    tables_of(folder, old=False)
    assert names_in(folder) == ["nodes.npy", "notes.txt", "polygons.npy", "scalars/1.npy", "tables.json"]
    assert (folder / "nodes.npy").read_bytes() == b"newnodes.npy"
    assert (folder / "nodes.npy").stat().st_mode & 0o777 == 0o600
    tables_of(folder, old=True)
    assert names_in(folder) == ["nodes.npy", "notes.txt", "parts.npy", "polygons.npy", "tables.json"]
    assert not (folder / "scalars").exists()


def test_tables_are_not_overwritten_unless_that_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "polygons.csv").write_bytes(b"mine")
    with pytest.raises(OutputError, match="an output must be a new file"):
        write_together(tmp_path, [("nodes.csv", b""), ("polygons.csv", b"")], others=(), overwrite=False)
    assert names_in(tmp_path) == ["polygons.csv"]


def test_tables_that_cannot_be_written_leave_nothing(tmp_path: Path) -> None:
    def files() -> Iterator[tuple[str, bytes]]:
        yield "scalars/1.npy", b"one"
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(WriteError, match="must be written whole"):
        write_together(tmp_path / "new", files(), others=(), overwrite=True)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(OutputError, match=r"a mesh must have a folder to be in, .* cannot be made"):
        write_together(tmp_path / "none" / "out", [], others=(), overwrite=True)
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match=r"an output must have a place, and at .*file it cannot be made"):
        write_together(tmp_path / "file", [], others=(), overwrite=True)


def test_tables_whose_save_is_killed_at_any_step_are_the_old_or_the_new(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "fsync", lambda _: None)
    for old in (True, False):
        tables_of(tmp_path / str(old), old=old)
    kinds = [content_of(tmp_path / "True"), content_of(tmp_path / "False")]
    found = []
    for number in count():
        folder = tmp_path / f"killed {number}"
        tables_of(folder, old=True)
        with suppress(Killed), steps(number, killed) as done:
            tables_of(folder, old=False)
        found.append(kinds.index(content_of(folder)))
        # The next save names the tables that are left, and removes what is hidden.
        tables_of(folder, old=False)
        assert sorted(os.listdir(folder)) == ["nodes.npy", "polygons.npy", "scalars", "tables.json"]
        assert content_of(folder) == kinds[1]
        if len(done) < number:
            break
    assert found == sorted(found)
    assert 0 < sum(found) < len(found)


@pytest.mark.parametrize("suffix", ["csv", "npy"])
def test_tables_that_have_no_names_of_their_own_yet_are_found_in_every_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str
) -> None:
    kind = KINDS["CSV tables" if suffix == "csv" else "npy tables"]
    with monkeypatch.context() as patch:
        # As if the program were killed before.
        patch.setattr(writing, "_finish", lambda _: None)
        kind.save(tmp_path, 1)
    assert [*(tmp_path / "t").glob("[!.]*.*")] == []
    expected = kind.read(tmp_path)
    nodes, polygons = (f"t/{key}.{suffix}" for key in ("nodes", "polygons"))
    (tmp_path / "scene.toml").write_text(f'mesh = [{{nodes = "{nodes}", polygons = "{polygons}"}}]')
    for source in (tmp_path / "scene.toml", tmp_path / nodes):
        assert mesh_sum(read_scene(source).mesh) == expected
    assert kind_of(tmp_path / "t") == "mesh"
    for command in ("info", "validate"):
        assert CliRunner().invoke(autocolor, [command, str(tmp_path / "t")]).exit_code == 0


def test_tables_are_read_again_if_a_save_comes_while_they_are_opened(tmp_path: Path) -> None:
    tables_of(tmp_path, old=True)
    moments = iter(["between", "late", "never"])

    def opened() -> list[bytes]:
        moment = next(moments)
        nodes = read_table(tmp_path, "nodes.npy", bytes_of)
        if moment == "between":
            tables_of(tmp_path, old=False)
        polygons = read_table(tmp_path, "polygons.npy", bytes_of)
        if moment == "late":
            tables_of(tmp_path, old=True)
        return [nodes, polygons]

    assert read_together(tmp_path, "tables.json", opened) == [b"oldnodes.npy", b"oldpolygons.npy"]
    with pytest.raises(InputError, match="tables must stay while they are opened, but a program saves them"):
        read_together(tmp_path, "tables.json", lambda: tables_of(tmp_path, old=True))


def test_two_programs_do_not_save_tables_to_a_folder_at_once(tmp_path: Path) -> None:
    def files() -> Iterator[tuple[str, bytes]]:
        with pytest.raises(WriteError, match=f"another one saves to {tmp_path}; try again"):
            tables_of(tmp_path, old=False)
        yield "nodes.npy", b"one"

    write_together(tmp_path, files(), others=(), overwrite=True)
    assert (tmp_path / "nodes.npy").read_bytes() == b"one"
