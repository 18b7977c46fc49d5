from __future__ import annotations

import re

import numpy as np
import pytest

from autocolor import (
    Light,
    Mesh,
    Scene,
)
from autocolor.explanation.point import corner_rows
from autocolor.explanation.text import LABEL, PAGE, WIDTH, TextRow, rows_of_text
from tests.small import car, opened


def page_of(scene: Scene) -> list[TextRow]:
    return rows_of_text(opened(scene)[0].explain(12, 16))


def many_lights(count: int) -> list[Light]:
    return [Light(f"lamp {number} of a long row", (number, -5.0, 3.0)) for number in range(count)]


SCENES = {
    "plain": car(),
    "no light": car().replace(lights=[]),
    "many lights": car().replace(lights=many_lights(40)),
    "bands": car().with_scalar(name="z"),
    "missing": car().with_scalar(name="stress"),
    "dithered": car().replace(dither="ordered", mapping="gamma", contrast="floor"),
    "ramp": car().with_paint("body", ramp=[(number % 256, 0, 0) for number in range(1024)]),
    "normals": car().replace(words="normals"),
    "very bright": car().replace(ambient=1e9),
    "long names": car().replace(name="a name " * 20),
}


@pytest.mark.parametrize("name", SCENES)
def test_an_explanation_fits_on_a_page_of_80_columns(name: str) -> None:
    rows = page_of(SCENES[name])
    assert len(rows) <= PAGE
    for row in rows:
        assert len(row.label) < LABEL
        assert len(str(row)) <= WIDTH
        assert str(row).isprintable()


def test_lights_that_do_not_fit_are_counted_and_added_up() -> None:
    explanation = opened(car().replace(lights=many_lights(40)))[0].explain(12, 16)
    rows = rows_of_text(explanation)
    (rest,) = [row.says for row in rows if row.says.startswith("and ")]
    shown = [row for row in rows if re.match(r"[0-9]+ lamp", row.label)]
    count, total = re.match(r"and ([0-9]+) more +([0-9.]+)$", rest).groups()  # type: ignore[union-attr]
    assert int(count) == 40 - len(shown)
    left_out = sum(light.contribution for light in explanation.lights[len(shown) :])
    assert float(total) == pytest.approx(left_out, abs=1e-4)
    for row, light in zip(shown, explanation.lights, strict=False):
        assert row.label.startswith(f"{light.light} lamp")


def test_the_rows_say_the_word_and_the_color() -> None:
    explanation = opened()[0].explain(12, 16)
    says = {row.label: row.says for row in rows_of_text(explanation)}
    assert says["word"].startswith(f"{explanation.word} = first word ")
    assert says["color"].startswith("#{:02x}{:02x}{:02x}  red".format(*explanation.color))
    assert says["part"] == "1  hood"


def test_the_background_has_a_short_explanation() -> None:
    rows = rows_of_text(opened()[0].explain(0, 0))
    assert [row.label for row in rows] == ["pixel", "seen", "word", "color"]


def test_a_triangle_has_three_corners_wherever_it_repeats_one() -> None:
    corners = np.eye(3)
    for nodes in ([0, 1, 2, 2], [0, 0, 1, 2], [0, 1, 1, 2], [0, 1, 2, 0]):
        assert sorted(node for node, _ in corner_rows(Mesh(corners, np.array([nodes])), 0)) == [0, 1, 2]
    assert len(corner_rows(Mesh(corners, np.array([[1, 1, 1, 1]])), 0)) == 1
