"""Edge lengths against the target sizes, and how fast they change from edge to edge."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.metric_roots import unpacked

QUASI_UNIT = (0.5**0.5, 2.0**0.5)  # metric lengths that conform to the target sizes
GROWTH_SLACK = 0.1  # relative: sizes are interpolated between the nodes of the field, and grow with
# the distance on the surface, which is longer than the edge
BLOCK = 1 << 15  # edges looked at together, to stay within the cache


def edge_lengths(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """(ne,) length of every edge of ``mesh.edges`` in model units."""
    return quality.edge_lengths(mesh.points, mesh.edges)


class EdgeSizes(NamedTuple):
    """Of the target sizes at both ends of each edge."""

    mean: NDArray[np.float64]  # (ne,)
    apart: NDArray[np.float64]  # (ne,) by how much they differ


def edge_sizes(mesh: SurfaceMesh) -> EdgeSizes | None:
    """None where there are none."""
    return None if mesh.sizes is None else EdgeSizes(*quality.edge_sizes(mesh.edges, mesh.sizes))


def metric_lengths(
    mesh: SurfaceMesh, lengths: NDArray[np.float64], sizes: EdgeSizes | None
) -> NDArray[np.float64] | None:
    """(ne,) length of pq over the mean of the target sizes at p and q; None where there are none.

    Where sizes are anisotropic, of those in the direction of pq.
    """
    corners = mesh.parametrisation
    if sizes is None:
        return None
    root = None if corners is None else corners.metric_root_3d
    if root is None or corners is None:
        return lengths / sizes.mean
    metric = np.empty(len(lengths))
    for begin in range(0, len(lengths), BLOCK):
        block = slice(begin, begin + BLOCK)
        first, second = _stretched_at_ends(mesh, root, corners.uv_triangles, block)
        total = first + second
        metric[block] = 2.0 * first * second / np.where(total > 0.0, total, 1.0)
    return metric


def _stretched_at_ends(
    mesh: SurfaceMesh, root: NDArray[np.float64], uv_triangles: NDArray[np.int32], block: slice
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lengths (k,) of edges in the metrics at either end, as one of their faces has them."""
    a, b = mesh.edges[block].T
    corners = uv_triangles.ravel()
    step = mesh.points[b] - mesh.points[a]
    start = mesh.connectivity.half_edges[block, 0]
    end = np.where(start % 3 == 2, start - 2, start + 1)
    first, second = (
        np.linalg.norm(stretched(root[corners[e]], step), axis=1) for e in (start, end)
    )
    return first, second


def stretched(
    metric_root_3d: NDArray[np.float64], step: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Steps (k, 3) in target sizes: W d, for W (k, 6)."""
    return np.einsum("kij,kj->ki", unpacked(metric_root_3d), step)


class Growth(NamedTuple):
    """Longest over shortest edge at a vertex: 1 when all edges there are equally long."""

    largest: float
    p99: float  # 99 of 100 vertices are below


def growth(mesh: SurfaceMesh, lengths: NDArray[np.float64]) -> Growth:
    """Ratio of the lengths of edges that share a vertex."""
    longest, shortest = quality.edge_extremes(mesh.edges, lengths, len(mesh.points))
    used = (shortest > 0) & (longest < np.inf)  # no edge, no finite length
    used &= longest > 0
    if not used.any():
        return Growth(float("nan"), float("nan"))
    ratio = longest[used] / shortest[used]
    return Growth(float(ratio.max()), quality.quantile(ratio, 0.99))


class SizeGrowth(NamedTuple):
    """By how much the target sizes at the two ends of an edge differ, over what is allowed."""

    fraction: float  # of the edges, those along which it is more than a tenth above that
    largest: float  # 1 is allowed
    point: Point  # middle of that edge


def size_growth(
    mesh: SurfaceMesh, lengths: NDArray[np.float64], sizes: EdgeSizes | None, slope: float
) -> SizeGrowth | None:
    """Growth of the target sizes over the edges of the mesh; None as for ``growth_of_edges``."""
    corners, most = mesh.parametrisation, 1.0 + GROWTH_SLACK
    if sizes is not None and slope > 0.0 and (corners is None or corners.metric_root_3d is None):
        worst, largest, above = quality.size_changes(sizes.apart, lengths, slope, most)
    else:
        over = growth_of_edges(mesh, lengths, sizes, slope)
        worst = -1 if over is None else int(over.argmax())
        largest, above = (
            (0.0, 0) if over is None else (float(over[worst]), int(np.count_nonzero(over > most)))
        )
    if worst < 0:
        return None
    place = mesh.points[mesh.edges[worst]].mean(axis=0)
    return SizeGrowth(above / len(lengths), largest, as_point(place))


def growth_of_edges(
    mesh: SurfaceMesh, lengths: NDArray[np.float64], sizes: EdgeSizes | None, slope: float
) -> NDArray[np.float64] | None:
    """Growth of the target sizes over each edge (k,), in any direction; 1 is what is allowed.

    Along an edge of length l sizes may differ by ``slope`` l. Where sizes depend on the direction
    those along the edge are compared. None without sizes or edges of a length.
    """
    corners = mesh.parametrisation
    if sizes is None or not (lengths > 0.0).any() or not slope > 0.0:
        return None
    root = None if corners is None else corners.metric_root_3d
    if root is None or corners is None:
        return _finite(sizes.apart, slope * lengths)
    over = np.empty(len(lengths))
    for begin in range(0, len(lengths), BLOCK):
        block = slice(begin, begin + BLOCK)
        length = lengths[block]
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = _stretched_at_ends(mesh, root, corners.uv_triangles, block)
            first, second = (length / metric for metric in ends)  # l / h long in the metric
            over[block] = _finite(np.abs(first - second), slope * length)
    return over


def _finite(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) quotients a / b; 0 where they are none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        over = a / b
    finite = np.isfinite(over)
    if not finite.all():
        over[~finite] = 0.0
    return over
