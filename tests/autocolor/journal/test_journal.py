"""The journal: it reads back to the same session, and what no journal has is refused with its line."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import autocolor
from autocolor import InputError, MissingInputError, Studio, View, read_journal, read_scene
from autocolor.journal import journal
from autocolor.journal.autosave import JOURNAL, Autosave
from autocolor.journal.history import History, Show
from autocolor.journal.journal import first_line
from autocolor.journal.places import NO_STAMP, Source, checksum_of, opened, place_of
from ramtek_emu import Ramtek9300
from tests.autocolor.journal.random_steps import (
    CAR,
    LARGER,
    OBJ,
    journal_of,
    moves,
    summary,
    take_move,
    written_scenes,
)
from tests.small import SMALL


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Source:
    return written_scenes(tmp_path_factory.mktemp("scenes"))


@pytest.fixture(scope="module")
def box(tmp_path_factory: pytest.TempPathFactory) -> Source:
    """A small scene, which is read at once."""
    path = tmp_path_factory.mktemp("box") / "box.obj"
    path.write_text(OBJ)
    return Source(str(path), surfaces="parts")


@pytest.fixture(scope="module")
def begin(box: Source) -> dict[str, object]:
    """The first line of a journal."""
    record: dict[str, object] = json.loads(first_line(opened(box).scene, box))
    return record


def session_of(source: Source) -> History:
    return History(read_scene(source.path), place_of(source))


def walked(history: History) -> list[tuple[object, ...]]:
    """What is known of a session at each step back to its beginning."""
    found = [summary(history)]
    while history.to_undo:
        history.move("undo")
        found.append(summary(history))
        while history.timeline.views_back:
            history.move("view_back")
            found.append(summary(history))
    return found


@given(st.lists(moves, max_size=8), st.data())
def test_any_session_is_read_back(
    source: Source, taken: list[tuple[str, Any, Any]], data: st.DataObject
) -> None:
    studio = Studio(session_of(source), Ramtek9300(SMALL))
    folder = Path(mkdtemp())
    autosave = Autosave(folder)
    for move in taken:
        take_move(studio, move, Path(source.path).parent)
        if data.draw(st.booleans()):
            autosave.update(studio.history, at_once=True)
    autosave.update(studio.history, at_once=True)
    if studio.history.steps:
        appended = read_journal(folder / JOURNAL).history
        whole = read_journal(journal_of(studio.history, folder)).history
        assert walked(appended) == walked(whole) == walked(studio.history)
    autosave.end()


def test_a_journal_that_is_cut_anywhere_gives_the_session_up_to_a_step(tmp_path: Path, box: Source) -> None:
    history = History(*opened(box))
    summaries = [summary(history)]
    steps: list[Callable[[], None]] = [
        lambda: history.take(history.scene.replace(ambient=0.5)),
        lambda: history.take(history.scene.replace(ambient=0.75), same_step=True),
        lambda: history.keep("A"),
        lambda: history.move("undo"),
        lambda: history.move("redo"),
        lambda: history.mark_saved({"/a\udcff.npz": "9f"}),
    ]
    for step in steps:
        step()
        summaries.append(summary(history))
    path = journal_of(history, tmp_path)
    text = path.read_bytes()
    first = text.index(b"\n") + 1
    for cut in (*range(0, first - 1, 99), first - 1):
        path.write_bytes(text[:cut])
        with pytest.raises(InputError, match="a journal must begin as autocolor writes it"):
            read_journal(path)
    seen = []
    ends = [at for at, byte in enumerate(text) if byte == ord("\n") and at > first]
    for cut in sorted({*range(first, len(text), 9), *ends, *(end + 1 for end in ends)}):
        path.write_bytes(text[:cut])
        seen.append(summary(read_journal(path).history))
    assert [now for before, now in pairwise([None, *seen]) if now != before] == [
        summaries[0],
        *summaries[2:],
    ]


def test_lines_are_steps_in_json(tmp_path: Path, box: Source, begin: dict[str, object]) -> None:
    history = History(*opened(box))
    history.take(history.scene.with_view(angle=3))
    history.take(history.scene.with_view(angle=5), same_step=True)
    history.keep("it's")
    history.go(history.shown("it's"), Show("it's"))
    history.rename("it's", "B")
    history.drop("B")
    history.mark_saved({"/box\udcff.npz": "9f"})
    history.move("undo")
    path = journal_of(history, tmp_path)
    lines = path.read_text("ascii").splitlines(keepends=True)
    assert json.loads(lines[0]) == begin
    assert [line.rstrip("\n") for line in lines[1:]] == [
        '{"step": "edit", "change": "with_view", "row": null, "columns": {"angle": 5.0}, "mesh": null,'
        ' "joins": false}',
        '{"step": "keep", "name": "it\'s"}',
        '{"step": "show", "name": "it\'s"}',
        '{"step": "rename", "name": "it\'s", "to": "B"}',
        '{"step": "drop", "name": "B"}',
        '{"step": "saved", "files": {"/box\\udcff.npz": "9f"}}',
        '{"step": "undo", "steps": 1}',
    ]
    assert summary(read_journal(path).history) == summary(history)


def test_a_file_of_any_name_is_opened_again(tmp_path: Path) -> None:
    path = tmp_path / "b\udcffx \N{SNOWMAN}\n'\".obj"
    path.write_text(OBJ)
    source = Source(str(path), "y", "parts", 0.5)
    history = History(*opened(source))
    history.open(opened(source), source)
    session = read_journal(journal_of(history, tmp_path))
    assert session.source == source
    assert session.history.scene.mesh.coordinates.tolist()[1] == [0.5, 0, 0]
    assert session.history.place.source == source


def test_a_changed_mesh_is_saved_once_beside_the_journal(tmp_path: Path, source: Source) -> None:
    history = session_of(source)
    start = history.start
    larger = start.replace(mesh=LARGER.mesh)
    for scene in (larger, larger.replace(ambient=0.9), start, larger):
        history.take(scene)
    path = journal_of(history, tmp_path / "session")
    assert sorted(each.name for each in path.parent.iterdir()) == ["scene-2", JOURNAL]
    again = read_journal(path).history
    assert summary(again) == summary(history)
    assert again.to_undo[3].mesh is again.start.mesh
    assert again.to_undo[1].mesh is again.scene.mesh
    # The folder can be moved, and a session that goes on saves no mesh again.
    path.parent.rename(tmp_path / "moved")
    again = read_journal(tmp_path / "moved" / JOURNAL).history
    journal_of(again, tmp_path / "moved")
    assert sorted(each.name for each in (tmp_path / "moved").iterdir()) == ["scene-2", JOURNAL]


def test_only_the_mesh_must_still_be_in_the_files(tmp_path: Path) -> None:
    source = written_scenes(tmp_path)
    history = session_of(source)
    history.take(history.scene.with_light("key", on=False))
    path = journal_of(history, tmp_path / "session")
    other = CAR.replace(ambient=0.25, lights=(), view=View((0, 0, 9), direction=(0, 0, -1)))
    autocolor.write_scene(source.path, other, overwrite=True)
    again = read_journal(path).history
    assert checksum_of(again.scene) == checksum_of(history.scene)
    # The file has another scene now, and is not saved over.
    assert again.place.stamp == NO_STAMP


EDIT: dict[str, object] = {
    "step": "edit",
    "change": "replace",
    "row": None,
    "columns": {},
    "mesh": None,
    "joins": False,
}


def edit(change: str, row: str | None = None, **columns: object) -> dict[str, object]:
    return {**EDIT, "change": change, "row": row, "columns": columns}


def refusal(tmp_path: Path, *lines: object) -> str:
    """The refusal of a journal with these lines; empty if it is read."""
    data = [line if isinstance(line, bytes) else json.dumps(line).encode() for line in lines]
    path = tmp_path / JOURNAL
    path.write_bytes(b"\n".join([*data, b""]))
    try:
        read_journal(path)
    except InputError as error:
        return str(error)
    return ""


def raw_edit(column: str, value: str) -> bytes:
    """An edit of a column, whose value may be no JSON."""
    return json.dumps(edit("replace", **{column: "@"})).replace('"@"', value).encode()


STRANGE = (
    *("NaN", "-Infinity", "1e999", "9" * 400, "9" * 5000),
    *('{"a": ' * depth + "1" + "}" * depth for depth in (1, 300, 990, 100_000)),
)
UNKNOWN = "it must be a step that this version of autocolor writes, not "
REFUSED_LINES: dict[str, object] = {
    "another kind": {"step": "paint"},
    "a kind that is no text": {"step": ["edit"]},
    "no kind": {},
    "no object": 3,
    "another field": {"step": "undo", "steps": 1, "count": 2},
    "a missing field": {"step": "keep"},
    "another type": {"step": "keep", "name": 5},
    "a method that is no change": {**EDIT, "change": "__class__"},
    "a row of no table": {**EDIT, "row": "key"},
    "no row": {**EDIT, "change": "with_light"},
    "columns without a light": {**EDIT, "change": "without_light", "row": "key", "columns": {"on": True}},
    "columns without a scalar": {**EDIT, "change": "without_scalar", "columns": {"bands": 3}},
    "a mesh for a light": {**EDIT, "change": "with_light", "row": "key", "mesh": ""},
    "a mesh that is no name": {**EDIT, "mesh": 5},
    "joins that is no truth": {**EDIT, "joins": 1},
    "a scale that is true": {
        "step": "open", **Source("a")._asdict(), "scale": True, "tables": {}, "checksum": "",
    },
    "files that are no stamps": {"step": "saved", "files": {"/car.npz": 5}},
    "half an object": b'{"step": "undo", "steps": 1',
    "an empty line": b"",
    "no UTF-8": b'{"step": "keep", "name": "\xff"}',
    "deep": b'{"step":' * 100_000,
    "a number of many digits": b'{"step": "keep", "name": ' + b"9" * 5000 + b"}",
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED_LINES)
def test_a_line_of_no_journal_is_refused(tmp_path: Path, begin: dict[str, object], name: str) -> None:
    problem = refusal(tmp_path, begin, REFUSED_LINES[name])
    assert problem.startswith(f"{JOURNAL}, line 2: {UNKNOWN}")
    assert problem.endswith("; recover the session with the version that left it")
    assert len(problem) < 500


@given(st.binary(max_size=60) | st.text('{}[]":, step undo\\n0123\0\ud800', max_size=60).map(repr))
def test_any_bytes_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, begin: dict[str, object], data: bytes | str
) -> None:
    line = data if isinstance(data, bytes) else data.encode()
    problem = refusal(tmp_path_factory.getbasetemp(), begin, line.replace(b"\n", b" "))
    assert problem.startswith(f"{JOURNAL}, line 2: ")


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ({"step": "undo", "steps": 1}, "there must be a step to undo, and there is none; remove the line"),
        ({"step": "redo", "steps": 1}, "there must be a step to redo, and there is none; remove the line"),
        ({"step": "redo", "steps": 0}, "there must be a step to redo, and there is none; remove the line"),
        ({"step": "show", "name": "A"}, "there is no variant 'A'"),
        (edit("with_surface", "aa"), "there is no surface 'aa'; did you mean 'a'?"),
        (edit("replace", mesh="x"), "mesh must be a Mesh, not 'x'"),
        *((raw_edit("exposure", value), "") for value in STRANGE),
        ({**EDIT, "mesh": "scene-2"}, "scene-2: there is no such file or folder; check the name"),
        ({**EDIT, "mesh": "a\0b"}, "a file name must be valid on this system, not "),
    ],
)
def test_a_step_that_is_refused_is_named_by_its_line(
    tmp_path: Path, begin: dict[str, object], line: object, problem: str
) -> None:
    text = refusal(tmp_path, begin, line)
    assert text.startswith(f"{JOURNAL}, line 2: ")
    assert problem in text


@pytest.mark.parametrize(
    ("field", "value", "problem"),
    [
        ("scale", 0, "scale must be "),
        ("path", "/none.obj", "/none.obj: there is no such file or folder; check the name"),
        ("path", f"{'x' * 5000}.toml", "xxx"),
        ("tables", {"mesh": 3}, "mesh must be a Mesh, not 3"),
        ("checksum", "9f", "must hold the mesh that it held when it was opened"),
    ],
)
def test_a_scene_that_cannot_be_opened_is_refused(
    tmp_path: Path, begin: dict[str, object], field: str, value: object, problem: str
) -> None:
    later = {name: inner for name, inner in begin.items() if name != "version"} | {"step": "open"}
    for number, lines in ((1, [{**begin, field: value}]), (2, [begin, {**later, field: value}])):
        text = refusal(tmp_path, *lines)
        assert text.startswith(f"{JOURNAL}, line {number}: ")
        assert problem in text


NO_JOURNAL = f"{JOURNAL}: a journal must begin as autocolor writes it; choose another file"


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", NO_JOURNAL),
        (b"\xff\xfe\n", NO_JOURNAL),
        (b'{"step": "undo", "steps": 1}', NO_JOURNAL),
        (
            b'"""A session of autocolor: run it with Python."""\nimport autocolor\n',
            f"{JOURNAL}: it is the script of a session, not a journal; run it with Python",
        ),
    ],
)
def test_another_file_is_no_journal(tmp_path: Path, data: bytes, problem: str) -> None:
    assert refusal(tmp_path, data) == problem
    with pytest.raises(MissingInputError):
        read_journal(tmp_path / "none" / JOURNAL)


def test_a_journal_begins_once_and_is_of_this_version(tmp_path: Path, begin: dict[str, object]) -> None:
    assert refusal(tmp_path, {**begin, "version": 3}).startswith(f"{JOURNAL}, line 1: {UNKNOWN}")
    once = f"{JOURNAL}, line 2: a journal must begin once; remove the line"
    assert refusal(tmp_path, begin, begin) == once


SEEN_IN_VERSION_1 = [
    *[(0.13, 0, 0.88), (0.13, 0, 0.25), (0.13, 10, 0.25), (0.13, 10, 0.25), (0.5, 10, 0.25)],
    *[(0.13, 10, 0.25), (0.13, 0, 0.25), (0.13, 20, 0.25), (0.13, 0, 0.25), (0.13, 20, 0.25)],
    *[(0.13, 10, 0.25), (0.13, 10, 0.25), (0.13, 20, 0.25), (0.13, 10, 0.25), (0.13, 30, 0.25)],
    *[(0.75, 30, 0.25), (0.13, 30, 0.25), (0.13, 10, 0.25)],
]
"""The ambient light, the angle and the blend that version 1 showed after each line of its journal."""


def test_a_journal_of_version_1_shows_what_version_1_showed(tmp_path: Path, box: Source) -> None:
    text = Path(__file__).with_name("version_1.jsonl").read_text("ascii")
    *lines, _ = text.replace("/home/ann/box.obj", box.path).split("\n")
    path = tmp_path / JOURNAL
    seen = []
    for count in range(1, len(lines) + 1):
        # The program may have been killed after each line, and during the next.
        path.write_text("\n".join([*lines[:count], "".join(lines[count : count + 1])[:-1]]), "ascii")
        history = read_journal(path).history
        scene = history.scene
        seen.append((scene.ambient, scene.view.angle, scene.surfaces[0].paint.blend))
    assert seen == SEEN_IN_VERSION_1
    # Views are no steps any more: the paint and the variant are left to undo, the ambient light to redo.
    assert [len(history.to_undo), len(history.to_redo)] == [2, 1]
    assert history.unsaved_variants == ()
    again = read_journal(journal_of(history, tmp_path / "again", box)).history
    assert walked(again) == walked(history)


earlier_moves = st.lists(
    st.tuples(st.just("edit"), st.booleans(), st.tuples(st.integers(0, 2), st.integers(0, 2)))
    | st.tuples(st.sampled_from(["undo", "redo", "open", "keep", "show"]), st.none(), st.none()),
    max_size=12,
)


@given(earlier_moves)
def test_any_journal_of_version_1_ends_as_version_1_did(
    tmp_path_factory: pytest.TempPathFactory,
    box: Source,
    begin: dict[str, object],
    taken: list[tuple[str, Any, Any]],
) -> None:
    # The twin is version 1: two stacks of pairs, the ambient light and the angle.
    present: tuple[float, int] = (1, 0)
    undone: list[Any] = [None]
    redone: list[Any] = []
    kept: dict[str, Any] = {}
    later = {name: inner for name, inner in begin.items() if name != "version"} | {"step": "open"}
    lines: list[object] = [{**begin, "version": 1}, edit("replace", ambient=0.25, view={"angle": 0})]
    for kind, same_step, values in taken:
        name = f"{len(kept) - (kind == 'show')}"
        if kind == "edit" and values != present:
            joins = same_step and not redone
            record = edit("replace", ambient=values[0] / 4, view={"angle": values[1]})
            lines.append({**record, "joins": joins})
            if not joins:
                undone.append(present)
                redone.clear()
            present = values
        elif kind in ("undo", "redo"):
            there, here = (undone, redone) if kind == "undo" else (redone, undone)
            if there and there[-1] is not None:
                lines.append({"step": kind})
                here.append(present)
                present = there.pop()
        elif kind == "keep":
            lines.append({"step": "keep", "name": name})
            kept[name] = present
        elif kind == "open" or (kind == "show" and kept and kept[name] != present):
            lines.append(later if kind == "open" else {"step": "show", "name": name})
            undone.append(present)
            redone.clear()
            present = (0.52, 0) if kind == "open" else kept[name]
    path = tmp_path_factory.mktemp("earlier") / JOURNAL
    path.write_text("".join(f"{json.dumps(line)}\n" for line in lines), "ascii")
    scene = read_journal(path).history.scene
    assert (scene.ambient, scene.view.angle) == (present[0] / 4, present[1])


def test_long_lines_and_many_lines_are_refused(
    tmp_path: Path, begin: dict[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal, "LONGEST_LINE", 5000)
    problem = f"{JOURNAL}, line 2: it must be at most 5,000 bytes, not 5,001; remove it"
    assert refusal(tmp_path, begin, b" " * 5001) == problem
    assert UNKNOWN in refusal(tmp_path, begin, b" " * 5000)
    monkeypatch.setattr(journal, "MOST_LINES", 20)
    assert refusal(tmp_path, begin, *[b""] * 20) == (
        f"{JOURNAL}: a journal must have at most 20 lines; choose another file"
    )
    assert UNKNOWN in refusal(tmp_path, begin, *[b""] * 19)
    monkeypatch.setattr(journal, "LARGEST_JOURNAL", 30)
    assert "must have at most 30 bytes" in refusal(tmp_path, begin)
