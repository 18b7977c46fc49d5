"""The part collector: grids of points become quads of named parts, mirrored, and then an OBJ text."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from autocolor.scene.geometry.normals import node_normals
from scenes.modeling.coupe.curves import Array, Indices

MIDDLE_HEIGHT = 0.55
DECIMALS = 5
"""A hundredth of a millimeter. With a tenth, the normals of polygons 2 cm wide miss by half a degree."""
Point = tuple[float, float, float]
Names = NDArray[np.str_]


class Parts:
    """Named parts under construction; nodes that coincide within a part are shared."""

    def __init__(self) -> None:
        """Start with no part."""
        self.nodes: dict[str, dict[Point, int]] = {}
        self.polygons: dict[str, list[list[int]]] = {}
        self.normals: dict[str, Callable[[Array], Array]] = {}
        """The normals of a part at places (..., 3), instead of those of its polygons."""

    def polygon(self, part: str, points: Array) -> None:
        """Add one polygon, counterclockwise from outside; corners that coincide are taken together."""
        nodes = self.nodes.setdefault(part, {})
        corners: list[int] = []
        # The factor keeps a number that ends in 5 from rounding one way here and another way elsewhere.
        for x, y, z in np.round(points * (1 + 1e-9), DECIMALS) + 0.0:
            number = nodes.setdefault((float(x), float(y), float(z)), len(nodes))
            if number not in corners:
                corners.append(number)
        if len(corners) >= 3:
            self.polygons.setdefault(part, []).append(corners)

    def grid(
        self,
        part: str | Names,
        points: Array,
        *,
        outward: Point | None = None,
        mirror: bool = True,
        flip: bool | None = None,
    ) -> None:
        """Add the quads of an (n, m, 3) grid and its mirror image.

        `part` is one name, or an (n - 1, m - 1) array of the names of the cells, where "" leaves a cell out.
        The winding is turned to face away from the middle of the car, or along `outward`. "{side}" in a
        part's name becomes right and left.
        """
        quads = np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], axis=2)
        if flip is None:
            normals = np.cross(quads[:, :, 2] - quads[:, :, 0], quads[:, :, 3] - quads[:, :, 1])
            middle = quads.mean(axis=2) * [0.85, 0, 0] + [0, 0, MIDDLE_HEIGHT]
            away = quads.mean(axis=2) - middle if outward is None else np.array(outward)
            flip = bool((normals * away).sum() < 0)
        if flip:
            quads = quads[:, :, ::-1]
        names = np.full(quads.shape[:2], part) if isinstance(part, str) else part
        for name, quad in zip(names.ravel(), quads.reshape(-1, 4, 3), strict=True):
            if name:
                self.polygon(str(name).format(side="right"), quad)
                if mirror:
                    self.polygon(str(name).format(side="left"), quad[::-1] * [1.0, -1.0, 1.0])

    def closed(self, part: str, sections: Array, *, mirror: bool = True) -> None:
        """Add a bar round an (n, m, 3) list of sections: its sides, and a fan at each end.

        The sections are counterclockwise seen from the first end.
        """
        ring = np.concatenate([sections, sections[:, :1]], axis=1)
        self.grid(part, ring, flip=False, mirror=mirror)
        for end, flip in ((ring[0], True), (ring[-1], False)):
            middle = np.broadcast_to(end.mean(axis=0), end.shape)
            self.grid(part, np.stack([end, middle]), flip=flip, mirror=mirror)

    def rings(self, names: Sequence[str]) -> Iterator[list[Point]]:
        """The corners of each polygon of these parts."""
        for name in names:
            nodes = list(self.nodes[name])
            yield from ([nodes[corner] for corner in corners] for corners in self.polygons[name])

    def sink(self, part: str, others: Sequence[str], depth: float) -> None:
        """Lower the polygons of a part of the skin, with walls where they adjoin polygons of the others."""
        normals: dict[Point, Array] = {}
        for ring in self.rings([part]):
            corners = np.array(ring)
            normal = np.cross(corners[2] - corners[0], corners[-1] - corners[1])
            for node in ring:
                normals[node] = normals.get(node, 0.0) + normal / np.linalg.norm(normal)
        lowered = {
            node: np.array(node) - depth * normal / np.linalg.norm(normal) for node, normal in normals.items()
        }
        rims = {edge for ring in self.rings(others) for edge in zip(ring, ring[1:] + ring[:1], strict=True)}
        rings = list(self.rings([part]))
        self.nodes[part], self.polygons[part] = {}, []
        for ring in rings:
            self.polygon(part, np.array([lowered[node] for node in ring]))
            for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
                if (b, a) in rims:
                    self.polygon(part, np.array([a, b, lowered[b], lowered[a]]))

    def numbered(self, names: list[str]) -> tuple[list[Point], dict[str, list[list[int]]]]:
        """Return the nodes these parts have together, and their polygons as node numbers from 1."""
        numbers: dict[Point, int] = {}
        polygons: dict[str, list[list[int]]] = {}
        for name in names:
            own = [numbers.setdefault(node, len(numbers) + 1) for node in self.nodes[name]]
            polygons[name] = [[own[corner] for corner in corners] for corners in self.polygons[name]]
        return list(numbers), polygons

    def obj(self, names: list[str], title: str, apart: Sequence[str] | None = None) -> str:
        """Return the OBJ text of these parts: shared nodes, then the polygons of each part.

        With `apart`, the file has normals, which are smooth across the borders of all parts but these.
        """
        nodes, polygons = self.numbered(names)
        lines = [f"# {title}"] + [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in nodes]
        numbers = None
        if apart is not None:
            normals, rows = self.normals_of(names, apart)
            lines += [f"vn {x:.4f} {y:.4f} {z:.4f}" for x, y, z in normals]
            numbers = iter(rows.tolist())
        for name in names:
            lines.append(f"g {name}")
            for ring in polygons[name]:
                corners = [str(node) for node in ring]
                if numbers:
                    own = zip(ring, next(numbers), strict=False)
                    corners = [f"{node}//{normal + 1}" for node, normal in own]
                lines.append("f " + " ".join(corners))
        return "\n".join(lines) + "\n"

    def normals_of(self, names: list[str], apart: Sequence[str]) -> tuple[Array, Indices]:
        """Return the distinct normals (k, 3) of these parts, and their rows at the corners (polygons, 4)."""
        nodes, polygons = self.numbered(names)
        corners = np.array([(*ring, ring[-1])[:4] for name in names for ring in polygons[name]]) - 1
        of_part = np.repeat(names, [len(polygons[name]) for name in names])
        groups = np.array([1 + names.index(name) * (name in apart) for name in of_part])
        computed = node_normals(np.array(nodes), corners, groups)
        normals = computed.vectors[computed.numbers].astype(float)
        for name in self.normals.keys() & set(names):
            places = np.array(nodes)[corners[of_part == name]]
            given = self.normals[name](places)
            # They are on the side from which the polygon is counterclockwise.
            facing = np.cross(places[:, 2] - places[:, 0], places[:, 3] - places[:, 1])
            same = (facing * given.sum(axis=1)).sum(axis=1) > 0
            normals[of_part == name] = np.where(same, 1.0, -1.0)[:, None, None] * given
        unique, rows = np.unique(np.round(normals.reshape(-1, 3), 4) + 0.0, axis=0, return_inverse=True)
        return unique, rows.reshape(-1, 4)

    def counts(self, names: list[str]) -> tuple[int, int, int]:
        """Return the numbers of nodes, polygons and distinct edges of these parts in one file."""
        nodes, polygons = self.numbered(names)
        rings = [ring for of_part in polygons.values() for ring in of_part]
        edges = {frozenset(edge) for ring in rings for edge in zip(ring, ring[1:] + ring[:1], strict=True)}
        return len(nodes), len(rings), len(edges)
