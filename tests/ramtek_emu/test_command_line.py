"""The exit codes and messages of a command; tests that need a process of their own are with `autocolor`."""

from __future__ import annotations

import errno
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from types import ModuleType
from typing import ClassVar, NamedTuple

import click
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.command_line import CommandGroup, run_command, tell
from ramtek_emu.errors import OutputExistsError, escaped


class Left(NamedTuple):
    code: int
    out: str
    err: str


End = Callable[..., Left]


@pytest.fixture
def end(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> End:
    """Run a command that calls the given function; returns how it ended."""

    def run(does: Callable[[], object], *arguments: str) -> Left:
        @click.command()
        @click.argument("names", nargs=-1)
        def command(names: tuple[str, ...]) -> None:
            click.echo(" ".join(names))
            does()

        monkeypatch.setattr(sys, "argv", ["tool", *arguments])
        capsys.readouterr()
        with pytest.raises(SystemExit) as left:
            run_command(command, "tool")
        assert isinstance(left.value.code, int)
        return Left(left.value.code, *capsys.readouterr())

    return run


def raising(error: BaseException) -> Callable[[], None]:
    def does() -> None:
        raise error

    return does


def after(cause: BaseException, error: BaseException) -> BaseException:
    """The error, raised while the cause was handled."""
    error.__context__ = cause
    return error


def test_a_command_ends_with_0_or_a_code_of_its_own(end: End) -> None:
    assert end(lambda: None, "a", "b") == (0, "a b\n", "")
    assert end(lambda: click.get_current_context().exit(1)).code == 1
    # Names that are no text are shown with backslashes.
    assert end(lambda: None, "\udcff").out == "\\udcff\n"


class TwoProblemsError(Exception):
    exit_code = 65


def test_each_problem_of_a_refusal_has_a_line_with_the_name_of_the_command(end: End) -> None:
    assert end(raising(TwoProblemsError("a\x0b\nb"))).err == "tool: a\\x0b\ntool: b\n"


def has_no_commands_for_a_terminal(text: str) -> bool:
    return all(letter.isprintable() or letter == "\n" for letter in text)


@given(st.text())
def test_what_is_printed_commands_no_terminal(text: str) -> None:
    assert escaped(text).isprintable()
    assert escaped(escaped(text)) == escaped(text)
    if text.isprintable():
        assert escaped(text) == text


STRANGE = "\u202e\x00\x16\x1b[2J\x7f\x85\u2028\u2066\u061c\udcff\n"
"""Characters that turn the direction of text, clear a terminal, begin a line or are no text."""


@pytest.mark.parametrize(
    "does",
    [
        raising(OutputExistsError(STRANGE)),
        raising(ValueError(STRANGE)),
        raising(click.UsageError(STRANGE)),
        lambda: tell(STRANGE, STRANGE),
    ],
    ids=["refusal", "fault", "usage", "message"],
)
def test_strange_characters_of_names_are_escaped_in_every_message(
    end: End, does: Callable[[], object]
) -> None:
    left = end(does)
    assert has_no_commands_for_a_terminal(left.err)
    assert "\\u202e\\x00\\x16\\x1b[2J" in left.err


@pytest.mark.parametrize(
    ("error", "code", "sentence"),
    [
        (click.UsageError("no"), 2, "Error: no"),
        (click.Abort(), 130, "tool: interrupted"),
        (KeyboardInterrupt(), 130, "tool: interrupted"),
        (OSError(errno.ENOSPC, "No space left on device"), 74, "not fail (no space left on device)"),
        (OSError(errno.EIO, "Input/output error", "a/file"), 70, "a fault of this program"),
        (MemoryError(), 71, "tool: memory must suffice, and it ran out (tool a\\n: nothing is left); take a"),
        (
            OSError(errno.ENOMEM, "Cannot allocate memory"),
            71,
            "(tool a\\n: [Errno 12] Cannot allocate memory)",
        ),
        (after(MemoryError("no"), OutputExistsError("a.png exists")), 71, "(tool a\\n: no)"),
        (OutputExistsError("a.png\n\x1b exists"), 73, "tool: a.png\\n\\x1b exists\n"),
        (after(FileNotFoundError(2, "No such file"), OutputExistsError("no")), 73, "tool: no"),
        (RecursionError("deep"), 70, "RecursionError: deep"),
    ],
)
def test_each_failure_has_its_code_and_no_traceback(
    end: End, error: BaseException, code: int, sentence: str
) -> None:
    left = end(raising(error), "a\n")
    assert left.code == code
    assert sentence in left.err
    assert "Traceback" not in left.err


ENDING = [
    pytest.param(
        name, code, sentence, marks=pytest.mark.skipif(not hasattr(signal, name), reason="no such signal")
    )
    for name, code, sentence in (
        ("SIGINT", 130, "interrupted"),
        ("SIGTERM", 143, "ended by SIGTERM"),
        ("SIGHUP", 129, "ended by SIGHUP"),
    )
]


@pytest.mark.parametrize(("name", "code", "sentence"), ENDING)
def test_the_first_signal_ends_a_command_and_later_signals_do_nothing(
    end: End, name: str, code: int, sentence: str
) -> None:
    def does() -> None:
        try:
            signal.raise_signal(getattr(signal, name))
        finally:
            signal.raise_signal(signal.SIGTERM)
            signal.raise_signal(signal.SIGINT)

    assert end(does) == (code, "\n", f"tool: {sentence}\n")


def test_a_signal_ends_a_command_whose_library_raises_another_exception_unless_it_was_ignored(
    end: End,
) -> None:
    def does() -> None:
        try:
            signal.raise_signal(signal.SIGTERM)
        except KeyboardInterrupt:
            raise ValueError("interrupted") from None

    assert end(does) == (143, "\n", "tool: ended by SIGTERM\n")
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    assert end(does) == (0, "\n", "")


WITH_TIMERS = pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="this system has no timers")


class Destroyed:
    def __del__(self) -> None:
        signal.raise_signal(signal.SIGTERM)


def drop() -> None:
    with suppress(KeyboardInterrupt):
        signal.raise_signal(signal.SIGTERM)


@WITH_TIMERS
@pytest.mark.parametrize("dropping", [Destroyed, drop])
def test_a_signal_whose_exception_is_dropped_ends_the_command_later(
    end: End, dropping: Callable[[], object]
) -> None:
    def does() -> None:
        dropping()
        while True:
            time.sleep(1)

    assert end(does) == (143, "\n", "tool: ended by SIGTERM\n")


@WITH_TIMERS
def test_what_is_put_in_order_after_a_signal_is_not_interrupted(end: End) -> None:
    orders = []

    def does() -> None:
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            for _ in range(20):
                time.sleep(0.005)
                with suppress(ValueError):
                    raise ValueError
            orders.append("done")

    assert end(does).code == 143
    assert orders == ["done"]


def test_a_process_that_runs_several_commands_still_shows_exceptions(
    end: End, capsys: pytest.CaptureFixture[str]
) -> None:
    for _ in range(2):
        end(lambda: None)
    sys.excepthook(ValueError, ValueError("x"), None)
    assert capsys.readouterr().err == "ValueError: x\n"


def test_a_reader_of_stdout_that_left_ends_a_command_in_silence(end: End) -> None:
    assert end(raising(BrokenPipeError(errno.EPIPE, "Broken pipe"))) == (141, "\n", "")


def test_debug_shows_the_traceback_and_is_no_argument_before_two_dashes(end: End) -> None:
    left = end(raising(ValueError("x")), "a", "--debug", "b")
    assert (left.code, left.out) == (70, "a b\n")
    assert "Traceback" in left.err
    assert left.err.endswith("ValueError: x; report it\n")
    assert end(lambda: None, "--", "a", "--debug") == (0, "a --debug\n", "")


def test_a_process_without_a_stdout_fails_when_it_writes(
    end: End, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    left = end(lambda: None)
    assert left.code == 74
    assert "stdout must stay open" in left.err
    sys.stdout.close()


class TwoCommands(CommandGroup):
    """Commands in a module of this test."""

    package = "tests_of_command_line"
    table: ClassVar[dict[str, str]] = {"paint": "paint the house", "list": "list the rooms"}


@pytest.fixture
def group(monkeypatch: pytest.MonkeyPatch) -> TwoCommands:
    paint, rooms = ModuleType("paint"), ModuleType("list")
    paint.paint = click.Command("paint", callback=lambda: click.echo("red"))  # type: ignore[attr-defined]
    rooms.list_command = click.Command("list", callback=lambda: click.echo("hall"))  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "tests_of_command_line", ModuleType("tests_of_command_line"))
    monkeypatch.setitem(sys.modules, "tests_of_command_line.paint", paint)
    monkeypatch.setitem(sys.modules, "tests_of_command_line.list", rooms)
    return TwoCommands("house")


@pytest.mark.parametrize(
    ("argument", "code", "shown"),
    [
        ("paint", 0, "red\n"),
        ("list", 0, "hall\n"),
        ("--help", 0, "Commands:\n  paint  paint the house\n  list   list the rooms\n"),
        ("pant", 2, "Error: there is no command 'pant'; did you mean 'paint'?\n"),
        ("xyz", 2, "Error: there is no command 'xyz'; known are paint, list\n"),
    ],
)
def test_a_command_is_loaded_by_its_name_from_the_module_of_that_name(
    argument: str, code: int, shown: str, group: TwoCommands, monkeypatch: pytest.MonkeyPatch
) -> None:
    if argument == "--help":
        # Help loads no command.
        monkeypatch.delitem(sys.modules, "tests_of_command_line.paint")
    result = CliRunner().invoke(group, [argument])
    assert result.exit_code == code
    assert result.output.endswith(shown)
