"""What the commands share: the display, the streams that are read, and what is written at the end."""

from __future__ import annotations

import difflib
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, Final, TypeVar

import click

from ramtek_emu.errors import ConfigurationError, MissingInputError
from ramtek_emu.writing import Output, refuse_output, write_atomically

if TYPE_CHECKING:
    from ramtek_emu.configuration import Configuration
    from ramtek_emu.display import Ramtek9300

Function = TypeVar("Function", bound=Callable[..., object])

TICK_SECONDS: Final = 0.01
"""How long a host is served between two looks at the window."""


def display_options(function: Function) -> Function:
    """The options of every command that has a display: which one, and what is written of it at the end."""
    for option in (
        click.option("--force", is_flag=True, help="Overwrite what exists."),
        click.option("--configuration", metavar="NAME", help="The display; GMR_9300 if not given."),
        click.option(
            "--start", type=click.Path(), metavar="SNAPSHOT", help="Go on with the display of a snapshot."
        ),
        click.option("--record", type=click.Path(), metavar="OUT", help="Keep the words that are sent."),
        click.option(
            "--snapshot", type=click.Path(), metavar="PNG", help="Keep the display: words, table, parameters."
        ),
        click.option("-o", "--output", type=click.Path(), metavar="PNG", help="The picture at the end."),
    ):
        function = option(function)
    return function


def configuration_named(name: str | None) -> Configuration:
    """The configuration of that name, capitals or not; ConfigurationError names those there are."""
    from ramtek_emu.configuration import CONFIGURATIONS, GMR_9300

    if name is None:
        return GMR_9300
    asked = name.upper().replace("-", "_")
    if asked not in CONFIGURATIONS:
        near = [each for each in CONFIGURATIONS if each.startswith(asked)]
        near = near or difflib.get_close_matches(asked, CONFIGURATIONS, n=1)
        advice = f"did you mean {near[0]}?" if near else "choose one of them"
        raise ConfigurationError(
            f"a configuration must be one of {', '.join(sorted(CONFIGURATIONS))}, not {name!r}; {advice}"
        )
    return CONFIGURATIONS[asked]


def display_asked_for(configuration: str | None, start: str | None) -> Ramtek9300:
    """A display of that configuration just switched on, or the one of a snapshot."""
    if start is not None:
        if configuration is not None:
            raise click.UsageError("a display must be given by --configuration or --start; leave one out")
        from ramtek_emu.snapshot.snapshot import read_snapshot

        return read_snapshot(start)
    from ramtek_emu.display import Ramtek9300

    return Ramtek9300(configuration_named(configuration))


def refuse_outputs(force: bool, *paths: str | None) -> None:
    """Refuse outputs that cannot be made, before anything is done; None is no output."""
    for path in paths:
        if path is not None:
            if path in ("", "-"):
                raise click.UsageError(f"an output must be the name of a file, not {path!r}; give it one")
            refuse_output(path, force)


@contextmanager
def recording(path: str | None, force: bool) -> Iterator[Callable[[bytes], object] | None]:
    """What is to be given the words of whole instructions; their file is there once all went well."""
    if path is None:
        yield None
        return
    with Output(path, overwrite=force) as output:
        yield output.write
        output.keep()
    tell(f"wrote {path}")


def write_outputs(display: Ramtek9300, output: str | None, snapshot: str | None, force: bool) -> None:
    """Write the picture and the snapshot, whichever is asked for, and say so on stderr."""
    if output is not None:
        from ramtek_emu.png import png_bytes

        write_atomically(output, png_bytes(display.field()), overwrite=force)
        tell(f"wrote {output}")
    if snapshot is not None:
        from ramtek_emu.snapshot.snapshot import write_snapshot

        write_snapshot(display, snapshot, overwrite=force)
        tell(f"wrote {snapshot}")


def open_stream(path: str) -> BinaryIO:
    """A file of words to read, `-` for stdin; MissingInputError when there is none."""
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
        reason = (getattr(cause, "strerror", None) or str(cause)).lower()
        raise MissingInputError(
            f"a stream must be a file that can be read, not {path!r} ({reason}); check the name"
        ) from None


def reader_of(file: BinaryIO) -> Callable[[int], bytes]:
    """What gives the bytes that are there, at most so many, without waiting for more; nothing at the end."""
    number = file.fileno()

    def read(most: int) -> bytes:
        try:
            return os.read(number, most)
        except OSError as cause:
            reason = (cause.strerror or str(cause)).lower()
            raise MissingInputError(
                f"a stream must be readable to its end, and it is not ({reason}); try a copy of it"
            ) from None

    return read


def tell(message: str) -> None:
    """Say something that is no answer: on stderr."""
    click.echo(message, err=True)


def show(display: Ramtek9300, serve_for: Callable[[float], None]) -> None:
    """Show the display in a window until it is closed; `serve_for` is called between its fields."""
    from ramtek_emu.monitor.window import Monitor

    name = display.configuration.name.replace("_", " ")
    # Ctrl+C closes the window; what is to be written at the end is written.
    with suppress(KeyboardInterrupt):
        Monitor(display, f"RAMTEK {name}", on_tick=lambda: serve_for(TICK_SECONDS)).run()


def tell_the_end(display: Ramtek9300, held_words: int, odd_byte: bytes) -> None:
    """Say what of a stream was not done: what is no instruction or has no effect, and what is not whole."""
    illegal = display.processor.illegal_words
    if illegal:
        tell(f"{illegal} {'word begins' if illegal == 1 else 'words begin'} no instruction: skipped")
    unknown = display.processor.unimplemented
    if unknown:
        plural = "instruction is" if unknown == 1 else "instructions are"
        tell(f"{unknown} {plural} known by name only: without effect")
    if held_words:
        tell(f"the stream ends within an instruction: its {held_words} words were dropped")
    if odd_byte:
        tell("the stream ends within a word: its last byte was dropped")
