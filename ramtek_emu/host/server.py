"""Server: a display behind a listening socket, for one host after the other.

What is modeled: the host interface as a stream of words, low byte first, both ways. What is **not**: the
UNIBUS registers and their interrupts.

No call blocks longer than its argument allows, so that a window can be drawn in between: `step` reads what
has arrived, sends what can be sent, and returns. When a host leaves, all its words are executed first; then
its unfinished instruction and its unread replies are dropped, the memories keep their state, and the next
host is served. Hosts that connect meanwhile wait in line: the system keeps the connections of 128 of them
with what they have sent, and others try again until they find a place.

Limits: a host is disconnected if nothing is sent or received for `idle_seconds`, or if an instruction stays
incomplete for `partial_seconds`. The clock of a host starts when its turn comes, so that one that waits loses
nothing, and one that is silent holds up the line for `idle_seconds` at most. While REPLY_BYTES of replies
wait for the host, nothing more is read from it.
"""

from __future__ import annotations

import os
import selectors
import socket
import stat
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from types import TracebackType
from typing import Final, TypeVar

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.arrays import Booleans, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import OutputError, OutputExistsError, PortError, reason_of
from ramtek_emu.host.port import PacketConnection, Sign, StreamConnection, packet_socket
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.instruction_set.table import FORMATS

# -------------------- host_session
# HostSession: passes the bytes of a host to a display and those of the replies back, for sockets and pipes.
#
# What is modeled: words low byte first both ways (Hardware: PRG, JPL, V8K: the words of a PDP-11's or a
# VAX's memory as they are); instructions cut anywhere; replies in order and as soon as they exist; whole
# words: an odd byte at the end is dropped (Hardware: PRG DRIVER.c, V8K round down).
#
# The words are passed on in pieces. A piece that may contain reading instructions is short, so that no more
# than MOST_WAITING words of replies ever wait; the next piece is read when those replies were taken. A
# piece is also short if the last one took long, so that a window that is served in between stays
# responsive.

Record = Callable[[bytes], object]

LEAST: Final = 4
PIECE: Final = 1 << 15
"""The smallest and the largest number of words passed to the display at once."""
LONG: Final = 0.004
SHORT: Final = 0.001
"""Seconds: a piece that took longer than LONG makes the next one shorter, one below SHORT makes it longer."""
READING_PIECE: Final = 64
"""The size of a piece that may contain reading instructions: at most 32, each with at most 32,767 words."""
REPLY_PIECE: Final = 1 << 15
"""The largest number of words of replies returned at once."""


def replying() -> Booleans:
    """Whether each of the 256 opcodes makes the display reply."""
    opcodes = np.zeros(256, np.bool_)
    opcodes[[format.opcode for format in FORMATS if format.replies]] = True
    return opcodes


class HostSession:
    """One host at a display. When it leaves, its unfinished words are dropped and the memories are kept."""

    def __init__(self, display: Ramtek9300, record: Record | None = None) -> None:
        """Begin a session; `record` is called with the bytes of whole instructions, in order."""
        self.display = display
        self._record = record
        self._unrecorded = NO_WORDS
        self.words = 0
        """How many words the host has sent; it never decreases."""
        self.odd_byte = b""
        """The first byte of a word whose second byte has not arrived."""
        self._replies = replying()
        self._size = READING_PIECE
        self.leave()

    @property
    def held_words(self) -> int:
        """How many words of an incomplete instruction are held."""
        return self.display.decoder.held_words

    @property
    def unfinished(self) -> bool:
        """Whether a word or an instruction is incomplete."""
        return bool(self.odd_byte) or self.held_words > 0

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Pass bytes of the host to the display, piece by piece, and yield the replies to each piece.

        The work is done while the iterator is consumed: the next piece waits until all replies were taken.
        """
        data = self.odd_byte + data
        self.odd_byte = data[len(data) & ~1 :]
        words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)
        most = READING_PIECE if self._replies[words >> 8].any() else PIECE
        place = 0
        while place < len(words):
            piece = words[place : place + min(self._size, most)]
            place += len(piece)
            begin = time.perf_counter()
            self.display.send(piece)
            took = time.perf_counter() - begin
            if took > LONG:
                self._size = max(LEAST, self._size // 8)
            elif took < SHORT:
                self._size = min(PIECE, 2 * self._size)
            self.words += len(piece)
            self._keep(piece)
            yield b""
            while waiting := self.display.processor.waiting:
                yield self.display.receive(min(waiting, REPLY_PIECE)).astype("<u2", copy=False).tobytes()

    def _keep(self, piece: Words) -> None:
        """Record the words of the instructions that are complete now."""
        if self._record is not None:
            words = np.concatenate((self._unrecorded, piece))
            whole = len(words) - self.held_words
            self._record(words[:whole].astype("<u2", copy=False).tobytes())
            self._unrecorded = words[whole:]

    def reset(self) -> None:
        """Reset the display; what is recorded resets it at the same place.

        The incomplete instruction and the replies that were not taken are dropped; the odd byte stays, since
        the stream of bytes goes on.
        """
        self._unrecorded = NO_WORDS
        self.display.reset()
        if self._record is not None:
            self._record(instructions.reset().astype("<u2", copy=False).tobytes())

    def leave(self) -> None:
        """Drop the incomplete instruction, the odd byte and the replies that were not taken."""
        self.odd_byte = b""
        self._unrecorded = NO_WORDS
        self.display.decoder.clear()
        self.display.receive(self.display.processor.waiting)


# -------------------- client
# Client: the host that a server serves now, with its words, its replies and its time limits.
#
# A host that no longer takes its replies loses them, but its words are still executed, as on a pipe.

REPLY_BYTES: Final = 1 << 18
"""When this many bytes of replies wait for the host, no more of its words are read."""


class Client:
    """The connected host: its connection, its words and the replies to be sent."""

    def __init__(
        self,
        connection: StreamConnection,
        session: HostSession,
        idle_seconds: float,
        partial_seconds: float,
    ) -> None:
        self.connection = connection
        self.socket = connection.socket
        self.session = session
        self.idle_seconds, self.partial_seconds = idle_seconds, partial_seconds
        self.gone = False
        self.sent_all = False
        self._takes_replies = True
        self._pending: Iterator[bytes] | None = None
        self._moved = self._whole = time.monotonic()

    @property
    def has_work(self) -> bool:
        """Whether words of the host can be passed to the display now."""
        return self._pending is not None and self.connection.waiting < REPLY_BYTES

    @property
    def wanted(self) -> int:
        """The events of the connection that can be handled now."""
        reading = self._pending is None and not self.sent_all and self.connection.waiting < REPLY_BYTES
        writing = self.connection.has_to_send
        return (selectors.EVENT_READ if reading else 0) | (selectors.EVENT_WRITE if writing else 0)

    @property
    def ended(self) -> bool:
        """Whether nothing remains to be done for this host."""
        return self.gone or (self.sent_all and self._pending is None and not self.connection.has_to_send)

    @property
    def deadline(self) -> float:
        """When the host is disconnected if nothing happens."""
        idle = self._moved + self.idle_seconds
        return min(idle, self._whole + self.partial_seconds) if self.session.unfinished else idle

    def serve(self, events: int) -> bool:
        """Read or write what the connection is ready for; returns whether anything moved."""
        moved = False
        if events & selectors.EVENT_WRITE and self.connection.has_to_send:
            moved = self._send()
        if events & selectors.EVENT_READ:
            moved |= self._read()
        if moved:
            self._moved = time.monotonic()
        return moved

    def _send(self) -> bool:
        try:
            self.connection.send()
        except BlockingIOError:
            return False
        except OSError:
            self._takes_replies = False
            self.connection.drop()
        return True

    def _read(self) -> bool:
        try:
            data = self.connection.read()
        except BlockingIOError:
            return False
        except OSError:
            self.gone = True
            return False
        if not self.session.unfinished:
            self._whole = time.monotonic()
        if data is Sign.END:
            self.sent_all = True
        elif data is Sign.MARK:
            self.session.leave()
            self.session.reset()
            self.connection.answer_mark()
        else:
            self._pending = self.session.feed(data)
        return True

    def work(self) -> bool:
        """Pass one piece of the host's words to the display; returns whether there was one."""
        if not self.has_work or self._pending is None:
            return False
        begin = time.monotonic()
        reply = next(self._pending, None)
        # The clocks of the host stand still while it is the display that takes its time.
        took = time.monotonic() - begin
        self._moved, self._whole = self._moved + took, self._whole + took
        if reply is None:
            self._pending = None
        elif self._takes_replies:
            self.connection.reply(reply)
        if not self.session.unfinished:
            self._whole = time.monotonic()
        return True

    def leave(self) -> None:
        """Close the connection and drop what is unfinished."""
        if self._pending is not None:
            self.connection.break_off()
        self._pending = None
        self.session.leave()
        self.socket.close()


IDLE_SECONDS: Final = 600.0
PARTIAL_SECONDS: Final = 60.0
LINE: Final = 128
"""How many hosts can wait in line."""

Self = TypeVar("Self", bound="Server")


class Server:
    """A display that serves the hosts of a listening socket."""

    def __init__(
        self,
        display: Ramtek9300,
        listener: socket.socket,
        connection: Callable[[socket.socket], StreamConnection],
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to serve; `record` is called with the bytes of whole instructions, host after host."""
        self.display = display
        self.record = record
        self.idle_seconds = idle_seconds
        self.partial_seconds = partial_seconds
        self.served = 0
        """How many hosts were served and have left; it never decreases."""
        self._connection = connection
        self._listener = listener
        self._listener.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._client: Client | None = None

    @property
    def busy(self) -> bool:
        """Whether a host is being served."""
        return self._client is not None

    def step(self, seconds: float = 0.0) -> bool:
        """Serve what has arrived, waiting up to `seconds` for it; returns whether anything was done."""
        client = self._client
        if client is None:
            return bool(self._selector.select(seconds)) and self._accept()
        left = max(0.0, client.deadline - time.monotonic())
        seconds = 0.0 if client.has_work else min(seconds, left)
        self._selector.modify(client.socket, client.wanted or selectors.EVENT_WRITE)
        done = False
        for _, events in self._selector.select(seconds):
            done |= client.serve(events)
        done |= client.work()
        if client.ended or time.monotonic() >= client.deadline:
            self._disconnect()
            done = True
        return done

    def serve_for(self, seconds: float, wait: float = 0.0) -> None:
        """Serve until nothing is left to do or the time is over; for a window's ticks.

        It blocks only while a host is connected, and up to `wait` seconds, for the first words.
        """
        end = time.monotonic() + seconds
        done = self.step(wait if self.busy else 0.0)
        while done and time.monotonic() < end:
            done = self.step()

    def reset(self) -> None:
        """Press RESET on the control unit: an unfinished instruction is dropped, the host stays connected."""
        client = self._client
        (HostSession(self.display, self.record) if client is None else client.session).reset()

    def close(self) -> None:
        """Disconnect the host and stop listening; hosts that wait in line are turned away."""
        self._disconnect()
        self._selector.close()
        self._listener.close()

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        self.close()

    def _accept(self) -> bool:
        try:
            connected, _ = self._listener.accept()
        except OSError:
            # The caller has disconnected already.
            return False
        try:
            connection = self._connection(connected)
        except OSError:
            connected.close()
            return True
        session = HostSession(self.display, self.record)
        self._client = Client(connection, session, self.idle_seconds, self.partial_seconds)
        # While this host is served, the others wait in the listener's line.
        self._selector.unregister(self._listener)
        self._selector.register(connected, selectors.EVENT_READ)
        return True

    def _disconnect(self) -> None:
        if self._client is not None:
            self._selector.unregister(self._client.socket)
            self._client.leave()
            self._client = None
            self._selector.register(self._listener, selectors.EVENT_READ)
            self.served += 1


# -------------------- tcp_server
# TcpServer: a display at `tcp://host:port`.
#
# Words come as a stream of bytes: TCP does not tell where one write of a host ended and the next began. A
# program that relied on each write being rounded down to whole words needs `UnixServer`.

LOOPBACK: Final = "127.0.0.1"


class TcpServer(Server):
    """A display on TCP. `port` is the port it listens on, even if 0 asked for any free one."""

    def __init__(
        self,
        display: Ramtek9300,
        port: int = 0,
        host: str = LOOPBACK,
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen; PortError if the port cannot be had."""
        try:
            family = socket.AF_INET6 if ":" in host else socket.AF_INET
            listener = socket.create_server((host, port), family=family, backlog=LINE)
        except (OSError, OverflowError, UnicodeError) as cause:
            raise PortError(
                f"a server must have a port to itself, and {host}:{port} cannot be had ({reason_of(cause)}); "
                "choose another, or 0 for any"
            ) from cause
        super().__init__(
            display,
            listener,
            StreamConnection,
            idle_seconds=idle_seconds,
            partial_seconds=partial_seconds,
            record=record,
        )
        self.host = host
        self.port: int = listener.getsockname()[1]

    @property
    def address(self) -> str:
        """The address that a host passes to TcpPort."""
        return f"tcp://{f'[{self.host}]' if ':' in self.host else self.host}:{self.port}"


# -------------------- unix_server
# UnixServer: a display at a path, on a Unix domain socket that keeps the boundaries of writes (SEQPACKET).
#
# Each packet is one write of the host and is rounded down to whole words alone, as the drivers of the time
# did (Hardware: PRG DRIVER.c, V8K). Whoever may write to the file may draw: it is made for its owner only
# (0600).


class UnixServer(Server):
    """A display on a Unix socket; `address` is its path, which a host passes to UnixPort."""

    def __init__(
        self,
        display: Ramtek9300,
        path: str | os.PathLike[str],
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen.

        PortError where the system has no such sockets, OutputExistsError if the path is taken by anything but
        the socket of a server that is gone, OutputError if no socket can be made there.
        """
        self.address = os.fspath(path)
        listener = packet_socket()
        try:
            clear_the_way(self.address)
            # The socket's file gets the permissions of the socket; they are never wider.
            os.fchmod(listener.fileno(), stat.S_IRUSR | stat.S_IWUSR)
            listener.bind(self.address)
            listener.listen(LINE)
            self._file = identity(self.address)
        except OutputExistsError:
            listener.close()
            raise
        except (OSError, ValueError) as cause:
            listener.close()
            raise OutputError(
                f"a server's socket must be where one can be made, not at {self.address!r} "
                f"({reason_of(cause)}); choose another path"
            ) from cause
        super().__init__(
            display,
            listener,
            PacketConnection,
            idle_seconds=idle_seconds,
            partial_seconds=partial_seconds,
            record=record,
        )

    def close(self) -> None:
        """Disconnect the host, stop listening, and remove the socket's file if it is still ours."""
        super().close()
        with suppress(OSError):
            if identity(self.address) == self._file:
                os.unlink(self.address)


def clear_the_way(path: str) -> None:
    """Remove the socket of a server that is gone; OutputExistsError if anything else is at the path."""
    try:
        kind = os.lstat(path).st_mode
    except FileNotFoundError:
        return
    thing = "exists"
    if stat.S_ISSOCK(kind):
        thing = "belongs to a server that runs"
        # A socket of another type is refused by a server that runs, and does not disturb it.
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as asking:
            try:
                asking.connect(path)
            except ConnectionRefusedError:
                os.unlink(path)
                return
            except OSError:
                pass
    raise OutputExistsError(
        f"a server's socket must be a new file or the socket of a server that is gone, not {path}, "
        f"which {thing}; choose another path"
    )


def identity(path: str) -> tuple[int, int]:
    """What tells the file at a path from any other: its device and its number there."""
    file = os.lstat(path)
    return file.st_dev, file.st_ino
