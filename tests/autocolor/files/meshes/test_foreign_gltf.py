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
from autocolor.files.meshes import gltf_document
from autocolor.files.meshes.gltf_document import MOST_LEVELS, size_of_gltf
from autocolor.files.meshes.repair import MeshReport, Placement
from tests.autocolor.files.meshes.test_foreign_vtk import CUBE, area_of, volume_of
from tests.autocolor.files.refusals import is_read_or_refused, refusal

needs_vtk = pytest.mark.needs("vtkmodules")
shared = pytest.mark.usefixtures("shared")

TRIANGLES = np.array(
    [
        0,
        2,
        3,
        0,
        3,
        1,
        4,
        5,
        7,
        4,
        7,
        6,
        0,
        1,
        5,
        0,
        5,
        4,
        1,
        3,
        7,
        1,
        7,
        5,
        3,
        2,
        6,
        3,
        6,
        7,
        2,
        0,
        4,
        2,
        4,
        6,
    ],
    np.uint16,
)
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
        """The number of a new accessor, whose rows begin at multiples of four bytes."""
        width = values.shape[1] if values.ndim == 2 else 1
        padded = np.zeros(
            (len(values), width + (-width * values.itemsize % 4) // values.itemsize), values.dtype
        )
        padded[:, :width] = values.reshape(len(values), width)
        padded = values if width == 1 else padded
        stride = {} if padded.shape == values.shape else {"byteStride": padded.strides[0]}
        row = {
            "bufferView": self.view(padded.tobytes(), **stride),
            "componentType": COMPONENTS[values.dtype.str[1:]],
        }
        self.json["accessors"].append({**row, "count": len(values), "type": TYPES[width], **others})
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


@needs_vtk
@shared
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
    assert report.repairs == ("a." + suffix + ": left out other scenes: 1",)
    names = [file.read(tmp_path, suffix=suffix).mesh.part_names for _ in range(2)]
    assert names == [report.mesh.part_names] * 2


@needs_vtk
@shared
def test_parts_of_one_mesh_are_named_by_their_materials(tmp_path: Path) -> None:
    file = Gltf().named("door")
    file.json["materials"] = [{"name": "paint"}, {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    primitives = [{**file.primitive, "material": number} for number in (0, 1, 1)]
    file.json["meshes"] = [{"name": "panel", "primitives": [*primitives, file.primitive]}]
    report = file.read(tmp_path)
    assert report.mesh.part_names == ("door paint", "door material 1", "door material 1 2", "door")
    assert [each.name for each in report.materials] == ["paint"]
    assert report.repairs == ("a.gltf: left out the textures of parts: 2",)
    del file.json["nodes"][0]["name"]
    assert file.read(tmp_path).mesh.part_names[3] == "panel"


@needs_vtk
@shared
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


@needs_vtk
@shared
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


@needs_vtk
@shared
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


@needs_vtk
@shared
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


@needs_vtk
@shared
def test_scalars_and_nodes_are_those_of_the_file(tmp_path: Path) -> None:
    file = Gltf()
    # Each corner has a node of its own, as with normals of its own, and a scalar.
    own = CUBE[TRIANGLES].astype(np.float32)
    attributes = {
        "POSITION": file.array(own),
        "NORMAL": file.array(own - np.float32(0.5)),
        "COLOR_0": file.places,
    }
    attributes["_HEAT"] = file.array(np.where(own[:, 0] == 0, 1, 2).astype(np.float32))
    file.json["meshes"][0]["primitives"] = [{"attributes": attributes}]
    report = file.read(tmp_path)
    assert len(report.mesh.coordinates) == 8
    [heat] = report.mesh.scalars
    assert heat.name == "HEAT"
    assert heat.values.tolist() == (report.mesh.coordinates[:, 2] + 1).tolist()
    assert report.repairs == ("a.gltf: left out the colors of nodes of parts: 1",)
    attributes["_HEAT"] = file.array(np.arange(36, dtype=np.float32))
    assert len(file.read(tmp_path).mesh.coordinates) == 36


# What is refused.

ONE = "it must have no extension that may change the geometry, as {!r} does; export it without this extension"
CUT = (
    "a.glb: a binary glTF file must have version 2, its own length and a chunk of JSON first; the file is cut"
    " short or damaged"
)
WITHIN = "accessors 0: its {} values must be within its bufferView and its buffer, which has 168 bytes"
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


@needs_vtk
@shared
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
         "accessors 0: byteOffset must be a whole number of at least 0, not -4"),
        ("accessors.0.type", "VEC2",
         "accessors 0: its type must have 3 components of a known type, not be 'VEC2' of 5126"),
        ("accessors.1.count", 35, "meshes 0: triangles must have three corners each, not 35 in all"),
        ("accessors.0.count", 7, "meshes 0: a corner must be a node from 0 to 6"),
        (f"{PRIMITIVE}.mode", 7, "meshes 0: the mode of a primitive must be 0 to 6, not 7"),
        (f"{PRIMITIVE}.mode", 1,
         "its scene must have meshes of triangles; skipped primitives of points or lines: 1"),
        (f"{PRIMITIVE}.attributes.NORMAL", 1,
         "accessors 1: its type must have 3 components of a known type, not be 'SCALAR' of 5123"),
        ("nodes.0.mesh", 5, "meshes must have a row 5, which another row names"),
        ("nodes.0.children", [0], "nodes 0: a node must be below one other node at most"),
        ("nodes.0.children", ["x"], "children must be a list of the numbers of nodes, not ['x']"),
        ("nodes.0.scale", [1, 2], "nodes 0: scale must be 3 finite numbers, not [1, 2]"),
        ("nodes.0.skin", 0, "meshes 0: a node of a skin must have one to four joints with weights"),
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


@needs_vtk
@shared
def test_extensions_of_materials_and_lights_do_no_harm(tmp_path: Path) -> None:
    file = Gltf()
    file.json["extensionsRequired"] = ["KHR_texture_basisu", "KHR_materials_unlit"]
    file.json["extensionsUsed"] = ["KHR_lights_punctual", "X_new"]
    file.json["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    file.json |= {"animations": [{}], "cameras": [{}, {}]}
    assert file.read(tmp_path).repairs == tuple(
        f"a.gltf: left out {what}" for what in ("animations: 1", "cameras: 2", "lights: 1")
    )


def test_buffers_in_the_folder_are_counted_and_data_in_the_file_are_not(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a b.bin").write_bytes(bytes(1000))
    path = tmp_path / "a.gltf"
    path.write_text('{"buffers": [{"uri": "sub/a%20b.bin"}, {"uri": "DATA:;base64,AAAA"}, {}]}')
    assert size_of_gltf(path) == path.stat().st_size + 1000
    (tmp_path / "sub" / "a b.bin").unlink()
    assert refusal(size_of_gltf, path) == (
        "a.gltf: buffers 0: it must be in its folder, where there is no file 'a b.bin'; copy it there"
    )


@pytest.mark.parametrize(
    ("uri", "sentence"),
    [
        *(
            (address, f"not the address {address!r}; fetch it and name the file")
            for address in ("http://example.org/a.bin", "file:///etc/passwd")
        ),
        *(
            (uri, f"in the scene's folder, not {name!r}; copy the file there")
            for uri, name in (("../a.bin", "../a.bin"), ("%2e%2e/a.bin", "../a.bin"), ("/etc/a", "/etc/a"))
        ),
        ("a%00.bin", "not 'a\\x00.bin'; correct it"),
        (7, "not ''; correct it"),
    ],
)
def test_no_address_is_fetched_and_no_file_out_of_the_folder_read(
    tmp_path: Path, uri: object, sentence: str
) -> None:
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps({"buffers": [{}, {"uri": uri}]}))
    told = refusal(read_mesh, {"file": path})
    assert told.startswith("a.gltf: buffers 1: it must be the name of a file")
    assert told.endswith(sentence)


JSON = b'{"buffers": [{"uri": "https://x"}]}'


def glb(
    version: int = 2, length: int = 20 + len(JSON), size: int = len(JSON), kind: bytes = b"JSON"
) -> bytes:
    return struct.pack("<4sIII4s", b"glTF", version, length, size, kind) + JSON


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        *(
            ("a.gltf", data, "a.gltf: a glTF file must describe its scene in JSON, not ")
            for data in (b"", b"[]", b"{", b'{"a": NaN}', b"[" * 100_000, b"\xff")
        ),
        ("a.gltf", b'{"buffers": {}}', "a.gltf: buffers must be a list; correct the file"),
        ("a.glb", glb(), "a.glb: buffers 0: it must be the name of a file, not the address 'https://x'"),
        *(
            ("a.glb", data, CUT)
            for data in (
                *(glb()[:19], glb()[:20], glb(version=1), glb(version=3), glb(kind=b"BIN\0")),
                *(glb(length=21 + len(JSON)), glb(size=len(JSON) + 1), b"glTF" + bytes(40)),
                glb(length=28 + len(JSON)) + struct.pack("<I4s", 9, b"BIN\0"),
            )
        ),
    ],
    ids=lambda each: str(each)[:40],
)
def test_what_is_no_scene_is_refused(tmp_path: Path, name: str, data: bytes, sentence: str) -> None:
    (tmp_path / name).write_bytes(data)
    assert refusal(read_mesh, {"file": tmp_path / name}).startswith(sentence)


@needs_vtk
@shared
@pytest.mark.parametrize("levels", [MOST_LEVELS, MOST_LEVELS + 1])
def test_nodes_have_a_limited_depth_and_json_a_limited_size(
    tmp_path: Path, levels: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = Gltf()
    file.json["nodes"] = [*({"children": [number + 1]} for number in range(levels)), {"mesh": 0}]
    if levels <= MOST_LEVELS:
        assert volume_of(file.read(tmp_path)) == pytest.approx(1)
    else:
        assert refusal(file.read, tmp_path).startswith(
            "a.gltf: nodes 101: a node must have at most 100 nodes above"
        )
    monkeypatch.setattr(gltf_document, "MOST_VALUES", 9)
    assert refusal(file.read, tmp_path).startswith("a.gltf: a glTF file must describe its scene in JSON")


@needs_vtk
@shared
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
