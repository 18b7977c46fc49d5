from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh, View, render, scene_of
from autocolor.visibility.projection import focal_length, projection
from tests.autocolor.meshes import cube, grid
from tests.autocolor.reference import ray
from tests.autocolor.strategies import Vector, directions, meshes, rasters, vectors, views


@given(vectors(), directions, rasters)
def test_the_rays_of_the_lens_go_through_the_centers_of_the_pixels(
    eye: Vector, direction: Vector, raster: tuple[int, int]
) -> None:
    view = View(eye, direction=direction, field_of_view=50)
    focal = focal_length(raster[0], 50.0)
    for pixel in range(raster[0] * raster[1]):
        expected = view.axes @ np.array(ray(view, *raster, *divmod(pixel, raster[1])))
        line, element = divmod(pixel, raster[1])
        x, y = (element + 0.5 - raster[1] / 2) / focal, (line + 0.5 - raster[0] / 2) / focal
        assert (x, y, 1.0) == pytest.approx(expected, abs=1e-5)


def test_pixels_are_square_and_the_field_of_view_is_the_vertical_one() -> None:
    view = View((0, -1, 0), direction=(0, 1, 0), field_of_view=90)
    panel = grid(1, 1, (-1, 0, -1), (2, 0, 0), (0, 0, 2))
    projected = projection(panel, view, 100, 300)
    assert np.sort(projected.x) == pytest.approx([100, 100, 200, 200])
    assert np.sort(projected.y) == pytest.approx([0, 0, 100, 100])


@given(meshes(), views(), rasters)
def test_no_line_crosses_a_polygon_more_than_twice(mesh: Mesh, view: View, raster: tuple[int, int]) -> None:
    projected = projection(mesh, view, *raster)
    first_lines = projected.first_line[projected.corners]
    for line in range(raster[0]):
        above = first_lines <= line
        crossed = (above != np.roll(above, -1, axis=0)).sum(axis=0)
        assert set(crossed.tolist()) <= {0, 2}


@given(meshes(), views(), rasters)
def test_what_is_projected_is_before_the_eye_and_finite(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    projected = projection(mesh, view, *raster)
    used = np.unique(projected.corners)
    assert np.isfinite(projected.x[used]).all()
    assert np.isfinite(projected.y[used]).all()
    assert (projected.inverse_depth[used] > 0).all()
    assert (np.diff(projected.polygon_numbers) >= 0).all()
    assert set(projected.polygon_numbers.tolist()) <= set(range(len(mesh.node_numbers)))


@pytest.mark.parametrize(("eye", "from_behind"), [((0, -3, 0), False), ((0, 3, 0), True)])
def test_a_polygon_is_seen_from_behind_when_it_runs_clockwise_to_the_eye(
    eye: Vector, from_behind: bool
) -> None:
    panel = grid(1, 1, (-1, 0, -1), (2, 0, 0), (0, 0, 2))
    assert projection(panel, View(eye, target=(0, 0, 0)), 10, 10).from_behind.tolist() == [from_behind]


def test_a_node_that_no_polygon_uses_changes_nothing() -> None:
    mesh = cube()
    scene = scene_of(mesh)
    stray = Mesh(
        np.concatenate([mesh.coordinates, [(1e25, 0, 0), (0, 0, -1e30)]]),
        mesh.node_numbers,
        mesh.part_numbers,
        mesh.part_names,
    )
    pictures = [render(scene.replace(mesh=each), 30, 40) for each in (mesh, stray)]
    assert pictures[0].intensity.tobytes() == pictures[1].intensity.tobytes()


def test_a_dart_is_split_at_its_notch() -> None:
    # The notch points down; a line below the tip of the notch crosses the dart four times.
    dart = Mesh(
        np.array([(-1, 0, 1), (0, 0, -1), (1, 0, 1), (0, 0, 0.2)]),
        np.array([(0, 1, 2, 3)]),
        np.zeros(1, np.intp),
        ("dart",),
    )
    for angle in (0, 90, 180, 270, 37):
        view = View((0, -4, 0), direction=(0, 1, 0), angle=angle, field_of_view=40)
        scene = scene_of(dart, view=view)
        covered = render(scene, 64, 64).surface_number > 0
        for line, element in np.ndindex(64, 64):
            x, _, z = (4 * part for part in ray(view, 64, 64, line, element))
            x = abs(x)
            inside_by = min((z - (2 * x - 1)) / 2.3, ((0.2 + 0.8 * x) - z) / 1.3)
            if abs(inside_by) > 1e-6:
                assert covered[line, element] == (inside_by > 0)
