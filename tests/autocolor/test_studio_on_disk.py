"""A studio and its files, which other programs may change: nothing is lost unasked."""

from __future__ import annotations

import os
import re
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import autocolor
from autocolor import (
    OutputError,
    Scene,
    Studio,
    UsageError,
    read_journal,
    read_picture,
    read_scene,
    render,
    scene_of,
    write_picture,
)
from autocolor.files import picture_file
from autocolor.files.array_file import array_file_bytes
from autocolor.files.stamps import stamp_of
from autocolor.files.store import store_file
from autocolor.files.store.connections import replacing
from autocolor.journal import places
from autocolor.journal.history import History
from autocolor.journal.places import Source, checksum_of
from ramtek_emu import Ramtek9300
from tests.autocolor.journal.random_steps import journal_of, summary
from tests.small import SMALL, car, cube, is_true_to_its_file, opened


def outside_toml(path: Path) -> None:
    """Another program edits a scene file."""
    text = re.sub("^angle = .*\n", "", path.read_text(), flags=re.MULTILINE)
    path.write_text(text.replace("[view]", "[view]\nangle = 7.0"))


def outside_row(path: Path) -> None:
    """Another program changes a row of a store."""
    with closing(sqlite3.connect(path)) as other, other:
        other.execute("UPDATE view SET angle = 7")


def outside_log(path: Path) -> None:
    """Another program changes a row of a store in WAL mode, and leaves it in the log."""
    with closing(sqlite3.connect(path)) as other, other:
        other.execute("PRAGMA journal_mode = WAL")
    OPEN.append(sqlite3.connect(path))
    with OPEN[-1]:
        OPEN[-1].execute("UPDATE view SET angle = 7")


def outside_mesh(path: Path) -> None:
    """Another program changes the mesh beside a scene file."""
    (mesh,) = (each for each in path.parent.iterdir() if each != path)
    autocolor.write_scene(path.parent.parent / "other", scene_of(cube(2.0)))
    (other,) = (each for each in (path.parent.parent / "other").iterdir() if each.suffix == mesh.suffix)
    os.replace(other, mesh)


def outside_picture(path: Path) -> None:
    """Another program writes a picture file."""
    scene = read_picture(path).scene.with_view(angle=7)
    write_picture(path, scene, render(scene, (32, 24)), overwrite=True)


OPEN: list[sqlite3.Connection] = []
OUTSIDE = {
    "a scene file": ("box/scene.toml", outside_toml),
    "a mesh": ("box/scene.toml", outside_mesh),
    "a store": ("box.sqlite", outside_row),
    "the log of a store": ("box.db", outside_log),
    "a picture": ("box.npz", outside_picture),
}


def write(path: Path, scene: Scene) -> None:
    """Write a file of any of these kinds."""
    if path.suffix == ".npz":
        write_picture(path, scene, render(scene, (32, 24)), overwrite=True)
    else:
        autocolor.write_scene(path, scene, overwrite=True)


def save(studio: Studio, path: Path) -> None:
    """Save to a file of any of these kinds, which may be overwritten."""
    (studio.save if path.suffix == ".npz" else studio.save_scene)(path, overwrite=True)


@pytest.fixture
def _closed() -> Iterator[None]:
    yield
    while OPEN:
        OPEN.pop().close()


@pytest.mark.usefixtures("_closed")
@pytest.mark.parametrize("has_saved", [False, True])
@pytest.mark.parametrize("what", OUTSIDE)
def test_a_change_of_another_program_is_never_overwritten_silently(
    tmp_path: Path, what: str, has_saved: bool
) -> None:
    name, change = OUTSIDE[what]
    path = tmp_path / name
    write(path, scene_of(cube()))
    studio, _ = opened()
    studio.open(path.parent if path.suffix == ".toml" else path)
    if has_saved:
        studio.view(angle=3)
        save(studio, path)
    change(path)
    theirs = read_scene(path)
    studio.view(angle=5)
    mine, before = studio.scene, stamp_of(path)
    with pytest.raises(OutputError, match=r"reopen\(\)"):
        save(studio, path)
    saved = studio.save_session(tmp_path)
    assert (saved.changed, stamp_of(path)) == ((path,), before)
    studio.undo()
    studio.open(path)
    assert checksum_of(studio.scene) == checksum_of(theirs)
    studio.undo()
    studio.redo()
    assert not studio.is_changed
    # A store is not replaced while another program has it open in WAL mode.
    if OPEN:
        OPEN.pop().close()
        studio.reopen()
    studio.edit(mine)
    save(studio, path)
    assert read_scene(path).view.angle == 5


def test_a_change_that_was_read_again_may_be_overwritten(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    path = tmp_path / "car" / "scene.toml"
    studio, _ = opened()
    studio.open(path)
    studio.light("key", on=False)
    outside_toml(path)
    assert studio.reopen()
    assert studio.scene.view.angle == 7
    studio.undo()
    assert studio.is_changed
    studio.save_scene(path, overwrite=True)
    assert not studio.is_changed
    assert not read_scene(path).lights["key"].on
    # A comment is no other scene, and the file may be saved to after it was read again.
    path.write_text(path.read_text() + "# mine\n")
    studio.light("key", on=True)
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(path, overwrite=True)
    studio.undo()
    assert not studio.reopen()
    studio.redo()
    studio.save_scene(path, overwrite=True)
    assert path.read_text().endswith("# mine\n")


@pytest.mark.skipif(os.name == "nt", reason="links need permissions there")
def test_a_file_is_known_by_its_links_and_a_link_to_another_file_is_a_change(tmp_path: Path) -> None:
    for name in ("one", "two"):
        autocolor.write_scene(tmp_path / name, car().replace(ambient=0.3 if name == "one" else 0.6))
    (tmp_path / "link").symlink_to("one")
    studio, _ = opened()
    studio.open(tmp_path / "link")
    outside_toml(tmp_path / "one" / "scene.toml")
    for name in ("link", "one"):
        with pytest.raises(OutputError, match="another program changed"):
            studio.save_scene(tmp_path / name, overwrite=True)
    studio.reopen()
    (tmp_path / "link").unlink()
    (tmp_path / "link").symlink_to("two")
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(tmp_path / "link", overwrite=True)
    assert read_scene(tmp_path / "two").ambient == 0.6


def test_a_change_while_the_save_waits_for_the_store_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "box.sqlite"
    autocolor.write_scene(path, scene_of(cube()))
    studio, _ = opened()
    studio.open(path)

    def waiting(store: Path, check: Callable[[], None]) -> object:
        outside_row(store)
        return replacing(store, check)

    monkeypatch.setattr(store_file, "replacing", waiting)
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(path, overwrite=True)
    assert read_scene(path).view.angle == 7


def test_a_scene_that_was_shown_when_its_file_was_left_for_another_is_unsaved(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    autocolor.write_scene(tmp_path / "box", BOX)
    studio, _ = opened()
    studio.open(tmp_path / "car")
    studio.recolor("body", blend=0.2)
    studio.save_session(tmp_path)
    assert not studio.history.left_unsaved
    studio.undo()
    studio.keep_variant("A")
    studio.open(tmp_path / "box")
    assert studio.history.left_unsaved == ("car",)
    assert studio.history.unsaved_variants == ("A",)


FILES = "a/scene.toml", "b.sqlite", "c.npz"
BOX = scene_of(cube(), name="box")

random_moves = st.lists(
    st.tuples(st.sampled_from(["edit", "edit", "open", "save", "write"]), st.sampled_from(FILES))
    | st.tuples(st.sampled_from(["undo", "undo", "redo", "session", "reopen", "keep", "show"]), st.none()),
    max_size=20,
)


def take(studio: Studio, kind: str, path: Path, number: int) -> None:
    """Take a random move; `number` makes each edit another one."""
    scene = studio.scene.replace(ambient=number % 4 / 8)
    if kind == "edit":
        studio.edit(scene)
    elif kind == "open":
        studio.open(path)
    elif kind == "save":
        save(studio, path)
    elif kind == "write":
        # Another program writes the file.
        write(path, scene)
    elif kind == "session":
        studio.save_session(path.parent / "work")
    elif kind == "keep":
        studio.keep_variant()
    elif kind == "show":
        studio.show_variant("A")
    else:
        getattr(studio, kind)()


@given(random_moves)
@example(
    [("edit", None), ("reopen", None), ("edit", None), ("undo", None), ("edit", None), ("save", FILES[0])]
)
@example([("edit", None), ("reopen", None), *[("edit", None)] * 2, ("session", None), *[("undo", None)] * 4])
def test_a_scene_that_counts_as_saved_is_in_its_file_also_after_recovery(
    moves: list[tuple[str, str | None]],
) -> None:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "work").mkdir()
        autocolor.write_scene(folder / FILES[0], BOX)
        autocolor.write_scene(folder / FILES[1], BOX)
        opened(BOX)[0].save(folder / FILES[2])
        source = Source(str(folder / FILES[0]))
        studio = Studio(History(*places.opened(source)), Ramtek9300(SMALL))
        files = studio.history.on_disk
        for number, (kind, file) in enumerate(moves):
            path = folder / (file or "none")
            before, is_there = stamp_of(path), files[str(path)] is not None
            was_changed = files.was_changed(str(path))
            try:
                take(studio, kind, path, number)
            except UsageError:
                pass
            except OutputError:
                assert was_changed
            else:
                assert not (kind == "save" and was_changed)
            if is_there and was_changed and kind != "write":
                assert stamp_of(path) == before
            main = next(iter(studio.history.files))
            assert files.was_changed(main) or is_true_to_its_file(studio), (number, kind, file)
        if not any(files.was_changed(path) for path in files._real_paths):
            session = folder / "session"
            assert summary(read_journal(journal_of(studio.history, session)).history) == summary(
                studio.history
            )


def test_a_change_that_comes_while_a_file_is_read_again_is_not_overwritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "car" / "scene.toml"
    autocolor.write_scene(path.parent, car())
    studio, _ = opened()
    studio.open(path)
    path.write_text(f"# theirs\n{path.read_text()}")
    read = places.opened

    def interrupted(*arguments: Any, **keywords: Any) -> Any:
        again = read(*arguments, **keywords)
        outside_toml(path)
        return again

    monkeypatch.setattr("autocolor.studio.opened", interrupted)
    assert not studio.reopen()
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(path, overwrite=True)


@pytest.mark.parametrize("is_session", [False, True])
def test_a_picture_that_changes_while_it_is_made_is_not_overwritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_session: bool
) -> None:
    studio, _ = opened()
    path = studio.save_session(tmp_path).picture
    studio.light("key", on=False)

    def interrupted(*arguments: Any) -> bytes:
        path.write_bytes(b"theirs")
        return array_file_bytes(*arguments)

    monkeypatch.setattr(picture_file, "array_file_bytes", interrupted)
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_session(tmp_path) if is_session else studio.save(path, overwrite=True)
    assert path.read_bytes() == b"theirs"


def test_a_mesh_is_named_by_the_file_that_it_was_read_from(tmp_path: Path) -> None:
    for name in ("a", "b"):
        autocolor.write_scene(tmp_path / name, car())
    (mesh,) = (path for path in (tmp_path / "b").iterdir() if path.suffix != ".toml")
    mesh.rename(mesh.with_stem("other"))
    scene = tmp_path / "b" / "scene.toml"
    scene.write_text(scene.read_text().replace(mesh.name, f"other{mesh.suffix}"))
    studio, _ = opened()
    studio.open(tmp_path / "a")
    studio.open(tmp_path / "b")
    studio.save_scene(tmp_path / "b" / "variant.toml")
    assert sorted(os.listdir(tmp_path / "b")) == [f"other{mesh.suffix}", "scene.toml", "variant.toml"]


def test_to_open_the_file_of_the_present_look_again_is_no_step_and_brings_its_view(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    studio = Studio(scene_of(cube()), Ramtek9300(SMALL))
    mesh = "car/mesh.tables"
    for path, steps in (("car", 1), ("car", 1), ("car/scene.toml", 1), ("car", 3), (mesh, 4), (mesh, 4)):
        studio.open(tmp_path / path)
        assert studio.scene.view.angle == 0
        assert len(studio.history.to_undo) == steps
        studio.edit(studio.scene.with_view(angle=3))
        if path == "car/scene.toml":
            studio.edit(studio.scene.with_light("key", intensity=0.3))
