"""Explanations: why a pixel looks as it does, from the rows of the tables to the color of an entry.

This is the paper for one pixel. Each step is computed apart from the renderer, by the plain formula, for one
point, in Python's floats. The renderer gives only facts of the whole picture: the polygon that is visible at
the pixel, the ranges of intensities, and the words and bands of each surface. So an explanation also checks
the renderer: it must agree with the picture.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import asdict, dataclass
from typing import Any

from autocolor.checks import Color
from autocolor.explanation.level import LevelExplained, color_of, level_at, word_of
from autocolor.explanation.light import LightExplained, light_at
from autocolor.explanation.point import Camera, PointExplained, point_at
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.ranges import BACKGROUND
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
    seen = seen_at(sight, line, element)
    # JSON cannot hold integers of numpy.
    line, element = int(line), int(element)
    background = Explanation(
        scene=scene.name,
        line=line,
        element=element,
        point=None,
        ambient=scene.ambient,
        lights=(),
        intensity=None,
        level=None,
        word=BACKGROUND,
        color=scene.background,
    )
    if seen is None:
        return background
    camera = Camera(scene.view, sight.points.lines, sight.points.elements)
    at_pixel = line // sight.block, element // sight.block
    point = point_at(scene, camera, seen.polygon, *at_pixel)
    lights = [
        light_at(light, number, scene, point) for number, light in enumerate(scene.lights_in_world, start=1)
    ]
    lights.sort(key=lambda each: -each.contribution)
    intensity = scene.ambient + math.fsum(each.contribution for each in lights)
    if image.meaning == "normal":
        level, word = None, int(image.words[line, element])
        red, green, blue = image.entries[word].tolist()
        color = red, green, blue
    else:
        level = level_at(image, point, intensity, at_pixel)
        word, color = word_of(level), color_of(level)
    return dataclasses.replace(
        background,
        point=point,
        lights=tuple(lights),
        intensity=intensity,
        level=level,
        word=word,
        color=color,
    )
