"""The `autocolor` command."""

from __future__ import annotations

# Python has loaded it already; `signal` would take 3 ms, in which Ctrl+C would show a traceback.
import _signal  # type: ignore[import-not-found]
import os


def main() -> None:
    """Run the command that the arguments name."""
    # Until `run_command` handles Ctrl+C, it ends the program in silence.
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    # Products of so few rows take as long in one thread. On a machine that others use as well, a light takes
    # five times as long in two, because they wait for each other. Numpy reads this when it is imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

    from autocolor.commands.autocolor import autocolor
    from ramtek_emu.command_line import run_command

    run_command(autocolor, "autocolor")


if __name__ == "__main__":
    main()
