from __future__ import annotations

import io
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autocolor import Scene, render
from autocolor.arrays import Words
from autocolor.images import display_image
from autocolor.mapping.palette import thumbnail
from autocolor.screens.gallery import ELEMENTS, FRAME, LINES, Tile
from autocolor.screens.message_line import MESSAGE
from autocolor.screens.pages import CHARACTERS, LEFT, TOP, PageRow
from autocolor.screens.sent_screen import rows_of_edit
from autocolor.screens.session import LastEdit
from autocolor.screens.variants_screen import ON_PAGE, PLACES
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import text
from autocolor.widgets.menu import WORK
from ramtek_emu import GMR_9300, PRINCETON_9300, Ramtek9300, Recorder, instructions
from ramtek_emu.instruction_set.assembler import assemble
from ramtek_emu.instruction_set.disassembler import items
from tests.autocolor.screens.boxes import hand_at, told
from tests.autocolor.screens.hand import Hand
from tests.small import boxes
from tests.tables import first

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
    listed = [item.instruction for item in items([words.astype("<u2").tobytes()])]
    return [instruction.format.name for instruction in listed if instruction is not None]


def listing_of(words: Words) -> list[PageRow]:
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
    row = rows_of_edit(last_edit(recorded.viewer), GMR_9300)[1]
    assert row.text == "no word: no entry of the lookup table, and no word of the picture"


def test_a_color_that_is_undone_from_another_screen_needs_no_word_of_the_picture(recorded: Recorded) -> None:
    viewer = recorded.viewer
    recorded.edit(EDITS["object color"](SCENE))
    viewer.on_key("f2")
    viewer.on_key("z", control=True)
    assert viewer.page == "picture"
    last = last_edit(viewer)
    assert names_in(last.words) == ["LAM"]
    assert last.other_words > viewer.studio.words.size // 2
    # Turning to another screen is no edit.
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


@pytest.mark.parametrize("page", ["picture", "light and view", "mixing"])
def test_the_words_of_a_turned_view_are_told_when_they_go(
    recorded: Recorded, monkeypatch: pytest.MonkeyPatch, page: str
) -> None:
    viewer = recorded.viewer
    recorded.edit(EDITS["object color"](SCENE))
    before = viewer.studio.scene
    viewer.session.turn_to(page)
    viewer.tell("")
    # The coarse picture of a movement is refined by the turn to the listing.
    monkeypatch.setattr("autocolor.studio.block_for", lambda *_: 2)
    viewer.on_key("left")
    if page != "picture":
        # Another edit before the picture is shown again belongs to its words.
        recorded.edit(viewer.studio.scene.with_light("fill", intensity=2))
    viewer.on_key("f2")
    assert not viewer.studio.is_coarse
    sent = recorded.sent_by(lambda: viewer.on_key("f2"))
    last = last_edit(viewer)
    assert (last.before, last.after) == (before, viewer.studio.scene)
    assert sent.startswith(last.words.astype("<u2").tobytes())
    assert sum(name == "WI" for name in names_in(last.words)) > 1
    # Comparing shows words of another scene, which are no edit.
    viewer.on_key("b", typed="b")
    viewer.on_release("b")
    assert last_edit(viewer) is last


@given(st.lists(st.tuples(st.integers(0, 255), st.integers(0, 255)), min_size=1, max_size=20))
def test_a_listing_that_is_whole_assembles_to_the_words(colors: list[tuple[int, int]]) -> None:
    words = instructions.load_entries(7, [(red, green, 9) for red, green in colors])
    lines = [row.text for row in listing_of(words)]
    assert b"".join(assemble(lines)) == words.astype("<u2").tobytes()


def test_an_edit_of_colors_on_the_screen_is_listed_there(recorded: Recorded) -> None:
    viewer = recorded.viewer
    viewer.on_key("f2")
    viewer.on_key("c", typed="c")
    viewer.on_tick()
    assert viewer.page == "sent"
    row = rows_of_edit(last_edit(viewer), GMR_9300)[0]
    assert text(row.text, LEFT, TOP, row.ink) in viewer.board.page().items


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
    words = instructions.load_entries(3, np.zeros((40, 3), np.uint8), short=True)
    rows = rows_of_edit(LastEdit(SCENE, SCENE, words, 0), PRINCETON_9300)
    assert "40 entries" in rows[1].text


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return hand_at(tmp_path, "variants")


def keep(hand: Hand, number: int) -> None:
    """Keep some variants, each in other colors."""
    for each in range(number):
        color = f"#{(each * 67) % 256:02x}{(each * 29) % 256:02x}80"
        hand.viewer.studio.recolor("low", object_color=color)
        hand.pick("keep")


def rest(hand: Hand) -> None:
    for _ in range(ON_PAGE + 1):
        hand.viewer.on_tick()


def shown_at(hand: Hand, place: int) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    """The colors of a small picture on the display."""
    left, top = PLACES[place].left + FRAME, PLACES[place].top + FRAME
    return hand.display.field()[top : top + LINES, left : left + ELEMENTS].astype(np.int64)


def names(hand: Hand) -> list[str]:
    return [each.label for each in hand.viewer.board.content.widgets]


def test_a_scene_is_kept_and_come_back_to_in_one_step(hand: Hand) -> None:
    for label in ("come back", "drop"):
        hand.pick(label)
        assert told(hand) == (f"{label}: no variant is kept yet", True)
    kept = hand.scene
    hand.pick("keep")
    assert told(hand) == ("kept as A", False)
    hand.viewer.studio.recolor("low", object_color="#123456")
    changed = hand.scene
    hand.pick("come back")
    assert hand.scene.equals(kept)
    assert told(hand) == ("A is the scene again; undo goes back", False)
    assert hand.viewer.session.screen == "picture"
    assert hand.viewer.studio.history.to_undo[-1] is changed


def test_a_variant_is_chosen_by_a_click_and_dropped(hand: Hand) -> None:
    keep(hand, 3)
    assert names(hand) == ["A", "B", "C"]
    hand.click(PLACES[1].left + 20, PLACES[1].top + 20)
    hand.pick("drop")
    assert told(hand) == ("variant B dropped", False)
    assert names(hand) == ["A", "C"]
    hand.click(PLACES[0].left + 20, PLACES[0].top + 20)
    hand.pick("come back")
    assert hand.viewer.studio.scene.surfaces["low"].paint.object_color == (0, 0, 128)


def test_a_variant_is_named_when_it_is_kept_and_renamed_by_a_second_click(hand: Hand) -> None:
    hand.viewer.session.has_keyboard = True
    for row, name in (("keep", ""), ("keep", "dusk"), ("keep as", "red")):
        hand.pick(row)
        hand.type(name)
        hand.press("return")
        hand.viewer.studio.recolor("low", blend=0.25 + len(name) / 100)
    assert names(hand) == ["A", "dusk", "red"]
    hand.pick("keep as")
    hand.type("dusk")
    hand.press("return")
    assert told(hand)[1]
    hand.press("escape")
    scene = hand.viewer.studio.variants["A"].scene
    for _ in range(2):
        hand.pick("A", 0.5)
    assert hand.hint == "name of the variant: A"
    hand.type("dawn")
    hand.press("return")
    assert names(hand) == ["dawn", "dusk", "red"]
    assert hand.viewer.studio.variants["dawn"].scene is scene
    assert hand.hint.startswith("variant dawn")


@pytest.mark.parametrize("number", first(1, [4, 1, ON_PAGE]))
def test_small_pictures_have_true_colors_all_at_once(hand: Hand, number: int) -> None:
    keep(hand, number)
    rest(hand)
    assert all(WORK.covers(place) for place in PLACES)
    for place in {0, number - 1}:
        scene = list(hand.viewer.studio.variants.values())[place].scene
        picture = render(scene, (2 * ELEMENTS, 2 * LINES))
        wanted = thumbnail(display_image(scene, picture), LINES, ELEMENTS).astype(np.int64)
        errors = np.abs(shown_at(hand, place) - wanted).max(axis=2)
        assert errors.mean() < 3
        assert np.percentile(errors, 99) <= 16


def pictures(hand: Hand) -> int:
    """How many small pictures are shown."""
    tiles = [each for each in hand.viewer.board.content.widgets if isinstance(each, Tile)]
    return sum(each.picture is not None for each in tiles)


def test_small_pictures_come_in_turn_while_nothing_moves(hand: Hand) -> None:
    keep(hand, 3)
    assert pictures(hand) == 0
    for number in (1, 2, 3, 3):
        hand.viewer.on_tick()
        assert pictures(hand) == number
    assert not hand.viewer.board.content.idle()
    hand.pick("drop")
    hand.turn_to("picture")
    assert np.array_equal(hand.display.entries, hand.viewer.studio.entries)
    # When the screen is back, the pictures of the other variants are shown at once.
    hand.turn_to("variants")
    assert pictures(hand) == 2
    hand.pick("keep")
    assert pictures(hand) == 2
    hand.viewer.on_tick()
    assert pictures(hand) == 3


def test_many_variants_have_pages(hand: Hand) -> None:
    keep(hand, ON_PAGE + 3)
    assert len(names(hand)) == 3
    assert hand.widget("page").present == "2 of 2"  # type: ignore[attr-defined]
    # It opens at the page of the last variant.
    hand.pick("page")
    hand.turn_to("picture")
    hand.turn_to("variants")
    assert len(names(hand)) == 3
    hand.pick("page")
    assert len(names(hand)) == ON_PAGE
    hand.pick("page")
    for _ in range(3):
        hand.pick("drop")
    assert len(names(hand)) == ON_PAGE
    assert "page" not in [row.label for row in hand.viewer.board.content.rows()]
