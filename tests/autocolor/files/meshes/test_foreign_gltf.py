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
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.formats import read_mesh
from autocolor.files.meshes.foreign import read_in_own_process
from autocolor.files.meshes.gltf_document import size_of_gltf
from autocolor.files.meshes.repair import MeshReport, Placement
from tests.autocolor.files.meshes.test_foreign_vtk import CUBE, FACES, area_of, format_named, volume_of
from tests.autocolor.files.refusals import is_read_or_refused, refusal

pytestmark = [pytest.mark.needs("vtkmodules"), pytest.mark.usefixtures("shared")]

TRIANGLES = np.array([face[at] for face in FACES for at in (0, 1, 2, 0, 2, 3)], np.uint16)
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Gltf:
    """A glTF file of a cube, to be changed and written."""

    def __init__(self, **primitive: Any) -> None:
        self.binary = b""
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []}
        self.places, self.corners = self.array(CUBE.astype(np.float32)), self.array(TRIANGLES)
        self.primitive = {"attributes": {"POSITION": self.places}, "indices": self.corners, **primitive}
        self.json |= {
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [self.primitive]}],
        }

    def view(self, data: bytes, **others: Any) -> int:
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **others}
        )
        self.binary += data + bytes(-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def array(self, values: Any, **others: Any) -> int:
        """The number of a new accessor, whose rows of several numbers begin at multiples of four bytes."""
        width, stride = values.shape[1] if values.ndim == 2 else 1, {}
        row = {"count": len(values), "type": TYPES[width], "componentType": COMPONENTS[values.dtype.str[1:]]}
        if width > 1:
            values = np.pad(values, ((0, 0), (0, (-width * values.itemsize % 4) // values.itemsize)))
            stride = {"byteStride": values.strides[0]} if values.shape[1] > width else {}
        view = self.view(np.ascontiguousarray(values).tobytes(), **stride)
        self.json["accessors"].append({**row, "bufferView": view, **others})
        return len(self.json["accessors"]) - 1

    def named(self, *names: str) -> Gltf:
        """The same with the names of nodes, each of which has the mesh."""
        self.json["nodes"] = [{"mesh": 0, "name": name} for name in names]
        self.json["scenes"] = [{"nodes": list(range(len(names)))}]
        return self

    def write(self, folder: Path, suffix: str = "gltf") -> Path:
        path = folder / f"a.{suffix}"
        if suffix == "glb":
            described = {**self.json, "buffers": [{"byteLength": len(self.binary)}]}
            text = json.dumps(described).encode()
            text += b" " * (-len(text) % 4)
            size = 28 + len(text) + len(self.binary)
            head = struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON")
            path.write_bytes(head + text + struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)
        else:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.binary).decode()
            buffers = [{"byteLength": len(self.binary), "uri": uri}]
            path.write_text(json.dumps({"buffers": buffers} | self.json))
        return path

    def read(self, folder: Path, up: str = "x", suffix: str = "gltf") -> MeshReport:
        """The mesh, with x up: (x, y, z) of the file become (y, z, x)."""
        return read_mesh({"file": self.write(folder, suffix)}, Placement(up))


def box(report: MeshReport) -> list[list[float]]:
    """The corners of the box around a mesh that was read with x up, in the axes of the file."""
    return [np.roll(each, 1).round(5).tolist() for each in report.mesh.bounds]


@pytest.mark.parametrize("suffix", ["gltf", "glb"])
def test_each_node_is_a_part_that_is_placed_and_up(tmp_path: Path, suffix: str) -> None:
    file = Gltf().named("wheel", "wheel", "")
    red = {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0, 1, 1]}}
    file.json["materials"] = [red]
    file.primitive["material"] = 0
    file.json["nodes"][0]["translation"] = [5, 0, 0]
    file.json["nodes"][1]["scale"] = [-1, 1, 1]
    half = math.sqrt(0.5)
    turned = {"rotation": [0, 0, 2 * half, 2 * half], "children": [2]}
    file.json["nodes"][2]["matrix"] = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1]
    file.json["nodes"].append(turned)
    file.json["scenes"] = [{"nodes": []}, {"nodes": [0, 1, 3]}]
    file.json["scene"] = 1
    report = file.read(tmp_path, suffix=suffix)
    assert report.mesh.part_names == ("wheel", "wheel 2", "a")
    assert volume_of(report) == pytest.approx(1 + 1 + 8)
    assert box(report) == [[-2, 0, 0], [6, 12, 2]]
    assert box(file.read(tmp_path, "z", suffix))[0] == pytest.approx([0, -2, -2])
    assert report.material_of_part == dict.fromkeys(report.mesh.part_names, "red")
    assert [(each.name, each.paint.object_color) for each in report.materials] == [("red", (188, 0, 255))]
    assert report.repairs == ("a." + suffix + ": left out its other scenes",)
    names = [file.read(tmp_path, suffix=suffix).mesh.part_names for _ in range(2)]
    assert names == [report.mesh.part_names] * 2


def test_parts_of_one_mesh_are_named_by_their_materials(tmp_path: Path) -> None:
    file = Gltf().named("door")
    file.json["materials"] = [{"name": "paint"}, {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    primitives = [{**file.primitive, "material": number} for number in (0, 1, 1)]
    file.json["meshes"] = [{"name": "panel", "primitives": [*primitives, file.primitive]}]
    report = file.read(tmp_path)
    assert report.mesh.part_names == ("door paint", "door material 1", "door material 1 2", "door")
    assert [each.name for each in report.materials] == ["paint"]
    assert report.repairs == ("a.gltf: left out its textures",)
    del file.json["nodes"][0]["name"]
    assert file.read(tmp_path).mesh.part_names[3] == "panel"


def test_quantized_and_sparse_numbers_are_unpacked(tmp_path: Path) -> None:
    for kind, scale, normalized, side in (
        ("i2", 32767, True, 1), ("u2", 65535, True, 1), ("i1", 127, True, 1), ("u1", 255, True, 1),
        ("i2", 300, False, 300), ("u2", 40_000, False, 40_000), ("u1", 3, False, 3),
    ):  # fmt: skip
        file = Gltf()
        file.json["extensionsRequired"] = file.json["extensionsUsed"] = ["KHR_mesh_quantization"]
        places = file.array((CUBE * scale).astype(kind), normalized=normalized)
        file.primitive["attributes"] = {"POSITION": places}
        report = file.read(tmp_path)
        assert box(report) == [[0, 0, 0], [side] * 3]
        assert volume_of(report) == pytest.approx(side**3)
    # A sparse accessor, of quantized numbers too, moves the upper nodes.
    for kind, scale in (("f4", 1), ("i1", 127)):
        file = Gltf()
        rows, values = (
            file.view(bytes([4, 5, 6, 7])),
            file.view((CUBE[4:] * [scale, scale, 0]).astype(kind).tobytes()),
        )
        indices = {"bufferView": rows, "componentType": 5121}
        if kind == "i1":
            places = file.array((CUBE * scale).astype(kind), normalized=True)
            file.json["bufferViews"][values]["byteStride"] = 3
        else:
            places = file.places
        sparse = {"count": 4, "indices": indices, "values": {"bufferView": values}}
        file.json["accessors"][places]["sparse"] = sparse
        file.primitive["attributes"] = {"POSITION": places}
        assert area_of(file.read(tmp_path)) == pytest.approx(2)
    # Without a view, an accessor is zero but for its sparse values.
    del file.json["accessors"][places]["bufferView"]
    assert box(file.read(tmp_path)) == [[0, 0, 0], [1, 1, 0]]


def test_strips_and_fans_are_triangles_and_points_and_lines_are_counted(tmp_path: Path) -> None:
    for mode, indices in ((4, [0, 1, 3, 0, 3, 2]), (5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])):
        file = Gltf(mode=mode)
        file.primitive["indices"] = file.array(np.array(indices, np.uint32))
        others = [{**file.primitive, "mode": other} for other in range(4)]
        file.json["meshes"][0]["primitives"] = [*others, file.primitive]
        report = file.read(tmp_path)
        assert area_of(report) == pytest.approx(1)
        a, b, c, _ = report.mesh.coordinates[report.mesh.node_numbers.T]
        # With x up, z of the file is y.
        assert (np.cross(b - a, c - a)[:, 1] > 0).all()
        assert report.repairs == ("a.gltf: skipped primitives of points or lines: 4",
                                  "a.gltf: 4 nodes that no polygon uses were dropped")[: 2]  # fmt: skip


def raised(file: Gltf, height: float) -> int:
    """The number of an accessor that moves the upper nodes up."""
    return file.array(np.outer(CUBE[:, 2], [0, 0, height]).astype(np.float32))


def test_morph_targets_are_applied_with_their_weights(tmp_path: Path) -> None:
    file = Gltf().named("own", "mesh's")
    file.primitive["targets"] = [{"POSITION": raised(file, 2)}, {"POSITION": raised(file, 100)}]
    file.json["nodes"][0]["weights"] = [2, 0]
    assert box(file.read(tmp_path))[1] == [1, 1, 5]
    file.json["meshes"][0]["weights"] = [0.5, 0]
    assert volume_of(file.read(tmp_path)) == pytest.approx(5 + 2)
    # Weights of zero leave the file's normals as they are; other weights do not if a target has no normals.
    file.primitive["attributes"]["NORMAL"] = file.array(CUBE.astype(np.float32) + 1)
    del file.json["nodes"][0]["weights"]
    file.json["meshes"][0]["weights"] = [0, 0]
    assert volume_of(file.read(tmp_path)) == pytest.approx(2)
    file.primitive["targets"][0] = {"NORMAL": raised(file, 2)}
    assert volume_of(file.read(tmp_path)) == pytest.approx(2)


@pytest.mark.parametrize("with_matrices", [True, False])
def test_skins_move_nodes_by_the_weights_of_their_joints(tmp_path: Path, with_matrices: bool) -> None:
    chance = np.random.default_rng(4)
    joints = chance.integers(0, 2, (8, 4)).astype(np.uint8)
    weights = chance.random((8, 4)).astype(np.float32)
    weights /= weights.sum(axis=1, keepdims=True)
    file = Gltf()
    attributes = file.primitive["attributes"]
    attributes |= {"JOINTS_0": file.array(joints), "WEIGHTS_0": file.array(weights)}
    moves = np.array([[2.0, 0, 0], [0, 3, 1]])
    places = [{"translation": move.tolist()} for move in moves]
    file.json["nodes"] = [
        {"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
        {**places[0], "children": [2]},
        places[1],
    ]
    file.json["scenes"] = [{"nodes": [0, 1]}]
    skin: dict[str, Any] = {"joints": [1, 2]}
    bound = np.zeros((2, 3))
    if with_matrices:
        bound = np.array([[-1.0, 0, 0], [0, -2, 0]])
        matrices = np.tile(np.eye(4, dtype=np.float32), (2, 1, 1))
        matrices[:, 3, :3] = bound
        skin["inverseBindMatrices"] = file.array(matrices.reshape(2, 16))
    file.json["skins"] = [skin]
    of_joints = np.cumsum(moves, axis=0) + bound
    expected = CUBE + np.einsum("nj,njk->nk", weights, of_joints[joints])
    found = np.roll(file.read(tmp_path).mesh.coordinates, 1, axis=1)
    assert np.allclose(found, expected, atol=1e-4)


def test_nodes_at_one_place_are_one_and_what_is_left_out_is_told(tmp_path: Path) -> None:
    file = Gltf()
    own = CUBE[TRIANGLES].astype(np.float32)
    normals, heat = file.array(own - np.float32(0.5)), file.array(own[:, 0].copy())
    attributes = {"POSITION": file.array(own), "NORMAL": normals, "COLOR_0": file.places, "_HEAT": heat}
    file.json["meshes"][0]["primitives"] = [{"attributes": attributes}]
    file.json["extensionsRequired"] = ["KHR_texture_basisu", "KHR_materials_unlit"]
    file.json["extensionsUsed"] = ["KHR_lights_punctual", "X_new"]
    file.json["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    file.json |= {"animations": [{}], "cameras": [{}, {}]}
    report = file.read(tmp_path)
    assert len(report.mesh.coordinates) == 8
    polygons = read_in_own_process(format_named("glTF"), tmp_path / "a.gltf", 1).polygons
    assert polygons.normals is not None
    assert polygons.corner_normals is not None
    at_corners = (polygons.coordinates[polygons.corners] - 0.5) / math.sqrt(0.75)
    assert np.allclose(polygons.normals[polygons.corner_normals], at_corners)
    assert report.repairs == (
        "a.gltf: left out its animations, attributes of its own, cameras, colors of nodes and lights",
    )


# What is refused.

ONE = "it must have no extension that may change the geometry, as {!r} does; export it without this extension"
CUT = (
    "a.gltf: a binary glTF file must have version 2, its own length and a chunk of JSON first; the file is"
    " cut short or damaged"
)
WITHIN = "accessors 0: its {} values must be within its view"
VTK = "VTK must be able to read it, and cannot ({})"
SEGV = "VTK must read it, and crashed (code -11)"
PRIMITIVE = "meshes.0.primitives.0"


def changed(path: str, value: object) -> Gltf:
    """The cube with one value of its JSON changed, by keys and numbers with points between."""
    file = Gltf()
    *keys, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    row: Any = file.json
    for key in keys:
        row = row[key]
    row[last] = value
    return file


@pytest.mark.parametrize(
    ("path", "value", "sentence"),
    [
        ("extensionsRequired", ["X_new"], ONE.format("X_new")),
        ("extensionsUsed", ["KHR_draco_mesh_compression"], ONE.format("KHR_draco_mesh_compression")),
        *(
            (f"{where}.extensions", {name: {}}, ONE.format(name))
            for where, name in (
                (PRIMITIVE, "KHR_draco_mesh_compression"),
                ("bufferViews.0", "EXT_meshopt_compression"),
                ("nodes.0", "EXT_mesh_gpu_instancing"),
                ("accessors.1", "X_new"),
            )
        ),
        ("accessors.0.count", 90, WITHIN.format(90)),
        ("bufferViews.0.byteLength", 95, WITHIN.format(8)),
        ("bufferViews.0.byteOffset", -4,
         "bufferViews 0: byteOffset must be a whole number of at least 0, not -4"),
        ("bufferViews.0.buffer", 1, "bufferViews 0: it must be within its buffer"),
        ("accessors.0.type", "VEC9", "accessors 0: its type must be one of glTF, not 'VEC9' of 5126"),
        ("accessors.0.count", 7, VTK.format("Invalid index in primitive")),
        (f"{PRIMITIVE}.mode", 1,
         "its scene must have meshes of triangles; skipped primitives of points or lines: 1"),
        ("nodes.0.mesh", 5, VTK.format("Invalid mesh index 5")),
        ("nodes.0.children", [0], SEGV),
        ("accessors", "x", VTK.format("Invalid accessor value")),
        ("accessors.0.bufferView", 9,
         "its JSON must describe a scene as glTF 2.0 does, and is damaged"),
        (f"{PRIMITIVE}.attributes.JOINTS_1", 0, "meshes 0: a node of a skin must have four joints at most"),
        ("meshes.0.weights", [1, 1],
         "VTK must be able to read it, and cannot (Invalid number of morphing weights)"),
        ("nodes", [{}], "its scene must have meshes of triangles"),
        ("buffers", [{"byteLength": 168}],
         "buffers 0: it must have the 168 bytes that the file says, not 0"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(tmp_path: Path, path: str, value: object, sentence: str) -> None:
    end = "" if "export" in sentence else "; correct the file, or write it as OBJ or PLY"
    assert refusal(changed(path, value).read, tmp_path) == f"a.gltf: {sentence}{end}"


NAMED = "a.gltf: buffers 0: it must be the name of a file"


@pytest.mark.parametrize(
    ("uri", "sentence"),
    [
        ("http://x/a.bin", f"{NAMED}, not the address 'http://x/a.bin'; fetch it and name the file"),
        ("file:///etc/a", f"{NAMED}, not the address 'file:///etc/a'; fetch it and name the file"),
        ("../a.bin", f"{NAMED} in the scene's folder, not '../a.bin'; copy the file there"),
        ("%2e%2e/a.bin", f"{NAMED} in the scene's folder, not '../a.bin'; copy the file there"),
        ("/etc/a", f"{NAMED} in the scene's folder, not '/etc/a'; copy the file there"),
        ("a%00.bin", f"{NAMED}, not 'a\\x00.bin'; correct it"),
        (7, f"{NAMED}, not ''; correct it"),
        ("sub/a%20c.bin",
         "a.gltf: buffers 0: it must be in its folder, where there is no file 'a c.bin'; copy it there"),
    ],
)  # fmt: skip
def test_no_address_is_fetched_and_no_file_out_of_the_folder_read(
    tmp_path: Path, uri: object, sentence: str
) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a b.bin").write_bytes(bytes(1000))
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps({"buffers": [{"uri": uri}]}))
    assert refusal(read_mesh, {"file": path}) == sentence
    path.write_text('{"buffers": [{"uri": "sub/a%20b.bin"}, {"uri": "DATA:;base64,AAAA"}, {}]}')
    assert size_of_gltf(path) == path.stat().st_size + 1000


JSON = b'{"buffers": [{"uri": "https://x"}]}'


def glb(
    version: int = 2, length: int = 20 + len(JSON), size: int = len(JSON), kind: bytes = b"JSON"
) -> bytes:
    return struct.pack("<4sIII4s", b"glTF", version, length, size, kind) + JSON


NO_JSON = "a.gltf: a glTF file must describe its scene in JSON, not "
SCENES = [
    *((data, NO_JSON) for data in (b"", b"[]", b"{", b'{"a": NaN}', b"[" * 100_000, b"\xff")),
    *((data, CUT) for data in (glb()[:19], glb()[:20], glb(version=1), glb(version=3), glb(kind=b"BIN\0"))),
    *((data, CUT) for data in (glb(length=21 + len(JSON)), glb(size=len(JSON) + 1), b"glTF" + bytes(40))),
    (glb(), "a.gltf: buffers 0: it must be the name of a file, not the address 'https://x'"),
]


@pytest.mark.parametrize(("data", "sentence"), SCENES, ids=lambda each: str(each)[:40])
def test_what_is_no_scene_is_refused(tmp_path: Path, data: bytes, sentence: str) -> None:
    (tmp_path / "a.gltf").write_bytes(data)
    assert refusal(read_mesh, {"file": tmp_path / "a.gltf"}).startswith(sentence)


@given(
    st.sampled_from(["nodes.0", "accessors.0", "accessors.1", "bufferViews.0", PRIMITIVE, "meshes.0"]),
    st.sampled_from(
        ["mesh", "skin", "children", "count", "byteOffset", "byteLength", "componentType", "type", "sparse",
         "mode", "attributes", "indices", "material", "targets", "weights", "matrix", "extensions"]
    ),
    st.sampled_from([None, -1, 0, 3, 2**31, 2**63, 1.5, "x", [], [0], [1e300], {}, {"POSITION": 1}, True]),
)  # fmt: skip
def test_any_value_of_any_key_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, where: str, key: str, value: object
) -> None:
    path = changed(f"{where}.{key}", value).write(tmp_path_factory.getbasetemp())
    assert is_read_or_refused(path, path.read_bytes())
