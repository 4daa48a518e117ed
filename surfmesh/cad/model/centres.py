"""Centres of faces, edges and solids of a plain model, and samples inside faces.

A face is integrated by Green's theorem: along its loops runs the integral of |r_u x r_v| in u,
from the left side of the (u, v) box, by Gauss's rule.

    v |    ,-----.         for each step of the boundary, from (u, v) to (u + du, v + dv):
      |---/       \\            dA = dv * int_{u0}^{u} |r_u x r_v| du
      |  |<------- |
      |   `-------'
      +------------- u
"""

from __future__ import annotations

from functools import cache

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadModel, CadSolid
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.quadrature import gauss_rule
from surfmesh.geometry.small_matrices import product

STRAIGHT, CURVED = 2, 65
"""Samples along edges."""

POINTS, PANELS, ALONG = 12, 2, 8
"""Of Gauss's rule, for each of PANELS across a face and of ALONG along its edges."""


def boundary_polygons(face: CadFace) -> list[np.ndarray]:
    """The loops of a face as polygons (k, 2) in (u, v), not closed."""
    found = []
    for loop in face.loops:
        parts = []
        for coedge in loop:
            straight = coedge.is_straight
            fraction = np.linspace(0.0, 1.0, STRAIGHT if straight else CURVED)
            parts.append(coedge.walk(fraction)[:-1])
        found.append(np.concatenate(parts))
    return found


def face_centre(face: CadFace) -> np.ndarray:
    """Centre of mass (3,) of a face."""
    total, moment = 0.0, np.zeros(3)
    for coedge in face.coedges:
        weight, point, r_u, r_v = _across(face, coedge)
        weight = weight * np.linalg.norm(np.cross(r_u, r_v), axis=1)
        total += weight.sum()
        moment += product(weight, point)
    if abs(total) > 0.0:
        return moment / total
    (points,) = face.surface.evaluate(np.concatenate(boundary_polygons(face)), 0)
    return points.mean(axis=0)


def face_area(face: CadFace) -> float:
    """Area of a face, on both sides of places where r_u x r_v vanishes."""
    total = 0.0
    for coedge in face.coedges:
        weight, _, r_u, r_v = _across(face, coedge, ALONG)
        total += float(product(weight, np.linalg.norm(np.cross(r_u, r_v), axis=1)))
    return abs(total)


def _across(face: CadFace, coedge: CadCoedge, along_straight: int = 1) -> tuple[np.ndarray, ...]:
    """Weights (n,) in (u, v), points, r_u and r_v (n, 3) between the left side and a coedge."""
    straight = coedge.is_straight
    along, w_along = gauss_rule(0.0, 1.0, along_straight if straight else ALONG, POINTS)
    t, w = gauss_rule(0.0, 1.0, PANELS, POINTS)
    uv, speed = coedge.pcurve.evaluate(coedge.p0 + along * (coedge.p1 - coedge.p0), 1)
    dv = speed[:, 1] * (coedge.p1 - coedge.p0) * (-w_along if coedge.reversed else w_along)
    (u0, _), _ = face.surface.domain
    u, v = uv.T
    places = np.stack(np.broadcast_arrays(u0 + t * (u - u0)[:, None], v[:, None]), axis=-1)
    point, r_u, r_v = face.surface.evaluate(places.reshape(-1, 2), 1)
    return ((dv * (u - u0))[:, None] * w).ravel(), point, r_u, r_v


def edge_centre(edge: CadEdge) -> np.ndarray:
    """Centre of mass (3,) of an edge that is not degenerate."""
    t, w = gauss_rule(0.0, 1.0, ALONG, POINTS)
    points, speed = edge.evaluate(t, 1)
    w = w * np.linalg.norm(speed, axis=1)
    return product(w, points) / w.sum() if w.sum() > 0.0 else points.mean(axis=0)


def solid_centre(model: CadModel, solid: CadSolid) -> np.ndarray:
    """Centre of mass (3,) of the volume, by the divergence theorem over its faces."""
    total, moment = 0.0, np.zeros(3)
    for shell in solid.shells:
        for number, against in shell:
            face = model.faces[number]
            sign = -1.0 if against != face.reversed else 1.0
            for coedge in face.coedges:
                weight, point, r_u, r_v = _across(face, coedge)
                normal = np.cross(r_u, r_v)
                total += sign * float(product(weight, np.einsum("ij,ij->i", point, normal))) / 3.0
                moment += sign * (product(weight, 0.5 * point**2 * normal))
    return moment / total if total else moment


@cache
def cell_centres(count: int) -> np.ndarray:
    """Centres (n, 2) of count x count cells of the unit square, row after row; not to be written
    to."""
    at = (np.arange(count) + 0.5) / count
    found = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)
    found.flags.writeable = False
    return found


def inner_samples(face: CadFace, count: int) -> np.ndarray:
    """uv (n, 2) of about count x count points of a grid that lie in the face."""
    low, high = np.array(face.surface.domain).T
    grid = low + cell_centres(count) * (high - low)
    return grid[is_inside(boundary_polygons(face), grid)]
