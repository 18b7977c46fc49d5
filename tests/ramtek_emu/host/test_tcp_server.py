from __future__ import annotations

import socket

import pytest

from ramtek_emu import PortError, Ramtek9300, TcpPort
from ramtek_emu.host.tcp_server import TcpServer
from tests.ramtek_emu.recorded_streams import words


def test_a_port_that_is_taken_is_refused_in_one_sentence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        with pytest.raises(PortError) as taken:
            TcpServer(Ramtek9300(), port)
    assert f"a server must have a port to itself, and 127.0.0.1:{port} cannot be had" in str(taken.value)


def test_an_address_of_version_six_is_one_that_a_port_takes() -> None:
    try:
        server = TcpServer(Ramtek9300(), host="::1")
    except PortError:
        pytest.skip("this machine has no IPv6")
    with server:
        assert server.address == f"tcp://[::1]:{server.port}"
        port = TcpPort(server.address)
        port.send(words("0902 0044 5 0 0 0 0"))
        while not server.display.words.any():
            server.step(0.1)
        port._socket.close()


def test_hosts_in_line_are_turned_away_when_the_server_closes() -> None:
    server = TcpServer(Ramtek9300())
    ports = [TcpPort(server.address, timeout=5) for _ in range(3)]
    server.step(1)
    server.close()
    for port in ports:
        with pytest.raises(PortError, match="it left"):
            port.close()
