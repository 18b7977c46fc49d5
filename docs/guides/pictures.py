"""The pictures of the guides: `python -m docs.guides.pictures` writes them into docs/guides/images.

Each function of PICTURES returns a picture, which is named after the function. To write some pictures only,
name their functions: `python -m docs.guides.pictures light_place`. A picture of results runs the commands of
its guide, and shows what they wrote. A picture of a screen is the field of a display, after the steps of the
guide were done with the joystick unit. A picture of the cookbook is the image that its script writes, at most
320 wide; the page of the cookbook is a picture of `pictures_of_scenes`, because it needs a browser.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import chdir
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np
from PIL import Image

from autocolor import image, read_palette, read_scene
from autocolor.scene.arrangements import ARRANGEMENTS, arranged
from autocolor.screens.file_actions import bring_paints
from autocolor.screens.viewer import Viewer
from docs.generate.blocks import blocks_of, commands_of
from docs.generate.commands import ROOT, here
from ramtek_emu.memory.cursors import Joystick
from scenes.figures import Field, captioned, click, click_at, open_viewer, point_at

GUIDES: Final = Path(__file__).parent
IMAGES: Final = GUIDES / "images"

COLORS: Final = 255
"""The most colors of a picture: a pixel is then a byte."""

QUALITY: Final = 94
FILM_QUALITY: Final = 75
"""The quality of the WebP files of the cookbook: of pictures, and of films, which are larger."""

RECIPE: Final = (320, 240)
"""The largest size of a picture of the cookbook."""

SMALL: Final = 2
"""A panel has this part of the lines and elements of a result."""

CAR: Final = slice(40, 200)
"""The lines of a small panel that show the car."""

COBALT: Final = (530, 251)
"""The element and the line of a paint in the menu of color mixing."""

EXPLAINED: Final = (240, 200)
"""The line and the element of the pixel that the guide to the studio explains."""


def start_paint() -> Field:
    """The coupe, and the recolored coupe."""
    results = results_of("start")
    return np.hstack([results["coupe"][CAR], results["blue"][CAR]])


def start_menu() -> Field:
    """The picture screen with its menu; the pointer is at the word of color mixing."""
    with open_viewer("coupe", "picture") as (viewer, display):
        # The menu opens when the pointer comes to the right edge from elsewhere.
        for element, line in ((400, 57), (639, 57), (280, 8)):
            point_at(viewer, element, line)
        return display.field()


def light_alone() -> Field:
    """Each of the four lights alone."""
    return sheet("light", ("key", "side", "back", "rim"))


def light_arrangements() -> Field:
    """The coupe in each arrangement of lights."""
    scene = read_scene(ROOT / "scenes" / "coupe")
    pictures = {name: image(arranged(scene, name), size=(240, 180), smooth=4) for name in ARRANGEMENTS}
    panels = [captioned(picture[30:150], name, 1) for name, picture in pictures.items()]
    return np.vstack([np.hstack(panels[:3]), np.hstack(panels[3:])])


def light_place() -> Field:
    """The screen light & view, while the side light is dragged in the view from above."""
    with open_viewer("coupe", "light and view") as (viewer, display):
        idle(viewer)
        grab(viewer, "side: x", (-52, 0))
        return display.field()


def light_spot() -> Field:
    """The key light concentrated, in a cone, and in a soft cone."""
    return sheet("light", ("concentrated", "cone", "soft"), across=3)


def light_flaps() -> Field:
    """The side light, with a flap, with a soft flap, and with a half-space."""
    return sheet("light", ("side", "flap", "soft-flap", "half-space"))


def light_highlight() -> Field:
    """The lights screen, after the highlight of the back light was dragged to the front of the hood."""
    with open_viewer("coupe", "lights") as (viewer, display):
        click(viewer, " 3 back")
        grab(viewer, "highlight of back", (-56, 24)).track = False
        viewer.poll()
        idle(viewer)
        return display.field()


def light_links() -> Field:
    """The key light without the floor, and the back light on the hood alone."""
    return sheet("light", ("car-only", "hood-only"))


def light_exposure() -> Field:
    """A dim light with three exposures."""
    return sheet("light", ("automatic", "held", "lifted"), across=3)


def studio_mixing() -> Field:
    """Color mixing, with the paints of a file, of which the pointer takes one."""
    with open_viewer("coupe", "mixing") as (viewer, display):
        bring_paints(viewer.session, read_palette(ROOT / "examples" / "paints.gpl"), "paints.gpl")
        viewer.tell("")
        click_at(viewer, *COBALT)
        return display.field()


def studio_split() -> Field:
    """The red car at the left of the line, the blue car at its right."""
    with open_viewer("coupe", "picture") as (viewer, display):
        viewer.studio.recolor("body", object_color="#2348c8", blend=0.5)
        for element in (400, 639):
            point_at(viewer, element, 57)
        click(viewer, "compare", 0.75)
        idle(viewer)
        return display.field()


def studio_explain() -> Field:
    """The explanation of a pixel of the hood."""
    with open_viewer("coupe", "picture") as (viewer, display):
        viewer.session.pixel = EXPLAINED
        viewer.session.turn_to("explain")
        viewer.tell("")
        idle(viewer)
        return display.field()


def studio_sent() -> Field:
    """The listing of an edit of the body's object color."""
    with open_viewer("coupe", "picture") as (viewer, display):
        viewer.session.edit(viewer.session.scene.with_surface("body", paint={"object_color": "#2348c8"}))
        viewer.tell("")
        viewer.session.turn_to("sent")
        viewer.tell("")
        idle(viewer)
        return display.field()


PICTURES: Final[Sequence[Callable[[], Field]]] = (
    start_paint, start_menu,
    light_alone, light_arrangements, light_place, light_spot, light_flaps, light_highlight, light_links,
    light_exposure,
    studio_mixing, studio_split, studio_explain, studio_sent,
)  # fmt: skip


@cache
def results_of(guide: str) -> Mapping[str, Field]:
    """The PNG files that the commands of a guide write in an empty folder, by name, at a small size."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        for block in blocks_of((GUIDES / f"{guide}.md").read_text("utf-8")):
            for line, _ in commands_of(block):
                if not line.startswith("autocolor view "):
                    code, _, err = here(line, folder)
                    assert code == 0, f"{line}: {err}"
        return {
            path.stem: np.asarray(Image.open(path).convert("RGB").reduce(SMALL))
            for path in folder.glob("*.png")
        }


def sheet(guide: str, names: Sequence[str], across: int = 2) -> Field:
    """Results of the commands of a guide in rows, each with its name below it."""
    panels = [captioned(results_of(guide)[name][CAR], f"{name}.png", 1) for name in names]
    return np.vstack([np.hstack(panels[first : first + across]) for first in range(0, len(panels), across)])


def grab(viewer: Viewer, label: str, by: tuple[int, int]) -> Joystick:
    """Begin to drag the handle of a label by elements and lines; returns the unit, which still tracks."""
    handle = next(each for each in viewer.board.content.handles if each.label.startswith(label))
    joystick = point_at(viewer, handle.element, handle.line)
    joystick.track = True
    viewer.poll()
    for share in (0.5, 1):
        point_at(viewer, handle.element + round(share * by[0]), handle.line + round(share * by[1]))
    viewer.on_tick()
    return joystick


def idle(viewer: Viewer) -> None:
    """Let the viewer do what it does while nothing moves."""
    while viewer.board.content.idle():
        viewer.on_tick()


def path_of(picture: Callable[[], Field]) -> Path:
    """The file of a picture."""
    return IMAGES / f"{picture.__name__.replace('_', '-')}.png"


def write(pictures: Sequence[Callable[[], Field]]) -> None:
    """Write the pictures that the command line names, or all."""
    IMAGES.mkdir(exist_ok=True)
    for picture in pictures:
        if picture.__name__ in sys.argv[1:] or len(sys.argv) == 1:
            path = path_of(picture)
            field = Image.fromarray(picture())
            field.quantize(COLORS, kmeans=5, dither=Image.Dither.NONE).save(path, optimize=True)
            print(path, path.stat().st_size)


# The cookbook.


def recipes() -> dict[str, str]:
    """The scripts of the cookbook, by the names of their pictures: `images/cookbook-film.webp` is "film"."""
    text = (GUIDES / "cookbook.md").read_text("utf-8")
    found = re.findall(
        r"^```python\n(.*?)^```\n\n!\[.*?\]\(images/cookbook-(\w+)\.webp\)$", text, re.DOTALL | re.M
    )
    return {name: code for code, name in found}


def cooked(name: str, folder: Path) -> Path:
    """Run a script of the cookbook in a folder; returns the file that it must have written."""
    (folder / "scenes").symlink_to(ROOT / "scenes", target_is_directory=True)
    with chdir(folder):
        exec(compile(recipes()[name], name, "exec"), {})
    return next(path for suffix in ("png", "webp", "html") if (path := folder / f"{name}.{suffix}").exists())


def small_frames(path: Path) -> list[Image.Image]:
    """The frames of an image file, at most as large as `RECIPE`."""
    with Image.open(path) as file:
        frames = []
        for number in range(getattr(file, "n_frames", 1)):
            file.seek(number)
            frame = file.convert("RGBA" if file.mode == "RGBA" else "RGB")
            frame.thumbnail(RECIPE, Image.Resampling.BOX)
            frames.append(frame)
    return frames


def write_recipes() -> None:
    """Write the pictures of the cookbook that the command line names, such as cookbook_film, or all."""
    for name in recipes():
        if f"cookbook_{name}" in sys.argv[1:] or len(sys.argv) == 1:
            with TemporaryDirectory() as folder:
                made = cooked(name, Path(folder))
                if made.suffix == ".html":
                    continue
                first, *others = small_frames(made)
            path = IMAGES / f"cookbook-{name}.webp"
            film = (
                {"save_all": True, "append_images": others, "duration": first.info["duration"]}
                if others
                else {}
            )
            first.save(path, quality=FILM_QUALITY if others else QUALITY, method=6, **film)
            print(path, path.stat().st_size)


if __name__ == "__main__":
    write(PICTURES)
    write_recipes()
