from __future__ import annotations

import dataclasses
import io
import json
import tempfile
import tracemalloc
import zipfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    InputError,
    Light,
    Mesh,
    Part,
    Scene,
    UsageError,
    read_picture,
    render,
    scene_of,
    write_picture,
)
from autocolor.checks import shown
from autocolor.errors import OutputError
from autocolor.files.array_file import array_file_bytes, read_array_file
from autocolor.files.picture_file import PICTURE_FILE, SavedPicture
from autocolor.images import display_image
from autocolor.lighting.picture import Picture
from autocolor.scene.columns import keys_of
from autocolor.scene.scalar import MeshScalar
from autocolor.scene.surfaces import Paint, Reflectance, Surface
from tests.autocolor.linked_scenes import linked_scenes
from tests.small import grid, wall, wall_scene
from tests.tables import refused

LINES, ELEMENTS = 9, 12
ARRAYS = ("coordinates", "node_numbers", "part_numbers")

Header = dict[str, Any]


def lit_wall() -> Scene:
    """A wall with every kind of field that a file must keep."""
    lights = (
        Light("key", (1, -3, 2), aim=(0, 0, 0), concentration=3, cone_angle=50),
        Light("fill", (-2, -3, 1), intensity=0.25, flaps=Flaps(z=Flap(-0.5), x=Flap(maximum=1, on=False))),
        Light("off", (0, -1, 0), on=False, direction=(0, 1, 0)),
    )
    return wall_scene(ambient=0.125, lights=lights, mapping=((0, 0.1), (0.5, 0.9), (1, 1)), name="lit wall")


def in_color() -> Scene:
    """A wall with scalars of both kinds, some of their values missing, one of them shown."""
    mesh = wall(3, 2).with_scalars(
        MeshScalar("stress", np.array([np.nan, *range(11)])),
        MeshScalar("load", np.linspace(-1, 1, 6), "polygon"),
        MeshScalar("\udcff", np.full(6, np.nan), "polygon"),
    )
    # The name of a file that is no UTF-8 holds halves of code points.
    return wall_scene(mesh, name="купе \udcff", scalar={"name": "stress", "limits": (0, 5), "bands": 4})


def panels() -> Scene:
    """Two walls side by side, of one surface, and a part and a surface without polygons."""
    mesh = Mesh.joined([grid(1, 1, (x, 0, 0), (1, 0, 0), (0, 0, 1), name) for x, name in enumerate("ab")])
    mesh = dataclasses.replace(mesh, part_names=("a", "b", "none"))
    surfaces = {"a": "wall", "b": "wall", "none": "none"}
    return scene_of(mesh, surfaces=[Surface("wall"), Surface("none")], surface_of_part=surfaces)


@cache
def content(make: Callable[[], Scene]) -> bytes:
    """The bytes of the picture file of a scene."""
    scene = make()
    return bytes_of(scene, render(scene, LINES, ELEMENTS))


def bytes_of(scene: Scene, picture: Picture) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "made.npz")
        write_picture(path, scene, picture)
        return path.read_bytes()


def read(data: bytes) -> SavedPicture:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "changed.npz")
        path.write_bytes(data)
        return read_picture(path)


def members_of(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def zipped(members: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def with_array(whole: bytes, name: str, array: npt.NDArray[Any]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return zipped({**members_of(whole), f"{name}.npy": buffer.getvalue()})


def header_of(whole: bytes) -> Header:
    header: Header = json.loads(np.load(io.BytesIO(members_of(whole)["header.npy"])).tobytes())
    return header


def with_header(whole: bytes, header: bytes) -> bytes:
    return with_array(whole, "header", np.frombuffer(header, np.uint8))


def edited(whole: bytes, path: str, value: object) -> bytes:
    """The file with another value at a path of its header; without a value if it is None."""
    header: Any = header_of(whole)
    *keys, last = path.split(".")
    table = header
    for key in keys:
        table = table[key]
    table[last] = value
    if value is None:
        del table[last]
    return with_header(whole, json.dumps(header).encode())


def is_equal(one: Scene, other: Scene) -> bool:
    names = [field.name for field in dataclasses.fields(Scene) if field.name != "mesh"]
    return (
        all(getattr(one, name) == getattr(other, name) for name in names)
        and (one.mesh.part_names, one.mesh.crease_angle) == (other.mesh.part_names, other.mesh.crease_angle)
        and all(np.array_equal(getattr(one.mesh, name), getattr(other.mesh, name)) for name in ARRAYS)
        and [(scalar.name, scalar.of, scalar.values.tobytes()) for scalar in one.mesh.scalars]
        == [(scalar.name, scalar.of, scalar.values.tobytes()) for scalar in other.mesh.scalars]
    )


@given(scene=linked_scenes(), smooth=st.sampled_from([1, np.int64(3)]))
def test_every_scene_that_renders_comes_back_with_its_picture_and_is_written_the_same(
    scene: Scene, smooth: int
) -> None:
    try:
        picture = render(scene, LINES // smooth, ELEMENTS // smooth, smooth=smooth)
        now = display_image(scene, picture)
    except InputError:
        return
    data = bytes_of(scene, picture)
    again = read(data)
    assert is_equal(again.scene, scene)
    assert bytes_of(again.scene, again.picture) == data
    for name in ("intensity", "surface_number", "part_number", "scalar"):
        one, other = getattr(again.picture, name), getattr(picture, name)
        assert (one is None) is (other is None)
        assert one is None or one.tobytes() == other.tobytes()
    for name in ("parts", "surfaces", "ranges", "scalar_limits", "smooth"):
        assert getattr(again.picture, name) == getattr(picture, name)
    then = display_image(again.scene, again.picture)
    assert (then.words == now.words).all()
    assert (then.entries == now.entries).all()


def test_numpy_can_open_a_picture_file() -> None:
    picture, scene = read(content(in_color))
    assert is_equal(scene, in_color())
    with np.load(io.BytesIO(content(in_color))) as arrays:
        scale = json.loads(arrays["header"].tobytes())["scale"]
        assert (arrays["relative_intensity"] * np.float32(scale) == picture.intensity).all()
        assert (arrays["surface_number"] == picture.surface_number).all()
        assert (arrays["part_number"] == picture.part_number).all()
        assert (arrays["coordinates"] == scene.mesh.coordinates).all()
        assert arrays["mesh_scalar_1"].tolist() == np.linspace(-1, 1, 6).tolist()


def test_an_existing_file_is_kept_unless_it_may_be_overwritten(tmp_path: Path) -> None:
    path, (picture, scene) = tmp_path / "wall.npz", read(content(lit_wall))
    path.write_bytes(b"mine")
    with pytest.raises(OutputError):
        write_picture(path, scene, picture)
    guarded: list[bytes] = []
    guard = lambda _: lambda: guarded.append(path.read_bytes())  # noqa: E731
    write_picture(path, scene, picture, overwrite=True, guard=guard)
    assert (guarded, path.read_bytes()) == ([b"mine"], content(lit_wall))


ALONE = "a picture and its scene must both have a scalar or neither, not one alone; render the scene"
PAINTED = {"surfaces": [Surface("paint")], "parts": [Part("wall", "paint")]}


@pytest.mark.parametrize(
    ("make", "name", "changes", "sentence"),
    [
        (lit_wall, "wall.png", {}, "a picture with its scene must be written to a file that ends in .npz"),
        (lit_wall, "wall.npz", {"scalar": {"name": "z"}}, ALONE),
        (in_color, "wall.npz", {"scalar": None}, ALONE),
        (lit_wall, "wall.npz", PAINTED, r"must be those of the scene, \['paint'\], not"),
    ],
)
def test_a_picture_that_is_not_of_the_scene_or_has_another_suffix_is_not_written(
    tmp_path: Path, make: Callable[[], Scene], name: str, changes: Header, sentence: str
) -> None:
    picture, scene = read(content(make))
    with pytest.raises((InputError, UsageError), match=sentence):
        write_picture(tmp_path / name, scene.replace(**changes), picture)
    assert list(tmp_path.iterdir()) == []


NESTED = (("reflectance", Reflectance), ("paint", Paint))


def nested(values: Header) -> Header:
    """A scene as the first picture files had it: reflectance and paint as tables of a surface."""
    rows = []
    for surface in values["surfaces"]:
        # Phong's model was the only one, and had no name.
        row = {key: value for key, value in surface.items() if key != "model"}
        for table, cls in NESTED:
            row[table] = {key: row.pop(key) for key in list(row) if key in keys_of(cls)}
        rows.append(row)
    return {**values, "surfaces": rows}


@pytest.mark.parametrize("version", [1, 2, 3])
def test_a_picture_file_of_an_older_format_is_still_read(tmp_path: Path, version: int) -> None:
    picture, scene = read(content(lit_wall))
    (tmp_path / "new.npz").write_bytes(content(lit_wall))
    header, arrays = read_array_file(PICTURE_FILE, tmp_path / "new.npz")
    series = [key for key in PICTURE_FILE.series if key in header] if version == 3 else ()
    header = {key: header[key] for key in (*PICTURE_FILE.keys, *series)}
    del arrays["part_number"]
    if version == 1:
        header["scene"] = nested(header["scene"])
    older = dataclasses.replace(
        PICTURE_FILE,
        formats=(f"autocolor picture {version}",),
        arrays={name: PICTURE_FILE.arrays[name] for name in arrays},
    )
    again = read(array_file_bytes(older, header, arrays))
    assert is_equal(again.scene, scene)
    assert (again.picture.intensity == picture.intensity).all()
    assert (again.picture.surface_number == picture.surface_number).all()
    # It does not know its parts, also once it is written again.
    for each in (again, read(bytes_of(again.scene, again.picture))):
        assert each.picture.parts == ()
        assert each.picture.part_number.shape == (LINES, ELEMENTS)
        assert not each.picture.part_number.any()


# Damaged files.


@given(data=st.data(), in_members=st.booleans())
def test_changed_bytes_are_refused_or_give_a_picture_that_can_be_shown(
    data: st.DataObject, in_members: bool
) -> None:
    whole = content(lit_wall)
    members = members_of(whole)
    name = data.draw(st.sampled_from(sorted(members)))
    changed = bytearray(members[name] if in_members else whole)
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(changed)))
        length = data.draw(st.sampled_from([0, 1, 1, 100]))
        changed[place : place + length] = data.draw(st.binary(max_size=40))
    with suppress(InputError):
        # Members have right checksums.
        picture, scene = read(zipped({**members, name: bytes(changed)}) if in_members else bytes(changed))
        display_image(scene, picture)


SMOOTH = ": smooth must be a whole number that divides its lines and elements, (9, 12), not"
LIMITS = ": shown_scalars[1].limits must be two finite numbers, the second above the first, not"

test_a_header_that_breaks_a_rule_is_refused = refused(
    lambda place: read(edited(content(place[0]), *place[1:])),
    [
        ((make, key, value), f"changed.npz{sentence}; save the picture again")
        for make, key, value, sentence in (
            (
                in_color,
                "scene.scalar",
                None,
                ": there must be a scalar at the pixels if the scene shows one, and none if it does not, not"
                " 1",
            ),
            *((lit_wall, "smooth", value, f"{SMOOTH} {shown(value)}") for value in (0, -3, 2, 3.0, True)),
            *(
                (lit_wall, "scale", value, f": its scale must be a number above 0, not {shown(value)}")
                for value in (0, -1.5, True, "1", 3.5e38)
            ),
            (lit_wall, "scale", 3.3e38, ": every intensity must be a number from 0 to 3.4e+38"),
            (lit_wall, "surfaces", ["a"], ": its surfaces must be the scene's, ['wall'], not ['a']"),
            *(
                (lit_wall, "scene", value, f": scene: it must be tables, its mesh among them, not {value}")
                for value in cast("tuple[object, ...]", ([], {"mesh": []}))
            ),
            (lit_wall, "scene.lights", None, ": lights must be a list of Light rows, not missing; add it"),
            (
                lit_wall,
                "scene.mesh.crease_angle",
                None,
                ": mesh: crease_angle must be a number from 0 to 180, not nan",
            ),
            *(
                (in_color, "shown_scalars", [row], f"{LIMITS} {shown(told)}")
                for row, told in (
                    ({"limits": [0, 1e300]}, [0, 1e300]),
                    ({"limits": [0, 1], "more": 3}, {"limits": [0, 1], "more": 3}),
                    (3, 3),
                )
            ),
        )
    ],
)


RASTER = (LINES, ELEMENTS)
OF_TYPE = " dimensions, not "
FINITE = "every intensity must be a number from 0 to 3.4e+38"
ONE_SHAPE = "its arrays must be of one shape, not"


@pytest.mark.parametrize(
    ("make", "name", "array", "sentence"),
    [
        (lit_wall, "relative_intensity", np.zeros(RASTER), OF_TYPE),
        (lit_wall, "relative_intensity", np.zeros((ELEMENTS, LINES), np.float32), ONE_SHAPE),
        (lit_wall, "relative_intensity", np.full(RASTER, np.nan, np.float32), FINITE),
        (lit_wall, "relative_intensity", np.full(RASTER, -1, np.float32), FINITE),
        (lit_wall, "surface_number", np.full(RASTER, 2, np.uint8), "with polygons, not 2"),
        (panels, "surface_number", np.full(RASTER, 2, np.uint8), "with polygons, not 2"),
        (lit_wall, "part_number", np.ones((ELEMENTS, LINES), np.int32), ONE_SHAPE),
        (lit_wall, "node_numbers", np.array([[0, 1, 2, 4]], np.int32), "of the node table (0 to 3)"),
        (in_color, "mesh_scalar_0", np.zeros(11), "one value a node"),
        (in_color, "scalar_0", np.zeros((ELEMENTS, LINES), np.float32), "at each of (9, 12) pixels"),
        (in_color, "scalar_0", np.full(RASTER, np.inf, np.float32), "at each of (9, 12) pixels"),
    ],
)
def test_a_wrong_array_is_refused(
    make: Callable[[], Scene], name: str, array: npt.NDArray[Any], sentence: str
) -> None:
    with pytest.raises(InputError) as caught:
        read(with_array(content(make), name, array))
    assert str(caught.value).startswith("changed.npz")
    assert sentence in str(caught.value)


@pytest.mark.parametrize(("at", "number"), [(1, 4), (1, -1), (1, 0), (1, 3), (0, 1), (0, 3)])
def test_part_numbers_that_break_a_rule_are_refused_in_a_sentence(at: int, number: int) -> None:
    whole = content(panels)
    numbers = read(whole).picture.part_number.copy()
    line, element = np.argwhere(numbers == at)[0].tolist()
    numbers[line, element] = number
    with pytest.raises(InputError) as caught:
        read(with_array(whole, "part_number", numbers))
    assert str(caught.value) == (
        "changed.npz: a part number must be that of a part of the surface there, not"
        f" {number} (line {line}, element {element}); save the picture again"
    )


def described(text: str, data: bytes = b"") -> bytes:
    """An array file with any description."""
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + data


SHAPE = "{{'descr': '<f4', 'fortran_order': False, 'shape': {}, }}\n"


@pytest.mark.parametrize(
    "data",
    [
        b"\x93NUMPY\x02\x00" + b"\0" * 100,
        b"\x93NUMPY\x01\x00\xff\xff",
        *(described(SHAPE.format(shape)) for shape in ("(99999999999, 99999999999)", "(-1, 4)")),
        described("{'descr': '|O', 'fortran_order': False, 'shape': (1, 1), }\n", b"\x80\x04N."),
        described("__import__('os')\n"),
        described("(" * 1000),
    ],
)
def test_an_array_of_another_description_is_refused_before_memory_is_taken(data: bytes) -> None:
    members = {**members_of(content(lit_wall)), "relative_intensity.npy": data}
    tracemalloc.start()
    with pytest.raises(InputError, match=r"^changed\.npz: .*; save the picture again$"):
        read(zipped(members))
    assert tracemalloc.get_traced_memory()[1] < 4_000_000
    tracemalloc.stop()


def test_a_file_that_is_cut_short_or_has_other_members_is_refused() -> None:
    whole = content(lit_wall)
    members = members_of(whole)
    for data in (
        *(whole[:length] for length in range(0, len(whole), 97)),
        zipped({name: data for name, data in members.items() if name != "header.npy"}),
        zipped({**members, "../header.npy": b""}),
        zipped({"x" * 60_000: b""}),
        *(with_header(whole, text) for text in (b"{", b"null", b" " * ((16 << 20) + 1))),
    ):
        with pytest.raises(InputError, match=r"^changed\.npz: a picture file must be whole") as caught:
            read(data)
        assert len(str(caught.value)) < 400
