"""Pointing at the light and view screen: scenes, and a hand on the unit of a display that shows it."""

from __future__ import annotations

from autocolor import Light, Scene, Surface, View, scene_of
from autocolor.checks import Vector
from autocolor.screens.light_and_view.light_and_view_screen import LightAndViewScreen
from autocolor.screens.light_and_view.marks import MovablePoint, points_in
from autocolor.screens.light_and_view.orthographic_views import OrthographicViews, fitted_views, shown_points
from autocolor.screens.screen import Handle
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.small import boxes

KEY = Light("key", (2.0, -3.0, 4.0), aim=(0.5, 0.5, 0.5), concentration=2.0)
FILL = Light("fill", (-3.0, -3.0, 1.0), intensity=0.5)
VIEWS = OrthographicViews((0.0, 0.0, 0.0), 10.0)


def boxed(*lights: Light) -> Scene:
    """A cube of two surfaces under some lights."""
    surfaces = [Surface("low"), Surface("high")]
    view = View((-2.0, -3.0, 2.0), target=(0.5, 0.5, 0.5))
    return scene_of(boxes().mesh, surfaces=surfaces, lights=list(lights), view=view, name="box")


def opened(scene: Scene, shows_all: bool = True) -> Hand:
    """A hand on a display that shows the light and view screen of a scene, or its object alone."""
    viewer = Viewer(scene, Ramtek9300())
    viewer.session.turn_to("light and view")
    viewer.tell("")
    hand = Hand(viewer)
    if shows_all:
        screen_of(hand).views = fitted_views(shown_points(scene))
        viewer.tell("")
    while viewer.board.content.idle():
        pass
    viewer.tell("")
    return hand


def screen_of(hand: Hand) -> LightAndViewScreen:
    """The light and view screen that is shown."""
    screen = hand.viewer.board.screen
    assert isinstance(screen, LightAndViewScreen)
    return screen


def movable_of(handle: Handle) -> MovablePoint:
    """The point that a handle moves."""
    assert isinstance(handle.key, MovablePoint)
    return handle.key


def point_of(hand: Hand, movable: MovablePoint) -> Vector:
    """The coordinates of a movable point now."""
    screen = screen_of(hand)
    others, ours = points_in(hand.scene, screen.views, movable.side, screen.chosen)
    return next(each.point for each in (*others, *ours) if each.movable == movable)


def handle_of(hand: Hand, movable: MovablePoint) -> Handle:
    """The first handle of something."""
    return next(each for each in hand.viewer.board.content.handles if each.key == movable)


def place_of(hand: Hand, movable: MovablePoint) -> tuple[int, int]:
    """Where something can be taken hold of."""
    handle = handle_of(hand, movable)
    return handle.element, handle.line


def is_undone_at_once(hand: Hand, before: Scene) -> bool:
    """Whether one step of undo, or the view before, brings a scene back, and nothing else is before it."""
    studio = hand.viewer.studio
    took = studio.undo() != studio.view_back()
    return took and studio.scene.equals(before) and not studio.undo() and not studio.view_back()
