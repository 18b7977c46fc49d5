"""Figure 8: the effect of each of the four lights individually."""

from __future__ import annotations

from scenes.figures import Sheet, open_scene


def main() -> None:
    """Render once; each panel is the weighted sum again, with the other lights' weights at nothing."""
    studio = open_scene("coupe")
    # By the whole object: a surface that a light does not reach stays dark. With the exposure of all four
    # lights held, from the ambient light up, each panel shows what its light adds.
    exposure = {"object": (studio.scene.ambient, studio.picture.ranges.whole.maximum)}
    four = studio.scene.replace(scaling="object", mapping="gamma", exposure=exposure)
    sheet = Sheet("08")
    for light in four.lights:
        studio.edit(four.only_lights(light.name))
        sheet.add(studio, f"Light: {light.name}", light.name)
    sheet.write(across=2)


if __name__ == "__main__":
    main()
