"""A screen for the tests of the window: Xvfb's."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator

import pytest


@pytest.fixture(scope="module")
def screen() -> Iterator[str]:
    """A virtual screen of 1400 x 1100 pixels."""
    if shutil.which("Xvfb") is None:
        pytest.skip("Xvfb is not installed; the window cannot be tried without a screen")
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1400x1100x24", "-nolisten", "tcp"],
        pass_fds=[write_end],
        stderr=subprocess.DEVNULL,
    )
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        number = pipe.readline().strip()
    if not number:
        server.wait()
        pytest.skip("Xvfb does not start here; the window cannot be tried without a screen")
    yield f":{number}"
    server.terminate()
    server.wait()


@pytest.fixture
def on_screen(screen: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of a screen that windows open on."""
    monkeypatch.setenv("DISPLAY", screen)
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/tmp")
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    return screen
