"""Polygons (k, 2) with corners of all kinds, counter-clockwise."""

import numpy as np


def square(cuts, low=0.0, high=1.0):
    t = low + (high - low) * np.arange(cuts) / cuts
    low, high = np.full(cuts, low), np.full(cuts, high)
    sides = [(t, low), (high, t), (high - t + low, high), (low, high - t + low)]
    return np.concatenate([np.stack(side, axis=1) for side in sides])


def star(points, inner, phase=0.1, centre=(0.5, 0.5), radius=0.49):
    angle = phase + np.pi * np.arange(2 * points) / points
    r = radius * np.where(np.arange(2 * points) % 2, inner, 1.0)
    return np.stack([centre[0] + r * np.cos(angle), centre[1] + r * np.sin(angle)], axis=1)


def spike(degrees):
    """A square with a thin notch of this angle."""
    half = 0.4 * np.tan(np.radians(degrees) / 2)
    return np.array(
        [(0, 0), (1, 0), (1, 1), (0.5 + half, 1), (0.5, 0.6), (0.5 - half, 1), (0, 1)], float
    )
