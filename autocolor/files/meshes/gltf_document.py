"""A glTF or GLB file, checked and written out in full, so that a library cannot misunderstand it.

The numbers of accessors are unpacked here: sparse accessors, strides, quantized positions and defaults become
plain arrays. Nodes, skins and morph targets stay for the library. Buffers are read by our rule of paths. What
the program does not use is left out and counted: textures, colors of nodes, animations, lights and cameras.
An extension that may change the geometry is refused by its name.
"""

from __future__ import annotations

import binascii
import json
import math
import os
import re
import struct
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, NamedTuple
from urllib.parse import unquote, unquote_to_bytes

import numpy as np

from autocolor.arrays import AnyArray, Floats
from autocolor.checks import Color, shown
from autocolor.errors import InputError
from autocolor.files.meshes.foreign_mesh import ForeignRefusal
from autocolor.files.meshes.repair import different, printable_name
from autocolor.files.paths import path_within
from autocolor.files.reading import bounded_json, read_whole, status_of

MOST_VALUES: Final = 2_000_000
"""Limit: values in the JSON of a glTF file; numbers of meshes are in its buffers."""

MOST_LEVELS: Final = 100
"""Limit: nodes of a glTF file above a node. The library goes from node to node by recursion."""

Row = dict[str, Any]


def document(path: Path) -> tuple[Row, bytes]:
    """The JSON of a glTF file, and the binary chunk of a GLB file. Raises InputError if either is damaged."""
    data, binary = read_whole(path, 1), b""
    if data.startswith(b"glTF"):
        # A GLB file begins with its version, its length, and a chunk of JSON with its size.
        version, length, size, kind = struct.unpack_from("<III4s", data.ljust(20, b"\0"), 4)
        binary = data[20 + size : length]
        binary_size, binary_kind = struct.unpack_from("<I4s", binary.ljust(8, b"\0"))
        is_cut = length > len(data) or size > len(data) - 20 or binary_size > max(len(binary) - 8, 0)
        if version != 2 or kind != b"JSON" or is_cut:
            raise InputError(
                f"{path.name}: a binary glTF file must have version 2, its own length and a chunk of JSON"
                " first; the file is cut short or damaged"
            )
        data, binary = data[20 : 20 + size], binary[8 : 8 + binary_size]
        if binary_kind != b"BIN\0":
            binary = b""
    try:
        described = bounded_json(data, MOST_VALUES)
        if not isinstance(described, dict):
            raise ValueError(f"a {type(described).__name__}")
    except ValueError as error:
        reason = " ".join(str(error).split())[:100]
        raise InputError(
            f"{path.name}: a glTF file must describe its scene in JSON, not {reason}; write it again"
        ) from None
    return described, binary


def buffer_files(path: Path, described: Row) -> list[Path | None]:
    """The files of the buffers, in the folder of a glTF file; None for buffers within the file.

    Raises InputError for an address, a file outside of the folder, or a file that is not there.
    """
    rows = described.get("buffers", [])
    if not isinstance(rows, list):
        raise InputError(f"{path.name}: buffers must be a list; correct the file")
    files: list[Path | None] = []
    for number, row in enumerate(rows):
        uri = row.get("uri") if isinstance(row, dict) else None
        if uri is None or (isinstance(uri, str) and uri[:5].lower() == "data:"):
            files.append(None)
            continue
        reasons: list[str] = []
        named = path_within(reasons, path.parent, unquote(uri) if isinstance(uri, str) else "")
        if named is not None and not named.is_file():
            reasons.append(f"must be in its folder, where there is no file {named.name!r}; copy it there")
        if reasons:
            raise InputError(f"{path.name}: buffers {number}: it {reasons[0]}")
        files.append(named)
    return files


def size_of_gltf(path: Path) -> int:
    """The bytes of a glTF file and of the buffers in its folder. Raises InputError."""
    described, _ = document(path)
    files = buffer_files(path, described)
    return status_of(path).st_size + sum(os.stat(each).st_size for each in files if each is not None)


# Extensions. Most concern materials and textures, which are left out.

HARMLESS: Final = re.compile(
    r"(KHR|EXT|ADOBE|MSFT|AGI)_(materials|texture|lights|xmp|animation|packing|articulations|audio)\w*"
    r"|KHR_mesh_quantization|EXT_(mesh|instance|structural)_(features|metadata)|FB_ngon_encoding|MSFT_lod"
    r"|CESIUM_primitive_outline|MOZ_\w+"
)
"""Extensions without which the geometry is the same."""

GEOMETRIC: Final = re.compile(r"\w*(draco|meshopt|instancing|gaussian|compression|CESIUM_RTC)\w*")
"""Extensions that are refused even if they are only listed as used."""

WITH_GEOMETRY: Final = ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "skins")


def _refuse_extensions(described: Row) -> None:
    """Raise ForeignRefusal for an extension that is required or in the geometry, and is not harmless."""
    rows = [row for key in WITH_GEOMETRY for row in _list(described, key)]
    rows += [row for mesh in _list(described, "meshes") for row in _list(mesh, "primitives")]
    needed = [str(each) for each in _list(described, "extensionsRequired")]
    needed += [each for each in map(str, _list(described, "extensionsUsed")) if GEOMETRIC.fullmatch(each)]
    needed += [each for row in rows if isinstance(row, dict) for each in _table(row, "extensions")]
    for name in needed:
        if not HARMLESS.fullmatch(name):
            raise ForeignRefusal(
                f"it must have no extension that may change the geometry, as {shown(name)} does",
                "export it without this extension",
            )


def _list(row: object, key: str) -> list[Any]:
    """The list of a row; empty if it has none."""
    rows = row.get(key) if isinstance(row, dict) else None
    return rows if isinstance(rows, list) else []


# Accessors.

TYPES: Final = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Accessors:
    """The rows of a glTF file by their numbers, and the arrays of its accessors."""

    def __init__(self, path: Path) -> None:
        self.described, self._binary = document(path)
        self._files = buffer_files(path, self.described)
        self._buffers: dict[int, bytes] = {}

    def rows(self, key: str) -> list[Any]:
        """The rows of a list of the file."""
        return _list(self.described, key)

    def row(self, key: str, number: object) -> Row:
        """One row of a list of the file. Raises ForeignRefusal if there is none."""
        rows = self.rows(key)
        if type(number) is int and 0 <= number < len(rows) and isinstance(rows[number], dict):
            row: Row = rows[number]
            return row
        raise ForeignRefusal(f"{key} must have a row {shown(number)}, which another row names")

    def array(self, number: object, *widths: int) -> AnyArray:
        """The values of an accessor, (count, width), with one of the widths. Raises ForeignRefusal.

        Normalized numbers are float32 from -1 to 1, others have the type of the file.
        """
        row = self.row("accessors", number)
        place = f"accessors {number}"
        width, type_ = WIDTHS.get(row.get("type", ""), 0), TYPES.get(row.get("componentType", 0))
        if width not in widths or type_ is None:
            raise ForeignRefusal(
                f"{place}: its type must have {' or '.join(map(str, widths))} components of a known type,"
                f" not be {shown(row.get('type'))} of {shown(row.get('componentType'))}"
            )
        dtype, count = np.dtype(type_), whole(row, "count", place)
        if "bufferView" in row:
            values = self._viewed(row, place, count, width, dtype)
        else:
            values = np.zeros((count, width), dtype)
        if "sparse" in row:
            sparse = _table(row, "sparse")
            changed = whole(sparse, "count", place)
            indices, those = _table(sparse, "indices"), _table(sparse, "values")
            index_type = np.dtype(TYPES.get(indices.get("componentType", 0), "<u1"))
            at = self._viewed(indices, place, changed, 1, index_type)[:, 0]
            if changed and at.max() >= count:
                raise ForeignRefusal(f"{place}: its sparse values must be in rows 0 to {count - 1}")
            values = values.copy()
            values[at] = self._viewed(those, place, changed, width, dtype)
        if row.get("normalized") is True and dtype.kind in "iu":
            values = np.maximum(values / np.float32(np.iinfo(dtype).max), np.float32(-1))
        return values

    def _viewed(self, row: Row, place: str, count: int, width: int, dtype: np.dtype[Any]) -> AnyArray:
        """Values, (count, width), from the view that an accessor or a part of it names."""
        view = self.row("bufferViews", row.get("bufferView"))
        buffer = self._buffer(view.get("buffer"))
        start, length = whole(view, "byteOffset", place, 0), whole(view, "byteLength", place)
        offset, item = whole(row, "byteOffset", place, 0), width * dtype.itemsize
        stride = whole(view, "byteStride", place, item) or item
        end = offset + stride * (count - 1) + item if count else 0
        if stride < item or end > length or start + length > len(buffer):
            raise ForeignRefusal(
                f"{place}: its {count:,} values must be within its bufferView and its buffer, which has"
                f" {len(buffer):,} bytes"
            )
        return np.ndarray((count, width), dtype, buffer, start + offset, (stride, dtype.itemsize))

    def _buffer(self, number: object) -> bytes:
        """The bytes of a buffer. Raises ForeignRefusal if there are fewer than the file says."""
        row = self.row("buffers", number)
        assert isinstance(number, int)
        if number not in self._buffers:
            named, uri = self._files[number], row.get("uri")
            data = self._binary if uri is None else _data_of(uri) if named is None else read_whole(named, 1)
            least = whole(row, "byteLength", f"buffers {number}")
            if len(data) < least:
                raise ForeignRefusal(
                    f"buffers {number}: it must have the {least:,} bytes that the file says, not"
                    f" {len(data):,}"
                )
            self._buffers[number] = data
        return self._buffers[number]


def _data_of(uri: str) -> bytes:
    """The bytes within a data URI. Raises ForeignRefusal."""
    head, _, text = uri.partition(",")
    try:
        return binascii.a2b_base64(unquote(text)) if head.endswith(";base64") else unquote_to_bytes(text)
    except ValueError as error:
        raise ForeignRefusal(f"the data of a buffer must be base64, not damaged ({error})") from None


def whole(row: Row, key: str, place: str, default: int | None = None) -> int:
    """A whole number of at least 0 in a row. Raises ForeignRefusal."""
    value = row.get(key, default)
    if type(value) is not int or not 0 <= value < 1 << 40:
        raise ForeignRefusal(f"{place}: {key} must be a whole number of at least 0, not {shown(value)}")
    return value


def _table(row: Row, key: str) -> Row:
    """The table of a row; empty if it has none."""
    value = row.get(key)
    return value if isinstance(value, dict) else {}


def numbers(row: Row, key: str, place: str, count: int | None = None) -> list[float] | None:
    """A list of finite numbers in a row, None if it has none. Raises ForeignRefusal."""
    if key not in row:
        return None
    values = row[key]
    if isinstance(values, list) and (count is None or len(values) == count):
        found = [float(each) for each in values if type(each) in (int, float) and abs(each) < 1e38]
        if len(found) == len(values):
            return found
    wanted = "finite numbers" if count is None else f"{count} finite numbers"
    raise ForeignRefusal(f"{place}: {key} must be {wanted}, not {shown(values)}")


# The scene.


class Primitive(NamedTuple):
    """The number of nodes of a primitive, their scalars, and its material or None."""

    nodes: int
    scalars: dict[str, Floats]
    material: int | None


@dataclass(eq=False)
class Completed:
    """A glTF file written out as `glb`, and what the library need not know.

    `primitives` has those of each mesh, `names` a name for each node with a mesh, by the numbers of the file.
    """

    glb: bytes = b""
    primitives: dict[int, list[Primitive]] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    materials: tuple[str, ...] = ()
    colors: dict[str, Color] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)


def completed(path: Path) -> Completed:
    """The default scene of a glTF file. Raises InputError and ForeignRefusal."""
    file = Accessors(path)
    _refuse_extensions(file.described)
    writer = _Writer(file)
    writer.write(path.stem)
    return writer.result


class _Writer:
    """Writes the parts of a scene that the library is to put together."""

    def __init__(self, file: Accessors) -> None:
        self.file = file
        self.result = Completed()
        self._binary = bytearray()
        self._views: list[Row] = []
        self._accessors: list[Row] = []

    def write(self, stem: str) -> None:
        file, result = self.file, self.result
        roots = self._roots()
        nodes = dict(self._nodes(roots))
        self._materials()
        users: dict[str, list[Row]] = defaultdict(list)
        for row in nodes.values():
            users[str(row.get("mesh"))].append(row)
        meshes: list[Row] = [{"primitives": []} for _ in file.rows("meshes")]
        written: list[Row] = [{} for _ in file.rows("nodes")]
        skins: list[Row] = [{"joints": [0]} for _ in file.rows("skins")]
        for number, row in nodes.items():
            node, mesh = _placed(row, f"nodes {number}"), row.get("mesh")
            written[number] = node
            if mesh is None:
                continue
            named = file.row("meshes", mesh)
            result.names[number] = _name(row) or _name(named) or stem
            if mesh not in result.primitives:
                meshes[mesh] = self._mesh(mesh, named, users[str(mesh)])
            node["mesh"] = mesh
            if "weights" in meshes[mesh] and "weights" in row:
                node["weights"] = numbers(row, "weights", f"nodes {number}")
            if "skin" in row:
                node["skin"] = row["skin"]
                skins[row["skin"]] = self._skin(row["skin"], nodes, meshes[mesh])
        lights = sum("KHR_lights_punctual" in _table(row, "extensions") for row in nodes.values())
        for what, count in (
            ("animations", len(file.rows("animations"))),
            ("cameras", len(file.rows("cameras"))),
            ("lights", lights),
            ("other scenes", len(file.rows("scenes")) - 1),
        ):
            if count > 0:
                result.left_out[f"left out {what}"] = count
        described = {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": roots}],
            "nodes": written,
            "meshes": meshes,
            "skins": skins,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        text = json.dumps({key: each for key, each in described.items() if each}).encode()
        text += b" " * (-len(text) % 4)
        result.glb = (
            struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(self._binary), len(text), b"JSON")
            + text
            + struct.pack("<I4s", len(self._binary), b"BIN\0")
            + self._binary
        )

    def _roots(self) -> list[int]:
        """The nodes of the default scene; without scenes, the nodes that are no children."""
        file = self.file
        if file.rows("scenes"):
            return _children(file.row("scenes", file.described.get("scene", 0)), "nodes")
        below = {each for row in file.rows("nodes") for each in _list(row, "children")}
        return [number for number in range(len(file.rows("nodes"))) if number not in below]

    def _nodes(self, level: list[int]) -> Iterator[tuple[int, Row]]:
        """The nodes of a scene with their numbers. Raises ForeignRefusal unless they are trees."""
        reached = set[int]()
        for _ in range(MOST_LEVELS + 1):
            below: list[int] = []
            for number in level:
                row = self.file.row("nodes", number)
                if number in reached:
                    raise ForeignRefusal(f"nodes {number}: a node must be below one other node at most")
                reached.add(number)
                below.extend(_children(row))
                yield number, row
            level = below
        if level:
            raise ForeignRefusal(
                f"nodes {level[0]}: a node must have at most {MOST_LEVELS} nodes above it, not more",
                "export the scene flat",
            )

    def _skin(self, number: object, nodes: dict[int, Row], mesh: Row) -> Row:
        """A skin with all of its matrices."""
        row, place = self.file.row("skins", number), f"skins {number}"
        joints = _children(row, "joints")
        if not joints or not set(joints) <= nodes.keys():
            raise ForeignRefusal(f"{place}: its joints must be nodes of the scene")
        matrices = np.tile(np.eye(4).reshape(1, 16), (len(joints), 1))
        if "inverseBindMatrices" in row:
            matrices = self.file.array(row["inverseBindMatrices"], 16)[: len(joints)]
        if len(matrices) < len(joints) or mesh["extras"] >= len(joints):
            raise ForeignRefusal(f"{place}: it must have a matrix for each joint, and all joints of its mesh")
        return {"joints": joints, "inverseBindMatrices": self._written(matrices, "<f4", "MAT4")}

    def _mesh(self, number: int, row: Row, users: list[Row]) -> Row:
        """A mesh without its points and lines; `extras` is the highest number of a joint that it uses."""
        place = f"meshes {number}"
        is_skinned = any("skin" in each for each in users)
        weights = numbers(row, "weights", place)
        is_morphed = any(weights or ()) or any(any(_list(each, "weights")) for each in users)
        mesh: Row = {"primitives": [], "extras": 0}
        if is_morphed and weights:
            mesh["weights"] = weights
        self.result.primitives[number] = []
        for primitive in _list(row, "primitives"):
            mode = primitive.get("mode", 4) if isinstance(primitive, dict) else None
            if type(mode) is not int or not 0 <= mode <= 6:
                raise ForeignRefusal(f"{place}: the mode of a primitive must be 0 to 6, not {shown(mode)}")
            if mode < 4:
                self.result.left_out["skipped primitives of points or lines"] += 1
                continue
            written = self._triangles(number, primitive, mode, place)
            targets = _list(primitive, "targets") if is_morphed else []
            attributes = _table(primitive, "attributes")
            nodes = self.result.primitives[number][-1].nodes
            names = [name for name in ("POSITION", "NORMAL") if name in attributes]
            # Normals that some morph targets leave as they are would be wrong.
            names = [name for name in names if name == "POSITION" or all(name in each for each in targets)]
            written["attributes"] = {name: self._vectors(attributes, name, nodes, place) for name in names}
            if targets:
                mesh.setdefault("weights", [0.0] * len(targets))
                written["targets"] = [
                    {name: self._vectors(each, name, nodes, place) for name in names} for each in targets
                ]
            if is_skinned:
                self._bind(mesh, written, attributes, nodes, place)
            mesh["primitives"].append(written)
        return mesh

    def _triangles(self, mesh: int, row: Row, mode: int, place: str) -> Row:
        """The corners of triangles, a strip or a fan, whose primitive is added to the result."""
        file, result = self.file, self.result
        attributes, material = _table(row, "attributes"), row.get("material")
        count = len(file.array(attributes.get("POSITION"), 3))
        corners: AnyArray = np.arange(count, dtype=np.uint32)
        if "indices" in row:
            corners = file.array(row["indices"], 1)[:, 0]
        if corners.dtype.kind != "u" or corners.max(initial=0) >= max(count, 1):
            raise ForeignRefusal(f"{place}: a corner must be a node from 0 to {count - 1:,}")
        if len(corners) < 3 or (mode == 4 and len(corners) % 3):
            raise ForeignRefusal(
                f"{place}: triangles must have three corners each, not {len(corners):,} in all"
            )
        if material is not None and "texture" in json.dumps(file.row("materials", material)).lower():
            result.left_out["left out the textures of parts"] += 1
        if any(name.startswith("COLOR_") for name in attributes):
            result.left_out["left out the colors of nodes of parts"] += 1
        scalars = {}
        for name, number in attributes.items():
            if name.startswith("_") and file.row("accessors", number).get("type") == "SCALAR":
                scalars[name.removeprefix("_")] = file.array(number, 1)[:, 0].astype(np.float64)
                if len(scalars[name.removeprefix("_")]) != count:
                    raise ForeignRefusal(f"{place}: {shown(name)} must have a value for each of the nodes")
        result.primitives[mesh].append(Primitive(count, scalars, material))
        return {"mode": mode, "indices": self._written(corners, "<u4", "SCALAR")}

    def _vectors(self, row: Row, name: str, nodes: int, place: str) -> int:
        """The number of a new accessor of vectors, one for each node."""
        values = self.file.array(row.get(name), 3)
        if len(values) != nodes:
            raise ForeignRefusal(f"{place}: {name} must have a vector for each of the {nodes:,} nodes")
        return self._written(values, "<f4", "VEC3")

    def _bind(self, mesh: Row, written: Row, attributes: Row, nodes: int, place: str) -> None:
        """Add the joints and weights of the nodes of a skin."""
        if "JOINTS_1" in attributes or not {"JOINTS_0", "WEIGHTS_0"} <= attributes.keys():
            raise ForeignRefusal(f"{place}: a node of a skin must have one to four joints with weights")
        joints, weights = (self.file.array(attributes[name], 4) for name in ("JOINTS_0", "WEIGHTS_0"))
        if not len(joints) == len(weights) == nodes:
            raise ForeignRefusal(f"{place}: each node of a skin must have its joints and weights")
        joints = np.where(weights > 0, joints, 0)
        mesh["extras"] = max(mesh["extras"], int(joints.max(initial=0)))
        written["attributes"]["JOINTS_0"] = self._written(joints, "<u2", "VEC4")
        written["attributes"]["WEIGHTS_0"] = self._written(weights, "<f4", "VEC4")

    def _written(self, values: AnyArray, dtype: str, type_: str) -> int:
        """The number of a new accessor with these values."""
        data = np.ascontiguousarray(values, dtype).tobytes()
        self._views.append({"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)})
        self._binary += data + bytes(-len(data) % 4)
        component = next(number for number, each in TYPES.items() if each == dtype)
        row = {"bufferView": len(self._views) - 1, "byteOffset": 0, "componentType": component}
        self._accessors.append({**row, "count": len(values), "type": type_})
        return len(self._accessors) - 1

    def _materials(self) -> None:
        """The names of the materials, and the base colors of those that have one."""
        rows = [each if isinstance(each, dict) else {} for each in self.file.rows("materials")]
        names = [_name(row) or f"material {number}" for number, row in enumerate(rows)]
        self.result.materials = different(names)
        for name, row in zip(self.result.materials, rows, strict=True):
            shiny = _table(_table(row, "extensions"), "KHR_materials_pbrSpecularGlossiness")
            rough = _table(row, "pbrMetallicRoughness")
            color = numbers(rough, "baseColorFactor", name, 4) or numbers(shiny, "diffuseFactor", name, 4)
            if color is None and not any("Texture" in key for key in (*rough, *shiny)):
                color = [1.0, 1.0, 1.0]
            if color is not None:
                red, green, blue = (srgb(each) for each in color[:3])
                self.result.colors[name] = (red, green, blue)


def srgb(linear: float) -> int:
    """A linear component of a color, 0 to 1, as sRGB, 0 to 255.

    >>> srgb(0), srgb(0.5), srgb(1)
    (0, 188, 255)
    """
    linear = min(max(linear, 0.0), 1.0)
    return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))


def _name(row: Row) -> str:
    """The name of a row, printable; empty if it has none."""
    name = row.get("name")
    return printable_name(name) if isinstance(name, str) else ""


def _children(row: Row, key: str = "children") -> list[int]:
    """The numbers of nodes in a list of a row. Raises ForeignRefusal if it is something else."""
    children = row.get(key, [])
    if not isinstance(children, list) or not all(type(each) is int for each in children):
        raise ForeignRefusal(f"{key} must be a list of the numbers of nodes, not {shown(children)}")
    return children


def _placed(row: Row, place: str) -> Row:
    """The transform and the children of a node."""
    written: Row = {key: each for key in ("children",) if (each := _children(row))}
    for key, count in (("matrix", 16), ("translation", 3), ("rotation", 4), ("scale", 3)):
        if (values := numbers(row, key, place, count)) is not None:
            # The library takes a rotation for a unit quaternion.
            length = math.hypot(*values) if key == "rotation" else 1.0
            written[key] = [each / (length or 1.0) for each in values]
    return written
