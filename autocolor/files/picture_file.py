"""Picture files: a picture with the scene that it was made from, as an .npz that numpy can open.

The members are `header` (the scene but its mesh, as JSON in UTF-8 bytes), `relative_intensity` (lines,
elements) float32 in proportion to the header's scale, `surface_number` (lines, elements) uint8, and the
mesh: `coordinates` (nodes, 3) float64, `node_numbers` (polygons, 4) and `part_numbers` (polygons,) int32.

They are stored without compression, so that a file can't promise more than it holds: each array's size is
checked against the bytes that are there before anything is allocated. Nothing is ever unpickled.
"""

from __future__ import annotations

import ast
import io
import json
import math
import zipfile
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import numpy as np
import numpy.typing as npt

from autocolor.errors import InputError
from autocolor.files.reading import read_bytes
from autocolor.files.scene_values import scene_of_values, values_of_scene
from autocolor.files.writing import write_atomically
from autocolor.picture import Picture
from autocolor.scene import Scene
from autocolor.seen import SurfaceSlice

FORMAT = "autocolor picture 1"
LARGEST_PICTURE_FILE = 4 << 30
LARGEST_HEADER = 16 << 20
LARGEST_ARRAY_HEADER = 1024

MEMBERS = {
    "header": ("|u1", 1),
    "relative_intensity": ("<f4", 2),
    "surface_number": ("|u1", 2),
    "coordinates": ("<f8", 2),
    "node_numbers": ("<i4", 2),
    "part_numbers": ("<i4", 1),
}
"""The dtype and the number of dimensions of each member."""


class SavedPicture(NamedTuple):
    """A picture and the scene that it was made from."""

    picture: Picture
    scene: Scene


def write_picture(
    path: str | PathLike[str], picture: Picture, scene: Scene, *, overwrite: bool = False
) -> None:
    """Write a picture file, wholly or not at all; OutputError or WriteError where it can't be."""
    header = {
        "format": FORMAT,
        "scale": picture.scale,
        "surfaces": list(picture.surfaces),
        "scene": values_of_scene(scene),
    }
    relative = np.zeros(picture.lines * picture.elements, np.float32)
    relative[picture.pixels] = picture.relative
    arrays: dict[str, npt.NDArray[Any]] = {
        "header": np.frombuffer(json.dumps(header, ensure_ascii=False, allow_nan=False).encode(), np.uint8),
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
            # A fixed date: the same picture gives the same file.
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", (1983, 7, 25, 0, 0, 0)), member.getvalue())
    write_atomically(path, buffer.getvalue(), overwrite=overwrite)


def read_picture(path: str | PathLike[str]) -> SavedPicture:
    """The picture of a picture file with its scene; InputError for a file that is no whole picture file."""
    source = Path(path)
    arrays = _arrays(source)
    header = _header(source, arrays["header"])
    try:
        mesh = (arrays["coordinates"], arrays["node_numbers"], arrays["part_numbers"])
        scene = scene_of_values(header["scene"], *mesh)
        picture = _picture(header, arrays["relative_intensity"], arrays["surface_number"])
        known = [surface.name for surface in scene.surfaces]
        if list(picture.surfaces) != known:
            raise InputError(f"its surfaces must be the scene's, {known}, not {list(picture.surfaces)}")
    except InputError as error:
        raise InputError(f"{source.name}: {problem}" for problem in error.problems) from None
    return SavedPicture(picture, scene)


def read_picture_scene(path: str | PathLike[str]) -> Scene:
    """The scene of a picture file."""
    return read_picture(path).scene


def _arrays(source: Path) -> dict[str, npt.NDArray[Any]]:
    """The members of the file, each checked before it is made an array."""
    whole = f"{source.name}: a picture file must be whole and as autocolor wrote it, not"
    try:
        with zipfile.ZipFile(io.BytesIO(read_bytes(source, LARGEST_PICTURE_FILE))) as archive:
            found = {member.filename: member for member in archive.infolist()}
            expected = {f"{name}.npy" for name in MEMBERS}
            if set(found) != expected or len(archive.infolist()) != len(expected):
                raise InputError(f"{whole} with the members {sorted(found)[:8]}; save the picture again")
            if any(member.compress_type != zipfile.ZIP_STORED for member in found.values()):
                raise InputError(f"{whole} compressed; save the picture again")
            return {name: _array(source, name, archive.read(f"{name}.npy")) for name in MEMBERS}
    except (zipfile.BadZipFile, EOFError, OSError, NotImplementedError, RuntimeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{whole} {error or 'cut short'}; save the picture again") from None


def _array(source: Path, name: str, data: bytes) -> npt.NDArray[Any]:
    """One member as an array of the type and the dimensions that it must have."""
    dtype, dimensions = MEMBERS[name]
    place = f"{source.name}, {name}"
    problem = InputError(
        f"{place}: it must be an array of {dtype} with {dimensions} dimensions in as many bytes as its shape"
        f" says, not {len(data)} bytes beginning {data[:10]!r}; save the picture again"
    )
    length = int.from_bytes(data[8:10], "little")
    if data[:8] != b"\x93NUMPY\x01\x00" or length > LARGEST_ARRAY_HEADER or len(data) < 10 + length:
        raise problem
    try:
        described = ast.literal_eval(data[10 : 10 + length].decode("ascii").strip())
        shape = described["shape"]
        expected = {"descr": dtype, "fortran_order": False, "shape": shape}
        counts = [count for count in shape if type(count) is int and 0 <= count <= len(data)]
    except (ValueError, SyntaxError, KeyError, TypeError, RecursionError, MemoryError):
        raise problem from None
    size = math.prod(counts) * np.dtype(dtype).itemsize
    if (
        described != expected
        or len(counts) != len(shape)
        or len(shape) != dimensions
        or size != len(data) - 10 - length
    ):
        raise problem
    return np.frombuffer(data, dtype, offset=10 + length).reshape(counts)


def _header(source: Path, data: npt.NDArray[Any]) -> dict[str, Any]:
    """The header as a dictionary with the keys that it must have."""
    place = f"{source.name}, header"

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    try:
        if len(data) > LARGEST_HEADER:
            raise ValueError(f"{len(data)} bytes")
        header = json.loads(data.tobytes().decode("utf-8"), parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{place}: it must be JSON of at most 16 MiB, not {error}; save the picture again"
        ) from None
    keys = {"format", "scale", "surfaces", "scene"}
    if not isinstance(header, dict) or set(header) != keys or header["format"] != FORMAT:
        raise InputError(f"{place}: its format must be {FORMAT!r}, not another; save the picture again")
    return header


def _picture(header: dict[str, Any], relative: npt.NDArray[Any], numbers: npt.NDArray[Any]) -> Picture:
    """The picture, with its visible pixels sorted by surface again."""
    scale, surfaces = header["scale"], header["surfaces"]
    again = "save the picture again"
    if isinstance(scale, bool) or not isinstance(scale, (int, float)) or not 0 < scale < 1e39:
        raise InputError(f"its scale must be a number above 0, not {scale!r}; {again}")
    if not isinstance(surfaces, list) or not all(isinstance(name, str) for name in surfaces):
        raise InputError(f"its surfaces must be a list of names, not {surfaces!r}; {again}")
    if relative.shape != numbers.shape or not relative.size:
        raise InputError(
            f"its arrays must be of one shape, not {relative.shape} and {numbers.shape}; {again}"
        )
    if numbers.max() > len(surfaces):
        raise InputError(f"a surface number must be 0 to {len(surfaces)}, not {numbers.max()}; {again}")
    if not (np.isfinite(relative).all() and relative.min() >= 0):
        raise InputError(f"an intensity must be a finite number of at least 0, not otherwise; {again}")
    flat = numbers.ravel()
    pixels = np.flatnonzero(flat)
    pixels = pixels[np.argsort(flat[pixels], kind="stable")]
    stops = np.cumsum(np.bincount(flat[pixels], minlength=1)).tolist()
    slices = tuple(
        SurfaceSlice(number, stops[number - 1], stops[number])
        for number in range(1, len(stops))
        if stops[number] > stops[number - 1]
    )
    lines, elements = relative.shape
    intensities = relative.ravel()[pixels].astype(np.float32)
    return Picture(lines, elements, tuple(surfaces), pixels, slices, intensities, float(scale))
