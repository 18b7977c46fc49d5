"""A studio whose words stand for normals: what an edit sends, and what it leaves.

In the manner of `test_studio`, whose edits are made here, too.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autocolor import InputError, Scene, Studio, image, read_picture
from autocolor.rendering import Rendering, rendering
from autocolor.testing import colors, numbers
from ramtek_emu import Ramtek9300, Recorder
from tests.autocolor.test_studio import (
    SURFACES,
    Edit,
    SlowClock,
    any_edits,
    apply,
    light_edits,
    recolorings,
    turn,
)
from tests.small import car, fresh, held, opened

shown_edits = st.tuples(
    st.just("scene"),
    st.just(""),
    st.fixed_dictionaries(
        {},
        optional={
            "ambient": numbers(0, 1),
            "scaling": st.sampled_from(["surface", "object"]),
            "mapping": st.sampled_from(["linear", "gamma", "equalize"]),
            "contrast": st.sampled_from(["stretch", "floor"]),
            "background": colors(),
        },
    ),
)
normals_edits = st.sampled_from(
    [("scene", "", {"words": words}) for words in ("levels", "normals")]
    + [("scene", "", {"division": division}) for division in ("covered", "equal")]
)
reflectance_edits = st.tuples(
    st.just("surface"),
    SURFACES,
    st.fixed_dictionaries(
        {},
        optional={
            "diffuse": numbers(0, 2),
            "specular": numbers(0, 2),
            "exponent": st.sampled_from([0.0, 1.0, 30.0]),
            "blend": numbers(0, 1),
        },
    ),
)


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures that are as coarse as they can be while something moves."""
    monkeypatch.setattr("autocolor.studio.perf_counter", SlowClock())


def opened_with_normals() -> tuple[Studio, Ramtek9300]:
    return opened(car().replace(words="normals"))


@given(st.lists(light_edits | shown_edits | reflectance_edits | recolorings, min_size=1, max_size=6))
def test_where_words_stand_for_normals_no_edit_of_light_writes_a_word(edits: list[Edit]) -> None:
    studio, display = opened_with_normals()
    words, written = display.words.copy(), display.frame_buffer.written
    for edit in edits:
        entries_written = display.lookup_table.written
        apply(studio, edit)
        # Two words an entry, and each entry at most once.
        assert display.lookup_table.written - entries_written <= 2 * 1024
        assert held(display) == fresh(studio.scene)
    assert display.frame_buffer.written == written
    assert (display.words == words).all()


@given(st.lists(any_edits | reflectance_edits | normals_edits, min_size=1, max_size=6))
def test_any_edits_with_normals_leave_what_a_fresh_studio_shows_and_undo_takes_them_back(
    edits: list[Edit],
) -> None:
    studio, display = opened_with_normals()
    scenes_before = [studio.scene]
    for edit in edits:
        if apply(studio, edit) and studio.scene is not scenes_before[-1]:
            scenes_before.append(studio.scene)
        assert held(display) == fresh(studio.scene)
    assert picture_of(studio) == fresh_picture(studio.scene)
    while len(scenes_before) > 1:
        assert studio.undo()
        scenes_before.pop()
        assert studio.scene.equals(scenes_before[-1])
        assert held(display) == fresh(studio.scene)
    while studio.redo():
        assert held(display) == fresh(studio.scene)


def picture_of(studio: Studio) -> tuple[bytes, bytes, bool]:
    picture = studio.picture
    return picture.intensity.tobytes(), picture.surface_number.tobytes(), picture.normals is None


def fresh_picture(scene: Scene) -> tuple[bytes, bytes, bool]:
    return picture_of(opened(scene)[0])


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
    assert picture_of(studio) == fresh_picture(studio.scene)
    assert held(display) == fresh(studio.scene)


def test_what_is_sent_for_a_light_over_normals_is_one_load_of_entries() -> None:
    sent = io.BytesIO()
    display = Ramtek9300()
    studio = Studio(car().replace(words="normals"), Recorder(sent, display))
    begun = sent.tell()
    studio.light("key", position=(3.0, -4.0, 3.0))
    stream = np.frombuffer(sent.getvalue()[begun:], "<u2")
    # LAM, the address of the first entry, the length in bytes; two words an entry.
    assert stream[0] >> 8 == 0x03
    assert len(stream) == 3 + stream[2] // 2
    assert stream[2] // 4 <= 1024
    other = Ramtek9300()
    Studio(studio.scene, other)
    assert held(display) == held(other)


def test_levels_come_back_as_they_were_after_normals() -> None:
    studio, display = opened()
    before = held(display)
    studio.normals()
    assert held(display) != before
    studio.light("fill", intensity=2.0)
    studio.normals(on=False)
    assert held(display) == fresh(studio.scene)
    assert studio.picture.normals is None
    for _ in range(3):
        assert studio.undo()
    assert held(display) == before
    assert studio.scene.words == "levels"


def test_a_drag_of_a_light_over_normals_is_one_step() -> None:
    studio, display = opened_with_normals()
    before = held(display)
    for x in range(4):
        studio.edit(studio.scene.with_light("key", position=(x, -4, 3)), same_step=x > 0, moving=True)
    assert not studio.is_coarse
    assert held(display) == fresh(studio.scene)
    assert studio.undo()
    assert held(display) == before
    assert not studio.undo()


def test_a_scene_that_a_scalar_colors_keeps_its_levels() -> None:
    studio, display = opened(car().with_scalar(name="z"))
    before = held(display)
    with pytest.raises(InputError) as error:
        studio.normals()
    assert str(error.value) == (
        "words must be 'levels' where a scalar colors surfaces, not 'normals'; change it, or remove the"
        " scalar"
    )
    assert held(display) == before
    studio.scalar(None)
    studio.normals()
    with pytest.raises(InputError, match="words must be 'levels' where a scalar"):
        studio.scalar(name="z")
    assert held(display) == fresh(studio.scene)


def test_holding_the_exposure_of_normals_changes_no_entry() -> None:
    studio, display = opened_with_normals()
    before = held(display)
    studio.hold_exposure()
    assert held(display) == before
    studio.light("key", intensity=0.2)
    darker = studio.entries.astype(int).sum()
    studio.release_exposure()
    assert darker < studio.entries.astype(int).sum()


@pytest.mark.usefixtures("slow")
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(any_edits | st.just("turn") | st.just("refine"), min_size=1, max_size=8))
def test_after_movements_over_normals_a_refined_picture_is_the_fresh_one(edits: list[Any]) -> None:
    studio, display = opened_with_normals()
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


def test_a_picture_of_a_file_has_no_normals_and_is_shown_by_its_levels(tmp_path: Path) -> None:
    studio, _ = opened_with_normals()
    studio.save(tmp_path / "car.npz")
    saved = read_picture(tmp_path / "car.npz")
    assert saved.scene.words == "normals"
    assert saved.picture.normals is None
    by_levels = opened(studio.scene.replace(words="levels"))[1]
    assert (image(saved.scene, saved.picture) == by_levels.field()).all()
    # A studio renders it, and so finds the normals again.
    assert held(opened(saved.scene)[1]) == fresh(studio.scene)


def test_the_colors_of_a_picture_with_normals_are_those_of_the_display() -> None:
    studio, display = opened_with_normals()
    studio.light("key", position=(0.0, -4.0, 1.0))
    assert (image(studio.scene, studio.picture) == display.field()).all()
