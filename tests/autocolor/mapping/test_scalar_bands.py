from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Mesh, View, render, scene_of
from autocolor.mapping.display_image import display_image
from autocolor.mapping.scalar_bands import DARKEST, Bands, band_entries, band_numbers
from autocolor.scene.scalars.color_scales import scale_colors
from autocolor.scene.scalars.mesh_scalars import MeshScalar

values = st.floats(-20, 20, width=32) | st.just(math.nan) | st.sampled_from([1e30, -1e30, 0.0, 1.0, 4.0])


def band_of(value: float, bands: Bands) -> int:
    """The band of one value, step by step."""
    if math.isnan(value):
        return bands.bands + bands.has_below + bands.has_above
    rounding = 2.0**-20 * max(abs(bands.low), abs(bands.high))
    if value < bands.low - rounding:
        return bands.bands if bands.has_below else 0
    if value > bands.high + rounding:
        return bands.bands + bands.has_below if bands.has_above else bands.bands - 1
    band = math.floor((value - bands.low) / (bands.high - bands.low) * bands.bands)
    return min(max(band, 0), bands.bands - 1)


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


def test_a_value_at_the_upper_limit_is_in_the_last_band_and_one_that_rounding_put_beyond_it_too() -> None:
    bands = Bands(0.0, 250.0, 16, 8, has_above=True)
    just_beyond = np.nextafter(np.float32(250), np.float32(300))
    assert band_numbers(np.array([250, just_beyond, 251], np.float32), bands).tolist() == [15, 15, 16]


def test_the_bands_beyond_the_limits_follow_the_others() -> None:
    bands = Bands(0, 1, 10, 4, has_below=True, has_above=True, has_missing=True)
    assert (bands.below, bands.above, bands.missing) == (10, 11, 12)
    assert (bands.total, bands.levels) == (13, 52)
    assert bands.brightest(0) == 3
    assert bands.brightest(12) == bands.levels - 1


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
    image = display_image(scene, render(scene, lines, elements))
    ((first, levels),) = image.ranges.values()
    assert levels == 40
    # The plane fills the picture: 8 world units are its elements, whose centers are at half-integers.
    x = (np.arange(elements) + 0.5) / elements * 8 - 4
    bands = np.clip(np.floor((3 * x + 7 + 4) / 20 * 10), 0, 9)
    assert (image.words >= first).all()
    assert ((image.words - first) // 4 == bands).all()
