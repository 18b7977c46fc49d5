"""Picture files: a picture and the scene that it was rendered from, as an .npz that numpy can open.

The members are `header` (the scene without its mesh, as JSON in UTF-8), `relative_intensity` (lines,
elements) float32, to be multiplied by the header's scale, `surface_number` (lines, elements) uint8, and the
mesh: `coordinates` (nodes, 3) float64, `node_numbers` (polygons, 4) and `part_numbers` (polygons,) int32.

`array_file` reads and writes them.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, AnyArray
from autocolor.errors import InputError
from autocolor.files.array_file import ArrayFileKind, array_file_bytes, read_array_file
from autocolor.files.plain_scene import plain_scene, scene_of_plain
from autocolor.files.writing import check_suffix, write_atomically
from autocolor.lighting.picture import Picture
from autocolor.scene.scene import Scene

FORMATS_READ: Final = ("autocolor picture 2", "autocolor picture 1")
"""In version 1 the reflectance and the paint of a surface were nested tables."""

MOST_PROBLEMS: Final = 20
LONGEST_PROBLEM: Final = 400

PICTURE_FILE: Final = ArrayFileKind(
    noun="picture file",
    advice="save the picture again",
    largest=4 << 30,
    formats=FORMATS_READ,
    keys=frozenset(("scale", "surfaces", "scene")),
    arrays={
        "relative_intensity": ("<f4", 2),
        "surface_number": ("|u1", 2),
        "coordinates": ("<f8", 2),
        "node_numbers": ("<i4", 2),
        "part_numbers": ("<i4", 1),
    },
)


class SavedPicture(NamedTuple):
    """A picture and the scene that it was rendered from."""

    picture: Picture
    scene: Scene


def write_picture(
    path: str | PathLike[str], picture: Picture, scene: Scene, *, overwrite: bool = False
) -> None:
    """Write a picture file atomically.

    Raises UsageError for a name that does not end in .npz, OutputError or WriteError if it cannot be written.
    """
    check_suffix(path, ".npz", "a picture with its scene")
    header = {
        "scale": picture.scale,
        "surfaces": list(picture.surfaces),
        "scene": plain_scene(scene),
    }
    relative = np.zeros(picture.lines * picture.elements, np.float32)
    relative[picture.pixels] = picture.relative
    arrays: dict[str, AnyArray] = {
        "relative_intensity": relative.reshape(picture.lines, picture.elements),
        "surface_number": picture.surface_number,
        "coordinates": scene.mesh.coordinates,
        "node_numbers": scene.mesh.node_numbers,
        "part_numbers": scene.mesh.part_numbers,
    }
    write_atomically(path, array_file_bytes(PICTURE_FILE, header, arrays), overwrite=overwrite)


def read_picture(path: str | PathLike[str]) -> SavedPicture:
    """The picture and the scene of a picture file. Raises InputError if the file is damaged or incomplete."""
    source = Path(path)
    header, arrays = read_array_file(PICTURE_FILE, source)
    try:
        mesh = (arrays["coordinates"], arrays["node_numbers"], arrays["part_numbers"])
        scene = scene_of_plain(header["scene"], *mesh)
        picture = _picture(header, scene, arrays["relative_intensity"], arrays["surface_number"])
    except InputError as error:
        raise InputError(
            f"{source.name}: {problem[:LONGEST_PROBLEM]}; {PICTURE_FILE.advice}"
            for problem in error.problems[:MOST_PROBLEMS]
        ) from None
    return SavedPicture(picture, scene)


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
