from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from ramtek_emu.png import png_bytes

FIELD = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)


def test_a_saved_field_is_read_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "field.png"
    path.write_bytes(png_bytes(FIELD))
    with Image.open(path) as picture:
        assert (np.asarray(picture) == FIELD).all()
