"""Edge lengths against the target sizes, and how fast they change from edge to edge."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import EdgeFigures, JoinedTriangles
from surfmesh.quality.measures.joined import joined_triangles
from surfmesh.quality.measures.places import Point, as_point, middles
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.metric_roots import unpacked

QUASI_UNIT = (0.5**0.5, 2.0**0.5)  # metric lengths that conform to the target sizes
GROWTH_SLACK = 0.1  # relative: sizes are interpolated between the nodes of the field, and grow with
# the distance on the surface, which is longer than the edge


def edge_figures(
    mesh: SurfaceMesh, joined: JoinedTriangles | None = None, slope: float = 0.0
) -> EdgeFigures:
    """Lengths of the edges, and over the target sizes where there are any.

    In the metric: of pq over the mean of the target sizes at p and q; where these depend on the
    direction, of those in the direction of pq. joined: the mesh, where it is at hand. slope: what
    sizes may differ by along an edge, over its length; 0: not asked.
    """
    corners, roots = mesh.parametrisation, mesh.metric_root_3d
    return (joined or joined_triangles(mesh)).edge_figures(
        mesh.sizes, roots, None if roots is None or corners is None else corners.uv_triangles,
        slope, 1.0 + GROWTH_SLACK,
    )  # fmt: skip


def stretched(
    metric_root_3d: NDArray[np.float64], step: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Steps (k, 3) in target sizes: W d, for W (k, 6)."""
    return np.einsum("kij,kj->ki", unpacked(metric_root_3d), step)


class SizeGrowth(NamedTuple):
    """By how much the target sizes at the two ends of an edge differ, over what is allowed."""

    fraction: float  # of the edges, those along which it is more than a tenth above that
    largest: float  # 1 is allowed
    point: Point  # middle of that edge


def size_growth(mesh: SurfaceMesh, edges: EdgeFigures) -> SizeGrowth | None:
    """Growth of the target sizes over the edges of the mesh, in any direction.

    Along an edge of length l sizes may differ by ``slope`` l. Where they depend on the direction
    those along the edge are compared. None where it was not asked for, without sizes or edges of
    a length.
    """
    steepest, largest, above = edges.changes
    if steepest < 0:
        return None
    place = middles(mesh.points[mesh.edges[steepest]])
    return SizeGrowth(above / len(mesh.edges), largest, as_point(place))
