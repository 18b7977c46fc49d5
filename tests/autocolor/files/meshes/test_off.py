from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from autocolor.files.meshes.off import read_off
from autocolor.files.meshes.repair import FILE, MeshReport, Placement
from tests.autocolor.files.refusals import refused, swapped

CUBE = """OFF
# a cube
8 6 12
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


def read(folder: Path, text: str | bytes, placement: Placement | None = None) -> MeshReport:
    path = folder / "cube.off"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_off(path, placement or Placement())


def test_a_cube_keeps_its_quads_and_nodes(tmp_path: Path) -> None:
    report = read(tmp_path, CUBE)
    mesh = report.mesh
    assert (len(mesh.coordinates), len(mesh.node_numbers), mesh.triangle_count) == (8, 6, 0)
    assert mesh.node_numbers[0].tolist() == [3, 2, 1, 0]
    assert mesh.coordinates[6].tolist() == [1, 1, 1]
    assert mesh.part_names == ("cube",)
    assert report.repairs == ()


@pytest.mark.parametrize(
    "first",
    [
        *("OFF 8 6 12", "8 6 12", "  OFF\n\n8 6\t0", "OFF # 1\n8 6 12 # 2", "OFF8 6 12", "COFF8 6\n12"),
        *("# a\n\nNOFF8 6 12", "CNOFF 8 6 12", "STCNOFF\n8 6 12"),
    ],
)
def test_the_header_has_many_forms(tmp_path: Path, first: str) -> None:
    text = CUBE.replace("OFF\n# a cube\n8 6 12", first)
    if "NOFF" in first:
        text = re.sub(r"^([01] [01] [01])$", r"\1 0 0 1", text, flags=re.MULTILINE)
    assert read(tmp_path, text).mesh.node_numbers.tolist() == read(tmp_path, CUBE).mesh.node_numbers.tolist()


COLORS = ("cube.off: left out the colors of nodes", "cube.off: left out the colors of polygons")


@pytest.mark.parametrize("normal", ["", " 1 0 -1"])
@pytest.mark.parametrize("texture", ["", " 0.5 0.25"])
@pytest.mark.parametrize("color", ["", " 0.5 1 0 nan"])
def test_normals_are_used_and_colors_are_left_out(
    tmp_path: Path, normal: str, texture: str, color: str
) -> None:
    keyword = f"{'ST' * bool(texture)}{'C' * bool(color)}{'N' * bool(normal)}OFF"
    lines = CUBE.replace("OFF", keyword).splitlines()
    # Some nodes have no color.
    lines[3:11] = [f"{line}{normal}{color * (row != 2)}{texture}" for row, line in enumerate(lines[3:11])]
    lines[11:] = [f"{line}{' 7' * bool(color) * (row % 2)}" for row, line in enumerate(lines[11:])]
    report = read(tmp_path, "\n".join(lines), Placement(normals=FILE))
    plain = read(tmp_path, CUBE).mesh
    assert report.mesh.coordinates.tolist() == plain.coordinates.tolist()
    assert report.mesh.node_numbers.tolist() == plain.node_numbers.tolist()
    assert report.repairs[: 2 * bool(color)] == COLORS * bool(color)
    own = report.mesh.own_normals
    if normal:
        assert own is not None
        unit = np.array(list(map(float, normal.split())))
        assert np.abs(own.vectors[own.numbers] @ (unit / np.linalg.norm(unit))) == pytest.approx(1)
    else:
        assert own is None


def test_polygons_of_many_sides_are_split_and_what_follows_is_told(tmp_path: Path) -> None:
    text = "OFF\n5 2 0\n0 0 0\n2 0 0\n3 1 0\n2 2 0\n0 2 0\n5 0 1 2 3 4\n3 0 1 2\nmore words\n"
    report = read(tmp_path, text)
    assert sorted(len(set(row)) for row in report.mesh.node_numbers.tolist()) == [3, 3, 4]
    assert report.repairs == (
        "cube.off: skipped words that are neither nodes nor polygons: 2",
        "cube.off: 1 polygon with more than four corners was split",
    )


LINES = ": the header must count the lines of nodes and polygons, 1 or more, not"
CUT = "it is cut short or its counts are wrong"

test_what_is_refused = refused(
    "cube.off",
    [
        (swapped(CUBE, old, new), f"cube.off{sentence}")
        for old, new, sentence in (
            (
                "OFF\n",
                "4OFF\n",
                ": an OFF file must begin OFF, COFF, NOFF or STOFF, not '4OFF'; write it with three"
                " coordinates, as text",
            ),
            *(
                ("8 6 12", f"{counts} 12", f"{LINES} {told} of 14 lines; export it again")
                for counts, told in (("0 6", "0 and 6"), ("8 0", "8 and 0"), ("8 7", "8 and 7"))
            ),
            ("1 1 0\n", "1 1\n", ", line 6: the line of a node must have 3 numbers, not '1'; correct it"),
            *(
                (
                    "4 0 1 5 4",
                    f"4 0 1 5 {word}",
                    f", line 14: a corner must be a node number from 0 to 7, not '{word}'; correct it",
                )
                for word in ("8", "-1", "5.5", "inf")
            ),
            *(
                (
                    "4 0 1 5 4",
                    f"{count} 0 1 5 4",
                    ", line 14: a polygon must begin with the number of the corners on its line, not"
                    f" '{count}'; correct it",
                )
                for count in ("5", "-1", "3.5")
            ),
        )
    ],
)
