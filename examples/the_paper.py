"""The paper in an hour: a notebook, in cells that begin with `# %%`.

`python -m docs.generate.notebook > examples/the_paper.ipynb` runs the cells and writes the notebook. Edit
this file, not the notebook. Editors that know such cells run them here.
"""

from __future__ import annotations

# %% [markdown]
# # The paper in an hour
#
# D. R. Warn, "Lighting Controls for Synthetic Images", SIGGRAPH 1983, describes how GM Research lit cars
# in a computer, as photographers light them in a studio. It also describes how a color is changed in a
# picture that takes minutes to compute: the picture is not computed again. This notebook goes through the
# paper in its own order. You compute one pixel by hand, and compare each number with what the program
# gives.
#
# You need `pip install .` in the folder of the project, numpy, and some school geometry. Read the paper
# beside it if you can: it has nine pages.

# %%
from importlib.util import find_spec

import numpy as np
import numpy.typing as npt
from PIL import Image

import autocolor
from autocolor import Flap, Light, Mesh, Phong, Scene, Studio, View
from autocolor.explanation.text import rows_of_text
from ramtek_emu import Configuration, Ramtek9300

LINES, ELEMENTS = 240, 320

Floats = npt.NDArray[np.float64]


def shown(scene: Scene) -> tuple[Studio, Ramtek9300]:
    """A studio that shows a scene, and its display, which is smaller than the paper's."""
    small = Configuration(name="SMALL", elements=ELEMENTS, lines=LINES, planes=10)
    display = Ramtek9300(small)
    return Studio(scene, display), display


def beside(*scenes: Scene) -> Image.Image:
    """The pictures of scenes, side by side."""
    fields = [autocolor.image(scene, size=(200, 150)) for scene in scenes]
    return Image.fromarray(np.hstack(fields)).quantize(192)


# %% [markdown]
# ## Introduction: what there is
#
# An object is a mesh of polygons with three or four sides. Polygons form parts, such as a door. Each part
# has a surface type, such as glass, and each surface type has a reflectance and colors. GM kept all of it
# in tables of a relational data base. Their car was a Camaro of 8,136 polygons. Ours is a coupe that comes
# with the program.

# %%
coupe = autocolor.demo()
mesh = coupe.mesh
print(f"{len(mesh.coordinates):,} nodes, {len(mesh.node_numbers):,} polygons")
hood = coupe.parts[0]
print(f"{len(coupe.parts)} parts, such as {hood.name!r} with the surface {hood.surface!r}")
print("surfaces:", ", ".join(surface.name for surface in coupe.surfaces))
print("lights:", ", ".join(light.name for light in coupe.lights))

# %% [markdown]
# A studio renders a scene and sends it to a display, here an emulated RAMTEK 9300.

# %%
studio, display = shown(coupe)
studio

# %% [markdown]
# ## The lighting model
#
# Before there is any color, there are two arrays of the size of the picture. The virtual picture array has
# an unscaled floating-point intensity for each pixel. A second array has the number of the surface that
# the pixel shows. A picture in this program is these two arrays. In a notebook it shows the intensities in
# gray.

# %%
picture = studio.picture
print("intensity", picture.intensity.dtype, picture.intensity.shape)
print("surface number", picture.surface_number.dtype, picture.surface_number.shape)
picture

# %% [markdown]
# While the picture is computed, the minimum and the maximum of the intensity are noted for the whole
# picture and for each surface. The display needs them later.

# %%
for name, (low, high) in picture.ranges.surfaces.items():
    print(f"{name:7} {low:.3f} to {high:.3f}")

# %% [markdown]
# ### One pixel
#
# Let us look at one pixel of the hood, at the edge of a highlight. At first the four lights are point
# sources: they shine in all directions, like bare bulbs. `explain` gives every number of a pixel by the
# plain formulas of the paper.

# %%
LINE, ELEMENT = 112, 68
lights = [Light(light.name, light.position, light.intensity) for light in coupe.lights]
bulbs = coupe.replace(lights=lights)
studio_of_bulbs, _ = shown(bulbs)
why = studio_of_bulbs.explain(LINE, ELEMENT)
print(*rows_of_text(why), sep="\n")

# %% [markdown]
# This is the whole paper for one pixel. Now we compute it again, step by step.
#
# **The point.** The hidden surface algorithm has found the polygon. We need its corners: where they are on
# the raster, in pixels from the upper left, and how far they are ahead of the eye.

# %%
assert why.point is not None
corners = np.array([corner.coordinates for corner in why.point.corners])
normals = np.array([corner.normal for corner in why.point.corners])

view = coupe.view
eye, (right, down, ahead) = np.array(view.eye), view.axes
focal = LINES / 2 / np.tan(np.radians(view.field_of_view / 2))

depth = (corners - eye) @ ahead
x = ELEMENTS / 2 + focal * ((corners - eye) @ right) / depth
y = LINES / 2 + focal * ((corners - eye) @ down) / depth
print(np.column_stack([x, y, depth]).round(3))

# %% [markdown]
# The scan line runs through the middle of its pixels, and crosses two edges of the polygon. We interpolate
# along both edges down to the scan line, and then along the scan line to the pixel: this is the bilinear
# interpolation of the paper. The program departs from the paper in one detail. It interpolates 1 / depth
# and normal / depth, which are linear on the raster, so that the result is also right in perspective.

# %%
at_corners = np.column_stack([x, 1 / depth, normals / depth[:, None]])
crossings = []
for one, other in zip(range(4), (1, 2, 3, 0), strict=True):
    share = (LINE + 0.5 - y[one]) / (y[other] - y[one])
    if 0 <= share < 1:
        crossings.append((1 - share) * at_corners[one] + share * at_corners[other])
start, end = sorted(crossings, key=lambda crossing: float(crossing[0]))
share = (ELEMENT + 0.5 - start[0]) / (end[0] - start[0])
_, inverse_depth, *normal = (1 - share) * start + share * end


def unit(vector: npt.ArrayLike) -> Floats:
    """The vector, scaled to length 1."""
    array = np.asarray(vector, float)
    return np.asarray(array / np.linalg.norm(array))


def cosine(one: Floats, other: Floats) -> float:
    """The cosine of the angle between two unit vectors; 0 for more than a right angle."""
    return max(float(one @ other), 0.0)


across, below = ELEMENT + 0.5 - ELEMENTS / 2, LINE + 0.5 - LINES / 2
ray = ahead + (across * right + below * down) / focal
P = eye + ray / inverse_depth
N = unit(normal)
print("P =", P.round(4), " N =", N.round(4))
assert np.allclose(P, why.point.point)
assert np.allclose(N, why.point.normal)

# %% [markdown]
# **The light.** Figures 1 and 2 of the paper. Each light gives a diffuse and a specular part:
#
#     light(j) = intensity(j) (D cos(I) + S cos^N(E))
#
# I is the angle between the normal and the ray to the light. E is the angle between the reflected ray of
# the light and the ray to the eye. We reflect the ray to the eye instead of the rays of all lights. This
# is R, and E is the angle between R and the ray to the light.

# %%
reflectance = why.point.reflectance
model = reflectance.model
assert isinstance(model, Phong)
D, S, n = reflectance.diffuse, reflectance.specular, model.exponent
print(f"D = {D}, S = {S}, N = {n}")

to_eye = unit(eye - P)
R = 2 * (N @ to_eye) * N - to_eye
intensity = coupe.ambient
for light in bulbs.lights:
    to_light = unit(np.array(light.position) - P)
    cos_i, cos_e = cosine(N, to_light), cosine(R, to_light)
    diffuse, specular = light.intensity * D * cos_i, light.intensity * S * cos_e**n
    print(f"{light.name:5} diffuse {diffuse:.4f}  specular {specular:.4f}")
    intensity += diffuse + specular

print(f"by hand          {intensity:.6f}")
print(f"by the renderer  {studio_of_bulbs.picture.intensity[LINE, ELEMENT]:.6f}")
assert np.isclose(intensity, studio_of_bulbs.picture.intensity[LINE, ELEMENT], rtol=1e-4)

# %% [markdown]
# **No limits.** Intensities are scaled for the display only afterwards. So there is no limit for D and S,
# or for the number and the intensity of lights: with a thousand times the light, the display gets the same
# words.

# %%
stronger = [light.replace(intensity=1000 * light.intensity) for light in bulbs.lights]
strong_studio, _ = shown(bulbs.replace(lights=stronger, ambient=1000 * bulbs.ambient))
print(f"maximum {strong_studio.picture.ranges.whole.maximum:.1f}")
print("words that differ", np.count_nonzero(strong_studio.words != studio_of_bulbs.words))

# %% [markdown]
# ## Light controls
#
# Bare bulbs are hard to place. Left, the car under the four bulbs; right, under one bulb at the eye, as in
# Figure 7. Cars are not photographed like this.

# %%
beside(bulbs, coupe.replace(lights=[Light("eye", view.eye)]))

# %% [markdown]
# ### Direction and concentration
#
# A directed light is modeled as a point that reflects light, and is itself shiny. Its light falls off with
# the angle L from its direction by cos^C(L). C is the concentration. With C = 0 the light is a point
# source again. At these angles half of the light is left:

# %%
for C in (1, 10, 40):
    print(f"C = {C:2}: {np.degrees(np.arccos(0.5 ** (1 / C))):.1f} degrees")

# %% [markdown]
# Figure 4 of the paper: a pyramid on a plane. A mesh is an array of nodes and an array of polygons, which
# name their nodes; a triangle repeats its last one. The point source at the left makes a bright spot on
# the plane that nobody wants. Aimed at the side of the pyramid with C = 1, the light is a flood. With C =
# 40 it is a spotlight.

# %%
nodes = [(-1.2, -1.2, 0), (1.2, -1.2, 0), (1.2, 1.2, 0), (-1.2, 1.2, 0), (0, 0, 2)]
nodes += [(-6, -6, 0), (6, -6, 0), (6, 6, 0), (-6, 6, 0)]
polygons = [(0, 1, 4, 4), (1, 2, 4, 4), (2, 3, 4, 4), (3, 0, 4, 4), (5, 6, 7, 8)]
parts = np.array([0, 0, 0, 0, 1])
pyramid = autocolor.scene_of(
    Mesh(np.array(nodes, float), np.array(polygons), parts, ("pyramid", "plane")),
    surfaces="parts",
    view=View((3.6, -8.5, 5.2), target=(0.8, -0.8, 0.45), field_of_view=33),
    lights=[Light("lamp", (3.3, -1.2, 1.0))],
    ambient=0.08,
    scaling="object",
)
pyramid = pyramid.with_surface("pyramid", diffuse=0.9, specular=0.2, object_color="#e0a030")
pyramid = pyramid.with_surface("plane", exponent=40, object_color="#5878b8")
flood = pyramid.with_light("lamp", aim=(0.5, 0.0, 0.9), concentration=1)
beside(pyramid, flood, flood.with_light("lamp", concentration=40))

# %% [markdown]
# The four lights of the coupe are aimed and concentrated. Figure 8 of the paper shows what each of them
# does alone. The whole picture is the sum of these four, and of the ambient light.

# %%
alone = [coupe.only_lights(light.name) for light in coupe.lights]
pictures = [autocolor.render(scene.replace(ambient=0), (ELEMENTS, LINES)) for scene in alone]
is_seen = picture.surface_number > 0
total = np.sum([each.intensity for each in pictures], axis=0) + coupe.ambient
assert np.allclose(picture.intensity[is_seen], total[is_seen], rtol=1e-4)
# One range for all pictures, so that less light looks darker.
exposure = {"object": (0.0, picture.ranges.whole.maximum / 2)}
beside(*(scene.replace(exposure=exposure, mapping="gamma") for scene in alone))

# %% [markdown]
# The program stores the diffuse and the specular part of each light, as planes. If one light is moved, the
# other planes are the same arrays as before. If only its intensity changes, no plane is computed, just the
# sum.

# %%
before = dict(studio.picture.light_planes)
studio.light("side", aim=(0.5, -0.9, 0.75))
after = studio.picture.light_planes
studio.undo()
used_again = [name for name in after if after[name].values is before[name].values]
print("used again:", *used_again)

# %% [markdown]
# ### Flaps and cones
#
# Barn doors on a studio lamp restrict its light. Here they are a minimum and a maximum of a coordinate,
# with a switch (Figure 9): outside, the light has no effect. The light of the pictures below ends at the
# crease along the side of the car, and in the last picture also below the roof.

# %%
lamp = Light("lamp", (-4.0, -6.0, 2.0), aim=(0.0, 0.0, 0.6), concentration=4)
side_view = View((-4.9, -8.9, 1.8), target=(0.0, 0.0, 0.52), field_of_view=23)
side = coupe.replace(lights=[lamp], view=side_view, ambient=0.12, mapping="gamma")
beside(
    side,
    side.with_light("lamp", flaps={"z": Flap(minimum=0.555)}),
    side.with_light("lamp", flaps={"z": Flap(minimum=0.555, maximum=1.0)}),
)

# %% [markdown]
# A cone (Figure 10) is a sharp edge around the direction of a light: there is no light where L is larger
# than the angle A. As printed in the paper, the test is the wrong way round: a point is in the cone if
# cos(L) is **not less** than cos(A). The pictures have no cone, A = 14 degrees and A = 7 degrees.

# %%
spot = Light("spot", (-5.0, -4.0, 5.0), aim=(-0.9, -0.3, 0.8), concentration=6)
spotlit = coupe.replace(lights=[spot], ambient=0.12, mapping="gamma")
beside(spotlit, *(spotlit.with_light("spot", cone_angle=angle) for angle in (14.0, 7.0)))

# %% [markdown]
# **The pixel again**, now under the real lights. Each control is a factor of the light.

# %%
why = studio.explain(LINE, ELEMENT)
intensity = coupe.ambient
for light in coupe.lights:
    assert light.aim is not None
    direction = unit(np.array(light.aim) - light.position)
    to_light = unit(np.array(light.position) - P)
    cos_l = cosine(direction, -to_light)
    flap = light.flaps.z
    is_lit = flap is None or flap.minimum <= P[2] <= flap.maximum
    control = cos_l**light.concentration * is_lit
    cos_i, cos_e = cosine(N, to_light), cosine(R, to_light)
    print(f"{light.name:5} cos^C(L) {cos_l**light.concentration:.4f}  flap {is_lit:d}")
    intensity += light.intensity * control * (D * cos_i + S * cos_e**n)
print(f"by hand          {intensity:.6f}")
print(f"by the renderer  {picture.intensity[LINE, ELEMENT]:.6f}")
assert np.isclose(intensity, picture.intensity[LINE, ELEMENT], rtol=1e-4)

# %% [markdown]
# ## Light source color blending
#
# ### Words and ranges
#
# The display has a number of ten bits for each pixel, a word. A lookup table with 1024 entries gives each
# word its color. Figure 11: each surface owns a range of sequential words, and within its range a word
# stands for an intensity. All three components of a color are in one entry. Three tables of eight bits
# could not do this.

# %%
paper = coupe.replace(scaling="surface", exposure="auto", contrast="stretch")
studio, display = shown(paper)
for name, (first, levels) in studio.level_ranges.items():
    print(f"{name:7} words {first:3} to {first + levels - 1}")
table = display.entries.reshape(16, 64, 3).repeat(8, axis=0).repeat(8, axis=1)
Image.fromarray(table).quantize(192)

# %% [markdown]
# In this scene, the range of intensities of each surface is scaled by itself, so the floor is brighter than
# in the pictures above: the minimum and the maximum of a surface become the lowest and the highest word of
# its range. Two lines of numpy give the words of the whole body. A word could differ from the display's by
# one where rounding decides.

# %%
body = picture.surface_number == picture.surfaces.index("body") + 1
first, levels = studio.level_ranges["body"]
low, high = picture.ranges.surfaces["body"]
fraction = (picture.intensity[body] - low) / (high - low)
words = first + np.floor(fraction * (levels - 1) + 0.5).astype(int)
difference = np.abs(words - display.words[body])
print(f"{np.count_nonzero(difference)} of {len(words):,} words differ")
assert difference.max() <= 1

# %% [markdown]
# ### Blending
#
# Figure 12: a surface has two colors. Below the blend level it shows the object color, which is darker for
# lower levels. From there on, the color shifts in equal steps to the color of the light source, up to the
# highest level. Here is the range of the body by hand. It is equal to the table of the display.

# %%
paint = paper.surfaces["body"].paint
level = np.arange(levels)
blend_level = np.floor(paint.blend * (levels - 1) + 0.5)
share = np.clip((level - blend_level) / (levels - 1 - blend_level), 0, 1)
share *= paint.light_percentage / 100
mixed = np.outer(1 - share, paint.object_color) + np.outer(share, paint.light_color)
entries = np.floor(mixed * (level / (levels - 1))[:, None] + 0.5).astype(np.uint8)
assert (entries == display.entries[first : first + levels]).all()
Image.fromarray(np.repeat(entries[None, :, :], 24, axis=0)).resize((3 * levels, 24))

# %% [markdown]
# So our pixel has this word and this color:

# %%
word = int(display.words[LINE, ELEMENT])
print(f"word {word} = {first} + level {word - first}, color {entries[word - first]}")
assert (display.field()[LINE, ELEMENT] == entries[word - first]).all()

# %% [markdown]
# ### Recoloring
#
# Now the point of it all. In 1983, a picture took one to five minutes. To paint the car, only the entries of
# its range are sent. The display counts what is written to its memories: no word of the picture is written.

# %%
words_before, entries_before = display.frame_buffer.written, display.entries.copy()
studio.recolor("body", object_color="#1f4fbf", light_color="#e8f4ff", blend=0.5)
changed = np.any(display.entries != entries_before, axis=1).sum()
words_written = display.frame_buffer.written - words_before
print(f"{words_written} words written, {changed} entries changed")
assert display.frame_buffer.written == words_before
display

# %% [markdown]
# Figure 15: one picture, three tables with the same two colors. The light source color begins at the top
# of the range, in its middle, and at its lowest level. The last table looks like metallic paint.

# %%
fields = []
for blend in (1.0, 0.5, 0.0):
    studio.recolor("body", object_color="#a80c24", light_color="#ff9480", blend=blend)
    fields.append(display.field()[40:200])
assert display.frame_buffer.written == words_before
Image.fromarray(np.hstack(fields)).quantize(192)

# %% [markdown]
# The paper calls this an obvious simplification: a level stands for one mixture of diffuse and specular
# light. Here are all pixels of the body with the word of our pixel. The specular share of their light
# differs, and they all have one color. "But it works quite well."

# %%
planes = picture.planes
light_of_highlights = S * np.sum(
    [light.intensity * planes[light.name].specular for light in coupe.lights], axis=0
)
has_word = body & (display.words == word)
specular_share = light_of_highlights[has_word] / picture.intensity[has_word]
least, most = specular_share.min(), specular_share.max()
print(f"{has_word.sum()} pixels, of whose light {least:.0%} to {most:.0%} is specular")

# %% [markdown]
# ## Conclusions
#
# Directed lights behave like those of a studio, so they are easier to place than bare bulbs. Flaps and
# cones restrict them. And colors are chosen while the picture is on the screen. Try it: run this notebook
# with the extra `notebook`, and the last cell is the display of the studio, on which you can change
# colors. Each change is an edit of `studio`, and `studio.undo()` takes it back.

# %%
studio.widget() if find_spec("anywidget") else 'first: pip install ".[notebook]"'

# %% [markdown]
# Where to go on: `autocolor tutorial` is the same studio in a window, with the screens of Figures 5, 13
# and 14. `tests/test_paper.py` has a short test for each claim of the paper, in this order. The other
# scripts in `examples/` use what you have seen.
