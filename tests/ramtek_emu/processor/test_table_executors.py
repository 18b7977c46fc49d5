from __future__ import annotations

from ramtek_emu import PRINCETON_9300
from tests.ramtek_emu.displays import sent


def test_tables_that_are_not_there_take_and_give_nothing() -> None:
    display = sent("0301 0000 0004 FFFF FFFF", "0401 0000 0004")
    assert not display.entries.any()
    assert display.receive(2).tolist() == [0, 0]


def test_recorded_color_map_3_splits_the_word_four_three_three() -> None:
    table = [(i & 0o1700) << 2 | (i & 0o070) << 2 | (i & 0o007) << 1 for i in range(1024)]
    assert table[:9] == [0, 2, 4, 6, 8, 0xA, 0xC, 0xE, 0x20]
    display = sent(
        "0300 0000 0800 " + " ".join(f"{word:04X}" for word in table),
        "0300 03FF 0002 0000",
        configuration=PRINCETON_9300,
    )
    assert display.entries[0x1FF].tolist() == [7 * 17, 14 * 17, 14 * 17]
    assert display.entries[1022].tolist() == [255, 14 * 17, 12 * 17]
    # Parking the counter overwrites the last entry.
    assert display.entries[1023].tolist() == [0, 0, 0]
    assert display.lookup_table.address == 0
