"""Small things: mirrors, handles, side moldings and wipers."""

from __future__ import annotations

import numpy as np

from scenes.modeling.coupe.body import S_END, columns_at, s_at, skin, wall
from scenes.modeling.coupe.canopy import crown, flank
from scenes.modeling.coupe.curves import Array
from scenes.modeling.coupe.parts import Parts

STRIP = np.array([3.15, 3.5])


def outward_at(grid: Array) -> Array:
    """Return unit normals (n, m, 3) of the skin at these parameters, away from the car."""
    along = wall(grid[..., 0] + 1e-4, grid[..., 1]) - wall(grid[..., 0] - 1e-4, grid[..., 1])
    up = wall(grid[..., 0], grid[..., 1] + 1e-4) - wall(grid[..., 0], grid[..., 1] - 1e-4)
    normal: Array = np.cross(up, along)
    normal /= np.linalg.norm(normal, axis=-1)[..., None]
    return normal


def raised(parts: Parts, part: str, grid: Array, low: float, high: float, edging: str) -> None:
    """Add a pad that stands out from the skin by `low` at its foot and `high` at its top, and its edging."""
    base, normal = skin(grid), outward_at(grid)
    normal[np.abs(base[..., 1]) < 1e-9, 1] = 0.0
    middle = base.reshape(-1, 3).mean(axis=0)
    face = base + normal * np.linspace(low, high, grid.shape[1])[None, :, None]
    parts.grid(part, face)
    sunk = base - normal * 0.004
    x, y, z = -normal.reshape(-1, 3).mean(axis=0)
    parts.grid(edging, sunk[:, [0, -1]], outward=(float(x), float(y), float(z)))
    strips = [np.stack([sunk[:, k], face[:, k]], axis=1) for k in (0, -1)]
    # An end on the center line needs no edging: the mirror image goes on there.
    strips += [np.stack([sunk[k], face[k]], axis=1) for k in (0, -1) if abs(base[k, 0, 1]) > 1e-9]
    for strip in strips:
        x, y, z = strip.reshape(-1, 3).mean(axis=0) - middle
        parts.grid(edging, strip, outward=(float(x), float(y), float(z)))


def mirrors(parts: Parts) -> None:
    """Add the door mirrors: a rounded housing, its glass and its foot."""
    x = np.array([-0.43, -0.425, -0.405, -0.37, -0.33, -0.295, -0.285])[:, None]
    size = np.array([0.0, 0.40, 0.68, 0.90, 1.0, 1.0, 0.93])[:, None]
    angle = np.linspace(0, 2 * np.pi, 17)[None]
    wide, high = (np.sign(wave) * np.abs(wave) ** 0.7 for wave in (np.cos(angle), np.sin(angle)))
    swept = x + 0.02 * np.abs(wide) * size**2 + 0.015 * (wide + 1) * size
    housing = np.stack(
        [swept, 0.965 + 0.098 * size * wide, 0.945 + 0.054 * size * high - 0.012 * (1 - size)], axis=-1
    )
    parts.grid("mirrors", housing, flip=True)
    rim = housing[-1]
    middle = np.broadcast_to(rim.mean(axis=0) - [0.008, 0, 0], rim.shape)
    inner = middle + (rim - rim.mean(axis=0)) * 0.9
    parts.grid("mirrors", np.stack([rim, inner]), outward=(1, 0, 0))
    parts.grid("mirror_glass", np.stack([inner, middle]), outward=(1, 0, 0))
    front, rear = flank([-0.40, -0.33], 0.892) - [0, 0.01, 0.02]
    up = np.array([0, 0, 0.045])
    root = np.array([front, front + up, rear + up, rear])
    tip = np.array([(-0.375, 0.90), (-0.375, 0.935), (-0.32, 0.935), (-0.32, 0.90)])
    parts.closed("mirrors", np.stack([root, np.insert(tip, 1, 0.93, axis=1)]))


def wipers(parts: Parts) -> None:
    """Add two wipers, at rest low on the windshield."""
    lift = np.array([-0.008, 0, 0.014])
    for w0, w1, t0, t1 in ((-0.04, 0.60, 0.20, 0.14), (-0.66, -0.10, 0.13, 0.20)):
        w, t = np.linspace(w0, w1, 5), np.linspace(t0, t1, 5)
        low, high = crown(t, w), crown(t + 0.05, w)
        blade = np.stack([low, low + lift, high + lift, high], axis=1)
        parts.closed("wipers", blade, mirror=False)


def strips(parts: Parts) -> None:
    """Add the dark rub strip round the car, a little below the side crease."""
    front, rear = float(s_at(-1.88, STRIP[0])), float(s_at(1.85, STRIP[0]))
    for end, cut, count in ((0.0, front, 10), (S_END, rear, 9)):
        s, v = np.meshgrid(np.linspace(end, cut, count + 1), STRIP, indexing="ij")
        raised(parts, "moldings", np.stack([s, v], axis=-1), 0.009, 0.009, "moldings")
    for start, end, count in ((-0.965, -0.575, 2), (-0.545, 0.615, 6), (0.645, 0.80, 1)):
        grid = columns_at(np.linspace(start, end, count + 1), STRIP)
        raised(parts, "moldings", grid, 0.009, 0.009, "moldings")


def build(parts: Parts) -> None:
    """Add all of them."""
    mirrors(parts)
    wipers(parts)
    strips(parts)
    handle = columns_at(np.linspace(0.40, 0.56, 3), np.array([6.35, 6.75]))
    raised(parts, "handles", handle, 0.008, 0.008, "handles")
    for x, foot, head in ((-2.08, 2.4, 2.8), (2.0, 2.25, 2.7)):
        lamp = columns_at(np.linspace(x, x + 0.13, 3), np.array([foot, head]))
        raised(parts, "side_markers", lamp, 0.003, 0.015, "lamp_frames")
