"""The paper in 45 minutes: a lesson in cells that begin with `# %%`, as editors and jupytext know them.

`python -m docs.generate.notebook > examples/the_paper.ipynb` runs the cells and writes the notebook. Edit
this file, not the notebook. The solutions of the tasks are Python blocks of the texts, and run, too.
"""

from __future__ import annotations

# %% [markdown]
# # The paper in 45 minutes
#
# In 1983, David Warn of General Motors Research described how cars are lit in a computer as photographers
# light them in a studio, and how a picture that took minutes to compute gets new colors at once. This
# lesson follows his paper, "Lighting Controls for Synthetic Images". You need some Python and the cosine.
# Set it up in the folder of the project with three lines:
#
#     python3 -m venv .venv
#     .venv/bin/pip install ".[notebook]" jupyterlab
#     .venv/bin/jupyter lab examples/the_paper.ipynb
#
# | minutes | part | tasks |
# |---|---|---|
# | 5 | A car to recolor | 1 |
# | 10 | Light without limits | 2, 3 |
# | 12 | Light controls | 4, 5 |
# | 15 | Words, ranges and entries | 6, 7, 8 |
# | 3 | Where to go on | |
#
# Run a cell with Shift+Enter. Make your **prediction** before you run the cell below it; until then its
# result is folded. Try each **task** in a cell of your own (the key B adds a cell), then open the solution.

# %%
import ipywidgets
import numpy as np
from PIL import Image

import autocolor
from ramtek_emu import Ramtek9300

# %% [markdown]
# ## A car to recolor (5 minutes)
#
# A studio renders a scene once and sends it to a display, here an emulated RAMTEK 9300. Click the body of
# the car and mix a color. The line below the picture says what was sent.

# %%
car = autocolor.demo()
display = Ramtek9300()
studio = autocolor.Studio(car, display)
studio.widget()

# %% [markdown]
# The picture has 307,200 pixels. For each pixel the display stores a *word*, a number from 0 to 1023. The
# word is a place in a table of 1024 colors, which are called *entries*.
#
# **Task 1.** Paint the body green in one line of Python.
#
# <details><summary>Solution</summary>
#
# ```python
# studio.recolor("body", object_color="#1c5a34", light_color="#f4fff0", blend=0.6)
# ```
#
# </details>
#
# **Prediction.** How many words does a new color of the body change, and how many entries?

# %% jupyter={"outputs_hidden": true}
words, entries = display.words.copy(), display.entries.copy()
studio.recolor("body", object_color="#1f4fbf", light_color="#e8f4ff", blend=0.5)
print(np.count_nonzero(display.words != words), "words")
print(np.count_nonzero((display.entries != entries).any(axis=1)), "entries")

# %% [markdown]
# This is the idea of the paper. In 1983 a picture took one to five minutes, and a new color no time at all.
# The next parts show which numbers make this possible.
#
# ## Light without limits (10 minutes)
#
# Before there is any color, a picture is two arrays: an unscaled intensity for each pixel, and the number
# of the surface that the pixel shows. The least and the largest intensity of each surface are noted.

# %%
picture = studio.picture
print(picture.intensity.dtype, picture.surface_number.dtype, picture.intensity.shape)
for name, (low, high) in picture.ranges.surfaces.items():
    print(f"{name:10} {low:.3f} to {high:.3f}")

# %% [markdown]
# **Task 2.** Find the line and the element of the brightest pixel of the body.
#
# <details><summary>Solution</summary>
#
# ```python
# on_body = picture.surface_number == picture.surfaces.index("body") + 1
# brightest = np.where(on_body, picture.intensity, 0).argmax()
# print(np.unravel_index(brightest, picture.intensity.shape))
# ```
#
# </details>
#
# The renderer finds the point and the normal of the surface in each pixel. Then each light adds a diffuse
# and a specular part (Figures 1 and 2 of the paper):
#
#     light(j) = intensity(j) (D cos(I) + S cos^N(E))
#
# I is the angle between the normal and the ray to the light. E is the angle between the ray to the light
# and the ray to the eye, mirrored at the normal. `explain` gives the numbers of a pixel. At first we make
# the lights bare bulbs, which shine in all directions.

# %%
bulbs = car.replace(lights=[autocolor.Light(each.name, each.position, each.intensity) for each in car.lights])
bright = autocolor.Studio(bulbs)
on_body = bright.picture.surface_number == picture.surfaces.index("body") + 1
line, element = np.unravel_index(np.where(on_body, bright.picture.intensity, 0).argmax(), on_body.shape)
point = bright.explain(int(line), int(element)).point
assert point is not None
P, normal = np.array(point.point), np.array(point.normal)
to_eye = (np.array(car.view.eye) - P) / point.distance
model = point.reflectance.model
assert isinstance(model, autocolor.Phong)
D, S, N = point.reflectance.diffuse, point.reflectance.specular, model.exponent
print(f"line {line}, element {element}: D = {D}, S = {S}, N = {N}")

# %% [markdown]
# **Task 3.** Compute the intensity of this pixel from `P`, `normal`, `to_eye`, D, S, N, and the lights'
# positions and intensities. Both vectors have length 1. A negative cosine counts as 0. The ambient light is
# `car.ambient`.
#
# <details><summary>Solution</summary>
#
# ```python
# mirrored = 2 * (normal @ to_eye) * normal - to_eye
# intensity = bulbs.ambient
# for light in bulbs.lights:
#     to_light = np.array(light.position) - P
#     to_light = to_light / np.linalg.norm(to_light)
#     cos_i, cos_e = max(normal @ to_light, 0), max(mirrored @ to_light, 0)
#     intensity += light.intensity * (D * cos_i + S * cos_e**N)
# print(f"{intensity:.4f} by hand, {bright.picture.intensity[line, element]:.4f} by the renderer")
# assert np.isclose(intensity, bright.picture.intensity[line, element], rtol=1e-3)
# ```
#
# </details>
#
# **Prediction.** Make all lights a thousand times stronger. How many words of the display change?

# %% jupyter={"outputs_hidden": true}
lights = [light.replace(intensity=1000 * light.intensity) for light in bulbs.lights]
strong = autocolor.Studio(bulbs.replace(lights=lights, ambient=1000 * bulbs.ambient))
print(np.count_nonzero(strong.words != bright.words), "words")

# %% [markdown]
# Intensities have no limit: they are scaled for the display only at the end.
#
# ## Light controls (12 minutes)
#
# Bare bulbs are hard to place. A directed light is like a shiny point: its light falls off with the angle L
# from its direction by
#
#     cos^C(L)
#
# C is the concentration. Figure 4 of the paper shows a pyramid on a plane. Move the slider: C = 0 is a bulb,
# 1 a flood light, 40 a spotlight. The bright spot on the plane, which nobody wants, goes.

# %%
nodes = [(-1.2, -1.2, 0), (1.2, -1.2, 0), (1.2, 1.2, 0), (-1.2, 1.2, 0), (0, 0, 2)]
nodes += [(-6, -6, 0), (6, -6, 0), (6, 6, 0), (-6, 6, 0)]
polygons = [(0, 1, 4, 4), (1, 2, 4, 4), (2, 3, 4, 4), (3, 0, 4, 4), (5, 6, 7, 8)]
parts = np.array([0, 0, 0, 0, 1])
pyramid = autocolor.scene_of(
    autocolor.Mesh(np.array(nodes, float), np.array(polygons), parts, ("pyramid", "plane")),
    surfaces="parts",
    view=autocolor.View((3.6, -8.5, 5.2), target=(0.8, -0.8, 0.45), field_of_view=33),
    lights=[autocolor.Light("lamp", (3.3, -1.2, 1.0), aim=(0.5, 0.0, 0.9))],
    ambient=0.08,
    scaling="object",
)
pyramid = pyramid.with_surface("pyramid", diffuse=0.9, specular=0.2, object_color="#e0a030")
pyramid = pyramid.with_surface("plane", exponent=40, object_color="#5878b8")


@ipywidgets.interact(C=(0, 60))
def with_concentration(C: int = 1) -> Image.Image:
    """The picture of the pyramid with a concentration of its light."""
    scene = pyramid.with_light("lamp", concentration=C)
    return Image.fromarray(autocolor.image(scene, size=(480, 360)))


# %% [markdown]
# **Task 4.** At which angle L is half of the light left, for C = 1, 10 and 40?
#
# <details><summary>Solution</summary>
#
# ```python
# for C in (1, 10, 40):
#     print(f"C = {C}: {np.degrees(np.arccos(0.5 ** (1 / C))):.1f} degrees")
# ```
#
# </details>
#
# **Prediction.** The car has several lights (Figure 8 shows each alone). What is the sum of the pictures in
# which one light shines alone and without ambient light?

# %% jupyter={"outputs_hidden": true}
alone = [autocolor.render(car.only_lights(light.name).replace(ambient=0)).intensity for light in car.lights]
is_seen = picture.surface_number > 0
difference = np.abs(sum(alone) + car.ambient - picture.intensity)[is_seen]
print(f"at most {difference.max():.5f} beside the picture of all lights, of {picture.intensity.max():.1f}")
assert difference.max() < 1e-3 * picture.intensity.max()

# %% [markdown]
# So if a light moves, the parts of the other lights stay.
#
# Flaps are the barn doors of a lamp (Figure 9): a minimum and a maximum of a coordinate, outside of which
# the light has no effect. This lamp lights the whole side of the car:

# %%
lamp = autocolor.Light("lamp", (-4.0, -6.0, 2.0), aim=(0.0, 0.0, 0.6), concentration=4)
side_view = autocolor.View((-4.9, -8.9, 1.8), target=(0.0, 0.0, 0.52), field_of_view=23)
side = car.replace(lights=[lamp], view=side_view, ambient=0.12, mapping="gamma")


def shown(scene: autocolor.Scene) -> Image.Image:
    """The picture of a scene, small and with few colors."""
    return Image.fromarray(autocolor.image(scene, size=(320, 240))).quantize(128)


shown(side)

# %% [markdown]
# **Task 5.** Give the lamp a flap, so that its light begins at the crease of the side, at z = 0.555.
#
# <details><summary>Solution</summary>
#
# ```python
# shown(side.with_light("lamp", flaps={"z": autocolor.Flap(minimum=0.555)}))
# ```
#
# </details>
#
# A cone (Figure 10) ends the light sharply at an angle A from its direction. The paper prints that a point
# is in the cone if cos(L) is at most cos(A). **Prediction.** Would this light the inside of the cone? Below,
# A is 7 degrees, with the test as it must be.

# %% jupyter={"outputs_hidden": true}
spot = autocolor.Light("spot", (-5.0, -4.0, 5.0), aim=(-0.9, -0.3, 0.8), concentration=6)
shown(car.replace(lights=[spot.replace(cone_angle=7.0)], ambient=0.12, mapping="gamma"))

# %% [markdown]
# The cosine is larger for smaller angles. As printed, the test lights the outside.
#
# ## Words, ranges and entries (15 minutes)
#
# Figure 11: each surface owns a range of consecutive words. Within its range, a word stands for an
# intensity. The lowest word is for the least intensity of the surface, the highest word for the largest.

# %%
paper = car.replace(scaling="surface", exposure="auto", contrast="stretch", mapping="linear")
studio = autocolor.Studio(paper, display)
picture = studio.picture
for name, (first, levels) in studio.level_ranges.items():
    print(f"{name:10} words {first:3} to {first + levels - 1}")

# %% [markdown]
# **Task 6.** Compute the words of the body from `picture.intensity`, `picture.ranges.surfaces["body"]` and
# `studio.level_ranges["body"]`. Compare them with `display.words`.
#
# <details><summary>Solution</summary>
#
# ```python
# on_body = picture.surface_number == picture.surfaces.index("body") + 1
# first, levels = studio.level_ranges["body"]
# low, high = picture.ranges.surfaces["body"]
# share = (picture.intensity[on_body] - low) / (high - low)
# by_hand = first + np.floor(share * (levels - 1) + 0.5).astype(int)
# difference = np.abs(by_hand - display.words[on_body])
# print(np.count_nonzero(difference), "of", len(by_hand), "words differ, where rounding decides")
# assert difference.max() <= 1
# ```
#
# </details>
#
# Figure 12: a surface has two colors. Up to its blend level it shows the object color, darker for lower
# levels. Above it, the color goes in equal steps to the color of the light source.

# %%
paint = paper.surfaces["body"].paint
first, levels = studio.level_ranges["body"]
print(paint.object_color, paint.light_color, f"blend {paint.blend}, light {paint.light_percentage} %")
Image.fromarray(np.repeat(display.entries[None, first : first + levels], 24, axis=0)).resize((640, 24))

# %% [markdown]
# **Task 7.** Compute these entries by hand. For a level from 0 to `levels - 1`, the share of the light color
# grows from the blend level on; the mixed color is multiplied by `level / (levels - 1)`.
#
# <details><summary>Solution</summary>
#
# ```python
# level = np.arange(levels)
# begin = np.floor(paint.blend * (levels - 1) + 0.5)
# share = np.clip((level - begin) / (levels - 1 - begin), 0, 1) * paint.light_percentage / 100
# mixed = np.outer(1 - share, paint.object_color) + np.outer(share, paint.light_color)
# by_hand = np.floor(mixed * (level / (levels - 1))[:, None] + 0.5).astype(np.uint8)
# assert (by_hand == display.entries[first : first + levels]).all()
# ```
#
# </details>
#
# **Prediction.** Figure 15 shows one picture with three tables. The two colors are the same; the color of
# the light begins at the top of the range, in its middle, and at its bottom. Which car has metallic paint?

# %% jupyter={"outputs_hidden": true}
fields = []
for blend in (1.0, 0.5, 0.0):
    studio.recolor("body", object_color="#a80c24", light_color="#ff9480", blend=blend)
    fields.append(display.field()[80:400:2, ::2])
Image.fromarray(np.hstack(fields)).quantize(128)

# %% [markdown]
# The paper calls the table "an obvious simplification": diffuse and specular light of the same sum have the
# same word, and so the same color.
#
# **Task 8.** Take the word that most pixels of the body have. Which shares of specular light do these pixels
# have? The array `picture.planes[name].specular` is cos^N(E) times the controls of a light.
#
# <details><summary>Solution</summary>
#
# ```python
# on_body = picture.surface_number == picture.surfaces.index("body") + 1
# word = np.bincount(display.words[on_body]).argmax()
# S = paper.surfaces["body"].reflectance.specular
# specular = S * sum(light.intensity * picture.planes[light.name].specular for light in paper.lights)
# has_word = on_body & (display.words == word)
# share = specular[has_word] / picture.intensity[has_word]
# print(f"{has_word.sum()} pixels, of whose light {share.min():.0%} to {share.max():.0%} is specular")
# ```
#
# </details>
#
# ## Where to go on (3 minutes)
#
# Your edits are steps of the studio: `studio.undo()` takes them back, and `studio.save("car.npz")` keeps the
# picture for other programs. `autocolor tutorial` opens the studio in a window, with the screens of Figures
# 5, 13 and 14. `docs/guides/paper.md` goes through the whole paper, and `tests/test_paper.py` has a test for
# each of its claims.
