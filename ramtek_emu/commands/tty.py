"""`ramtek tty`: runs a program that opens a device; a display gets its writes one by one."""

from __future__ import annotations

import os
import platform
import re
import shutil
import signal
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import TYPE_CHECKING, Final, NamedTuple, NoReturn

import click

from ramtek_emu.command_line import ENDING
from ramtek_emu.commands.displays import Handler, handling
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
"""How long the display may take to execute the program's words, with other hosts before it in line."""


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
    place of {} in its arguments. Every write is rounded down to whole words, as the drivers of the time did.
    The program reads the replies of the display from the device. The exit code is the program's, or 128 plus
    the number of the signal that ended it.

    A program that draws with fwrite and putc needs --stream: for a terminal, C's stdio ends a write at every
    byte 0A, even in the middle of a word. Without --stream, the system must separate the writes (Linux 5.5
    and later does, unless a sandbox forbids it); otherwise the program is not run.
    """
    refuse_systems_without_pidfd()
    if shutil.which(program) is None:
        raise MissingInputError(f"a program must be executable, not {program!r}; check its name")

    from ramtek_emu.host.device import DeviceRelay
    from ramtek_emu.host.port import UnixPort

    with ExitStack() as opened, UnixPort(path, WAIT_SECONDS) as port:
        ours, device = opened.enter_context(terminal())
        if link is not None:
            opened.enter_context(linked(link, device))
        command = [word.replace("{}", device) for word in (program, *arguments)]
        with started(command, {**os.environ, DEVICE: device}, not stream) as running:
            relay = DeviceRelay(port, ours, running.notices)
            relay.relay(running.ended)
            code = os.waitstatus_to_exitcode(os.waitpid(running.process, 0)[1])
        relay.finish()
    context.exit(128 - code if code < 0 else code)


def refuse_systems_without_pidfd() -> None:
    """PortError on systems without pidfd, which waits for a process and files together: Linux 5.3 has it."""
    try:
        os.close(os.pidfd_open(os.getpid()))
    except (AttributeError, OSError):
        raise PortError(
            f"a program's device must be made on Linux 5.3 or later, not on {platform.platform(terse=True)}; "
            "pipe the program into `ramtek serve --stdio`"
        ) from None


@contextmanager
def terminal() -> Iterator[tuple[int, str]]:
    """A pseudoterminal in raw mode: our side, and the path of the program's side."""
    import pty
    import tty as terminal_modes

    try:
        ours, theirs = pty.openpty()
    except OSError as error:
        raise PortError(
            f"a program must have a pseudoterminal, and the system gives none ({reason_of(error)}); close a"
            " terminal, or let the program write to a pipe of `ramtek serve --stdio`"
        ) from None
    try:
        terminal_modes.setraw(theirs)
        # Keep the program's side open, so that the program may close and open it as often as it likes.
        yield ours, os.ttyname(theirs)
    finally:
        os.close(theirs)
        os.close(ours)


@contextmanager
def linked(name: str, device: str) -> Iterator[None]:
    """Make a name a link to the device; OutputExistsError or OutputError if that cannot be done.

    The link of a `ramtek tty` that was killed is replaced.
    """
    try:
        if is_stale(name, device):
            os.unlink(name)
        os.symlink(device, name)
    except FileExistsError:
        raise OutputExistsError(
            f"a link must be a new name, not {name}, which exists; choose another"
        ) from None
    except (OSError, ValueError) as cause:
        raise OutputError(
            f"a link must be where a link can be made, not at {name} ({reason_of(cause)}); choose another"
        ) from None
    try:
        yield
    finally:
        with suppress(OSError):
            if os.readlink(name) == device:
                os.unlink(name)


def is_stale(name: str, our_device: str) -> bool:
    """Whether a name is a link to a device that is gone, or whose number is that of our device now."""
    try:
        device = os.readlink(name)
    except OSError:
        return False
    is_terminal = re.fullmatch("/dev/pts/[0-9]+", device) is not None
    return is_terminal and (device == our_device or not os.path.lexists(device))


class Running(NamedTuple):
    """A running program: its process, a file that is readable after its end, and notices of its writes."""

    process: int
    ended: int
    notices: WriteNotices | None


@contextmanager
def started(command: list[str], environment: dict[str, str], with_notices: bool) -> Iterator[Running]:
    """Run a program, with or without notices of its writes.

    Ctrl+C is left to the program, and SIGTERM and SIGHUP are passed on to it. If the display is lost, the
    program gets SIGHUP. Raises PortError if the system gives no notices, MissingInputError if the program
    cannot be run.
    """
    from ramtek_emu.host.device import WriteNotices

    def pass_on(number: int, _: object = None) -> None:
        with suppress(ProcessLookupError):
            signal.pidfd_send_signal(ended, number)

    handlers: dict[int, Handler] = {**dict.fromkeys(ENDING, pass_on), signal.SIGINT: signal.SIG_IGN}
    with ExitStack() as opened:
        # A signal that arrives meanwhile is for the program, too.
        signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
        try:
            process, notices_file = forked(command, environment, with_notices)
            ended = os.pidfd_open(process)
            opened.callback(os.close, ended)
            notices = None if notices_file is None else WriteNotices(notices_file)
            if notices is not None:
                opened.callback(notices.close)
            opened.enter_context(handling(handlers))
        finally:
            signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
        try:
            yield Running(process, ended, notices)
        except PortError:
            pass_on(signal.SIGHUP)
            raise


WITH_NOTICES: Final = b"notices"
WITHOUT: Final = b"none"
"""Messages of a child process before it executes the program; any other message is a failure's reason."""


def forked(command: list[str], environment: dict[str, str], with_notices: bool) -> tuple[int, int | None]:
    """A child process that executes the program, and the file of the notices of its writes.

    PortError if notices are asked for and the system gives none, MissingInputError if the program cannot be
    run. In both cases the child process has ended.
    """
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours:
        process = os.fork()
        if process == 0:
            become(command, environment, theirs, with_notices)
        theirs.close()
        sent, files, _, _ = socket.recv_fds(ours, 1 << 10, 1)
        failure = ours.recv(1 << 10).decode()
    if sent in (WITH_NOTICES, WITHOUT) and not failure:
        return process, files[0] if files else None
    os.waitpid(process, 0)
    for file in files:
        os.close(file)
    if failure:
        raise MissingInputError(f"a program must be executable, not {command[0]!r} ({failure}); check it")
    # Some sandboxes kill a process that asks for notices: then it sent nothing.
    reason = sent.decode() or "asking for it is forbidden"
    raise PortError(
        f"a system must tell one write of a program from the next, and this one does not ({reason}); "
        "give --stream if the program's writes are one stream of bytes"
    )


def become(
    command: list[str], environment: dict[str, str], parent: socket.socket, with_notices: bool
) -> NoReturn:
    """In the child: send the file of the notices to the parent and execute the program, or exit."""
    from ramtek_emu.host.device import ask_for_notices

    try:
        for number in (*ENDING, signal.SIGPIPE):
            if number == signal.SIGPIPE or signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
        if with_notices:
            socket.send_fds(parent, [WITH_NOTICES], [ask_for_notices()])
        else:
            parent.send(WITHOUT)
        os.execvpe(command[0], command, environment)
    except (OSError, ValueError) as cause:
        parent.send(reason_of(cause).encode())
    finally:
        os._exit(127)
