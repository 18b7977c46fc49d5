"""What an edit of lights did to the exposure, and why it changed nothing.

With automatic exposure and one light alone, any intensity of the light gives the same levels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np

from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import held_exposure, stage_surfaces
from autocolor.scene.columns import fields_of
from autocolor.scene.lights import Light
from autocolor.scene.scene import AUTO, LEVELS, Scene
from autocolor.screens.session import Offer, Session
from autocolor.studio import Studio
from autocolor.widgets.widget import titled

LEAST_CHANGED: Final = 1e-4
"""Assumed: the share of the visible pixels whose words an edit must change by more than rounding."""

FOLLOWED: Final = 0.1
"""Assumed: the change of a largest intensity, as a share of it, from which on a message says so."""


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


def edited_lights(now: Scene, before: Scene) -> list[tuple[Light | None, Light]]:
    """The lights that an edit changed, before and after; none if it changed something else as well."""
    names = [name for name in fields_of(Scene) if name not in ("lights", "view")]
    olds = {light.name: light for light in before.lights}
    is_renamed = len(now.lights) == len(olds) and olds.keys() != {light.name for light in now.lights}
    if is_renamed or any(vars(now)[name] is not vars(before)[name] for name in names):
        return []
    pairs = [(olds.get(light.name), light) for light in now.lights]
    return [pair for pair in pairs if is_edited(*pair)]


def reason_of_no_change(studio: Studio, edited: Sequence[tuple[Light | None, Light]]) -> str:
    """Why edits of lights changed nothing that is seen."""
    scene = studio.scene
    which = titled("light", edited[0][1].name) if len(edited) == 1 else "every edited light"
    versions = [light for pair in edited for light in pair if light is not None]
    if not any(light.on for light in versions):
        return f"{which} is off"
    if not any(light.on and light.intensity for light in versions):
        return f"{which} has the intensity 0"
    names = [light.name for _, light in edited]
    alone = scene.replace(
        lights=[light.replace(on=light.name in names, intensity=1) for light in scene.lights],
        ambient=0,
        words=LEVELS,
        exposure=AUTO,
    )
    if not studio.image_of(alone).picture.ranges.whole.maximum:
        return f"{which} shines on nothing that is seen"
    return "no point that is seen gets another level"


def ranges_to_hold(image: DisplayImage) -> dict[str, tuple[float, float]]:
    """The ranges of intensities that an image maps, by the names of surfaces, as an exposure holds them.

    A surface without a range of its own is mapped by the object's.
    """
    scene = image.scene
    held = held_exposure(image.mapped, scene.scaling, scene.exposure, stage_surfaces(scene))
    return {} if isinstance(held, str) else dict(held)


def growth(before: DisplayImage, now: DisplayImage) -> float:
    """The ratio by which the largest intensity that is mapped has grown, for the surface where it is largest.

    A ratio below 1 is a loss. It is 1 if the ranges are held.
    """
    olds, news = ranges_to_hold(before), ranges_to_hold(now)
    ratios = [news[name][1] / high for name, (_, high) in olds.items() if name in news and high > 0]
    return max((ratio for ratio in ratios if ratio > 0), key=lambda ratio: abs(math.log(ratio)), default=1.0)


def tell_effect(session: Session) -> bool:
    """Say that the exposure followed the last edits of lights, or why they changed nothing that is seen.

    Returns whether there is something to say.
    """
    edits, session.edits = session.edits, None
    if edits is None or edits[1] is not session.scene:
        return False
    before, studio = edits[0], session.studio
    edited = edited_lights(studio.scene, before.scene)
    if not edited:
        return False
    image = studio.display_image
    ratio = growth(before, image)
    if abs(ratio - 1) > FOLLOWED:
        more = "more" if ratio > 1 else "less"
        hold = partial(hold_ranges, session, before)
        done = f"{session.message}; " if session.news_may_go else ""
        message = f"{done}exposed again: {more} light looks the same"
        session.tell(message, offer=Offer("hold all", hold))
        return True
    if not looks_equal(before, image):
        return False
    session.tell(f"no change: {reason_of_no_change(studio, edited)}", is_warning=True)
    return True


def hold_ranges(session: Session, image: DisplayImage) -> None:
    """Hold the ranges of an image before the last edits, as one step, so that less light is darker."""
    session.edit(session.scene.replace(exposure=ranges_to_hold(image)))
    session.tell("all ranges are held as before the edit: less light is darker")
