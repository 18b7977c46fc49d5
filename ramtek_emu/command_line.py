"""Command line: loads a command by name and runs it; for `autocolor` and `ramtek`.

A command writes its result to stdout and all messages to stderr. It ends with an exit code, and shows no
traceback unless --debug is given.
"""

from __future__ import annotations

import difflib
import errno
import os
import select
import signal
import sys
import traceback
from contextlib import suppress
from importlib import import_module
from io import TextIOWrapper
from types import TracebackType
from typing import ClassVar, Final, NoReturn, TextIO

import click

from ramtek_emu.errors import escaped

UNAVAILABLE: Final = 69
FAULT: Final = 70
OUT_OF_MEMORY: Final = 71
WRITING_FAILED: Final = 74
BY_SIGNAL: Final = 128
"""The exit code in a shell of a program that a signal ended, minus the number of the signal."""
ENDING: Final = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""The signals that end a program from outside. Windows has no SIGHUP."""
SECONDS_BETWEEN: Final = 0.02
"""Limit: of two looks at whether Ended was dropped."""
READER_LEFT: Final = 141
"""The exit code in a shell of a program that SIGPIPE ended."""
PYGAME: Final = "pygame" if sys.version_info < (3, 14) else "pygame-ce"
"""The package that provides pygame, as in pyproject.toml: pygame has no wheels from Python 3.14 on."""


version_option = click.version_option(
    package_name="autocolor", message="%(version)s", help="Show the version and leave."
)


class CommandGroup(click.Group):
    """A group of commands. A command is imported only when it is used, so that help is shown at once.

    The module and the function of a command have the name of the command. If that name is a built-in of
    Python (`list`), the function's name ends in `_command`.
    """

    package: ClassVar[str]
    """The package of the commands' modules."""
    table: ClassVar[dict[str, str]]
    """The commands and their lines of help, in the order of the help."""

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
        """The command that the arguments name; the error for an unknown name suggests the nearest command."""
        if args and args[0] not in self.table and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], self.table, n=1)
            advice = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(self.table)}"
            ctx.fail(f"there is no command {args[0]!r}; {advice}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the table of commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.table.items()))


class Ended(KeyboardInterrupt):
    """A signal is to end the program."""

    def __init__(self, number: int) -> None:
        super().__init__(
            "interrupted" if number == signal.SIGINT else f"ended by {signal.Signals(number).name}"
        )
        self.exit_code = BY_SIGNAL + number


class EndingSignals:
    """The handlers of the signals that end a program: the first signal raises Ended, the others do nothing.

    A signal that was ignored when the program started (`nohup`) stays ignored. Python or a library in C may
    drop an exception, as in a `__del__` or during an import. So Ended is raised again if nothing handles it.
    """

    ended: Ended | None = None
    ignored = False
    """Whether signals do nothing, because the program ends."""
    cancels = False
    """Whether Ctrl+C raises KeyboardInterrupt each time, because it cancels a step, not the program."""

    def install(self) -> None:
        """Install the handlers for the rest of the process."""
        self.ended, self.ignored, self.cancels = None, False, False
        # A process that runs several commands installs the handlers again; the hooks before them stay.
        if sys.unraisablehook != self._on_unraisable:
            self._show_unraisable, sys.unraisablehook = sys.unraisablehook, self._on_unraisable
        # Libraries in C may print an exception that is raised while they are imported.
        if sys.excepthook != self._on_exception:
            self._show, sys.excepthook = sys.excepthook, self._on_exception
        for number in ENDING:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._receive)

    def ignore(self) -> None:
        """Ignore signals from now on."""
        self.ignored = True
        if sys.platform != "win32":
            signal.setitimer(signal.ITIMER_REAL, 0)

    def _receive(self, number: int, _: object) -> None:
        if self.ignored or self.ended is not None:
            return
        if self.cancels and number == signal.SIGINT:
            raise KeyboardInterrupt
        self.ended = Ended(number)
        if sys.platform != "win32":
            signal.signal(signal.SIGALRM, self._raise_again)
            signal.setitimer(signal.ITIMER_REAL, SECONDS_BETWEEN, SECONDS_BETWEEN)
        raise self.ended

    def _raise_again(self, *_: object) -> None:
        """Raise Ended, unless it is being handled, as in a `finally`."""
        error = sys.exception()
        while error is not None and error is not self.ended:
            error = error.__context__
        if self.ended is not None and not self.ignored and error is None:
            raise self.ended

    def _on_unraisable(self, unraisable: sys.UnraisableHookArgs) -> None:
        if not isinstance(unraisable.exc_value, Ended):
            self._show_unraisable(unraisable)

    def _on_exception(
        self, kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        if not isinstance(error, Ended):
            self._show(kind, error, trace)


SIGNALS: Final = EndingSignals()
"""The signals that end this process."""


def run_command(command: click.Command, name: str) -> None:
    """Run a command and end the process with its exit code.

    SIGINT, SIGTERM and SIGHUP raise Ended, once; the exit code is 128 plus the number of the signal. If an
    error has an attribute `exit_code`, the user can act on it: its message is shown, and the attribute is the
    code. If the reader of stdout leaves, the command ends in silence. If pygame cannot be imported, the
    message has the package to install. All other errors are faults of the program. With `--debug` anywhere
    before a `--`, the traceback is shown.
    """
    SIGNALS.install()
    try:
        code, message = _outcome(command, name)
        if SIGNALS.ended is not None:
            # A library replaced the exception by another, such as SQLite's "interrupted".
            raise SIGNALS.ended
        _show(name, message)
        SIGNALS.ignore()
    except KeyboardInterrupt as interrupt:
        SIGNALS.ignore()
        end = SIGNALS.ended or interrupt
        # Nobody may read what is left in the buffers: drop it.
        _discard(sys.stdout)
        if takes_text(sys.stderr):
            _show(name, str(end) or "interrupted")
        code = getattr(end, "exit_code", BY_SIGNAL + signal.SIGINT)
    _leave(code)


def _outcome(command: click.Command, name: str) -> tuple[int, str]:
    """Run a command. Returns its exit code and the message for stderr."""
    debug, arguments = _without_debug(sys.argv[1:])
    had_stdout = sys.stdout is not None
    if sys.stdout is None:
        sys.stdout = _closed_pipe()
    if isinstance(sys.stdout, TextIOWrapper):
        # File names may contain bytes that are no valid text.
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        code = _exit_code(command, name, arguments)
        sys.stdout.flush()
    except click.exceptions.Abort:
        raise KeyboardInterrupt from None
    except click.ClickException as refusal:
        refusal.message = escaped(refusal.message)  # type: ignore[misc]
        with suppress(OSError, ValueError):
            refusal.show()
        return refusal.exit_code, ""
    except BrokenPipeError:
        if had_stdout:
            return READER_LEFT, ""
        return WRITING_FAILED, "stdout must stay open until all is written, not be closed; read it all"
    except Exception as error:
        if debug:
            with suppress(OSError, ValueError):
                traceback.print_exc()
        if memory_error := _memory_error(error):
            # Free what the functions had allocated when memory ran out.
            traceback.clear_frames(error.__traceback__)
            doing = ", ".join(getattr(memory_error, "__notes__", [" ".join([name, *arguments])]))
            reason = str(memory_error) or "nothing is left"
            return OUT_OF_MEMORY, (
                f"memory must suffice, and it ran out ({escaped(doing)}: {reason[:1].lower()}{reason[1:]});"
                " take a smaller mesh or picture, or give the program more memory"
            )
        refused: int | None = getattr(error, "exit_code", None)
        if refused is not None:
            return refused, str(error)
        if isinstance(error, ImportError) and str(error.name).startswith("pygame"):
            return UNAVAILABLE, (
                f"a window must have pygame, and it cannot be loaded ({error}); "
                f"install it with `pip install {PYGAME}`, or ask for a picture file instead"
            )
        if isinstance(error, OSError) and error.filename is None:
            reason = (error.strerror or str(error)).lower()
            return WRITING_FAILED, f"stdout must take what is written, not fail ({reason}); make room"
        fault = f"a fault of this program, not of yours: {type(error).__name__}: {error}"
        return FAULT, f"{fault}; {'report it' if debug else 'add --debug for the traceback and report it'}"
    return code if isinstance(code, int) else 0, ""


def _exit_code(command: click.Command, name: str, arguments: list[str]) -> object:
    """The exit code of a command, or None. Click's own `main` would end silently with 1 at a broken pipe."""
    completion = f"_{name.upper()}_COMPLETE"
    if completion in os.environ:
        from click.shell_completion import shell_complete

        return shell_complete(command, {}, name, completion, os.environ[completion])
    try:
        with command.make_context(name, [*arguments]) as context:
            return command.invoke(context)
    except click.exceptions.Exit as leaving:
        return leaving.exit_code


def _memory_error(error: BaseException | None) -> BaseException | None:
    """The lack of memory that an error reports, or that led to it; None for any other error."""
    while error is not None and not isinstance(error, MemoryError):
        if getattr(error, "errno", None) == errno.ENOMEM:
            break
        error = error.__context__
    return error


def _without_debug(arguments: list[str]) -> tuple[bool, list[str]]:
    """Whether `--debug` is among the arguments, and the arguments without it."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    rest = [argument for argument in arguments[:end] if argument != "--debug"]
    return len(rest) < end, rest + arguments[end:]


def _closed_pipe() -> TextIOWrapper:
    """The write end of a pipe without a reader, for a process that was started without a stdout."""
    read_end, write_end = os.pipe()
    os.close(read_end)
    return open(write_end, "w", encoding="utf-8")


def tell(*lines: str, err: bool = True) -> None:
    """Print lines, by default on stderr. What cannot be printed, as in names of files, is escaped.

    If stderr is closed, the lines are lost, and the program goes on.
    """
    with suppress(*((OSError, ValueError) if err else ())):
        for line in lines:
            click.echo(escaped(line), err=err)


def _show(name: str, message: str) -> None:
    """Print the message on stderr, with the name of the command before each line."""
    tell(*(f"{name}: {line}" for line in message.split("\n") if line))


def takes_text(stream: TextIO | None) -> bool:
    """Whether writing to the stream does not wait for a reader; True where this cannot be known."""
    try:
        return stream is not None and bool(select.select([], [stream], [], 0)[1])
    except (OSError, ValueError):
        return True


def report(message: str) -> None:
    """Print a message on stderr, as `tell` does. If nobody reads stderr, the message is dropped."""
    if takes_text(sys.stderr):
        tell(message)


def _discard(stream: TextIO | None) -> None:
    """Send what a stream's buffer contains, and all that follows, to the null device."""
    with suppress(OSError, ValueError):
        if stream is not None:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _leave(code: int) -> NoReturn:
    """Flush the buffers, or drop them if that fails, and end the process with the code."""
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except (OSError, ValueError):
            # Otherwise the exit would fail and change the code.
            _discard(stream)
    sys.exit(code)
