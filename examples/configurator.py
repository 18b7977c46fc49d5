"""A configurator: 24 paints under three lights, their contact sheet, and a turntable of one paint.

Run it in the folder of the project: `python examples/configurator.py`. To go on after a stop, run it again:
pictures that are whole are not made again.
"""

from __future__ import annotations

from autocolor import Variant, animate, batch, frames, read_palette, read_scene

car = read_scene("scenes/coupe").with_view(field_of_view=30)
paints = read_palette("examples/paints.gpl")
evening = {"lights.key.intensity": 0.3, "lights.rim.intensity": 1.5}
spot = {"lights.side.on": False, "lights.back.on": False, "lights.key.concentration": 30.0}
lights: dict[str, dict[str, float]] = {"studio": {}, "evening": evening, "spot": spot}
looks = [
    Variant(f"{name} {light}", {"surfaces.body.object_color": color, **settings})
    for name, color in zip(paints.names, paints.colors.tolist(), strict=True)
    for light, settings in lights.items()
]
made = batch(car, looks, "looks/{name}.png", size=(320, 240), smooth=2, resume=True, sheet="looks.png")
print(f"{len(made)} looks, {sum(bool(look.problem) for look in made)} failed")
turned = frames(car, [looks[3]], 24, turn=360)
animate(car, turned, "turntable.webp", size=(320, 240), smooth=2, overwrite=True)
