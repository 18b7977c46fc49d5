"""The pictures of the guides are those that their functions make, and each is in its guide."""

from __future__ import annotations

import inspect
from collections.abc import Callable

import numpy as np
import pytest
from PIL import Image

from docs.guides.pictures import GUIDES, PICTURES, path_of
from scenes.figures import Field

MOST_BYTES = 60_000
CLOSE = 1.0
"""The mean difference of components. Fewer colors make 0.25 of it, and a missing drag at least 5."""

SCREENS = [picture for picture in PICTURES if "open_viewer" in inspect.getsource(picture)]


def test_every_picture_is_small_and_in_its_guide() -> None:
    for picture in PICTURES:
        path = path_of(picture)
        guide = GUIDES / f"{picture.__name__.partition('_')[0]}.md"
        assert f"](images/{path.name})" in guide.read_text("utf-8")
        assert path.stat().st_size <= MOST_BYTES


@pytest.mark.parametrize("picture", SCREENS, ids=lambda picture: picture.__name__)
def test_a_picture_of_a_screen_is_that_of_its_steps(picture: Callable[[], Field]) -> None:
    with Image.open(path_of(picture)) as image:
        shown = np.asarray(image.convert("RGB"), np.int16)
    assert np.abs(shown - picture()).mean() < CLOSE, f"run: python -m docs.guides.pictures {picture.__name__}"
