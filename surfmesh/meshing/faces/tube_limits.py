"""Sizes that leave room for a tube: at least a few edges from a seam all the way round to it.

seam       seam        nodes of a seam have two images in (u, v); the line between them is
 o----------o          a closed curve in space, and a mesh whose edges are as long as it
 o----------o  ->      pinches the tube, or closes it
 o----------o
"""

import numpy as np

from surfmesh.geometry.surface import Surface
from surfmesh.sizing.rules.size_limits import SizeLimits

EDGES_ROUND = 5.0
"""Wanted edges on the way round a tube, at least."""

SAMPLES = 9
POLE = 1e-3
"""Way round, as a fraction of the size there, below which a node is a pole."""

SAME_PLACE = 1e-3
"""Images nearer than this fraction of the face's box are no two images: an edge inside the face."""


def seam_limits(
    surface: Surface, uv: np.ndarray, numbers: np.ndarray, sizes: np.ndarray, slope: float
) -> SizeLimits | None:
    """Limits where the sizes (n,) of nodes at uv (n, 2) are too large for the way round.

    numbers (n,): nodes of equal number are one point. The limits go below ``min_size``: without
    them the mesh would have another topology than the face. None when there is room.
    """
    order = np.argsort(numbers, kind="stable")
    first, second = order[:-1], order[1:]
    extent = np.maximum(np.ptp(uv, axis=0), np.finfo(float).tiny)
    apart = (np.abs(uv[first] - uv[second]) > SAME_PLACE * extent).any(axis=1)
    pair = (numbers[first] == numbers[second]) & apart
    if not pair.any():
        return None
    first, second = first[pair], second[pair]
    t = np.linspace(0.0, 1.0, SAMPLES)[:, None, None]
    way = (1.0 - t) * uv[first] + t * uv[second]
    points = surface.evaluate(way.reshape(-1, 2), 0)[0].reshape(SAMPLES, -1, 3)
    length = np.linalg.norm(points[1:] - points[:-1], axis=2).sum(axis=0)
    limit = length / EDGES_ROUND
    narrow = (limit < sizes[first]) & (length > POLE * sizes[first])
    if not narrow.any():
        return None
    return SizeLimits(
        points[:, narrow].reshape(-1, 3), np.tile(limit[narrow], SAMPLES), slope,
        way[:, narrow].reshape(-1, 2), essential=True,
    )  # fmt: skip
