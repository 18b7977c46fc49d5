"""The script of a session: its lines, and that it gives the same words and entries when it is run."""

from __future__ import annotations

import ast
import contextlib
import math
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import autocolor
from autocolor import (
    InputError,
    Light,
    Mesh,
    Scene,
    Studio,
    UsageError,
    View,
    read_journal,
    read_scene,
    scene_of,
)
from autocolor.journal.history import Drop, Edit, History, Keep, Open, Saved, Show, Step
from autocolor.journal.opening import checksum_of, opened
from autocolor.journal.places import Source
from autocolor.journal.reading import session_of
from autocolor.journal.script import MeshesBeside, call_between, journal_text, literal, step_line
from autocolor.scene.changes import HalfSpaceChanges, LightChanges
from autocolor.scene.creation import new_light_of
from autocolor.scene.scene import AUTO
from ramtek_emu import Ramtek9300
from tests.autocolor.linked_scenes import linked
from tests.autocolor.meshes import cube
from tests.autocolor.sessions import SMALL, car, held
from tests.autocolor.strategies import MAPPINGS, colors, exposures, lights, numbers, surfaces, views
from tests.autocolor.test_studio import any_edits, apply, recolorings

CAR = car()
NAMES = ["key", "fill", "rim"]


def linked_lights(lights: tuple[Light, ...]) -> st.SearchStrategy[tuple[Light, ...]]:
    """The lights with half-spaces and links, following each other."""
    return linked(CAR.replace(lights=lights)).map(lambda scene: scene.lights)


columns_of_scenes = st.fixed_dictionaries(
    {},
    optional={
        "parts": st.tuples(*[st.sampled_from(["body", "glass", "wheels"])] * 3).map(
            lambda names: tuple(
                part.replace(surface=name, stage=name == "glass")
                for part, name in zip(CAR.parts, names, strict=True)
            )
        ),
        "surfaces": st.tuples(*(surfaces(name) for name in ("body", "glass", "wheels"))),
        "lights": st.tuples(*(lights(name) for name in NAMES)).flatmap(
            lambda three: st.integers(0, 3).flatmap(lambda count: linked_lights(three[:count]))
        ),
        "view": views(),
        "ambient": numbers(0, 1),
        "scaling": st.sampled_from(["surface", "object"]),
        "mapping": st.sampled_from(MAPPINGS),
        "contrast": st.sampled_from(["stretch", "floor"]),
        "exposure": exposures,
        "dither": st.sampled_from(["off", "ordered"]),
        "division": st.sampled_from(["covered", "equal"]),
        "background": colors,
        "name": st.sampled_from(["scene", "a 'name'\n", "\N{SNOWMAN}"]),
    },
)
OTHER = scene_of(cube(), name="other")
LARGER = CAR.replace(
    mesh=Mesh(CAR.mesh.coordinates * 2, CAR.mesh.node_numbers, CAR.mesh.part_numbers, CAR.mesh.part_names, 17)
)

moves = (
    any_edits
    | recolorings
    | st.tuples(st.just("columns"), st.booleans(), columns_of_scenes)
    | st.tuples(st.sampled_from(["undo", "redo"]), st.none(), st.none())
    | st.tuples(st.just("add_light"), st.sampled_from(NAMES), lights())
    | st.tuples(st.just("remove_light"), st.sampled_from(NAMES), st.none())
    | st.tuples(st.just("open"), st.sampled_from(["car", "box.obj"]), st.sampled_from(["materials", "parts"]))
    | st.tuples(st.just("mesh"), st.booleans(), st.sampled_from([CAR, LARGER, OTHER]))
    | st.tuples(st.sampled_from(["keep", "show", "drop"]), st.sampled_from("AB"), st.none())
    | st.tuples(st.sampled_from(["hold", "release", "saved"]), st.none(), st.none())
)


def do(studio: Studio, move: tuple[str, Any, Any], folder: Path) -> None:
    """Make a move of a session, unless it is refused. Files to open are in a folder."""
    kind, what, value = move
    with contextlib.suppress(InputError, UsageError):
        if kind == "columns":
            studio.edit(studio.scene.replace(**value), same_step=what)
        elif kind in ("undo", "redo"):
            getattr(studio, kind)()
        elif kind == "add_light":
            studio.edit(studio.scene.replace(lights=(*studio.scene.lights, value.replace(name=what))))
        elif kind == "remove_light":
            studio.remove_light(what)
        elif kind == "open":
            studio.open(folder / what, surfaces=value)
        elif kind == "mesh":
            studio.edit(value, same_step=what)
        elif kind in ("keep", "show", "drop"):
            getattr(studio, f"{kind}_variant")(what)
        elif kind in ("hold", "release"):
            getattr(studio, f"{kind}_exposure")()
        elif kind == "saved":
            studio.mark_saved({"/car/scene.toml": "9f"})
        else:
            apply(studio, move)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("journal") / "car"
    autocolor.write_scene(folder, CAR)
    (folder.parent / "box.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 1 1\ng a\nf 1 2 3\ng b\nf 1 3 4\n")
    return folder


def run_script(text: str) -> tuple[Studio, Ramtek9300]:
    """The studio and the display of a script that is run, on a small display."""
    display = Ramtek9300(SMALL)
    names: dict[str, Any] = {}
    assert text.count("Ramtek9300())") == 1
    exec(text.replace("Ramtek9300())", "display)"), {"display": display}, names)
    studio = names["studio"]
    assert isinstance(studio, Studio)
    return studio, display


class State(NamedTuple):
    """What a display holds, and what is known of the scene it shows."""

    words: bytes
    entries: bytes
    ranges: dict[str, Any]
    is_changed: bool


def state(studio: Studio, display: Ramtek9300) -> State:
    return State(*held(display), dict(studio.level_ranges), studio.is_changed)


def states(studio: Studio, display: Ramtek9300) -> list[State]:
    """What there is after each step back to the beginning, and forth to the end."""
    studio.refine()
    found = [state(studio, display)]
    while studio.redo():
        found.append(state(studio, display))
    while studio.undo():
        found.append(state(studio, display))
    return found


@settings(max_examples=40)
@given(st.lists(moves, max_size=8))
def test_any_session_is_given_by_its_script_run_or_read_byte_for_byte(
    written: Path, made: list[tuple[str, Any, Any]]
) -> None:
    display = Ramtek9300(SMALL)
    studio = Studio(read_scene(written), display)
    first = state(studio, display)
    for move in made:
        do(studio, move, written.parent)
    path = written.parent / "session.py"
    beside = written.parent / "beside"
    text = studio.journal(written, beside=beside)
    path.write_text(text, "utf-8")
    session = read_journal(path)
    read, other = Ramtek9300(SMALL), Ramtek9300(SMALL)
    again = Studio(session.history, read)
    assert again.journal(beside=beside) == text
    assert again.variants.keys() == studio.variants.keys()
    assert again.history.left_unsaved == studio.history.left_unsaved
    expected = states(studio, display)
    ran, other = run_script(text)
    assert states(ran, other) == expected
    assert states(again, read) == expected
    assert expected[-1]._replace(is_changed=False) == first


def test_a_drag_after_a_redo_and_one_that_came_back_are_given_by_the_script(written: Path) -> None:
    display = Ramtek9300(SMALL)
    studio = Studio(read_scene(written), display)
    studio.recolor("body", blend=0.25)
    studio.recolor("body", blend=0.75)
    studio.undo()
    studio.redo()
    studio.edit(studio.scene.with_view(angle=5), same_step=True)
    studio.view(angle=10)
    studio.edit(studio.scene.with_view(angle=5), same_step=True)
    text = studio.journal(written)
    assert text.count("same_step=True") == 2
    other = Ramtek9300(SMALL)
    read = Studio(session_of(text).history, other)
    expected = states(studio, display)
    assert len(expected) == 4
    assert states(*run_script(text)) == expected
    assert states(read, other) == expected


def test_what_a_light_has_by_name_is_told_by_what_was_changed(written: Path) -> None:
    scene = read_scene(written)
    door: HalfSpaceChanges = {"point": (0, 0, 1), "direction": (0, 1, 0)}
    steps: list[LightChanges] = [
        {"half_spaces": {"left": door}},
        {"half_spaces": {"my 'door'": door, "left": {"edge_width": 0.5}}},
        {"half_spaces": {"left": {"name": "right"}}, "follows": "eye"},
        {"half_spaces": {"right": None}, "only_surfaces": ["body", "glass"]},
        {"half_spaces": (), "only_surfaces": None, "except_surfaces": [], "follows": None},
    ]
    display = Ramtek9300(SMALL)
    studio = Studio(scene, display)
    for changes in steps:
        studio.light("key", **changes)
    text = studio.journal(written)
    new = "'point': [0.0, 0.0, 1.0], 'direction': [0.0, 1.0, 0.0]"
    sharp = f"{{{new}, 'edge_width': 0.0, 'carried': False, 'on': True}}"
    soft = sharp.replace("0.0, 'carried'", "0.5, 'carried'")
    assert text.splitlines()[-5:] == [
        f"studio.light('key', half_spaces={{'left': {sharp}}})",
        f"studio.light('key', half_spaces={{'left': {{'edge_width': 0.5}}, \"my 'door'\": {sharp}}})",
        f"studio.light('key', half_spaces={{'left': None, 'right': {soft}}}, follows='eye')",
        "studio.light('key', half_spaces={'right': None}, only_surfaces=['body', 'glass'])",
        "studio.light('key', half_spaces={\"my 'door'\": None}, follows=None, only_surfaces=None,"
        " except_surfaces=[])",
    ]
    again = session_of(text).history
    assert again.scene.replace(mesh=scene.mesh).equals(studio.scene)
    assert len(again.to_undo) == len(steps)
    assert run_script(text)[0].scene.replace(mesh=scene.mesh).equals(studio.scene)


def lines_of(*scenes: Scene) -> list[str]:
    return [step_line(Edit(before, after), CAR, MeshesBeside()) for before, after in pairwise(scenes)]


def test_each_kind_of_step_has_the_narrowest_line() -> None:
    painted = CAR.with_surface("body", blend=0.25, object_color="red")
    matt = painted.with_surface("body", model="blinn")
    off = matt.with_light("key", on=False, cone_angle=None)
    turned = off.with_view(angle=3, target=None, direction=(0, 1, 0))
    more = turned.with_new_light("rim", position=(1, 2, 3))
    fewer = more.without_light("key")
    stage = fewer.with_part("pane", stage=True)
    many = stage.replace(ambient=0.5, background="navy")
    held_on = many.replace(exposure={"object": (0.1, 1.5)})
    free = held_on.replace(exposure="auto")
    assert lines_of(CAR, painted, matt, off, turned, more, fewer, stage, many, held_on, free) == [
        "studio.recolor('body', object_color='#ff0000', blend=0.25)",
        "studio.surface('body', model='blinn', exponent=20.0)",
        "studio.light('key', on=False, cone_angle=None)",
        "studio.view(direction=[0.0, 1.0, 0.0], target=None, angle=3.0)",
        "studio.add_light('rim', position=[1.0, 2.0, 3.0], intensity=1.0, on=True,"
        " concentration=0.0, flaps={}, falloff='none', at_infinity=False)",
        "studio.remove_light('key')",
        "studio.edit(studio.scene.with_part('pane', stage=True))",
        "studio.edit(studio.scene.replace(ambient=0.5, background='#000080'))",
        "studio.hold_exposure({'object': [0.1, 1.5]})",
        "studio.release_exposure()",
    ]


def test_steps_of_the_scalar_have_lines_of_their_own() -> None:
    shown = CAR.with_scalar(name="z", bands=8)
    limited = shown.with_scalar(limits=[0, 1], scale=["red", "blue"])
    free = limited.with_scalar(limits=None)
    assert lines_of(CAR, shown, limited, free, CAR) == [
        "studio.scalar(name='z', scale='viridis', bands=8, missing='#808080', legend=True,"
        " direction=[0.0, 0.0, 1.0], stripes=12.0)",
        "studio.scalar(limits=[0.0, 1.0], scale=['#ff0000', '#0000ff'])",
        "studio.scalar(limits=None)",
        "studio.scalar(None)",
    ]
    for after, call in ((free, "with_scalar(limits=None)"), (CAR, "without_scalar()")):
        line = step_line(Edit(limited, after, joins=True), CAR, MeshesBeside())
        assert line == f"studio.edit(studio.scene.{call}, same_step=True)"


def test_what_is_undone_with_the_step_before_says_so() -> None:
    line = step_line(Edit(CAR, CAR.with_light("key", on=False), joins=True), CAR, MeshesBeside())
    assert line == "studio.edit(studio.scene.with_light('key', on=False), same_step=True)"


def test_a_limit_that_was_taken_away_is_told() -> None:
    narrow = CAR.with_light("fill", flaps={"z": {"maximum": 0.5}})
    wide = narrow.with_light("fill", flaps={"z": {"maximum": math.inf}})
    assert lines_of(narrow, wide) == ["studio.light('fill', flaps={'z': {'maximum': 1e999}})"]
    assert narrow.with_light("fill", flaps={"z": {"maximum": float("1e999")}}).equals(wide)


def test_lights_in_another_order_are_told_in_full() -> None:
    (line,) = lines_of(CAR, CAR.replace(lights=CAR.lights[::-1]))
    assert line.startswith("studio.edit(studio.scene.replace(lights=[{'name': 'fill', 'position': [-3.0")


@pytest.mark.parametrize(
    "after",
    [
        CAR.with_copied_light("key"),
        CAR.with_mirrored_light("key", "y"),
        CAR.only_lights("fill"),
        CAR.only_lights("fill").with_all_lights_on(),
        CAR.with_light("key", name="main"),
        CAR.with_rig(CAR.with_light("key", position=(9, 8, 7)).rig),
        CAR.replace(lights=(*CAR.lights, new_light_of(CAR))),
    ],
)
def test_every_edit_of_lights_is_told(after: Scene) -> None:
    call = call_between(CAR, after)
    again = getattr(CAR, call.method)(*call.names, **ast.literal_eval(literal(call.changes)))
    assert again.equals(after)


def test_only_the_mesh_must_still_be_in_the_files(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", CAR)
    studio = Studio(read_scene(tmp_path / "car").replace(ambient=0.75), Ramtek9300(SMALL))
    studio.light("key", on=False)
    text = studio.journal(tmp_path / "car")
    other = studio.scene.replace(ambient=0.25, lights=(), view=View((0, 0, 9), direction=(0, 0, -1)))
    autocolor.write_scene(tmp_path / "car", other, overwrite=True)
    again = run_script(text)[0].scene
    assert again.equals(studio.scene.replace(mesh=again.mesh))
    assert session_of(text).history.scene.lights == studio.scene.lights


def test_the_checksum_is_that_of_all_values(written: Path) -> None:
    scene = read_scene(written)
    assert checksum_of(scene) == checksum_of(read_scene(written))
    mesh = scene.mesh
    other = Mesh(mesh.coordinates * 2, mesh.node_numbers, mesh.part_numbers, mesh.part_names)
    different = [scene.replace(mesh=other), scene.replace(ambient=0.2), scene.replace(exposure=AUTO)]
    assert [checksum_of(each) == checksum_of(scene) for each in different] == [False, False, True]


def test_steps_of_files_and_variants_have_lines_of_their_own(tmp_path: Path) -> None:
    step = Open(CAR, Source(str(tmp_path / "car.obj"), "y", "parts"))
    beside = MeshesBeside(tmp_path)
    line = step_line(step, CAR, beside)
    begin = (
        f"studio.open('{tmp_path / 'car.obj'}', up='y', surfaces='parts', tables={{'parts': [{{'name': 'hood'"
    )
    assert line.startswith(begin)
    assert line.endswith(f", checksum='{checksum_of(CAR)}')")
    steps: list[Step] = [Keep("A"), Show("it's"), Drop("A"), Saved(CAR, {"/car.npz": "9f"}), "undo"]
    assert [step_line(each, CAR, beside) for each in steps] == [
        "studio.keep_variant('A')",
        'studio.show_variant("it\'s")',
        "studio.drop_variant('A')",
        "studio.mark_saved({'/car.npz': '9f'})",
        "studio.undo()",
    ]


def test_a_scale_is_told_and_read_again(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    source = Source(str(tmp_path / "car.obj"), "y", "parts", 0.5)
    scene, place = opened(source)
    assert scene.mesh.coordinates.tolist() == [[0, 0, 0], [0.5, 0, 0], [0.5, 0, 0.5]]
    text = journal_text(History(scene, place), source, MeshesBeside())
    assert "up='y', surfaces='parts', scale=0.5)" in text
    assert session_of(text).source == source
    line = step_line(Open(scene, source), scene, MeshesBeside())
    assert ", up='y', surfaces='parts', scale=0.5, tables=" in line
    again = session_of(f"{text}{line}\n").history.scene
    assert checksum_of(again) == checksum_of(scene)


def test_another_mesh_is_named_with_what_else_was_changed(tmp_path: Path) -> None:
    beside = MeshesBeside(tmp_path)
    line = step_line(Edit(CAR, LARGER.replace(ambient=0.75)), CAR, beside)
    path = tmp_path / "scene-2"
    assert line == (
        f"studio.edit(studio.scene.replace(mesh=autocolor.read_scene('{path}').mesh, ambient=0.75))"
    )
    assert step_line(Edit(LARGER, CAR, joins=True), CAR, beside) == (
        "studio.edit(studio.scene.replace(mesh=scene.mesh), same_step=True)"
    )


def test_literals_are_read_as_they_were() -> None:
    values: list[Any] = ["it's \"\n\ud800", -0.0, 1e-320, -math.inf, True, None, [1, [2.5]], {"a": {}}]
    assert eval(literal(values)) == values
    assert literal([-math.inf, -0.0]) == "[-1e999, -0.0]"


# -------------------- test_meshes_beside
# Changed meshes beside a journal: each once, and exactly.


def larger(scene: Scene, crease_angle: float = 40.0) -> Scene:
    mesh = scene.mesh
    return scene.replace(
        mesh=Mesh(mesh.coordinates * 1.1, mesh.node_numbers, mesh.part_numbers, mesh.part_names, crease_angle)
    )


def test_a_mesh_is_saved_once_and_read_back_as_it_was(tmp_path: Path) -> None:
    beside = MeshesBeside(tmp_path / "session")
    one, other = larger(car(), 17.0), larger(car())
    path = beside.path_of(one)
    assert path == tmp_path / "session" / "scene-2"
    assert beside.path_of(one.replace(ambient=0.9)) == path
    assert beside.path_of(other) == tmp_path / "session" / "scene-3"
    again = read_scene(path).mesh
    assert np.array_equal(again.coordinates, one.mesh.coordinates)
    assert np.array_equal(again.node_numbers, one.mesh.node_numbers)
    assert again.part_names == one.mesh.part_names
    assert again.crease_angle == 17.0


def test_a_mesh_that_was_read_from_there_is_not_saved_again(tmp_path: Path) -> None:
    path = MeshesBeside(tmp_path).path_of(larger(car()))
    before = sorted(tmp_path.iterdir())
    assert MeshesBeside(tmp_path).path_of(read_scene(path)) == path
    assert sorted(tmp_path.iterdir()) == before


def test_without_a_folder_a_changed_mesh_is_refused() -> None:
    with pytest.raises(InputError) as refusal:
        MeshesBeside().path_of(car())
    assert str(refusal.value) == (
        "a mesh that a session changed must be saved beside its journal, and no folder is named for it; name"
        " one with beside="
    )
