from __future__ import annotations

import sys
from pathlib import Path

import pytest

from autocolor.files.modules import import_modules_of


def test_every_module_and_package_of_a_package_is_imported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for path in ("shelf/__init__.py", "shelf/one.py", "shelf/two/__init__.py", "shelf/two/inner.py"):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    import_modules_of("shelf")
    names = {name for name in sys.modules if name.partition(".")[0] == "shelf"}
    for name in names:
        monkeypatch.delitem(sys.modules, name)
    assert names == {"shelf", "shelf.one", "shelf.two"}
