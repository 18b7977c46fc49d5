"""`autocolor sql`: query and change the tables of a scene with SQL."""

from __future__ import annotations

import csv
import io
import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import as_usage
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.errors import AutocolorError, InputError, UsageError
from ramtek_emu.command_line import SIGNALS, tell
from ramtek_emu.errors import escaped

if TYPE_CHECKING:
    from autocolor.files.scene_report import SceneReport
    from autocolor.files.store.tables import Answer, Tables, Value

EXAMPLES: Final = """\b
Examples:
  autocolor sql scenes/coupe "SELECT name, intensity FROM lights"
  autocolor sql car.obj "SELECT part, count(*) FROM polygons GROUP BY part" --csv
  autocolor sql car.sqlite "UPDATE lights SET intensity = 2 WHERE name = 'key'" --write
  autocolor sql car.sqlite                      ask at a prompt
  autocolor sql car.sqlite < statements.sql     run the statements of a file
"""


@click.command(epilog=EXAMPLES)
@scene_options
@click.argument("statement", required=False)
@click.option("--write", is_flag=True, help="Allow INSERT, UPDATE and DELETE, and save SCENE.")
@click.option("--csv", "form", flag_value="csv", help="Print rows as CSV.")
@click.option("--json", "form", flag_value="json", help="Print rows as a JSON list of objects.")
@click.option(
    "--seconds",
    type=click.FloatRange(0.001, 86400),
    default=30.0,
    show_default=True,
    help="Longest time of a statement.",
)
@click.pass_context
def sql(
    context: click.Context,
    source: SceneSource,
    statement: str | None,
    write: bool,
    form: str | None,
    seconds: float,
) -> None:
    """Run SQL on the tables of SCENE: STATEMENT, or else statements from a prompt or stdin.

    SCENE is a store (.sqlite) or any other scene. `.schema` at the prompt shows the tables; docs/STORE.md
    describes them. A change is checked like a scene file; if it breaks a rule, nothing is changed.
    """
    tables, report = _opened(source, write)
    tables.seconds = seconds
    run = partial(_run, tables, source, write, form)

    with tables:
        if statement is not None:
            run(statement)
        elif reads_from_a_terminal():
            prompt(tables, run)
        else:
            for line in statements_in(sys.stdin):
                run(line)
    context.exit(0 if report is None else ended(report, source))


def _opened(source: SceneSource, write: bool) -> tuple[Tables, SceneReport | None]:
    """The tables of a scene, and the report of its reading; None for a store, which is never repaired."""
    from autocolor.files.store.tables import is_store, open_tables, tables_of

    path = Path(source.path)
    if is_store(path):
        return open_tables(path), None
    if write:
        _refuse_write(path)
    report = read(source)
    return tables_of(report.scene), report


def _refuse_write(path: Path) -> None:
    """Raise UsageError unless a scene can be saved at the path."""
    if path.is_dir() or path.suffix.lower() == ".toml":
        return
    advice = "take its scene out with `autocolor tables --write`"
    if path.suffix.lower() != ".npz":
        advice = "make a scene of it with `autocolor tables --write`, or a store with `autocolor convert`"
    raise UsageError(f"--write must save to a store or to a scene's folder, not to {path}; {advice}")


def _run(tables: Tables, source: SceneSource, write: bool, form: str | None, statement: str) -> None:
    """Run a statement, and print its rows, or the number of changed rows."""
    if not (write and tables.would_change(statement)):
        for line in lines_of(tables.answer(statement), form):
            click.echo(line)
        return
    try:
        count = tables.change(statement)
    except InputError as error:
        with as_usage():
            raise InputError(["nothing was changed", *error.problems]) from None
    click.echo(f"changed {count:,} row{'' if count == 1 else 's'}", err=True)
    if not tables.is_in_a_file:
        from autocolor.files.scene_writing import write_scene_with_tables

        path = Path(source.path)
        tell_written(*map(str, write_scene_with_tables(path, tables.scene(), overwrite=True, complete=False)))


MEASURED: Final = 1000
"""The number of rows that determine the widths of columns; wider cells in later rows are not aligned."""

WIDEST: Final = 60
"""Limit: letters of a cell of a table; longer text is cut."""

ABSENT: Final = "NULL"


def lines_of(answer: Answer, form: str | None) -> Iterator[str]:
    """The lines of an answer as "csv", "json" or a table. Rows are read as the lines are asked for."""
    return {"csv": _csv, "json": _json, None: _table}[form](answer)


def _table(answer: Answer) -> Iterator[str]:
    """The columns and the rows, aligned, with numbers at the right."""
    rows = iter(answer.rows)
    cells = []
    has_number = [False] * len(answer.columns)
    has_other = [False] * len(answer.columns)
    for values in islice(rows, MEASURED):
        cells.append([_cell(value) for value in values])
        for place, value in enumerate(values):
            has_number[place] |= isinstance(value, (int, float))
            has_other[place] |= not isinstance(value, (int, float, type(None)))
    if not answer.columns:
        return
    header = [escaped(name) for name in answer.columns]
    widths = [max(map(len, column)) for column in zip(header, *cells, strict=True)]
    is_number = [number and not other for number, other in zip(has_number, has_other, strict=True)]
    yield _line(header, widths, is_number)
    yield "  ".join("-" * width for width in widths)
    for row in chain(cells, ([_cell(value) for value in values] for values in rows)):
        yield _line(row, widths, is_number)


def _line(cells: Sequence[str], widths: Sequence[int], is_number: Sequence[bool]) -> str:
    placed = [
        cell.rjust(width) if right else cell.ljust(width)
        for cell, width, right in zip(cells, widths, is_number, strict=True)
    ]
    return "  ".join(placed).rstrip()


def _cell(value: Value) -> str:
    if value is None:
        return ABSENT
    text = f"{len(value):,} bytes" if isinstance(value, bytes) else str(value)
    return escaped(text if len(text) <= WIDEST else f"{text[: WIDEST - 3]}...")


def _csv(answer: Answer) -> Iterator[str]:
    """Rows as CSV, NULL as an empty cell."""
    yield _csv_line(answer.columns)
    for row in answer.rows:
        yield _csv_line(["" if value is None else _plain(value) for value in row])


def _csv_line(cells: Sequence[object]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(cells)
    return text.getvalue()


def _json(answer: Answer) -> Iterator[str]:
    """A list of objects, whose keys are the names of columns; a line has an object."""
    opening = "["
    for row in answer.rows:
        values = dict(zip(answer.columns, map(_plain, row), strict=True))
        yield f"{opening}{json.dumps(values, ensure_ascii=False)}"
        opening = ","
    yield "[]" if opening == "[" else "]"


def _plain(value: Value) -> object:
    """The value for JSON and CSV: infinite numbers and bytes become text."""
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, float) and value - value != 0:
        return str(value)
    return value


GREETING: Final = "statements end with ;   .tables   .schema [TABLE]   .help   .quit, or Ctrl+D"
FIRST: Final = "sql> "
NEXT: Final = "...> "

MOST_LETTERS: Final = 1 << 20
"""Limit: letters of a statement."""

_PIECES: Final = re.compile(
    r"""'[^']*(?:'|\Z)|"[^"]*(?:"|\Z)|`[^`]*(?:`|\Z)|\[[^]]*(?:]|\Z)|--[^\n]*|/\*.*?(?:\*/|\Z)|;""", re.DOTALL
)
"""Semicolons, and strings, names and comments, which may contain semicolons."""


def prompt(tables: Tables, run: Callable[[str], None]) -> None:
    """Run typed statements until Ctrl+D or `.quit`; Ctrl+C deletes the typed text or stops a statement."""
    with suppress(ImportError):
        # With readline the user can edit lines, and the arrow keys bring earlier lines back.
        import readline  # noqa: F401
    click.echo(GREETING, err=True)
    text = ""
    SIGNALS.cancels = True
    try:
        while True:
            try:
                line = input(NEXT if text else FIRST)
                if not text and line.strip() in (".quit", ".exit"):
                    return
                if not text and _dotted(line, tables):
                    continue
                whole, text = split(f"{text}{line}\n")
                for statement in whole:
                    run(statement)
            except EOFError:
                click.echo(err=True)
                return
            except KeyboardInterrupt:
                if SIGNALS.ended is not None:
                    raise
                text = ""
                click.echo("canceled; Ctrl+D ends", err=True)
            except AutocolorError as error:
                tell(*(f"autocolor: {problem}" for problem in error.problems))
    finally:
        SIGNALS.cancels = False


def _dotted(line: str, tables: Tables) -> bool:
    """Run a command that begins with a dot; returns False for a line of SQL."""
    words = line.split()
    if not words:
        return True
    if not words[0].startswith("."):
        return False
    if words[0] == ".tables":
        tell(*tables.names, err=False)
    elif words[0] == ".schema":
        for name in words[1:] or tables.names:
            tell(*tables.definition(name).split("\n"), err=False)
    else:
        click.echo(GREETING, err=True)
    return True


def statements_in(lines: Iterable[str]) -> Iterator[str]:
    """The statements in some lines. The last statement may lack its semicolon.

    Raises UsageError for a line that is not text in UTF-8.
    """
    text = ""
    try:
        for line in lines:
            text += line
            if ";" in line:
                whole, text = split(text)
                yield from whole
            if len(text) > MOST_LETTERS:
                break
    except UnicodeDecodeError:
        raise UsageError("statements must be text in UTF-8; save them in this encoding") from None
    if text.strip():
        yield text


def split(text: str) -> tuple[list[str], str]:
    """The complete statements of a text, with their semicolons, and the rest of the text.

    >>> split("SELECT ';'; SELECT 2; SELECT")
    (["SELECT ';';", ' SELECT 2;'], ' SELECT')
    """
    whole = []
    begin = 0
    for piece in _PIECES.finditer(text):
        if piece[0] == ";":
            whole.append(text[begin : piece.end()])
            begin = piece.end()
    rest = text[begin:]
    return whole, rest if rest.strip() else ""


def reads_from_a_terminal() -> bool:
    """Whether stdin is a terminal, where a user types the statements."""
    return sys.stdin is not None and sys.stdin.isatty()
