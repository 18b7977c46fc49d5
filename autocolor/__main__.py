"""The `autocolor` command."""

from __future__ import annotations

from autocolor.commands.autocolor import autocolor
from ramtek_emu.command_line import run_command


def main() -> None:
    """Run the command that the arguments name."""
    run_command(autocolor, "autocolor")


if __name__ == "__main__":
    main()
