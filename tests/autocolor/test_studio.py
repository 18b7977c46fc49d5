"""The studio with a real display: what is sent, and what the display then shows."""

from __future__ import annotations

import copy
import itertools
import pickle
import re
import warnings
import weakref
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import autocolor
from autocolor import (
    EditWarning,
    InputError,
    OutputError,
    Scene,
    Studio,
    Surface,
    UsageError,
    image,
    read_picture,
    read_scene,
    scene_of,
    testing,
)
from autocolor.journal.history import Move
from autocolor.mapping.ranges import SCREENS
from autocolor.rendering import Rendering, rendering
from autocolor.testing import (
    Recoloring,
    check_entries_outside_range_stay,
    check_recoloring_moves_no_word,
    colors,
    limits,
    numbers,
    scales,
    scenes,
    vectors,
)
from ramtek_emu import GMR_9300, Ramtek9300
from tests.small import SMALL, car, cube, fresh, held, opened
from tests.tables import refused

Edit = tuple[str, str, dict[str, Any]]
"""A kind of edit, the row that it changes, and the changes."""

SURFACES = st.sampled_from(["body", "glass", "wheels"])


def edits(
    kind: str, row: st.SearchStrategy[str], **changes: st.SearchStrategy[Any]
) -> st.SearchStrategy[Edit]:
    """Edits of a kind, each with some of the changes."""
    return st.tuples(st.just(kind), row, st.fixed_dictionaries({}, optional=changes))


own_recolorings = testing.recolorings(["body", "glass", "wheels"])
recolorings = own_recolorings.map(lambda each: ("recolor", each.surface, dict(each.changes)))
reflectances = {
    "diffuse": numbers(0, 2),
    "specular": numbers(0, 2),
    "exponent": st.sampled_from([0.0, 1.0, 30.0]),
    "blend": numbers(0, 1),
}
surface_edits = edits(
    "surface", SURFACES, two_sided=st.booleans(), levels=st.none() | st.integers(2, 300), **reflectances
)
light_edits = edits(
    "light",
    st.sampled_from(["key", "fill"]),
    position=vectors(numbers(3, 5)),
    aim=vectors(numbers(-1, 1)),
    intensity=st.just(0.0) | numbers(0, 3),
    on=st.booleans(),
    concentration=numbers(0, 40),
    cone_angle=st.none() | numbers(5, 180),
    flaps=st.fixed_dictionaries({"x": st.none() | st.just({"minimum": 0.1})}),
)
scene_edits = edits(
    "scene",
    st.just(""),
    ambient=numbers(0, 1),
    scaling=st.sampled_from(["surface", "object"]),
    mapping=st.sampled_from(["linear", "gamma", "equalize", ((0.0, 0.0), (0.5, 0.9), (1.0, 1.0))]),
    contrast=st.sampled_from(["stretch", "floor"]),
    background=colors(),
)
view_edits = edits("view", st.just(""), angle=numbers(-90, 90), field_of_view=numbers(20, 60))
scale_edits = edits("scalar", st.just(""), scale=scales(), missing=colors())
level_edits = edits(
    "scalar",
    st.just(""),
    limits=st.none() | limits(),
    bands=st.integers(2, 200),
    shades=st.none() | st.integers(1, 12),
    below=st.none() | colors(),
    above=st.none() | colors(),
    surfaces=st.none() | st.lists(SURFACES, unique=True),
    legend=st.booleans(),
)
scalar_choices = st.tuples(
    st.just("scalar"), st.just(""), st.fixed_dictionaries({"name": st.sampled_from(["stress", "z"])})
)
any_edits: st.SearchStrategy[Edit] = (
    recolorings
    | surface_edits
    | light_edits
    | scene_edits
    | view_edits
    | scalar_choices
    | scale_edits
    | level_edits
    | st.just(("scalar", "none", {}))
)
normals_edits = edits(
    "scene",
    st.just(""),
    words=st.sampled_from(["levels", "normals"]),
    division=st.sampled_from(["covered", "equal"]),
)


def apply(studio: Studio, edit: Edit) -> bool:
    """Whether the edit was taken; a refused one must leave everything as it was."""
    kind, name, changes = edit
    before = (studio.scene, studio.picture, studio.words, repr(studio))
    try:
        if kind == "scene":
            studio.edit(studio.scene.replace(**changes))
        elif kind == "view":
            studio.view(**changes)
        elif kind == "scalar" and name == "none":
            studio.scalar(None)
        elif kind == "scalar":
            studio.scalar(**changes)
        else:
            getattr(studio, kind)(name, **changes)
    except InputError:
        assert (studio.scene, studio.picture, studio.words, repr(studio)) == before
        return False
    return True


def opened_with(words: Any) -> tuple[Studio, Ramtek9300]:
    """A studio with the car, whose words stand for levels or for normals."""
    return opened(car().replace(words=words))


in_both_ways = pytest.mark.parametrize("words", ["levels", "normals"])


@given(st.lists(own_recolorings, min_size=1, max_size=6))
def test_recoloring_sends_the_entries_of_one_surface_and_no_word(edits: list[Recoloring]) -> None:
    studio, display = opened()
    for edit in edits:
        field, written = display.field(), display.lookup_table.written

        def outside_stays(studio: Studio, edit: Recoloring = edit) -> None:
            check_entries_outside_range_stay(studio, edit, edit.surface)

        check_recoloring_moves_no_word(studio, outside_stays)
        # Two words an entry.
        assert display.lookup_table.written - written <= 2 * studio.level_ranges[edit.surface].levels
        changed = (display.field() != field).any(axis=2)
        number = studio.picture.surfaces.index(edit.surface) + 1
        assert (studio.picture.surface_number[changed] == number).all()
    assert held(display) == fresh(studio.scene)


SEEN = "surface 'body' has these colors already; the recoloring changes nothing"
UNSEEN = "surface 'spare' has no polygons; no picture shows its colors"


@pytest.mark.parametrize(
    ("surface", "color", "sentence"), [("body", "#b0b0b0", SEEN), ("spare", "red", UNSEEN)]
)
def test_a_recoloring_that_no_picture_shows_says_so(surface: str, color: str, sentence: str) -> None:
    scene = car()
    studio, _ = opened(scene.replace(surfaces=[*scene.surfaces, Surface("spare")]))
    with pytest.warns(EditWarning, match=f"^{re.escape(sentence)}$") as caught:
        studio.recolor(surface, object_color=color)
    # The warning is at the line of the caller.
    assert [each.filename for each in caught] == [__file__]
    assert len(studio.history.to_undo) == (surface == "spare")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        studio.recolor("body", object_color="navy")


def test_a_studio_is_used_by_one_thread_at_a_time() -> None:
    # Where words stand for normals, the picture is rendered when it is asked for.
    studio, display = opened_with("normals")
    studio.light("key", intensity=0.5)
    problems: list[str] = []

    def use(edit: Callable[[], object]) -> None:
        try:
            edit()
        except UsageError as problem:
            problems.append(str(problem))

    def at_once(_: object) -> None:
        """Use the studio while its display receives words, from this thread and from another."""
        assert studio.seen_at(12, 16) is not None
        for edit in (lambda: studio.recolor("body", blend=0.3), studio.undo, lambda: studio.picture):
            in_thread(edit)
        in_thread(lambda: studio.scene)

    def in_thread(edit: Callable[[], object]) -> None:
        thread = Thread(target=use, args=(edit,))
        thread.start()
        thread.join()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(display, "send", at_once)
        studio.recolor("body", blend=0.1)
    assert problems == 3 * [
        "a studio must be used by one thread at a time, not by two at once; make a Studio for each thread, or"
        " wait until the other thread is ready"
    ]
    in_thread(lambda: studio.recolor("boddy", blend=0.2))
    studio.recolor("body", blend=0.2)
    assert problems[3:] == ["there is no surface 'boddy'; did you mean 'body'?"]


@given(st.sampled_from(["stress", "z"]), st.lists(scale_edits, min_size=1, max_size=4))
def test_another_color_scale_writes_no_word_and_the_entries_of_colored_surfaces_alone(
    name: str, edits: list[Edit]
) -> None:
    studio, display = opened(car().with_scalar(name=name, surfaces=["body", "wheels"], below="#00ff00"))
    colored = ("body", "wheels")

    def all_edits(studio: Studio) -> None:
        for edit in edits:
            entries_written = display.lookup_table.written
            assert apply(studio, edit)
            # Two words an entry.
            most = 2 * sum(studio.level_ranges[name].levels for name in colored)
            assert display.lookup_table.written - entries_written <= most

    check_recoloring_moves_no_word(
        studio, lambda studio: check_entries_outside_range_stay(studio, all_edits, colored)
    )
    assert held(display) == fresh(studio.scene)


def test_a_ramp_is_one_table_load_of_the_surface_s_entries_and_no_word() -> None:
    studio, display = opened()
    levels = studio.level_ranges["body"].levels
    received, entries = display.words_received, display.entries
    ramp = Recoloring("body", {"ramp": ["#200", "#f60", "#fff"]})
    check_entries_outside_range_stay(studio, ramp, "body")
    assert display.words_received - received == 3 + 2 * levels
    assert held(display) == fresh(studio.scene)
    assert studio.undo()
    assert (display.entries == entries).all()


def test_the_legend_follows_the_scale_by_entries_alone_and_the_limits_by_its_numbers() -> None:
    display = Ramtek9300()
    studio = Studio(car().with_scalar(name="z"), display)

    def held_anew() -> bool:
        anew = Ramtek9300()
        Studio(studio.scene, anew)
        return held(display) == held(anew)

    assert (display.words != studio.words).any()
    check_recoloring_moves_no_word(studio, lambda studio: studio.scalar(scale="magma"))
    assert held_anew()
    numbers = display.words.copy()
    studio.scalar(limits=[-0.25, 0.75])
    assert (display.words != numbers).any()
    assert held_anew()
    studio.scalar(legend=False)
    assert (display.words == studio.words).all()
    studio.undo()
    assert held_anew()


@in_both_ways
@given(st.lists(any_edits | normals_edits, min_size=1, max_size=6))
def test_any_edits_leave_what_a_fresh_studio_sends_and_undo_takes_them_back(
    words: str, edits: list[Edit]
) -> None:
    studio, display = opened_with(words)
    start, looks, memories = studio.scene, [studio.scene], held(display)
    for edit in edits:
        # An edit that changes nothing leaves the scene. A view is no step.
        if apply(studio, edit) and studio.scene is not looks[-1]:
            looks[len(looks) - (edit[0] == "view") :] = [studio.scene]
            memories = held(display)
        assert held(display) == memories
    anew, other = opened(studio.scene)
    assert held(display) == held(other) == (studio.words.tobytes(), studio.entries.tobytes())
    assert display.words.max() < SCREENS.first
    assert studio.picture.intensity.tobytes() == anew.picture.intensity.tobytes()
    assert (studio.picture.normals is None) == (anew.picture.normals is None)
    view = studio.scene.view
    for move, ends in ((studio.undo, looks[-2::-1]), (studio.redo, looks[1:])):
        for scene in ends:
            assert move()
            assert studio.scene.equals(scene.replace(view=view))
            assert held(display) == fresh(studio.scene)
        assert not move()
    studio.undo(len(looks) - 1)
    while studio.view_back():
        assert held(display) == fresh(studio.scene)
    assert studio.scene.equals(start)


@given(scenes())
def test_any_scene_is_shown_and_watched_as_its_words_and_entries_say(scene: Scene) -> None:
    studio, display = opened(scene)
    assert held(display) == (studio.words.tobytes(), studio.entries.tobytes())
    assert display.field().tobytes() == studio.entries[studio.words].tobytes()
    assert studio._repr_png_() == display._repr_png_()
    written = display.frame_buffer.written
    lines = dict(studio.watch())
    assert list(lines) == list(range(24))
    assert np.concatenate(list(lines.values())).tolist() == display.words.tolist()
    assert display.frame_buffer.written == written


def test_several_steps_are_undone_and_redone_at_once_and_sent_once() -> None:
    studio, display = opened()
    scenes = [studio.scene]
    for diffuse in (0.2, 0.3, 0.4):
        studio.surface("body", diffuse=diffuse)
        scenes.append(studio.scene)
    written = display.frame_buffer.written
    assert studio.undo(3)
    assert studio.scene is scenes[0]
    assert studio.redo(2)
    assert studio.scene is scenes[2]
    assert display.frame_buffer.written == written + 2 * studio.words.size
    assert held(display) == fresh(studio.scene)
    assert not studio.undo(3)
    assert not studio.undo(0)
    assert not studio.redo(2)
    assert studio.scene is scenes[2]
    assert studio.history.steps[3:] == [Move("undo", 3), Move("redo", 2)]


def test_a_new_edit_forgets_what_was_undone_and_a_new_variant_does_not() -> None:
    studio, _ = opened()
    studio.recolor("body", blend=0.1)
    studio.undo()
    studio.keep_variant()
    assert studio.redo()
    studio.undo()
    studio.recolor("body", blend=0.2)
    assert not studio.redo()
    assert studio.scene.surfaces["body"].paint.blend == 0.2


def test_a_drag_is_one_step() -> None:
    studio, display = opened()
    scene, before = studio.scene, held(display)
    own = scene.surfaces["body"].paint.blend
    studio.recolor("body", blend=0.5)
    for blend in (0.4, 0.3, 0.2):
        studio.edit(studio.scene.with_surface("body", blend=blend), same_step=True)
    assert repr(studio) == "Studio('scene', to undo 1, to redo 0)"
    studio.undo()
    assert held(display) == before
    studio.recolor("body", blend=0.5)
    # The drag comes back to where it began.
    studio.edit(studio.scene.with_surface("body", blend=own), same_step=True)
    assert not studio.is_changed
    assert not studio.undo()


def test_a_glance_around_leaves_what_was_undone_and_undo_and_redo_leave_the_view() -> None:
    studio, display = opened()
    for blend in (0.2, 0.3):
        studio.recolor("body", blend=blend)
    assert studio.undo()
    for angle in (5, 10):
        studio.view(angle=angle)
    written = display.frame_buffer.written
    assert studio.redo()
    assert (studio.scene.view.angle, studio.scene.surfaces["body"].paint.blend) == (10, 0.3)
    assert studio.undo(2)
    # Looks of one view differ in entries alone.
    assert display.frame_buffer.written == written
    assert studio.view_back()
    assert (studio.scene.view.angle, repr(studio)) == (5, "Studio('scene', to undo 0, to redo 2)")
    assert studio.view_forward()
    assert not studio.view_forward()
    assert studio.scene.view.angle == 10
    assert studio.is_changed
    assert held(display) == fresh(studio.scene)


def test_a_gesture_that_is_taken_back_was_never_made() -> None:
    studio, display = opened()
    studio.recolor("body", blend=0.5)
    studio.undo()
    studio.view(angle=5)
    studio.view_back()
    before, known = held(display), studio.history.timeline
    for edit in (studio.scene.with_view(angle=7), studio.scene.with_light("key", on=False)):
        studio.edit(edit)
        studio.edit(studio.scene.replace(ambient=0.5), same_step=True)
        studio.keep_variant()
        studio.take_back()
        assert held(display) == before
        assert studio.history.timeline == known
    studio.redo()
    studio.take_back()
    assert studio.scene.surfaces["body"].paint.blend == 0.5


def test_the_first_edit_of_a_drag_after_an_undo_is_a_step_of_its_own() -> None:
    studio, _ = opened()
    for blend in (0.2, 0.3):
        studio.edit(studio.scene.with_surface("body", blend=blend))
    studio.undo()
    studio.edit(studio.scene.with_surface("body", blend=0.4), same_step=True)
    studio.undo()
    assert studio.scene.surfaces["body"].paint.blend == 0.2


# Coarse pictures of movements.


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every picture takes a second, so that it is as coarse as it can be while something moves."""
    monkeypatch.setattr("autocolor.studio.perf_counter", itertools.count().__next__)


def turn(studio: Studio, angle: float) -> None:
    studio.edit(studio.scene.with_view(angle=angle), same_step=True, moving=True)


@in_both_ways
@pytest.mark.usefixtures("slow")
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(any_edits | st.just("turn") | st.just("refine"), min_size=1, max_size=8))
def test_after_movements_a_refined_picture_is_the_fresh_one(words: str, edits: list[Any]) -> None:
    studio, display = opened_with(words)
    turn(studio, 20.0)
    assert studio.is_coarse
    for number, edit in enumerate(edits):
        if edit == "turn":
            turn(studio, float(number))
        elif edit == "refine":
            studio.refine()
            assert held(display) == fresh(studio.scene)
        else:
            apply(studio, edit)
        assert held(display) == (studio.words.tobytes(), studio.entries.tobytes())
    studio.refine()
    assert not studio.is_coarse
    assert held(display) == fresh(studio.scene)


@pytest.mark.usefixtures("slow")
def test_a_coarse_picture_has_blocks_and_the_ranges_of_the_one_before() -> None:
    studio, display = opened()
    ranges, entries = studio.level_ranges, held(display)[1]
    turn(studio, 30.0)
    assert (studio.picture.lines, studio.picture.elements) == (6, 8)
    assert display.words.shape == (24, 32)
    assert np.array_equal(display.words, display.words[::4, ::4].repeat(4, axis=0).repeat(4, axis=1))
    assert len(np.unique(display.words)) > 5
    assert studio.level_ranges is ranges
    assert held(display)[1] == entries
    # Colors change at once, and the picture stays as coarse as it is.
    check_recoloring_moves_no_word(studio, Recoloring("body", {"object_color": "#123456"}))
    assert studio.is_coarse


@pytest.mark.usefixtures("slow")
def test_what_a_coarse_picture_would_falsify_is_done_with_the_fine_one(tmp_path: Path) -> None:
    studio, display = opened()
    first, before = studio.scene, held(display)
    turn(studio, 30.0)
    studio.save(tmp_path / "a.npz")
    assert read_picture(tmp_path / "a.npz").picture.lines == 24
    turn(studio, 31.0)
    other, _ = opened(studio.scene)
    for each in (studio, other):
        each.hold_exposure()
    assert studio.scene.exposure == other.scene.exposure
    turn(studio, 32.0)
    assert studio.is_coarse
    image = studio.image_of(first)
    assert (image.words.tobytes(), image.entries.tobytes()) == before
    studio.take_back()
    assert not studio.is_coarse
    assert studio.scene.view.angle == 31


def test_a_picture_that_is_fast_enough_is_never_coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: 5.0)
    studio, _ = opened()
    turn(studio, 30.0)
    assert not studio.is_coarse


@pytest.mark.usefixtures("slow")
def test_while_the_picture_is_coarse_the_block_of_a_pixel_counts() -> None:
    studio, _ = opened()
    turn(studio, 20.0)
    assert studio.sight.block == 4
    for line, element in itertools.product(range(0, 24, 4), range(0, 32, 4)):
        seen = studio.seen_at(line, element)
        assert studio.seen_at(line + 3, element + 3) == seen
        assert (seen is None) == (studio.words[line, element] == 0)
    found = studio.highlight_of("key")
    assert found is not None
    assert (found[0] % 4, found[1] % 4) == (2, 2)
    studio.refine()
    assert studio.sight.block == 1


@pytest.mark.usefixtures("slow")
def test_watching_refines_a_coarse_picture_and_goes_on_with_it_and_is_no_step() -> None:
    studio, _ = opened()
    turn(studio, 10.0)
    lines = studio.watch()
    scene, words, (_, first) = studio.scene, studio.words, next(lines)
    assert not studio.is_coarse
    studio.view(angle=30)
    assert studio.words.tolist() != words.tolist()
    assert np.concatenate([first, *(rest for _, rest in lines)]).tolist() == words.tolist()
    assert studio.view_back()
    assert studio.scene.equals(scene)
    assert studio.view_back()
    assert not studio.view_back()


# What is sent.


def in_other_paints(scene: Scene) -> Scene:
    """The scene with other paints of two surfaces."""
    return scene.with_surface("body", blend=0.1).with_surface("wheels", object_color="#102030")


@pytest.mark.parametrize(
    ("edit", "words_sent", "entries_sent"),
    [
        (lambda studio: studio.recolor("body", object_color="#010203"), False, True),
        (lambda studio: studio.edit(studio.scene.replace(contrast="floor")), False, True),
        (lambda studio: studio.edit(studio.scene.replace(background="#010203")), False, True),
        (lambda studio: studio.save_view("hood"), False, False),
        (lambda studio: studio.edit(studio.scene), False, False),
        (lambda studio: studio.edit(in_other_paints(studio.scene)), False, True),
        (lambda studio: studio.edit(studio.scene.replace(scaling="object")), True, False),
        (lambda studio: studio.edit(studio.scene.replace(mapping="gamma")), True, False),
        (lambda studio: studio.surface("body", levels=40), True, True),
        (lambda studio: studio.surface("body", diffuse=0.4), True, False),
        (lambda studio: studio.light("key", intensity=2), True, False),
        (lambda studio: studio.view(angle=4), True, True),
    ],
)
def test_words_are_sent_whole_or_not_at_all_and_entries_where_they_differ(
    edit: Any, words_sent: bool, entries_sent: bool
) -> None:
    studio, display = opened()
    written, loaded, picture = display.frame_buffer.written, display.lookup_table.written, studio.picture
    edit(studio)
    assert display.frame_buffer.written - written == (32 * 24 if words_sent else 0)
    assert (display.lookup_table.written > loaded) == entries_sent
    assert words_sent or studio.picture is picture
    assert held(display) == fresh(studio.scene)


test_what_is_refused = refused(
    lambda act: act(opened()[0]),
    [
        (
            lambda studio: studio.scalar(None, bands=8),
            "scalar takes fields of a Scalar, or None alone; write it as in scalar(name='z', bands=8)",
        ),
        (
            Studio.reopen,
            "the scene must be in a file to be read again, and it is in none; save it",
        ),
        (Studio.journal, "a journal must name what its first scene was read from; give its path"),
    ],
)


@pytest.mark.parametrize(
    ("edit", "kind"),
    [
        (lambda studio: studio.recolor("body", object_color="rde"), InputError),
        (lambda studio: studio.recolor("body", diffuse=1), InputError),
        (lambda studio: studio.recolor("body", "red"), UsageError),
        (lambda studio: studio.recolor("boddy", blend=0.5), UsageError),
        (lambda studio: studio.light("key", intensity=1e39), InputError),
        (lambda studio: studio.light("kee", intensity=1), UsageError),
        (lambda studio: studio.add_light("rim"), InputError),
        (lambda studio: studio.add_light("key", position=(0, 0, 1)), InputError),
        (lambda studio: studio.remove_light("kye"), UsageError),
        (lambda studio: studio.surface("body", levels=5000), InputError),
        (lambda studio: studio.view(eye=(0, 0, 0)), InputError),
        (lambda studio: studio.take_view("hood"), UsageError),
        (lambda studio: studio.scalar(bands=8), InputError),
        (lambda studio: studio.scalar(name="z", bands=256, shades=5), InputError),
        (lambda studio: studio.place_highlight("key", 0, 0), UsageError),
        (lambda studio: studio.place_highlight("key", 24, 0), UsageError),
        (lambda studio: studio.show_variant("A"), UsageError),
        (lambda studio: studio.open("none.obj"), InputError),
        (lambda studio: studio.open(__file__), InputError),
    ],
)
def test_an_edit_that_is_refused_changes_nothing(edit: Any, kind: type[Exception]) -> None:
    studio, display = opened()
    studio.recolor("body", blend=0.5)
    studio.undo()

    def state() -> tuple[Any, ...]:
        written = display.frame_buffer.written, display.lookup_table.written
        return studio.scene, studio.history.steps[:], repr(studio), held(display), written

    before = state()
    with pytest.raises(kind):
        edit(studio)
    assert state() == before
    assert studio.redo()


def test_named_views_are_saved_taken_and_removed_by_steps() -> None:
    studio, _ = opened()
    start = studio.scene
    assert [studio.save_view(name) for name in ("hood", None, "hood")] == ["hood", "view 1", "hood"]
    studio.view(angle=4)
    studio.take_view("hood")
    assert studio.scene.view == start.view
    studio.remove_view("hood")
    assert [row.name for row in studio.scene.views] == ["view 1"]
    # The view itself is no step.
    assert [studio.undo() for _ in range(4)] == [True] * 3 + [False]
    assert studio.scene is start
    assert [studio.view_back() for _ in range(3)] == [True, True, False]
    assert studio.scene.equals(start)


def test_everything_can_be_sent_again() -> None:
    studio, display = opened()
    before = held(display)
    display.frame_buffer.fill(display.frame_buffer.window, 77)
    studio.send_everything()
    assert held(display) == before


def test_with_sends_false_nothing_is_sent() -> None:
    display = Ramtek9300(SMALL)
    studio = Studio(car(), display, sends=False)
    studio.light("key", on=False)
    assert display.words_received == 0
    studio.sends = True
    studio.send_everything()
    studio.recolor("body", blend=0.5)
    assert held(display) == fresh(studio.scene)


class Port:
    """A host port of which nothing else is known."""

    def __init__(self) -> None:
        self.display = Ramtek9300()
        self.send, self.receive = self.display.send, self.display.receive


def test_a_studio_without_a_display_has_one_of_the_paper_s_configuration() -> None:
    studio = Studio(car())
    assert isinstance(studio.display, Ramtek9300)
    assert studio.display.configuration == GMR_9300
    assert held(studio.display) == (studio.words.tobytes(), studio.entries.tobytes())
    assert Studio(car()).display is not studio.display


def test_a_display_sees_a_studio_only_through_its_host_port() -> None:
    port = Port()
    studio = Studio(car(), port)
    assert studio.display is port
    assert studio.words.shape == (480, 640)
    studio.light("key", on=False)
    assert held(port.display) == (studio.words.tobytes(), studio.entries.tobytes())


# Exposure.


def test_with_the_exposure_held_less_light_looks_darker_and_the_rest_stays() -> None:
    studio = Studio(car().replace(contrast="floor"), Ramtek9300(SMALL))
    before = studio.picture
    studio.hold_exposure()
    words = studio.words.copy()
    studio.light("key", intensity=0.3)
    assert (studio.words <= words).all()
    assert (studio.words < words).any()
    unchanged = before.intensity == studio.picture.intensity
    assert (studio.words == words)[unchanged].all()
    studio.light("key", intensity=1.0)
    assert (studio.words == words).all()
    studio.release_exposure()
    assert studio.scene.exposure == "auto"


@pytest.mark.parametrize("before", ["auto", "99.5 %", {"glass": (0.0, 2.0)}])
def test_a_released_exposure_is_the_exposure_before_it_was_held(before: Any) -> None:
    studio, _ = opened(car().replace(exposure=before))
    free, words = studio.scene.exposure, studio.words
    studio.hold_exposure()
    assert (studio.words == words).all()
    studio.hold_exposure({**dict(studio.scene.exposure), "object": (0.0, 2.0)})  # type: ignore[arg-type]
    studio.light("key", intensity=0.3)
    studio.release_exposure()
    assert studio.scene.exposure == free


def renamed(scene: Scene, name: str, other: str) -> Scene:
    """The scene with another name of a surface."""
    surfaces = [each.replace(name=other) if each.name == name else each for each in scene.surfaces]
    parts = [each.replace(surface=other) if each.surface == name else each for each in scene.parts]
    exposure = {"object": (0.0, 2.0)}
    return scene.replace(surfaces=surfaces, parts=parts, exposure=exposure)


def test_an_exposure_of_a_surface_that_the_scene_has_no_more_is_not_brought_back() -> None:
    studio, _ = opened(car().replace(exposure={"glass": (0.0, 2.0)}))
    studio.edit(renamed(studio.scene, "glass", "pane"))
    studio.release_exposure()
    assert studio.scene.exposure == "auto"


def test_a_release_of_ranges_of_some_surfaces_or_of_nothing_leaves_none_held() -> None:
    studio, _ = opened(car().replace(exposure="99.5 %"))
    studio.release_exposure()
    assert studio.scene.exposure == "99.5 %"
    studio.hold_exposure({"glass": (0.0, 2.0)})
    assert dict(studio.scene.exposure) == {"glass": (0.0, 2.0)}  # type: ignore[arg-type]
    studio.light("key", intensity=0.3)
    studio.release_exposure()
    assert studio.scene.exposure == "99.5 %"


@pytest.mark.parametrize("pickled", [pickle.dumps, copy.deepcopy, copy.copy])
def test_a_studio_says_why_it_is_not_pickled(pickled: Callable[[Studio], object]) -> None:
    with pytest.raises(TypeError, match="connected to a display; pickle its scene"):
        pickled(opened()[0])


# Lights and highlights.


LIGHT_NAMES = st.sampled_from(["key", "fill", "a", "b"])


@given(st.lists(st.tuples(st.sampled_from(["add", "remove", "undo", "redo"]), LIGHT_NAMES), max_size=10))
def test_lights_come_and_go_and_come_back(edits: list[tuple[str, str]]) -> None:
    studio, display = opened()
    for number, (kind, name) in enumerate(edits):
        there = name in [light.name for light in studio.scene.lights]
        if kind == "add" and not there:
            studio.add_light(name, position=(number - 3.0, -4.0, 2.0), cone_angle=40, aim=(0, 0, 0))
        elif kind == "remove" and there:
            studio.remove_light(name)
        elif kind in ("undo", "redo"):
            getattr(studio, kind)()
    assert held(display) == fresh(studio.scene)


ON_THE_HOOD = 7, 15
"""A pixel at which the round body of `car` is seen, as it is on the three lines below."""


def test_placing_a_highlight_is_a_step_and_it_is_found_there() -> None:
    studio, display = opened()
    scene, pixel = studio.scene, ON_THE_HOOD
    studio.place_highlight("key", *pixel)
    assert studio.highlight_of("key", "body") == pixel
    assert held(display) == fresh(studio.scene)
    seen = studio.seen_at(*pixel)
    assert seen is not None
    assert studio.scene.lights["key"].aim == seen.point
    assert studio.undo()
    assert studio.scene is scene
    assert not studio.undo()


def test_what_is_seen_has_the_present_name_of_its_surface() -> None:
    studio, _ = opened()
    assert studio.seen_at(0, 0) is None
    studio.edit(renamed(studio.scene, "body", "paint"))
    seen = studio.seen_at(*ON_THE_HOOD)
    assert seen is not None
    assert (seen.part, seen.surface) == ("hood", "paint")


@given(st.lists(any_edits, min_size=1, max_size=3))
def test_what_another_scene_looks_like_is_told_and_not_shown(edits: list[Edit]) -> None:
    studio, display = opened()
    first = studio.scene
    for edit in edits:
        apply(studio, edit)
    scene, memories = studio.scene, held(display)
    image = studio.image_of(first)
    assert (image.words.tobytes(), image.entries.tobytes()) == fresh(first)
    assert (studio.scene, held(display)) == (scene, memories)


# Words that stand for normals.


@given(
    st.lists(light_edits | scene_edits | edits("surface", SURFACES, **reflectances) | recolorings, min_size=1)
)
def test_where_words_stand_for_normals_no_edit_of_light_writes_a_word(edits: list[Edit]) -> None:
    studio, display = opened_with("normals")
    words, written = display.words.copy(), display.frame_buffer.written
    for edit in edits:
        entries_written = display.lookup_table.written
        apply(studio, edit)
        # Two words an entry, and each entry at most once.
        assert display.lookup_table.written - entries_written <= 2 * 1024
        assert held(display) == fresh(studio.scene)
    assert display.frame_buffer.written == written
    assert (display.words == words).all()


def test_a_light_that_moves_over_normals_computes_no_plane_until_the_picture_is_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    studio, display = opened()
    studio.normals()
    rendered = []

    def counted(scene: Scene, *rest: Any) -> Rendering:
        rendered.append(scene)
        return rendering(scene, *rest)

    monkeypatch.setattr("autocolor.studio.rendering", counted)
    words = studio.words
    for x in range(5):
        studio.light("key", position=(x, -4.0, 3.0))
    assert rendered == []
    assert studio.words is words
    picture = studio.picture
    assert rendered == [studio.scene]
    assert studio.display_image.picture is picture
    # What was asked for is not computed twice.
    assert studio.picture is picture
    assert picture.intensity.tobytes() == opened(studio.scene)[0].picture.intensity.tobytes()
    assert held(display) == fresh(studio.scene)


def test_a_drag_of_a_light_over_normals_is_one_step() -> None:
    studio, display = opened_with("normals")
    before = held(display)
    for x in range(4):
        studio.edit(studio.scene.with_light("key", position=(x, -4, 3)), same_step=x > 0, moving=True)
    assert not studio.is_coarse
    assert held(display) == fresh(studio.scene)
    assert studio.undo()
    assert held(display) == before
    assert not studio.undo()


def test_a_picture_of_a_file_has_no_normals_and_is_shown_by_its_levels(tmp_path: Path) -> None:
    studio, _ = opened_with("normals")
    studio.save(tmp_path / "car.npz")
    saved = read_picture(tmp_path / "car.npz")
    assert saved.scene.words == "normals"
    assert saved.picture.normals is None
    by_levels = opened(studio.scene.replace(words="levels"))[1]
    assert (image(saved.scene, saved.picture) == by_levels.field()).all()
    # A studio renders it, and so finds the normals again.
    assert held(opened(saved.scene)[1]) == fresh(studio.scene)


# Opening, variants, saving and the script.


OBJ = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\ng front\nf 1 2 3 4\ng side\nf 1 4 5\n"


@pytest.fixture
def mesh_file(tmp_path: Path) -> Path:
    (tmp_path / "box.obj").write_text(OBJ)
    return tmp_path / "box.obj"


def test_opening_is_a_step_and_undoing_it_gives_the_first_picture_byte_for_byte(mesh_file: Path) -> None:
    studio, display = opened()
    first, ranges, scene = held(display), dict(studio.level_ranges), studio.scene
    studio.open(mesh_file, up="y", surfaces="parts")
    assert studio.scene.name == "box"
    assert [surface.name for surface in studio.scene.surfaces] == ["front", "side"]
    assert held(display) == fresh(studio.scene)
    second = held(display)
    studio.undo()
    assert (held(display), dict(studio.level_ranges)) == (first, ranges)
    assert studio.scene is scene
    studio.redo()
    assert held(display) == second


def test_a_studio_knows_whether_its_scene_is_saved() -> None:
    studio, _ = opened()
    for is_on in (False, True):
        studio.light("key", on=is_on)
        assert studio.is_changed is not is_on
    studio.recolor("body", blend=0.1)
    studio.mark_saved()
    assert not studio.is_changed
    studio.undo()
    assert studio.is_changed
    studio.redo()
    assert not studio.is_changed


def test_a_scene_that_was_written_to_a_scene_file_is_saved(tmp_path: Path) -> None:
    studio, display = opened()
    studio.recolor("body", blend=0.1)
    written = display.frame_buffer.written
    studio.save_scene(tmp_path / "car")
    assert not studio.is_changed
    assert display.frame_buffer.written == written
    again = read_scene(tmp_path / "car")
    assert again.replace(mesh=studio.scene.mesh, name=studio.scene.name).equals(studio.scene)
    studio.recolor("body", blend=0.2)
    with pytest.raises(OutputError, match="exists"):
        studio.save_scene(tmp_path / "car")
    assert studio.is_changed
    studio.save_scene(tmp_path / "car" / "scene.toml", overwrite=True)
    assert read_scene(tmp_path / "car").surfaces["body"].paint.blend == 0.2


def test_a_session_that_is_saved_under_a_name_takes_it_by_one_step(tmp_path: Path) -> None:
    studio, _ = opened()
    studio.save_session(tmp_path, "night")
    assert (studio.scene.name, studio.is_changed) == ("night", False)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["night", "night.npz"]
    studio.undo()
    with pytest.raises(OutputError):
        studio.save_session(tmp_path, "night")
    assert studio.scene.name == "scene"
    assert not studio.undo()


def test_a_script_needs_a_folder_for_a_mesh_that_was_changed(tmp_path: Path) -> None:
    studio, _ = opened()
    studio.edit(studio.scene.replace(ambient=0.5))
    assert "ambient=0.5" in studio.journal("car.toml")
    studio.edit(scene_of(cube()))
    with pytest.raises(InputError):
        studio.journal("car.toml")
    studio.journal("car.toml", beside=tmp_path / "beside")
    assert list((tmp_path / "beside").iterdir())


def test_a_variant_is_shown_by_one_step() -> None:
    studio, display = opened()
    assert studio.keep_variant() == "A"
    first = held(display)
    studio.recolor("body", blend=0.25)
    studio.light("key", on=False)
    assert studio.keep_variant("night") == "night"
    night = held(display)
    studio.show_variant("A")
    assert held(display) == first
    studio.show_variant("A")
    studio.undo()
    assert held(display) == night
    assert list(studio.variants) == ["A", "night"]
    studio.rename_variant("A", "dawn")
    assert list(studio.variants) == ["dawn", "night"]
    with pytest.raises(UsageError):
        studio.rename_variant("dawn", "night")
    studio.drop_variant("dawn")
    assert list(studio.variants) == ["night"]
    with pytest.raises(UsageError):
        studio.show_variant("A")


def test_a_variant_brings_back_the_files_of_its_scene(mesh_file: Path, tmp_path: Path) -> None:
    studio, _ = opened()
    first = studio.save_session(tmp_path)
    studio.keep_variant("A")
    studio.open(mesh_file)
    second = studio.save_session(tmp_path)
    assert first.scene != second.scene
    studio.show_variant("A")
    assert studio.save_session(tmp_path) == first


def test_the_file_of_a_scene_is_read_again_by_one_step_to_undo(tmp_path: Path) -> None:
    studio, _ = opened()
    path = tmp_path / "car.sqlite"
    autocolor.write_scene(path, studio.scene)
    studio.open(path)
    assert studio.file == path
    assert not studio.reopen()
    autocolor.write_scene(path, studio.scene.replace(ambient=0.5), overwrite=True)
    before = studio.scene
    assert studio.reopen()
    assert studio.scene.ambient == 0.5
    assert studio.scene.mesh is before.mesh
    studio.undo()
    assert studio.scene is before


def test_a_studio_that_is_dropped_is_freed_at_once() -> None:
    studio, _ = opened()
    freed = weakref.ref(studio)
    del studio
    assert freed() is None
