from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autocolor.modules import import_modules_of


def test_all_modules_of_a_package_are_imported_in_the_order_of_their_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "cupboard"
    folder.mkdir()
    (folder / "__init__.py").write_text("seen = []\n")
    for name in ("spoons", "forks"):
        (folder / f"{name}.py").write_text(f"from cupboard import seen\nseen.append({name!r})\n")
    monkeypatch.syspath_prepend(tmp_path)
    import_modules_of("cupboard")
    assert sys.modules["cupboard"].seen == ["forks", "spoons"]
    for name in [name for name in sys.modules if name.partition(".")[0] == "cupboard"]:
        monkeypatch.delitem(sys.modules, name)
