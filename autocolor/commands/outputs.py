"""Output files of the commands: checks of their paths before any work, writing, and its progress."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.checks import shown
from autocolor.errors import OutputError, UsageError
from ramtek_emu.command_line import tell
from ramtek_emu.writing import same_outputs

if TYPE_CHECKING:
    from autocolor.lighting.picture import Picture
    from autocolor.scene.scene import Scene

OTHERS: Final = {
    "--layers": (".exr", "an OpenEXR file"),
    "--words": (".png", "a PNG"),
    "--indexed": (".png", "a PNG"),
}
"""The suffix and the kind of the other outputs, by option."""


def refuse_outputs(
    output: str | None, save: str | None, force: bool, others: Mapping[str, str | None] | None = None
) -> None:
    """Check the paths of a PNG (`-o`), a picture file (`--save`) and others by option, unless they are None.

    Raises UsageError for a wrong suffix. Raises OutputError if the file exists and `force` is false, or if it
    cannot be created.
    """
    given = {option: path for option, path in (others or {}).items() if path is not None}
    if output is not None:
        _refuse(output, force)
        if Path(output).suffix.lower() not in ("", ".png"):
            raise UsageError(f"-o must be the name of a PNG, not {shown(output)}; end it in .png")
    if save is not None:
        _refuse(save, force)
        if Path(save).suffix.lower() != ".npz":
            raise UsageError(f"--save must be the name of a picture file, not {shown(save)}; end it in .npz")
    for option, path in given.items():
        _refuse(path, force)
        suffix, kind = OTHERS[option]
        if Path(path).suffix.lower() != suffix:
            raise UsageError(f"{option} must be the name of {kind}, not {shown(path)}; end it in {suffix}")
    if same := same_outputs([path for path in (output, save, *given.values()) if path is not None]):
        one, other = same
        raise UsageError(
            f"two outputs must be two files, not {one} and {other}, which are the same; rename one"
        )


def _refuse(path: str, force: bool) -> None:
    if not path:
        raise UsageError("an output must have a name, not an empty name; name a file")
    if path == "-":
        raise UsageError("an output must be a file, not stdout; name a file")
    from autocolor.files.writing import refuse_output

    folder = Path(path).parent
    if not os.path.isdir(folder):
        raise OutputError(
            f"an output must be in an existing folder, not {folder}; create it or choose another"
        )
    refuse_output(path, overwrite=force)
    if not os.access(folder, os.W_OK):
        raise OutputError(f"an output must be in a writable folder, not {folder}; choose another")


def write_image(path: str, scene: Scene, picture: Picture, force: bool) -> None:
    """Write a picture in the colors of a scene to a PNG file of any name, atomically; see `save_image`."""
    from autocolor.files.writing import write_atomically
    from autocolor.images import display_image, smoothed
    from ramtek_emu.png import png_bytes

    colors = smoothed(display_image(scene, picture), picture.smooth)
    write_atomically(path, png_bytes(colors), overwrite=force)


def tell_written(*paths: str | None) -> None:
    """Print on stderr that these files were written; None is skipped."""
    for path in paths:
        if path is not None:
            tell(f"wrote {path}")


@contextmanager
def progress(count: int) -> Iterator[Callable[[], None]]:
    """A progress bar with the time left on stderr, if stderr is a terminal.

    Call the yielded function after each step. The bar ends with the last step, so that messages have lines of
    their own.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield lambda: None
        return
    with ExitStack() as stack:
        bar = stack.enter_context(click.progressbar(length=count, file=sys.stderr, show_pos=True))

        def step() -> None:
            bar.update(1)
            if bar.finished:
                stack.close()

        yield step
