"""What a module that calls a library returns or raises; it imports no library.

Each of `foreign_vtk`, `foreign_gltf`, `foreign_3mf` and `foreign_meshio` has a function
`read(path: Path, kind: str) -> ForeignMesh`, which runs in the process of `foreign_worker`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from autocolor.checks import Color
from autocolor.files.meshes.repair import RawPolygons, different, printable_name

REMEDY: Final = "correct the file, or write it as OBJ or PLY"


@dataclass(frozen=True, eq=False)
class ForeignMesh:
    """A mesh as a library gives it.

    `material_of_part` has the names of materials by part, `colors` the colors of materials that have a
    color, and `sentences` say what was left out.
    """

    polygons: RawPolygons
    sentences: tuple[str, ...] = ()
    material_of_part: Mapping[str, str] = field(default_factory=dict)
    colors: Mapping[str, Color] = field(default_factory=dict)


class ForeignRefusal(Exception):  # noqa: N818
    """A file cannot be read as it is.

    `reason` is the rule, what the file has instead, and the place: "a cell must have nodes of the file, from
    0 to 5, not 99 (cell 1)". The message to the user is the file's name, the reason and the remedy.
    """

    def __init__(self, reason: str, remedy: str = REMEDY) -> None:
        super().__init__(f"{reason}; {remedy}")


def unreadable(library: str, line: str) -> ForeignRefusal:
    """The refusal of a file that a library cannot read, with the line that the library printed."""
    return ForeignRefusal(f"{library} must be able to read it, and cannot ({line})")


def part_names_of(names: Sequence[str]) -> tuple[str, ...]:
    """Names of parts that are printable and different; a part without a name is "part"."""
    return different([printable_name(name) or "part" for name in names])
