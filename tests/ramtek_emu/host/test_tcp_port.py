from __future__ import annotations

import copy
import pickle
import socket
import threading
from typing import Any

import numpy as np
import pytest

from ramtek_emu import PortError, ReplyError, TcpPort, instructions
from ramtek_emu.host.tcp_port import host_and_port
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.serving import READ_EVERYTHING, serving, until


def test_a_port_without_a_display_is_refused_in_one_sentence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(PortError) as refusal:
        TcpPort(f"tcp://127.0.0.1:{port}")
    assert str(refusal.value) == (
        f"a display must listen at tcp://127.0.0.1:{port}, and it is not reached (connection refused); "
        "start `ramtek serve` there"
    )


@pytest.mark.parametrize(
    "address",
    ["", "127.0.0.1:1", "tcp://", "tcp://a", "tcp://a:0", "tcp://a:70000", "tcp://a:b", "tcp://a b:1", 9300],
)
def test_what_is_no_address_is_refused(address: Any) -> None:
    with pytest.raises(PortError) as refusal:
        host_and_port(address)
    assert str(refusal.value) == (
        f"an address must be tcp://host:port with a port from 1 to 65535, not {address!r}; write it so"
    )


def test_words_that_do_not_come_are_refused_after_a_while() -> None:
    with serving() as server, TcpPort(server.address, timeout=0.2) as port:
        port.send(words("0B03 0040 0 0 0 0 2"))
        with pytest.raises(ReplyError) as refusal:
            port.receive(3)
        assert "within 0.2 seconds, not 3 of which 1 came" in str(refusal.value)
        assert port.receive(1).tolist() == [0]
        with pytest.raises(ReplyError):
            port.receive(-1)
    with pytest.raises(PortError, match="must be open"):
        port.send(words("0700"))


def test_after_closing_everything_that_was_sent_is_drawn() -> None:
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    with serving() as server:
        for shift in range(5):
            with TcpPort(server.address) as port:
                port.send(instructions.write_image((picture + shift) % 1024))
            assert (server.display.words == (picture + shift) % 1024).all()


def test_closing_drops_the_replies_that_nobody_took_and_loses_no_word() -> None:
    with serving() as server:
        with TcpPort(server.address) as port:
            port.send(np.concatenate((READ_EVERYTHING, READ_EVERYTHING, OUTLINE)))
        assert server.display.words.any()
        port.close()


def silent_listener() -> socket.socket:
    """A server that accepts nobody: whoever comes waits in its line."""
    return socket.create_server(("127.0.0.1", 0))


def test_a_display_that_does_not_get_to_the_end_is_told_when_closing() -> None:
    with silent_listener() as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        port = TcpPort(address, timeout=0.2)
        port.send(OUTLINE)
        with pytest.raises(PortError) as refusal:
            port.close()
    assert str(refusal.value) == (
        f"a display must get to the end of what it was sent within 0.2 seconds, and {address} has not: "
        "it may be serving another host first; give a longer timeout"
    )


@pytest.mark.parametrize("rudely", [False, True])
def test_a_host_that_is_turned_away_is_told_when_closing(rudely: bool) -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=5)
        connection, _ = listener.accept()
        if rudely:
            # With unread words, closing resets the connection.
            port.send(OUTLINE)
            connection.recv(1)
        connection.close()
        with pytest.raises(PortError, match=r"a display must stay at .*, and it left"):
            port.close()
        port.close()


def test_an_error_in_a_with_block_is_not_hidden_by_the_one_of_closing() -> None:
    with silent_listener() as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        with pytest.raises(ZeroDivisionError), TcpPort(address, timeout=0.1):
            raise ZeroDivisionError


def test_a_hard_reset_frees_a_display_that_waits_for_the_rest_of_an_instruction() -> None:
    with serving() as server, TcpPort(server.address) as port:
        port.send(instructions.load_entries(3, [[1, 2, 3]]))
        port.send(OUTLINE)
        server_words = server.display.words
        port.send(words("0802 0002 0009 1600 0064 0464 0B03 0040 0 0 9 9 C8 0A01 FFFE 1 2 3"))
        until(lambda: server.display.decoder.held_words == 5)
        port.reset()
        assert not server_words.any()
        assert server.display.decoder.held_words == 0
        assert not server.display.cursors[0].is_visible
        assert server.display.entries[3].tolist() == [1, 2, 3]
        # The replies of before are gone; the next are those of what is asked now.
        port.send(words("0902 0044 5 0 0 0 0 0B03 0040 0 0 0 0 2"))
        assert port.receive(1).tolist() == [5]


def test_many_resets_in_a_row_leave_the_words_between_them_whole() -> None:
    with serving() as server, TcpPort(server.address) as port:
        for number in range(50):
            port.send(words(f"0902 0044 {number + 1:X} 0 0 0 0 0B03 0040 0 0 0 0 2"))
            assert port.receive(1).tolist() == [number + 1]
            port.reset()
        assert not server.display.words.any()


def test_a_reset_that_is_not_answered_is_told() -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=0.2)
        with pytest.raises(PortError, match=r"a display must reset within 0\.2 seconds"):
            port.reset()
        with pytest.raises(PortError):
            port.close()


def test_a_reset_that_is_answered_late_still_drops_the_replies_of_before() -> None:
    with silent_listener() as listener:
        port = TcpPort(f"tcp://127.0.0.1:{listener.getsockname()[1]}", timeout=0.2)
        connected, _ = listener.accept()
        with connected:
            with pytest.raises(PortError):
                port.reset()
            connected.sendall(b"\1\0")
            connected.send(b"\0", socket.MSG_OOB)
            connected.sendall(b"\7\0")
            port.timeout = 10
            assert port.receive(1).tolist() == [7]
    with pytest.raises(PortError):
        port.close()


def test_replies_that_come_while_words_are_sent_are_kept_in_order() -> None:
    with serving() as server, TcpPort(server.address) as port:
        threads = threading.active_count()
        for _ in range(4):
            port.send(READ_EVERYTHING)
        assert not port.receive(4 * 480 * 640).any()
        assert threading.active_count() == threads


def test_a_connection_cannot_be_copied_or_pickled_and_says_why() -> None:
    with serving() as server:
        address = server.address
        with TcpPort(address) as port:
            for attempt in (copy.copy, copy.deepcopy, pickle.dumps):
                with pytest.raises(TypeError) as refusal:
                    attempt(port)
                assert str(refusal.value) == (
                    f"a connection must stay in its process, not be copied or pickled ({address}); "
                    "open another TcpPort there"
                )
            assert repr(port) == f"TcpPort({address}, open)"
        assert repr(port) == f"TcpPort({address}, closed)"
