"""Server: a display behind a listening socket, for one host after the other.

What is modeled: the host interface as a stream of words, low byte first in both directions (Hardware: PRG,
JPL, V8K: the words of a PDP-11's or a VAX's memory); instructions cut anywhere; replies in order and as soon
as they exist; whole words: a write of odd length is rounded down (Hardware: PRG DRIVER.c, V8K). A Unix socket
separates the writes of a host, and every write is rounded down. TCP does not mark the ends of writes: only
the odd byte at the end of the session is dropped. What is **not** modeled: the UNIBUS registers and their
interrupts, and the errors of a driver. PRG DRIVER.c refuses a second open with EACCES and V8K with ENXIO;
here the second host waits in line.

No call blocks longer than its argument allows, so that a window can be drawn in between: `step` reads the
bytes that have arrived, sends as many replies as the socket takes, and returns. When a host leaves, all its
words are executed first. Then its unfinished instruction and its unread replies are dropped, the memories
stay as they are, and the next host is served. Hosts that connect meanwhile wait in line: the system stores
the connections of 128 hosts with the words they have sent; further hosts try again until there is a place.

Limit: a host is disconnected if nothing is sent or received for `idle_seconds`. The clock of a host starts
when its turn comes, so that waiting in line costs nothing, and a silent host holds up the line for
`idle_seconds` at most. While REPLY_BYTES of replies wait for the host, nothing more is read from it.
"""

from __future__ import annotations

import errno
import os
import secrets
import selectors
import socket
import stat
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Final, Self

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.arrays import Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import OutputError, OutputExistsError, PortError, reason_of
from ramtek_emu.host.port import (
    break_off,
    keeps_writes,
    packet_socket,
    prepared,
    read_socket,
    ready,
    write_socket,
)
from ramtek_emu.instruction_set.instruction import NO_WORDS

Record = Callable[[bytes], object]
"""A function that records the bytes of whole instructions, in order."""

SLICE_SECONDS: Final = 0.004
"""How long words are executed before the session pauses; a long instruction has pauses within it."""
HOST_SECONDS: Final = 0.005
"""How long the input of a window may wait while a connected host sends nothing. Its words never wait."""
REPLY_PIECE: Final = 1 << 15
"""The words of waiting replies at which the session pauses, and the most that are returned at once."""


class HostSession:
    """Hosts at a display: passes the bytes of their words on and the bytes of replies back, on any wire.

    The session pauses often: a window is served in between, a signal is noticed, and replies are taken before
    they outgrow the processor's bound. The words that are left begin with the instruction in progress. When
    instructions are executed, their words are recorded and leave.
    """

    def __init__(self, display: Ramtek9300, record: Record | None = None) -> None:
        self.display = display
        self.is_stopped = False
        """Whether a program lets its hosts wait: nothing is executed, and replies are still passed on."""
        self.is_within = False
        """Whether the first instruction that is left is half executed."""
        self.odd_byte = b""
        """The first byte of a word whose second byte has not arrived."""
        self._left = NO_WORDS
        self.record = record
        self.leave()

    @property
    def unexecuted(self) -> int:
        """The number of words that have arrived and are not executed.

        A half-drawn instruction counts with all its words. The words of an incomplete instruction do not
        count once all words before them are executed.
        """
        return len(self._left) - self.display.decoder.pending_words

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Pass bytes of the host to the display, and yield the replies, or no bytes, at every pause.

        The session goes on when the iterator is asked for more.
        """
        data = self.odd_byte + data
        self.odd_byte = data[len(data) & ~1 :]
        words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)
        self._left = np.concatenate((self._left, words)) if len(self._left) else words
        return self._execute(words)

    def _execute(self, words: Words) -> Iterator[bytes]:
        processor, clock = self.display.processor, time.perf_counter
        while self.unexecuted and self.is_stopped:
            yield b""
        steps = self.display.send_stepwise(words)
        place = 0
        while self.unexecuted:
            due, before = clock() + SLICE_SECONDS, place
            for step in steps:
                before, place = place, step
                if self.is_stopped or clock() >= due or processor.waiting >= REPLY_PIECE:
                    # A pause within an instruction has the number of the pause before.
                    self.is_within = place == before
                    break
            else:
                self.is_within = False
            if executed := len(self._left) - len(words) + place if place else 0:
                self._record(self._left[:executed])
                self._left = words[place:]
            was_within, resets = self.is_within, self.display.resets
            yield self._reply()
            while processor.waiting or (self.unexecuted and self.is_stopped):
                yield self._reply()
            if was_within and self.display.resets != resets:
                # Leave the instruction that the reset abandoned out of the recording.
                place = next(steps)
                self._left = words[place:]

    def _record(self, words: Words) -> None:
        if self.record is not None:
            self.record(words.astype("<u2", copy=False).tobytes())

    def _reply(self) -> bytes:
        count = min(self.display.processor.waiting, REPLY_PIECE)
        return self.display.receive(count).astype("<u2", copy=False).tobytes()

    def reset(self) -> None:
        """Reset the display; the recording gets a reset at the same place.

        The incomplete instruction and the unread replies are dropped; the odd byte stays, since the stream of
        bytes goes on.
        """
        self._left = self._left[self.display.decoder.pending_words :]
        self.is_within = False
        self.display.reset()
        self._record(instructions.reset())

    def leave(self) -> None:
        """Drop the words that are left, the odd byte and the unread replies.

        Assumed: PRG DRIVER.c resets the display at an open that finds it not ready. Such a reset would erase
        the picture of the host that left, so only words that nobody can finish are dropped.
        """
        self._left, self.odd_byte, self.is_within = NO_WORDS, b"", False
        self.display.decoder.clear()
        self.display.receive(self.display.processor.waiting)


READ_BYTES: Final = 1 << 16
"""The most bytes that are read at once."""
REPLY_BYTES: Final = 1 << 18
"""The bytes of waiting replies at which reading the host's words stops."""


class Client:
    """The host that is served now, with its socket, its waiting replies and its time limit.

    A host that stops reading its replies loses them, but its words are still executed (Assumed: a host that
    draws and leaves wants its picture).
    """

    def __init__(self, connected: socket.socket, session: HostSession, idle_seconds: float) -> None:
        self.socket = prepared(connected)
        self.session = session
        self.idle_seconds = idle_seconds
        self._replies: deque[bytes] = deque()
        self._pending: Iterator[bytes] | None = None
        self._sent_all = False
        self.deadline = time.monotonic() + idle_seconds
        """The time when the host is disconnected, unless something is transferred before."""

    @property
    def waiting(self) -> int:
        """The number of bytes of waiting replies."""
        return sum(map(len, self._replies))

    @property
    def has_work(self) -> bool:
        """Whether words of the host can be executed now."""
        return self._pending is not None and self.waiting < REPLY_BYTES

    @property
    def ended(self) -> bool:
        """Whether the host has left, with all words executed and all replies sent, or is silent too long."""
        has_left = self._sent_all and self._pending is None and not self._replies
        return has_left or time.monotonic() >= self.deadline

    def step(self, seconds: float = 0.0) -> bool:
        """Read, execute and reply once, waiting up to `seconds`; returns whether anything was done."""
        reads = self._pending is None and not self._sent_all and self.waiting < REPLY_BYTES
        wanted = (selectors.EVENT_READ if reads else 0) | (selectors.EVENT_WRITE if self._replies else 0)
        left = max(0.0, self.deadline - time.monotonic())
        events = ready(self.socket, wanted, 0.0 if self.has_work else min(seconds, left))
        if events & selectors.EVENT_WRITE:
            self._send()
        if events & selectors.EVENT_READ:
            self._read()
        if events:
            self.deadline = time.monotonic() + self.idle_seconds
        return self._work() or events != 0

    def _send(self) -> None:
        """Send the next reply. Replies to different writes are in different packets."""
        reply = self._replies.popleft()
        try:
            if rest := reply[write_socket(self.socket, reply) :]:
                self._replies.appendleft(rest)
        except OSError:
            self._replies.clear()

    def _read(self) -> None:
        has_packets = keeps_writes(self.socket)
        try:
            data = self._receive(socket.MSG_PEEK if has_packets else 0)
        except OSError:
            data = b""
        if data is None:
            return
        self._sent_all = not data
        if has_packets:
            # A packet is a write of the host: round it down to whole words. It is taken when it is executed.
            data = data[: len(data) & ~1]
        if not self._sent_all:
            self._pending = self.session.feed(data)

    def _receive(self, flags: int = 0) -> bytes | None:
        try:
            return read_socket(self.socket, READ_BYTES, flags)
        except ConnectionError:
            # If a host leaves without its replies, an error comes once, before the last packets of the host.
            return read_socket(self.socket, READ_BYTES, flags)

    def _work(self) -> bool:
        """Execute a piece of the host's words; returns whether there was a piece."""
        has_work = self.has_work
        if has_work and self._pending is not None:
            reply = next(self._pending, None)
            if reply:
                self._replies.append(reply)
            elif reply is None:
                self._pending = None
                if keeps_writes(self.socket):
                    # The packet is executed: take it out of the socket.
                    self._receive()
        if has_work or self.session.is_stopped:
            # The display was working, or a program stops the host: this was no silence of the host.
            self.deadline = time.monotonic() + self.idle_seconds
        return has_work

    def close(self) -> None:
        """Close the socket, and drop the replies."""
        if self._pending is not None:
            # Tell the host that not all its words were executed; an unread packet tells it, too.
            break_off(self.socket)
        self.socket.close()


IDLE_SECONDS: Final = 600.0
HOSTS_IN_LINE: Final = 128
"""Limit: the most hosts that wait in line."""


class Server:
    """A display that serves one host after the other; `address` is the address for a host's port."""

    def __init__(
        self,
        display: Ramtek9300,
        listener: socket.socket | None,
        address: str,
        idle_seconds: float,
        record: Record | None,
    ) -> None:
        self.display = display
        self.address = address
        self.session = HostSession(display, record)
        """The session of all hosts, one after the other."""
        self.idle_seconds = idle_seconds
        self.served = 0
        """The number of hosts that were served and have left; it never decreases."""
        self._listener = listener
        self._client: Client | None = None

    @property
    def busy(self) -> bool:
        """Whether a host is being served."""
        return self._client is not None

    def step(self, seconds: float = 0.0) -> bool:
        """Serve once, waiting up to `seconds` for an event; returns whether anything was done."""
        if self._client is None:
            # While a host is served, other hosts wait in the listener's line.
            return self._accept(seconds)
        done = self._client.step(seconds)
        if self._client.ended:
            self._disconnect()
            return True
        return done

    def serve_for(self, seconds: float, wait: float = 0.0) -> None:
        """Serve for up to `seconds`, or until no work is left; for a window's ticks.

        If a host is connected, wait up to `wait` seconds for the first words; otherwise do not wait.
        """
        end = time.monotonic() + seconds
        done = self.step(wait if self.busy else 0.0)
        while done and time.monotonic() < end:
            done = self.step()

    def close(self) -> None:
        """Disconnect the host and stop listening; the hosts in line are turned away."""
        self._disconnect()
        if self._listener is not None:
            self._listener.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _accept(self, seconds: float) -> bool:
        """Take the next host, waiting up to `seconds` for it; returns whether there is one."""
        if self._listener is None or not ready(self._listener, selectors.EVENT_READ, seconds):
            return False
        self._listener.setblocking(False)
        try:
            connected, _ = self._listener.accept()
        except OSError:
            # The host has disconnected already.
            return False
        self._client = Client(connected, self.session, self.idle_seconds)
        return True

    def _disconnect(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
            self.served += 1
            self._leave()

    def _leave(self) -> None:
        self.session.leave()


class TcpServer(Server):
    """A display at `tcp://host:port`. With `port=0` the system chooses a free port: see `port`."""

    def __init__(
        self,
        display: Ramtek9300,
        port: int = 0,
        host: str = "127.0.0.1",
        *,
        idle_seconds: float = IDLE_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen; PortError if the port is taken or cannot be opened."""
        try:
            family = socket.AF_INET6 if ":" in host else socket.AF_INET
            listener = socket.create_server((host, port), family=family, backlog=HOSTS_IN_LINE)
        except (OSError, OverflowError, UnicodeError) as cause:
            raise PortError(
                f"a server must have a free port, and {host}:{port} cannot be opened ({reason_of(cause)}); "
                "choose another, or 0 for any"
            ) from cause
        self.port: int = listener.getsockname()[1]
        address = f"tcp://{f'[{host}]' if ':' in host else host}:{self.port}"
        super().__init__(display, listener, address, idle_seconds, record)


class UnixServer(Server):
    """A display at a path, on a Unix socket that keeps the boundaries of writes (SEQPACKET).

    Everyone who may write to the socket's file may draw: only its owner may (0600).
    """

    def __init__(
        self,
        display: Ramtek9300,
        path: str | os.PathLike[str],
        *,
        idle_seconds: float = IDLE_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen.

        PortError if the system has no such sockets. OutputExistsError if the path exists, unless it is the
        socket of a server that is gone. OutputError if no socket can be made there.
        """
        address = os.fspath(path)
        listener = packet_socket()
        try:
            self._file = listen_at(listener, address)
        except OutputExistsError:
            listener.close()
            raise
        except (OSError, ValueError) as cause:
            listener.close()
            raise OutputError(
                f"a server's socket must be where a socket can be made, not at {address!r} "
                f"({reason_of(cause)}); choose another path"
            ) from cause
        super().__init__(display, listener, address, idle_seconds, record)

    def close(self) -> None:
        """Disconnect the host, stop listening, and remove the socket's file if it is still ours."""
        super().close()
        with suppress(OSError):
            if os.path.samestat(os.lstat(self.address), self._file):
                os.unlink(self.address)


def listen_at(listener: socket.socket, path: str) -> os.stat_result:
    """Listen at a path, which then names the socket; returns the state of its file.

    The socket of a server that is gone is removed. OutputExistsError if anything else is at the path, OSError
    if the path is too long for a socket.

    The name appears when the socket listens already, so that no host that finds it is refused. Before, the
    socket has a hidden name in the same folder, which only Linux can name by its descriptor.
    """
    if sys.platform != "linux":
        raise OSError("packet sockets are of Linux")
    # The socket's file gets the permissions of the socket: set them before the file exists.
    os.fchmod(listener.fileno(), stat.S_IRUSR | stat.S_IWUSR)
    folder = os.open(os.path.dirname(path) or ".", os.O_PATH)
    # A socket's name is short: name the folder by its descriptor, so that each path that fits can be taken.
    hidden = f"/proc/self/fd/{folder}/.{secrets.token_hex(4)}"
    try:
        listener.bind(hidden)
        try:
            listener.listen(HOSTS_IN_LINE)
            # A running server refuses a socket of another type and is not disturbed.
            with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as asking:
                refusal = asking.connect_ex(path)
            if refusal == errno.EPROTOTYPE:
                raise taken(path, "belongs to a server that runs")
            if refusal == errno.ECONNREFUSED and stat.S_ISSOCK(os.lstat(path).st_mode):
                os.unlink(path)
            # Unlike a renaming, a link replaces no file that another server has made meanwhile.
            try:
                os.link(hidden, path)
            except FileExistsError:
                raise taken(path, "exists") from None
            return os.lstat(path)
        finally:
            os.unlink(hidden)
    finally:
        os.close(folder)


def taken(path: str, thing: str) -> OutputExistsError:
    """The error for a path that another file or server has."""
    return OutputExistsError(
        f"a server's socket must be a new file or the socket of a server that is gone, not {path}, "
        f"which {thing}; choose another path"
    )
