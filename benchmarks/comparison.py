"""What is compared: one scene for this renderer and for its peers, and the edits of it that are timed.

The scene is the coupe with its flaps off, for no peer has any; with white surfaces before a blue background,
so that a peer's picture shows intensities and what is covered; and with lights so weak that nothing is
brighter than 8 bits can say.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import numpy.typing as npt

import autocolor
from autocolor import Flaps, Light, Scene
from benchmarks.points import ALL_LIGHTS, COUPE, FRAME, ONE_LIGHT, RECOLOR

LINES, ELEMENTS = 480, 640
BRIGHTEST = 0.98
"""The largest intensity, a little below 1 so that none comes to lie above it when a light is moved."""

WHITE, BLUE, PAINTS = (255, 255, 255), (0, 0, 255), ((176, 144, 32), (48, 96, 224))

Field = npt.NDArray[np.uint8]


def comparison_scene() -> Scene:
    """The scene of the comparison."""
    scene = autocolor.read_scene(COUPE)
    scene = scene.replace(
        background=BLUE,
        lights=[light.replace(flaps=Flaps()) for light in scene.lights],
        surfaces=[surface.replace(object_color=WHITE) for surface in scene.surfaces],
    )
    weaker = BRIGHTEST / autocolor.render(scene, (ELEMENTS, LINES)).ranges.whole.maximum
    return scene.replace(
        ambient=scene.ambient * weaker,
        lights=[light.replace(intensity=light.intensity * weaker) for light in scene.lights],
    )


def expected(scene: Scene) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
    """The field of a scene as it must come from a peer, and what of it is covered.

    The field is (lines, elements, 3) float32: the color of each pixel's surface times its intensity, 255 for
    1, and the background's color elsewhere.
    """
    picture = autocolor.render(scene, (ELEMENTS, LINES))
    colors = np.array([BLUE, *(surface.paint.object_color for surface in scene.surfaces)], np.float32)
    covered = picture.surface_number > 0
    shown = np.where(covered, picture.intensity, np.float32(1))
    return np.minimum(colors[picture.surface_number] * shown[..., None], np.float32(255)), covered


def with_eye_moved(scene: Scene, step: float) -> Scene:
    """The scene from an eye that moved along x."""
    x, y, z = scene.view.eye
    return scene.with_view(eye=(x + step, y, z))


def with_light_moved(scene: Scene, step: float) -> Scene:
    """The scene with its first light moved along x."""
    return scene.with_light(scene.lights[0].name, position=_aside(scene.lights[0], step))


def with_lights_moved(scene: Scene, step: float) -> Scene:
    """The scene with all lights moved along x."""
    return scene.replace(lights=[light.replace(position=_aside(light, step)) for light in scene.lights])


def recolored(scene: Scene, _: float) -> Scene:
    """The scene with its first surface in one of two colors, never the one that it has."""
    surface = scene.surfaces[0]
    color = PAINTS[surface.paint.object_color == PAINTS[0]]
    return scene.with_surface(surface.name, object_color=color)


EDITS: Mapping[str, Callable[[Scene, float], Scene]] = {
    FRAME: with_eye_moved,
    ONE_LIGHT: with_light_moved,
    ALL_LIGHTS: with_lights_moved,
    RECOLOR: recolored,
}
"""What is timed, as edits of a scene by a step in its units."""


def _aside(light: Light, step: float) -> tuple[float, float, float]:
    x, y, z = light.position
    return (x + step, y, z)
