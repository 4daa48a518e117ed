"""A traced branch as splines: a curve in space and one in the (u, v) of either face.

All three have one parameter, the length along the curve: points at equal lengths are pulled onto
both surfaces, splines of degree 5 go through them, and there are twice as many until the splines
keep to each other everywhere between.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.interpolating_spline import interpolating_spline
from surfmesh.geometry.quadrature import unit_rule
from surfmesh.geometry.small_matrices import product
from surfmesh.intersection.contact_curves import pulled_into_contact
from surfmesh.intersection.newton import pulled_onto_both
from surfmesh.intersection.tracing import Trace, place

DEGREE = 5
COUNTS = (16, 32, 64, 128, 256, 512, 1024, 2048)
"""Spans, the first that are enough."""

NEAR = 1e-10
"""Of the diagonal: how far the curve may be off either surface."""

LOOSEST = 1e-6
"""Of the diagonal: a curve that cannot be followed so closely is refused. Those of splines whose
second derivative jumps are followed less closely than others; the edge's tolerance says so."""

BETWEEN = np.array([0.113, 0.31, 0.5, 0.69, 0.887])
"""Of a span: where splines are compared with the surfaces."""

GAUSS, WEIGHTS = unit_rule(4)


class FittedCurve(NamedTuple):
    """curve: in space; pcurve_a, pcurve_b: in (u, v); all over 0 to length. deviation: how far
    these are apart in space, at most."""

    curve: BSplineCurve
    pcurve_a: BSplineCurve
    pcurve_b: BSplineCurve
    length: float
    deviation: float


def fitted(trace: Trace, a: FaceSurface, b: FaceSurface, size: float) -> FittedCurve:
    """Splines along a trace. size: the diagonal. Raises ``SurfaceError`` where none keeps near."""
    chord = np.linalg.norm(np.diff(trace.points, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(chord)])
    columns = np.hstack([trace.points, trace.uv_a, trace.uv_b])
    spline = _through(s, columns, trace.closed)
    best: FittedCurve | None = None
    for count in COUNTS:
        s, columns = _evenly(spline, s[-1], columns[[0, -1]], count, a, b, trace.touches)
        spline = _through(s, columns, trace.closed)
        made = _measured(spline, s, a, b, trace.closed)
        if best is None or made.deviation < best.deviation:
            best = made
        if made.deviation <= NEAR * size and len(s) > count // 2 + 1 and count > COUNTS[0]:
            return made
    assert best is not None  # noqa: S101
    if best.deviation <= LOOSEST * size:
        return best
    raise SurfaceError(
        f"{a.name} and {b.name}: no spline follows their common curve near "
        f"{place(trace.points[len(trace.points) // 2])}, the best is {best.deviation:.2g} off: "
        "a parametrisation has no speed there, or bends sharply"
    )


def _through(s: np.ndarray, columns: np.ndarray, closed: bool):
    degree = min(DEGREE, len(s) - 1)
    degree -= degree % 2 == 0
    if not closed:
        return interpolating_spline(s, columns, degree)
    # a closed curve goes on smoothly: some points beyond both ends
    more = min(8, len(s) - 1)
    before, after = columns[-1 - more : -1], columns[1 : more + 1]
    around = np.concatenate([before, columns, after])
    length = s[-1]
    places = np.concatenate([s[-1 - more : -1] - length, s, s[1 : more + 1] + length])
    return interpolating_spline(places, around, degree)


def _evenly(
    spline, length: float, ends: np.ndarray, count: int, a: FaceSurface, b: FaceSurface,
    touches: bool,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Points at equal lengths along a spline (count + 1,), pulled onto both surfaces; the lengths
    from the start."""
    knots = np.linspace(0.0, length, 4 * count + 1)
    half = 0.5 * np.diff(knots)
    at = 0.5 * (knots[1:] + knots[:-1])[:, None] + half[:, None] * GAUSS
    speed = np.linalg.norm(spline(at.ravel(), 1)[:, :3], axis=1).reshape(at.shape)
    s = np.concatenate([[0.0], np.cumsum(half * product(speed, WEIGHTS))])
    t = np.interp(np.linspace(0.0, s[-1], count + 1), s, knots)
    for _ in range(3):  # to the equal lengths within rounding of the quadrature
        t = np.clip(t, 0.0, length)
        k = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)
        part = 0.5 * (t - knots[k])
        inner = knots[k][:, None] + part[:, None] * (1.0 + GAUSS)
        rate = np.linalg.norm(spline(inner.ravel(), 1)[:, :3], axis=1).reshape(inner.shape)
        reached = s[k] + part * product(rate, WEIGHTS)
        here = np.linalg.norm(spline(t, 1)[:, :3], axis=1)
        t = t - (reached - np.linspace(0.0, s[-1], count + 1)) / here
    t[0], t[-1] = 0.0, length
    guess, way = spline(t), spline(t, 1)[:, :3]
    way /= np.linalg.norm(way, axis=1)[:, None]
    pulled = pulled_into_contact if touches else pulled_onto_both
    found = pulled(a, b, guess[:, 3:5], guess[:, 5:7], way, guess[:, :3])
    columns = np.hstack([found.point, found.uv_a, found.uv_b])
    columns[[0, -1]] = ends
    return np.linspace(0.0, s[-1], count + 1), columns


def _measured(spline, s: np.ndarray, a: FaceSurface, b: FaceSurface, closed: bool) -> FittedCurve:
    """The splines in the form of the model, and how far they are off both surfaces."""
    step = np.diff(s)
    at = (s[:-1, None] + BETWEEN * step[:, None]).ravel()
    values = spline(at)
    off = [
        surface.evaluate(values[:, k : k + 2], 0)[0] - values[:, :3]
        for surface, k in ((a, 3), (b, 5))
    ]
    deviation = max(float(np.linalg.norm(step, axis=1).max()) for step in off)
    knots, control = spline.t, spline.c
    parts = [BSplineCurve(knots, control[:, k]) for k in (slice(0, 3), slice(3, 5), slice(5, 7))]
    return FittedCurve(parts[0], parts[1], parts[2], float(s[-1]), deviation)
