from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View
from autocolor.screens.light_and_view.areas import area_of_picture
from autocolor.screens.light_and_view.mesh_edges import mesh_edges
from autocolor.screens.light_and_view.perspective_strokes import perspective_strokes
from autocolor.visibility.projection import projection
from autocolor.widgets.areas import Area
from tests.autocolor.meshes import cube, sphere, wall
from tests.autocolor.strategies import meshes, views

AREA = area_of_picture(Area(256, 0, 503, 223))


def test_edges_are_where_the_renderer_has_their_pixels() -> None:
    view = View((4.0, 5.0, 6.0), target=(0.5, 0.5, 0.5), angle=20.0)
    edges = mesh_edges(cube())
    projected = projection(cube(), view, AREA.height, AREA.width)
    # The renderer has the centers of pixels at halves.
    places = np.stack([projected.x - 0.5 + AREA.left, projected.y - 0.5 + AREA.top], axis=1)
    found = perspective_strokes(edges.coordinates, edges.features, view, AREA)
    assert found == pytest.approx(places[edges.features].reshape(-1, 4))


def test_the_height_of_the_area_is_the_field_of_view() -> None:
    view = View((0.0, -1.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=90.0)
    edges = mesh_edges(wall(half=0.98))
    found = perspective_strokes(edges.coordinates, edges.features, view, Area(0, 0, 99, 99))
    # At 45 degrees a unit is half the height: the outer pixels end at -0.5 and 99.5.
    assert (found.min(), found.max()) == pytest.approx((49.5 - 49, 49.5 + 49))
    assert len(found) == 4


def test_what_is_behind_the_eye_is_left_out_and_what_passes_it_is_cut_off() -> None:
    view = View((0.0, 0.0, 0.0), direction=(0.0, 1.0, 0.0), field_of_view=90.0)
    points = np.array([(0.5, 1, 0), (0.5, -1, 0), (0, -1, 0), (0, -2, 0)], np.float64)
    middle = AREA.middle[0]
    found = perspective_strokes(points, np.array([(0, 1), (1, 0), (2, 3)]), view, AREA)
    one = [middle + AREA.height / 4, AREA.middle[1]]
    end = [AREA.right, AREA.middle[1]]
    assert found.tolist() == [[*one, *end], [*end, *one]]


def test_an_eye_within_the_object_sees_its_edges() -> None:
    view = View((0.5, 0.5, 0.5), direction=(0.3, 1.0, 0.1), field_of_view=120.0)
    edges = mesh_edges(cube())
    found = perspective_strokes(edges.coordinates, edges.features, view, AREA)
    assert 4 <= len(found) < 12


@given(meshes(), views())
def test_all_strokes_are_within_the_area(mesh: Mesh, view: View) -> None:
    edges = mesh_edges(mesh)
    found = perspective_strokes(edges.coordinates, edges.features, view, AREA)
    assert (found >= [AREA.left, AREA.top] * 2).all()
    assert (found <= [AREA.right, AREA.bottom] * 2).all()


def test_no_size_of_the_object_makes_a_difference() -> None:
    edges = mesh_edges(sphere(8, 5), crease_angle=1)
    view = View((3.0, 4.0, 1.0), target=(0.0, 0.0, 0.0))
    expected = perspective_strokes(edges.coordinates, edges.features, view, AREA)
    for size in (2.0**-60, 2.0**60):
        scaled = View((3 * size, 4 * size, size), target=(0.0, 0.0, 0.0))
        found = perspective_strokes(edges.coordinates * size, edges.features, scaled, AREA)
        assert found == pytest.approx(expected)
