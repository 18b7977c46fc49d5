"""The formats that trimesh and meshio read for us, of the extra `meshes`.

- glTF (.glb, .gltf) and 3MF: trimesh. glTF is y up by its specification: it is turned so unless it is read
  with x up, so that such a file stands as it does elsewhere. 3MF is z up. Neither is scaled: glTF is in
  meters, 3MF in its own unit.
- VTU, Abaqus (.inp), Gmsh (.msh), Nastran (.bdf, .nas, .fem), Medit (.mesh), SU2 and binary UGRID (as in
  .b8.ugrid): meshio, of which these formats need no further package.
"""

from __future__ import annotations

import dataclasses
import importlib.util
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Final

from autocolor.checks import Color, listed
from autocolor.errors import UnavailableError
from autocolor.files.meshes.foreign.named_files import size_of_3mf, size_of_file, size_of_gltf
from autocolor.files.meshes.foreign.own_process import WORKER, limits_for, read_in_own_process
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport
from autocolor.scene.columns.rows import changed
from autocolor.scene.defaults import COLORED_PAINT, created_surface
from autocolor.scene.surfaces import Surface


@dataclasses.dataclass(frozen=True)
class ForeignFormat:
    """A format: its name, suffixes, the library and its word for it, and the packages that it needs.

    `size_of` is the number of bytes to read, after what the file names was checked; `up` the file's up axis.
    """

    name: str
    suffixes: tuple[str, ...]
    library: str
    kind: str
    packages: tuple[str, ...]
    size_of: Callable[[Path], int] = size_of_file
    up: str = "z"


FOREIGN: Final = (
    ForeignFormat("glTF", (".glb",), "trimesh", "glb", ("trimesh", "networkx"), size_of_gltf, "y"),
    ForeignFormat("glTF text", (".gltf",), "trimesh", "gltf", ("trimesh", "networkx"), size_of_gltf, "y"),
    ForeignFormat("3MF", (".3mf",), "trimesh", "3mf", ("trimesh", "networkx", "lxml"), size_of_3mf),
    ForeignFormat("VTU", (".vtu",), "meshio", "vtu", ("meshio",)),
    ForeignFormat("Abaqus", (".inp",), "meshio", "abaqus", ("meshio",)),
    ForeignFormat("Gmsh", (".msh",), "meshio", "gmsh", ("meshio",)),
    ForeignFormat("Nastran", (".bdf", ".nas", ".fem"), "meshio", "nastran", ("meshio",)),
    ForeignFormat("Medit", (".mesh",), "meshio", "medit", ("meshio",)),
    ForeignFormat("SU2", (".su2",), "meshio", "su2", ("meshio",)),
    ForeignFormat("UGRID", (".ugrid",), "meshio", "ugrid", ("meshio",)),
)


def read_foreign(
    read_as: ForeignFormat, path: Path, placement: Placement = PLAIN, *, command: Sequence[str] = WORKER
) -> MeshReport:
    """The mesh of a file, which a library reads in its own process, and what was left out or repaired.

    Raises InputError, and UnavailableError if a package is missing.
    """
    missing = [name for name in read_as.packages if importlib.util.find_spec(name) is None]
    size = read_as.size_of(path)
    if missing:
        raise UnavailableError(
            f"{path.name}: to read {read_as.suffixes[0]} files, the package {listed(missing)} must be"
            ' installed; run: pip install "autocolor[meshes]"'
        )
    found = read_in_own_process(read_as.library, read_as.kind, path, limits_for(size), command)
    if placement.up == "z":
        placement = dataclasses.replace(placement, up=read_as.up)
    report = repaired(found.polygons, path.name, placement, skipped=found.sentences)
    materials = dict.fromkeys(found.material_of_part.values())
    return dataclasses.replace(
        report,
        material_of_part=dict(found.material_of_part),
        materials=tuple(_surface(name, found.colors[name]) for name in materials if name in found.colors),
    )


def _surface(name: str, color: Color) -> Surface:
    """The surface of a material, of which the base color is known."""
    return changed(created_surface(name, COLORED_PAINT.object_color), {"object_color": color})


for _each in FOREIGN:
    register(MeshFormat(_each.name, partial(read_foreign, _each), _each.suffixes))
