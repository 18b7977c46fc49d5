"""CommandGroup: commands known by name and loaded when they are named, so that help comes at once."""

import difflib
from importlib import import_module
from typing import ClassVar

import click


class CommandGroup(click.Group):
    """A group of commands, each a function of its own name in a module of its own name.

    A command whose name is a word of Python's own (`list`) is called that name with `_command` behind.
    """

    package: ClassVar[str]
    """Where the modules of the commands are."""
    table: ClassVar[dict[str, str]]
    """What each command does, in the order of the help."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names in the order of the table."""
        return list(self.table)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name, or None."""
        if cmd_name not in self.table:
            return None
        module = import_module(f"{self.package}.{cmd_name}")
        command: click.Command = getattr(module, f"{cmd_name}_command", None) or getattr(module, cmd_name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that the arguments name; a wrong name is told the nearest right one."""
        if args and args[0] not in self.table and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], self.table, n=1)
            advice = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(self.table)}"
            ctx.fail(f"there is no command {args[0]!r}; {advice}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The table of commands, without loading any of them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.table.items()))
