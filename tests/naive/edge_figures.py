"""Lengths of edges against target sizes, in numpy: the twin of ``src/quality/edge_figures.hpp``."""

from typing import NamedTuple

import numpy as np

from surfmesh.sizing.metric_roots import unpacked


class SlowEdgeFigures(NamedTuple):
    lengths: np.ndarray
    metric_lengths: np.ndarray
    over: np.ndarray  # by how much sizes differ along each edge, over slope times length
    ratios: tuple[float, float]


def edge_figures(points, triangles, table, sizes, roots, root_triangles, slope):
    """roots: (k, 6) where sizes depend on the direction, else None."""
    a, b = table.edges.T
    lengths = np.linalg.norm(points[b] - points[a], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        if roots is None:
            metric = lengths / (0.5 * (sizes[a] + sizes[b]))
            apart = np.abs(sizes[a] - sizes[b])
        else:
            first, second = _in_metrics(points, table, roots, root_triangles)
            metric = 2.0 * first * second / np.where(first + second > 0.0, first + second, 1.0)
            apart = np.abs(lengths / first - lengths / second)
        over = apart / (slope * lengths)
    over[~np.isfinite(over)] = 0.0
    ratios = _ratios(table.edges, lengths if roots is None else metric, len(points))
    return SlowEdgeFigures(lengths, metric, over, ratios)


def _in_metrics(points, table, roots, root_triangles):
    """Lengths of edges in the metrics at the ends of their first half-edges."""
    a, b = table.edges.T
    start = table.half_edges[:, 0]
    end = np.where(start % 3 == 2, start - 2, start + 1)
    return (
        np.linalg.norm(
            np.einsum(
                "kij,kj->ki", unpacked(roots[root_triangles.ravel()[e]]), points[b] - points[a]
            ),
            axis=1,
        )
        for e in (start, end)
    )


def _ratios(edges, lengths, vertices):
    longest, shortest = np.zeros(vertices), np.full(vertices, np.inf)
    with np.errstate(invalid="ignore"):
        for end in edges.T:
            np.maximum.at(longest, end, lengths)
            np.minimum.at(shortest, end, lengths)
        used = (shortest > 0.0) & (longest > 0.0) & (longest < np.inf)
    if not used.any():
        return np.nan, np.nan
    ratio = longest[used] / shortest[used]
    return float(ratio.max()), float(np.quantile(ratio, 0.99))
