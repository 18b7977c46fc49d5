"""Material libraries of OBJ files (MTL): the surfaces that their materials describe, read and written.

These statements are used: `newmtl` begins a material; `Kd` is the object color; the largest component of
`Ks` is S, the specular reflectance, which is 0 without such a statement or where `illum` is 0 or 1; `Ns`
is N, the exponent, at least 1. A material without specular reflectance keeps its object color at every
level. D stays the default, because `Kd` is a color and no intensity. Textures and transparency are left
out, and the report says so. Everything else is ignored.

A library must be in the folder of the OBJ file, or below it. A library with another path, such as an
absolute path, is looked for in the folder by its file name. The mesh is read despite problems in a library,
and the report mentions them.
"""

from __future__ import annotations

import io
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path, PureWindowsPath
from typing import Any, Final

from autocolor.arrays import half_up
from autocolor.errors import InputError
from autocolor.files.meshes.number_text import decimal
from autocolor.files.meshes.repair import name_of
from autocolor.files.paths import path_within
from autocolor.files.reading import read_bytes, shown, text_lines
from autocolor.scene.columns import replaced
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.surfaces import Surface

LARGEST_LIBRARIES: Final = 4 * 1024 * 1024
"""Limit: bytes of all libraries of a file, enough for ten thousand materials."""

MOST_LIBRARIES: Final = 100
MOST_NAMED: Final = 5
"""Limit: libraries that are looked for, and missing ones that are named."""

LARGEST: Final = 1e6
"""Limit: above every coefficient and exponent of a material."""

TEXTURES: Final = re.compile(rb"map_\w+|bump|disp|decal|refl|norm", re.IGNORECASE)
TRANSPARENCY: Final = {b"d": 1.0, b"Tr": 0.0}
"""The statements of transparency, and their values for an opaque material."""

USED: Final = (b"Kd", b"Ks", b"Ns", b"illum")

WITHOUT_HIGHLIGHT: Final = (0.0, 1.0)
"""The illumination models, `illum`, in which nothing reflects specularly."""

LEAST_EXPONENT: Final = 1.0
"""Assumed: some programs write 0 for the roughest material, which would be a highlight all over."""


def read_materials(
    obj: Path, libraries: Sequence[bytes], wanted: Sequence[str]
) -> tuple[tuple[Surface, ...], tuple[str, ...]]:
    """The surfaces of the materials in `wanted`, and messages about what was left out or wrong.

    `libraries` are the arguments of its `mtllib` statements. If there is no such file, a file beside it with
    the same name and the suffix .mtl is read. If a material is defined twice, the first definition counts.
    """
    if not wanted:
        return (), ()
    missing: list[bytes] = []
    paths = _paths(obj, libraries, missing)
    sentences: list[str] = []
    surface_of: dict[str, Surface] = {}
    left = LARGEST_LIBRARIES
    for path in paths:
        if len(surface_of) == len(wanted):
            break
        try:
            data = read_bytes(path, left)
            left -= len(data)
            data = text_lines(data, path.name, "a material library")
        except InputError as error:
            sentences.append(f"the materials have default colors: {error}")
            continue
        surfaces, notes = materials_of(data, path.name, set(wanted))
        surface_of = {**surfaces, **surface_of}
        sentences.extend(notes)
    sentences.extend(
        f"the materials have default colors: there is no library {shown(name)} in the folder of {obj.name};"
        " copy it there"
        for name in missing[:MOST_NAMED]
    )
    undefined = [name for name in wanted if name not in surface_of]
    if surface_of and undefined:
        more = f" and {len(undefined) - 3:,} more" if len(undefined) > 3 else ""
        names = ", ".join(shown(name) for name in undefined[:3])
        sentences.append(f"no library defines material {names}{more}; default colors are used")
    return tuple(surface_of[name] for name in wanted if name in surface_of), tuple(sentences)


def _paths(obj: Path, libraries: Sequence[bytes], missing: list[bytes]) -> list[Path]:
    """The paths of the libraries, at most MOST_LIBRARIES; arguments without a file are added to `missing`."""
    folder = obj.parent
    paths: dict[str, Path] = {}
    for library in dict.fromkeys(libraries[:MOST_LIBRARIES]):
        # The argument is one name with spaces, or several names.
        path = _path(folder, library)
        several = [path] if path else [_path(folder, name) for name in library.split()[:MOST_LIBRARIES]]
        if not any(several):
            missing.append(library)
        paths.update({os.path.realpath(path): path for path in several if path is not None})
    if not paths:
        beside = _path(folder, os.fsencode(f"{obj.stem}.mtl"))
        paths = {} if beside is None else {"": beside}
        # The library may have been renamed together with the OBJ file.
        if beside is not None:
            missing.clear()
    return list(paths.values())[:MOST_LIBRARIES]


def _path(folder: Path, name: bytes) -> Path | None:
    """The path of a library within the folder; None if there is no such file."""
    text = name_of(name.strip().strip(b'"'))
    for candidate in dict.fromkeys((text, text.replace("\\", "/"), PureWindowsPath(text).name)):
        path = path_within([], folder, candidate)
        try:
            if path is not None and path.is_file():
                return path
        except (OSError, ValueError):
            pass
    return None


def materials_of(data: bytes, place: str, wanted: set[str]) -> tuple[Mapping[str, Surface], list[str]]:
    """The surfaces of the materials in `wanted` that a library defines, and what was left out or wrong."""
    problems: list[str] = []
    textured: set[str] = set()
    transparent: set[str] = set()
    tables: dict[str, dict[bytes, list[float]]] = {}
    name, table = "", dict[bytes, list[float]]()
    for number, line in enumerate(io.BytesIO(data), start=1):
        words = line.split(b"#", 1)[0].split()
        if not words:
            continue
        keyword = words[0]
        if keyword == b"newmtl":
            name = name_of(line.split(None, 1)[1]) if len(words) > 1 else ""
            table = tables.setdefault(name, {}) if name in wanted and name not in tables else {}
        elif keyword in USED or keyword in TRANSPARENCY:
            values = _numbers(words[1:])
            if values is None:
                problems.append(
                    f"{place}, line {number}: {keyword.decode()} must have one number or three, from 0 to"
                    f" {LARGEST:g}, not {shown(b' '.join(words[1:]))}; the default is used"
                )
            elif keyword in USED:
                table[keyword] = values
            elif values[0] != TRANSPARENCY[keyword]:
                transparent.add(name)
        elif TEXTURES.fullmatch(keyword):
            textured.add(name)
    left_out = (("the textures", textured & wanted), ("the transparency", transparent & wanted))
    sentences = [
        f"{place}: left out {what} of {len(names):,} material{'s' if len(names) > 1 else ''}"
        for what, names in left_out
        if names
    ]
    sentences.extend(problems[:1])
    if len(problems) > 1:
        sentences.append(f"{place}: {len(problems) - 1:,} more such lines")
    return {name: _surface(name, values) for name, values in tables.items()}, sentences


def _numbers(words: list[bytes]) -> list[float] | None:
    """The numbers of a statement, one or three; None if one is below 0 or not below LARGEST."""
    numbers = [decimal(word) for word in words[:3]]
    # A comparison with NaN is false.
    return numbers if len(numbers) in (1, 3) and all(0 <= number < LARGEST for number in numbers) else None


def _surface(name: str, values: Mapping[bytes, list[float]]) -> Surface:
    """The surface of a material; properties that it does not define have their defaults."""
    changes: dict[str, Any] = {}
    if b"Kd" in values:
        parts = [min(half_up(255 * min(part, 1.0)), 255) for part in values[b"Kd"]]
        changes["object_color"] = parts * 3 if len(parts) == 1 else parts
    has_highlight = values.get(b"illum", [2.0])[0] not in WITHOUT_HIGHLIGHT
    changes["specular"] = max(values.get(b"Ks", [0.0])) if has_highlight else 0.0
    if changes["specular"] == 0:
        changes["blend"] = 1.0
    if b"Ns" in values:
        changes["exponent"] = max(values[b"Ns"][0], LEAST_EXPONENT)
    return replaced(created_surface(name, COLORED_PAINT.object_color), changes)


def mtl_text(surfaces: Iterable[tuple[str, Surface]]) -> bytes:
    """Surfaces, each with the name of its material, as a material library that `read_obj` reads back.

    Diffuse reflectance, light color and other properties that a material does not have are left out.
    """
    lines = []
    for name, surface in surfaces:
        color = " ".join(f"{component / 255:.6g}" for component in surface.paint.color)
        specular = surface.reflectance.specular
        exponent = vars(surface.reflectance.model).get("exponent")
        lines += [statement("newmtl", name), f"Kd {color}", f"Ks {specular!r} {specular!r} {specular!r}"]
        lines += ["illum 2"] if exponent is None else [f"Ns {exponent!r}", "illum 2"]
    return "\n".join([*lines, ""]).encode("utf-8", "replace")


def statement(keyword: str, name: str) -> str:
    """The line that names something; a space after a last backslash keeps it from continuing the line."""
    return f"{keyword} {name} " if name.endswith("\\") else f"{keyword} {name}"
