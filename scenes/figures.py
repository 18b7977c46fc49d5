"""The figures of the paper, each made by a script of its own: `python -m scenes.figures` makes them all.

Paper: D. R. Warn, "Lighting Controls for Synthetic Images", Figures 4, 6, 7, 8, 9, 10 and 15; two of what
its introduction tells of: a machined part with its stress, and the curvature of a body; and what grew from
what it says in passing, such as S that grows with the angle of incidence. Each script renders once, then
relights or recolors for every panel, and writes labeled pictures into `figures/`, or into the folder that it
is given: `python -m scenes.figure_04 elsewhere`.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
from pathlib import Path

import numpy as np
import numpy.typing as npt

import autocolor
from ramtek_emu import GMR_9300, Ramtek9300, instructions
from ramtek_emu.png import save_png

SCENES = Path(__file__).parent
FIGURES = (
    "04", "06", "07", "08", "09", "10", "15", "part", "curvature",
    "incidence", "half-spaces", "links", "following", "highlight", "normals",
)  # fmt: skip
CAPTION_LINES = 26

Field = npt.NDArray[np.uint8]


def open_scene(name: str) -> tuple[autocolor.Studio, Ramtek9300]:
    """A studio on one of the scenes beside this file, and its display."""
    return open_studio(read_scene(name))


def read_scene(name: str) -> autocolor.Scene:
    """One of the scenes beside this file."""
    return autocolor.read_scene(SCENES / name)


def open_studio(scene: autocolor.Scene) -> tuple[autocolor.Studio, Ramtek9300]:
    """A studio on a scene, which is rendered now, and its display."""
    display = Ramtek9300()
    return autocolor.Studio(scene, display), display


def captioned(field: Field, text: str) -> Field:
    """A field with a line of text below it, written by a display of its own."""
    strip = Ramtek9300(dataclasses.replace(GMR_9300, name="caption", lines=CAPTION_LINES))
    strip.send(instructions.load_entries(0, [(24, 26, 30), (235, 235, 235)]))
    strip.send(instructions.write_text(text, 12, 4, 1, 0, size=2))
    return np.vstack([field, strip.field()])


def parser_of(module: str, description: str) -> argparse.ArgumentParser:
    """The command line of a script in this folder: where its pictures go."""
    parser = argparse.ArgumentParser(prog=f"python -m scenes.{module}", description=description)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("figures"), help="default: %(default)s")
    return parser


def parser_of_figure(figure: str) -> argparse.ArgumentParser:
    """The command line of the script of one figure."""
    return parser_of(
        f"figure_{figure.replace('-', '_')}", f"Write figure {figure} and its panels as PNG files."
    )


class Sheet:
    """The panels of one figure: each is written alone, and all of them side by side at the end."""

    def __init__(self, figure: str, folder: Path | None = None) -> None:
        self.figure = figure
        self.folder = folder or parser_of_figure(figure).parse_args().folder
        self.panels: list[Field] = []

    def add(self, field: Field, caption: str, panel: str = "") -> None:
        """Write one panel with its caption."""
        self.panels.append(captioned(field, caption))
        self._write(self.panels[-1], f"figure-{self.figure}{f'-{panel}' if panel else ''}.png")

    def write(self, across: int) -> None:
        """Write all panels in rows of so many."""
        rows = [
            np.hstack(self.panels[first : first + across]) for first in range(0, len(self.panels), across)
        ]
        self._write(np.vstack(rows), f"figure-{self.figure}.png")

    def _write(self, field: Field, name: str) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        save_png(field, self.folder / name)
        print(self.folder / name)


def main() -> None:
    """Make every figure."""
    parser_of("figures", f"Write the figures {', '.join(FIGURES)} as PNG files.").parse_args()
    for number in FIGURES:
        importlib.import_module(f"scenes.figure_{number.replace('-', '_')}").main()


if __name__ == "__main__":
    main()
