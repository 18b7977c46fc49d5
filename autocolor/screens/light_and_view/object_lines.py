"""The lines of the object on the light and view screen, each with its word; what is costly is kept.

The features and the silhouette are drawn without what is hidden. Of a stage, such as a floor, only the
outline is drawn.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part
from autocolor.screens.light_and_view.hidden_edges import VisibleDepths, depths_toward, without_hidden
from autocolor.screens.light_and_view.mesh_edges import MeshEdges, mesh_edges
from autocolor.screens.light_and_view.orthographic_views import OrthographicViews, Side
from autocolor.screens.light_and_view.perspective_strokes import perspective_strokes
from autocolor.screens.light_and_view.silhouettes import silhouette_from, silhouette_toward
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, LIGHT_GRAY
from autocolor.widgets.items import Item, segments
from autocolor.widgets.strokes import drawn


class _Kept(NamedTuple):
    """What was found for the parts of a mesh."""

    mesh: Mesh
    parts: tuple[Part, ...]
    edges: MeshEdges
    of_side: dict[str, tuple[Indices, Indices]]
    """The features and the silhouette that each view shows."""
    items: dict[tuple[str, OrthographicViews], tuple[Item, ...]]


class ObjectLines:
    """The lines of the object of a scene; they are found once for a mesh."""

    def __init__(self) -> None:
        self._kept: _Kept | None = None

    def of_side(self, scene: Scene, views: OrthographicViews, side: Side) -> tuple[Item, ...]:
        """The lines in one of the three views, features before the silhouette."""
        kept = self._of(scene)
        key = side.name, views
        if key not in kept.items:
            # The views before are not shown again.
            for other in [each for each in kept.items if each[1] != views]:
                del kept.items[other]
            features, silhouette = self._edges_of(kept, side)
            coordinates = scene.mesh.coordinates
            kept.items[key] = _items(
                views.strokes(side, coordinates, features),
                views.strokes(side, coordinates, silhouette),
                side.area,
            )
        return kept.items[key]

    def of_eye(self, scene: Scene, area: Area) -> tuple[Item, ...]:
        """The lines as the eye sees them, in an area of the shape of the picture."""
        edges = self._of(scene).edges
        coordinates, view = scene.mesh.coordinates, scene.view
        silhouette = silhouette_from(edges, view.eye)
        return _items(
            perspective_strokes(coordinates, edges.features, view, area),
            perspective_strokes(coordinates, silhouette, view, area),
            area,
        )

    def _of(self, scene: Scene) -> _Kept:
        kept = self._kept
        if kept is None or kept.mesh is not scene.mesh or kept.parts != scene.parts:
            edges = mesh_edges(scene.mesh, object_parts(scene))
            kept = self._kept = _Kept(scene.mesh, scene.parts, edges, {}, {})
        return kept

    def _edges_of(self, kept: _Kept, side: Side) -> tuple[Indices, Indices]:
        if side.name not in kept.of_side:
            edges, coordinates = kept.edges, kept.mesh.coordinates
            silhouette = silhouette_toward(edges, side.toward)
            numbers = [n for n in kept.mesh.parts_in_use if not kept.parts[n].stage]
            depths: VisibleDepths | None = depths_toward(kept.mesh, side, numbers)
            if depths is None:
                kept.of_side[side.name] = edges.features, silhouette
            else:
                kept.of_side[side.name] = (
                    without_hidden(edges.features, coordinates, depths),
                    without_hidden(silhouette, coordinates, depths),
                )
        return kept.of_side[side.name]


def _items(features: Floats, silhouette: Floats, area: Area) -> tuple[Item, ...]:
    return (
        segments(drawn(features).astype(np.float64), GRAY, area),
        segments(drawn(silhouette).astype(np.float64), LIGHT_GRAY, area),
    )


def object_parts(scene: Scene) -> list[int]:
    """The numbers of the parts in use that are not stage; all, if there are no others."""
    used = list(scene.mesh.parts_in_use)
    return [number for number in used if not scene.parts[number].stage] or used
