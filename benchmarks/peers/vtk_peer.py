"""VTK, which computes the light at every fragment of every triangle again for any edit."""

from __future__ import annotations

import subprocess
import sys

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (what the classes of vtkRenderingCore are made of)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkUnsignedCharArray, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from autocolor import Light, Scene
from benchmarks.comparison import ELEMENTS, LINES, Field
from benchmarks.peers.peer import AbsentError, on_llvmpipe
from benchmarks.peers.triangles import Triangles, triangles
from benchmarks.points import ALL_LIGHTS, FRAME, ONE_LIGHT, RECOLOR

WIDEST_CONE = 89.99
"""In degrees; from 90 on a light of VTK's has no exponent any more."""

TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.Render()
"""


class VtkPeer:
    """A renderer of VTK's with an actor for each surface, off screen, without multisampling."""

    is_slow = False

    def __init__(self, scene: Scene) -> None:
        _try_window()
        self._renderer = vtkRenderer()
        self._renderer.SetBackground(*(component / 255 for component in scene.background))
        self._renderer.AutomaticLightCreationOff()
        self._actors = {each.surface: _actor(scene, each) for each in triangles(scene)}
        for actor in self._actors.values():
            self._renderer.AddActor(actor)
        self._lights = [_light(light) for light in scene.lights]
        for light in self._lights:
            self._renderer.AddLight(light)
        self._place_eye(scene)
        self._window = vtkRenderWindow()
        self._window.SetOffScreenRendering(True)
        self._window.SetMultiSamples(0)
        self._window.SetSize(ELEMENTS, LINES)
        self._window.AddRenderer(self._renderer)
        self._render()
        opengl = on_llvmpipe(self._opengl_renderer())
        self.description = f"{vtkVersion.GetVTKVersion()}, {self._window.GetClassName()}, {opengl}"
        self.edits = {
            FRAME: self._move_eye,
            ONE_LIGHT: self._move_first_light,
            ALL_LIGHTS: self._move_lights,
            RECOLOR: self._recolor,
        }

    def field(self) -> Field:
        """The pixels in the window."""
        pixels = vtkUnsignedCharArray()
        self._window.GetPixelData(0, 0, ELEMENTS - 1, LINES - 1, 1, pixels, 0)
        field: Field = vtk_to_numpy(pixels).reshape(LINES, ELEMENTS, 3)[::-1].copy()
        return field

    def _move_eye(self, scene: Scene) -> None:
        self._place_eye(scene)
        self._render()

    def _move_first_light(self, scene: Scene) -> None:
        _place_light(self._lights[0], scene.lights[0])
        self._render()

    def _move_lights(self, scene: Scene) -> None:
        for light, placed in zip(self._lights, scene.lights, strict=True):
            _place_light(light, placed)
        self._render()

    def _recolor(self, scene: Scene) -> None:
        _color(self._actors[0], scene, 0)
        self._render()

    def _render(self) -> None:
        """Render, and wait until the pixels are there (glFinish)."""
        self._window.Render()
        self._window.WaitForCompletion()

    def _place_eye(self, scene: Scene) -> None:
        camera, view = self._renderer.GetActiveCamera(), scene.view
        ahead = [place + step for place, step in zip(view.eye, view.axes[2].tolist(), strict=True)]
        camera.SetPosition(*view.eye)
        camera.SetFocalPoint(*ahead)
        camera.SetViewUp(*(-view.axes[1]).tolist())
        camera.SetViewAngle(view.field_of_view)
        self._renderer.ResetCameraClippingRange()

    def _opengl_renderer(self) -> str:
        for line in self._window.ReportCapabilities().splitlines():
            if line.startswith("OpenGL renderer string:"):
                return str(line.partition(":")[2].strip())
        return "an unknown renderer"


def _try_window() -> None:
    """Open a window in another process: where VTK finds no OpenGL, it ends the process that asked for it."""
    trial = subprocess.run([sys.executable, "-c", TRIAL], capture_output=True, text=True, check=False)
    if trial.returncode:
        raise AbsentError(
            f"VTK finds no OpenGL (its trial ended with {trial.returncode}); install Mesa's EGL, libegl1"
        )


def _actor(scene: Scene, each: Triangles) -> vtkActor:
    points, cells, mesh = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(each.places, deep=True))
    cells.SetData(3, numpy_to_vtk(each.corners.ravel(), deep=True))
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    mesh.GetPointData().SetNormals(numpy_to_vtk(each.normals, deep=True))
    mapper, actor = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputData(mesh)
    actor.SetMapper(mapper)
    reflectance, finish = scene.surfaces[each.surface].reflectance, actor.GetProperty()
    finish.SetInterpolationToPhong()
    finish.SetAmbient(scene.ambient)
    finish.SetDiffuse(reflectance.diffuse)
    finish.SetSpecular(reflectance.specular)
    finish.SetSpecularPower(reflectance.exponent)
    _color(actor, scene, each.surface)
    return actor


def _color(actor: vtkActor, scene: Scene, surface: int) -> None:
    actor.GetProperty().SetColor(
        *(component / 255 for component in scene.surfaces[surface].paint.object_color)
    )


def _light(light: Light) -> vtkLight:
    made = vtkLight()
    made.SetLightTypeToSceneLight()
    made.SetPositional(True)
    made.SetIntensity(light.intensity if light.on else 0.0)
    made.SetExponent(light.concentration)
    if light.axis is None:
        made.SetConeAngle(180.0)
    else:
        made.SetConeAngle(min(light.cone_angle or WIDEST_CONE, WIDEST_CONE))
    _place_light(made, light)
    return made


def _place_light(made: vtkLight, light: Light) -> None:
    axis = light.axis or (0.0, 0.0, -1.0)
    made.SetPosition(*light.position)
    made.SetFocalPoint(*(place + step for place, step in zip(light.position, axis, strict=True)))
