"""The command line: one file a command, each loaded only when it is named, so that help comes at once."""

from __future__ import annotations

from importlib import import_module

import click

from ramtek_emu.command_line import version_option

COMMANDS = {
    "render": "the picture of a scene, without a window",
    "recolor": "a saved picture in other colors, without computing it again",
    "view": "a scene in the window of the display",
    "info": "what a scene holds: counts, sizes, ranges",
    "validate": "every problem of a scene at once",
    "tables": "the tables of a scene, also those created for it",
}

EXAMPLES = """\b
Examples:
  autocolor                                     the built-in demo in the window
  autocolor render scenes/coupe -o coupe.png    the picture of a scene
  autocolor render car.obj                      the picture of a bare mesh
  autocolor COMMAND --help                      more on a command
"""


class CommandGroup(click.Group):
    """A group that knows its commands by name and imports the one that is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names in the order of the table."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name, or None."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = getattr(import_module(f"autocolor.commands.{cmd_name}"), cmd_name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that the arguments name; a wrong name is told the nearest right one."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            from autocolor.checks import nearest

            ctx.fail(f"there is no command {args[0]!r}{nearest(args[0], COMMANDS)}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The table of commands, without loading any of them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(
    cls=CommandGroup,
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
