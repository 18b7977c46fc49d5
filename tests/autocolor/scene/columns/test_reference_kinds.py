from __future__ import annotations

from autocolor import Part, Surface
from autocolor.scene.columns.reference_kinds import PointOrName, Reference, References, references_of


def test_names_that_refer_to_other_rows_are_found() -> None:
    assert Reference("surfaces").names_in("body") == ("body",)
    assert References("lights").names_in(("key", "rim")) == ("key", "rim")
    assert PointOrName("lights").names_in("key") == ("key",)
    assert PointOrName("lights").names_in((1.0, 2.0, 3.0)) == ()


def test_columns_that_refer_to_other_tables_are_known() -> None:
    assert {name: kind.table for name, kind in references_of(Part).items()} == {"surface": "surfaces"}
    assert references_of(Surface) == {}
