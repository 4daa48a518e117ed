"""Curves along which two surfaces touch: pulled into contact, followed from end to end.

r_A - r_B = 0,  N_A . r_B,s = N_A . r_B,t = 0     five equations for four unknowns, which agree
                                                  where the surfaces touch (Gauss and Newton)
way              the direction in which the difference of both surfaces over the tangent plane
                 does not bend (``touching``); a step along it is pulled back into contact in the
                 plane at right angles to it
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm, product, pseudo_inverse
from surfmesh.intersection.newton import Pulled, limits_of, unit_normals, uv_directions
from surfmesh.intersection.touching import branch_ways
from surfmesh.intersection.tracing import End, Trace, place

STEPS = 30
WEAK = 1e-7
"""Singular values below this part of the largest one are none: the way along the contact."""

PARALLEL = 1e-6
"""Sine between the normals where surfaces touch."""

TURN, STRAIGHTER = 0.16, 0.08
"""Radians between ways of neighbouring places, at most; below the second, steps grow."""

GROWN = 1.5
AHEAD = 1.6
"""Steps ahead in which ends are looked for."""

ALIKE = 0.45
"""Sine, and relative error in (u, v), within which an end lies straight ahead."""

LEAST_STEP = 1e-5
"""Of the first step."""

MOST_POINTS = 20_000


def pulled_into_contact(
    a: FaceSurface, b: FaceSurface, uv_a: np.ndarray, uv_b: np.ndarray,
    normal: np.ndarray | None = None, through: np.ndarray | None = None,
) -> Pulled:  # fmt: skip
    """Places near guesses (n, 2) where both surfaces have one point and one tangent plane; with
    ``normal`` and ``through`` (n, 3) in the planes that these give.

    Those that have not come into contact have a gap, or normals that are not parallel.
    """
    (low_a, high_a), (low_b, high_b) = limits_of(a), limits_of(b)
    low, high = np.concatenate([low_a, low_b]), np.concatenate([high_a, high_b])
    at = np.clip(np.hstack([uv_a, uv_b]), low, high)
    extent = max(float(np.ptp(a.evaluate(at[:, :2], 0)[0], axis=0).max(initial=0.0)), 1e-3)
    for _ in range(STEPS):
        value, slope = _equations(a, b, at, extent)
        if normal is not None and through is not None:
            r, r_u, r_v = a.evaluate(at[:, :2], 1)
            row = np.zeros((len(at), 1, 4))
            row[:, 0, 0] = np.einsum("ni,ni->n", normal, r_u)
            row[:, 0, 1] = np.einsum("ni,ni->n", normal, r_v)
            ahead = np.einsum("ni,ni->n", normal, r - through)
            value = np.concatenate([value, ahead[:, None]], axis=1)
            slope = np.concatenate([slope, row], axis=1)
        speed = np.maximum(np.linalg.norm(slope, axis=1), 1e-300)
        inverse = pseudo_inverse(np.nan_to_num(slope / speed[:, None]), WEAK)
        step = np.einsum("nij,nj->ni", inverse, np.nan_to_num(value)) / speed
        room = np.abs(step / (high - low)).max(axis=1)
        step /= np.maximum(1.0, 5.0 * room)[:, None]
        at = np.clip(at - step, low, high)
        if np.abs(step * speed).max(initial=0.0) <= 1e-14 * (1.0 + extent):
            break
    (p,), (q,) = a.evaluate(at[:, :2], 0), b.evaluate(at[:, 2:], 0)
    return Pulled(at[:, :2], at[:, 2:], 0.5 * (p + q), np.linalg.norm(p - q, axis=1))


def _equations(
    a: FaceSurface, b: FaceSurface, at: np.ndarray, extent: float
) -> tuple[np.ndarray, np.ndarray]:
    """Values (n, 5) and derivatives (n, 5, 4); those of angles times a length."""
    r, ru, rv, ruu, ruv, rvv = a.evaluate(at[:, :2], 2)
    q, qs, qt, qss, qst, qtt = b.evaluate(at[:, 2:], 2)
    normal = np.cross(ru, rv)
    normal_u = np.cross(ruu, rv) + np.cross(ru, ruv)
    normal_v = np.cross(ruv, rv) + np.cross(ru, rvv)
    size = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    along = [np.maximum(np.linalg.norm(way, axis=1), 1e-300) * size / extent for way in (qs, qt)]
    dot = np.einsum
    value = np.column_stack([
        r - q, dot("ni,ni->n", normal, qs) / along[0], dot("ni,ni->n", normal, qt) / along[1]
    ])  # fmt: skip
    slope = np.empty((len(at), 5, 4))
    slope[:, :3] = np.stack([ru, rv, -qs, -qt], axis=2)
    rows = ((normal_u, qs), (normal_v, qs), (normal, qss), (normal, qst)), (
        (normal_u, qt), (normal_v, qt), (normal, qst), (normal, qtt)
    )  # fmt: skip
    for k, row in enumerate(rows):
        for column, (one, other) in enumerate(row):
            slope[:, 3 + k, column] = dot("ni,ni->n", one, other) / along[k]
    return value, slope


def touches_there(a: FaceSurface, b: FaceSurface, found: Pulled, gap: float) -> np.ndarray:
    """Of places (n,), have both surfaces one point and one tangent plane there?"""
    cross = np.cross(unit_normals(a, found.uv_a), unit_normals(b, found.uv_b))
    return (found.gap <= gap) & (np.linalg.norm(cross, axis=1) <= PARALLEL)


class ContactTracer:
    """Of contacts of one pair of surfaces. step: the first, model units; gap: what is on both."""

    def __init__(self, a: FaceSurface, b: FaceSurface, step: float, gap: float) -> None:
        self.a, self.b, self.step, self.gap = a, b, step, gap

    def trace(self, start: End, ends: Sequence[End], closed: bool = False) -> Trace:
        """The contact from ``start`` along its way to one of ``ends``; closed: back to the only
        one of these, which is the start seen from the other side.

        Raises ``SurfaceError`` with the place where it is lost.
        """
        way, step = start.way, self.step
        places = [(start.point, start.uv_a, start.uv_b)]
        while len(places) < MOST_POINTS:
            looks = not closed or len(places) > 3
            end = self._ahead(places[-1], way, AHEAD * step, ends) if looks else None
            if end is not None:
                if len(places) < 3:
                    places += self._between(places[-1], end)
                places.append((end.point, end.uv_a, end.uv_b))
                points, uv_a, uv_b = (np.array(column) for column in zip(*places))
                first, last = (None, None) if closed else (start, end)
                return Trace(points, uv_a, uv_b, first, last, touches=True)
            taken = self._step(places[-1], way, step)
            if taken is None:
                step *= 0.5
                if step < LEAST_STEP * self.step:
                    break
                continue
            here, ahead = taken
            places.append(here)
            if float(product(way, ahead)) > np.cos(STRAIGHTER):
                step = min(step * GROWN, 4.0 * self.step)
            way = ahead
        raise SurfaceError(
            f"{self.a.name} and {self.b.name} touch at {place(places[-1][0])}, where the curve "
            "along which they touch cannot be followed further; move or change one of them"
        )

    def _step(self, here: tuple, way: np.ndarray, step: float) -> tuple | None:
        """The place a step ahead, and the way there; None where that is too far."""
        point, uv_a, uv_b = here
        uv_a = uv_a + step * uv_directions(self.a, uv_a[None], way[None])[0]
        uv_b = uv_b + step * uv_directions(self.b, uv_b[None], way[None])[0]
        through = (point + step * way)[None]
        found = pulled_into_contact(self.a, self.b, uv_a[None], uv_b[None], way[None], through)
        length = norm(found.point[0] - point)
        if not touches_there(self.a, self.b, found, self.gap)[0]:
            return None
        if not 0.8 * step < length < 1.25 * step:
            return None
        what, ways = branch_ways(self.a, self.b, found.uv_a[0], found.uv_b[0])
        if what != "along":
            return None
        ahead = ways[0] if float(product(ways[0], way)) > 0.0 else -ways[0]
        if float(product(ahead, way)) <= np.cos(TURN):
            return None
        return (found.point[0], found.uv_a[0], found.uv_b[0]), ahead

    def _ahead(self, here: tuple, way: np.ndarray, reach: float, ends: Sequence[End]) -> End | None:
        """The nearest end within reach that lies straight ahead."""
        best, nearest = None, reach
        for end in ends:
            step = end.point - here[0]
            distance = norm(step)
            if end.used or not self.gap < distance <= nearest or float(product(step, way)) <= 0.0:
                continue
            if norm(np.cross(step / distance, way)) > ALIKE:
                continue
            led = uv_directions(self.a, here[1][None], step[None])[0]
            other = uv_directions(self.b, here[2][None], step[None])[0]
            if not (_is_ahead(end.uv_a - here[1], led) and _is_ahead(end.uv_b - here[2], other)):
                continue
            if float(product(end.way, way)) < 0.0:
                best, nearest = end, distance
        return best

    def _between(self, here: tuple, end: End) -> list[tuple]:
        """Two places more on a very short contact."""
        made = []
        chord = end.point - here[0]
        for fraction in (1.0 / 3.0, 2.0 / 3.0):
            point, uv_a, uv_b = (
                (1.0 - fraction) * x + fraction * y
                for x, y in zip(here, (end.point, end.uv_a, end.uv_b))
            )
            found = pulled_into_contact(
                self.a, self.b, uv_a[None], uv_b[None],
                (chord / norm(chord))[None], point[None],
            )  # fmt: skip
            made.append((found.point[0], found.uv_a[0], found.uv_b[0]))
        return made


def _is_ahead(step: np.ndarray, led: np.ndarray) -> bool:
    """Is a step in (u, v) the one that the way in space leads along, not one over a seam?"""
    return bool(norm(step - led) <= ALIKE * max(norm(step), 1e-300))
