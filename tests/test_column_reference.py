from __future__ import annotations

import pytest

from autocolor.scene.columns import Row, keys_of
from autocolor.scene.surfaces import Surface
from docs.generate.columns import LEFT_OUT, ROOT, TABLES, document, lines_of


def test_the_document_is_up_to_date() -> None:
    is_up_to_date = (ROOT / "docs" / "COLUMNS.md").read_text("utf-8") == document()
    assert is_up_to_date, "run: python -m docs.generate.columns > docs/COLUMNS.md"


@pytest.mark.parametrize(("title", "text", "cls"), TABLES)
def test_every_key_of_a_table_has_a_line_with_what_it_is(title: str, text: str, cls: type[Row]) -> None:
    lines = "\n".join(lines_of(title, text, cls))
    for key, (column, _, _) in keys_of(cls).items():
        assert (f"| `{key}` | {column.help}" in lines) == (key not in LEFT_OUT.get(cls, ()))


def test_a_parameter_of_a_variant_tells_which_ones_it_goes_with() -> None:
    told = {
        line.split("`")[1]: "Goes with" in line for line in lines_of("", "", Surface) if line[:3] == "| `"
    }
    growth = {"base_reflectance", "refractive_index", "fresnel_curve"}
    assert {key for key, goes in told.items() if goes} == growth | {
        "exponent",
        "roughness",
        "normal_reflectance",
    }
