from __future__ import annotations

import pytest

from ramtek_emu import (
    SnapshotError,
)
from ramtek_emu.snapshot.snapshot import display_of
from tests.ramtek_emu.snapshots import SNAPSHOT, texts_of, with_text


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
