from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Flap, Flaps, InputError, Light, Surface
from autocolor.files.store import schema as module
from autocolor.files.store.schema import columns_of
from autocolor.files.store.store_file import read_store
from autocolor.scene.columns import Row, keys_of
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part
from autocolor.scene.view import NamedView, View
from tests.autocolor.files.store.stores import small_store


def test_a_table_of_too_many_rows_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_ROWS", 1)
    with pytest.raises(InputError, match="the rows of parts must be at most 1, not more; leave rows out"):
        read_store(small_store(tmp_path))


@pytest.mark.parametrize("cls", [Scene, View, NamedView, Scalar, Light, Surface, Part, Flap, Flaps])
def test_every_key_of_a_class_has_its_columns(cls: type[Row]) -> None:
    held_elsewhere = {"mesh", "parts", "surfaces", "lights", "views"} if cls is Scene else set()
    found = {column.path[0] for column in columns_of(cls)}
    assert found == keys_of(cls).keys() - held_elsewhere
