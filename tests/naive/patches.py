"""Cells of nine nodes, as the gradation sees them."""

import numpy as np

NONE = np.empty((0, 2), np.int32)


def patches(nx, ny):
    """Patches of nine nodes that tile a grid of (2 nx + 1) (2 ny + 1) nodes."""
    i, j = np.meshgrid(np.arange(nx), np.arange(ny))
    first = (2 * j * (2 * nx + 1) + 2 * i).ravel()
    k = np.arange(9)
    return (first[:, None] + k % 3 + (k // 3) * (2 * nx + 1)).astype(np.int32)
