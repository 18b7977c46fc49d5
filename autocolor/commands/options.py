"""Options that several commands share, such as `--paints`, `--size`, `--smooth` and `--limit`.

The options for SCENE are those of `scenes`.
An invalid value of an option is a UsageError, not an InputError.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from autocolor.errors import InputError, UsageError
from ramtek_emu.command_line import tell

if TYPE_CHECKING:
    from logging import LogRecord

    from autocolor.screens.viewer import Viewer

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
"""A decorator of the function of a command."""


def option(names: str, metavar: str, help: str, type: Any = None, **more: Any) -> Decorator:
    """An option with a value, by default a path: its names, the name of its value, and its help."""
    return click.option(*names.split(), metavar=metavar, help=help, type=type or click.Path(), **more)


def flag(name: str, help: str) -> Decorator:
    """An option without a value."""
    return click.option(name, is_flag=True, help=help)


force_option = flag("--force", "Overwrite existing files.")
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


@contextmanager
def as_usage(place: str = "") -> Iterator[None]:
    """Raise a UsageError instead of an InputError; the lines of its message begin with `place`."""
    try:
        yield
    except InputError as error:
        raise UsageError(f"{place}{problem}" for problem in error.problems) from None


paints_option = option(
    "--paints", "FILE", "Offer the named paints of a .gpl or .csv file beside the swatches of color mixing."
)


def bringing_paints(path: str | None) -> Callable[[Viewer], object]:
    """A function that brings the paints of a palette file to a viewer; it does nothing without a path.

    The file is read at once. Raises InputError.
    """
    if path is None:
        return lambda _: None
    from autocolor.files.palette_file import read_palette

    paints, name = read_palette(path), Path(path).name
    return lambda viewer: viewer.bring_paints(paints, name)


recover_option = option(
    "--recover",
    "[SESSION]",
    "Instead of SCENE, continue the newest session that was not closed, or the session of a name.",
    str,
    is_flag=False,
    flag_value="newest",
)


def _allow(context: click.Context, _: click.Parameter, limit: float | None) -> None:
    """Allow the command this multiple of the memory budget."""
    if limit is not None and not context.resilient_parsing:
        from autocolor.budget import allowing

        context.find_root().with_resource(allowing(limit))


limit_option = option(
    "--limit",
    "FACTOR",
    "Factor for the memory that files and pictures may take, such as 2 for twice as much.",
    float,
    expose_value=False,
    callback=_allow,
)
"""`--limit` of the commands that read files."""

VERBOSITY: Final = "autocolor.verbosity"
"""The key of a click context for the number of `-v`; it is there if the log is printed."""


def _listen(context: click.Context, _: click.Parameter, count: int) -> None:
    """Print log records on stderr until the command ends: warnings, and what `-v` asks for.

    `-v` may be given before the command and after it.
    """
    is_before_command = context.parent is None
    if context.resilient_parsing or (is_before_command and not count):
        return
    import logging

    logger = logging.getLogger("autocolor")
    is_printed = VERBOSITY in context.meta
    verbosity = context.meta[VERBOSITY] = context.meta.get(VERBOSITY, 0) + count
    logger.setLevel((logging.WARNING, logging.INFO, logging.DEBUG)[min(verbosity, 2)])
    if is_printed:
        return

    class Printer(logging.Handler):
        """Prints records on stderr, like all messages of a command."""

        def emit(self, record: LogRecord) -> None:
            tell(f"autocolor: {self.format(record)}")

    printer = Printer()
    logger.addHandler(printer)

    def stop() -> None:
        logger.removeHandler(printer)
        logger.setLevel(logging.NOTSET)

    context.find_root().call_on_close(stop)


verbose_option = click.option(
    "-v",
    "--verbose",
    count=True,
    show_default=False,
    expose_value=False,
    is_eager=True,
    callback=_listen,
    help="Print the steps of the command with their times; -vv prints more.",
)
"""`-v` of the group and of its commands."""
