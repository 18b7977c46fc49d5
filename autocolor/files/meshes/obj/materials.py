"""Material libraries of OBJ files (MTL): the surfaces that their materials describe.

These statements are used: `newmtl` begins a material; `Kd` is the object color; the largest component of `Ks`
is S, the specular reflectance; `Ns` is N, the exponent. A material without specular reflectance keeps its
object color at every level. D stays the default, because `Kd` is a color and no intensity. Textures and
transparency are left out, and the report says so. Everything else is ignored.

A library must be in the folder of the OBJ file, or below it. One that is named elsewhere, as by an absolute
path, is looked for there by its file name. Problems in a library are reported, and do not keep the mesh from
being read.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PureWindowsPath
from typing import Any, Final, NamedTuple

from autocolor.errors import InputError
from autocolor.files.meshes.obj.statements import name_of
from autocolor.files.paths import path_within
from autocolor.files.reading import read_bytes, shown, text_problem
from autocolor.mapping.rounding import half_up
from autocolor.scene.columns.rows import changed
from autocolor.scene.defaults import created_surface
from autocolor.scene.surfaces import Surface

LARGEST_LIBRARY: Final = 16 * 1024 * 1024
MOST_LIBRARIES: Final = 100
MOST_PROBLEMS: Final = 5
"""Assumed: problems that are reported of one library; the others are counted."""

NUMBER: Final = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?")

TEXTURES: Final = re.compile(rb"map_\w+|bump|disp|decal|refl|norm", re.IGNORECASE)
TRANSPARENCY: Final = {b"d": 1.0, b"Tr": 0.0}
"""The statements of transparency, and their values for what is not transparent."""

USED: Final = (b"Kd", b"Ks", b"Ns")


class Materials(NamedTuple):
    """The surfaces of some materials, and what was left out or wrong in their libraries."""

    surfaces: tuple[Surface, ...]
    sentences: tuple[str, ...]


def read_materials(obj: Path, libraries: Sequence[bytes], wanted: Sequence[str]) -> Materials:
    """The surfaces of the materials in `wanted`, from the libraries that an OBJ file names.

    `libraries` are the arguments of its `mtllib` statements. Without such a statement, a file beside it with
    the same name and the suffix .mtl is read. Where a material is defined twice, the first one counts.
    """
    if not wanted:
        return Materials((), ())
    sentences: list[str] = []
    found: dict[str, Surface] = {}
    for path in _paths(obj, libraries, sentences):
        try:
            data = read_bytes(path, LARGEST_LIBRARY)
            if problem := text_problem(data):
                raise InputError(f"{path.name}: a material library {problem}")
        except InputError as error:
            sentences.append(f"the materials have default colors: {error}")
            continue
        surfaces, notes = materials_of(data, path.name, set(wanted))
        found = {**surfaces, **found}
        sentences.extend(notes)
    return Materials(tuple(found[name] for name in wanted if name in found), tuple(sentences))


def _paths(obj: Path, libraries: Sequence[bytes], sentences: list[str]) -> Iterator[Path]:
    """The paths of the libraries; what is missing is added to the sentences."""
    if not libraries:
        beside = obj.with_suffix(".mtl")
        yield from [beside] if beside.is_file() else []
    for library in dict.fromkeys(libraries[:MOST_LIBRARIES]):
        # The argument is one name with spaces, or several names.
        found = _path(obj.parent, library)
        several = [_path(obj.parent, name) for name in library.split()]
        if found is not None:
            yield found
        elif len(several) > 1 and any(several):
            yield from (path for path in several if path is not None)
        else:
            sentences.append(
                f"the materials have default colors: there is no library {shown(library)} in the folder of"
                f" {obj.name}; copy it there"
            )


def _path(folder: Path, name: bytes) -> Path | None:
    """The path of a library within the folder; None if there is no such file."""
    text = name_of(name.strip().strip(b'"'))
    for candidate in (text, text.replace("\\", "/"), PureWindowsPath(text).name):
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
    for number, line in enumerate(re.split(rb"\r\n|\r|\n", data), start=1):
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
                rule = "must have finite numbers of at least 0" if keyword in USED else "must have a number"
                problems.append(
                    f"{place}, line {number}: {keyword.decode()} {rule}, not {shown(b' '.join(words[1:]))};"
                    " the default is used"
                )
            elif keyword in USED:
                table[keyword] = values
            else:
                transparent |= {name} if values[0] != TRANSPARENCY[keyword] else set()
        elif TEXTURES.fullmatch(keyword):
            textured.add(name)
    left_out = (("the textures", textured & wanted), ("the transparency", transparent & wanted))
    sentences = [
        f"{place}: left out {what} of {len(names):,} material{'s' if len(names) > 1 else ''}"
        for what, names in left_out
        if names
    ]
    sentences.extend(problems[:MOST_PROBLEMS])
    if len(problems) > MOST_PROBLEMS:
        sentences.append(f"{place}: {len(problems) - MOST_PROBLEMS:,} more such lines")
    return {name: _surface(name, values) for name, values in tables.items()}, sentences


def _numbers(words: list[bytes]) -> list[float] | None:
    """The numbers of a statement, one or three; None if they are not finite or below 0."""
    words = words[:3]
    if len(words) == 2 or not words or not all(NUMBER.fullmatch(word) for word in words):
        return None
    numbers = [float(word) for word in words]
    return numbers if all(0 <= number < math.inf for number in numbers) else None


def _surface(name: str, values: Mapping[bytes, list[float]]) -> Surface:
    """The surface of one material; what it does not define has its default."""
    changes: dict[str, Any] = {}
    if b"Kd" in values:
        parts = [min(half_up(255 * min(part, 1.0)), 255) for part in values[b"Kd"]]
        changes["object_color"] = parts * 3 if len(parts) == 1 else parts
    if b"Ks" in values:
        changes["specular"] = max(values[b"Ks"])
        if changes["specular"] == 0:
            changes["blend"] = 1.0
    if b"Ns" in values:
        changes["exponent"] = values[b"Ns"][0]
    return changed(created_surface(name), changes)
