"""The `ramtek` command."""

from __future__ import annotations

from ramtek_emu.command_line import run_command
from ramtek_emu.commands.ramtek import ramtek


def main() -> None:
    """Run the command and leave with its exit code."""
    run_command(ramtek, "ramtek")


if __name__ == "__main__":
    main()
