"""The JSON of a glTF or GLB file, checked and completed, so that VTK cannot misunderstand it.

Buffers are read by our rule of paths, and the values of accessors become one buffer. VTK reads what an
accessor has beyond its view as zeros, and joints beyond their skin from any memory, so that is refused here.
An extension that may change the geometry is refused by its name.
"""

from __future__ import annotations

import binascii
import json
import math
import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote, unquote_to_bytes

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.foreign.mesh import ForeignRefusal
from autocolor.files.paths import path_within
from autocolor.files.reading import bounded_json, read_whole, status_of

MOST_VALUES: Final = 2_000_000
"""Limit: values in the JSON of a glTF file; numbers of meshes are in its buffers."""

Row = dict[str, Any]


def document(path: Path) -> tuple[Row, bytes]:
    """The JSON of a glTF file, and the binary chunk of a GLB file. Raises InputError if either is damaged."""
    data, binary = read_whole(path, 1), b""
    if data.startswith(b"glTF"):
        # Its version, its length, and a chunk of JSON with its size.
        version, length, size, kind = struct.unpack_from("<III4s", data.ljust(20, b"\0"), 4)
        binary = data[28 + size : length]
        if version != 2 or kind != b"JSON" or length > len(data) or size > len(data) - 20:
            raise InputError(
                f"{path.name}: a binary glTF file must have version 2, its own length and a chunk of JSON"
                " first; the file is cut short or damaged"
            )
        data = data[20 : 20 + size]
    try:
        described = bounded_json(data, MOST_VALUES)
        if not isinstance(described, dict):
            raise ValueError(f"a {type(described).__name__}")
        return described, binary
    except ValueError as error:
        reason = " ".join(str(error).split())[:100]
        raise InputError(
            f"{path.name}: a glTF file must describe its scene in JSON ({reason}); write it again"
        ) from None


def buffer_files(path: Path, described: Row) -> Iterator[Path | None]:
    """The files of the buffers, in the folder of a glTF file; None for buffers within the file.

    Raises InputError for an address, a file outside of the folder, or a file that is not there.
    """
    for number, row in enumerate(rows(described, "buffers")):
        uri, reasons = row.get("uri"), list[str]()
        if uri is None or str(uri)[:5].lower() == "data:":
            yield None
        else:
            named = path_within(reasons, path.parent, unquote(str(uri)))
            if named is None or not named.is_file():
                reasons.append("must be in its folder, and is not there; copy it there")
                raise InputError(f"{path.name}: buffers {number}: it {reasons[0]}")
            yield named


def rows(row: Row, key: str) -> list[Row]:
    """The tables in a list of a row; a value of another type counts as an empty list or table."""
    values = row.get(key)
    return [each if isinstance(each, dict) else {} for each in values] if isinstance(values, list) else []


def size_of_gltf(path: Path) -> int:
    """The bytes of a glTF file and of the buffers in its folder. Raises InputError."""
    described, _ = document(path)
    files = [path, *filter(None, buffer_files(path, described))]
    return sum(status_of(each).st_size for each in files)


# Extensions. Most concern materials and textures, which are left out.

HARMLESS: Final = re.compile(
    r"(KHR|EXT|ADOBE|MSFT|AGI)_(materials|texture|lights|xmp|animation|packing|articulations|audio)\w*"
    r"|KHR_mesh_quantization|EXT_(mesh|instance|structural)_(features|metadata)|FB_ngon_encoding|MSFT_lod"
)
"""Extensions without which the geometry is the same."""

WITH_GEOMETRY: Final = ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "skins")


def refuse_extensions(described: Row) -> None:
    """Raise ForeignRefusal for an extension that is required, or that geometry has, and is not harmless."""
    owners = [row for key in WITH_GEOMETRY for row in rows(described, key)]
    owners += [row for mesh in rows(described, "meshes") for row in rows(mesh, "primitives")]
    needed = [str(each) for each in described.get("extensionsRequired") or ()]
    needed += [each for owner in owners for each in owner.get("extensions") or ()]
    for name in needed:
        if not HARMLESS.fullmatch(name):
            raise ForeignRefusal(
                f"it must have no extension that may change the geometry, as {shown(name)} does",
                "export it without this extension",
            )


# The file that VTK reads.

TYPES: Final = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
FLOAT: Final = 5126
WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def completed(path: Path, described: Row, binary: bytes) -> bytes:
    """A GLB file of one buffer, with the scene that `described` becomes. Raises ForeignRefusal.

    Each accessor has a view of its own, so that VTK finds no offsets, strides or sparse values, which it
    leaves out at times.
    """
    buffers, views = dict[int, bytes](), dict[int, tuple[memoryview, int]]()
    for number, named in enumerate(buffer_files(path, described)):
        row = described["buffers"][number]
        uri, least = row.get("uri"), row["byteLength"]
        data = binary if uri is None else _data_of(uri) if named is None else read_whole(named, 1)
        if len(data) < least:
            raise ForeignRefusal(
                f"buffers {number}: it must have the {least:,} bytes that the file says, not {len(data):,}"
            )
        buffers[number] = data[:least]
    for number, view in enumerate(rows(described, "bufferViews")):
        data, offset = buffers.get(view["buffer"], b""), view.get("byteOffset", 0)
        end = offset + view["byteLength"]
        if not 0 <= offset <= end <= len(data):
            raise ForeignRefusal(f"bufferViews {number}: it must be within its buffer")
        views[number] = memoryview(data)[offset:end], view.get("byteStride", 0)
    accessors, joined = rows(described, "accessors"), bytearray()
    arrays = [_values_of(row, views, f"accessors {number}") for number, row in enumerate(accessors)]
    described["bufferViews"] = []
    for number, (row, values) in enumerate(zip(accessors, arrays, strict=True)):
        row |= {"bufferView": number, "byteOffset": 0}
        described["bufferViews"].append({"buffer": 0, "byteOffset": len(joined), "byteLength": values.nbytes})
        joined += values.tobytes() + bytes(-values.nbytes % 4)
    skins, meshes = rows(described, "skins"), rows(described, "meshes")
    for node in rows(described, "nodes"):
        if "skin" in node and "mesh" in node:
            skin = skins[node["skin"]]
            if "inverseBindMatrices" not in skin:
                raise ForeignRefusal(f"skins {node['skin']}: it must have inverse bind matrices")
            count = min(len(skin["joints"]), len(arrays[skin["inverseBindMatrices"]]))
            for primitive in rows(meshes[node["mesh"]], "primitives"):
                joints = primitive["attributes"].get("JOINTS_0")
                if joints is not None and (arrays[joints] >= count).any():
                    raise ForeignRefusal(
                        f"accessors {joints}: joints must be of their skin, which has {count:,}"
                    )
        # VTK warns of rounded unit quaternions.
        if length := math.hypot(*node.get("rotation", ())):
            node["rotation"] = [each / length for each in node["rotation"]]
    described["buffers"] = [{"byteLength": len(joined)}]
    for key in ("extensionsRequired", "extensionsUsed", "images", "textures", "animations", "cameras"):
        described.pop(key, None)
    text = json.dumps(described).encode()
    text += b" " * (-len(text) % 4)
    size = 28 + len(text) + len(joined)
    head = struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(joined), b"BIN\0") + joined


def _values_of(row: Row, views: dict[int, tuple[memoryview, int]], place: str) -> AnyArray:
    """The values of an accessor, (count, columns), which must be within its view. Raises ForeignRefusal.

    Vectors of whole numbers that are not normalized, which VTK refuses, become floats.
    """

    def read(part: Row, length: int, columns: int, type_: np.dtype[Any]) -> AnyArray:
        data, stride = views[part["bufferView"]]
        offset, size = part.get("byteOffset", 0), columns * type_.itemsize
        stride = stride or size
        if length and offset + stride * (length - 1) + size > len(data):
            raise ForeignRefusal(f"{place}: its {length:,} values must be within its view")
        return np.ndarray((length, columns), type_, data, offset, (stride, type_.itemsize)).copy()

    count, width, dtype = row["count"], WIDTHS[row["type"]], np.dtype(TYPES[row["componentType"]])
    values = read(row, count, width, dtype) if "bufferView" in row else np.zeros((count, width), dtype)
    if sparse := row.pop("sparse", None):
        indices = sparse["indices"]
        at = read(indices, sparse["count"], 1, np.dtype(TYPES[indices["componentType"]]))[:, 0]
        values[at] = read(sparse["values"], sparse["count"], width, dtype)
    if width == 3 and dtype.kind != "f" and not row.get("normalized"):
        values, row["componentType"] = values.astype("<f4"), FLOAT
    return values


def _data_of(uri: str) -> bytes:
    """The bytes within a data URI. Raises ValueError."""
    head, _, text = uri.partition(",")
    return binascii.a2b_base64(unquote(text)) if head.endswith(";base64") else unquote_to_bytes(text)
