"""How the parameters are set by pointing is tested with the lights screen."""

from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Light
from autocolor.screens.light_parameters import aim_of, kind_of, parameter_rows
from tests.autocolor.screens.boxes import KEY, hand_at


@pytest.mark.parametrize(
    ("light", "kind"),
    [
        (Light("a", (0, 0, 1)), "point source"),
        (Light("a", (0, 0, 1), aim=(0, 0, 0)), "aim"),
        (Light("a", (0, 0, 1), direction=(0, 0, -1)), "direction"),
    ],
)
def test_the_kind_of_a_light_is_what_its_axis_comes_from(light: Light, kind: str) -> None:
    assert kind_of(light) == kind


def test_the_kind_stands_before_what_only_some_kinds_have(tmp_path: Path) -> None:
    session = hand_at(tmp_path, "lights").viewer.session
    labels = [row.label for row in parameter_rows(session, KEY, leave_out=("name", "flaps"))]
    assert labels[:6] == ["position x", "position y", "position z", "intensity", "on", "kind"]
    assert labels[6:] == ["aim x", "aim y", "aim z", "concentration", "cone angle"]
    without = parameter_rows(session, KEY, leave_out=("aim", "concentration"))
    assert without[-1].label == "kind"


def test_a_directed_light_is_aimed_ahead() -> None:
    ahead = aim_of(Light("a", (0, 0, 4), direction=(0, 0, -2)), (-1, -1, -1), (1, 1, 1))
    assert ahead == pytest.approx((0, 0, 0))
    aside = aim_of(Light("a", (0, 0, 4), direction=(1, 0, 0)), (-1, -1, -1), (1, 1, 1))
    assert aside == pytest.approx((4, 0, 4))
    assert aim_of(Light("a", (0, 0, 4)), (-1, -1, -1), (3, 1, 1)) == (1, 0, 0)


def test_a_light_in_the_middle_of_the_object_is_aimed_down() -> None:
    assert aim_of(Light("a", (0, 0, 0)), (-1, -1, -1), (1, 1, 1)) == (0, 0, -1)
