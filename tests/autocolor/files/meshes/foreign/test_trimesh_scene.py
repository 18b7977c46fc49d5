from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from autocolor.files.meshes.foreign.trimesh_scene import polygons_of_trimesh


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
