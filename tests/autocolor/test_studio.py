"""The studio with a real display: what is sent, and what the display then shows."""

from __future__ import annotations

import copy
import itertools
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import autocolor
from autocolor import (
    InputError,
    OutputError,
    Scene,
    Studio,
    Surface,
    UsageError,
    read_picture,
    read_scene,
    scene_of,
    testing,
)
from autocolor.lighting.picking import highlight_placed
from autocolor.mapping.ranges import SCREENS
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
from ramtek_emu import Ramtek9300
from tests.small import SMALL, car, cube, fresh, held, opened

Edit = tuple[str, str, dict[str, Any]]


SURFACES = st.sampled_from(["body", "glass", "wheels"])

own_recolorings = testing.recolorings(["body", "glass", "wheels"])
recolorings = own_recolorings.map(lambda each: ("recolor", each.surface, dict(each.changes)))
surface_edits = st.tuples(
    st.just("surface"),
    SURFACES,
    st.fixed_dictionaries(
        {},
        optional={
            "diffuse": numbers(0, 2),
            "specular": numbers(0, 2),
            "exponent": st.sampled_from([0.0, 1.0, 30.0]),
            "two_sided": st.booleans(),
            "levels": st.none() | st.integers(2, 300),
            "blend": numbers(0, 1),
        },
    ),
)
light_edits = st.tuples(
    st.just("light"),
    st.sampled_from(["key", "fill"]),
    st.fixed_dictionaries(
        {},
        optional={
            "position": vectors(numbers(3, 5)),
            "aim": vectors(numbers(-1, 1)),
            "intensity": st.just(0.0) | numbers(0, 3),
            "on": st.booleans(),
            "concentration": numbers(0, 40),
            "cone_angle": st.none() | numbers(5, 180),
            "flaps": st.fixed_dictionaries({"x": st.none() | st.just({"minimum": 0.1})}),
        },
    ),
)
scene_edits = st.tuples(
    st.just("scene"),
    st.just(""),
    st.fixed_dictionaries(
        {},
        optional={
            "ambient": numbers(0, 1),
            "scaling": st.sampled_from(["surface", "object"]),
            "mapping": st.sampled_from(["linear", "gamma", "equalize", ((0.0, 0.0), (0.5, 0.9), (1.0, 1.0))]),
            "contrast": st.sampled_from(["stretch", "floor"]),
            "background": colors(),
        },
    ),
)
view_edits = st.tuples(
    st.just("view"),
    st.just(""),
    st.fixed_dictionaries({"angle": numbers(-90, 90), "field_of_view": numbers(20, 60)}),
)
scale_edits = st.tuples(
    st.just("scalar"),
    st.just(""),
    st.fixed_dictionaries({}, optional={"scale": scales(), "missing": colors()}),
)
level_edits = st.tuples(
    st.just("scalar"),
    st.just(""),
    st.fixed_dictionaries(
        {},
        optional={
            "limits": st.none() | limits(),
            "bands": st.integers(2, 200),
            "shades": st.none() | st.integers(1, 12),
            "below": st.none() | colors(),
            "above": st.none() | colors(),
            "surfaces": st.none() | st.lists(SURFACES, unique=True),
            "legend": st.booleans(),
        },
    ),
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


@given(st.lists(own_recolorings, min_size=1, max_size=6))
def test_recoloring_writes_no_word(edits: list[Recoloring]) -> None:
    studio, display = opened()
    for edit in edits:
        entries_written = display.lookup_table.written
        check_recoloring_moves_no_word(studio, edit)
        range_of_surface = studio.level_ranges[edit.surface]
        # Two words an entry, and at most those of the one surface.
        assert display.lookup_table.written - entries_written <= 2 * range_of_surface.levels


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


@given(st.lists(level_edits, min_size=1, max_size=4))
def test_limits_and_bands_make_levels_anew_and_render_nothing(edits: list[Edit]) -> None:
    studio, display = opened(car().with_scalar(name="stress"))
    picture = studio.picture
    for edit in edits:
        apply(studio, edit)
    assert studio.picture is picture
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


def test_another_scalar_mixes_and_lights_nothing_again() -> None:
    studio, display = opened(car().with_scalar(name="stress"))
    planes = dict(studio.picture.light_planes)
    studio.scalar(name="z")
    assert all(studio.picture.light_planes[name] is each for name, each in planes.items())
    assert held(display) == fresh(studio.scene)


def test_recoloring_a_surface_that_a_scalar_colors_sends_nothing_until_it_has_its_own_colors() -> None:
    studio, display = opened(car().with_scalar(name="z"))
    received = display.words_received
    studio.recolor("body", object_color="#123456")
    assert display.words_received == received
    studio.scalar(None)
    assert held(display) == fresh(studio.scene)


def test_a_scalar_is_chosen_by_its_name_first_and_left_by_none() -> None:
    studio, _ = opened()
    with pytest.raises(InputError, match="scalar: name must be a string"):
        studio.scalar(bands=8)
    with pytest.raises(
        InputError, match="must be a scalar of the mesh or a computed scalar, not 'stres'; did you"
    ):
        studio.scalar(name="stres")
    with pytest.raises(UsageError, match="scalar takes fields of a Scalar, or None alone"):
        studio.scalar(None, bands=8)
    studio.scalar(name="stress", bands=8)
    studio.scalar(bands=4)
    assert studio.scene.scalar is not None
    assert (studio.scene.scalar.name, studio.scene.scalar.bands) == ("stress", 4)
    studio.scalar(None)
    assert studio.scene.scalar is None
    assert studio.undo()
    assert studio.scene.scalar.bands == 4


def test_bands_for_which_there_are_too_few_words_leave_everything_as_it_was() -> None:
    studio, display = opened(car().with_scalar(name="z"))
    before = held(display), studio.scene
    with pytest.raises(
        InputError, match="surface 'body' and 2 more: the bands of scalar 'z' times their shades"
    ):
        studio.scalar(bands=256, shades=2)
    assert (held(display), studio.scene) == before


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


@given(own_recolorings)
def test_recoloring_a_surface_changes_its_own_pixels_and_entries_only(edit: Recoloring) -> None:
    studio, display = opened()
    field = display.field()
    check_entries_outside_range_stay(studio, edit, edit.surface)
    changed = (display.field() != field).any(axis=2)
    number = studio.picture.surfaces.index(edit.surface) + 1
    assert (studio.picture.surface_number[changed] == number).all()


@given(st.lists(recolorings, min_size=1, max_size=4))
def test_a_recolored_picture_is_the_fresh_one_in_the_new_colors(edits: list[Edit]) -> None:
    studio, display = opened()
    for edit in edits:
        apply(studio, edit)
    _, anew = opened(studio.scene)
    assert display.field().tobytes() == anew.field().tobytes()


@given(st.lists(any_edits, min_size=1, max_size=6))
def test_after_any_edits_the_display_holds_what_a_fresh_studio_sends(edits: list[Edit]) -> None:
    studio, display = opened()
    for edit in edits:
        before = held(display)
        if not apply(studio, edit):
            assert held(display) == before
    assert held(display) == fresh(studio.scene)
    assert display.words.max() < SCREENS.first
    assert display.words.tobytes() == studio.words.tobytes()
    assert display.entries.tobytes() == studio.entries.tobytes()


@given(st.lists(any_edits, min_size=1, max_size=5))
def test_undo_and_redo_bring_back_every_word_and_entry(edits: list[Edit]) -> None:
    studio, display = opened()
    states = [(studio.scene, held(display))]
    for edit in edits:
        # An edit that changes nothing leaves the scene, and is no step.
        if apply(studio, edit) and studio.scene is not states[-1][0]:
            states.append((studio.scene, held(display)))
    for scene, memories in states[-2::-1]:
        assert studio.undo()
        assert (studio.scene, held(display)) == (scene, memories)
    assert not studio.undo()
    for scene, memories in states[1:]:
        assert studio.redo()
        assert (studio.scene, held(display)) == (scene, memories)
    assert not studio.redo()


@given(scenes())
def test_any_scene_is_shown_as_its_words_and_entries_say(scene: Scene) -> None:
    studio, display = opened(scene)
    assert held(display) == (studio.words.tobytes(), studio.entries.tobytes())
    assert display.field().tobytes() == studio.entries[studio.words].tobytes()
    assert studio._repr_png_() == display._repr_png_()


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
    assert not studio.redo(2)
    assert studio.scene is scenes[2]
    assert studio.history.steps[3:] == ["undo"] * 3 + ["redo"] * 2


@pytest.mark.parametrize("steps", [0, -1, 1.5, "2"])
def test_steps_must_be_a_whole_number(steps: int) -> None:
    studio, _ = opened()
    with pytest.raises(UsageError, match="steps must be a whole number of at least 1, not"):
        studio.undo(steps)


def test_a_new_edit_forgets_what_was_undone() -> None:
    studio, _ = opened()
    studio.recolor("body", blend=0.1)
    studio.undo()
    studio.recolor("body", blend=0.2)
    assert not studio.redo()
    assert studio.scene.surface("body").paint.blend == 0.2


def test_an_edit_to_an_equal_scene_is_no_step() -> None:
    studio, display = opened()
    scene, written = studio.scene, display.frame_buffer.written
    studio.recolor("body", object_color=scene.surface("body").paint.object_color)
    studio.light(scene.lights[0].name, on=scene.lights[0].on)
    studio.edit(scene.replace(ambient=scene.ambient))
    assert studio.scene is scene
    assert not studio.is_changed
    assert not studio.undo()
    assert display.frame_buffer.written == written


def test_a_drag_is_one_step() -> None:
    studio, display = opened()
    before = held(display)
    studio.recolor("body", blend=0.5)
    for blend in (0.4, 0.3, 0.2):
        studio.edit(studio.scene.with_surface("body", blend=blend), same_step=True)
    assert repr(studio) == "Studio('scene', to undo 1, to redo 0)"
    studio.undo()
    assert held(display) == before


def test_a_drag_that_comes_back_to_where_it_began_is_undone_to_the_scene_itself() -> None:
    studio, _ = opened()
    scene, blend = studio.scene, studio.scene.surface("body").paint.blend
    studio.recolor("body", blend=0.5)
    studio.edit(studio.scene.with_surface("body", blend=blend), same_step=True)
    assert not studio.is_changed
    assert studio.undo()
    assert studio.scene is scene
    assert not studio.is_changed


class SlowClock:
    """A clock on which every picture takes a second."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def __call__(self) -> float:
        self.seconds += 1.0
        return self.seconds


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures that are as coarse as they can be while something moves."""
    monkeypatch.setattr("autocolor.studio.perf_counter", SlowClock())


def turn(studio: Studio, angle: float) -> None:
    studio.edit(studio.scene.with_view(angle=angle), same_step=True, moving=True)


@given(scenes(), scenes())
@settings(suppress_health_check=[HealthCheck.too_slow])
def test_the_lines_that_are_watched_are_the_picture_that_the_display_has(one: Scene, other: Scene) -> None:
    studio, display = opened(one)
    studio.edit(other)
    written = display.frame_buffer.written
    lines = dict(studio.watch())
    assert list(lines) == list(range(24))
    assert np.concatenate(list(lines.values())).tolist() == display.words.tolist()
    assert display.frame_buffer.written == written


def test_watching_goes_on_with_the_picture_with_which_it_began() -> None:
    studio, _ = opened()
    words, lines = studio.words, studio.watch()
    first = next(lines)[1]
    studio.view(angle=30)
    assert studio.words.tolist() != words.tolist()
    assert np.concatenate([first, *(rest for _, rest in lines)]).tolist() == words.tolist()


@pytest.mark.usefixtures("slow")
def test_watching_refines_a_coarse_picture_and_is_no_step() -> None:
    studio, display = opened()
    turn(studio, 10.0)
    assert studio.is_coarse
    scene = studio.scene
    lines = np.concatenate([words for _, words in studio.watch()])
    assert not studio.is_coarse
    assert lines.tolist() == display.words.tolist()
    assert studio.scene is scene
    assert studio.undo()
    assert not studio.undo()


@pytest.mark.usefixtures("slow")
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(any_edits | st.just("turn") | st.just("refine"), min_size=1, max_size=8))
def test_after_movements_a_refined_picture_is_the_fresh_one(edits: list[Any]) -> None:
    studio, display = opened()
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
    studio, _ = opened()
    turn(studio, 30.0)
    studio.save(tmp_path / "a.npz")
    assert read_picture(tmp_path / "a.npz").picture.lines == 24
    turn(studio, 31.0)
    studio.hold_exposure()
    other, _ = opened(studio.scene.replace(exposure="auto"))
    other.hold_exposure()
    assert studio.scene.exposure == other.scene.exposure


def test_a_picture_that_is_fast_enough_is_never_coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("autocolor.studio.perf_counter", lambda: 5.0)
    studio, _ = opened()
    turn(studio, 30.0)
    assert not studio.is_coarse


@pytest.mark.usefixtures("slow")
def test_undoing_a_movement_brings_back_the_fine_picture() -> None:
    studio, display = opened()
    before = held(display)
    for angle in (10.0, 20.0, 30.0):
        turn(studio, angle)
    studio.undo()
    assert held(display) == before
    assert not studio.is_coarse


def test_an_edit_and_its_opposite_leave_nothing_to_save() -> None:
    studio, _ = opened()
    for is_on in (False, True):
        studio.light("key", on=is_on)
        assert studio.is_changed is not is_on


def test_several_surfaces_in_other_paints_are_recolored_at_once() -> None:
    studio, display = opened()
    scene = studio.scene.with_surface("body", blend=0.1).with_surface("wheels", object_color="#102030")
    check_recoloring_moves_no_word(studio, lambda studio: studio.edit(scene))
    assert held(display) == fresh(scene)


def test_a_surface_that_no_part_has_is_recolored_without_sending_anything() -> None:
    scene = car()
    studio, display = opened(scene.replace(surfaces=[*scene.surfaces, Surface("spare")]))
    written = display.lookup_table.written
    studio.recolor("spare", object_color="#102030")
    assert studio.scene.surface("spare").paint.object_color == (16, 32, 48)
    assert display.lookup_table.written == written
    assert studio.undo()


@pytest.mark.parametrize("contrast", ["stretch", "floor"])
def test_a_light_sends_entries_only_where_the_floor_of_a_surface_moves(contrast: Any) -> None:
    studio, display = opened(car().replace(contrast=contrast))
    written = display.lookup_table.written
    studio.light("key", intensity=2.5)
    assert (display.lookup_table.written > written) == (contrast == "floor")
    assert held(display) == fresh(studio.scene)


def test_an_edit_that_is_refused_changes_nothing() -> None:
    studio, display = opened()
    studio.recolor("body", blend=0.5)
    studio.undo()
    before = (
        studio.scene,
        held(display),
        repr(studio),
        display.frame_buffer.written,
        display.lookup_table.written,
    )
    refused: list[tuple[Any, type[Exception]]] = [
        (lambda: studio.recolor("body", object_color="rde"), InputError),
        (lambda: studio.recolor("body", diffuse=1), UsageError),  # type: ignore[call-arg]
        (lambda: studio.recolor("boddy", blend=0.5), UsageError),
        (lambda: studio.light("key", intensity=-1), InputError),
        (lambda: studio.light("key", intensity=1e39), InputError),
        (lambda: studio.light("kee", intensity=1), UsageError),
        (lambda: studio.surface("body", levels=5000), InputError),
        (lambda: studio.view(eye=(0, 0, 0)), InputError),
    ]
    for edit, kind in refused:
        with pytest.raises(kind):
            edit()
        assert before == (
            studio.scene,
            held(display),
            repr(studio),
            display.frame_buffer.written,
            display.lookup_table.written,
        )
    assert studio.redo()


def test_recolor_takes_only_what_colors() -> None:
    with pytest.raises(UsageError) as refusal:
        opened()[0].recolor("body", blent=0.5)  # type: ignore[call-arg]
    assert str(refusal.value) == ("recolor takes fields of a Paint, not 'blent'; did you mean 'blend'?")


def test_the_same_scene_again_is_no_step_and_sends_nothing() -> None:
    studio, display = opened()
    written = display.frame_buffer.written, display.lookup_table.written
    studio.edit(studio.scene)
    assert not studio.undo()
    assert written == (display.frame_buffer.written, display.lookup_table.written)


def test_named_views_are_saved_taken_and_removed_by_steps_and_only_taking_sends() -> None:
    studio, display = opened()
    start = studio.scene
    written = display.frame_buffer.written, display.lookup_table.written
    assert [studio.save_view("hood"), studio.save_view(), studio.save_view("hood")] == [
        "hood",
        "view 1",
        "hood",
    ]
    assert written == (display.frame_buffer.written, display.lookup_table.written)
    studio.view(angle=4)
    studio.take_view("hood")
    assert studio.scene.view == start.view
    studio.remove_view("hood")
    assert [row.name for row in studio.scene.views] == ["view 1"]
    with pytest.raises(UsageError, match="there is no named view 'hood'"):
        studio.take_view("hood")
    assert [studio.undo() for _ in range(6)] == [True] * 5 + [False]
    assert studio.scene is start


@pytest.mark.parametrize(
    ("edit", "words_sent"),
    [
        (lambda studio: studio.recolor("body", object_color="#010203"), False),
        (lambda studio: studio.edit(studio.scene.replace(contrast="floor")), False),
        (lambda studio: studio.edit(studio.scene.replace(background="#010203")), False),
        (lambda studio: studio.save_view("hood"), False),
        (lambda studio: studio.edit(studio.scene.replace(scaling="object")), True),
        (lambda studio: studio.edit(studio.scene.replace(mapping="gamma")), True),
        (lambda studio: studio.surface("body", levels=40), True),
        (lambda studio: studio.surface("body", diffuse=0.4), True),
        (lambda studio: studio.light("key", intensity=2), True),
        (lambda studio: studio.view(angle=4), True),
    ],
)
def test_words_are_sent_whole_or_not_at_all(edit: Any, words_sent: bool) -> None:
    studio, display = opened()
    written, picture = display.frame_buffer.written, studio.picture
    edit(studio)
    assert display.frame_buffer.written - written == (32 * 24 if words_sent else 0)
    if not words_sent:
        assert studio.picture is picture


def test_three_blends_of_the_body_change_body_pixels_only() -> None:
    # Figure 15: A the object color alone, B and C with the light color from lower and lower levels.
    studio, display = opened()
    body = studio.picture.surface_number == studio.picture.surfaces.index("body") + 1
    colors_of_c: dict[str, Any] = {"object_color": "#802020", "light_color": "#ffffff"}
    fields = []
    for blend in (1.0, 0.6, 0.0):
        studio.recolor("body", blend=blend, **colors_of_c)
        fields.append(display.field().astype(int))
    for one, other in itertools.pairwise(fields):
        assert not (one != other).any(axis=2)[~body].any()
        assert (other >= one)[body].all()
        assert (other > one)[body].any()


def test_the_floor_keeps_the_shading_in_proportion_to_the_intensity() -> None:
    studio, display = opened(car().replace(contrast="floor"))
    studio.recolor("body", object_color="#ffffff", blend=1.0)
    number = studio.picture.surfaces.index("body") + 1
    of_body = studio.picture.surface_number == number
    intensity = studio.picture.intensity[of_body]
    shade = display.field()[of_body][:, 0] / 255
    assert np.abs(shade - intensity / intensity.max()).max() < 0.01


def test_the_floor_of_the_whole_object_is_the_objects() -> None:
    studio, _ = opened(car().replace(contrast="floor", scaling="object", ambient=1.0))
    least, most = studio.picture.ranges.whole
    for name in ("body", "glass"):
        studio.recolor(name, object_color="#ffffff", blend=1.0)
        first = studio.level_ranges[name].first
        assert studio.entries[first, 0] == pytest.approx(255 * least / most, abs=0.51)


def test_the_background_and_the_screens_keep_their_words() -> None:
    studio, display = opened(car().replace(background="#102030"))
    nothing = studio.picture.surface_number == 0
    assert nothing.any()
    assert (display.words[nothing] == 0).all()
    assert (display.field()[nothing] == (16, 32, 48)).all()
    assert len({tuple(entry) for entry in display.entries[SCREENS.first :].tolist()}) == SCREENS.levels


def test_a_studio_knows_whether_its_scene_is_saved() -> None:
    studio, _ = opened()
    assert not studio.is_changed
    studio.recolor("body", blend=0.1)
    assert studio.is_changed
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
    assert read_scene(tmp_path / "car").surface("body").paint.blend == 0.2


def test_everything_can_be_sent_again() -> None:
    studio, display = opened()
    before = held(display)
    display.frame_buffer.write(np.full((24, 32), 77, np.uint16))
    studio.send_everything()
    assert held(display) == before


def test_the_picture_has_the_size_of_its_display_else_640_by_480() -> None:
    assert opened()[0].words.shape == (24, 32)
    assert Studio(scene_of(cube()), Ramtek9300()).words.shape == (480, 640)


def test_on_the_papers_display_edits_come_to_the_same_as_a_fresh_picture() -> None:
    display, anew = Ramtek9300(), Ramtek9300()
    studio = Studio(car(), display)
    studio.light("key", position=(3, -3, 2), concentration=20)
    studio.surface("body", exponent=60, diffuse=0.5)
    studio.light("fill", flaps={"z": {"on": True}})
    studio.recolor("glass", object_color="#203040", blend=0.2)
    studio.edit(studio.scene.replace(mapping="equalize", ambient=0.3))
    Studio(studio.scene, anew)
    assert held(display) == held(anew)
    assert display.field().tobytes() == anew.field().tobytes()


def test_a_display_sees_a_studio_only_through_its_host_port() -> None:
    class Port:
        def __init__(self) -> None:
            self.display = Ramtek9300()

        def send(self, words: Any) -> None:
            self.display.send(words)

        def receive(self, count: int) -> Any:
            return self.display.receive(count)

    port = Port()
    studio = Studio(car(), port)
    studio.light("key", on=False)
    assert held(port.display) == (studio.words.tobytes(), studio.entries.tobytes())


def test_the_first_edit_of_a_drag_after_an_undo_is_a_step_of_its_own() -> None:
    studio, _ = opened()
    for blend in (0.2, 0.3):
        studio.edit(studio.scene.with_surface("body", blend=blend))
    studio.undo()
    studio.edit(studio.scene.with_surface("body", blend=0.4), same_step=True)
    studio.undo()
    assert studio.scene.surface("body").paint.blend == 0.2


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
    studio = Studio(car().replace(exposure=before), Ramtek9300(SMALL))
    free = studio.scene.exposure
    words = studio.words.copy()
    studio.hold_exposure()
    assert (studio.words == words).all()
    studio.hold_exposure({**dict(studio.scene.exposure), "object": (0.0, 2.0)})  # type: ignore[arg-type]
    studio.light("key", intensity=0.3)
    studio.release_exposure()
    assert studio.scene.exposure == free
    studio.hold_exposure()
    if not isinstance(before, str):
        # The scene does not have the surface any more.
        pane = [
            each.replace(name={"glass": "pane"}.get(each.name, each.name)) for each in studio.scene.surfaces
        ]
        parts = [
            each.replace(surface={"glass": "pane"}.get(each.surface, each.surface))
            for each in studio.scene.parts
        ]
        studio.edit(studio.scene.replace(exposure={"object": (0.0, 2.0)}, surfaces=pane, parts=parts))
        free = "auto"
    studio.release_exposure()
    assert studio.scene.exposure == free


def test_a_release_of_ranges_of_some_surfaces_or_of_nothing_leaves_none_held() -> None:
    studio = Studio(car().replace(exposure="auto"), Ramtek9300(SMALL))
    studio.edit(studio.scene.replace(exposure="99.5 %"))
    studio.release_exposure()
    assert studio.scene.exposure == "99.5 %"
    studio.hold_exposure({"glass": (0.0, 2.0)})
    studio.light("key", intensity=0.3)
    studio.release_exposure()
    assert studio.scene.exposure == "99.5 %"


def test_an_edit_of_light_or_color_moves_no_range_and_one_of_the_view_does() -> None:
    studio = Studio(car(), Ramtek9300(SMALL))
    ranges = studio.level_ranges
    studio.light("key", intensity=0.3, position=(0, 0, 9))
    studio.recolor("body", object_color="#123456")
    studio.surface("glass", diffuse=0.1)
    assert studio.level_ranges is ranges
    studio.view(eye=(1.0, -2.0, 1.0))
    assert dict(studio.level_ranges) != dict(ranges)


def test_the_lights_alone_add_up_to_all_together_where_the_exposure_is_held_from_zero() -> None:
    """Paper: Figure 8. With the ambient light in the first panel only."""
    scene = car().replace(ambient=0.05, scaling="object", mapping="linear")
    whole = Studio(scene, Ramtek9300(SMALL)).picture.ranges.whole
    scene = scene.replace(exposure={"object": (0.0, whole.maximum)})
    together = Studio(scene, Ramtek9300(SMALL))
    seen = together.picture.surface_number > 0
    firsts = np.zeros(256, int)
    for number, name in enumerate(together.picture.surfaces, 1):
        firsts[number] = together.level_ranges[name].first
    first = firsts[together.picture.surface_number]
    total = np.zeros(seen.shape, int)
    for row, light in enumerate(scene.lights):
        panel = scene.only_lights(light.name).replace(ambient=0.0 if row else scene.ambient)
        alone = Studio(panel, Ramtek9300(SMALL))
        assert alone.level_ranges == together.level_ranges
        total += alone.words - first
    off = np.abs(total - (together.words - first))[seen]
    assert off.max() <= len(scene.lights) / 2


@pytest.mark.parametrize("division", ["covered", "equal"])
def test_recoloring_a_dithered_picture_writes_no_word(division: Any) -> None:
    display = Ramtek9300(SMALL)
    studio = Studio(car().replace(dither="ordered", division=division, exposure={"object": (0, 1)}), display)
    check_recoloring_moves_no_word(studio, Recoloring("body", {"object_color": "#123456", "blend": 0.2}))
    pane = Recoloring("glass", {"light_color": "#ffeedd", "light_percentage": 40})
    check_recoloring_moves_no_word(studio, pane)
    assert (display.field() == display.entries[display.words]).all()


@pytest.mark.parametrize("pickled", [pickle.dumps, copy.deepcopy, copy.copy])
def test_a_studio_says_why_it_is_not_pickled(pickled: Callable[[Studio], object]) -> None:
    with pytest.raises(TypeError, match="connected to a display; pickle its scene"):
        pickled(opened()[0])


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


def test_a_light_that_is_added_or_removed_leaves_the_planes_of_the_others() -> None:
    studio, _ = opened()
    before = studio.picture.light_planes
    studio.add_light("rim", position=(0, 4, 3))
    after = studio.picture.light_planes
    assert [after[name].values is before[name].values for name in before] == [True, True]
    studio.remove_light("key")
    assert studio.picture.light_planes["rim"].values is after["rim"].values
    assert "key" not in studio.picture.light_planes


@pytest.mark.parametrize(
    ("name", "fields", "message"),
    [
        ("rim", {}, "lights[3]: position must be three finite numbers of at most 1e36, not missing; add it"),
        (
            "key",
            {"position": (0, 0, 1)},
            "lights[3].name must be unique, not the same as lights[1]; rename it",
        ),
    ],
)
def test_a_light_that_cannot_be_added_changes_nothing(name: str, fields: Any, message: str) -> None:
    studio, display = opened()
    scene, before = studio.scene, held(display)
    with pytest.raises(InputError) as refusal:
        studio.add_light(name, **fields)
    assert str(refusal.value) == message
    with pytest.raises(UsageError, match="there is no light 'kye'; did you mean 'key'"):
        studio.remove_light("kye")
    assert (studio.scene, held(display)) == (scene, before)


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
    assert studio.scene.light("key").aim == seen.point
    assert studio.undo()
    assert studio.scene is scene
    assert not studio.undo()


def test_a_dragged_highlight_is_one_step() -> None:
    studio, _ = opened()
    line, element = ON_THE_HOOD
    studio.surface("body", diffuse=0.6)
    scene = studio.scene
    for number, down in enumerate((0, 1, 2, 3)):
        moved = highlight_placed(studio.scene, studio.seen_at(line + down, element), "key")
        studio.edit(moved, same_step=number > 0, moving=True)
    assert studio.highlight_of("key", "body") == (line + 3, element)
    assert studio.undo()
    assert studio.scene is scene


def test_a_highlight_on_the_background_or_outside_changes_nothing() -> None:
    studio, display = opened()
    scene, before = studio.scene, held(display)
    assert studio.seen_at(0, 0) is None
    with pytest.raises(UsageError, match="a highlight must be dragged to a surface, not to the background"):
        studio.place_highlight("key", 0, 0)
    with pytest.raises(UsageError, match="a line must be 0 to 23, not 24; choose another"):
        studio.place_highlight("key", 24, 0)
    assert (studio.scene, held(display)) == (scene, before)


def test_what_is_seen_has_the_present_name_of_its_surface() -> None:
    studio, _ = opened()
    line, element = ON_THE_HOOD
    studio.edit(
        studio.scene.replace(
            surfaces=[
                each.replace(name="paint") if each.name == "body" else each for each in studio.scene.surfaces
            ],
            parts=[
                each.replace(surface="paint") if each.surface == "body" else each
                for each in studio.scene.parts
            ],
        )
    )
    seen = studio.seen_at(line, element)
    assert seen is not None
    assert (seen.part, seen.surface) == ("hood", "paint")


@pytest.mark.usefixtures("slow")
def test_while_the_picture_is_coarse_the_block_of_a_pixel_counts() -> None:
    studio, _ = opened()
    turn(studio, 20.0)
    assert studio.sight.block == 4
    for line in range(0, 24, 4):
        for element in range(0, 32, 4):
            seen = studio.seen_at(line, element)
            assert studio.seen_at(line + 3, element + 3) == seen
            assert (seen is None) == (studio.words[line, element] == 0)
    found = studio.highlight_of("key")
    assert found is not None
    assert (found[0] % 4, found[1] % 4) == (2, 2)
    studio.refine()
    assert studio.sight.block == 1


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


@pytest.mark.usefixtures("slow")
def test_another_scene_is_told_at_its_full_size_while_a_picture_is_coarse() -> None:
    studio, _ = opened()
    first = studio.scene
    turn(studio, 20)
    assert studio.is_coarse
    image = studio.image_of(first)
    assert (image.words.tobytes(), image.entries.tobytes()) == fresh(first)


def test_the_image_of_a_scene_in_other_colors_has_the_same_words() -> None:
    studio, _ = opened()
    image = studio.image_of(studio.scene.with_paint("body", object_color="#204060"))
    assert image.words is studio.words
    assert (image.entries != studio.entries).any()


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


def test_a_file_that_cannot_be_opened_changes_nothing(mesh_file: Path) -> None:
    studio, display = opened()
    before = held(display), repr(studio), len(studio.history.steps)
    mesh_file.write_text("f 1 2 3\n")
    with pytest.raises(InputError):
        studio.open(mesh_file)
    with pytest.raises(InputError):
        studio.open(mesh_file.with_name("none.obj"))
    assert (held(display), repr(studio), len(studio.history.steps)) == before


def test_every_opened_scene_knows_its_unsaved_changes(mesh_file: Path) -> None:
    studio, _ = opened()
    studio.recolor("body", blend=0.25)
    assert studio.is_changed
    studio.open(mesh_file)
    assert not studio.is_changed
    assert studio.history.left_unsaved == ("scene",)
    studio.view(angle=5)
    assert studio.is_changed
    for _ in range(2):
        studio.undo()
    assert studio.is_changed
    assert studio.history.left_unsaved == ()
    studio.undo()
    assert not studio.is_changed


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
    studio.drop_variant("A")
    assert list(studio.variants) == ["night"]
    with pytest.raises(UsageError):
        studio.show_variant("A")


def test_a_new_variant_leaves_the_steps_to_redo() -> None:
    studio, _ = opened()
    studio.recolor("body", blend=0.25)
    studio.undo()
    studio.keep_variant()
    assert studio.redo()


def test_a_variant_brings_back_the_files_of_its_scene(mesh_file: Path, tmp_path: Path) -> None:
    studio, _ = opened()
    first = studio.save_session(tmp_path)
    studio.keep_variant("A")
    studio.open(mesh_file)
    second = studio.save_session(tmp_path)
    assert first.scene != second.scene
    studio.show_variant("A")
    assert studio.save_session(tmp_path) == first


def test_a_script_needs_the_path_of_its_first_scene() -> None:
    with pytest.raises(UsageError) as refusal:
        opened()[0].journal()
    assert str(refusal.value) == "a journal must name what its first scene was read from; give its path"


def test_given_exposure_ranges_are_held() -> None:
    studio, _ = opened()
    studio.hold_exposure({"object": (0.0, 2.0)})
    assert studio.scene.exposure == (("object", (0.0, 2.0)),)


def test_the_file_of_a_scene_is_read_again_by_one_step_to_undo(tmp_path: Path) -> None:
    studio, _ = opened()
    with pytest.raises(UsageError, match="the scene must be in a file to be read again, and it is in none"):
        studio.reopen()
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
