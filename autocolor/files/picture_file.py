"""Picture files: a picture and the scene that it was rendered from, as an .npz that numpy can open.

The members are `header` (the scene without its mesh, as JSON in UTF-8), `relative_intensity` (lines,
elements) float32, to be multiplied by the header's scale, `surface_number` (lines, elements) uint8,
`part_number` (lines, elements) int32, where k means row k - 1 of the part table, and the mesh:
`coordinates` (nodes, 3) float64, `node_numbers` (polygons, 4) and `part_numbers` (polygons,) int32,
`mesh_scalar_0` and so on, the values of its scalars, float64, and the normals of the mesh file, if they are
used: `own_normal_0` and `own_normal_number_0`. If the scene shows a scalar, its values at the pixels are
`scalar_0`, (lines, elements) float32; NaN is a missing value. `smooth` in the header is more than 1 if each
pixel of an image is the mean of a square of so many pixels a side.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, AnyArray
from autocolor.budget import allowing
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.files.array_file import ArrayFileKind, array_file_bytes, mesh_of, read_array_file
from autocolor.files.paths import PICTURE_SUFFIX
from autocolor.files.writing import Guard, check_suffix, no_guard, write_atomically
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.scene.columns import from_plain, to_plain
from autocolor.scene.scalar import LimitsKind
from autocolor.scene.scene import Scene

PICTURE_FILE: Final = ArrayFileKind(
    noun="picture file",
    advice="save the picture again",
    format="autocolor picture 4",
    types={
        "relative_intensity": ("<f4", (None, None)),
        "surface_number": ("|u1", (None, None)),
        "part_number": ("<i4", (None, None)),
        "scalar": ("<f4", (None, None)),
    },
)


class SavedPicture(NamedTuple):
    """A scene and the picture that was rendered from it."""

    scene: Scene
    picture: Picture


def write_picture(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture,
    *,
    overwrite: bool = False,
    guard: Guard = no_guard,
) -> None:
    """Write a picture and its scene to a picture file, atomically; `guard` may refuse to overwrite a file.

    Raises UsageError for wrong arguments, InputError if the picture is not the scene's, and OutputError or
    WriteError if the file cannot be written.
    """
    check_surfaces(scene, picture)
    check_suffix(path, PICTURE_SUFFIX, "a picture with its scene")
    check = guard(Path(path))
    if (picture.scalar_values is None) != (scene.scalar is None):
        raise UsageError(
            "a picture and its scene must both have a scalar or neither, not one alone; render the scene"
        )
    header = {
        "scale": picture.scale,
        "scene": plain_scene(scene),
        "shown_scalars": [] if picture.scalar is None else [{"limits": picture.scalar_limits}],
        "smooth": picture.smooth,
    }
    relative = np.zeros(picture.lines * picture.elements, np.float32)
    relative[picture.pixels] = picture.relative
    arrays: dict[str, AnyArray] = {
        "relative_intensity": relative.reshape(picture.lines, picture.elements),
        "surface_number": picture.surface_number,
        "part_number": picture.part_number,
        **({} if picture.scalar is None else {"scalar_0": picture.scalar}),
    }
    data = array_file_bytes(PICTURE_FILE, scene.mesh, header, arrays)
    check()
    write_atomically(path, data, overwrite=overwrite)


def read_picture(path: str | PathLike[str], *, limit: float | None = None) -> SavedPicture:
    """The scene and the picture of a picture file; `limit` is a factor for the memory budget.

    Raises InputError if the file is damaged or incomplete, or if it needs more memory than the budget allows.
    """
    source = Path(path)
    with allowing(limit):
        header, arrays = read_array_file(PICTURE_FILE, source)
    with PICTURE_FILE.naming(source.name):
        plain = header["scene"]
        mesh = mesh_of(header, arrays, plain["mesh"]["part_names"], plain["mesh"]["crease_angle"])
        scene = from_plain(Scene, {**plain, "mesh": mesh})
        return SavedPicture(scene, _picture(header, scene, arrays))


def _picture(header: Mapping[str, Any], scene: Scene, arrays: Mapping[str, AnyArray]) -> Picture:
    """The picture of the rasters and the header. Raises InputError if they or the scene do not match."""
    scale, smooth = header["scale"], header.get("smooth", 1)
    relative, surfaces = arrays["relative_intensity"], arrays["surface_number"]
    parts, scalar = arrays["part_number"], arrays.get("scalar_0")
    shape = relative.shape
    if type(scale) not in (int, float) or not 0 < scale < LARGEST_SINGLE:
        raise InputError(f"its scale must be a number above 0, not {shown(scale)}")
    if not relative.size or any(
        each.shape != shape for each in (surfaces, parts, scalar) if each is not None
    ):
        raise InputError(f"its arrays must be of one shape, not {shape} and others")
    # Both comparisons with NaN are false.
    if not (relative.min() >= 0 and float(relative.max()) * scale <= LARGEST_SINGLE):
        raise InputError(f"every intensity must be a number from 0 to {LARGEST_SINGLE:.3g}")
    if type(smooth) is not int or smooth < 1 or any(size % smooth for size in shape):
        raise InputError(
            f"smooth must be a whole number that divides its lines and elements, {shape}, not {shown(smooth)}"
        )
    # Parts without polygons, and no part, are of no surface.
    seen = scene.staged
    surface_of = np.zeros(1 + len(seen.parts), np.uint8)
    for part in seen.mesh.parts_in_use:
        surface_of[1 + part] = seen.surface_number_of_part[part]
    wrong = (parts < 0) | (parts >= len(surface_of))
    wrong |= surface_of.take(parts, mode="clip") != surfaces
    if wrong.any():
        line, element = np.argwhere(wrong)[0].tolist()
        raise InputError(
            f"a part number must be that of a part of the surface there, {surfaces[line, element]}, not"
            f" {parts[line, element]} (line {line}, element {element})"
        )
    try:
        limits = [LimitsKind().accepted(row["limits"]) for row in header["shown_scalars"]]
    except (ValueError, OverflowError):
        raise InputError(f"shown_scalars: limits {LimitsKind().rule()}") from None
    if not (scalar is not None) == len(limits) == (scene.scalar is not None):
        raise InputError(
            "there must be a scalar at the pixels if the scene shows one, and none if it does not"
        )
    if scalar is not None and np.isinf(scalar).any():
        raise InputError("a scalar must have a finite number or NaN at each pixel, not infinity")
    names, of_part = tuple(surface.name for surface in scene.surfaces), seen.mesh.part_names
    picture = Picture.from_rasters(
        relative, surfaces, names, float(scale), scalar, next(iter(limits), None), parts, of_part, smooth
    )
    return dataclasses.replace(picture, apart=scene.stage_surface)


def plain_scene(scene: Scene) -> dict[str, Any]:
    """The tables of a scene as values that JSON can hold, without the arrays of the mesh.

    Keys whose value is None or infinite are omitted.
    """
    mesh = {"part_names": scene.mesh.part_names, "crease_angle": scene.mesh.crease_angle}
    return {"mesh": mesh, **to_plain(scene)}
