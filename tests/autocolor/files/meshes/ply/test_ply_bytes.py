from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.meshes.ply import ply_bytes as ply_bytes_module
from autocolor.files.meshes.ply.ply_bytes import ply_bytes
from autocolor.files.meshes.ply.ply_file import read_ply
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import MeshScalar

COORDINATES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.1, 1 / 3, 1e-300], [7, 8, 9]])
POLYGONS = ([0, 1, 2, 3], [0, 1, 2, 2], [1, 2, 4, 4], [2, 3, 4, 1])
names = st.text(st.characters(categories=("L", "N", "P")), min_size=1, max_size=12)


@st.composite
def meshes(draw: st.DrawFn) -> Mesh:
    polygons = draw(st.lists(st.sampled_from(POLYGONS), min_size=1, max_size=8))
    part_names = draw(st.lists(names, min_size=1, max_size=4, unique=True))
    parts = draw(
        st.lists(st.integers(0, len(part_names) - 1), min_size=len(polygons), max_size=len(polygons))
    )
    scalars = []
    special = st.sampled_from(["x", "red", "part", "value_0", "von Mises", "stress", "vertex_indices"])
    for name in draw(st.lists(names | special, max_size=4, unique=True)):
        of = draw(st.sampled_from(["node", "polygon"]))
        count = len(COORDINATES) if of == "node" else len(polygons)
        number = st.floats(-1e30, 1e30) | st.just(np.nan)
        scalars.append(MeshScalar(name, np.array(draw(st.lists(number, min_size=count, max_size=count))), of))
    return Mesh(COORDINATES, np.array(polygons), np.array(parts), tuple(part_names), scalars=tuple(scalars))


@given(mesh=meshes(), at_once=st.sampled_from([1, 3, 1 << 16]))
def test_what_is_written_reads_back_equal(
    mesh: Mesh, at_once: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / "written.ply"
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(ply_bytes_module, "ROWS_AT_ONCE", at_once)
        path.write_bytes(ply_bytes(mesh))
    report = read_ply(path)
    assert report.repairs == ()
    read = report.mesh
    for name in ("coordinates", "node_numbers", "part_numbers"):
        assert np.array_equal(getattr(read, name), getattr(mesh, name))
    assert read.part_names == mesh.part_names
    found = {each.name: each for each in read.scalars}
    assert set(found) == {each.name for each in mesh.scalars}
    for each in mesh.scalars:
        assert found[each.name].of == each.of
        assert np.array_equal(found[each.name].values, each.values, equal_nan=True)


def test_a_mesh_of_one_part_is_written_as_other_programs_do(tmp_path: Path) -> None:
    mesh = Mesh(COORDINATES[:3], np.array([[0, 1, 2]]), part_names=("hood\n",))
    header, _, data = ply_bytes(mesh).partition(b"end_header\n")
    assert header.decode().splitlines() == [
        "ply",
        "format binary_little_endian 1.0",
        "comment written by autocolor",
        "comment part 0 hood?",
        "element vertex 3",
        "property double x",
        "property double y",
        "property double z",
        "element face 1",
        "property list uchar int vertex_indices",
    ]
    assert data == COORDINATES[:3].astype("<f8").tobytes() + b"\3" + np.array([0, 1, 2], "<i4").tobytes()
