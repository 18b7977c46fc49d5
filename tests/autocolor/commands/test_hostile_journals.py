"""No command rolls back a journal beside a store, because a journal can name any file to be deleted."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.shell_completion import BashComplete

from autocolor import InputError, Studio, WriteError, open_tables, write_scene
from autocolor.commands.autocolor import autocolor
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import Refused
from tests.autocolor.files.store.stores import contents, hostile_journal, small_scene, small_store

UPDATE = "'UPDATE lights SET intensity = 2'"


@pytest.fixture
def store(folder: Path) -> Path:
    """A store in the current folder, and a journal that names another file of the folder."""
    (folder / "named.txt").write_text("precious")
    path = small_store(folder)
    hostile_journal(path, folder / "named.txt")
    return path


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("info small.sqlite", 65),
        ("validate small.sqlite", 65),
        ("render small.sqlite -o out.png", 65),
        ("view small.sqlite", 65),
        ("show small.sqlite --to tcp://127.0.0.1:1", 65),
        ("tables small.sqlite", 65),
        ("tables small.sqlite --write --force", 65),
        ("convert small.sqlite out.obj", 65),
        ("convert small.sqlite out.db", 65),
        ("convert two.obj small.sqlite --force", 74),
        ("convert scene small.sqlite --force", 74),
        ("sql small.sqlite", 65),
        ("sql small.sqlite 'SELECT * FROM lights'", 65),
        (f"sql small.sqlite {UPDATE} --write", 65),
    ],
)
def test_a_command_refuses_the_store(refused: Refused, store: Path, line: str, code: int) -> None:
    assert refused(line, code).startswith("small.sqlite: the -journal beside the store")


@pytest.mark.parametrize(
    "line", ["render small.sqlite --light", "render small.sqlite --set", "recolor small.sqlite"]
)
def test_completion_leaves_the_store_alone(store: Path, line: str) -> None:
    shell = BashComplete(autocolor, {}, "autocolor", "_AUTOCOLOR_COMPLETE")
    before = contents(store.parent)
    assert shell.get_completions(line.split(), "") == []
    assert contents(store.parent) == before
    Path(f"{store}-journal").unlink()
    assert shell.get_completions(line.split(), "") != []


def test_a_studio_neither_opens_nor_saves_the_store(store: Path) -> None:
    before = contents(store.parent)
    studio = Studio(small_scene(), Ramtek9300())
    with pytest.raises(InputError, match="the -journal beside the store"):
        studio.open(store)
    with pytest.raises(WriteError, match="the -journal beside the store"):
        write_scene(store, studio.scene, overwrite=True)
    assert contents(store.parent) == before


@pytest.mark.parametrize("statement", ["UPDATE lights SET intensity = -1", "UPDATE polygons SET node1 = 9"])
def test_a_change_that_is_rolled_back_deletes_no_file(
    store: Path, monkeypatch: pytest.MonkeyPatch, statement: str
) -> None:
    monkeypatch.setattr("autocolor.files.store.connections.SECONDS_OF_WAITING", 0.05)
    hostile_journal(store, store.parent / "named.txt", has_header=False)
    before = contents(store.parent)
    with open_tables(store) as tables, pytest.raises(InputError, match="the -journal beside the store"):
        tables.change(statement)
    assert contents(store.parent) == before
