import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Configuration, Ramtek9300, instructions
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, quick, rasters


@quick
@given(rasters(), st.integers(0, 2**32 - 1))
def test_the_field_is_each_word_s_entry(raster: NDArray[np.uint16], seed: int) -> None:
    colors = np.random.default_rng(seed).integers(0, 256, (1024, 3))
    display = Ramtek9300(SMALL)
    display.send(instructions.write_image(raster))
    display.send(instructions.load_entries(0, colors))
    entries = [(int(red), int(green), int(blue)) for red, green, blue in colors]
    twin = np.array(reference.field(raster.tolist(), entries))
    assert (display.field() == twin).all()
    pixels = np.zeros((9, 13), np.uint32)
    display.scan_out.scan_out_into(pixels)
    assert (pixels == (twin[..., 0] << 16 | twin[..., 1] << 8 | twin[..., 2])).all()


def test_the_stamp_moves_with_every_word_and_every_entry_written() -> None:
    display = Ramtek9300()
    stamps = [display.scan_out.stamp]
    for stream in (
        instructions.write_image([[1]]),
        instructions.load_entries(0, [[1, 2, 3]]),
        instructions.erase(),
    ):
        display.send(stream)
        stamps.append(display.scan_out.stamp)
    assert len(set(stamps)) == 4
    display.send(instructions.no_operation())
    assert display.scan_out.stamp == stamps[-1]


def test_recoloring_writes_no_word_and_changes_the_field() -> None:
    display = Ramtek9300()
    display.send(instructions.write_image(np.full((480, 640), 300)))
    written = display.frame_buffer.written
    display.send(instructions.load_entries(300, [[9, 8, 7]]))
    assert display.frame_buffer.written == written
    assert (display.field() == (9, 8, 7)).all()


def test_only_the_visible_part_of_the_memory_is_shown() -> None:
    display = Ramtek9300(Configuration(name="TALL", elements=8, lines=8, planes=10, visible_lines=5))
    display.send(instructions.load_entries(0, np.repeat(np.arange(256)[:, None], 3, axis=1)))
    display.send(instructions.write_image(np.arange(64).reshape(8, 8)))
    assert display.words.shape == (8, 8)
    assert display.field()[..., 0].tolist() == np.arange(40).reshape(5, 8).tolist()


def test_with_fewer_planes_the_address_counter_picks_the_part_of_the_table() -> None:
    display = Ramtek9300(Configuration(name="EIGHT", elements=2, lines=1, planes=8))
    display.send(instructions.load_entries(256, np.full((256, 3), 50)))
    park = np.array([0x0300, 0x0000, 0x0000], np.uint16)
    display.send(park)
    assert display.field().tolist() == [[[0, 0, 0], [0, 0, 0]]]
    display.send(park + np.array([0, 0x200, 0], np.uint16))
    assert display.field().tolist() == [[[50, 50, 50], [50, 50, 50]]]
