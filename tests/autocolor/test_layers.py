"""The layers of a picture for compositors: the channels, their names, and the OpenEXR file."""

from __future__ import annotations

import json
import sys
from io import BytesIO
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import (
    InputError,
    Light,
    OutputError,
    Scene,
    UnavailableError,
    UsageError,
    image,
    read_picture,
    render,
    save_layers,
    scene_of,
    write_picture,
)
from autocolor.arrays import components_of
from autocolor.budget import MEMORY, allowing
from autocolor.explanation.explain import explain
from autocolor.images import display_image
from autocolor.layers import (
    BYTES_OF_LIGHT,
    BYTES_OF_PIXEL,
    FIXED_LAYERS,
    cryptomatte,
    identity,
    layers_of,
    light_layers,
    murmur_hash,
)
from autocolor.rendering import rendering
from autocolor.testing import scenes
from autocolor.visibility.visible_points import Sight
from tests.small import car, cube, wall_scene
from tests.tables import first

SIZE = (32, 24)


def car_with_named_lights() -> Scene:
    """The car; the names of its lights are no names of layers."""
    scene = car()
    key, fill = scene.lights
    return scene.replace(lights=(key.replace(name="rim.left"), fill.replace(name="depth")), ambient=0.1)


def light_sum(channels: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The sum of ambient and all layers of lights."""
    added = [values for name, values in channels.items() if name.endswith((".diffuse.Y", ".specular.Y"))]
    total: np.ndarray[Any, np.dtype[np.float64]] = np.sum([channels["ambient.Y"], *added], 0, np.float64)
    return total


@given(scenes())
def test_the_layers_are_the_arrays_of_the_picture_and_its_points_and_the_lights_add_up(scene: Scene) -> None:
    again = rendering(scene, 24, 32)
    picture, points = again.picture, again.points
    channels = layers_of(scene, picture).channels
    assert (channels["intensity.Y"] == picture.intensity).all()
    vectors = {"position": points.world_points, "normal": points.world_normals}
    expected = {
        f"{layer}.{axis}": values[:, k] for layer, values in vectors.items() for k, axis in enumerate("XYZ")
    }
    ahead = (points.world_points - np.array(scene.view.eye)) @ points.view.axes[2]
    np.testing.assert_allclose(points.depths, ahead, rtol=1e-9, atol=1e-9)
    for name, values in {**expected, "depth.Z": points.depths}.items():
        assert channels[name].dtype == np.float32
        assert (channels[name].ravel()[points.pixels] == values.astype(np.float32)).all()
    assert (channels["depth.Z"] > 0).tolist() == (picture.surface_number > 0).tolist()
    for name, values in channels.items():
        assert np.isfinite(values).all()
        if name not in "RGB":
            assert not values[picture.surface_number == 0].any()
    shining = [light for light in scene.lights if light.shines]
    assert sum(name.endswith(".diffuse.Y") for name in channels) == len(shining)
    rounding = 2.0**-23 * (2 + 2 * len(shining))
    tiny = np.finfo(np.float32).tiny * max(1.0, picture.scale)
    error = np.abs(light_sum(channels) - picture.intensity)
    assert (error <= rounding * picture.intensity + tiny).all()


def test_a_pixel_has_the_point_and_the_shares_of_its_explanation() -> None:
    scene = car_with_named_lights()
    again = rendering(scene, 24, 32)
    channels = layers_of(scene, again.picture).channels
    shown = display_image(scene, again.picture)
    lit = 0
    for line, element in np.argwhere(again.picture.surface_number)[::9].tolist():
        explained = explain(Sight(scene, again.points), shown, line, element)
        point = explained.point
        assert point is not None
        for name, vector in (("position", point.point), ("normal", point.normal)):
            at_pixel = [channels[f"{name}.{axis}"][line, element] for axis in "XYZ"]
            assert at_pixel == pytest.approx(vector, abs=1e-5)
        for each in explained.lights:
            layer = {"rim.left": "rim_left", "depth": "depth_2"}[each.name]
            shares = [channels[f"{layer}.{name}.Y"][line, element] for name in ("diffuse", "specular")]
            assert shares == pytest.approx([each.diffuse, each.specular], rel=1e-4, abs=1e-6)
            lit += shares[0] > 0 and shares[1] > 0
    assert lit > 5


def test_the_colors_are_those_of_the_image_as_light_in_half_precision() -> None:
    scene = car()
    picture = render(scene, SIZE, smooth=2)
    channels = layers_of(scene, picture).channels
    light = np.stack([channels[name] for name in "RGB"], axis=-1)
    assert light.dtype == np.float16
    assert light.shape == (48, 64, 3)
    assert (components_of(light.astype(np.float64)) == image(scene, picture, smooth=1)).all()


@pytest.mark.parametrize("count", [2, 20])
def test_the_layers_of_each_light_are_in_the_budget_and_need_not_fit_in_the_planes(count: int) -> None:
    lights = [Light(f"light {number}", (0.1 * number - 1, -3.0, 0.5)) for number in range(count)]
    scene = wall_scene(view=None).replace(lights=(*lights, Light("dark", (1, 1, 1), on=False)))
    picture = render(scene, SIZE)
    usual = layers_of(scene, picture).channels
    needed = (BYTES_OF_PIXEL + count * BYTES_OF_LIGHT) * SIZE[0] * SIZE[1]
    with allowing(1.001 * needed / MEMORY):
        assert len(rendering(scene, 24, 32).picture.light_planes) < count or count == 2
        channels = layers_of(scene, picture).channels
    assert channels.keys() == usual.keys()
    for name, values in channels.items():
        np.testing.assert_allclose(values, usual[name], rtol=1e-6)
    message = rf"the layers of 32 x 24 pixels and {count} lights must take at most 0\.\d MB"
    with allowing(0.999 * needed / MEMORY), pytest.raises(InputError, match=message):
        layers_of(scene, picture)


def test_a_picture_that_sees_nothing_has_layers_of_zeros() -> None:
    scene = scene_of(cube()).with_view(eye=(0.0, -5.0, 0.0), direction=(0.0, -1.0, 0.0))
    channels, attributes = layers_of(scene, render(scene, SIZE))
    assert not any(values.any() for name, values in channels.items() if name not in "RGB")
    assert [json.loads(text) for name, text in attributes.items() if name.endswith("manifest")] == [{}, {}]


@pytest.mark.parametrize(
    "edit",
    [
        lambda scene: scene.with_light("key", intensity=0.9),
        lambda scene: scene.with_surface("body", diffuse=0.1),
        lambda scene: scene.with_view(angle=5),
        lambda scene: scene.replace(ambient=0.3),
    ],
)
def test_a_picture_of_another_scene_is_refused(edit: Any) -> None:
    scene = car()
    with pytest.raises(InputError, match="must be computed from the scene that it was rendered from"):
        layers_of(edit(scene), render(scene, SIZE))


def test_other_colors_and_another_mapping_are_the_same_layers() -> None:
    scene = car()
    picture = render(scene, SIZE)
    blue = scene.with_surface("body", object_color="#0000ff").replace(mapping="gamma")
    channels, others = layers_of(scene, picture).channels, layers_of(blue, picture).channels
    different = [name for name, values in channels.items() if (values != others[name]).any()]
    assert set(different) <= set("RGB")
    assert different


names = st.text(st.characters(exclude_categories=()), min_size=1, max_size=90)


@given(st.lists(st.one_of(names, st.sampled_from(["a.b", "a b", "a_b", "depth", "a_b_2"])), unique=True))
def test_the_layers_of_lights_have_names_of_their_own_without_periods(given_names: list[str]) -> None:
    layers = list(light_layers(given_names).values())
    assert list(light_layers(given_names)) == given_names
    assert len(set(layers)) == len(layers)
    assert not set(layers) & set(FIXED_LAYERS)
    for layer in layers:
        assert all(letter.isalnum() or letter in "_-" for letter in layer)
        assert 0 < len(f"{layer}.specular.Y".encode()) <= 255


@pytest.mark.parametrize(
    ("name", "number"),
    [
        # From the manifest of a sample image of the specification of Cryptomatte.
        ("bunny", 0x13851A76),
        ("bush", 0xF763D090),
        ("flowerA.flowerA_petal1.:1015", 0x914754E4),
        ("flowerA.flowerA_petal1.:1126", 0x05E7BD28),
        ("flowerA.flowerA_petal1.:84", 0x49050927),
        ("", 0),
    ],
)
def test_a_name_is_hashed_as_everywhere(name: str, number: int) -> None:
    assert murmur_hash(name.encode()) == number


@given(st.one_of(st.integers(0, 2**32 - 1), st.sampled_from([0, 1, 0x7F800000, 0xFFC00001, 0x80000000])))
def test_an_identity_is_finite_and_has_the_bits_of_the_hash_but_perhaps_one(number: int) -> None:
    value = np.uint32(identity(number)).view(np.float32)
    assert np.isfinite(value)
    assert abs(value) >= np.finfo(np.float32).tiny
    assert identity(number) ^ number == (1 << 23 if number >> 23 & 255 in (0, 255) else 0)


def test_a_matte_is_where_the_identity_of_a_name_is() -> None:
    numbers = np.array([[0, 2], [1, 2]], np.uint8)
    # The exponent of the hash of "s78" has the bits 0 alone.
    channels, attributes = cryptomatte("crypto_part", ["s78", "Tür \U0001f697", "unseen"], numbers)
    manifest = json.loads(attributes["cryptomatte/5a1484c/manifest"])
    assert manifest.keys() == {"s78", "Tür \U0001f697"}
    for number, name in ((1, "s78"), (2, "Tür \U0001f697")):
        matte = channels["crypto_part00.R"] == np.uint32(int(manifest[name], 16)).view(np.float32)
        assert (matte == (numbers == number)).all()
    assert (channels["crypto_part00.G"] == (numbers > 0)).all()
    assert not channels["crypto_part00.B"].any()
    assert not channels["crypto_part00.A"].any()
    assert attributes["cryptomatte/5a1484c/name"] == "crypto_part"
    assert f"{murmur_hash(b'crypto_part'):08x}".startswith("5a1484c")


@pytest.mark.needs("OpenEXR")
def test_the_file_has_all_channels_and_attributes_bit_for_bit(tmp_path: Path) -> None:
    import OpenEXR

    scene = car_with_named_lights()
    picture = render(scene, SIZE)
    save_layers(tmp_path / "car.exr", scene, picture)
    file = OpenEXR.File(BytesIO((tmp_path / "car.exr").read_bytes()), separate_channels=True)
    channels, attributes = layers_of(scene, picture)
    read = {name: channel.pixels for name, channel in file.channels().items()}
    assert read.keys() == channels.keys()
    for name, values in channels.items():
        assert read[name].tobytes() == values.tobytes()
    assert attributes.items() <= file.header().items()
    assert json.loads(attributes["autocolor/lights"]) == {"rim_left": "rim.left", "depth_2": "depth"}


@pytest.mark.needs("OpenEXR")
@pytest.mark.parametrize("smooth", first(1, [2, 1]))
def test_a_picture_from_a_file_has_the_same_layers(tmp_path: Path, smooth: int) -> None:
    scene = scene_of(cube(), scalar={"name": "z"})
    picture = render(scene, SIZE, smooth=smooth)
    write_picture(tmp_path / "cube.npz", picture=picture, scene=scene)
    saved = read_picture(tmp_path / "cube.npz")
    save_layers(tmp_path / "a.exr", scene, picture)
    save_layers(tmp_path / "b.exr", saved.scene, saved.picture)
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


@pytest.mark.needs("OpenEXR")
def test_a_file_is_never_written_over_unasked_nor_under_another_suffix(tmp_path: Path) -> None:
    scene = scene_of(cube())
    picture = render(scene, (8, 6))
    path = tmp_path / "cube.exr"
    path.write_text("old")
    with pytest.raises(OutputError, match="exists"):
        save_layers(path, scene, picture)
    assert path.read_text() == "old"
    save_layers(path, scene, picture, overwrite=True)
    assert path.read_bytes().startswith(b"\x76\x2f\x31\x01")
    with pytest.raises(UsageError, match=r"layers must be written to a file that ends in \.exr"):
        save_layers(tmp_path / "cube.png", scene, picture)


@pytest.mark.parametrize("version", [None, "1.3.9", "3.4.17"])
def test_without_a_library_that_is_new_enough_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, version: str | None
) -> None:
    library = None if version is None else ModuleType("OpenEXR")
    if library is not None:
        library.__dict__["__version__"] = version
    monkeypatch.setitem(sys.modules, "OpenEXR", library)
    scene = scene_of(cube())
    with pytest.raises(UnavailableError) as caught:
        save_layers(tmp_path / "cube.exr", scene, render(scene, (8, 6)))
    assert str(caught.value) == (
        "to write layers, the package OpenEXR must be installed, at least version 3.5; run: pip install"
        ' "OpenEXR>=3.5"'
    )
