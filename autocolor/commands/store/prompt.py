"""The prompt of `autocolor sql`: statements that end with a semicolon, and words that begin with a dot."""

from __future__ import annotations

import re
import sqlite3
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Final

import click

from autocolor.checks import printable
from autocolor.errors import AutocolorError, UsageError

if TYPE_CHECKING:
    from autocolor.files.store.tables import Tables

GREETING: Final = "statements end with ;   .tables   .schema [TABLE]   .help   .quit, or Ctrl+D"
FIRST: Final = "sql> "
NEXT: Final = "...> "

MOST_LETTERS: Final = 1 << 20
"""Assumed: letters of one statement."""

_PIECES: Final = re.compile(
    r"""'[^']*(?:'|\Z)|"[^"]*(?:"|\Z)|`[^`]*(?:`|\Z)|\[[^]]*(?:]|\Z)|--[^\n]*|/\*.*?(?:\*/|\Z)|;""", re.DOTALL
)
"""Texts, names and comments, which may hold semicolons, and semicolons."""


def prompt(tables: Tables, run: Callable[[str], None]) -> None:
    """Ask for statements until Ctrl+D or `.quit`; Ctrl+C takes back what was typed, or ends a statement."""
    with suppress(ImportError):
        # Lines can be edited, and come back with the arrow keys.
        import readline  # noqa: F401
    click.echo(GREETING, err=True)
    text = ""
    while True:
        try:
            line = input(NEXT if text else FIRST)
            if not text and _dotted(line, tables):
                continue
            whole, text = split(f"{text}{line}\n")
            for statement in whole:
                run(statement)
        except EOFError:
            click.echo(err=True)
            return
        except KeyboardInterrupt:
            text = ""
            click.echo("taken back; Ctrl+D ends", err=True)
        except AutocolorError as error:
            click.echo(f"autocolor: {error}", err=True)
        except _Quit:
            return


class _Quit(Exception):  # noqa: N818
    """The user asked to leave the prompt."""


def _dotted(line: str, tables: Tables) -> bool:
    """Do what a word with a dot asks for; False for a line that is none."""
    words = line.split()
    if not words:
        return True
    if not words[0].startswith("."):
        return False
    if words[0] == ".tables":
        click.echo("\n".join(map(printable, tables.names)))
    elif words[0] == ".schema":
        for name in words[1:] or tables.names:
            click.echo("\n".join(map(printable, tables.definition(name).split("\n"))))
    elif words[0] in (".quit", ".exit"):
        raise _Quit
    else:
        click.echo(GREETING, err=True)
    return True


def statements_in(lines: Iterable[str]) -> Iterator[str]:
    """The statements of some lines; the last one may lack its semicolon."""
    text = ""
    for line in _readable(lines):
        text += line
        if ";" in line:
            whole, text = split(text)
            yield from whole
        if len(text) > MOST_LETTERS:
            break
    if text.strip():
        yield text


def _readable(lines: Iterable[str]) -> Iterator[str]:
    """The lines. Raises UsageError for one that is not text in UTF-8."""
    try:
        yield from lines
    except UnicodeDecodeError:
        raise _not_text() from None


def _not_text() -> UsageError:
    return UsageError("statements must be text in UTF-8 without NUL; save them so")


def split(text: str) -> tuple[list[str], str]:
    """The whole statements of a text, each with its semicolon, and what is left after them.

    Raises UsageError for what is not text in UTF-8.

    >>> split("SELECT ';'; SELECT 2; SELECT")
    (["SELECT ';';", ' SELECT 2;'], ' SELECT')
    """
    whole = []
    begin = 0
    for found in _PIECES.finditer(text):
        if found[0] == ";" and _is_complete(text[begin : found.end()]):
            whole.append(text[begin : found.end()])
            begin = found.end()
    rest = text[begin:]
    return whole, rest if rest.strip() else ""


def _is_complete(text: str) -> bool:
    """Whether a text is a statement to its end: the semicolons in a trigger end none."""
    try:
        return sqlite3.complete_statement(text)
    except ValueError:
        raise _not_text() from None


def reads_from_a_terminal() -> bool:
    """Whether somebody types."""
    return sys.stdin is not None and sys.stdin.isatty()
