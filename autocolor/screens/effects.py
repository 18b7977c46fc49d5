"""What an edit of lights changed in the picture, and why it changed nothing.

With automatic exposure and one light alone, any intensity of the light gives the same levels.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import held_exposure, stage_surfaces
from autocolor.scene.columns import fields_of
from autocolor.scene.lights import Light
from autocolor.scene.scene import AUTO, LEVELS, Scene
from autocolor.screens.session import Session
from autocolor.studio import Studio
from autocolor.widgets.widget import titled

LEAST_CHANGED: Final = 1e-4
"""Assumed: the share of the visible pixels whose words an edit must change by more than rounding."""

AUTOMATIC: Final = "automatic exposure maps the brightest to the highest level; "
"""The reason that ends with how to hold the exposure."""


def looks_equal(one: DisplayImage, other: DisplayImage) -> bool:
    """Whether two images differ by less than rounding: in few words, by one level, and in no entry.

    Measured: 0.2 ms for 640 x 480 words.
    """
    changed = one.words != other.words
    visible = int(np.count_nonzero(other.words))
    if np.count_nonzero(changed) >= LEAST_CHANGED * max(1, visible):
        return False
    differences = one.words[changed].astype(int) - other.words[changed]
    return not (np.abs(differences) > 1).any() and np.array_equal(one.entries, other.entries)


def is_edited(before: Light | None, after: Light) -> bool:
    """Whether an edit of a light is meant to change what is seen; None is for a new light.

    Changing `follows` alone leaves the light where it is, and changing `carried` its half-space.
    """
    if before is None:
        return after.on
    one, other = (
        (light.follows, {plane.name: plane.carried for plane in light.half_spaces})
        for light in (before, after)
    )
    return before != after and one == other


def reason_of_no_change(studio: Studio, before: DisplayImage) -> str:
    """Why edits of lights since an image changed nothing that is seen; empty if they did, or were others."""
    scene, start = studio.scene, before.scene
    is_other = any(
        vars(scene)[name] is not vars(start)[name] for name in fields_of(Scene) if name != "lights"
    )
    olds = {light.name: light for light in start.lights}
    edited = [light for light in scene.lights if is_edited(olds.get(light.name), light)]
    is_renamed = len(scene.lights) == len(olds) and olds.keys() != {light.name for light in scene.lights}
    if is_other or is_renamed or not edited or not looks_equal(before, studio.display_image):
        return ""
    which = titled("light", edited[0].name) if len(edited) == 1 else "every edited light"
    versions = [version for light in edited for version in (light, olds.get(light.name, light))]
    if not any(light.on for light in versions):
        return f"{which} is off"
    if not any(light.on and light.intensity for light in versions):
        return f"{which} has the intensity 0"
    names = [light.name for light in edited]
    alone = scene.replace(
        lights=[light.replace(on=light.name in names, intensity=1) for light in scene.lights],
        ambient=0,
        words=LEVELS,
        exposure=AUTO,
    )
    if not studio.image_of(alone).picture.ranges.whole.maximum:
        return f"{which} shines on nothing that is seen"
    held = held_exposure(before.mapped, scene.scaling, scene.exposure, stage_surfaces(scene))
    if held != scene.exposure and not looks_equal(before, studio.image_of(scene.replace(exposure=held))):
        return AUTOMATIC
    return "no point that is seen gets another level"


def tell_effect(session: Session) -> bool:
    """If the last edits of lights changed nothing that is seen, say why; returns whether they did not."""
    edits, session.edits = session.edits, None
    if edits is None or edits[1] is not session.scene:
        return False
    reason = reason_of_no_change(session.studio, edits[0])
    if reason == AUTOMATIC:
        reason += "E holds all" if session.has_keyboard else "hold the exposure in the menu of lights"
    if reason:
        session.tell(f"no change: {reason}", is_warning=True)
    return bool(reason)
