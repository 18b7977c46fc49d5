"""A screen for the tests of the window: Xvfb's."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.virtual_screen import virtual_screen


@pytest.fixture(scope="module")
def screen(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A virtual screen of 1400 x 1100 pixels."""
    with virtual_screen(tmp_path_factory.mktemp("screen"), "1400x1100") as opened:
        yield opened.name


@pytest.fixture
def on_screen(screen: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of a screen that windows open on."""
    monkeypatch.setenv("DISPLAY", screen)
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/tmp")
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    return screen
