"""How deep two solids that overlap go into each other: measured at their vertices.

vertices of one in the box of the other -> those inside it -> the farthest from its triangles
                                                              (most may only be as far as the
                                                               nearest vertex of it: deepest first)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import PointTree, triangle_distances
from surfmesh.quality.measures.inside import inside
from surfmesh.quality.measures.solids import bounds_solid
from surfmesh.result.surface_mesh import SurfaceMesh

MEASURED = 64  # vertices, of those that may be deepest


class OverlapDepth(NamedTuple):
    """Of the deepest vertex of either of two solids within the other."""

    depth: float  # 0 where none of either lies within the other
    point: NDArray[np.float64]


def overlap_depth(mesh: SurfaceMesh, solids: tuple[int, int]) -> OverlapDepth:
    """At least so deep do they overlap, to within the distance of facets from their faces."""
    best = OverlapDepth(0.0, np.full(3, np.nan))
    triangles = [mesh.triangles[bounds_solid(mesh, solid)] for solid in solids]
    for own, other in (triangles, triangles[::-1]):
        best = max(best, _deepest(mesh.points, own, other), key=lambda found: found.depth)
    return best


def _deepest(
    points: NDArray[np.float64], own: NDArray[np.int32], other: NDArray[np.int32]
) -> OverlapDepth:
    """Of the vertices of triangles ``own`` (m, 3), within those of ``other``."""
    corners = points[other]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    places = points[np.unique(own)]
    places = places[((places > low) & (places < high)).all(axis=1)]
    places = places[inside(places, corners)]
    best = OverlapDepth(0.0, np.full(3, np.nan))
    if not len(places):
        return best
    most = PointTree(points[np.unique(other)]).nearest(places, 1)[0][:, 0]
    for k in np.argsort(-most, kind="stable")[:MEASURED].tolist():
        if most[k] <= best.depth:
            break
        depth = float(triangle_distances(places[k : k + 1], corners).min())
        if depth > best.depth:
            best = OverlapDepth(depth, places[k])
    return best
