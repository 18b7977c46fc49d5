from __future__ import annotations

import ast
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from ramtek_emu import Ramtek9300, arrays
from ramtek_emu.drawing.areas import area
from ramtek_emu.drawing.curves import conic_pixels
from ramtek_emu.memory.scan_orders import Point
from tests.ramtek_emu.drawing.test_areas import returned


def kind_of(array_type: object) -> object:
    """The type of the numbers in an array type; numpy 2.5 and later store it in another place."""
    kind = get_args(array_type)[-1]
    return (get_args(kind) or (kind,))[0]


@pytest.mark.parametrize(
    ("name", "array"),
    [
        ("Words", Ramtek9300().words),
        ("Colors", Ramtek9300().entries),
        ("Colors", Ramtek9300().field()),
        ("PackedColors", Ramtek9300().lookup_table.packed),
        ("Dots", returned(area(np.ones((2, 2), np.bool_), 0, 0))),
        ("Numbers", conic_pixels((1, 1, 0, -4, 0, 0), Point(0, 0), None)[0]),
        ("Bytes", np.frombuffer(b"12", np.uint8)),
    ],
)
def test_a_type_names_the_kind_of_numbers_that_such_arrays_hold(name: str, array: object) -> None:
    assert isinstance(array, np.ndarray)
    assert kind_of(getattr(arrays, name)) is array.dtype.type


def test_every_type_has_a_docstring() -> None:
    body = ast.parse(Path(arrays.__file__).read_text("utf-8")).body
    for statement, text in zip(body, [*body[1:], None], strict=True):
        if isinstance(statement, ast.Assign) and "NDArray" in ast.unparse(statement.value):
            assert isinstance(text, ast.Expr), f"{ast.unparse(statement)} must be followed by its meaning"
