from __future__ import annotations

import socket

from ramtek_emu.host.connection import PacketConnection
from ramtek_emu.host.marks import Sign


def test_a_packet_loses_its_odd_byte_and_replies_keep_their_boundaries() -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = PacketConnection(there)
    with host, there:
        for packet in (b"abc", b"d", b"ef"):
            host.send(packet)
        assert [display.read() for _ in range(3)] == [b"ab", b"", b"ef"]
        display.reply(b"12")
        display.reply(b"")
        display.reply(b"3456")
        assert display.waiting == 6
        while display.has_to_send:
            display.send()
        assert [host.recv(100), host.recv(100)] == [b"12", b"3456"]
        host.close()
        assert display.read() is Sign.END


def test_the_answer_to_a_mark_takes_the_place_of_the_replies_that_wait() -> None:
    host, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = PacketConnection(there)
    with host, there:
        display.reply(b"old")
        display.answer_mark()
        assert display.has_to_send
        display.reply(b"new")
        while display.has_to_send:
            display.send()
        assert [host.recv(100), host.recv(100)] == [b"", b"new"]
