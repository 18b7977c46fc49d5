"""Meshes of other programs, by stand-ins that have what the meshes of trimesh, PyVista and meshio have."""

from __future__ import annotations

import logging
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Mesh, UsageError, render, scene_of
from autocolor.scene.geometry.polygon_split import split_polygons
from autocolor.scene.scalar import MeshScalar
from tests.tables import refused

POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1], [0.5, 1.5, 0]]
TRIANGLES = [[0, 1, 4], [1, 2, 4]]
QUAD = [0, 1, 2, 3]
NODE = "a node number must be a row of the nodes (0 to 5)"
PENTAGON = [0, 1, 2, 5, 3]


def trimesh(faces: Any) -> Any:
    return SimpleNamespace(vertices=np.array(POINTS), faces=np.array(faces), units=None)


def polydata(*faces: list[int], point_data: Any = None, cell_data: Any = None) -> Any:
    counted = np.array([number for face in faces for number in (len(face), *face)], np.int64)
    points = np.array(POINTS, np.float32)
    return SimpleNamespace(points=points, faces=counted, point_data=point_data, cell_data=cell_data)


def meshio(point_data: Any = None, cell_data: Any = None, **cells: Any) -> Any:
    blocks = [SimpleNamespace(type=kind, data=data) for kind, data in cells.items()]
    return SimpleNamespace(points=np.array(POINTS), cells=blocks, point_data=point_data, cell_data=cell_data)


@pytest.mark.parametrize(
    ("source", "polygons"),
    [
        ((np.array(POINTS), np.array(TRIANGLES)), [[0, 1, 4, 4], [1, 2, 4, 4]]),
        ((POINTS, [QUAD, *TRIANGLES]), [QUAD, [0, 1, 4, 4], [1, 2, 4, 4]]),
        ((POINTS, (np.array(QUAD), np.array(TRIANGLES[0], np.uint8))), [QUAD, [0, 1, 4, 4]]),
        ((trimesh(TRIANGLES),), [[0, 1, 4, 4], [1, 2, 4, 4]]),
        ((polydata(TRIANGLES[0], QUAD, TRIANGLES[1]),), [[0, 1, 4, 4], QUAD, [1, 2, 4, 4]]),
        ((meshio(triangle=np.array(TRIANGLES)),), [[0, 1, 4, 4], [1, 2, 4, 4]]),
        ((meshio(quad=np.array([QUAD]), triangle=np.array(TRIANGLES)),), [QUAD, [0, 1, 4, 4], [1, 2, 4, 4]]),
    ],
)
def test_triangles_and_quads_are_kept_in_their_order(source: tuple[Any, ...], polygons: Any) -> None:
    mesh = Mesh.of(*source)
    assert mesh.coordinates.tolist() == POINTS
    assert mesh.node_numbers.tolist() == polygons
    assert (mesh.part_names, mesh.part_numbers.tolist()) == (("mesh",), [0] * len(polygons))


@pytest.mark.parametrize(
    "source",
    [
        (POINTS, [TRIANGLES[0], PENTAGON]),
        (polydata(TRIANGLES[0], PENTAGON),),
        (meshio(triangle=np.array(TRIANGLES[:1]), polygon=[np.array(PENTAGON)]),),
        (meshio(triangle=np.array(TRIANGLES[:1]), polygon5=np.array([PENTAGON])),),
    ],
)
def test_a_polygon_of_more_than_four_sides_is_split_and_counted(
    source: tuple[Any, ...], caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.INFO, "autocolor"):
        mesh = Mesh.of(*source)
    assert "polygons with more than four corners that were split: 1" in caplog.messages
    assert mesh.node_numbers.tolist() == [[0, 1, 4, 4], [0, 1, 2, 5], [0, 5, 3, 3]]


@given(st.lists(st.lists(st.integers(0, 5), min_size=3, max_size=7), min_size=1, max_size=8))
def test_every_side_of_a_polygon_is_a_side_of_a_piece(polygons: list[list[int]]) -> None:
    counts = np.array([len(polygon) for polygon in polygons])
    assume(not len(split_polygons(np.array(POINTS, np.float64), np.concatenate(polygons), counts).crossed))
    mesh = Mesh.of(POINTS, polygons)
    pieces = [list(dict.fromkeys(row)) if row[2] == row[3] else row for row in mesh.node_numbers.tolist()]
    sides = {frozenset(pair) for row in pieces for pair in zip(row, [*row[1:], row[0]], strict=True)}
    for polygon in polygons:
        for side in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
            assert frozenset(side) in sides or len(set(side)) == 1


def test_quads_whose_sides_cross_are_split_in_any_source(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "autocolor"):
        heights = {"x": np.array(POINTS)[:, 0]}
        mesh = Mesh.of(meshio(quad=np.array([[0, 1, 2, 3], [0, 2, 1, 3]]), point_data=heights))
    assert "polygons whose sides cross that were split: 1" in caplog.messages
    assert mesh.node_numbers[0].tolist() == [0, 1, 2, 3]
    assert len(mesh.node_numbers) > 2
    assert mesh.scalars[0].values == pytest.approx(mesh.coordinates[:, 0])


def test_cells_that_are_no_polygons_are_left_out_in_a_sentence(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "autocolor"):
        mesh = Mesh.of(meshio(tetra=[[0, 1, 2, 4]], triangle=np.array(TRIANGLES), line=[[0, 1]]))
    assert len(mesh.node_numbers) == 2
    assert "cells left out: 1 of type 'tetra', 1 of type 'line'" in caplog.messages


def test_a_scene_is_made_of_a_mesh_of_another_program_and_of_arrays() -> None:
    scenes = [scene_of(trimesh(TRIANGLES)), scene_of(np.array(POINTS), np.array(TRIANGLES))]
    pictures = [render(scene, (30, 20)).intensity for scene in scenes]
    assert pictures[0].any()
    assert (pictures[0] == pictures[1]).all()
    assert [part.name for part in scenes[0].parts] == ["mesh"]


def test_a_part_may_be_named_and_a_mesh_of_ours_stays_itself() -> None:
    mesh = Mesh.of(trimesh(TRIANGLES), part="hood", crease_angle=10)
    assert (mesh.part_names, mesh.crease_angle) == (("hood",), 10)
    assert Mesh.of(mesh) is mesh
    assert scene_of(mesh).mesh is mesh


test_what_is_no_mesh_is_refused = refused(
    scene_of,
    [
        *(
            (
                source,
                "a mesh must be a Mesh, nodes and polygons, or a surface of trimesh, PyVista or meshio, not"
                f" {type(source).__name__}; take its surface, or give its nodes and its polygons as two"
                " arguments",
            )
            for source in (
                None,
                [POINTS, TRIANGLES],
                SimpleNamespace(points=POINTS),
                SimpleNamespace(points=POINTS, cells=np.array([4, 0, 1, 2, 4]), celltypes=np.array([10])),
                SimpleNamespace(vertices=POINTS),
                SimpleNamespace(geometry={}),
            )
        ),
        *(
            (source, f"a mesh must be in memory, not a file, {source!r}; read that with read_scene")
            for source in ("car.obj", Path("car.obj"))
        ),
    ],
    UsageError,
)

ALONE = "a mesh must have polygons, not nodes alone; add some"
SIDES = "a polygon must have 3 to 1,000 node numbers, not"
FACES = "faces must have as many numbers after each count, not"

test_tables_that_break_a_rule_are_refused_in_a_sentence = refused(
    lambda source: Mesh.of(*source),
    [
        ((POINTS, []), ALONE),
        ((polydata(),), ALONE),
        ((POINTS, 3), "polygons must be a table of node numbers, not 3; give rows of them"),
        ((POINTS, "abc"), "polygons must be a table of node numbers, not 'abc'; give rows of them"),
        ((POINTS, [[0, 1], QUAD]), f"{SIDES} [0, 1] (row 0); correct it"),
        ((POINTS, [QUAD, [0, 1, 2.5]]), f"{SIDES} [0, 1, 2.5] (row 1); correct it"),
        ((POINTS, [QUAD, [0, 1, [2, 3]]]), f"{SIDES} [0, 1, [2, 3]] (row 1); correct it"),
        ((POINTS, [QUAD, [0, 1, 6]]), f"{NODE}, not 6 (row 1); correct it"),
        ((POINTS, [PENTAGON, [0, 1, -1]]), f"{NODE}, not -1 (row 1); correct it"),
        (
            ([[0, 1], [1, 2]], [PENTAGON]),
            "nodes must be numbers of shape (nodes, 3), not (2, 2); convert them",
        ),
        (
            (POINTS, [[0, 1, 6]]),
            "polygon table: a node number must be a row of the node table (0 to 5), not [0, 1, 6, 6] (row 0)",
        ),
        (
            (SimpleNamespace(points=POINTS, faces=np.array([3, 0, 1, 2, 4, 0, 1])),),
            f"{FACES} 2 after 4 (polygon 1); correct them",
        ),
        (
            (SimpleNamespace(points=POINTS, faces=np.array([3, 0, 1, 2, -1, 0])),),
            f"{FACES} 1 after -1 (polygon 1); correct them",
        ),
        (
            (SimpleNamespace(points=POINTS, faces=np.array([3.0, 0, 1, 2])),),
            "faces must be whole numbers in one row, a count before each polygon; convert them",
        ),
        (
            (SimpleNamespace(points=POINTS, cells=[("triangle", [[0, 1, 2]])]),),
            "cells must be cell blocks with a type and data, as in meshio, not ('triangle', [[0, 1, 2]]);"
            " convert them",
        ),
        (
            (meshio(tetra=[[0, 1, 2, 4]] * 1000),),
            "a mesh must have triangles or quads, not cells alone: 1,000 of type 'tetra'; take its surface",
        ),
        ((meshio(),), "a mesh must have triangles or quads, not none; take its surface"),
    ],
)


TRIANGLE = [3, 2, 4]


def scalars_of(mesh: Mesh) -> dict[str, tuple[str, list[float]]]:
    return {each.name: (each.of, each.values.tolist()) for each in mesh.scalars}


def test_data_of_points_and_of_cells_are_scalars() -> None:
    mesh = Mesh.of(
        polydata(
            QUAD,
            TRIANGLE,
            point_data={"stress": np.arange(6, dtype=np.float32), "id": np.arange(6)},
            cell_data={"load": np.array([[2.5], [3.5]])},
        )
    )
    assert scalars_of(mesh) == {
        "stress": ("node", [0, 1, 2, 3, 4, 5]),
        "id": ("node", [0, 1, 2, 3, 4, 5]),
        "load": ("polygon", [2.5, 3.5]),
    }
    assert isinstance(mesh.scalars[0], MeshScalar)
    assert scene_of(mesh, scalar={"name": "load"}).mesh is mesh


def test_data_of_blocks_that_are_no_polygons_are_left_out() -> None:
    source = meshio(
        {"stress": np.arange(6.0)},
        {"load": [np.array([9.0]), np.array([1.0]), np.array([8.0]), np.array([2.0])]},
        line=[[0, 1]],
        quad=[QUAD],
        tetra=[[0, 1, 2, 4]],
        triangle=[TRIANGLE],
    )
    assert scalars_of(Mesh.of(source)) == {
        "stress": ("node", [0, 1, 2, 3, 4, 5]),
        "load": ("polygon", [1, 2]),
    }


def test_the_pieces_of_a_polygon_have_its_value() -> None:
    for source in (
        polydata(PENTAGON, TRIANGLE, cell_data={"load": np.array([1.0, 2.0])}),
        meshio(cell_data={"load": [[1.0], [2.0]]}, polygon5=[PENTAGON], triangle=[TRIANGLE]),
    ):
        mesh = Mesh.of(source)
        assert len(mesh.node_numbers) == 3
        assert scalars_of(mesh) == {"load": ("polygon", [1, 1, 2])}


@pytest.mark.parametrize(
    "values",
    [
        np.zeros((6, 3)),
        np.zeros(5),
        np.zeros((6, 1, 1)),
        np.array(["a"] * 6),
        [1, [2, 3]],
        np.zeros(6, np.bool_),
        np.zeros(6, np.complex128),
        None,
        3,
    ],
)
def test_what_is_no_scalar_is_left_out_in_a_sentence(values: Any, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "autocolor"):
        mesh = Mesh.of(polydata(QUAD, point_data={"vectors": values, "stress": np.arange(6.0)}))
    assert list(scalars_of(mesh)) == ["stress"]
    assert caplog.messages == ["data of a node left out, since they are no scalar: vectors"]


def test_endless_values_are_missing(caplog: pytest.LogCaptureFixture) -> None:
    given = np.array([np.inf, -1e31, np.nan, 3.0, 4.0, 5.0])
    with caplog.at_level(logging.INFO, "autocolor"):
        mesh = Mesh.of(polydata(QUAD, point_data={"stress": given}))
    assert np.isnan(mesh.scalars[0].values).tolist() == [True, True, True, False, False, False]
    assert caplog.messages == ["values of scalar stress above 1e30 in size made missing: 2"]
    assert given[0] == np.inf


def test_names_that_no_scalar_can_have_are_left_out() -> None:
    assert scalars_of(Mesh.of(polydata(QUAD, point_data={"": np.zeros(6), 3: np.zeros(6)}))) == {}
