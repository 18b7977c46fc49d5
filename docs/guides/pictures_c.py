"""The pictures of display.md, paper.md and elsewhere.md: `python -m docs.guides.pictures_c` writes them all.

The pictures of display.md are drawn by the display from the listings and the examples that the guide shows.
"""

from __future__ import annotations

import doctest
import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from PIL import Image

import autocolor
from ramtek_emu import Ramtek9300
from ramtek_emu.instruction_set.assembler import assemble
from scenes.figures import captioned, click, open_viewer, point_at

FOLDER: Final = Path(__file__).parent
MOST_BYTES: Final = 40_000
"""The largest picture of a guide."""

Field = npt.NDArray[np.uint8]


def blocks_of(guide: str, language: str) -> list[str]:
    """The code blocks of a guide in a language."""
    text = (FOLDER / guide).read_text("utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


def listings() -> dict[str, str]:
    """The listings of display.md, by the names in their first lines: `; areas.txt` begins "areas"."""
    return {block[2:].split(".txt")[0]: block for block in blocks_of("display.md", "asm")}


def examples(guide: str) -> doctest.DocTest:
    """The examples of a guide, in one doctest."""
    text = "\n".join(blocks_of(guide, "pycon"))
    return doctest.DocTestParser().get_doctest(text, {}, guide, str(FOLDER / guide), 0)


def names_after(guide: str) -> dict[str, Any]:
    """The names that the examples of a guide leave, such as `display`."""
    test = examples(guide)
    doctest.DocTestRunner(verbose=False).run(test, clear_globs=False)
    return test.globs


def played(*names: str, more: str = "") -> Ramtek9300:
    """The display after some listings, and after `more` lines of a listing."""
    display = Ramtek9300()
    lines = [line for name in names for line in listings()[name].splitlines()]
    stream = b"".join(assemble([*lines, *more.splitlines()]))
    display.send(np.frombuffer(stream, "<u2"))
    return display


def of_listing(name: str) -> Callable[[], Field]:
    """Draws the upper half of the field that a listing leaves on the display that is switched on."""
    return lambda: played("colors", name).field()[:240]


def view() -> Field:
    """The page of text by view.txt, and again with the lines from the bottom."""
    fields = (played("colors", "text", "view", more=more).field() for more in ("", "SELVO #1"))
    return beside(*(field[::2, ::2] for field in fields))


def ball() -> Field:
    """The ball of display.md in its two colors."""
    names = names_after("display.md")
    return beside(names["red"][::2, ::2], names["blue"][::2, ::2])


def stripes() -> Field:
    """The field of display.md that is drawn with one entry."""
    field: Field = names_after("display.md")["stripes"]
    return field[::2, ::2]


def beside(*fields: Field, gap: int = 8) -> Field:
    """Fields of one height, side by side with white gaps."""
    white = np.full((len(fields[0]), gap, 3), 255, np.uint8)
    parts = [part for field in fields for part in (white, field)][1:]
    return np.hstack(parts)


def panel(scene: autocolor.Scene, caption: str, lines: int = 150, elements: int = 200) -> Field:
    """A small picture of a scene with smooth edges, and a caption below it."""
    field = autocolor.image(scene, autocolor.render(scene, lines, elements, smooth=3))
    return captioned(field, caption, size=1)


def terms() -> Field:
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


def controls() -> Field:
    """The wall of paper.md under one lamp with several controls."""
    wall = names_after("paper.md")["wall"].replace(exposure={"object": (0, 1.5)})
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


def words() -> Field:
    """The words of the coupe as grays, and their colors by the table."""
    display = Ramtek9300()
    autocolor.Studio(autocolor.demo(), display)
    grays = np.repeat((display.words[::2, ::2, np.newaxis] // 4).astype(np.uint8), 3, axis=2)
    return beside(
        captioned(grays, "words, 0 black to 1023 white", 1), captioned(display.field()[::2, ::2], "colors", 1)
    )


def blends() -> Field:
    """The entries of the coupe's body in three blends, above the picture with them."""
    parts = []
    for blend in (1.0, 0.5, 0.0):
        car = autocolor.demo().with_paint("body", object_color="#8c1a22", light_color="#f0e8d8", blend=blend)
        studio = autocolor.Studio(car, Ramtek9300())
        entries = studio.display_image.entries_of(car.surface("body"))
        bar = entries[np.linspace(0, len(entries) - 1, 200).round().astype(int)]
        parts.append(np.vstack([np.tile(bar, (24, 1, 1)), panel(car, f"blend {blend:g}")]))
    return beside(*parts)


def elsewhere() -> Field:
    """The studio on a display, with the menu that the pointer brings at the right edge."""
    with open_viewer("coupe", "lights") as (viewer, display):
        click(viewer, "key")
        point_at(viewer, 632, 200)
        return display.field()


PICTURES: Final[dict[str, Callable[[], Field]]] = {
    **{
        f"display-{name}": of_listing(name)
        for name in ("areas", "lines", "curves", "text", "images", "cursors")
    },
    "display-view": view,
    "display-ball": ball,
    "display-stripes": stripes,
    "paper-terms": terms,
    "paper-controls": controls,
    "paper-words": words,
    "paper-blends": blends,
    "elsewhere": elsewhere,
}


def png_of(field: Field) -> bytes:
    """The PNG file of a field; with more than 256 colors, of the nearest of 256."""
    image = Image.fromarray(field)
    colors = image.getcolors(256)
    image = image.quantize(256 if colors is None else len(colors), dither=Image.Dither.NONE)
    file = io.BytesIO()
    image.save(file, "PNG", optimize=True)
    return file.getvalue()


def main() -> None:
    """Write all pictures."""
    for name, picture in PICTURES.items():
        data = png_of(picture())
        (FOLDER / "images" / f"{name}.png").write_bytes(data)
        print(f"{name}.png {len(data):,} bytes")


if __name__ == "__main__":
    main()
