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

LARGEST_LIBRARY: Final = 4 * 1024 * 1024
"""Limit: bytes of a library, enough for ten thousand materials."""

MOST_LIBRARIES: Final = 20
"""Limit: libraries of a file that are read."""

LARGEST: Final = 1e6
"""Limit: above every coefficient and exponent of a material."""

TEXTURES: Final = re.compile(rb"map_\w+|bump|disp|decal|refl|norm", re.IGNORECASE)
OPAQUE: Final = {b"d": 1.0, b"Tr": 0.0}
"""The statements of transparency, and their values for an opaque material."""

USED: Final = (b"Kd", b"Ks", b"Ns", b"illum")

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
    # The argument is one name with spaces, or several names.
    found = [
        _paths(obj.parent, [library]) or _paths(obj.parent, library.split())
        for library in libraries[:MOST_LIBRARIES]
    ]
    paths = [path for each in found for path in each]
    # The library may have been renamed together with the OBJ file.
    paths = paths or _paths(obj.parent, [os.fsencode(f"{obj.stem}.mtl")])
    sentences: list[str] = []
    surface_of: dict[str, Surface] = {}
    for path in [*dict.fromkeys(paths)][:MOST_LIBRARIES]:
        try:
            data = text_lines(read_bytes(path, LARGEST_LIBRARY), path.name, "a material library")
        except InputError as error:
            sentences.append(f"the materials have default colors: {error}")
            continue
        surfaces, notes = materials_of(data, path.name, set(wanted))
        surface_of = {**surfaces, **surface_of}
        sentences.extend(notes)
    undefined = [name for name in wanted if name not in surface_of]
    if undefined and (libraries or paths):
        more = f" and {len(undefined) - 3:,} more" if len(undefined) > 3 else ""
        missing = [shown(library) for library, each in zip(libraries, found, strict=False) if not each]
        advice = f"; copy {missing[0]} to the folder of {obj.name}" if missing else ""
        sentences.append(
            f"no library defines material {', '.join(map(shown, undefined[:3]))}{more}; default colors are"
            f" used{advice}"
        )
    return tuple(surface_of[name] for name in wanted if name in surface_of), tuple(sentences)


def _paths(folder: Path, names: Sequence[bytes]) -> list[Path]:
    """The paths of the libraries that are within the folder, each by its path or its file name."""
    paths = []
    for name in names[:MOST_LIBRARIES]:
        windows = PureWindowsPath(name_of(name.strip().strip(b'"')))
        candidates = [path_within([], folder, text) for text in (windows.as_posix(), windows.name)]
        paths += [path for path in candidates if path is not None and os.path.isfile(path)][:1]
    return paths


def materials_of(data: bytes, place: str, wanted: set[str]) -> tuple[Mapping[str, Surface], list[str]]:
    """The surfaces of the materials in `wanted` that a library defines, and what was left out or wrong."""
    wrong: list[str] = []
    left_out: dict[str, set[str]] = {"the textures": set(), "the transparency": set()}
    tables: dict[str, dict[bytes, list[float]]] = {}
    name, table = "", dict[bytes, list[float]]()
    for number, line in enumerate(io.BytesIO(data), start=1):
        keyword, *words = line.split(b"#", 1)[0].split() or [b""]
        if keyword == b"newmtl":
            name = name_of(line.split(None, 1)[1]) if words else ""
            table = tables.setdefault(name, {}) if name in wanted and name not in tables else {}
        elif keyword in USED or keyword in OPAQUE:
            values = [decimal(word) for word in words[:3]]
            # A comparison with NaN is false.
            if len(values) not in (1, 3) or not all(0 <= value < LARGEST for value in values):
                wrong.append(
                    f"{place}, line {number}: {keyword.decode()} must have one number or three, from 0 to"
                    f" {LARGEST:g}, not {shown(b' '.join(words))}; the default is used"
                )
            elif keyword in USED:
                table[keyword] = values
            elif values[0] != OPAQUE[keyword]:
                left_out["the transparency"].add(name)
        elif TEXTURES.fullmatch(keyword):
            left_out["the textures"].add(name)
    sentences = [
        f"{place}: left out {what} of {count:,} material{'s' if count > 1 else ''}"
        for what, names in left_out.items()
        if (count := len(names & wanted))
    ]
    if len(wrong) > 1:
        wrong[1:] = [f"{place}: {len(wrong) - 1:,} more such lines"]
    return {name: _surface(name, values) for name, values in tables.items()}, sentences + wrong


def _surface(name: str, values: Mapping[bytes, list[float]]) -> Surface:
    """The surface of a material; properties that it does not define have their defaults."""
    changes: dict[str, Any] = {}
    if b"Kd" in values:
        parts = [min(half_up(255 * min(part, 1.0)), 255) for part in values[b"Kd"]]
        changes["object_color"] = parts * 3 if len(parts) == 1 else parts
    # In the illumination models 0 and 1 nothing reflects specularly.
    has_highlight = values.get(b"illum", [2.0])[0] > 1
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
