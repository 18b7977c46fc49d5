from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from autocolor import InputError, Studio, Surface, UsageError, render, scene_of
from autocolor.images import send_picture
from ramtek_emu import GMR_9300, EntryFormat, Ramtek9300
from tests.autocolor.meshes import cube, wall_scene
from tests.autocolor.sessions import SMALL, held, opened


def test_a_saved_picture_is_sent_without_rendering() -> None:
    studio, display = opened()
    other = Ramtek9300(SMALL)
    send_picture(studio.scene, studio.picture, other)
    assert held(other) == held(display)


def test_a_picture_of_other_surfaces_is_refused_and_leaves_the_display_as_it_was() -> None:
    studio, display = opened()
    before = held(display)
    other = scene_of(cube(), surfaces=[Surface("paint")], surface_of_part={"cube": "paint"})
    with pytest.raises(InputError, match="surfaces of a picture must be those of the scene"):
        send_picture(other, studio.picture, display)
    assert held(display) == before


def test_a_picture_larger_than_the_display_is_refused_and_a_smaller_one_is_shown_at_its_upper_left() -> None:
    scene = wall_scene()
    display = Ramtek9300(SMALL)
    lines, elements = SMALL.shown_lines, SMALL.shown_elements
    with pytest.raises(UsageError) as refusal:
        send_picture(scene, render(scene, lines, elements + 2), display)
    assert str(refusal.value) == (
        f"a picture must be at most {elements} x {lines}, as large as the display, not"
        f" {elements + 2} x {lines}; render it smaller, or take a larger configuration"
    )
    assert display.words_received == 0
    small = render(scene, lines // 2, elements // 2)
    send_picture(scene, small, display)
    shown = display.words != 0
    assert (shown[: lines // 2, : elements // 2] == (small.surface_number != 0)).all()
    assert shown.sum() == (small.surface_number != 0).sum()


@pytest.mark.parametrize("display", ["tcp://127.0.0.1:9300", None, Ramtek9300])
def test_what_is_no_display_is_refused_in_words(display: Any) -> None:
    for send in (Studio, lambda scene, to: send_picture(scene, render(scene, 24, 32), to)):
        with pytest.raises(
            UsageError, match=r"a display must be a host port, such as Ramtek9300\(\), or TcpPort"
        ):
            send(wall_scene(), display)


def test_a_display_with_a_12_bit_table_gets_12_bit_entries() -> None:
    display = Ramtek9300(dataclasses.replace(GMR_9300, entry_format=EntryFormat.WORD_12))
    studio = Studio(wall_scene(), display)
    studio.recolor("wall", object_color="#80c0f0", blend=1)
    assert (display.entries >> 4 == studio.entries >> 4).all()
    assert (display.words == studio.words).all()


@pytest.mark.parametrize("changes", [{"planes": 8}, {"entries": 256}])
def test_a_display_with_fewer_words_or_entries_than_the_papers_is_refused(changes: dict[str, int]) -> None:
    smaller = dataclasses.replace(GMR_9300, name="small", **changes)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match=r"must have 1024 words and entries, not \d+ and \d+ \(small\)"):
        Studio(wall_scene(), Ramtek9300(smaller))
