"""Edge lengths against the wanted ones, and how fast they change from edge to edge."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.surface_mesh import SurfaceMesh

QUASI_UNIT = (0.5**0.5, 2.0**0.5)  # metric lengths that conform to the wanted sizes
BLOCK = 1 << 15  # edges looked at together, to stay within the cache


def edge_lengths(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """(ne,) length of every edge of ``mesh.edges`` in model units."""
    lengths = np.empty(len(mesh.edges))
    for start in range(0, len(lengths), BLOCK):
        a, b = mesh.edges[start : start + BLOCK].T
        step = mesh.points[b] - mesh.points[a]
        lengths[start : start + BLOCK] = np.sqrt(np.einsum("ij,ij->i", step, step))
    return lengths


def metric_lengths(mesh: SurfaceMesh, lengths: NDArray[np.float64]) -> NDArray[np.float64]:
    """(ne,) length of pq over the mean of the sizes wanted at p and q; 1 is as wanted."""
    metric = 2.0 * lengths
    for start in range(0, len(lengths), BLOCK):
        a, b = mesh.edges[start : start + BLOCK].T
        metric[start : start + BLOCK] /= mesh.sizes[a] + mesh.sizes[b]
    return metric


class Growth(NamedTuple):
    """Longest over shortest edge at a vertex: 1 when all edges there are equally long."""

    largest: float
    p99: float  # 99 of 100 vertices are below


def growth(mesh: SurfaceMesh, lengths: NDArray[np.float64]) -> Growth:
    """Ratio of the lengths of edges that share a vertex."""
    longest = np.zeros(len(mesh.points))
    shortest = np.full(len(mesh.points), np.inf)
    for end in mesh.edges.T:
        np.maximum.at(longest, end, lengths)
        np.minimum.at(shortest, end, lengths)
    used = (shortest > 0) & (longest < np.inf)  # no edge, no finite length
    used &= longest > 0
    if not used.any():
        return Growth(float("nan"), float("nan"))
    ratio = longest[used] / shortest[used]
    return Growth(float(ratio.max()), float(np.quantile(ratio, 0.99)))
