"""The views of a page: each equals the image of the scene whose levels and exposure the first view holds."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given

from autocolor import InputError, Scene, Studio, View, image, render, save_page
from autocolor.scene.orbit import around
from autocolor.scene.view import NamedView
from autocolor.testing import scenes
from autocolor.web import exported
from autocolor.web.exported import export_of
from autocolor.web.views import views_of
from ramtek_emu import Ramtek9300
from tests.autocolor.web.twin import entries_in, words_in
from tests.small import SMALL, car, cube, wall_scene
from tests.tables import call, refused

SIZE = (32, 24)
BESIDE = View((-3.0, -3.0, 1.0), target=(0.0, 0.0, 0.0), field_of_view=40.0)
BELOW = View((0.0, -4.0, -3.0), target=(0.0, 0.0, 0.0))


def turning(scene: Scene, views: Sequence[NamedView], **options: Any) -> Any:
    """The export of a page with some views, through JSON."""
    first = scene.replace(view=views[0].view)
    return json.loads(json.dumps(export_of(first, render(first, SIZE), views=views, **options)))


def held_by_a_studio(scene: Scene) -> Scene:
    """The scene with the exposure and the levels that a studio shows it with."""
    studio = Studio(scene, Ramtek9300(SMALL))
    studio.hold_exposure()
    shown = studio.display_image
    for name, (_, levels) in studio.level_ranges.items():
        if name in shown.bands:
            studio.scalar(shades=shown.bands[name].shades)
        else:
            studio.surface(name, levels=levels)
    return studio.scene


def check_views(scene: Scene, views: Sequence[NamedView], values: Any) -> None:
    entries, held = entries_in(values), held_by_a_studio(scene.replace(view=views[0].view))
    assert [each["name"] for each in values["views"]] == [each.name for each in views]
    for each, turned in zip(views, values["views"], strict=True):
        words = words_in({**values, "words": turned["words"] or values["words"]})
        expected = image(held.replace(view=each.view), size=SIZE, smooth=1)
        assert (entries[words] == expected).all(), each.name
    # No word changed when levels and exposure were held.
    own = scene.replace(view=views[0].view)
    assert (entries[words_in(values)] == image(own, size=SIZE, smooth=1)).all()


@pytest.mark.parametrize(
    "changes",
    [
        {"contrast": "floor", "exposure": "99 %", "mapping": "gamma", "dither": "ordered"},
        {"scaling": "object", "exposure": {"body": [0.0, 0.7]}},
        {"stage": "bowl", "contrast": "floor"},
        {"scalar": {"name": "stress"}, "contrast": "floor"},
    ],
    ids=["following", "held", "staged", "scalar"],
)
def test_each_view_is_the_image_of_the_scene_with_the_levels_and_the_exposure_of_the_first(
    changes: dict[str, Any],
) -> None:
    scene = car().replace(**changes)
    views = views_of(scene, 5, 4 / 3)
    check_views(scene, views, turning(scene, views))


@given(scenes(words="levels", mapping="linear", exposure={"object": (0.0, 1.5)}))
def test_every_scene_turns_or_is_refused(scene: Scene) -> None:
    views = views_of(scene, 3, 4 / 3)
    try:
        values = turning(scene, views)
    except InputError:
        # There are too few words for the bands, or a view needs other bands.
        assume(False)
    check_views(scene, views, values)


def test_a_surface_that_the_first_view_does_not_show_has_its_lowest_level_in_the_others() -> None:
    scene = car().replace(contrast="floor")
    hidden = View((0.0, -1.15, 0.0), target=(0.0, 0.0, 0.0), field_of_view=20.0)
    views = (NamedView("near", hidden), NamedView("beside", BESIDE))
    values = turning(scene, views)
    assert len(render(scene.replace(view=hidden), SIZE).slices) < 3
    assert all(each["floor"] > 0 for each in values["surfaces"])
    check_views(scene, views, values)


def test_the_lights_of_a_page_that_turns_are_those_of_the_first_view() -> None:
    scene = car()
    views = views_of(scene, 3, 4 / 3)
    first = scene.replace(view=views[0].view)
    values = turning(scene, views, lights=True)
    assert values["lights"]["rows"] == export_of(first, render(first, SIZE), lights=True)["lights"]["rows"]


def test_the_cameras_are_the_view_and_the_named_views() -> None:
    scene = car().replace(views=[NamedView("beside", BESIDE), NamedView("below", BELOW)])
    assert [each.name for each in views_of(scene, "cameras", 1)] == ["view", "beside", "below"]
    taken = scene.with_taken_view("below")
    assert [each.name for each in views_of(taken, "cameras", 1)] == ["beside", "below"]
    check_views(scene, views_of(scene, "cameras", 1), turning(scene, views_of(scene, "cameras", 1)))


@pytest.mark.parametrize(
    ("scene", "aspect"),
    [
        (car(), 4 / 3),
        (car().with_view(angle=20, field_of_view=50), 0.5),
        (wall_scene(view=View((3.0, -4.0, 9.0), target=(0.0, 0.0, 0.0))), 1.0),
        (wall_scene(cube(1e-300)), 4 / 3),
    ],
    ids=["car", "wide and narrow", "from above", "a point"],
)
def test_an_orbit_has_one_distance_at_which_the_object_just_fits(scene: Scene, aspect: float) -> None:
    views = around(scene, 7, aspect)
    middle = np.mean(scene.object_bounds, axis=0)
    assert {view.target for view in views} == {views[0].target}
    distances = [math.dist(view.eye, middle) for view in views]
    assert np.allclose(distances, distances[0], rtol=1e-9)
    reach = []
    for view in views:
        x, y, depth = view.axes @ (scene.object_coordinates - np.array(view.eye)).T
        half = view.half_height(aspect)
        assert (depth > 0).all()
        reach += [np.abs(x / depth).max() / (half * aspect), np.abs(y / depth).max() / half]
    assert max(reach) <= 0.86 + 1e-9
    if scene.object_bounds[1][0] > 1e-100:
        assert max(reach) == pytest.approx(0.86)


def test_an_orbit_begins_at_the_view_and_stays_above_a_stage() -> None:
    scene = car().replace(stage="floor", view=View((0.5, -3.0, -0.9), target=(0.0, 0.0, 0.0)))
    first, second, *_ = (np.array(view.eye) for view in around(scene, 4))
    assert first[2] >= np.mean(scene.object_bounds, axis=0)[2]
    middle = np.mean(scene.object_bounds, axis=0)
    away, beside = (each[:2] - middle[:2] for each in (first, second))
    toward = np.array(scene.view.eye[:2]) - middle[:2]
    assert np.allclose(away / np.hypot(*away), toward / np.hypot(*toward))
    assert np.allclose(beside, [-away[1], away[0]])


def page(scene: Scene, views: Any) -> None:
    save_page("never written.html", scene, size=SIZE, views=views)


LOW = [NamedView("low", BELOW)]
COUNTS = "the views of a page must be a whole number from 2 to 64, or 'cameras', not {}; give another number"
test_views_that_are_refused = refused(
    call,
    [
        (lambda: page(car(), 1), COUNTS.format("1")),
        (lambda: page(car(), "all"), COUNTS.format("'all'")),
        (
            lambda: page(car(), "cameras"),
            "a scene for views from its cameras must have a named view, not none; save one in the studio, or"
            " give a number of views",
        ),
        (
            lambda: page(car().replace(stage="floor", views=LOW), "cameras"),
            "view 'low': its surfaces must have the levels and bands that they have in the first view,"
            " because all views have one table; move its eye above the stage, or leave the scalar or the"
            " views out",
        ),
        (
            lambda: page(car().replace(mapping="equalize"), 2),
            "a page with views must have a mapping that stays with the exposure, not equalize, which follows"
            " the picture; set mapping to linear, or leave the views out",
        ),
        (
            lambda: page(car().replace(words="normals"), 2),
            "a page with views must have words that stand for levels, not for normals; render the scene with"
            ' words="levels", or leave the views out',
        ),
        (
            lambda: page(car().only_lights(), 2),
            "the picture of a page with views must have more than one intensity, or there is no exposure to"
            " hold; switch a light on, or leave the views out",
        ),
        (
            lambda: save_page("never written.html", car(), render(car(), SIZE), views=2),
            "views, size and smooth must be for a scene that is rendered, not for its picture; give the scene"
            " alone",
        ),
    ],
)


def test_more_pixels_than_a_browser_holds_are_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(exported, "MOST_VIEW_PIXELS", 3 * SIZE[0] * SIZE[1])
    save_page(tmp_path / "car.html", car(), size=SIZE, smooth=1, views=3)
    with pytest.raises(InputError, match="the views of a page must have at most 2,304 pixels together"):
        save_page(tmp_path / "more.html", car(), size=SIZE, smooth=1, views=4)
