"""The lines of the object in the views of the light and view screen; what is costly is kept.

The edges are drawn at once, and those that are hidden left out later, when there is time: that takes longer
than a page should. Of a stage, such as a floor, the features alone are drawn.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part
from autocolor.screens.light_and_view.hidden_edges import VisibleDepths, depths_toward, without_hidden
from autocolor.screens.light_and_view.kept import Kept
from autocolor.screens.light_and_view.mesh_edges import MeshEdges, mesh_edges
from autocolor.screens.light_and_view.orthographic_views import SIDES, OrthographicViews, Side
from autocolor.screens.light_and_view.perspective_strokes import perspective_strokes
from autocolor.screens.light_and_view.silhouettes import silhouette_from, silhouette_toward
from autocolor.widgets.areas import Area
from autocolor.widgets.strokes import drawn


class ObjectStrokes(NamedTuple):
    """The strokes of an object in a view from pixel to pixel, each (n, 4).

    They are those of the features of its stage, of its own features, and of its silhouette.
    """

    stage: Floats
    features: Floats
    silhouette: Floats


class _Found(NamedTuple):
    """The edges of a mesh with its parts; of each view, by its name, the features and the silhouette."""

    mesh: Mesh
    parts: tuple[Part, ...]
    object_numbers: list[int]
    edges: MeshEdges
    stage: Indices
    of_side: dict[str, tuple[Indices, Indices]]
    is_without_hidden: set[str]


class ObjectLines:
    """The lines of the object of a scene; they are found once for a mesh."""

    def __init__(self) -> None:
        self._found: _Found | None = None
        self._strokes: dict[str, Kept[ObjectStrokes]] = {side.name: Kept() for side in SIDES}

    def of_side(self, scene: Scene, views: OrthographicViews, side: Side) -> ObjectStrokes:
        """The lines in one of the three views, the same as before if nothing changed."""
        found, coordinates = self._of(scene), scene.mesh.coordinates
        edges = found.of_side[side.name]

        def strokes() -> ObjectStrokes:
            return _drawn(*(views.strokes(side, coordinates, each) for each in (found.stage, *edges)))

        return self._strokes[side.name].of(strokes, edges, views)

    def leave_out_hidden(self, scene: Scene) -> bool:
        """Leave out what is hidden in one view where that was not done; returns False if there is none."""
        found = self._of(scene)
        left = [side for side in SIDES if side.name not in found.is_without_hidden]
        if not left:
            return False
        side, coordinates = left[0], scene.mesh.coordinates
        found.is_without_hidden.add(side.name)
        depths = depths_toward(scene.mesh, side, found.object_numbers)
        if depths is not None:
            features, silhouette = found.of_side[side.name]
            found.of_side[side.name] = (
                without_hidden(features, coordinates, depths),
                without_hidden(silhouette, coordinates, depths),
            )
        return True

    def of_eye(self, scene: Scene, area: Area, visible: VisibleDepths | None = None) -> ObjectStrokes:
        """The lines as the eye sees them, in an area of the shape of the picture.

        With the depths of what is visible in the picture, those that are hidden are left out.
        """
        found = self._of(scene)
        coordinates, view = scene.mesh.coordinates, scene.view
        edges = [found.stage, found.edges.features, silhouette_from(found.edges, view.eye)]
        if visible is not None:
            edges = [without_hidden(each, coordinates, visible) for each in edges]
        return _drawn(*(perspective_strokes(coordinates, each, view, area) for each in edges))

    def _of(self, scene: Scene) -> _Found:
        found = self._found
        if found is None or found.mesh is not scene.mesh or found.parts != scene.parts:
            used = list(scene.mesh.parts_in_use)
            numbers = [number for number in used if not scene.parts[number].stage] or used
            stage = [number for number in used if number not in numbers]
            edges = mesh_edges(scene.mesh, numbers)
            outline = mesh_edges(scene.mesh, stage).features if stage else np.empty((0, 2), np.intp)
            of_side = {side.name: (edges.features, silhouette_toward(edges, side.toward)) for side in SIDES}
            found = _Found(scene.mesh, scene.parts, numbers, edges, outline, of_side, set())
            self._found = found
        return found


def _drawn(*strokes: Floats) -> ObjectStrokes:
    return ObjectStrokes(*(drawn(each).astype(np.float64) for each in strokes))
