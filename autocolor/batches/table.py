"""Tables of variants, from Python, CSV, JSON, or lists of values; and tables of results.

A column is a key, as after `--set`. The columns `name` and `time` are optional.
docs/guides/paint.md has examples.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Final, NamedTuple

from autocolor.arrays import Bytes
from autocolor.checks import brief, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.palette_file import Palette, read_palette
from autocolor.files.paths import LONGEST_STEM, file_stem
from autocolor.files.reading import bounded_json, read_bytes, text_lines
from autocolor.files.text_table import TextTable, value_of_text
from autocolor.immutable import Immutable
from autocolor.scene.columns import REFUSED, Tier
from autocolor.scene.kinds import Number, in_digits

MOST_VARIANTS: Final = 100_000
"""Limit: variants of a batch."""

LARGEST_TABLE: Final = 16 << 20
"""Limit: bytes of a table of variants."""

TIMES: Final = Number(at_least=-1e9, at_most=1e9)
"""The times of variants, in any unit."""

NAME: Final = "name"
TIME: Final = "time"


@dataclass(frozen=True)
class Variant(Immutable):
    """A variant of a scene: a name, the fields that it sets by key, and its time in an animation, if any.

    A key and its value are those of `--set`: `surfaces.body.object_color`, `lights.key.intensity`,
    `view.eye`, `ambient`. A value is plain, or a text as in a scene file. None and "none" unset a field. The
    settings are read-only. Raises UsageError.
    """

    name: str
    settings: Mapping[str, object]
    time: float | None = None

    def __post_init__(self) -> None:
        settings, time = self.settings, self.time
        if not isinstance(self.name, str) or not self.name:
            raise UsageError(
                f"a variant must have a name of at least one character, not {shown(self.name)}; name it"
            )
        if not isinstance(settings, Mapping) or not all(isinstance(key, str) for key in settings):
            raise UsageError(
                f"the settings of a variant must be values by key, not {shown(settings)}; write them as in"
                " {'ambient': 0.2}"
            )
        if time is not None:
            if TIMES.validated(time, (), []) is REFUSED:
                raise UsageError(f"the time of a variant {TIMES.rule()}, not {shown(time)}; correct it")
            vars(self)["time"] = float(time)
        plain = {key: _plain(value) for key, value in settings.items()}
        vars(self)["settings"] = MappingProxyType(plain)

    def __reduce__(self) -> tuple[type[Variant], tuple[str, dict[str, object], float | None]]:
        # A read-only mapping cannot be pickled.
        return Variant, (self.name, dict(self.settings), self.time)


def _plain(value: object) -> object:
    """The value; a palette or a NumPy array as a list, because the text of an array leaves out numbers."""
    if isinstance(value, Palette):
        return [in_digits(color) for color in value]
    return value.tolist() if hasattr(value, "tolist") else value


Rows = Iterable[Variant | Mapping[str, object]]
"""Variants, or tables of values by key, with the optional keys `name` and `time`."""


def variants_of(rows: Rows) -> tuple[Variant, ...]:
    """The variants of some rows, in their order, with a name each. Raises UsageError with the row.

    A variant without a name is named by its values of the keys in which the rows differ. Such a name can be
    the stem of a file. All names are unique, also where files do not distinguish capitals.

    >>> [variant.name for variant in variants_of([{"ambient": 0.1}, {"ambient": 0.2}])]
    ['0.1', '0.2']
    """
    if isinstance(rows, (str, bytes, Mapping, Variant)) or not isinstance(rows, Iterable):
        raise UsageError(
            f"variants must be a list of tables or of Variants, not {shown(rows)}; write them after the"
            " scene, as in [{'ambient': 0.1}, {'ambient': 0.2}]"
        )
    return _named(enumerate(rows, 1))


def _named(rows: Iterable[tuple[int, object]]) -> tuple[Variant, ...]:
    """The variants of some numbered rows. Raises UsageError, with the row, if a row is wrong."""
    variants: list[Variant] = []
    numbers: dict[str, int] = {}
    for number, row in rows:
        try:
            if len(variants) == MOST_VARIANTS:
                raise UsageError(f"a table must have at most {MOST_VARIANTS:,} variants, not more; split it")
            variant = _variant(row)
            name = variant.name.casefold()
            if name != UNNAMED and numbers.setdefault(name, number) != number:
                text = f"not {shown(variant.name)} as in row {numbers[name]}; rename a variant"
                raise UsageError(f"a name must be unique, {text}")
        except UsageError as problem:
            raise UsageError(f"row {number}: {problem}") from None
        variants.append(variant)
    taken = dict.fromkeys(numbers, 1)
    varying = _varying([variant.settings for variant in variants])
    for place, variant in enumerate(variants):
        if variant.name == UNNAMED:
            name = _free(_label(variant.settings, varying, place + 1), taken)
            variants[place] = Variant(name, variant.settings, variant.time)
    return tuple(variants)


UNNAMED: Final = "\0"
"""The name of a variant until it has one."""


def _variant(row: object) -> Variant:
    """The variant of a row, which may be UNNAMED. Raises UsageError."""
    if isinstance(row, Variant):
        return row
    if not isinstance(row, Mapping):
        raise UsageError(
            f"a variant must be a table of values by key, not {shown(row)}; write it as in {{'ambient': 0.2}}"
        )
    settings = {key: value for key, value in row.items() if key not in (NAME, TIME)}
    name = row.get(NAME)
    return Variant(UNNAMED if name is None else name, settings, row.get(TIME))


def _free(name: str, taken: dict[str, int]) -> str:
    """The name if it is not taken, else the name with the first free number from 2: "red-2".

    The names that are taken are without capitals, each with the last number that was added to it.
    """
    free, folded = name, name.casefold()
    while free.casefold() in taken:
        taken[folded] += 1
        free = f"{name[: LONGEST_STEM - 8]}-{taken[folded]}"
    taken[free.casefold()] = 1
    return free


def _varying(settings: Sequence[Mapping[str, object]]) -> dict[str, int]:
    """The keys in which some settings differ, in order of first occurrence, with their places.

    All keys if there are none.
    """
    counts = Counter((key, repr(value)) for row in settings for key, value in row.items())
    keys = dict.fromkeys(key for key, _ in counts)
    same = {key for (key, _), count in counts.items() if count == len(settings)}
    varying = [key for key in keys if key not in same] or keys
    return {key: place for place, key in enumerate(varying)}


def _label(settings: Mapping[str, object], varying: Mapping[str, int], number: int) -> str:
    """The values of some keys as a stem of a file, such as "navy-0.5"; the number if there are no values."""
    keys = sorted(settings.keys() & varying.keys(), key=varying.__getitem__)
    text = "-".join(filter(None, (stem_of(settings[key]) for key in keys)))
    return file_stem(text) if text.strip(" .") else str(number)


LEFT_OUT: Final = str.maketrans(dict.fromkeys("#[]{}\"'")) | {ord("/"): "_", ord("\\"): "_"}
"""The marks of colors, lists and texts, which file names leave out, and of folders, which become "_"."""


def stem_of(value: object) -> str:
    """A plain value, or its text, as a part of a file name, without the marks in LEFT_OUT.

    >>> stem_of("#1f3f8f"), stem_of([4.0, -6, 5]), stem_of('["#200", "#fff"]')
    ('1f3f8f', '4.0,-6,5', '200,fff')
    """
    text = f"{value:.6g}" if isinstance(value, float) else text_of(value)
    return text.translate(LEFT_OUT).replace(", ", ",")


def text_of(value: object) -> str:
    """A plain value as text, as in a cell of a table of variants.

    >>> text_of(0.5), text_of(True), text_of([4.0, -6, 5]), text_of(None)
    ('0.5', 'true', '[4.0, -6, 5]', 'none')
    """
    if isinstance(value, (str, float)):
        return value if isinstance(value, str) else f"{value:.12g}"
    return "none" if value is None else json.dumps(value, default=str, skipkeys=True)


class Result(NamedTuple):
    """The result of a variant: a file, an image or a problem.

    `path` is its file. Without a file, `image` is its picture: the colors, (lines, elements, 3) uint8, or the
    bytes of a file. `problem` says why there is no picture; otherwise it is empty. `seconds` is the time of
    the processor. `tier` is the cost of the edit from the variant before it: FRAME for a first rendering,
    None if nothing had to be edited. `was_made` is false if the file already existed.
    """

    name: str
    settings: Mapping[str, object]
    path: str | None = None
    image: Bytes | bytes | None = None
    problem: str = ""
    seconds: float = 0.0
    tier: Tier | None = None
    was_made: bool = True

    def __reduce__(self) -> tuple[type[Result], tuple[object, ...]]:
        # A read-only mapping cannot be pickled.
        return Result, (self.name, dict(self.settings), *self[2:])


TABLE_BEGINS: Final = b"name,path,"
"""The first bytes of a table of results."""


def results_bytes(results: Sequence[Result]) -> bytes:
    """The results as a CSV table: name, path, a column for each key, seconds, problem."""
    keys = list(dict.fromkeys(key for result in results for key in result.settings))
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow([NAME, "path", *keys, "seconds", "problem"])
    for result in results:
        settings = result.settings
        cells = [text_of(settings[key]) if key in settings else "" for key in keys]
        writer.writerow([result.name, result.path or "", *cells, f"{result.seconds:.4f}", result.problem])
    return text.getvalue().encode("utf-8", "backslashreplace")


def grid(axes: Mapping[str, Iterable[object]]) -> tuple[Variant, ...]:
    """Every combination of values for some keys, as variants; the last key changes fastest.

    `axes` has the values of each key. They may be the colors of a Palette, with their names. Raises
    UsageError for an axis without values, and for too many variants.

        >>> [variant.name for variant in grid({"scaling": ["object", "surface"], "ambient": [0.1, 0.2]})]
        ['object-0.1', 'object-0.2', 'surface-0.1', 'surface-0.2']
    """
    if not isinstance(axes, Mapping):
        raise UsageError(
            f"a grid must be lists of values by key, not {shown(axes)}; write it as in"
            " {'ambient': [0.1, 0.2]}"
        )
    for key, values in axes.items():
        if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
            raise UsageError(
                f"{brief(key)}: an axis must be a list of values or a Palette, not {shown(values)}; write it"
                " as a list"
            )
    return products([variants_of(_rows_of(key, values, {})) for key, values in axes.items()])


def _rows_of(key: str, values: Iterable[object], taken: dict[str, int]) -> Iterator[dict[str, object]]:
    """A row for each value of a key; the rows of a palette have the names of its colors (see `_free`)."""
    if not isinstance(values, Palette):
        yield from ({key: value} for value in values)
        return
    for color, name in zip(values.colors, values.names, strict=True):
        yield {key: in_digits(color), NAME: _free(name, taken) if name else None}


def products(tables: Sequence[Sequence[Variant]]) -> tuple[Variant, ...]:
    """Every combination of a variant of each table, with the settings of all; the last changes fastest.

    A combination is named after the variants of all tables that have several, and has the time of the first
    variant with a time. Raises UsageError if two tables set the same key, if a table is empty, or for too
    many combinations.
    """
    count = math.prod(map(len, tables)) if tables else 0
    if not count or count > MOST_VARIANTS:
        rule = f"must have 1 to {MOST_VARIANTS:,} variants, not {count:,}"
        raise UsageError(f"a grid {rule}; give {'fewer values' if count else 'a value for each key'}")
    check_keys(tables)
    several = [number for number, table in enumerate(tables) if len(table) > 1] or range(len(tables))
    taken: dict[str, int] = {}
    variants = []
    for parts in product(*tables):
        name = "-".join(parts[number].name for number in several)[:LONGEST_STEM]
        settings = {key: value for part in parts for key, value in part.settings.items()}
        time = next((part.time for part in parts if part.time is not None), None)
        variants.append(Variant(_free(name, taken), settings, time))
    return tuple(variants)


def check_keys(tables: Iterable[Iterable[Variant]]) -> None:
    """Raise UsageError if two tables set the same key."""
    seen: set[str] = set()
    for table in tables:
        keys = {key for variant in table for key in variant.settings}
        if both := sorted(keys & seen):
            raise UsageError(f"a key must be in one table or list, not {both[0]!r} in two; leave one out")
        seen |= keys


NUMBER: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
EVENLY: Final = re.compile(rf"\s*({NUMBER})\s*:\s*({NUMBER})\s*:\s*({NUMBER})\s*")

PIECE: Final = re.compile(r""""(?:[^"\\]|\\.)*"?|'[^']*'?|[\[({]|[\])}]|,|[^"'\[({\])},]+""", re.DOTALL)
"""A piece of a list of values: a text in quotes, a bracket, a comma, anything else."""


def varied(text: str) -> tuple[Variant, ...]:
    """The variants of KEY=A,B,C or of KEY=START:STOP:COUNT.

    START:STOP:COUNT are evenly spaced numbers from START to STOP. A value @PALETTE stands for the colors of a
    palette, with their names: a file that `read_palette` reads. Commas in brackets and in quotes do not
    separate values. Raises UsageError, or InputError for a palette.

    >>> [dict(variant.settings) for variant in varied("ambient=0:1:3")]
    [{'ambient': 0.0}, {'ambient': 0.5}, {'ambient': 1.0}]
    >>> [dict(variant.settings) for variant in varied("view.eye=[1,2,3],[4,5,6]")]
    [{'view.eye': '[1,2,3]'}, {'view.eye': '[4,5,6]'}]
    """
    key, equals, values = (part.strip() for part in text.partition("="))
    if not (key and equals and values) or key in (NAME, TIME):
        raise UsageError(
            f"--vary must be KEY=A,B,C or KEY=START:STOP:COUNT, not {shown(text)}; write it as in"
            " surfaces.body.object_color=red,navy"
        )
    taken, rows = dict[str, int](), list[dict[str, object]]()
    if evenly := EVENLY.fullmatch(values):
        start, stop, count = map(float, evenly.groups())
        is_count = count.is_integer() and 2 <= count <= MOST_VARIANTS
        if not (is_count and math.isfinite(start) and math.isfinite(stop)):
            raise UsageError(
                f"--vary {brief(key)}: evenly spaced numbers must be START:STOP:COUNT, finite and with a"
                f" whole COUNT from 2 to {MOST_VARIANTS:,}, not {shown(values)}; correct it"
            )
        shares = [step / (count - 1) for step in range(int(count))]
        return variants_of({key: float(f"{start * (1 - share) + stop * share:.12g}")} for share in shares)
    for value in _split(values, key):
        palette = read_palette(value[1:].strip("\"'")) if value.startswith("@") else None
        rows.extend(_rows_of(key, [value] if palette is None else palette, taken))
    return variants_of(rows)


def _split(text: str, key: str) -> list[str]:
    """The values between the commas that are in no brackets and in no quotes. Raises UsageError."""
    values, depth, value = [], 0, ""
    for piece in PIECE.findall(text):
        depth += (piece in "[({") - (piece in "])}")
        if piece == "," and depth <= 0:
            values.append(value.strip())
            value = ""
        else:
            value += piece
    values.append(value.strip())
    if not all(values):
        raise UsageError(
            f"--vary {brief(key)}: there must be a value before and after each comma, not {shown(text)};"
            " leave a comma out, or write none for a field without a value"
        )
    return values


def read_variants(path: str | PathLike[str]) -> tuple[Variant, ...]:
    """The variants of a table in a file: CSV with a row of keys at the top, or a JSON list of objects.

    Values in CSV are texts as after `--set`, written as `text_table` understands; an empty cell leaves a
    field as it is, and `none` unsets it. Raises InputError with the row, MissingInputError if there is no
    such file, UsageError for another suffix.
    """
    source = Path(path)
    rows_of = {".csv": _csv_rows, ".json": _json_rows}.get(source.suffix.lower())
    if rows_of is None:
        raise UsageError(
            "a table of variants must be a file that ends in .csv or .json, not"
            f" {brief(source.name)}; rename it"
        )
    try:
        variants = _named(rows_of(read_bytes(source, LARGEST_TABLE), source.name))
    except UsageError as problem:
        raise InputError(f"{source.name}, {problem}") from None
    if not variants:
        raise InputError(f"{source.name}: a table must have at least one variant, not none; add a row")
    return variants


def _csv_rows(data: bytes, file: str) -> Iterator[tuple[int, dict[str, object]]]:
    """The rows of a CSV table with their numbers, as in a spreadsheet. Raises InputError."""
    for number, cells in TextTable(data, file, "a table of variants").records():
        row: dict[str, object] = {key: cell for key, cell in cells.items() if cell}
        if TIME in row:
            row[TIME] = value_of_text(cells[TIME])
        yield number, row


def _json_rows(data: bytes, file: str) -> Iterator[tuple[int, object]]:
    """The rows of a JSON table, numbered from 1. Raises InputError."""
    try:
        rows = bounded_json(text_lines(data, file, "a table of variants"), 10 * MOST_VARIANTS)
    except ValueError as error:
        raise InputError(f"{file}: a table must be valid JSON ({error}); correct it") from None
    if not isinstance(rows, list):
        raise InputError(f"{file}: a table in JSON must be a list of objects, not {shown(rows)}")
    return enumerate(rows, 1)
