"""Shared parts of commands: the display, input streams, output files, the window, signals."""

from __future__ import annotations

import math
import os
import select
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, BinaryIO, Final, TypeVar

import click
from click.core import ParameterSource

from ramtek_emu.command_line import ENDING, SIGNALS, report
from ramtek_emu.configuration import CONFIGURATIONS, GMR_9300, Configuration
from ramtek_emu.errors import MissingInputError, RamtekError, WordsError, reason_of
from ramtek_emu.writing import PNG, Output, check_suffix, refuse_output, same_outputs

if TYPE_CHECKING:
    from ramtek_emu.display import Ramtek9300
    from ramtek_emu.host.server import HostSession, Record
    from ramtek_emu.inspection.stream import Stream
    from ramtek_emu.monitor.window import Monitor

Function = TypeVar("Function", bound=Callable[..., object])


def complete_configurations(_: click.Context, __: click.Parameter, incomplete: str) -> list[str]:
    """The names of configurations, for completion in a shell, in upper or lower case."""
    names = [name.lower().replace("_", "-") for name in CONFIGURATIONS]
    names += [f"{name}-monochrome" for name in names]
    return [name for name in names if name.startswith(incomplete.lower().replace("_", "-"))]


configuration_option: Final = click.option(
    "--configuration",
    metavar="NAME",
    shell_complete=complete_configurations,
    help="The display; GMR_9300 if not given. NAME-monochrome has a black-and-white monitor.",
)
table_option: Final = click.option(
    "--table",
    # `scan_out.TABLES`, whose module would import numpy for each command.
    type=click.Choice(["gray", "gray8"]),
    help="Show the words in gray, by their rank or by their low eight bits, not through the display's table.",
)
start_option: Final = click.option(
    "--start", type=click.Path(), metavar="SNAPSHOT", help="Go on with the display of a snapshot."
)


def display_options(function: Function) -> Function:
    """Add the options of all commands with a display: the configuration, and the files to write."""
    for option in (
        click.option("--force", is_flag=True, help="Overwrite what exists."),
        configuration_option,
        table_option,
        start_option,
        click.option("--record", type=click.Path(), metavar="OUT", help="Record the words that are sent."),
        click.option(
            "--snapshot", type=click.Path(), metavar="PNG", help="Save the display: words, table, parameters."
        ),
        click.option("-o", "--output", type=click.Path(), metavar="PNG", help="The picture at the end."),
    ):
        function = option(function)
    return function


def display_asked_for(
    configuration: str | None, start: str | None = None, table: str | None = None
) -> Ramtek9300:
    """A new display of the configuration, GMR_9300 if None, or the display of the snapshot `start`.

    It is shown through the table of grays `table`, None for its own.
    """
    if start is None:
        from ramtek_emu.display import Ramtek9300

        display = Ramtek9300(GMR_9300 if configuration is None else configuration)
    elif configuration is not None:
        raise click.UsageError("a display must be given by --configuration or --start; leave one out")
    else:
        from ramtek_emu.snapshot import read_snapshot

        display = read_snapshot(start)
    display.scan_out.shown_table = table or ""
    return display


def refuse_given(context: click.Context, where: str, *options: str) -> None:
    """Refuse options of the command line that have no effect, such as "without --film"."""
    for option in options:
        if context.get_parameter_source(option) is ParameterSource.COMMANDLINE:
            name = f"--{option.replace('_', '-')}"
            raise click.UsageError(f"{name} must not be given {where}, where it has no effect; leave it out")


def refuse_outputs(force: bool, *paths: str | None, pictures: Sequence[str | None] = ()) -> None:
    """Refuse outputs that cannot be written; call it before the work. None means no output.

    `pictures` are further outputs, which are PNG files.
    """
    outputs = [path for path in (*paths, *pictures) if path is not None]
    for path in outputs:
        if path in ("", "-"):
            raise click.UsageError(f"an output must be the name of a file, not {path!r}; give it one")
        if path in pictures:
            check_suffix(path, PNG, "a picture")
        refuse_output(path, force)
    if same := same_outputs(outputs):
        raise click.UsageError(
            f"two outputs must be two files, not {same[0]} and {same[1]}, which are the same; rename one"
        )


WAIT_SECONDS: Final = 0.1
"""Limit: how long a signal may be unnoticed while nothing arrives."""
REST_SECONDS: Final = 1.0
"""Assumed: a host that sends nothing for so long has drawn its picture and loaded its table."""


class Run:
    """A display that runs for hosts or from a file, the signal that ends it, and its outputs.

    A signal is remembered, and noticed between two instructions, between two slices of a long instruction,
    and while waiting for the host. An instruction that a signal cuts off stays half drawn in the picture and
    in the snapshot. It counts as not executed, and the recording ends with the instruction before it. If an
    output cannot be written, that is reported, and the display goes on with its other outputs.
    """

    def __init__(self) -> None:
        self.signal = 0
        """The number of the first signal that is to end the display; 0 if there was none."""
        self.exit_code = 0
        """The exit code of the first failure; 0 if there was none."""
        self.record: Record | None = None
        """Records words; None if no recording was asked for."""
        self.hints: set[str] = set()
        """The subjects of the hints that were printed."""
        self._rest = 0, math.inf
        """The count of words received, and the time at which their host is at rest."""

    def hint(self, display: Ramtek9300) -> str:
        """Print a hint, once, about words that are all black, and about an instruction that is missing.

        Returns the new hints; "" if there are none.
        """
        hints, foreign = {}, display.processor.foreign
        if "dark" not in self.hints and display.scan_out.is_dark:
            hints["dark"] = "words were drawn, and nothing is lit: --table gray shows them (F2 in a window)"
        if "foreign" not in self.hints and foreign is not None:
            hints["foreign"] = f"a 9300 does not take {foreign}, but the display FAMILY does"
        self.hints |= hints.keys()
        for hint in hints.values():
            report(hint)
        return "; ".join(hints.values())

    def hint_at_rest(self, display: Ramtek9300, seconds: float) -> str:
        """Print the hints once the host has sent no words for REST_SECONDS; returns them as `hint` does.

        `seconds` is the time of any clock; call this function in each turn of a window.
        """
        words, rests_at = self._rest
        if display.words_received != words:
            self._rest = display.words_received, seconds + REST_SECONDS
        elif seconds >= rests_at:
            self._rest = words, math.inf
            return self.hint(display)
        return ""

    def receive(self, number: int, _: object) -> None:
        """Remember a signal."""
        self.signal = self.signal or number

    @property
    def ends(self) -> bool:
        """Whether a signal is to end the display."""
        return self.signal != 0

    def wait(self, file: int, to_write: bool = False) -> bool:
        """Wait until a file can be read, or written; False after a signal."""
        read, write = ([], [file]) if to_write else ([file], [])
        while not self.signal:
            # Windows cannot wait for a pipe.
            if os.name == "nt" or any(select.select(read, write, [], WAIT_SECONDS)):
                return True
        return False

    def attempt(self, write: Callable[[], object]) -> bool:
        """Write an output, and return True; if that fails, report the reason and return False."""
        try:
            write()
        except RamtekError as failure:
            self.fail(failure)
            return False
        return True

    def fail(self, failure: RamtekError) -> None:
        """Report a failure; the command ends with the exit code of the first."""
        report(f"ramtek: {failure}")
        self.exit_code = self.exit_code or failure.exit_code


@contextmanager
def running(
    display: Ramtek9300,
    output: str | None = None,
    snapshot: str | None = None,
    record: str | None = None,
    force: bool = False,
) -> Iterator[Run]:
    """Run a display in a `with` block. At its end the recording, the picture and the snapshot are written.

    SIGINT, SIGTERM and SIGHUP end the display, but no output is lost: see `Run`. If an output failed, the
    command ends with its exit code. After any other error, no output is written.
    """
    run = Run()
    with ExitStack() as handled, ExitStack() as opened:
        for number in ENDING:
            # A signal that the program's parent ignores stays ignored.
            if signal.getsignal(number) is not signal.SIG_IGN:
                handled.callback(signal.signal, number, signal.signal(number, run.receive))
        if record is not None:
            recording = opened.enter_context(Output(record, overwrite=force))

            def record_words(data: bytes) -> None:
                nonlocal record
                if record is not None and not run.attempt(lambda: recording.write(data)):
                    report("the display goes on without its recording")
                    record = None
                    opened.close()

            run.record = record_words
        yield run
        run.hint(display)
        if record is not None and run.attempt(recording.keep):
            report(f"wrote {record}")
        if output is not None and run.attempt(lambda: display.save_png(output, overwrite=force)):
            report(f"wrote {output}")
        if snapshot is not None:
            from ramtek_emu.snapshot import write_snapshot

            if run.attempt(lambda: write_snapshot(display, snapshot, overwrite=force)):
                report(f"wrote {snapshot}")
        # A signal that was noticed must not end the command a second time.
        SIGNALS.ignored = run.ends
    if run.exit_code:
        raise click.exceptions.Exit(run.exit_code)


def open_stream(path: str) -> BinaryIO:
    """The input file, stdin for `-`; MissingInputError if it cannot be read."""
    if path == "-":
        if sys.stdin is None:
            raise MissingInputError("a stream must come from stdin, which is closed; name a file instead")
        return sys.stdin.buffer
    try:
        return open(path, "rb")
    except (OSError, ValueError) as cause:
        raise MissingInputError(
            f"a stream must be a file that can be read, not {path!r} ({reason_of(cause)}); check the name"
        ) from None


MOST_READ: Final = 1 << 28
"""Limit: bytes of a stream that is read whole, about 430 pictures of 640 x 480 words."""


def read_stream(path: str, configuration: Configuration) -> Stream:
    """The instructions of a file, or of stdin for `-`; an incomplete end is reported.

    Raises MissingInputError if it cannot be read, and WordsError if it is too long.
    """
    import numpy as np

    from ramtek_emu.inspection.stream import Stream

    with open_stream(path) as file:
        try:
            data = file.read(MOST_READ + 1)
        except OSError as cause:
            raise unreadable(cause) from None
    if len(data) > MOST_READ:
        raise WordsError(
            f"a stream must be at most {MOST_READ:,} bytes here, not more ({path}); give a part of it"
        )
    words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)
    stream = Stream(configuration, words)
    tell_incomplete(f"the stream {path}", len(words) - int(stream.ends[-1]), len(data) % 2 != 0)
    return stream


def unreadable(cause: OSError) -> MissingInputError:
    """The error for a stream that was opened and cannot be read to its end."""
    return MissingInputError(
        f"a stream must be readable to its end, not fail ({reason_of(cause)}); try a copy of it"
    )


TICK_SECONDS: Final = 0.01
"""How long a host is served before the window is handled again."""


def show(
    monitor: Monitor,
    run: Run,
    is_busy: Callable[[], bool] = lambda: False,
    may_hint: Callable[[], bool] = lambda: True,
) -> None:
    """Show a window with hints until it is closed, or a signal ends the display.

    While `is_busy()` is true, the window does not wait for input. While `may_hint()` is false, no hints are
    shown.
    """
    from ramtek_emu.monitor.window import TICK_MILLISECONDS

    monitor.open()
    try:
        while not run.ends and monitor.step(0 if is_busy() else TICK_MILLISECONDS):
            if may_hint() and (hint := run.hint_at_rest(monitor.display, time.monotonic())):
                monitor.tell(hint)
    finally:
        monitor.close()


def tell_the_end(session: HostSession, run: Run) -> None:
    """Report words that were not executed: illegal words, instructions without effect, an incomplete end.

    After a signal, the end of the words that were read says nothing about the stream.
    """
    processor = session.display.processor
    if illegal := processor.illegal_words:
        report(f"words that begin no instruction, skipped: {illegal}")
    if unknown := processor.unimplemented:
        report(f"instructions known by name only, without effect: {unknown}")
    tell_unexecuted(session)
    if not run.ends:
        tell_incomplete("the stream", session.display.decoder.pending_words, session.odd_byte != b"")


def tell_unexecuted(session: HostSession) -> None:
    """Report that the display has ended within the words of a host."""
    if session.unexecuted:
        report("the display ended before it had executed all words of the host")


def tell_incomplete(stream: str, words: int, has_odd_byte: bool) -> None:
    """Report the words of an instruction, and the byte, that begin at the end of a stream."""
    if words:
        dropped = "word was" if words == 1 else f"{words} words were"
        report(f"{stream} ends within an instruction: its {dropped} dropped")
    if has_odd_byte:
        report(f"{stream} ends within a word: its last byte was dropped")
