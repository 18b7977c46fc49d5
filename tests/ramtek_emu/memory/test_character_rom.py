from __future__ import annotations

from itertools import combinations

from ramtek_emu.memory.character_rom import characters


def test_every_printable_character_but_space_has_a_shape_of_its_own() -> None:
    shapes = characters()
    seen = {code: shapes[code].tobytes() for code in range(32, 127)}
    assert all(a != b for a, b in combinations(seen.values(), 2))
    assert [code for code in range(32, 127) if not shapes[code].any()] == [32]


def test_cells_never_touch_their_neighbors() -> None:
    shapes = characters()
    assert shapes.shape == (256, 9, 7)
    assert not shapes[:, 0].any()
    assert not shapes[:, :, [0, 6]].any()


def test_codes_without_a_shape_are_blank() -> None:
    shapes = characters()
    assert not shapes[:32].any()
    assert not shapes[127].any()
