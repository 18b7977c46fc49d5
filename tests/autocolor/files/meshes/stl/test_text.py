from __future__ import annotations

import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.stl import text as text_module
from autocolor.files.meshes.stl.text import FACET, read_text

A = "facet normal nan 0 x\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n"
B = A.replace("vertex 0 0 0", "vertex -5 .5 +5.")


def refusal(text: str) -> str:
    with pytest.raises(InputError) as caught:
        read_text(text.encode(), "a.stl")
    return str(caught.value)


@pytest.mark.parametrize("block", [1, 1 << 21])
def test_solids_are_parts(block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_module, "BLOCK", block)
    text = f"solid the hood\n{A}{B}endsolid the hood\n\nsolid\nendsolid\n  SOLID door\n{B.upper()}ENDSOLID\n"
    found = read_text(text.encode(), "a.stl")
    assert found.names == (b" the hood", b" door")
    assert found.part_numbers.tolist() == [0, 0, 1]
    assert found.corners.reshape(3, 9).tolist() == [
        [0, 0, 0, 1, 0, 0, 0, 1, 0],
        [-5, 0.5, 5, 1, 0, 0, 0, 1, 0],
        [-5, 0.5, 5, 1, 0, 0, 0, 1, 0],
    ]
    assert found.messages == ()


def test_lines_may_be_broken_anywhere() -> None:
    text = "solid a\n" + A.replace("\n", " ").replace(" ", "\n\n \t") + "endsolid"
    assert len(read_text(text.encode(), "a.stl").corners) == 3


def test_a_solid_without_an_end_is_told() -> None:
    found = read_text(f"solid a\n{A}".encode(), "a.stl")
    assert len(found.corners) == 3
    assert found.messages == ("the last solid has no 'endsolid': the file may be cut short",)


def test_a_text_without_solids_has_no_triangles() -> None:
    assert len(read_text(b"\n \n", "a.stl").corners) == 0


@pytest.mark.parametrize("block", [1, 1 << 21])
@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (f"{A}", "line 1: a facet must stand in a solid, not outside; add a line 'solid'"),
        (
            f"solid\n{A}endsolid\n\n{A}solid\n",
            "line 11: a facet must stand in a solid, not outside; add a line 'solid'",
        ),
        ("\nendsolid\n", "line 2: a solid must begin before it ends; remove the line"),
        (f"solid a\n{A}solid b\n", "line 9: a solid must end before the next; add a line 'endsolid'"),
        (
            f"solid a\n{A}{A.replace('outer loop', 'inner loop')}endsolid\n",
            f"line 10: a facet must be '{FACET}', with numbers for the points, and 'outer' must stand here,"
            " not 'inner'; correct it",
        ),
        (
            f"solid a\n{A}{A.replace('endloop', 'vertex 1 1 1 endloop')}endsolid\n",
            f"line 14: a facet must be '{FACET}', with numbers for the points, and 'endloop' must stand here,"
            " not 'vertex'; correct it",
        ),
        (
            f"solid a\n{A.partition('endloop')[0]}",
            f"line 6: a facet must be '{FACET}', and not end before its 'endloop'; correct it",
        ),
        (
            f"solid a\n{A}facet",
            f"line 9: a facet must be '{FACET}', and not end before its 'normal'; correct it",
        ),
        *(
            (
                f"solid a\n{A.replace('1e0', number)}endsolid\n",
                f"line 6: a coordinate must be a decimal number of at most 1e30 in size, not '{number}';"
                " correct it",
            )
            for number in ("nan", "1_0", "0x1", "1e31", "1,5", "inf", ".")
        ),
    ],
)
def test_a_wrong_text_is_refused(
    text: str, sentence: str, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_module, "BLOCK", block)
    assert refusal(text) == f"a.stl, {sentence}"


def test_an_endless_facet_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_module, "BLOCK", 1)
    monkeypatch.setattr(text_module, "LONGEST_FACET", 200)
    assert refusal(f"solid a\n{A}" + "vertex " * 100) == (
        "a.stl, line 9: a facet must have at most 200 bytes, not more; correct it"
    )
