"""The border of a face with its coedges cut at nodes, and the places of nodes in its (u, v)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace
from surfmesh.errors import SurfaceError
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.arrangement import HalfEdge, half_edge, turn
from surfmesh.intersection.tracing import place

GRAZING = 1e-5
"""Radians: a curve that comes to an edge at a smaller angle touches it."""

ALONG = 1e-3
"""Radians: an edge that both faces have is their common curve if it leaves so near to that."""

NEAR = 1e-2
"""Of the (u, v) box: an image of a node so near to the end of an edge is the end."""


@dataclass(frozen=True, eq=False)
class Image:
    """A place of a node in the (u, v) of a face. key: among those of the face. leaves, enters:
    (2,) directions of the loop there, None inside the face. Of a place on a pole: the way (3,) of
    the curve that leaves there, the rate (2,) of u and v, and the face (of the other side) that it
    is common with."""

    key: object
    uv: np.ndarray
    leaves: np.ndarray | None = None
    enters: np.ndarray | None = None
    way: np.ndarray | None = None
    rate: np.ndarray | None = None
    other: int = -1
    is_pole: bool = False


class Part(NamedTuple):
    """A coedge, or a part of one, with the node where it starts.

    leaving: where it starts on a pole, the curve that leaves there: way, rate and other face, as
    of an `Image`.
    """

    coedge: CadCoedge
    node: int
    degenerate: bool
    leaving: tuple[np.ndarray | None, np.ndarray | None, int]


PartsOf = Callable[[CadCoedge], list[Part]]
"""The parts that nodes cut a coedge in, in walking order."""

Inner = Mapping[int, list[np.ndarray]]
"""Nodes inside a face, with their places (2,) in (u, v)."""


class FaceBorder:
    """The loops of a face with their coedges cut at the nodes."""

    def __init__(
        self, face: CadFace, inner: Inner, parts_of: PartsOf,
        is_inside: Callable[[np.ndarray], bool],
    ) -> None:  # fmt: skip
        self.face = face
        self.is_inside = is_inside
        surface = self.face.surface
        box = np.array(surface.domain)
        line = np.linspace(0.0, 1.0, 9)
        grid = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2)
        points, r_u, r_v = surface.evaluate(box[:, 0] + grid * (box[:, 1] - box[:, 0]), 1)
        self.scale = np.array([np.linalg.norm(d, axis=1).mean() for d in (r_u, r_v)])
        self.extent = norm(np.ptp(np.nan_to_num(points), axis=0))
        self.halves: list[HalfEdge] = []
        self.degenerate: set[int] = set()
        self.images: dict[int, list[Image]] = {}
        self.is_cut = False
        for number_of_loop, loop in enumerate(face.loops):
            parts = [part for coedge in loop for part in parts_of(coedge)]
            self.is_cut |= len(parts) > len(loop)
            halves = [
                half_edge(
                    coedge, (number_of_loop, k), (number_of_loop, (k + 1) % len(parts)), self.scale
                )
                for k, (coedge, *_) in enumerate(parts)
            ]
            for k, (half, part) in enumerate(zip(halves, parts)):
                if part.degenerate:
                    self.degenerate.add(part.coedge.edge)
                way, rate, other = part.leaving
                image = Image(
                    half.start, part.coedge.walk(np.zeros(1))[0], half.leaves,
                    halves[k - 1].enters, way, rate, other,
                    part.degenerate or parts[k - 1].degenerate,
                )  # fmt: skip
                self.images.setdefault(part.node, []).append(image)
            self.halves += halves
        for node, places in inner.items():
            for k, uv in enumerate(places):
                self.images.setdefault(node, []).append(Image((node, k, "inside"), uv))

    def add_curve(
        self, edge: int, pcurve: object, length: float, start: object, end: object
    ) -> None:
        """Both half-edges of a curve between two places."""
        forward = CadCoedge(edge, False, pcurve, 0.0, length, False)  # type: ignore[arg-type]
        backward = replace(forward, reversed=True)
        self.halves.append(half_edge(forward, start, end, self.scale))
        self.halves.append(half_edge(backward, end, start, self.scale))
        self.is_cut = True

    def image_at(self, node: int, uv: np.ndarray) -> Image:
        """The image of a node nearest to a place (2,); a new one inside the face if there is none.

        Raises ``SurfaceError`` where those that there are lie elsewhere.
        """
        images = self.images.setdefault(node, [])
        if not images:
            images.append(Image((node, 0, "inside"), uv))
        width = np.ptp(np.array(self.face.surface.domain), axis=1)
        off = [float(np.abs((image.uv - uv) / width).max()) for image in images]
        best = int(np.argmin(off))
        if off[best] > NEAR:
            where = place(self.face.surface.evaluate(uv[None], 0)[0][0])
            raise SurfaceError(
                f"{self.face.surface.name}: an edge that lies on it leads nowhere at {where}"
            )
        return images[best]

    def uses(self, edge: int) -> list[CadCoedge]:
        """The coedges of an edge, of one inside the face the first."""
        found = [half.coedge for half in self.halves if half.coedge.edge == edge]
        return [c for k, c in enumerate(found) if all(c.pcurve is not o.pcurve for o in found[:k])]

    def shared_with(self, other: FaceBorder) -> list[int]:
        """Edges that both faces have, on their borders or inside; no degenerate ones."""
        own, theirs = (
            {half.coedge.edge for half in border.halves} - border.degenerate
            for border in (self, other)
        )
        return sorted(own & theirs)

    def edges_along(self, image: Image, way: np.ndarray) -> set[int]:
        """The edges that leave a place in a direction (2,), or nearly."""
        way = way * self.scale
        found = set()
        for half in self.halves:
            for key, leaves in ((half.start, half.leaves), (half.end, -half.enters)):
                if key == image.key:
                    angle = turn(leaves, way)
                    if min(angle, 2.0 * np.pi - angle) < ALONG:
                        found.add(half.coedge.edge)
        return found

    def enters(self, image: Image, way: np.ndarray, ahead: np.ndarray) -> bool:
        """Does a direction (2,) lead from a place into the face? Where it runs along the border,
        by whether a place (2,) a little ahead lies within."""
        if image.leaves is None or image.enters is None:
            return True
        way = way * self.scale
        open_angle = turn(image.leaves, -image.enters) or 2.0 * np.pi
        angle = turn(image.leaves, way)
        if any(abs(angle - edge) < GRAZING for edge in (0.0, open_angle, 2.0 * np.pi)):
            return self.is_inside(ahead)
        return angle < open_angle
