"""glTF files, made of JSON and arrays."""

from __future__ import annotations

import base64
import json
import math
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from autocolor.files.foreign.gltf_document import completed, document, size_of_gltf
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import MeshReport, Placement
from tests.autocolor.files.foreign.conftest import CUBE, SIDES, area_and_volume
from tests.autocolor.files.refusals import refusal, refused

pytestmark = [pytest.mark.needs("vtkmodules"), pytest.mark.usefixtures("shared")]

TRIANGLES = np.array([side[at] for side in SIDES for at in (0, 1, 2, 0, 2, 3)], np.uint16)
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Gltf:
    """A glTF file of a cube, to be changed and written."""

    def __init__(self) -> None:
        self.binary = b""
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []}
        self.attributes = {"POSITION": self.array(CUBE.astype("f4"))}
        self.primitive: dict[str, Any] = {"attributes": self.attributes, "indices": self.array(TRIANGLES)}
        self.mesh: dict[str, Any] = {"primitives": [self.primitive]}
        self.node: dict[str, Any] = {"mesh": 0}
        self.json |= {"scenes": [{"nodes": [0]}], "nodes": [self.node], "meshes": [self.mesh]}

    def view(self, data: bytes, **others: int) -> int:
        """The number of a new view of the buffer."""
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **others}
        )
        self.binary += data + bytes(-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def array(self, values: Any, width: int = 0, **others: Any) -> int:
        """The number of a new accessor; if `width` is given, the rows have more numbers than that."""
        row = {"count": len(values), "componentType": COMPONENTS[values.dtype.str[1:]]}
        view = self.view(values.tobytes(), **({"byteStride": values.strides[0]} if width else {}))
        type_ = TYPES[width or values.size // len(values)]
        self.json["accessors"].append({**row, "type": type_, "bufferView": view, **others})
        return len(self.json["accessors"]) - 1

    @property
    def text(self) -> str:
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.binary).decode()
        return json.dumps({"buffers": [{"byteLength": len(self.binary), "uri": uri}]} | self.json)

    def read(self, folder: Path) -> MeshReport:
        """The mesh, with x up: (x, y, z) of the file become (y, z, x)."""
        (folder / "a.gltf").write_text(self.text)
        return read_mesh({"file": folder / "a.gltf"}, Placement("x"))


def box(report: MeshReport) -> list[list[float]]:
    """The corners of the box around a mesh that was read with x up, in the axes of the file."""
    return [np.roll(each, 1).round(5).tolist() for each in report.mesh.bounds]


def test_each_node_is_a_part_that_is_placed_and_up(tmp_path: Path) -> None:
    file = Gltf()
    file.json["materials"] = [{"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0, 1, 1]}}]
    file.primitive["material"] = 0
    half = math.sqrt(0.5)
    file.json["nodes"] = [
        {"mesh": 0, "name": "wheel", "translation": [5, 0, 0]},
        {"mesh": 0, "name": "wheel", "scale": [-1, 1, 1]},
        {"mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1]},
        {"rotation": [0, 0, 2 * half, 2 * half], "children": [2]},
    ]
    file.json |= {"scenes": [{"nodes": []}, {"nodes": [0, 1, 3]}], "scene": 1}
    file.read(tmp_path)
    (tmp_path / "a.glb").write_bytes(completed(tmp_path / "a.gltf", *document(tmp_path / "a.gltf")))
    for name in ("a.gltf", "a.glb"):
        report = read_mesh({"file": tmp_path / name}, Placement("x"))
        assert report.mesh.part_names == ("wheel", "wheel 2", "a")
        assert area_and_volume(report)[1] == 1 + 1 + 8
        assert box(report) == [[-2, 0, 0], [6, 12, 2]]
        lowest = read_mesh({"file": tmp_path / name}).mesh.bounds[0]
        assert lowest == pytest.approx([-2, -2, 0])
        assert report.material_of_part == dict.fromkeys(report.mesh.part_names, "red")
        assert [(each.name, each.paint.object_color) for each in report.materials] == [("red", (188, 0, 255))]
        assert report.repairs == (f"{name}: left out its other scenes",)


def test_parts_of_one_mesh_are_named_by_their_materials(tmp_path: Path) -> None:
    file = Gltf()
    file.node["name"], file.mesh["name"] = "door", "panel"
    file.json["materials"] = [{"name": "paint"}, {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    file.mesh["primitives"] += [{**file.primitive, "material": number} for number in (0, 1, 1)]
    report = file.read(tmp_path)
    assert report.mesh.part_names == ("door", "door paint", "door material 1", "door material 1 2")
    assert [each.name for each in report.materials] == ["paint"]
    assert report.repairs == ("a.gltf: left out its textures",)
    del file.node["name"]
    assert file.read(tmp_path).mesh.part_names[0] == "panel"


def test_quantized_and_sparse_numbers_are_unpacked(tmp_path: Path) -> None:
    for kind, scale, normalized, side in (
        ("i2", 32767, True, 1), ("u1", 255, True, 1), ("u2", 40_000, False, 40_000), ("u1", 3, False, 3),
    ):  # fmt: skip
        file = Gltf()
        file.json["extensionsRequired"] = file.json["extensionsUsed"] = ["KHR_mesh_quantization"]
        # Rows begin at multiples of four bytes.
        values = np.pad((CUBE * scale).astype(kind), ((0, 0), (0, 1)))
        file.attributes["POSITION"] = file.array(values, 3, normalized=normalized)
        report = file.read(tmp_path)
        assert box(report) == [[0, 0, 0], [side] * 3]
        assert area_and_volume(report)[1] == pytest.approx(side**3)
        # Sparse values move the upper nodes down.
        flat = file.view((CUBE[4:] * [scale, scale, 0]).astype(kind).tobytes())
        file.json["accessors"][-1]["sparse"] = {
            "count": 4,
            "indices": {"bufferView": file.view(bytes([4, 5, 6, 7])), "componentType": 5121},
            "values": {"bufferView": flat},
        }
        assert area_and_volume(file.read(tmp_path))[0] == pytest.approx(2 * side**2)
    # Without a view, an accessor is zero but for its sparse values.
    del file.json["accessors"][-1]["bufferView"]
    assert box(file.read(tmp_path)) == [[0, 0, 0], [3, 3, 0]]


def test_strips_and_fans_are_triangles_and_points_and_lines_are_counted(tmp_path: Path) -> None:
    for mode, indices in ((4, [0, 1, 3, 0, 3, 2]), (5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])):
        file = Gltf()
        file.primitive |= {"mode": mode, "indices": file.array(np.array(indices, np.uint32))}
        file.mesh["primitives"] += [{**file.primitive, "mode": other} for other in range(4)]
        report = file.read(tmp_path)
        a, b, c, _ = report.mesh.coordinates[report.mesh.node_numbers.T]
        # With x up, z of the file is y.
        assert np.cross(b - a, c - a)[:, 1].tolist() == [1, 1]
        assert report.repairs[0] == "a.gltf: skipped primitives of points or lines: 4"


def test_morph_targets_are_applied_with_their_weights(tmp_path: Path) -> None:
    file = Gltf()
    file.primitive["targets"] = [
        {"POSITION": file.array((CUBE * [0, 0, height]).astype("f4"))} for height in (2, 100)
    ]
    file.json["nodes"].append({"mesh": 0, "weights": [2, 0]})
    file.json["scenes"][0]["nodes"] = [0, 1]
    file.mesh["weights"] = [0.5, 0]
    report = file.read(tmp_path)
    assert box(report)[1] == [1, 1, 5]
    assert area_and_volume(report)[1] == 2 + 5
    # Weights of zero leave the file's normals as they are; others do not, as a target has no normals.
    file.attributes["NORMAL"] = file.array(CUBE.astype("f4") + np.float32(1))
    file.mesh["weights"] = [0, 0]
    assert area_and_volume(file.read(tmp_path))[1] == 1 + 5


def test_skins_move_nodes_by_the_weights_of_their_joints(tmp_path: Path) -> None:
    chance = np.random.default_rng(4)
    joints = chance.integers(0, 2, (8, 4)).astype("u1")
    weights = chance.dirichlet(np.ones(4), 8).astype("f4")
    file = Gltf()
    file.attributes |= {"JOINTS_0": file.array(joints), "WEIGHTS_0": file.array(weights)}
    moves, bound = np.array([[2.0, 0, 0], [0, 3, 1]]), np.array([[-1.0, 0, 0], [0, -2, 0]])
    one, other = ({"translation": move.tolist()} for move in moves)
    file.node |= {"skin": 0, "translation": [100, 0, 0]}
    file.json["nodes"] += [{**one, "children": [2]}, other]
    file.json["scenes"] = [{"nodes": [0, 1]}]
    matrices = np.tile(np.eye(4, dtype="f4"), (2, 1, 1))
    matrices[:, 3, :3] = bound
    file.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": file.array(matrices)}]
    of_joints = np.cumsum(moves, axis=0) + bound
    expected = CUBE + np.einsum("nj,njk->nk", weights, of_joints[joints])
    assert np.allclose(np.roll(file.read(tmp_path).mesh.coordinates, 1, axis=1), expected, atol=1e-4)
    file.json["skins"][0]["joints"] = [1]
    sentence = f"a.gltf: skins 0: it must have all joints and their matrices{END}"
    assert refusal(file.read, tmp_path) == sentence
    file.json["skins"] = [{"joints": [1, 2]}]
    assert refusal(file.read, tmp_path) == sentence


def test_nodes_at_one_place_are_one_and_what_is_left_out_is_told(tmp_path: Path) -> None:
    file = Gltf()
    own = CUBE[TRIANGLES].astype("f4")
    normals, heat = file.array(own - np.float32(0.5)), file.array(own[:, 0].copy())
    colors, places = file.attributes["POSITION"], file.array(own)
    file.primitive["attributes"] = {"POSITION": places, "NORMAL": normals, "COLOR_0": colors, "_HEAT": heat}
    del file.primitive["indices"]
    file.json["extensionsRequired"] = ["KHR_texture_basisu", "KHR_materials_unlit"]
    file.json["extensionsUsed"] = ["KHR_lights_punctual", "X_new"]
    file.node["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    file.json |= {"animations": [{}], "cameras": [{}, {}]}
    report = file.read(tmp_path)
    assert len(report.mesh.coordinates) == 8
    mesh = read_mesh({"file": tmp_path / "a.gltf"}, Placement("x", normals="file")).mesh
    assert mesh.own_normals is not None
    at_corners = (mesh.coordinates[mesh.node_numbers] - 0.5) / math.sqrt(0.75)
    assert np.allclose(mesh.own_normals.vectors[mesh.own_normals.numbers], at_corners)
    assert report.repairs == (
        "a.gltf: left out its animations, attributes of its own, cameras, colors of nodes and lights",
    )


END = "; correct the file, or write it as OBJ or PLY"
VTK = "VTK must be able to read it, and cannot ({})" + END
EXTENSION = (
    "it must have no extension that may change the geometry, as {} does; export it without this extension"
)
PRIMITIVE = "meshes.0.primitives.0"


@pytest.mark.parametrize(
    ("path", "value", "sentence"),
    [
        ("extensionsRequired", ["X_new"], EXTENSION.format("'X_new'")),
        (f"{PRIMITIVE}.extensions", {"KHR_draco_x": {}}, EXTENSION.format("'KHR_draco_x'")),
        ("bufferViews.0.byteOffset", -4,
         "accessors 0: its values must be within its view (offset must be non-negative and no greater than"
         f" buffer length (168)){END}"),
        ("buffers", [{"byteLength": 168}],
         f"accessors 0: its values must be within its view (buffer is smaller than requested size){END}"),
        ("accessors.0.count", 7, VTK.format("Invalid index in primitive")),
        (f"{PRIMITIVE}.mode", 1,
         f"its scene must have meshes of triangles; skipped primitives of points or lines: 1{END}"),
        ("nodes.0.children", [0], f"VTK must give a whole mesh, and does not (it crashed (code -11)){END}"),
        (f"{PRIMITIVE}.attributes.JOINTS_1", 0,
         f"meshes 0: a node of a skin must have four joints at most{END}"),
        ("buffers", [{"uri": "b%20c"}],
         "buffers 0: it must be in its folder, and is not there; copy it there"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(tmp_path: Path, path: str, value: object, sentence: str) -> None:
    file = Gltf()
    *keys, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    row: Any = file.json
    for key in keys:
        row = row[key]
    row[last] = value
    assert refusal(file.read, tmp_path) == f"a.gltf: {sentence}"


def test_the_size_of_a_file_is_that_of_its_buffers_too(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a b.bin").write_bytes(bytes(1000))
    path = tmp_path / "a.gltf"
    path.write_text('{"buffers": [{"uri": "sub/a%20b.bin"}, {"uri": "DATA:;base64,AAAA"}, {}]}')
    assert size_of_gltf(path) == path.stat().st_size + 1000


NO_JSON = "a.gltf: a glTF file must describe its scene in JSON ({}); write it again"
BINARY = NO_JSON.format("it has no version 2, or is cut short or damaged")
test_what_is_no_scene_is_refused = refused(
    "a.gltf",
    [
        (b'{"a": NaN}', NO_JSON.format("the number NaN")),
        (struct.pack("<4sIII4s2s", b"glTF", 2, 22, 2, b"JSON", b"[]"), NO_JSON.format("a list")),
        *(
            (struct.pack("<4sIII4s2s", b"glTF", *head, b"[]"), BINARY)
            for head in ((1, 22, 2, b"JSON"), (2, 22, 2, b"BIN"), (2, 23, 2, b"JSON"), (2, 22, 3, b"JSON"))
        ),
    ],
)
