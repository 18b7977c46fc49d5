from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given

from autocolor import Mesh
from autocolor.scene.geometry import curvature
from autocolor.testing import meshes
from tests.small import cube, grid, sphere, wall
from tests.tables import first

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


def scattered(count: int, seed: int) -> Mesh:
    """Triangles of random density on a patch of the unit sphere."""
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
    x, y = 2 * across.ravel(), upward.ravel() - 0.5
    places = np.stack([np.cos(y) * np.cos(x), np.cos(y) * np.sin(x), np.sin(y)], axis=1)
    return Mesh(places, triangles, part_names=("patch",))


def test_the_mean_curvature_of_a_sphere_is_the_inverse_of_its_radius() -> None:
    for columns, rows, radius in ((60, 120, 0.5), (120, 60, 20.0)):
        mesh = sphere(columns, rows, radius)
        assert mesh.curvatures.mean * radius == pytest.approx(1, abs=0.01)
        assert mesh.curvatures.gaussian * radius**2 == pytest.approx(1, abs=0.01)
        inward = Mesh(mesh.coordinates, mesh.node_numbers[:, ::-1], part_names=("sphere",))
        assert inward.curvatures.mean * radius == pytest.approx(-1, abs=0.03)


@pytest.mark.parametrize("tube", first(2, [0.7, 0.25, 0.4]))
@pytest.mark.parametrize("sides", first(1, [(80, 160), (160, 80)]))
def test_both_curvatures_of_a_torus_are_those_of_the_formula(tube: float, sides: tuple[int, int]) -> None:
    mesh = torus(*sides, tube=tube)
    x, y, _ = places(mesh).T
    cosine = (np.hypot(x, y) - 1) / tube
    of_ring = cosine / (1 + tube * cosine)
    mean, gaussian = (1 / tube + of_ring) / 2, of_ring / tube
    assert mesh.curvatures.mean == pytest.approx(mean, abs=0.005 * np.abs(mean).max())
    assert mesh.curvatures.gaussian == pytest.approx(gaussian, abs=0.005 * np.abs(gaussian).max())


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


@pytest.mark.parametrize("seed", first(1, range(3)))
def test_the_density_of_triangles_does_not_matter(seed: int) -> None:
    off = np.abs(scattered(40, seed).curvatures.mean - 1)
    assert np.median(off) < 0.01
    assert np.quantile(off, 0.95) < 0.05


@pytest.mark.parametrize("scale", [1e-20, 1e20])
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
