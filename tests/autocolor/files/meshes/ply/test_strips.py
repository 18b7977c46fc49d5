from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.meshes.ply.strips import triangles_of_strips


def triangles(lists: list[list[int]]) -> list[list[int]]:
    numbers = np.array([number for each in lists for number in each], np.intp)
    counts = np.array([len(each) for each in lists], np.intp)
    corners, sides = triangles_of_strips(numbers, counts)
    assert (sides == 3).all()
    return corners.reshape(len(sides), 3).tolist()


def test_every_second_triangle_of_a_strip_is_turned() -> None:
    assert triangles([[0, 1, 2, 3, 4]]) == [[0, 1, 2], [2, 1, 3], [2, 3, 4]]


def test_a_strip_ends_at_minus_one_and_where_its_list_ends() -> None:
    assert triangles([[0, 1, 2, -1, 3, 4, 5], [], [6, 7], [8, 9, 10]]) == [[0, 1, 2], [3, 4, 5], [8, 9, 10]]


def test_triangles_that_only_lead_on_are_left_out() -> None:
    assert triangles([[0, 1, 2, 2, 3, 4]]) == [[0, 1, 2], [3, 2, 4]]


@given(lists=st.lists(st.lists(st.integers(-1, 5), max_size=12), max_size=4))
def test_triangles_are_those_of_one_strip_after_the_other(lists: list[list[int]]) -> None:
    expected = []
    for each in lists:
        strip: list[int] = []
        for number in [*each, -1]:
            if number >= 0:
                strip.append(number)
                continue
            for at in range(len(strip) - 2):
                a, b, c = strip[at : at + 3]
                if len({a, b, c}) == 3:
                    expected.append([b, a, c] if at % 2 else [a, b, c])
            strip = []
    assert triangles(lists) == expected
