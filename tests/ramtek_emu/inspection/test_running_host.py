from __future__ import annotations

import time
from types import SimpleNamespace

import numpy as np
import pytest

from ramtek_emu import Ramtek9300, TcpPort, instructions
from ramtek_emu.host import server as module_of_servers
from ramtek_emu.host.server import TcpServer
from ramtek_emu.inspection import panels
from ramtek_emu.inspection import running_host as module
from ramtek_emu.inspection.running_host import RunningHost
from ramtek_emu.inspection.session import inspection_of
from tests.ramtek_emu.inspection.sessions import Served, Steps, text_of
from tests.ramtek_emu.recorded_streams import OUTLINE

POINTS = np.random.default_rng(1).integers(0, (640, 480), (16000, 2))
"""Vertices of an instruction that takes long."""


@pytest.fixture
def small_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tick executes as little as it can."""
    monkeypatch.setattr(module_of_servers, "SLICE_SECONDS", 0.0)
    monkeypatch.setattr(module, "PIECE_SECONDS", 0.0)


def test_a_paused_host_waits_and_is_not_disconnected(monkeypatch: pytest.MonkeyPatch) -> None:
    with TcpServer(Ramtek9300(), idle_seconds=5) as server:
        host = RunningHost(server)
        session, replay = Steps(inspection_of(host)), host.replay
        port = TcpPort(server.address)
        port.send(instructions.read_cursor(0))
        while not len(replay.stream):
            session.tick()
        session.pause()
        port.send(np.tile(instructions.read_cursor(0), 2))
        offset = 0.0
        later = SimpleNamespace(monotonic=lambda: time.monotonic() + offset, perf_counter=time.perf_counter)
        monkeypatch.setattr(module_of_servers, "time", later)
        for _ in range(100):
            # The host is silent for minutes in all, but none of its words is executed.
            offset += 4
            session.tick()
        assert session.state.number == len(replay.stream) == 1
        assert server.busy
        monkeypatch.undo()
        assert port.receive(2).tolist() == [0, 0]
        session.go_on()
        while len(replay.stream) < 3:
            session.tick()
        # The last instruction is executed, and its reply may still wait to be sent.
        while server.step():
            pass
        assert port.receive(4).tolist() == [0, 0, 0, 0]
        port.socket.close()


def test_the_past_of_a_running_display_has_its_cursors_where_the_joystick_moved_them() -> None:
    served = Served(Ramtek9300())
    served.host.display.joystick.move_to(200, 100)
    served.execute(OUTLINE)
    session = served.inspection
    session.go(len(session.replay.stream) - 1)
    assert "200,100" in text_of(panels.cursors(session.state)[0])


def test_a_running_display_forgets_its_past_before_memory_is_full(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_BYTES", 3 << 20)
    served = Served(Ramtek9300())
    session = served.inspection
    first = session.replay.stream
    picture = np.arange(480 * 640).reshape(480, 640) % 1024
    while session.replay.stream is first:
        if not served.host_session.unexecuted:
            served.send(instructions.write_image(picture))
        session.tick()
    state = session.state
    assert (state.number, state.target, state.length) == (0, 0, 0)
    assert state.message.endswith("MB of memory: they are counted from here on")
    served.execute()
    # The instructions are counted anew, and the past begins with the picture as it was.
    begin = len(session.replay.stream)
    served.execute(instructions.erase((0, 0, 9, 9), 5), instructions.erase((0, 0, 1, 1), 6))
    session.pause()
    assert session.state.number == session.state.length == begin + 2 < len(first)
    shown = []
    for number in (0, begin + 1, begin + 2):
        session.go(number)
        shown.append((session.state.number, session.display.words[0, 5], session.display.words[0, 0]))
    assert shown == [(0, 5, 0), (begin + 1, 5, 5), (begin + 2, 5, 6)]
    # It is also so in a pause, where a joystick may still move.
    monkeypatch.setattr(module, "MOST_BYTES", 0)
    session.tick()
    assert (session.state.number, session.state.target, session.state.length) == (0, 0, 0)
    assert len(panels.listing(session.state)) == 1


@pytest.mark.usefixtures("small_pieces")
def test_a_host_can_be_paused_within_a_long_instruction() -> None:
    served = Served(Ramtek9300())
    served.send(*(instructions.write_vectors(POINTS + shift, 7 + shift) for shift in (0, 1)))
    session = served.inspection
    while not served.host.display.words.any():
        session.tick()
    session.pause()
    drawn = served.host.display.words.copy()
    for _ in range(5):
        session.tick()
    assert session.state.length == 0
    assert np.array_equal(session.display.words, drawn)
    session.go_on()
    served.execute()
    session.pause()
    expected = Ramtek9300()
    for number in (1, 2):
        session.go(number)
        expected.send(session.replay.stream.words_between(number - 1, number))
        assert np.array_equal(session.display.words, expected.words)


def is_alike(served: Served) -> bool:
    """Whether the replay has come to the display as it is."""
    replayed, display = served.inspection.replay.display, served.host.display
    return (replayed.words == display.words).all() and str(replayed.cursors[0]) == str(display.cursors[0])


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize("is_paused", [False, True])
@pytest.mark.parametrize("has_more", [False, True])
def test_a_reset_within_a_long_instruction_is_in_the_past(is_paused: bool, has_more: bool) -> None:
    more = [instructions.write_vectors(POINTS[::-1], 9), instructions.erase((9, 9, 90, 90), 3)]
    first = [instructions.write_cursor(0, 100, 100), instructions.write_vectors(POINTS, 7)]
    served = Served(Ramtek9300())
    served.send(*first, *(more if has_more else []))
    session = served.inspection
    while not (served.host.display.words == 7).any():
        session.tick()
    assert served.host_session.is_within
    if is_paused:
        session.pause()
    served.host_session.reset()
    served.host.display.joystick.move_to(30, 40)
    if is_paused:
        session.tick()
        session.go(session.state.length)
        assert session.state.number == 2
        assert is_alike(served)
    session.go_on()
    served.execute()
    served.execute(instructions.erase((50, 50, 52, 52), 5))
    session.pause()
    assert len(session.replay.stream) == (5 if has_more else 3)
    session.go(session.state.length - 1)
    session.go(session.state.length)
    assert is_alike(served)
    session.go(1)
    assert session.display.cursors[0].is_visible
