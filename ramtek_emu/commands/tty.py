"""`ramtek tty`: a program that opens a device, whose writes a display gets one by one."""

from __future__ import annotations

import os
import platform
import shutil
import signal
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import TYPE_CHECKING, Final, NamedTuple, NoReturn

import click

from ramtek_emu.commands.displays import tell
from ramtek_emu.errors import MissingInputError, OutputError, OutputExistsError, PortError, reason_of

if TYPE_CHECKING:
    from ramtek_emu.host.device import WriteNotices

EXAMPLES: Final = """\b
Examples:
  ramtek serve --unix /tmp/display --window &
  ramtek tty /tmp/display -- old_program {}              {} is the device's path
  ramtek tty /tmp/display -- sh -c 'old_program > $RAMTEK_DEVICE < $RAMTEK_DEVICE'
  ramtek tty --link /tmp/ramtek /tmp/display -- old_program
"""

DEVICE: Final = "RAMTEK_DEVICE"
WAIT_SECONDS: Final = 600.0
"""How long the display may serve other hosts before it gets to the end of what this program wrote."""


@click.command(epilog=EXAMPLES)
@click.option("--stream", is_flag=True, help="Do not round writes down: for programs that use C's stdio.")
@click.option(
    "--link", type=click.Path(), metavar="NAME", help="Make NAME a link to the device while PROGRAM runs."
)
@click.argument("path", type=click.Path())
@click.argument("program")
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
@click.pass_context
def tty(
    context: click.Context,
    stream: bool,
    link: str | None,
    path: str,
    program: str,
    arguments: tuple[str, ...],
) -> None:
    """Run PROGRAM with its device on the display that `ramtek serve --unix PATH` makes.

    The device is a pseudoterminal: the program finds its path in the environment as RAMTEK_DEVICE, and in
    place of {} in its arguments. Each of its writes is rounded down to whole words by itself, as the drivers
    of the time did, and the replies of the display can be read there. The exit code is the program's, or 128
    and the number of the signal that ended it.

    A program that draws with fwrite and putc needs --stream: for a terminal, C's stdio ends a write at each
    byte 0A, wherever that is in a word.
    """
    refuse_systems_without_pidfd()
    if shutil.which(program) is None:
        raise MissingInputError(f"a program must be one that can be run, not {program!r}; check its name")

    from ramtek_emu.host.device import DeviceRelay
    from ramtek_emu.host.port import UnixPort

    with ExitStack() as opened, UnixPort(path, WAIT_SECONDS) as port:
        ours, device = opened.enter_context(terminal())
        if link is not None:
            opened.enter_context(linked(link, device))
        command = [each.replace("{}", device) for each in (program, *arguments)]
        with started(command, {**os.environ, DEVICE: device}, not stream) as running:
            if running.notices is None and not stream:
                tell(
                    "warning: this system does not tell one write of a program from the next "
                    f"({running.reason}): those in quick succession may be taken as one"
                )
            relay = DeviceRelay(port, ours, running.notices, stream)
            relay.relay(running.ended)
            code = os.waitstatus_to_exitcode(os.waitpid(running.process, 0)[1])
        relay.finish()
    context.exit(128 - code if code < 0 else code)


def refuse_systems_without_pidfd() -> None:
    """PortError where a process cannot be waited for together with files: on Linux since 5.3 it can."""
    try:
        os.close(os.pidfd_open(os.getpid()))
    except (AttributeError, OSError):
        raise PortError(
            f"a program's device must be made on Linux 5.3 or later, not on {platform.platform(terse=True)}; "
            "pipe the program into `ramtek serve --stdio`"
        ) from None


@contextmanager
def terminal() -> Iterator[tuple[int, str]]:
    """A pseudoterminal in raw mode: our side, and the path of the other."""
    import pty
    import tty as terminal_modes

    ours, theirs = pty.openpty()
    try:
        terminal_modes.setraw(theirs)
        # Their side stays open here, so that the program may close and open it as often as it likes.
        yield ours, os.ttyname(theirs)
    finally:
        os.close(theirs)
        os.close(ours)


@contextmanager
def linked(name: str, device: str) -> Iterator[None]:
    """Make a name a link to the device; OutputExistsError or OutputError if that cannot be done."""
    try:
        os.symlink(device, name)
    except FileExistsError:
        raise OutputExistsError(
            f"a link must be a new name, not {name}, which exists; choose another"
        ) from None
    except (OSError, ValueError) as cause:
        raise OutputError(
            f"a link must be made where it can, not at {name} ({reason_of(cause)}); choose another"
        ) from None
    try:
        yield
    finally:
        with suppress(OSError):
            if os.readlink(name) == device:
                os.unlink(name)


class Running(NamedTuple):
    """A program: its process, a file that can be read when it has ended, and notices of its writes."""

    process: int
    ended: int
    notices: WriteNotices | None
    reason: str
    """Why there are no notices."""


@contextmanager
def started(command: list[str], environment: dict[str, str], with_notices: bool) -> Iterator[Running]:
    """Run a program; Ctrl+C is left to it, other signals to end are passed on. It is hung up on an error."""
    from ramtek_emu.host.device import WriteNotices

    process, reason, number, failure = forked(command, environment, with_notices)
    if not reason:
        # Some sandboxes end a process that asks for notices.
        os.waitpid(process, 0)
        process, _, number, failure = forked(command, environment, with_notices=False)
        reason = "asking for it is forbidden"
    notices = None if number is None else WriteNotices(number)
    ended = os.pidfd_open(process)

    def pass_on(number: int, _: object = None) -> None:
        with suppress(ProcessLookupError):
            signal.pidfd_send_signal(ended, number)

    before = {
        signal.SIGINT: signal.signal(signal.SIGINT, signal.SIG_IGN),
        signal.SIGTERM: signal.signal(signal.SIGTERM, pass_on),
        signal.SIGHUP: signal.signal(signal.SIGHUP, pass_on),
    }
    try:
        if failure:
            os.waitpid(process, 0)
            raise MissingInputError(
                f"a program must be one that can be run, not {command[0]!r} ({failure}); check it"
            )
        yield Running(process, ended, notices, reason)
    except PortError:
        pass_on(signal.SIGHUP)
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        os.close(ended)
        if notices is not None:
            notices.close()


def forked(
    command: list[str], environment: dict[str, str], with_notices: bool
) -> tuple[int, str, int | None, str]:
    """A process that becomes the program, what it says of the notices, their file, and why it failed."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours:
        process = os.fork()
        if process == 0:
            become(command, environment, theirs, with_notices)
        theirs.close()
        said, numbers, _, _ = socket.recv_fds(ours, 1 << 10, 1)
        failure = ours.recv(1 << 10)
    return process, said.decode(), numbers[0] if numbers else None, failure.decode()


def become(
    command: list[str], environment: dict[str, str], parent: socket.socket, with_notices: bool
) -> NoReturn:
    """Become the program, after telling the parent the file of the notices, or why there is none."""
    from ramtek_emu.host.device import ask_for_notices

    try:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        try:
            socket.send_fds(parent, [b"told of"], [ask_for_notices()] if with_notices else [])
        except OSError as cause:
            parent.send(reason_of(cause).encode())
        try:
            os.execvpe(command[0], command, environment)
        except (OSError, ValueError) as cause:
            parent.send(reason_of(cause).encode())
    finally:
        os._exit(127)
