"""The pictures of display.md, inspect.md, paper.md, elsewhere.md and emulators.md.

`python -m docs.guides.pictures_of_displays` writes them. As in `pictures`, each function returns the picture
that is named after it. The display draws the pictures of display.md from its listings and examples.
The picture of emulators.md needs SIMH.
"""

from __future__ import annotations

import doctest
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from PIL import Image

import autocolor
from docs.generate.blocks import blocks_of
from docs.generate.commands import ROOT
from docs.guides.pictures import GUIDES, write
from ramtek_emu import Ramtek9300
from ramtek_emu.inspection.inspector import Inspector
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.session import inspection_of, is_busy, tick
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.monitor.input_queue import Key, Pointer
from scenes.figures import Field, captioned, click, open_viewer, point_at


@cache
def listings() -> dict[str, str]:
    """The listings of display.md, by the names of their files: `; areas.txt` is the first line of "areas"."""
    blocks = blocks_of((GUIDES / "display.md").read_text("utf-8"))
    return {
        block.text[2:].partition(".txt")[0]: block.text for block in blocks if block.text.startswith("; ")
    }


@cache
def names_after(guide: str) -> dict[str, Any]:
    """The names that the examples of a guide leave, such as `display`."""
    blocks = blocks_of((GUIDES / f"{guide}.md").read_text("utf-8"))
    text = "\n".join(block.text for block in blocks if block.language == "pycon")
    examples = doctest.DocTestParser().get_doctest(text, {}, guide, None, None)
    doctest.DocTestRunner().run(examples, clear_globs=False)
    return examples.globs


def upper_half(name: str) -> Field:
    """The upper half of the field that a listing leaves on the display that is switched on."""
    display = Ramtek9300("family")
    lines = [line for each in ("colors", name) for line in listings()[each].splitlines()]
    display.send(np.frombuffer(b"".join(assemble(lines)), "<u2"))
    return display.field()[:240]


def display_areas() -> Field:
    """Windows, planes and the write window."""
    return upper_half("areas")


def display_lines() -> Field:
    """Linked and unlinked lines, points, textures."""
    return upper_half("lines")


def display_curves() -> Field:
    """Circles, filled areas, conics."""
    return upper_half("curves")


def display_text() -> Field:
    """Text, and characters that were loaded."""
    return upper_half("text")


def display_images() -> Field:
    """Images, rasters, pixels and copies."""
    return upper_half("images")


def display_cursors() -> Field:
    """Two cursors over a box."""
    return upper_half("cursors")


def display_ball() -> Field:
    """The ball of display.md in its two colors."""
    names = names_after("display")
    return beside(names["red"][::2, ::2], names["blue"][::2, ::2])


def display_stripes() -> Field:
    """The field of display.md that is drawn with one entry."""
    field: Field = names_after("display")["stripes"]
    return field[::2, ::2]


def beside(*fields: Field, gap: int = 8) -> Field:
    """Fields of one height, side by side with white gaps."""
    white = np.full((len(fields[0]), gap, 3), 255, np.uint8)
    parts = [part for field in fields for part in (white, field)][1:]
    return np.hstack(parts)


def panel(scene: autocolor.Scene, caption: str, size: tuple[int, int] = (200, 150)) -> Field:
    """A small picture of a scene with smooth edges, and a caption below it."""
    return captioned(autocolor.image(scene, size=size, smooth=3), caption, size=1)


def paper_terms() -> Field:
    """The coupe by diffuse light, by specular light, and by both."""
    car = autocolor.demo().replace(exposure={"object": (0, 1.05)})
    matte, mirrors = car.replace(ambient=0), car.replace(ambient=0)
    for surface in car.surfaces:
        matte = matte.with_surface(surface.name, specular=0.0)
        mirrors = mirrors.with_surface(surface.name, diffuse=0.0)
    return beside(
        panel(matte, "intensity D cos(I)"),
        panel(mirrors, "intensity S cos^N(E)"),
        panel(car, "their sum, with the ambient"),
    )


def paper_1983() -> Field:
    """The coupe with what the paper describes, and as its scene file says."""
    car = autocolor.demo()
    before = autocolor.image(car.as_in_1983(), size=(300, 225), smooth=1)
    return beside(captioned(before, "scene.as_in_1983()", 1), panel(car, "the scene file", (300, 225)))


def paper_controls() -> Field:
    """The wall of paper.md under one lamp with several controls."""
    wall = names_after("paper")["wall"].replace(exposure={"object": (0, 1.5)})
    wall = wall.with_view(field_of_view=28)
    flap = {"z": {"minimum": -0.1, "maximum": 0.5}}
    every = {"concentration": 10, "cone_angle": 20, "flaps": flap}
    changes: tuple[tuple[str, dict[str, Any]], ...] = (
        ("point source, C = 0", {}),
        ("C = 10", {"concentration": 10}),
        ("C = 40", {"concentration": 40}),
        ("Z flaps at -0.1 and 0.5", {"flaps": flap}),
        ("cone of 20 degrees", {"cone_angle": 20}),
        ("all of them", every),
    )
    panels = [panel(wall.with_light("lamp", **change), text) for text, change in changes]
    return np.vstack([beside(*panels[:3]), beside(*panels[3:])])


def paper_words() -> Field:
    """The words of the coupe as grays, and their colors by the table."""
    display = Ramtek9300()
    autocolor.Studio(autocolor.demo(), display)
    grays = np.repeat((display.words[::2, ::2, np.newaxis] // 4).astype(np.uint8), 3, axis=2)
    return beside(
        captioned(grays, "words, 0 black to 1023 white", 1), captioned(display.field()[::2, ::2], "colors", 1)
    )


def paper_blends() -> Field:
    """The entries of the coupe's body in three blends, above the picture with them."""
    parts = []
    for blend in (1.0, 0.5, 0.0):
        car = autocolor.demo().with_paint("body", object_color="#8c1a22", light_color="#f0e8d8", blend=blend)
        studio = autocolor.Studio(car, Ramtek9300())
        entries = studio.display_image.entries_of("body")
        bar = entries[np.linspace(0, len(entries) - 1, 200).round().astype(int)]
        parts.append(np.vstack([np.tile(bar, (24, 1, 1)), panel(car, f"blend {blend:g}")]))
    return beside(*parts)


def elsewhere_lights() -> Field:
    """The studio on a display, with the menu that the pointer brings at the right edge."""
    with open_viewer("coupe", "lights") as (viewer, display):
        click(viewer, " 1 key")
        point_at(viewer, 632, 200)
        return display.field()


def simulated(folder: Path) -> str:
    """Run the simulator of emulators.md in a folder, which gets lines.png; returns what it prints."""
    blocks = blocks_of((GUIDES / "emulators.md").read_text("utf-8"))
    (commands,) = (block.text for block in blocks if block.language == "sh")
    shutil.copy(ROOT / "examples" / "lines.ini", folder)
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    with subprocess.Popen(
        ["sh", "-c", commands],
        cwd=folder,
        env={**os.environ, "PATH": path},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as shell:
        try:
            return shell.communicate(timeout=60)[0]
        except subprocess.TimeoutExpired:
            os.killpg(shell.pid, signal.SIGKILL)
            raise


def emulators_lines() -> Field:
    """The figures that a PDP-11 draws."""
    with TemporaryDirectory() as folder:
        simulated(Path(folder))
        with Image.open(Path(folder) / "lines.png") as picture:
            return np.asarray(picture.convert("RGB"))


def inspect_pixel() -> Field:
    """The window of inspect.md at the instruction that wrote a pixel of the white bar."""
    blocks = blocks_of((GUIDES / "inspect.md").read_text("utf-8"))
    (listing,) = (block.text for block in blocks if block.text.startswith("; chart.txt"))
    words = np.frombuffer(b"".join(assemble(listing.splitlines())), "<u2")
    inspector = Inspector(inspection_of(Replay(Stream(words=words.astype(np.uint16)))))
    inspector.press(Key("end"))
    for action in ("move", "press", "release"):
        inspector.point(Pointer(502, 302, action, 0 if action == "move" else 1))
    inspector.press(Key("left"))
    while is_busy(inspector.session):
        inspector.page.session = tick(inspector.session)
    return inspector.page.colors()


PICTURES: Final[Sequence[Callable[[], Field]]] = (
    display_areas, display_lines, display_curves, display_text, display_images, display_cursors,
    display_ball, display_stripes, inspect_pixel,
    paper_1983, paper_terms, paper_controls, paper_words, paper_blends,
    elsewhere_lights, emulators_lines,
)  # fmt: skip


if __name__ == "__main__":
    write(PICTURES)
