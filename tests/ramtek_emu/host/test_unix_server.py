from __future__ import annotations

import os
import socket
import stat
from pathlib import Path

import numpy as np
import pytest

from ramtek_emu import OutputError, OutputExistsError, PortError, Ramtek9300
from ramtek_emu.host.unix_port import UnixPort
from ramtek_emu.host.unix_server import UnixServer
from tests.ramtek_emu.recorded_streams import OUTLINE
from tests.ramtek_emu.serving import serving_at


def dead_socket(path: Path) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        listener.bind(str(path))


def test_the_socket_is_its_owner_s_alone_and_goes_with_the_server(tmp_path: Path) -> None:
    path = tmp_path / "display"
    before = os.umask(0)
    try:
        with UnixServer(Ramtek9300(), path) as server:
            assert server.address == str(path)
            assert stat.S_IMODE(path.stat().st_mode) == 0o600
    finally:
        os.umask(before)
    assert not path.exists()


def test_the_socket_of_a_server_that_is_gone_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "display"
    dead_socket(path)
    with serving_at(path) as server, UnixPort(path) as port:
        port.send(OUTLINE)
        port.close()
        assert server.display.words.any()


@pytest.mark.parametrize("kind", ["file", "folder", "link", "server"])
def test_what_is_at_the_path_already_is_left_alone(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "display"
    server = None
    if kind == "file":
        path.write_text("mine")
    elif kind == "folder":
        path.mkdir()
    elif kind == "link":
        path.symlink_to(tmp_path / "nothing")
    else:
        server = UnixServer(Ramtek9300(), path)
    before = path.lstat()
    with pytest.raises(OutputExistsError) as refusal:
        UnixServer(Ramtek9300(), path)
    assert str(refusal.value) == (
        "a server's socket must be a new file or the socket of a server that is gone, "
        f"not {path}, which {'belongs to a server that runs' if server else 'exists'}; choose another path"
    )
    assert path.lstat().st_ino == before.st_ino
    if server is not None:
        assert not server.step()
        server.close()


def test_a_server_leaves_a_file_that_took_the_place_of_its_socket(tmp_path: Path) -> None:
    path = tmp_path / "display"
    with UnixServer(Ramtek9300(), path):
        path.unlink()
        path.write_text("mine")
    assert path.read_text() == "mine"


@pytest.mark.parametrize("path", ["no folder/display", "x" * 200])
def test_a_path_where_no_socket_can_be_made_is_refused(path: str, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"a server's socket must be where one can be made, not at"):
        UnixServer(Ramtek9300(), tmp_path / path)


def test_a_system_without_sockets_of_packets_is_told_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(socket, "SOCK_SEQPACKET")
    with pytest.raises(PortError) as refusal:
        UnixServer(Ramtek9300(), tmp_path / "display")
    assert refusal.value.exit_code == 69
    assert str(refusal.value) == (
        "a system must have Unix sockets that keep the boundaries of writes, and this one does not "
        "(no sock_seqpacket); use TCP or a pipe"
    )


def test_packets_of_random_bytes_leave_the_display_that_their_whole_words_leave(tmp_path: Path) -> None:
    draw = np.random.default_rng(9400)
    packets = [draw.bytes(int(draw.integers(1, 300))) for _ in range(400)]
    twin = Ramtek9300()
    for packet in packets:
        twin.send(np.frombuffer(packet[: len(packet) & ~1], "<u2").astype(np.uint16))
    with serving_at(tmp_path / "display") as server:
        with UnixPort(tmp_path / "display") as port:
            for packet in packets:
                port.write(packet)
        assert (server.display.words == twin.words).all()
        assert (server.display.entries == twin.entries).all()
        assert server.display.processor.waiting == 0
