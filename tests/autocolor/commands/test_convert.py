from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import read_scene
from autocolor.commands.convert import format_lines
from tests.autocolor.commands.conftest import Run


def test_a_mesh_becomes_a_scene_and_that_a_mesh_again(run: Run, folder: Path) -> None:
    to_scene = run("convert", "two.obj", "made")
    assert to_scene.code == 0
    assert to_scene.err.splitlines()[-1] == "wrote made/scene.toml"
    back = run("convert", "made", "back.obj")
    assert back.code == 0
    assert back.err.splitlines()[0].startswith("autocolor: back.obj: left out, as OBJ cannot hold it: ")
    one, other = read_scene("two.obj").mesh, read_scene("back.obj").mesh
    assert (one.coordinates == other.coordinates).all()
    assert one.part_names == other.part_names


def test_a_mesh_is_placed_as_it_is_read(run: Run, folder: Path) -> None:
    assert run("convert", "two.obj", "large.obj", "--up", "y", "--scale", "2").code == 0
    assert read_scene("large.obj").mesh.coordinates[2].tolist() == [2, -2, 0]


def test_nothing_is_overwritten_without_force(run: Run, folder: Path) -> None:
    (folder / "old.obj").write_text("mine")
    refused = run("convert", "none.obj", "old.obj")
    assert (refused.code, (folder / "old.obj").read_text()) == (73, "mine")
    assert run("convert", "two.obj", "old.obj", "--force").code == 0
    assert len(read_scene("old.obj").mesh.node_numbers) == len(read_scene("two.obj").mesh.node_numbers)


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("two.obj",), 2),
        (("two.obj", "-"), 2),
        (("two.obj", ""), 2),
        (("two.obj", "x.xyzzy"), 2),
        (("two.obj", "x", "--to", "nothing"), 2),
        (("none.obj", "x.obj"), 66),
        (("two.obj", "none/x.obj"), 73),
        (("scene", "x.obj", "--up", "y"), 2),
    ],
)
def test_what_cannot_be_done_ends_with_the_code_for_it(
    run: Run, folder: Path, arguments: tuple[str, ...], code: int
) -> None:
    before = sorted(folder.iterdir())
    assert run("convert", *arguments).code == code
    assert sorted(folder.iterdir()) == before


def test_with_strict_what_is_left_out_is_an_exit_code(run: Run, folder: Path) -> None:
    assert run("convert", "two.obj", "a.obj", "--strict").code == 0
    assert run("convert", "scene", "b.obj", "--strict").code == 1
    (folder / "torn.obj").write_text((folder / "two.obj").read_text() + "f 1 1 2\n")
    assert run("convert", "torn.obj", "c.obj", "--strict").code == 1


def test_what_stl_cannot_hold_is_listed(run: Run, folder: Path) -> None:
    (folder / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.1\nv 9 9 9\nf 1 2 3 4\n")
    converted = run("convert", "quad.obj", "quad.stl")
    assert (converted.code, converted.err.splitlines()) == (
        0,
        [
            "autocolor: quad.obj: 1 node that no polygon uses was dropped",
            "autocolor: quad.stl: left out, as STL cannot hold it: 1 quad (each is written as two triangles)",
            "autocolor: quad.stl: left out, as STL cannot hold it: the double precision of 1 node (rounded to"
            " single)",
            "wrote quad.stl",
        ],
    )
    again = run("convert", "quad.stl", "again.stl", "--strict")
    assert (again.code, again.err) == (0, "wrote again.stl\n")
    assert (folder / "again.stl").read_bytes() == (folder / "quad.stl").read_bytes()
    # The dropped node alone is a repair.
    assert run("convert", "quad.obj", "strict.ply", "--strict").code == 1
    assert run("convert", "strict.ply", "strict.stl", "--strict").code == 1
    assert run("convert", "strict.ply", "again.ply", "--strict").code == 0


def test_the_format_may_be_named(run: Run, folder: Path) -> None:
    assert run("convert", "two.obj", "two.model", "--to", "obj").code == 0
    assert run("info", "two.model").code == 0


def test_the_formats_are_listed_with_what_is_read_and_written(run: Run) -> None:
    shown = run("convert", "--formats")
    assert (shown.code, shown.out.splitlines()) == (0, format_lines())
    lines = {line.split()[0]: line for line in format_lines()}
    assert lines["OBJ"].split()[1:] == [".obj", "read,", "written"]
    assert lines["picture"].split()[1:] == [".npz", "read"]
    assert lines["scene"].endswith("read, written")
