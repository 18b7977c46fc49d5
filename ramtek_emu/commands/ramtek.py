"""`ramtek`: shows the test pattern, or runs one of the other commands."""

from __future__ import annotations

from typing import ClassVar, Final

import click

from ramtek_emu.command_line import CommandGroup, version_option
from ramtek_emu.commands.displays import configuration_option, display_asked_for, refuse_outputs

EXAMPLES: Final = """\b
Examples:
  ramtek                          the test pattern in a window
  ramtek -o pattern.png           the same in a picture file, without a screen
  ramtek play drawing.ramtek      a stream of instructions in a window
  ramtek serve --port 9300        a display that programs draw on over TCP
  ramtek COMMAND --help           more on a command
"""


class RamtekGroup(CommandGroup):
    """The commands of the display."""

    package = "ramtek_emu.commands"
    table: ClassVar[dict[str, str]] = {
        "play": "run a stream of instructions from a file",
        "list": "a stream as instructions with named operands",
        "inspect": "a stream at any of its instructions; who wrote a pixel",
        "diff": "the first instruction after which two streams differ",
        "assemble": "a listing back into its stream",
        "conformance": "the claims of the conformance suite, here or on another emulator",
        "serve": "a display for programs, over TCP, on a Unix socket or on a pipe",
    }


@click.group(
    cls=RamtekGroup,
    invoke_without_command=True,
    epilog=EXAMPLES,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False),
    metavar="PNG",
    help="Write the picture, open no window.",
)
@configuration_option
@click.option("--force", is_flag=True, help="Overwrite the picture if it exists.")
@click.option("--full-screen", is_flag=True, help="Fill the screen.")
@click.option("--fit", is_flag=True, help="Fill the window, at the cost of uneven pixels.")
@click.option("--debug", is_flag=True, help="Show a traceback when something fails.")
@version_option
@click.pass_context
def ramtek(
    context: click.Context,
    output: str | None,
    configuration: str | None,
    force: bool,
    full_screen: bool,
    fit: bool,
    debug: bool,
) -> None:
    """A RAMTEK 9300 display.

    Without a command it shows the test pattern; F1 lists the keys of the window.
    """
    if context.invoked_subcommand is not None:
        return
    from ramtek_emu.monitor.pattern import pattern

    refuse_outputs(force, pictures=[output])
    display = display_asked_for(configuration)
    display.send(pattern(display.configuration))
    if output is not None:
        display.save_png(output, overwrite=force)
        return
    from ramtek_emu.monitor.window import Monitor

    Monitor(display, "RAMTEK 9300 test pattern", full_screen=full_screen, fit=fit).run()
