from __future__ import annotations

import sys
import zipfile
from pathlib import Path

import pytest

from autocolor.modules import import_modules_of


def test_all_modules_of_a_package_are_imported_in_the_order_of_their_names_also_from_an_archive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "cupboard"
    folder.mkdir()
    (folder / "__init__.py").write_text("seen = []\n")
    for name in ("spoons", "forks"):
        (folder / f"{name}.py").write_text(f"from cupboard import seen\nseen.append({name!r})\n")
    with zipfile.ZipFile(tmp_path / "house.zip", "w") as archive:
        for module in folder.iterdir():
            archive.write(module, f"cupboard/{module.name}")
    for place in (tmp_path, tmp_path / "house.zip"):
        monkeypatch.syspath_prepend(place)
        import_modules_of("cupboard")
        cupboard = sys.modules["cupboard"]
        assert str(cupboard.__file__).startswith(str(place / "cupboard"))
        assert cupboard.seen == ["forks", "spoons"]
        for name in [name for name in sys.modules if name.partition(".")[0] == "cupboard"]:
            del sys.modules[name]
