"""What the sizes inside a face ask for along its edges, which know their own surroundings only."""

import numpy as np

from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines

COARSE = 2.0
"""Segments of the boundary so many times longer than the sizes inside allow are to be cut."""

LOOKED_AT = (0.1, 0.3, 0.5, 0.7, 0.9)
"""Fractions of a segment at which the sizes inside are read."""


def sizes_along_edges(
    sizing: Sizing, surface: Surface, field: SizeField, loops: BoundaryLoops
) -> SizeLimits | None:
    """What sizes grown from the inside ask for along edges, which know their surroundings only."""
    points = surface.evaluate(loops.uv, 0)[0] if loops.points is None else loops.points
    first, second = loops.segments.T
    step = points[second] - points[first]
    length = np.linalg.norm(step, axis=1)
    real = length > 0.0  # at a pole there are none
    first, second, step, length = first[real], second[real], step[real], length[real]
    if not len(length):
        return None
    # where sizes have a direction segments may be long, and pass much on their way
    fractions = LOOKED_AT if sizing.is_anisotropic else LOOKED_AT[2:3]
    ends = loops.uv[first], loops.uv[second]
    uv = np.stack([(1.0 - t) * ends[0] + t * ends[1] for t in fractions], axis=1)
    xy = field.chart.to_plane(uv.reshape(-1, 2))
    if sizing.is_anisotropic:
        way = field.chart.to_plane(ends[1]) - field.chart.to_plane(ends[0])
        way, whole = (np.repeat(a, len(fractions), axis=0) for a in (way, length))
        sizes = whole / np.maximum(field.metric_lengths(xy, way), np.finfo(float).tiny)
    else:
        sizes = field.sizes(xy)
    sizes = np.maximum(sizes, sizing.min_size or 0.0).reshape(-1, len(fractions))
    coarse = length > COARSE / (1.0 / sizes).mean(axis=1)
    if not coarse.any():
        return None
    (places,) = surface.evaluate(uv[coarse].reshape(-1, 2), 0)
    sizes, metric_root_3d = sizes[coarse].ravel(), None
    if sizing.is_anisotropic:
        along = np.repeat(step[coarse] / length[coarse, None], len(fractions), axis=0)
        metric_root_3d = along_lines(along, sizes)
    return SizeLimits(places, sizes, sizing.gradient, metric_root_3d=metric_root_3d)
