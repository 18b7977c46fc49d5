"""The `autocolor` command."""

from __future__ import annotations

import os
import signal


def main() -> None:
    """Run the command that the arguments name."""
    # Ctrl+C ends the program in silence until `run_command` handles it.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    # Products of so few rows take as long in one thread. On a machine that others use as well, a light takes
    # five times as long in two, because they wait for each other. Numpy reads this when it is imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

    from autocolor.commands.autocolor import autocolor
    from ramtek_emu.command_line import run_command

    run_command(autocolor, "autocolor")


if __name__ == "__main__":
    main()
