"""Triangles over which a surface hides nothing by its second derivatives: block after block."""

import numpy as np

from surfmesh.geometry.formulas.interval import largest_along

LEVELS, BLOCK = 3, 1 << 13


def bounded_at_once(surface, pieces, seen):
    """(k,) triangles whose second derivatives alone say that nothing hides there.

    seen: (k,) largest distance at the corners, in the middles of the sides and at the centroid.
    """
    bounded = np.zeros(len(pieces.uv), bool)
    for start in range(0, len(bounded), BLOCK):
        part = slice(start, start + BLOCK)
        lo, hi = pieces.uv[part].min(axis=1), pieces.uv[part].max(axis=1)
        lower, upper = surface.all_bounds(lo, hi)
        (du, dv), normal = (hi - lo).T, pieces.normal[part]
        with np.errstate(invalid="ignore", over="ignore"):
            uu, uvs, vv = (largest_along(lower[:, k], upper[:, k], normal)[:, 0] for k in (3, 4, 5))
            height = (du * du * uu + 2.0 * du * dv * uvs + dv * dv * vv) / 8.0
            bounded[part] = seen[part] + 0.25 * height <= pieces.tolerance[part]
    return bounded


def bounded_between_samples(surface, pieces, seen):
    """(k,) triangles whose second derivatives along their edges say so; ``seen`` as above."""
    bounded = np.zeros(len(pieces.uv), bool)
    for start in range(0, len(bounded), BLOCK):
        part = slice(start, start + BLOCK)
        bound = _interpolation_error(surface, pieces.uv[part], pieces.normal[part, 0])
        bounded[part] = seen[part] + 0.25 * bound <= pieces.tolerance[part]
    return bounded


def bounded_in_parts(surface, pieces):
    """(k,) triangles within their tolerance by second derivatives along edges of their parts."""
    bounded = np.ones(len(pieces.uv), bool)
    piece, uv = np.arange(len(bounded)), pieces.uv
    for level in range(LEVELS + 1):
        within = np.empty(len(piece), bool)
        for start in range(0, len(piece), BLOCK):
            part = slice(start, start + BLOCK)
            within[part] = _interpolated_within(surface, pieces, piece[part], uv[part])
        bounded[piece[~within]] &= level < LEVELS
        going = ~within & bounded[piece]
        piece, uv = np.repeat(piece[going], 4), _in_four(uv[going])
        if not len(piece):
            break
    return bounded


def _interpolated_within(surface, pieces, piece: np.ndarray, uv: np.ndarray):
    """(n,) do parts uv (n, 3, 2) of triangles keep to their tolerance?"""
    normal = pieces.normal[piece, 0]
    (r,) = surface.evaluate(uv.reshape(-1, 2), 0)
    height = np.abs(
        np.einsum("nij,nj->ni", r.reshape(-1, 3, 3) - pieces.corner[piece, None], normal)
    )
    bound = _interpolation_error(surface, uv, normal)
    return height.max(axis=1) + bound <= pieces.tolerance[piece]


def _interpolation_error(surface, uv: np.ndarray, normal: np.ndarray):
    """(n,) by how much linear interpolation along normal (n, 3) errs at most over uv (n, 3, 2)."""
    lower, upper = surface.all_bounds(uv.min(axis=1), uv.max(axis=1))
    du, dv = (uv[:, [1, 2, 0]] - uv).transpose(2, 0, 1)
    weights = np.stack([du * du, 2.0 * du * dv, dv * dv], axis=2)  # (n, 3 edges, 3 derivatives)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        times = weights[..., None] * normal[:, None, None]
        ends = times * lower[:, None, 3:6], times * upper[:, None, 3:6]
        most = np.maximum(*ends).sum(axis=(2, 3)), np.minimum(*ends).sum(axis=(2, 3))
        a, b, c = np.maximum(most[0], -most[1]).T
        inner = 2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c
        peak = np.where(inner > 0.0, a * b * c / inner, 0.0)
        # the largest of l0 l1 a + l1 l2 b + l2 l0 c is within, or amid an edge
        inside = (a * (b + c - a) > 0.0) & (b * (c + a - b) > 0.0) & (c * (a + b - c) > 0.0)
        amid = np.maximum.reduce([a, b, c]) / 4.0
        return 0.5 * np.where(inside, np.maximum(peak, amid), amid)


def _in_four(uv: np.ndarray) -> np.ndarray:
    """Parts (4 n, 3, 2) of triangles (n, 3, 2), four after four."""
    a, b, c = uv.transpose(1, 0, 2)
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3, 2)
