"""OBJ statements other than nodes and polygons: what names the parts, and what is skipped.

A polygon's part is the latest `g` or `o` name before it (the first name, where `g` gives several). Before
any was given it is the current `usemtl` name, and before any of these the file's own name. So a file that
groups keeps its groups whole whatever materials they use, and one that only changes materials has a part for
each. `g` or `o` without a name takes the name away.
"""

from __future__ import annotations

from typing import Final

from autocolor.files.reading import shown

UNUSED: Final = frozenset(
    b"vt vn s mg mtllib maplib usemap lod bevel c_interp d_interp shadow_obj trace_obj".split()
)
"""Statements that change nothing here; material files are never opened."""

SKIPPED: Final = {
    b"p": "points",
    b"l": "lines",
    **dict.fromkeys(
        b"vp deg bmat step cstype curv curv2 surf parm trim hole scrv sp end con ctech stech".split(),
        "statements of curves and curved surfaces",
    ),
}


class Statements:
    """The part names and the counts of what was skipped, while a file is read from top to bottom."""

    def __init__(self, file_stem: str) -> None:
        self.file_stem = file_stem
        self.group: str | None = None
        self.surface: str | None = None
        self.numbers: dict[str, int] = {}
        self.skipped: dict[str, int] = {}
        self.unknown = ""

    @property
    def part_number(self) -> int:
        """The row of the part that a polygon read now belongs to."""
        name = self.group or self.surface or self.file_stem
        return self.numbers.setdefault(name, len(self.numbers))

    def read(self, line: bytes) -> bool:
        """Read one line; False where it is a node or a polygon."""
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
            # Name the first unknown one only, so that a file of rubbish makes no endless report.
            if keyword not in SKIPPED and not self.unknown:
                self.unknown = f"unknown statements (the first is {shown(keyword)})"
            what = SKIPPED.get(keyword, self.unknown)
            self.skipped[what] = self.skipped.get(what, 0) + 1
        return True

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was skipped, for the report."""
        return tuple(f"skipped were {count:,} {what}" for what, count in self.skipped.items())


def _name(text: bytes) -> str:
    """The name as text that can be shown; what is not UTF-8 is taken as Latin-1."""
    text = text.strip()[:200]
    try:
        name = text.decode("utf-8")
    except UnicodeDecodeError:
        name = text.decode("latin-1")
    return "".join(letter if letter.isprintable() else "?" for letter in name)
