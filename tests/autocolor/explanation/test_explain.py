from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Scene, UsageError
from autocolor.errors import InputError
from autocolor.explanation.explain import explain
from autocolor.images import display_image
from autocolor.mapping.display_image import DisplayImage
from autocolor.rendering import Rendering, rendering
from autocolor.testing import scenes
from autocolor.visibility.visible_points import Sight
from tests.small import car, opened, wall_scene

LINES, ELEMENTS = 24, 32


def rendered(scene: Scene, elements: int = ELEMENTS) -> tuple[Rendering, DisplayImage]:
    both = rendering(scene, LINES, elements)
    return both, display_image(scene, both.picture)


@given(scenes(), st.sampled_from([20, ELEMENTS, 40]), st.integers(0, 1 << 30))
def test_an_explanation_agrees_with_the_picture(scene: Scene, elements: int, seed: int) -> None:
    try:
        both, image = rendered(scene, elements)
    except InputError:
        # The bands and levels of some random scenes do not fit into the words.
        return
    picture, sight = both.picture, Sight(scene, both.points)
    whole = picture.ranges.whole.maximum
    for place in np.random.default_rng(seed).permutation(len(picture.pixels))[:3].tolist():
        line, element = divmod(int(picture.pixels[place]), elements)
        explanation = explain(sight, image, line, element)
        at = explanation.point
        assert at is not None
        assert at.surface == picture.surface_number[line, element]
        assert at.part == picture.part_number[line, element]
        assert explanation.word == int(image.words[line, element])
        assert explanation.color == tuple(image.entries[explanation.word].tolist())
        intensity = float(picture.intensity[line, element])
        assert explanation.intensity == pytest.approx(intensity, abs=1e-4 * whole)


def test_all_lights_and_the_ambient_light_add_up_to_the_intensity() -> None:
    studio, _ = opened()
    explanation = studio.explain(12, 16)
    assert explanation.intensity == pytest.approx(
        studio.scene.ambient + sum(light.contribution for light in explanation.lights)
    )
    contributions = [light.contribution for light in explanation.lights]
    assert contributions == sorted(contributions, reverse=True)
    assert {light.name for light in explanation.lights} == {light.name for light in studio.scene.lights}
    assert explanation.point is not None
    for light in explanation.lights:
        row = studio.scene.lights[light.name]
        assert light.light == studio.scene.lights.index(row) + 1
        if row.axis is None:
            assert light.cos_light is None
        else:
            ray = np.array(explanation.point.point) - row.position
            assert light.cos_light == pytest.approx(ray @ row.axis / np.linalg.norm(ray))


def test_rows_are_counted_from_1_and_lead_from_the_nodes_to_the_surface() -> None:
    studio, _ = opened()
    scene, at = studio.scene, studio.explain(12, 16).point
    assert at is not None
    seen = studio.seen_at(12, 16)
    assert seen is not None
    assert at.polygon == seen.polygon + 1
    nodes = dict.fromkeys(scene.mesh.node_numbers[seen.polygon].tolist())
    assert [corner.node - 1 for corner in at.corners] == list(nodes)
    for corner in at.corners:
        assert corner.coordinates == tuple(scene.mesh.coordinates[corner.node - 1].tolist())
    assert scene.parts[at.part - 1].name == at.part_name == seen.part
    assert scene.surfaces[at.surface - 1].name == at.surface_name == seen.surface
    assert at.point == pytest.approx(seen.point, abs=1e-5)
    assert at.normal == pytest.approx(seen.normal, abs=1e-5)
    assert at.reflected_view == pytest.approx(seen.reflected_view, abs=1e-5)


def test_on_the_background_nothing_is_seen() -> None:
    studio, _ = opened(car().replace(background="#102030"))
    explanation = studio.explain(0, 0)
    assert (explanation.point, explanation.level, explanation.intensity) == (None, None, None)
    assert (explanation.word, explanation.color) == (0, (16, 32, 48))


@pytest.mark.parametrize(("line", "element"), [(24, 0), (0, 32), (-1, 0), (0.5, 0)])
def test_a_pixel_outside_of_the_picture_is_refused(line: int, element: int) -> None:
    with pytest.raises(UsageError, match=r"an? (line|element) must be 0 to (23|31), not"):
        opened()[0].explain(line, element)


def test_where_words_stand_for_normals_the_entry_is_the_words() -> None:
    studio, _ = opened()
    studio.normals()
    studio.light("key", intensity=2.0)
    explanation = studio.explain(12, 16)
    assert explanation.level is None
    assert explanation.word == studio.words[12, 16]
    assert explanation.color == tuple(studio.entries[explanation.word].tolist())
    # The intensity is that of the point, in the light of now.
    assert explanation.intensity == pytest.approx(float(studio.picture.intensity[12, 16]), rel=1e-4)


def test_a_coarse_picture_is_explained_by_its_blocks_and_refined_by_the_studio() -> None:
    scene = car()
    both = rendering(scene, LINES // 2, ELEMENTS // 2)
    image = display_image(scene, both.picture, block=2)
    sight = Sight(scene, both.points, 2)
    pixels = [(12, 16), (13, 16), (12, 17), (13, 17)]
    found = [explain(sight, image, line, element) for line, element in pixels]
    assert {each.word for each in found} == {int(image.words[12, 16])}
    assert len({each.point for each in found}) == 1


def test_json_can_hold_everything() -> None:
    scene = car().with_scalar(name="stress", missing="#010203")
    studio, _ = opened(scene)
    line, element = np.array([12, 16])
    plain = studio.explain(line, element).to_plain()
    assert json.loads(json.dumps(plain, allow_nan=False))["level"]["scalar"]["value"] is None
    assert plain["color"] == (1, 2, 3) or plain["level"]["brightness"] < 1
    assert opened()[0].explain(0, 0).to_plain()["point"] is None


def test_an_edit_changes_the_numbers_that_it_should() -> None:
    studio, _ = opened(wall_scene())
    before = studio.explain(12, 16)
    studio.light(studio.scene.lights[0].name, intensity=3 * studio.scene.lights[0].intensity)
    after = studio.explain(12, 16)
    assert after.point == before.point
    name = studio.scene.lights[0].name
    one, three = (next(light for light in each.lights if light.name == name) for each in (before, after))
    assert three.contribution == pytest.approx(3 * one.contribution)
    assert math.isclose(three.cos_incidence, one.cos_incidence)
