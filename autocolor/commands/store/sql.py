"""`autocolor sql`: the tables of a scene as a relational data base."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from autocolor.commands.options.usage import as_usage
from autocolor.commands.outputs import tell_written
from autocolor.commands.scenes import SceneSource, ended, read, scene_options
from autocolor.commands.store.answers import FORMATS, lines_of
from autocolor.errors import InputError, UsageError

if TYPE_CHECKING:
    from autocolor.files.scenes.scene_report import SceneReport
    from autocolor.files.store.tables import Tables

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
@click.option("--write", is_flag=True, help="Let INSERT, UPDATE and DELETE through, and save SCENE.")
@click.option(
    "--format", "form", type=click.Choice(FORMATS), help="How to print rows: as a table by default."
)
@click.option("--csv", "as_csv", is_flag=True, help="Print CSV.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option(
    "--seconds",
    type=click.FloatRange(0.001, 86400),
    default=30.0,
    show_default=True,
    help="How long a statement may take.",
)
@click.pass_context
def sql(
    context: click.Context,
    source: SceneSource,
    statement: str | None,
    write: bool,
    form: str | None,
    as_csv: bool,
    as_json: bool,
    seconds: float,
) -> None:
    """Ask the tables of SCENE with a statement of SQL; without one, at a prompt or from stdin.

    SCENE is a store (.sqlite), or any other scene, which is read into memory for it. `.schema` at the prompt
    shows the tables; docs/STORE.md describes them. A change is checked as a scene file is, and refused as a
    whole if anything would be wrong.
    """
    asked = [each for each, is_asked in zip(FORMATS, (False, as_csv, as_json), strict=True) if is_asked]
    if len(asked) + (form is not None) > 1:
        raise UsageError("rows must be printed in one way, not several; leave one of the options")
    tables, report = _opened(source, write)
    tables.seconds = seconds
    run = partial(_run, tables, source, write, form or next(iter(asked), "table"))
    from autocolor.commands.store.prompt import prompt, reads_from_a_terminal, statements_in

    with tables:
        if statement is not None:
            run(statement)
        elif reads_from_a_terminal():
            prompt(tables, run)
        else:
            for each in statements_in(sys.stdin):
                run(each)
    context.exit(0 if report is None else ended(report, source))


def _opened(source: SceneSource, write: bool) -> tuple[Tables, SceneReport | None]:
    """The tables of a scene, and the report of what was read; None for a store, which needs no repair."""
    from autocolor.files.store.tables import is_store, open_tables, tables_of

    path = Path(source.path)
    if is_store(path):
        return open_tables(path), None
    if write:
        _refuse_write(path)
    report = read(source)
    return tables_of(report.scene), report


def _refuse_write(path: Path) -> None:
    """Raise UsageError for a file that no scene is saved to."""
    if path.is_dir() or path.suffix.lower() == ".toml":
        return
    advice = "take its scene out with `autocolor tables --write`"
    if path.suffix.lower() != ".npz":
        advice = "make a scene of it with `autocolor tables --write`, or a store with `autocolor convert`"
    raise UsageError(f"--write must save to a store or to a scene's folder, not to {path}; {advice}")


def _run(tables: Tables, source: SceneSource, write: bool, form: str, statement: str) -> None:
    """Run one statement, and print its rows, or how many it changed."""
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
