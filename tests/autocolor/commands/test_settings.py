from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from autocolor import Flap, Flaps, HalfSpace, Scene, Surface, read_scene
from autocolor.commands.settings import settings_after, with_settings
from autocolor.errors import UsageError
from autocolor.files.settings import place_of, value_at
from autocolor.scene.changes import HalfSpaceChanges
from tests.small import scene_folder
from tests.tables import refused


@cache
def scene() -> Scene:
    """Two squares with two lights: key with a half-space "left" and another "a.b", and "key.2"."""
    with TemporaryDirectory() as folder:
        scene = read_scene(scene_folder(Path(folder) / "scene"))
    plane: HalfSpaceChanges = {"point": (0, 0, 0), "direction": (0, 0, 1)}
    return scene.with_light("key", half_spaces={"left": plane, "a.b": plane})


@pytest.mark.parametrize(
    ("settings", "value"),
    [
        # Every kind of key.
        ("ambient=0.25", 0.25),
        ("mapping=[[0,0],[0.5,0.75],[1,1]]", ((0, 0), (0.5, 0.75), (1, 1))),
        ("background=#102030", (16, 32, 48)),
        ("view.angle=10", 10),
        (" lights.key.aim = [1, 0, 0] ", (1, 0, 0)),
        ("parts.side.surface=front.low", "front.low"),
        # The last value counts.
        ("ambient=0.1; ambient=0.2", 0.2),
        # A name may hold points and stand in quotes.
        ("surfaces.front.low.blend=0.125", 0.125),
        ('surfaces."front.low".blend=0.125', 0.125),
        # Each setting of a row may break a rule alone, in any order.
        ("lights.key.2.concentration=5; lights.key.2.aim=[0, 0, 0]", (0, 0, 0)),
        ("lights.key.2.aim=[0, 0, 0]; lights.key.2.concentration=5", 5),
        ("lights.key.flaps.z.minimum=2; lights.key.flaps.z.maximum=3", 3),
        # A flap is set whole or field by field.
        ("lights.key.flaps.z.maximum=0.75", 0.75),
        ("lights.key.flaps.x={maximum = 0.25, on = false}", Flap(maximum=0.25, on=False)),
        # none unsets what may be absent.
        ("surfaces.side.levels=20; surfaces.side.levels=none", None),
        ("lights.key.flaps.z.maximum=none", math.inf),
        ("lights.key.flaps.z=none", None),
        ("lights.key.flaps=none", Flaps()),
        ("lights.key.direction=[0, 1, 0]; lights.key.aim=none ", None),
        # Names are a list, with or without brackets and quotes.
        ("lights.key.only_surfaces=side,front.low", ("side", "front.low")),
        ("lights.key.only_surfaces=side, 'front.low'", ("side", "front.low")),
        ("lights.key.except_parts=side", ("side",)),
        ("lights.key.except_parts=[]", ()),
        ("lights.key.except_parts=side; lights.key.except_parts=none", None),
        # A word, a name or nothing.
        ("lights.key.follows=eye", "eye"),
        ("lights.key.follows=eye; lights.key.follows=None", None),
        # Half-spaces are removed, and changed field by field.
        ("lights.key.half_spaces=none", ()),
        ("lights.key.half_spaces.left=none", None),
        ("lights.key.half_spaces.left.on=false", False),
        ("lights.key.half_spaces.a.b.edge_width=0.5", 0.5),
    ],
)
def test_a_field_is_set_by_its_key(settings: str, value: object) -> None:
    *_, last = settings.split(";")
    changed = with_settings(scene(), tuple(settings.split(";")))
    assert value_at(changed, place_of(scene(), last.partition("=")[0].strip())) == value


def test_of_two_names_the_longer_is_meant() -> None:
    changed = with_settings(scene(), ("lights.key.2.intensity=3", "lights.key.intensity=2"))
    assert [light.intensity for light in changed.lights] == [2, 3]
    rows = with_settings(scene(), ("lights.key.half_spaces.a.b.on=false",)).lights["key"].half_spaces
    assert [row.on for row in rows] == [False, True]


def test_a_half_space_is_added_whole() -> None:
    door = "{point = [0, 0, 0], direction = [1, 0, 0], edge_width = 0.5, carried = true}"
    for name in ("barn door", '"barn door"'):
        added = with_settings(scene(), (f"lights.key.2.half_spaces.{name}={door}",))
        assert added.lights["key.2"].half_spaces == (
            HalfSpace("barn door", (0, 0, 0), (1, 0, 0), 0.5, carried=True),
        )


def test_a_scalar_is_set_where_there_was_none_in_any_order_and_unset() -> None:
    changed = with_settings(scene(), ("scalar.bands=8", "scalar.limits=[0,250]", "scalar.name=z"))
    assert changed.scalar is not None
    assert (changed.scalar.name, changed.scalar.bands, changed.scalar.limits) == ("z", 8, (0.0, 250.0))
    other = with_settings(changed, ("scalar.scale=magma", "scalar.limits=none"))
    assert other.scalar == changed.with_scalar(scale="magma", limits=None).scalar
    assert with_settings(other, ("scalar=none",)).scalar is None


def test_what_is_named_none_stays_a_name() -> None:
    named = scene().replace(surfaces=(*scene().surfaces, Surface("none"), Surface("a, b")))
    assert with_settings(named, ("parts.side.surface=none",)).parts["side"].surface == "none"
    with pytest.raises(UsageError):
        with_settings(named, ("parts.side.surface=None",))
    changed = with_settings(named, ("surfaces.none.levels=9", "surfaces.none.levels=none"))
    assert changed.surfaces["none"].levels is None
    linked = with_settings(named, ('lights.key.only_surfaces="a, b"',)).lights["key"].links
    assert linked.only_surfaces == ("a, b",)


FIELD = "it must name a field; write it as in lights.key.intensity or view.angle"
UNSET = "only an optional field can be unset"

test_what_cannot_be_set = refused(
    lambda settings: with_settings(scene(), settings.split(";")),
    [
        ("=0.2", "--set must be KEY=VALUE, not '=0.2'; write it as in lights.key.intensity=2"),
        ("ambient", "--set must be KEY=VALUE, not 'ambient'; write it as in lights.key.intensity=2"),
        # A key that names nothing.
        ("lights=1", f"--set lights: {FIELD}"),
        ("scalar.=1", f"--set scalar.: {FIELD}"),
        (
            "lights.key.2.half_spaces.left.on=false",
            "--set lights.key.2.half_spaces.left.on: there is no half-space 'left'; add a half-space with all"
            " its keys in a table",
        ),
        (
            "lights.key.half_spaces.lft=none",
            "--set: light 'key': half_spaces.lft: there is no half-space of this name; did you mean 'left'?",
        ),
        ("lights.key.a.x=1", "--set: light 'key': there is no field 'a'; did you mean 'aim'?"),
        ("lights.key.on.x=1", "--set: light 'key': on must be true or false, not {'x': 1}"),
        # A table and its fields.
        (
            "lights.key.flaps.x={maximum = 1}; lights.key.flaps.x.minimum=0",
            "--set lights.key.flaps.x.minimum: lights.key.flaps.x is also set, as a whole; leave one out",
        ),
        # What must have a value.
        (
            "lights.key.half_spaces.left.on=none",
            f"--set lights.key.half_spaces.left.on: it must be true or false, not none; {UNSET}",
        ),
        # A value that breaks a rule of the scene, whose sentence is the scene's.
        ("view.direction=none", "--set: view: it must have either a direction or a target; give one of them"),
    ],
)


@pytest.mark.parametrize(
    ("start", "some"),
    [
        ("lights.key.", "aim= flaps. cone_angle= half_spaces. follows= only_parts= 2."),
        ("lights.key.half_spaces.", "a.b. left."),
        ("lights.key.half_spaces.a.b.", "point= on="),
        ("lights.key.half_spaces.left.edge_width=", "0.0"),
        ("lights.key.follows=", "none eye key.2"),
        ("lights.key.position=", "[2.0,-3.0,4.0]"),
        ("parts.side.surface=", "side front.low"),
        ("scalar.", "name= limits= bands="),
        ("scalar.name=", "z"),
        ("scalar.scale=", "viridis zebra_r"),
        ("mapping=", "linear gamma equalize"),
        ("lights.key.flaps.z.maximum=", "0.5"),
        ("surfaces.side.model=", "phong blinn"),
    ],
)
def test_what_follows_a_start_are_the_keys_of_its_table_or_the_values(start: str, some: str) -> None:
    found = settings_after(scene(), start)
    assert {f"{start}{each}" for each in some.split()} <= set(found)
    assert all(each.startswith(start) for each in found)
    assert not {"lights.key.name=", "lights.key.half_spaces.a.b.name=", "scalar.name=none"} & set(found)
