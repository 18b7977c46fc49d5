from __future__ import annotations

from pathlib import Path

from autocolor.files.meshes.byu import read_byu
from autocolor.files.meshes.repair import MeshReport, Placement
from tests.autocolor.files.refusals import refused, swapped

CUBE = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]

FREE = """2 8 6 24
1 5 6 6
0 0 0 1 0 0 0 1 0 1 1 0
0 0 1 1 0 1 0 1 1 1 1 1
1 3 4 -2 5 6 8 -7 1 2 6 -5
3 7 8 -4 1 5 7 -3 2 4 8 -6
"""


def in_columns(width: int) -> str:
    """The cube in columns of Fortran, where numbers with a sign touch those before them."""
    words = FREE.split()
    numbers = ["".join(word.rjust(width) for word in words[:4]), "".join(w.rjust(width) for w in words[4:8])]
    places = [f"{float(word) - 0.5:12.5E}".replace("E", "D") for word in words[8:32]]
    numbers += ["".join(places[at : at + 6]) for at in range(0, 24, 6)]
    numbers.append("".join(word.rjust(width) for word in words[32:]))
    return "\n".join(numbers)


def read(folder: Path, text: str | bytes, placement: Placement | None = None) -> MeshReport:
    path = folder / "cube.byu"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_byu(path, placement or Placement())


def test_a_cube_keeps_its_quads_nodes_and_parts(tmp_path: Path) -> None:
    report = read(tmp_path, FREE)
    mesh = report.mesh
    assert mesh.coordinates.tolist() == CUBE
    assert mesh.node_numbers.tolist()[0] == [0, 2, 3, 1]
    assert (mesh.edge_count, mesh.triangle_count, len(mesh.node_numbers)) == (12, 0, 6)
    assert mesh.part_names == ("part 1", "part 2")
    assert mesh.part_numbers.tolist() == [0, 0, 0, 0, 0, 1]
    assert report.repairs == ()


def test_numbers_in_columns_may_touch_and_have_exponents_with_d(tmp_path: Path) -> None:
    text = in_columns(5)
    assert "D-01-" in text
    mesh = read(tmp_path, text).mesh
    assert (mesh.coordinates + 0.5).tolist() == CUBE
    assert mesh.node_numbers.tolist() == read(tmp_path, FREE).mesh.node_numbers.tolist()


def test_a_polygon_of_no_part_has_one_named_after_the_file(tmp_path: Path) -> None:
    mesh = read(tmp_path, FREE.replace("1 5 6 6", "2 3 3 5")).mesh
    assert mesh.part_names == ("part 1", "part 2", "cube")
    assert mesh.part_numbers.tolist() == [2, 0, 1, 1, 1, 2]
    assert read(tmp_path, FREE.replace("2 8", "0 8").replace("1 5 6 6\n", "")).mesh.part_names == ("cube",)


def test_a_polygon_of_many_sides_is_split_and_what_follows_is_told(tmp_path: Path) -> None:
    text = "1 5 1 5\n1 1\n0 0 0 2 0 0 3 1 0 2 2 0 0 2 0\n1 2 3 4 -5\nend of file\n"
    report = read(tmp_path, text)
    assert sorted(map(len, map(set, report.mesh.node_numbers.tolist()))) == [3, 4]
    assert report.repairs == (
        "cube.byu: skipped words after the connectivity: 3",
        "cube.byu: 1 polygon with more than four corners was split",
    )


CUT = "it is cut short or its counts are wrong"
POLYGONS = "each ended by a negative corner, not {}; correct the header or the corners"
COUNTS = "the header must count parts from 0, and nodes, polygons and corners from 1"
RANGE = "part 2 must have polygons of 1 to 6, in order, which no other part has"
CORNER = "a corner must be a node number of 1 to 8, or minus one"

test_what_is_refused = refused(
    "cube.byu",
    [
        (swapped(FREE, old, new), f"cube.byu{sentence}")
        for old, new, sentence in (
            ("2 8 6", "2 0 6", f", line 1: {COUNTS}, not '2'; correct it"),
            ("2 8 6", "-1 8 6", f", line 1: {COUNTS}, not '-1'; correct it"),
            ("6 24", "25 24", f": there must be 25 polygons, {POLYGONS.format(6)}"),
            ("8 -6", "8 6", f": there must be 6 polygons, {POLYGONS.format(5)}"),
            ("4 8 -6", "", f": there must be 56 numbers to the end of the connectivity, not 53; {CUT}"),
            *(
                ("1 5 6 6", f"1 5 {wrong}", f", line 2: {RANGE}, not '{wrong[0]}'; correct it")
                for wrong in ("6 7", "0 0", "6 5", "5 6")
            ),
            *(
                ("1 3 4 -2", f"1 3 {corner} -2", f", line 5: {CORNER}, not '{corner}'; correct it")
                for corner in (9, 0)
            ),
        )
    ],
)
