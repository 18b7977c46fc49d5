"""Random steps of a session, the journal of a session, and all that must be the same after recovering it."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

import autocolor
from autocolor import InputError, Light, Mesh, Studio, UsageError, scene_of
from autocolor.journal.autosave import JOURNAL
from autocolor.journal.history import History
from autocolor.journal.journal import MeshesBeside, first_line, step_line
from autocolor.journal.places import Source, checksum_of
from autocolor.testing import lights, named_views, scene_columns, surfaces, views
from tests.autocolor.linked_scenes import linked
from tests.autocolor.test_studio import any_edits, apply, recolorings
from tests.small import car, cube

OBJ = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 1 1\ng a\nf 1 2 3\ng b\nf 1 3 4\n"

CAR = car()
NAMES = ["key", "fill", "rim"]


def linked_lights(lights: tuple[Light, ...]) -> st.SearchStrategy[tuple[Light, ...]]:
    """The lights with half-spaces and links, following each other."""
    return linked(CAR.replace(lights=lights)).map(lambda scene: scene.lights)


columns_of_scenes = st.fixed_dictionaries(
    {},
    optional={
        "parts": st.tuples(*[st.sampled_from(["body", "glass", "wheels"])] * 3).map(
            lambda names: tuple(
                part.replace(surface=name, stage=name == "glass")
                for part, name in zip(CAR.parts, names, strict=True)
            )
        ),
        "surfaces": st.tuples(*(surfaces(name) for name in ("body", "glass", "wheels"))),
        "lights": st.tuples(*(lights(name) for name in NAMES)).flatmap(
            lambda three: st.integers(0, 3).flatmap(lambda count: linked_lights(three[:count]))
        ),
        "view": views(),
        "views": named_views(),
        **scene_columns(),
        "name": st.sampled_from(["scene", "a 'name'\n", "\N{SNOWMAN}"]),
    },
)
OTHER = scene_of(cube(), name="other")
LARGER = CAR.replace(
    mesh=Mesh(CAR.mesh.coordinates * 2, CAR.mesh.node_numbers, CAR.mesh.part_numbers, CAR.mesh.part_names, 17)
)

moves = (
    any_edits
    | recolorings
    | st.tuples(st.just("columns"), st.booleans(), columns_of_scenes)
    | st.tuples(st.sampled_from(["undo", "redo"]), st.none(), st.integers(1, 3))
    | st.tuples(st.sampled_from(["view_back", "view_forward", "take_back"]), st.none(), st.none())
    | st.tuples(st.just("add_light"), st.sampled_from(NAMES), lights())
    | st.tuples(st.just("remove_light"), st.sampled_from(NAMES), st.none())
    | st.tuples(st.just("open"), st.sampled_from(["car", "box.obj"]), st.sampled_from(["materials", "parts"]))
    | st.tuples(st.just("mesh"), st.booleans(), st.sampled_from([CAR, LARGER, OTHER]))
    | st.tuples(st.sampled_from(["keep", "show", "drop"]), st.sampled_from("AB"), st.none())
    | st.tuples(st.just("rename"), st.sampled_from("AB"), st.sampled_from("AC"))
    | st.tuples(st.sampled_from(["hold", "release", "saved"]), st.none(), st.none())
)


def take_move(studio: Studio, move: tuple[str, Any, Any], folder: Path) -> None:
    """Take a move of a session, unless it is refused. Files to open are in a folder."""
    kind, what, value = move
    with contextlib.suppress(InputError, UsageError):
        if kind == "columns":
            studio.edit(studio.scene.replace(**value), same_step=what)
        elif kind in ("undo", "redo"):
            getattr(studio, kind)(value)
        elif kind in ("view_back", "view_forward", "take_back"):
            getattr(studio, kind)()
        elif kind == "add_light":
            studio.edit(studio.scene.replace(lights=(*studio.scene.lights, value.replace(name=what))))
        elif kind == "remove_light":
            studio.remove_light(what)
        elif kind == "open":
            studio.open(folder / what, surfaces=value)
        elif kind == "mesh":
            studio.edit(value, same_step=what)
        elif kind in ("keep", "show", "drop"):
            getattr(studio, f"{kind}_variant")(what)
        elif kind == "rename":
            studio.rename_variant(what, value)
        elif kind in ("hold", "release"):
            getattr(studio, f"{kind}_exposure")()
        elif kind == "saved":
            studio.mark_saved({"/car/scene.toml": "9f"})
        else:
            apply(studio, move)


def written_scenes(folder: Path) -> Source:
    """Write the files that moves open to a folder; returns the source of the first scene."""
    autocolor.write_scene(folder / "car", CAR)
    (folder / "box.obj").write_text(OBJ)
    return Source(str(folder / "car"))


def journal_of(history: History, folder: Path, source: Source | None = None) -> Path:
    """Write the journal of a session whole to a folder."""
    source = source or history.first_place.source
    assert source is not None
    folder.mkdir(exist_ok=True)
    meshes = MeshesBeside(folder)
    lines = [step_line(step, history.start, meshes) for step in history.steps]
    (folder / JOURNAL).write_text("".join([first_line(history.start, source), *lines]), "ascii")
    return folder / JOURNAL


def summary(history: History) -> tuple[object, ...]:
    """All that is known of a session, as values that can be compared."""
    return (
        checksum_of(history.scene),
        [checksum_of(scene) for scene in history.to_undo],
        [checksum_of(scene) for scene in history.to_redo],
        history.timeline.views_back,
        history.timeline.views_forward,
        history.timeline.has_jumped,
        {name: (checksum_of(one.scene), one.place.source) for name, one in history.variants.items()},
        history.place.source,
        history.is_changed,
        history.left_unsaved,
        history.unsaved_variants,
        history.saved.files,
    )
