from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

import autocolor
from autocolor import Scene
from benchmarks.agreement import MOST_PERCENTILE
from benchmarks.comparison import BRIGHTEST, EDITS, comparison_scene, expected
from benchmarks.contestants import FAR
from benchmarks.peers.triangles import triangles


@pytest.fixture(scope="module")
def scene() -> Scene:
    return comparison_scene()


def test_8_bits_can_say_every_intensity(scene: Scene) -> None:
    assert autocolor.render(scene).ranges.whole.maximum == pytest.approx(BRIGHTEST)


def test_no_light_has_a_flap(scene: Scene) -> None:
    assert all(light.flaps == autocolor.Flaps() for light in scene.lights)


def test_each_edit_shows_as_more_than_an_agreement_allows(scene: Scene) -> None:
    fields = [expected(edit(scene, FAR))[0] for edit in EDITS.values()]
    fields.append(expected(scene)[0])
    for one, other in combinations(fields, 2):
        assert np.percentile(np.abs(one - other), 99) > 3 * MOST_PERCENTILE


def test_an_edit_that_is_made_again_changes_the_scene_again(scene: Scene) -> None:
    for edit in EDITS.values():
        once = edit(scene, 1e-3)
        assert not once.equals(scene)
        assert not edit(once, 1e-3).equals(once)


def test_the_triangles_of_the_peers_are_the_polygons_of_the_mesh(scene: Scene) -> None:
    mesh = scene.mesh
    every = triangles(scene)
    assert [each.surface for each in every] == list(range(len(scene.surfaces)))
    assert sum(len(each.corners) for each in every) == 2 * len(mesh.node_numbers) - mesh.triangle_count
    corners = mesh.coordinates[mesh.node_numbers]
    vectors = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]).sum(axis=0) / 2
    halves = np.zeros(3)
    for each in every:
        a, b, c = np.moveaxis(each.places[each.corners].astype(np.float64), 1, 0)
        halves += np.cross(b - a, c - a).sum(axis=0) / 2
    np.testing.assert_allclose(halves, vectors, atol=1e-4)


def test_triangles_share_the_nodes_that_share_a_normal(scene: Scene) -> None:
    for each in triangles(scene):
        rows = np.hstack([each.places, each.normals])
        assert len(np.unique(each.corners)) == len(rows)
    assert sum(len(each.places) for each in triangles(scene)) < 2 * len(scene.mesh.node_numbers)
