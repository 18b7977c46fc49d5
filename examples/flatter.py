"""Flatter a part: scipy moves a light around the hood of the coupe until the creases of the hood show best.

`python -m examples.flatter [FOLDER]` writes flatter.png, before and after, into a folder. It needs scipy
(`pip install scipy`). A step of the search moves one light, so this light alone is computed: the visible
points and the planes of the other three lights are used again.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image
from scipy.optimize import direct

import autocolor
from ramtek_emu import Configuration, Ramtek9300

PART, LIGHT = "hood", "back"
CENTER, DISTANCE = np.array([-1.5, 0.0, 0.68]), 9.0
"""A point of the hood, at which the light stays aimed, and the distance of the light from it, in meters."""

LINES, ELEMENTS = 240, 320


def placed(scene: autocolor.Scene, angles: npt.ArrayLike) -> autocolor.Scene:
    """The scene with the light at an azimuth from the +x axis and an elevation, in degrees."""
    azimuth, elevation = np.radians(angles)
    level = np.cos(elevation)
    outward = np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])
    return scene.with_light(LIGHT, position=tuple(CENTER + DISTANCE * outward), aim=tuple(CENTER))


def main(folder: Path = Path()) -> None:
    """Search with the light, write before and after side by side, and print where the light is."""
    above = placed(autocolor.demo().with_taken_view("hood"), (0.0, 85.0))
    size = Configuration(name="SMALL", elements=ELEMENTS, lines=LINES, planes=10, entries=1024)
    studio = autocolor.Studio(above, Ramtek9300(size))

    # The pixels of the part whose neighbors to the right and below belong to the part, too.
    on_part = studio.picture.part_number == studio.picture.parts.index(PART) + 1
    inner = on_part[:-1, :-1] & on_part[:-1, 1:] & on_part[1:, :-1]

    def flatness(angles: npt.ArrayLike) -> float:
        """The mean slope of the intensity on the part, relative to the median, with a minus sign."""
        intensity = studio.image_of(placed(above, angles)).picture.intensity
        across, down = np.diff(intensity, axis=1)[:-1], np.diff(intensity, axis=0)[:, :-1]
        return -float(np.hypot(across, down)[inner].mean() / np.median(intensity[on_part]))

    # `direct` divides the range of both angles where the objective is low, without a random number.
    best = direct(flatness, [(-180, 180), (10, 85)], maxfun=200)
    studio.edit(placed(above, best.x))
    contrast = flatness(best.x) / flatness((0.0, 85.0))
    print(f"{best.nfev} places tried; azimuth {best.x[0]:.0f}, elevation {best.x[1]:.0f} degrees")
    print(f"the hood has {contrast:.1f} times the contrast")
    panels = [autocolor.image(scene, size=(ELEMENTS, LINES)) for scene in (above, studio.scene)]
    Image.fromarray(np.hstack(panels)).save(folder / "flatter.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
