"""The state folder, its locks, and the lists of recent colors and files."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs
import pytest

from autocolor import OutputError
from autocolor.files.state import (
    COLORS,
    FILES,
    MOST_COLORS,
    MOST_FILES,
    lock_file,
    note_color,
    note_file,
    recent_colors,
    recent_files,
    state_folder,
)


def test_the_last_entries_are_first_and_there_once(state: Path) -> None:
    assert (recent_colors(), recent_files()) == ((), ())
    assert not state.exists()
    for number in (*range(13), 12, 5):
        note_color((number, 0, 0))
        note_file(f"/{number}")
    order = [5, *range(12, 5, -1), *range(4, -1, -1)]
    assert recent_colors() == tuple((number, 0, 0) for number in order[:MOST_COLORS])
    assert recent_files() == tuple(Path(f"/{number}") for number in order[:MOST_FILES])


@pytest.mark.parametrize(
    "data",
    [
        b"\xff\xfe",
        b'{"a": 1}',
        b"[" * 100_000,
        b'[1e999, [], "blue", "#12345", "#1234567", "#12345\xc3\xbc", "relative", "/a\\u0000b", ""]',
    ],
    ids=lambda data: repr(data[:9]),
)
def test_a_damaged_list_is_an_empty_one_and_heals(state: Path, data: bytes) -> None:
    state.mkdir(parents=True)
    for name in (COLORS, FILES):
        (state / name).write_bytes(data)
    assert (recent_colors(), recent_files()) == ((), ())
    note_color((16, 32, 48))
    note_file("/scene")
    assert (recent_colors(), recent_files()) == (((16, 32, 48),), (Path("/scene"),))


def test_a_list_that_cannot_be_written_is_no_error(state: Path) -> None:
    state.parent.mkdir(parents=True)
    state.write_text("a file where the folder should be", "utf-8")
    note_color((255, 0, 0))
    assert recent_colors() == ()
    state.unlink()
    note_color((255, 0, 0))
    assert state.stat().st_mode & 0o777 == 0o700


def test_without_a_home_there_are_no_lists_and_the_variable_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platformdirs, "user_state_dir", lambda *_, **__: "~/.local/state/autocolor")
    note_color((255, 0, 0))
    assert recent_colors() == ()
    with pytest.raises(OutputError, match="a home folder, and there is none; set XDG_STATE_HOME"):
        state_folder()


def test_a_lock_lasts_until_it_is_closed(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    for _ in range(2):
        descriptor = lock_file(path)
        assert descriptor is not None
        assert lock_file(path) is None
        os.close(descriptor)
