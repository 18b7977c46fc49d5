"""The command line: one file a command, each loaded only when it is named, so that help comes at once."""

from __future__ import annotations

from typing import ClassVar, Final

import click

from ramtek_emu.command_line import CommandGroup, version_option

EXAMPLES: Final = """\b
Examples:
  autocolor                                     the built-in demo in the window
  autocolor render scenes/coupe -o coupe.png    the picture of a scene
  autocolor render car.obj                      the picture of a bare mesh
  autocolor COMMAND --help                      more on a command
"""


class AutocolorGroup(CommandGroup):
    """The commands of the studio."""

    package = "autocolor.commands"
    table: ClassVar[dict[str, str]] = {
        "render": "the picture of a scene, without a window",
        "recolor": "a saved picture in other colors, without computing it again",
        "view": "a scene in the window of the display",
        "info": "what a scene holds: counts, sizes, ranges",
        "validate": "every problem of a scene at once",
        "show": "the picture of a scene on a display elsewhere",
        "tables": "the tables of a scene, also those created for it",
    }


@click.group(
    cls=AutocolorGroup,
    invoke_without_command=True,
    epilog=EXAMPLES,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.option("--debug", is_flag=True, help="Show a traceback when something fails.")
@version_option
@click.pass_context
def autocolor(context: click.Context, debug: bool) -> None:
    """Light a scene and recolor it on an emulated RAMTEK 9300, without computing it again.

    Without a command it shows the built-in demo in the window.
    """
    if context.invoked_subcommand is None:
        from autocolor.commands.view import show_demo

        show_demo()
