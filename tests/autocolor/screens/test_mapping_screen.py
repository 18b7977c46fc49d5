from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import autocolor
from autocolor import Mesh, Scene
from autocolor.scene.columns import fields_of
from autocolor.scene.curves import CurvePoints
from autocolor.screens.mapping_screen import (
    ACROSS,
    LEAST_APART,
    MOST_COUNTED,
    PANEL,
    STRAIGHT,
    added,
    curve_of,
    moved,
    place_of,
    shares_of,
)
from autocolor.widgets.items import WHITE, YELLOW
from tests.autocolor.screens.boxes import hand_at, hint_of, told, undo, words_are_those_of_the_scene
from tests.autocolor.screens.hand import Hand
from tests.small import boxes, grid


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "mapping")


def points_of(hand: Hand) -> CurvePoints:
    mapping = hand.scene.mapping
    assert not isinstance(mapping, str)
    return mapping


def test_every_parameter_of_the_mapping_has_a_row(hand: Hand) -> None:
    labels = {row.label for row in hand.viewer.board.content.rows()}
    tables = {"mesh", "parts", "surfaces", "lights", "view", "views", "scalar", "name", "background", "front"}
    tables |= {"stage", "backdrop"}
    assert labels >= set(fields_of(Scene)) - tables


@pytest.mark.parametrize(
    ("mapping", "most"), [("linear", 2), ("gamma", 8), ("logarithm", 8), ("equalize", 12)]
)
def test_a_click_on_a_curve_with_a_name_adds_a_point_to_the_fewest_that_look_like_it(
    hand: Hand, mapping: str, most: int
) -> None:
    hand.choose("mapping", mapping)
    before, studio = hand.scene, hand.viewer.studio
    assert before.mapping == mapping
    levels, _ = curve_of(studio.display_image, hand.viewer.session.surface_name)
    hand.choose("mapping", "points")
    fewest = points_of(hand)
    assert 2 <= len(fewest) <= most
    assert np.abs(np.interp(ACROSS, *np.transpose(fewest)) - levels).max() < 0.03
    undo(hand)
    assert hand.scene is before
    hand.click(*place_of(0.6, 0.97))
    assert is_a_curve(points_of(hand))
    assert len(points_of(hand)) in (len(fewest), len(fewest) + 1)
    assert (0.6, 0.97) in [pytest.approx(point, abs=0.01) for point in points_of(hand)]


def test_a_dragged_point_changes_the_words_in_one_step(hand: Hand) -> None:
    hand.pick("straight")
    before, words = hand.scene, hand.viewer.studio.words
    assert points_of(hand) == ((0, 0), (1, 1))
    # A drag on the curve makes the point that it moves.
    hand.drag(place_of(0.5, 0.5), place_of(0.5, 0.6), place_of(0.4, 0.7))
    assert np.allclose(points_of(hand), ((0, 0), (0.4, 0.7), (1, 1)), atol=0.01)
    assert told(hand) == ("intensity 0.40, level 0.70", False)
    assert (hand.viewer.studio.words != words).any()
    assert words_are_those_of_the_scene(hand)
    # The curve goes through its points, and the touched one is yellow.
    seen = [hand.display.words[place_of(*point)[::-1]] for point in (*points_of(hand), (0.2, 0.35))]
    assert seen == [WHITE, YELLOW, WHITE, YELLOW]
    undo(hand)
    assert hand.scene is before
    hand.click(*place_of(1, 1))
    assert told(hand) == ("intensity 1.00, level 1.00: pick its new place", False)
    hand.click(*place_of(0.8, 0.95))
    assert np.allclose(points_of(hand), ((0, 0), (1, 0.95)), atol=0.01)


def test_the_point_that_was_touched_last_is_removed(hand: Hand) -> None:
    hand.pick("straight")
    assert hint_of(hand, "remove point") == "click at a point between the ends of the curve first"
    hand.drag(place_of(0.5, 0.5), place_of(0.5, 0.6))
    hand.pick("remove point")
    assert points_of(hand) == STRAIGHT
    # An end of the curve, and a curve with a name, have nothing to remove.
    hand.drag(place_of(0, 0), place_of(0.2, 0.1))
    assert points_of(hand)[0] == pytest.approx((0, 0.1), abs=0.01)
    hand.pick("remove point")
    assert told(hand)[1]
    hand.choose("mapping", "linear")
    assert hint_of(hand, "remove point").startswith("click at a point")


def test_shares_say_how_often_intensities_are_seen() -> None:
    values = np.repeat(np.array([0.0, 0.5, 1.0], np.float32), [100, 25, 4])
    shares = shares_of(values, 0.0, 1.0)
    assert (shares[0], shares[len(shares) // 2], shares[-1]) == pytest.approx((1, 0.5, 0.2))
    assert np.count_nonzero(shares) == 3
    # Ranges without extent or of a few roundings of float32, and many or no intensities.
    assert shares_of(np.full(3 * MOST_COUNTED, 0.5, np.float32), 0.5, 0.5).max() == 1
    assert shares_of(np.array([0.5, 0.5000005], np.float32), 0.5, 0.5000005).max() == 1
    assert not shares_of(np.zeros(0, np.float32), 0.0, 1.0).any()


FRACTIONS = st.floats(0, 1)


def is_a_curve(points: CurvePoints) -> bool:
    xs, ys = np.transpose(points)
    rises = (np.diff(xs) > 0).all() and (np.diff(ys) >= 0).all()
    return bool(rises and (xs[0], xs[-1]) == (0, 1) and ys[0] >= 0 and ys[-1] <= 1)


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 30), FRACTIONS, FRACTIONS)))
def test_whatever_is_done_the_curve_rises_from_end_to_end(acts: list[tuple[bool, int, float, float]]) -> None:
    points = STRAIGHT
    for moves, number, x, y in acts:
        if moves:
            points = moved(points, number % len(points), x, y)
        else:
            points, number = added(points, x, y)
            assert abs(points[number][0] - x) <= LEAST_APART
            assert points[number][1] == pytest.approx(y, abs=1e-4)
        assert is_a_curve(points)


FIVE = ((0.0, 0.0), (0.25, 0.25), (0.5, 0.5), (0.75, 0.75), (1.0, 1.0))
CLOSE = ((0.0, 0.0), (0.5, 0.2), (0.505, 0.4), (0.51, 0.6), (1.0, 1.0))


@pytest.mark.parametrize(
    ("points", "number", "to", "lands"),
    [
        # Between its neighbors.
        (FIVE, 1, (0.9, 0.9), (0.49, 0.5)),
        (FIVE, 2, (0.0, 0.0), (0.26, 0.25)),
        # The ends, and a point between close neighbors, move up and down alone.
        (FIVE, 4, (0.5, 0.8), (1, 0.8)),
        (CLOSE, 2, (0.9, 0.5), (0.505, 0.5)),
    ],
)
def test_a_point_goes_where_it_is_put_as_far_as_its_neighbors_let_it(
    points: CurvePoints, number: int, to: tuple[float, float], lands: tuple[float, float]
) -> None:
    assert moved(points, number, *to) == (*points[:number], lands, *points[number + 1 :])


@pytest.mark.parametrize(
    ("to", "number", "ys"),
    [
        ((0.3, 0.9), 2, (0.0, 0.25, 0.9, 0.9, 0.9, 1.0)),
        ((0.6, 0.1), 3, (0.0, 0.1, 0.1, 0.1, 0.75, 1.0)),
        # Too close to another point it is that one.
        ((0.252, 0.9), 1, (0.0, 0.9, 0.9, 0.9, 1.0)),
    ],
)
def test_a_new_point_lands_where_it_was_put_and_others_make_way(
    to: tuple[float, float], number: int, ys: tuple[float, ...]
) -> None:
    points, at = added(FIVE, *to)
    xs = {x for x, _ in FIVE} | ({to[0]} if len(ys) == 6 else set())
    assert (points, at) == (tuple(zip(sorted(xs), ys, strict=True)), number)


HELD = (("low", (0.1, 0.5)), ("object", (0.0, 2.0)))


def limits_of(hand: Hand, name: str) -> tuple[float, float]:
    return dict(hand.viewer.studio.scene.exposure)[name]  # type: ignore[arg-type]


def test_a_drag_sets_one_end_of_what_is_held_as_one_step_and_ends_do_not_cross(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes().replace(exposure=HELD))
    before, words = hand.viewer.studio.scene, hand.viewer.studio.words
    hand.pull("minimum", 0.0, 1.0)
    low, high = limits_of(hand, "low")
    assert 0.4 < low < high == 0.5
    assert (hand.viewer.studio.words != words).any()
    assert words_are_those_of_the_scene(hand)
    undo(hand)
    assert hand.viewer.studio.scene is before
    hand.pull("maximum", 0.9, 0.0)
    low, high = limits_of(hand, "low")
    assert low == 0.1 < high == vars(hand.widget("maximum"))["value"] < 0.2
    # All surfaces without a range of their own share one.
    hand.viewer.session.choose_surface("high")
    hand.pull("minimum", 0.1, 0.2)
    assert limits_of(hand, "object")[0] > 0
    assert limits_of(hand, "low") == (low, high)
    # Below a maximum of almost nothing it is 0.
    hand.viewer.session.edit(hand.scene.replace(exposure={"object": (4e-7, 1e-6)}))
    hand.viewer.tell("")
    hand.pull("minimum", 0.2, 0.4)
    assert limits_of(hand, "object") == (0, 1e-6)


def test_hidden_panels_leave_the_picture_below_the_curve_free(hand: Hand) -> None:
    hand.pick("straight")
    before = hand.scene
    assert len(hand.viewer.board.content.handles) == 2
    # The panel does not turn the object behind it.
    hand.drag((PANEL.left + 2, PANEL.top + 2), (PANEL.left + 90, PANEL.top + 60))
    assert hand.scene.view == before.view
    undo(hand)
    middle = place_of(0.5, 0.5)
    assert hand.viewer.board.content.hint(*middle).endswith("a click or a drag makes a point here")
    hand.pick("hide panels")
    content = hand.viewer.board.content
    assert not content.handles
    assert not content.items
    assert "makes a point" not in content.hint(*middle)
    hand.click(*middle)
    assert hand.scene is before
    hand.drag(middle, (middle[0] + 20, middle[1]))
    assert hand.scene.view != before.view
    assert hand.scene.mapping == before.mapping


def test_a_row_for_each_surface_says_whether_its_range_is_held_and_flips_it(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes())
    words = hand.viewer.studio.words

    def states() -> list[object]:
        rows = [hand.widget(name) for name in ("low", "high", "exposure")]
        return [vars(row).get("is_on", vars(row).get("present")) for row in rows]

    assert states() == [False, False, "auto"]
    hand.pick("high", 0.95)
    assert told(hand) == ("the range of high: held", False)
    assert states() == [False, True, "mixed"]
    hand.pick("exposure", 0.5)
    assert states() == [True, True, "all held"]
    hand.pick("high", 0.95)
    assert states() == [True, False, "mixed"]
    assert "object" not in dict(hand.scene.exposure)  # type: ignore[arg-type]
    hand.pick("low", 0.95)
    assert states() == [False, False, hand.scene.exposure] == [False, False, "auto"]
    assert np.array_equal(hand.viewer.studio.words, words)
    for present in ("all held", "99.5 %"):
        hand.pick("exposure")
        assert states()[-1] == present
    assert hand.scene.exposure == "99.5 %"
    assert told(hand) == ("the exposure follows the picture", False)
    hand.pick("high", 0.2)
    assert hand.viewer.session.surface_name == "high"


def test_holding_one_surface_of_a_percentage_changes_no_word_and_its_release_returns_to_it(
    tmp_path: Path,
) -> None:
    for scaling in ("surface", "object"):
        hand = hand_at(tmp_path, "mapping", boxes().replace(exposure="90 %", scaling=scaling))
        words = hand.viewer.studio.words
        hand.pick("low", 0.95)
        assert {*dict(hand.scene.exposure)} >= {"low", "object"}  # type: ignore[arg-type]
        assert np.array_equal(hand.viewer.studio.words, words)
        hand.pick("low", 0.95)
        hand.pick("high", 0.95)
        assert hand.scene.exposure == "90 %"
        assert told(hand) == ("the range of high: 90 %", False)


def test_a_surface_that_leaves_the_range_of_the_object_leaves_it_to_the_others(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", boxes().replace(exposure={"object": (0, 2)}))
    hand.pick("low", 0.95)
    assert hand.scene.exposure == (("high", (0, 2)),)


@pytest.mark.parametrize(
    "scene",
    [
        boxes().replace(lights=(), ambient=0.2),
        boxes().with_view(eye=(3, 0.5, 0.5)),
    ],
)
def test_a_surface_of_one_intensity_or_out_of_sight_has_no_range_to_hold(
    tmp_path: Path, scene: Scene
) -> None:
    hand = hand_at(tmp_path, "mapping", scene)
    hand.pick("low", 0.95)
    assert told(hand) == ("low has no range to hold; light it, and turn it to the eye", True)
    assert hand.scene is scene


def test_many_surfaces_have_no_rows(tmp_path: Path) -> None:
    hand = hand_at(tmp_path, "mapping", strips(11))
    assert not {"strip 0", "maximum"} & set(hand.labels)
    assert "strip 0" in hand_at(tmp_path, "mapping", strips(10)).labels
    assert hand.widget("exposure").present == "99.5 %"  # type: ignore[attr-defined]


def strips(count: int) -> Scene:
    """Strips side by side, each of its own surface."""
    strips = [grid(1, 1, (number, 0, 0), (1, 0, 0), (0, 0, 9), f"strip {number}") for number in range(count)]
    return autocolor.scene_of(Mesh.joined(strips), surfaces="parts")
