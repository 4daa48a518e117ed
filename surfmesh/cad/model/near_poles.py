"""P-curves that end at a pole which is only nearly a point: there they keep their direction.

v |   \\_____/            A row of control points a hair apart is a side of the face in (u, v)
  |  .'     '.           and a point for its edges. The foot of an edge's end lies anywhere
  | /         \\          on that side, so p-curves that follow their edges to the last bit
  +------------- u       swing across it, and cross each other.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadVertex
from surfmesh.cad.model.centres import face_area
from surfmesh.cad.model.invariants import FRACTIONS, NOISE
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.cad_surfaces.curves import Line
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.small_matrices import norm

ZONE = 30.0  # times the extent of the side: nearer to the pole a p-curve is not believed
SWING = 0.02  # of the face's box: less is no swing
LARGEST = 0.01  # of the face's size: a longer side is no pole
SAMPLES, STEPS = 513, 8  # of a p-curve, and steps to the nearest points of the surface


def pcurves_at_near_poles(
    edges: list[CadEdge], vertices: list[CadVertex], faces: list[CadFace]
) -> list[str]:
    """Straighten, in place, the p-curves beside degenerate edges that are not quite a point."""
    changed = []
    for number, face in enumerate(faces):
        loops, found = [], False
        for loop in face.loops:
            coedges = list(loop)
            for at, coedge in enumerate(loop):
                if edges[coedge.edge].degenerate and len(loop) > 2:
                    found |= _straightened(face, coedges, at, edges, vertices)
            loops.append(tuple(coedges))
        if found:
            uv = np.concatenate([coedge.uv(FRACTIONS) for loop in loops for coedge in loop])
            (u0, v0), (u1, v1) = uv.min(axis=0).tolist(), uv.max(axis=0).tolist()
            surface = face.surface.with_domain(((u0, u1), (v0, v1)))
            changed_face = replace(face, surface=surface, loops=tuple(loops))
            faces[number] = replace(changed_face, area=face_area(changed_face))
            changed.append(str(number))
    if not changed:
        return []
    return [
        f"face{'s' * (len(changed) > 1)} {', '.join(changed)}: a pole is only nearly a point; the "
        "p-curves of its edges are made straight there"
    ]


def _straightened(
    face: CadFace, coedges: list[CadCoedge], at: int, edges: list[CadEdge],
    vertices: list[CadVertex],
) -> bool:  # fmt: skip
    """Change the coedges beside the degenerate one, in place; whether any swings there."""
    before, after = (at - 1) % len(coedges), (at + 1) % len(coedges)
    if edges[coedges[before].edge].degenerate or edges[coedges[after].edge].degenerate:
        return False
    pole = vertices[edges[coedges[at].edge].start].point
    (u0, u1), (v0, v1) = face.surface.domain
    box = np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]])
    (corners,) = face.surface.evaluate(box, 0)
    size = diagonal(corners)
    (side,) = face.surface.evaluate(coedges[at].uv(FRACTIONS), 0)
    extent = diagonal(side)
    if not NOISE * size < extent < LARGEST * size:
        return False
    ends = []
    for place, last in ((before, True), (after, False)):
        end = _end_at_pole(face, coedges[place], edges[coedges[place].edge], pole, extent, last)
        if end is None:
            return False
        ends.append((place, *end))
    if not any(swings for *_, swings in ends):
        return False
    for place, coedge, _, _ in ends:
        coedges[place] = coedge
    first = ends[0][2]
    step = ends[1][2] - first
    length = norm(step)
    line = Line(first, step / max(length, np.finfo(float).tiny))
    coedges[at] = replace(coedges[at], reversed=False, pcurve=line, p0=0.0, p1=length)
    return True


def _end_at_pole(
    face: CadFace, coedge: CadCoedge, edge: CadEdge, pole: np.ndarray, extent: float, last: bool
) -> tuple[CadCoedge, np.ndarray, bool] | None:
    """A coedge that ends at a pole whose side is ``extent`` long, straight in the zone around it.

    last: its walk ends there, and does not begin. Returns the coedge, as it was if it does not
    swing there; its end (2,) in (u, v); and whether it swings. None: all of it is in the zone.
    """
    (u0, u1), (v0, v1) = face.surface.domain
    at_pole = np.array([1.0 if last else 0.0])
    fraction = np.linspace(0.0, 1.0, SAMPLES)
    points = edge.evaluate(fraction, 0)[0]
    uv = closest_point(face.surface, points, coedge.uv(fraction), STEPS, margin=0.0)[0]
    at_end = last != coedge.reversed  # of the edge's range: its end lies in the pole
    near = np.linalg.norm(points - pole, axis=1) < ZONE * extent
    if near.all():
        return None
    zone = np.flatnonzero(near)
    swing = np.ptp(uv[zone], axis=0) / np.array([u1 - u0, v1 - v0])
    across = int(np.argmax(swing))
    if swing[across] < SWING:
        return coedge, coedge.walk(at_pole)[0], False
    uv[zone, across] = uv[zone.min() if at_end else zone.max(), across]
    parameters = coedge.p0 + fraction * (coedge.p1 - coedge.p0)
    order = slice(None) if parameters[-1] > parameters[0] else slice(None, None, -1)
    better = replace(coedge, pcurve=_polyline(parameters[order], uv[order]))
    return better, better.walk(at_pole)[0], True


def _polyline(parameters: np.ndarray, uv: np.ndarray) -> BSplineCurve:
    """Straight from point to point: uv (n, 2) at rising parameters (n,)."""
    return BSplineCurve(np.concatenate([parameters[:1], parameters, parameters[-1:]]), uv)
