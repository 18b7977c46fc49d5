"""Explanations: why a pixel looks as it does, from the rows of the tables to the color of an entry.

This is the paper for one pixel: the renderer's own point there, the plain light equation in float64, and the
mapping of the picture's intensity to a level.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import asdict, dataclass
from typing import Any

from autocolor.checks import Color
from autocolor.explanation.level import LevelExplained, level_explained, word_of
from autocolor.explanation.light import LightExplained, light_explained
from autocolor.explanation.point import PointExplained, point_explained
from autocolor.mapping.display_image import DisplayImage
from autocolor.scene.columns import to_plain
from autocolor.visibility.visible_points import Sight, seen_at


@dataclass(frozen=True)
class Explanation:
    """Why a pixel looks as it does. Rows of tables are counted from 1.

    `point` and `intensity` are None on the background. `lights` has all lights, those that contribute most
    first. `level` is None on the background, and where words stand for normals: then the entry has the light
    at the normal that stands for several, in place of the light at this point.
    """

    scene: str
    line: int
    element: int
    point: PointExplained | None
    ambient: float
    lights: tuple[LightExplained, ...]
    intensity: float | None
    level: LevelExplained | None
    word: int
    color: Color

    def to_plain(self) -> dict[str, Any]:
        """The explanation as dictionaries, lists and numbers, which JSON can hold."""
        plain = asdict(self)
        if self.point is not None:
            plain["point"]["reflectance"] = to_plain(self.point.reflectance)
        for row, light in zip(plain["lights"], self.lights, strict=True):
            row["controls"] = dict(light.controls)
        return plain


def explain(sight: Sight, image: DisplayImage, line: int, element: int) -> Explanation:
    """Why a pixel of an image looks as it does. `sight` has the visible points of the image.

    Raises UsageError if there is no such line or element.
    """
    scene = image.scene
    place, seen = sight.place_at(line, element), seen_at(sight, line, element)
    # JSON cannot hold integers of numpy.
    line, element = int(line), int(element)
    word = int(image.words[line, element])
    red, green, blue = image.entries[word].tolist()
    background = Explanation(
        scene=scene.name,
        line=line,
        element=element,
        point=None,
        ambient=scene.ambient,
        lights=(),
        intensity=None,
        level=None,
        word=word,
        color=(red, green, blue),
    )
    if seen is None or place is None:
        return background
    point = point_explained(scene, seen)
    lights = [
        light_explained(light, number, sight.points, place, point)
        for number, light in enumerate(scene.lights_in_world, start=1)
    ]
    lights.sort(key=lambda each: -each.contribution)
    level = None if image.meaning == "normal" else level_explained(image, point, place)
    return dataclasses.replace(
        background,
        point=point,
        lights=tuple(lights),
        intensity=scene.ambient + math.fsum(each.contribution for each in lights),
        level=level,
        word=word if level is None else word_of(level),
    )
