from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import (
    SnapshotError,
)
from ramtek_emu.configuration import GMR_9300
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.snapshot.plain_values import listed, packed, plain, restored, unpacked, whole_number
from ramtek_emu.snapshot.snapshot import display_of
from tests.ramtek_emu.snapshots import SNAPSHOT, texts_of, with_text
from tests.ramtek_emu.strategies import SMALL, quick


@pytest.mark.parametrize(
    ("keyword", "old", "new", "part"),
    [
        ("Software", "snapshot 1", "snapshot 9", "of the format 'ramtek_emu snapshot 1'"),
        ("configuration", '"elements":13', '"elements":14', "must have 14 x 9 words"),
        ("configuration", '"elements":13', '"elements":99999999', "from -32768 to 65535, not 99999999"),
        ("configuration", '"elements":13', '"elements":-1', "elements must be a whole number from 1"),
        ("configuration", '"planes":10', '"planes":1', "a word of a snapshot must be 0 to 1"),
        ("configuration", '"PAIR_24"', '"PAIR_99"', "must be one of PAIR_24, WORD_12"),
        ("configuration", '"name"', '"nome"', "must be an object of name"),
        ("parameters", '"scan_order":0', '"scan_order":"0"', "parameters.scan_order of a snapshot"),
        ("parameters", '"scan_order":0', '"scan_order":1e9', "parameters.scan_order of a snapshot"),
        ("parameters", '"zoom":[1,1]', '"zoom":[0,1]', "parameters.zoom[0] of a snapshot must be a whole"),
        ("parameters", '"zoom":[1,1]', '"zoom":[1]', "must be 2 items"),
        ("parameters", '"zoom":[1,1]', '"zoom":true', "must be 2 items"),
        ("cursors", '"track":false', '"track":0', "track of a snapshot must be true or false, not 0"),
        ("cursors", '"shape":"', '"shape":"!', "bytes in base64"),
        ("lookup table", '"address":0', '"address":5000', "address of a snapshot"),
        ("processor", '"illegal":false', '"illegal":null', "illegal of a snapshot must be true or false"),
    ],
)
def test_a_value_that_does_not_fit_is_refused_by_name(keyword: str, old: str, new: str, part: str) -> None:
    text = texts_of(SNAPSHOT)[keyword]
    assert old in text
    with pytest.raises(SnapshotError) as refusal:
        display_of(with_text(keyword, text.replace(old, new, 1)))
    assert part in str(refusal.value)
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 700


@quick
@given(
    st.lists(st.integers(0, 0xFFFF), min_size=6, max_size=6),
    st.lists(st.booleans(), min_size=11, max_size=11),
)
def test_what_was_made_plain_is_restored_through_json(words: list[int], dots: list[bool]) -> None:
    parameters = Parameters.at_reset(SMALL)
    parameters.conic = tuple(words)
    parameters.background = words[0]
    state = {
        "parameters": parameters,
        "words": np.array(words, np.uint16).reshape(2, 3),
        "dots": np.array(dots),
        "configuration": GMR_9300,
    }
    for name, value in state.items():
        pattern = value if name != "parameters" else Parameters.at_reset(SMALL)
        again = restored(pattern, json.loads(json.dumps(plain(value))), name)
        assert np.array_equal(again, value) if isinstance(value, np.ndarray) else again == value


@quick
@given(st.binary(max_size=200), st.integers(0, 3))
def test_packed_bytes_are_unpacked_when_they_are_as_many_as_expected(data: bytes, more: int) -> None:
    text = packed(data)
    if not more:
        assert unpacked(text, len(data), "pixels") == data
        return
    with pytest.raises(SnapshotError) as refusal:
        unpacked(text, len(data) + more, "pixels")
    assert str(refusal.value).startswith(
        f"pixels of a snapshot must be {len(data) + more} packed bytes, not "
    )


@pytest.mark.parametrize("value", [True, 1.0, "1", None, -1, 11])
def test_a_number_is_whole_and_within_its_limits(value: object) -> None:
    with pytest.raises(SnapshotError) as refusal:
        whole_number(value, (0, 10), "lines")
    assert str(refusal.value) == (
        f"lines of a snapshot must be a whole number from 0 to 10, not {value!r}; "
        "take a new one with --snapshot"
    )


def test_a_list_is_no_longer_than_it_may_be() -> None:
    assert listed((0, 0), [[1, 2], [3, 4]], "driven", 2) == [(1, 2), (3, 4)]
    with pytest.raises(SnapshotError, match="driven of a snapshot must be a list of at most 1, not"):
        listed((0, 0), [[1, 2], [3, 4]], "driven", 1)
