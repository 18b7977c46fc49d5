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
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, SupportsIndex, overload

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color, printable, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.formats import suffix_rule
from autocolor.files.reading import read_bytes, read_head, text_lines
from autocolor.files.text_table import TextTable
from autocolor.files.writing import write_atomically
from autocolor.scene.kinds import ColorKind

MOST_COLORS: Final = 4096
"""Limit: the colors of a palette. The largest lists of paints have some two thousand."""

MOST_PROBLEMS: Final = 20
"""Limit: problems reported for one palette."""

LONGEST_NAME: Final = 100
"""Limit: letters of a name, which fit in two lines of a message."""

LARGEST: Final = 1 << 20
"""Limit: the bytes of a palette file. MOST_COLORS with names of LONGEST_NAME letters take half of it."""

GPL: Final = ".gpl"
CSV: Final = ".csv"
SUFFIXES: Final = (CSV, GPL)

GIMP: Final = "GIMP Palette"
COMPONENTS: Final = ("red", "green", "blue")
COLOR: Final = ColorKind()


@dataclass(frozen=True, init=False)
class Palette(Sequence[Color]):
    """Colors in order, red, green and blue from 0 to 255, and their names; "" for a color without a name.

    A palette is a sequence of its colors, so that it can be the ramp of a surface, the colors of a scale, or
    the values of a key in `grid`, which then names its variants after the colors.

    Any colors are accepted that a surface accepts, in any sequence or array. Names may repeat; without
    `names`, no color has a name. Raises InputError unless there are 1 to 4,096 valid colors, and a valid name
    for each of them or none at all.
    """

    colors: tuple[Color, ...]
    names: tuple[str, ...]

    def __init__(self, colors: Any, names: Iterable[str] = ()) -> None:
        if not isinstance(colors, Iterable):
            raise InputError(f"the colors of a palette must be a sequence, not {shown(colors)}; give a list")
        colors = colors.tolist() if isinstance(colors, np.ndarray) else list(colors)
        names = tuple(names) or ("",) * len(colors)
        if not 1 <= len(colors) <= MOST_COLORS:
            rule = f"a palette must have 1 to {MOST_COLORS:,} colors, not {len(colors):,}"
            raise InputError(f"{rule}; {'choose some of them' if colors else 'add a color'}")
        if len(names) != len(colors):
            raise InputError(
                f"a palette must have a name for each of its {len(colors):,} colors, or no names, not"
                f" {len(names):,}; write '' for a color without a name"
            )
        for number, (color, name) in enumerate(zip(colors, names, strict=True), start=1):
            if problem := _problem_of(color, name):
                raise InputError(f"color {number} of a palette: {problem}")
        vars(self).update(colors=tuple(map(COLOR.accepted, colors)), names=names)

    def __len__(self) -> int:
        return len(self.colors)

    @overload
    def __getitem__(self, key: SupportsIndex) -> Color: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Color, ...]: ...
    def __getitem__(self, key: SupportsIndex | slice) -> Color | tuple[Color, ...]:
        return self.colors[key]

    def color_named(self, name: str) -> Color | None:
        """The first color with this name, in capitals or not; None if no color has this name."""
        folded = [each.casefold() for each in self.names]
        return self.colors[folded.index(name.casefold())] if name and name.casefold() in folded else None


def _problem_of(color: Any, name: Any) -> str:
    """What is wrong with a color or its name; "" if nothing is."""
    try:
        COLOR.accepted(color)
    except (ValueError, TypeError, OverflowError):
        return f"a color {COLOR.rule()}, not {shown(color, 40)}{COLOR.advice(color) or '; correct it'}"
    if isinstance(name, str) and len(name) <= LONGEST_NAME and name.isprintable() and name == name.strip(" "):
        return ""
    rule = f"must be at most {LONGEST_NAME} printable characters in UTF-8, without spaces around them"
    return f"a name {rule}, not {shown(name, 40)}; correct it"


def read_palette(path: str | os.PathLike[str]) -> Palette:
    """The palette of a .csv file, or of a GIMP palette with any ending.

    Raises InputError with the problems and their lines, MissingInputError if there is no such file.
    """
    path = Path(path)
    data = read_bytes(path, LARGEST)
    if path.suffix.lower() == GPL or data.startswith(GIMP.encode()):
        unit, place, rows = "line", path.name, _gpl_rows(data, path.name)
    elif path.suffix.lower() == CSV:
        table = _color_table(data, path.name)
        unit, place, rows = "row", table.place, [*_csv_rows(table)]
    else:
        rule = suffix_rule(path, SUFFIXES)
        raise InputError(f"{path.name or path}: a palette must {rule}; save it as one of these")
    problems = [
        f"{place}, {unit} {number}: {problem}"
        for number, color, name in rows
        if (problem := _problem_of(color, name))
    ]
    if problems:
        raise InputError(problems[:MOST_PROBLEMS])
    try:
        return Palette([color for _, color, _ in rows], [name for _, _, name in rows])
    except InputError as error:
        raise InputError(f"{place}: {error}") from None


def _gpl_rows(data: bytes, place: str) -> list[tuple[int, Any, str]]:
    """The lines, colors and names of a GIMP palette. Its own name and number of columns are not kept."""
    # A name with bytes that are not UTF-8 becomes unprintable.
    text = text_lines(data, place, "a palette").decode("utf-8", "surrogateescape")
    first, *lines = text.split("\n")
    if first.rstrip(" \t") != GIMP:
        raise InputError(f"{place}, line 1: it must be {GIMP!r}, not {shown(first, 40)}; save it by GIMP")
    rows: list[tuple[int, Any, str]] = []
    count = 3
    for number, line in enumerate(lines, start=2):
        if line.startswith(("Name:", "Columns:", "Channels:")):
            count = 4 if line.split() == ["Channels:", "RGBA"] else count
        elif line.strip() and not line.lstrip().startswith("#"):
            words = line.split(None, count)
            color = _components(words[:count])
            # A fourth component that is a number is the transparency.
            color = color[:3] if isinstance(color[-1], int) else color
            rows.append((number, color, "".join(words[count:]).strip()))
    return rows


def _color_table(data: bytes, place: str) -> TextTable:
    """The table of a .csv file. Raises InputError unless its header has the columns of a palette."""
    table = TextTable(data, place, "a palette")
    if sorted({name.lower() for name in table.header} - {"", "name"}) not in (sorted(COMPONENTS), ["color"]):
        columns = shown(", ".join(table.header), 60)
        raise table.wrong(
            f"the columns must be red, green, blue, or color, and perhaps name, not {columns}"
            f" ({table.understood}); name them so"
        )
    return table


def _csv_rows(table: TextTable) -> Iterator[tuple[int, Any, str]]:
    """The rows, colors and names of a table. Raises InputError."""
    for number, cells in table.records():
        values = {name.lower(): cell for name, cell in cells.items()}
        # pandas writes the whole numbers of a column with missing values with a point.
        texts = [values.get(name, "").removesuffix(".0") for name in COMPONENTS]
        yield number, values.get("color", _components(texts)), values.get("name", "")


def _components(texts: Iterable[str]) -> list[int | str]:
    """The components of a color; a text that is no whole number stays as it is."""
    return [int(text) if text.isascii() and text.isdigit() and len(text) < 4 else text for text in texts]


def write_palette(
    path: str | os.PathLike[str],
    palette: Bytes | Sequence[str | Sequence[int]],
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
    if not isinstance(palette, Palette) or names is not None:
        palette = Palette(palette, names or ())
    text = io.StringIO()
    rows = zip(palette.colors, palette.names, strict=True)
    if path.suffix.lower() == GPL:
        text.write(f"{GIMP}\nName: {printable(path.stem).strip() or 'palette'}\n#\n")
        for (red, green, blue), name in rows:
            text.write(f"{red:3} {green:3} {blue:3}\t{name}".rstrip("\t") + "\n")
    else:
        columns = 4 if any(palette.names) else 3
        table = csv.writer(text, lineterminator="\n")
        table.writerow((*COMPONENTS, "name")[:columns])
        table.writerows((*color, name)[:columns] for color, name in rows)
    write_atomically(path, text.getvalue().encode(), overwrite=overwrite)


def check_palette_path(path: Path) -> None:
    """Raise UsageError unless palettes can be written to files with the ending of a path."""
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(f"{path.name}: a palette must {suffix_rule(path, SUFFIXES)}; rename it")


def is_palette(path: Path) -> bool:
    """Whether a file seems to be a palette. Its ending decides; for .csv, its first row decides, too."""
    if path.suffix.lower() == GPL:
        return True
    with suppress(InputError):
        return path.suffix.lower() == CSV and bool(_color_table(read_head(path), path.name).header)
    return False
