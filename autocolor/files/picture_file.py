"""Picture files: a picture and the scene that it was rendered from, as an .npz that numpy can open.

The members are `header` (the scene without its mesh, as JSON in UTF-8), `relative_intensity` (lines,
elements) float32, to be multiplied by the header's scale, `surface_number` (lines, elements) uint8,
`part_number` (lines, elements) int32, where k means row k - 1 of the part table, and the mesh:
`coordinates` (nodes, 3) float64, `node_numbers` (polygons, 4) and `part_numbers` (polygons,) int32, and
`mesh_scalar_0` and so on, the values of its scalars, float64. If the scene shows a scalar, its values
at the pixels are `scalar_0`, (lines, elements) float32; NaN is a missing value. If the picture is smooth, the
header has the number `smooth`: each pixel of an image is the mean of a square of so many pixels a side.

Before version 4 there were no part numbers: the picture of such a file does not know its parts. Written
again, its part numbers are all 0. Versions 1 and 2 have no scalars, and in version 1 the reflectance and the
paint of a surface were nested tables. `array_file` reads and writes the members.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, AnyArray
from autocolor.budget import allowing
from autocolor.checks import shown
from autocolor.errors import InputError, UsageError
from autocolor.files.array_file import (
    KEY,
    MESH_SCALARS,
    NORMALS,
    ArrayFileKind,
    Series,
    array_file_bytes,
    normal_members,
    normal_rows,
    normals_of,
    read_array_file,
    scalar_members,
    scalar_rows,
    scalars_of,
)
from autocolor.files.paths import PICTURE_SUFFIX
from autocolor.files.writing import Guard, check_suffix, no_guard, write_atomically
from autocolor.lighting.picture import Picture, check_surfaces
from autocolor.scene.columns import Problem, RowError, from_plain, to_plain
from autocolor.scene.geometry.normals import NodeNormals
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import LimitsKind, MeshScalar
from autocolor.scene.scene import Scene

SHOWN: Final = "shown_scalars"
"""The key of a list in the header. Its row, if any, is a table with the `limits` of the shown scalar."""

MOST_PROBLEMS: Final = 20
LONGEST_PROBLEM: Final = 400

PICTURE_FILE: Final = ArrayFileKind(
    noun="picture file",
    advice="save the picture again",
    formats=tuple(f"autocolor picture {version}" for version in (4, 3, 2, 1)),
    keys=frozenset(("scale", "surfaces", "scene")),
    arrays={
        "relative_intensity": ("<f4", 2),
        "surface_number": ("|u1", 2),
        "part_number": ("<i4", 2),
        "coordinates": ("<f8", 2),
        "node_numbers": ("<i4", 2),
        "part_numbers": ("<i4", 1),
    },
    series={KEY: MESH_SCALARS, **NORMALS, SHOWN: Series("scalar", ("<f4", 2), most=1)},
    optional=frozenset(("smooth", "part_number")),
)


class SavedPicture(NamedTuple):
    """A picture and the scene that it was rendered from."""

    picture: Picture
    scene: Scene


def write_picture(
    path: str | PathLike[str],
    scene: Scene,
    picture: Picture,
    *,
    overwrite: bool = False,
    guard: Guard = no_guard,
) -> None:
    """Write a picture and its scene to a picture file, atomically; `guard` may refuse to overwrite a file.

    Raises UsageError if the scene and the picture are in the wrong order, for a name that does not end in
    .npz, or if only one of the two has a scalar; InputError if the surfaces of the picture are not those of
    the scene; OutputError or WriteError if the file cannot be written.
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
        "surfaces": list(picture.surfaces),
        "scene": plain_scene(scene),
        KEY: scalar_rows(scene.mesh.scalars),
        SHOWN: [] if picture.scalar is None else [{"limits": picture.scalar_limits}],
        **({"smooth": picture.smooth} if picture.smooth > 1 else {}),
        **normal_rows(scene.mesh.own_normals),
    }
    relative = np.zeros(picture.lines * picture.elements, np.float32)
    relative[picture.pixels] = picture.relative
    arrays: dict[str, AnyArray] = {
        "relative_intensity": relative.reshape(picture.lines, picture.elements),
        "surface_number": picture.surface_number,
        "part_number": picture.part_number,
        "coordinates": scene.mesh.coordinates,
        "node_numbers": scene.mesh.node_numbers,
        "part_numbers": scene.mesh.part_numbers,
        **scalar_members(scene.mesh.scalars),
        **normal_members(scene.mesh.own_normals),
        **({} if picture.scalar is None else {"scalar_0": picture.scalar}),
    }
    data = array_file_bytes(PICTURE_FILE, header, arrays)
    check()
    write_atomically(path, data, overwrite=overwrite)


def read_picture(path: str | PathLike[str], *, limit: float | None = None) -> SavedPicture:
    """The picture and the scene of a picture file; `limit` is a factor for the memory budget.

    Raises InputError if the file is damaged or incomplete, or if it needs more memory than the budget allows.
    """
    source = Path(path)
    with allowing(limit):
        header, arrays = read_array_file(PICTURE_FILE, source)
    try:
        mesh = (arrays["coordinates"], arrays["node_numbers"], arrays["part_numbers"])
        scene = scene_of_plain(header["scene"], *mesh, scalars_of(header, arrays), normals_of(arrays))
        picture = _picture(header, scene, arrays)
    except InputError as error:
        raise InputError(
            f"{source.name}: {problem[:LONGEST_PROBLEM]}; {PICTURE_FILE.advice}"
            for problem in error.problems[:MOST_PROBLEMS]
        ) from None
    return SavedPicture(picture, scene)


def _require(condition: object, sentence: str) -> None:
    if not condition:
        raise InputError(sentence)


def _picture(header: Mapping[str, Any], scene: Scene, arrays: Mapping[str, AnyArray]) -> Picture:
    """The picture of the rasters and the header. Raises InputError if they or the scene do not match."""
    scale, smooth = header["scale"], header.get("smooth", 1)
    relative, numbers = arrays["relative_intensity"], arrays["surface_number"]
    parts = arrays.get("part_number")
    is_number = isinstance(scale, (int, float)) and not isinstance(scale, bool)
    _require(
        is_number and 0 < scale < LARGEST_SINGLE, f"its scale must be a number above 0, not {shown(scale)}"
    )
    names = [surface.name for surface in scene.surfaces]
    _require(
        header["surfaces"] == names, f"its surfaces must be the scene's, {names}, not {header['surfaces']!r}"
    )
    shapes = {array.shape for array in (relative, numbers, parts) if array is not None}
    _require(len(shapes) == 1 and relative.size, f"its arrays must be of one shape, not {sorted(shapes)}")
    # Both comparisons with NaN are false.
    _require(
        relative.min() >= 0 and float(relative.max()) * scale <= LARGEST_SINGLE,
        f"every intensity must be a number from 0 to {LARGEST_SINGLE:.3g}",
    )
    _require(
        type(smooth) is int and smooth >= 1 and not any(size % smooth for size in numbers.shape),
        f"smooth must be a whole number that divides its lines and elements, {numbers.shape}, not"
        f" {shown(smooth)}",
    )
    if parts is not None and numbers.any() and not parts.any():
        parts = None
    _check_numbers(scene, numbers, parts)
    scalar, limits = _shown_scalar(header.get(SHOWN, ()), scene, arrays)
    return Picture.from_rasters(
        relative, numbers, tuple(names), float(scale), scalar, limits, parts, scene.mesh.part_names, smooth
    )


def _check_numbers(scene: Scene, surfaces: AnyArray, parts: AnyArray | None) -> None:
    """Raise InputError for a pixel with a part or a surface without polygons, or of two different surfaces.

    Without part numbers (`parts` is None), only the surface numbers are checked.
    """
    surface_of = np.zeros(1 + len(scene.parts), np.uint8)
    for part in scene.mesh.parts_in_use:
        surface_of[1 + part] = scene.surface_number_of_part[part]
    wrong = ~np.isin(surfaces, [0, *surface_of])
    what = "surface number must be that of a surface with polygons"
    if parts is not None and not wrong.any():
        what = "part number must be that of a part of the surface there"
        wrong = (parts < 0) | (parts >= len(surface_of))
        wrong |= (surface_of.take(parts, mode="clip") != surfaces) | ((parts > 0) & (surfaces == 0))
        surfaces = parts
    if wrong.any():
        line, element = np.argwhere(wrong)[0].tolist()
        raise InputError(f"a {what}, not {surfaces[line, element]} (line {line}, element {element})")


def _shown_scalar(
    rows: Sequence[object], scene: Scene, arrays: Mapping[str, AnyArray]
) -> tuple[AnyArray, tuple[float, float]] | tuple[None, None]:
    """The raster of the scalar that a picture shows, and the scalar's own range. Raises InputError."""
    rule = "there must be a scalar at the pixels if the scene shows one, and none if it does not"
    _require(len(rows) == (scene.scalar is not None), f"{rule}, not {len(rows)}")
    if not rows:
        return None, None
    row, values, shape = rows[0], arrays["scalar_0"], arrays["surface_number"].shape
    problems: list[Problem] = []
    given = row["limits"] if isinstance(row, Mapping) and row.keys() == {"limits"} else row
    limits: Any = LimitsKind().validated(given, (SHOWN, 0, "limits"), problems)
    if problems:
        raise RowError(problems)
    _require(
        values.shape == shape and not np.isinf(values).any(),
        f"a scalar must have a finite number or NaN at each of {shape} pixels, not {values.shape} with"
        " others",
    )
    return values, limits


# A scene, without the arrays of its mesh, as values that JSON can hold, and back.


def plain_scene(scene: Scene) -> dict[str, Any]:
    """The tables of a scene as values that JSON can hold, without the arrays of the mesh.

    Keys whose value is None or infinite are omitted.
    """
    mesh = {"part_names": scene.mesh.part_names, "crease_angle": scene.mesh.crease_angle}
    return {"mesh": mesh, **to_plain(scene)}


def scene_of_plain(
    values: object,
    coordinates: AnyArray,
    node_numbers: AnyArray,
    part_numbers: AnyArray,
    scalars: tuple[MeshScalar, ...] = (),
    own_normals: NodeNormals | None = None,
) -> Scene:
    """The scene of values as from `plain_scene`, of the mesh's arrays, scalars and normals.

    Raises InputError.
    """
    if not isinstance(values, Mapping) or not isinstance(values.get("mesh"), Mapping):
        raise InputError(f"scene: it must be tables, its mesh among them, not {shown(values)}")
    described = values["mesh"]
    mesh = Mesh(
        coordinates,
        node_numbers,
        part_numbers,
        described.get("part_names", ()),
        described.get("crease_angle", math.nan),
        scalars,
        own_normals,
    )
    return from_plain(Scene, {**values, "mesh": mesh})
