"""3MF files, which are written by hand: a cube, placed and painted in every way."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest

from autocolor.files.formats import read_mesh
from tests.autocolor.files.foreign.conftest import CUBE, SIDES
from tests.autocolor.files.refusals import refusal

pytestmark = [pytest.mark.needs("lib3mf"), pytest.mark.usefixtures("shared")]

SCHEMAS = "http://schemas.microsoft.com/3dmanufacturing"
SPACES = {"": "core/2015/02", ":p": "production/2015/06", ":m": "material/2015/02",
          ":b": "beamlattice/2017/02", ":s": "slice/2015/07"}  # fmt: skip
XMLNS = " ".join(f'xmlns{prefix}="{SCHEMAS}/{name}"' for prefix, name in SPACES.items())
RELATIONS = "http://schemas.openxmlformats.org/package/2006"
TYPES = (
    f'<Types xmlns="{RELATIONS}/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
    "</Types>"
)

TRIANGLES = [piece for a, b, c, d in SIDES for piece in ((a, b, c), (a, c, d))]


def cube(size: float = 1, painted: str = "", others: str = "") -> str:
    """A mesh; the first six triangles have the attributes `painted`."""
    vertices = "".join(f'<vertex x="{size * x}" y="{size * y}" z="{size * z}"/>' for x, y, z in CUBE)
    rows = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}" {painted if number < 6 else ""}/>'
        for number, (a, b, c) in enumerate(TRIANGLES)
    )
    return f"<mesh><vertices>{vertices}</vertices><triangles>{rows}</triangles>{others}</mesh>"


def part(number: int, content: str, attributes: str = 'name="cube"') -> str:
    return f'<object id="{number}" {attributes}>{content}</object>'


def model(resources: str, build: str = '<item objectid="1"/>', required: str = "") -> str:
    needs = f'requiredextensions="{required}"' if required else ""
    return (
        f'<?xml version="1.0"?><model unit="inch" {XMLNS} {needs}><resources>{resources}</resources>'
        f"<build>{build}</build></model>"
    )


def written(folder: Path, root: str, **others: str) -> Path:
    """A file with a model and the model files named by `others`."""
    path = folder / "a.3mf"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("[Content_Types].xml", TYPES)
        for place, targets in (("_rels/", ["3dmodel"]), ("3D/_rels/3dmodel.model", others)):
            rows = "".join(
                f'<Relationship Target="/3D/{each}.model" Id="{each}" Type="{SCHEMAS}/2013/01/3dmodel"/>'
                for each in targets
            )
            text = f'<Relationships xmlns="{RELATIONS}/relationships">{rows}</Relationships>'
            archive.writestr(f"{place}.rels", text)
        for name, text in {"3dmodel": root, **others}.items():
            archive.writestr(f"3D/{name}.model", text)
    return path


def moved(x: float, y: float = 0, axes: str = "1 0 0 0 1 0 0 0 1") -> str:
    return f'transform="{axes} {x} {y} 0"'


QUARTER = "0 1 0 -1 0 0 0 0 1"
"""A quarter turn about z, which takes x to y."""

MIRRORED = "-1 0 0 0 1 0 0 0 1"


def test_components_are_parts_placed_by_all_transforms_above_them(tmp_path: Path) -> None:
    pair = f'<components><component objectid="1"/><component objectid="1" {moved(10)}/></components>'
    items = f'<item objectid="2" {moved(3, 0, QUARTER)}/><item objectid="1" {moved(0, 0, MIRRORED)}/>'
    path = written(tmp_path, model(part(1, cube()) + part(2, pair, 'name="pair"'), items))
    mesh = read_mesh({"file": path}).mesh
    assert mesh.part_names == read_mesh({"file": path}).mesh.part_names == ("cube", "cube 2", "cube 3")
    corners = mesh.coordinates.reshape(3, 8, 3)
    assert corners.min(axis=1).tolist() == [[2, 0, 0], [2, 10, 0], [-1, 0, 0]]
    assert corners.max(axis=1).tolist() == [[3, 1, 1], [3, 11, 1], [0, 1, 1]]
    # A mirrored mesh faces outward, too: each triangle has a positive volume with the center.
    a, b, c, _ = mesh.coordinates[mesh.node_numbers.T] - corners.mean(axis=1)[mesh.part_numbers]
    assert (np.einsum("ij,ij->i", a, np.cross(b, c)) > 0).all()


def test_objects_of_model_files_with_equal_numbers_are_different(tmp_path: Path) -> None:
    components = (
        '<components><component p:path="/3D/a.model" objectid="1"/>'
        f'<component p:path="/3D/b.model" objectid="1" {moved(10)}/></components>'
    )
    small, large = (model(part(1, cube(size), ""), "", "p") for size in (1, 3))
    path = written(tmp_path, model(part(1, components, ""), required="p"), a=small, b=large)
    mesh = read_mesh({"file": path}).mesh
    assert mesh.part_names == ("a", "a 2")
    assert mesh.coordinates.max(axis=0).tolist() == [13, 3, 3]


PAINTS = (
    '<basematerials id="5"><base name="red" displaycolor="#FF0000"/>'
    '<base name="blue" displaycolor="#0000FF80"/><base name="red" displaycolor="#880000"/></basematerials>'
    '<m:colorgroup id="6"><m:color color="#00FF00"/><m:color color="#FFFF00"/><m:color color="#00FF00"/>'
    "</m:colorgroup>"
    '<m:compositematerials id="7" matid="5" matindices="0 1"><m:composite values="0.5 0.5"/>'
    "</m:compositematerials>"
)
MIXED = "a.3mf: left out textures and mixed colors of triangles"


@pytest.mark.parametrize(
    ("attributes", "painted", "materials", "sentences"),
    [
        ('pid="5" pindex="1"', "", {"cube": ("blue", (0, 0, 255))}, ()),
        ('pid="5" pindex="0"', 'pid="5" p1="2"',
         {"cube red": ("red", (255, 0, 0)), "cube red #880000": ("red #880000", (136, 0, 0))}, ()),
        ("", 'pid="6" p1="1"', {"cube": None, "cube #ffff00": ("#ffff00", (255, 255, 0))}, ()),
        ('pid="6" pindex="0"', 'pid="6" p1="0" p2="1" p3="1"', {"cube": ("#00ff00", (0, 255, 0))},
         (f"{MIXED}: 6",)),
        ('pid="7" pindex="0"', "", {"cube": None}, (f"{MIXED}: 12",)),
    ],
)  # fmt: skip
def test_materials_and_colors_are_surfaces(
    tmp_path: Path,
    attributes: str,
    painted: str,
    materials: dict[str, tuple[str, tuple[int, int, int]] | None],
    sentences: tuple[str, ...],
) -> None:
    root = model(PAINTS + part(1, cube(1, painted), f'name="cube" {attributes}'))
    report = read_mesh({"file": written(tmp_path, root)})
    colors = {surface.name: surface.paint.object_color for surface in report.materials}
    found = {name: report.material_of_part.get(name) for name in report.mesh.part_names}
    assert {name: material and (material, colors[material]) for name, material in found.items()} == materials
    assert report.repairs == sentences


STACK = (
    '<s:slicestack id="8"><s:slice ztop="1"><s:vertices><s:vertex x="0" y="0"/><s:vertex x="1" y="0"/>'
    '<s:vertex x="1" y="1"/></s:vertices><s:polygon startv="0"><s:segment v2="1"/><s:segment v2="2"/>'
    '<s:segment v2="0"/></s:polygon></s:slice></s:slicestack>'
)


def test_supports_are_left_out_and_slices_of_whole_meshes_are_not_needed(tmp_path: Path) -> None:
    parts = part(1, cube(), 's:slicestackid="8"') + part(2, cube(2), 'type="support"')
    items = '<item objectid="1"/><item objectid="2"/>'
    report = read_mesh({"file": written(tmp_path, model(STACK + parts, items, "s"))})
    assert (report.mesh.part_names, len(report.mesh.node_numbers)) == (("a",), 12)
    assert report.repairs == ("a.3mf: left out objects of the type support: 1",)


BEAMS = '<b:beamlattice radius="1" minlength="0.1"><b:beams><b:beam v1="0" v2="7"/></b:beams></b:beamlattice>'
LOW = 'name="cube" s:slicestackid="8" s:meshresolution="lowres"'
NONE = "the build must have an object with triangles, not none"
CANNOT = "lib3mf must be able to read it, and cannot"


@pytest.mark.parametrize(
    ("root", "reason"),
    [
        (model(part(1, cube(others=BEAMS)), required="b"),
         "object 'cube' must have triangles only, not a beam lattice"),
        (model(STACK + part(1, cube(), LOW), required="s"),
         "object 'cube' must have triangles of full detail, not slices"),
        (model(part(1, cube()), ""), f"{NONE} (the build is empty)"),
        (model(part(1, cube(), 'type="other"')), f"{NONE} (left out objects of the type other: 1)"),
        (model(part(1, cube()), required="q").replace("<model", '<model xmlns:q="http://unknown"'),
         f"{CANNOT} (A required extension is not supported)"),
        (model(part(1, cube(others="<unknown/>"))), f"{CANNOT} (Invalid Element in namespace.)"),
        (model(part(1, cube()))[:-80], f"{CANNOT} (No build section in model file)"),
    ],
)  # fmt: skip
def test_what_cannot_be_shown_is_refused_with_its_reason(tmp_path: Path, root: str, reason: str) -> None:
    sentence = refusal(read_mesh, {"file": written(tmp_path, root)})
    assert sentence == f"a.3mf: {reason}; correct the file, or write it as OBJ or PLY"
