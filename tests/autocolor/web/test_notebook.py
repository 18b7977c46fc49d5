"""Widgets of a studio: what travels to the browser, and what its messages do."""

from __future__ import annotations

import base64
import copy
import dataclasses
import itertools
import pickle
import sys
import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autocolor import Studio, UnavailableError
from autocolor.arrays import Words
from autocolor.files.settings import scene_with
from autocolor.testing import colors
from autocolor.web import notebook
from ramtek_emu import PRINCETON_9300, Configuration, PortError, Ramtek9300, instructions
from ramtek_emu.timing import Timing
from tests.autocolor.sessions import SMALL, car, opened

pytest.importorskip("anywidget")

OBJECT_COLOR = "surfaces.body.object_color"
NUMBERS = itertools.count()
LOCAL = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


class Browser:
    """The browser's side of a widget, as the stub of its comm: what arrived, and the answers to messages."""

    def __init__(self, data: dict[str, Any], buffers: list[bytes], **_: object) -> None:
        self.comm_id = f"stub {next(NUMBERS)}"
        self.traits: dict[str, Any] = {}
        self.arrived: list[set[str]] = []
        """The names of the traits in each update."""
        self.answers: list[str] = []
        self.is_lost = False
        self._take(data, buffers)
        self.arrived.clear()

    def send(self, data: dict[str, Any], buffers: list[bytes] | None = None) -> None:
        if self.is_lost:
            raise ConnectionError("the kernel is gone")
        if data["method"] == "custom":
            self.answers.append(data["content"]["answer"])
        else:
            self._take(data, buffers or [])

    def _take(self, data: dict[str, Any], buffers: list[bytes]) -> None:
        binary = {path[0]: bytes(each) for path, each in zip(data["buffer_paths"], buffers, strict=True)}
        self.arrived.append({*data["state"], *binary})
        self.traits |= data["state"] | binary

    def on_msg(self, callback: Any) -> None:
        self._callback = callback

    def close(self) -> None:
        self.is_lost = True

    def say(self, message: object) -> str:
        """Send a message to the studio; returns the sentence of the answer."""
        answers = len(self.answers)
        self._callback({"content": {"data": {"method": "custom", "content": message}}, "buffers": []})
        (answer,) = self.answers[answers:]
        return answer

    @property
    def words(self) -> Words:
        """The words that the browser shows, by a plain twin of its unpacking."""
        lines, elements = self.traits["picture"]["lines"], self.traits["picture"]["elements"]
        data = zlib.decompress(self.traits["words"])
        steps, whole = data[: lines * elements], iter(np.frombuffer(data[lines * elements :], "<u2").tolist())
        words = np.zeros((lines, elements), np.uint16)
        for line, element in itertools.product(range(lines), range(elements)):
            step = steps[line * elements + element]
            left = int(words[line, element - 1]) if element else 0
            words[line, element] = next(whole) if step == 128 else left + (step ^ 128) - 128
        return words

    @property
    def field(self) -> Any:
        """The colors that the browser shows."""
        return np.frombuffer(self.traits["entries"], np.uint8).reshape(1024, 3)[self.words]

    @property
    def undo_and_redo(self) -> tuple[int, int]:
        return self.traits["picture"]["undo"], self.traits["picture"]["redo"]


@pytest.fixture(autouse=True)
def comms(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("comm.create_comm", Browser)


def shown_in(studio: Studio) -> tuple[Any, Browser]:
    """A new widget of a studio, and the browser that shows it."""
    widget = studio.widget()
    return widget, widget.comm


def test_a_widget_shows_what_the_display_shows() -> None:
    studio, display = opened()
    _, browser = shown_in(studio)
    assert np.array_equal(browser.words, display.words)
    assert np.array_equal(browser.field, display.field())
    assert [each["name"] for each in browser.traits["picture"]["surfaces"]] == ["body", "glass", "wheels"]


def test_a_recoloring_sends_entries_and_no_words() -> None:
    studio, display = opened()
    _, browser = shown_in(studio)
    studio.recolor("body", object_color="#102030")
    assert browser.arrived == [{"picture", "entries"}]
    assert len(browser.traits["entries"]) == 3072
    assert np.array_equal(browser.field, display.field())


def test_an_edit_of_a_light_sends_words_and_no_entries() -> None:
    studio, display = opened()
    _, browser = shown_in(studio)
    studio.light("key", intensity=0.2)
    assert browser.arrived == [{"picture", "words"}]
    assert np.array_equal(browser.field, display.field())


def test_an_edit_that_shows_nothing_new_sends_neither() -> None:
    studio, _ = opened()
    _, browser = shown_in(studio)
    studio.save_view("front")
    assert browser.arrived == [{"picture"}]
    studio.save_view("front")
    assert browser.arrived == [{"picture"}]


def test_a_legend_is_in_the_words() -> None:
    display = Ramtek9300(Configuration(name="medium", elements=320, lines=300, planes=10))
    studio = Studio(car(), display)
    _, browser = shown_in(studio)
    without = browser.words
    studio.scalar(name="z", legend=True)
    assert np.array_equal(browser.words, display.words)
    assert not np.array_equal(browser.words, without)
    assert browser.traits["picture"]["legend"] is None


@pytest.mark.parametrize(
    "configuration",
    [
        PRINCETON_9300,
        dataclasses.replace(SMALL, lines=60, elements=80, visible_lines=30, visible_elements=40),
        dataclasses.replace(SMALL, planes=12, entries=4096),
        dataclasses.replace(SMALL, timing=Timing()),
    ],
    ids=["short entries", "a part is visible", "more words and entries", "time passes"],
)
def test_displays_of_all_kinds_are_shown(configuration: Configuration) -> None:
    display = Ramtek9300(configuration)
    studio = Studio(car(), display)
    _, browser = shown_in(studio)
    studio.recolor("body", object_color="#123456")
    lines, elements = configuration.shown_lines, configuration.shown_elements
    assert np.array_equal(browser.words, display.words[:lines, :elements])
    assert browser.traits["entries"] == display.entries[:1024].tobytes()


messages = st.one_of(
    st.builds(
        lambda color, same: {"edit": {OBJECT_COLOR: f"#{bytes(color).hex()}"}, "same_step": same},
        colors(),
        st.booleans(),
    ),
    st.builds(
        lambda value, same: {"edit": {"lights.key.intensity": value}, "same_step": same},
        st.sampled_from([0.0, 0.5, 1.0]),
        st.booleans(),
    ),
    st.builds(lambda on: {"edit": {"lights.fill.on": on}, "same_step": False}, st.booleans()),
    st.builds(lambda name, steps: {name: steps}, st.sampled_from(["undo", "redo"]), st.integers(0, 3)),
)


@LOCAL
@given(st.lists(messages, max_size=8))
def test_after_any_messages_all_browsers_show_the_display_of_the_studio(said: list[Any]) -> None:
    studio, display = opened()
    browsers = [shown_in(studio)[1], shown_in(studio)[1]]
    for number, message in enumerate(said):
        browsers[number % 2].say(message)
        for browser in browsers:
            assert np.array_equal(browser.field, display.field())
            assert browser.undo_and_redo == (len(studio.history.to_undo), len(studio.history.to_redo))


def test_an_edit_in_the_browser_is_an_edit_of_the_studio() -> None:
    studio, _ = opened()
    _, browser = shown_in(studio)
    before = studio.scene
    edit = {OBJECT_COLOR: "#102030", "surfaces.glass.blend": 0.25, "lights.fill.on": False}
    assert browser.say({"edit": edit, "same_step": False}) == ""
    assert studio.scene.equals(scene_with(before, edit))
    assert browser.say({"undo": 1}) == ""
    assert studio.scene is before
    assert browser.say({"redo": 1}) == ""
    assert browser.undo_and_redo == (1, 0)


def test_a_drag_in_the_browser_is_one_step() -> None:
    studio, _ = opened()
    _, browser = shown_in(studio)
    studio.recolor("glass", blend=0.1)
    for number, color in enumerate(["#100000", "#200000", "#300000"]):
        assert browser.say({"edit": {OBJECT_COLOR: color}, "same_step": number > 0}) == ""
    assert browser.undo_and_redo == (2, 0)


@pytest.mark.parametrize("meanwhile", ["recolor", "undo", "nothing"])
def test_a_drag_never_joins_a_step_that_is_not_its_own(meanwhile: str) -> None:
    studio, _ = opened()
    _, browser = shown_in(studio)
    studio.recolor("glass", blend=0.1)
    begun = f"#{bytes(studio.scene.surface('body').paint.object_color).hex()}"
    browser.say({"edit": {OBJECT_COLOR: begun if meanwhile == "nothing" else "#100000"}, "same_step": False})
    if meanwhile == "recolor":
        studio.recolor("glass", blend=0.9)
    elif meanwhile == "undo":
        studio.undo()
    before = studio.scene
    browser.say({"edit": {OBJECT_COLOR: "#200000"}, "same_step": True})
    assert studio.history.to_undo[-1] is before


BAD = [
    ({"edit": {"surfaces.body.object_colour": "#102030"}}, "did you mean 'object_color'?"),
    ({"edit": {"surfaces.hood.object_color": "#102030"}}, "there is no surface 'hood'"),
    ({"edit": {OBJECT_COLOR: "#10"}}, "object_color"),
    ({"edit": {OBJECT_COLOR: "#102030", "surfaces.glass.blend": 7}}, "blend"),
    ({"edit": {"surfaces.body.levels": 1000, "surfaces.glass.levels": 1000}}, "levels of all surfaces"),
    ({"edit": {"lights.key.intensity": float("nan")}}, "intensity"),
    ({"edit": {3: 4}}, "an edit, undo or redo"),
    ({"edit": "#102030"}, "an edit, undo or redo"),
    ({"undo": 9}, "there is 1 step to undo, not 9"),
    ({"undo": 0}, "there is 1 step to undo, not 0"),
    ({"undo": True}, "there is 1 step to undo, not true"),
    ({"redo": 1}, "there are 0 steps to redo, not 1"),
    ({"redo": "all"}, "there are 0 steps to redo, not 'all'"),
    ("undo", "an edit, undo or redo"),
    ({}, "an edit, undo or redo"),
    (None, "an edit, undo or redo"),
]


@pytest.mark.parametrize(("message", "sentence"), BAD)
def test_a_message_that_cannot_be_done_is_answered_and_changes_nothing(
    message: object, sentence: str
) -> None:
    studio, display = opened()
    studio.recolor("body", blend=0.3)
    _, browser = shown_in(studio)
    before, field = studio.scene, display.field()
    assert sentence in browser.say(message)
    assert studio.scene is before
    assert np.array_equal(display.field(), field)
    assert browser.arrived == []
    assert browser.say({"undo": 1}) == ""


@LOCAL
@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
        lambda inner: (
            st.lists(inner) | st.dictionaries(st.sampled_from(["edit", "undo", OBJECT_COLOR]), inner)
        ),
        max_leaves=6,
    )
)
def test_any_message_is_answered(message: object) -> None:
    studio, display = opened()
    _, browser = shown_in(studio)
    browser.say(message)
    assert np.array_equal(browser.field, display.field())


def test_a_fault_of_the_studio_is_answered_and_goes_to_the_log(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    studio, _ = opened()
    _, browser = shown_in(studio)
    monkeypatch.setattr(Studio, "undo", lambda *_: 1 // 0)
    studio.recolor("body", blend=0.3)
    assert browser.say({"undo": 1}) == notebook.FAILED
    assert "ZeroDivisionError" in caplog.text


def test_a_studio_whose_display_is_lost_answers_and_keeps_its_scene() -> None:
    class Lost(Ramtek9300):
        is_lost = False

        def send(self, words: Words) -> None:
            if self.is_lost:
                raise PortError("the display left")
            super().send(words)

    display = Lost(SMALL)
    studio = Studio(car(), display)
    _, browser = shown_in(studio)
    before, field = studio.scene, browser.field
    display.is_lost = True
    assert browser.say({"edit": {OBJECT_COLOR: "#102030"}}) == "the display left"
    assert studio.scene is before
    assert np.array_equal(browser.field, field)


def test_every_step_of_the_studio_shows_in_all_widgets() -> None:
    studio, display = opened()
    browsers = [shown_in(studio)[1] for _ in range(3)]

    def check() -> None:
        for browser in browsers:
            assert np.array_equal(browser.field, display.field())
            assert browser.undo_and_redo == (len(studio.history.to_undo), len(studio.history.to_redo))

    studio.keep_variant("A")
    studio.recolor("body", object_color="#102030")
    check()
    studio.undo()
    check()
    studio.redo()
    check()
    studio.show_variant("A")
    check()
    studio.remove_light("fill")
    check()
    studio.edit(studio.scene.with_view(angle=20), moving=True)
    studio.refine()
    check()
    studio.undo(3)
    check()
    studio.normals()
    studio.light("key", intensity=0.1)
    check()
    studio.send_everything()
    check()
    assert browsers[0].undo_and_redo == (3, 0)


def test_a_scene_that_the_studio_opens_shows_in_the_widget(tmp_path: Any) -> None:
    studio, display = opened()
    _, browser = shown_in(studio)
    other = Studio(
        car().with_surface("body", object_color="#123456").replace(name="other"), Ramtek9300(SMALL)
    )
    other.save(tmp_path / "other.npz")
    studio.open(tmp_path / "other.npz")
    assert browser.traits["picture"]["name"] == "other"
    assert np.array_equal(browser.field, display.field())


def test_a_closed_widget_hears_nothing_and_the_last_takes_its_display_along() -> None:
    studio, display = opened()
    widgets = [shown_in(studio)[0] for _ in range(2)]
    browsers = [widget.comm for widget in widgets]
    widgets[0].close()
    studio.recolor("body", blend=0.3)
    assert [browser.arrived for browser in browsers] == [[], [{"picture", "entries"}]]
    port = studio._widgets
    assert port is not None
    assert port._copy is not None
    widgets[1].close()
    assert port._copy is None
    studio.light("key", intensity=0.3)
    _, browser = shown_in(studio)
    assert np.array_equal(browser.field, display.field())


def test_a_widget_that_is_gone_does_not_stop_the_studio(caplog: pytest.LogCaptureFixture) -> None:
    studio, display = opened()
    lost, other = shown_in(studio)[1], shown_in(studio)[1]
    lost.is_lost = True
    studio.recolor("body", object_color="#102030")
    studio.light("key", intensity=0.3)
    assert np.array_equal(other.field, display.field())
    assert caplog.text.count("a widget could not be refreshed") == 1


def test_the_display_of_the_studio_gets_the_words_that_it_gets_without_a_widget() -> None:
    displays = []
    for has_widget in (False, True):
        studio, display = opened()
        if has_widget:
            shown_in(studio)
        studio.recolor("body", blend=0.3)
        studio.light("key", intensity=0.3)
        studio.undo()
        displays.append(display)
    assert displays[0].words_received == displays[1].words_received
    assert np.array_equal(displays[0].field(), displays[1].field())


def test_a_saved_notebook_has_the_picture() -> None:
    studio, _ = opened()
    widget, _ = shown_in(studio)
    studio.recolor("body", object_color="#102030")
    data, _ = widget._repr_mimebundle_()
    assert base64.b64decode(data["image/png"]) == studio._repr_png_()
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == widget.model_id


def test_a_studio_with_widgets_is_not_copied() -> None:
    studio, _ = opened()
    shown_in(studio)
    for copied in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="a studio cannot be pickled or copied"):
            copied(studio)


def test_a_widget_without_anywidget_is_refused_with_the_extra_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    studio, _ = opened()
    notebook.widget_class.cache_clear()
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(UnavailableError, match=r'pip install "\.\[notebook\]"'):
        studio.widget()
    studio.recolor("body", blend=0.3)


def test_replies_of_the_display_reach_the_studio() -> None:
    studio, _ = opened()
    shown_in(studio)
    port = studio._port
    port.send(instructions.read_cursor(0))
    assert len(port.receive(2)) == 2
