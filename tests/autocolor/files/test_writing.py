from __future__ import annotations

import errno
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from itertools import count
from pathlib import Path

import pytest
from click.testing import CliRunner

from autocolor import read_scene
from autocolor.commands.autocolor import autocolor
from autocolor.errors import AutocolorError, InputError, OutputError, WriteError
from autocolor.files import reading
from autocolor.files.formats import read_mesh
from autocolor.files.opening import kind_of
from autocolor.files.reading import COMMITTED, NAMES, TableFiles, read_together
from autocolor.files.writing import refuse_output, write_atomically, write_together
from ramtek_emu import writing
from tests.kills import KINDS, Killed, killed, mesh_sum, steps


def test_files_are_written_whole_and_overwritten_only_if_asked(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    write_atomically(path, b"old", overwrite=False)
    with pytest.raises(OutputError) as caught:
        write_atomically(path, b"new", overwrite=False)
    assert str(caught.value) == (
        f"an output must be a new file, not {path}, which exists; choose another name, or overwrite it"
        " with --force (overwrite=True in Python)"
    )
    assert path.read_bytes() == b"old"
    write_atomically(path, b"new", overwrite=True)
    assert path.read_bytes() == b"new"
    assert os.listdir(tmp_path) == ["a.npz"]


@pytest.mark.parametrize("name", ["none/a.npz", "", "a\0b", "a" * 5000])
def test_what_is_no_place_for_a_file_is_refused_at_once(tmp_path: Path, name: str) -> None:
    for write in (refuse_output, partial(write_atomically, data=b"")):
        with pytest.raises(OutputError):
            write(tmp_path / name, overwrite=True)
    assert os.listdir(tmp_path) == []


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


# Folders of tables.


def tables_of(folder: Path, *, old: bool) -> None:
    """Save a set of tables: the old has a table that the new lacks, and the new has one in a folder."""
    names = ["nodes.npy", "polygons.npy", "parts.npy" if old else "scalars/1.npy"]
    files = [(name, [b"old" if old else b"new", name.encode()]) for name in names]
    write_together(folder, files, others=["parts.npy", "scalars/1.npy"], overwrite=True)


def names_in(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def test_tables_written_together_get_their_names_and_other_files_stay(tmp_path: Path) -> None:
    folder = tmp_path / "tables"
    tables_of(folder, old=True)
    (folder / "notes.txt").write_text("mine")
    tables_of(folder, old=False)
    assert names_in(tmp_path / "tables") == ["nodes.npy", "notes.txt", "polygons.npy", "scalars/1.npy"]
    assert (folder / "nodes.npy").read_bytes() == b"newnodes.npy"


def test_tables_are_not_overwritten_unless_that_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "polygons.npy").write_bytes(b"mine")
    with pytest.raises(OutputError, match="an output must be a new file"):
        write_together(tmp_path, [("nodes.npy", [b""]), ("polygons.npy", [b""])], others=(), overwrite=False)
    assert names_in(tmp_path) == ["polygons.npy"]
    assert (tmp_path / "polygons.npy").read_bytes() == b"mine"


def test_tables_that_cannot_be_written_leave_nothing(tmp_path: Path) -> None:
    def pieces() -> Iterator[bytes]:
        yield b"one"
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(WriteError, match="must be written whole"):
        write_together(tmp_path / "new", [("nodes.npy", pieces())], others=(), overwrite=True)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    for folder, sentence in (
        (tmp_path / "none" / "out", r"must be in an existing folder, not .*none; create it"),
        (tmp_path / "file", "must be a folder, not the file"),
        (tmp_path / ("x" * 300), r"a mesh must have a folder to be in, .* cannot be made"),
    ):
        with pytest.raises(OutputError, match=sentence):
            write_together(folder, [], others=(), overwrite=True)


def content_of(folder: Path) -> dict[str, bytes]:
    """The content of the tables of a folder, as our readers find them."""
    names = ("nodes.npy", "polygons.npy", "parts.npy", "scalars/1.npy")

    def read(files: TableFiles) -> dict[str, bytes]:
        return {name: files.path(folder, name).read_bytes() for name in names if files.has(folder, name)}

    return read_together(read)


@pytest.mark.parametrize("has_old", [True, False])
def test_tables_whose_save_is_killed_at_any_step_are_the_old_or_the_new(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, has_old: bool
) -> None:
    monkeypatch.setattr(os, "fsync", lambda _: None)
    for old in (True, False):
        tables_of(tmp_path / str(old), old=old)
    kinds = [content_of(tmp_path / "True") if has_old else {}, content_of(tmp_path / "False")]
    found = []
    for number in count():
        folder = tmp_path / f"killed {number}"
        if has_old:
            tables_of(folder, old=True)
        with suppress(Killed), steps(number, killed) as done:
            tables_of(folder, old=False)
        found.append(kinds.index(content_of(folder)))
        # The next save moves the tables that are left, and removes temporary files.
        writing._SWEPT.clear()
        tables_of(folder, old=False)
        assert names_in(folder) == names_in(tmp_path / "False")
        assert content_of(folder) == kinds[1]
        if len(done) < number:
            break
    assert found == sorted(found)
    assert 0 < sum(found) < len(found)


def test_tables_that_have_no_names_of_their_own_yet_are_found_in_every_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, suffix in (("CSV tables", "csv"), ("npy tables", "npy")):
        kind, folder = KINDS[name], tmp_path / suffix
        folder.mkdir()
        with monkeypatch.context() as patch, suppress(Killed):
            patch.setattr(os, "replace", lambda *_: killed())
            kind.save(folder, 1)
        assert os.listdir(folder / "t") == [COMMITTED, *(["scalars"] if suffix == "npy" else [])]
        expected = kind.read(folder)
        nodes, polygons = (f"t/{key}.{suffix}" for key in ("nodes", "polygons"))
        (folder / "scene.toml").write_text(f'mesh = [{{nodes = "{nodes}", polygons = "{polygons}"}}]')
        for source in (folder / "scene.toml", folder / nodes):
            assert mesh_sum(read_scene(source).mesh) == expected
        assert kind_of(folder / "t") == "mesh"
        for command in (["info"], ["validate"], ["convert", str(folder / "out.ply")]):
            arguments = [command[0], str(folder / "t"), *command[1:]]
            assert CliRunner().invoke(autocolor, arguments).exit_code == 0
        assert os.listdir(folder / "t")[0] == COMMITTED


def test_tables_are_read_again_if_a_save_comes_while_they_are_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "SECONDS_BETWEEN_TRIES", 0)
    for old in (True, False):
        tables_of(tmp_path / str(old), old=old)
    folder = tmp_path / "True"
    moments = iter(["between", "late", "never"])

    def opened(files: TableFiles) -> list[bytes]:
        moment = next(moments)
        nodes = files.path(folder, "nodes.npy").read_bytes()
        if moment == "between":
            tables_of(folder, old=False)
        polygons = files.path(folder, "polygons.npy").read_bytes()
        if moment == "late":
            tables_of(folder, old=True)
        return [nodes, polygons]

    assert read_together(opened) == [b"oldnodes.npy", b"oldpolygons.npy"]

    def always(files: TableFiles) -> bool:
        has = files.has(folder, "nodes.npy")
        tables_of(folder, old=True)
        return has

    with pytest.raises(InputError, match="tables must stay as they are while they are opened"):
        read_together(always)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"[]",
        b'{"files": ["../x.csv"], "absent": []}',
        b'{"files": ["nodes.csv"], "absent": ["scene.toml"]}',
    ],
)
def test_a_set_of_tables_that_we_did_not_write_is_refused(tmp_path: Path, content: bytes) -> None:
    kind = KINDS["CSV tables"]
    kind.save(tmp_path, 0)
    committed = tmp_path / "t" / COMMITTED
    committed.mkdir()
    (committed / NAMES).write_bytes(content)
    (tmp_path / "t" / "scene.toml").touch()
    files = {key: tmp_path / "t" / f"{key}.csv" for key in ("nodes", "polygons")}
    with pytest.raises(InputError, match="it must be a file that autocolor wrote"):
        read_mesh(files)
    with pytest.raises(InputError, match="it must be a file that autocolor wrote"):
        kind.save(tmp_path, 1)
    assert (tmp_path / "t" / "scene.toml").exists()


def test_links_in_a_set_of_tables_are_not_followed(tmp_path: Path) -> None:
    kind = KINDS["CSV tables"]
    kind.save(tmp_path, 0)
    before = kind.read(tmp_path)
    committed = tmp_path / "t" / COMMITTED
    committed.mkdir()
    (committed / "nodes.csv").symlink_to(tmp_path / "elsewhere")
    (committed / NAMES).write_text(json.dumps({"files": ["nodes.csv"], "absent": []}))
    assert kind.read(tmp_path) == before
    shutil.rmtree(committed)
    kind.save(tmp_path / "t", 1)
    committed.symlink_to(tmp_path / "t" / "t")
    (tmp_path / "t" / "t" / NAMES).write_text(json.dumps({"files": ["nodes.csv"], "absent": []}))
    with pytest.raises(InputError, match="it is a link"):
        kind.read(tmp_path)


def test_scalars_are_not_written_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "t").mkdir()
    (tmp_path / "t" / "scalars").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(OutputError, match="scalars: it must be a folder, not a link"):
        KINDS["npy tables"].save(tmp_path, 1)
    assert os.listdir(tmp_path / "elsewhere") == []
    assert os.listdir(tmp_path / "t") == ["scalars"]


def test_tables_keep_their_permissions(tmp_path: Path) -> None:
    for number in (0, 1):
        KINDS["npy tables"].save(tmp_path, number)
        (tmp_path / "t" / "nodes.npy").chmod(0o600)
    assert (tmp_path / "t" / "nodes.npy").stat().st_mode & 0o777 == 0o600


def test_tables_that_are_left_replace_no_new_file_unless_that_is_allowed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch, suppress(Killed):
        patch.setattr(os, "replace", lambda *_: killed())
        KINDS["CSV tables"].save(tmp_path, 1)
    (tmp_path / "t" / "nodes.csv").write_text("mine")
    with pytest.raises(OutputError, match="must be a new file"):
        write_together(tmp_path / "t", [("nodes.csv", [b"new"])], others=(), overwrite=False)
    assert (tmp_path / "t" / "nodes.csv").read_text() == "mine"


def test_a_folder_of_the_name_of_a_save_that_holds_other_files_is_named(tmp_path: Path) -> None:
    (tmp_path / COMMITTED).mkdir()
    (tmp_path / COMMITTED / "other").touch()
    with pytest.raises(WriteError, match=rf"{COMMITTED} could not be"):
        write_together(tmp_path, [("nodes.csv", [b"new"])], others=(), overwrite=True)
