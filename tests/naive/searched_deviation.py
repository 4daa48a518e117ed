"""How far a triangle is from a curved surface, searched over places and directions."""

import numpy as np


def searched_deviation(k1, k2, h1=1.0, h2=1.0, turns=91, n=24):
    """Largest distance in z between z = (k1 x^2 + k2 y^2) / 2 and a triangle with its corners on
    it, equilateral of side 1 in the metric of lengths h1 along x, h2 along y; over places in the
    triangle and directions of the triangle."""
    i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
    keep = i + j <= n
    weights = np.stack([i[keep], j[keep], n - i[keep] - j[keep]], axis=1) / n
    worst = 0.0
    for angle in np.linspace(0, 2 * np.pi / 3, turns):
        a = angle + 2 * np.pi * np.arange(3) / 3
        corners = np.stack([h1 * np.cos(a), h2 * np.sin(a)], axis=1) / np.sqrt(3)
        height = corners**2 @ (k1, k2) / 2
        place = weights @ corners
        worst = max(worst, np.abs(weights @ height - place**2 @ (k1, k2) / 2).max())
    return worst
