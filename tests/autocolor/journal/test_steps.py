"""Steps that are taken again from their lines, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, UsageError
from autocolor.errors import AutocolorError
from autocolor.journal.history import Edit, History
from autocolor.journal.steps import Steps
from tests.autocolor.sessions import car

CAR = car()


def taken(*lines: str) -> History:
    history = History(CAR)
    steps = Steps(history)
    for line in lines:
        steps.take(line)
    return history


def test_variants_and_what_is_saved_are_taken_up() -> None:
    history = taken(
        "studio.keep_variant('A')",
        "studio.recolor('body', blend=0.25)",
        "studio.mark_saved({'/car.npz': '9f'})",
        "studio.show_variant('A')",
    )
    assert history.scene is CAR
    assert history.is_changed
    assert history.saved.files == {"/car.npz": "9f"}
    assert len(history.to_undo) == 2


def test_a_variant_that_is_shown_already_is_no_step() -> None:
    assert taken("studio.keep_variant('A')", "studio.show_variant('A')").to_undo == ()


def test_an_exposure_is_held_and_released() -> None:
    history = taken("studio.hold_exposure({'object': [0.5, 2.0]})")
    assert history.scene.exposure == (("object", (0.5, 2.0)),)
    assert taken("studio.release_exposure()").to_undo == ()


def test_a_mesh_is_that_of_a_scene_or_the_first_one_and_each_is_read_once(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", CAR)
    change = f"studio.edit(studio.scene.replace(mesh=autocolor.read_scene({str(tmp_path / 'car')!r}).mesh))"
    history = taken(change, "studio.edit(studio.scene.replace(mesh=scene.mesh))", change)
    meshes = [step.after.mesh for step in history.steps if isinstance(step, Edit)]
    assert meshes[1] is CAR.mesh
    assert meshes[0] is meshes[2]
    assert meshes[0] is not CAR.mesh


def test_a_scene_is_opened_with_its_tables(tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
    path = repr(str(tmp_path / "box.obj"))
    history = taken(f"studio.open({path}, up='y', tables={{'ambient': 0.75}})")
    assert history.scene.ambient == 0.75
    assert history.place.source is not None
    assert history.place.source.up == "y"
    with pytest.raises(InputError, match="must hold the mesh that it held when it was opened"):
        taken(f"studio.open({path}, checksum='9f')")


@pytest.mark.parametrize(
    "line",
    [
        "studio.open('a', 'b')",
        "studio.open(5)",
        "studio.open('a', outside=True)",
        "studio.open('a', tables=[])",
        "studio.open('a', scale='2')",
        "studio.open('a', scale=True)",
        "studio.open('a', tables={5: 1})",
        "studio.keep_variant()",
        "studio.keep_variant(name='A')",
        "studio.show_variant(5)",
        "studio.mark_saved()",
        "studio.mark_saved(['/car.npz'])",
        "studio.mark_saved({'/car.npz': 5})",
        "studio.save_session('.')",
        "studio.hold_exposure()",
        "studio.release_exposure(1)",
        "studio.edit(studio.scene.replace(mesh=autocolor.read_scene('a', up='y').mesh))",
        "studio.edit(studio.scene.replace(mesh=autocolor.demo().mesh))",
        "studio.edit(studio.scene.replace(mesh=autocolor.read_scene('a').view))",
        "studio.edit(studio.scene.replace(mesh=studio.scene.mesh))",
        "studio.edit(studio.scene.with_part('hood', mesh=scene.mesh))",
        "scene.edit()",
    ],
)
def test_anything_else_is_refused(line: str) -> None:
    with pytest.raises(UsageError, match="it must be a call that autocolor writes, with plain values, not "):
        taken(line)


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("studio.show_variant('A')", "there is no variant 'A'"),
        ("studio.keep_variant('')", "a variant must have a name of 1 to 100 characters, not ''"),
        ("studio.open('/none.obj')", "/none.obj: there is no such file or folder; check the name"),
        ("studio.open('/', up='w')", "up must be 'x', 'y' or 'z', not 'w'"),
        ("studio.open('/', scale=0)", "scale must be a number above 0 and at most 1e+30"),
        ("studio.hold_exposure({'bodi': [0, 1]})", "exposure 'bodi' is not in the surface table"),
    ],
)
def test_a_step_that_cannot_be_taken_is_told(line: str, problem: str) -> None:
    with pytest.raises(AutocolorError) as refusal:
        taken(line)
    assert str(refusal.value).startswith(problem)
