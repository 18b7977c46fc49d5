"""The virtual picture array: unscaled floating-point intensities and the surface number at each pixel.

Paper: "The Lighting Model": the intensity at a point is the sum of the contributions of all lights plus an
ambient term, an unscaled floating-point value. An auxiliary array has the surface numbers. Minima and maxima
are found for the whole picture and for each surface.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Bytes, Indices, PartNumbers, Singles, underflowing
from autocolor.checks import is_whole, shown
from autocolor.errors import InputError, UsageError
from autocolor.immutable import Immutable, read_only
from autocolor.lighting.shading import DIFFUSE, SPECULAR, LightPlanes
from autocolor.scene.scene import Scene, check_scene
from autocolor.visibility.visible_points import SurfaceSlice, VisibleParts, surface_slices


class IntensityRange(NamedTuple):
    """The minimum and the maximum of some intensities."""

    minimum: float
    maximum: float


@dataclass(frozen=True)
class PictureRanges:
    """Minimum and maximum intensity of the whole picture and, by surface name, of each visible surface.

    For a picture in which nothing is visible, minimum and maximum of the whole are 0.
    """

    whole: IntensityRange
    surfaces: Mapping[str, IntensityRange]


@dataclass(frozen=True, eq=False, repr=False)
class LightPlane(Immutable):
    """The planes of a light as rasters, (lines, elements) float32 each; see `LightPlanes`."""

    diffuse: Singles
    specular: Singles


@dataclass(frozen=True, eq=False)
class Picture(Immutable):
    """The picture that the lighting model computes: intensities and surfaces, no colors.

    The visible pixels are sorted by surface; `slices` has the slice of each surface. `pixels` are their flat
    places in the raster, `relative` the intensities in proportion to `scale`, both (n,). `light_planes` has
    the computed planes by light; of many lights, only the planes that fit in memory (see `illumination`).

    `scalar_values`, (n,) float32 in the order of `pixels`, are the values of the scalar that colors the
    scene, NaN where missing. `scalar_limits` are its own range. Both are None without a scalar.

    `visible_parts` has the part at each of `pixels`. It is None in a picture of rasters without part numbers.

    `normals`, (3, n) float32 in the order of `pixels`, are unit vectors in camera space; None unless the
    words of the scene stand for normals.

    If `smooth` is more than 1, each pixel of an image is the mean of a square of `smooth` pixels a side.

    `apart` is the name of a surface that the range of the whole picture leaves out: that of a stage that is
    made around the object.

    `counts`, (n,), are how many pixels each intensity stands for; None if each stands for one.
    """

    lines: int
    elements: int
    surfaces: tuple[str, ...]
    pixels: Indices
    slices: tuple[SurfaceSlice, ...]
    relative: Singles
    scale: float
    light_planes: Mapping[str, LightPlanes] = field(default_factory=dict, repr=False)
    scalar_values: Singles | None = field(default=None, repr=False)
    scalar_limits: tuple[float, float] | None = None
    visible_parts: VisibleParts | None = field(default=None, repr=False)
    normals: Singles | None = field(default=None, repr=False)
    smooth: int = 1
    apart: str = ""
    counts: Indices | None = field(default=None, repr=False)

    @classmethod
    def from_rasters(
        cls,
        relative: Singles,
        surface_number: Bytes,
        surfaces: tuple[str, ...],
        scale: float,
        scalar: Singles | None = None,
        scalar_limits: tuple[float, float] | None = None,
        part_number: PartNumbers | None = None,
        parts: tuple[str, ...] = (),
        smooth: int = 1,
    ) -> Picture:
        """A picture of relative intensities and surface numbers, both (lines, elements), without planes.

        `scalar`, (lines, elements), are the values of a scalar where polygons are visible. `part_number`,
        (lines, elements), are numbers of `parts` from 1 on there.
        """
        lines, elements = relative.shape
        numbers = surface_number.ravel()
        pixels = np.flatnonzero(numbers)
        pixels = pixels[np.argsort(numbers[pixels], kind="stable")]
        slices = surface_slices(np.bincount(numbers[pixels], minlength=1))
        intensities = relative.ravel()[pixels].astype(np.float32)
        values = None if scalar is None else read_only(scalar.ravel()[pixels].astype(np.float32))
        return cls(
            lines,
            elements,
            surfaces,
            pixels,
            slices,
            intensities,
            scale,
            scalar_values=values,
            scalar_limits=scalar_limits,
            visible_parts=None
            if part_number is None
            else VisibleParts.of_points(parts, part_number.ravel()[pixels]),
            smooth=smooth,
        )

    @property
    def size(self) -> tuple[int, int]:
        """The width and height of an image of the picture: the elements and lines, divided by `smooth`."""
        return self.elements // self.smooth, self.lines // self.smooth

    @cached_property
    @underflowing
    def intensity(self) -> Singles:
        """Unscaled intensities, (lines, elements) float32, 0 where nothing is visible; read-only."""
        return self._raster(self.relative * np.float32(self.scale))

    @cached_property
    def surface_number(self) -> Bytes:
        """Surface numbers, (lines, elements) uint8: number k is surfaces[k - 1], 0 is none; read-only."""
        numbers = np.empty(len(self.pixels), np.uint8)
        for surface in self.slices:
            numbers[surface.pixels] = surface.surface_number
        raster: Bytes = self._raster(numbers)
        return raster

    @property
    def parts(self) -> tuple[str, ...]:
        """The names of the parts of the mesh; none if the picture does not know them."""
        return () if self.visible_parts is None else self.visible_parts.names

    @cached_property
    def part_number(self) -> PartNumbers:
        """Part numbers, (lines, elements) int32: number k is parts[k - 1], 0 is none; read-only.

        All are 0 if the picture does not know its parts.
        """
        none = np.zeros(len(self.pixels), np.int32)
        raster: PartNumbers = self._raster(none if self.visible_parts is None else self.visible_parts.numbers)
        return raster

    @cached_property
    def scalar(self) -> Singles | None:
        """The scalar, (lines, elements) float32, NaN on the background and for missing values; read-only.

        None for a picture whose scene shows no scalar.
        """
        return None if self.scalar_values is None else self._raster(self.scalar_values, np.nan)

    @cached_property
    def relative_ranges(self) -> Mapping[int, IntensityRange]:
        """Minimum and maximum of `relative` by surface number; number 0 is all but the surface `apart`."""
        ranges = {}
        for surface in self.slices:
            values = self.relative[surface.pixels]
            ranges[surface.surface_number] = IntensityRange(float(values.min()), float(values.max()))
        counted = [ranges[number] for number in ranges if self.surfaces[number - 1] != self.apart]
        counted = counted or [*ranges.values()]
        least = min((each.minimum for each in counted), default=0.0)
        most = max((each.maximum for each in counted), default=0.0)
        return {0: IntensityRange(least, most), **ranges}

    @property
    @underflowing
    def ranges(self) -> PictureRanges:
        """Minimum and maximum intensity of the whole picture and of each visible surface."""
        scale = np.float32(self.scale)
        scaled = {
            number: IntensityRange(*(float(np.float32(relative) * scale) for relative in each))
            for number, each in self.relative_ranges.items()
        }
        return PictureRanges(
            scaled[0], {self.surfaces[number - 1]: each for number, each in scaled.items() if number}
        )

    @property
    def planes(self) -> Mapping[str, LightPlane]:
        """The two planes of the lights as rasters, by the name of the light."""
        return {
            name: LightPlane(self._raster(planes.values[DIFFUSE]), self._raster(planes.values[SPECULAR]))
            for name, planes in self.light_planes.items()
        }

    def _raster(self, values: AnyArray, elsewhere: float = 0) -> AnyArray:
        """A raster with the values at the visible pixels and another number elsewhere; read-only."""
        flat = np.full(self.lines * self.elements, elsewhere, values.dtype)
        flat[self.pixels] = values
        flat.flags.writeable = False
        return flat.reshape(self.lines, self.elements)

    def _repr_png_(self) -> bytes:
        from ramtek_emu.png import png_bytes

        ranges = self.ranges.whole
        extent = (ranges.maximum - ranges.minimum) or 1.0
        gray = np.where(self.surface_number > 0, (self.intensity - ranges.minimum) / extent * 255 + 0.5, 0)
        return png_bytes(np.repeat(gray.astype(np.uint8)[..., None], 3, axis=2))

    def __repr__(self) -> str:
        whole = self.ranges.whole
        smooth = f"smooth {self.smooth}, " if self.smooth > 1 else ""
        return (
            f"Picture({self.elements} x {self.lines}, {smooth}{len(self.pixels)} pixels of {len(self.slices)}"
            f" surfaces, intensities {whole.minimum:.4g} to {whole.maximum:.4g})"
        )


MOST_SMOOTH: Final = 64
"""Limit: the pixels along a side of a square that becomes a pixel of an image."""


def check_smooth(smooth: int) -> None:
    """Raise UsageError unless `smooth` is a whole number from 1 to MOST_SMOOTH."""
    if not is_whole(smooth, 1, MOST_SMOOTH):
        raise UsageError(
            f"smooth must be a whole number from 1 to {MOST_SMOOTH}, not {shown(smooth)}; give one such as 4"
        )


def check_surfaces(scene: Scene, picture: Picture) -> None:
    """Raise InputError if the surfaces of a picture are not those of a scene, in the same order.

    Raises UsageError unless the arguments are a scene and a picture, in this order.
    """
    if isinstance(scene, Picture) and isinstance(picture, Scene):
        raise UsageError("the scene must come before the picture, not after it; swap the two arguments")
    check_scene(scene)
    if not isinstance(picture, Picture):
        raise UsageError(f"a picture must be a Picture, not {shown(picture)}; `render` makes one of a scene")
    names = [surface.name for surface in scene.surfaces]
    if list(picture.surfaces) != names:
        raise InputError(
            f"the surfaces of a picture must be those of the scene, {shown(names)}, not"
            f" {shown(list(picture.surfaces))}; render this scene, or use the scene that was rendered"
        )
