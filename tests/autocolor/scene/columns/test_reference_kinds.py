from __future__ import annotations

from autocolor import Light, Part, Surface
from autocolor.scene.columns.reference_kinds import Reference, References, WordOrName, references_of
from autocolor.scene.lights.links import Links


def test_names_that_refer_to_other_rows_are_found() -> None:
    assert Reference("surfaces").names_in("body") == ("body",)
    assert References("lights").names_in(("key", "rim")) == ("key", "rim")


def test_a_word_is_no_name() -> None:
    assert WordOrName("lights", "eye").names_in("eye") == ()
    assert WordOrName("lights", "eye").names_in("key") == ("key",)


def test_columns_that_refer_to_other_tables_are_known_also_inside_others() -> None:
    assert {key: each.kind.table for key, each in references_of(Part).items()} == {"surface": "surfaces"}
    assert references_of(Surface) == {}
    found = references_of(Light)
    assert found["only_parts"].path == ("links", "only_parts")
    light = Light("key", (0, 0, 0), links=Links(only_parts=("hood",)))
    assert found["only_parts"].value_in(light) == ("hood",)
