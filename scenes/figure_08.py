"""Figure 8: the effect of each of the four lights individually."""

from __future__ import annotations

from typing import Final

import numpy as np

from scenes.figures import Sheet, open_scene

BRIGHTEST: Final = 99.5
"""The percentage of the visible pixels within the range: a narrow highlight does not darken the rest."""


def main() -> None:
    """Render once; each panel is the weighted sum again, with the other lights' weights at nothing."""
    studio = open_scene("coupe")
    # By the whole object: a surface that a light does not reach stays dark. From the ambient light up, each
    # panel shows what its light adds.
    four = studio.scene.replace(scaling="object", mapping="gamma")
    sheet = Sheet("08")
    for light in four.lights:
        alone = four.only_lights(light.name)
        studio.edit(alone)
        visible = studio.picture.surface_number > 0
        most = float(np.percentile(studio.picture.intensity[visible], BRIGHTEST))
        studio.edit(alone.replace(exposure={"object": (alone.ambient, most)}))
        sheet.add(studio, f"Light: {light.name}", light.name)
    sheet.write(across=2)


if __name__ == "__main__":
    main()
