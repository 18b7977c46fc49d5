from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from autocolor.files.meshes.foreign.meshio_cells import polygons_of_meshio

CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
AROUND = [0, 1, 3, 2, 4, 5, 7, 6]


def mesh(*cells: tuple[str, Any], points: Any = CUBE, **others: Any) -> Any:
    """A mesh as meshio has it."""
    return SimpleNamespace(
        points=np.array(points, float),
        cells=[
            SimpleNamespace(type=kind, data=data if kind == "polygon" else np.array(data))
            for kind, data in cells
        ],
        **{"point_data": {}, "cell_data": {}, "field_data": {}, "cell_sets": {}, **others},
    )


def test_quads_stay_quads_and_other_cells_are_counted() -> None:
    found = polygons_of_meshio(
        mesh(
            ("vertex", [[0]]), ("quad", [[0, 1, 3, 2]]), ("line", [[0, 1], [1, 2]]), ("triangle", [[4, 5, 6]])
        ),
        "m",
    )
    assert found.polygons.corners.tolist() == [0, 1, 3, 2, 4, 5, 6]
    assert found.polygons.corner_counts.tolist() == [4, 3]
    assert found.polygons.part_names == ("m",)
    assert len(found.polygons.coordinates) == 8
    assert found.sentences == ("skipped cells of type vertex: 1", "skipped cells of type line: 2")


def test_the_outer_surface_of_volume_cells_has_their_scalars() -> None:
    stress = np.array([[3.0, 4.0, 0.0]] * 9)
    found = polygons_of_meshio(
        mesh(
            ("hexahedron", [AROUND]),
            points=[*CUBE, [0.5, 0.5, 0.5]],
            point_data={"v": stress, "gmsh:dim_tags": stress},
            cell_data={"c": [np.array([7.0])], "bad": [np.array([1, 2])]},
        ),
        "m",
    )
    assert found.polygons.corner_counts.tolist() == [4] * 6
    assert len(found.polygons.coordinates) == 8
    assert {each.name: each.values.tolist() for each in found.polygons.scalars} == {
        "v magnitude": [5.0] * 8,
        "c": [7.0] * 6,
    }
    assert found.sentences == (
        "took the outer surface of 1 volume cell",
        "left out 1 node that the surface does not use",
        "skipped the polygon array 'bad', which has no number for each polygon",
    )


def test_cells_of_higher_order_are_read_by_their_corners() -> None:
    found = polygons_of_meshio(mesh(("triangle6", [[0, 1, 2, 3, 4, 5]]), ("polygon", [[0, 1, 3, 2, 6]])), "m")
    assert found.polygons.corner_counts.tolist() == [3, 5]
    assert found.sentences == ("took the corners alone of cells of higher order: 1",)


def test_physical_groups_sets_and_references_are_parts() -> None:
    cells = ("triangle", [[0, 1, 2], [1, 2, 3]]), ("quad", [[4, 5, 7, 6]])
    tags = [np.array([4, 9]), np.array([4])]
    gmsh = mesh(*cells, cell_data={"gmsh:physical": tags}, field_data={"hood": np.array([4, 2])})
    medit = mesh(*cells, cell_data={"medit:ref": tags})
    sets = mesh(
        *cells,
        cell_sets={
            "gmsh:bounding_entities": [np.array([0, 1]), np.array([0])],
            "roof": [np.array([1]), None],
            "all": [np.array([0, 1, 99]), np.array([], int)],
        },
    )
    for each, names, numbers in (
        (gmsh, ("hood", "part 9"), [0, 1, 0]),
        (medit, ("part 4", "part 9"), [0, 1, 0]),
        (sets, ("m", "roof", "all"), [2, 1, 0]),
    ):
        polygons = polygons_of_meshio(each, "m").polygons
        assert polygons.part_names == names
        assert polygons.part_numbers.tolist() == numbers
        assert polygons.scalars == ()


def test_two_coordinates_are_a_plane() -> None:
    found = polygons_of_meshio(mesh(("triangle", [[0, 1, 2]]), points=[[0, 0], [1, 0], [0, 1]]), "m")
    assert found.polygons.coordinates.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("cells", "rule"),
    [
        (("triangle", [[0, 1, 8]]), "a cell with a node that is none of the 8 of the file"),
        (("triangle", [[0, 1, -1]]), "a cell with a node that is none of the 8 of the file"),
        (("tetra", [[0, 1, 2]]), "cells of type tetra with 3 corners"),
        (("quad", [[0, 1, 2.5, 3]]), "node numbers that are not whole"),
    ],
)
def test_cells_that_cannot_be_are_refused(cells: tuple[str, Any], rule: str) -> None:
    with pytest.raises(ValueError, match=rule):
        polygons_of_meshio(mesh(cells), "m")
