"""Picture files: a picture and the scene that it was rendered from, as an .npz that numpy can open.

The members are `header` (the scene without its mesh, as JSON in UTF-8), `relative_intensity` (lines,
elements) float32, to be multiplied by the header's scale, `surface_number` (lines, elements) uint8, and the
mesh: `coordinates` (nodes, 3) float64, `node_numbers` (polygons, 4) and `part_numbers` (polygons,) int32.

They are stored without compression: the size of each array is checked against the size of its member before
anything is allocated, so a small file cannot take much memory. Nothing is ever unpickled.
"""

from __future__ import annotations

import io
import json
import math
import re
import struct
import zipfile
from os import PathLike
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, AnyArray
from autocolor.errors import InputError
from autocolor.files.plain_scene import plain_scene, scene_of_plain
from autocolor.files.reading import read_bytes, shown
from autocolor.files.writing import write_atomically
from autocolor.lighting.picture import Picture
from autocolor.scene.scene import Scene

FORMAT: Final = "autocolor picture 2"
FORMATS_READ: Final = (FORMAT, "autocolor picture 1")
"""In version 1 the reflectance and the paint of a surface were nested tables."""

LARGEST_PICTURE_FILE: Final = 4 << 30
LARGEST_HEADER: Final = 16 << 20
MOST_VALUES: Final = 1_000_000
LARGEST_ARRAY_HEADER: Final = 1024
MOST_PROBLEMS: Final = 20
LONGEST_PROBLEM: Final = 400

ARRAY_HEADER: Final = re.compile(
    rb"\{'descr': '([^']*)', 'fortran_order': False, 'shape': \(((?:\d{1,12}, ?)*(?:\d{1,12})?)\), \} *\n"
)
"""The array header exactly as numpy writes it; it is matched, never evaluated."""

MEMBERS: Final = {
    "header": ("|u1", 1),
    "relative_intensity": ("<f4", 2),
    "surface_number": ("|u1", 2),
    "coordinates": ("<f8", 2),
    "node_numbers": ("<i4", 2),
    "part_numbers": ("<i4", 1),
}
"""The dtype and number of dimensions of each member."""


class SavedPicture(NamedTuple):
    """A picture and the scene that it was rendered from."""

    picture: Picture
    scene: Scene


def write_picture(
    path: str | PathLike[str], picture: Picture, scene: Scene, *, overwrite: bool = False
) -> None:
    """Write a picture file atomically. Raises OutputError or WriteError if that is not possible."""
    header = {
        "format": FORMAT,
        "scale": picture.scale,
        "surfaces": list(picture.surfaces),
        "scene": plain_scene(scene),
    }
    relative = np.zeros(picture.lines * picture.elements, np.float32)
    relative[picture.pixels] = picture.relative
    arrays: dict[str, AnyArray] = {
        "header": np.frombuffer(json.dumps(header, allow_nan=False).encode(), np.uint8),
        "relative_intensity": relative.reshape(picture.lines, picture.elements),
        "surface_number": picture.surface_number,
        "coordinates": scene.mesh.coordinates,
        "node_numbers": scene.mesh.node_numbers,
        "part_numbers": scene.mesh.part_numbers,
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            member = io.BytesIO()
            np.lib.format.write_array(
                member,
                np.ascontiguousarray(array, dtype=MEMBERS[name][0]),
                version=(1, 0),
                allow_pickle=False,
            )
            # A fixed date makes the file depend on its content only.
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", (1983, 7, 25, 0, 0, 0)), member.getvalue())
    write_atomically(path, buffer.getvalue(), overwrite=overwrite)


def read_picture(path: str | PathLike[str]) -> SavedPicture:
    """The picture and the scene of a picture file. Raises InputError if the file is damaged or incomplete."""
    source = Path(path)
    arrays = _arrays(source)
    header = _header(source, arrays["header"])
    try:
        mesh = (arrays["coordinates"], arrays["node_numbers"], arrays["part_numbers"])
        scene = scene_of_plain(header["scene"], *mesh)
        picture = _picture(header, scene, arrays["relative_intensity"], arrays["surface_number"])
    except InputError as error:
        raise InputError(
            f"{source.name}: {problem[:LONGEST_PROBLEM]}; save the picture again"
            for problem in error.problems[:MOST_PROBLEMS]
        ) from None
    return SavedPicture(picture, scene)


def _damaged(source: Path, found: str) -> InputError:
    return InputError(
        f"{source.name}: a picture file must be whole and as autocolor wrote it, not {found};"
        " save the picture again"
    )


def _arrays(source: Path) -> dict[str, AnyArray]:
    """The members of the file as arrays, each checked before its array is made."""
    try:
        with zipfile.ZipFile(io.BytesIO(read_bytes(source, LARGEST_PICTURE_FILE))) as archive:
            found = [member.filename for member in archive.infolist()]
            if sorted(found) != sorted(f"{name}.npy" for name in MEMBERS):
                raise _damaged(source, f"with members like {', '.join(map(shown, found[:3])) or 'none'}")
            if any(member.compress_type != zipfile.ZIP_STORED for member in archive.infolist()):
                raise _damaged(source, "compressed")
            return {name: _array(source, name, archive.read(f"{name}.npy")) for name in MEMBERS}
    except InputError:
        raise
    except (zipfile.BadZipFile, EOFError, RuntimeError, ValueError, OSError) as error:
        raise _damaged(source, f"damaged or of another kind ({error or 'cut short'})") from None
    except (struct.error, LookupError, ArithmeticError) as error:
        # zipfile raises these for wrong offsets in its directory.
        raise _damaged(source, f"damaged ({error})") from None


def _array(source: Path, name: str, data: bytes) -> AnyArray:
    """One member as an array. Raises InputError if its dtype, dimensions or size is not the required one."""
    dtype, dimensions = MEMBERS[name]
    start = 10 + int.from_bytes(data[8:10], "little")
    described = ARRAY_HEADER.fullmatch(data[10:start]) if start <= LARGEST_ARRAY_HEADER else None
    if described is not None and data[:8] == b"\x93NUMPY\x01\x00" and described[1].decode() == dtype:
        shape = [int(count) for count in re.findall(rb"\d+", described[2])]
        size = math.prod(shape) * np.dtype(dtype).itemsize
        if len(shape) == dimensions and size == len(data) - start and max(shape) <= len(data):
            return np.frombuffer(data, dtype, offset=start).reshape(shape)
    raise InputError(
        f"{source.name}, {name}: it must be an array of {dtype} with {dimensions} dimensions in as many bytes"
        f" as its shape says, not {len(data)} bytes that begin {data[:10]!r}; save the picture again"
    )


def _header(source: Path, data: AnyArray) -> dict[str, Any]:
    """The parsed header. Raises InputError if it is not JSON or lacks a key."""
    place = f"{source.name}, header"

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    try:
        text = data.tobytes()
        if len(text) > LARGEST_HEADER or sum(map(text.count, (b",", b"[", b"{"))) > MOST_VALUES:
            raise ValueError(f"{len(text):,} bytes of it")
        header = json.loads(text.decode("utf-8"), parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{place}: it must be JSON of at most {LARGEST_HEADER >> 20} MiB and {MOST_VALUES:,} values, not"
            f" {error}; save the picture again"
        ) from None
    keys = {"format", "scale", "surfaces", "scene"}
    if not isinstance(header, dict) or set(header) != keys or header["format"] not in FORMATS_READ:
        raise InputError(f"{place}: its format must be {FORMAT!r}, not another; save the picture again")
    return header


def _picture(header: dict[str, Any], scene: Scene, relative: AnyArray, numbers: AnyArray) -> Picture:
    """The picture of the rasters and the header. Raises InputError if they or the scene do not match."""
    scale = header["scale"]
    names = [surface.name for surface in scene.surfaces]
    if isinstance(scale, bool) or not isinstance(scale, (int, float)) or not 0 < scale < LARGEST_SINGLE:
        raise InputError(f"its scale must be a number above 0, not {scale!r}")
    if header["surfaces"] != names:
        raise InputError(f"its surfaces must be the scene's, {names}, not {header['surfaces']!r}")
    if relative.shape != numbers.shape or not relative.size:
        raise InputError(f"its arrays must be of one shape, not {relative.shape} and {numbers.shape}")
    if not (np.isfinite(relative).all() and relative.min() >= 0):
        raise InputError("every intensity must be a finite number of at least 0")
    if float(relative.max()) * scale > LARGEST_SINGLE:
        raise InputError(
            f"intensities must stay below {LARGEST_SINGLE:.3g}, not reach {scale:g} times their own"
        )
    in_use = set(scene.mesh.parts_in_use)
    owned = {number for part, number in enumerate(scene.surface_number_of_part) if part in in_use}
    picture = Picture.from_rasters(relative, numbers, tuple(names), float(scale))
    invalid = {each.surface_number for each in picture.slices} - owned
    if invalid:
        raise InputError(f"a surface number must be that of a surface with polygons, not {min(invalid)}")
    return picture
