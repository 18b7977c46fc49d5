"""matplotlib: polygons in one flat color each, painted from far to near.

It can do no better than one intensity a polygon, computed here at its middle, sorts whole polygons by their
mean depth, and has no near plane, so that polygons must be cut for it. Its pictures are not the same; its
times say how long one waits there for a picture of the same mesh.
"""

from __future__ import annotations

import math

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from autocolor import Scene, View
from benchmarks.comparison import ELEMENTS, LINES, Field
from benchmarks.points import ALL_LIGHTS, FRAME, ONE_LIGHT, RECOLOR

DOTS = 100
NEAR = 0.25
"""Where polygons are cut, as a fraction of the way from the eye to its target: nothing is seen so near."""

Floats = npt.NDArray[np.float64]


class MatplotlibPeer:
    """A figure of the size of the picture with one collection of polygons in it."""

    is_slow = True

    def __init__(self, scene: Scene) -> None:
        self.description = (
            f"{matplotlib.__version__}, Agg, Poly3DCollection, flat polygons by painter's order"
        )
        self.edits = {
            FRAME: self._move_eye,
            ONE_LIGHT: self._shade,
            ALL_LIGHTS: self._shade,
            RECOLOR: self._recolor,
        }
        figure = Figure(figsize=(ELEMENTS / DOTS, LINES / DOTS), dpi=DOTS)
        figure.patch.set_facecolor([component / 255 for component in scene.background])
        self._canvas = FigureCanvasAgg(figure)
        self._axes = figure.add_axes((0, 0, 1, 1), projection="3d")
        self._axes.set_axis_off()
        self._axes.patch.set_visible(False)
        self._middles, self._normals, self._surface = flat_polygons(scene)
        self._polygons = Poly3DCollection(
            cut_polygons(scene), antialiaseds=False, linewidths=0, clip_on=False
        )
        self._axes.add_collection3d(self._polygons, autolim=False)
        self._move_eye(scene)

    def field(self) -> Field:
        """The pixels of the canvas."""
        return np.asarray(self._canvas.buffer_rgba())[..., :3].copy()

    def _move_eye(self, scene: Scene) -> None:
        self._place_eye(scene.view)
        self._shade(scene)

    def _shade(self, scene: Scene) -> None:
        self._intensities = flat_intensities(scene, self._middles, self._normals, self._surface)
        self._recolor(scene)

    def _recolor(self, scene: Scene) -> None:
        colors = np.array([surface.paint.object_color for surface in scene.surfaces]) / 255
        shown = np.clip(colors[self._surface] * self._intensities[:, None], 0, 1)
        self._polygons.set_facecolor(shown)
        self._canvas.draw()

    def _place_eye(self, view: View) -> None:
        """Give the axes the view; their eye looks at the middle of their limits, from as far as they like."""
        axes, forward = self._axes, view.axes[2]
        half = math.tan(math.radians(view.field_of_view) / 2)
        axes.set_box_aspect((1, 1, 1))
        axes.set_proj_type("persp", focal_length=1)
        axes.viewLim.intervalx = axes.viewLim.intervaly = (-half, half)
        axes.view_init(
            elev=math.degrees(math.asin(-forward[2])), azim=math.degrees(math.atan2(-forward[1], -forward[0]))
        )
        # Measure how far with limits of 1 around the eye, then scale these and put the aim in their middle.
        self._limit(np.array(view.eye), 1.0)
        depth = axes.get_proj()[3]
        distance = float(depth @ np.append(view.eye, 1) / (depth[:3] @ forward))
        self._limit(np.array(view.eye) + _reach(view) * forward, _reach(view) / distance)

    def _limit(self, middle: Floats, reach: float) -> None:
        for set_limits, at in zip(
            (self._axes.set_xlim, self._axes.set_ylim, self._axes.set_zlim), middle.tolist(), strict=True
        ):
            set_limits(at - reach, at + reach)


def _reach(view: View) -> float:
    """How far the eye is from what it looks at."""
    return math.dist(view.eye, view.target) if view.target is not None else 1.0


def cut_polygons(scene: Scene) -> list[Floats]:
    """The corners of the polygons, without what lies behind the eye."""
    view, corners = scene.view, scene.mesh.coordinates[scene.mesh.node_numbers]
    depths = (corners - np.array(view.eye)) @ view.axes[2] - NEAR * _reach(view)
    polygons = list(corners)
    for number in np.flatnonzero((depths < 0).any(axis=1)).tolist():
        rows, depth, kept = corners[number], depths[number], []
        for row, following in zip(range(4), (1, 2, 3, 0), strict=True):
            if depth[row] >= 0:
                kept.append(rows[row])
            if (depth[row] < 0) != (depth[following] < 0):
                way = depth[row] / (depth[row] - depth[following])
                kept.append(rows[row] + way * (rows[following] - rows[row]))
        # One that lies behind it as a whole becomes a point out of the picture.
        polygons[number] = np.array(kept or [view.eye - NEAR * view.axes[2]] * 3)
    return polygons


def flat_polygons(scene: Scene) -> tuple[Floats, Floats, npt.NDArray[np.intp]]:
    """The middle, the mean node normal and the row of the surface table of each polygon."""
    mesh = scene.mesh
    normals = mesh.normals.vectors[mesh.normals.numbers].mean(axis=1)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    middles = mesh.coordinates[mesh.node_numbers].mean(axis=1)
    return middles, normals, np.array(scene.surface_number_of_part, np.intp)[mesh.part_numbers] - 1


def flat_intensities(scene: Scene, middles: Floats, normals: Floats, surface: npt.NDArray[np.intp]) -> Floats:
    """The intensity at the middle of each polygon, by Phong's model and the controls of the lights."""
    diffuse, specular, exponent = np.array(
        [
            (each.reflectance.diffuse, each.reflectance.specular, each.reflectance.exponent)
            for each in scene.surfaces
        ]
    )[surface].T
    to_eye = np.array(scene.view.eye) - middles
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    facing = (normals * to_eye).sum(axis=1, keepdims=True)
    normals = np.where(facing < 0, -normals, normals)
    mirrored = 2 * np.abs(facing) * normals - to_eye
    total = np.full(len(middles), scene.ambient)
    for light in scene.lights:
        toward = np.array(light.position) - middles
        toward /= np.linalg.norm(toward, axis=1, keepdims=True)
        cos_incidence = (normals * toward).sum(axis=1)
        cos_eye = np.maximum((mirrored * toward).sum(axis=1), 0.0)
        part = light.intensity * light.on * (diffuse * cos_incidence + specular * cos_eye**exponent)
        lit = cos_incidence > 0
        if light.axis is not None:
            cos_light = -toward @ np.array(light.axis)
            least = 0.0 if light.concentration > 0 else -1.0
            if light.cone_angle is not None:
                least = max(least, math.cos(math.radians(light.cone_angle)))
            lit &= cos_light >= least
            part *= np.maximum(cos_light, 0.0) ** light.concentration
        total += np.where(lit, part, 0.0)
    return total
