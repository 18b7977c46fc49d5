from __future__ import annotations

import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from autocolor.files.meshes import foreign_worker
from autocolor.files.meshes.foreign_worker import (
    guard,
    part_names_of,
    polygons_of_meshio,
    polygons_of_trimesh,
    sentence_of,
)


def test_what_a_reader_has_no_need_of_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "meshes"
    folder.mkdir()
    (folder / "a.obj").write_text("v 0 0 0")
    (tmp_path / "secret").write_text("secret")
    (folder / "link").symlink_to(tmp_path / "secret")
    refuse = guard(folder, tmp_path / "result")
    refuse("open", (str(folder / "a.obj"), "r", os.O_RDONLY))
    refuse("open", (os.fsencode(os.__file__), "r", os.O_RDONLY))
    refuse("open", (str(tmp_path / "result"), "w", os.O_WRONLY | os.O_CREAT))
    refuse("open", (3, "r", os.O_RDONLY))
    refuse("import", ("trimesh", None, None, None, None))
    for name in ("../secret", "link"):
        with pytest.raises(PermissionError, match=f"the file names '.*{name}', which is not in its folder"):
            refuse("open", (str(folder / name), "r", os.O_RDONLY))
    with pytest.raises(PermissionError):
        refuse("open", (str(folder / "a.obj"), "w", os.O_WRONLY | os.O_CREAT))
    for event in ("socket.connect", "subprocess.Popen", "os.system", "urllib.Request", "os.remove"):
        with pytest.raises(PermissionError, match=f"{event} is not allowed"):
            refuse(event, ())


def test_a_failure_is_one_line_of_limited_length() -> None:
    assert sentence_of(ValueError("a\n b")) == "ValueError: a b"
    assert sentence_of(KeyError()) == "KeyError"
    assert sentence_of(SystemExit(1)) == "it gave up"
    assert sentence_of(MemoryError()) == "it needs more memory than its size and --limit allow"
    assert len(sentence_of(ValueError("x" * 1000))) == 300


class Graph(dict[str, Any]):
    """The graph of a scene, as trimesh has it."""

    @property
    def nodes_geometry(self) -> list[str]:
        return list(self)


def triangle(**others: Any) -> Any:
    """A triangle whose last corner is written twice, as in two triangles with normals of their own."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 0.0], [1, 1, 0]])
    return SimpleNamespace(
        vertices=vertices,
        **{
            "faces": np.array([[0, 1, 2], [1, 4, 3]]),
            "vertex_attributes": {},
            "visual": None,
            **others,
        },
    )


def scene(geometry: dict[str, Any], **nodes: tuple[Any, str]) -> Any:
    return SimpleNamespace(geometry=geometry, graph=Graph(nodes))


def test_each_node_of_a_scene_is_a_part_placed_by_its_transform() -> None:
    moved, mirrored = np.eye(4), np.diag([-1.0, 1, 1, 1])
    moved[0, 3] = 5
    found = polygons_of_trimesh(scene({"w": triangle()}, b=(mirrored, "w"), a=(moved, "w")), "file")
    polygons = found.polygons
    assert polygons.part_names == ("a", "b")
    assert polygons.part_numbers.tolist() == [0, 0, 1, 1]
    assert polygons.coordinates.tolist() == [
        [5, 0, 0], [6, 0, 0], [5, 1, 0], [6, 1, 0], [0, 0, 0], [-1, 0, 0], [0, 1, 0], [-1, 1, 0],
    ]  # fmt: skip
    # The mirrored triangles are turned over, so that they face the same way.
    assert polygons.corners.reshape(-1, 3).tolist() == [[0, 1, 2], [1, 3, 2], [6, 5, 4], [6, 7, 5]]
    assert found.sentences == ()


@pytest.mark.parametrize("count", [2, 3, 4])
def test_a_scene_has_a_limited_number_of_parts(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foreign_worker, "MOST_PLACED", 3)
    of_one_mesh = scene({"w": triangle()}, **{f"node {number}": (np.eye(4), "w") for number in range(count)})
    if count <= 3:
        assert len(polygons_of_trimesh(of_one_mesh, "file").polygons.part_names) == count
    else:
        with pytest.raises(ValueError, match="4 parts, and at most 3 are read"):
            polygons_of_trimesh(of_one_mesh, "file")


def test_nodes_with_different_scalars_are_not_welded() -> None:
    values = np.array([[1.0], [2], [3], [4], [np.inf]])
    colors = np.zeros((5, 4))
    mesh = triangle(vertex_attributes={"_stress": values, "color": colors})
    other = triangle()
    found = polygons_of_trimesh(
        scene({"m": mesh, "n": other}, m=(np.eye(4), "m"), n=(np.eye(4), "n")), "file"
    )
    assert len(found.polygons.coordinates) == 9
    (scalar,) = found.polygons.scalars
    assert (scalar.name, str(scalar.values.tolist())) == (
        "stress",
        "[1.0, 2.0, 3.0, 4.0, nan, nan, nan, nan, nan]",
    )


def test_materials_have_a_name_and_a_color_and_textures_are_told() -> None:
    red = SimpleNamespace(name="red", baseColorFactor=np.array([200, 10, 20, 255]), baseColorTexture=None)
    wood = SimpleNamespace(name="wood", baseColorFactor=None, baseColorTexture=object())
    geometry = {
        "m": triangle(visual=SimpleNamespace(material=red)),
        "n": triangle(visual=SimpleNamespace(material=wood)),
        "points": SimpleNamespace(vertices=np.zeros((2, 3))),
    }
    placed = {name: (np.eye(4), name) for name in geometry}
    found = polygons_of_trimesh(scene(geometry, **placed), "file")
    assert found.material_of_part == {"m": "red", "n": "wood"}
    assert found.colors == {"red": (200, 10, 20)}
    assert found.sentences == ("skipped parts without triangles: 1", "left out the textures of parts: 1")


def test_a_scene_without_triangles_or_with_wrong_ones_is_refused() -> None:
    with pytest.raises(ValueError, match="no triangles"):
        polygons_of_trimesh(scene({}), "file")
    wrong = triangle(faces=np.array([[0, 1, 5]]))
    with pytest.raises(ValueError, match="a triangle of a with a node that it does not have"):
        polygons_of_trimesh(scene({"m": wrong}, a=(np.eye(4), "m")), "file")


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


def test_names_are_made_unique_and_printable() -> None:
    assert part_names_of(["a", "a", "a 2", "", "b\0", "a"]) == ("a", "a 2", "a 2 2", "part", "b?", "a 3")
