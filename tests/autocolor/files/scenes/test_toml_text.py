from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Scene
from autocolor.errors import InputError
from autocolor.files.scene_sources import read_scene_with_report
from autocolor.files.scenes.toml_text import key_lines, parsed_toml, scene_text
from tests.autocolor.linked_scenes import linked_scenes
from tests.autocolor.strategies import of_mesh


def refusal(data: bytes | str) -> str:
    with pytest.raises(InputError) as caught:
        parsed_toml(data if isinstance(data, bytes) else data.encode(), "scene.toml")
    assert len(caught.value.problems) == 1
    return str(caught.value)


def test_toml_is_parsed() -> None:
    text = (
        'a = 1\r\n["b.c"."d \\" ["]\n"""'.replace('"""', "")
        + "e = '''x\n[y]'''\n# [[[[\nf = [[1.5, 2.5], []]\n"
    )
    assert parsed_toml(text.encode(), "x") == {
        "a": 1,
        "b.c": {'d " [': {"e": "x\n[y]", "f": [[1.5, 2.5], []]}},
    }


@pytest.mark.parametrize(
    ("text", "line", "place"),
    [
        ("a = 1\nb 2\n", 2, "column 3"),
        ("a = 1\na = 2\n", 2, "column 6"),
        ("\na = [1,\n\n", 2, "the end of the file"),
    ],
)
def test_a_syntax_error_is_one_sentence_with_its_line(text: str, line: int, place: str) -> None:
    sentence = refusal(text)
    assert sentence.startswith(f"scene.toml, line {line}: it must be valid TOML, but is not at {place} (")
    assert sentence.endswith("); correct the line")


def test_other_encodings_are_refused() -> None:
    assert refusal("a = 1".encode("utf-16")) == (
        "scene.toml: a scene file must be text in UTF-8, not UTF-16; save it as UTF-8"
    )
    assert refusal(b"a = 1\nb = '\xe4'") == (
        "scene.toml, line 2: a scene file must be text in UTF-8, not bytes like 0xe4; save it as UTF-8"
    )
    assert refusal(b"a = 1\n\0") == (
        "scene.toml: a scene file must be text, not hold a NUL byte (line 2); save it as UTF-8 text"
    )


@pytest.mark.parametrize("brackets", ["[" * 1000, "[" * 1000 + "]" * 1000, "{a=" * 1000, "[{a=" * 500])
def test_deep_nesting_is_refused_before_parsing(brackets: str) -> None:
    assert refusal("b = 1\na = " + brackets) == (
        "scene.toml, line 2: brackets must be nested at most 16 deep, not deeper; flatten them"
    )


@pytest.mark.parametrize("key", ["a" + ".a" * 20_000, "a" + " . 'b'" * 20_000, '"a"' + '."b"' * 20_000])
@pytest.mark.parametrize("form", ["{} = 1", "[{}]", "[[{}]]", "a = {{ {} = 1 }}"])
def test_long_dotted_keys_are_refused_before_parsing(key: str, form: str) -> None:
    assert refusal("\n" + form.format(key)) == (
        "scene.toml, line 2: a key must have at most 8 parts between dots, not more; shorten it"
    )


@pytest.mark.parametrize("word", ["1" * 5000, "0x" + "f" * 4998, "-1" + "_1" * 2499, "1e" + "9" * 4998])
def test_endless_numbers_are_refused_before_parsing(word: str) -> None:
    assert refusal("a = " + word) == (
        "scene.toml, line 1: a number or a key must have at most 100 digits or letters, not 5,000; write it"
        " shorter, or in quotes"
    )


def test_brackets_and_dots_in_texts_and_comments_do_not_count() -> None:
    brackets = "[" * 100 + "." * 100 + "1" * 200
    text = f"# {brackets}\na = '{brackets}'\nb = \"\\\"{brackets}\"\nc = '''\n'{brackets}'''\n"
    text += f'd = """\n\\"""{brackets}"""\n'
    assert set(parsed_toml(text.encode(), "x")) == {"a", "b", "c", "d"}


def test_a_list_of_many_numbers_is_no_dotted_key() -> None:
    assert len(parsed_toml(b"a = [" + b"1.5, " * 1000 + b"]", "x")["a"]) == 1000


@pytest.mark.parametrize(
    "text", ["a = 'x", 'a = "x\\', 'a = """x', "a = '''x''", 'a = """""', "]]]]", '"' * 9999]
)
def test_open_ends_are_refused(text: str) -> None:
    assert refusal(text).startswith("scene.toml, line 1: it must be valid TOML")


@given(st.binary(max_size=100) | st.text("ab.=[]{}\"'\\#,1-: \n\r\t", max_size=100).map(str.encode))
def test_any_bytes_are_parsed_or_refused(data: bytes) -> None:
    try:
        parsed_toml(data, "scene.toml")
    except InputError:
        return
    key_lines(data)


def test_every_key_has_its_line() -> None:
    text = """
ambient = 1
"a = b" . c = 2
[view]
eye = [
    1,
    2,
]

[[lights]]
name = 'a' # comment
flaps.z = { on = true }
[[lights]]
name = '''
b'''
on = true
[surfaces."a.b"]
"""
    assert key_lines(text.encode()) == {
        ("ambient",): 2,
        ("a = b",): 3,
        ("a = b", "c"): 3,
        ("view",): 4,
        ("view", "eye"): 5,
        ("lights",): 10,
        ("lights", 0): 10,
        ("lights", 0, "name"): 11,
        ("lights", 0, "flaps"): 12,
        ("lights", 0, "flaps", "z"): 12,
        ("lights", 1): 13,
        ("lights", 1, "name"): 14,
        ("lights", 1, "on"): 16,
        ("surfaces",): 17,
        ("surfaces", "a.b"): 17,
    }


MESH = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\no {}\nf 1 2 3 4\no {}\nf 1 2 3\n"


def read_back(
    folder: Path, scene: Scene, mesh_files: tuple[dict[str, str], ...], without_defaults: bool = False
) -> Scene:
    text = scene_text(scene, mesh_files, without_defaults=without_defaults)
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    report = read_scene_with_report(folder)
    assert without_defaults or report.created == ()
    return report.scene


def same(one: Scene, other: Scene) -> bool:
    fields = {field.name for field in dataclasses.fields(Scene)} - {"mesh", "name"}
    arrays = ("coordinates", "node_numbers", "part_numbers")
    return (
        all(getattr(one, name) == getattr(other, name) for name in fields)
        and all(np.array_equal(getattr(one.mesh, name), getattr(other.mesh, name)) for name in arrays)
        and one.mesh.part_names == other.mesh.part_names
        and one.mesh.crease_angle == other.mesh.crease_angle
    )


@pytest.mark.parametrize("without_defaults", [False, True])
@given(drawn=linked_scenes(), up=st.sampled_from("xyz"))
def test_a_scene_that_was_written_reads_back_equal(
    without_defaults: bool, drawn: Scene, up: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(MESH.format(*drawn.mesh.part_names))
    mesh = read_scene_with_report(folder / "car.obj", up=up).scene.mesh
    angle = drawn.mesh.crease_angle
    scene = of_mesh(drawn, dataclasses.replace(mesh, crease_angle=angle))
    assert same(scene, read_back(folder, scene, ({"file": "car.obj", "up": up},), without_defaults))


@given(
    names=st.lists(
        # A backslash at the end of a line would continue it.
        st.text(min_size=1, max_size=20)
        .map(lambda name: name.strip().rstrip("\\").rstrip())
        .filter(lambda name: bool(name) and name.isprintable()),
        min_size=2,
        max_size=2,
        unique=True,
    )
)
def test_any_names_are_written(names: list[str], tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(MESH.format(*names), encoding="utf-8")
    report = read_scene_with_report(folder / "car.obj")
    assert report.scene.mesh.part_names == tuple(names)
    assert same(report.scene, read_back(folder, report.scene, report.mesh_files))  # type: ignore[arg-type]


def test_what_was_created_is_written_out_and_read_back(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj", surfaces="parts")
    assert len(report.created) == 3
    text = scene_text(report.scene, report.mesh_files)
    for table in ("[view]", "[[mesh]]", "[parts.hood]", "[surfaces.roof]", "[[lights]]"):
        assert table in text
    (tmp_path / "scene.toml").write_text(text)
    assert same(report.scene, read_scene_with_report(tmp_path).scene)


def test_ends_of_flaps_that_are_nowhere_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj")
    scene = report.scene.with_light("key", flaps=Flaps(z=Flap(minimum=0.5), x=Flap(on=False)))
    text = scene_text(scene, report.mesh_files)
    assert "flaps.x = { on = false, edge_width = 0.0 }\n" in text
    assert "flaps.z = { minimum = 0.5, on = true, edge_width = 0.0 }\n" in text
    (tmp_path / "scene.toml").write_text(text)
    assert same(scene, read_scene_with_report(tmp_path).scene)


def test_half_spaces_have_a_line_each_and_links_are_lists(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj")
    scene = report.scene.with_light(
        "key",
        half_spaces={
            "left": {"point": (1, 0, 0), "direction": (1, 0, 0)},
            "a door": {"point": (0, 0, 0), "direction": (0, 1, 0), "edge_width": 0.5, "on": False},
        },
        flaps=Flaps(z=Flap(minimum=0.5)),
        only_parts=["hood"],
        except_surfaces=[],
        follows="eye",
    )
    text = scene_text(scene, report.mesh_files, without_defaults=True)
    assert (
        """
flaps.z = { minimum = 0.5 }
half_spaces."a door" = { point = [0.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], edge_width = 0.5, on = false }
half_spaces.left = { point = [1.0, 0.0, 0.0], direction = [1.0, 0.0, 0.0] }
follows = "eye"
except_surfaces = []
only_parts = ["hood"]
"""
        in text
    )
    whole = scene_text(scene, report.mesh_files)
    assert "direction = [1.0, 0.0, 0.0], edge_width = 0.0, carried = false, on = true }\n" in whole
