"""Widgets of a studio: what travels to the browser, what its messages do, and both in a real browser."""

from __future__ import annotations

import base64
import copy
import dataclasses
import itertools
import pickle
import re
import sys
from collections.abc import Callable, Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autocolor import Scene, Studio, Surface, UnavailableError, render, scene_of
from autocolor.arrays import AnyArray, Words
from autocolor.files.settings import scene_with
from autocolor.images import display_image
from autocolor.sending import shown_colors
from autocolor.testing import colors
from autocolor.web import notebook
from ramtek_emu import Configuration, PortError, Ramtek9300
from tests.autocolor.web.twin import unpacked_words
from tests.small import SMALL, boxes, car, cube, opened

pytestmark = pytest.mark.needs("anywidget")

OBJECT_COLOR = "surfaces.body.object_color"
NUMBERS = itertools.count()
LOCAL = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def text_of(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


class Cell:
    """The browser's side of a widget in a cell, as the stub of its comm: what arrived, and the answers."""

    def __init__(self, data: dict[str, Any], buffers: list[bytes], **_: object) -> None:
        self.comm_id = f"stub {next(NUMBERS)}"
        self.traits: dict[str, Any] = {}
        self.arrived: list[set[str]] = []
        """The names of the traits in each update."""
        self.answers: list[str] = []
        self.news: list[dict[str, Any]] = []
        """Updates and answers for a real browser, as JSON."""
        self.is_lost = False
        self._take(data, buffers)
        self.arrived.clear()

    def send(self, data: dict[str, Any], buffers: list[bytes] | None = None) -> None:
        if self.is_lost:
            raise ConnectionError("the kernel is gone")
        if data["method"] == "custom":
            self.answers.append(data["content"]["answer"])
            self.news.append(data["content"])
        else:
            self._take(data, buffers or [])

    def _take(self, data: dict[str, Any], buffers: list[bytes]) -> None:
        binary = {path[0]: bytes(each) for path, each in zip(data["buffer_paths"], buffers, strict=True)}
        self.arrived.append({*data["state"], *binary})
        self.traits |= data["state"] | binary
        self.news.append({"state": data["state"], "binary": {name: text_of(binary[name]) for name in binary}})

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
    def words(self) -> AnyArray:
        """The words that the browser shows."""
        picture = self.traits["picture"]
        return unpacked_words(self.traits["words"], picture["lines"], picture["elements"])

    @property
    def field(self) -> Any:
        """The colors that the browser shows."""
        return np.frombuffer(self.traits["entries"], np.uint8).reshape(1024, 3)[self.words]

    @property
    def undo_and_redo(self) -> tuple[int, int]:
        return self.traits["picture"]["undo"], self.traits["picture"]["redo"]


@pytest.fixture(autouse=True)
def comms(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("comm.create_comm", Cell)


def seen(studio: Studio, scene: Scene | None = None, smooth: int = 2) -> AnyArray:
    """The colors that a widget of a studio shows, of its scene or another: those of four samples a pixel."""
    lines, elements = studio.words.shape
    scene = scene or studio.scene
    return shown_colors(display_image(scene, render(scene, (elements, lines), smooth=smooth)))


def shown_in(studio: Studio) -> tuple[Any, Cell]:
    """A new widget of a studio, and its cell."""
    widget = studio.widget()
    return widget, widget.comm


@pytest.mark.parametrize(
    ("edit", "arrives"),
    [
        (lambda studio: studio.recolor("body", object_color="#102030"), [{"picture", "entries"}]),
        (lambda studio: studio.light("key", intensity=0.2), [{"picture", "words"}]),
        (lambda studio: studio.save_view("front"), [{"picture"}]),
        (lambda studio: studio.recolor("body"), []),
    ],
    ids=["entries", "words", "neither", "nothing"],
)
def test_an_edit_sends_what_it_changes(edit: Callable[[Studio], object], arrives: list[set[str]]) -> None:
    studio = opened()[0]
    _, cell = shown_in(studio)
    edit(studio)
    assert cell.arrived == arrives
    assert [each["name"] for each in cell.traits["picture"]["surfaces"]] == ["body", "glass", "wheels"]
    assert len(cell.traits["entries"]) == 3072
    assert np.array_equal(cell.field, seen(studio))


def test_the_lights_are_sent_without_planes_and_their_exposure_is_told() -> None:
    studio, _ = opened()
    _, cell = shown_in(studio)
    lights = cell.traits["picture"]["lights"]
    assert [(row["name"], row["on"], row["intensity"]) for row in lights["rows"]] == [
        ("key", True, 1.0),
        ("fill", True, 0.4),
    ]
    assert lights["held"] == notebook.FOLLOWING
    studio.hold_exposure()
    assert cell.traits["picture"]["lights"]["held"] == notebook.HELD


def test_a_legend_is_that_of_the_display() -> None:
    display = Ramtek9300(Configuration(name="medium", elements=320, lines=300, planes=10))
    studio = Studio(car(), display)
    _, cell = shown_in(studio)
    assert cell.traits["picture"]["legend"] is None
    studio.scalar(name="z", legend=True)
    key: Any = cell.traits["picture"]["legend"]
    words = unpacked_words(base64.b64decode(key["words"]), key["lines"], key["elements"])[::2, ::2]
    line, element = key["line"] // 2, key["element"] // 2
    assert np.array_equal(words, display.words[line:, element:][: words.shape[0], : words.shape[1]])


@pytest.mark.parametrize(
    ("configuration", "smooth"),
    [
        (dataclasses.replace(SMALL, lines=60, elements=80, visible_lines=30, visible_elements=40), 2),
        (dataclasses.replace(SMALL, lines=1024, elements=1280), 1),
    ],
    ids=["a part is visible", "large"],
)
def test_displays_of_all_sizes_are_shown(configuration: Configuration, smooth: int) -> None:
    studio = Studio(car(), Ramtek9300(configuration))
    _, cell = shown_in(studio)
    assert cell.traits["picture"]["smooth"] == smooth
    assert np.array_equal(cell.field, seen(studio, smooth=smooth))


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
    st.builds(
        lambda blend, on: {"edit": {"surfaces.glass.blend": blend, "lights.key.on": on}},
        st.sampled_from([0.25, 0.75]),
        st.booleans(),
    ),
    st.builds(lambda on: {"edit": {"lights.fill.on": on}, "same_step": False}, st.booleans()),
    st.builds(lambda name, steps: {name: steps}, st.sampled_from(["undo", "redo"]), st.integers(0, 3)),
)


@LOCAL
@given(st.lists(messages, max_size=8))
def test_after_any_messages_all_browsers_show_the_display_of_the_studio(said: list[Any]) -> None:
    studio = opened()[0]
    cells = [shown_in(studio)[1], shown_in(studio)[1]]
    for number, message in enumerate(said):
        before = studio.scene
        cells[number % 2].say(message)
        if "edit" in message:
            assert studio.scene.equals(scene_with(before, message["edit"]))
        for cell in cells:
            assert np.array_equal(cell.field, seen(studio))
            assert cell.undo_and_redo == (len(studio.history.to_undo), len(studio.history.to_redo))


@pytest.mark.parametrize("meanwhile", ["recolor", "undo", "nothing", "a drag"])
def test_a_drag_is_one_step_and_never_joins_a_step_that_is_not_its_own(meanwhile: str) -> None:
    studio, _ = opened()
    _, cell = shown_in(studio)
    cell.say({"edit": {"surfaces.glass.blend": 0.1}, "same_step": False})
    begun = f"#{bytes(studio.scene.surfaces['body'].paint.object_color).hex()}"
    cell.say({"edit": {OBJECT_COLOR: begun if meanwhile == "nothing" else "#100000"}, "same_step": False})
    if meanwhile == "recolor":
        studio.recolor("glass", blend=0.9)
    elif meanwhile == "undo":
        studio.undo()
    before = studio.scene
    cell.say({"edit": {OBJECT_COLOR: "#200000"}, "same_step": True})
    assert (studio.history.to_undo[-1] is before) == (meanwhile != "a drag")
    steps = {"recolor": 4, "undo": 2, "nothing": 2, "a drag": 2}
    assert cell.undo_and_redo == (steps[meanwhile], 0)


NO_MESSAGE = "an edit, undo or redo"
BAD = [
    ({"edit": {"surfaces.body.object_colour": "#102030"}}, ""),
    ({"edit": {OBJECT_COLOR: "#102030", "surfaces.glass.blend": 7}}, ""),
    ({"edit": {"lights.key.intensity": float("nan")}}, ""),
    ({"edit": {3: 4}}, NO_MESSAGE),
    ({"edit": "#102030"}, NO_MESSAGE),
    ({"undo": 9}, "there is 1 step to undo, not 9"),
    ({"undo": 0}, "there is 1 step to undo, not 0"),
    ({"undo": True}, "there is 1 step to undo, not true"),
    ({"redo": 1}, "there are 0 steps to redo, not 1"),
    ({}, NO_MESSAGE),
    (None, NO_MESSAGE),
]


@pytest.mark.parametrize(("message", "sentence"), BAD)
def test_a_message_that_cannot_be_done_is_answered_and_changes_nothing(
    message: object, sentence: str
) -> None:
    studio, display = opened()
    studio.recolor("body", blend=0.3)
    _, cell = shown_in(studio)
    before, field = studio.scene, display.field()
    answer = cell.say(message)
    assert answer
    assert sentence in answer
    assert studio.scene is before
    assert np.array_equal(display.field(), field)
    assert cell.arrived == []
    assert cell.say({"undo": 1}) == ""


def test_a_fault_of_the_studio_is_answered_and_goes_to_the_log(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    studio, _ = opened()
    _, cell = shown_in(studio)
    monkeypatch.setattr(Studio, "undo", lambda *_: 1 // 0)
    studio.recolor("body", blend=0.3)
    assert cell.say({"undo": 1}) == notebook.FAILED
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
    _, cell = shown_in(studio)
    before, field = studio.scene, cell.field
    display.is_lost = True
    assert cell.say({"edit": {OBJECT_COLOR: "#102030"}}) == "the display left"
    assert studio.scene is before
    assert np.array_equal(cell.field, field)


def test_every_step_of_the_studio_shows_in_all_widgets(tmp_path: Path) -> None:
    studio = opened()[0]
    cells = [shown_in(studio)[1] for _ in range(2)]
    other = Studio(boxes(), Ramtek9300(SMALL))
    other.save(tmp_path / "other.npz")
    steps: list[Callable[[], object]] = [
        lambda: studio.keep_variant("A"),
        lambda: studio.recolor("body", object_color="#102030"),
        studio.undo,
        studio.redo,
        lambda: studio.show_variant("A"),
        lambda: studio.remove_light("fill"),
        lambda: studio.edit(studio.scene.with_view(angle=20), moving=True),
        studio.refine,
        lambda: studio.undo(3),
        studio.normals,
        lambda: studio.light("key", intensity=0.1),
        studio.send_everything,
        lambda: studio.open(tmp_path / "other.npz"),
    ]
    for step in steps:
        step()
        for cell in cells:
            assert np.array_equal(cell.field, seen(studio))
            assert cell.undo_and_redo == (len(studio.history.to_undo), len(studio.history.to_redo))
    assert cells[0].traits["picture"]["surfaces"][0]["name"] == "low"


def test_a_closed_widget_hears_nothing_and_a_new_one_shows_the_display() -> None:
    studio = opened()[0]
    widgets = [shown_in(studio)[0] for _ in range(2)]
    cells = [widget.comm for widget in widgets]
    widgets[0].close()
    studio.recolor("body", blend=0.3)
    assert [cell.arrived for cell in cells] == [[], [{"picture", "entries"}]]
    widgets[1].close()
    studio.light("key", intensity=0.3)
    _, cell = shown_in(studio)
    assert np.array_equal(cell.field, seen(studio))


def test_a_widget_that_is_gone_does_not_stop_the_studio(caplog: pytest.LogCaptureFixture) -> None:
    studio = opened()[0]
    lost, other = shown_in(studio)[1], shown_in(studio)[1]
    lost.is_lost = True
    studio.recolor("body", object_color="#102030")
    studio.light("key", intensity=0.3)
    assert np.array_equal(other.field, seen(studio))
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


def test_a_studio_is_not_copied() -> None:
    for copied in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="a studio cannot be pickled or copied"):
            copied(opened()[0])


def test_a_widget_without_anywidget_is_refused_with_its_command(monkeypatch: pytest.MonkeyPatch) -> None:
    studio, _ = opened()
    notebook.widget_class.cache_clear()
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(UnavailableError, match=r"run: pip install anywidget$"):
        studio.widget()
    studio.recolor("body", blend=0.3)


def test_the_cells_of_the_guide_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    guide = (Path(__file__).parents[3] / "docs" / "guides" / "notebook.md").read_text("utf-8")
    variables: dict[str, Any] = {}
    for cell in re.findall("^```python\n(.*?)^```", guide, re.DOTALL | re.MULTILINE):
        exec(cell, variables)
    assert variables["other"].comm is None
    assert (tmp_path / "blue.npz").is_file()


IN_A_BROWSER = pytest.mark.needs("playwright")

# The model of a widget, as anywidget gives it to a module.
RENDER = """async ([source, news]) => {
    const {default: module} = await import(`data:text/javascript;base64,${source}`);
    const listeners = [], traits = {};
    const tell = (event, value) => listeners.forEach(([name, heard]) => name === event && heard(value));
    const view = text => new DataView(Uint8Array.from(atob(text), letter => letter.charCodeAt(0)).buffer);
    window.sent = [];
    window.receive = ({answer, state, binary}) => {
        if (answer !== undefined) return tell("msg:custom", {answer});
        const names = [...Object.keys(state), ...Object.keys(binary)];
        Object.assign(traits, state);
        for (const name in binary) traits[name] = view(binary[name]);
        names.forEach(name => tell(`change:${name}`, traits[name]));
    };
    window.model = {
        get: name => traits[name],
        on: (event, heard) => listeners.push([event, heard]),
        off: (event, heard) => listeners.splice(listeners.findIndex(each => each[1] === heard), 1),
        send: message => sent.push(structuredClone(message)),
    };
    news.forEach(receive);
    window.end = await module.render({model, el: document.getElementById("cell")});
    window.listening = () => listeners.length;
}"""
SHOWS = """colors => {
    const canvas = document.querySelector(".glass canvas");
    const {width, height} = canvas;
    const copy = new OffscreenCanvas(width, height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const shown = copy.getImageData(0, 0, width, height).data.filter((_, at) => at % 4 < 3);
    return btoa(String.fromCharCode(...shown)) === colors;
}"""


class Window:
    """A widget that the module shows in a real browser, and the carrier of the messages between them."""

    def __init__(self, browser: Any, cell: Cell, studio: Studio) -> None:
        self.page = browser.new_page()
        self.page.set_default_timeout(10_000)
        self.faults: list[str] = []
        self.page.on("console", lambda message: self.faults.append(message.text))
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.set_content('<div id="cell"></div>')
        self.cell = cell
        self.studio = studio
        source = (files("autocolor.web") / "autocolor.js").read_bytes()
        self.page.evaluate(RENDER, [text_of(source), cell.news])
        cell.news.clear()

    def carry(self) -> tuple[int, int]:
        """Carry messages to the studio, and its updates and answers back; returns how many of both."""
        messages = self.page.evaluate("sent.splice(0)")
        for message in messages:
            self.cell.say(message)
        news = self.cell.news.copy()
        self.cell.news.clear()
        self.page.evaluate("news => news.forEach(receive)", news)
        return len(messages), len(news)

    def check(self) -> None:
        """Carry all messages, and wait until the canvas has the colors of the studio."""
        while any(self.carry()):
            pass
        self.page.wait_for_function(SHOWS, arg=text_of(seen(self.studio).tobytes()))
        assert self.faults == []

    def wait_for_status(self, text: str) -> None:
        self.page.get_by_role("status").filter(has_text=text).wait_for()


@pytest.fixture
def window(browser: Any) -> Iterator[Callable[[Cell, Studio], Window]]:
    windows: list[Window] = []

    def open_window(cell: Cell, studio: Studio) -> Window:
        windows.append(Window(browser, cell, studio))
        return windows[-1]

    yield open_window
    for each in windows:
        each.page.close()


@IN_A_BROWSER
def test_a_browser_shows_every_step_and_its_edits_are_steps_of_the_studio(window: Any) -> None:
    studio = opened()[0]
    cell = shown_in(studio)[1]
    other = shown_in(studio)[1]
    shown = window(cell, studio)
    page = shown.page
    shown.check()
    # A color that is typed in the browser, where a notebook takes Enter for itself.
    page.evaluate("() => {document.onkeydown = press => press.key !== 'Enter'}")
    field = page.get_by_role("textbox", name="#rrggbb")
    field.fill("#204080")
    field.press("Enter")
    shown.check()
    assert studio.scene.surfaces["body"].paint.object_color == (0x20, 0x40, 0x80)
    assert cell.arrived == [{"picture", "entries"}]
    # An edit in Python, and another in the browser by a key.
    studio.recolor("glass", object_color="#ff0000")
    shown.check()
    page.get_by_role("slider", name="Strength of light key").press("Home")
    shown.check()
    assert studio.scene.lights["key"].intensity == 0
    assert cell.arrived[-1] == {"picture", "words"}
    shown.wait_for_status("bytes of words")
    page.get_by_role("switch", name="fill").press("Space")
    shown.check()
    assert not studio.scene.lights["fill"].on
    # Undo and redo, in the browser and in Python.
    for name in ("Undo", "Undo", "Undo", "Undo", "Redo"):
        page.get_by_role("button", name=name, disabled=False).click()
        shown.check()
        shown.wait_for_status(f"{name}ne.")
    assert cell.undo_and_redo == (1, 3)
    studio.undo()
    shown.check()
    page.get_by_role("button", name="Undo", disabled=True).wait_for()
    assert np.array_equal(other.field, seen(studio))


@IN_A_BROWSER
def test_a_drag_in_a_browser_sends_as_fast_as_the_studio_answers_and_is_one_step(window: Any) -> None:
    studio = opened()[0]
    cell = shown_in(studio)[1]
    shown = window(cell, studio)
    red = shown.page.get_by_role("slider", name="Red")
    red.evaluate(
        """bar => {
            const tell = name => bar.dispatchEvent(new Event(name, {bubbles: true}));
            for (bar.value = 60; bar.value < 89; bar.value++) tell("input");
            tell("input");
            tell("change");
        }"""
    )
    red.focus()
    assert red.get_attribute("data-lm-suppress-shortcuts") == "true"
    # The first edit is answered, while the browser already shows the last.
    assert shown.carry() == (1, 2)
    assert studio.scene.surfaces["body"].paint.object_color[0] == 60
    red.dispatch_event("change", {"bubbles": True})
    assert red.input_value() == "89"
    # One edit stands for all that came before the answer.
    assert shown.carry() == (1, 2)
    assert shown.carry() == (0, 0)
    assert studio.scene.surfaces["body"].paint.object_color[0] == 89
    assert len(studio.history.to_undo) == 1
    shown.check()


def drag(bar: Any, value: float) -> None:
    """Drag the handle of a bar to a value, and hold it there."""
    bar.evaluate(
        "(bar, value) => {bar.value = value; bar.dispatchEvent(new Event('input', {bubbles: true}))}", value
    )


@IN_A_BROWSER
@pytest.mark.parametrize("has_normals", [False, True])
def test_a_browser_shows_light_during_the_drag_and_keeps_the_paint_that_is_ahead(
    has_normals: bool, window: Any
) -> None:
    studio = opened(car().replace(contrast="floor"))[0]
    studio.normals(has_normals)
    shown = window(shown_in(studio)[1], studio)
    drag(shown.page.get_by_role("slider", name="Strength of light key"), 0.1)
    shown.check()
    if not has_normals:
        red = shown.page.get_by_role("slider", name="Red")
        drag(red, 90)
        studio.recolor("glass", object_color="#ff0000")
        shown.page.evaluate("news => news.forEach(receive)", shown.cell.news)
        assert red.input_value() == "90"
        ahead = seen(studio, studio.scene.with_paint("body", object_color=(90, 176, 176)))
        shown.page.wait_for_function(SHOWS, arg=text_of(ahead.tobytes()))
        shown.check()


@IN_A_BROWSER
def test_an_edit_that_the_studio_refuses_is_told_in_the_browser_and_taken_back(
    window: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    studio = opened()[0]
    shown = window(shown_in(studio)[1], studio)
    with monkeypatch.context() as patch:
        patch.setattr(studio, "edit", lambda *_: studio.take_view("nowhere"))
        shown.page.get_by_role("slider", name="Blend").press("Home")
        shown.check()
    shown.wait_for_status("nowhere")
    assert studio.history.to_undo == ()
    shown.page.get_by_role("slider", name="Blend").press("Home")
    shown.check()
    assert studio.scene.surfaces["body"].paint.blend == 0


@IN_A_BROWSER
def test_a_browser_says_when_the_studio_is_busy_and_when_it_has_answered(window: Any) -> None:
    studio = opened()[0]
    shown = window(shown_in(studio)[1], studio)
    shown.page.clock.install()
    shown.page.get_by_role("slider", name="Blend").press("Home")
    shown.page.clock.run_for(5000)
    shown.wait_for_status("has not answered yet")
    shown.carry()
    shown.wait_for_status("has answered")


@IN_A_BROWSER
def test_a_browser_shows_another_scene_of_the_studio_and_stops_when_it_is_left(window: Any) -> None:
    studio = opened()[0]
    shown = window(shown_in(studio)[1], studio)
    studio.edit(scene_of(cube(1.2), surface_of_part={"cube": "wood"}, surfaces=[Surface("wood")]))
    shown.check()
    shown.page.get_by_role("radio", name="wood").wait_for(state="attached")
    shown.page.evaluate("end()")
    assert shown.page.evaluate("listening()") == 0
    assert shown.page.locator("#cell > *").count() == 0
