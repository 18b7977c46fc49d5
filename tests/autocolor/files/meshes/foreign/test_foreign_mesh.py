from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.array_file import array_file_bytes
from autocolor.files.meshes.foreign.foreign_mesh import (
    ForeignMesh,
    foreign_mesh_bytes,
    kind_of_file,
    part_names_of,
    read_foreign_mesh,
)
from autocolor.files.repair.polygons import Polygons
from autocolor.scene.scalars.mesh_scalars import MeshScalar

NODES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])

MESH = ForeignMesh(
    Polygons(
        NODES,
        np.array([0, 1, 2, 3, 0, 1, 2]),
        np.array([4, 3]),
        np.array([0, 1]),
        ("hood", "roof"),
        (
            MeshScalar("stress", np.array([1, 2, np.nan, 4])),
            MeshScalar("heat", np.array([5.0, 6.0]), "polygon"),
        ),
    ),
    ("skipped lines: 3",),
    {"hood": "red"},
    {"red": (200, 10, 20)},
)

HEADER = {
    "part_names": ["p"],
    "node_scalars": [],
    "polygon_scalars": [],
    "sentences": [],
    "materials": {},
    "colors": {},
}

ARRAYS: dict[str, Any] = {
    "coordinates": NODES,
    "corners": [0, 1, 2],
    "corner_counts": [3],
    "part_numbers": [0],
    "node_values": [],
    "polygon_values": [],
}


def read(folder: Path, data: bytes) -> ForeignMesh:
    path = folder / "result.npz"
    path.write_bytes(data)
    return read_foreign_mesh(path, 1 << 20, "a.glb", "trimesh")


def test_a_mesh_comes_back_as_it_was_sent(tmp_path: Path) -> None:
    found = read(tmp_path, foreign_mesh_bytes(MESH))
    for name in ("coordinates", "corners", "corner_counts", "part_numbers", "part_names"):
        assert np.array_equal(getattr(found.polygons, name), getattr(MESH.polygons, name)), name
    assert [(each.name, each.of, str(each.values.tolist())) for each in found.polygons.scalars] == [
        ("stress", "node", "[1.0, 2.0, nan, 4.0]"),
        ("heat", "polygon", "[5.0, 6.0]"),
    ]
    assert found.sentences == MESH.sentences
    assert found.material_of_part == MESH.material_of_part
    assert found.colors == MESH.colors


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"coordinates": np.full((4, 3), np.nan)}, "a node whose coordinates are not finite and at"
         " most 1e30 in size, [nan, nan, nan] (node 1)"),
        ({"coordinates": np.zeros((4, 2))}, "nodes of 2 coordinates, not three"),
        ({"corners": [0, 1, 4]}, "a polygon with the node 5, which must be from 1 to 4"),
        ({"corners": [0, 1, -1]}, "a polygon with the node 0, which must be from 1 to 4"),
        ({"corner_counts": [4]}, "polygons without all of their corners"),
        ({"corner_counts": [-1, 4], "part_numbers": [0, 0]}, "polygons without all of their corners"),
        ({"part_numbers": [1]}, "polygons of parts that are not there"),
        ({"part_numbers": [0, 0]}, "polygons of parts that are not there"),
        ({"node_values": [1.0]}, "scalars without a value for each node"),
        ({"part_names": [1]}, "names that are no texts"),
        ({"materials": {"p": 1}}, "materials that have no names"),
        ({"colors": {"red": [1, 2, 256]}}, "materials whose colors are no colors"),
    ],
)  # fmt: skip
def test_nothing_is_believed(tmp_path: Path, changes: dict[str, Any], rule: str) -> None:
    header = {key: changes.get(key, value) for key, value in HEADER.items()}
    arrays = {key: np.asarray(changes.get(key, value)) for key, value in ARRAYS.items()}
    with pytest.raises(InputError) as caught:
        read(tmp_path, array_file_bytes(kind_of_file(0), header, arrays))
    assert str(caught.value) == f"a.glb: trimesh gave {rule}; correct the file, or write it as OBJ or PLY"


@pytest.mark.parametrize("data", [b"", b"PK", b"\x80\x04N.", foreign_mesh_bytes(MESH)[:-30]])
def test_what_is_no_result_is_refused(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(InputError, match=r"^a\.glb: trimesh gave no mesh "):
        read(tmp_path, data)


def test_infinite_values_become_missing(tmp_path: Path) -> None:
    header = {**HEADER, "node_scalars": ["s"]}
    arrays = {key: np.asarray(value) for key, value in ARRAYS.items()}
    arrays["node_values"] = np.array([1, np.inf, 3, 4])
    found = read(tmp_path, array_file_bytes(kind_of_file(0), header, arrays))
    assert str(found.polygons.scalars[0].values.tolist()) == "[1.0, nan, 3.0, 4.0]"
    assert found.sentences == ("scalar 's': 1 value above 1e30 in size was made missing",)


def test_names_are_made_unique_and_printable() -> None:
    assert part_names_of(["a", "a", "a 2", "", "b\0", "a"]) == ("a", "a 2", "a 2 2", "part", "b?", "a 3")
