from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given

from autocolor import Mesh
from autocolor.scene.geometry import curvature
from autocolor.testing import meshes
from tests.small import cube, grid, sphere, wall

Array = npt.NDArray[np.float64]


def nodes_of_normals(mesh: Mesh) -> npt.NDArray[np.intp]:
    """A node at each normal."""
    nodes = np.zeros(len(mesh.normals.vectors), np.intp)
    nodes[mesh.normals.numbers.ravel()] = mesh.node_numbers.ravel()
    return nodes


def places(mesh: Mesh) -> Array:
    """The coordinates at each normal, (normals, 3)."""
    found: Array = mesh.coordinates[nodes_of_normals(mesh)]
    return found


def torus(around: int, across: int, ring: float = 1.0, tube: float = 0.4) -> Mesh:
    """A ring about z of `around` x `across` quads, facing outward."""
    turn, bend = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across)
    off_axis = ring + tube * np.cos(bend)
    coordinates = np.stack([off_axis * np.cos(turn), off_axis * np.sin(turn), tube * np.sin(bend)], axis=-1)
    row, column = np.arange(across)[:, None], np.arange(around)

    def node(row: npt.NDArray[np.intp], column: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
        return row % across * around + column % around

    corners = (node(row, column), node(row, column + 1), node(row + 1, column + 1), node(row + 1, column))
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    return Mesh(coordinates.reshape(-1, 3), quads, part_names=("torus",))


def heights(columns: int, rows: int, height: Callable[[Array, Array], Array], size: float = 1.0) -> Mesh:
    """A patch around the origin over [-size, size] in x and y, facing up."""
    flat = grid(columns, rows, (-size, -size, 0.0), (2 * size, 0.0, 0.0), (0.0, 2 * size, 0.0))
    x, y, _ = flat.coordinates.T
    return Mesh(np.stack([x, y, height(x, y)], axis=1), flat.node_numbers, part_names=("patch",))


def scattered(count: int, seed: int, shape: Callable[[Array, Array], Array]) -> Mesh:
    """Triangles of random density over the unit square; `shape` gives their places, (nodes, 3)."""
    random = np.random.default_rng(seed)

    def line() -> Array:
        sums = np.cumsum(random.uniform(0.3, 1.7, count))
        places: Array = np.append(0, sums) / sums[-1]
        return places

    across, upward = np.meshgrid(line(), line())
    for table, axis in ((across, 1), (upward, 0)):
        gaps = np.diff(table, axis=axis)
        least = np.minimum(np.delete(gaps, 0, axis), np.delete(gaps, -1, axis))
        inner = np.delete(np.delete(least, 0, 1 - axis), -1, 1 - axis)
        table[1:-1, 1:-1] += random.uniform(-0.25, 0.25, inner.shape) * inner
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    quads = np.stack([corner, corner + 1, corner + count + 2, corner + count + 1], axis=1)
    turned = random.random(len(quads)) < 0.5
    quads[turned] = np.roll(quads[turned], 1, axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2, 2]], quads[:, [0, 2, 3, 3]]])
    return Mesh(shape(across.ravel(), upward.ravel()), triangles, part_names=("patch",))


def test_the_mean_curvature_of_a_sphere_is_the_inverse_of_its_radius() -> None:
    for columns, rows in ((60, 120), (120, 60)):
        for radius in (0.5, 1.0, 20.0):
            mesh = sphere(columns, rows, radius)
            assert mesh.curvatures.mean * radius == pytest.approx(1, abs=0.01)
            assert mesh.curvatures.gaussian * radius**2 == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize("tube", [0.25, 0.4, 0.7])
@pytest.mark.parametrize("sides", [(80, 160), (160, 80)])
def test_both_curvatures_of_a_torus_are_those_of_the_formula(tube: float, sides: tuple[int, int]) -> None:
    mesh = torus(*sides, tube=tube)
    x, y, _ = places(mesh).T
    cosine = (np.hypot(x, y) - 1) / tube
    of_ring = cosine / (1 + tube * cosine)
    mean, gaussian = (1 / tube + of_ring) / 2, of_ring / tube
    assert mesh.curvatures.mean == pytest.approx(mean, abs=0.005 * np.abs(mean).max())
    assert mesh.curvatures.gaussian == pytest.approx(gaussian, abs=0.005 * np.abs(gaussian).max())


def test_a_surface_that_faces_inward_has_the_opposite_mean_curvature() -> None:
    mesh = sphere(60, 30)
    inward = Mesh(mesh.coordinates, mesh.node_numbers[:, ::-1], part_names=("sphere",))
    assert inward.curvatures.mean == pytest.approx(-1, abs=0.02)
    assert inward.curvatures.gaussian == pytest.approx(1, abs=0.04)


def test_a_flat_surface_has_no_curvature() -> None:
    for mesh in (cube(), wall(5, 3), grid(4, 4, (1.0, 2.0, 3.0), (1.0, 5.0, 2.0), (-3.0, 0.0, 1.0))):
        assert mesh.curvatures.mean == pytest.approx(0, abs=1e-6)
        assert mesh.curvatures.gaussian == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("bands", [1, 5])
def test_a_cylinder_bends_one_way_up_to_its_rims(bands: int) -> None:
    count, radius = 48, 3.0
    turns = np.arange(count) * 2 * np.pi / count
    rings = [
        np.stack([radius * np.cos(turns), radius * np.sin(turns), np.full(count, height)], axis=1)
        for height in np.linspace(0, 2, bands + 1)
    ]
    first = (np.arange(bands)[:, None] * count + np.arange(count)).ravel()
    after = first - first % count + (first + 1) % count
    quads = np.stack([first, after, after + count, first + count], axis=1)
    mesh = Mesh(np.concatenate(rings), quads, part_names=("cylinder",))
    assert mesh.curvatures.mean == pytest.approx(1 / (2 * radius), rel=0.01)
    assert mesh.curvatures.gaussian == pytest.approx(0, abs=1e-5)


def test_a_saddle_has_a_negative_gaussian_curvature_and_a_bowl_and_a_hill_a_positive_one() -> None:
    at_middle = {}
    for name, height in (
        ("saddle", lambda x, y: x * x - y * y),
        ("bowl", lambda x, y: x * x + y * y),
        ("hill", lambda x, y: -x * x - y * y),
    ):
        mesh = heights(20, 20, height, 0.2)
        middle = np.abs(places(mesh)).sum(axis=1).argmin()
        found = mesh.curvatures
        at_middle[name] = (found.mean[middle], found.gaussian[middle])
    assert at_middle["saddle"] == pytest.approx((0, -4), abs=0.02)
    assert at_middle["bowl"] == pytest.approx((-2, 4), abs=0.02)
    assert at_middle["hill"] == pytest.approx((2, 4), abs=0.02)


@pytest.mark.parametrize("seed", range(3))
def test_the_density_of_triangles_does_not_matter(seed: int) -> None:
    def cap(across: Array, upward: Array) -> Array:
        flat = np.cos(upward - 0.5)
        return np.stack([flat * np.cos(2 * across), flat * np.sin(2 * across), np.sin(upward - 0.5)], axis=1)

    off = np.abs(scattered(40, seed, cap).curvatures.mean - 1)
    assert np.median(off) < 0.01
    assert np.quantile(off, 0.95) < 0.05


@pytest.mark.parametrize("scale", [1e-20, 1e-3, 1e6, 1e20])
def test_curvature_scales_with_the_object(scale: float) -> None:
    mesh = torus(24, 16)
    scaled = Mesh(mesh.coordinates * scale, mesh.node_numbers, part_names=("torus",))
    assert scaled.curvatures.mean * scale == pytest.approx(mesh.curvatures.mean, rel=1e-4, abs=1e-5)
    assert scaled.curvatures.gaussian * scale**2 == pytest.approx(
        mesh.curvatures.gaussian, rel=1e-4, abs=1e-5
    )


def test_a_crease_has_no_curvature_across_it() -> None:
    # Two cylinders that meet in a ridge.
    def shape(x: Array, y: Array) -> Array:
        return np.sqrt(4 - (np.abs(x) + 1) ** 2 + 0 * y)

    mesh = heights(20, 6, shape, 0.8)
    assert len(mesh.normals.vectors) > len(mesh.coordinates)
    assert mesh.curvatures.mean == pytest.approx(0.25, rel=0.05)


def test_the_rim_of_a_patch_has_the_curvature_next_to_it() -> None:
    def cap(across: Array, upward: Array) -> Array:
        flat = np.cos(upward - 0.5)
        return np.stack([flat * np.cos(2 * across), flat * np.sin(2 * across), np.sin(upward - 0.5)], axis=1)

    mesh = scattered(30, 7, cap)
    rim = np.isin(nodes_of_normals(mesh) % 31, (0, 30)) | np.isin(nodes_of_normals(mesh) // 31, (0, 30))
    off = np.abs(mesh.curvatures.mean - 1)[rim]
    assert rim.sum() == 120
    assert np.median(off) < 0.02
    assert off.max() < 0.5


def test_nodes_that_are_repeated_are_as_those_that_are_shared() -> None:
    shared = sphere(30, 16)
    repeated = Mesh(
        shared.coordinates[shared.node_numbers].reshape(-1, 3),
        np.arange(4 * len(shared.node_numbers)).reshape(-1, 4),
        part_names=("sphere",),
    )
    of_corners = [mesh.curvatures.mean[mesh.normals.numbers] for mesh in (shared, repeated)]
    assert of_corners[0] == pytest.approx(of_corners[1], rel=1e-6)


def test_curvatures_do_not_depend_on_the_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    in_one = torus(12, 8).curvatures
    monkeypatch.setattr(curvature, "CORNERS_AT_ONCE", 7)
    in_many = torus(12, 8).curvatures
    assert in_one.mean == pytest.approx(in_many.mean, rel=1e-12)
    assert in_one.gaussian == pytest.approx(in_many.gaussian, rel=1e-12, abs=1e-12)


@given(meshes())
def test_any_mesh_has_finite_curvatures(mesh: Mesh) -> None:
    for values in (mesh.curvatures.mean, mesh.curvatures.gaussian):
        assert values.shape == (len(mesh.normals.vectors),)
        assert np.isfinite(values).all()
        assert not values.flags.writeable


def test_a_mesh_without_polygons_has_none() -> None:
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.intp), np.zeros(0, np.intp))
    assert len(empty.curvatures.mean) == 0
    assert math.isfinite(empty.curvatures.gaussian.sum())
