"""What the commands share about outputs: refusing one before anything is computed for it, and writing it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from autocolor.errors import OutputError, UsageError

if TYPE_CHECKING:
    from ramtek_emu import Ramtek9300


def refuse_outputs(output: str | None, save: str | None, force: bool) -> None:
    """Refuse a picture (`-o`) or a picture file (`--save`) that cannot be made; None is no output.

    Raises UsageError for a name that says another format, OutputError for what exists or has no place.
    """
    if output is not None:
        _refuse(output, force)
        if Path(output).suffix.lower() not in ("", ".png"):
            raise UsageError(f"-o must be the name of a PNG, not {output!r}; end it in .png")
    if save is not None:
        _refuse(save, force)
        if Path(save).suffix.lower() != ".npz":
            raise UsageError(f"--save must be the name of a picture file, not {save!r}; end it in .npz")


def _refuse(path: str, force: bool) -> None:
    if not path:
        raise UsageError("an output must have a name, not an empty one; give it one")
    if path == "-":
        raise UsageError("an output must be a file, not stdout; give it a name")
    from autocolor.files.writing import refuse_output

    folder = Path(path).parent
    if not os.path.isdir(folder):
        raise OutputError(
            f"an output must have a folder to be in, not {folder}, which is none; make it or choose another"
        )
    if not os.access(folder, os.W_OK):
        raise OutputError(
            f"an output must have a folder that can be written, not {folder}; choose another place"
        )
    refuse_output(path, overwrite=force)


def write_png(path: str, display: Ramtek9300, force: bool) -> None:
    """Write what the display shows to a PNG file, wholly or not at all."""
    from autocolor.files.writing import write_atomically
    from ramtek_emu.png import png_bytes

    write_atomically(path, png_bytes(display.field()), overwrite=force)


def tell_written(*paths: str | None) -> None:
    """Say on stderr what was written."""
    for path in paths:
        if path is not None:
            click.echo(f"wrote {path}", err=True)
