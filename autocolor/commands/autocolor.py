"""The `autocolor` command group. It imports a command only when it is used, so that help is fast."""

from __future__ import annotations

from typing import ClassVar, Final

import click

from autocolor.commands.options import bringing_paints, flag, paints_option, verbose_option
from autocolor.errors import UsageError
from ramtek_emu.command_line import CommandGroup, version_option

EXAMPLES: Final = """\b
Examples:
  autocolor                                     show the built-in demo in a window
  autocolor render scenes/coupe -o coupe.png    render a scene to a PNG file
  autocolor render car.obj                      render a mesh without a scene file
  autocolor COMMAND --help                      show the help of a command
"""


class AutocolorGroup(CommandGroup):
    """The group of all commands, with a line of help for each of them."""

    package = "autocolor.commands"

    table: ClassVar[dict[str, str]] = {
        "render": "render a scene to a PNG or picture file, without a window",
        "recolor": "change the colors of a saved picture, without rendering it again",
        "palette": "write the colors of a surface's levels to a palette file",
        "sweep": "make pictures of many variants of a scene or a picture",
        "page": "write a page that recolors a picture in any browser",
        "animate": "write the frames between variants as a film or a stream",
        "view": "show a scene in an interactive window",
        "info": "print the counts, sizes and ranges of a scene",
        "explain": "explain a pixel of a scene, from the nodes to the color",
        "validate": "list every problem of a scene and every fault of its mesh",
        "convert": "write a mesh or a scene in another format",
        "show": "show a scene on another display, and work there with its joystick",
        "tutorial": "learn the interactive system step by step, on the built-in demo",
        "tables": "print or write a complete scene file for a mesh or a scene",
        "sql": "query and change the tables of a scene with SQL",
    }


@click.group(
    cls=AutocolorGroup,
    invoke_without_command=True,
    epilog=EXAMPLES,
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
)
@flag("--debug", "Show the traceback of an error.")
@paints_option
@verbose_option
@version_option
@click.pass_context
def autocolor(context: click.Context, debug: bool, paints: str | None) -> None:
    """Render lit scenes on an emulated RAMTEK 9300, and recolor them without rendering them again.

    Without a command, show the built-in demo in a window.
    """
    if context.invoked_subcommand is None:
        from autocolor.commands.view import show_demo

        show_demo(prepare=bringing_paints(paints))
    elif paints is not None:
        raise UsageError("--paints before a command is for the demo; write it after `view` or `show`")
