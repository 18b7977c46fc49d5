from __future__ import annotations

import pytest

from autocolor.files.meshes.ply.properties import Comments, is_scalar, named_in, property_of

NONE = Comments({}, {})


def test_comments_name_parts_and_scalars() -> None:
    comments = (
        "part 0 hood",
        "part 12 left door",
        "scalar value_0 von Mises",
        "part x",
        "scalar a",
        "part 0 b",
    )
    assert named_in(comments) == Comments({0: "hood", 12: "left door"}, {"value_0": "von Mises"})


@pytest.mark.parametrize("name", ["stress", "quality", "intensity", "confidence", "part"])
def test_a_number_is_a_scalar(name: str) -> None:
    assert is_scalar(name, NONE)


@pytest.mark.parametrize("name", ["x", "nx", "red", "diffuse_green", "alpha", "s", "texture_u", "texnumber"])
def test_coordinates_normals_colors_and_texture_coordinates_are_no_scalars(name: str) -> None:
    assert not is_scalar(name, NONE)
    assert is_scalar(name, Comments({}, {name: "of it"}))


@pytest.mark.parametrize(
    ("scalar", "name"),
    [
        ("stress", "stress"), ("von Mises", "value_3"), ("x", "value_3"), ("red", "value_3"),
        ("part", "value_3"), ("value_0", "value_3"), ("größe", "value_3"), ("vertex_index", "value_3"),
    ],
)  # fmt: skip
def test_a_scalar_is_written_under_its_name_where_that_is_free(scalar: str, name: str) -> None:
    assert property_of(scalar, 3) == name
