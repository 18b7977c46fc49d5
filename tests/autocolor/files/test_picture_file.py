from __future__ import annotations

import copy
import dataclasses
import errno
import io
import json
import math
import os
import tracemalloc
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

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
    Scene,
    UsageError,
    image,
    read_picture,
    read_scene,
    render,
    scene_of,
    write_picture,
)
from autocolor.checks import shown
from autocolor.errors import MissingInputError, OutputError, WriteError
from autocolor.files.array_file import array_file_bytes, read_array_file
from autocolor.files.picture_file import PICTURE_FILE, SavedPicture, plain_scene, scene_of_plain
from autocolor.images import display_image
from autocolor.scene.columns import keys_of
from autocolor.scene.scalar import MeshScalar
from autocolor.scene.surfaces import Paint, Reflectance, Surface
from tests.autocolor.linked_scenes import linked_scenes
from tests.small import cube, grid, wall, wall_scene

LINES, ELEMENTS = 9, 12


def lit_wall() -> Scene:
    """A wall with every kind of field that a file must keep."""
    lights = (
        Light("key", (1, -3, 2), aim=(0, 0, 0), concentration=3, cone_angle=50),
        Light("fill", (-2, -3, 1), intensity=0.25, flaps=Flaps(z=Flap(-0.5), x=Flap(maximum=1, on=False))),
        Light("off", (0, -1, 0), on=False, direction=(0, 1, 0)),
    )
    return wall_scene(ambient=0.125, lights=lights, mapping=((0, 0.1), (0.5, 0.9), (1, 1)), name="lit wall")


def saved(path: Path, scene: Scene, lines: int = LINES, elements: int = ELEMENTS) -> SavedPicture:
    """A scene's picture, written and read again."""
    write_picture(path, scene, render(scene, lines, elements))
    return read_picture(path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The bytes of a small picture file."""
    path = tmp_path_factory.mktemp("pictures") / "wall.npz"
    saved(path, lit_wall())
    return path.read_bytes()


def read_bytes(data: bytes, folder: Path) -> SavedPicture:
    path = folder / "changed.npz"
    path.write_bytes(data)
    return read_picture(path)


def members_of(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def zipped(members: dict[str, bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", compression) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def in_color() -> Scene:
    """A wall with scalars of both kinds, some of their values missing, one of them shown."""
    mesh = wall(3, 2).with_scalars(
        MeshScalar("stress", np.array([np.nan, *range(11)])),
        MeshScalar("load", np.linspace(-1, 1, 6), "polygon"),
        MeshScalar("\udcff", np.full(6, np.nan), "polygon"),
    )
    return wall_scene(mesh, scalar={"name": "stress", "limits": (0, 5), "bands": 4})


@pytest.fixture(scope="module")
def colored(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The bytes of a small picture file with scalars."""
    path = tmp_path_factory.mktemp("pictures") / "wall.npz"
    saved(path, in_color())
    return path.read_bytes()


def npy(array: npt.NDArray[Any]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()


def with_array(whole: bytes, name: str, array: npt.NDArray[Any]) -> bytes:
    return zipped({**members_of(whole), f"{name}.npy": npy(array)})


def header_of(whole: bytes) -> dict[str, Any]:
    header: dict[str, Any] = json.loads(np.load(io.BytesIO(members_of(whole)["header.npy"])).tobytes())
    return header


def with_header(whole: bytes, text: str | bytes) -> bytes:
    data = text if isinstance(text, bytes) else text.encode()
    return with_array(whole, "header", np.frombuffer(data, np.uint8))


def equal_scenes(one: Scene, other: Scene) -> bool:
    names = [field.name for field in dataclasses.fields(Scene) if field.name != "mesh"]
    return (
        all(getattr(one, name) == getattr(other, name) for name in names)
        and one.mesh.part_names == other.mesh.part_names
        and one.mesh.crease_angle == other.mesh.crease_angle
        and all(
            np.array_equal(getattr(one.mesh, name), getattr(other.mesh, name))
            for name in ("coordinates", "node_numbers", "part_numbers")
        )
        and [(scalar.name, scalar.of, scalar.values.tobytes()) for scalar in one.mesh.scalars]
        == [(scalar.name, scalar.of, scalar.values.tobytes()) for scalar in other.mesh.scalars]
    )


def test_a_picture_file_under_the_name_of_an_image_is_refused(tmp_path: Path) -> None:
    scene = lit_wall()
    path = tmp_path / "wall.png"
    with pytest.raises(UsageError) as refusal:
        write_picture(path, scene, render(scene, 24, 32))
    assert str(refusal.value) == (
        f"a picture with its scene must be written to a file that ends in .npz, not to {path}; rename it"
    )
    assert not path.exists()


def test_a_picture_comes_back_with_its_scene(tmp_path: Path) -> None:
    scene = lit_wall()
    picture = render(scene, LINES, ELEMENTS)
    again = saved(tmp_path / "wall.npz", scene)
    assert equal_scenes(again.scene, scene)
    assert (again.picture.intensity == picture.intensity).all()
    assert (again.picture.surface_number == picture.surface_number).all()
    assert again.picture.part_number.tobytes() == picture.part_number.tobytes()
    assert again.picture.parts == picture.parts == ("wall",)
    assert again.picture.surfaces == picture.surfaces
    assert again.picture.ranges == picture.ranges
    assert (display_image(again.scene, again.picture).words == display_image(scene, picture).words).all()


@pytest.mark.parametrize("name", ["stress", "load", "\udcff", "z", "zebra"])
def test_a_picture_comes_back_with_its_scalar_and_those_of_the_mesh(tmp_path: Path, name: str) -> None:
    scene = in_color().replace(scalar={"name": name})
    picture = render(scene, LINES, ELEMENTS)
    again = saved(tmp_path / "wall.npz", scene)
    assert equal_scenes(again.scene, scene)
    assert picture.scalar is not None
    assert again.picture.scalar is not None
    assert again.picture.scalar.tobytes() == picture.scalar.tobytes()
    assert again.picture.scalar_limits == picture.scalar_limits
    write_picture(tmp_path / "two.npz", again.scene, again.picture)
    assert (tmp_path / "two.npz").read_bytes() == (tmp_path / "wall.npz").read_bytes()


def test_numpy_can_open_the_scalars(colored: bytes) -> None:
    with np.load(io.BytesIO(colored)) as arrays:
        assert {*arrays} - {*PICTURE_FILE.arrays} == {
            "header", "mesh_scalar_0", "mesh_scalar_1", "mesh_scalar_2", "scalar_0",
        }  # fmt: skip
        assert arrays["mesh_scalar_1"].tolist() == np.linspace(-1, 1, 6).tolist()


@pytest.mark.parametrize("scalar", [None, {"name": "z"}])
def test_a_picture_of_another_scalar_than_its_scene_is_not_written(tmp_path: Path, scalar: Any) -> None:
    scene = wall_scene(scalar=scalar)
    other = scene.replace(scalar=None if scalar else {"name": "z"})
    with pytest.raises(UsageError, match="must both have a scalar or neither, not one alone; render"):
        write_picture(tmp_path / "wall.npz", other, render(scene, LINES, ELEMENTS))
    assert list(tmp_path.iterdir()) == []


@given(scene=linked_scenes())
def test_every_scene_that_renders_comes_back_with_equal_words(
    scene: Scene, tmp_path_factory: pytest.TempPathFactory
) -> None:
    try:
        picture = render(scene, LINES, ELEMENTS)
        now = display_image(scene, picture)
    except InputError:
        return
    path = tmp_path_factory.mktemp("pictures") / "scene.npz"
    write_picture(path, scene, picture)
    again = read_picture(path)
    assert equal_scenes(again.scene, scene)
    assert again.picture.part_number.tobytes() == picture.part_number.tobytes()
    assert again.picture.parts == picture.parts
    then = display_image(again.scene, again.picture)
    assert (then.words == now.words).all()
    assert (then.entries == now.entries).all()


def test_numpy_can_open_a_picture_file(tmp_path: Path) -> None:
    scene = lit_wall()
    picture = saved(tmp_path / "wall.npz", scene).picture
    with np.load(tmp_path / "wall.npz") as arrays:
        assert set(arrays) == {"header", *PICTURE_FILE.arrays}
        scale = json.loads(arrays["header"].tobytes())["scale"]
        assert (arrays["relative_intensity"] * np.float32(scale) == picture.intensity).all()
        assert (arrays["surface_number"] == picture.surface_number).all()
        assert (arrays["part_number"] == picture.part_number).all()
        assert (arrays["coordinates"] == scene.mesh.coordinates).all()


def test_a_smooth_picture_comes_back_with_its_smoothness(tmp_path: Path) -> None:
    scene = lit_wall()
    # Integers of numpy are as good as others.
    lines, elements, smooth = np.array([LINES // 3, ELEMENTS // 3, 3])
    picture = render(scene, lines, elements, smooth=smooth)
    write_picture(tmp_path / "wall.npz", scene, picture)
    again = read_picture(tmp_path / "wall.npz")
    assert again.picture.smooth == 3
    assert (image(*again[::-1]) == image(scene, picture)).all()
    # The file is that of a plain picture with one number more.
    plain = saved(tmp_path / "plain.npz", scene).picture
    assert plain.smooth == 1
    assert (plain.intensity == again.picture.intensity).all()
    header, plain_header = (header_of((tmp_path / name).read_bytes()) for name in ("wall.npz", "plain.npz"))
    assert header == {**plain_header, "smooth": 3}


def test_the_same_picture_gives_the_same_bytes(tmp_path: Path) -> None:
    saved(tmp_path / "one.npz", lit_wall())
    saved(tmp_path / "two.npz", lit_wall())
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()


def test_a_picture_that_was_read_is_written_with_the_same_bytes(tmp_path: Path) -> None:
    picture, scene = saved(tmp_path / "one.npz", lit_wall())
    write_picture(tmp_path / "two.npz", scene, picture)
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()


def test_names_in_any_script_and_in_none_come_back(tmp_path: Path) -> None:
    # The name of a file that is no UTF-8 holds halves of code points.
    scene = lit_wall().replace(name="купе \udcff")
    assert saved(tmp_path / "wall.npz", scene).scene.name == scene.name


def test_a_scene_in_which_nothing_is_seen_comes_back(tmp_path: Path) -> None:
    scene = wall_scene(view=lit_wall().view.replace(direction=(0, -1, 0)), ambient=0.0, lights=[])
    again = saved(tmp_path / "nothing.npz", scene)
    assert not again.picture.surface_number.any()


def test_a_picture_file_is_a_scene(tmp_path: Path) -> None:
    saved(tmp_path / "wall.npz", lit_wall())
    assert equal_scenes(read_scene(tmp_path / "wall.npz"), lit_wall())


def test_an_existing_file_is_kept_unless_it_may_be_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "wall.npz"
    path.write_bytes(b"mine")
    scene = lit_wall()
    picture = render(scene, LINES, ELEMENTS)
    with pytest.raises(OutputError):
        write_picture(path, scene, picture)
    assert path.read_bytes() == b"mine"
    write_picture(path, scene, picture, overwrite=True)
    assert equal_scenes(read_picture(path).scene, scene)


def test_a_full_disk_leaves_the_old_file_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "wall.npz"
    path.write_bytes(b"mine")
    picture = render(lit_wall(), LINES, ELEMENTS)

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(WriteError, match="no space left on device"):
        write_picture(path, lit_wall(), picture, overwrite=True)
    assert path.read_bytes() == b"mine"
    assert os.listdir(tmp_path) == ["wall.npz"]


def test_a_picture_of_other_surfaces_than_its_scene_is_not_written(tmp_path: Path) -> None:
    picture = render(lit_wall(), LINES, ELEMENTS)
    other = scene_of(lit_wall().mesh, surfaces=[Surface("paint")], surface_of_part={"wall": "paint"})
    with pytest.raises(InputError, match=r"must be those of the scene, \['paint'\], not"):
        write_picture(tmp_path / "wall.npz", other, picture)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_not_there_is_missing(tmp_path: Path) -> None:
    with pytest.raises(MissingInputError):
        read_picture(tmp_path / "wall.npz")


def test_a_file_cut_short_anywhere_is_refused(whole: bytes, tmp_path: Path) -> None:
    for length in range(0, len(whole), 13):
        with pytest.raises(InputError, match=r"^changed\.npz: a picture file must be whole"):
            read_bytes(whole[:length], tmp_path)


@given(data=st.data())
def test_changed_bytes_are_refused_or_harmless(
    whole: bytes, data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    changed = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(changed) - 1))
        kind = data.draw(st.sampled_from(["flip", "cut", "insert", "set"]))
        if kind == "flip":
            changed[place] ^= 1 << data.draw(st.integers(0, 7))
        elif kind == "set":
            changed[place] = data.draw(st.sampled_from([0, 1, 0x7F, 0x80, 0xFF]))
        elif kind == "cut":
            del changed[place : place + data.draw(st.integers(1, 100))]
        else:
            changed[place:place] = data.draw(st.binary(min_size=1, max_size=40))
        changed = changed or bytearray(b"P")
    with suppress(InputError):
        read_bytes(bytes(changed), tmp_path_factory.mktemp("pictures"))


# Members with right checksums but wrong contents.


@given(data=st.data())
def test_changed_members_are_refused_or_give_a_picture_that_can_be_shown(
    whole: bytes, data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    members = members_of(whole)
    name = data.draw(st.sampled_from(sorted(members)))
    changed = bytearray(members[name])
    for _ in range(data.draw(st.integers(1, 3))):
        changed[data.draw(st.integers(0, len(changed) - 1))] = data.draw(st.integers(0, 255))
    with suppress(InputError):
        picture, scene = read_bytes(
            zipped({**members, name: bytes(changed)}), tmp_path_factory.mktemp("pictures")
        )
        display_image(scene, picture)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The path of each value within a JSON value."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(place for key, row in inner for place in places(row, (*path, key)))]


@given(data=st.data())
def test_any_value_anywhere_in_the_header_is_refused_or_can_be_shown(
    whole: bytes, data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    header = header_of(whole)
    path = data.draw(st.sampled_from(places(header)[1:]))
    table = header
    for key in path[:-1]:
        table = table[key]
    what = data.draw(st.sampled_from(["value", "none", "extra"]))
    if what == "value":
        table[path[-1]] = data.draw(JSON)
    elif what == "none":
        del table[path[-1]]
    elif isinstance(table, dict):
        table[data.draw(st.text(max_size=8))] = data.draw(JSON)
    try:
        picture, scene = read_bytes(
            with_header(whole, json.dumps(header)), tmp_path_factory.mktemp("pictures")
        )
        display_image(scene, picture)
    except InputError:
        pass


def change(**fields: Any) -> Callable[[dict[str, Any]], None]:
    return lambda header: header.update(fields)


def change_scene(table: str, row: int | None = None, **fields: Any) -> Callable[[dict[str, Any]], None]:
    def run(header: dict[str, Any]) -> None:
        target = header["scene"][table]
        (target if row is None else target[row]).update(fields)

    return run


@pytest.mark.parametrize(
    ("edit", "sentence"),
    [
        (change(format="autocolor picture 5"), "its format must be 'autocolor picture 4'"),
        (change(format="autocolor picture 2"), "it must have exactly the keys of its format"),
        *(
            (
                change(smooth=smooth),
                "smooth must be a whole number that divides its lines and elements, (9, 12), not"
                f" {shown(smooth)}",
            )
            for smooth in (0, -3, 2, 4, 9, 1.0, 3.0, True, "3", None, [3])
        ),
        (change(scale=0), "its scale must be a number above 0, not 0"),
        (change(scale=-1.5), "its scale must be a number above 0, not -1.5"),
        (change(scale=True), "its scale must be a number above 0, not True"),
        (change(scale="1"), "its scale must be a number above 0, not '1'"),
        (change(scale=10**300), "its scale must be a number above 0"),
        (change(scale=3.3e38), "intensities must stay below 3.4e+38"),
        (change(surfaces=["other"]), "its surfaces must be the scene's, ['wall'], not ['other']"),
        (change(surfaces=["wall", "more"]), "its surfaces must be the scene's"),
        (change(surfaces={}), "its surfaces must be the scene's"),
        (change(scene=[]), "scene: it must be tables, its mesh among them, not []"),
        (change(more=1), "it must have exactly the keys of its format"),
        (change(mesh_scalars=3), "mesh_scalars must be a list of at most 1,000 rows, not 3"),
        (change(mesh_scalars=[{}] * 1001), "mesh_scalars must be a list of at most 1,000 rows, not ["),
        (change(shown_scalars=[{}, {}]), "shown_scalars must be a list of at most 1 rows, not ["),
        (
            change(mesh_scalars=[{"name": "a", "of": "node"}]),
            "must be whole and as autocolor wrote it, not with",
        ),
        (change_scene("lights", 0, intensity=-1), "intensity must be a finite number of at least 0"),
        (change_scene("lights", 0, intensity=10**400), "intensity must be a finite number of at least 0"),
        (change_scene("lights", 0, name=[]), "lights[1].name must be a string"),
        (
            change_scene("lights", 1, flaps={"z": 4}),
            "lights[2].flaps.z must be a table of minimum, maximum, on and edge_width, not 4",
        ),
        (change_scene("parts", 0, name=["wall"]), "parts[1].name must be a string"),
        (change_scene("parts", 0, surface={}), "surface must be a string"),
        (change_scene("parts", 0, surface="walls"), "surface 'walls' is not in the surface table"),
        (change_scene("mesh", part_names=[1]), "part names must be strings"),
        (change_scene("mesh", part_names=[[]]), "part names must be strings"),
        (change_scene("mesh", crease_angle=-1), "crease_angle must be a number from 0 to 180"),
        (change_scene("surfaces", 0, levels=1), "levels must be a whole number from 2 to 1000000"),
        (change_scene("view", eye=[0, 0]), "view.eye must be three finite numbers"),
        (
            change_scene("view", **{str(number): 0 for number in range(99)}),
            "it must be a table of at most 64 keys",
        ),
    ],
)
def test_a_header_that_breaks_a_rule_is_refused_in_a_sentence(
    whole: bytes, tmp_path: Path, edit: Callable[[dict[str, Any]], None], sentence: str
) -> None:
    header = copy.deepcopy(header_of(whole))
    edit(header)
    with pytest.raises(InputError) as caught:
        read_bytes(with_header(whole, json.dumps(header)), tmp_path)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith("changed.npz")
    assert str(caught.value).endswith("; save the picture again")


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"{",
        b"null",
        b"\xff\xfe{}",
        b'{"format": NaN}',
        b'{"format": -Infinity}',
        b"[" * 100_000,
        b'{"a":' * 100_000,
        b"9" * 5000,
        b"[" + b"[]," * 1_000_001 + b"[]]",
    ],
)
def test_a_header_that_is_no_json_of_ours_is_refused(whole: bytes, tmp_path: Path, text: bytes) -> None:
    with pytest.raises(InputError, match=r"^changed\.npz, header: it"):
        read_bytes(with_header(whole, text), tmp_path)


WRONG_ARRAYS: list[tuple[str, npt.NDArray[Any]]] = [
    ("relative_intensity", np.zeros((LINES, ELEMENTS), np.float64)),
    ("relative_intensity", np.zeros((LINES, ELEMENTS), ">f4")),
    ("relative_intensity", np.asfortranarray(np.zeros((LINES, ELEMENTS), np.float32))),
    ("relative_intensity", np.zeros(LINES * ELEMENTS, np.float32)),
    ("relative_intensity", np.zeros((ELEMENTS, LINES), np.float32)),
    ("relative_intensity", np.zeros((0, ELEMENTS), np.float32)),
    ("relative_intensity", np.full((LINES, ELEMENTS), np.nan, np.float32)),
    ("relative_intensity", np.full((LINES, ELEMENTS), np.inf, np.float32)),
    ("relative_intensity", np.full((LINES, ELEMENTS), -1, np.float32)),
    ("surface_number", np.full((LINES, ELEMENTS), 2, np.uint8)),
    ("surface_number", np.zeros((LINES, ELEMENTS), np.int8)),
    ("surface_number", np.zeros((LINES, ELEMENTS, 1), np.uint8)),
    ("surface_number", np.array(1, np.uint8)),
    ("part_number", np.ones((ELEMENTS, LINES), np.int32)),
    ("part_number", np.ones((LINES, ELEMENTS), np.uint8)),
    ("part_number", np.ones(LINES * ELEMENTS, np.int32)),
    ("part_number", np.full((LINES, ELEMENTS), 2, np.int32)),
    ("part_number", np.full((LINES, ELEMENTS), -1, np.int32)),
    ("coordinates", np.full((4, 3), np.nan)),
    ("coordinates", np.full((4, 3), 1e31)),
    ("coordinates", np.zeros((4, 2))),
    ("coordinates", np.zeros((0, 3))),
    ("node_numbers", np.array([[0, 1, 2, -1]], np.int32)),
    ("node_numbers", np.array([[0, 1, 2, 4]], np.int32)),
    ("node_numbers", np.array([[0, 1, 2, 3]], np.int64)),
    ("part_numbers", np.array([1], np.int32)),
    ("part_numbers", np.array([-1], np.int32)),
    ("part_numbers", np.array([0, 0], np.int32)),
    ("part_numbers", np.array([{"a": 1}], object)),
    ("header", np.array(["{}"])),
]


def panels() -> Scene:
    """Two walls side by side, of one surface, and a part without polygons."""
    mesh = Mesh.joined([grid(1, 1, (x, 0, 0), (1, 0, 0), (0, 0, 1), name) for x, name in enumerate("ab")])
    mesh = Mesh(mesh.coordinates, mesh.node_numbers, mesh.part_numbers, ("a", "b", "none"))
    return scene_of(mesh)


def test_part_numbers_that_break_a_rule_are_refused_in_a_sentence(tmp_path: Path) -> None:
    again = saved(tmp_path / "panels.npz", panels())
    assert again.picture.parts == ("a", "b", "none")
    numbers = again.picture.part_number
    assert set(numbers.ravel().tolist()) == {0, 1, 2}
    whole = (tmp_path / "panels.npz").read_bytes()
    line, element = np.argwhere(numbers == 1)[0].tolist()
    empty_line, empty = np.argwhere(numbers == 0)[0].tolist()
    at, not_there = f"(line {line}, element {element})", f"(line {empty_line}, element {empty})"
    of_surface = "a part number must be that of a part of the surface there"
    for place, number, sentence in (
        ((line, element), 4, "a part number must be 0 to 3, not 4"),
        ((line, element), -1, "a part number must be 0 to 3, not -1"),
        ((line, element), 0, f"{of_surface}, not 0 {at}"),
        ((line, element), 3, f"{of_surface}, not 3 {at}"),
        ((empty_line, empty), 1, f"{of_surface}, not 1 {not_there}"),
        ((empty_line, empty), 3, f"{of_surface}, not 3 {not_there}"),
    ):
        changed = numbers.copy()
        changed[place] = number
        with pytest.raises(InputError) as caught:
            read_bytes(with_array(whole, "part_number", changed), tmp_path)
        assert str(caught.value) == f"changed.npz: {sentence}; save the picture again"
    # Another part of the same surface may be there.
    read_bytes(with_array(whole, "part_number", np.where(numbers > 0, 2, 0).astype(np.int32)), tmp_path)


WRONG_SCALARS: list[tuple[str, npt.NDArray[Any]]] = [
    ("mesh_scalar_0", np.zeros(11)),
    ("mesh_scalar_0", np.zeros(12, np.float32)),
    ("mesh_scalar_0", np.full(12, np.inf)),
    ("mesh_scalar_1", np.zeros((6, 1))),
    ("mesh_scalar_3", np.zeros(6)),
    ("scalar_0", np.zeros((ELEMENTS, LINES), np.float32)),
    ("scalar_0", np.zeros((LINES, ELEMENTS))),
    ("scalar_0", np.full((LINES, ELEMENTS), np.inf, np.float32)),
    ("scalar_1", np.zeros((LINES, ELEMENTS), np.float32)),
]


@pytest.mark.parametrize(("name", "array"), WRONG_SCALARS)
def test_a_wrong_scalar_is_refused(
    colored: bytes, tmp_path: Path, name: str, array: npt.NDArray[Any]
) -> None:
    with pytest.raises(InputError, match=r"^changed\.npz"):
        read_bytes(with_array(colored, name, array), tmp_path)


def change_rows(table: str, **fields: Any) -> Callable[[dict[str, Any]], None]:
    return lambda header: header[table][0].update(fields)


@pytest.mark.parametrize(
    ("edit", "sentence"),
    [
        (change_rows("mesh_scalars", name=""), "a scalar must have a name, not ''; give it a name"),
        (change_rows("mesh_scalars", name=3), "a scalar must have a name, not 3; give it a name"),
        (change_rows("mesh_scalars", name="load"), "scalar 'load': its name must be unique"),
        (change_rows("mesh_scalars", of="part"), "it must be of 'node' or 'polygon', not 'part'"),
        (change_rows("mesh_scalars", of="polygon"), "there must be one value a polygon (6), not 12"),
        (change_rows("mesh_scalars", more=1), "mesh_scalars[1] must be a table of name and of, not {"),
        (change_rows("shown_scalars", limits=[1, 1]), "shown_scalars[1].limits must be two finite numbers"),
        (
            change_rows("shown_scalars", limits=[0, 1e300]),
            "shown_scalars[1].limits must be two finite numbers",
        ),
        (change_rows("shown_scalars", limits=3), "shown_scalars[1].limits must be two finite numbers"),
        (change_rows("shown_scalars", more=3), "shown_scalars[1].limits must be two finite numbers"),
        (change(shown_scalars=[3]), "shown_scalars[1].limits must be two finite numbers"),
        (change_scene("scalar", name="strain"), "scalar.name must be a scalar of the mesh"),
    ],
)
def test_a_header_with_wrong_scalars_is_refused_in_a_sentence(
    colored: bytes, tmp_path: Path, edit: Callable[[dict[str, Any]], None], sentence: str
) -> None:
    header = header_of(colored)
    edit(header)
    with pytest.raises(InputError) as caught:
        read_bytes(with_header(colored, json.dumps(header)), tmp_path)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith("changed.npz")
    assert str(caught.value).endswith("; save the picture again")


def test_a_raster_without_a_scalar_in_the_scene_is_refused(colored: bytes, tmp_path: Path) -> None:
    header = header_of(colored)
    del header["scene"]["scalar"]
    with pytest.raises(InputError, match="there must be a scalar at the pixels if the scene shows one, and"):
        read_bytes(with_header(colored, json.dumps(header)), tmp_path)


@pytest.mark.parametrize(("name", "array"), WRONG_ARRAYS)
def test_a_wrong_array_is_refused(whole: bytes, tmp_path: Path, name: str, array: npt.NDArray[Any]) -> None:
    with pytest.raises(InputError, match=r"^changed\.npz"):
        read_bytes(with_array(whole, name, array), tmp_path)


def test_a_surface_without_polygons_is_seen_nowhere(tmp_path: Path) -> None:
    # Such a surface owns no word that its pixels could have.
    mesh = dataclasses.replace(cube(), part_names=("cube", "none"))
    saved(tmp_path / "cube.npz", wall_scene(mesh, lights=[]))
    data = (tmp_path / "cube.npz").read_bytes()
    scene = read_picture(tmp_path / "cube.npz").scene
    numbers = np.full((LINES, ELEMENTS), scene.surface_number_of_part[1], np.uint8)
    with pytest.raises(InputError, match="must be that of a surface with polygons, not 3"):
        read_bytes(with_array(data, "surface_number", numbers), tmp_path)


def described(text: str, data: bytes = b"") -> bytes:
    """An array file with any description."""
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + data


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x93NUMPY",
        b"\x93NUMPY\x02\x00" + b"\0" * 100,
        b"\x93NUMPY\x01\x00\xff\xff",
        described("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999, 99999999999), }\n"),
        described("{'descr': '<f4', 'fortran_order': False, 'shape': (0, 99999999999), }\n"),
        described("{'descr': '<f4', 'fortran_order': False, 'shape': (-1, 1), }\n"),
        described("{'descr': '<f4', 'fortran_order': False, 'shape': (True, 1), }\n", b"\0" * 4),
        described("{'descr': '|O', 'fortran_order': False, 'shape': (1, 1), }\n", b"\x80\x04N."),
        described("{'descr': ['<f4'], 'fortran_order': False, 'shape': (1, 1), }\n", b"\0" * 4),
        described("{'descr': '<f4', 'shape': (1, 1), }\n", b"\0" * 4),
        described("__import__('os')\n"),
        described("(" * 900),
        described("\xff\xfe"),
    ],
)
def test_an_array_of_another_description_is_refused(whole: bytes, tmp_path: Path, data: bytes) -> None:
    members = {**members_of(whole), "relative_intensity.npy": data}
    with pytest.raises(InputError, match=r"^changed\.npz, relative_intensity: it must be an array of <f4"):
        read_bytes(zipped(members), tmp_path)


def test_other_members_are_refused(whole: bytes, tmp_path: Path) -> None:
    members = members_of(whole)
    for changed in (
        {},
        {name: data for name, data in members.items() if name != "header.npy"},
        {**members, "more.npy": b""},
        {**members, "../header.npy": b""},
        {f"folder/{name}": data for name, data in members.items()},
        {"x" * 60_000: b""},
    ):
        with pytest.raises(InputError) as caught:
            read_bytes(zipped(changed), tmp_path)
        assert len(str(caught.value)) < 400


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_member_that_stands_twice_is_refused(whole: bytes, tmp_path: Path) -> None:
    buffer = io.BytesIO(whole)
    with zipfile.ZipFile(buffer, "a") as archive:
        archive.writestr("header.npy", members_of(whole)["header.npy"])
    with pytest.raises(InputError, match="a picture file must be whole"):
        read_bytes(buffer.getvalue(), tmp_path)


def test_a_small_file_cannot_promise_more_memory_than_it_holds(whole: bytes, tmp_path: Path) -> None:
    # A thousand times its size, if it were unpacked.
    zeros = {**members_of(whole), "coordinates.npy": npy(np.zeros((3_000_000, 3)))}
    bomb = zipped(zeros, zipfile.ZIP_DEFLATED)
    assert len(bomb) < 100_000
    (tmp_path / "bomb.npz").write_bytes(bomb)
    tracemalloc.start()
    with pytest.raises(InputError, match="not compressed"):
        read_picture(tmp_path / "bomb.npz")
    assert tracemalloc.get_traced_memory()[1] < 4_000_000
    tracemalloc.stop()


@pytest.mark.parametrize("data", [b"", b"x", b"PK\x05\x06" + b"\0" * 18, b"\x80\x04N.", b"PK" * 500])
def test_a_file_of_another_kind_is_refused(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(InputError, match=r"^changed\.npz: a picture file must be whole"):
        read_bytes(data, tmp_path)


def test_a_folder_is_no_picture_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must be a regular file, not a folder"):
        read_picture(tmp_path)


NESTED = (("reflectance", Reflectance), ("paint", Paint))


def read_again(values: object, scene: Scene) -> Scene:
    """The scene of the values, and of the arrays of a scene's mesh."""
    mesh = scene.mesh
    return scene_of_plain(values, mesh.coordinates, mesh.node_numbers, mesh.part_numbers, mesh.scalars)


def columns(scene: Scene) -> dict[str, Any]:
    """Everything of a scene but the arrays of its mesh."""
    described = (scene.mesh.part_names, scene.mesh.crease_angle)
    return {
        **{name: value for name, value in vars(scene).items() if name in keys_of(Scene)},
        "mesh": described,
    }


def nested(values: dict[str, Any]) -> dict[str, Any]:
    """The values as the first picture files had them: reflectance and paint as tables of a surface."""
    rows = []
    for surface in values["surfaces"]:
        row = dict(surface)
        for table, cls in NESTED:
            row[table] = {key: row.pop(key) for key in list(row) if key in keys_of(cls)}
        rows.append(row)
    return {**values, "surfaces": rows}


@given(linked_scenes())
def test_a_scene_comes_back_from_its_values_through_json(scene: Scene) -> None:
    text = json.dumps(plain_scene(scene), allow_nan=False)
    again = read_again(json.loads(text), scene)
    assert columns(again) == columns(scene)
    assert json.dumps(plain_scene(again), allow_nan=False) == text


@given(linked_scenes())
def test_the_values_of_the_first_picture_files_give_the_same_scene(scene: Scene) -> None:
    values = json.loads(json.dumps(plain_scene(scene)))
    old = nested(values)
    assert set(old["surfaces"][0]) <= {"name", "reflectance", "paint", "two_sided", "levels"}
    # Phong's model was the only one, and had no name.
    for surface in old["surfaces"]:
        if surface["reflectance"].get("model") == "phong":
            del surface["reflectance"]["model"]
    assert columns(read_again(old, scene)) == columns(scene)


@pytest.mark.parametrize("old", ["autocolor picture 1", "autocolor picture 2", "autocolor picture 3"])
def test_a_picture_file_of_an_older_format_is_still_read(tmp_path: Path, old: str) -> None:
    scene = wall_scene(ambient=0.5)
    picture = render(scene, 6, 8)
    write_picture(tmp_path / "new.npz", scene, picture)
    header, arrays = read_array_file(PICTURE_FILE, tmp_path / "new.npz")
    if old == "autocolor picture 3":
        header = {key: header[key] for key in (*PICTURE_FILE.keys, *PICTURE_FILE.series)}
    else:
        header = {key: header[key] for key in PICTURE_FILE.keys}
    del arrays["part_number"]
    older = dataclasses.replace(PICTURE_FILE, formats=(old,), added=frozenset())
    older = dataclasses.replace(older, arrays={name: PICTURE_FILE.arrays[name] for name in arrays})
    if old == "autocolor picture 1":
        header["scene"] = nested(header["scene"])
    (tmp_path / "old.npz").write_bytes(array_file_bytes(older, header, arrays))
    again = read_picture(tmp_path / "old.npz")
    assert columns(again.scene) == columns(scene)
    assert (again.picture.intensity == picture.intensity).all()
    assert (again.picture.surface_number == picture.surface_number).all()
    # It does not know its parts, also once it is written again.
    write_picture(tmp_path / "again.npz", again.scene, again.picture)
    for each in (again, read_picture(tmp_path / "again.npz")):
        assert each.picture.parts == ()
        assert each.picture.part_number.shape == (6, 8)
        assert not each.picture.part_number.any()


def test_what_is_absent_or_endless_is_left_out() -> None:
    lights = [Light("key", (0, -1, 0), flaps=Flaps(z=Flap(maximum=2.0)))]
    values = plain_scene(wall_scene(lights=lights))
    (light,) = values["lights"]
    assert light["flaps"] == {"z": {"maximum": 2.0, "on": True, "edge_width": 0.0}}
    assert not {"direction", "aim", "cone_angle"} & set(light)
    assert values["mesh"] == {"part_names": ("wall",), "crease_angle": 40.0}


@pytest.mark.parametrize("values", [None, [], "scene", 3, {}, {"mesh": None}, {"mesh": []}])
def test_what_is_no_scene_of_tables_is_refused(values: object) -> None:
    with pytest.raises(InputError, match="scene: it must be tables, its mesh among them, not "):
        read_again(values, wall_scene())


@pytest.mark.parametrize("table", ["parts", "surfaces", "lights", "view"])
def test_a_table_that_is_missing_is_named_and_not_created(table: str) -> None:
    values = plain_scene(wall_scene())
    del values[table]
    with pytest.raises(InputError, match=f"{table} must be .*, not missing; add it"):
        read_again(values, wall_scene())


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)


@given(key=st.sampled_from(sorted(plain_scene(wall_scene()))), value=JSON)
def test_any_value_of_any_table_gives_a_sound_scene_or_a_sentence(key: str, value: object) -> None:
    scene = wall_scene()
    try:
        again = read_again({**plain_scene(scene), key: value}, scene)
    except InputError as error:
        problems = error.problems
    else:
        problems = ()
        assert columns(read_again(plain_scene(again), again)) == columns(again)
    assert all(problem and "\n" not in problem for problem in problems)


def test_a_crease_angle_that_is_left_out_is_refused() -> None:
    values = plain_scene(wall_scene())
    values["mesh"] = {"part_names": ["wall"]}
    with pytest.raises(InputError, match="crease_angle must be a number from 0 to 180, not nan"):
        read_again(values, wall_scene())
    values["mesh"]["crease_angle"] = math.inf
    with pytest.raises(InputError, match="crease_angle"):
        read_again(values, wall_scene())


def test_wrong_arrays_are_refused_with_the_rules_of_a_mesh() -> None:
    scene = wall_scene()
    with pytest.raises(InputError, match="node"):
        scene_of_plain(plain_scene(scene), scene.mesh.coordinates, np.array([[0, 1, 9]]), np.array([0]))


def test_a_surface_of_another_model_keeps_its_parameters() -> None:
    surface = Surface("wall", Reflectance(0.5, 0.25, "cook-torrance"))
    scene = wall_scene().replace(surfaces=[surface])
    assert read_again(plain_scene(scene), scene).surfaces == (surface,)
