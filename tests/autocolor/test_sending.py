from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from autocolor import Studio, UsageError, render
from autocolor.images import display_image, send_picture
from autocolor.mapping.legend import legend
from autocolor.sending import send_image, shown_colors, shown_words
from ramtek_emu import GMR_9300, EntryFormat, Ramtek9300
from tests.small import wall_scene


@pytest.mark.parametrize("display", ["tcp://127.0.0.1:9300", None, Ramtek9300])
def test_what_is_no_display_is_refused_in_words(display: Any) -> None:
    for send in (Studio, lambda scene, to: send_picture(scene, render(scene, (32, 24)), to)):
        with pytest.raises(
            UsageError, match=r"a display must be a host port, such as Ramtek9300\(\), or TcpPort"
        ):
            send(wall_scene(), display)


def test_the_words_and_colors_of_an_image_with_a_legend_are_those_of_its_display() -> None:
    scene = wall_scene().with_scalar(name="x")
    shown = display_image(scene, render(scene))
    assert legend(shown) is not None
    display = Ramtek9300(GMR_9300)
    send_image(display, shown)
    assert np.array_equal(shown_words(shown), display.words)
    assert np.array_equal(shown_colors(shown), display.field())
    plain = display_image(wall_scene(), render(wall_scene(), (80, 60)))
    assert np.array_equal(shown_colors(plain), plain.colors)


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
