from __future__ import annotations

import numpy as np

from ramtek_emu import Ramtek9300
from ramtek_emu.host.host_session import HostSession


def test_a_session_never_lets_more_replies_wait_than_the_display_holds() -> None:
    session = HostSession(Ramtek9300())
    asked = np.tile(np.array([0x0B01, 0xFFFE], np.uint16), 2000).astype("<u2").tobytes()
    count = sum(len(reply) for reply in session.feed(asked))
    assert count == 2000 * 0xFFFE
    assert session.words == 4000
