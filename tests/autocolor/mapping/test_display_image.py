from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Picture, Scene, Surface, UsageError, render
from autocolor.images import display_image
from autocolor.mapping.display_image import DisplayImage, words_by_line
from autocolor.mapping.ranges import BACKGROUND, SCREEN_COLORS, SCREENS, WORDS
from autocolor.rendering import Rendering, rendering
from autocolor.scene.columns import Tier
from autocolor.scene.scene import costs_at_least
from autocolor.testing import MAPPINGS, colors, exposures, limits, numbers, paints, scalars, scales, scenes
from tests.autocolor.strategies import rasters
from tests.small import car, wall_scene

LINES, ELEMENTS = 9, 12

Edit = Callable[[Scene], Scene]

names = st.sampled_from(["body", "glass"])


def of_surface(**fields: st.SearchStrategy[Any]) -> st.SearchStrategy[Edit]:
    """Edits of some fields of one surface."""
    return st.builds(
        lambda name, changes: lambda scene: scene.with_surface(name, **changes),
        names,
        st.fixed_dictionaries(fields),
    )


def of_scene(**fields: st.SearchStrategy[Any]) -> st.SearchStrategy[Edit]:
    """Edits of some fields of the scene itself."""
    return st.builds(lambda changes: lambda scene: scene.replace(**changes), st.fixed_dictionaries(fields))


def of_scalar(**fields: st.SearchStrategy[Any]) -> st.SearchStrategy[Edit]:
    """Edits of some fields of the scalar, if there is one."""
    return st.builds(
        lambda changes: lambda scene: scene.with_scalar(**changes) if scene.scalar else scene,
        st.fixed_dictionaries(fields),
    )


paint_edits = of_surface(paint=paints())
edits = st.one_of(
    paint_edits,
    of_surface(blend=numbers(0, 1)),
    of_surface(levels=st.none() | st.integers(2, 300)),
    of_surface(diffuse=numbers(0, 2)),
    of_surface(two_sided=st.booleans()),
    of_scene(background=colors()),
    of_scene(contrast=st.sampled_from(["stretch", "floor"])),
    of_scene(scaling=st.sampled_from(["surface", "object"])),
    of_scene(mapping=st.sampled_from(MAPPINGS)),
    of_scene(exposure=exposures()),
    of_scene(dither=st.sampled_from(["off", "ordered"])),
    of_scene(division=st.sampled_from(["covered", "equal"])),
    of_scene(ambient=numbers(0, 1)),
    of_scene(lights=st.sampled_from([(), (Light("key", (0.0, -3.0, 2.0)),)])),
    of_scene(scalar=st.none() | scalars()),
    of_scalar(scale=scales()),
    of_scalar(below=st.none() | colors()),
    of_scalar(limits=st.none() | limits()),
    of_scalar(bands=st.integers(2, 20)),
    of_scalar(surfaces=st.none() | st.just(("glass",))),
    of_scene(name=st.sampled_from(["scene", "another"])),
)
"""Edits of every tier."""


class Session:
    """A scene, its rendering and its image, edited as a studio does."""

    def __init__(self, scene: Scene) -> None:
        self.rendering: Rendering = rendering(scene, LINES, ELEMENTS)
        self.image = display_image(scene, self.rendering.picture)

    def edit(self, *edits: Edit) -> DisplayImage:
        """The image before the edits; `image` is then the one after them."""
        before, scene = self.image, self.image.scene
        for each in edits:
            scene = each(scene)
        if costs_at_least(before.scene, scene, Tier.MIX):
            self.rendering = rendering(scene, LINES, ELEMENTS, self.rendering)
        self.image = display_image(scene, self.rendering.picture, before)
        return before


def loaded(before: DisplayImage, after: DisplayImage) -> npt.NDArray[np.uint8]:
    """The table of one image after the loads that lead to another."""
    table = before.entries.copy()
    for first, entries in after.loads_after(before):
        assert len(entries) > 0
        table[first : first + len(entries)] = entries
    return table


@given(scenes(), names, paints())
def test_another_paint_loads_the_range_of_its_surface_alone(scene: Scene, name: str, paint: Any) -> None:
    session = Session(scene)
    is_other = scene.surfaces[name].paint != paint
    before = session.edit(lambda scene: scene.with_surface(name, paint=paint))
    loads = [(first, len(entries)) for first, entries in session.image.loads_after(before)]
    has_words = name in session.image.ranges and name not in session.image.bands
    assert loads == ([tuple(session.image.ranges[name])] if is_other and has_words else [])


@given(scenes(), scalars(), scales())
def test_another_color_scale_loads_the_ranges_of_colored_surfaces_alone(
    scene: Scene, scalar: Any, scale: Any
) -> None:
    session = Session(scene.replace(scalar=scalar))
    before = session.edit(lambda scene: scene.with_scalar(scale=scale))
    assert session.image.words is before.words
    loads = [(first, len(entries)) for first, entries in session.image.loads_after(before)]
    ranges = [tuple(session.image.ranges[name]) for name in ("body", "glass") if name in session.image.bands]
    assert loads == ([] if scale == scalar.scale else ranges)


@given(scenes(), of_scene(background=colors()) | of_scene(contrast=st.sampled_from(["stretch", "floor"])))
def test_if_more_than_paints_differ_one_load_reaches_from_the_first_to_the_last_changed_entry(
    scene: Scene, edit: Edit
) -> None:
    session = Session(scene)
    before = session.edit(edit)
    differing = np.flatnonzero((before.entries != session.image.entries).any(axis=1))
    loads = [(first, first + len(entries) - 1) for first, entries in session.image.loads_after(before)]
    assert loads == ([(differing[0], differing[-1])] if len(differing) else [])


@given(scenes())
def test_every_entry_is_the_backgrounds_a_surfaces_or_a_screens(scene: Scene) -> None:
    image = Session(scene).image
    assert image.entries.shape == (WORDS, 3)
    assert tuple(image.entries[BACKGROUND]) == scene.background
    assert list(map(tuple, image.entries[SCREENS.first :].tolist())) == list(SCREEN_COLORS)
    free = np.ones(WORDS, np.bool_)
    free[[BACKGROUND, *range(SCREENS.first, WORDS)]] = False
    for name, (first, levels) in image.ranges.items():
        assert (image.entries[first : first + levels] == image.entries_of(name)).all()
        free[first : first + levels] = False
    assert not image.entries[free].any()
    assert not image.entries.flags.writeable
    assert not image.words.flags.writeable
    assert image.words.max() < SCREENS.first
    assert ((image.words == BACKGROUND) == (image.picture.surface_number == 0)).all()


SPARE = Surface("spare").replace(object_color=(1, 2, 3))


def test_a_surface_that_takes_the_place_and_the_paint_of_another_is_still_loaded() -> None:
    scene = wall_scene()
    blue = scene.surfaces[0].paint.replace(object_color="#0000ff")
    scene = scene.replace(surfaces=[scene.surfaces[0], SPARE.replace(paint=blue)])
    before = display_image(scene, two_tones(0.5, 2.0))
    wall, spare = scene.surfaces
    after = display_image(
        scene.replace(surfaces=[spare, wall.replace(paint=blue)]), two_tones(0.5, 2.0), before
    )
    assert (loaded(before, after) == after.entries).all()
    assert (after.entries != before.entries).any()


def two_tones(least: float, most: float) -> Picture:
    """A picture of two pixels of the wall."""
    relative = np.array([[least, most]], np.float32)
    return Picture.from_rasters(relative, np.ones((1, 2), np.uint8), ("wall",), 1.0)


@pytest.mark.parametrize(
    ("contrast", "scaling", "darkest"),
    [("stretch", "surface", 0), ("stretch", "object", 0), ("floor", "surface", 50), ("floor", "object", 50)],
)
def test_the_lowest_entry_is_black_or_in_proportion_to_the_lowest_intensity(
    contrast: Any, scaling: Any, darkest: int
) -> None:
    wall = Surface("wall").replace(object_color=(200, 200, 200), light_color=(200, 200, 200))
    scene = wall_scene().replace(surfaces=[wall], contrast=contrast, scaling=scaling)
    image = display_image(scene, two_tones(0.5, 2.0))
    dark, bright = image.entries[image.words][0].tolist()
    assert dark == [darkest] * 3
    assert bright == [200] * 3


def test_a_floor_that_moves_with_the_picture_is_loaded() -> None:
    scene = wall_scene(contrast="floor")
    before = display_image(scene, two_tones(0.5, 2.0))
    after = display_image(scene, two_tones(1.0, 2.0), before)
    assert after.ranges is before.ranges
    assert (loaded(before, after) == after.entries).all()
    assert (after.entries != before.entries).any()
    stretched = display_image(scene.replace(contrast="stretch"), two_tones(0.5, 2.0))
    moved = display_image(stretched.scene, two_tones(1.0, 2.0), stretched)
    assert list(moved.loads_after(stretched)) == []


def test_a_surface_that_is_dark_everywhere_or_seen_nowhere_has_a_floor_of_black() -> None:
    zero = np.zeros((1, 2), np.float32), np.zeros((1, 2), np.uint8)
    for picture in (two_tones(0.0, 0.0), Picture.from_rasters(*zero, ("wall",), 1.0)):
        assert display_image(wall_scene(contrast="floor"), picture).entries[1].tolist() == [0, 0, 0]


@given(scenes(), st.lists(st.lists(edits, min_size=1, max_size=3), min_size=1, max_size=3))
def test_an_edited_image_is_as_if_made_alone_and_its_loads_turn_one_table_into_the_other(
    scene: Scene, steps: list[list[Edit]]
) -> None:
    session = Session(scene)
    for step in steps:
        before = session.edit(*step)
        image = session.image
        assert (loaded(before, image) == image.entries).all()
        assert (loaded(image, before) == before.entries).all()
        alone = display_image(image.scene, image.picture)
        assert image.ranges == alone.ranges
        assert (image.words == alone.words).all()
        assert (image.entries == alone.entries).all()
        # The words are shared where no level can have changed.
        if not costs_at_least(before.scene, image.scene, Tier.LEVELS):
            assert image.words is before.words
            assert image.ranges is before.ranges
        renamed = display_image(image.scene.replace(name="new"), image.picture)
        assert list(image.loads_after(image)) == list(image.loads_after(renamed)) == []


@given(scenes(), rasters)
def test_all_lines_together_are_the_words_of_the_picture(scene: Scene, size: tuple[int, int]) -> None:
    image = display_image(scene, render(scene, size))
    found = list(words_by_line(image))
    assert [line for line, _ in found] == list(range(size[1]))
    assert {(words.shape, words.dtype) for _, words in found} == {((1, size[0]), np.dtype("u2"))}
    assert np.concatenate([words for _, words in found]).tolist() == image.words.tolist()


def test_a_coarse_image_has_no_lines() -> None:
    with pytest.raises(UsageError) as caught:
        words_by_line(display_image(car(), render(car(), (16, 12)), block=2))
    assert str(caught.value) == (
        "an image must have blocks of 1 pixel for its lines, not of 2; refine it first"
    )
