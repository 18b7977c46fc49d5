from __future__ import annotations

import pickle

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility.visible_parts import VisibleParts
from autocolor.visibility.visible_surfaces import visible_surfaces
from autocolor.visibility.watkins import watkins
from tests.autocolor.meshes import cube
from tests.autocolor.reference import first_hit, ray
from tests.autocolor.strategies import meshes, outside_views, soups

RASTER = (9, 12)


def in_parts(mesh: Mesh, count: int) -> Mesh:
    """The mesh with its polygons dealt out to so many parts."""
    numbers = np.arange(len(mesh.node_numbers)) % count
    return Mesh(mesh.coordinates, mesh.node_numbers, numbers, tuple(f"part {each}" for each in range(count)))


@given(soups(), outside_views(), st.integers(1, 4))
def test_the_part_at_a_pixel_is_that_of_the_polygon_that_a_ray_meets_first(
    soup: Mesh, view: View, count: int
) -> None:
    mesh = in_parts(soup, count)
    points = visible_surfaces(mesh, view, (1,) * count, *RASTER)
    numbers = np.zeros(RASTER[0] * RASTER[1], int)
    numbers[points.pixels] = points.parts.numbers
    for pixel, number in enumerate(numbers.tolist()):
        hit = first_hit(mesh, view.eye, ray(view, *RASTER, *divmod(pixel, RASTER[1])))
        if hit.clear > 1e-3 and hit.depth > 1e-3:
            assert number == (0 if hit.polygon < 0 else mesh.part_numbers[hit.polygon] + 1)


@given(meshes(), outside_views())
def test_the_literal_watkins_sees_the_same_parts(mesh: Mesh, view: View) -> None:
    one, other = (find(mesh, view, (1, 1), *RASTER) for find in (visible_surfaces, watkins))
    assert one.parts.numbers.tolist() == other.parts.numbers.tolist()


def test_part_numbers_are_worked_out_once_when_they_are_asked_for_and_read_only() -> None:
    view = View((3, -4, 4), target=(0.5, 0.5, 0.5))
    parts = visible_surfaces(in_parts(cube(), 6), view, (1,) * 6, *RASTER).parts
    assert "numbers" not in vars(parts)
    assert parts.numbers is parts.numbers
    assert parts.numbers.dtype == np.int32
    assert set(parts.numbers.tolist()) == {2, 3, 6}
    for each in (parts, pickle.loads(pickle.dumps(parts))):
        assert not each.numbers.flags.writeable
        assert each.numbers.tolist() == parts.numbers.tolist()


def test_a_mesh_may_have_more_parts_than_16_bits_can_count() -> None:
    many = 70_000
    mesh = Mesh(cube().coordinates, cube().node_numbers, np.full(6, many - 1), tuple(map(str, range(many))))
    parts = visible_surfaces(mesh, View((3, -4, 2), target=(0, 0, 0)), (1,) * many, *RASTER).parts
    assert set(parts.numbers.tolist()) == {many}


@given(st.lists(st.integers(1, 3)))
def test_parts_of_points_are_the_numbers_that_they_were_made_of(numbers: list[int]) -> None:
    parts = VisibleParts.of_points(("a", "b", "c"), np.array(numbers, np.int32))
    assert parts.numbers.tolist() == numbers
