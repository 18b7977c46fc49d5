"""The `ramtek` command."""

from __future__ import annotations

# Python has loaded it already; `signal` would take 3 ms, in which Ctrl+C would show a traceback.
import _signal  # type: ignore[import-not-found]


def main() -> None:
    """Run the command and leave with its exit code."""
    # Until `run_command` handles Ctrl+C, it ends the program in silence.
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)

    from ramtek_emu.command_line import run_command
    from ramtek_emu.commands.ramtek import ramtek

    run_command(ramtek, "ramtek")


if __name__ == "__main__":
    main()
