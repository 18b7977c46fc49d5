"""The strategies and checks that other programs use, and the tests in docs/TESTING.md."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pytest
from hypothesis import Phase, find, given, settings
from hypothesis import strategies as st

import ramtek_emu.testing
from autocolor import Scene, Studio, render, scene_of, testing
from autocolor.mapping.ranges import LevelRange
from autocolor.testing import (
    Recoloring,
    check_entries_outside_range_stay,
    check_recoloring_moves_no_word,
    level_ranges,
    paints,
    recolorings,
    scenes,
)
from ramtek_emu import Ramtek9300
from tests.small import SMALL, car, cube, opened
from tests.tables import call, refused

Value = TypeVar("Value")

PAGE = Path(__file__).parents[2] / "docs" / "TESTING.md"


def simplest(strategy: st.SearchStrategy[Value], is_it: Callable[[Value], bool]) -> Value:
    """The simplest value that hypothesis finds."""
    phases = [Phase.generate, Phase.shrink]
    return find(
        strategy, is_it, settings=settings(max_examples=200, phases=phases, database=None, derandomize=True)
    )


def test_failing_values_shrink_to_simple_values() -> None:
    assert simplest(paints(), lambda paint: paint.object_color[1] > 7).object_color == (0, 8, 0)
    recoloring = simplest(recolorings(["hood"]), lambda each: "blend" in each.changes)
    assert recoloring.changes == {"blend": 0.0}
    ranges = simplest(level_ranges(), lambda ranges: len(ranges) > 1)
    assert ranges == {"surface 0": LevelRange(1, 2), "surface 1": LevelRange(3, 2)}


EDGES: list[tuple[st.SearchStrategy[Any], Callable[[Any], float], tuple[float, ...]]] = [
    (testing.numbers(0, 1), float, (0, 1)),
    (testing.numbers(-3, 2), float, (-3, 2)),
    (testing.coordinates(), float, (-2, 0, 2)),
    (testing.colors(), min, (0, 255)),
    (testing.blended_paints(), lambda paint: paint.blend, (0, 1)),
    (testing.blended_paints(), lambda paint: paint.light_percentage, (0, 100)),
    (testing.lights(), lambda light: light.intensity, (0,)),
    (testing.lights(), lambda light: light.cone_angle or 0.0, (0, 1)),
    (testing.edge_widths(), float, (0, 0.01, 2)),
    (testing.reflectances(), lambda each: each.diffuse, (0, 2)),
    (testing.reflectances(), lambda each: each.specular, (0, 2)),
    (testing.scene_columns()["ambient"], float, (0, 1)),
    (testing.scalars(), lambda row: row.bands, (2, 20)),
    (testing.scalars(), lambda row: row.shades or 0, (0, 1)),
    (testing.scalars(), lambda row: (row.limits or (9, 9))[0], (-8, 0, 9)),
    (testing.meshes(), lambda mesh: len(mesh.node_numbers), (1, 8)),
    (testing.meshes(), lambda mesh: len(mesh.coordinates), (3, 18)),
    (testing.surfaces("body"), lambda surface: surface.levels or 0, (0, 2)),
    (testing.ramps(), len, (2, 9)),
]


@pytest.mark.parametrize(("strategy", "number", "edge"), [(*row[:2], e) for row in EDGES for e in row[2]])
def test_a_strategy_reaches_its_edges(
    strategy: st.SearchStrategy[Any], number: Callable[[Any], float], edge: float
) -> None:
    unhurried = settings(max_examples=5000, phases=[Phase.generate], database=None, derandomize=True)
    find(strategy, lambda value: number(value) == edge, settings=unhurried)


CAR = car()


@given(scenes(mesh=CAR.mesh, lights=CAR.lights[:1], parts=CAR.parts, surfaces=CAR.surfaces, scalar=None))
def test_fields_that_are_given_are_not_random(scene: Scene) -> None:
    assert scene.mesh is CAR.mesh
    assert (scene.parts, scene.surfaces, scene.scalar) == (CAR.parts, CAR.surfaces, None)
    assert scene.lights == CAR.lights[:1]


@given(recolorings())
def test_a_recoloring_of_a_scene_and_of_a_studio_are_the_same(recoloring: Recoloring) -> None:
    studio, _ = opened()
    assert recoloring(studio) is studio
    recolored = recoloring(car())
    assert isinstance(recolored, Scene)
    assert recolored.surfaces == studio.scene.surfaces


@given(scenes(), recolorings())
def test_a_recoloring_moves_no_word_and_no_entry_of_another_surface(
    scene: Scene, recoloring: Recoloring
) -> None:
    for picture in (None, render(scene, (12, 9))):
        check_recoloring_moves_no_word(scene, recoloring, picture=picture)
        check_entries_outside_range_stay(scene, recoloring, recoloring.surface, picture=picture)


def darker(subject: Any) -> Any:
    """An edit of a scene, or of a studio, that moves words."""
    if isinstance(subject, Scene):
        return subject.with_light("key", position=(3.0, -4.0, 0.0))
    return subject.light("key", position=(3.0, -4.0, 0.0))


def message_of(check: Callable[[], None]) -> str:
    with pytest.raises(AssertionError) as failure:
        check()
    return str(failure.value)


@pytest.mark.parametrize("subject", [car(), opened()[0]], ids=["scene", "studio"])
def test_words_that_move_are_counted_and_the_first_is_told(subject: Any) -> None:
    text = message_of(lambda: check_recoloring_moves_no_word(subject, darker))
    match = re.match(
        r"a recoloring must move no word, but (\d+) of 768 words moved, the first at line (\d+), element"
        r" (\d+): (\d+) became (\d+)$",
        text,
    )
    assert match, text
    count, line, element, before, after = map(int, match.groups())
    words = [opened()[1].words, opened(darker(car()))[1].words]
    assert count == np.count_nonzero(words[0] != words[1]) > 0
    assert [int(each[line, element]) for each in words] == [before, after]
    assert (words[0] != words[1]).ravel().argmax() == line * 32 + element


def test_words_that_are_written_again_without_a_change_are_counted() -> None:
    studio, _ = opened()
    text = message_of(lambda: check_recoloring_moves_no_word(studio, Studio.send_everything))
    assert re.match(r"a recoloring must move no word, but \d+ words were written again$", text), text


def test_words_of_a_picture_that_move_are_told_of_its_own_size() -> None:
    def few_levels(scene: Scene) -> Scene:
        return scene.with_surface("body", levels=2)

    picture = render(car(), (16, 12))
    text = message_of(lambda: check_recoloring_moves_no_word(car(), few_levels, picture=picture))
    assert " of 192 words moved" in text
    text = message_of(lambda: check_recoloring_moves_no_word(car(), darker, picture=picture))
    assert text == "a recoloring must need no other picture, but the edited scene does"


@pytest.mark.parametrize(
    ("surfaces", "named"),
    [
        ("wheels", "'wheels' ({wheels})"),
        (["glass", "wheels"], "'glass' ({glass}) and 'wheels' ({wheels})"),
        ([], "no surface"),
    ],
)
@pytest.mark.parametrize("kind", ["scene", "studio"])
def test_entries_outside_of_the_ranges_are_told(kind: str, surfaces: str | list[str], named: str) -> None:
    studio = opened()[0]
    ranges, before = studio.level_ranges, studio.entries
    edit = Recoloring("body", {"object_color": "#0000ff", "light_color": "#0000ff"})
    after = opened(car().with_paint("body", **edit.changes))[0].entries
    subject: Any = car() if kind == "scene" else studio
    text = message_of(lambda: check_entries_outside_range_stay(subject, edit, surfaces))
    changed = np.flatnonzero((before != after).any(axis=1))
    colors = ["#{:02x}{:02x}{:02x}".format(*table[changed[0]]) for table in (before, after)]
    spans = {name: f"{levels.first} to {levels.last}" for name, levels in ranges.items()}
    assert text == (
        f"the entries outside the range of {named.format(**spans)} must stay, but {len(changed)} changed, the"
        f" first is entry {changed[0]}: {colors[0]} became {colors[1]}"
    )


def test_the_background_is_outside_of_every_range() -> None:
    def red(scene: Scene) -> Scene:
        return scene.replace(background="#ff0000")

    text = message_of(lambda: check_entries_outside_range_stay(car(), red, ["body", "glass", "wheels"]))
    assert text.endswith("must stay, but 1 changed, the first is entry 0: #000000 became #ff0000")


def test_a_range_that_moves_is_told() -> None:
    def levels(scene: Scene) -> Scene:
        return scene.with_surface("body", levels=20)

    text = message_of(lambda: check_entries_outside_range_stay(car(), levels, "body"))
    assert re.match(r"the range of 'body' \(1 to \d+\) must stay, but it became 1 to 20$", text), text


def test_a_surface_of_no_part_has_no_entries_to_change() -> None:
    scene = car()
    scene = scene.replace(surfaces=[*scene.surfaces, scene.surfaces[0].replace(name="spare")])
    check_entries_outside_range_stay(scene, Recoloring("spare", {"blend": 0.1}), "spare")
    blend = Recoloring("body", {"blend": 0.1})
    text = message_of(lambda: check_entries_outside_range_stay(scene, blend, "spare"))
    assert text.startswith("the entries outside the range of 'spare' (no words) must stay, but ")


class Elsewhere:
    """A display of which only its port is at hand."""

    def __init__(self) -> None:
        self.display = Ramtek9300(SMALL)
        self.configuration, self.send, self.receive = SMALL, self.display.send, self.display.receive


def test_of_a_display_elsewhere_the_words_that_the_studio_has_are_compared() -> None:
    studio = Studio(car(), Elsewhere())
    check_recoloring_moves_no_word(studio, Recoloring("body", {"blend": 0.1}))
    check_entries_outside_range_stay(studio, Recoloring("body", {"blend": 0.2}), "body")
    assert " of 768 words moved" in message_of(lambda: check_recoloring_moves_no_word(studio, darker))


test_wrong_calls_of_the_checks_are_refused = refused(
    call,
    [
        (
            lambda: check_recoloring_moves_no_word(car(), lambda scene: None),
            "an edit of a scene must return the edited Scene, not None",
        ),
        (
            lambda: check_recoloring_moves_no_word(opened()[0], darker, picture=render(car(), (2, 2))),
            "a picture must come with its scene; leave it out, a studio has its own picture",
        ),
        (
            lambda: check_entries_outside_range_stay(car(), Recoloring("body", {}), "bodi"),
            "there is no surface 'bodi'; did you mean 'body'?",
        ),
        (
            lambda: check_recoloring_moves_no_word(car(), darker, picture=render(scene_of(cube()), (2, 2))),
            "the surfaces of a picture must be those of the scene, ['body', 'glass', 'wheels'], not"
            " ['surface']; render this scene, or use the scene that was rendered",
        ),
    ],
)


@pytest.mark.parametrize("module", ["autocolor.testing", "ramtek_emu.testing"])
def test_without_hypothesis_it_is_named_with_its_command(
    monkeypatch: pytest.MonkeyPatch, module: str
) -> None:
    monkeypatch.delitem(sys.modules, module, raising=False)
    monkeypatch.setitem(sys.modules, "hypothesis", None)
    with pytest.raises(ModuleNotFoundError) as refusal:
        __import__(module)
    assert str(refusal.value) == f"{module} needs the package hypothesis; run: pip install hypothesis"


EXAMPLES = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text("utf-8"), re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_tests_of_the_page_pass(example: str) -> None:
    names: dict[str, Any] = {}
    exec(example, names)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    assert tests
    for test in tests:
        test()


def test_the_page_names_every_strategy_and_check() -> None:
    text = PAGE.read_text("utf-8")
    for module in (testing, ramtek_emu.testing):
        for name, value in vars(module).items():
            if getattr(value, "__module__", "") == module.__name__ and name[0].islower():
                assert f"{name}(" in text, name
