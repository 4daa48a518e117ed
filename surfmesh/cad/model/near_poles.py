"""Images that end at a pole which is only nearly a point: there they keep their direction.

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
            piece = replace(face, surface=surface, loops=tuple(loops))
            faces[number] = replace(piece, area=face_area(piece))
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
    width = np.array([u1 - u0, v1 - v0])
    box = np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]])
    (corners,) = face.surface.evaluate(box, 0)
    size = diagonal(corners)
    (side,) = face.surface.evaluate(coedges[at].uv(FRACTIONS), 0)
    extent = diagonal(side)
    if not NOISE * size < extent < LARGEST * size:
        return False
    ends = []
    for place, last in ((before, True), (after, False)):
        fraction = np.linspace(0.0, 1.0, SAMPLES)
        coedge = coedges[place]
        edge = edges[coedge.edge]
        points = edge.evaluate(fraction, 0)[0]
        uv = closest_point(face.surface, points, coedge.uv(fraction), STEPS, margin=0.0)[0]
        at_end = last != coedge.reversed  # of the edge's range: its end lies in the pole
        near = np.linalg.norm(points - pole, axis=1) < ZONE * extent
        zone = np.flatnonzero(near)
        edge_of_zone = zone.min() if at_end else zone.max()
        if near.all():
            return False
        swing = np.ptp(uv[zone], axis=0) / width
        across = int(np.argmax(swing))
        if swing[across] < SWING:
            ends.append((place, coedge, coedge.walk(np.array([1.0 if last else 0.0]))[0], False))
            continue
        uv[zone, across] = uv[edge_of_zone, across]
        parameters = coedge.p0 + fraction * (coedge.p1 - coedge.p0)
        order = slice(None) if parameters[-1] > parameters[0] else slice(None, None, -1)
        better = replace(coedge, pcurve=_polyline(parameters[order], uv[order]))
        ends.append((place, better, better.walk(np.array([1.0 if last else 0.0]))[0], True))
    if not any(swings for *_, swings in ends):
        return False
    for place, coedge, _, _ in ends:
        coedges[place] = coedge
    first, last = ends[0][2], ends[1][2]
    step = last - first
    length = norm(step)
    line = Line(first, step / max(length, np.finfo(float).tiny))
    coedges[at] = replace(coedges[at], reversed=False, pcurve=line, p0=0.0, p1=length)
    return True


def _polyline(parameters: np.ndarray, uv: np.ndarray) -> BSplineCurve:
    """Straight from point to point: uv (n, 2) at rising parameters (n,)."""
    return BSplineCurve(np.concatenate([parameters[:1], parameters, parameters[-1:]]), uv)
