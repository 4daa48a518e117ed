"""Which sides of a surface coincide in space: the twin of ``src/surfaces/coincident_sides.hpp``."""

import numpy as np

from surfmesh.geometry.differential.infinite_speed import rounding_of_sides
from surfmesh.geometry.differential.sides import SideTopology, side_points
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Surface

SAMPLES = 65  # points on which two sides are compared; uneven, so that symmetry fools nobody
SAME = 1e-9  # of the bounding box diagonal: sin(pi) is 1e-16, a real gap is far larger

# opposite sides first: where several sides coincide, that is what is meant
_PAIRS = ((1, 3), (0, 2), (0, 1), (1, 2), (2, 3), (0, 3))


def find_sides(surface: Surface) -> SideTopology:
    """Compare the sides of a surface in space."""
    low, high = np.array(surface.domain, float).T
    # ends exact, as those of `side_points`
    uv = np.where(_PLACES < 1.0, low + _PLACES * (high - low), high)
    (cloud,) = surface.evaluate(uv, 0)
    curves = cloud[-4 * SAMPLES :].reshape(4, SAMPLES, 3)
    columns = np.ascontiguousarray(cloud.T)
    of_sides = columns[:, -4 * SAMPLES :].reshape(3, 4, SAMPLES)
    whole = norm(columns.max(axis=1) - columns.min(axis=1))
    tolerance = whole * np.maximum(SAME, rounding_of_sides(surface))

    extents = (of_sides.max(axis=2) - of_sides.min(axis=2)).T
    collapsed = [norm(extent) <= near for extent, near in zip(extents, tolerance.tolist())]
    partner, reverse = [-1] * 4, [False] * 4
    for first, second in _PAIRS:
        if collapsed[first] or collapsed[second] or partner[first] >= 0 or partner[second] >= 0:
            continue
        for backwards in (False, True):
            # the samples are symmetric under t -> 1 - t, so backwards is the same list reversed
            other = curves[second][::-1] if backwards else curves[second]
            if np.abs(curves[first] - other).max() <= max(tolerance[first], tolerance[second]):
                partner[first], partner[second] = second, first
                reverse[first] = reverse[second] = backwards
                break
    return SideTopology(surface.domain, tuple(collapsed), tuple(partner), tuple(reverse))


def _samples() -> np.ndarray:
    """Uneven parameters in [0, 1], symmetric under t -> 1 - t, both ends included."""
    count = (SAMPLES - 1) // 2
    golden = 0.5 * (np.sqrt(5.0) - 1.0)
    half = 0.5 * np.sort((np.arange(1, count) * golden) % 1.0)
    return np.concatenate([[0.0], half, [0.5], 1.0 - half[::-1], [1.0]])


def _places() -> np.ndarray:
    """Where a surface is compared, on the unit square: a grid, then the samples of each side."""
    coarse, unit = np.linspace(0.0, 1.0, 9), ((0.0, 1.0), (0.0, 1.0))
    grid = np.stack(np.meshgrid(coarse, coarse), axis=-1).reshape(-1, 2)
    return np.concatenate([grid, *(side_points(unit, side, _samples()) for side in range(4))])


_PLACES = _places()
