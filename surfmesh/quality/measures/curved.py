"""Quadratic triangles: their area, volume, Jacobian, and distance from the surface, both ways.

The nearest points of the surface to the points of a triangle that lies over it one to one are all
of the surface there: what the mesh is farther from the surface than, that is the surface no farther
from the mesh. So both ways are one figure; rims are looked at as curves.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.differential.projection import closest_point
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import as_point, as_uv
from surfmesh.quality.measures.surface_to_mesh import SurfaceDeviation
from surfmesh.result.curved_fit import curved_fit
from surfmesh.result.quadratic_triangles import derivatives, least_jacobians
from surfmesh.result.surface_mesh import SurfaceMesh

_A, _B = (6.0 - 15.0**0.5) / 21.0, (6.0 + 15.0**0.5) / 21.0
RULE = np.array(
    [
        (1 / 3, 1 / 3, 1 / 3),
        *((1 - 2 * x, x, x) for x in (_A, _B)),
        *((x, 1 - 2 * x, x) for x in (_A, _B)),
        *((x, x, 1 - 2 * x) for x in (_A, _B)),
    ]
)
WEIGHTS = np.array([9 / 40, *3 * [(155 - 15.0**0.5) / 1200, (155 + 15.0**0.5) / 1200]])
"""Seven points that integrate polynomials of degree 5 over a triangle: volumes exactly.
Source: Radon 1948; Zienkiewicz & Taylor, The Finite Element Method."""
CENTRE = np.full((1, 3), 1.0 / 3.0)
STEPS = 8  # of the search for the surface's normal at a centre


class CurvedShapes(NamedTuple):
    """One value for each of m quadratic triangles, in powers of model units."""

    area: NDArray[np.float64]
    volume: NDArray[np.float64]  # between it and the straight triangle: see ``_volumes``
    jacobian: NDArray[np.float64]  # no less is its Jacobian over that of the straight triangle


def curved_shapes(mesh: SurfaceMesh) -> CurvedShapes:
    """Of a mesh of second order."""
    nodes = mesh.nodes[mesh.elements] - mesh.points.mean(axis=0)
    along_s, along_t, points = derivatives(nodes, RULE)
    normal = np.cross(along_s, along_t)
    area = 0.5 * np.einsum("q,mq->m", WEIGHTS, np.linalg.norm(normal, axis=2))
    volume = np.einsum("q,mqd,mqd->m", WEIGHTS, points, normal) / 6.0
    a, b, c = nodes[:, :3].transpose(1, 0, 2)
    volume -= np.einsum("md,md->m", a, np.cross(b, c)) / 6.0
    return CurvedShapes(area, volume, least_jacobians(mesh.nodes, mesh.elements))


def curved_deviation(known: KnownSurfaces, area: NDArray[np.float64]) -> Deviation:
    """As ``deviation``, of curved triangles with areas (m,), each looked at densely."""
    mesh = known.mesh
    chord = (mesh.sizing and mesh.sizing.chord) or np.inf
    fit = curved_fit(mesh, chord)
    total = float(area.sum())
    rms = (float((area * fit.mean_square).sum()) / total) ** 0.5 if total > 0 else float("nan")
    top = int(fit.largest.argmax())
    cosine = _cosines(known)
    if mesh.turned_faces is not None:
        cosine[mesh.turned_faces[mesh.face_ids]] *= -1.0
    return Deviation(
        fit.largest, fit.mean_square, cosine, float(fit.largest[top]), rms, top,
        as_point(fit.point[top]), as_uv(fit.uv[top]),
    )  # fmt: skip


def curved_surface_deviation(known: KnownSurfaces, fit: Deviation) -> SurfaceDeviation:
    """The other way: see above."""
    face, uv = int(known.mesh.face_ids[fit.triangle]), np.array([fit.uv])
    (foot,) = known.mesh.surfaces[face].evaluate(uv, 0)
    return SurfaceDeviation(
        fit.by_triangle.copy(), fit.largest, as_point(foot[0]), fit.uv, fit.triangle, False
    )


def _cosines(known: KnownSurfaces) -> NDArray[np.float32]:
    """(m,) of the angles between the normals of triangles and surfaces at their centres; 1 where
    either is missing."""
    mesh = known.mesh
    along_s, along_t, points = derivatives(mesh.nodes[mesh.elements], CENTRE)
    own = np.cross(along_s, along_t)[:, 0]
    uv = known.uv(np.arange(len(own), dtype=np.int32)).mean(axis=1)
    found = np.ones(len(own), np.float32)
    for face in np.unique(mesh.face_ids).tolist():
        rows = np.flatnonzero(mesh.face_ids == face)
        surface = mesh.surfaces[face]
        foot, _, _ = closest_point(surface, points[rows, 0], uv[rows], STEPS)
        _, ru, rv = surface.evaluate(foot, 1)
        normal = np.cross(ru, rv)
        size = np.linalg.norm(normal, axis=1) * np.linalg.norm(own[rows], axis=1)
        dot = np.einsum("ij,ij->i", normal, own[rows])
        found[rows] = np.where(size > 0.0, dot / np.where(size > 0.0, size, 1.0), 1.0)
    return found
