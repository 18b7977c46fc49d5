"""The figures of the paper, each made by a script of its own: `python -m scenes.figures` makes them all.

Paper: D. R. Warn, "Lighting Controls for Synthetic Images", Figures 4 to 10 and 13 to 15; two subjects of its
introduction: a machined part with its stress, and the curvature of a body; and what grew from its asides,
such as S that grows with the angle of incidence. Each script renders once, then relights or recolors for
every panel, and writes labeled pictures into `figures/`, or into the folder that it is given:
`python -m scenes.figure_04 elsewhere`. `python -m scenes.figures docs/figures --webp` makes all pictures of
docs/gallery.md.

Pictures have smooth edges: they are rendered at SMOOTH times their lines and elements, and averaged. Figures
5, 13 and 14 are screens, and show the words of the display as they are.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from unittest import mock

import numpy as np
import numpy.typing as npt
from PIL import Image

import autocolor
from autocolor.images import averaged, smoothed
from autocolor.screens.viewer import Viewer
from ramtek_emu import GMR_9300, Ramtek9300, instructions
from ramtek_emu.memory.cursors import Joystick
from ramtek_emu.png import png_bytes
from ramtek_emu.writing import write_atomically

SCENES = Path(__file__).parent
FIGURES = (
    "04", "05", "06", "07", "08", "09", "10", "13", "14", "15", "part", "curvature",
    "incidence", "half-spaces", "links", "following", "highlight", "normals",
)  # fmt: skip
CAPTION_LINES = 26

SMOOTH = 4
"""Lines and elements that are rendered for each of a figure. Chosen by looking at the edges of the coupe."""

Field = npt.NDArray[np.uint8]


def open_scene(name: str) -> autocolor.Studio:
    """A studio on one of the scenes beside this file."""
    return open_studio(read_scene(name))


def read_scene(name: str) -> autocolor.Scene:
    """One of the scenes beside this file."""
    return autocolor.read_scene(SCENES / name)


def open_studio(scene: autocolor.Scene, display: Ramtek9300 | None = None) -> autocolor.Studio:
    """A studio on a scene, which is rendered now, on a display of its own or the fine one that is given."""
    return autocolor.Studio(scene, display or fine_display())


def fine_display() -> Ramtek9300:
    """A display that has SMOOTH times the lines and elements of a panel."""
    lines, elements = SMOOTH * GMR_9300.lines, SMOOTH * GMR_9300.elements
    return Ramtek9300(dataclasses.replace(GMR_9300, name="fine", lines=lines, elements=elements))


@contextmanager
def open_viewer(name: str, screen: str) -> Iterator[tuple[Viewer, Ramtek9300]]:
    """One of the scenes on a screen, and its display; the user's recent colors are left out."""
    with tempfile.TemporaryDirectory() as state:
        homes = {home: state for home in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME")}
        with mock.patch.dict(os.environ, homes):
            display = Ramtek9300()
            viewer = Viewer(read_scene(name), display, Path(state))
            viewer.session.turn_to(screen)
            viewer.tell("")
            yield viewer, display


def click(viewer: Viewer, label: str, share: float = 0.25) -> None:
    """Click a widget that the viewer shows, at a share of its width, or of the height of an upright one."""
    widget = next(each for each in viewer.board.widgets() if each.label == label)
    left, top, right, bottom = widget.area
    across, up = (0.5, share) if bottom - top > right - left else (share, 0.5)
    click_at(viewer, round(left + across * (right - left)), round(bottom - up * (bottom - top)))


def click_at(viewer: Viewer, element: int, line: int) -> None:
    """Press ENTER at a pixel of the display, and wait until the page is complete."""
    point_at(viewer, element, line).press_enter()
    viewer.poll()
    while viewer.board.content.idle():
        viewer.on_tick()


def point_at(viewer: Viewer, element: int, line: int) -> Joystick:
    """Move the cursor of the display to a pixel; returns the joystick unit of the display."""
    assert isinstance(viewer.display, Ramtek9300)
    joystick = viewer.display.joystick
    joystick.move_to(element, line)
    viewer.poll()
    return joystick


def captioned(field: Field, text: str, size: int = 2) -> Field:
    """A field with a line of text below it, written by a display of its own; `size` 1 is for small panels."""
    lines, elements = CAPTION_LINES * size // 2, field.shape[1]
    strip = Ramtek9300(dataclasses.replace(GMR_9300, name="caption", lines=lines, elements=elements))
    strip.send(instructions.load_entries(0, [(24, 26, 30), (235, 235, 235)]))
    strip.send(instructions.write_text(text, 6 * size, 2 * size, 1, 0, size=size))
    return np.vstack([field, strip.field()])


def parser_of(module: str, description: str) -> argparse.ArgumentParser:
    """The command line of a script in this folder: where its pictures go, and in which files."""
    parser = argparse.ArgumentParser(prog=f"python -m scenes.{module}", description=description)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("figures"), help="default: %(default)s")
    parser.add_argument("--webp", action="store_true", help="write a figure as one lossless WebP file")
    return parser


def parser_of_figure(figure: str) -> argparse.ArgumentParser:
    """The command line of the script of one figure."""
    return parser_of(
        f"figure_{figure.replace('-', '_')}", f"Write figure {figure} and its panels as PNG files."
    )


class Sheet:
    """The panels of one figure: each is written alone, and all of them side by side at the end.

    With `--webp`, the panels are only written side by side.
    """

    def __init__(self, figure: str, options: argparse.Namespace | None = None) -> None:
        options = options or parser_of_figure(figure).parse_args()
        self.figure = figure
        self.folder: Path = options.folder
        self.webp: bool = options.webp
        self.panels: list[Field] = []

    def panel_of(self, shown: autocolor.Studio | Ramtek9300) -> Field:
        """A studio, or what its display shows, at the size of a panel, with smooth edges."""
        if isinstance(shown, autocolor.Studio):
            return smoothed(shown.display_image, SMOOTH)
        return averaged(shown.entries, shown.words, SMOOTH)

    def add(self, shown: autocolor.Studio | Field, caption: str, panel: str = "") -> None:
        """Write a panel with its caption: a studio, or a field as it is, such as the field of a screen."""
        field = shown if isinstance(shown, np.ndarray) else self.panel_of(shown)
        self.panels.append(captioned(field, caption))
        if not (panel and self.webp):
            self._write(self.panels[-1], f"figure-{self.figure}{f'-{panel}' if panel else ''}")

    def write(self, across: int) -> None:
        """Write all panels in rows of so many."""
        rows = [
            np.hstack(self.panels[first : first + across]) for first in range(0, len(self.panels), across)
        ]
        self._write(np.vstack(rows), f"figure-{self.figure}")

    def _write(self, field: Field, name: str) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.folder / f"{name}{'.webp' if self.webp else '.png'}"
        write_atomically(path, webp_bytes(field) if self.webp else png_bytes(field), overwrite=True)
        print(path)


def webp_bytes(field: Field) -> bytes:
    """A field as a lossless WebP file."""
    file = BytesIO()
    Image.fromarray(field).save(file, "WEBP", lossless=True, quality=100, method=6)
    return file.getvalue()


def main() -> None:
    """Make every figure."""
    parser_of("figures", f"Write the figures {', '.join(FIGURES)} as PNG files.").parse_args()
    for number in FIGURES:
        importlib.import_module(f"scenes.figure_{number.replace('-', '_')}").main()


if __name__ == "__main__":
    main()
