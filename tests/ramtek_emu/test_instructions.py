from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from ramtek_emu import InstructionError, WordsError, instructions


def test_an_instruction_takes_at_most_10922_circles() -> None:
    for count in (1, 10_921, 10_922):
        assert len(instructions.write_circles([(1, 1, 1)] * count)) == 2 + 3 * count
    for count in (0, 10_923):
        with pytest.raises(WordsError, match="with 1 to 10922 rows"):
            instructions.write_circles([(1, 1, 1)] * count)


def test_the_lookup_table_is_addressed_by_words() -> None:
    assert instructions.park_table().tolist() == [0x0300, 0, 0]
    assert instructions.park_table(5).tolist() == [0x0300, 5, 0]
    assert instructions.read_entries().tolist() == [0x0400, 0, 4096]
    assert instructions.read_entries(6, 3).tolist() == [0x0400, 6, 6]
    assert instructions.load_entries(7, [[1, 2, 3]]).tolist()[:2] == [0x0300, 14]
    for words in (0, 1, 32766, 32767):
        assert instructions.read_entries(0, words)[2] == 2 * words
    for wrong in (-1, 32768):
        with pytest.raises(InstructionError, match="the words to read must be 0 to 32767"):
            instructions.read_entries(0, wrong)


def test_encoders_take_numbers_and_rows_of_python_and_of_numpy_alike() -> None:
    encoders: Any = instructions
    one, two, three = np.int64(1), np.uint8(2), np.int16(3)
    window = np.array([1, 2, 3, 9])
    pairs = [
        (encoders.set_parameters(foreground=np.array(3)), encoders.set_parameters(foreground=3)),
        (encoders.erase(window, three), encoders.erase((1, 2, 3, 9), 3)),
        (encoders.erase(window.tolist()), encoders.erase(window)),
        (encoders.write_image([[1, 2]], one, two, three), encoders.write_image([[1, 2]], 1, 2, 3)),
        (encoders.write_text("ab", one, two, size=three), encoders.write_text("ab", 1, 2, size=3)),
        (
            encoders.write_text(bytearray(b"ab"), 1, 2, size=[two, three]),
            encoders.write_text(b"ab", 1, 2, size=(2, 3)),
        ),
        (encoders.write_vectors([(1, 2)], start=window[:2]), encoders.write_vectors([(1, 2)])),
        (encoders.write_circles(((1, 2, 3),)), encoders.write_circles(np.array([[1, 2, 3]]))),
        (encoders.zoom(three, two), encoders.zoom(3, 2)),
        (encoders.write_cursor(one, two, three), encoders.write_cursor(1, 2, 3)),
        (encoders.read_entries(one, two), encoders.read_entries(1, 2)),
        (encoders.load_entries(one, [[1, 2, 3]]), encoders.load_entries(1, np.array([[1, 2, 3]]))),
        (encoders.concatenate([0x0500], range(2)), np.array([0x0500, 0, 1], np.uint16)),
    ]
    for encoded, expected in pairs:
        assert encoded.dtype == np.uint16
        assert encoded.tolist() == expected.tolist()
    for (encoded, count), (expected, again) in zip(
        encoders.read_image(one, one, two, three), encoders.read_image(1, 1, 2, 3), strict=True
    ):
        assert (encoded.tolist(), count) == (expected.tolist(), again)
