"""What comes back from the process of a library: polygons, materials, and sentences about what is left out.

It comes as an array file, which is checked like any other: nothing is believed, and nothing unpickled.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray
from autocolor.checks import LARGEST_COORDINATE, Color, printable, shown
from autocolor.errors import InputError
from autocolor.files.array_file import ArrayFileKind, array_file_bytes, read_array_file
from autocolor.files.repair.found_scalars import FoundScalars
from autocolor.files.repair.names import different, printable_name
from autocolor.files.repair.polygons import Polygons
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON

FAILED: Final = b"!"
"""What a result begins with that is no mesh, but a sentence in UTF-8."""

LONGEST_SENTENCE: Final = 300
MOST_SENTENCES: Final = 100


@dataclass(frozen=True, eq=False)
class ForeignMesh:
    """A mesh as a library gives it.

    `material_of_part` has the names of materials by part, `colors` the color of those that have one, and
    `sentences` tell what was left out.
    """

    polygons: Polygons
    sentences: tuple[str, ...] = ()
    material_of_part: Mapping[str, str] = field(default_factory=dict)
    colors: Mapping[str, Color] = field(default_factory=dict)


KEYS: Final = ("part_names", "node_scalars", "polygon_scalars", "sentences", "materials", "colors")

ARRAYS: Final = {
    "coordinates": ("<f8", 2),
    "corners": ("<i8", 1),
    "corner_counts": ("<i8", 1),
    "part_numbers": ("<i8", 1),
    # One after the other: an array of no scalars would have as many columns as there are nodes.
    "node_values": ("<f8", 1),
    "polygon_values": ("<f8", 1),
}


def kind_of_file(largest: int) -> ArrayFileKind:
    """The kind of array file that a result is, of at most so many bytes."""
    return ArrayFileKind(
        noun="result of a reader",
        advice="write the mesh as OBJ or PLY",
        largest=largest,
        formats=("autocolor foreign mesh 1",),
        keys=frozenset(KEYS),
        arrays=ARRAYS,
    )


def foreign_mesh_bytes(mesh: ForeignMesh) -> bytes:
    """The content of the file that a mesh comes back in."""
    polygons = mesh.polygons
    of = {each: [scalar for scalar in polygons.scalars if scalar.of == each] for each in (NODE, POLYGON)}
    header = {
        "part_names": polygons.part_names,
        "node_scalars": [scalar.name for scalar in of[NODE]],
        "polygon_scalars": [scalar.name for scalar in of[POLYGON]],
        "sentences": mesh.sentences,
        "materials": dict(mesh.material_of_part),
        "colors": dict(mesh.colors),
    }
    values = {each: [scalar.values for scalar in scalars] for each, scalars in of.items()}
    arrays = {
        "coordinates": polygons.coordinates,
        "corners": polygons.corners,
        "corner_counts": polygons.corner_counts,
        "part_numbers": polygons.part_numbers,
        "node_values": np.concatenate([np.empty(0), *values[NODE]]),
        "polygon_values": np.concatenate([np.empty(0), *values[POLYGON]]),
    }
    return array_file_bytes(kind_of_file(0), header, arrays)


def read_foreign_mesh(path: Path, largest: int, place: str, library: str) -> ForeignMesh:
    """The mesh that a library gave for the file `place`, checked. Raises InputError."""

    def wrong(rule: str) -> InputError:
        return InputError(f"{place}: {library} gave {rule}; correct the file, or write it as OBJ or PLY")

    try:
        header, arrays = read_array_file(kind_of_file(largest), path)
    except InputError as error:
        raise wrong(f"no mesh ({str(error)[:LONGEST_SENTENCE]})") from None
    if problem := _problem(header, arrays):
        raise wrong(problem)
    scalars = FoundScalars()
    counts = {NODE: len(arrays["coordinates"]), POLYGON: len(arrays["corner_counts"])}
    for of, count in counts.items():
        for row, name in enumerate(header[f"{of}_scalars"]):
            scalars.add(name, arrays[f"{of}_values"][row * count : (row + 1) * count], of)
    polygons = Polygons(
        arrays["coordinates"].copy(),
        arrays["corners"].astype(np.intp),
        arrays["corner_counts"].astype(np.intp),
        arrays["part_numbers"].astype(np.intp),
        part_names_of(header["part_names"]),
        scalars.scalars,
    )
    renamed = dict(zip(header["part_names"], polygons.part_names, strict=True))
    sentences = (printable(each[:LONGEST_SENTENCE]) for each in header["sentences"][:MOST_SENTENCES])
    return ForeignMesh(
        polygons,
        (*sentences, *scalars.messages),
        {renamed[part]: _material(name) for part, name in header["materials"].items() if part in renamed},
        {_material(name): (color[0], color[1], color[2]) for name, color in header["colors"].items()},
    )


def _problem(header: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> str | None:
    """What is wrong with the tables, as the object of a sentence; None if nothing is."""
    nodes, corners, sizes = arrays["coordinates"], arrays["corners"], arrays["corner_counts"]
    parts = arrays["part_numbers"]
    lists = ("part_names", "node_scalars", "polygon_scalars", "sentences")
    if not all(
        isinstance(header[key], list) and all(isinstance(each, str) for each in header[key]) for key in lists
    ):
        return "names that are no texts"
    materials, colors = header["materials"], header["colors"]
    if not isinstance(materials, dict) or not all(isinstance(each, str) for each in materials.values()):
        return "materials that have no names"
    if not isinstance(colors, dict) or not all(map(_is_color, colors.values())):
        return "materials whose colors are no colors"
    if nodes.shape[1] != 3:
        return f"nodes of {nodes.shape[1]} coordinates, not three"
    wrong = np.flatnonzero(~(np.abs(nodes) <= LARGEST_COORDINATE).all(axis=1))
    if len(wrong):
        where = f"{shown(nodes[wrong[0]].tolist())} (node {wrong[0] + 1:,})"
        return f"a node whose coordinates are not finite and at most 1e30 in size, {where}"
    if sizes.sum() != len(corners) or not ((sizes >= 0) & (sizes <= len(corners))).all():
        return "polygons without all of their corners"
    wrong = np.flatnonzero((corners < 0) | (corners >= len(nodes)))
    if len(wrong):
        return f"a polygon with the node {corners[wrong[0]] + 1:,}, which must be from 1 to {len(nodes):,}"
    if len(parts) != len(sizes) or (
        len(parts) and not (parts.min() >= 0 and parts.max() < len(header["part_names"]))
    ):
        return "polygons of parts that are not there"
    for of, count in ((NODE, len(nodes)), (POLYGON, len(sizes))):
        if len(arrays[f"{of}_values"]) != count * len(header[f"{of}_scalars"]):
            return f"scalars without a value for each {of}"
    return None


def _is_color(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(type(each) is int and 0 <= each <= 255 for each in value)
    )


def part_names_of(names: Sequence[str]) -> tuple[str, ...]:
    """Names of parts that are printable and different; one without a name is "part"."""
    return different([printable_name(name) or "part" for name in names])


def _material(name: str) -> str:
    return printable_name(name) or "material"
