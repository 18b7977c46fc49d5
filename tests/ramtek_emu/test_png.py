from __future__ import annotations

import os
from io import BytesIO
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from ramtek_emu.arrays import Colors, Words
from ramtek_emu.png import TABLE, indexed_png_bytes, png_bytes, save_png, word_png_bytes

FIELD = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)


def test_a_saved_field_is_read_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "field.png"
    save_png(FIELD, path)
    with Image.open(path) as picture:
        assert (np.asarray(picture) == FIELD).all()
    assert path.read_bytes() == png_bytes(FIELD)
    assert os.listdir(tmp_path) == ["field.png"]


@given(
    arrays(np.uint16, st.tuples(st.integers(1, 5), st.integers(1, 5)), elements=st.integers(0, 1023)),
    arrays(np.uint8, st.tuples(st.sampled_from([1, 255, 1024]), st.just(3))),
)
def test_words_and_entries_are_read_back_as_they_were(words: Words, entries: Colors) -> None:
    with Image.open(BytesIO(word_png_bytes(words[:, ::-1], entries))) as file:
        assert file.mode == "I;16"
        assert (np.asarray(file) == words[:, ::-1]).all()
        assert bytes.fromhex(file.info[TABLE]) == entries.tobytes()


@given(st.data(), st.one_of(st.integers(1, 20), st.just(256)))
def test_indices_and_a_palette_are_read_back_as_they_were(data: st.DataObject, count: int) -> None:
    palette = data.draw(arrays(np.uint8, (count, 3)))
    indices = data.draw(arrays(np.uint8, (3, 5), elements=st.integers(0, count - 1)))
    with Image.open(BytesIO(indexed_png_bytes(indices, palette))) as file:
        assert file.mode == "P"
        assert (np.asarray(file) == indices).all()
        assert (np.asarray(file.convert("RGB")) == palette[indices]).all()
