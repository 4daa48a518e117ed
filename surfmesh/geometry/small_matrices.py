"""Products and decompositions of small matrices, the same bits on every processor.

BLAS and LAPACK choose code by the processor, which differs in the last bit: enough for another
triangle. Here sums go from first to last, with numpy's loops over elements alone.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

SWEEPS = 40
"""Over all pairs of columns, at most: they are orthogonal after five or six."""

ORTHOGONAL = 1e-16
"""Cosine of two columns that count as orthogonal."""

LARGEST_RATIO = 1e150


def product(a: ArrayLike, b: ArrayLike) -> NDArray[np.float64]:
    """``a @ b``: of two vectors (n,), a matrix and a vector, stacks of matrices."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    if b.ndim == 1:
        found = np.einsum("...i,i->...", a, b)
    elif a.ndim == 1:
        found = np.einsum("i,...ij->...j", a, b)
    else:
        found = np.einsum("...ij,...jk->...ik", a, b)
    return np.asarray(found)


def norm(a: ArrayLike) -> float:
    """``np.linalg.norm`` of a vector, or of all entries in one row."""
    row = np.ravel(np.asarray(a, float))
    largest = float(np.abs(row).max(initial=0.0))
    if not 0.0 < largest < math.inf:
        return largest
    scaled = row / largest
    return largest * math.sqrt(np.einsum("i,i->", scaled, scaled))


def thin_svd(
    a: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """``np.linalg.svd(a, full_matrices=False)`` of a stack (..., m, n): u (..., m, k), s (..., k)
    falling, v (..., k, n) with k the smaller of m and n. Columns of u, or rows of v where m < n,
    are zero where s is.

    One-sided rotations: Hestenes, "Inversion of matrices by biorthogonalization", 1958.
    """
    if a.shape[-2] < a.shape[-1]:
        v, s, u = thin_svd(np.swapaxes(a, -1, -2))
        return np.swapaxes(u, -1, -2), s, np.swapaxes(v, -1, -2)
    u = np.array(a, float)
    columns = u.shape[-1]
    v = np.broadcast_to(np.eye(columns), (*u.shape[:-2], columns, columns)).copy()
    for _ in range(SWEEPS):
        if not any([_rotate(u, v, p, q) for p in range(columns) for q in range(p + 1, columns)]):
            break
    s = np.sqrt((u * u).sum(axis=-2))
    order = np.argsort(-s, axis=-1, kind="stable")
    s = np.take_along_axis(s, order, axis=-1)
    u, v = (np.take_along_axis(one, order[..., None, :], axis=-1) for one in (u, v))
    u = u / np.where(s > 0.0, s, 1.0)[..., None, :]
    return u, s, np.swapaxes(v, -1, -2)


def _rotate(u: NDArray[np.float64], v: NDArray[np.float64], p: int, q: int) -> bool:
    """Turn columns p and q of each matrix so that those of u are orthogonal; was it needed?"""
    one, two = u[..., p], u[..., q]
    square_one, square_two = (one * one).sum(axis=-1), (two * two).sum(axis=-1)
    both = (one * two).sum(axis=-1)
    turns = np.abs(both) > ORTHOGONAL * np.sqrt(square_one * square_two)
    if not turns.any():
        return False
    ratio = (square_two - square_one) / (2.0 * np.where(turns, both, 1.0))
    ratio = np.clip(ratio, -LARGEST_RATIO, LARGEST_RATIO)  # its square is finite
    tangent = np.copysign(1.0, ratio) / (np.abs(ratio) + np.sqrt(1.0 + ratio * ratio))
    tangent = np.where(turns, tangent, 0.0)[..., None]
    cosine = 1.0 / np.sqrt(1.0 + tangent * tangent)
    sine = cosine * tangent
    for columns in (u, v):
        one, two = columns[..., p].copy(), columns[..., q].copy()
        columns[..., p], columns[..., q] = cosine * one - sine * two, sine * one + cosine * two
    return True


def pseudo_inverse(a: NDArray[np.float64], rcond: float) -> NDArray[np.float64]:
    """``np.linalg.pinv`` of a stack (..., m, n): singular values of no more than ``rcond`` times
    the largest count as zero."""
    u, s, v = thin_svd(a)
    kept = s > rcond * s.max(axis=-1, keepdims=True, initial=0.0)
    inverse = np.where(kept, 1.0 / np.where(kept, s, 1.0), 0.0)
    return np.asarray(np.einsum("...ki,...k,...jk->...ij", v, inverse, u))


def least_squares(
    a: NDArray[np.float64], b: NDArray[np.float64], rcond: float
) -> NDArray[np.float64]:
    """``np.linalg.lstsq(a, b, rcond)[0]`` of a matrix (m, n) and a vector (m,)."""
    return product(pseudo_inverse(a, rcond), b)


def symmetric_axes(a: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """``np.linalg.eigh`` of a symmetric matrix (2, 2): values rising, axes in the columns."""
    middle, half = 0.5 * (a[0, 0] + a[1, 1]), 0.5 * (a[0, 0] - a[1, 1])
    radius = math.hypot(half, a[1, 0])
    # along the axis of the larger value, without cancellation
    along = (half + radius, a[1, 0]) if half >= 0.0 else (a[1, 0], radius - half)
    size = math.hypot(*along)
    x, y = (along[0] / size, along[1] / size) if size > 0.0 else (0.0, 1.0)
    return np.array([middle - radius, middle + radius]), np.array([[-y, x], [x, y]])
