"""OBJ statements other than nodes and polygons: part names, materials, and statements that are skipped.

A polygon belongs to the group of the latest `g` or `o` name before it; of several names after `g`, the first
counts. `g` or `o` without a name ends the group. A group is a part; where its polygons have several
materials, it is a part for each of them, and all but the first add the material to their name: "hood", "hood
chrome". Without a group the part has the name of the material, and without that the file's own name.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from autocolor.files.reading import shown
from autocolor.files.repair.names import name_of

UNUSED: Final = frozenset(
    b"vt vn s mg maplib usemap lod bevel c_interp d_interp shadow_obj trace_obj".split()
)
"""Statements that are ignored without being counted."""

SKIPPED: Final = {
    b"p": "points",
    b"l": "lines",
    **dict.fromkeys(
        b"vp deg bmat step cstype curv curv2 surf parm trim hole scrv sp end con ctech stech".split(),
        "statements of curves and curved surfaces",
    ),
}


class ObjPart(NamedTuple):
    """A part of an OBJ file, and the name of its material, None without one."""

    name: str
    material: str | None


class Statements:
    """Keeps the current group and material, and counts skipped statements, while a file is read."""

    def __init__(self, file_stem: str) -> None:
        self.file_stem = file_stem
        self.group: str | None = None
        self.material: str | None = None
        self.libraries: list[bytes] = []
        self.numbers: dict[tuple[str | None, str | None], int] = {}
        self.skipped: dict[str, int] = {}
        self.unknown = ""

    @property
    def part_number(self) -> int:
        """The part number of a polygon at the current position: that of its group and material.

        A new pair of them gets the next number.
        """
        return self.numbers.setdefault((self.group, self.material), len(self.numbers))

    def parts(self) -> tuple[ObjPart, ...]:
        """The parts in the order of their numbers, with different names."""
        # First name those that have a name of their own, so that no part with an added name takes it.
        names: dict[tuple[str | None, str | None], str] = {}
        taken: set[str] = set()
        added = []
        for group, material in self.numbers:
            name = group or material or self.file_stem
            if name in taken:
                added.append((group, material))
            else:
                names[group, material] = name
                taken.add(name)
        for group, material in added:
            name = stem = f"{group} {material}" if group and material else group or material or self.file_stem
            number = 1
            while name in taken:
                number += 1
                name = f"{stem} {number}"
            names[group, material] = name
            taken.add(name)
        return tuple(ObjPart(names[key], key[1]) for key in self.numbers)

    def read(self, line: bytes) -> bool:
        """Process one line; returns False if it is a node or a polygon, which the caller must read."""
        words = line.split(None, 2)
        if not words or words[0].startswith(b"#"):
            return True
        keyword = words[0]
        if keyword in (b"v", b"f"):
            return False
        if keyword == b"g":
            self.group = name_of(words[1]) if len(words) > 1 else None
        elif keyword == b"o":
            self.group = name_of(line.split(None, 1)[1]) if len(words) > 1 else None
        elif keyword == b"usemtl":
            self.material = name_of(line.split(None, 1)[1]) if len(words) > 1 else None
        elif keyword == b"mtllib":
            self.libraries.extend(line.split(None, 1)[1:])
        elif keyword not in UNUSED:
            # Name only the first unknown statement, to keep the report short.
            if keyword not in SKIPPED and not self.unknown:
                self.unknown = f"unknown statements (the first is {shown(keyword)})"
            what = SKIPPED.get(keyword, self.unknown)
            self.skipped[what] = self.skipped.get(what, 0) + 1
        return True

    @property
    def sentences(self) -> tuple[str, ...]:
        """Messages about what was skipped."""
        return tuple(f"skipped {what}: {count:,}" for what, count in self.skipped.items())
