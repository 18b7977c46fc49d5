"""The attacks `signals`: commands that get a signal at any moment.

A row is a command and a moment. The command is started in a folder of its own, and gets a signal at that
moment. Then it must end with the row's exit code and without a traceback, its outputs must be whole, and
nothing else may be left in the folder. Windows are tried if there is a screen (`xvfb-run`).
"""

from __future__ import annotations

import os
import random
import select
import shlex
import signal
import socket
import subprocess
import sys
import time
from array import array
from collections.abc import Callable
from contextlib import nullcontext, suppress
from fcntl import ioctl
from functools import partial
from pathlib import Path
from termios import FIONREAD
from typing import NamedTuple

import numpy as np

from ramtek_emu import NCAR_9460, Ramtek9300, instructions, read_snapshot
from tests.attacks import Trial
from tests.ramtek_emu.processes import environment, stream
from tests.ramtek_emu.serving import serving_at

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
DRAWING = stream(instructions.write_vectors([[20, 10], [60, 45], [5, 40]], 9))
READ = stream(next(instructions.read_image(0, 0, 1, 1))[0])
READ_ALL = stream(np.concatenate([words for words, _ in instructions.read_image(0, 0, 640, 480)]))
FILLS = stream(np.concatenate([instructions.fill(5, 5, 9), instructions.fill(5, 5, 8)] * 17_000))
"""About 240,000 words that take the display a minute and more."""
PIPE_BYTES = 1 << 16


class Command:
    """A command that runs in a folder of its own, and its host."""

    def __init__(self, process: subprocess.Popen[bytes], place: Path) -> None:
        self.process, self.place = process, place
        self._host: socket.socket | None = None

    def until(self, condition: Callable[[], object]) -> None:
        """Wait for a state of the command."""
        end = time.monotonic() + 60
        while not condition():
            assert self.process.poll() is None, self.process.communicate()
            assert time.monotonic() < end, "the command does not get there"
            time.sleep(0.002)

    def connect(self) -> None:
        """Connect to the address that a server prints."""
        assert self.process.stdout is not None
        address = self.process.stdout.readline().decode().strip()
        if address.startswith("tcp:"):
            self._host = socket.create_connection(("127.0.0.1", int(address.rpartition(":")[2])))
        else:
            self._host = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            self._host.connect(str(self.place / address))

    def send(self, data: bytes, least: int | None = None) -> None:
        """Send at least `least` bytes, or all, and then as many as the command takes at once."""
        assert self.process.stdin is not None
        number = self.process.stdin.fileno() if self._host is None else self._host.fileno()
        os.set_blocking(number, False)
        sent = 0
        while sent < len(data):
            try:
                sent += os.write(number, data[sent : sent + (1 << 14)])
            except BlockingIOError:
                if least is not None and sent >= least:
                    break
                select.select([], [number], [], 60)

    def receive(self, count: int) -> bytes:
        """Bytes of a reply."""
        assert self.process.stdout is not None
        file = self.process.stdout if self._host is None else self._host
        select.select([file], [], [], 60)
        return os.read(file.fileno(), count)

    @property
    def unread(self) -> int:
        """How many bytes wait in the command's stdout."""
        waiting = array("i", [0])
        ioctl(self.process.stdout, FIONREAD, waiting)  # type: ignore[arg-type]
        return waiting[0]

    def catches(self, number: signal.Signals) -> bool:
        """Whether the command handles a signal."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return bool(int(status.partition("SigCgt:")[2].split()[0], 16) >> (number - 1) & 1)

    def close(self) -> None:
        """Close the host, and the pipes."""
        if self._host is not None:
            self._host.close()
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            assert pipe is not None
            pipe.close()


def at_any_time(command: Command) -> None:
    """At any time after our first line."""
    command.until(lambda: command.catches(signal.SIGTERM))
    time.sleep(random.choice((0, random.uniform(0, 0.5))))


def recording(command: Command) -> None:
    command.until(lambda: any(name.name.endswith(".part") for name in command.place.iterdir()))
    command.send(DRAWING)


def idle(command: Command, connect: bool = False) -> None:
    if connect:
        command.connect()
    command.send(DRAWING + READ)
    assert command.receive(2) == b"\0\0"


def filling(command: Command, connect: bool = False) -> None:
    if connect:
        idle(command, connect)
    command.send(FILLS, PIPE_BYTES + 1)


def unread(command: Command, connect: bool = False) -> None:
    """Nobody reads what the command writes."""
    if connect:
        command.connect()
    command.send(DRAWING + READ_ALL * 40, 0)
    command.until(lambda: connect or command.unread > PIPE_BYTES - 4096)


def printing(command: Command) -> None:
    command.until(lambda: command.unread > PIPE_BYTES - 4096)


class Row(NamedTuple):
    """A command at a moment; its exit codes, where -1 stands for 128 and the signal; its outputs."""

    arguments: str
    moment: Callable[[Command], None]
    codes: tuple[int, ...] = (-1,)
    written: tuple[str, ...] = ()
    module: str = "ramtek_emu"
    has_display: bool = False
    """Whether a display is served at `display`."""

    @property
    def moment_name(self) -> str:
        """The name of the moment's function."""
        return str(getattr(self.moment, "func", self.moment).__name__)


OUTPUTS = "-o o.png --snapshot s.png --record r.ramtek --configuration NCAR_9460"
WRITTEN = ("o.png", "s.png", "r.ramtek")
SERVERS = (f"serve --unix display {OUTPUTS}", f"serve --port 0 {OUTPUTS}")
PIPED = (f"serve --stdio {OUTPUTS}", f"serve --stdio --joystick stick {OUTPUTS}")
PLAYED = f"play - {OUTPUTS}"
COUPE = Path(__file__).parents[1] / "scenes" / "coupe"
AUTOCOLOR = {
    f"render {COUPE} -o o.png": ("o.png",),
    f"render {COUPE} --save o.npz": ("o.npz",),
    **{f"convert {COUPE} {output}": (output,) for output in ("o.sqlite", "o.csv", "o.tables", "o")},
    f"convert {COUPE / 'body.obj'} o.ply": ("o.ply",),
    f"validate {COUPE}": (),
    f"sql {COUPE} 'SELECT count(*) FROM nodes a, nodes b, nodes c'": (),
}
"""Commands with their outputs."""
SHOWN = (f"show {COUPE} --to ./display --once", f"show {COUPE} --to ./display", "tutorial --to ./display")
SERVED = (idle, filling, unread)

ROWS = (
    *(Row(command, moment, (0,), WRITTEN) for moment in SERVED for command in PIPED),
    *(Row(each, partial(moment, connect=True), (0,), WRITTEN) for moment in SERVED for each in SERVERS),
    *(Row(PLAYED, moment, (-1,), WRITTEN) for moment in (recording, filling)),
    *(Row(command, at_any_time, (0, -1), WRITTEN) for command in (*PIPED, *SERVERS, PLAYED)),
    Row("list lines.ramtek", printing),
    Row("list lines.ramtek", at_any_time, (0, -1)),
    Row("assemble - -o a.ramtek", at_any_time),
    Row("-o o.png", at_any_time, (0, -1), ("o.png",)),
    *(Row(command, at_any_time, (0, -1), AUTOCOLOR[command], "autocolor") for command in AUTOCOLOR),
    *(Row(command, at_any_time, (0, -1), (), "autocolor", has_display=True) for command in SHOWN),
)
WINDOWS = (
    *(Row(f"{PLAYED} --window", moment, (0,), WRITTEN) for moment in (recording, filling)),
    *(Row(f"{PIPED[0]} --window", moment, (0,), WRITTEN) for moment in SERVED),
    *(Row(command, at_any_time, module="autocolor") for command in (f"view {COUPE}", "tutorial", "")),
)


def row_of(arguments: str, moment: Callable[[Command], None]) -> Row:
    """The first row whose command begins with this text, at this moment."""
    return next(
        row
        for row in ROWS
        if row.arguments.startswith(arguments) and getattr(row.moment, "func", row.moment) is moment
    )


def attack(row: Row, number: signal.Signals, place: Path) -> tuple[float, str]:
    """Start a row's command, send it a signal at its moment, and check what it leaves.

    Returns the seconds until its end, and what it said on stderr.
    """
    (place / "lines.ramtek").write_bytes(DRAWING * 4000)
    os.mkfifo(place / "stick")
    with serving_at(place / "display") if row.has_display else nullcontext():
        seconds, code, said = ended(row, number, place)
    check(row, number, place, code, said)
    return seconds, said


def ended(row: Row, number: signal.Signals, place: Path) -> tuple[float, int, str]:
    """The seconds from the signal to the end of a row's command, its exit code, and what it said."""
    process = subprocess.Popen(
        (sys.executable, "-m", row.module, *shlex.split(row.arguments)),
        cwd=place,
        env={
            **environment(),
            "XDG_STATE_HOME": str(place / "state"),
            **({"DISPLAY": os.environ["DISPLAY"]} if row in WINDOWS else {}),
        },
        start_new_session=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        bufsize=0,
    )
    command = Command(process, place)
    try:
        row.moment(command)
        begin = time.monotonic()
        # As a terminal does: all processes of the group get it.
        with suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        code = process.wait(60)
        seconds = time.monotonic() - begin
        assert process.stderr is not None
        said = process.stderr.read().decode()
    finally:
        process.kill()
        process.wait()
        command.close()
    return seconds, code, said


def check(row: Row, number: signal.Signals, place: Path, code: int, said: str) -> None:
    """Whether a command that ended has left its outputs, whole, and nothing else."""
    codes = {128 + number if expected == -1 else expected for expected in row.codes}
    if row.moment is at_any_time:
        # After our last line, the signal ends Python.
        codes.add(-number)
    assert code in codes, (code, said)
    assert "Traceback" not in said
    left = {path.name for path in place.iterdir()} - {"lines.ramtek", "stick", "state"}
    if row.moment is at_any_time:
        # Everything is written, or nothing.
        assert left in (set(), set(row.written)), (left, said)
    else:
        assert left == set(row.written), (left, said)
    if "s.png" in left:
        twin = Ramtek9300(NCAR_9460)
        twin.send(np.frombuffer((place / "r.ramtek").read_bytes(), "<u2").astype(np.uint16))
        words = read_snapshot(place / "s.png").words
        # A fill that the signal cut off is half drawn, and not in the recording.
        assert np.isin(words[words != twin.words], (8, 9)).all(), "the recording is cut"


class Signalled(Trial):
    """A row that gets each signal."""

    def __init__(self, row: Row) -> None:
        self.row = row

    def attempt(self, chance: random.Random) -> str:
        random.seed(chance.random())
        attack(self.row, chance.choice(ENDING), Path.cwd())
        return ""


def trials() -> dict[str, Callable[[], Trial]]:
    """The attacks by their names."""
    rows = ROWS + (WINDOWS if "DISPLAY" in os.environ else ())
    return {f"{row.moment_name}, {row.module} {row.arguments}": partial(Signalled, row) for row in rows}
