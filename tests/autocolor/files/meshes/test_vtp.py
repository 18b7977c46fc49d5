from __future__ import annotations

import dataclasses
import itertools
import re
import tracemalloc
import zlib
from pathlib import Path

import numpy as np
import pytest

from autocolor.files.formats import format_of
from autocolor.files.meshes import vtp
from autocolor.files.meshes.repair import MeshReport, Placement
from autocolor.files.meshes.vtp import read_vtp
from tests.autocolor.files.meshes.vtp_files import PACKED, VtpWriter
from tests.autocolor.files.refusals import is_read_or_refused, refusal, refused

NODES = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0.1], [2, 1, 0], [9, 9, 9]]

ENCODINGS = [
    VtpWriter(form, encoding, compressor, order, header)
    for form, encoding, compressor, order, header in itertools.product(
        ("ascii", "binary", "appended"), ("raw", "base64"), PACKED, "<>", ("u4", "u8")
    )
    if form == "appended" or encoding == "raw"
    if form != "ascii" or (compressor == "" and header == "u4")
]


def read(folder: Path, data: bytes, placement: Placement | None = None) -> MeshReport:
    path = folder / "thing.vtp"
    path.write_bytes(data)
    return read_vtp(path, placement or Placement())


def name_of(writer: VtpWriter) -> str:
    return "-".join([writer.format, writer.encoding, writer.compressor[3:7], writer.order, writer.header])


@pytest.mark.parametrize("encoding", ENCODINGS, ids=name_of)
def test_every_encoding_gives_the_same_mesh(tmp_path: Path, encoding: VtpWriter) -> None:
    writer = dataclasses.replace(encoding, pieces=[], appended=b"")
    heights = writer.array("height", "Float64", [0, 1, 2, 3, 1e300, np.nan, 6])
    colors = writer.array("colors", "UInt8", np.zeros((7, 3)), 3)
    normals = writer.array("N", "Float32", np.zeros((7, 3)), 3)
    moves = writer.array("move", "Int8", [[3, 4, 0]] * 7, 3)
    numbers = writer.array("number", "Int64", range(10, 17))
    points = f'<PointData Scalars="height" Normals="N">{heights}{colors}{normals}{moves}</PointData>'
    writer.piece(
        NODES,
        sections=f"{points}<CellData>{numbers}</CellData>",
        Verts=[[6], [5, 4]],
        Lines=[[0, 1, 2]],
        Polys=[[0, 1, 2, 3], [1, 4, 2], [0, 1, 4, 5, 3]],
        Strips=[[0, 1, 3, 2, 4]],
    )
    report = read(tmp_path, writer.data)
    mesh = report.mesh
    assert mesh.coordinates.tolist() == np.array(NODES[:6], np.float32).tolist()
    assert mesh.node_numbers.tolist() == [
        [0, 1, 2, 3], [1, 4, 2, 2], [0, 1, 4, 5], [0, 5, 3, 3], [0, 1, 3, 3], [3, 1, 2, 2], [3, 2, 4, 4],
    ]  # fmt: skip
    scalars = {each.name: (each.of, each.values.tolist()) for each in mesh.scalars}
    assert scalars.pop("height")[1][:4] == [0, 1, 2, 3]
    assert scalars == {
        "move magnitude": ("node", [5.0] * 6),
        # The data of strips follows that of polygons, whatever the order of the sections.
        "number": ("polygon", [13, 14, 15, 15, 16, 16, 16]),
    }
    assert mesh.part_names == ("thing",)
    assert report.repairs == tuple(
        f"thing.vtp: {sentence}"
        for sentence in (
            "skipped vertices: 2",
            "skipped lines: 1",
            "scalar 'height': 1 value above 1e30 in size was made missing",
            "skipped arrays of colors: 1",
            "skipped normals: 1",
            "1 polygon with more than four corners was split",
            "1 node that no polygon uses was dropped",
        )
    )


@pytest.mark.parametrize("form", ["ascii", "appended"])
def test_all_pieces_are_one_mesh(tmp_path: Path, form: str) -> None:
    writer = VtpWriter(form)
    for first in (0, 10):
        in_both = writer.array("s", "Int32", range(first, first + 4))
        alone = writer.array("alone" if first else "s2", "Int32", range(4))
        number = writer.array("cell", "Int32", [first])
        sections = f"<PointData>{in_both}{alone}</PointData><CellData>{number}</CellData>"
        writer.piece(np.array(NODES[:4]) + first, sections=sections, Polys=[[0, 1, 2, 3]])
        writer.piece([])
    report = read(tmp_path, writer.data)
    assert report.mesh.node_numbers.tolist() == [[0, 1, 2, 3], [4, 5, 6, 7]]
    assert report.mesh.coordinates[4].tolist() == [10, 10, 10]
    assert [(each.name, each.values.tolist()) for each in report.mesh.scalars] == [
        ("s", [0, 1, 2, 3, 10, 11, 12, 13]),
        ("cell", [0, 10]),
    ]
    assert report.repairs == ("thing.vtp: skipped arrays that differ between pieces, or are empty: 2",)


def test_it_is_placed_and_known_by_its_suffix_and_its_first_bytes(tmp_path: Path) -> None:
    data = VtpWriter().piece(NODES[:4], Polys=[[0, 1, 2, 3]]).data
    assert read(tmp_path, data, Placement("y", 2.0)).mesh.coordinates[2].tolist() == [2, 0, 2]
    for name in ("a.vtp", "a.dat"):
        (tmp_path / name).write_bytes(data)
        mesh_format = format_of(tmp_path / name)
        assert mesh_format is not None
        assert mesh_format.name == "VTP"


def test_a_file_that_begins_with_many_comments_is_recognized_at_once() -> None:
    comments = b"<!-- - -- > -->" * 5000
    assert vtp.begins_as_vtp(GOOD.replace(b"<VTK", comments + b"<VTK"))
    assert not vtp.begins_as_vtp(comments + b"x")


def good(form: str = "ascii", encoding: str = "raw", compressor: str = "") -> bytes:
    return VtpWriter(form, encoding, compressor).piece(NODES[:4], Polys=[[0, 1, 2, 3]]).data


GOOD, BINARY, APPENDED = good(), good("binary"), good("appended")
ZLIB = good("binary", compressor="vtkZLibDataCompressor")
AT_POINTS = "thing.vtp, line 5, array 'Points': "
SHORT = "; the file is cut short or its counts are wrong"

test_a_wrong_file_is_refused_with_its_place = refused(
    "thing.vtp",
    [
        (b"", "thing.vtp, line 1: a VTP file must be XML (no element found); write it again"),
        (b"<VTKFile", "thing.vtp, line 1: a VTP file must be XML (unclosed token); write it again"),
        (
            GOOD.replace(b"<VTK", b'<!DOCTYPE x [<!ENTITY a "aaaa">]>\n<VTK'),
            "thing.vtp, line 2: a VTP file must have no DOCTYPE; remove it",
        ),
        (
            GOOD.replace(b"<VTK", b'<!DOCTYPE x SYSTEM "file:///etc/passwd">\n<VTK'),
            "thing.vtp, line 2: a VTP file must have no DOCTYPE; remove it",
        ),
        (
            GOOD.replace(b'"PolyData"', b'"ImageData"'),
            "thing.vtp, line 2: it must be a VTKFile of type 'PolyData', not 'VTKFile' of type 'ImageData';"
            " take its surface",
        ),
        (
            GOOD.replace(b"LittleEndian", b"Middle"),
            "thing.vtp: byte_order must be LittleEndian or BigEndian, not 'Middle'; write it again",
        ),
        (
            GOOD.replace(b"UInt32", b"UInt16"),
            "thing.vtp: header_type must be UInt32 or UInt64, not 'UInt16'; write it again",
        ),
        (
            GOOD.replace(b'Points="4"', b'Points="400"'),
            f"{AT_POINTS}it must have 1,200 numbers, not 12{SHORT}",
        ),
        (
            GOOD.replace(b'Polys="1"', b'Polys="0"'),
            "thing.vtp: a mesh must have a polygon with area, not none; add polygons",
        ),
        (
            GOOD.replace(b"Points>", b"Places>"),
            "thing.vtp, line 4: a piece with points must have Points, not none; add them",
        ),
        (
            GOOD.replace(b'Components="3"', b'Components="2"'),
            f"{AT_POINTS}Points must have three components; correct it",
        ),
        (
            GOOD.replace(b'Components="3"', b'Components="x"'),
            f"{AT_POINTS}NumberOfComponents must be a whole number, not 'x'; correct it",
        ),
        (
            GOOD.replace(b"1.0 1.0 0.0", b"1.0 1_0 0.0"),
            "thing.vtp, line 8: a value must be a decimal number, nan or inf, not '1_0'; correct it",
        ),
        (
            GOOD.replace(b"1.0 1.0 0.0", b"1.0 1e31 0.0"),
            f"{AT_POINTS}a coordinate must be finite and at most 1e30 in size, not 1e+31 (number 8); correct"
            " it",
        ),
        (
            GOOD.replace(b'"Float32"', b'"Float16"'),
            f"{AT_POINTS}its type must be one of {', '.join(vtp.TYPES)}, not 'Float16'; write the file again",
        ),
        (
            GOOD.replace(b'"ascii"', b'"morse"', 1),
            f"{AT_POINTS}its format must be ascii, binary or appended, not 'morse'; write the file again",
        ),
        (
            GOOD.replace(b"connectivity", b"corners"),
            "thing.vtp, line 4: the Polys of a piece must have the arrays 'connectivity' and 'offsets'; write"
            " the file again",
        ),
        (
            GOOD.replace(b"\n3\n", b"\n4\n"),
            "thing.vtp, Polys: a node number must be from 0 to 3, not 4 (cell 0, counted from 0); correct it",
        ),
        (
            GOOD.replace(b'"Int64"', b'"Float32"'),
            "thing.vtp, line 12, array 'connectivity': its type must be Int64 or another of whole numbers;"
            " correct it",
        ),
        (
            GOOD.replace(b" 4\n", b" -4\n"),
            "thing.vtp, line 18, array 'offsets': offsets must rise from 0 on; correct them",
        ),
        (
            BINARY.replace(b"\n MAAA", b"\n M*AA"),
            f"{AT_POINTS}it must be base64, not have '*'; write it again",
        ),
        (
            BINARY.replace(b"\n MAAA", b"\n MAA"),
            f"{AT_POINTS}it must be base64 of whole bytes, not cut short; write it again",
        ),
        (BINARY.replace(b"\n MAAA", b"\n NAAA"), f"{AT_POINTS}it must have 48 bytes, not 52{SHORT}"),
        (BINARY.replace(b'Points="4"', b'Points="5"'), f"{AT_POINTS}it must have 60 bytes, not 48{SHORT}"),
        (APPENDED[:-40], f"{AT_POINTS}it must have 52 bytes, not 40{SHORT}"),
        (
            APPENDED.replace(b'offset="44"', b'offset="nine"'),
            f"{AT_POINTS}its offset must be a whole number, not 'nine'; correct it",
        ),
        (
            APPENDED.replace(b'offset="36"', b'offset="%b"' % (b"9" * 5000)),
            f"thing.vtp, line 8, array 'offsets': its offset must be a whole number, not '{'9' * 40}'...;"
            " correct it",
        ),
        (
            APPENDED.replace(b'offset="44"', b'offset="99999999"'),
            f"{AT_POINTS}it must have 4 bytes, not 0{SHORT}",
        ),
        (
            APPENDED.replace(b'encoding="raw"', b'encoding="hex"'),
            "thing.vtp: the encoding of AppendedData must be raw or base64, not 'hex'; write it again",
        ),
        (
            APPENDED.replace(b" _", b" -"),
            "thing.vtp: AppendedData must begin with '_'; write the file again",
        ),
        (
            ZLIB.replace(b"vtkZLib", b"vtkLZ4"),
            f"{AT_POINTS}its compressor must be vtkZLibDataCompressor or vtkLZMADataCompressor, not"
            " 'vtkLZ4DataCompressor'; write the file with zlib",
        ),
        (
            ZLIB.replace(b"vtkZLib", b"vtkLZMA"),
            f"{AT_POINTS}a packed block must be whole, not wrong (Input format not supported by decoder);"
            " write it again",
        ),
        (
            ZLIB.replace(b'Points="4"', b'Points="5"'),
            f"{AT_POINTS}it must have 60 bytes, not 48{SHORT}",
        ),
        ("x".encode("utf-16"), "thing.vtp: a VTP file must be text in UTF-8, not UTF-16; save it as UTF-8"),
        (
            b"<VTKFile " + b"a" * 70_000,
            "thing.vtp, line 1: a tag must have at most 65,536 bytes, not more; correct it",
        ),
    ],
)


@pytest.mark.parametrize("kind", ["Points", "Verts", "Lines", "Polys"])
@pytest.mark.parametrize("count", ["-4", "4.0", "", "999999999999999999", "9" * 400])
def test_a_count_is_a_whole_number_that_a_file_of_its_size_may_have(
    tmp_path: Path, kind: str, count: str
) -> None:
    old, new = rb'NumberOf%b="."' % kind.encode(), b'NumberOf%b="%b"' % (kind.encode(), count.encode())
    data = re.sub(old, new, GOOD)
    assert refusal(read, tmp_path, data).startswith(
        f"thing.vtp, line 4: NumberOf{kind} must be a whole number from 0 to {200 * len(data):,}, for the"
        f" size of the file, not '{count[:39]}"
    )


def test_a_block_that_takes_much_memory_to_unpack_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = good("binary", compressor="vtkLZMADataCompressor")
    assert len(read(tmp_path, data).mesh.coordinates) == 4
    monkeypatch.setattr(vtp, "LARGEST_DICTIONARY", 1 << 16)
    assert refusal(read, tmp_path, data) == (
        f"{AT_POINTS}a packed block must be whole, not wrong (Memory usage limit exceeded); write it again"
    )


def test_too_many_elements_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vtp, "MOST_ELEMENTS", 10)
    data = GOOD.replace(b"<Points>", b"<Points>" + b"<a/>" * 20)
    assert refusal(read, tmp_path, data) == (
        "thing.vtp, line 5: a VTP file must have at most 10 elements, not more; simplify it"
    )


def test_arrays_that_share_appended_data_are_refused(tmp_path: Path) -> None:
    writer = VtpWriter("appended")
    first = writer.array("first", "Int32", np.zeros(1000), 250)
    shared = "".join(first.replace("first", str(number)) for number in range(40))
    writer.piece(NODES[:4], sections=f"<PointData>{shared}</PointData>", Polys=[[0, 1, 2, 3]])
    assert refusal(read, tmp_path, writer.data).endswith(
        "its offset must be its own, not another array's; write the file again"
    )


def bomb(size: int) -> bytes:
    """A file whose scalar unpacks from a thousandth of its size."""
    writer = VtpWriter("appended", compressor="vtkZLibDataCompressor", block=size)
    zeros = writer.array("zeros", "UInt8", np.zeros(size), size // 4)
    writer.piece(NODES[:4], sections=f"<PointData>{zeros}</PointData>", Polys=[[0, 1, 2, 3]])
    return writer.data


def test_data_that_unpack_to_much_more_than_the_file_are_refused_before(tmp_path: Path) -> None:
    data = bomb(40_000_000)
    tracemalloc.start()
    sentence = refusal(read, tmp_path, data)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 4_000_000
    assert sentence.endswith(f"at most {200 * len(data):,} bytes, not more; write it without compression")


@pytest.mark.parametrize("change", [-1, 1, 1000])
def test_a_block_of_another_size_than_its_header_says_is_refused(tmp_path: Path, change: int) -> None:
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(
            PACKED,
            "vtkZLibDataCompressor",
            lambda data: zlib.compress(data[:change] if change < 0 else data + bytes(change)),
        )
        data = good("binary", compressor="vtkZLibDataCompressor")
    assert refusal(read, tmp_path, data) == (
        f"{AT_POINTS}a packed block must have 24 bytes, not fewer or more; write it again"
    )


def test_any_cut_or_change_of_a_byte_is_read_or_refused(tmp_path: Path) -> None:
    for data in (GOOD, good("appended", "base64", "vtkLZMADataCompressor"), APPENDED, ZLIB):
        for at in range(0, len(data), 31):
            for damaged in (data[:at], data[:at] + b"\x81" + data[at + 1 :], data[:at] + data[at + 3 :]):
                assert is_read_or_refused(tmp_path / "thing.vtp", damaged)
