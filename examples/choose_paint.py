"""Choose a paint from 200, 25 colors in 8 finishes: a contact sheet of the 25 that differ most.

`python -m examples.choose_paint [FOLDER]` writes paints.png into a folder. The coupe is rendered once. A
paint is a table of some 250 entries, and each entry is shown by the same number of pixels, whatever the
paint is. So the 200 tables tell how each paint looks on the car, and no picture is made before the choice.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import autocolor
from autocolor import Variant

COLORS = autocolor.read_palette(Path(__file__).with_name("paints.gpl"))
FINISHES: dict[str, dict[str, Any]] = {
    "matte": {"blend": 1.0},
    "satin": {"blend": 0.5, "light_percentage": 35.0},
    "lacquer": {"blend": 0.64},
    "metallic": {"blend": 0.3},
    "chrome": {"blend": 0.0},
    "gold": {"blend": 0.2, "light_color": "#ffcf80"},
    "ice": {"blend": 0.2, "light_color": "#9fd4ff"},
    "beetle": {"blend": 0.0, "light_color": "#58ffa0"},
}
SHOWN = 25
FORM = 16.0
"""The least standard deviation of the brightness, 0 to 255, with which the form of the car shows."""


def main(folder: Path = Path()) -> None:
    """Write the contact sheet, and print how many paints show the form."""
    studio = autocolor.Studio(autocolor.demo())
    car, (first, levels) = studio.scene, studio.level_ranges["body"]
    pixels = np.bincount(studio.words.ravel(), minlength=1024)[first : first + levels]
    share = pixels / pixels.sum()

    paints, tables = [], []
    for name, color in zip(COLORS.names, COLORS.colors, strict=True):
        for finish, fields in FINISHES.items():
            settings = {f"surfaces.body.{key}": value for key, value in fields.items()}
            paints.append(Variant(f"{name}, {finish}", {"surfaces.body.object_color": color, **settings}))
            studio.edit(car.with_surface("body", object_color=color, **fields))
            tables.append(studio.entries[first : first + levels])

    # The form shows where the brightness of the pixels differs enough.
    entries = np.array(tables, float)
    brightness = entries @ [0.2126, 0.7152, 0.0722]
    deviation = np.sqrt(brightness**2 @ share - (brightness @ share) ** 2)
    candidates = np.flatnonzero(deviation >= FORM)
    print(f"{len(paints)} paints, {len(candidates)} of which show the form of the car")

    # Begin with the paint of the most contrast. Each further paint differs most from all before.
    chosen = [int(deviation.argmax())]
    nearest = np.full(len(paints), np.inf)
    while len(chosen) < SHOWN:
        difference = ((entries - entries[chosen[-1]]) ** 2).sum(axis=2) @ share
        nearest = np.minimum(nearest, difference)
        chosen.append(int(candidates[nearest[candidates].argmax()]))
    sheet = [paints[number] for number in sorted(chosen)]
    autocolor.batch((car, studio.picture), sheet, sheet=folder / "paints.png", overwrite=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
