"""Output files of the commands: checks of their paths before any work, writing, and its progress."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.checks import shown
from autocolor.errors import OutputError, UsageError
from ramtek_emu.command_line import tell
from ramtek_emu.writing import same_outputs

if TYPE_CHECKING:
    from click._termui_impl import ProgressBar

KINDS: Final = {
    "-o": ("a PNG", ".png"),
    "--save": ("a picture file", ".npz"),
    "--layers": ("an OpenEXR file", ".exr"),
    "--words": ("a PNG", ".png"),
    "--indexed": ("a PNG", ".png"),
}
"""The kind of an output and the suffix of its name, by option."""


def refuse_outputs(outputs: Mapping[str, str | None], force: bool) -> None:
    """Check the paths of outputs, by option of KINDS; None is skipped.

    Raises UsageError for a wrong suffix. Raises OutputError if the file exists and `force` is false, or if it
    cannot be created.
    """
    from autocolor.files.writing import refuse_output

    given = {option: path for option, path in outputs.items() if path is not None}
    for option, path in given.items():
        if path == "-":
            raise UsageError("an output must be a file, not stdout; name a file")
        refuse_output(path, overwrite=force)
        folder = Path(path).parent
        if not os.access(folder, os.W_OK):
            raise OutputError(f"an output must be in a writable folder, not {folder}; choose another")
        kind, suffix = KINDS[option]
        if Path(path).suffix.lower() != suffix:
            raise UsageError(f"{option} must be the name of {kind}, not {shown(path)}; end it in {suffix}")
    if same := same_outputs([*given.values()]):
        one, other = same
        raise UsageError(
            f"two outputs must be two files, not {one} and {other}, which are the same; rename one"
        )


def tell_written(*paths: str | None) -> None:
    """Print on stderr that these files were written; None is skipped."""
    for path in paths:
        if path is not None:
            tell(f"wrote {path}")


def progress(count: int) -> ProgressBar[int]:
    """A progress bar of so many steps with the time left, on stderr; hidden if stderr is no terminal."""
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    return click.progressbar(length=count, file=sys.stderr, show_pos=True, hidden=not is_terminal)
