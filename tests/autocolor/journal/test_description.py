"""Descriptions of differences of scenes: every column is named, as short as they must be."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from autocolor import Flap, Flaps, Scene
from autocolor.journal.description import describe
from autocolor.scene.columns import with_values
from tests.autocolor.scene.test_every_column import EDITS, ROWS, edited, every_column, start
from tests.small import cube

LONG = 400
"""Characters that suffice for every detail."""

ON_OFF = {"on": "off"}
"""Switches that say their state alone."""


def table_of(table: str) -> str:
    """The table whose row an edit changes."""
    return "lights" if table in ("flaps", "half_spaces") else table


def before_edit(table: str, key: str) -> Scene:
    """The scene before an edit; of flaps, half-spaces and scalars, one that has the row already."""
    first = next(iter(EDITS[table]))
    if table == "scalar":
        return start().with_scalar(name="slope")
    return edited(start(), table, first) if table in ("flaps", "half_spaces") and key != first else start()


@every_column
def test_an_edit_is_described_by_its_row_and_its_column(table: str, key: str) -> None:
    before = before_edit(table, key)
    line = describe(before, edited(before, table, key), LONG)
    assert ROWS.get(table_of(table), table_of(table)) in line
    assert ON_OFF.get(key, key.replace("_", " ")) in line
    assert describe(edited(before, table, key), before, LONG)


@every_column
def test_a_description_fits_if_its_shortest_form_does(table: str, key: str) -> None:
    scene = edited(start(), table, key)
    shortest = describe(start(), scene, 0)
    assert shortest
    for most in range(len(shortest), 90, 7):
        assert len(describe(start(), scene, most)) <= most


def test_equal_scenes_have_no_difference() -> None:
    copy = with_values(start(), {"lights": tuple(light.replace() for light in start().lights)})
    assert describe(start(), start()) == describe(start(), copy) == ""


SCENES = {
    "key: flaps x on": start().with_light("key", flaps=Flaps(x=Flap())),
    "key: intensity 1 -> 0.8": start().with_light("key", intensity=0.8),
    "key: intensity 1 -> 1.00001": start().with_light("key", intensity=1.00001),
    "key: position z 3 -> 2.5": start().with_light("key", position=(2, -4, 2.5)),
    "key: position": start().with_light("key", position=(0, 0, 5)),
    "key, rim: off": start().only_lights(),
    "body: object color #b01020": start().with_paint("body", object_color="#b01020"),
    "body: ramp #220000 #ff6600": start().with_paint("body", ramp=["#200", "#f60"]),
    "part cube: surface body -> glass": start().with_part("cube", surface="glass"),
    "light fill added": start().with_new_light("fill", position=(0, 0, 1)),
    "light rim removed": start().without_light("rim"),
    "key: name key -> main": start().with_light("key", name="main"),
    "scene car": with_values(start(), {"mesh": cube(), "name": "car"}),
    "lights: order": start().replace(lights=start().lights[::-1]),
    "key: flaps y maximum none -> 0.5": start().with_light("key", flaps={"y": {"maximum": 0.5}}),
    "scalar z added": start().with_scalar(name="z"),
    "ambient 0.1 -> 0.3, mapping": start().replace(ambient=0.3, mapping=[[0, 0], [1, 0.5]]),
    "view: eye; ambient 0.1 -> 0.3": start().with_view(eye=(1, 2, 3)).replace(ambient=0.3),
}


@pytest.mark.parametrize("line", SCENES)
def test_differences_in_words(line: str) -> None:
    assert describe(start(), SCENES[line]) == line


def test_less_room_leaves_out_values_then_columns_then_names() -> None:
    scene = start().with_light("key", intensity=0.5).with_light("rim", intensity=0.25)
    scene = scene.with_paint("body", blend=0.25).with_view(angle=5).replace(ambient=0.3)
    lines: Sequence[str] = list(dict.fromkeys(describe(start(), scene, most) for most in range(150, 0, -1)))
    assert lines == [
        "body: blend 0.6 -> 0.25; key: intensity 1 -> 0.5; rim: intensity 1 -> 0.25; view: angle 0 -> 5;"
        " ambient 0.1 -> 0.3",
        "body: blend; key, rim: intensity; view: angle; ambient",
        "surface body, light key, light rim, view, ambient",
        "surface body, 2 lights, view, settings",
    ]
