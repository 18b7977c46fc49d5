"""OBJ statements other than nodes and polygons: part names, and statements that are skipped.

A polygon belongs to the part of the latest `g` or `o` name before it; of several names after `g`, the first
counts. Without such a name it belongs to the part of the current `usemtl` name, and without that to the part
with the file's own name. So groups stay whole whatever materials they use, and a file with materials but no
groups has one part for each material. `g` or `o` without a name ends the group.
"""

from __future__ import annotations

from typing import Final

from autocolor.files.reading import shown

UNUSED: Final = frozenset(
    b"vt vn s mg mtllib maplib usemap lod bevel c_interp d_interp shadow_obj trace_obj".split()
)
"""Statements that are ignored without being counted; material files are never opened."""

SKIPPED: Final = {
    b"p": "points",
    b"l": "lines",
    **dict.fromkeys(
        b"vp deg bmat step cstype curv curv2 surf parm trim hole scrv sp end con ctech stech".split(),
        "statements of curves and curved surfaces",
    ),
}


class Statements:
    """Keeps the current part name and counts skipped statements while a file is read."""

    def __init__(self, file_stem: str) -> None:
        self.file_stem = file_stem
        self.group: str | None = None
        self.surface: str | None = None
        self.numbers: dict[str, int] = {}
        self.skipped: dict[str, int] = {}
        self.unknown = ""

    @property
    def part_number(self) -> int:
        """The part number of a polygon at the current position; a new part name gets the next number."""
        name = self.group or self.surface or self.file_stem
        return self.numbers.setdefault(name, len(self.numbers))

    def read(self, line: bytes) -> bool:
        """Process one line; returns False if it is a node or a polygon, which the caller must read."""
        words = line.split(None, 2)
        if not words or words[0].startswith(b"#"):
            return True
        keyword = words[0]
        if keyword in (b"v", b"f"):
            return False
        if keyword == b"g":
            self.group = _name(words[1]) if len(words) > 1 else None
        elif keyword == b"o":
            self.group = _name(line.split(None, 1)[1]) if len(words) > 1 else None
        elif keyword == b"usemtl":
            self.surface = _name(line.split(None, 1)[1]) if len(words) > 1 else None
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


def _name(text: bytes) -> str:
    """The name as printable text of at most 200 characters; bytes that are not UTF-8 are read as Latin-1."""
    text = text.strip()[:200]
    try:
        name = text.decode("utf-8")
    except UnicodeDecodeError:
        name = text.decode("latin-1")
    return "".join(letter if letter.isprintable() else "?" for letter in name)
