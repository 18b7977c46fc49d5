"""The budget of memory: estimates are refused before anything is allocated, and users may allow more."""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from click.testing import CliRunner

import autocolor
from autocolor import InputError, Scene, Studio, UsageError, read_scene, render, scene_of, write_scene
from autocolor import budget as module
from autocolor.budget import MEMORY, allowed_memory, allowing, require_memory, validated_limit
from autocolor.commands.info import info
from autocolor.files.opening import output_named
from autocolor.lighting.illumination import BYTES_OF_LIGHT, SHARE
from autocolor.rendering import rendering
from ramtek_emu import Ramtek9300
from tests.small import grid
from tests.tables import refused


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The bytes that the budget is asked for."""
    needs: list[float] = []

    def recorded(needed: float, subject: str, remedy: str) -> None:
        needs.append(needed)
        require_memory(needed, subject, remedy)

    for each in list(sys.modules.values()):
        if vars(each).get("require_memory") is require_memory and each.__name__ != __name__:
            monkeypatch.setattr(each, "require_memory", recorded)
    return needs


def factor(needed: float) -> float:
    """The limit that allows this number of bytes and no more."""
    return needed / MEMORY


def test_the_budget_allows_as_much_as_it_has_and_names_the_limit_that_allows_more() -> None:
    for needed in (MEMORY - 1, MEMORY):
        require_memory(needed, "a.ply: to read it", "split it")
    with pytest.raises(InputError) as refused:
        require_memory(MEMORY + 1, "a.ply: to read it", "split it")
    assert str(refused.value) == (
        "a.ply: to read it must take at most 4,000.0 MB of memory, not 4,000.1 MB; split it, or allow it with"
        " --limit 1.1 (limit=1.1 in Python)"
    )
    for tenths in range(11, 3000):
        with allowing(tenths / 10):
            require_memory(MEMORY // 10 * tenths, "it", "split it")


def test_a_limit_holds_inside_of_its_block_and_none_leaves_it() -> None:
    with allowing(2.0), allowing(None):
        assert allowed_memory() == 2 * MEMORY
        with allowing(0.5):
            assert allowed_memory() == MEMORY // 2
        assert allowed_memory() == 2 * MEMORY
        budgets: list[int] = []
        thread = threading.Thread(target=lambda: budgets.append(allowed_memory()))
        thread.start()
        thread.join()
        # A new thread begins with the usual budget.
        assert budgets == [MEMORY]
    assert allowed_memory() == MEMORY
    with allowing(1e300):
        require_memory(1e18, "it", "split it")


test_what_is_refused = refused(
    validated_limit,
    [
        (
            limit,
            "limit must be a finite number above 0, a factor for the memory that is allowed, not"
            f" {text}; give one such as 2",
        )
        for limit, text in (
            (0, "0"),
            (-1, "-1"),
            (float("nan"), "nan"),
            (float("inf"), "inf"),
            (10**400, repr(10**400)[:60] + "..."),
            (True, "true"),
            ("2", "'2'"),
        )
    ],
)


def hills() -> Scene:
    """Nine warped quads."""
    flat = grid(3, 3, (0, 0, 0), (3, 0, 0), (0, 3, 0))
    x, y, _ = flat.coordinates.T
    return scene_of(autocolor.Mesh(np.column_stack([x, y, x * y * y]), flat.node_numbers))


def converted(name: str) -> Callable[[Path], Path]:
    """A function that writes the hills in a format that we write."""

    def write(folder: Path) -> Path:
        output = output_named(name)
        path = folder / f"hills{output.suffixes[0] if output.suffixes else ''}"
        assert output.write is not None
        output.write(path, hills(), False)
        return path

    return write


FORMATS = {name: converted(name) for name in ("CSV", "OBJ", "PLY", "tables", "store")}


@pytest.mark.parametrize("write", FORMATS.values(), ids=FORMATS)
def test_a_file_is_read_within_the_budget_that_it_asks_for_and_refused_below(
    tmp_path: Path, write: Callable[[Path], Path], asked: list[float]
) -> None:
    path = write(tmp_path)
    assert len(read_scene(path).mesh.node_numbers) == 9
    needed = max(asked)
    assert path.is_dir() or needed >= 2 * path.stat().st_size
    for more in (0, 1):
        read_scene(path, limit=factor(needed + more))
    with pytest.raises(InputError, match=r"must take at most 0\.\d MB .* --limit 0.1 "):
        read_scene(path, limit=factor(needed - 1))


def test_a_picture_is_rendered_within_the_budget_that_it_asks_for(asked: list[float]) -> None:
    scene = hills()
    whole = render(scene, (40, 30))
    needed = max(asked)
    assert needed == 96 * 30 * 40
    for more in (0, 1):
        assert np.array_equal(render(scene, (40, 30), limit=factor(needed + more)).relative, whole.relative)
    with pytest.raises(InputError, match=r"a picture of 40 x 30 pixels must take .*; render fewer lines"):
        render(scene, (40, 30), limit=factor(needed - 1))
    with pytest.raises(InputError, match=r"a picture of 16384 x 16384 pixels .* --limit 6.5 "):
        render(scene, (16384, 16384))


def test_normals_of_many_mapped_polygons_are_refused_before_they_are_computed(tmp_path: Path) -> None:
    mesh = hills().mesh
    np.save(tmp_path / "nodes.npy", np.asfortranarray(mesh.coordinates))
    np.save(tmp_path / "polygons.npy", np.asfortranarray(mesh.node_numbers))
    scene = read_scene(tmp_path, limit=1e-7)
    with pytest.raises(InputError, match=r"the normals of 9 polygons must take .*--to npy"), allowing(1e-7):
        _ = scene.mesh.normals
    assert len(scene.mesh.normals.vectors)


def test_a_studio_remembers_its_limit(tmp_path: Path) -> None:
    scene, needed = hills(), 96 * 640 * 480
    write_scene(tmp_path / "hills", scene)
    (tmp_path / "large.ply").write_bytes(bytes(5_000_000))
    small = Studio(scene, Ramtek9300(), limit=factor(needed))
    small.view(eye=(9.0, 9.0, 9.0))
    small.open(tmp_path / "hills")
    with pytest.raises(InputError, match="to read"):
        small.open(tmp_path / "large.ply")
    with pytest.raises(InputError, match="a picture of 640 x 480 pixels"):
        Studio(scene, Ramtek9300(), limit=factor(needed - 1))


@pytest.fixture
def runner() -> Iterator[CliRunner]:
    yield CliRunner()
    assert allowed_memory() == MEMORY
    assert logging.getLogger("autocolor").level == logging.NOTSET


def test_a_command_allows_the_limit_of_its_option_until_it_ends(tmp_path: Path, runner: CliRunner) -> None:
    path = converted("OBJ")(tmp_path)
    assert isinstance(runner.invoke(info, [str(path), "--limit", "1e-9"]).exception, InputError)
    assert runner.invoke(info, [str(path), "--limit", "0.1"]).exit_code == 0
    assert isinstance(runner.invoke(info, [str(path), "--limit", "nan"]).exception, UsageError)


def lit_by(count: int) -> Scene:
    """The hills under some lights."""
    lights = [autocolor.Light(f"light {n}", position=(9.0 - n, 9.0, 9.0 + n)) for n in range(count)]
    return hills().replace(lights=lights)


def unasked() -> AbstractContextManager[object]:
    """Nothing is asked of the budget for pixels and normals, so that a test of planes may have a tiny one."""
    return patch.object(module, "allowed_memory", lambda: sys.maxsize)


def planes_for(scene: Scene, count: float) -> float:
    """The limit that allows the planes of this number of lights, and no more."""
    return factor(count * BYTES_OF_LIGHT * len(render(scene, (40, 30)).pixels) / SHARE * (1 + 1e-9))


@pytest.mark.parametrize("lights", [2, 5])
def test_planes_that_do_not_fit_are_computed_in_turns_and_give_the_same_bits(lights: int) -> None:
    scene = lit_by(lights)
    whole = render(scene, (40, 30))
    assert len(whole.light_planes) == lights
    for fitting in (0.5, 1, 1.99, 2, lights - 0.01, lights, lights + 1):
        with allowing(planes_for(scene, fitting)), unasked():
            picture = render(scene, (40, 30))
        assert list(picture.light_planes) == [light.name for light in scene.lights][: int(fitting)]
        assert picture.relative.tobytes() == whole.relative.tobytes()
        for name, planes in picture.light_planes.items():
            assert planes.values.tobytes() == whole.light_planes[name].values.tobytes()


@pytest.mark.parametrize(
    "edit",
    [
        lambda scene: scene.with_light("light 0", intensity=2.0),
        lambda scene: scene.with_light("light 0", position=(1.0, 2.0, 30.0)),
        lambda scene: scene.with_light("light 4", position=(1.0, 2.0, 30.0)),
        lambda scene: scene.with_light("light 1", on=False),
        lambda scene: scene.without_light("light 0"),
        lambda scene: scene.with_surface("surface", model="cook-torrance"),
    ],
)
def test_an_edit_of_lights_computed_in_turns_is_as_a_fresh_picture(edit: Callable[[Scene], Scene]) -> None:
    scene = lit_by(5)
    with allowing(planes_for(scene, 2)), unasked():
        before = rendering(scene, 30, 40)
        edited = rendering(edit(scene), 30, 40, before)
        again = rendering(scene, 30, 40, edited)
    assert len(edited.picture.light_planes) <= 2
    assert edited.picture.relative.tobytes() == render(edit(scene), (40, 30)).relative.tobytes()
    assert again.picture.relative.tobytes() == before.picture.relative.tobytes()
