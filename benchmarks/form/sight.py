"""What is judged: bare meshes, each seen from three sides, with lights that are created for the view.

All surfaces are white under white light, so that a pixel's gray is its mapped intensity.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

import autocolor
from autocolor import Mesh, Scene, View
from autocolor.arrays import Bytes
from autocolor.files.formats import FILE_FORMATS, suffixes_of
from autocolor.files.meshes.repair import UPS
from autocolor.images import display_image
from autocolor.rendering import Rendering, rendering
from autocolor.scene.defaults import default_lights, default_view, framed
from benchmarks.form.creases import Creases, flat_normals, visible_creases
from benchmarks.form.measures import Measures, measure, tone
from benchmarks.shapes import shapes

WHITE: Final = (255, 255, 255)
ASPECT: Final = 4 / 3

SMOOTH: Final = 2.0
"""In degrees: how far the normal at a corner is from that of the polygon, where it is shaded smoothly."""

CREATED: Final = "created"
"""The view that is created for a mesh, the first that people see."""

TURNED: Final = {"turned": (-175.0, 40.0), "low": (65.0, 5.0)}
"""The azimuth and elevation of the eye in degrees, 120 from each other and from the created view."""


class Subject(NamedTuple):
    """A scene of a bare mesh, with all else created, and whether most of the mesh is curved."""

    name: str
    scene: Scene
    is_curved: bool


@dataclass(frozen=True, eq=False)
class Sight:
    """A subject seen from one side, with what does not depend on lights and colors.

    `rendering` is that of the white scene with the lights that are created for the view.
    """

    subject: Subject
    view_name: str
    rendering: Rendering
    creases: Creases

    def gray(self, scene: Scene | None = None) -> Bytes:
        """The gray of the whole raster, flat, under the lights and the mapping of a scene with this view.

        The visible points are not computed again, if only lights, reflectances and the mapping differ.
        """
        shown = self.rendering
        if scene is not None:
            lines, elements = shown.picture.lines, shown.picture.elements
            shown = rendering(scene, lines, elements, before=shown)
        gray: Bytes = display_image(shown.scene, shown.picture).colors[..., 0].ravel()
        return gray

    def measures(self, scene: Scene | None = None) -> Measures:
        """The measures under the lights and the mapping of a scene with this view."""
        found = measure(self.gray(scene), self.rendering.points.pixels, self.creases)
        return found if self.view_name != CREATED else replace(found, tone=self.tone())

    def tone(self) -> float | None:
        """The tone in the colors of the subject."""
        picture = self.rendering.picture
        colored = self.rendering.scene.replace(surfaces=self.subject.scene.surfaces)
        return tone(display_image(colored, picture).colors.reshape(-1, 3)[picture.pixels])


def subjects(paths: Sequence[Path] = ()) -> Iterator[Subject]:
    """Our own shapes, some mesh files, and every mesh file in some folders.

    A path may end in a colon and the up axis of its files, as in `car.obj:y`.
    """
    for name, shape in shapes().items():
        yield Subject(name, autocolor.scene_of(shape.mesh), shape.is_curved)
    for path, up in map(path_and_up, paths):
        files = sorted(path.iterdir()) if path.is_dir() else [path]
        for file in files:
            if file.suffix.lower() in suffixes_of(FILE_FORMATS):
                scene = autocolor.read_scene(file, up=up)
                yield Subject(file.stem, scene, is_curved(scene.mesh))


def path_and_up(path: Path) -> tuple[Path, str]:
    """The path without its up axis, and the axis, which is z unless it is given.

    >>> path_and_up(Path("car.obj:y"))[1], path_and_up(Path("meshes"))[1]
    ('y', 'z')
    """
    name, colon, up = path.name.rpartition(":")
    return (path.with_name(name), up) if colon and up in UPS else (path, "z")


def is_curved(mesh: Mesh) -> bool:
    """Whether most polygons are shaded smoothly: some corner's normal is not that of the polygon."""
    flat = flat_normals(mesh).T
    at_corners = mesh.normals.vectors[mesh.normals.numbers]
    cosines = np.einsum("ijk,ik->ij", at_corners, flat).min(axis=1)
    return bool(np.median(cosines) < math.cos(math.radians(SMOOTH)))


def views(mesh: Mesh) -> dict[str, View]:
    """The created view of a mesh and those from two other sides, each framing it."""
    coordinates = mesh.used_coordinates
    found = {CREATED: default_view(coordinates)}
    for name, (azimuth, elevation) in TURNED.items():
        turn, rise = math.radians(azimuth), math.radians(elevation)
        eye = (math.cos(rise) * math.cos(turn), math.cos(rise) * math.sin(turn), math.sin(rise))
        found[name] = framed(View(eye=eye, target=(0.0, 0.0, 0.0)), coordinates)
    return found


def white(scene: Scene, view: View) -> Scene:
    """The scene from another side with the lights that are created for it, and with white surfaces."""
    surfaces = [surface.replace(object_color=WHITE, light_color=WHITE) for surface in scene.surfaces]
    lights = default_lights(scene.object_coordinates, view)
    return scene.replace(view=view, lights=lights, surfaces=surfaces)


def sights(subject: Subject, lines: int = 480) -> Iterator[Sight]:
    """The subject from each side."""
    for name, view in views(subject.scene.mesh).items():
        seen = rendering(white(subject.scene, view), lines, round(lines * ASPECT))
        yield Sight(subject, name, seen, visible_creases(subject.scene.mesh, seen.points))
