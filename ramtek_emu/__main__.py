"""The `ramtek` command."""

from __future__ import annotations

import signal


def main() -> None:
    """Run the command and leave with its exit code."""
    # Ctrl+C ends the program in silence until `run_command` handles it.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    from ramtek_emu.command_line import run_command
    from ramtek_emu.commands.ramtek import ramtek

    run_command(ramtek, "ramtek")


if __name__ == "__main__":
    main()
