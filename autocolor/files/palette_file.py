"""Palette files: colors, some with names, to and from other programs.

A palette is the entries of a surface's range, or a list of named paints. Names may repeat.

- .gpl, a GIMP palette, which Inkscape, Krita and Aseprite read and write: colors with names, in UTF-8.
  Aseprite's `Channels: RGBA` adds a transparency to each color, which is left out.
- .csv, a table as `text_table` reads it: the columns red, green and blue from 0 to 255, or the column color
  as "#rrggbb" or by name; and perhaps the column name. Written as `red,green,blue`, and `name` if a color has
  a name.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color, printable, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.formats import suffix_rule
from autocolor.files.meshes.number_text import Problems
from autocolor.files.reading import read_bytes, read_head, text_lines, utf_8_text
from autocolor.files.text_table import TextTable
from autocolor.files.writing import write_atomically
from autocolor.immutable import Immutable, read_only
from autocolor.scene.kinds import ColorKind

MOST_COLORS: Final = 4096
"""Limit: the colors of a palette. The largest lists of paints have some two thousand."""

LONGEST_NAME: Final = 100
"""Limit: letters of a name, which fit in two lines of a message."""

LARGEST: Final = 1 << 20
"""Limit: the bytes of a palette file. MOST_COLORS with names of LONGEST_NAME letters take half of it."""

GPL: Final = ".gpl"
CSV: Final = ".csv"
SUFFIXES: Final = (CSV, GPL)

COLOR: Final = ColorKind()


@dataclass(frozen=True, repr=False, eq=False, init=False)
class Palette(Immutable):
    """Colors in order, (n, 3) uint8, read-only, and their names, n texts; "" for a color without a name.

    Names may repeat; without `names`, no color has a name. Raises InputError unless there are 1 to 4,096
    valid colors, and a valid name for each of them or none at all.
    """

    colors: Bytes
    names: tuple[str, ...]

    def __init__(self, colors: Any, names: Iterable[str] = ()) -> None:
        try:
            values = colors.tolist() if isinstance(colors, np.ndarray) else colors
            values = [values] if isinstance(values, str) else list(values)
        except TypeError:
            raise InputError(
                f"the colors of a palette must be a sequence of colors, not {shown(colors)}; give a list"
            ) from None
        names = ((names,) if isinstance(names, str) else tuple(names)) or ("",) * len(values)
        if not 1 <= len(values) <= MOST_COLORS:
            rule = f"a palette must have 1 to {MOST_COLORS:,} colors, not {len(values):,}"
            raise InputError(f"{rule}; {'choose some of them' if values else 'add a color'}")
        if len(names) != len(values):
            raise InputError(
                f"a palette must have a name for each of its {len(values):,} colors, or no names, not"
                f" {len(names):,}; write '' for a color without a name"
            )
        for number, (color, name) in enumerate(zip(values, names, strict=True), start=1):
            if problem := _problem_of(color, name):
                raise InputError(f"color {number} of a palette: {problem}")
        array = np.array([COLOR.accepted(color) for color in values], np.uint8)
        vars(self).update(colors=read_only(array), names=names)

    def __len__(self) -> int:
        return len(self.colors)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Palette):
            return NotImplemented
        return self.names == other.names and np.array_equal(self.colors, other.colors)

    def __hash__(self) -> int:
        return hash((self.colors.tobytes(), self.names))

    def color(self, number: int) -> Color:
        """The color at a place, counted from 0."""
        red, green, blue = self.colors[number].tolist()
        return red, green, blue

    def color_named(self, name: str) -> Color | None:
        """The first color with this name, in capitals or not; None if no color has this name."""
        folded = [each.casefold() for each in self.names]
        return self.color(folded.index(name.casefold())) if name and name.casefold() in folded else None


def _problem_of(color: Any, name: Any) -> str:
    """What is wrong with a color or its name; "" if nothing is."""
    try:
        COLOR.accepted(color)
    except (ValueError, TypeError, OverflowError):
        return f"a color {COLOR.rule()}, not {shown(color, 40)}{COLOR.advice(color) or '; correct it'}"
    if isinstance(name, str) and len(name) <= LONGEST_NAME and name.isprintable() and name == name.strip(" "):
        return ""
    rule = f"must be at most {LONGEST_NAME} printable characters, without spaces around them"
    return f"a name {rule}, not {shown(name, 40)}; correct it"


def read_palette(path: str | os.PathLike[str]) -> Palette:
    """The palette of a .csv file, or of a GIMP palette with any ending.

    Raises InputError with the problems and their lines, MissingInputError if there is no such file.
    """
    path = Path(path)
    data = read_bytes(path, LARGEST)
    if path.suffix.lower() == GPL or data.startswith(GIMP.encode()):
        return _read_gpl(data, path.name)
    if path.suffix.lower() == CSV:
        return _read_csv(data, path.name)
    rule = suffix_rule(path, SUFFIXES)
    raise InputError(f"{path.name or path}: a palette must {rule}; save it as one of these")


def write_palette(
    path: str | os.PathLike[str],
    palette: Palette | Bytes | Sequence[str | Sequence[int]],
    *,
    names: Iterable[str] | None = None,
    overwrite: bool = False,
) -> None:
    """Write a palette, or colors with or without `names`, to a .gpl or .csv file, atomically.

        autocolor.write_palette("ramp.gpl", ["#200", "#f60", "#fff"], names=["low", "middle", "high"])

    `read_palette` gives back the same palette. Raises UsageError for another ending; InputError for invalid
    colors and names; OutputError if the file exists and `overwrite` is false, or if it cannot be created;
    WriteError if writing fails.
    """
    path = Path(path)
    check_palette_path(path)
    if not isinstance(palette, Palette):
        palette = Palette(palette, names or ())
    elif names is not None:
        palette = Palette(palette.colors, names)
    text = io.StringIO()
    rows = zip(palette.colors.tolist(), palette.names, strict=True)
    if path.suffix.lower() == GPL:
        text.write(f"{GIMP}\nName: {printable(path.stem).strip() or 'palette'}\n#\n")
        for (red, green, blue), name in rows:
            text.write(f"{red:3} {green:3} {blue:3}\t{name}".rstrip("\t") + "\n")
    else:
        columns = 4 if any(palette.names) else 3
        table = csv.writer(text, lineterminator="\n")
        table.writerow((*COMPONENTS[:3], "name")[:columns])
        table.writerows((*color, name)[:columns] for color, name in rows)
    write_atomically(path, text.getvalue().encode(), overwrite=overwrite)


def check_palette_path(path: Path) -> None:
    """Raise UsageError unless palettes can be written to files with the ending of a path."""
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(f"{path.name}: a palette must {suffix_rule(path, SUFFIXES)}; rename it")


def is_palette(path: Path) -> bool:
    """Whether a file seems to be a palette. Its ending decides; for .csv, its first row decides, too."""
    if path.suffix.lower() != CSV:
        return path.suffix.lower() == GPL
    head = read_head(path)
    try:
        return _are_columns(TextTable(head[: head.rfind(b"\n") + 1] or head, path.name).header)
    except InputError:
        return False


# The GIMP palette: a line for each color. The name of the palette and its number of columns are not kept.

GIMP: Final = "GIMP Palette"
GIMP_HEADER: Final = re.compile(r"(Name|Columns|Channels):[ \t]*(.*?)[ \t]*")
COMPONENT: Final = r"[ \t]*([0-9]{1,3})(?![0-9])"
NAME: Final = r"(?:[ \t]+(.*))?"
COMPONENTS: Final = ("red", "green", "blue", "alpha")


def _read_gpl(data: bytes, place: str) -> Palette:
    text = utf_8_text(text_lines(data, place, "a palette"), place, "a palette")
    first, *lines = text.split("\n")
    if first.rstrip(" \t") != GIMP:
        raise InputError(f"{place}, line 1: it must be {GIMP!r}, not {shown(first, 40)}; save it by GIMP")
    problems = Problems("line")
    rows: list[tuple[int, Any, str]] = []
    count = 3
    for number, line in enumerate(lines, start=2):
        if not line.strip() or line.lstrip(" \t").startswith("#"):
            continue
        if not rows and (header := GIMP_HEADER.fullmatch(line)):
            count = 4 if header.groups() == ("Channels", "RGBA") else count
        elif color := re.fullmatch(COMPONENT * count + NAME, line, re.DOTALL):
            rows.append((number, [int(color[at]) for at in (1, 2, 3)], (color[count + 1] or "").strip(" \t")))
        else:
            rule = f"a color must be {', '.join(COMPONENTS[:count])} and perhaps a name"
            problems.note(place, number, f"{rule}, not {shown(line, 40)}; correct it")
    return _palette(problems, place, rows)


# The table.


def _are_columns(header: Sequence[str]) -> bool:
    """Whether these are the names of the columns of a palette, with or without names."""
    columns = [name.lower() for name in header if name]
    return sorted(columns) in (["blue", "green", "red"], ["color"]) or (
        "name" in columns and _are_columns([name for name in columns if name != "name"])
    )


def _read_csv(data: bytes, place: str) -> Palette:
    table = TextTable(data, place, "a palette")
    if not _are_columns(table.header):
        columns = shown(", ".join(table.header), 60)
        raise table.wrong(
            f"the columns must be red, green, blue, or color, and perhaps name, not {columns}"
            f" ({table.understood}); name them so"
        )
    rows = []
    for row, cells in table.records():
        values = {name.lower(): cell for name, cell in cells.items()}
        color: Any = values.get("color")
        if color is None:
            # pandas writes the whole numbers of a column with missing values with a point.
            texts = [values[name].removesuffix(".0") for name in COMPONENTS[:3]]
            color = [int(text) if re.fullmatch("[0-9]{1,3}", text) else text for text in texts]
        rows.append((row, color, values.get("name", "")))
    return _palette(Problems("row"), table.place, rows)


def _palette(problems: Problems, place: str, rows: Sequence[tuple[int, Any, str]]) -> Palette:
    """The palette of the lines, colors and names of a file. Raises InputError with all problems."""
    for line, color, name in rows:
        if problem := _problem_of(color, name):
            problems.note(place, line, problem)
    problems.raise_any()
    try:
        return Palette([color for _, color, _ in rows], [name for _, _, name in rows])
    except InputError as error:
        raise InputError(f"{place}: {error}") from None
