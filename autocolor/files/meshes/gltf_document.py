"""A glTF or GLB file, checked and written out in full, so that a library cannot misunderstand it.

The numbers of accessors are unpacked here: sparse accessors, strides, quantized positions and defaults become
plain arrays. Nodes, skins and morph targets stay for the library. Buffers are read by our rule of paths. What
the program does not use is left out, and counted in `sentences`: textures, colors of nodes, animations, lights
and cameras. An extension that may change the geometry is refused by its name.
"""

from __future__ import annotations

import binascii
import json
import math
import os
import re
import struct
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote, unquote_to_bytes

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices
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
    r"(KHR|EXT|ADOBE|MSFT|AGI)_(materials|texture|lights|xmp|animation|packing|articulations)\w*"
    r"|KHR_mesh_quantization|EXT_(mesh|instance|structural)_(features|metadata)|FB_ngon_encoding|MSFT_lod"
    r"|EXT_(primitive_voxels_)?feature_metadata|KHR_audio|KHR_implicit_shapes|KHR_physics_rigid_bodies"
)
"""Extensions that leave the geometry as it is without them."""

GEOMETRIC: Final = re.compile(r"\w*(draco|meshopt|instancing|gaussian|compression|CESIUM_RTC)\w*")
"""Extensions that are refused wherever they are named, even if no part of the file has them."""

WITH_GEOMETRY: Final = ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "skins")


def _refuse_extensions(described: Row) -> None:
    """Raise ForeignRefusal if an extension is required, or has a part in the geometry, and is not harmless."""

    def names(row: object, key: str) -> set[str]:
        listed = row.get(key) if isinstance(row, dict) else None
        return {str(each) for each in listed} if isinstance(listed, (list, dict)) else set()

    used = names(described, "extensionsUsed")
    needed = names(described, "extensionsRequired") | {each for each in used if GEOMETRIC.fullmatch(each)}
    for key in WITH_GEOMETRY:
        for row in described.get(key) or ():
            needed |= names(row, "extensions")
            primitives = row.get("primitives") if key == "meshes" and isinstance(row, dict) else None
            for primitive in primitives if isinstance(primitives, list) else ():
                needed |= names(primitive, "extensions")
    unknown = sorted(name for name in needed if not HARMLESS.fullmatch(name))
    if unknown:
        raise ForeignRefusal(
            f"it must have no extension that may change the geometry, as {shown(unknown[0])} does",
            "export it without this extension",
        )


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
        """The rows of a list of the file; none if it has no such list."""
        rows = self.described.get(key, [])
        return rows if isinstance(rows, list) else []

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
            sparse = part(row, "sparse", place)
            changed = whole(sparse, "count", place)
            indices, those = part(sparse, "indices", place), part(sparse, "values", place)
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


def part(row: Row, key: str, place: str) -> Row:
    """A table within a row. Raises ForeignRefusal."""
    value = row.get(key)
    if not isinstance(value, dict):
        raise ForeignRefusal(f"{place}: {key} must be a table, not {shown(value)}")
    return value


def numbers(row: Row, key: str, place: str, count: int | None = None) -> list[float] | None:
    """A list of finite numbers in a row, None if it has none. Raises ForeignRefusal."""
    if key not in row:
        return None
    values = row[key]
    try:
        if isinstance(values, list) and len(values) == (len(values) if count is None else count):
            found = [float(each) for each in values]
            if all(map(math.isfinite, found)):
                return found
    except (TypeError, ValueError, OverflowError):
        pass
    wanted = "finite numbers" if count is None else f"{count} finite numbers"
    raise ForeignRefusal(f"{place}: {key} must be {wanted}, not {shown(values)}")


# The scene.


@dataclass(frozen=True, eq=False)
class Primitive:
    """The triangles of a mesh with one material: the number of nodes, their scalars, and the material or None."""

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

    @property
    def sentences(self) -> list[str]:
        """What was left out, with its number."""
        return [f"{what}: {count:,}" for what, count in self.left_out.items()]


def completed(path: Path) -> Completed:
    """The default scene of a glTF file. Raises InputError and ForeignRefusal."""
    return _Writer(Accessors(path)).completed(path.stem)


MODES: Final = {4: "triangles", 5: "strips", 6: "fans"}


class _Writer:
    """Writes the parts of a scene that the library is to put together."""

    def __init__(self, file: Accessors) -> None:
        self.file = file
        self.result = Completed()
        self._binary = bytearray()
        self._views: list[Row] = []
        self._accessors: list[Row] = []

    def completed(self, stem: str) -> Completed:
        file, result = self.file, self.result
        _refuse_extensions(file.described)
        nodes = dict(self._nodes())
        self._materials()
        meshes: list[Row] = [{"primitives": []} for _ in file.rows("meshes")]
        written: list[Row] = [{} for _ in file.rows("nodes")]
        skins = [{"joints": [0]} for _ in file.rows("skins")]
        for number, row in nodes.items():
            written[number] = _placed(row, f"nodes {number}")
            mesh = row.get("mesh")
            if mesh is None:
                continue
            named = file.row("meshes", mesh)
            result.names[number] = _name(row) or _name(named) or stem
            if mesh not in result.primitives:
                meshes[mesh] = self._mesh(mesh, named, list(nodes.values()))
            written[number]["mesh"] = mesh
            weights = numbers(row, "weights", f"nodes {number}")
            if weights and "weights" in meshes[mesh]:
                written[number]["weights"] = weights
            if "skin" in row:
                skins[row["skin"]] = self._skin(row["skin"], nodes, meshes[mesh])
                written[number]["skin"] = row["skin"]
        for key, what in (("animations", "animations"), ("cameras", "cameras")):
            if count := len(file.rows(key)):
                result.left_out[f"left out {what}"] += count
        if count := sum("KHR_lights_punctual" in (row.get("extensions") or {}) for row in nodes.values()):
            result.left_out["left out lights"] += count
        described = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": self._roots()}],
            "nodes": written,
            "meshes": meshes,
            "skins": skins,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        text = json.dumps({key: each for key, each in described.items() if each}).encode()
        text += b" " * (-len(text) % 4)
        result.glb = b"".join(
            (
                struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self._binary)),
                struct.pack("<I4s", len(text), b"JSON"), text,
                struct.pack("<I4s", len(self._binary), b"BIN\0"), self._binary,
            )
        )  # fmt: skip
        return result

    def _roots(self) -> list[int]:
        """The nodes of the default scene; without scenes, the nodes that are no children."""
        file, scenes = self.file, self.file.rows("scenes")
        if scenes:
            if len(scenes) > 1:
                self.result.left_out["left out other scenes"] = len(scenes) - 1
            return _children(file.row("scenes", file.described.get("scene", 0)), "nodes")
        below = {each for row in file.rows("nodes") if isinstance(row, dict) for each in _children(row)}
        return [number for number in range(len(file.rows("nodes"))) if number not in below]

    def _nodes(self) -> Iterator[tuple[int, Row]]:
        """The nodes of the scene with their numbers. Raises ForeignRefusal unless they are trees."""
        level, reached = self._roots(), set[int]()
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
        if len(matrices) < len(joints) or mesh.get("extras", len(joints)) >= len(joints):
            raise ForeignRefusal(f"{place}: it must have a matrix for each joint, and joints for all nodes")
        return {"joints": joints, "inverseBindMatrices": self._written(matrices, "<f4", "MAT4")}

    def _mesh(self, number: int, row: Row, nodes: list[Row]) -> Row:
        """A mesh without its points and lines; `extras` is the highest number of a joint that it uses."""
        place = f"meshes {number}"
        weights = numbers(row, "weights", place)
        of_nodes = [each.get("weights") for each in nodes if each.get("mesh") == number]
        is_morphed = any(weights or ()) or any(any(each or ()) for each in of_nodes)
        is_skinned = any("skin" in each for each in nodes if each.get("mesh") == number)
        primitives, extras = [], -1
        self.result.primitives[number] = []
        for primitive in row["primitives"] if isinstance(row.get("primitives"), list) else ():
            written = self._primitive(number, primitive, place, is_morphed)
            if written is None:
                continue
            if is_skinned:
                written["attributes"], highest = self._bound(primitive, written["attributes"], place)
                extras = max(extras, highest)
            primitives.append(written)
        mesh: Row = {"primitives": primitives}
        if is_morphed:
            mesh["weights"] = weights or [0.0] * len(primitives[0].get("targets", ())) if primitives else []
        return {**mesh, "extras": extras} if is_skinned else mesh

    def _primitive(self, mesh: int, row: Row, place: str, is_morphed: bool) -> Row | None:
        """The triangles, strip or fan of a primitive; None for points and lines, which are counted."""
        file, result = self.file, self.result
        mode = row.get("mode", 4) if isinstance(row, dict) else None
        if type(mode) is not int or not 0 <= mode <= 6:
            raise ForeignRefusal(f"{place}: the mode of a primitive must be 0 to 6, not {shown(mode)}")
        if mode not in MODES:
            result.left_out["skipped primitives of points or lines"] += 1
            return None
        attributes = part(row, "attributes", place)
        places = file.array(attributes.get("POSITION"), 3)
        indices: Indices = np.arange(len(places))
        if "indices" in row:
            listed = file.array(row["indices"], 1)[:, 0]
            if listed.dtype.kind != "u" or (len(listed) and listed.max() >= len(places)):
                raise ForeignRefusal(f"{place}: indices must be whole numbers from 0 to {len(places) - 1}")
            indices = listed
        if len(indices) < 3 or (mode == 4 and len(indices) % 3):
            raise ForeignRefusal(
                f"{place}: triangles must have three corners each, not {len(indices):,} in all"
            )
        written: Row = {
            "mode": mode,
            "attributes": {"POSITION": self._written(places, "<f4", "VEC3")},
            "indices": self._written(indices, "<u4", "SCALAR"),
        }
        targets = row.get("targets") if is_morphed else None
        kept = ["POSITION", "NORMAL"] if "NORMAL" in attributes else ["POSITION"]
        if isinstance(targets, list) and targets:
            if not all(isinstance(each, dict) and "POSITION" in each for each in targets):
                raise ForeignRefusal(f"{place}: a morph target must have positions")
            kept = [name for name in kept if all(name in each for each in targets)]
            written["targets"] = [
                {name: self._values(each[name], 3, places, place) for name in kept} for each in targets
            ]
        if "NORMAL" in kept:
            written["attributes"]["NORMAL"] = self._values(attributes["NORMAL"], 3, places, place)
        material = row.get("material")
        if material is not None and "texture" in json.dumps(file.row("materials", material)).lower():
            result.left_out["left out the textures of parts"] += 1
        if "COLOR_0" in attributes:
            result.left_out["left out the colors of nodes of parts"] += 1
        result.primitives[mesh].append(
            Primitive(len(places), self._scalars(attributes, len(places)), material)
        )
        return written

    def _scalars(self, attributes: Row, count: int) -> dict[str, Floats]:
        """The attributes of one component of an application, by their names without the mark before it."""
        scalars = {}
        for name, number in attributes.items():
            if name.startswith("_") and self.file.row("accessors", number).get("type") == "SCALAR":
                values = self.file.array(number, 1)[:, 0].astype(np.float64)
                if len(values) == count:
                    scalars[name.removeprefix("_")] = values
        return scalars

    def _bound(self, primitive: Row, attributes: Row, place: str) -> tuple[Row, int]:
        """The attributes with the joints and weights of a skin, and the highest joint that has a weight."""
        given = part(primitive, "attributes", place)
        if "JOINTS_1" in given or "JOINTS_0" not in given or "WEIGHTS_0" not in given:
            raise ForeignRefusal(f"{place}: a node of a skin must have one to four joints with weights")
        joints, weights = self.file.array(given["JOINTS_0"], 4), self.file.array(given["WEIGHTS_0"], 4)
        if not len(joints) == len(weights) == self._accessors[attributes["POSITION"]]["count"]:
            raise ForeignRefusal(f"{place}: each node of a skin must have its joints and weights")
        joints = np.where(weights > 0, joints, 0)
        bound = {
            "JOINTS_0": self._written(joints, "<u2", "VEC4"),
            "WEIGHTS_0": self._written(weights, "<f4", "VEC4"),
        }
        return {**attributes, **bound}, int(joints.max(initial=0))

    def _values(self, number: object, width: int, places: AnyArray, place: str) -> int:
        """The number of a new accessor of vectors, which must be as many as the nodes."""
        values = self.file.array(number, width)
        if len(values) != len(places):
            raise ForeignRefusal(f"{place}: accessors {number} must have a vector for each of the nodes")
        return self._written(values, "<f4", f"VEC{width}")

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
            shiny = (row.get("extensions") or {}).get("KHR_materials_pbrSpecularGlossiness") or {}
            rough = row.get("pbrMetallicRoughness") or {}
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
