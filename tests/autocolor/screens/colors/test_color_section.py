from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import Paint
from autocolor.errors import UsageError
from autocolor.screens.colors.color_section import LIGHT_SOURCE, OBJECT, ColorSection, whole
from autocolor.screens.viewer import Viewer
from autocolor.widgets.colors import BLUE, GREEN, RED, WHITE
from autocolor.widgets.component_bars import ComponentBar
from autocolor.widgets.widget import Place
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.painting_hand import boxes_scene

PAINT = Paint((10, 20, 31), (255, 0, 0))


@pytest.fixture
def viewer(tmp_path: Path) -> Viewer:
    return Viewer(boxes_scene(), Ramtek9300(), tmp_path)


def section_of(viewer: Viewer, title: str, given: list[object]) -> ColorSection:
    return ColorSection(
        viewer.session, title, 100, give=lambda section, color: given.append((section.title, color)),
        choose=lambda section: given.append(section.title),
    )  # fmt: skip


@pytest.mark.parametrize(("title", "values"), [(OBJECT, [10, 20, 31, 20]), (LIGHT_SOURCE, [255, 0, 0, 85])])
def test_it_has_a_heading_and_a_bar_for_each_component_and_for_white(
    viewer: Viewer, title: str, values: list[int]
) -> None:
    heading, *bars = section_of(viewer, title, []).widgets(PAINT, is_chosen=False)
    assert heading.label == title
    assert all(isinstance(bar, ComponentBar) for bar in bars)
    found = [(bar.letter, bar.word, bar.value) for bar in bars if isinstance(bar, ComponentBar)]
    assert found == list(zip("RGBW", (RED, GREEN, BLUE, WHITE), values, strict=True))


def test_bars_and_ramp_stand_beside_each_other_without_overlapping(viewer: Viewer) -> None:
    section = section_of(viewer, OBJECT, [])
    widgets = section.widgets(PAINT, is_chosen=True)
    areas = [section.ramp, *(each.area for each in widgets)]
    for number, area in enumerate(areas):
        assert not any(area.overlaps(other) for other in areas[number + 1 :])
    assert (section.ramp.top, section.ramp.bottom) == (widgets[1].area.top, widgets[-1].area.bottom)


def test_a_component_is_put_into_the_color_that_the_surface_has_now(viewer: Viewer) -> None:
    given: list[object] = []
    bars = section_of(viewer, OBJECT, given).widgets(PAINT, is_chosen=True)[1:]
    assert isinstance(bars[1], ComponentBar)
    bars[1].put(99.0)
    assert given == [(OBJECT, (176, 99, 32))]


def test_a_pick_on_the_heading_chooses_the_color(viewer: Viewer) -> None:
    given: list[object] = []
    section = section_of(viewer, OBJECT, given)
    heading, *_ = section.widgets(PAINT, is_chosen=False)
    heading.pick(Place(10, 104))
    assert given == [OBJECT]


def test_the_key_of_the_heading_is_not_that_of_the_row(viewer: Viewer) -> None:
    for title in (OBJECT, LIGHT_SOURCE):
        section = section_of(viewer, title, [])
        keys = [each.key for each in (*section.widgets(PAINT, is_chosen=False), section.row(PAINT))]
        assert len(set(keys)) == len(keys)


def test_the_row_takes_what_is_typed_as_it_is(viewer: Viewer) -> None:
    given: list[object] = []
    row = section_of(viewer, LIGHT_SOURCE, given).row(PAINT)
    assert (row.label, row.value) == ("light", "#ff0000")
    row.take("teal")
    assert given == [(LIGHT_SOURCE, "teal")]


def test_the_ramp_rises_to_the_right_from_the_first_step_to_the_last(viewer: Viewer) -> None:
    display = Ramtek9300()
    section = section_of(viewer, OBJECT, [])
    ramp = np.arange(300, 364, dtype=np.uint16)
    for item in section.items(ramp):
        display.send(np.frombuffer(item.stream, np.uint16))
    line = display.words[section.ramp.top, section.ramp.left : section.ramp.right + 1]
    assert set(np.bincount(line)[301:363].tolist()) <= {2, 3}
    assert line.tolist() == sorted(line.tolist())
    assert (line[0], line[-1]) == (300, 363)


@pytest.mark.parametrize("value", [-1, 256, 0.5, float("inf"), float("nan")])
def test_what_is_no_component_is_refused(value: float) -> None:
    with pytest.raises(UsageError) as told:
        whole("green", value)
    assert str(told.value) == f"green must be a whole number from 0 to 255, not {value:g}; type another"
