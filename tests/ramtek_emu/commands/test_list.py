from __future__ import annotations

import json

import numpy as np

from tests.ramtek_emu.processes import run
from tests.ramtek_emu.recorded_streams import OUTLINE, words


def test_a_listing_in_json_holds_every_word() -> None:
    data = np.concatenate((OUTLINE, words("A3FF 0A01 0008"))).astype("<u2").tobytes() + b"!"
    listed = json.loads(run("list", "-", "--json", data=data).stdout)
    stream = [word for item in listed for word in item["words"]]
    assert np.array(stream, "<u2").tobytes() == data[:-1]
    assert listed[0] == {
        "place": 0,
        "words": [0x0802, 0x0002, 0x0100],
        "name": "SET",
        "meaning": "set parameters",
        "flags": [],
        "operands": {"foreground": [256]},
    }
    assert listed[-1]["byte"] == ord("!")
    assert json.loads(run("list", "-", "--json").stdout) == []
