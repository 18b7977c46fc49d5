"""`-v`: what the library logs, on stderr."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

if TYPE_CHECKING:
    from logging import LogRecord

COUNT: Final = "autocolor.verbosity"
"""Where the contexts of a command keep how often the option was given."""


def _listen(context: click.Context, _: click.Parameter, count: int) -> None:
    """Print what is logged until the command has ended; nothing changes without the option."""
    if not count or context.resilient_parsing:
        return
    import logging

    logger = logging.getLogger("autocolor")
    # The option may stand before the command and after it.
    is_first = COUNT not in context.meta
    context.meta[COUNT] = context.meta.get(COUNT, 0) + count
    logger.setLevel(logging.INFO if context.meta[COUNT] == 1 else logging.DEBUG)
    if not is_first:
        return

    class Printer(logging.Handler):
        """Prints each record on stderr, as all messages of a command."""

        def emit(self, record: LogRecord) -> None:
            click.echo(f"autocolor: {self.format(record)}", err=True)

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
    expose_value=False,
    is_eager=True,
    callback=_listen,
    help="Say what is read, created and computed, and how long it takes; -vv for more.",
)
"""`-v` of the group and of each command."""
