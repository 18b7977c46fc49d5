from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu import Ramtek9300, ReplyError
from tests.ramtek_emu.displays import sent
from tests.ramtek_emu.strategies import SMALL


def test_asking_for_more_than_waits_is_refused_by_name() -> None:
    display = sent("0B03 0040 0000 0000 0003 0000 0008")
    with pytest.raises(ReplyError) as refusal:
        display.receive(5)
    assert str(refusal.value) == (
        "the words received must be 0 to 4, which wait, not 5; send an instruction that reads them first"
    )
    assert display.receive(3).tolist() == [0, 0, 0]
    assert display.receive(1).tolist() == [0]


def test_what_a_host_never_reads_does_not_fill_the_memory() -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array([0x0B01, 0xFFFF] * 400, np.uint16))
    assert display.processor.waiting == 1 << 22
