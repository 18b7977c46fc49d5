from __future__ import annotations

import io
import json
import tempfile
import zipfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Scene, UsageError, read_picture, render, write_picture
from autocolor.checks import shown
from autocolor.files.picture_file import SavedPicture, plain_scene
from autocolor.images import display_image
from autocolor.lighting.picture import Picture
from autocolor.scene.mesh import has_same_tables
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.linked_scenes import linked_scenes
from tests.small import wall, wall_scene
from tests.tables import refused

LINES, ELEMENTS = 9, 12


def lit_wall() -> Scene:
    return wall_scene(ambient=0.125, name="lit wall")


def in_color() -> Scene:
    """A wall with scalars of both kinds, some of their values missing, one of them shown."""
    mesh = wall(3, 2).with_scalars(
        MeshScalar("stress", np.array([np.nan, *range(11)])),
        MeshScalar("load", np.linspace(-1, 1, 6), "polygon"),
        MeshScalar("\udcff", np.full(6, np.nan), "polygon"),
    )
    # The name of a file that is no UTF-8 holds halves of code points.
    return wall_scene(mesh, name="купе \udcff", scalar={"name": "stress", "limits": (0, 5), "bands": 4})


@cache
def content(make: Callable[[], Scene]) -> bytes:
    """The bytes of the picture file of a scene."""
    scene = make()
    return bytes_of(scene, render(scene, (ELEMENTS, LINES)))


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


def changed(make: Callable[[], Scene], **arrays: npt.NDArray[Any]) -> bytes:
    """The picture file of a scene with other arrays."""
    buffer = io.BytesIO()
    with np.load(io.BytesIO(content(make))) as whole:
        np.savez(buffer, **{**whole, **arrays})
    return buffer.getvalue()


def edited(make: Callable[[], Scene], path: str, value: object) -> bytes:
    """The picture file of a scene with another value at a path of its header; without one if it is None."""
    with np.load(io.BytesIO(content(make))) as whole:
        header: Any = json.loads(whole["header"].tobytes())
    *keys, last = path.split(".")
    table = header
    for key in keys:
        table = table[key]
    table[last] = value
    if value is None:
        del table[last]
    return changed(make, header=np.frombuffer(json.dumps(header).encode(), np.uint8))


@given(scene=linked_scenes(), smooth=st.sampled_from([1, np.int64(3)]))
def test_every_scene_that_renders_comes_back_with_its_picture_and_is_written_the_same(
    scene: Scene, smooth: int
) -> None:
    try:
        picture = render(scene, (ELEMENTS // smooth, LINES // smooth), smooth=smooth)
        now = display_image(scene, picture)
    except InputError:
        return
    data = bytes_of(scene, picture)
    again = read(data)
    assert plain_scene(again.scene) == plain_scene(scene)
    assert has_same_tables(again.scene.mesh, scene.mesh)
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
    scene, picture = read(content(in_color))
    with np.load(io.BytesIO(content(in_color))) as arrays:
        scale = json.loads(arrays["header"].tobytes())["scale"]
        assert (arrays["relative_intensity"] * np.float32(scale) == picture.intensity).all()
        assert (arrays["part_number"] == picture.part_number).all()
        assert (arrays["coordinates"] == scene.mesh.coordinates).all()


ALONE = "a picture and its scene must both have a scalar or neither, not one alone; render the scene"


@pytest.mark.parametrize(
    ("make", "name", "scalar", "sentence"),
    [
        (lit_wall, "wall.png", None, "a picture with its scene must be written to a file that ends in .npz"),
        (lit_wall, "wall.npz", {"name": "z"}, ALONE),
    ],
)
def test_a_picture_that_is_not_of_the_scene_or_has_another_suffix_is_not_written(
    tmp_path: Path, make: Callable[[], Scene], name: str, scalar: Any, sentence: str
) -> None:
    scene, picture = read(content(make))
    with pytest.raises(UsageError, match=sentence):
        write_picture(tmp_path / name, scene.replace(scalar=scalar), picture)
    assert list(tmp_path.iterdir()) == []


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
        scene, picture = read(zipped({**members, name: bytes(changed)}) if in_members else bytes(changed))
        display_image(scene, picture)


OF_SCALAR = "there must be a scalar at the pixels if the scene shows one, and none if it does not"
OF_SMOOTH = "smooth must be a whole number that divides its lines and elements, (9, 12), not"
OF_LIMITS = "shown_scalars: limits must be two finite numbers, the second above the first"
OF_HEADER = "its header must be as autocolor wrote it, and is not"
OF_INTENSITY = "every intensity must be a number from 0 to 3.4e+38"
RASTER = (LINES, ELEMENTS)
DARK = np.full(RASTER, -1, np.float32)
OF_PART = "a part number must be that of a part of the surface there"
FIRST = "0, not {} (line 0, element 0)"
ENDLESS = np.full(RASTER, np.inf, np.float32)

test_what_is_not_of_the_scene_is_refused = refused(
    read,
    [
        (data, f"changed.npz: {sentence}; save the picture again")
        for data, sentence in (
            (edited(in_color, "scene.scalar", None), OF_SCALAR),
            (edited(in_color, "scale", None), f"{OF_HEADER} ('scale')"),
            (edited(in_color, "shown_scalars", [{"limits": [3, 3]}]), OF_LIMITS),
            *((edited(lit_wall, "smooth", value), f"{OF_SMOOTH} {value}") for value in (0, 2, 3.0)),
            *(
                (edited(lit_wall, "scale", value), f"its scale must be a number above 0, not {shown(value)}")
                for value in (0, "1", 3.5e38)
            ),
            (edited(lit_wall, "scale", 3.3e38), OF_INTENSITY),
            (changed(lit_wall, relative_intensity=DARK), OF_INTENSITY),
            (changed(lit_wall, relative_intensity=DARK * np.nan), OF_INTENSITY),
            *(
                (
                    changed(lit_wall, part_number=np.full(RASTER, part, np.int32)),
                    f"{OF_PART}, {FIRST}".format(part),
                )
                for part in (-1, 1, 2)
            ),
            (
                edited(lit_wall, "scene", []),
                f"{OF_HEADER} (list indices must be integers or slices, not str)",
            ),
            (
                edited(lit_wall, "scene.lights", None),
                "lights must be a list of Light rows, not missing; add it",
            ),
            (
                changed(in_color, relative_intensity=-DARK.reshape(12, 9)),
                "its arrays must be of one shape, not (12, 9) and others",
            ),
            (
                changed(in_color, scalar_0=DARK.reshape(12, 9)),
                "its arrays must be of one shape, not (9, 12) and others",
            ),
            (
                changed(in_color, scalar_0=ENDLESS),
                "a scalar must have a finite number or NaN at each pixel, not infinity",
            ),
        )
    ],
)


HUGE = b"{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999, 99999999999), }\n"
HUGE_ARRAY = b"\x93NUMPY\1\0" + len(HUGE).to_bytes(2, "little") + HUGE


def test_a_file_that_is_cut_short_or_has_other_members_is_refused() -> None:
    whole = content(lit_wall)
    members = members_of(whole)
    for data in (
        *(whole[:length] for length in range(0, len(whole), 97)),
        zipped({name: data for name, data in members.items() if name != "header.npy"}),
        zipped({**members, "x" * 60_000: b""}),
        zipped({**members, "relative_intensity.npy": HUGE_ARRAY}),
        changed(lit_wall, header=np.frombuffer(b"null", np.uint8)),
        edited(lit_wall, "format", "autocolor picture 3"),
    ):
        with pytest.raises(InputError, match=r"^changed\.npz: a picture file must be whole") as caught:
            read(data)
        assert len(str(caught.value)) < 400
