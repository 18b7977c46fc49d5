"""The pictures of the guides on paint, meshes and scalars, made by the commands that the guides show.

`python -m docs.guides.pictures_of_scenes` writes them all to docs/guides/images, in about ten seconds, and
`python -m docs.guides.pictures_of_scenes scalar_hills` writes one. The panels are smaller than the
pictures of the commands. `paint_page` and `cookbook_page` need playwright
and Debian's Chromium.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np
from PIL import Image

from autocolor import Mesh, Scene, image, scene_of
from docs.generate.commands import ROOT, here
from docs.guides.pictures import cooked
from scenes.figures import Field, captioned

IMAGES: Final = Path(__file__).parent / "images"
COUPE: Final = ROOT / "scenes" / "coupe"
BRACKET: Final = ROOT / "scenes" / "bracket"

PANEL: Final = "--size 320x240 --smooth 4"
LARGE_PANEL: Final = "--size 560x420 --smooth 4"
"""The size of panels with a legend: in smaller pictures it would hide the object."""

QUALITY: Final = 88
"""The quality of WebP files. Chosen by looking at thin stripes and at the letters of legends."""

OUTLINE: Final = (
    (0.55, 0.0), (0.62, 0.12), (0.5, 0.5), (0.8, 1.1), (0.78, 1.5), (0.42, 1.9), (0.5, 2.15),
)  # fmt: skip
"""Radius and height of the rings of a vase."""

SIDES: Final = 16


def main() -> None:
    """Write the pictures that the command line names, or all."""
    IMAGES.mkdir(exist_ok=True)
    for draw in PICTURES:
        if draw.__name__ in sys.argv[1:] or len(sys.argv) == 1:
            path = IMAGES / f"{draw.__name__.replace('_', '-')}.webp"
            with TemporaryDirectory() as place:
                draw(Path(place), path)
            print(path, path.stat().st_size)


def paint_recolored(place: Path, path: Path) -> None:
    """A picture file in three paints."""
    ran(place, f"render {COUPE} {PANEL} --save coupe.npz -o coupe.png")
    ran(place, "recolor coupe.npz body --object '#0a3cc8' --blend 0.7 -o blue.png")
    ran(place, "recolor coupe.npz body --ramp '#200,#f60,#fff' -o glowing.png")
    captions = ("As rendered", "#0a3cc8, blend 0.7", "A ramp of three colors")
    save(path, row_of([place / f"{name}.png" for name in ("coupe", "blue", "glowing")], captions))


def paint_sheet(place: Path, path: Path) -> None:
    """The contact sheet of three colors in three blends."""
    ran(place, f"render {COUPE} --save coupe.npz")
    vary = "--vary surfaces.body.object_color=red,navy,silver --vary surfaces.body.blend=0,0.4,1"
    ran(place, f"sweep coupe.npz {vary} -o {{name}}.png --sheet sheet.png")
    save(path, field_of(place / "sheet.png"))


def paint_fade(place: Path, path: Path) -> None:
    """A film of a fade between three colors."""
    ran(place, f"render {COUPE} --size 240x180 --smooth 4 --save coupe.npz")
    vary = "--vary surfaces.body.object_color=red,navy,goldenrod,red"
    ran(place, f"animate coupe.npz {vary} --frames 30 -o {{number:02}}.png")
    frames = [Image.open(each) for each in sorted(place.glob("[0-9][0-9].png"))]
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=100, loop=0, quality=60, method=6)


def paint_page(place: Path, path: Path) -> None:
    """The page of the coupe with its lights and a strip of variants, in a browser."""
    ran(place, f"render {COUPE} --save coupe.npz")
    vary = "--vary surfaces.body.object_color=navy,silver,goldenrod"
    ran(place, f"page coupe.npz --lights {vary} -o coupe.html")
    save(path, screenshot(place / "coupe.html", 1000, 700))


def cookbook_page(place: Path, path: Path) -> None:
    """The page of the cookbook in a browser, at a third of its size."""
    window = Image.fromarray(screenshot(cooked("page", place), 960, 720))
    save(path, np.asarray(window.reduce(3)))


def screenshot(page: Path, width: int, height: int) -> Field:
    """A page in Debian's Chromium."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        window = browser.new_page(viewport={"width": width, "height": height}, color_scheme="light")
        window.goto(page.as_uri())
        window.wait_for_selector("canvas")
        # The page draws its variants while it is idle.
        window.wait_for_timeout(2000)
        window.screenshot(path=page.with_suffix(".png"))
        browser.close()
    return field_of(page.with_suffix(".png"))


def mesh_parts(place: Path, path: Path) -> None:
    """A bare mesh, with one surface and with a surface for each part."""
    mesh = BRACKET / "bracket.ply"
    ran(place, f"render {mesh} {PANEL} -o bare.png")
    ran(place, f"render {mesh} {PANEL} --surfaces parts -o parts.png")
    captions = ("autocolor render bracket.ply", "--surfaces parts")
    save(path, row_of([place / "bare.png", place / "parts.png"], captions))


def mesh_creases(place: Path, path: Path) -> None:
    """One vase with three crease angles."""
    nodes, polygons = vase()
    panels = []
    for angle in (0.0, 40.0, 180.0):
        scene = scene_of(Mesh.of(nodes, polygons, crease_angle=angle))
        panels.append(captioned(panel_of(scene), f"crease_angle = {angle:g}", 1))
    save(path, np.hstack(panels))


def scalar_stress(place: Path, path: Path) -> None:
    """A machined part in metal, and its stress in two color scales."""
    stress = "--set scalar.name=stress --set scalar.limits=[0,150] --set scalar.bands=15"
    ran(place, f"render {BRACKET} {LARGE_PANEL} -o metal.png")
    ran(place, f"render {BRACKET} {LARGE_PANEL} {stress} -o stress.png")
    captions = ("scenes/bracket", "scalar.name=stress")
    save(path, row_of([place / "metal.png", place / "stress.png"], captions))


def scalar_scales(place: Path, path: Path) -> None:
    """One picture file in three ways to show a scalar."""
    stress = "--set scalar.name=stress --set scalar.limits=[0,150] --set scalar.bands=15"
    ran(place, f"render {BRACKET} {LARGE_PANEL} {stress} --save stress.npz")
    ran(place, "recolor stress.npz --set scalar.scale=turbo -o turbo.png")
    ran(place, "recolor stress.npz --set scalar.limits=[0,100] --set scalar.above=magenta -o above.png")
    ran(place, "recolor stress.npz --set scalar.scale=turbo --set scalar.shades=1 -o flat.png")
    captions = ("scale=turbo", "limits=[0,100], above=magenta", "scale=turbo, shades=1")
    save(path, row_of([place / f"{name}.png" for name in ("turbo", "above", "flat")], captions))


def scalar_form(place: Path, path: Path) -> None:
    """Two computed scalars: curvature and zebra stripes."""
    only_body = "--set scalar.surfaces=body"
    curvature = (
        "--set 'scalar.name=\"mean curvature\"' --set scalar.scale=coolwarm --set scalar.limits=[-5,5]"
    )
    zebra = "--set scalar.name=zebra --set scalar.scale=zebra --set scalar.bands=2 --set scalar.shades=1"
    along = "--set scalar.direction=[1,0,0] --set interpolation=invariant --set scalar.legend=false"
    ran(place, f"render {COUPE} {LARGE_PANEL} {curvature} --set scalar.bands=21 {only_body} -o curvature.png")
    ran(place, f"render {COUPE} {LARGE_PANEL} {zebra} {along} {only_body} --stage none -o zebra.png")
    captions = ("mean curvature, in 1/m", "zebra stripes along x")
    save(path, row_of([place / "curvature.png", place / "zebra.png"], captions))


def scalar_hills(place: Path, path: Path) -> None:
    """A scalar of the reader's own, by the Python of the guide."""
    code = (Path(__file__).parent / "scalars.md").read_text("utf-8").split("```python\n")[1].split("```")[0]
    with chdir(place):
        exec(code, {})
    save(path, field_of(place / "hills.png"))


PICTURES: Final[tuple[Callable[[Path, Path], None], ...]] = (
    paint_recolored,
    paint_sheet,
    paint_fade,
    paint_page,
    cookbook_page,
    mesh_parts,
    mesh_creases,
    scalar_stress,
    scalar_scales,
    scalar_form,
    scalar_hills,
)
"""The pictures, which are named after their functions."""


def ran(place: Path, line: str) -> None:
    """Run a command of `autocolor` in a folder. Raises RuntimeError if it does not end well."""
    code, _, err = here(f"autocolor {line}", place)
    if code:
        raise RuntimeError(f"autocolor {line}: {err}")


def vase() -> tuple[list[tuple[float, float, float]], list[list[int]]]:
    """The nodes and quads of a vase without a bottom."""
    nodes = [
        (radius * math.cos(2 * math.pi * side / SIDES), radius * math.sin(2 * math.pi * side / SIDES), height)
        for radius, height in OUTLINE
        for side in range(SIDES)
    ]
    quads = [
        [ring + side, ring + (side + 1) % SIDES, ring + SIDES + (side + 1) % SIDES, ring + SIDES + side]
        for ring in range(0, SIDES * (len(OUTLINE) - 1), SIDES)
        for side in range(SIDES)
    ]
    return nodes, quads


def panel_of(scene: Scene) -> Field:
    """The picture of a scene at the size of a panel."""
    return image(scene, size=(320, 240), smooth=4)


def field_of(path: Path) -> Field:
    """The pixels of a PNG file."""
    with Image.open(path) as file:
        return np.asarray(file.convert("RGB"))


def row_of(paths: list[Path], captions: tuple[str, ...]) -> Field:
    """PNG files side by side, each with its caption below."""
    fields = [field_of(path) for path in paths]
    size = 2 if fields[0].shape[1] > 400 else 1
    return np.hstack([captioned(field, text, size) for field, text in zip(fields, captions, strict=True)])


def save(path: Path, field: Field) -> None:
    """Write a picture as WebP."""
    Image.fromarray(field).save(path, quality=QUALITY, method=6)


if __name__ == "__main__":
    main()
