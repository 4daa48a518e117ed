"""Curves traced on two surfaces, from a start to the end that they come to.

        T     p + h T        a step along the tangent T = n_A x n_B, pulled back onto both
    p --->---- - - o         surfaces in the plane at right angles to it; shorter where the
     \\_____________p'       tangent turns by more than TURN. No search: what the curve ends at
                             is known before, and looked for within the next step.

The ends of open branches are where edges of one face meet the other (``piercings``); a closed
branch ends where it starts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.intersection.bounds import boxes_and_cones, cross_surely
from surfmesh.intersection.newton import pulled_onto_both, unit_normals, uv_directions

TURN, STRAIGHTER = 0.16, 0.08
"""Radians between the tangents of neighbouring points, at most; below the second, steps grow."""

GROWN = 1.5
AHEAD = 1.6
"""Steps ahead in which ends are looked for."""

ALIKE = 0.45
"""Sine, and relative error in (u, v), within which an end lies straight ahead."""

LEAST_STEP = 1e-7
"""Of the first step: shorter ones lead nowhere."""

BESIDE = 0.1
"""Of the longer side of the (u, v) box of a step: how much wider it is looked at."""

MOST_POINTS = 20_000
FLAT = 1e-7
"""Sine of the angle between tangent planes, below which surfaces touch."""


@dataclass
class End:
    """A place where a branch starts or ends: on both surfaces.

    way: (3,) unit direction into both faces. node: its number; image_a, image_b: which of the
    places in (u, v) of the faces it is. singular: a branch point, or a pole of a surface, where
    no normal tells the way. rate_a, rate_b: (2,) of u and v along the way, where the surfaces do
    not say. touches: the surfaces have one tangent plane along the curve that leaves.
    """

    node: int
    uv_a: np.ndarray
    uv_b: np.ndarray
    point: np.ndarray
    way: np.ndarray
    image_a: object = None
    image_b: object = None
    singular: bool = False
    rate_a: np.ndarray | None = None
    rate_b: np.ndarray | None = None
    touches: bool = False
    used: bool = field(default=False, compare=False)


@dataclass(frozen=True, eq=False)
class Trace:
    """Points of a branch (n, 3), their (u, v) on both surfaces (n, 2); start and end.

    A closed branch has its first point once more at the end, and no ends. touches: the surfaces
    have one tangent plane all along.
    """

    points: np.ndarray
    uv_a: np.ndarray
    uv_b: np.ndarray
    start: End | None
    end: End | None
    touches: bool = False

    @property
    def closed(self) -> bool:
        return self.start is None


class Tracer:
    """Of branches on one pair of surfaces. step: the first, model units; gap: what is on both."""

    def __init__(self, a: FaceSurface, b: FaceSurface, step: float, gap: float) -> None:
        self.a, self.b, self.step, self.gap = a, b, step, gap
        self.singular: list[np.ndarray] = []

    def tangent(self, uv_a: np.ndarray, uv_b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit n_A x n_B (n, 3), and the sine of the angle between the tangent planes (n,)."""
        cross = np.cross(unit_normals(self.a, uv_a), unit_normals(self.b, uv_b))
        sine = np.linalg.norm(cross, axis=1)
        return cross / np.maximum(sine, 1e-300)[:, None], sine

    def trace(self, start: End, ends: Sequence[End], closed: bool = False) -> Trace:
        """The branch from ``start`` along its way, to one of ``ends``; closed: back to the only
        one of these, which is the start seen from the other side.

        Raises ``SurfaceError`` with the place where it is lost.
        """
        way = start.way
        points, uvs_a, uvs_b = [start.point], [start.uv_a], [start.uv_b]
        step = self.step
        here = start.point, start.uv_a, start.uv_b
        self.singular = [end.point for end in [start, *ends] if end.singular]
        rates = start.rate_a, start.rate_b
        while len(points) < MOST_POINTS:
            reach = AHEAD * step
            looks = not closed or len(points) > 3
            end = self._ahead(here, way, reach, ends) if looks else None
            if end is not None:
                if len(points) < 3:  # enough points for a curve
                    self._insert_between(points, uvs_a, uvs_b, end)
                points.append(end.point)
                uvs_a.append(end.uv_a)
                uvs_b.append(end.uv_b)
                arrays = np.array(points), np.array(uvs_a), np.array(uvs_b)
                return Trace(*arrays, None if closed else start, None if closed else end)
            taken = self._step(here, way, step, rates)
            if taken is None:
                step *= 0.5
                if step < LEAST_STEP * self.step:
                    break
                continue
            here, new_way = taken
            rates = None, None
            points.append(here[0])
            uvs_a.append(here[1])
            uvs_b.append(here[2])
            if float(way @ new_way) > np.cos(STRAIGHTER):
                step = min(step * GROWN, 4.0 * self.step)
            way = new_way
        raise SurfaceError(
            f"{self.a.name} and {self.b.name}: their common curve cannot be followed at "
            f"{place(here[0])}: the surfaces touch there, or leave their domain"
        )

    def _step(self, here: tuple, way: np.ndarray, step: float, rates: tuple) -> tuple | None:
        """The point a step ahead, and the tangent there; None where that is too far."""
        point, uv_a, uv_b = here
        along_a, along_b = (
            uv_directions(surface, uv[None], way[None])[0] if rate is None else rate
            for surface, uv, rate in ((self.a, uv_a, rates[0]), (self.b, uv_b, rates[1]))
        )
        found = pulled_onto_both(
            self.a, self.b, (uv_a + step * along_a)[None], (uv_b + step * along_b)[None],
            way[None], (point + step * way)[None],
        )  # fmt: skip
        if not found.gap[0] <= self.gap:
            return None
        new = found.point[0]
        tangent, sine = self.tangent(found.uv_a, found.uv_b)
        tangent = tangent[0]
        if float(tangent @ way) < 0.0:
            tangent = -tangent
        length = np.linalg.norm(new - point)
        if not (
            sine[0] > FLAT
            and float(tangent @ way) > np.cos(TURN)
            and 0.8 * step < length < 1.25 * step
            and (
                self._is_near_singular(point)
                or self._is_one_curve(here[1:], (found.uv_a[0], found.uv_b[0]))
            )
        ):
            return None
        return (new, found.uv_a[0], found.uv_b[0]), tangent

    def _ahead(self, here: tuple, way: np.ndarray, reach: float, ends: Sequence[End]) -> End | None:
        """The nearest end within reach that lies straight ahead and is entered the same way."""
        point, uv_a, uv_b = here
        best, nearest, aslant = None, reach, 1.0
        for end in ends:
            step = end.point - point
            distance = float(np.linalg.norm(step))
            same = self.gap + 1e-6 * distance
            if end.used or not same < distance <= nearest + same or float(step @ way) <= 0.0:
                continue
            sine = np.linalg.norm(np.cross(step / distance, way))
            turned = np.linalg.norm(np.cross(end.way, way))
            if sine > ALIKE or turned > 2.0 * ALIKE or float(end.way @ way) >= 0.0:
                continue
            if (
                self._straight(self.a, uv_a, end.uv_a, step)
                and self._straight(self.b, uv_b, end.uv_b, step)
                and (
                    (end.singular and self._is_near_singular(point))
                    or self._is_one_curve((uv_a, uv_b), (end.uv_a, end.uv_b))
                )
            ):
                # several leave a branch point: the one straight ahead
                if best is not None and distance > nearest - same and sine + turned >= aslant:
                    continue
                best, nearest, aslant = end, distance, float(sine + turned)
        return best

    def _is_near_singular(self, point: np.ndarray) -> bool:
        """Is a branch point or pole so near that normals tell nothing?"""
        return any(np.linalg.norm(point - other) <= self.step for other in self.singular)

    def _is_one_curve(
        self, here: tuple[np.ndarray, np.ndarray], there: tuple[np.ndarray, np.ndarray]
    ) -> bool:
        """Are no normals parallel over the boxes from here to there? Then one curve passes."""
        cones = []
        for surface, start, end in zip((self.a, self.b), here, there):
            low, high = np.minimum(start, end), np.maximum(start, end)
            room = BESIDE * (high - low).max()
            cones.append(boxes_and_cones(surface, (low - room)[None], (high + room)[None])[1])
        first = np.zeros(1, np.int64)
        return bool(cross_surely(cones[0], first, cones[1], first)[0])

    @staticmethod
    def _straight(surface: FaceSurface, uv: np.ndarray, end: np.ndarray, step: np.ndarray) -> bool:
        """Does the way in (u, v) to an end lead there in space?"""
        _, r_u, r_v = surface.evaluate(0.5 * (uv + end)[None], 1)
        led = (r_u * (end - uv)[0] + r_v * (end - uv)[1])[0]
        return bool(np.linalg.norm(led - step) <= ALIKE * np.linalg.norm(step))

    def _insert_between(self, points: list, uvs_a: list, uvs_b: list, end: End) -> None:
        """Two points more on a very short branch."""
        first = points[-1], uvs_a[-1], uvs_b[-1]
        for fraction in (1.0 / 3.0, 2.0 / 3.0):
            guess = [(1.0 - fraction) * x + fraction * y for x, y in zip(
                first, (end.point, end.uv_a, end.uv_b)
            )]  # fmt: skip
            chord = end.point - first[0]
            found = pulled_onto_both(
                self.a, self.b, guess[1][None], guess[2][None],
                (chord / np.linalg.norm(chord))[None], guess[0][None],
            )  # fmt: skip
            if found.gap[0] <= self.gap:
                points.append(found.point[0])
                uvs_a.append(found.uv_a[0])
                uvs_b.append(found.uv_b[0])


def place(point: np.ndarray) -> str:
    """(x, y, z) for messages."""
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"
