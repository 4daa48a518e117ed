"""Partial derivatives by differences that never leave the domain.

In each variable the polynomial of degree p through p + 1 even nodes is differentiated. The nodes
lie about the point; near a side they are moved inwards, so that nothing is asked for outside:

    u0                 c - h    c    c + h        c = u, but at least p h / 2 from u0 and u1
    |----x----x----x----x----x----|               t = (u - c) / h, in [-p/2, p/2]
         the polynomial of degree 4
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from surfmesh.geometry.surface import Domain

ORDERS = (2, 4, 6)
LADDER = 14  # steps that are tried, each half the one before
LARGEST = 1.0 / 16.0  # of the domain: the first of them
TRIED = 9  # points each way at which they are tried

Values = Callable[[np.ndarray], np.ndarray]
"""(n, 2) float -> (n, k) float."""


@dataclass(frozen=True)
class Differences:
    """Central differences of order 2, 4 or 6 in the distance of the nodes.

    Near the sides, where the nodes are not about the point, second derivatives lose one order.
    """

    domain: Domain
    order: int
    steps: tuple[float, float]
    """Distances of the nodes in u and in v, parameters."""

    def first(self, values: Values, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """d/du and d/dv of ``values`` at uv (n, 2): two arrays (n, k)."""
        return self._line(values, uv, 0, (1,))[0], self._line(values, uv, 1, (1,))[0]

    def both(self, values: Values, uv: np.ndarray) -> tuple[np.ndarray, ...]:
        """(d/du, d/dv, d2/du2, d2/dudv, d2/dv2) of ``values`` at uv (n, 2), (n, k) each."""
        along_u, w_u = self._nodes(uv[:, 0], 0)
        along_v, w_v = self._nodes(uv[:, 1], 1)
        total: list[np.ndarray] | None = None
        wanted = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        for i in range(self.order + 1):
            for j in range(self.order + 1):
                found = values(np.stack([along_u[i], along_v[j]], axis=1))
                terms = [(w_u[a][:, i] * w_v[b][:, j])[:, None] * found for a, b in wanted]
                total = terms if total is None else [s + t for s, t in zip(total, terms)]
        assert total is not None  # noqa: S101 for mypy: order >= 0
        return tuple(total)

    def _line(
        self, values: Values, uv: np.ndarray, axis: int, derivatives: tuple[int, ...]
    ) -> list[np.ndarray]:
        """Derivatives along one variable alone."""
        nodes, weights = self._nodes(uv[:, axis], axis)
        total: list[Any] = [0.0 for _ in derivatives]
        for i in range(self.order + 1):
            place = uv.copy()
            place[:, axis] = nodes[i]
            found = values(place)
            total = [s + weights[d][:, i, None] * found for s, d in zip(total, derivatives)]
        return total

    def _nodes(self, x: np.ndarray, axis: int) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
        """Nodes (p + 1, n) and their weights (n, p + 1) for derivatives 0, 1 and 2."""
        first, last = self.domain[axis]
        step, half = self.steps[axis], self.order // 2
        middle = np.clip(x, first + half * step, last - half * step)
        offsets = np.arange(-half, half + 1)
        nodes = np.clip(middle + step * offsets[:, None], first, last)  # round-off stays inside
        t = (x - middle) / step
        # rows: the Lagrange polynomials' coefficients, lowest first
        basis = lagrange_polynomials(offsets)
        weights = []
        for derivative in range(3):
            weights.append(np.polynomial.polynomial.polyval(t, basis.T).T / step**derivative)
            basis = np.polynomial.polynomial.polyder(basis, axis=1)
        return nodes, tuple(weights)


def lagrange_polynomials(nodes: np.ndarray) -> np.ndarray:
    """Coefficients (n, n), lowest first, of the polynomials that are 1 at one of n whole numbers
    and 0 at the others; each is rounded once."""
    others = [np.delete(nodes, i) for i in range(len(nodes))]
    polynomials = [np.polynomial.polynomial.polyfromroots(own) for own in others]
    return np.array([p / np.prod(x - own) for p, x, own in zip(polynomials, nodes, others)])


def chosen_differences(
    values: Values, domain: Domain, order: int, step: float | None = None
) -> tuple[Differences, float]:
    """Differences with good steps, and the error of second derivatives that is left.

    Truncation falls and round-off grows as the step shrinks. Each variable takes the step whose
    derivatives agree best with those of half of it, on a grid of points that evenness does not
    fool. step: a fraction of the domain, to use instead. The error is the largest disagreement, as
    a fraction of the largest second derivative or, where that is more, of the extent of values; all
    in parts of the domain.
    """
    extent = [last - first for first, last in domain]
    if step is not None:
        ladder = [step]
    else:
        ladder = [LARGEST * 0.5**k for k in range(LADDER)]
    grid = [first + (last - first) * _uneven() for first, last in domain]
    points = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 2)
    steps, errors = [], []
    for axis in (0, 1):
        found = []
        for fraction in [*ladder, 0.5 * ladder[-1]]:
            rule = Differences(domain, order, (fraction * extent[0], fraction * extent[1]))
            (second,) = rule._line(values, points, axis, (2,))
            found.append(second * extent[axis] ** 2)
        disagreement = [float(np.abs(a - b).max()) for a, b in pairwise(found)]
        best = int(np.argmin(disagreement))
        steps.append(ladder[best] * extent[axis])
        errors.append((disagreement[best], float(np.abs(found[best]).max())))
    flat = float(np.ptp(values(points), axis=0).max())  # second derivatives may be round-off
    largest = max(flat, *(size for _, size in errors))
    error = max(disagreement for disagreement, _ in errors) / largest if largest > 0.0 else 0.0
    return Differences(domain, order, (steps[0], steps[1])), error


def _uneven() -> np.ndarray:
    """Points in [0, 1], both ends among them."""
    golden = 0.5 * (np.sqrt(5.0) - 1.0)
    return np.r_[0.0, np.sort((np.arange(1, TRIED - 1) * golden) % 1.0), 1.0]
