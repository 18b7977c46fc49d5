from __future__ import annotations

import pytest

from benchmarks.start import import_tree, imports

REPORT = """\
import time: self [us] | cumulative | imported package
import time:        10 |         10 |   deep
import time:       300 |        310 | first
import time:        20 |         20 |     deepest
import time:        30 |         50 |   middle
import time:        40 |         40 |   beside
import time:      1000 |       1090 | second
something that was said on stderr
"""


def test_a_module_stands_above_what_it_imports() -> None:
    assert [(row.module, row.depth) for row in import_tree(REPORT)] == [
        ("first", 0), ("deep", 1), ("second", 0), ("middle", 1), ("deepest", 2), ("beside", 1),
    ]  # fmt: skip
    assert import_tree(REPORT)[2][:3] == ("second", 1.0, 1.09)


def test_the_imports_of_some_code_add_up_by_package() -> None:
    measured = imports("import json", rounds=1)
    assert set(measured["packages ms"]) >= {"the standard library"}
    assert sum(measured["packages ms"].values()) == pytest.approx(measured["own ms"])
