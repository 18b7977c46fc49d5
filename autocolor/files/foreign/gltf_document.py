"""The JSON of a glTF or GLB file, checked and completed, so that VTK cannot misunderstand it.

Buffers are read by our rule of paths, and the values of accessors become one buffer. VTK reads what an
accessor has beyond its view as zeros, and joints beyond their skin from any memory, so that is refused here.
An extension that may change the geometry is refused by its name.
"""

from __future__ import annotations

import base64
import json
import math
import re
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.foreign.mesh import ForeignRefusal
from autocolor.files.paths import path_within
from autocolor.files.reading import bounded_json, read_whole, status_of

Row = dict[str, Any]


def document(path: Path) -> tuple[Row, bytes]:
    """The JSON of a glTF file, and the binary chunk of a GLB file. Raises InputError if either is damaged."""
    data, binary = read_whole(path, 1), b""
    try:
        if data.startswith(b"glTF"):
            # Its version, its length, and a chunk of JSON with its size.
            version, length, size, kind = struct.unpack_from("<III4s", data, 4)
            binary = data[28 + size : length]
            if version != 2 or kind != b"JSON" or max(length, 20 + size) > len(data):
                raise ValueError("it has no version 2, or is cut short or damaged")
            data = data[20 : 20 + size]
        # Numbers of meshes are in buffers, not in the JSON.
        described = bounded_json(data, 2_000_000)
        if not isinstance(described, dict):
            raise ValueError(f"a {type(described).__name__}")
        return described, binary
    except (ValueError, struct.error) as error:
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


HARMLESS: Final = re.compile(
    r"(KHR|EXT|ADOBE|MSFT|AGI)_(materials|texture|lights|xmp|animation|packing|articulations|audio)\w*"
    r"|KHR_mesh_quantization|EXT_(mesh|instance|structural)_(features|metadata)|FB_ngon_encoding|MSFT_lod"
)
"""Extensions without which the geometry is the same."""


def refuse_extensions(described: Row) -> None:
    """Raise ForeignRefusal for an extension that is required, or that geometry has, and is not harmless."""
    keys = ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "skins")
    geometry = json.dumps([described.get(key) for key in keys])
    required = map(str, described.get("extensionsRequired") or ())
    # Their names begin with that of a vendor.
    for name in (*required, *re.findall(r'"([A-Z]+_\w+)": {', geometry)):
        if not HARMLESS.fullmatch(name):
            raise ForeignRefusal(
                f"it must have no extension that may change the geometry, as {shown(name)} does",
                "export it without this extension",
            )


TYPES: Final = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
FLOAT: Final = 5126
WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def completed(path: Path, described: Row, binary: bytes) -> bytes:
    """A GLB file of one buffer, with the scene that `described` becomes. Raises ForeignRefusal.

    Each accessor has a view of its own, so that VTK finds no offsets, strides or sparse values, which it
    leaves out at times.
    """
    buffers, views = dict[int, bytes](), dict(enumerate(rows(described, "bufferViews")))
    for number, named in enumerate(buffer_files(path, described)):
        uri = str(described["buffers"][number].get("uri") or "")
        # A data URI that does not say that it is in base64 has no bytes.
        own = base64.b64decode(uri.partition(";base64,")[2], validate=True) if uri else binary
        buffers[number] = read_whole(named, 1) if named else own
    described["bufferViews"], joined, arrays = [], bytearray(), list[AnyArray]()
    for number, row in enumerate(rows(described, "accessors")):
        try:
            values = _values_of(row, views, buffers)
        except (ValueError, TypeError) as error:
            raise ForeignRefusal(
                f"accessors {number}: its values must be within its view ({error})"
            ) from None
        row |= {"bufferView": number, "byteOffset": 0}
        described["bufferViews"].append({"buffer": 0, "byteOffset": len(joined), "byteLength": values.nbytes})
        joined += values.tobytes() + bytes(-values.nbytes % 4)
        arrays.append(values)
    skins, meshes = rows(described, "skins"), rows(described, "meshes")
    for node in rows(described, "nodes"):
        if "skin" in node and "mesh" in node:
            skin = skins[node["skin"]]
            matrices = arrays[skin["inverseBindMatrices"]] if "inverseBindMatrices" in skin else ()
            for primitive in rows(meshes[node["mesh"]], "primitives"):
                joints = primitive["attributes"].get("JOINTS_0")
                if joints is not None and arrays[joints].max() >= min(len(skin["joints"]), len(matrices)):
                    raise ForeignRefusal(f"skins {node['skin']}: it must have all joints and their matrices")
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


def _values_of(row: Row, views: Mapping[int, Row], buffers: Mapping[int, bytes]) -> AnyArray:
    """The values of an accessor, (count, columns). Raises ValueError and TypeError if a buffer is too short.

    Vectors of whole numbers that are not normalized, which VTK refuses, become floats.
    """

    def read(part: Row, length: int, columns: int, type_: np.dtype[Any]) -> AnyArray:
        view = views[part["bufferView"]]
        data = np.frombuffer(buffers[view["buffer"]], np.uint8, view["byteLength"], view.get("byteOffset", 0))
        strides = (view.get("byteStride") or columns * type_.itemsize, type_.itemsize)
        return np.ndarray((length, columns), type_, data, part.get("byteOffset", 0), strides).copy()

    count, width, dtype = row["count"], WIDTHS[row["type"]], np.dtype(TYPES[row["componentType"]])
    values = read(row, count, width, dtype) if "bufferView" in row else np.zeros((count, width), dtype)
    if sparse := row.pop("sparse", None):
        indices = sparse["indices"]
        at = read(indices, sparse["count"], 1, np.dtype(TYPES[indices["componentType"]]))[:, 0]
        values[at] = read(sparse["values"], sparse["count"], width, dtype)
    if width == 3 and dtype.kind != "f" and not row.get("normalized"):
        values, row["componentType"] = values.astype("<f4"), FLOAT
    return values
