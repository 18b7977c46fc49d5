from __future__ import annotations

from pathlib import Path

from autocolor import read_scene
from tests.autocolor.commands.conftest import Run, is_same


def test_a_mesh_becomes_a_scene_and_that_a_mesh_again(run: Run, folder: Path) -> None:
    to_scene = run("convert", "two.obj", "made")
    assert (to_scene.code, to_scene.err.splitlines()[-1]) == (0, "wrote made/scene.toml")
    back = run("convert", "made", "back.obj")
    assert back.code == 0
    assert back.err.splitlines()[0].startswith("autocolor: back.obj: left out, as OBJ cannot hold it: ")
    one, other = read_scene("two.obj").mesh, read_scene("back.obj").mesh
    assert (one.coordinates == other.coordinates).all()
    assert one.part_names == other.part_names


def test_a_mesh_is_placed_as_it_is_read(run: Run, folder: Path) -> None:
    assert run("convert", "two.obj", "large.obj", "--up", "y", "--scale", "2").code == 0
    assert read_scene("large.obj").mesh.coordinates[2].tolist() == [2, -2, 0]


def test_what_stl_cannot_hold_is_listed(run: Run, folder: Path) -> None:
    (folder / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.1\nv 9 9 9\nf 1 2 3 4\n")
    converted = run("convert", "quad.obj", "quad.stl")
    assert converted.code == 0
    repaired, quads, wrote = converted.err.splitlines()
    assert repaired.startswith("autocolor: quad.obj: 1 node that no polygon uses was dropped")
    assert quads.startswith("autocolor: quad.stl: left out, as STL cannot hold it: the quads ")
    assert wrote == "wrote quad.stl"
    again = run("convert", "quad.stl", "again.stl", "--strict")
    assert (again.code, again.err) == (0, "wrote again.stl\n")
    assert is_same("again.stl", "quad.stl")
    # The dropped node alone is a repair, and the quad alone is left out.
    assert run("convert", "quad.obj", "strict.ply", "--strict").code == 1
    assert run("convert", "strict.ply", "strict.stl", "--strict").code == 1
    assert run("convert", "strict.ply", "again.ply", "--strict").code == 0
    # A scene leaves out more than its mesh does.
    assert run("convert", "scene", "b.obj", "--strict").code == 1


def test_the_format_may_be_named(run: Run, folder: Path) -> None:
    assert run("convert", "two.obj", "two.model", "--to", "obj").code == 0
    assert run("info", "two.model").code == 0


def test_the_formats_are_listed_with_what_is_read_and_written(run: Run) -> None:
    shown = run("convert", "--formats")
    assert (shown.code, shown.err) == (0, "")
    lines = shown.out.splitlines()
    rows = {line.split()[0]: line.split()[1:] for line in lines}
    assert rows["OBJ"] == ["read,", "written:", ".obj"]
    assert rows["picture"] == ["read:", ".npz"]
    assert rows["scene"][:2] == ["read,", "written:"]
    assert [line.casefold() for line in lines] == sorted(line.casefold() for line in lines)
