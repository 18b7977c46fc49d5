"""Meshes that formats with parts and scalars hold whole, and what is equal once they are read again."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from autocolor.files.meshes.repair import MeshReport
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MeshScalar

COORDINATES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.1, 1 / 3, 1e-300], [7, 8, 9]])
POLYGONS = ([0, 1, 2, 3], [0, 1, 2, 2], [1, 2, 4, 4], [2, 3, 4, 1])
WITH_ALL_NODES = [[0, 1, 2, 3], [3, 4, 5, 5]]
NAMES = st.text(st.characters(exclude_categories=("C", "Z")), min_size=1, max_size=12).flatmap(
    # A backslash at the end of a line continues it in some formats.
    lambda name: st.sampled_from([name, f"{name}\\"])
)
WITH_MEANING = st.sampled_from(
    [
        *("x", "X", "red", "part", "value_0", "von Mises", "vertex_indices"),
        *("node5", "scalar", "scalar x", "nodes"),
    ]
)
"""Names that columns or properties of a mesh have, or nearly so."""


@st.composite
def writable_meshes(draw: st.DrawFn) -> Mesh:
    """Meshes without repairs, all of whose parts have polygons, in the order of these."""
    polygons = [*draw(st.lists(st.sampled_from(POLYGONS), max_size=8)), *WITH_ALL_NODES]
    part_names = draw(st.lists(NAMES, min_size=4, max_size=4, unique=True))
    parts = draw(st.lists(st.integers(0, 3), min_size=len(polygons), max_size=len(polygons)))
    used, part_numbers = np.unique(np.sort(parts), return_inverse=True)
    scalars = []
    for name in draw(st.lists(NAMES | WITH_MEANING, max_size=4, unique=True)):
        of = draw(st.sampled_from(["node", "polygon"]))
        count = len(COORDINATES) if of == "node" else len(polygons)
        number = st.floats(-1e30, 1e30) | st.just(np.nan)
        scalars.append(MeshScalar(name, np.array(draw(st.lists(number, min_size=count, max_size=count))), of))
    names = tuple(part_names[: len(used)])
    return Mesh(COORDINATES, np.array(polygons), part_numbers, names, scalars=tuple(scalars))


def assert_equal(report: MeshReport, mesh: Mesh) -> None:
    """What was read is the mesh, with its scalars in any order, and nothing was repaired."""
    assert report.repairs == ()
    for name in ("coordinates", "node_numbers", "part_numbers"):
        assert np.array_equal(getattr(report.mesh, name), getattr(mesh, name))
    assert report.mesh.part_names == mesh.part_names
    found = {each.name: each for each in report.mesh.scalars}
    assert set(found) == {each.name for each in mesh.scalars}
    for each in mesh.scalars:
        assert found[each.name].of == each.of
        assert np.array_equal(found[each.name].values, each.values, equal_nan=True)
