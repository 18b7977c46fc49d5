"""The first lines of the README make its picture, anywhere and as often as they are run."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from scenes.title_picture import FRAMES, LINES

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")
(CODE,) = re.findall(r"^```python\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)


def test_the_lines_make_the_moving_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for _ in range(2):
        names: dict[str, Any] = {}
        exec(CODE, names)
    with Image.open("car.webp") as made, Image.open(ROOT / "docs" / "recolor.webp") as shown:
        for number in range(FRAMES):
            made.seek(number)
            shown.seek(number)
            assert (np.array(made.convert("RGB")) == np.array(shown.convert("RGB"))[:LINES]).all(), number
    with Image.open("blue.png") as blue:
        assert (np.array(blue) == names["studio"].display_image.colors).all()


def test_the_lines_are_ten() -> None:
    assert len([line for line in CODE.splitlines() if line]) == 10
