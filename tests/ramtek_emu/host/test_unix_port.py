from __future__ import annotations

import socket
import threading
from pathlib import Path

import numpy as np
import pytest

from ramtek_emu import PortError, UnixPort, instructions
from tests.ramtek_emu.recorded_streams import words
from tests.ramtek_emu.serving import READ_EVERYTHING, serving_at, until

NAME = bytes.fromhex("030c 4000 0000 0000 4001 0900 0600 5645 4e45 3231 00")
"""A text instruction of 21 bytes, as a program of the time wrote it."""


def test_each_write_is_rounded_down_to_whole_words_alone(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server, UnixPort(tmp_path / "display") as port:
        assert len(NAME) == 21
        port.write(NAME)
        port.write(bytes.fromhex("0017"))
        assert port.receive(2).tolist() == [0, 0]
        assert server.display.words.any()
        assert server.display.decoder.held_words == 0
        # Single bytes are no words at all.
        for byte in b"\x02\x09\x44":
            port.write(bytes((byte,)))
        port.send(words("0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [server.display.words[0, 0]]


def test_a_whole_picture_goes_both_ways(tmp_path: Path) -> None:
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    with serving_at(tmp_path / "display"), UnixPort(tmp_path / "display") as port:
        port.send(instructions.write_image(picture))
        for _ in range(3):
            port.send(READ_EVERYTHING)
        for _ in range(3):
            assert (port.receive(480 * 640) == picture.reshape(-1)).all()


def test_two_hundred_hosts_one_right_after_another_all_draw_at_a_unix_socket(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with serving_at(path) as server:
        for number in range(0, 200, 2):
            with UnixPort(path) as port:
                port.send(words(f"0902 0044 {number + 1:X} {number:X} 9 {number:X} 9"))
            with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as host:
                host.connect(str(path))
                drawing = words(f"0902 0044 {number + 2:X} {number + 1:X} 9 {number + 1:X} 9")
                host.send(drawing.astype("<u2").tobytes())
        until(lambda: server.served == 200)
        assert server.display.words[9, :200].tolist() == list(range(1, 201))


def test_a_hard_reset_frees_a_display_that_waits_for_the_rest_of_an_instruction(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display") as server, UnixPort(tmp_path / "display") as port:
        port.send(words("0902 0044 7 0 0 9 9 0B03 0040 0 0 9 9 C8 0A01 FFFE 1 2 3"))
        port.reset()
        assert not server.display.words.any()
        assert server.display.decoder.held_words == 0
        port.send(words("0902 0044 5 0 0 0 0 0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [5]


def test_more_hosts_than_the_line_holds_find_a_place_later(tmp_path: Path) -> None:
    path = tmp_path / "display"

    def draw(number: int) -> None:
        with UnixPort(path, timeout=20) as port:
            port.send(words(f"0902 0044 5 {number:X} 9 {number:X} 9"))

    with serving_at(path) as server:
        first = UnixPort(path)
        until(lambda: server.busy)
        hosts = [threading.Thread(target=draw, args=(number,)) for number in range(150)]
        for host in hosts:
            host.start()
        first.close()
        for host in hosts:
            host.join()
        assert (server.display.words[9, :150] == 5).all()


def test_a_write_that_is_too_long_for_a_packet_is_refused(tmp_path: Path) -> None:
    with serving_at(tmp_path / "display"), UnixPort(tmp_path / "display") as port:
        with pytest.raises(PortError) as refusal:
            port.write(bytes(65537))
        assert str(refusal.value) == (
            "a write must be at most 65536 bytes, not 65537; divide it at an even place"
        )


def test_a_path_without_a_display_is_refused_in_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with pytest.raises(PortError) as refusal:
        UnixPort(path)
    assert str(refusal.value) == (
        f"a display must listen at {path}, and it is not reached (no such file or directory); "
        f"start `ramtek serve --unix {path}`"
    )
