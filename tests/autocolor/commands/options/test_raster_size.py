from __future__ import annotations

import click
import pytest

from autocolor.commands.options.raster_size import LARGEST, size_of
from ramtek_emu import GMR_9300, Configuration, ConfigurationError


@pytest.mark.parametrize(
    ("text", "size"), [("640x480", (640, 480)), ("1X1", (1, 1)), ("4096x4096", (4096, 4096))]
)
def test_a_size_is_its_elements_and_its_lines(text: str, size: tuple[int, int]) -> None:
    assert size_of(text) == size


@pytest.mark.parametrize(
    "text",
    ["", "640", "640x", "x480", "640,480", "0x5", "5x0", "4097x1", "-1x5", "1.5x2", "\uff11x1", "1x1\n"],
)
def test_what_is_no_size_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(click.BadParameter) as refusal:
        size_of(text)
    assert refusal.value.message == (
        f"a size must be ELEMENTSxLINES, each from 1 to 4096, not {text!r}; write it as in 1280x960"
    )


def test_the_largest_size_is_that_of_the_largest_display() -> None:
    def display(size: int) -> Configuration:
        return Configuration(name="large", elements=size, lines=size, planes=GMR_9300.planes)

    assert display(LARGEST).lines == LARGEST
    with pytest.raises(ConfigurationError):
        display(LARGEST + 1)
