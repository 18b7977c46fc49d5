"""The habits of the drivers of the time: long sessions in which parameters stay set."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ramtek_emu import JPL_9460, NCAR_9460, Ramtek9300
from tests.ramtek_emu.strategies import sent_words


def packed(data: bytes | NDArray[np.uint8]) -> list[int]:
    """Bytes as words, reverse packed."""
    words: list[int] = np.frombuffer(bytes(data), "<u2").tolist()
    return words


def test_the_image_driver_writes_and_reads_lines_of_bytes() -> None:
    display = Ramtek9300(JPL_9460)
    picture = np.random.default_rng(11).integers(0, 256, (20, 100), np.uint8)
    for line in range(20):
        row = packed(picture[line])
        head = [0x0A0F, 0x80C1, 0x0020, 0x00FF, 0, 0, 639, 479, 0, 50, 60 + line, 1, 100]
        display.send(sent_words([*head, *row]))
    assert (display.words[60:80, 50:150] == picture).all()
    display.send(sent_words([0x0B0F, 0x80C0, 0x0021, 0, 0, 639, 479, 0, 50, 65, 0x00FF, 1, 100]))
    assert display.receive(50).tolist() == packed(picture[5])


def test_the_weather_driver_clips_draws_and_colors() -> None:
    display = Ramtek9300(NCAR_9460)
    clip = [0x080E, 0x0041, 0x0006, 0xFF, 0, 512, 639, 1023, 0, 512, 639, 1023, 0, 512]
    display.send(sent_words([0x2701, *clip, 0x4EFF]))
    display.send(sent_words([0x0802, 0x0004, 3, 0x0909, 0, *clip]))
    assert (display.words[512:, :640] == 3).all()
    assert not display.words[:512].any()
    assert not display.words[:, 640:].any()
    image = [0x0A0F, 0x00C0, 0x0020, 8, 528, 11, 531, 0, 1, 16, *packed(np.arange(1, 17, dtype=np.uint8))]
    display.send(sent_words(image))
    assert display.words[528:532, 8:12].tolist() == np.arange(1, 17).reshape(4, 4).tolist()
    # Draw a line that leaves the clip window.
    display.send(sent_words([0x0E0F, 0x8002, 0x0008, 7, 600, 600, 0xFFFF, 0x1000, 4, 700, 600]))
    assert (display.words[600, 600:640] == 7).all()
    assert not display.words[600, 640:].any()
    table = [0x2901, 0x0300, 0, 1024, 0, 0, 0x0000, 0x00FF, 0xFF00, 0, 0x00FF, 0, *[0] * 504]
    display.send(sent_words([*table, 0x0300, 0, 0]))
    assert display.entries[:4].tolist() == [[0, 0, 0], [255, 0, 0], [0, 255, 0], [0, 0, 255]]
    # The video origin is at the bottom: line 528 of the memory is 528 lines up.
    assert display.field()[1023 - 528, 8].tolist() == [255, 0, 0]
    display.send(sent_words([0x2C00, 700, 0x400 | 900, 0x2E00]))
    assert display.receive(2).tolist() == [700, 0x400 | 900]
