"""B-spline functions by their definition, sums over all of them, division of power series."""

import numpy as np


def basis(knots, degree, i, t, order=0) -> float:
    """N_i of a degree at t, or its derivative, by the recursion of Cox and de Boor."""
    if order > 0:
        left = _ratio(basis(knots, degree - 1, i, t, order - 1), knots[i + degree] - knots[i])
        right = _ratio(
            basis(knots, degree - 1, i + 1, t, order - 1), knots[i + degree + 1] - knots[i + 1]
        )
        return degree * (left - right)
    if degree == 0:
        return 1.0 if knots[i] <= t < knots[i + 1] else 0.0
    left = _ratio(t - knots[i], knots[i + degree] - knots[i])
    right = _ratio(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1])
    left = left and left * basis(knots, degree - 1, i, t)
    return left + (right and right * basis(knots, degree - 1, i + 1, t))


def _ratio(a, b) -> float:
    return a / b if b else 0.0


def surface(knots_u, knots_v, control, weights, u, v, order) -> dict:
    """{(k, l): derivative (3,)} for k + l <= order.

    The product rule (w r)_kl = sum of binomials w_ij r_(k-i)(l-j) is solved for r_kl.
    """
    degree_u = len(knots_u) - control.shape[0] - 1
    degree_v = len(knots_v) - control.shape[1] - 1
    homogeneous = np.concatenate([control * weights[..., None], weights[..., None]], axis=-1)
    numbers = [(s - l, l) for s in range(order + 1) for l in range(s + 1)]
    sums = {}
    for k, l in numbers:
        N_u = [
            basis(knots_u, degree_u, i, u, k) if k <= degree_u else 0.0
            for i in range(control.shape[0])
        ]
        N_v = [
            basis(knots_v, degree_v, j, v, l) if l <= degree_v else 0.0
            for j in range(control.shape[1])
        ]
        sums[k, l] = np.einsum("i,j,ijc->c", N_u, N_v, homogeneous)
    r = {}
    for k, l in numbers:
        rest = sum(
            _binomial(k, i) * _binomial(l, j) * sums[i, j][3] * r[k - i, l - j]
            for i in range(k + 1)
            for j in range(l + 1)
            if i + j
        )
        r[k, l] = (sums[k, l][:3] - rest) / sums[0, 0][3]
    return r


def _binomial(n, k) -> int:
    return 1 if k == 0 else _binomial(n - 1, k - 1) * n // k
