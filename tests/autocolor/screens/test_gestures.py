from __future__ import annotations

import pytest
from autocolor.screens.pointing import Drag, wheel_ratio


def test_the_degrees_of_a_drag_do_not_depend_on_its_steps() -> None:
    drag, total = Drag(1, 100, 100), [0.0, 0.0]
    for element, line in ((130, 90), (90, 140), (160, 80)):
        right, up = drag.turn_to(element, line)
        total = [total[0] + right, total[1] + up]
        drag = drag._replace(element=element, line=line)
    assert total == pytest.approx(Drag(1, 100, 100).turn_to(160, 80))


def test_the_wheel_moves_closer_and_back_by_its_steps() -> None:
    assert wheel_ratio("wheel up", 1) < 1
    assert wheel_ratio("wheel up", 3) == pytest.approx(wheel_ratio("wheel up", 1) ** 3)
    assert wheel_ratio("wheel up", 2) * wheel_ratio("wheel down", 2) == pytest.approx(1)
