from __future__ import annotations

import io
import itertools
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autocolor import Scene
from autocolor.arrays import Words
from autocolor.screens.message_line import MESSAGE
from autocolor.screens.sent_screen import CHARACTERS, ROWS_A_PAGE, ListingRow, rows_of_edit
from autocolor.screens.session import LastEdit
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import SCREEN, text
from ramtek_emu import GMR_9300, PRINCETON_9300, Ramtek9300, Recorder, instructions
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items
from tests.small import boxes

SCENE = boxes()

EDITS: dict[str, Callable[[Scene], Scene]] = {
    "object color": lambda scene: scene.with_paint("high", object_color="#24c"),
    "blend": lambda scene: scene.with_paint("low", blend=0.9),
    "specular": lambda scene: scene.with_surface("low", reflectance={"specular": 0.9}),
    "light": lambda scene: scene.with_light("fill", intensity=2),
    "switch": lambda scene: scene.with_light("key", on=False),
    "view": lambda scene: scene.with_view(eye=(3, -2, 1)),
    "name": lambda scene: scene.replace(name="other"),
    "background": lambda scene: scene.replace(background="#123"),
}


class Recorded:
    """A viewer on a display in this process, and the bytes that it sent."""

    def __init__(self, folder: Path) -> None:
        self.display = Ramtek9300()
        self.file = io.BytesIO()
        self.viewer = Viewer(SCENE, Recorder(self.file, self.display), folder)

    def sent_by(self, action: Callable[[], object]) -> bytes:
        """The bytes that an action sends."""
        start = self.file.tell()
        action()
        return self.file.getvalue()[start:]

    def edit(self, scene: Scene) -> bytes:
        """The bytes that the page of an edited scene sends."""
        session = self.viewer.session
        session.same_step = False
        session.edit(scene)
        return self.sent_by(lambda: self.viewer.tell(""))


@pytest.fixture
def recorded(tmp_path: Path) -> Recorded:
    viewer = Recorded(tmp_path)
    viewer.viewer.tell("")
    return viewer


def last_edit(viewer: Viewer) -> LastEdit:
    last = viewer.session.last_edit
    assert last is not None
    return last


def names_in(words: Words) -> list[str]:
    """The names of the instructions of a stream that has nothing else."""
    listed = list(items([words.astype("<u2").tobytes()]))
    assert all(item.instruction is not None for item in listed)
    return [item.instruction.format.name for item in listed if item.instruction is not None]


def listing_of(words: Words) -> list[ListingRow]:
    """The rows below the table of shares."""
    rows = rows_of_edit(LastEdit(SCENE, SCENE, words, 0), GMR_9300)
    return rows[max(number for number, row in enumerate(rows) if not row.text) + 1 :]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(names=st.lists(st.sampled_from([*EDITS, "undo", "redo"]), max_size=8))
def test_the_words_are_those_that_the_display_received(tmp_path: Path, names: list[str]) -> None:
    recorded = Recorded(tmp_path)
    viewer, replayed = recorded.viewer, Ramtek9300()
    replayed.send(last_edit(viewer).words)
    for name in names:
        before = viewer.studio.scene
        if name in EDITS:
            sent = recorded.edit(EDITS[name](before))
        else:
            steps = viewer.studio.history.to_undo if name == "undo" else viewer.studio.history.to_redo
            if not steps:
                continue
            key = "z" if name == "undo" else "y"
            sent = recorded.sent_by(partial(viewer.on_key, key, control=True))
        last = last_edit(viewer)
        assert last.after is viewer.studio.scene
        if last.after is not before:
            assert last.before is before
            assert sent[: 2 * len(last.words)] == last.words.astype("<u2").tobytes()
            assert len(sent) == 2 * (len(last.words) + last.other_words)
            replayed.send(last.words)
    # The words of the edits alone make the picture: a message covers its lowest lines.
    shown = slice(0, MESSAGE.top)
    assert np.array_equal(replayed.entries, viewer.studio.entries)
    assert np.array_equal(replayed.words[shown], viewer.studio.words[shown])


def test_a_color_sends_entries_and_no_word_of_the_picture(recorded: Recorded) -> None:
    recorded.edit(EDITS["object color"](SCENE))
    last = last_edit(recorded.viewer)
    assert names_in(last.words) == ["LAM"]
    rows = [row.text for row in rows_of_edit(last, GMR_9300)]
    assert rows[0] == "high: object color #2244cc"
    assert re.fullmatch(r"\d+ words: \d+ entries of the lookup table, and no word of the picture", rows[1])
    assert "100.0%" in rows[4]
    # What is not shown sends nothing.
    recorded.edit(EDITS["name"](recorded.viewer.studio.scene))
    last = last_edit(recorded.viewer)
    assert len(last.words) == 0
    assert rows_of_edit(last, GMR_9300)[1].text == (
        "no word: no entry of the lookup table, and no word of the picture"
    )


def test_a_color_that_is_undone_from_another_screen_needs_no_word_of_the_picture(recorded: Recorded) -> None:
    viewer = recorded.viewer
    recorded.edit(EDITS["object color"](SCENE))
    viewer.on_key("f2")
    viewer.on_key("z", control=True)
    assert viewer.page == "picture"
    last = last_edit(viewer)
    assert names_in(last.words) == ["LAM"]
    assert last.other_words > viewer.studio.words.size // 2


def test_turning_to_another_screen_is_no_edit(recorded: Recorded) -> None:
    viewer = recorded.viewer
    recorded.edit(EDITS["view"](SCENE))
    last = last_edit(viewer)
    for name in viewer.screens:
        viewer.session.turn_to(name)
        viewer.tell("")
        viewer.on_tick()
    assert viewer.session.last_edit is last


def test_a_coarse_picture_is_followed_by_the_words_of_its_refined_picture(
    recorded: Recorded, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer = recorded.viewer
    monkeypatch.setattr("autocolor.studio.block_for", lambda *_: 2)
    viewer.on_key("left")
    viewer.on_key("left", repeated=True)
    assert viewer.studio.is_coarse
    coarse = last_edit(viewer)
    monkeypatch.undo()
    viewer.on_tick(is_at_rest=True)
    assert not viewer.studio.is_coarse
    refined = last_edit(viewer)
    assert (refined.before, refined.after) == (coarse.before, coarse.after)
    assert len(refined.words) != len(coarse.words) or (refined.words != coarse.words).any()
    assert "WI" in names_in(refined.words)


@given(st.lists(st.tuples(st.integers(0, 255), st.integers(0, 255)), min_size=1, max_size=20))
def test_a_listing_that_is_whole_assembles_to_the_words(colors: list[tuple[int, int]]) -> None:
    words = instructions.load_entries(7, [(red, green, 9) for red, green in colors])
    lines = [row.text for row in listing_of(words)]
    assert b"".join(assemble(lines)) == words.astype("<u2").tobytes()


def test_the_pages_have_every_row_once_and_nothing_overlaps(recorded: Recorded) -> None:
    viewer = recorded.viewer
    recorded.edit(EDITS["view"](SCENE))
    rows = rows_of_edit(last_edit(viewer), GMR_9300)
    viewer.on_key("f2")
    screen = viewer.screens[viewer.page]
    count = -(-len(rows) // ROWS_A_PAGE)
    assert count > 1
    shown = []
    for _ in range(count):
        page = screen.items()
        shown += [item.stream for item in page]
        for one, other in itertools.combinations(page, 2):
            assert not one.area.overlaps(other.area)
        assert all(SCREEN.covers(item.area) and not MESSAGE.overlaps(item.area) for item in page)
        viewer.on_key("space", typed=" ")
    for number, row in enumerate(rows):
        top = 50 + 13 * (number % ROWS_A_PAGE)
        assert not row.text or text(row.text, 8, top, row.ink).stream in shown


def test_an_edit_of_colors_on_the_screen_is_listed_there(recorded: Recorded) -> None:
    viewer = recorded.viewer
    viewer.on_key("f2")
    viewer.on_key("c", typed="c")
    viewer.on_tick()
    assert viewer.page == "sent"
    whole = Ramtek9300()
    rows = rows_of_edit(last_edit(viewer), GMR_9300)
    whole.send(np.frombuffer(text(rows[0].text, 8, 50, rows[0].ink).stream, np.uint16))
    area = text(rows[0].text, 8, 50).area
    places = slice(area.top, area.bottom + 1), slice(area.left, area.right + 1)
    assert np.array_equal(recorded.display.words[places], whole.words[places])


@given(st.integers(1, 30), st.integers(1, 300), st.integers(0, 2**32 - 1))
def test_a_long_listing_says_how_many_words_it_leaves_out(lines: int, elements: int, seed: int) -> None:
    image = np.random.default_rng(seed).integers(0, 3, (lines, elements)).astype(np.uint16)
    words = instructions.write_image(image)
    rows = [row.text.removesuffix(f"{2 * image.size} bytes") for row in listing_of(words)]
    left_out = re.fullmatch(r" *and ([\d,]+) words? more of this instruction", rows[-1])
    listed = " ".join(line[37:] for line in rows[: -1 if left_out else None])
    # A repeated word is written as 0010*640.
    repeats = re.findall(r"\b[0-9A-F]{4}(?:\*(\d+))?(?= |$)", listed)
    count = sum(int(repeat or 1) for repeat in repeats)
    assert count + (int(left_out[1].replace(",", "")) if left_out else 0) == image.size
    assert all(len(row) <= CHARACTERS for row in rows)


def test_a_display_with_short_entries_counts_a_word_for_each() -> None:
    words = instructions.load_short_entries(3, np.zeros((40, 3), np.uint8))
    rows = rows_of_edit(LastEdit(SCENE, SCENE, words, 0), PRINCETON_9300)
    assert "40 entries" in rows[1].text
