"""No command rolls back a journal beside a store, because a journal can name any file to be deleted."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.shell_completion import BashComplete

from autocolor.commands.autocolor import autocolor
from tests.autocolor.commands.conftest import Refused
from tests.autocolor.files.store.stores import contents, hostile_journal, small_store

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
        ("view small.sqlite", 65),
        ("convert small.sqlite out.obj", 65),
        ("convert two.obj small.sqlite --force", 65),
        ("sql small.sqlite", 65),
        (f"sql small.sqlite {UPDATE} --write", 65),
    ],
)
def test_a_command_refuses_the_store(refused: Refused, store: Path, line: str, code: int) -> None:
    assert refused(line, code).startswith("small.sqlite: its -journal names another file")


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
