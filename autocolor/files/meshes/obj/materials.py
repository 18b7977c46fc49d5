"""Material libraries of OBJ files (MTL): the surfaces that their materials describe.

These statements are used: `newmtl` begins a material; `Kd` is the object color; the largest component of `Ks`
is S, the specular reflectance, which is 0 without such a statement or where `illum` is 0 or 1; `Ns` is N, the
exponent, at least 1. A material without specular reflectance keeps its object color at every level. D stays
the default, because `Kd` is a color and no intensity. Textures and transparency are left out, and the report
says so. Everything else is ignored.

A library must be in the folder of the OBJ file, or below it. One that is named elsewhere, as by an absolute
path, is looked for there by its file name. Problems in a library are reported, and do not keep the mesh from
being read.
"""

from __future__ import annotations

import io
import math
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path, PureWindowsPath
from typing import Any, Final, NamedTuple

from autocolor.errors import InputError
from autocolor.files.meshes.obj.lines import NUMBER
from autocolor.files.paths import path_within
from autocolor.files.reading import read_bytes, shown, text_problem
from autocolor.files.repair.names import name_of
from autocolor.mapping.rounding import half_up
from autocolor.scene.columns.rows import changed
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.surfaces import Surface

LARGEST_LIBRARIES: Final = 4 * 1024 * 1024
"""Assumed: bytes of all libraries of a file, those of some ten thousand materials."""

MOST_LIBRARIES: Final = 100
MOST_PROBLEMS: Final = 5
"""Assumed: problems that are reported of one library; the others are counted."""

MOST_WORDS: Final = 8
"""As many words of a line are looked at."""

LARGEST: Final = 1e6
"""Assumed: above every coefficient and exponent of a material."""

TEXTURES: Final = re.compile(rb"map_\w+|bump|disp|decal|refl|norm", re.IGNORECASE)
TRANSPARENCY: Final = {b"d": 1.0, b"Tr": 0.0}
"""The statements of transparency, and their values for what is not transparent."""

USED: Final = (b"Kd", b"Ks", b"Ns", b"illum")

WITHOUT_HIGHLIGHT: Final = (0.0, 1.0)
"""The illumination models, `illum`, in which nothing reflects specularly."""

LEAST_EXPONENT: Final = 1.0
"""Assumed: some programs write 0 for the roughest material, which would be a highlight all over."""


class Materials(NamedTuple):
    """The surfaces of some materials, and what was left out or wrong in their libraries."""

    surfaces: tuple[Surface, ...]
    sentences: tuple[str, ...]


def read_materials(obj: Path, libraries: Sequence[bytes], wanted: Sequence[str]) -> Materials:
    """The surfaces of the materials in `wanted`, from the libraries that an OBJ file names.

    `libraries` are the arguments of its `mtllib` statements. Where none of them is found, a file beside it
    with the same name and the suffix .mtl is read. Where a material is defined twice, the first one counts.
    """
    if not wanted:
        return Materials((), ())
    missing: list[bytes] = []
    paths = _paths(obj, libraries, missing)
    sentences: list[str] = []
    found: dict[str, Surface] = {}
    left = LARGEST_LIBRARIES
    for path in paths:
        if len(found) == len(wanted):
            break
        try:
            data = read_bytes(path, left)
            left -= len(data)
            if problem := text_problem(data):
                raise InputError(f"{path.name}: a material library {problem}")
        except InputError as error:
            sentences.append(f"the materials have default colors: {error}")
            continue
        surfaces, notes = materials_of(data, path.name, set(wanted))
        found = {**surfaces, **found}
        sentences.extend(notes)
    sentences.extend(
        f"the materials have default colors: there is no library {shown(name)} in the folder of {obj.name};"
        " copy it there"
        for name in missing[:MOST_PROBLEMS]
    )
    undefined = [name for name in wanted if name not in found]
    if found and undefined:
        more = f" and {len(undefined) - 3:,} more" if len(undefined) > 3 else ""
        names = ", ".join(shown(name) for name in undefined[:3])
        sentences.append(f"no library defines material {names}{more}; default colors are used")
    return Materials(tuple(found[name] for name in wanted if name in found), tuple(sentences))


def _paths(obj: Path, libraries: Sequence[bytes], missing: list[bytes]) -> list[Path]:
    """The paths of the libraries, at most MOST_LIBRARIES; the arguments of those not found are collected."""
    folder = obj.parent
    found: dict[str, Path] = {}
    for library in dict.fromkeys(libraries[:MOST_LIBRARIES]):
        # The argument is one name with spaces, or several names.
        path = _path(folder, library)
        several = [path] if path else [_path(folder, name) for name in library.split()[:MOST_LIBRARIES]]
        if not any(several):
            missing.append(library)
        found.update({os.path.realpath(path): path for path in several if path is not None})
    if not found:
        beside = _path(folder, os.fsencode(f"{obj.stem}.mtl"))
        found = {} if beside is None else {"": beside}
        # What is named may have been renamed together with the OBJ file.
        if beside is not None:
            missing.clear()
    return list(found.values())[:MOST_LIBRARIES]


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
    more_problems = 0
    textured: set[str] = set()
    transparent: set[str] = set()
    tables: dict[str, dict[bytes, list[float]]] = {}
    name, table = "", dict[bytes, list[float]]()
    lines = io.BytesIO(data.replace(b"\r\n", b"\n").replace(b"\r", b"\n"))
    for number, line in enumerate(lines, start=1):
        words = line.split(b"#", 1)[0].split(None, MOST_WORDS)
        if not words:
            continue
        keyword = words[0]
        if keyword == b"newmtl":
            name = name_of(line.split(None, 1)[1]) if len(words) > 1 else ""
            table = tables.setdefault(name, {}) if name in wanted and name not in tables else {}
        elif keyword in USED or keyword in TRANSPARENCY:
            values = _numbers(words[1:], math.inf if keyword == b"Kd" else LARGEST)
            if values is None and len(problems) < MOST_PROBLEMS:
                problems.append(
                    f"{place}, line {number}: {keyword.decode()} must have one number or three, from 0 to"
                    f" {LARGEST:g}, not {shown(b' '.join(words[1:]))}; the default is used"
                )
            elif values is None:
                more_problems += 1
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
    sentences.extend(problems)
    if more_problems:
        sentences.append(f"{place}: {more_problems:,} more such lines")
    return {name: _surface(name, values) for name, values in tables.items()}, sentences


def _numbers(words: list[bytes], most: float) -> list[float] | None:
    """The numbers of a statement, one or three; None if one is below 0 or not below `most`."""
    words = words[:3]
    if len(words) == 2 or not words or not all(NUMBER.fullmatch(word) for word in words):
        return None
    numbers = [float(word) for word in words]
    return numbers if all(0 <= number < most for number in numbers) else None


def _surface(name: str, values: Mapping[bytes, list[float]]) -> Surface:
    """The surface of one material; what it does not define has its default."""
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
    return changed(created_surface(name, COLORED_PAINT.object_color), changes)
