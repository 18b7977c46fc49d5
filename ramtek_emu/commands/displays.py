"""Shared parts of commands: the display, input streams, output files, the window, signals."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, Final, TypeVar

import click

from ramtek_emu.configuration import CONFIGURATIONS, GMR_9300
from ramtek_emu.errors import MissingInputError, reason_of
from ramtek_emu.writing import Output, refuse_output, same_outputs, write_atomically

if TYPE_CHECKING:
    from ramtek_emu.display import Ramtek9300
    from ramtek_emu.host.pipe import Read
    from ramtek_emu.host.server import HostSession


Function = TypeVar("Function", bound=Callable[..., object])


def complete_configurations(_: click.Context, __: click.Parameter, incomplete: str) -> list[str]:
    """The names of configurations, for completion in a shell, in upper or lower case."""
    return [name for name in CONFIGURATIONS if name.startswith(incomplete.upper())]


def display_options(function: Function) -> Function:
    """Add the options of all commands with a display: the configuration, and the files to write."""
    for option in (
        click.option("--force", is_flag=True, help="Overwrite what exists."),
        click.option(
            "--configuration",
            metavar="NAME",
            shell_complete=complete_configurations,
            help="The display; GMR_9300 if not given.",
        ),
        click.option(
            "--start", type=click.Path(), metavar="SNAPSHOT", help="Go on with the display of a snapshot."
        ),
        click.option("--record", type=click.Path(), metavar="OUT", help="Record the words that are sent."),
        click.option(
            "--snapshot", type=click.Path(), metavar="PNG", help="Save the display: words, table, parameters."
        ),
        click.option("-o", "--output", type=click.Path(), metavar="PNG", help="The picture at the end."),
    ):
        function = option(function)
    return function


def display_asked_for(configuration: str | None, start: str | None = None) -> Ramtek9300:
    """A new display of the configuration, GMR_9300 if None, or the display of the snapshot `start`."""
    if start is not None:
        if configuration is not None:
            raise click.UsageError("a display must be given by --configuration or --start; leave one out")
        from ramtek_emu.snapshot import read_snapshot

        return read_snapshot(start)
    from ramtek_emu.display import Ramtek9300

    return Ramtek9300(GMR_9300 if configuration is None else configuration)


def refuse_outputs(force: bool, *paths: str | None) -> None:
    """Refuse outputs that cannot be written; call it before the work. None means no output."""
    for path in paths:
        if path is not None:
            if path in ("", "-"):
                raise click.UsageError(f"an output must be the name of a file, not {path!r}; give it one")
            refuse_output(path, force)
    if same := same_outputs(path for path in paths if path is not None):
        raise click.UsageError(
            f"two outputs must be two files, not {same[0]} and {same[1]}, which are the same; rename one"
        )


@contextmanager
def recording(path: str | None, force: bool) -> Iterator[Callable[[bytes], object] | None]:
    """A function that records words in a file, or None without a path; the file appears if nothing fails."""
    if path is None:
        yield None
        return
    with Output(path, overwrite=force) as output:
        yield output.write
        output.keep()
    tell(f"wrote {path}")


def write_outputs(display: Ramtek9300, output: str | None, snapshot: str | None, force: bool) -> None:
    """Write the picture and the snapshot, if asked for, and report their names on stderr."""
    if output is not None:
        from ramtek_emu.png import png_bytes

        write_atomically(output, png_bytes(display.field()), overwrite=force)
        tell(f"wrote {output}")
    if snapshot is not None:
        from ramtek_emu.snapshot import write_snapshot

        write_snapshot(display, snapshot, overwrite=force)
        tell(f"wrote {snapshot}")


def open_stream(path: str) -> BinaryIO:
    """The input file, stdin for `-`; MissingInputError if it cannot be read."""
    if path == "":
        raise click.UsageError("an input must be the name of a file, not ''; give it one")
    if path == "-":
        if sys.stdin is None:
            raise MissingInputError("a stream must come from stdin, which is closed; name a file instead")
        return sys.stdin.buffer
    try:
        if Path(path).is_dir():
            raise MissingInputError(f"a stream must be a file, not the folder {path}; name a file in it")
        return open(path, "rb")
    except MissingInputError:
        raise
    except (OSError, ValueError) as cause:
        raise MissingInputError(
            f"a stream must be a file that can be read, not {path!r} ({reason_of(cause)}); check the name"
        ) from None


def reader_of(file: BinaryIO) -> Callable[[int], bytes]:
    """A function `read(most)` that returns the available bytes, up to `most`; none at the end."""
    number = file.fileno()

    def read(most: int) -> bytes:
        try:
            return os.read(number, most)
        except OSError as cause:
            raise MissingInputError(
                f"a stream must be readable to its end, not fail ({reason_of(cause)}); try a copy of it"
            ) from None

    return read


def tell(message: str) -> None:
    """Print a message on stderr; stdout is for results."""
    click.echo(message, err=True)


class EndSignals:
    """Remembers Ctrl+C or a termination signal, which end a server without an error."""

    def __init__(self) -> None:
        self.received = False
        self._waiting = False

    def receive(self, *_: object) -> None:
        """Remember the signal, and interrupt a read that is waiting."""
        self.received = True
        if self._waiting:
            raise InterruptedError

    def until_received(self, read: Read) -> Read:
        """A function like `read` that returns no bytes after the signal, or if reading fails."""

        def read_until_received(most: int) -> bytes:
            try:
                self._waiting = True
                return b"" if self.received else read(most)
            except OSError:
                # A terminal or a socket also raises it after its other end was closed.
                return b""
            finally:
                self._waiting = False

        return read_until_received


@contextmanager
def end_signals() -> Iterator[EndSignals]:
    """Handle Ctrl+C and termination signals within a `with` block."""
    signals = EndSignals()
    before = {number: signal.signal(number, signals.receive) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield signals
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


TICK_SECONDS: Final = 0.01
"""How long a host is served before the window is handled again."""


def show(
    display: Ramtek9300, serve_for: Callable[[float], None], waits: Callable[[], bool] = lambda: False
) -> None:
    """Show the display in a window until the window is closed; `serve_for` is called at each tick.

    While `waits()` is true, `serve_for` itself waits for a host's words, and the window does not wait for
    input.
    """
    # Signals close the window between two ticks, never while a host is served; outputs are still written.
    with end_signals() as signals:
        from ramtek_emu.monitor.window import TICK_MILLISECONDS, Monitor

        def tick() -> None:
            if signals.received:
                monitor.close()
            else:
                serve_for(TICK_SECONDS)

        monitor = Monitor(display, f"RAMTEK {display.configuration.name.replace('_', ' ')}", on_tick=tick)
        monitor.open()
        try:
            while monitor.is_open:
                monitor.step(0 if waits() else TICK_MILLISECONDS)
        finally:
            monitor.close()


def tell_the_end(session: HostSession) -> None:
    """Report words that were not executed: illegal words, instructions without effect, an incomplete end."""
    processor = session.display.processor
    illegal, unknown = processor.illegal_words, processor.unimplemented
    if illegal:
        tell(f"{illegal} {'word begins' if illegal == 1 else 'words begin'} no instruction: skipped")
    if unknown:
        plural = "instruction is" if unknown == 1 else "instructions are"
        tell(f"{unknown} {plural} known by name only: without effect")
    if rest := session.display.decoder.pending_words:
        tell(f"the stream ends within an instruction: its {rest} words were dropped")
    if session.odd_byte:
        tell("the stream ends within a word: its last byte was dropped")
