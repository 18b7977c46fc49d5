from __future__ import annotations

import dataclasses
import json

import autocolor
from benchmarks import scaling
from benchmarks.hills import hills, side_of
from benchmarks.points import COUPE, EDITS, QUANTITIES, lit_by


def test_a_point_has_plain_times_and_memory() -> None:
    quantity = dataclasses.replace(QUANTITIES["polygons"], sizes=(16,))
    (point,) = json.loads(json.dumps(scaling.measured_points(quantity, rounds=1, quick=False)))
    assert (point["quantity"], point["label"], point["polygons"]) == ("polygons", "16", 16)
    assert 0 < point["pixels seen"] < point["pixels"] == 640 * 480
    assert list(point["edits ms"]) == list(EDITS)
    assert all(0 < edit["low"] <= edit["median"] <= edit["high"] for edit in point["edits ms"].values())
    assert point["open ms"] > 0
    assert 1 < point["open MiB"] < 1000
    table = scaling.text({"rounds": 1, "points": [point]})
    assert all(edit in table for edit in EDITS)


def test_hills_have_about_as_many_polygons_as_are_asked_for() -> None:
    for size in QUANTITIES["polygons"].sizes[:4]:
        assert abs(len(hills(side_of(size)).node_numbers) / size - 1) < 0.03


def test_any_number_of_lights_has_names_and_places_of_its_own() -> None:
    scene = autocolor.read_scene(COUPE)
    for lights in QUANTITIES["lights"].sizes:
        lit = lit_by(scene, lights).lights
        assert (
            len(lit) == len({light.name for light in lit}) == len({light.position for light in lit}) == lights
        )
