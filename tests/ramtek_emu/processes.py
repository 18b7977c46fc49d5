"""The commands in real processes, with pipes to the tests."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[2]


def environment() -> dict[str, str]:
    inherited = {
        name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")
    }
    return {**inherited, "PYTHONPATH": str(ROOT)}


def run(*arguments: object, data: bytes = b"", **variables: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "ramtek_emu", *map(str, arguments)],
        env={**environment(), **variables},
        input=data,
        capture_output=True,
        timeout=60,
        check=False,
    )


@contextmanager
def started(*arguments: object, **variables: str) -> Iterator[subprocess.Popen[bytes]]:
    """A running command with pipes, and with further variables of the environment."""
    process = subprocess.Popen(
        [sys.executable, "-m", "ramtek_emu", *map(str, arguments)],
        env={**environment(), **variables},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        bufsize=0,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()


def address_of(process: subprocess.Popen[bytes]) -> str:
    """The address that a server prints."""
    assert process.stdout is not None
    return process.stdout.readline().decode().strip()


def ended(process: subprocess.Popen[bytes], number: int) -> str:
    """End a server by a signal, in order. Returns what it said on stderr."""
    process.send_signal(number)
    assert process.wait(60) == 0
    assert process.stderr is not None
    return process.stderr.read().decode()


def stream(numbers: object) -> bytes:
    return np.asarray(numbers, "<u2").tobytes()


def field_of(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    with Image.open(path) as picture:
        return np.asarray(picture)


class PipedHost:
    """A host program that uses a display on a pipe."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self.into, self.out = process.stdin, process.stdout

    def send(self, numbers: object) -> None:
        self.into.write(stream(numbers))

    def receive(self, count: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
        data = b""
        while len(data) < 2 * count:
            piece = self.out.read(2 * count - len(data))
            assert piece, "the display left"
            data += piece
        return np.frombuffer(data, "<u2")
