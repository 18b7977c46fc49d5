"""Running a command: what it answers on stdout, everything else on stderr, an exit code, never a traceback.

Both commands of this distribution run through here, so that they end alike.
"""

import os
import sys
from contextlib import suppress

import click

FAULT = 70
INTERRUPTED = 130
WRITING_FAILED = 74


def run_command(command: click.Command, name: str) -> None:
    """Run a command and leave the process with its exit code.

    An error with an `exit_code` is a refusal: its sentence is shown and that code is given. Anything else is
    a fault of ours. With `--debug`, anywhere on the line, the traceback is shown.
    """
    arguments = sys.argv[1:]
    debug = "--debug" in arguments
    try:
        code = command.main(
            [argument for argument in arguments if argument != "--debug"], name, standalone_mode=False
        )
        sys.stdout.flush()
    except click.exceptions.Abort:
        _end(name, "interrupted", INTERRUPTED)
    except KeyboardInterrupt:
        _end(name, "interrupted", INTERRUPTED)
    except click.ClickException as refusal:
        refusal.show()
        sys.exit(refusal.exit_code)
    except BrokenPipeError:
        # What is left in the buffer can't be written either: give it to nobody.
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        _end(name, "stdout must stay open until everything is written, not be closed", WRITING_FAILED)
    except Exception as error:
        if debug:
            raise
        code = getattr(error, "exit_code", None)
        if code is not None:
            _end(name, str(error), code)
        if isinstance(error, OSError) and error.filename is None:
            _end(name, f"stdout can't be written ({error.strerror or error})", WRITING_FAILED)
        fault = f"a fault of this program, not of yours: {type(error).__name__}: {error}"
        _end(name, f"{fault}; add --debug for the traceback and report it", FAULT)
    sys.exit(code if isinstance(code, int) else 0)


def _end(name: str, message: str, code: int) -> None:
    """Say what happened, each line under the command's name, and leave."""
    for line in message.splitlines():
        # A name of a file may hold what the terminal's encoding does not.
        with suppress(OSError, ValueError):
            click.echo(f"{name}: {line}", err=True)
    sys.exit(code)
