from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, Mesh, Scene, Surface, View, render, scene_of
from autocolor.images import display_image
from autocolor.mapping.bands import (
    DARKEST,
    Bands,
    band_entries,
    band_numbers,
    bands_by_surface,
    colored_surfaces,
    own_limits,
)
from autocolor.mapping.ranges import SURFACE_WORDS
from autocolor.scene.color_scales import scale_colors
from autocolor.scene.scalar import MeshScalar
from autocolor.testing import scenes
from tests.small import grid
from tests.tables import refused

values = (
    st.floats(-20, 20, width=32)
    | st.just(math.nan)
    | st.sampled_from([1e30, -1e30])
    # Limits, and what rounding puts just beyond them.
    | st.builds(np.nextafter, st.integers(-8, 8).map(np.float32), st.sampled_from([-99, 99]).map(np.float32))
    | st.integers(-8, 8).map(float)
)


def band_of(value: float, bands: Bands) -> int:
    """The band of one value, step by step."""
    if math.isnan(value):
        return bands.bands + bands.has_below + bands.has_above
    rounding = 2.0**-20 * max(abs(bands.low), abs(bands.high))
    if value < bands.low - rounding:
        return bands.bands if bands.has_below else 0
    if value > bands.high + rounding:
        return bands.bands + bands.has_below if bands.has_above else bands.bands - 1
    # An edge of a band is as wide as a limit.
    band = math.floor((max(value, bands.low) + rounding - bands.low) / (bands.high - bands.low) * bands.bands)
    return min(band, bands.bands - 1)


@given(
    st.lists(values, max_size=20),
    st.integers(-8, 0),
    st.integers(1, 8),
    st.integers(2, 30),
    st.booleans(),
    st.booleans(),
)
def test_each_value_is_in_its_band(
    values: list[float], low: int, high: int, count: int, has_below: bool, has_above: bool
) -> None:
    bands = Bands(low, high, count, 1, has_below, has_above, True)
    found = band_numbers(np.array(values, np.float32), bands)
    assert found.tolist() == [band_of(value, bands) for value in np.array(values, np.float32).tolist()]


@pytest.mark.parametrize(
    ("name", "limits", "normal"), [("draft angle", (-10, 10), (0, -1, 0)), ("slope", (0, 90), (0, -1, 1))]
)
def test_a_plane_whose_value_is_an_edge_of_a_band_has_one_color(
    name: str, limits: tuple[float, float], normal: tuple[float, float, float]
) -> None:
    # Many quads, whose nodes are rounded, all in one plane.
    across, unit = np.array([1.0, 0.0, 0.0]), np.array(normal) / np.linalg.norm(normal)
    plane = grid(30, 30, (0.1, 0.2, 0.3), tuple(across), tuple(np.cross(unit, across)))
    middle = plane.coordinates.mean(axis=0)
    view = View(tuple((middle + 4 * unit + 0.3 * across).tolist()), target=tuple(middle.tolist()))
    scene = scene_of(plane, view=view).with_scalar(name=name, limits=limits, bands=10, shades=1)
    picture = render(scene, (80, 60))
    assert picture.scalar_values is not None
    (bands,) = bands_by_surface(scene, picture).values()
    assert set(band_numbers(picture.scalar_values, bands).tolist()) == {5}


@pytest.mark.parametrize("shades", [1, 2, 8])
def test_the_highest_shade_of_a_band_has_its_color_and_the_lowest_a_part_of_it(shades: int) -> None:
    bands = Bands(0, 1, 5, shades, has_below=True, has_above=True, has_missing=True)
    entries = band_entries("turbo", ((10, 20, 30), (200, 0, 200)), (128, 128, 128), bands)
    assert entries.shape == (bands.levels, 3)
    by_band = entries.reshape(-1, shades, 3)
    colors = [*scale_colors("turbo", 5).tolist(), [10, 20, 30], [200, 0, 200], [128, 128, 128]]
    assert by_band[:, -1].tolist() == colors
    darkest = DARKEST if shades > 1 else 1.0
    assert by_band[:, 0].tolist() == np.floor(np.array(colors) * darkest + 0.5).tolist()


def test_with_a_floor_the_brightness_of_the_shades_is_in_proportion_to_it() -> None:
    bands = Bands(0, 1, 2, 3)
    entries = band_entries(((0, 0, 0), (200, 200, 200)), (None, None), (0, 0, 0), bands, floor=0.2)
    assert entries[3:, 0].tolist() == [40, 120, 200]


def test_a_linear_field_on_a_plane_gives_straight_bands_at_the_computed_places() -> None:
    # A square of 8 x 6 seen straight from above, so that the field is linear in the elements of the picture.
    coordinates = np.array([(-4, -3, 0), (4, -3, 0), (4, 3, 0), (-4, 3, 0)], float)
    field = MeshScalar("field", 3 * coordinates[:, 0] + 7)
    mesh = Mesh(coordinates, np.array([[0, 1, 2, 3]]), np.zeros(1, np.intp), ("plane",)).with_scalars(field)
    scene = scene_of(
        mesh,
        lights=[Light("key", (3.0, 2.0, 5.0))],
        view=View((0, 0, 10), direction=(0, 0, -1), field_of_view=2 * math.degrees(math.atan(0.3))),
        scalar={"name": "field", "bands": 10, "shades": 4, "limits": [-4, 16]},
    )
    lines, elements = 48, 64
    image = display_image(scene, render(scene, (elements, lines)))
    ((first, levels),) = image.ranges.values()
    assert levels == 40
    # The plane fills the picture: 8 world units are its elements, whose centers are at half-integers.
    x = (np.arange(elements) + 0.5) / elements * 8 - 4
    bands = np.clip(np.floor((3 * x + 7 + 4) / 20 * 10), 0, 9)
    assert (image.words >= first).all()
    assert ((image.words - first) // 4 == bands).all()


def panes(count: int, *values: float, **scalar: Any) -> Scene:
    """Quads side by side, each of a surface of its own, with a scalar of the polygons."""
    mesh = Mesh.joined(
        [grid(1, 1, (2.0 * number, 0, 0), (1, 0, 0), (0, 0, 1), f"pane {number}") for number in range(count)]
    )
    given_values = np.resize(np.array(values or (0.0, 10.0)), count)
    return scene_of(
        mesh.with_scalars(MeshScalar("stress", given_values, "polygon")),
        surfaces=[Surface(name) for name in mesh.part_names],
        surface_of_part={name: name for name in mesh.part_names},
    ).with_scalar(**{"name": "stress", **scalar})


def bands_of(scene: Scene) -> Any:
    return bands_by_surface(scene, render(scene, (32, 24)))


def test_the_surfaces_that_are_not_colored_share_the_rest_as_ever() -> None:
    scene = panes(3, surfaces=["pane 1"], shades=4)
    image = display_image(scene, render(scene, (32, 24)))
    assert list(image.bands) == ["pane 1"]
    assert image.ranges["pane 1"].levels == 64
    assert sum(each.levels for each in image.ranges.values()) == SURFACE_WORDS
    equal = display_image(scene.replace(division="equal"), image.picture)
    assert [each.levels for each in equal.ranges.values()] == [(SURFACE_WORDS - 64) // 2, 64, 471]


def test_a_surface_of_stage_parts_alone_keeps_its_own_colors_unless_it_is_named() -> None:
    scene = panes(2).with_part("pane 0", stage=True)
    assert list(colored_surfaces(scene)) == ["pane 1"]
    assert list(colored_surfaces(scene.with_scalar(surfaces=["pane 0"]))) == ["pane 0"]
    assert list(colored_surfaces(scene.without_scalar())) == []


def test_missing_values_have_a_band_on_the_surfaces_where_they_are_seen() -> None:
    bands = bands_of(panes(2, np.nan, 3.0))
    assert bands["pane 0"].has_missing
    assert not bands["pane 1"].has_missing


def test_values_beyond_the_limits_have_bands_where_there_are_limits_and_colors() -> None:
    with_colors = {"below": "black", "above": "red"}
    (bands, *_) = bands_of(panes(2, limits=[2, 8], **with_colors)).values()
    assert (bands.has_below, bands.has_above) == (True, True)
    (bands, *_) = bands_of(panes(2, **with_colors)).values()
    assert (bands.has_below, bands.has_above) == (False, False)
    (bands, *_) = bands_of(panes(2, limits=[2, 8], above="red")).values()
    assert (bands.has_below, bands.has_above) == (False, True)


@pytest.mark.parametrize(
    ("values", "limits"),
    [
        ((2.0, 5.0), (2.0, 5.0)),
        ((4.0, 4.0), (2.0, 6.0)),
        ((0.0, 0.0), (-0.5, 0.5)),
        ((-4.0, -4.0), (-6.0, -2.0)),
        ((np.nan, np.nan), (0.0, 1.0)),
    ],
)
def test_the_own_limits_are_the_range_of_the_values_or_around_a_constant(
    values: tuple[float, ...], limits: tuple[float, float]
) -> None:
    assert own_limits(render(panes(2, *values), (32, 24))) == limits


@given(scenes())
def test_every_word_of_a_colored_surface_tells_band_and_shade(scene: Scene) -> None:
    picture = render(scene, (12, 9))
    image = display_image(scene, picture)
    for name, bands in image.bands.items():
        first, levels = image.ranges[name]
        assert levels == bands.levels
        seen = image.words[picture.surface_number == picture.surfaces.index(name) + 1]
        assert ((seen >= first) & (seen < first + levels)).all()


def test_without_a_scalar_or_its_values_there_are_no_bands() -> None:
    scene = panes(2)
    assert bands_of(scene.without_scalar()) == {}
    assert bands_by_surface(scene, render(scene.without_scalar(), (12, 9))) == {}


def test_as_many_shades_are_made_as_are_asked_for_or_at_most_eight_that_the_words_suffice_for() -> None:
    for count, bands, asked, shades in (
        (2, 16, None, 8),
        (2, 100, None, 5),
        (60, 16, None, 1),
        (2, 30, 16, 16),
    ):
        of_surfaces = bands_of(panes(count, bands=bands, shades=asked)).values()
        assert {(each.bands, each.shades) for each in of_surfaces} == {(bands, shades)}


test_too_many_bands_are_refused_with_the_words_left_and_a_remedy = refused(
    bands_of,
    [
        (
            panes(2, bands=64, shades=8),
            "surface 'pane 0' and 1 more: bands times shades must be at most 1007, the words that are left,"
            " not 128 x 8 = 1024; choose at most 7 shades, or fewer bands",
        ),
        (
            panes(5, bands=256),
            "surface 'pane 0' and 4 more: bands times shades must be at most 1007, the words that are left,"
            " not 1280 x 1 = 1280; choose fewer bands, or color fewer surfaces",
        ),
    ],
    InputError,
)
