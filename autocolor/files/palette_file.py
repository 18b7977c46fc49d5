"""Palette files: colors, some with names, to and from other programs.

A palette is the entries of a surface's range, or a list of named paints. Names may repeat.

- .gpl, a GIMP palette: any colors, with names. Written in UTF-8.
- .csv, a table: the columns red, green and blue from 0 to 255, or the column color as "#rrggbb" or by name;
  and perhaps the column name. Written as `red,green,blue`, and `name` if a color has a name.
- .act, Adobe's color table: at most 256 colors, without names. Written with 772 bytes. The last four bytes
  are the number of colors and the mark of no transparent color.

Transparency is not modeled: the transparent color of an .act file is a color like the others.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color, printable, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.formats import Format, format_named, recognized, suffix_rule, suffixes_of
from autocolor.files.meshes.number_text import Problems
from autocolor.files.reading import UTF_8_MARK, read_bytes, read_head, status_of, text_lines, utf_8_text
from autocolor.files.writing import write_atomically
from autocolor.immutable import Immutable, read_only
from autocolor.scene.kinds import ColorKind

MOST_COLORS: Final = 4096
"""Limit: the colors of a palette. The largest lists of paints have some two thousand."""

LONGEST_NAME: Final = 100
"""Limit: letters of a name, which fit in two lines of a message."""

LARGEST: Final = 1 << 20
"""Limit: the bytes of a palette file. MOST_COLORS with names of LONGEST_NAME letters take half of it."""

NAME_RULE: Final = f"must be at most {LONGEST_NAME} printable characters, without spaces around them"

COLOR: Final = ColorKind()


ColorsGiven = Bytes | Sequence[str | Sequence[int]]
"""Colors as an array (n, 3) uint8, or as texts such as "#b01020" and sequences of three whole numbers."""


@dataclass(frozen=True, repr=False, eq=False, init=False)
class Palette(Immutable):
    """Colors in order, (n, 3) uint8, read-only, and their names, n texts; "" for a color without a name.

    Names may repeat; without `names`, no color has a name. Raises InputError unless there are 1 to 4,096
    valid colors, and a valid name for each of them or none at all.
    """

    colors: Bytes
    names: tuple[str, ...]

    def __init__(self, colors: ColorsGiven, names: Iterable[str] = ()) -> None:
        array = _validated(colors)
        names = ((names,) if isinstance(names, str) else tuple(names)) or ("",) * len(array)
        if len(names) != len(array):
            raise InputError(
                f"a palette must have a name for each of its {len(array):,} colors, or no names, not"
                f" {len(names):,}; write '' for a color without a name"
            )
        for number, name in enumerate(names, start=1):
            if not is_name(name):
                raise InputError(f"name {number} of a palette {NAME_RULE}, not {shown(name)}; correct it")
        vars(self).update(colors=array, names=names)

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


def count_problem(count: int) -> str:
    """The sentence that refuses a palette with so many colors."""
    advice = "choose some of them" if count else "add a color"
    return f"a palette must have 1 to {MOST_COLORS:,} colors, not {count:,}; {advice}"


def is_name(name: object) -> bool:
    """Whether a value can be the name of a color, or "" for none."""
    return (
        isinstance(name, str) and len(name) <= LONGEST_NAME and name.isprintable() and name == name.strip(" ")
    )


def _validated(colors: Any) -> Bytes:
    """The colors as an array of their own, (n, 3) uint8, read-only. Raises InputError."""
    if isinstance(colors, np.ndarray) and colors.dtype == np.uint8:
        if colors.ndim != 2 or colors.shape[1] != 3:
            raise InputError(
                f"the colors of a palette must be an array (n, 3), not {colors.shape}; give a row for each"
            )
        array = np.array(colors)
    else:
        array = np.array(list(_accepted(colors)), np.uint8).reshape(-1, 3)
    if not 1 <= len(array) <= MOST_COLORS:
        raise InputError(count_problem(len(array)))
    return read_only(array)


def _accepted(colors: Any) -> Iterable[Color]:
    """The colors that some values describe. Raises InputError."""
    try:
        values = [colors] if isinstance(colors, str) else list(colors)
    except TypeError:
        raise InputError(
            f"the colors of a palette must be a sequence of colors, not {shown(colors)}; give a list"
        ) from None
    for number, value in enumerate(values, start=1):
        try:
            yield COLOR.accepted(value)
        except (ValueError, TypeError, OverflowError):
            advice = COLOR.advice(value) or "; correct it"
            raise InputError(
                f"color {number} of a palette {COLOR.rule()}, not {shown(value)}{advice}"
            ) from None


def read_palette(path: str | os.PathLike[str]) -> Palette:
    """The palette of a .gpl, .csv or .act file; `.colors` is (n, 3) uint8, `.names` has n texts.

    Raises InputError with the problems and their lines, MissingInputError if there is no such file.
    """
    path = Path(path)
    status_of(path)
    palette_format = recognized(path, PALETTE_FORMATS)
    if palette_format is None:
        raise InputError(
            f"{path.name or path}: a palette must {suffix_rule(path, SUFFIXES)}; save it as one of these"
        )
    return palette_format.read(read_bytes(path, LARGEST), path.name)


def write_palette(
    path: str | os.PathLike[str],
    palette: Palette | ColorsGiven,
    *,
    names: Iterable[str] | None = None,
    overwrite: bool = False,
) -> None:
    """Write a palette, or colors with or without `names`, to a .gpl, .csv or .act file, atomically.

        autocolor.write_palette("ramp.gpl", ["#200", "#f60", "#fff"], names=["low", "middle", "high"])

    `read_palette` gives back the same palette. Raises UsageError for another ending, and for names or more
    than 256 colors in an .act file; InputError for invalid colors and names; OutputError if the file exists
    and `overwrite` is false, or if it cannot be created; WriteError if writing fails.
    """
    path = Path(path)
    palette_format = check_palette_path(path)
    if not isinstance(palette, Palette):
        palette = Palette(palette, names or ())
    elif names is not None:
        palette = Palette(palette.colors, names)
    write_atomically(path, palette_format.written(palette, path), overwrite=overwrite)


def check_palette_path(path: Path) -> PaletteFormat:
    """The format in which a palette is written to a path. Raises UsageError for an unknown ending."""
    palette_format = format_named(path, PALETTE_FORMATS)
    if palette_format is None:
        raise UsageError(f"{path.name}: a palette must {suffix_rule(path, SUFFIXES)}; rename it")
    return palette_format


def is_palette(path: Path) -> bool:
    """Whether a file seems to be a palette. Its ending decides; for .csv, its first row decides, too."""
    palette_format = format_named(path, PALETTE_FORMATS)
    if palette_format is None or palette_format.suffixes != (CSV,):
        return palette_format is not None
    head = read_head(path).removeprefix(UTF_8_MARK).decode("utf-8", "replace")
    return _are_columns(re.split("[\r\n]", head)[0].lower().replace('"', "").split(","))


# The GIMP palette: a line for each color, its red, green, blue and name. The header may give the palette a
# name and a number of columns, which are not kept.

GPL: Final = ".gpl"
GIMP: Final = "GIMP Palette"
GIMP_HEADER: Final = re.compile(r"(?:Name|Columns):.*")
GIMP_COLOR: Final = re.compile(
    r"[ \t]*([0-9]{1,3})[ \t]+([0-9]{1,3})[ \t]+([0-9]{1,3})(?:[ \t]+(.*))?", re.DOTALL
)
COMPONENT_RULE: Final = "must be a whole number from 0 to 255"


def _begins_as_gpl(head: bytes) -> bool:
    return head.removeprefix(UTF_8_MARK).startswith(GIMP.encode())


def _read_gpl(data: bytes, place: str) -> Palette:
    lines = _text(data, place).split("\n")
    if lines[0].rstrip(" \t") != GIMP:
        raise InputError(f"{place}, line 1: it must be {GIMP!r}, not {shown(lines[0], 40)}; save it by GIMP")
    problems = Problems("line")
    colors: list[tuple[int, ...]] = []
    names: list[str] = []
    for number, line in enumerate(lines[1:], start=2):
        if line.isspace() or not line or line.lstrip(" \t").startswith("#"):
            continue
        if not colors and GIMP_HEADER.fullmatch(line):
            continue
        match = GIMP_COLOR.fullmatch(line)
        if match is None:
            problems.note(
                place,
                number,
                f"a color must be red, green, blue and perhaps a name, not {shown(line, 40)}; correct it",
            )
            continue
        *components, name = match.groups(default="")
        colors.append(_components(problems, place, number, components))
        names.append(_name(problems, place, number, name))
    return _palette(problems, place, colors, names)


def _gpl_of(palette: Palette, path: Path) -> bytes:
    title = printable(path.stem).strip() or "palette"
    lines = [GIMP, f"Name: {title}", "#"]
    for color, name in zip(palette.colors.tolist(), palette.names, strict=True):
        lines.append(" ".join(f"{component:3}" for component in color) + (f"\t{name}" if name else ""))
    return "\n".join([*lines, ""]).encode()


# The table: columns in any order, cells separated by commas. Empty rows are skipped.

CSV: Final = ".csv"
RED_GREEN_BLUE: Final = ("red", "green", "blue")
COLOR_COLUMN: Final = ("color",)
NAME: Final = "name"


def _are_columns(cells: Sequence[str]) -> bool:
    """Whether these are the names of the columns of a palette, with or without names."""
    columns = sorted(cell.strip() for cell in cells)
    return any(
        columns == sorted((*needed, *more))
        for needed in (RED_GREEN_BLUE, COLOR_COLUMN)
        for more in ((), (NAME,))
    )


def _read_csv(data: bytes, place: str) -> Palette:
    problems = Problems("row")
    colors: list[tuple[int, ...]] = []
    names: list[str] = []
    columns: list[str] = []
    row = 0
    try:
        for row, cells in enumerate(csv.reader(io.StringIO(_text(data, place), ""), strict=True), start=1):
            if row == 1:
                columns = [cell.strip().lower() for cell in cells]
                if not _are_columns(columns):
                    raise InputError(
                        f"{place}, row 1: the columns must be red, green, blue, or color, and perhaps name,"
                        f" not {shown(','.join(columns), 60)}; name them so"
                    )
            elif any(cells):
                color, name = _read_row(problems, place, row, columns, [cell.strip() for cell in cells])
                colors.append(color)
                names.append(name)
    except csv.Error as error:
        raise InputError(f"{place}, row {row + 1}: it must be CSV ({error}); correct the row") from None
    return _palette(problems, place, colors, names)


def _read_row(
    problems: Problems, place: str, row: int, columns: Sequence[str], cells: Sequence[str]
) -> tuple[tuple[int, ...], str]:
    """The color and the name of a row. Problems are noted."""
    if len(cells) != len(columns):
        problems.note(place, row, f"a row must have {len(columns)} cells, not {len(cells)}; correct it")
        return (0, 0, 0), ""
    values = dict(zip(columns, cells, strict=True))
    name = _name(problems, place, row, values.get(NAME, ""))
    if "red" in values:
        return _components(problems, place, row, [values[column] for column in RED_GREEN_BLUE]), name
    text = values["color"]
    try:
        return COLOR.accepted(text), name
    except (ValueError, TypeError):
        advice = COLOR.advice(text) or "; correct it"
        problems.note(place, row, f"a color {COLOR.rule()}, not {shown(text, 40)}{advice}")
        return (0, 0, 0), name


def _csv_of(palette: Palette, _: Path) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    has_names = any(palette.names)
    writer.writerow([*RED_GREEN_BLUE, *([NAME] if has_names else [])])
    for color, name in zip(palette.colors.tolist(), palette.names, strict=True):
        writer.writerow([*color, *([name] if has_names else [])])
    return text.getvalue().encode()


# Adobe's color table: the bytes of 256 colors; then perhaps the number of colors in use and the number of the
# transparent color, in two bytes each, the high byte first. 65535 is no transparent color.

ACT: Final = ".act"
ACT_COLORS: Final = 256
ACT_SIZES: Final = (3 * ACT_COLORS, 3 * ACT_COLORS + 4)


def _read_act(data: bytes, place: str) -> Palette:
    if len(data) not in ACT_SIZES:
        raise InputError(
            f"{place}: an .act file must have {ACT_SIZES[0]} or {ACT_SIZES[1]} bytes, not {len(data):,};"
            " save it again"
        )
    count = ACT_COLORS
    if len(data) > ACT_SIZES[0]:
        count = int.from_bytes(data[ACT_SIZES[0] :][:2], "big")
        if not 1 <= count <= ACT_COLORS:
            raise InputError(
                f"{place}: the number of colors, bytes 768 and 769, must be 1 to {ACT_COLORS}, not {count:,};"
                " save it again"
            )
    return Palette(np.frombuffer(data[: 3 * count], np.uint8).reshape(-1, 3))


def _act_of(palette: Palette, path: Path) -> bytes:
    if len(palette) > ACT_COLORS:
        raise UsageError(
            f"{path.name}: an .act file must hold at most {ACT_COLORS} colors, not {len(palette):,}; write a"
            " .gpl or .csv file"
        )
    if any(palette.names):
        raise UsageError(
            f"{path.name}: an .act file must hold colors without names; write a .gpl or .csv file, or leave"
            " the names out"
        )
    return palette.colors.tobytes().ljust(ACT_SIZES[0], b"\0") + len(palette).to_bytes(2, "big") + b"\xff\xff"


# What the two formats of text share.


def _text(data: bytes, place: str) -> str:
    """The text of a palette file, with lines that end with LF. Raises InputError."""
    return utf_8_text(text_lines(data, place, "a palette"), place, "a palette")


def _components(problems: Problems, place: str, line: int, texts: Sequence[str]) -> tuple[int, ...]:
    """Red, green and blue. Problems are noted."""
    components = []
    for name, text in zip(RED_GREEN_BLUE, texts, strict=True):
        is_number = re.fullmatch("[0-9]{1,3}", text) is not None and int(text) <= 255
        if not is_number:
            problems.note(place, line, f"{name} {COMPONENT_RULE}, not {shown(text, 40)}; correct it")
        components.append(int(text) if is_number else 0)
    return tuple(components)


def _name(problems: Problems, place: str, line: int, text: str) -> str:
    """A name without spaces around it. Problems are noted."""
    name = text.strip(" \t")
    if is_name(name):
        return name
    problems.note(place, line, f"a name {NAME_RULE}, not {shown(name, 40)}; correct it")
    return ""


def _palette(
    problems: Problems, place: str, colors: Sequence[tuple[int, ...]], names: Sequence[str]
) -> Palette:
    """The palette of a file, unless there were problems. Raises InputError."""
    problems.raise_any()
    if not 1 <= len(colors) <= MOST_COLORS:
        raise InputError(f"{place}: {count_problem(len(colors))}")
    return Palette(np.array(colors, np.uint8), names)


@dataclass(frozen=True)
class PaletteFormat(Format):
    """A format of palettes: its reader, from the bytes and the name of a file, and its writer."""

    read: Callable[[bytes, str], Palette]
    written: Callable[[Palette, Path], bytes]


PALETTE_FORMATS: Final = (
    PaletteFormat("GIMP palette", (GPL,), _read_gpl, _gpl_of, begins=_begins_as_gpl),
    PaletteFormat("CSV palette", (CSV,), _read_csv, _csv_of),
    PaletteFormat("Adobe color table", (ACT,), _read_act, _act_of),
)
"""All palette formats. A new format is its reader, its writer, and its row here."""

SUFFIXES: Final = suffixes_of(PALETTE_FORMATS)
