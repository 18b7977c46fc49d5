from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from autocolor import arrays
from autocolor.arrays import (
    chunks,
    chunks_of_runs,
    components_of,
    cross,
    dot,
    half_up,
    halves_up,
    least_of_four,
    lengths,
    light_of,
    most_of_four,
    power,
    runs,
    unit_vector,
    used_bounds,
    used_rows,
)
from autocolor.checks import Vector
from autocolor.testing import directions, numbers

whole = st.integers(-(2**63), 2**63 - 1)


@given(st.lists(st.tuples(whole, st.integers(1, 9), whole)))
def test_runs_follow_each_other_even_where_the_sum_leaves_64_bits(rows: list[tuple[int, int, int]]) -> None:
    first, count, step = np.array(rows, np.int64).reshape(-1, 3).T
    expected = [start + k * by for start, many, by in rows for k in range(many)]
    wrapped = [(number + 2**63) % 2**64 - 2**63 for number in expected]
    assert runs(first, count, step).tolist() == wrapped
    assert runs(first, count).tolist() == runs(first, count, np.ones_like(step)).tolist()


@given(st.lists(st.integers(1, 9)), st.integers(1, 20))
def test_chunks_of_runs_hold_every_run_once_and_are_no_larger_than_they_must(
    counts: list[int], most: int
) -> None:
    every = list(chunks_of_runs(np.array(counts, np.int64), most))
    assert [k for part, _ in every for k in range(len(counts))[part]] == list(range(len(counts)))
    for part, some in every:
        assert sum(counts[: part.start]) == some.start
        assert sum(counts[part]) == some.stop - some.start
        assert some.stop - some.start <= most or part.stop == part.start + 1


@given(st.integers(0, 50), st.integers(0, 50), st.integers(1, 20))
def test_chunks_hold_every_number_once_and_never_too_many(start: int, length: int, most: int) -> None:
    every = list(chunks(start + length, most, start))
    assert [number for piece in every for number in range(100)[piece]] == list(range(start, start + length))
    assert all(0 < piece.stop - piece.start <= most for piece in every)


@pytest.mark.parametrize("shape", [(3, 0), (3, 5), (3, 4, 6)])
def test_products_and_lengths_are_those_that_numpy_has_for_columns(shape: tuple[int, ...]) -> None:
    one, other = np.random.default_rng(3).normal(size=(2, *shape))
    assert cross(one, other).tolist() == np.cross(one, other, axis=0).tolist()
    assert lengths(one) == pytest.approx(np.linalg.norm(one, axis=0))
    if len(shape) == 2:
        assert dot(one, other) == pytest.approx((one * other).sum(axis=0))


exponents = st.one_of(
    st.integers(0, 64).map(float),
    st.floats(0.0, 200.0),
    st.sampled_from([1e-300, 1e-46, 1e-45, 1e-7, 63.5, 65.0, 1e6, 1e30, 1e300]),
)


@given(st.lists(st.floats(-1.0, 1.0, width=32), min_size=1), exponents)
@example([1.0], 1e30)
def test_every_cosine_is_raised_and_a_negative_one_counts_as_0(cosines: list[float], exponent: float) -> None:
    given_as = np.array(cosines, np.float32)
    powers = power(given_as, exponent)
    assert given_as.tolist() == np.array(cosines, np.float32).tolist()
    # Float32 takes the smallest exponents for 0, and anything to the power 0 is 1.
    single = float(np.float32(min(exponent, 3e38)))
    expected = [max(cosine, 0.0) ** single for cosine in cosines]
    assert ((powers >= 0) & (powers <= 1)).all()
    assert powers.tolist() == pytest.approx(expected, abs=2e-5)
    # Rounding may leave a cosine above 1.
    assert power(np.array([1.0000002], np.float32), exponent).tolist() == [1.0]


@given(st.lists(st.tuples(*[st.integers(-9, 9)] * 4), min_size=1))
def test_the_least_and_the_most_of_four_rows_are_those_of_each_column(
    columns: list[tuple[int, int, int, int]],
) -> None:
    rows = np.array(columns).T
    assert least_of_four(rows).tolist() == list(map(min, columns))
    assert most_of_four(rows).tolist() == list(map(max, columns))


@pytest.mark.parametrize(
    ("value", "whole"), [(2.5, 3), (-2.5, -2), (2.49, 2), (0.0, 0), (-0.5, 0), (1022.5, 1023)]
)
def test_halves_go_up(value: float, whole: int) -> None:
    assert half_up(value) == whole
    assert halves_up(np.array([value])).tolist() == [whole]
    assert halves_up(np.array([value], np.float32)).dtype == np.float32


@given(st.lists(st.tuples(*[st.integers(0, 9)] * 4), max_size=9), st.sampled_from([1, 2, 100]))
def test_the_used_rows_are_those_that_appear(polygons: list[tuple[int, int, int, int]], at_once: int) -> None:
    numbers = np.array(polygons, np.intp).reshape(-1, 4).T
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(arrays, "NUMBERS_AT_ONCE", at_once)
        assert np.flatnonzero(used_rows(numbers, 10)).tolist() == sorted({n for row in polygons for n in row})


def test_bounds_leave_out_what_no_number_uses() -> None:
    rows = np.array([[1.0, -9.0, 3.0], [5.0, 99.0, 4.0]])
    low, high = used_bounds(rows, np.array([[0, 2, 0]]))
    assert (low.tolist(), high.tolist()) == ([1.0, 4.0], [3.0, 5.0])
    low, high = used_bounds(rows, np.empty((1, 0), np.intp))
    assert (low.tolist(), high.tolist()) == ([np.inf] * 2, [-np.inf] * 2)


@given(directions(), numbers(1e-30, 1e30))
def test_a_unit_vector_has_the_direction_of_a_vector_of_any_length(direction: Vector, length: float) -> None:
    x, y, z = direction
    unit = unit_vector((x * length, y * length, z * length))
    assert math.hypot(*unit) == pytest.approx(1, rel=1e-15)
    assert unit == pytest.approx([each / math.hypot(x, y, z) for each in direction], rel=1e-12)


@pytest.mark.parametrize("size", [5e-324, 1e-300, 1e300])
def test_a_unit_vector_of_very_small_or_large_components_is_exact(size: float) -> None:
    assert unit_vector((size, 0.0, -size)) == pytest.approx((math.sqrt(0.5), 0, -math.sqrt(0.5)))


def test_the_component_of_the_light_of_a_component_is_the_component() -> None:
    components = np.arange(256)
    light = light_of(components.astype(np.float64))
    assert (components_of(light) == components).all()
    assert (light[0], light[255]) == (0, 1)
    # Halves of the steps between two components round up.
    halves = light_of(np.linspace(0.5, 254.5, 255))
    assert (components_of(halves * (1 + 1e-12)) == components[1:]).all()
    assert (components_of(halves * (1 - 1e-12)) == components[:-1]).all()
