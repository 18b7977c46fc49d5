"""OpenGL with a kept G-buffer: points, normals and surface numbers once a view, then light, then color.

It keeps what this renderer keeps, so that no edit computes more than it must: one pass over the pixels for a
light into its plane, one pass for all of them, and a last pass that adds the planes and colors them. The
passes leave out the background by the depth test.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from autocolor import Light, Scene
from benchmarks.comparison import ELEMENTS, LINES, Field
from benchmarks.peers import shaders
from benchmarks.peers.peer import AbsentError, on_llvmpipe
from benchmarks.peers.triangles import triangles
from benchmarks.points import ALL_LIGHTS, FRAME, ONE_LIGHT, RECOLOR

SIZE = (ELEMENTS, LINES)
VERSION = 400
EVERYWHERE = -2.0
"""Below any cosine."""

Singles = npt.NDArray[np.float32]


class OpenGlPeer:
    """A context without a window, and what is kept in its textures."""

    is_slow = False

    def __init__(self, scene: Scene) -> None:
        context = _created_context()
        self._context = context
        opengl = on_llvmpipe(context.info["GL_RENDERER"])
        self.description = f"kept G-buffer, moderngl {moderngl.__version__}, EGL, {opengl}"
        self.edits = {
            FRAME: self._move_eye,
            ONE_LIGHT: self._move_first_light,
            ALL_LIGHTS: self._move_lights,
            RECOLOR: self._recolor,
        }
        count = len(scene.lights)
        depth = context.depth_renderbuffer(SIZE)
        self._points, self._normals = (context.texture(SIZE, 4, dtype="f4") for _ in range(2))
        planes = [context.texture(SIZE, 1, dtype="f4") for _ in range(count)]
        self._seen = context.framebuffer([self._points, self._normals], depth)
        self._planes = context.framebuffer(planes, depth)
        self._plane = context.framebuffer(planes[:1], depth)
        self._picture = context.framebuffer([context.texture(SIZE, 4)], depth)
        for target in (self._planes, self._plane, self._picture):
            target.depth_mask = False

        self._mesh = context.program(shaders.MESH_VERTEX, shaders.MESH_FRAGMENT)
        self._light, self._all_lights, self._color = (
            context.program(shaders.WHOLE_VERTEX, _defined(fragment, lights, scene))
            for fragment, lights in (
                (shaders.LIGHT_FRAGMENT, 1),
                (shaders.LIGHT_FRAGMENT, count),
                (shaders.COLOR_FRAGMENT, count),
            )
        )
        self._mesh_array = self._triangles(scene)
        self._light_array, self._all_lights_array, self._color_array = (
            context.vertex_array(program, []) for program in (self._light, self._all_lights, self._color)
        )

        for program in (self._light, self._all_lights):
            program["points"], program["normals"] = 0, 1
            program["reflectances"].write(
                _singles(
                    (each.reflectance.diffuse, each.reflectance.specular, each.reflectance.exponent)
                    for each in scene.surfaces
                )
            )
        self._color["points"] = 0
        self._color["planes"].write(np.arange(2, 2 + count, dtype=np.int32))
        self._color["ambient"] = scene.ambient
        for place, texture in enumerate((self._points, self._normals, *planes)):
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            texture.use(place)
        self._set_colors(scene)
        self._move_eye(scene)

    def field(self) -> Field:
        """The colors of the last pass."""
        with self._context:
            read = np.frombuffer(self._picture.read(components=3), np.uint8)
        return read.reshape(LINES, ELEMENTS, 3)[::-1].copy()

    def _move_eye(self, scene: Scene) -> None:
        with self._context:
            eye = _singles(scene.view.eye)
            self._mesh["projection"].write(_projection(scene))
            self._light["eye"].write(eye)
            self._all_lights["eye"].write(eye)
            self._context.enable(moderngl.DEPTH_TEST)
            self._context.depth_func = "<"
            self._seen.clear()
            self._seen.use()
            self._mesh_array.render()
            self._context.depth_func = ">"
            self._picture.clear(*(component / 255 for component in scene.background))
            self._shade_all(scene)
            self._show()

    def _move_first_light(self, scene: Scene) -> None:
        with self._context:
            _set_lights(self._light, scene.lights[:1])
            self._plane.use()
            self._light_array.render(vertices=3)
            self._show()

    def _move_lights(self, scene: Scene) -> None:
        with self._context:
            self._shade_all(scene)
            self._show()

    def _recolor(self, scene: Scene) -> None:
        with self._context:
            self._set_colors(scene)
            self._show()

    def _shade_all(self, scene: Scene) -> None:
        _set_lights(self._all_lights, scene.lights)
        self._planes.use()
        self._all_lights_array.render(vertices=3)

    def _show(self) -> None:
        """Color the pixels, and wait until they are there (glFinish)."""
        self._picture.use()
        self._color_array.render(vertices=3)
        self._context.finish()

    def _set_colors(self, scene: Scene) -> None:
        colors = _singles(surface.paint.object_color for surface in scene.surfaces)
        self._color["colors"].write(colors / 255)

    def _triangles(self, scene: Scene) -> moderngl.VertexArray:
        """All triangles in one call."""
        every = triangles(scene)
        firsts = np.cumsum([0, *(len(each.places) for each in every)])
        rows = np.concatenate(
            [
                np.column_stack([each.places, each.normals, np.full(len(each.places), each.surface, "f4")])
                for each in every
            ]
        )
        corners = np.concatenate([each.corners + first for each, first in zip(every, firsts, strict=False)])
        return self._context.vertex_array(
            self._mesh,
            [(self._context.buffer(rows), "3f 3f 1f", "place", "normal", "surface")],
            index_buffer=self._context.buffer(corners.astype(np.int32)),
        )


def _created_context() -> moderngl.Context:
    try:
        return moderngl.create_context(
            standalone=True, require=VERSION, backend="egl", libgl="libGL.so.1", libegl="libEGL.so.1"
        )
    # Nothing narrower is raised where there is no OpenGL.
    except Exception as error:
        raise AbsentError(f"moderngl finds no OpenGL ({error}); install Mesa's EGL, libegl1") from None


def _defined(fragment: str, lights: int, scene: Scene) -> str:
    """A fragment shader for a number of lights."""
    return f"#version {VERSION}\n#define LIGHTS {lights}\n#define SURFACES {len(scene.surfaces)}\n{fragment}"


def _set_lights(program: moderngl.Program, lights: tuple[Light, ...]) -> None:
    program["positions"].write(_singles(light.position for light in lights))
    program["axes"].write(_singles(light.axis or (0.0, 0.0, 0.0) for light in lights))
    program["controls"].write(
        _singles(
            (light.intensity if light.on else 0.0, light.concentration, _least_cosine(light))
            for light in lights
        )
    )


def _least_cosine(light: Light) -> float:
    if light.cone_angle is not None:
        return math.cos(math.radians(light.cone_angle))
    return 0.0 if light.concentration > 0 else EVERYWHERE


def _projection(scene: Scene) -> Singles:
    """The matrix from the world to clip space, as its columns."""
    view = scene.view
    low, high = scene.mesh.bounds
    middle = float(view.axes[2] @ ((low + high) / 2 - np.array(view.eye)))
    reach = float(np.linalg.norm(high - low)) / 2
    far, near = middle + reach, max(middle - reach, 1e-3 * (middle + reach))
    scale = 1 / math.tan(math.radians(view.field_of_view) / 2)
    turned = np.eye(4)
    turned[:3, :3] = view.axes * np.array([[1], [-1], [-1]])
    turned[:3, 3] = -turned[:3, :3] @ np.array(view.eye)
    lens = np.diag([scale * LINES / ELEMENTS, scale, -(far + near) / (far - near), 0.0])
    lens[2, 3], lens[3, 2] = -2 * far * near / (far - near), -1.0
    return np.ascontiguousarray((lens @ turned).T, np.float32)


def _singles(rows: Iterable[Any]) -> Singles:
    return np.array(list(rows), np.float32)
