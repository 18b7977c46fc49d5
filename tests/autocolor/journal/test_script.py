"""The script of a session: its statements, and that it gives the same words and entries when it is run."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Scene, Studio, read_scene
from autocolor.journal.history import Drop, Edit, History, Keep, Move, Open, Rename, Saved, Show, Step
from autocolor.journal.journal import MeshesBeside
from autocolor.journal.places import Source, checksum_of, opened
from autocolor.journal.script import literal, script_of, step_statement
from autocolor.scene.changes import HalfSpaceChanges, LightChanges
from ramtek_emu import Ramtek9300
from tests.autocolor.journal.random_steps import CAR, moves, take_move, written_scenes
from tests.small import SMALL, held


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(written_scenes(tmp_path_factory.mktemp("scenes")).path)


def run_script(text: str) -> tuple[Studio, Ramtek9300]:
    """The studio and the display of a script that is run, on a small display."""
    display = Ramtek9300(SMALL)
    names: dict[str, Any] = {}
    assert text.count("Studio(scene)") == 1
    exec(text.replace("Studio(scene)", "Studio(scene, display)"), {"display": display}, names)
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


@given(st.lists(moves, max_size=8))
def test_a_script_that_is_run_gives_the_session_byte_for_byte(
    written: Path, taken: list[tuple[str, Any, Any]]
) -> None:
    display = Ramtek9300(SMALL)
    studio = Studio(read_scene(written), display)
    first, first_view = state(studio, display), studio.scene.view
    for move in taken:
        take_move(studio, move, written.parent)
    text = studio.journal(written, beside=written.parent / "beside")
    expected = states(studio, display)
    assert states(*run_script(text)) == expected
    studio.edit(studio.scene.replace(view=first_view))
    assert state(studio, display)._replace(is_changed=False) == first


def test_what_a_light_has_by_name_is_told_by_what_was_changed(written: Path) -> None:
    scene = read_scene(written)
    door: HalfSpaceChanges = {"point": (0, 0, 1), "direction": (0, 1, 0)}
    steps: list[LightChanges] = [
        {"half_spaces": {"my 'door'": door, "left": {**door, "edge_width": 0.5}}},
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
    assert text.splitlines()[-4:] == [
        f"studio.light('key', half_spaces={{'left': {soft}, \"my 'door'\": {sharp}}})",
        f"studio.light('key', half_spaces={{'left': None, 'right': {soft}}}, follows='eye')",
        "studio.light('key', half_spaces={'right': None}, only_surfaces=['body', 'glass'])",
        "studio.light('key', half_spaces={\"my 'door'\": None}, follows=None, only_surfaces=None,"
        " except_surfaces=[])",
    ]
    assert run_script(text)[0].scene.replace(mesh=scene.mesh).equals(studio.scene)


def statements_of(*scenes: Scene) -> list[str]:
    return [step_statement(Edit(before, after), CAR, MeshesBeside()) for before, after in pairwise(scenes)]


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
    wide = free.with_light("fill", flaps={"z": {"minimum": -math.inf}})
    steps = (CAR, painted, matt, off, turned, more, fewer, stage, many, held_on, free, wide)
    assert statements_of(*steps) == [
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
        "studio.edit(studio.scene.replace(exposure='auto'))",
        "studio.light('fill', flaps={'z': {'minimum': -1e999}})",
    ]


def test_steps_of_the_scalar_have_lines_of_their_own() -> None:
    shown = CAR.with_scalar(name="z", bands=8)
    limited = shown.with_scalar(limits=[0, 1], scale=["red", "blue"])
    free = limited.with_scalar(limits=None)
    assert statements_of(CAR, shown, limited, free, CAR) == [
        "studio.scalar(name='z', scale='viridis', bands=8, missing='#808080', legend=True,"
        " direction=[0.0, 0.0, 1.0], stripes=12.0)",
        "studio.scalar(limits=[0.0, 1.0], scale=['#ff0000', '#0000ff'])",
        "studio.scalar(limits=None)",
        "studio.scalar(None)",
    ]
    for after, call in ((free, "with_scalar(limits=None)"), (CAR, "without_scalar()")):
        line = step_statement(Edit(limited, after, joins=True), CAR, MeshesBeside())
        assert line == f"studio.edit(studio.scene.{call}, same_step=True)"


def test_steps_of_files_and_variants_have_lines_of_their_own(tmp_path: Path) -> None:
    step = Open(CAR, Source(str(tmp_path / "car.obj"), "y", "parts"))
    beside = MeshesBeside(tmp_path)
    line = step_statement(step, CAR, beside)
    begin = (
        f"studio.open('{tmp_path / 'car.obj'}', up='y', surfaces='parts', tables={{'parts': [{{'name': 'hood'"
    )
    assert line.startswith(begin)
    assert line.endswith(f", checksum='{checksum_of(CAR)}')")
    back = [Move("undo"), Move("redo", 3), Move("view_back")]
    steps: list[Step] = [
        Keep("A"),
        Show("it's"),
        Drop("A"),
        Rename("B", "C"),
        Saved(CAR, {"/car.npz": "9f"}),
        *back,
    ]
    assert [step_statement(each, CAR, beside) for each in steps] == [
        "studio.keep_variant('A')",
        'studio.show_variant("it\'s")',
        "studio.drop_variant('A')",
        "studio.rename_variant('B', 'C')",
        "studio.mark_saved({'/car.npz': '9f'})",
        "studio.undo()",
        "studio.redo(3)",
        "studio.view_back()",
    ]


def test_a_scale_is_in_the_script(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    source = Source(str(tmp_path / "car.obj"), "y", "parts", 0.5)
    scene, place = opened(source)
    text = script_of(History(scene, place), source, MeshesBeside())
    assert "up='y', surfaces='parts', scale=0.5)" in text
    again = run_script(text)[0].scene
    assert checksum_of(again) == checksum_of(scene)
    assert again.mesh.coordinates.tolist() == [[0, 0, 0], [0.5, 0, 0], [0.5, 0, 0.5]]


def test_literals_are_read_as_they_were() -> None:
    values: list[Any] = ["it's \"\n\ud800", -0.0, 1e-320, -math.inf, True, None, [1, [2.5]], {"a": {}}]
    assert eval(literal(values)) == values
    assert literal([-math.inf, -0.0]) == "[-1e999, -0.0]"
