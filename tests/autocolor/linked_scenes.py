"""Random scenes whose lights have half-spaces, links, soft edges and falloffs, and follow each other."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from autocolor import Light, Scene
from autocolor.scene.lights import EYE, FALLOFFS, HalfSpace, Links
from autocolor.testing import directions, numbers, scenes, vectors

half_spaces = st.builds(
    HalfSpace,
    st.sampled_from(["left", "right", "b", "barn door", 'a "b".c', "ü", "0"]),
    vectors(),
    directions(),
    st.sampled_from([0.0, 0.25]),
    st.booleans(),
    st.booleans(),
)
named = st.lists(half_spaces, max_size=4, unique_by=lambda row: row.name)


@st.composite
def linked(draw: st.DrawFn, scene: Scene) -> Scene:
    """The scene with lights that have any of the columns; only lights before one are followed by it."""
    lights: list[Light] = []
    for light in scene.lights:
        chosen: dict[str, Any] = {}
        for what, rows in (("surfaces", scene.surfaces), ("parts", scene.parts)):
            names = st.lists(st.sampled_from([row.name for row in rows]), max_size=3)
            chosen[f"{draw(st.sampled_from(['only', 'except']))}_{what}"] = draw(st.none() | names)
        fields: dict[str, Any] = {"half_spaces": draw(named), "links": Links(**chosen)}
        has_axis = light.axis is not None
        if draw(st.booleans()):
            falloff, reach = draw(st.sampled_from(FALLOFFS)), draw(numbers(0.5, 9))
            fields |= {"falloff": falloff, "reach": reach, "at_infinity": False}
        elif has_axis:
            fields |= {"falloff": "none", "at_infinity": draw(st.booleans())}
        if light.cone_angle is not None:
            fields["inner_angle"] = draw(st.none() | numbers(0, light.cone_angle))
        if has_axis and draw(st.booleans()):
            x, y, z = light.position
            fields["aim"] = (x + 1.0, y, z - 1.0)
        followed = [each.name for each in lights if each.aim is not None]
        fields["follows"] = draw(st.sampled_from([None, EYE, *followed]))
        lights.append(light.replace(**fields))
    return scene.replace(lights=tuple(lights))


def linked_scenes() -> st.SearchStrategy[Scene]:
    """A scene with everything in it, and all the columns of its lights."""
    return scenes().flatmap(linked)
