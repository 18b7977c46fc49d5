"""The files that a glTF file names, and the size of what a 3MF file holds, known before either is read.

A glTF file names buffers and images: in itself, in its folder, or by an address. No address is ever fetched:
it is refused, as is a path out of the folder. A 3MF file is an archive, whose members say how large they are.
"""

from __future__ import annotations

import io
import json
import os
import struct
import zipfile
from pathlib import Path
from typing import Any, Final, NoReturn
from urllib.parse import unquote

from autocolor.errors import InputError
from autocolor.files.paths import path_within
from autocolor.files.reading import LARGEST_MESH_FILE, read_bytes

MOST_VALUES: Final = 2_000_000
"""Assumed: values in the JSON of a glTF file; numbers of meshes are in its buffers."""

MOST_MEMBERS: Final = 10_000
LARGEST_GROWTH: Final = 200
"""Assumed: how many times larger than the file what it holds may be. XML packs to a tenth."""

MAGIC: Final = b"glTF"
MOST_PROBLEMS: Final = 20


def size_of_gltf(path: Path) -> int:
    """The bytes of a glTF file and of the files that it names. Raises InputError."""
    data = read_bytes(path, LARGEST_MESH_FILE)
    described = _json(path.name, _json_text(path.name, data))
    problems: list[str] = []
    size = len(data)
    for what in ("buffers", "images"):
        listed = described.get(what, [])
        if not isinstance(listed, list):
            raise InputError(f"{path.name}: {what} must be a list; correct the file")
        for row, each in enumerate(listed):
            uri = each.get("uri") if isinstance(each, dict) else None
            if uri is None or (isinstance(uri, str) and uri[:5].lower() == "data:"):
                continue
            reasons: list[str] = []
            named = path_within(reasons, path.parent, unquote(uri) if isinstance(uri, str) else "")
            problems.extend(f"{path.name}: {what} {row}: it {reason}" for reason in reasons)
            if named is not None and what == "buffers":
                size += _size(path.name, row, named)
            if len(problems) >= MOST_PROBLEMS:
                raise InputError(problems)
    if problems:
        raise InputError(problems)
    if size > LARGEST_MESH_FILE:
        raise InputError(
            f"{path.name}: it and its buffers must have at most {LARGEST_MESH_FILE:,} bytes, not {size:,};"
            " split or simplify it"
        )
    return size


def _size(place: str, row: int, named: Path) -> int:
    """The size of the file of a buffer. Raises InputError if there is none."""
    if not named.is_file():
        raise InputError(
            f"{place}: buffers {row}: there is no file {named.name!r} in its folder; copy it there"
        )
    return os.stat(named).st_size


def _json_text(place: str, data: bytes) -> bytes:
    """The JSON of a glTF file, which is all of it or the first chunk of a binary one. Raises InputError."""
    if not data.startswith(MAGIC):
        return data
    if len(data) >= 20:
        version, length, size, kind = struct.unpack_from("<II I4s", data, 4)
        if version == 2 and length <= len(data) and size <= len(data) - 20 and kind == b"JSON":
            return data[20 : 20 + size]
    raise InputError(
        f"{place}: a binary glTF file must have version 2, its own length and a chunk of JSON first; the file"
        " is cut short or damaged"
    )


def _json(place: str, text: bytes) -> dict[str, Any]:
    """The described scene. Raises InputError if it is no JSON, or too much of it."""

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    try:
        if sum(map(text.count, (b",", b"[", b"{"))) > MOST_VALUES:
            raise ValueError(f"more than {MOST_VALUES:,} values")
        described = json.loads(text.decode("utf-8"), parse_constant=refuse)
        if not isinstance(described, dict):
            raise ValueError(f"a {type(described).__name__}")
    except json.JSONDecodeError as error:
        raise InputError(
            f"{place}: a glTF file must describe its scene in JSON, not as at line {error.lineno}, column"
            f" {error.colno}; write it again"
        ) from None
    except (ValueError, RecursionError) as error:
        found = " ".join(str(error).split())[:100]
        raise InputError(
            f"{place}: a glTF file must describe its scene in JSON, not {found}; write it again"
        ) from None
    return described


def size_of_3mf(path: Path) -> int:
    """The bytes of what a 3MF file holds. Raises InputError."""
    data = read_bytes(path, LARGEST_MESH_FILE)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
    except (
        zipfile.BadZipFile,
        ValueError,
        OSError,
        EOFError,
        RuntimeError,
        LookupError,
        struct.error,
    ) as error:
        raise InputError(
            f"{path.name}: a 3MF file must be a whole ZIP archive, not damaged ({error}); write it again"
        ) from None
    size = sum(member.file_size for member in members)
    most = min(LARGEST_MESH_FILE, LARGEST_GROWTH * len(data))
    if len(members) > MOST_MEMBERS or size > most:
        raise InputError(
            f"{path.name}: a 3MF file of its size must hold at most {MOST_MEMBERS:,} files and {most:,}"
            f" bytes, not"
            f" {len(members):,} and {size:,}; simplify it"
        )
    return max(size, len(data))


def size_of_file(path: Path) -> int:
    """The bytes of a file that names no others. Raises InputError for one that is too large or no file."""
    return len(read_bytes(path, LARGEST_MESH_FILE))
