"""POV-Ray, a ray tracer in a process of its own: any edit is a whole run, from scene file to picture file.

The scene has no shadows, as the lighting model of 1983 has none.
"""

from __future__ import annotations

import math
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt

from autocolor import Light, Scene
from benchmarks.comparison import ELEMENTS, LINES, Field
from benchmarks.peers.peer import THREADS, AbsentError
from benchmarks.peers.triangles import Triangles, triangles
from benchmarks.points import FRAME

NO_SHADOWS = "+Q3"
"""The quality below which no shadow is traced; the finishes are computed in full."""


class PovRayPeer:
    """The program, and a folder with the mesh in its language."""

    is_slow = True

    def __init__(self, scene: Scene) -> None:
        program = shutil.which("povray")
        if program is None:
            raise AbsentError("there is no program povray; apt-get install povray")
        self._program = program
        self._folder = TemporaryDirectory(prefix="povray-")
        self.description = f"{_version(program)}, {THREADS} threads, no shadows"
        self.edits = {FRAME: self._run}
        meshes = "\n".join(map(_mesh, triangles(scene)))
        (Path(self._folder.name) / "meshes.inc").write_text(meshes, encoding="ascii")
        self._run(scene)

    def field(self) -> Field:
        """The pixels of the picture file."""
        content = (Path(self._folder.name) / "scene.ppm").read_bytes()
        pixels = np.frombuffer(content[-LINES * ELEMENTS * 3 :], np.uint8)
        return pixels.reshape(LINES, ELEMENTS, 3)

    def _run(self, scene: Scene) -> None:
        (Path(self._folder.name) / "scene.pov").write_text("\n".join(_statements(scene)), encoding="ascii")
        subprocess.run(
            [
                self._program, "+Iscene.pov", "+Oscene.ppm", "+FP", "File_Gamma=1.0",
                f"+W{ELEMENTS}", f"+H{LINES}", f"+WT{THREADS}", NO_SHADOWS, "-D", "-A", "-J", "-GA",
            ],
            cwd=self._folder.name, check=True, capture_output=True,
        )  # fmt: skip


def _version(program: str) -> str:
    told = subprocess.run([program, "--version"], capture_output=True, text=True, check=False)
    lines = [line for line in (told.stdout + told.stderr).splitlines() if line.startswith("POV-Ray ")]
    return lines[0].removeprefix("POV-Ray ") if lines else "an unknown version"


def _statements(scene: Scene) -> Iterator[str]:
    """A scene in POV-Ray's language."""
    view = scene.view
    right, down, forward = view.axes
    lens = 0.5 / math.tan(math.radians(view.field_of_view) / 2)
    yield "#version 3.7;"
    yield "global_settings { assumed_gamma 1.0 ambient_light rgb 1 }"
    yield f"background {{ rgb {_vector(component / 255 for component in scene.background)} }}"
    yield (
        f"camera {{ perspective location {_vector(view.eye)} direction {_vector(lens * forward)}"
        f" right {_vector(ELEMENTS / LINES * right)} up {_vector(-down)} }}"
    )
    for light in scene.lights:
        if light.on:
            yield f"light_source {{ {_vector(light.position)} rgb {light.intensity:.9g} {_spot(light)} }}"
    for number, surface in enumerate(scene.surfaces):
        color, reflectance = surface.paint.object_color, surface.reflectance
        yield (
            f"#declare Surface{number} = texture {{ pigment {{ rgb {_vector(part / 255 for part in color)} }}"
            f" finish {{ ambient {scene.ambient:.9g} diffuse {reflectance.diffuse:.9g}"
            f" phong {reflectance.specular:.9g} phong_size {reflectance.exponent:.9g} }} }}"
        )
    yield '#include "meshes.inc"'


def _spot(light: Light) -> str:
    if light.axis is None:
        return ""
    aim = np.array(light.position) + np.array(light.axis)
    angle = light.cone_angle if light.cone_angle is not None else 90.0
    return (
        f"spotlight point_at {_vector(aim)} radius {angle:.9g} falloff {angle:.9g}"
        f" tightness {light.concentration:.9g}"
    )


def _mesh(each: Triangles) -> str:
    return (
        f"mesh2 {{ vertex_vectors {{ {_table(each.places)} }} normal_vectors {{ {_table(each.normals)} }}"
        f" face_indices {{ {_table(each.corners)} }} texture {{ Surface{each.surface} }} }}"
    )


def _table(rows: npt.NDArray[Any]) -> str:
    return ", ".join([str(len(rows)), *(_vector(row) for row in rows.tolist())])


def _vector(components: Iterable[float]) -> str:
    return f"<{', '.join(f'{component:.9g}' for component in components)}>"
