from __future__ import annotations

import struct
import tracemalloc
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from ramtek_emu import (
    SnapshotError,
)
from ramtek_emu.arrays import Words
from ramtek_emu.snapshot.png_chunks import MOST_TEXT, picture_bytes, picture_of
from ramtek_emu.snapshot.snapshot import display_of
from tests.ramtek_emu.snapshots import SNAPSHOT
from tests.ramtek_emu.strategies import quick


def chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def hostile(*chunks: bytes, header: bytes = struct.pack(">IIBBBBB", 13, 9, 16, 0, 0, 0, 0)) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + b"".join((chunk(b"IHDR", header), *chunks, chunk(b"IEND", b"")))


@pytest.mark.parametrize(
    ("data", "part"),
    [
        (b"", "begin as a PNG file does"),
        (b"GIF89a", "begin as a PNG file does"),
        (SNAPSHOT[:-5], "have whole chunks"),
        (SNAPSHOT[:40], "have whole chunks"),
        (SNAPSHOT[:20] + b"\x99" + SNAPSHOT[21:], "right checksum"),
        (hostile(header=struct.pack(">IIBBBBB", 1 << 31, 1, 16, 0, 0, 0, 0)), "1 to 4096 elements and lines"),
        (hostile(header=struct.pack(">IIBBBBB", 13, 9, 8, 2, 0, 0, 0)), "16 bits gray"),
        (hostile(header=struct.pack(">IIBBBBB", 13, 9, 16, 0, 0, 0, 1)), "not interlaced"),
        (hostile(), "have pixels|9 lines of 13 words"),
        (hostile(chunk(b"IDAT", b"nonsense")), "have pixels that can be unpacked"),
        (hostile(chunk(b"IDAT", zlib.compress(bytes(10)))), "9 lines of 13 words"),
        (hostile(chunk(b"IDAT", zlib.compress(bytes(50_000_000)))), "9 lines of 13 words"),
        (hostile(chunk(b"IDAT", zlib.compress(b"\2" * 9 * 27))), "unfiltered lines"),
        (hostile(chunk(b"PLTE", b"")), "chunks that are known"),
        (hostile(chunk(b"tEXt", b"no zero")), "texts with a keyword"),
        (hostile(chunk(b"tEXt", b"a\0\xff")), "in ASCII"),
        (hostile(*[chunk(b"tEXt", b"a\0b")] * 2), "each text once"),
        (hostile(*[chunk(b"tEXt", b"%d\0" % n + b"a" * 900_000) for n in range(10)]), f"at most {MOST_TEXT}"),
        (hostile(*[chunk(b"tIME", b"")] * 70_000), "end within 65536 chunks"),
    ],
)
def test_a_hostile_file_is_refused_by_one_sentence(data: bytes, part: str) -> None:
    tracemalloc.start()
    with pytest.raises(SnapshotError) as refusal:
        display_of(data)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert any(piece in str(refusal.value) for piece in part.split("|"))
    assert str(refusal.value).endswith("take a new one with --snapshot")
    assert most < 3 * len(data) + (8 << 20)


names = st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1, max_size=20)


@quick
@given(
    arrays.arrays(np.uint16, st.tuples(st.integers(1, 6), st.integers(1, 6))),
    st.dictionaries(names, names, max_size=3),
)
def test_words_and_texts_come_back_as_they_were_written(words: Words, texts: dict[str, str]) -> None:
    read, read_texts = picture_of(picture_bytes(words, texts))
    assert read.dtype == np.uint16
    assert read.tolist() == words.tolist()
    assert read_texts == texts
