"""The pictures of the guides are those that their functions make, and each is in its guide."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable

import numpy as np
import pytest
from PIL import Image

from docs.guides import pictures, pictures_of_displays
from docs.guides.pictures import GUIDES, path_of
from scenes.figures import Field
from tests.tables import first

PICTURES = (*pictures.PICTURES, *pictures_of_displays.PICTURES)
MOST_BYTES = 60_000
CLOSE = 1.0
"""The mean difference of components. Fewer colors make 0.25 of it, and a missing drag at least 5."""

SCREENS = [picture for picture in PICTURES if "open_viewer" in inspect.getsource(picture)]
DRAWN = [
    picture for picture in PICTURES if re.search(r"upper_half|played|Inspector\(", inspect.getsource(picture))
]
"""The pictures of the listings in display.md and inspect.md. They have few colors, so no color is lost."""


def test_every_image_is_small_and_in_a_guide() -> None:
    text = "".join(path.read_text("utf-8") for path in GUIDES.glob("*.md"))
    for path in (GUIDES / "images").iterdir():
        assert f"](images/{path.name})" in text, f"remove {path}, or show it"
        assert path.stat().st_size <= MOST_BYTES


def test_every_picture_is_in_its_guide() -> None:
    for picture in PICTURES:
        guide = GUIDES / f"{picture.__name__.partition('_')[0]}.md"
        assert f"](images/{path_of(picture).name})" in guide.read_text("utf-8")


@pytest.mark.parametrize("picture", first(2, SCREENS), ids=lambda picture: picture.__name__)
def test_a_picture_of_a_screen_is_that_of_its_steps(picture: Callable[[], Field]) -> None:
    assert np.abs(saved(picture).astype(np.int16) - picture()).mean() < CLOSE, command(picture)


@pytest.mark.parametrize("picture", first(2, DRAWN), ids=lambda picture: picture.__name__)
def test_the_picture_of_a_listing_is_what_the_display_draws(picture: Callable[[], Field]) -> None:
    assert (saved(picture) == picture()).all(), command(picture)


def saved(picture: Callable[[], Field]) -> Field:
    """A picture as its guide shows it."""
    with Image.open(path_of(picture)) as image:
        return np.asarray(image.convert("RGB"))


def command(picture: Callable[[], Field]) -> str:
    """What to run if the saved picture is out of date."""
    return f"run: python -m {picture.__module__} {picture.__name__}"
