"""`autocolor sql`: query and change the tables of a scene with SQL."""

from __future__ import annotations

import csv
import json
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain, islice
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options import flag
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.errors import AutocolorError, InputError, UsageError
from ramtek_emu.command_line import SIGNALS, tell
from ramtek_emu.errors import escaped

if TYPE_CHECKING:
    from autocolor.files.store.tables import Tables, Value

EXAMPLES: Final = """\b
Examples:
  autocolor sql scenes/coupe "SELECT name, intensity FROM lights"
  autocolor sql car.obj "SELECT part, count(*) FROM polygons GROUP BY part" --csv
  autocolor sql car.sqlite "UPDATE lights SET intensity = 2 WHERE name = 'key'" --write
  autocolor sql car.sqlite                      ask at a prompt
  autocolor sql car.sqlite < statements.sql     run the statements of a file
"""


@click.command(epilog=EXAMPLES)
@scene_options()
@click.argument("statement", required=False)
@flag("--write", "Allow INSERT, UPDATE and DELETE, and save SCENE.")
@click.option("--csv", "form", flag_value="csv", help="Print rows as CSV.")
@click.option("--json", "form", flag_value="json", help="Print rows as a JSON list of objects.")
@click.option(
    "--seconds",
    type=click.FloatRange(0.001, 86400),
    default=30.0,
    help="Longest time of a statement.",
)
def sql(source: SceneSource, statement: str | None, write: bool, form: str | None, seconds: float) -> int:
    """Run SQL on the tables of SCENE: STATEMENT, or else statements from a prompt or stdin.

    SCENE is a store (.sqlite) or any other scene. `.schema` at the prompt shows the tables; docs/STORE.md
    describes them. A change is checked like a scene file; if it breaks a rule, nothing is changed.
    """
    from autocolor.files.store.tables import is_store, open_tables, tables_of

    # A store is never repaired, and has no report.
    path, report = Path(source.path), None
    if is_store(path):
        tables = open_tables(path)
    elif write and not (path.is_dir() or path.suffix.lower() == ".toml"):
        raise UsageError(
            f"--write must save to a store or to a scene's folder, not to {path}; make a scene of it with"
            " `autocolor tables --write`"
        )
    else:
        report = read(source)
        tables = tables_of(report.scene)
    tables.seconds = seconds
    run = partial(_run, tables, source, write, form)

    with tables:
        if statement is not None:
            run(statement)
        elif sys.stdin is not None and sys.stdin.isatty():
            prompt(tables, run)
        else:
            try:
                text = sys.stdin.read() if sys.stdin else ""
            except UnicodeDecodeError:
                raise UsageError("statements must be text in UTF-8; save them in this encoding") from None
            for each in filter(None, split(text)):
                run(each)
    return 0 if report is None else ended(report, source)


def _run(tables: Tables, source: SceneSource, write: bool, form: str | None, statement: str) -> None:
    """Run a statement, and print its rows, or the number of changed rows."""
    from autocolor.files.store.tables import ChangeError, is_store

    try:
        for line in lines_of(*tables.answer(statement), form):
            click.echo(line)
        return
    except ChangeError:
        if not write:
            raise
    try:
        count = tables.change(statement)
    except InputError as error:
        raise UsageError(["nothing was changed", *error.problems]) from None
    click.echo(f"changed {count:,} row{'' if count == 1 else 's'}", err=True)
    if not is_store(Path(source.path)):
        from autocolor.files.scene_writing import write_scene

        tell_written(*map(str, write_scene(source.path, tables.scene(), overwrite=True)))


WIDEST: Final = 60
"""Limit: letters of a cell of a table; longer text is cut."""


def lines_of(columns: tuple[str, ...], rows: Iterator[tuple[Value, ...]], form: str | None) -> Iterator[str]:
    """The lines of an answer as "csv", "json" or a table. Rows are read as the lines are asked for."""
    if form == "csv":
        # The writer returns what it writes.
        writer = csv.writer(SimpleNamespace(write=str), lineterminator="")
        yield from (writer.writerow(map(_plain, row)) for row in chain([columns], rows))
    elif form == "json":
        opening = "["
        for row in rows:
            values = dict(zip(columns, map(_plain, row), strict=True))
            yield f"{opening}{json.dumps(values, ensure_ascii=False)}"
            opening = ","
        yield "[]" if opening == "[" else "]"
    elif columns:
        # These determine the widths of columns; wider cells in later rows are not aligned.
        first = list(islice(rows, 1000))
        widths = [max(len(_cell(value)) for value in column) for column in zip(columns, *first, strict=True)]
        for row in chain([columns, tuple("-" * width for width in widths)], first, rows):
            sides = [">" if isinstance(value, (int, float)) else "<" for value in row]
            cells = zip(map(_cell, row), sides, widths, strict=True)
            yield "  ".join(f"{text:{side}{width}}" for text, side, width in cells).rstrip()


def _cell(value: Value) -> str:
    """The text of a value in a table."""
    text = f"{len(value):,} bytes" if isinstance(value, bytes) else "NULL" if value is None else str(value)
    text = escaped(text[: WIDEST + 1])
    return text if len(text) <= WIDEST else f"{text[: WIDEST - 3]}..."


def _plain(value: Value) -> object:
    """The value for JSON and CSV: infinite numbers and bytes become text."""
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, float) and value - value != 0:
        return str(value)
    return value


GREETING: Final = "statements end with ;   .tables   .schema [TABLE]   .help   .quit, or Ctrl+D"

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
                line = input("...> " if text else "sql> ")
                if not text and line.strip() in (".quit", ".exit"):
                    return
                if not text and line.strip().startswith("."):
                    _show(line.split(), tables)
                else:
                    *whole, text = split(f"{text}{line}\n")
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


def _show(words: Sequence[str], tables: Tables) -> None:
    """Answer a command that begins with a dot."""
    if words[0] == ".tables":
        tell(*tables.names, err=False)
    elif words[0] == ".schema":
        for name in words[1:] or tables.names:
            tables.columns(name)
            for row in tables.select("SELECT sql FROM sqlite_master WHERE name = ?", [name]):
                tell(*f"{row['sql']!s};".split("\n"), err=False)
    else:
        click.echo(GREETING, err=True)


def split(text: str) -> list[str]:
    """The complete statements of a text, with their semicolons, and the rest of the text, if only "".

    >>> split("SELECT ';'; SELECT 2; SELECT")
    ["SELECT ';';", ' SELECT 2;', ' SELECT']
    """
    ends = [piece.end() for piece in _PIECES.finditer(text) if piece[0] == ";"]
    whole = [text[begin:end] for begin, end in zip([0, *ends], ends, strict=False)]
    rest = text[ends[-1] :] if ends else text
    return [*whole, rest if rest.strip() else ""]
