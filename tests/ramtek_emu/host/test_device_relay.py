from __future__ import annotations

import os
import pty
import threading
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ramtek_emu import PortError, Ramtek9300, UnixPort
from ramtek_emu.host.device_relay import DeviceRelay
from ramtek_emu.host.unix_server import UnixServer
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import serving_at


class Device:
    """A terminal that a relay without notices connects with a display; `file` is the program's side."""

    def __init__(self, server: UnixServer) -> None:
        self.ours, self.file = pty.openpty()
        tty.setraw(self.file)
        self.ended, self._end = os.pipe()
        self.error: PortError | None = None
        self._port = UnixPort(server.address)
        self._relay = DeviceRelay(self._port, self.ours, None)
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        try:
            self._relay.relay(self.ended)
            self._relay.finish()
            self._port.close()
        except PortError as error:
            self.error = error
        finally:
            self._port.socket.close()

    def end(self) -> None:
        """Tell the relay that the program has ended, and wait until everything is drawn."""
        os.close(self._end)
        self.join()

    def join(self) -> None:
        self._thread.join(20)
        assert not self._thread.is_alive()
        for number in (self.ours, self.file, self.ended):
            os.close(number)


@contextmanager
def on_a_display(path: Path) -> Iterator[tuple[UnixServer, Device]]:
    with serving_at(path) as server:
        yield server, Device(server)


def read(number: int, count: int) -> bytes:
    data = b""
    while len(data) < count:
        data += os.read(number, count - len(data))
    return data


def test_words_and_replies_go_both_ways_and_the_rest_is_drawn_when_the_program_has_ended(
    tmp_path: Path,
) -> None:
    picture = np.arange(480 * 640) % 1024
    with on_a_display(tmp_path / "display") as (server, device):
        head = words("0A03 0040 0 0 27F 62 F780").astype("<u2").tobytes()
        sent = head + picture[: 0xF780 // 2].astype("<u2").tobytes()
        while sent:
            sent = sent[os.write(device.file, sent) :]
        os.write(device.file, words("0B03 0040 0 0 27F 62 F780").astype("<u2").tobytes())
        answer = np.frombuffer(read(device.file, 0xF780), "<u2")
        assert (answer == picture[: len(answer)]).all()
        os.write(device.file, np.tile(OUTLINE, 20).astype("<u2").tobytes() + b"!")
        device.end()
        assert device.error is None
        twin = Ramtek9300()
        twin.send(words("0A03 0040 0 0 27F 62 F780"))
        twin.send(picture[: 0xF780 // 2].astype(np.uint16))
        twin.send(OUTLINE)
        assert (server.display.words == twin.words).all()
        assert server.display.decoder.held_words == 0


def test_a_display_that_leaves_ends_the_relay_with_an_error(tmp_path: Path) -> None:
    with on_a_display(tmp_path / "display") as (server, device):
        os.write(device.file, words("0902 0044 7 5 5 5 5 0B03 0040 5 5 5 5 2").astype("<u2").tobytes())
        assert read(device.file, 2) == b"\x07\0"
    device.join()
    assert str(device.error) == (
        f"a display must stay at {server.address} while a program uses it, and it left; "
        "start the program again later"
    )


def test_a_program_that_takes_no_replies_is_stopped_and_not_kept_in_memory(tmp_path: Path) -> None:
    with on_a_display(tmp_path / "display") as (_, device):
        os.set_blocking(device.file, False)
        asked = words("0B03 0040 0 0 27F 1F A000").astype("<u2").tobytes()
        assert 1000 < stopped_after(device, 200 * asked) < 1 << 24
        assert len(device._relay._written) < 1 << 20
        assert len(device._relay._replies) < 1 << 20
        device.end()


def stopped_after(device: Device, data: bytes) -> int:
    """How many bytes a program has written, again and again, when its device takes no more for a second."""
    written = 0
    patience = time.monotonic() + 1
    while time.monotonic() < patience:
        try:
            written += os.write(device.file, data[written % len(data) :])
            patience = time.monotonic() + 1
        except BlockingIOError:
            time.sleep(0.001)
        assert written < 1 << 24
    return written
