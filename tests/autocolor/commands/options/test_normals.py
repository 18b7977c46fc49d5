from __future__ import annotations

import pytest

from autocolor import UsageError
from autocolor.commands.options.normals import with_normals
from tests.autocolor.sessions import car


def test_words_stand_for_normals_where_that_is_asked_for() -> None:
    scene = car()
    assert with_normals(scene, normals=True).words == "normals"
    assert with_normals(scene, normals=False) is scene


def test_a_scene_that_a_scalar_colors_is_refused_by_the_name_of_the_option() -> None:
    with pytest.raises(UsageError) as error:
        with_normals(car().with_scalar(name="z"), normals=True)
    assert str(error.value) == (
        "--normals: words must be 'levels' where a scalar colors surfaces, not 'normals'; change it, or take"
        " the scalar away"
    )
