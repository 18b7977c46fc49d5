"""No command rolls back a journal beside a store, because a journal can name any file to be deleted."""

from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import InputError, Studio, WriteError, open_tables, write_scene
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import Run
from tests.autocolor.commands.test_completion import completed
from tests.autocolor.files.store.stores import contents, hostile_journal, small_scene, small_store

WORDS = {"SELECT": "SELECT * FROM lights", "UPDATE": "UPDATE lights SET intensity = 2"}


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
        ("sql small.sqlite SELECT", 65),
        ("sql small.sqlite UPDATE --write", 65),
    ],
)
def test_a_command_refuses_the_store(run: Run, store: Path, line: str, code: int) -> None:
    before = contents(store.parent)
    ran = run(*(WORDS.get(word, word) for word in line.split()))
    assert contents(store.parent) == before
    assert (ran.code, ran.out) == (code, "")
    message = ran.err.removeprefix("reading small.sqlite\n")
    assert message.startswith("autocolor: small.sqlite: the -journal beside the store is from a change that")
    assert message.endswith("otherwise move the journal away\n")
    assert message.count("\n") == 1


@pytest.mark.parametrize(
    "line", ["render small.sqlite --light", "render small.sqlite --set", "recolor small.sqlite"]
)
def test_completion_leaves_the_store_alone(store: Path, line: str) -> None:
    before = contents(store.parent)
    assert completed(*line.split(), "") == []
    assert contents(store.parent) == before
    Path(f"{store}-journal").unlink()
    assert completed(*line.split(), "") != []


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
