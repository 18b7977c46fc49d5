from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.screens.light_and_view.mesh_edges import mesh_edges
from autocolor.screens.light_and_view.silhouettes import silhouette_from, silhouette_toward
from tests.autocolor.meshes import sphere
from tests.autocolor.strategies import Vector, directions


def turned_at_random(mesh: Mesh, seed: int) -> Mesh:
    """The mesh with some of its quads running the other way."""
    numbers = mesh.node_numbers.copy()
    turned = np.random.default_rng(seed).integers(0, 2, len(numbers)).astype(bool)
    turned &= numbers[:, 2] != numbers[:, 3]
    numbers[turned] = numbers[turned][:, ::-1]
    return Mesh(mesh.coordinates, numbers)


def test_the_silhouette_of_a_sphere_is_a_circle() -> None:
    columns = 32
    edges = mesh_edges(sphere(columns, 17))
    found = silhouette_toward(edges, (0.0, 0.0, 1.0))
    # The rows beside the equator are its neighbors.
    assert len(found) == columns
    heights = edges.coordinates[found][..., 2]
    assert np.ptp(heights) == pytest.approx(0, abs=1e-12)
    assert abs(heights[0, 0]) < np.sin(np.pi / 17)


@given(directions, st.integers(0, 1 << 32))
def test_a_silhouette_is_closed_whichever_way_the_polygons_run(direction: Vector, seed: int) -> None:
    toward = np.array(direction) / np.linalg.norm(direction)
    edges = mesh_edges(turned_at_random(sphere(24, 13), seed))
    found = silhouette_toward(edges, toward.tolist())
    assert len(found) >= 3
    assert (np.bincount(found.ravel()) % 2 == 0).all()
    plain = silhouette_toward(mesh_edges(sphere(24, 13)), toward.tolist())
    if np.abs(toward @ edges.normals).min() > 1e-6:
        assert sorted(map(sorted, found.tolist())) == sorted(map(sorted, plain.tolist()))


@given(directions)
def test_a_distant_eye_sees_the_silhouette_of_its_direction(direction: Vector) -> None:
    toward = np.array(direction) / np.linalg.norm(direction)
    edges = mesh_edges(sphere(24, 13))
    assume(np.abs(toward @ edges.normals).min() > 1e-6)
    expected = silhouette_toward(edges, toward.tolist())
    assert silhouette_from(edges, (1e9 * toward).tolist()).tolist() == expected.tolist()


def test_an_eye_nearby_sees_a_smaller_cap_of_a_sphere() -> None:
    edges = mesh_edges(sphere(64, 33))
    found = silhouette_from(edges, (0.0, 0.0, 2.0))
    # The horizon as seen from the distance 2 is at the height 1 / 2.
    assert len(found) == 64
    assert np.abs(edges.coordinates[found][..., 2] - 0.5).max() < 0.1


def test_an_eye_within_sees_no_silhouette() -> None:
    assert len(silhouette_from(mesh_edges(sphere()), (0.1, 0.2, 0.0))) == 0


def test_looking_along_a_cylinder_shows_no_lines_along_it() -> None:
    turns = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    rim = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    quads = [(k, (k + 1) % 40, 40 + (k + 1) % 40, 40 + k) for k in range(40)]
    edges = mesh_edges(Mesh(np.concatenate([rim, rim + np.array([0, 0, 1])]), np.array(quads)))
    assert len(silhouette_toward(edges, (0.0, 0.0, 1.0))) == 0
    assert len(silhouette_toward(edges, (0.6, 0.8, 0.0))) == 2
