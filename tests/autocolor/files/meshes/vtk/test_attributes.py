from __future__ import annotations

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.vtk.attributes import Attributes
from autocolor.files.meshes.vtk.cursor import VtkCursor
from tests.autocolor.files.meshes.vtk.files import TYPES, VtkWriter


def read(writer: VtkWriter) -> Attributes:
    """What is read of two nodes, in turned order, and three cells, of which the last is a polygon."""
    cursor = VtkCursor(writer.data, "a.vtk")
    if not writer.binary:
        cursor.as_text()
    for _ in range(4):
        cursor.words()
    attributes = Attributes(
        cursor, {"node": 2, "polygon": 3}, {"node": np.array([1, 0]), "polygon": np.array([2])}
    )
    attributes.read()
    return attributes


def shown(attributes: Attributes) -> dict[str, str]:
    return {each.name: f"{each.of} {each.values.tolist()}" for each in attributes.found.scalars}


@pytest.mark.parametrize("binary", [False, True])
def test_every_kind_of_data_is_read_or_skipped_and_told(binary: bool) -> None:
    colors = ([[1, 2, 3]] * 2, "unsigned_char") if binary else ([[0.1, 0.2, 0.3]] * 2, "float")
    table = ([[1, 2, 3, 4]], "unsigned_char") if binary else ([[0.1, 0.2, 0.3, 1]], "float")
    writer = (
        VtkWriter("POLYDATA", binary=binary)
        .line("POINT_DATA 2")
        .line("SCALARS Nodal%20Stress double")
        .line("LOOKUP_TABLE default")
        .numbers([1.5, 2.5], "double")
        .line("LOOKUP_TABLE reds 1")
        .numbers(*table)
        .line("SCALARS pair float 2")
        .line("LOOKUP_TABLE default")
        .numbers([3, 4, 6, 8], "float")
        .line("COLOR_SCALARS c 3")
        .numbers(*colors)
        .line("VECTORS v float")
        .numbers([1, 2, 2, 0, 0, 1], "float")
        .line("NORMALS n float")
        .numbers([0, 0, 1, 0, 0, 1], "float")
        .line("TEXTURE_COORDINATES uv 2 float")
        .numbers([0, 0, 1, 1], "float")
        .line("TENSORS t double")
        .numbers([[4, 0, 0, 0, 0, 0, 0, 0, 0]] * 2, "double")
        .line("METADATA\nINFORMATION 0\n")
        .line("CELL_DATA 3")
        .line("FIELD more 3")
        .line("heat 1 3 short")
        .numbers([7, 8, 9], "short")
        .line("METADATA\nINFORMATION 0\n")
        .line("six 6 3 float")
        .numbers(np.arange(18) * 0 + 5.0, "float")
        .line("other 1 2 int")
        .numbers([1, 2], "int")
        .line("GLOBAL_IDS ids vtkIdType")
        .numbers([1, 2, 3], "vtkIdType")
    )
    attributes = read(writer)
    assert shown(attributes) == {
        "Nodal Stress": "node [2.5, 1.5]",
        "pair magnitude": "node [10.0, 5.0]",
        "v magnitude": "node [1.0, 3.0]",
        "t von Mises": "node [4.0, 4.0]",
        "heat": "polygon [9.0]",
        "six von Mises": "polygon [15.0]",
    }
    assert attributes.messages == (
        "skipped color tables: 1",
        "skipped arrays of colors: 1",
        "skipped normals: 1",
        "skipped texture coordinates: 1",
        "skipped arrays that are of no node or cell: 1",
        "skipped arrays of numbers for identification: 1",
    )


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("binary", [False, True])
def test_scalars_may_have_any_type(binary: bool, kind: str) -> None:
    writer = VtkWriter("POLYDATA", binary=binary).line("POINT_DATA 2").line(f"SCALARS s {kind}")
    assert shown(read(writer.numbers([7, 9], kind))) == {"s": "node [9.0, 7.0]"}


def test_missing_values_are_nan() -> None:
    writer = VtkWriter("POLYDATA").line("POINT_DATA 2\nSCALARS s float\nLOOKUP_TABLE default\nnan 1")
    assert shown(read(writer)) == {"s": "node [1.0, nan]"}


def test_texts_and_bits_are_skipped() -> None:
    text = VtkWriter("POLYDATA").line(
        "POINT_DATA 2\nFIELD f 2\nnames 1 2 string\nfirst one\nsecond\nb 1 2 bit\n0 1"
    )
    binary = VtkWriter("POLYDATA", binary=True).line("POINT_DATA 2\nFIELD f 2\nnames 1 2 string")
    binary.data += bytes([0xC3]) + b"one" + bytes([0x80, 0x46]) + b"x" * 70 + b"\nb 1 2 bit\n\x40\n"
    for writer in (text, binary):
        attributes = read(writer.line("SCALARS s int\nLOOKUP_TABLE default").numbers([1, 2], "int"))
        assert shown(attributes) == {"s": "node [2.0, 1.0]"}
        assert attributes.messages == ("skipped arrays of texts: 1", "skipped arrays of bits: 1")


def test_what_follows_an_unknown_keyword_is_skipped_and_told() -> None:
    attributes = read(VtkWriter("POLYDATA").line("POINT_DATA 2\nSPLINES s 2\n1 2"))
    assert attributes.messages == ("skipped all from the unknown keyword 'SPLINES' on",)


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        ("POINT_DATA 3", "a.vtk, line 5: POINT_DATA must be for all 2 of the file, not 3; correct the count"),
        (
            "POINT_DATA 2\nSCALARS s",
            "a.vtk, line 6: SCALARS must be followed by 2 words, not 1; correct it",
        ),
        (
            "POINT_DATA 2\nSCALARS s float\nLOOKUP_TABLE default\n1",
            "a.vtk, line 7: the array 's' must have 2 numbers, not 1; the file is cut short or its counts are"
            " wrong",
        ),
        (
            "CELL_DATA 3\nFIELD f 1\nname 1 3",
            "a.vtk, line 7: an array of a FIELD must have a name, two counts and a type, not 'name 1 3';"
            " correct"
            " it",
        ),
        (
            "CELL_DATA 3\nFIELD f 900000",
            "a.vtk, line 6: a FIELD must have at most 100,000 arrays, not 900,000; leave some out",
        ),
        (
            "CELL_DATA 3\nFIELD f 1\nname 1 99999999999 string\n",
            "a.vtk, line 7: there must be 99,999,999,999 texts, not fewer; correct the count",
        ),
    ],
)  # fmt: skip
def test_wrong_data_are_refused_with_their_place(lines: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        read(VtkWriter("POLYDATA").line(lines))
    assert str(caught.value) == sentence
