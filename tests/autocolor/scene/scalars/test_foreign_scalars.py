"""Data of points and cells, by stand-ins that have what the meshes of PyVista and meshio have."""

from __future__ import annotations

import logging
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from autocolor import Mesh, scene_of
from autocolor.scene.scalars.mesh_scalars import MeshScalar

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]], np.float64)
QUAD, TRIANGLE, PENTAGON = [0, 1, 2, 3], [3, 2, 4], [0, 1, 2, 4, 3]


def told(mesh: Mesh) -> dict[str, tuple[str, list[float]]]:
    return {each.name: (each.of, each.values.tolist()) for each in mesh.scalars}


def meshio(point_data: Any = None, cell_data: Any = None, **cells: Any) -> Any:
    blocks = [SimpleNamespace(type=kind, data=np.array(data)) for kind, data in cells.items()]
    return SimpleNamespace(points=POINTS, cells=blocks, point_data=point_data, cell_data=cell_data)


def polydata(faces: list[list[int]], point_data: Any = None, cell_data: Any = None) -> Any:
    counted = np.array([number for face in faces for number in (len(face), *face)])
    return SimpleNamespace(points=POINTS, faces=counted, point_data=point_data, cell_data=cell_data)


def test_data_of_points_and_of_cells_are_scalars() -> None:
    mesh = Mesh.of(
        polydata(
            [QUAD, TRIANGLE],
            {"stress": np.arange(5, dtype=np.float32), "id": np.arange(5)},
            {"load": np.array([[2.5], [3.5]])},
        )
    )
    assert told(mesh) == {
        "stress": ("node", [0, 1, 2, 3, 4]),
        "id": ("node", [0, 1, 2, 3, 4]),
        "load": ("polygon", [2.5, 3.5]),
    }
    assert isinstance(mesh.scalars[0], MeshScalar)
    assert scene_of(mesh, scalar={"name": "load"}).mesh is mesh


def test_data_of_blocks_that_are_no_polygons_are_left_out() -> None:
    source = meshio(
        {"stress": np.arange(5.0)},
        {"load": [np.array([9.0]), np.array([1.0]), np.array([8.0]), np.array([2.0])]},
        line=[[0, 1]],
        quad=[QUAD],
        tetra=[[0, 1, 2, 4]],
        triangle=[TRIANGLE],
    )
    assert told(Mesh.of(source)) == {"stress": ("node", [0, 1, 2, 3, 4]), "load": ("polygon", [1, 2])}


def test_the_pieces_of_a_polygon_have_its_value() -> None:
    for source in (
        polydata([PENTAGON, TRIANGLE], cell_data={"load": np.array([1.0, 2.0])}),
        meshio(cell_data={"load": [[1.0], [2.0]]}, polygon5=[PENTAGON], triangle=[TRIANGLE]),
    ):
        mesh = Mesh.of(source)
        assert len(mesh.node_numbers) == 3
        assert told(mesh) == {"load": ("polygon", [1, 1, 2])}


@pytest.mark.parametrize(
    "values",
    [
        np.zeros((5, 3)),
        np.zeros(4),
        np.zeros((5, 1, 1)),
        np.array(["a"] * 5),
        [1, [2, 3]],
        np.zeros(5, np.bool_),
        np.zeros(5, np.complex128),
        None,
        3,
    ],
)
def test_what_is_no_scalar_is_left_out_in_a_sentence(values: Any, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "autocolor"):
        mesh = Mesh.of(polydata([QUAD], {"vectors": values, "stress": np.arange(5.0)}))
    assert list(told(mesh)) == ["stress"]
    assert caplog.messages == ["data of a node left out, since they are no scalar: vectors"]


@pytest.mark.parametrize("data", [{"load": [[1.0]]}, {"load": 3}, {"load": [[1.0], [2.0], [3.0]]}, [1], 3])
def test_data_of_cells_in_other_blocks_are_left_out(data: Any) -> None:
    mesh = Mesh.of(meshio(cell_data=data, quad=[QUAD], triangle=[TRIANGLE]))
    assert told(mesh) in ({}, {"load": ("polygon", [1, 2])})


def test_a_name_of_nodes_and_of_polygons_becomes_two() -> None:
    mesh = Mesh.of(polydata([QUAD], {"stress": np.zeros(5)}, {"stress": np.ones(1)}))
    assert told(mesh) == {"stress": ("node", [0] * 5), "stress of polygons": ("polygon", [1])}


def test_endless_values_are_missing(caplog: pytest.LogCaptureFixture) -> None:
    given = np.array([np.inf, -1e31, np.nan, 3.0, 4.0])
    with caplog.at_level(logging.INFO, "autocolor"):
        mesh = Mesh.of(polydata([QUAD], {"stress": given}))
    assert np.isnan(mesh.scalars[0].values).tolist() == [True, True, True, False, False]
    assert caplog.messages == ["values of scalar stress above 1e30 in size made missing: 2"]
    assert given[0] == np.inf


def test_names_that_no_scalar_can_have_are_left_out() -> None:
    assert told(Mesh.of(polydata([QUAD], {"": np.zeros(5), 3: np.zeros(5)}))) == {}
