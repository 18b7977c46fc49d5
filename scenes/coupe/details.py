"""Small things: spoiler, mirrors, handles, side moldings and wipers."""

from __future__ import annotations

import numpy as np

from scenes.coupe.body import S_END, s_at, wall
from scenes.coupe.canopy import crown, flank
from scenes.coupe.curves import Array, ease
from scenes.coupe.panels import skin
from scenes.coupe.parts import Parts


def outward_at(grid: Array) -> Array:
    """Return unit normals (n, m, 3) of the skin at these parameters, away from the car."""
    along = wall(grid[..., 0] + 1e-4, grid[..., 1]) - wall(grid[..., 0] - 1e-4, grid[..., 1])
    up = wall(grid[..., 0], grid[..., 1] + 1e-4) - wall(grid[..., 0], grid[..., 1] - 1e-4)
    normal = np.cross(up, along)
    normal /= np.linalg.norm(normal, axis=-1)[..., None]
    return normal


def raised(parts: Parts, part: str, grid: Array, low: float, high: float, edging: str) -> None:
    """Add a pad that stands out from the skin by `low` at its foot and `high` at its top, and its edging."""
    base, normal = skin(grid), outward_at(grid)
    middle = base.reshape(-1, 3).mean(axis=0)
    face = base + normal * np.linspace(low, high, grid.shape[1])[None, :, None]
    parts.grid(part, face)
    ends = [np.s_[k] for k in (0, -1) if abs(base[k, 0, 1]) > 1e-9]
    for edge in (np.s_[:, 0], np.s_[:, -1], *ends):
        strip = np.stack([base[edge] - normal[edge] * 0.004, face[edge]], axis=1)
        parts.grid(edging, strip, outward=tuple(strip.reshape(-1, 3).mean(axis=0) - middle))


def patch(x0: float, x1: float, v0: float, v1: float, across: int, up: int) -> Array:
    """Return parameters of a rectangle on the side of the car."""
    v = np.linspace(v0, v1, up + 1)
    grid = np.zeros((across + 1, up + 1, 2))
    for i, x in enumerate(np.linspace(x0, x1, across + 1)):
        grid[i] = np.stack([s_at(np.full(up + 1, x), v), v], axis=1)
    return grid


def spoiler(parts: Parts) -> None:
    """Add the lip on the rear deck, running out forward on the quarter panels."""
    s = np.linspace(S_END, 14.3, 19)
    edge = wall(s, 8.12)
    along = wall(s + 1e-4, 8.12) - wall(s - 1e-4, 8.12)
    inward = np.stack([along[:, 1], -along[:, 0], 0 * s], axis=1)
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    run_out = 1 - ease(-s, -15.6, -14.3)
    high = -0.004 + 0.058 * run_out
    deep = 0.03 + 0.15 * run_out * (1 - 0.5 * np.exp(-(((s - 15.7) / 0.7) ** 2)))
    up = np.array([0.0, 0.0, 1.0])
    rows = [edge - inward * 0.002 - up * 0.012]
    for reach, lift in ((0.03, 0.98), (0.12, 1.0), (0.28, 0.76), (0.52, 0.40), (0.78, 0.14), (1.0, -0.10)):
        rows.append(edge + inward * (deep * reach)[:, None] + up * (high * lift + 0.010 * reach)[:, None])
    points = np.stack(rows, axis=1)
    parts.grid("spoiler", points, outward=(0.0, 0.0, 1.0))


def mirrors(parts: Parts) -> None:
    """Add the door mirrors: a rounded housing, its glass and its foot."""
    x = np.array([-0.43, -0.425, -0.405, -0.37, -0.33, -0.295, -0.285])
    size = np.array([0.0, 0.40, 0.68, 0.90, 1.0, 1.0, 0.93])
    angle = np.linspace(0, 2 * np.pi, 17)
    round_y = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** 0.7
    round_z = np.sign(np.sin(angle)) * np.abs(np.sin(angle)) ** 0.7
    center = np.array([0.965, 0.945])
    housing = np.stack([
        x[:, None] + 0.02 * np.abs(round_y)[None] * size[:, None] ** 2 + 0.015 * (round_y[None] + 1) * size[:, None],
        center[0] + 0.098 * size[:, None] * round_y[None] + 0 * x[:, None],
        center[1] + 0.054 * size[:, None] * round_z[None] - 0.012 * (1 - size[:, None]),
    ], axis=-1)  # fmt: skip
    parts.grid("mirrors", housing, flip=True)
    rim = housing[-1]
    middle = rim.mean(axis=0)
    inner = middle + (rim - middle) * 0.9 - [0.008, 0, 0]
    parts.grid("mirrors", np.stack([rim, inner], axis=0), outward=(1, 0, 0))
    parts.grid("mirror_glass", np.stack([inner, np.repeat(middle[None] - [0.008, 0, 0], 17, axis=0)]), outward=(1, 0, 0))
    foot = flank(np.array([-0.40, -0.33]), np.array([0.892, 0.892]))
    a, b = foot[0] + [0, -0.01, -0.02], foot[1] + [0, -0.01, -0.02]
    arm = np.array([a, a + [0, 0, 0.045], b + [0, 0, 0.045], b, a])
    tip = np.array([[-0.375, 0.93, 0.90], [-0.375, 0.93, 0.935], [-0.32, 0.93, 0.935], [-0.32, 0.93, 0.90], [-0.375, 0.93, 0.90]])
    parts.grid("mirrors", np.stack([arm, tip]), flip=True)


def wipers(parts: Parts) -> None:
    """Add two wipers, at rest low on the windshield."""
    for w0, w1, t0, t1 in ((-0.02, 0.58, 0.34, 0.30), (-0.66, -0.10, 0.26, 0.34)):
        w, t = np.linspace(w0, w1, 7), np.linspace(t0, t1, 7)

        def on(t: Array, w: Array) -> Array:
            return crown(t, np.abs(w)) * np.stack([w * 0 + 1, np.where(w < 0, -1.0, 1.0), w * 0 + 1], axis=-1)

        low, high = on(t, w), on(t + 0.05, w)
        lift = np.array([-0.008, 0, 0.014])
        rows = np.stack([low, low + lift, high + lift, high], axis=1)
        parts.grid("wipers", rows, outward=(-0.5, 0, 1), mirror=False)


def build(parts: Parts) -> None:
    """Add all of them."""
    spoiler(parts)
    mirrors(parts)
    wipers(parts)
    raised(parts, "handles", patch(0.40, 0.56, 6.35, 6.75, 4, 1), 0.008, 0.008, "handles")
    raised(parts, "side_markers", patch(-2.08, -1.95, 2.4, 2.8, 2, 1), 0.003, 0.015, "lamp_frames")
    raised(parts, "side_markers", patch(2.00, 2.13, 2.25, 2.7, 2, 1), 0.003, 0.015, "lamp_frames")
    for s0, s1, count in ((0.0, float(s_at(-1.88, 3.3)), 11), (S_END, float(s_at(1.85, 3.3)), 10)):
        s, v = np.meshgrid(np.linspace(s0, s1, count + 1), [3.15, 3.5], indexing="ij")
        raised(parts, "moldings", np.stack([s, v], axis=-1), 0.009, 0.009, "moldings")
    for x0, x1, count in ((-0.965, -0.572, 4), (-0.548, 0.617, 12), (0.642, 0.80, 2)):
        raised(parts, "moldings", patch(x0, x1, 3.15, 3.5, count, 1), 0.009, 0.009, "moldings")


