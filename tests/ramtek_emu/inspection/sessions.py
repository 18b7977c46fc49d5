"""Sessions at rest, their panels as text, and hosts that a session can stop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, cast

import numpy as np

from ramtek_emu import Configuration, Ramtek9300
from ramtek_emu.host.server import HostSession, Server
from ramtek_emu.inspection import session as module
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.running_host import RunningHost
from ramtek_emu.inspection.session import Inspection, display_of, inspection_of
from ramtek_emu.monitor.boxes import Line
from tests.ramtek_emu.inspection.replays import replay_of
from tests.ramtek_emu.strategies import SMALL


class Steps:
    """An inspection that is replaced by the results of the functions of its module: `steps.go(5)`."""

    def __init__(self, value: Inspection) -> None:
        self.state = value

    @property
    def display(self) -> Ramtek9300:
        return display_of(self.state)

    @property
    def replay(self) -> Replay:
        return self.state.replay

    @property
    def is_busy(self) -> bool:
        return module.is_busy(self.state)

    def __getattr__(self, name: str) -> Callable[..., None]:
        function = getattr(module, name)

        def replace(*values: Any, **options: Any) -> None:
            self.state = function(self.state, *values, **options)

        return replace


def at_rest(session: Steps) -> Steps:
    """The session after all waiting work."""
    while session.is_busy:
        session.tick()
    return session


def text_of(line: Line) -> str:
    return "".join(span.text for span in line)


def session_of(*streams: object, configuration: Configuration = SMALL) -> Steps:
    """A prepared session of instructions, for the small display unless another is given."""
    words = np.concatenate([np.zeros(0, np.uint16), *(np.asarray(stream, np.uint16) for stream in streams)])
    return at_rest(Steps(inspection_of(replay_of(words.tolist(), configuration))))


class Served:
    """A host session that a stopped display executes, its inspection, and the replies to its host."""

    def __init__(self, display: Ramtek9300) -> None:
        self.session = self.host_session = HostSession(display)
        self.busy = False
        self.host = RunningHost(cast(Server, self))
        self.inspection = Steps(inspection_of(self.host))
        self.replies = b""
        self._waiting: Iterator[bytes] = iter(())

    def send(self, *streams: np.ndarray[tuple[int], np.dtype[np.uint16]]) -> None:
        """Send words, which wait until the inspection lets them be executed."""
        assert next(self._waiting, None) is None
        self._waiting = self.host_session.feed(np.concatenate(streams).astype("<u2").tobytes())

    def step(self, seconds: float) -> bool:
        reply = next(self._waiting, None)
        self.replies += reply or b""
        return reply is not None

    def execute(self, *streams: np.ndarray[tuple[int], np.dtype[np.uint16]]) -> None:
        """Send words, and let the running display execute them and all that waited before."""
        if streams:
            self.send(*streams)
        while self.host_session.unexecuted:
            self.inspection.tick()
