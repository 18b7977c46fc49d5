"""Journals are read and never run: what is no known call with plain values is refused, with its line."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import autocolor
from autocolor import InputError, MissingInputError, Studio, UsageError, read_journal, read_scene
from autocolor.errors import AutocolorError
from autocolor.journal import reading
from autocolor.journal import reading as lines
from autocolor.journal.history import Edit, History
from autocolor.journal.reading import Steps, called, dotted, expression_of, plain_value, session_of, value_of
from autocolor.journal.script import HEADER, STUDIO
from ramtek_emu import Ramtek9300
from tests.autocolor.sessions import SMALL, car


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("journal")
    # Without scalars, which OBJ cannot hold, so that the mesh is a text.
    autocolor.write_scene(folder / "car", car().replace(mesh=car().mesh.with_scalars()))
    return folder


@pytest.fixture(scope="module")
def text(folder: Path) -> str:
    studio = Studio(read_scene(folder / "car"), Ramtek9300(SMALL))
    studio.recolor("body", blend=0.25)
    return studio.journal(folder / "car")


def refusal(text: str) -> str:
    with pytest.raises(InputError) as refused:
        session_of(text)
    return str(refused.value)


def problem_of(text: str) -> str:
    """The refusal of a text; empty if it is read."""
    try:
        session_of(text)
    except InputError as error:
        return str(error)
    return ""


def test_a_journal_is_read_with_its_steps(folder: Path, text: str) -> None:
    session = session_of(text + "# A comment.\n\nstudio.undo()\r\nstudio.redo()\n")
    assert session.history.scene.surface("body").paint.blend == 0.25
    assert len(session.history.steps) == 3
    assert session.source.path == str(folder / "car")
    assert session.source.up == "z"


@pytest.mark.parametrize(
    "line",
    [
        "__import__('os').remove('x')",
        "studio.recolor('body', blend=__import__('os').getpid())",
        "studio.save('x.npz')",
        "studio.scene.mesh.clear()",
        "studio.edit(scene)",
        "studio.edit(studio.scene.__class__())",
        "studio.edit(studio.scene.replace(ambient=0.5), same_step=True, moving=True)",
        "studio.recolor(*['body'], blend=0.5)",
        "studio.recolor('body', **{'blend': 0.5})",
        "studio.recolor('body', diffuse=0.5)",
        "studio.recolor()",
        "studio.recolor(5, blend=0.1)",
        "studio.undo(3)",
        "studio.remove_light('key', on=True)",
        "studio.undo(); studio.undo()",
        "studio.undo",
        "x = 1",
        "import os",
        "    studio.undo()",
        "studio.view(angle=" + "(" * 5000 + "1" + ")" * 5000 + ")",
        "studio.view(angle=" + "9" * 5000 + ")",
        "studio.view(angle=1" + "+1" * 20000 + ")",
        "studio.\0undo()",
        "other.undo()",
        "studio()()",
        "'\\d'",
    ],
)
def test_anything_but_a_known_call_with_plain_values_is_refused(text: str, line: str) -> None:
    problem = refusal(text + line + "\n")
    assert problem.startswith(
        "journal, line 10: it must be a call that autocolor writes, with plain values, not "
    )
    assert problem.endswith("; remove it")


def test_nothing_of_a_journal_is_run(text: str, folder: Path) -> None:
    for line in ("open('made', 'w')", "studio.view(angle=open('made', 'w').fileno())"):
        refusal(text + line.replace("made", str(folder / "made")))
    assert not (folder / "made").exists()


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("studio.view(angle='x')", "view: angle must be a finite number, not 'x'"),
        (
            "studio.light('keg', on=True)",
            "there is no light 'keg'; did you mean 'key'?",
        ),
        ("studio.undo()\nstudio.undo()", "there must be a step to undo, and there is none; remove the line"),
        ("studio.redo()", "there must be a step to redo, and there is none; remove the line"),
    ],
)
def test_a_step_that_is_refused_is_told_with_its_line(text: str, line: str, problem: str) -> None:
    number = 10 + line.count("\n")
    assert refusal(f"{text}{line}\n") == f"journal, line {number}: {problem}"


def test_another_file_is_no_journal(tmp_path: Path) -> None:
    begin = "a journal must begin as autocolor writes it; choose another file"
    assert refusal("print('hello')\n") == f"journal: {begin}"
    assert refusal("") == f"journal: {begin}"
    assert refusal("\n".join([*HEADER, STUDIO])) == (
        "journal: a journal must make its scene by read_scene, replace and a checksum; choose another file"
    )
    (tmp_path / "a.py").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match=r"^a\.py: a journal must be text in UTF-8; choose another file$"):
        read_journal(tmp_path / "a.py")
    with pytest.raises(MissingInputError):
        read_journal(tmp_path / "b.py")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("autocolor.read_scene(", "autocolor.demo("),
        ("up='z'", "up=5"),
        ("up='z'", "strict=True"),
        ("scene = autocolor", "other = autocolor"),
        ("scene = scene.replace", "scene = scene.with_view"),
        ("checksum = ", "checksum: str = "),
    ],
)
def test_a_scene_that_is_read_otherwise_is_refused(text: str, old: str, new: str) -> None:
    assert "it must be a call that autocolor writes" in refusal(text.replace(old, new))


def test_a_mesh_that_was_changed_since_or_is_gone_is_told(text: str, folder: Path) -> None:
    (path,) = (folder / "car").glob("*.obj")
    before = path.read_text()
    try:
        path.write_text(before.replace("v ", "v 1", 1))
        assert refusal(text) == (
            f"journal, line 7: {folder / 'car'} must hold the mesh that it held when it was opened, and it"
            " was changed since; bring the old file back"
        )
    finally:
        path.write_text(before)
    with pytest.raises(MissingInputError, match="line 5"):
        session_of(text.replace(str(folder / "car"), str(folder / "cat")))


def test_long_lines_and_many_are_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lines, "LONGEST_LINE", 5000)
    problem = refusal(f"{text}studio.undo({'1,' * 5000})\n")
    assert problem == "journal, line 10: it must be at most 5,000 characters, not 10,013; remove it"
    monkeypatch.setattr(reading, "MOST_STEPS", 20)
    assert refusal(text + "studio.undo()\n" * 20) == ("journal: a journal must have at most 20 lines, not 28")


letters = st.text("studio.edit(scene)replace=[]{}'\"\\,:1e9-*#\n \0\ud800", max_size=60)


@given(
    st.lists(letters | st.sampled_from(["studio.", "studio.edit(", "studio.view(angle=", "...)"]), max_size=5)
)
def test_any_line_is_read_or_refused(text: str, pieces: list[str]) -> None:
    problem = problem_of(text + "".join(pieces))
    assert problem == "" or problem.startswith("journal")


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text() | st.binary() | st.integers(),
        lambda inner: (
            st.lists(inner) | st.dictionaries(st.text() | st.integers(), inner) | st.sets(st.integers())
        ),
    ),
    st.sampled_from(
        [
            "view(eye",
            "light('key', flaps",
            "surface('body', model",
            "recolor('body', object_color",
            "add_light('x', position",
            "edit(studio.scene.replace(exposure",
            "edit(studio.scene.replace(lights",
            "edit(studio.scene.replace(mesh",
            "edit(studio.scene.with_part('pane', name",
        ]
    ),
)
def test_any_plain_value_is_taken_or_refused(text: str, value: object, call: str) -> None:
    line = f"studio.{call}={value!r}{')' * call.count('(')}"
    problem = problem_of(f"{text}{line}\n")
    assert problem == "" or problem.startswith("journal, line 10: ")


# -------------------- test_lines
# Lines of a journal as statements that are never run.


def test_a_call_is_told_by_its_name_its_arguments_and_its_keywords() -> None:
    line = "studio.scene.with_light('key', position=[1, -2.5, 1e999], on=False)"
    call = called(expression_of(line), line)
    assert call.name == "studio.scene.with_light"
    assert [plain_value(each, line) for each in call.arguments] == ["key"]
    values = {key: plain_value(value, line) for key, value in call.keywords.items()}
    assert values == {"position": [1, -2.5, float("inf")], "on": False}


def test_the_value_of_an_assignment_is_that_of_one_name() -> None:
    assert plain_value(value_of("checksum = '9f'", "checksum"), "") == "9f"
    for line in ("other = 1", "checksum = other = 1", "checksum", "checksum += 1"):
        with pytest.raises(UsageError, match="it must be a call that autocolor writes"):
            value_of(line, "checksum")


@pytest.mark.parametrize("line", ["f()(1)", "[].append(1)", "f(*[1])", "f(**{})", "f", "1"])
def test_what_is_no_call_of_a_name_is_refused(line: str) -> None:
    with pytest.raises(UsageError):
        called(expression_of(line), line)


def test_a_name_with_dots_is_told_and_nothing_else_is() -> None:
    assert dotted(expression_of("scene.mesh"), "") == "scene.mesh"
    with pytest.raises(UsageError):
        dotted(expression_of("scene().mesh"), "")


# -------------------- test_steps
# Steps that are taken again from their lines, and what is refused.

CAR = car()


def taken(*lines: str) -> History:
    history = History(CAR)
    steps = Steps(history)
    for line in lines:
        steps.take(line)
    return history


def test_variants_and_what_is_saved_are_attached() -> None:
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
