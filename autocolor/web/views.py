"""The views of a page that turns, and the scene that all of them show.

A turn changes words only, and a paint entries only, in every view: all views have one table. So the other
views have the levels of the first, and intensities are mapped by its exposure. A view looks as an image of
the scene that `held_scene` returns, with that view.
"""

from __future__ import annotations

from typing import Final

from autocolor.checks import is_whole, shown
from autocolor.errors import InputError, UsageError
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import held_exposure, is_held, stage_surfaces
from autocolor.scene.orbit import around
from autocolor.scene.scene import Exposure, Scene
from autocolor.scene.view import MOST_VIEWS, NamedView

CAMERAS: Final = "cameras"
"""The views of a page for the scene's view and its named views."""

EQUALIZE: Final = "equalize"
"""The mapping that follows the picture."""


def views_of(scene: Scene, views: int | str | None, aspect: float) -> tuple[NamedView, ...]:
    """The views of a page, the first of which is shown first.

    For a number they are `orbit.around` the object, named by their angle from the first; for CAMERAS, the
    view and the named views of the scene; for None, the view alone. `aspect` is the width of the picture over
    its height. Raises UsageError for other values, and if a scene for CAMERAS has no named view.
    """
    own = NamedView("view", scene.view)
    if views is None:
        return (own,)
    if views == CAMERAS:
        if not scene.views:
            raise UsageError(
                "a scene for views from its cameras must have a named view, not none; save one in the studio,"
                " or give a number of views"
            )
        return (*scene.views,) if scene.view in [row.view for row in scene.views] else (own, *scene.views)
    if not is_whole(views, 2, MOST_VIEWS):
        raise UsageError(
            f"the views of a page must be a whole number from 2 to {MOST_VIEWS}, or {CAMERAS!r}, not"
            f" {shown(views)}; give another number"
        )
    count = int(views)
    orbit = around(scene, count, aspect)
    return tuple(NamedView(f"{360 * turn / count:g}°", view) for turn, view in enumerate(orbit))


def exposure_to_hold(image: DisplayImage, subject: str) -> Exposure:
    """The exposure of an image, held; `subject` is what a page needs it for, "lights" or "views".

    Raises UsageError if words stand for normals, InputError if the mapping is EQUALIZE or the picture has a
    single intensity.
    """
    scene = image.scene
    if not image.has_light_in_words:
        raise UsageError(
            f"a page with {subject} must have words that stand for levels, not for normals; render the scene"
            f' with words="levels", or leave the {subject} out'
        )
    if scene.mapping == EQUALIZE:
        raise InputError(
            f"a page with {subject} must have a mapping that stays with the exposure, not equalize, which"
            f" follows the picture; set mapping to linear, or leave the {subject} out"
        )
    exposure = held_exposure(image.mapped, scene.scaling, scene.exposure, stage_surfaces(scene))
    # In one view, ranges that the scene holds of some surfaces are enough.
    if not is_held(exposure) and (subject == "views" or isinstance(scene.exposure, str)):
        raise InputError(
            f"the picture of a page with {subject} must have more than one intensity, or there is no exposure"
            f" to hold; switch a light on, or leave the {subject} out"
        )
    return exposure


def held_scene(image: DisplayImage) -> Scene:
    """The scene of an image, in which other views have its levels and its exposure; no word of it changes.

    Raises as `exposure_to_hold`.
    """
    scene = image.scene.replace(exposure=exposure_to_hold(image, "views"))
    surfaces = [
        row.replace(levels=image.ranges[row.name].levels)
        if row.name in image.ranges and row.name not in image.bands
        else row
        for row in scene.surfaces
    ]
    for bands in image.bands.values():
        scene = scene.with_scalar(shades=bands.shades)
    return scene.replace(surfaces=surfaces)


def check_table(name: str, image: DisplayImage, first: DisplayImage) -> None:
    """Raise InputError unless the image of a named view has the ranges and bands of the first image."""
    if image.ranges != first.ranges or image.bands != first.bands:
        raise InputError(
            f"view {name!r}: its surfaces must have the levels and bands that they have in the first view,"
            " because all views have one table; move its eye above the stage, or leave the scalar or the"
            " views out"
        )
