from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given

from autocolor import (
    InputError,
    Light,
    Mesh,
    Rig,
    Scene,
    Studio,
    Surface,
    read_journal,
    read_rig,
    read_scene,
    render,
    scene_of,
    write_rig,
    write_scene,
)
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from autocolor.scene.columns.column import Tier
from autocolor.scene.lights.links import Links
from autocolor.scene.scene import cost_of_edit
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import grid
from tests.autocolor.strategies import some_of

NAMES = ["body", "glass", "floor"]


def panels(**links: object) -> Scene:
    """Three walls side by side, two of them of one surface, under one light."""
    rows = [grid(1, 1, (2 * column, 0, 0), (2, 0, 0), (0, 0, 2), name) for column, name in enumerate("abc")]
    return scene_of(
        Mesh.joined(rows),
        surfaces=[Surface("body"), Surface("glass")],
        surface_of_part={"a": "body", "b": "body", "c": "glass"},
        lights=[Light("key", (3, -4, 1), links=links)],  # type: ignore[arg-type]
    )


@given(some_of(NAMES), some_of(NAMES))
def test_a_light_shines_on_what_is_named_or_on_all_but_what_is_excepted(
    some: tuple[str, ...], others: tuple[str, ...]
) -> None:
    for name in NAMES:
        assert Links().shines_on_surface(name)
        assert Links(only_surfaces=some).shines_on_surface(name) == (name in some)
        assert Links(except_surfaces=some).shines_on_surface(name) == (name not in some)
    assert Links().lit_parts(NAMES) == {*NAMES}
    assert Links(only_parts=others).lit_parts(NAMES) == {*others}
    assert Links(except_parts=others).lit_parts(NAMES) == {*NAMES} - {*others}
    assert Links(only_parts=(*others, "elsewhere")).lit_parts(NAMES) == {*others}


@pytest.mark.parametrize("what", ["surfaces", "parts"])
def test_names_and_excepted_names_do_not_come_together(what: str) -> None:
    with pytest.raises(InputError) as refused:
        Links(**{f"only_{what}": ("a",), f"except_{what}": ("b",)})
    assert f"except_{what} must not come with only_{what}, not with both; leave one out" in str(refused.value)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"only_surfaces": ["bodi"]},
            "light 'key': only_surfaces 'bodi' is not in the surface table; did you mean 'body'?",
        ),
        ({"except_parts": ["d"]}, "light 'key': except_parts 'd' is not in the part table"),
        ({"links": Links(only_parts=("a", "d"))}, "light 'key': only_parts 'd' is not in the part table"),
        ({"links": {"only_parts": ["d"]}}, "light 'key': only_parts 'd' is not in the part table"),
    ],
)
def test_what_is_not_in_the_scene_is_refused_by_name(changes: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        panels().with_light("key", **changes)  # type: ignore[arg-type]
    assert str(refused.value).startswith(sentence)


def test_a_surface_that_a_light_is_linked_to_is_not_renamed_nor_removed_alone() -> None:
    scene = panels()
    scene = scene.replace(surfaces=(*scene.surfaces, Surface("spare")))
    scene = scene.with_light("key", except_surfaces=["spare"])
    sentence = "light 'key': except_surfaces 'spare' is not in the surface table"
    with pytest.raises(InputError) as refused:
        scene.with_surface("spare", name="other")
    assert str(refused.value).startswith(sentence)
    with pytest.raises(InputError) as refused:
        scene.replace(surfaces=scene.surfaces[:2])
    assert str(refused.value).startswith(sentence)
    renamed = scene.replace(
        surfaces=(*scene.surfaces[:2], Surface("other")),
        lights=(scene.light("key").replace(except_surfaces=["other"]),),
    )
    assert renamed.light("key").links == Links(except_surfaces=("other",))


def test_another_mesh_without_a_part_that_a_light_is_linked_to_is_refused() -> None:
    scene = panels(only_parts=["c"])
    fewer = panels()
    rows = [grid(1, 1, (2 * column, 0, 0), (2, 0, 0), (0, 0, 2), name) for column, name in enumerate("ab")]
    with pytest.raises(InputError) as refused:
        scene.replace(mesh=Mesh.joined(rows), parts=fewer.parts[:2])
    assert str(refused.value).startswith("light 'key': only_parts 'c' is not in the part table")


def test_links_to_surfaces_cost_the_sum_and_links_to_parts_the_light() -> None:
    scene = panels()
    for field in ("only_surfaces", "except_surfaces"):
        linked = scene.with_light("key", **{field: ["glass"]})  # type: ignore[arg-type]
        assert cost_of_edit(scene, linked) == cost_of_edit(linked, scene) == Tier.MIX
    for field in ("only_parts", "except_parts"):
        linked = scene.with_light("key", **{field: ["a"]})  # type: ignore[arg-type]
        assert cost_of_edit(scene, linked) == cost_of_edit(linked, scene) == Tier.LIGHT


@pytest.mark.parametrize(
    ("links", "left"),
    [
        (Links(), Links()),
        (Links(only_surfaces=("body", "chrome")), Links(only_surfaces=("body",))),
        (Links(except_surfaces=("chrome",)), Links()),
        (Links(only_surfaces=("chrome",), except_parts=("b", "z")), Links(except_parts=("b",))),
        (Links(only_parts=("z",), except_surfaces=()), Links(except_surfaces=())),
        (Links(only_parts=()), Links(only_parts=())),
    ],
)
def test_a_rig_leaves_out_the_links_to_what_a_scene_does_not_have(links: Links, left: Links) -> None:
    scene = panels()
    rig = Rig(*scene.object_bounds, (Light("rim", (3, -4, 1), links=links),))
    assert scene.with_rig(rig).light("rim").links == left
    assert links.within(["body", "glass", "chrome"], ["a", "b", "z"]) is links


def test_links_are_kept_by_scene_files_and_rig_files(tmp_path: Path) -> None:
    scene = panels(only_surfaces=["body", "glass"], except_parts=["a"])
    write_scene(tmp_path / "scene", scene)
    again = read_scene(tmp_path / "scene")
    assert again.lights == scene.lights
    assert render(again, 12, 16).intensity.tobytes() == render(scene, 12, 16).intensity.tobytes()
    write_rig(tmp_path / "rig.toml", scene)
    assert read_rig(tmp_path / "rig.toml").lights == scene.lights


def test_links_are_undone_and_told_by_the_journal(tmp_path: Path) -> None:
    source = Source(str(tmp_path / "scene"))
    write_scene(source.path, panels())
    studio = Studio(History(read_scene(source.path), place_of(source)), Ramtek9300())
    before = studio.words.copy()
    studio.light("key", only_surfaces=["glass"])
    assert (studio.words != before).any()
    studio.light("key", only_surfaces=None, except_parts=["b"])
    (tmp_path / "session.py").write_text(studio.journal(beside=tmp_path / "beside"), "utf-8")
    history = read_journal(tmp_path / "session.py").history
    assert history.scene.light("key").links == Links(except_parts=("b",))
    assert (Studio(history, Ramtek9300()).words == studio.words).all()
    studio.undo()
    assert studio.scene.light("key").links == Links(only_surfaces=("glass",))
    studio.undo()
    assert (studio.words == before).all()
