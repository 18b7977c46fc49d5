"""The limits of a scene's values: the largest value is accepted, and the next one is refused."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from autocolor import HalfSpace, Light, NamedView, Surface
from autocolor.errors import InputError
from autocolor.scene.columns import Row, RowError, replaced
from autocolor.scene.following import _in_words
from autocolor.scene.kinds import AngleCurveKind, ColorKind
from autocolor.scene.scalar import MeshScalar, Scalar
from tests.small import wall_scene

SCENE = wall_scene()
WALL = SCENE.surfaces[0]
LIGHT = Light("key", (0, -3, 0))


def surfaces(count: int) -> Row:
    names = [WALL.name, *(f"surface {number}" for number in range(count - 1))]
    return SCENE.replace(surfaces=[Surface(name) for name in names])


def half_spaces(count: int) -> Light:
    return LIGHT.replace(half_spaces=[HalfSpace(f"{n}", (0, 0, 0), (0, 0, 1)) for n in range(count)])


def views(count: int) -> Row:
    return SCENE.replace(views=[NamedView(f"{number}", SCENE.view) for number in range(count)])


LIMITS: list[tuple[Callable[[int], Row], int, int, str]] = [
    (surfaces, 1, 255, "surfaces must be at most 255, not 256;"),
    (half_spaces, 0, 64, "must be at most 64, not 65;"),
    (views, 0, 64, "views must be at most 64, not 65; remove named views"),
    (lambda n: Scalar("z", scale=((1, 2, 3),) * n), 2, 256, "a list of 2 to 256 colors"),
    (lambda n: Scalar("z", bands=n), 2, 256, "bands must be a whole number from 2 to 256, not "),
    (lambda n: Scalar("z", shades=n), 1, 256, "shades must be a whole number from 1 to 256, not "),
    (lambda n: WALL.replace(levels=n), 2, 1_000_000, "levels must be a whole number from 2 to 1000000"),
]


@pytest.mark.parametrize(("row", "least", "most", "sentence"), LIMITS)
def test_a_count_is_between_the_smallest_and_the_largest(
    row: Callable[[int], Row], least: int, most: int, sentence: str
) -> None:
    for count in (least, least + 1, most - 1, most):
        row(count)
    for count in (most + 1, *([least - 1] if least > 1 or "whole" in sentence else [])):
        with pytest.raises(InputError) as refusal:
            row(count)
        assert sentence in str(refusal.value)


def test_a_place_is_at_most_1e36_and_a_value_of_a_scalar_1e30_in_size() -> None:
    for sign in (-1, 1):
        for at in range(3):
            place = [0.0, 0.0, 0.0]
            place[at] = sign * 1e36
            assert LIGHT.replace(position=place).position == tuple(place)
            place[at] = sign * math.nextafter(1e36, math.inf)
            with pytest.raises(InputError, match="three finite numbers of at most 1e36"):
                LIGHT.replace(position=place)
        assert MeshScalar("a", np.array([0, sign * 1e30])).values[1] == sign * 1e30
        with pytest.raises(InputError, match=r"at most 1e30 in size, .* not -?1e\+30 \(row 1\)"):
            MeshScalar("a", np.array([0, sign * math.nextafter(1e30, math.inf)]))


def test_a_curve_has_2_to_91_points_and_a_color_at_most_100_letters() -> None:
    kind = AngleCurveKind(0.1, ((0, 1), (90, 0)))
    for points in (2, 3, 90, 91):
        angles = np.linspace(0, 90, points).tolist()
        assert len(kind.accepted([(angle, 0.5) for angle in angles])) == points
    for points in (1, 92):
        with pytest.raises(ValueError, match=r"^$"):
            kind.accepted([(angle, 0.5) for angle in np.linspace(0, 90, points).tolist()])
    for letters in (99, 100):
        assert ColorKind().accepted("rgb(1,2,3)".replace("1", "1".rjust(letters - 9))) == (1, 2, 3)
    with pytest.raises(ValueError, match=r"^$"):
        ColorKind().accepted("rgb(1,2,3)".replace("1", "1".rjust(101 - 9)))


def test_a_change_has_at_most_64_keys() -> None:
    for count in (63, 64):
        with pytest.raises(RowError, match="key62"):
            replaced(LIGHT, {f"key{number}": 0 for number in range(count)})
    with pytest.raises(RowError, match="it must be a table of at most 64 keys, not 65"):
        replaced(LIGHT, {f"key{number}": 0 for number in range(65)})


def test_half_spaces_can_all_be_replaced_in_one_change() -> None:
    full = half_spaces(64)
    new = HalfSpace("new", (0, 0, 0), (0, 0, 1))
    others: dict[str, HalfSpace | None] = {f"{number}": None for number in range(64)}
    others |= {name: new.replace(name=name) for name in map(str, range(64, 128))}
    assert len(full.replace(half_spaces=others).half_spaces) == 64
    with pytest.raises(RowError, match="must be at most 64, not 129"):
        full.replace(half_spaces={**others, "128": new.replace(name="128")})


@pytest.mark.parametrize(
    ("count", "words"),
    [
        (1, "'a'"),
        (7, "'a' to 'b' to 'c' to 'd' to 'e' to 'f' to 'g'"),
        (8, "'a' to 'b' to 'c' to 'd' to 'e' to 'f' to 'g' to 'h'"),
        (9, "'a' to 'b' to 'c' to 'd' to 'e' to 'f' to ... to 'i'"),
    ],
)
def test_a_circle_of_lights_is_named_by_at_most_8_words(count: int, words: str) -> None:
    assert _in_words("abcdefghi"[:count]) == words
