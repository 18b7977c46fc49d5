"""Every column of every row, with another value than its default, on every way that a scene takes.

`EDITS` has an edit for each key of each table. A new column is a line there; a test says which is missing.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from autocolor import (
    Light,
    Mesh,
    MeshScalar,
    NamedView,
    Picture,
    Scene,
    Studio,
    frames,
    read_journal,
    read_picture,
    read_rig,
    read_scene,
    render,
    scene_of,
    write_picture,
    write_rig,
    write_scene,
)
from autocolor.commands.settings import with_settings
from autocolor.files.settings import scene_with
from autocolor.journal.history import History
from autocolor.journal.journal import MeshesBeside, first_line, step_line
from autocolor.journal.places import Source
from autocolor.journal.script import script_of
from autocolor.mapping.normal_words import far_light
from autocolor.scene.columns import (
    MISSING,
    Row,
    RowError,
    Tier,
    fields_of,
    from_plain,
    keys_of,
    to_plain,
    with_values,
)
from autocolor.scene.kinds import Number, Whole
from autocolor.scene.lights import Flap, HalfSpace
from autocolor.scene.scalar import Scalar
from autocolor.scene.scene import costs_at_least
from autocolor.scene.surfaces import Part, Surface
from autocolor.scene.view import View
from tests.small import cube, grid

Values = Mapping[str, Any]

OF_A_VIEW: dict[str, Values] = {
    "eye": {"eye": [1, -5, 2]},
    "direction": {"direction": [0, 1, 0.25]},
    "target": {"target": [0.25, 0, 0.5]},
    "angle": {"angle": 12},
    "field_of_view": {"field_of_view": 50},
}

EDITS: dict[str, dict[str, Values]] = {
    "": {
        "ambient": {"ambient": 0.25},
        "scaling": {"scaling": "object"},
        "mapping": {"mapping": [[0, 0.1], [0.4, 0.8], [1, 1]]},
        "contrast": {"contrast": "floor"},
        "exposure": {"exposure": {"body": [0.1, 0.9], "object": [0, 2]}},
        "dither": {"dither": "ordered"},
        "division": {"division": "equal"},
        "words": {"words": "normals"},
        "interpolation": {"interpolation": "invariant"},
        "front": {"front": "-x"},
        "background": {"background": "#102030"},
        "stage": {"stage": "bowl"},
        "backdrop": {"backdrop": ["#102030", "#8090a0"]},
    },
    "view": OF_A_VIEW,
    "views": OF_A_VIEW,
    "scalar": {
        "name": {"name": "stress"},
        "limits": {"name": "z", "limits": [-0.25, 0.5]},
        "legend_place": {"name": "z", "legend_place": [0.25, 0.5]},
        "scale": {"name": "z", "scale": ["#000000", "#ff8000", "#ffffff"]},
        "bands": {"name": "z", "bands": 7},
        "shades": {"name": "z", "shades": 3},
        "below": {"name": "z", "below": "#0000ff"},
        "above": {"name": "z", "above": "#ff0000"},
        "missing": {"name": "z", "missing": "#010203"},
        "legend": {"name": "z", "legend": False},
        "surfaces": {"name": "z", "surfaces": ["glass"]},
        "direction": {"name": "distance", "direction": [1, 0, 0.5]},
        "stripes": {"name": "zebra", "stripes": 20},
    },
    "parts": {
        "surface": {"surface": "glass"},
        "stage": {"stage": True},
    },
    "surfaces": {
        "diffuse": {"diffuse": 0.3},
        "specular": {"specular": 0.9},
        "model": {"model": "blinn"},
        "exponent": {"exponent": 7},
        "base_reflectance": {"base_reflectance": 0.04},
        "refractive_index": {"refractive_index": 1.5},
        "fresnel_curve": {"fresnel_curve": [[0, 0.04], [60, 0.1], [90, 1]]},
        "roughness": {"model": "cook-torrance", "roughness": 0.5},
        "normal_reflectance": {"model": "cook-torrance", "normal_reflectance": 0.5},
        "object_color": {"object_color": "#b01020"},
        "light_color": {"light_color": "#fff0e0"},
        "blend": {"blend": 0.25},
        "light_percentage": {"light_percentage": 40},
        "ramp": {"ramp": ["#220000", "#ff6600", "#ffffff"]},
        "two_sided": {"two_sided": False},
        "levels": {"levels": 99},
    },
    "lights": {
        "position": {"position": [2, -3, 4]},
        "intensity": {"intensity": 0.5},
        "on": {"on": False},
        "direction": {"aim": None, "direction": [-1, 1, -1]},
        "aim": {"aim": [0.25, 0.5, 0]},
        "concentration": {"concentration": 5},
        "cone_angle": {"cone_angle": 40},
        "inner_angle": {"cone_angle": 40, "inner_angle": 30},
        "flaps": {"flaps": {"x": {"minimum": -0.25}, "z": {"maximum": 0.5}}},
        "half_spaces": {"half_spaces": {"left door": {"point": [0, 0, 1], "direction": [1, 0, 0]}}},
        "falloff": {"falloff": "linear", "reach": 9},
        "reach": {"falloff": "quadratic", "reach": 8},
        "at_infinity": {"at_infinity": True},
        "follows": {"follows": "rim"},
        "only_surfaces": {"only_surfaces": ["body"]},
        "except_surfaces": {"except_surfaces": ["glass"]},
        "only_parts": {"only_parts": ["cube"]},
        "except_parts": {"except_parts": []},
    },
    "flaps": {
        "minimum": {"minimum": -0.25},
        "maximum": {"maximum": 0.5},
        "on": {"maximum": 0.5, "on": False},
        "edge_width": {"maximum": 0.5, "edge_width": 0.125},
    },
    "half_spaces": {
        "point": {"point": [0, 0, 1], "direction": [1, 0, 0]},
        "direction": {"point": [0, 0, 0], "direction": [0, 0.5, 1]},
        "edge_width": {"point": [0, 0, 0], "direction": [1, 0, 0], "edge_width": 0.25},
        "carried": {"point": [0, 0, 0], "direction": [1, 0, 0], "carried": True},
        "on": {"point": [0, 0, 0], "direction": [1, 0, 0], "on": False},
    },
}
"""For each key of each table, keys and values that give it another value than its default."""

CLASSES: dict[str, type[Row]] = {
    "": Scene,
    "view": View,
    "views": NamedView,
    "scalar": Scalar,
    "parts": Part,
    "surfaces": Surface,
    "lights": Light,
    "flaps": Flap,
    "half_spaces": HalfSpace,
}

ROWS = {"views": "hood", "parts": "cube", "surfaces": "body", "lights": "key"}
"""The row of each table that is edited."""

NOT_EDITED = {
    "": {"mesh", "parts", "surfaces", "lights", "view", "views", "scalar", "name"},
    "views": {"name"},
    "parts": {"name"},
    "surfaces": {"name"},
    "lights": {"name"},
    "half_spaces": {"name"},
}
"""The tables, which have edits of their own, the mesh, and names; a scene has the name of its file."""

CASES = [pytest.param(table, key, id=f"{table}.{key}".strip(".")) for table in EDITS for key in EDITS[table]]
LIGHT_CASES = [case for case in CASES if case.values[0] in ("lights", "flaps", "half_spaces")]
every_column = pytest.mark.parametrize(("table", "key"), CASES)
every_column_of_a_light = pytest.mark.parametrize(("table", "key"), LIGHT_CASES)


@cache
def start() -> Scene:
    """A scene of two parts and two lights, in which every column has its default as far as it can."""
    mesh = Mesh.joined([cube(), grid(2, 2, (-1.5, -1, -1), (1, 0, 0), (0, 0, 1), "pane")])
    mesh = mesh.with_scalars(MeshScalar("stress", np.arange(float(len(mesh.coordinates))), "node"))
    return scene_of(
        mesh,
        surface_of_part={"cube": "body", "pane": "glass"},
        surfaces=[Surface("body"), Surface("glass")],
        lights=[Light("key", (2, -4, 3), aim=(0, 0, 0)), Light("rim", (-3, 2, 1), aim=(0, 0, 0.5))],
        view=View((1, -4, 1), target=(0, 0, 0)),
        views=[NamedView("hood", View((1, -4, 1), target=(0, 0, 0)))],
    )


def edited(scene: Scene, table: str, key: str) -> Scene:
    """The scene with another value in one column."""
    values: Any = EDITS[table][key]
    if table == "":
        return scene.replace(**values)
    if table == "view":
        return scene.with_view(**values)
    if table == "views":
        return scene.with_named_view("hood", **values)
    if table == "scalar":
        return scene.with_scalar(**values)
    if table == "parts":
        return scene.with_part("cube", **values)
    if table == "surfaces":
        return scene.with_surface("body", **values)
    if table == "flaps":
        values = {"flaps": {"y": values}}
    if table == "half_spaces":
        values = {"half_spaces": {"door": values}}
    return scene.with_light("key", **values)


def row_of(scene: Scene, table: str) -> Row | None:
    """The row of a scene that the edits of a table change."""
    if table in ("flaps", "half_spaces"):
        light = scene.lights["key"]
        return light.flaps.y if table == "flaps" else next(iter(light.half_spaces), None)
    if table in ROWS:
        (row,) = (row for row in vars(scene)[table] if row.name == ROWS[table])
    else:
        row = scene if table == "" else vars(scene)[table]
    assert row is None or isinstance(row, Row)
    return row


def default_of(cls: type[Row], key: str) -> object:
    """The plain value of a key that is left out; None for a key that must be given."""
    field = keys_of(cls)[key].field
    column = fields_of(cls)[field]
    return None if column.default in (None, MISSING) else column.kind.to_plain(field, column.default).get(key)


def test_every_key_has_an_edit() -> None:
    for table, cls in CLASSES.items():
        assert set(EDITS[table]) == set(keys_of(cls)) - NOT_EDITED.get(table, set())


def test_an_edit_gives_a_column_another_value_than_its_default() -> None:
    for table, edits in EDITS.items():
        for key in edits:
            row = row_of(edited(start(), table, key), table)
            assert row is not None
            assert to_plain(row)[key] != default_of(CLASSES[table], key), key


def same(one: Scene, other: Scene) -> bool:
    """Whether two scenes are equal in every column but their names and meshes."""
    return with_values(one, {"mesh": other.mesh, "name": other.name}).equals(other)


class Session(NamedTuple):
    """A session that begins with the start: its folder, what it read, and the names of its script."""

    folder: Path
    start: Scene
    names: dict[str, Any]

    def history(self, scene: Scene) -> History:
        """The history of the session, in which the edit that makes the scene is a step."""
        history = History(self.start)
        history.take(self.read(scene))
        return history

    def read(self, scene: Scene) -> Scene:
        """The scene as if it were read from the folder."""
        return with_values(scene, {"mesh": self.start.mesh, "name": self.start.name})

    def script_of(self, history: History) -> str:
        return script_of(history, Source(str(self.folder)), MeshesBeside())


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    folder = tmp_path_factory.mktemp("session")
    write_scene(folder, start())
    session = Session(folder, read_scene(folder), {})
    exec(session.script_of(History(session.start)), session.names)
    return session


@cache
def picture_of_start() -> Picture:
    return render(start(), (16, 12))


def by_scene_file(scene: Scene, folder: Path, session: Session) -> Scene:
    write_scene(folder, start())
    write_scene(folder, scene, overwrite=True)
    return read_scene(folder)


def by_table_store(scene: Scene, folder: Path, session: Session) -> Scene:
    write_scene(folder / "scene.sqlite", scene)
    return read_scene(folder / "scene.sqlite")


def by_picture_file(scene: Scene, folder: Path, session: Session) -> Scene:
    # An edit that costs less than a sum of lights leaves the picture as it is.
    is_rendered = costs_at_least(start(), scene, Tier.MIX)
    picture = render(scene, (16, 12)) if is_rendered else picture_of_start()
    write_picture(folder / "scene.npz", scene, picture)
    return read_picture(folder / "scene.npz").scene


def replayed(history: History, folder: Path, session: Session) -> History:
    """The history that the journal of a history gives."""
    meshes = MeshesBeside()
    lines = [step_line(step, history.start, meshes) for step in history.steps]
    first = first_line(history.start, Source(str(session.folder)))
    (folder / "journal").write_text("".join([first, *lines]))
    return read_journal(folder / "journal").history


def by_journal(scene: Scene, folder: Path, session: Session) -> Scene:
    return replayed(session.history(scene), folder, session).scene


def by_start_of_journal(scene: Scene, folder: Path, session: Session) -> Scene:
    """The journal of a session that began with the edited scene."""
    return replayed(History(session.read(scene)), folder, session).start


def by_script(scene: Scene, folder: Path, session: Session) -> Scene:
    """The step of the script of a session, whose beginning was run before."""
    beginning = session.script_of(History(session.start))
    script = session.script_of(session.history(scene))
    assert script.startswith(beginning)
    exec(script.removeprefix(beginning), session.names)
    studio = session.names["studio"]
    assert isinstance(studio, Studio)
    edited = studio.scene
    studio.take_back()
    return edited


WAYS = (
    by_scene_file,
    by_table_store,
    by_picture_file,
    by_journal,
    by_start_of_journal,
    by_script,
)


@every_column
def test_a_column_comes_through_every_way(tmp_path: Path, session: Session, table: str, key: str) -> None:
    scene = edited(start(), table, key)
    assert not same(scene, start())
    for way in WAYS:
        folder = tmp_path / way.__name__
        folder.mkdir()
        assert same(scene, way(scene, folder, session)), way


@every_column
def test_a_value_of_another_kind_is_refused_by_the_rule_of_the_column(table: str, key: str) -> None:
    rule = keys_of(CLASSES[table])[key].column.kind.rule()
    with pytest.raises(RowError) as caught:
        from_plain(CLASSES[table], {**EDITS[table][key], key: {1, 2}})
    sentences = [problem.sentence for problem in caught.value.row_problems]
    assert any(sentence.startswith(f"{key} {rule}, not {{1, 2}}") for sentence in sentences)


NUMBERS = {
    "finite number of at least 0": "ambient surfaces.diffuse surfaces.specular surfaces.exponent "
    "lights.intensity lights.concentration flaps.edge_width half_spaces.edge_width",
    "finite number": "view.angle views.angle flaps.minimum flaps.maximum",
    "number from 0.01 to 179": "view.field_of_view views.field_of_view",
    "whole number from 2 to 256": "scalar.bands",
    "whole number from 1 to 256": "scalar.shades",
    "number from 1 to 1000": "scalar.stripes",
    "number from 0.001 to 1": "surfaces.base_reflectance surfaces.normal_reflectance",
    "number from 1.07 to 10": "surfaces.refractive_index",
    "number from 0.01 to 1": "surfaces.roughness",
    "number from 0 to 1": "surfaces.blend",
    "number from 0 to 100": "surfaces.light_percentage",
    "whole number from 2 to 1000000": "surfaces.levels",
    "number above 0 and at most 180": "lights.cone_angle",
    "number from 0 to 180": "lights.inner_angle",
    "number above 0": "lights.reach",
}
"""The columns of numbers, by what each of them must be."""


def test_every_number_has_its_limits() -> None:
    rules = {
        f"{table}.{key}".strip("."): column.kind.rule()
        for table, cls in CLASSES.items()
        for key, (column, _) in keys_of(cls).items()
        if isinstance(column.kind, (Number, Whole))
    }
    assert rules == {key: f"must be a {rule}" for rule, keys in NUMBERS.items() for key in keys.split()}


@every_column
def test_a_column_is_set_on_the_command_line(table: str, key: str) -> None:
    within = {"flaps": "lights.key.flaps.y", "half_spaces": "lights.key.half_spaces.door"}
    prefix = within.get(table) or ".".join(filter(None, (table, ROWS.get(table, ""))))
    values = EDITS[table][key]
    if table == "half_spaces":
        # A row that does not exist is given whole, as a table.
        fields = ", ".join(f"{name} = {toml(value)}" for name, value in values.items())
        lines = [f"{prefix}={{{fields}}}"]
    else:
        lines = [f"{prefix}.{name}={toml(value)}".lstrip(".") for name, value in values.items()]
    assert same(with_settings(start(), tuple(lines)), edited(start(), table, key))


def toml(value: Any) -> str:
    """A value as TOML; "none" for None."""
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{name}" = {toml(inner)}' for name, inner in value.items()) + "}"
    return "none" if value is None else json.dumps(value)


@every_column_of_a_light
def test_a_column_comes_through_copies_and_rigs(tmp_path: Path, table: str, key: str) -> None:
    scene = edited(start(), table, key)
    light = scene.lights["key"]
    assert scene.with_copied_light("key", "copy").lights["copy"].replace(name="key") == light
    twice = scene.with_mirrored_light("key", "x", 0.25, "there").with_mirrored_light(
        "there", "x", 0.25, "back"
    )
    back, plain = to_plain(twice.lights["back"].replace(name="key")), to_plain(light)
    assert numbers_in(back) == pytest.approx(numbers_in(plain))
    assert without_numbers(back) == without_numbers(plain)
    assert same(scene.with_rig(scene.rig), scene)
    write_rig(tmp_path / "lights.toml", scene)
    assert read_rig(tmp_path / "lights.toml").lights == scene.lights


SCALED_BY_RIGS = {"position", "aim", "flaps", "half_spaces", "reach"}
"""The places and lengths of a light: they are measured by the object."""


@every_column_of_a_light
def test_a_rig_fitted_to_another_object_scales_places_and_lengths_and_keeps_the_rest(
    table: str, key: str
) -> None:
    rig = edited(start(), table, key).rig
    low, high = rig.minimum, rig.maximum
    (fitted, _) = rig.fitted(tuple(2 * each for each in low), tuple(2 * each for each in high))  # type: ignore[arg-type]
    before, after = to_plain(rig.lights[0]), to_plain(fitted)
    assert {name for name in before if before[name] != after[name]} <= SCALED_BY_RIGS
    assert without_numbers(before) == without_numbers(after)


NOT_FAR_AWAY = {"position", "at_infinity", "only_parts", "except_parts", "direction", "aim", "concentration"}
NOT_FAR_AWAY |= {"cone_angle", "inner_angle", "flaps", "half_spaces", "falloff", "reach"}
"""The columns that a far light has in another way, or not at all: they depend on the place of a point."""


@every_column_of_a_light
def test_a_far_light_keeps_all_columns_but_its_place_and_its_links_to_parts(table: str, key: str) -> None:
    light = edited(start(), table, key).lights_in_world["key"]
    far, plain = to_plain(far_light(light, (0.0, 0.0, 0.0))), to_plain(light)
    assert {name for name in plain if far.get(name) != plain[name]} <= NOT_FAR_AWAY
    assert "only_parts" not in far
    assert "except_parts" not in far


def numbers_in(value: object) -> list[float]:
    """The numbers in a plain value, in their order."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        return [number for each in value for number in numbers_in(each)]
    return [value] if isinstance(value, float) else []


def without_numbers(value: object) -> object:
    """A plain value with 0 in place of each number."""
    if isinstance(value, dict):
        return {name: without_numbers(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_numbers(each) for each in value]
    return 0 if isinstance(value, float) else value


def settings_of(table: str, key: str) -> dict[str, object]:
    """The edit of a column as settings by key."""
    if table in ("flaps", "half_spaces"):
        row = "y" if table == "flaps" else "door"
        return {f"lights.key.{table}": {row: EDITS[table][key]}}
    place = ".".join(filter(None, (table, ROWS.get(table))))
    return {f"{place}.{name}".lstrip("."): value for name, value in EDITS[table][key].items()}


@every_column
def test_between_two_values_of_a_column_there_are_settings_for_the_rows_between(table: str, key: str) -> None:
    one, other = start(), edited(start(), table, key)
    edit = settings_of(table, key)
    assert scene_with(one, edit).equals(other)
    for variants, between in (
        ([{}, edit], one.between(other, 0.5)),
        ([edit, {}], other.between(one, 0.5)),
    ):
        _, middle, _ = frames(one, variants, 3)
        assert scene_with(one, middle.settings).equals(between)
