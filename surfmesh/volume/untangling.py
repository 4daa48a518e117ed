"""Curved tetrahedra that are turned inside out in a part are mended from within; the surface stays.

A smooth surface leaves no room in a tetrahedron that has two sides on it: three of its edges
begin in one tangent plane. So tetrahedra that no move of their inner nodes mends are split in four:

        3                 3
       /|\\               /|\\        p: a new corner in the middle, with four new edges;
      / | \\    ->       / p \\       each part has one side of the old one
     0--|--2           0-'|'-2
      \\ | /             \\ | /
        1                 1

Inner corners and middles of inner edges then move to where all Jacobians near them are at least
``LEAST`` of those of the straight tetrahedra, by minimising the squares of what is missing.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from surfmesh.volume.curved_tetrahedra import (
    MIDDLE,
    gradients,
    jacobians,
    least_jacobians,
    straight_jacobians,
)

LEAST = 0.1  # of the straight tetrahedron's Jacobian, that is aimed for
ROUNDS = 4  # of moves and splits; splits without end would help nobody
STEPS = 200  # of the minimisation


class Untangled(NamedTuple):
    nodes: NDArray[np.float64]  # the given ones in their order, then new ones
    elements: NDArray[np.int64]  # (k, 10)
    solid_ids: NDArray[np.int32]  # (k,)
    left: int  # tetrahedra whose Jacobian is still not proved positive


def untangled(
    nodes: NDArray[np.float64], elements: NDArray, solid_ids: NDArray[np.int32], fixed: int
) -> Untangled:
    """Tetrahedra of ten nodes with inner nodes moved, and some split, so that maps are one to one.

    fixed: that many nodes stay, those of the surface.
    """
    bad = least_jacobians(nodes, elements) <= 0.0
    best = Untangled(nodes, elements.astype(np.int64), solid_ids, int(bad.sum()))
    tried = best
    for _ in range(ROUNDS):
        if not tried.left:
            break
        nodes = _moved(tried.nodes, tried.elements, bad, fixed)
        bad = least_jacobians(nodes, tried.elements) <= 0.0
        tried = tried._replace(nodes=nodes, left=int(bad.sum()))
        if tried.left < best.left:
            best = tried
        if tried.left:
            tried = _split(tried, bad)
            bad = least_jacobians(tried.nodes, tried.elements) <= 0.0
    return best


def _moved(nodes: NDArray, elements: NDArray, bad: NDArray[np.bool_], fixed: int) -> NDArray:
    """Nodes after the inner ones of ``bad`` tetrahedra and of those around them have moved."""
    near = np.zeros(len(nodes), bool)
    near[elements[bad]] = True
    near[elements[near[elements].any(axis=1)]] = True  # one ring more
    near[:fixed] = False
    free = np.flatnonzero(near)
    if not len(free):
        return nodes
    rows = elements[near[elements].any(axis=1)]
    number = np.full(len(nodes), -1)
    number[free] = np.arange(len(free))
    moving = number[rows]
    there = moving >= 0
    scale = np.abs(straight_jacobians(nodes[rows]))
    scale = np.maximum(scale, 1e-3 * scale.mean())[:, None]  # the flattest are given more room
    length = float(np.cbrt(scale.mean()))
    origin = nodes[free].copy()

    def missing(steps: NDArray) -> tuple[float, NDArray]:
        places = nodes[rows]
        places[there] = (origin + length * steps.reshape(-1, 3))[moving[there]]
        lack = np.maximum(LEAST - jacobians(places) / scale, 0.0)
        slopes = gradients(places, -2.0 * lack / scale)
        total = np.zeros((len(free), 3))
        np.add.at(total, moving[there], slopes[there])
        return float(np.square(lack).sum()), length * total.ravel()

    found = minimize(
        missing, np.zeros(3 * len(free)), jac=True, method="L-BFGS-B",
        options={"maxiter": STEPS, "ftol": 1e-14, "gtol": 1e-12},
    )  # fmt: skip
    result = nodes.copy()
    result[free] = origin + length * found.x.reshape(-1, 3)
    return result


def _split(mesh: Untangled, bad: NDArray[np.bool_]) -> Untangled:
    """Each ``bad`` tetrahedron in four around a new corner in its middle."""
    nodes, elements, solid_ids, _ = mesh
    old, n = elements[bad], len(nodes)
    count = len(old)
    centres = nodes[old[:, :4]].mean(axis=1)
    middles = 0.5 * (nodes[old[:, :4]] + centres[:, None])  # of the new edges, by corner
    new = n + np.arange(count)
    amid = n + count + np.arange(4 * count).reshape(count, 4)
    parts = []
    for gone in range(4):  # its place is taken by the new corner
        part = old.copy()
        part[:, gone] = new
        for other in range(4):
            if other != gone:
                part[:, MIDDLE[gone, other]] = amid[:, other]
        parts.append(part)
    solids = np.concatenate((solid_ids[~bad], np.tile(solid_ids[bad], 4)))
    return Untangled(
        np.concatenate((nodes, centres, middles.reshape(-1, 3))),
        np.concatenate((elements[~bad], *parts)), solids, len(parts) * count,
    )  # fmt: skip
