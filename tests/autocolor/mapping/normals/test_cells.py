from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Singles
from autocolor.mapping.normals.cells import BINS, cells_of, spread_of


def unit(vectors: object) -> Singles:
    array = np.asarray(vectors, np.float64)
    normalized: Singles = (array / np.linalg.norm(array, axis=0)).astype(np.float32)
    return normalized


def ball(radius: int) -> Singles:
    """The normals of a ball that is seen from far away, one at each pixel."""
    y, x = np.mgrid[-radius:radius, -radius:radius] + 0.5
    inside = x * x + y * y < radius * radius
    x, y = x[inside] / radius, y[inside] / radius
    return unit([x, y, -np.sqrt(1 - x * x - y * y)])


@given(st.integers(0, 2**31), st.integers(1, 400), st.integers(2, 60), st.sampled_from([0.02, 0.5, 3.0]))
def test_every_cell_holds_a_normal_and_there_are_at_most_as_many_as_asked_for(
    seed: int, count: int, most: int, spread: float
) -> None:
    generator = np.random.default_rng(seed)
    normals = unit(generator.normal(size=(3, count)) * spread + np.array([[0.3], [0.1], [-1.0]]))
    cells = cells_of(normals, most)
    assert cells.normals.dtype == np.float32
    assert cells.normals.shape[1] <= most
    assert np.unique(cells.numbers).tolist() == list(range(cells.normals.shape[1]))
    assert cells.normals.shape[1] <= cells.samples.shape[1] <= count
    # The normal of each cell is the mean of those in it.
    for number, normal in enumerate(cells.normals.T):
        mean = normals[:, cells.numbers == number].astype(np.float64).sum(axis=1)
        assert normal == pytest.approx(mean / np.linalg.norm(mean), abs=1e-5)


def test_a_ball_takes_all_cells_and_each_normal_is_in_one_of_the_nearest() -> None:
    normals = ball(150)
    cells = cells_of(normals, 1000)
    assert cells.normals.shape[1] > 980
    cosines = normals.T @ cells.normals
    own = np.take_along_axis(cosines, cells.numbers[:, None], axis=1)[:, 0]
    angles, nearest = np.arccos(np.clip([own, cosines.max(axis=1)], -1, 1))
    # A pixel may be beyond the border of its cell by no more than its bin reaches.
    assert (angles - nearest).max() < 2 * np.sqrt(2) * 2 / BINS
    # So many cells of a hemisphere have a radius of 0.045 each.
    assert angles.mean() < 0.04
    assert angles.max() < 0.15


def test_cells_are_spread_over_all_that_is_seen_and_denser_where_it_is_larger() -> None:
    cells = cells_of(ball(150), 1000)
    # In zones of equal area, from the silhouette to the middle, where one covers seven times the pixels.
    counts, _ = np.histogram(-cells.normals[2], bins=np.linspace(0, 1, 5))
    assert 100 < counts[0] < counts[-1] < 400


def test_as_few_normals_as_there_are_cells_have_a_cell_each() -> None:
    normals = unit([[0, 0, 0.7, 0, 0.7], [0, 0.5, 0, 0, 0], [-1, -0.8, -0.7, -1, -0.7]])
    cells = cells_of(normals, 3)
    assert cells.normals[:, cells.numbers] == pytest.approx(normals, abs=1e-6)
    assert cells.normals.shape[1] == 3


def test_a_flat_surface_has_one_cell_whatever_the_rounding_of_its_normals() -> None:
    generator = np.random.default_rng(1)
    flat = unit(np.array([[0.2], [-0.4], [-0.9]]) + generator.normal(size=(3, 500)) * 1e-6)
    cells = cells_of(flat, 300)
    assert cells.normals.shape == (3, 1)
    assert cells.normals[:, 0] == pytest.approx(flat[:, 0], abs=1e-5)
    assert spread_of(flat) == 1


def test_normals_that_differ_little_still_take_the_cells() -> None:
    generator = np.random.default_rng(2)
    normals = unit(np.array([[0.2], [-0.4], [-0.9]]) + generator.uniform(-0.02, 0.02, size=(3, 9000)))
    assert cells_of(normals, 300).normals.shape[1] > 290


def test_the_same_normals_give_the_same_cells() -> None:
    one, other = cells_of(ball(40), 100), cells_of(ball(40), 100)
    assert one.normals.tobytes() == other.normals.tobytes()
    assert one.numbers.tobytes() == other.numbers.tobytes()


def test_no_normals_have_no_cells_and_a_zero_normal_has_one() -> None:
    nothing = cells_of(np.empty((3, 0), np.float32), 10)
    assert nothing.normals.shape == (3, 0)
    assert nothing.numbers.shape == (0,)
    zero = cells_of(np.zeros((3, 4), np.float32), 10)
    assert zero.normals.tolist() == [[0], [0], [0]]
    assert zero.numbers.tolist() == [0, 0, 0, 0]


def test_normals_that_face_away_from_the_eye_have_cells_too() -> None:
    normals = unit([[0.1, 0.0, 1.0, -1.0], [0.0, 0.0, 0.2, 0.3], [0.99, -1.0, 0.9, 0.8]])
    cells = cells_of(normals, 4)
    assert cells.normals[:, cells.numbers] == pytest.approx(normals, abs=1e-6)


def test_the_spread_of_normals_is_how_much_of_the_sphere_they_take() -> None:
    half = spread_of(ball(400))
    # Half of the sphere is half of the disk in the square of all bins.
    assert half == pytest.approx(np.pi / 4 * BINS**2 / 2, rel=0.03)
    front = ball(400)
    # A cap of half the height has half the area of the half sphere.
    assert spread_of(front[:, front[2] < -0.5]) == pytest.approx(half / 2, rel=0.03)
