from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.ply import ply_polygons as ply_polygons_module
from autocolor.files.meshes.ply.columns import Column, Lists, PlyTables, Rows
from autocolor.files.meshes.ply.ply_polygons import ply_polygons
from autocolor.files.meshes.ply.properties import Comments
from autocolor.files.repair.polygons import Polygons
from autocolor.scene.scalars.mesh_scalars import MeshScalar

NONE = Comments({}, {})
SQUARE = {"x": [0, 1, 1, 0], "y": [0, 0, 1, 1], "z": [0, 0, 0, 0]}


def lists(*rows: list[float], dtype: str = "i4") -> Lists:
    flat = np.array([number for row in rows for number in row], dtype)
    return Lists(flat, np.array([len(row) for row in rows], np.intp))


def rows(name: str, columns: dict[str, Any]) -> Rows:
    found: dict[str, Column] = {
        key: each if isinstance(each, Lists) else np.array(each) for key, each in columns.items()
    }
    first = next(iter(found.values()), np.empty(0))
    count = len(first.counts) if isinstance(first, Lists) else len(first)
    return Rows(count, found, lambda row: f"a.ply, {name} {row}")


def read(
    comments: Comments = NONE, vertex: dict[str, Any] = SQUARE, **elements: dict[str, Any]
) -> tuple[Polygons, list[str]]:
    tables = {name: rows(name, columns) for name, columns in {"vertex": vertex, **elements}.items()}
    return ply_polygons(PlyTables(tables), comments, "a.ply", "a")


def refusal(elements: dict[str, dict[str, Any]]) -> str:
    with pytest.raises(InputError) as caught:
        read(NONE, **elements)
    return str(caught.value)


def scalars(polygons: Polygons) -> list[tuple[str, str, list[float]]]:
    def shown(scalar: MeshScalar) -> list[float]:
        values: list[float] = np.where(np.isnan(scalar.values), -9, scalar.values).tolist()
        return values

    return [(each.name, each.of, shown(each)) for each in polygons.scalars]


@pytest.mark.parametrize("name", ["vertex_indices", "vertex_index"])
@pytest.mark.parametrize("dtype", ["u1", ">u4", "i8", "f8"])
def test_faces_are_polygons(name: str, dtype: str) -> None:
    polygons, messages = read(face={name: lists([0, 1, 2, 3], [2, 1, 0], dtype=dtype)})
    assert polygons.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert polygons.corners.tolist() == [0, 1, 2, 3, 2, 1, 0]
    assert polygons.corner_counts.tolist() == [4, 3]
    assert (polygons.part_names, polygons.part_numbers.tolist()) == (("a",), [0, 0])
    assert messages == []


def test_strips_are_polygons_where_there_are_no_faces() -> None:
    strips = {"vertex_indices": lists([0, 1, 3, 2, -1])}
    polygons, messages = read(tristrips=strips)
    assert polygons.corners.tolist() == [0, 1, 3, 3, 1, 2]
    assert messages == []
    polygons, messages = read(tristrips=strips, face={"vertex_indices": lists([0, 1, 2])})
    assert polygons.corners.tolist() == [0, 1, 2]
    assert messages == ["skipped elements 'tristrips': 1"]


def test_other_elements_are_counted() -> None:
    _, messages = read(face={"vertex_indices": lists([0, 1, 2])}, edge={"vertex1": [0, 1]}, none={})
    assert messages == ["skipped elements 'edge': 2"]


def test_other_numbers_are_scalars() -> None:
    vertex = {
        **SQUARE,
        "nx": [1, 1, 1, 1],
        "red": [9, 9, 9, 9],
        "stress": [1.5, 2, np.nan, 3],
        "of": lists([], [], [], []),
    }
    face = {"vertex_indices": lists([0, 1, 2]), "quality": np.array([7], "u1"), "stress": [5]}
    polygons, messages = read(vertex=vertex, face=face)
    assert scalars(polygons) == [
        ("stress", "node", [1.5, 2, -9, 3]),
        ("quality", "polygon", [7]),
        ("stress of polygons", "polygon", [5]),
    ]
    assert messages == []


def test_infinite_values_become_missing_and_are_counted() -> None:
    vertex = {**SQUARE, "stress": [np.inf, -np.inf, 1e31, 1e30]}
    polygons, messages = read(vertex=vertex, face={"vertex_indices": lists([0, 1, 2])})
    assert scalars(polygons) == [("stress", "node", [-9, -9, -9, 1e30])]
    assert messages == ["scalar 'stress': infinite or larger than 1e30, and so missing: 3"]


def test_comments_name_scalars() -> None:
    face = {"vertex_indices": lists([0, 1, 2]), "value_0": [1.0], "red": [2.0]}
    polygons, _ = read(Comments({}, {"value_0": "von Mises", "red": "red"}), face=face)
    assert [name for name, _, _ in scalars(polygons)] == ["von Mises", "red"]


@pytest.mark.parametrize("name", ["part", "material_index", "group"])
def test_a_number_of_faces_divides_them_into_parts(name: str) -> None:
    face = {"vertex_indices": lists([0, 1, 2], [0, 2, 3], [1, 2, 3]), name: np.array([7, -1, 7], "i1")}
    polygons, _ = read(face=face)
    assert polygons.part_names == (f"{name} -1", f"{name} 7")
    assert polygons.part_numbers.tolist() == [1, 0, 1]
    assert polygons.scalars == ()


def test_only_the_first_such_number_does() -> None:
    face = {"vertex_indices": lists([0, 1, 2]), "group": [3], "part": [4]}
    polygons, _ = read(face=face)
    assert polygons.part_names == ("part 4",)
    assert scalars(polygons) == [("group", "polygon", [3])]


def test_comments_name_parts_and_those_without_polygons_too() -> None:
    face = {"vertex_indices": lists([0, 1, 2], [0, 2, 3]), "part": [2, 5]}
    polygons, _ = read(Comments({0: "hood", 2: "roof", 3: "roof"}, {}), face=face)
    assert polygons.part_names == ("hood", "roof", "roof 2", "part 5")
    assert polygons.part_numbers.tolist() == [1, 3]


def test_a_comment_names_the_one_part() -> None:
    polygons, _ = read(Comments({0: "hood"}, {}), face={"vertex_indices": lists([0, 1, 2])})
    assert polygons.part_names == ("hood",)


def test_numbers_that_are_no_parts_are_scalars(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ply_polygons_module, "MOST_UNNAMED_PARTS", 1)
    corners = lists([0, 1, 2], [0, 2, 3])
    for values in ([1, 2], [0.5, 0.5], [np.nan, 1], [1e300, 1e300]):
        polygons, _ = read(face={"vertex_indices": corners, "part": values})
        assert polygons.part_names == ("a",)
        assert len(polygons.scalars) == 1
    polygons, _ = read(Comments({1: "one", 2: "two"}, {}), face={"vertex_indices": corners, "part": [1, 2]})
    assert polygons.part_names == ("one", "two")


@pytest.mark.parametrize(
    ("elements", "sentence"),
    [
        (
            {"vertex": {"x": [1], "y": [2]}},
            "a.ply: an element 'vertex' must have the properties x, y and z, not only x and y; export it with"
            " coordinates",
        ),
        (
            {"vertex": {}},
            "a.ply: an element 'vertex' must have the properties x, y and z, not none; export it with"
            " coordinates",
        ),
        (
            {"vertex": {"x": lists([1]), "y": [2], "z": [3]}},
            "a.ply: an element 'vertex' must have the properties x, y and z, not only x, y and z; export it"
            " with coordinates",
        ),
        (
            {"vertex": {**SQUARE, "y": [0, np.nan, -np.inf, 1e31]}},
            "a.ply, vertex 1: a coordinate must be a finite number of at most 1e30 in size, not nan; correct"
            " it\n"
            "a.ply, vertex 2: a coordinate must be a finite number of at most 1e30 in size, not -inf; correct"
            " it\n"
            "a.ply, vertex 3: a coordinate must be a finite number of at most 1e30 in size, not 1e+31;"
            " correct it",
        ),
        (
            {"face": {"quality": [1]}},
            "a.ply: an element 'face' must have a list 'vertex_indices', not only quality; export it with"
            " polygons",
        ),
        (
            {"face": {"vertex_indices": [1]}},
            "a.ply: an element 'face' must have a list 'vertex_indices', not only vertex_indices; export it"
            " with polygons",
        ),
        (
            {"face": {"vertex_indices": lists([0, 1, 2], [0, 4, -1, 3], [2, 1, -3])}},
            "a.ply, face 1: a corner must be a node number from 0 to 3, not 4; correct it\n"
            "a.ply, face 2: a corner must be a node number from 0 to 3, not -3; correct it",
        ),
        (
            {"face": {"vertex_indices": lists([0, 1, 2**64 - 1], dtype="u8")}},
            "a.ply, face 0: a corner must be a node number from 0 to 3, not 1.84467440737096e+19; correct it",
        ),
        (
            {"face": {"vertex_indices": lists([0, 1.5, np.nan], dtype="f4")}},
            "a.ply, face 0: a corner must be a node number from 0 to 3, not 1.5; correct it",
        ),
        (
            {"vertex": {"x": [], "y": [], "z": []}, "face": {"vertex_indices": lists([0, 1, 2])}},
            "a.ply, face 0: a corner must be a node number of a node in the file, which has none, not 0;"
            " correct it",
        ),
        (
            {"face": {"vertex_indices": lists([0, 1, 2], [0] * 1001)}},
            "a.ply, face 1: a polygon must have at most 1,000 corners, not 1,001; split it",
        ),
        (
            {"tristrips": {"vertex_indices": lists([0, 1, 2, -2])}},
            "a.ply, tristrips 0: a corner must be a node number from -1 to 3, not -2; correct it",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused(elements: dict[str, Any], sentence: str) -> None:
    assert refusal(elements) == sentence
