"""A small snapshot, and the same with another text in it."""

from __future__ import annotations

from ramtek_emu import Ramtek9300
from ramtek_emu.snapshot import picture_bytes, picture_of, snapshot_bytes
from tests.ramtek_emu.recorded_streams import OUTLINE, words
from tests.ramtek_emu.strategies import SMALL

CURSORS = words("1600 0064 0C64 1601 0032 0440")


def small_snapshot() -> bytes:
    display = Ramtek9300(SMALL)
    display.send(OUTLINE)
    display.send(CURSORS)
    display.send(words("1300 0902 0044 0005 0000 0000 0003 0003"))
    return snapshot_bytes(display)


SNAPSHOT = small_snapshot()


def texts_of(data: bytes) -> dict[str, str]:
    return picture_of(data)[1]


def with_text(keyword: str, text: str) -> bytes:
    picture, texts = picture_of(SNAPSHOT)
    return picture_bytes(picture, texts | {keyword: text})
