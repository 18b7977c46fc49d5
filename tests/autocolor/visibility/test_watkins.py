"""The literal algorithm and the one for all lines at once give the same visible points, bit for bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility import watkins as watkins_room
from autocolor.visibility.depth import polygons_of_numbers
from autocolor.visibility.projection import projection
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from autocolor.visibility.watkins import numbers_by_line, watkins
from tests.autocolor.decals import ROUNDINGS, decal_on_ground
from tests.autocolor.strategies import interpolations, rasters, soups
from tests.small import cube, grid, sphere
from tests.tables import first


def assert_same(one: VisiblePoints, other: VisiblePoints) -> None:
    assert one.pixels.tolist() == other.pixels.tolist()
    assert one.polygon_numbers.tolist() == other.polygon_numbers.tolist()
    assert [(s.surface_number, s.start, s.stop) for s in one.slices] == [
        (s.surface_number, s.start, s.stop) for s in other.slices
    ]
    assert one.parts.numbers.tolist() == other.parts.numbers.tolist()
    assert one.rows.tobytes() == other.rows.tobytes()


@given(
    meshes(),
    views() | outside_views(),
    rasters,
    st.sampled_from([frozenset[int](), frozenset({1})]),
    interpolations,
)
def test_batch_and_watkins_agree_on_any_mesh(
    mesh: Mesh, view: View, raster: tuple[int, int], one_sided: frozenset[int], interpolation: str
) -> None:
    arguments = (mesh, view, (1, 2), *raster, one_sided, interpolation)
    assert_same(visible_surfaces(*arguments), watkins(*arguments))


@given(soups(), outside_views(), rasters)
def test_batch_and_watkins_agree_where_polygons_pass_through_each_other(
    mesh: Mesh, view: View, raster: tuple[int, int]
) -> None:
    assert_same(visible_surfaces(mesh, view, (1,), *raster), watkins(mesh, view, (1,), *raster))


@given(
    st.integers(0, 1 << 32),
    st.sampled_from(ROUNDINGS),
    rasters,
    outside_views() | st.none(),
    interpolations,
)
def test_batch_and_watkins_agree_on_decals(
    seed: int, rounding: str, raster: tuple[int, int], view: View | None, interpolation: str
) -> None:
    mesh, before = decal_on_ground(seed, rounding)
    arguments = (mesh, view or before, (1, 2), *raster, frozenset[int](), interpolation)
    assert_same(visible_surfaces(*arguments), watkins(*arguments))


THROUGH_EACH_OTHER = Mesh(
    np.random.default_rng(83).uniform(-1, 1, (90, 3)),
    np.arange(90).reshape(-1, 3),
    np.zeros(30, np.intp),
    ("soup",),
)


LARGER = [THROUGH_EACH_OTHER, sphere(), grid(9, 7, (-1, 0, -1), (2, 0.3, 0), (0, 0, 2))]


@pytest.mark.parametrize("mesh", first(2, LARGER))
def test_batch_and_watkins_agree_on_a_larger_picture(mesh: Mesh) -> None:
    view = View((3.0, -5.0, 2.0), target=(0.2, 0.1, 0.0))
    assert_same(visible_surfaces(mesh, view, (1,), 60, 80), watkins(mesh, view, (1,), 60, 80))


def test_batch_and_watkins_find_nothing_in_an_empty_mesh() -> None:
    empty = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())
    view = View((0.0, -1.0, 0.0), target=(0.0, 0.0, 0.0))
    assert_same(visible_surfaces(empty, view, (), 4, 5), watkins(empty, view, (), 4, 5))
    assert len(visible_surfaces(empty, view, (), 4, 5).pixels) == 0


@given(meshes() | soups(), views() | outside_views(), rasters, interpolations)
def test_the_lines_one_after_the_other_have_the_polygons_of_the_batch(
    mesh: Mesh, view: View, raster: tuple[int, int], interpolation: str
) -> None:
    batch = visible_surfaces(mesh, view, (1, 2), *raster, interpolation=interpolation)
    expected = np.full(raster, -1).ravel()
    expected[batch.pixels] = batch.polygon_numbers
    projected = projection(mesh, view, *raster, interpolation)
    for numbers, of_batch in zip(numbers_by_line(projected), expected.reshape(raster), strict=True):
        polygons = np.full(raster[1], -1)
        seen = numbers > 0
        polygons[seen] = projected.polygon_numbers[polygons_of_numbers(projected, numbers[seen])]
        assert polygons.tolist() == of_batch.tolist()


def test_a_line_is_computed_when_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    computed: list[int] = []

    def segments_of_line(active: list[watkins_room.Edge], *arguments: Any) -> list[watkins_room.Segment]:
        computed.append(arguments[-1])
        return []

    monkeypatch.setattr(watkins_room, "segments_of_line", segments_of_line)
    lines = numbers_by_line(projection(cube(), View((3.0, -5.0, 2.0), target=(0.0, 0.0, 0.0)), 9, 12))
    assert computed == []
    next(lines)
    next(lines)
    assert computed == [0, 1]
