"""The folder in which a program keeps what must outlast it, such as journals, on each system."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from autocolor.errors import OutputError


def state_folder() -> Path:
    """The folder for the state of `autocolor`, which need not exist. Raises OutputError if there is no home.

    It is in `XDG_STATE_HOME`, or `~/.local/state` without it; on Windows in `LOCALAPPDATA`, and on macOS in
    `~/Library/Application Support`.
    """
    if sys.platform == "win32":
        named, usual = os.environ.get("LOCALAPPDATA", ""), ("AppData", "Local")
    else:
        # The standard says to ignore a path that is not absolute.
        named = os.environ.get("XDG_STATE_HOME", "")
        usual = ("Library", "Application Support") if sys.platform == "darwin" else (".local", "state")
    if os.path.isabs(named):
        return Path(named, "autocolor")
    try:
        return Path.home().joinpath(*usual, "autocolor")
    except RuntimeError:
        raise OutputError(
            "the state folder must be in a home folder, and there is none; set XDG_STATE_HOME"
        ) from None
