from __future__ import annotations

import selectors
import socket

import pytest

from ramtek_emu import Ramtek9300
from ramtek_emu.arrays import Words
from ramtek_emu.host.client import Client
from ramtek_emu.host.connection import PacketConnection
from ramtek_emu.host.host_session import HostSession
from tests.ramtek_emu.recorded_streams import words


def packet(text: str) -> bytes:
    return words(text).astype("<u2").tobytes()


def test_a_host_that_takes_no_more_replies_is_still_drawn_for() -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = Ramtek9300()
    client = Client(PacketConnection(there), HostSession(display), 10, 10)
    host.send(packet("0B03 0040 0 0 0 0 2"))
    host.send(packet("0902 0044 7 5 5 5 5"))
    host.close()
    for _ in range(20):
        client.serve(client.wanted)
        client.work()
    assert client.ended
    assert display.words[5, 5] == 7
    client.leave()


def test_the_time_that_the_display_takes_is_no_silence_of_the_host(monkeypatch: pytest.MonkeyPatch) -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = Ramtek9300()
    client = Client(PacketConnection(there), HostSession(display), 10, 10)
    now = 1000.0
    monkeypatch.setattr("ramtek_emu.host.client.time.monotonic", lambda: now)
    monkeypatch.setattr("ramtek_emu.host.host_session.READING_PIECE", 4)
    draw = display.send

    def slow(sent: Words) -> None:
        nonlocal now
        now += 7
        draw(sent)

    monkeypatch.setattr(display, "send", slow)
    host.send(packet("0902 0044 7 5 5 5 5 0B03 0040 0 0 0 0 2"))
    client.serve(client.wanted)
    while client.has_work:
        client.work()
        assert client.deadline > now
    assert now > 1020
    assert display.words[5, 5] == 7
    now += 11
    assert client.deadline < now
    host.close()
    client.leave()


def test_a_mark_resets_the_display_and_is_recorded_as_a_reset() -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    kept: list[bytes] = []
    display = Ramtek9300()
    client = Client(PacketConnection(there), HostSession(display, kept.append), 10, 10)
    with host:
        for sent in (packet("0902 0044 7 5 5 5 5 0A01 0008"), b"", packet("0902 0044 9 6 6 6 6")):
            host.send(sent)
        for _ in range(20):
            client.serve(client.wanted & selectors.EVENT_READ)
            client.work()
        assert display.words[[5, 6], [5, 6]].tolist() == [0, 9]
        assert b"".join(kept) == packet("0902 0044 7 5 5 5 5 0500 0902 0044 9 6 6 6 6")
        client.serve(selectors.EVENT_WRITE)
        assert host.recv(10) == b""
    client.leave()
