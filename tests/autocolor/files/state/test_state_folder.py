from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autocolor import OutputError
from autocolor.files.state.state_folder import state_folder


@pytest.mark.parametrize(
    ("platform", "variables", "folder"),
    [
        ("linux", {}, "/home/ann/.local/state/autocolor"),
        ("linux", {"XDG_STATE_HOME": "/var/state"}, "/var/state/autocolor"),
        ("linux", {"XDG_STATE_HOME": "state"}, "/home/ann/.local/state/autocolor"),
        ("darwin", {}, "/home/ann/Library/Application Support/autocolor"),
        ("win32", {"LOCALAPPDATA": "/local", "XDG_STATE_HOME": "/var/state"}, "/local/autocolor"),
        ("win32", {}, "/home/ann/AppData/Local/autocolor"),
    ],
)
def test_each_system_has_its_place_for_state(
    monkeypatch: pytest.MonkeyPatch, platform: str, variables: dict[str, str], folder: str
) -> None:
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, value in {"HOME": "/home/ann", **variables}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys, "platform", platform)
    assert state_folder() == Path(folder)


def test_without_a_home_the_variable_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def home() -> Path:
        raise RuntimeError

    monkeypatch.delenv("XDG_STATE_HOME")
    monkeypatch.setattr(Path, "home", home)
    with pytest.raises(OutputError) as refusal:
        state_folder()
    assert str(refusal.value) == (
        "the state folder must be in a home folder, and there is none; set XDG_STATE_HOME"
    )
