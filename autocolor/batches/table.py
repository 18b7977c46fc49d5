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
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from numbers import Real
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from autocolor.arrays import Bytes
from autocolor.checks import brief, shown
from autocolor.errors import InputError, UsageError
from autocolor.files.palette_file import read_palette
from autocolor.files.paths import LONGEST_STEM, file_stem
from autocolor.files.reading import bounded_json, read_bytes, text_lines
from autocolor.files.text_table import TextTable
from autocolor.immutable import Immutable
from autocolor.scene.columns import Tier
from autocolor.scene.kinds import in_digits

MOST_VARIANTS: Final = 100_000
"""Limit: variants of a batch."""

MOST_KEYS: Final = 256
"""Limit: keys of a variant."""

LARGEST_TABLE: Final = 16 << 20
"""Limit: bytes of a table of variants."""

MOST_JSON_VALUES: Final = 1_000_000
"""Limit: values in a table in JSON."""

LATEST: Final = 1e9
"""Limit: a time, in size."""

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
        if len(settings) > MOST_KEYS:
            raise UsageError(
                f"a variant must have at most {MOST_KEYS} keys, not {len(settings):,}; leave keys out"
            )
        if time is not None:
            # A whole number may be too large for a float.
            is_number = isinstance(time, Real) and not isinstance(time, bool)
            if not is_number or not abs(time) <= LATEST:
                raise UsageError(
                    f"the time of a variant must be a number of at most {LATEST:g} in size, not"
                    f" {shown(time)}; correct it"
                )
            vars(self)["time"] = float(time)
        # The text of a NumPy array leaves out digits and, of a long array, numbers.
        plain = {
            key: value.tolist() if hasattr(value, "tolist") else value for key, value in settings.items()
        }
        vars(self)["settings"] = MappingProxyType(plain)

    def __reduce__(self) -> tuple[type[Variant], tuple[str, dict[str, object], float | None]]:
        # A read-only mapping cannot be pickled.
        return Variant, (self.name, dict(self.settings), self.time)


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
            f"variants must be a list of tables or of Variants, not {shown(rows)}; write them as in"
            " [{'ambient': 0.1}, {'ambient': 0.2}]"
        )
    given = islice(rows, MOST_VARIANTS + 1)
    return _named([_row(row, f"row {number}") for number, row in enumerate(given, 1)], UsageError)


class _Row(NamedTuple):
    """A row of a table; its name is None if it has none."""

    place: str
    name: object
    settings: Mapping[str, object]
    time: Any


def _row(row: object, place: str) -> _Row:
    """The row of a Variant or of a table. Raises UsageError for anything else."""
    if isinstance(row, Variant):
        return _Row(place, row.name, row.settings, row.time)
    if not isinstance(row, Mapping):
        raise UsageError(f"{place}: a variant must be a table of values by key, not {shown(row)}")
    settings = {key: value for key, value in row.items() if key not in (NAME, TIME)}
    return _Row(place, row.get(NAME), settings, row.get(TIME))


def _named(rows: Sequence[_Row], error: type[UsageError | InputError], file: str = "") -> tuple[Variant, ...]:
    """The variants of some rows. Raises `error`, with the row, if a row is wrong or there are too many."""
    if len(rows) > MOST_VARIANTS:
        text = f"a table must have at most {MOST_VARIANTS:,} variants, not more; split it"
        raise error(f"{file}: {text}" if file else text)
    within, names = f"{file}, " if file else "", _Names()
    for row in rows:
        if isinstance(row.name, str):
            other = names.places.setdefault(row.name.casefold(), row.place)
            if other != row.place:
                text = f"a name must be unique, not {shown(row.name)} as in {other}; rename a variant"
                raise error(f"{within}{row.place}: {text}")
    varying = _varying([row.settings for row in rows])
    variants = []
    for number, row in enumerate(rows, 1):
        name = names.free(_label(row.settings, varying, number)) if row.name is None else row.name
        try:
            variants.append(Variant(name, row.settings, row.time))  # type: ignore[arg-type]
        except UsageError as problem:
            raise error(f"{within}{row.place}: {problem}") from None
    return tuple(variants)


class _Names:
    """Names in use, in lower case, with their places."""

    def __init__(self) -> None:
        self.places: dict[str, str] = {}
        self._numbers: dict[str, int] = {}

    def free(self, name: str) -> str:
        """The name if it is not in use, else the name with the first free number from 2: "red-2"."""
        free = name
        while free.casefold() in self.places:
            number = self._numbers.get(name, 1) + 1
            self._numbers[name] = number
            free = f"{name[: LONGEST_STEM - 8]}-{number}"
        self.places[free.casefold()] = ""
        return free


def _varying(settings: Sequence[Mapping[str, object]]) -> dict[str, int]:
    """The keys in which some settings differ, in order of first occurrence, with their places.

    All keys if there are none.
    """
    firsts: dict[str, str] = {}
    counts: Counter[str] = Counter()
    differing: set[str] = set()
    for row in settings:
        counts.update(row.keys())
        for key, value in row.items():
            if firsts.setdefault(key, repr(value)) != repr(value):
                differing.add(key)
    varying = [key for key in firsts if key in differing or counts[key] < len(settings)]
    return {key: place for place, key in enumerate(varying or firsts)}


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
    ('1f3f8f', '4,-6,5', '200,fff')
    """
    text = f"{value:.6g}" if isinstance(value, float) else text_of(value)
    return text.translate(LEFT_OUT).replace(", ", ",")


def text_of(value: object) -> str:
    """A plain value as text, as `--set` reads it but shorter.

    >>> text_of(0.5), text_of(True), text_of([4.0, -6, 5]), text_of(None)
    ('0.5', 'true', '4,-6,5', 'none')
    """
    if value is None or isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.12g}"
    if isinstance(value, Mapping):
        return ",".join(f"{key}={text_of(inner)}" for key, inner in value.items())
    if isinstance(value, (list, tuple)):
        return ",".join(map(text_of, value))
    return str(value)


# Results.


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
        cells = [_cell(settings[key]) if key in settings else "" for key in keys]
        writer.writerow([result.name, result.path or "", *cells, f"{result.seconds:.4f}", result.problem])
    return text.getvalue().encode("utf-8", "backslashreplace")


def _cell(value: object) -> str:
    """A value as a cell of a table of variants."""
    is_nested = isinstance(value, (list, tuple, Mapping))
    return json.dumps(value, default=repr) if is_nested else text_of(value)


# Grids.


def grid(axes: Mapping[str, Iterable[object]]) -> tuple[Variant, ...]:
    """Every combination of values for some keys, as variants; the last key changes fastest.

    Raises UsageError for an axis without values, and for too many variants.

        >>> [variant.name for variant in grid({"scaling": ["object", "surface"], "ambient": [0.1, 0.2]})]
        ['object-0.1', 'object-0.2', 'surface-0.1', 'surface-0.2']
    """
    if not isinstance(axes, Mapping):
        raise UsageError(
            f"a grid must be lists of values by key, not {shown(axes)}; write it as in"
            " {'ambient': [0.1, 0.2]}"
        )
    return products([_axis(key, values) for key, values in axes.items()])


def _axis(key: str, values: Iterable[object]) -> tuple[Variant, ...]:
    """The variants with each of some values for a key."""
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
        raise UsageError(
            f"{brief(key)}: an axis must be a list of values, not {shown(values)}; write it as a list"
        )
    return variants_of([{key: value} for value in islice(values, MOST_VARIANTS + 1)])


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
    names = _Names()
    variants = []
    for parts in product(*tables):
        name = "-".join(parts[number].name for number in several)[:LONGEST_STEM]
        settings = {key: value for part in parts for key, value in part.settings.items()}
        time = next((part.time for part in parts if part.time is not None), None)
        variants.append(Variant(names.free(name), settings, time))
    return tuple(variants)


def check_keys(tables: Iterable[Iterable[Variant]]) -> None:
    """Raise UsageError if two tables set the same key."""
    seen: set[str] = set()
    for table in tables:
        keys = {key for variant in table for key in variant.settings}
        if both := sorted(keys & seen):
            raise UsageError(f"a key must be in one table or list, not {both[0]!r} in two; leave one out")
        seen |= keys


# The text of `--vary`.

NUMBER: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
EVENLY: Final = re.compile(rf"\s*({NUMBER})\s*:\s*({NUMBER})\s*:\s*({NUMBER})\s*")

PIECE: Final = re.compile(r""""(?:[^"\\]|\\.)*"?|'[^']*'?|[\[({]|[\])}]|,|[^"'\[({\])},]+""", re.DOTALL)
"""A piece of a list of values: a text in quotes, a bracket, a comma, anything else."""

LONGEST_LIST: Final = 1 << 20
"""Limit: letters of a list of values."""


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
    if not (key and equals and values) or key in (NAME, TIME) or len(values) > LONGEST_LIST:
        raise UsageError(
            f"--vary must be KEY=A,B,C or KEY=START:STOP:COUNT, not {shown(text)}; write it as in"
            " surfaces.body.object_color=red,navy"
        )
    evenly = EVENLY.fullmatch(values)
    if evenly is None:
        names, rows = _Names(), list[dict[str, object]]()
        for value in _split(values, key):
            rows += _of_palette(key, value[1:], names) if value.startswith("@") else [{key: value}]
        return variants_of(rows)
    start, stop, count = map(float, evenly.groups())
    is_count = count.is_integer() and 2 <= count <= MOST_VARIANTS
    if not (is_count and math.isfinite(start) and math.isfinite(stop)):
        raise UsageError(
            f"--vary {brief(key)}: evenly spaced numbers must be START:STOP:COUNT, finite and with a whole"
            f" COUNT from 2 to {MOST_VARIANTS:,}, not {shown(values)}; correct it"
        )
    shares = [step / (count - 1) for step in range(int(count))]
    return variants_of([{key: float(f"{start * (1 - share) + stop * share:.12g}")} for share in shares])


def _of_palette(key: str, path: str, names: _Names) -> list[dict[str, object]]:
    """The rows with each color of a palette, by the names of the colors. Raises InputError."""
    palette = read_palette(path.strip("\"'"))
    rows: list[dict[str, object]] = []
    for name, color in zip(palette.names, map(tuple, palette.colors.tolist()), strict=True):
        rows.append({key: in_digits(color), **({NAME: names.free(name)} if name else {})})
    return rows


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


# Tables in files.


def read_variants(path: str | PathLike[str]) -> tuple[Variant, ...]:
    """The variants of a table in a file: CSV with a row of keys at the top, or a JSON list of objects.

    Values in CSV are texts as after `--set`, written as `text_table` understands; an empty cell leaves a
    field as it is, and `none` unsets it. Raises InputError with the row, MissingInputError if there is no
    such file, UsageError for another suffix.
    """
    source = Path(path)
    read = READERS.get(source.suffix.lower())
    if read is None:
        raise UsageError(
            "a table of variants must be a file that ends in .csv or .json, not"
            f" {brief(source.name)}; rename it"
        )
    rows = list(islice(read(read_bytes(source, LARGEST_TABLE), source.name), MOST_VARIANTS + 1))
    if not rows:
        raise InputError(f"{source.name}: a table must have at least one variant, not none; add a row")
    return _named(rows, InputError, source.name)


def _csv_rows(data: bytes, file: str) -> Iterator[_Row]:
    """The rows of a CSV table; rows count from 1, as in a spreadsheet. Raises InputError."""
    table = TextTable(data, file, "a table of variants")
    if len(table.header) - table.header.count("") > MOST_KEYS + 2:
        raise table.wrong(f"a table must have at most {MOST_KEYS} keys, not more; leave keys out")
    for number, cells in table.records():
        row = {key: cell for key, cell in cells.items() if cell}
        name, time = row.pop(NAME, None), row.pop(TIME, None)
        yield _Row(f"row {number}", name, row, None if time is None else _time(time))


def _time(text: str) -> float | str:
    """The number in a text. A text without a number is returned as it is, and `Variant` refuses it."""
    return float(text) if re.fullmatch(NUMBER, text) else text


def _json_rows(data: bytes, file: str) -> Iterator[_Row]:
    """The rows of a JSON table. Raises InputError."""
    try:
        rows = bounded_json(text_lines(data, file, "a table of variants"), MOST_JSON_VALUES)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: a table must be valid JSON ({error}); correct it") from None
    if not isinstance(rows, list):
        raise InputError(f"{file}: a table in JSON must be a list of objects, not {shown(rows)}")
    for number, row in enumerate(rows, 1):
        try:
            yield _row(row, f"row {number}")
        except UsageError as problem:
            raise InputError(f"{file}, {problem}") from None


READERS: Final[Mapping[str, Callable[[bytes, str], Iterator[_Row]]]] = {
    ".csv": _csv_rows,
    ".json": _json_rows,
}
"""The readers of tables, by the suffix of their files."""
