"""Where on a surface small sizes lie that samples of it may miss.

What sources mark is projected onto the surface: the foot of a mark is nearest to it, so that
there the source asks for the smallest size on that piece of the surface.
"""

import numpy as np

from surfmesh._core.space import PointTree
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.options.sources import Source
from surfmesh.sizing.rules.size_limits import SizeLimits

GUESSES = 33
"""Points each way of the grid from which feet are looked for."""

PROJECTIONS = 6


def small_sizes(
    surface: Surface, sizing: Sizing, *known: SizeLimits | None
) -> tuple[np.ndarray, np.ndarray]:
    """uv (k, 2), sizes (k,) that the field has to be fine enough for.

    ``known``: limits from edges, loops and earlier rounds; those whose (u, v) is known count.
    """
    places, sizes = [np.empty((0, 2))], [np.empty(0)]
    for limits in known:
        if limits is not None and limits.uv is not None:
            places.append(limits.uv)
            sizes.append(limits.sizes)
    marked = [source for source in sizing.sources if isinstance(source, Source)]
    if marked:
        (u0, u1), (v0, v1) = surface.domain
        grid = np.stack(
            np.meshgrid(np.linspace(u0, u1, GUESSES), np.linspace(v0, v1, GUESSES)), axis=-1
        ).reshape(-1, 2)
        (points,) = surface.evaluate(grid, 0)
        tree = PointTree(points)
        for source in marked:
            guess = grid[tree.nearest(source.marks, 1)[1][:, 0]]
            uv, _, foot = closest_point(surface, source.marks, guess, PROJECTIONS, 0.0)
            asked = source(foot)
            there = np.isfinite(asked)
            places.append(uv[there])
            sizes.append(np.maximum(asked[there], sizing.min_size or 0.0))
    return np.concatenate(places), np.concatenate(sizes)
