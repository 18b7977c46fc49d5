from __future__ import annotations

import base64
import random
import struct
import tracemalloc
import zlib
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from PIL import Image

from ramtek_emu import (
    PRINCETON_9300,
    MissingInputError,
    Ramtek9300,
    RamtekError,
    SnapshotError,
    read_snapshot,
    write_snapshot,
)
from ramtek_emu.configuration import CONFIGURATIONS
from ramtek_emu.memory.scan_orders import Point
from ramtek_emu.monitor.pattern import pattern
from ramtek_emu.png import chunk
from ramtek_emu.snapshot import (
    MOST_TEXT,
    display_of,
    from_plain,
    picture_bytes,
    picture_of,
    snapshot_bytes,
)
from ramtek_emu.testing import streams
from tests.ramtek_emu.recorded_streams import BYTE_IMAGE, DECODED, OUTLINE, words
from tests.ramtek_emu.strategies import SMALL

CURSORS = words("1600 0064 0C64 1601 0032 0440")


def small_snapshot() -> bytes:
    display = Ramtek9300(SMALL)
    display.send(OUTLINE)
    display.send(CURSORS)
    display.send(words("1300 0902 0044 0005 0000 0000 0003 0003"))
    return snapshot_bytes(display)


SNAPSHOT = small_snapshot()


def with_text(keyword: str, text: str) -> bytes:
    picture, texts = picture_of(SNAPSHOT)
    return picture_bytes(picture, texts | {keyword: text})


def same(one: Ramtek9300, other: Ramtek9300) -> None:
    assert (one.words == other.words).all()
    assert (one.entries == other.entries).all()
    assert (one.field() == other.field()).all()
    assert one.configuration == other.configuration
    assert one.status == other.status
    assert one.processor.parameters == other.processor.parameters
    assert snapshot_bytes(one) == snapshot_bytes(other)


@pytest.mark.parametrize("name", sorted(CONFIGURATIONS))
def test_a_snapshot_read_back_is_the_same_display(name: str) -> None:
    configuration = CONFIGURATIONS[name]
    display = Ramtek9300(configuration)
    for stream in (pattern(configuration), OUTLINE, DECODED, BYTE_IMAGE, CURSORS, words("0001 1300 13FF")):
        display.send(stream)
    display.decoder.clear()
    again = display_of(snapshot_bytes(display))
    same(display, again)
    for one in (display, again):
        one.send(words("1400 0C01 0002 4142 0E01 0004 0005 0005 0500"))
        one.send(OUTLINE)
    same(display, again)


@given(streams(), streams())
def test_after_any_words_a_snapshot_goes_on_as_the_display_does(before: list[int], after: list[int]) -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array(before, np.uint16))
    again = display_of(snapshot_bytes(display))
    # An unfinished instruction and unread replies are in no snapshot.
    display.decoder.clear()
    same(display, again)
    display.receive(display.processor.waiting)
    for one in (display, again):
        one.send(np.array(after, np.uint16))
    same(display, again)
    count = display.processor.waiting
    assert display.receive(count).tolist() == again.receive(count).tolist()


OLD = zlib.decompress(
    base64.b85decode(
        b"c-rk*&yO256n0g0g(_7l94f&9ExvXr`MKMTw1<=|B~>Y9sR~tCO`I9e#KdE#wr7*DijcTf;s~62gaZ=d1b+qM$Ugz%%n6D2J"
        b"el2ALY(#j_=}Rvv!Ctvp5^(h_nzFpcl*laS1uDmt_<HE9K!!4_+GpUKjg;GZ{_g!syq15y{|L3V1^UJ3dd(LFUoDJ*xXLF+i"
        b"vPh*-wOAxQ?2MR+-34!<^8HoKVFIPJ8s-y8{|gE_uO~v$WTZs1%CBQ#+z_$^2up5z%8|#YFP>OjVUqp0#gARgIuv1d6ThP9?"
        b"44Oq+r^Sn_^<co?@jxa`t#mGYGKoGE!klhRmiaKVTcTIpnJG+LQ4X`$PRLa3bfPP~b<x6|(IwIVtJD`z~dE$Dy?LRpwGL08d"
        b"wKtvbXq?G`Ui6xh`cN3o{Fm4uSg3A<F?ylFL|M15X2>7QMHmUWjoNqe@K0?%3ni_7=v1gp5@2rN0{eXagfPizt{yts*`t=7d"
        b"0`Gl?ui`lalH-mWi}a-zNCXA5Ga!O)w+(N7U>KeoU8>ac*n}msT5KREq<k4SX>Zhs8b`I<0(mdm1z8)B3w7GPfPP#9#i$iEp"
        b"~)sp#lRxm_z6=1L}-CxfC5Il(H?5dS>h>bGYO24+$(3L+RzaQz{Mf~rDpVcD{4o(o}e0jh6%G3mwH8;7%gS>=$LV*6C2Lb_&"
        b"MhnMmQcnXLToP9n~E=%Pc<|?|^zs1B;BR;n<c63xvOl6UmU_Fk}VGd0gnUvgQ-53vYGvG+Z%r@kBd^9UGR;v~pg3G1c<#Evh"
        b";;eB5fU!8>-0*MQMK>?mrU>!w!5ocpHY)SJ)$bw7{RzrXb3M}%CR`g3b^0(T~D;Mhvd;Jz0pQ#i{B9%Z;ag*RP5K)^G2FN7c"
        b"<ARr(hARr(h;J*nPQ6VMInXKzT8_}l}s%j8ctI}92x$>z9#gw)@(JJ*druN>>&BpqLyT5%)$c3)2c2$)mtk___Wpq-PxO`o!"
        b"%Ez>P62@_#wCMPH4km#r6YP}D`Dt<@|2M>OpRO?zWLPq*z3?u@!p3u~TAdZzQX`Hzro~1LO#b*3(9!zOufBLn2<c$}b4(hMl"
        b"e!q#sf%Wqu;F)>A3qxQ-+Z)scx!n3PQS~B)BfP`8~ttqHf$Zdb^~U4c{u1lSUye0<8(Y3XXN6wt%qAXTMuA|ej(Ss?0<twWO"
        b"#6I@cpgvXMX{kz{P9"
    )
)
"""A file of 2026 in the format of version 1, of a display with a beam; it must be readable forever."""


def test_a_file_of_version_1_is_read_as_it_was_written() -> None:
    display = display_of(OLD)
    same(display, display_of(snapshot_bytes(display)))
    assert display.words[:2, :3].tolist() == [[1, 2, 3], [4, 5, 6]]
    assert display.field()[:, 3].tolist() == [[0x11, 0x22, 0x33]] * 3
    assert display.processor.parameters.conic == (1, -2, 3, 70000, 0, 9)
    assert display.processor.saved[0].index_2 == (9, 7)
    assert display.processor.loaded_characters.sum() == display.cursors[0].shape.sum() == 1
    assert (display.cursors[0].element, display.cursors[0].line, display.joystick.track) == (3, 2, True)
    assert (display.status.name, display.processor.illegal_words) == ("CURSOR|ILLEGAL|READY", 1)
    assert display.beam is not None
    assert display.beam.lines_done == 40


def test_a_snapshot_is_a_picture_that_others_read(tmp_path: Path) -> None:
    display = Ramtek9300(PRINCETON_9300)
    display.send(OUTLINE)
    path = tmp_path / "snapshot.png"
    write_snapshot(display, path)
    with Image.open(path) as picture:
        assert picture.size == (640, 512)
        assert (np.asarray(picture) == display.words).all()
        assert picture.info["Software"] == "ramtek_emu snapshot 1"
        assert picture.info == picture_of(path.read_bytes())[1]
    same(display, read_snapshot(path))
    for other in (tmp_path / "none.png", tmp_path, "a\0b"):
        with pytest.raises(MissingInputError):
            read_snapshot(other)


@pytest.mark.parametrize("text", ["", "null", "[" * 100_000, "{}", "9" * 5000, '{"all":1,"all":2}', "NaN"])
def test_a_text_that_is_no_state_is_refused(text: str) -> None:
    for keyword in ("configuration", "cursors"):
        with pytest.raises(SnapshotError):
            display_of(with_text(keyword, text))


@pytest.mark.parametrize("count", [100, pytest.param(600, marks=pytest.mark.thorough)])
def test_mutated_snapshots_are_read_or_refused(count: int) -> None:
    draw = random.Random(9300)
    picture, texts = picture_of(SNAPSHOT)
    accepted = 0
    for _ in range(count):
        keyword = draw.choice(sorted(texts))
        text = bytearray(texts[keyword].encode())
        for _ in range(draw.randint(1, 3)):
            text[draw.randrange(len(text))] = draw.choice(b'0123456789",:[]{}-eE.nt')
        try:
            display = display_of(picture_bytes(picture, texts | {keyword: text.decode()}))
        except SnapshotError:
            continue
        # A display that was accepted works.
        accepted += 1
        display.send(OUTLINE)
        display.field()
        display_of(snapshot_bytes(display))
    assert accepted > count / 12
    for _ in range(count):
        data = bytearray(SNAPSHOT)
        for _ in range(draw.randint(1, 4)):
            data[draw.randrange(len(data))] = draw.randrange(256)
        with pytest.raises(RamtekError):
            display_of(bytes(data[: draw.choice((len(data), draw.randrange(len(data))))]))


@pytest.mark.parametrize(
    ("keyword", "old", "new", "part"),
    [
        ("Software", "snapshot 1", "snapshot 9", "of the format 'ramtek_emu snapshot 1'"),
        ("configuration", '"elements":13', '"elements":14', "must have 14 x 9 words"),
        (
            "configuration",
            '"elements":13',
            '"elements":99999999',
            "a configuration that can be built: elements of SMALL must be",
        ),
        (
            "configuration",
            '"planes":10',
            '"planes":1',
            "a word of a snapshot must be a whole number from 0 to 1, not ",
        ),
        ("configuration", '"PAIR_24"', '"PAIR_99"', "entry_format of a display must be EntryFormat"),
        ("configuration", '"name":"SMALL"', f'"name":"{60 * "a"}"', ""),
        ("configuration", '"name":"SMALL"', f'"name":"{61 * "a"}"', "name of a snapshot must be a name"),
        ("configuration", '"name":"SMALL"', '"name":"\\n"', "name of a snapshot must be a name"),
        ("configuration", '"lines"', '"limes"', "must be an object of name"),
        ("parameters", '"scan_order":0', '"scan_order":"0"', "parameters.scan_order of a snapshot"),
        ("parameters", '"scan_order":0', '"scan_order":true', "parameters.scan_order of a snapshot"),
        ("parameters", '"zoom":[1,1]', '"zoom":[0,1]', "parameters.zoom[0] of a snapshot must be a whole"),
        ("parameters", '"zoom":[1,1]', '"zoom":[1]', "must be 2 items"),
        ("cursors", '"track":false', '"track":0', "track of a snapshot must be true or false, not 0"),
        ("cursors", '"shape":"', '"shape":"!', "bytes in base64"),
        ("cursors", '"shape":"', f'"shape":"{9999 * "a"}', f"not '{59 * 'a'}...; take a new one"),
        ("lookup table", '"address":0', '"address":65536', "table_address of a snapshot"),
        ("processor", '"illegal":false', '"illegal":null', "illegal of a snapshot must be true or false"),
    ],
)
def test_a_value_that_does_not_fit_is_refused_by_name(keyword: str, old: str, new: str, part: str) -> None:
    text = picture_of(SNAPSHOT)[1][keyword]
    assert old in text
    data = with_text(keyword, text.replace(old, new, 1))
    if not part:
        same(display_of(data), display_of(data))
        return
    with pytest.raises(SnapshotError) as refusal:
        display_of(data)
    assert part in str(refusal.value)
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 700


@pytest.mark.parametrize(
    ("pattern", "name", "low", "high"),
    [
        (0, "conic", -(2**31), 2**32 - 1),
        (0, "zoom", 1, 16),
        *[
            (0, name, 0, 2**62)
            for name in ("nanoseconds", "illegal_words", "without_effect", "lines_painted")
        ],
        (0, "element", -(2**17), 2**17),
        (0, "foreground", 0, 2**16 - 1),
        (Point(0, 0), "start", -(2**15), 2**15 - 1),
    ],
)
def test_every_number_of_a_state_has_its_limits(pattern: Any, name: str, low: int, high: int) -> None:
    def read(number: int) -> int:
        if isinstance(pattern, tuple):
            return int(from_plain(pattern, [1, number], f"parameters.{name}")[1])
        return int(from_plain(pattern, number, f"parameters.{name}[3]"))

    for value in (low, high):
        assert read(value) == value
    for value in (low - 1, high + 1):
        with pytest.raises(SnapshotError, match=f"must be a whole number from {low} to {high}, not"):
            read(value)


def test_a_list_is_no_longer_than_it_may_be() -> None:
    assert from_plain([(0, 0)], [[1, 2]] * 256, "cursors.tracking_devices") == [(1, 2)] * 256
    with pytest.raises(SnapshotError, match="tracking_devices of a snapshot must be a list of at most 256, "):
        from_plain([(0, 0)], [[1, 2]] * 257, "cursors.tracking_devices")


def saved(mode: str, size: tuple[int, int] = (13, 9)) -> bytes:
    """A picture of a mode of Pillow as a PNG file."""
    buffer = BytesIO()
    Image.new(mode, size).save(buffer, "PNG")
    return buffer.getvalue()


BOMB = SNAPSHOT[:8] + chunk(b"IHDR", struct.pack(">IIBBBBB", 60_000, 60_000, 16, 0, 0, 0, 0)) + SNAPSHOT[33:]


@pytest.mark.parametrize(
    ("data", "part"),
    [
        (b"", "be a whole PNG file, not a broken or another file (a png file must begin with its signature"),
        (b"GIF89a", "be a whole PNG file"),
        (SNAPSHOT[:-5], "be a whole PNG file"),
        (SNAPSHOT[:40], "be a whole PNG file"),
        (SNAPSHOT[:20] + b"\x99" + SNAPSHOT[21:], "be a whole PNG file"),
        (SNAPSHOT[:-20] + bytes([SNAPSHOT[-20] ^ 1]) + SNAPSHOT[-19:], "be a whole PNG file"),
        (BOMB, "be a whole PNG file"),
        (saved("I;16", (4097, 1)), "be 1 to 4096 elements and lines, not 4097 x 1"),
        (saved("I;16", (1, 4097)), "be 1 to 4096 elements and lines, not 1 x 4097"),
        (SNAPSHOT[:33] + chunk(b"tIME", b"") * 8192 + SNAPSHOT[33:], "end within 8192 chunks, not go on"),
        (saved("RGB"), "be 16 bits gray, not another kind of picture"),
        (saved("L"), "be 16 bits gray"),
        (with_text("more", "a" * (8 << 20)), f"have texts of at most {MOST_TEXT} bytes"),
    ],
)
def test_a_hostile_file_is_refused_by_one_sentence(data: bytes, part: str) -> None:
    with pytest.raises(SnapshotError) as refusal:
        picture_of(data)
    assert f"a snapshot must {part}" in str(refusal.value)
    assert str(refusal.value).endswith("with --snapshot")


def test_pixels_that_are_too_many_take_no_memory() -> None:
    begin, end = SNAPSHOT.index(b"IDAT") - 4, SNAPSHOT.index(b"IEND") - 4
    data = SNAPSHOT[:begin] + chunk(b"IDAT", zlib.compress(bytes(50_000_000))) + SNAPSHOT[end:]
    tracemalloc.start()
    with suppress(SnapshotError):
        picture_of(data)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1 << 20


def test_a_picture_may_have_as_many_elements_and_lines_as_the_limits_say() -> None:
    for size in ((1, 1), (4096, 1), (1, 4096)):
        assert picture_of(saved("I;16", size))[0].shape == size[::-1]
    # Another program may filter the lines, and compress them anew.
    buffer = BytesIO()
    with Image.open(BytesIO(SNAPSHOT)) as picture:
        picture.save(buffer, "PNG", optimize=True)
    assert (picture_of(buffer.getvalue())[0] == picture_of(SNAPSHOT)[0]).all()
