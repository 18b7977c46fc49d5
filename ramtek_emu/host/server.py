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

Limit: a host is disconnected if nothing is sent or received for `idle_seconds`, or if an instruction stays
incomplete for `partial_seconds`. The clock of a host starts when its turn comes, so that waiting in line
costs nothing, and a silent host holds up the line for `idle_seconds` at most. While REPLY_BYTES of replies
wait for the host, nothing more is read from it.
"""

from __future__ import annotations

import os
import selectors
import socket
import stat
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from types import TracebackType
from typing import Final, TypeVar

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.arrays import Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import OutputError, OutputExistsError, PortError, reason_of
from ramtek_emu.host.port import Sign, Wire, packet_socket, waiting_bytes
from ramtek_emu.instruction_set.instruction import NO_WORDS

Record = Callable[[bytes], object]
"""A function that records the bytes of whole instructions, in order."""

SLICE_SECONDS: Final = 0.004
"""How long words are executed before the session pauses; a long instruction has pauses within it."""
HOST_SECONDS: Final = 0.005
"""How long the input of a window may wait while a connected host sends nothing. Its words never wait."""
REPLY_PIECE: Final = 1 << 15
"""The words of waiting replies at which the session pauses, and the most that are returned at once."""


class Gate:
    """Decides how many instructions a display executes, for a program that stops its hosts."""

    def __init__(self) -> None:
        self.left: int | None = None
        """How many more instructions may be executed; None for any number."""
        self.is_within = False
        """Whether the last pause was within a long instruction."""
        self._place = 0

    @property
    def is_closed(self) -> bool:
        """Whether hosts must wait."""
        return self.left == 0

    def begin(self, place: int) -> None:
        """Note that the next instruction begins at a place of the host's words."""
        self._place, self.is_within = place, False

    def closes_at(self, place: int) -> bool:
        """Note how many words are executed; returns whether no further instruction may be."""
        self.is_within = place == self._place
        if not self.is_within:
            self._place = place
            if self.left:
                self.left -= 1
        return self.left == 0 and not self.is_within


class HostSession:
    """A host at a display: passes the bytes of its words on and the bytes of replies back, on any wire.

    The session pauses often: a window is served in between, a signal is noticed, and replies are taken before
    they outgrow the processor's bound.
    """

    def __init__(self, display: Ramtek9300, record: Record | None = None, gate: Gate | None = None) -> None:
        self.display = display
        self._record = record
        self._gate = gate
        self._unrecorded = NO_WORDS
        self.unexecuted = 0
        """The number of words that are not executed yet: the rest of the last `feed`.

        A half-drawn instruction counts with all its words, also the words of an earlier `feed`.
        """
        self.odd_byte = b""
        """The first byte of a word whose second byte has not arrived."""
        self.leave()

    @property
    def is_stopped(self) -> bool:
        """Whether the host must wait until a gate opens."""
        return self._gate is not None and self._gate.is_closed

    @property
    def unfinished(self) -> bool:
        """Whether a word or an instruction is incomplete."""
        return bool(self.odd_byte) or self.display.decoder.pending_words > 0

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Pass bytes of the host to the display, and yield the replies, or no bytes, at every pause.

        The session goes on when the iterator is asked for more.
        """
        data = self.odd_byte + data
        self.odd_byte = data[len(data) & ~1 :]
        words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)
        self.unexecuted = len(words)
        return self._execute(words)

    def _execute(self, words: Words) -> Iterator[bytes]:
        processor, clock, gate = self.display.processor, time.perf_counter, self._gate
        if gate is not None:
            gate.begin(0)
        while self.unexecuted and self.is_stopped:
            yield b""
        # The first instruction may have begun with words of the last feed.
        begun = self.display.decoder.pending_words
        steps = self.display.send_stepwise(words)
        begin = place = previous = 0
        while self.unexecuted:
            due = clock() + SLICE_SECONDS
            for place in steps:
                closes = gate is not None and gate.closes_at(place)
                if closes or clock() >= due or processor.waiting >= REPLY_PIECE:
                    self.unexecuted = len(words) - place + (0 if place else begun)
                    break
                previous = place
            else:
                self.unexecuted = 0
            if self._record is not None:
                self._record_words(self._record, words[begin:place], words[place:])
            begin = place
            is_within, previous, resets = place == previous, place, self.display.resets
            yield self._reply()
            while processor.waiting or (self.unexecuted and self.is_stopped):
                yield self._reply()
            if is_within and self.unexecuted and self.display.resets != resets:
                # Leave the instruction that the reset abandoned out of the recording.
                begin = place = previous = next(steps)
                self.unexecuted = len(words) - place
                if gate is not None:
                    gate.begin(place)

    def _record_words(self, record: Record, executed: Words, rest: Words) -> None:
        """Record whole instructions; at the end, keep the words of an incomplete instruction for later."""
        if len(executed):
            record(np.concatenate((self._unrecorded, executed)).astype("<u2", copy=False).tobytes())
            self._unrecorded = NO_WORDS
        if not self.unexecuted:
            self._unrecorded = np.concatenate((self._unrecorded, rest))

    def _reply(self) -> bytes:
        count = min(self.display.processor.waiting, REPLY_PIECE)
        return self.display.receive(count).astype("<u2", copy=False).tobytes()

    def reset(self) -> None:
        """Reset the display; the recording gets a reset at the same place.

        The incomplete instruction and the unread replies are dropped; the odd byte stays, since the stream of
        bytes goes on.
        """
        self._unrecorded = NO_WORDS
        self.display.reset()
        if self._gate is not None:
            self._gate.is_within = False
        if self._record is not None:
            self._record(instructions.reset().astype("<u2", copy=False).tobytes())

    def leave(self) -> None:
        """Drop the incomplete instruction, the odd byte and the unread replies.

        Assumed: PRG DRIVER.c resets the display at an open that finds it not ready. Such a reset would erase
        the picture of the host that left, so only words that nobody can finish are dropped.
        """
        self.unexecuted, self.odd_byte = 0, b""
        self._unrecorded = NO_WORDS
        self.display.decoder.clear()
        self.display.receive(self.display.processor.waiting)


READ_BYTES: Final = 1 << 16
"""The most bytes that are read at once."""
REPLY_BYTES: Final = 1 << 18
"""The bytes of waiting replies at which reading the host's words stops."""


class Client:
    """The host that is served now, with its wire, its session, its waiting replies and its time limits.

    A host that stops reading its replies loses them, but its words are still executed, as on a pipe.
    """

    def __init__(self, wire: Wire, session: HostSession, idle_seconds: float, partial_seconds: float) -> None:
        self.wire = wire
        self.session = session
        self.idle_seconds, self.partial_seconds = idle_seconds, partial_seconds
        self.waiting = 0
        """The number of bytes of waiting replies."""
        self._replies: deque[bytes] = deque()
        self._mark_is_due = False
        self._takes_replies = True
        self._pending: Iterator[bytes] | None = None
        self._is_gone = False
        self._sent_all = False
        self._last_transfer = self._last_complete = time.monotonic()

    @property
    def has_work(self) -> bool:
        """Whether words of the host can be executed now."""
        return self._pending is not None and self.waiting < REPLY_BYTES

    @property
    def has_to_send(self) -> bool:
        """Whether a mark or replies wait to be sent."""
        return self._mark_is_due or self.waiting > 0

    @property
    def wanted(self) -> int:
        """The events of the socket that can be served now."""
        reading = self._pending is None and not self._sent_all and self.waiting < REPLY_BYTES
        return (selectors.EVENT_READ if reading else 0) | (selectors.EVENT_WRITE if self.has_to_send else 0)

    @property
    def ended(self) -> bool:
        """Whether the host is lost, or has left with all words executed and all replies sent."""
        return self._is_gone or (self._sent_all and self._pending is None and not self.has_to_send)

    @property
    def deadline(self) -> float:
        """The time when the host is disconnected, unless something is transferred before."""
        idle = self._last_transfer + self.idle_seconds
        return min(idle, self._last_complete + self.partial_seconds) if self.session.unfinished else idle

    def serve(self, events: int) -> bool:
        """Read or write if the socket is ready; returns whether anything was transferred."""
        transferred = False
        if events & selectors.EVENT_WRITE and self.has_to_send:
            transferred = self._send()
        if events & selectors.EVENT_READ:
            transferred |= self._read()
        if transferred:
            self._last_transfer = time.monotonic()
        return transferred

    def _send(self) -> bool:
        """Send the mark, or the next reply. Replies to different writes are in different packets."""
        try:
            if self._mark_is_due:
                self._mark_is_due = not self.wire.send_mark()
                return not self._mark_is_due
            sent = self.wire.send(self._replies[0])
        except OSError:
            self._takes_replies = False
            self._drop_replies()
            return True
        self.waiting -= sent
        rest = self._replies.popleft()[sent:]
        if rest:
            self._replies.appendleft(rest)
        return sent > 0

    def _drop_replies(self) -> None:
        self._replies.clear()
        self.waiting = 0
        self._mark_is_due = False

    def _read(self) -> bool:
        try:
            data = self.wire.read(READ_BYTES)
        except OSError:
            self._is_gone = True
            return False
        if data is Sign.NOTHING:
            return False
        if not self.session.unfinished:
            self._last_complete = time.monotonic()
        if data is Sign.END:
            self._sent_all = True
        elif data is Sign.MARK:
            self.session.leave()
            self.session.reset()
            self._drop_replies()
            self._mark_is_due = True
        elif not isinstance(data, Sign):
            # A packet is a write of the host: round it down to whole words.
            self._pending = self.session.feed(data[: len(data) & ~1] if self.wire.keeps_writes else data)
        return True

    def work(self) -> bool:
        """Execute a piece of the host's words; returns whether there was a piece."""
        if self.session.is_stopped:
            # Stop the clocks of a host that must wait.
            self._last_transfer = self._last_complete = time.monotonic()
        if not self.has_work or self._pending is None:
            return False
        begin = time.monotonic()
        reply = next(self._pending, None)
        # Stop the clocks of the host while the display works.
        took = time.monotonic() - begin
        self._last_transfer += took
        self._last_complete += took
        if reply is None:
            self._pending = None
        elif reply and self._takes_replies:
            self._replies.append(reply)
            self.waiting += len(reply)
        if not self.session.unfinished:
            self._last_complete = time.monotonic()
        return True

    @property
    def unexecuted(self) -> int:
        """The number of the host's words that have arrived and are not executed."""
        data = waiting_bytes(self.wire.socket) + len(self.session.odd_byte)
        return data // 2 + self.session.unexecuted

    def leave(self) -> None:
        """Close the wire and drop the unfinished instruction and the replies."""
        if self._pending is not None:
            # Tell the host that not all its words were executed.
            self.wire.break_off()
        self._pending = None
        self.session.leave()
        self.wire.socket.close()


IDLE_SECONDS: Final = 600.0
PARTIAL_SECONDS: Final = 60.0
HOSTS_IN_LINE: Final = 128
"""Limit: the most hosts that wait in line."""

Self = TypeVar("Self", bound="Server")


class Server:
    """A display that serves the hosts of a listening socket; `address` is the address for a host's port."""

    def __init__(
        self,
        display: Ramtek9300,
        listener: socket.socket,
        address: str,
        idle_seconds: float,
        record: Record | None,
    ) -> None:
        self.display = display
        self.address = address
        self.record = record
        self.idle_seconds = idle_seconds
        self.partial_seconds = PARTIAL_SECONDS
        self.gate: Gate | None = None
        """Stops the hosts that connect from now on; None lets all instructions through."""
        self.served = 0
        """The number of hosts that were served and have left; it never decreases."""
        self._listener = listener
        self._listener.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._client: Client | None = None

    @property
    def busy(self) -> bool:
        """Whether a host is being served."""
        return self._client is not None

    @property
    def unexecuted(self) -> int:
        """The number of words of the host that is served which have arrived and are not executed."""
        return 0 if self._client is None else self._client.unexecuted

    def step(self, seconds: float = 0.0) -> bool:
        """Serve once, waiting up to `seconds` for an event; returns whether anything was done."""
        client = self._client
        if client is None:
            return bool(self._selector.select(seconds)) and self._accept()
        left = max(0.0, client.deadline - time.monotonic())
        seconds = 0.0 if client.has_work else min(seconds, left)
        self._selector.modify(client.wire.socket, client.wanted or selectors.EVENT_WRITE)
        done = False
        for _, events in self._selector.select(seconds):
            done |= client.serve(events)
        done |= client.work()
        if client.ended or time.monotonic() >= client.deadline:
            self._disconnect()
            done = True
        return done

    def serve_for(self, seconds: float, wait: float = 0.0) -> None:
        """Serve for up to `seconds`, or until no work is left; for a window's ticks.

        If a host is connected, wait up to `wait` seconds for the first words; otherwise do not wait.
        """
        end = time.monotonic() + seconds
        done = self.step(wait if self.busy else 0.0)
        while done and time.monotonic() < end:
            done = self.step()

    def reset(self) -> None:
        """Press RESET on the control unit: drops the unfinished instruction; the host stays connected."""
        client = self._client
        (HostSession(self.display, self.record) if client is None else client.session).reset()

    def close(self) -> None:
        """Disconnect the host and stop listening; the hosts in line are turned away."""
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
            # The host has disconnected already.
            return False
        try:
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            wire = Wire(connected)
        except OSError:
            connected.close()
            return True
        session = HostSession(self.display, self.record, self.gate)
        self._client = Client(wire, session, self.idle_seconds, self.partial_seconds)
        # While this host is served, other hosts wait in the listener's line.
        self._selector.unregister(self._listener)
        self._selector.register(connected, selectors.EVENT_READ)
        return True

    def _disconnect(self) -> None:
        if self._client is not None:
            self._selector.unregister(self._client.wire.socket)
            self._client.leave()
            self._client = None
            self._selector.register(self._listener, selectors.EVENT_READ)
            self.served += 1


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
        self.host = host
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
            remove_stale_socket(address)
            # The socket's file gets the permissions of the socket: set them before the file exists.
            if sys.platform != "win32":
                os.fchmod(listener.fileno(), stat.S_IRUSR | stat.S_IWUSR)
            listener.bind(address)
            listener.listen(HOSTS_IN_LINE)
            self._file = os.lstat(address)
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


def remove_stale_socket(path: str) -> None:
    """Remove the socket of a server that is gone; OutputExistsError if anything else is at the path."""
    try:
        kind = os.lstat(path).st_mode
    except FileNotFoundError:
        return
    thing = "exists"
    if sys.platform != "win32" and stat.S_ISSOCK(kind):
        thing = "belongs to a server that runs"
        # A running server refuses a socket of another type and is not disturbed.
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
