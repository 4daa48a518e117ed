"""How deep the corners of facets lie within the true body of other facets that they meet.

Corners lie on the true faces of their own body. Where one lies over a triangle of the other body
that faces it, its distance from the true face there says what facets cannot: whether the bodies
touch, overlap by less than the chord, or lie apart and only their facets meet.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import PointTree
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.small_matrices import norm
from surfmesh.quality.measures.known_surfaces import KnownSurfaces, Rows
from surfmesh.quality.measures.penetration import plane_weights
from surfmesh.quality.measures.solids import bounds_solid, solids_beside
from surfmesh.result.surface_mesh import SurfaceMesh

PROBES, NEAREST = 400, 8  # points of a solid's faces, and triangles of the other beside each
MOST = 3000  # pairs of triangles of two bodies that are looked at
STEPS = 8  # of the projection
OVER = -1e-6  # least barycentric weight of what lies over a triangle
FACING = -0.7  # cosine between outward normals of facets of one contact
UPRIGHT = 0.1  # of the distance: a foot may lie so much to the side of its point


class TrueDepth(NamedTuple):
    """Of two bodies; depths are negative where they lie apart."""

    depth: float  # the largest; minus infinity where no corner lies over the other body
    point: NDArray[np.float64]  # where that is
    deviation: float  # of that corner from its own face


NOWHERE = TrueDepth(-np.inf, np.full(3, np.nan), 0.0)


def true_depth(
    known: KnownSurfaces, pairs: NDArray[np.int32], bodies: NDArray[np.int64],
    limit: NDArray[np.float64],
) -> TrueDepth:  # fmt: skip
    """pairs: (k, 2) triangles of two solids that meet; bodies: (k, 2) the solids; limit: (k,) as
    deep as their facets may lie within each other: what lies farther away is another face's."""
    mesh, behind = known.mesh, solids_beside(known.mesh)[:, 0]
    outward = np.where(behind[pairs] == bodies, 1.0, -1.0)
    facing = np.flatnonzero(outward.prod(axis=1) * _cosines(mesh, pairs) < FACING)
    kept = facing[:: max(-(-len(facing) // MOST), 1)]
    pairs, outward, limit = pairs[kept], outward[kept], limit[kept]
    best = NOWHERE
    for own in (0, 1):
        triangles, base = np.repeat(pairs[:, own], 3), np.repeat(pairs[:, 1 - own], 3)
        corner = np.tile([0, 1, 2], len(pairs))
        points = mesh.points[mesh.triangles[triangles, corner]]
        uv = known.corners.uv_points[known.corners.uv_triangles[triangles, corner]]
        looked = _Looked(
            points, triangles, uv, base, np.repeat(outward[:, 1 - own], 3), np.repeat(limit, 3)
        )
        found = _deepest(known, looked)
        best = max(best, found, key=lambda one: one.depth)
    return best


def true_depth_of_faces(
    known: KnownSurfaces, solids: tuple[int, int], allowed: NDArray[np.float64], least: float
) -> TrueDepth:
    """The same from points of the faces amid triangles, of two solids that are known to touch.

    allowed: (m,) as deep as facets may lie within others.
    """
    mesh, beside = known.mesh, solids_beside(known.mesh)
    rows = [np.flatnonzero(bounds_solid(mesh, solid)) for solid in solids]
    middles = [mesh.points[mesh.triangles[own]].mean(axis=1) for own in rows]
    best = NOWHERE
    for k in (0, 1):
        tree = PointTree(middles[1 - k])
        low, high = (bound(middles[1 - k], axis=0) for bound in (np.min, np.max))
        margin = float((high - low).max()) / 2.0  # triangles of the other may be large
        near = ((middles[k] >= low - margin) & (middles[k] <= high + margin)).all(axis=1)
        own = rows[k][near][:: max(int(near.sum()) // PROBES, 1)]
        if not len(own):
            continue
        count = min(NEAREST, len(rows[1 - k]))
        _, place = tree.nearest(mesh.points[mesh.triangles[own]].mean(axis=1), count)
        base = rows[1 - k][place].ravel()
        own = np.repeat(own, count)
        outward = [
            np.where(beside[t, 0] == solids[i], 1.0, -1.0) for t, i in ((own, k), (base, 1 - k))
        ]
        pairs = np.stack([own, base], axis=1)
        facing = outward[0] * outward[1] * _cosines(mesh, pairs) < FACING
        own, base, outwards = own[facing], base[facing], outward[1][facing]
        uv = known.middle_uv(own)
        points = known.points_at(mesh.face_ids[own], uv)
        limit = allowed[own] + allowed[base] + least
        found = _deepest(known, _Looked(points, own, uv, base, outwards, limit))
        best = max(best, found, key=lambda one: one.depth)
    return best


class _Looked(NamedTuple):
    """Points on faces of one body, and triangles of the other that they may lie over."""

    points: NDArray[np.float64]  # (k, 3)
    triangles: Rows  # (k,) their own
    uv: NDArray[np.float64]  # (k, 2) on the faces of these
    base: Rows  # (k,) triangles of the other body
    outward: NDArray[np.float64]  # (k,) 1 where that body lies behind them, else -1
    limit: NDArray[np.float64]  # (k,) what lies farther away is another face's

    def chosen(self, rows: NDArray[np.intp]) -> "_Looked":
        return _Looked(
            self.points[rows], self.triangles[rows], self.uv[rows], self.base[rows],
            self.outward[rows], self.limit[rows],
        )  # fmt: skip


def _deepest(known: KnownSurfaces, looked: _Looked) -> TrueDepth:
    """The deepest of points that lie over triangles ``base`` (k,), face after face."""
    mesh, best = known.mesh, NOWHERE
    faces = mesh.face_ids[looked.base]
    for face in np.unique(faces).tolist():
        here = looked.chosen(np.flatnonzero(faces == face))
        depth, over = _over_face(known, face, here)
        if not over.any():
            continue
        worst = int(np.flatnonzero(over)[int(np.argmax(depth[over]))])
        if depth[worst] > best.depth:
            own = mesh.surfaces[int(mesh.face_ids[here.triangles[worst]])]
            (image,) = own.evaluate(here.uv[worst][None], 0)
            deviation = norm(image[0] - here.points[worst])
            best = TrueDepth(float(depth[worst]), here.points[worst], deviation)
    return best


def _cosines(mesh: SurfaceMesh, pairs: NDArray[np.int32]) -> NDArray[np.float64]:
    """(k,) between the normals of two triangles."""
    corners = mesh.points[mesh.triangles[pairs]]
    normal = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    size = np.linalg.norm(normal, axis=2).prod(axis=1)
    along = np.einsum("ij,ij->i", normal[:, 0], normal[:, 1])
    return along / np.maximum(size, np.finfo(float).tiny)


def _over_face(
    known: KnownSurfaces, face: int, looked: _Looked
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """How deep the points lie below one face, and which of them lie over triangles of it."""
    mesh, surface = known.mesh, known.mesh.surfaces[face]
    corners = known.uv(looked.base)
    foot_uv, distance, foot = closest_point(surface, looked.points, corners.mean(axis=1), STEPS)
    _, along_u, along_v = surface.evaluate(foot_uv, 1)
    normal = np.cross(along_u, along_v)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    turned = mesh.turned_faces is not None and bool(mesh.turned_faces[face])
    normal *= ((-1.0 if turned else 1.0) * looked.outward)[:, None]
    depth = -np.einsum("ij,ij->i", looked.points - foot, normal)
    over = (distance <= looked.limit) & (plane_weights(foot_uv, corners).min(axis=1) >= OVER)
    over &= distance - np.abs(depth) <= UPRIGHT * distance + np.finfo(float).eps
    return depth, over
