"""Curved tetrahedra that are turned inside out in a part are mended from within; the surface stays.

A smooth surface leaves no room in a tetrahedron of which three edges begin in one tangent plane,
nor at an inner side of which two edges do. So where no move of inner nodes mends a tetrahedron, an
inner edge of it between two corners of the surface is split with all tetrahedra around it; one
that has no such edge is split in four:

        3                3                3
       /|\\              /|\\              /|\\     m: a new corner, where the middle of the
      / | \\            / | \\            / p \\       inner edge 0-2 was
     0--|--2    ->    0--m--2    or    0-'|'-2   p: a new corner in the middle
      \\ | /            \\ | /            \\ | /
        1                1                1

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
from surfmesh.volume.volume_mesh import LEGS

LEAST = 0.1  # of the straight tetrahedron's Jacobian, that is aimed for
ROUNDS = 4  # of moves and splits; splits without end would help nobody
STEPS = 200  # of the minimisation


class Untangled(NamedTuple):
    nodes: NDArray[np.float64]  # the given ones in their order, then new ones
    elements: NDArray[np.int64]  # (k, 10)
    solid_ids: NDArray[np.int32]  # (k,)
    left: int  # tetrahedra that are still not proved to be well turned


def untangled(
    nodes: NDArray[np.float64], elements: NDArray, solid_ids: NDArray[np.int32], fixed: int
) -> Untangled:
    """Tetrahedra of ten nodes with inner nodes moved, and some split, so that maps are one to one.

    fixed: that many nodes stay, those of the surface.
    """
    bad = _inside_out(nodes, elements)
    best = Untangled(nodes, elements.astype(np.int64), solid_ids, int(bad.sum()))
    tried = best
    for _ in range(ROUNDS):
        if not tried.left:
            break
        nodes = _moved(tried.nodes, tried.elements, bad, fixed)
        bad = _inside_out(nodes, tried.elements)
        tried = tried._replace(nodes=nodes, left=int(bad.sum()))
        if tried.left < best.left:
            best = tried
        if tried.left:
            tried = _split(tried, bad, fixed)
            bad = _inside_out(tried.nodes, tried.elements)
    return best


def _inside_out(nodes: NDArray, elements: NDArray) -> NDArray[np.bool_]:
    """Whether a tetrahedron is not proved to be well turned, or a straight one is not."""
    turned = straight_jacobians(nodes[elements]) <= 0.0
    return turned | (least_jacobians(nodes, elements) <= 0.0)


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


def _split(mesh: Untangled, bad: NDArray[np.bool_], fixed: int) -> Untangled:
    """Inner edges of ``bad`` tetrahedra between corners of the surface; or tetrahedra in four."""
    inner = (mesh.elements[:, 4:] >= fixed) & (mesh.elements[:, LEGS] < fixed).all(axis=2)
    chosen = _apart(mesh.elements, np.unique(mesh.elements[bad, 4:][inner[bad]]), bad)
    hopeless = bad & ~inner.any(axis=1)
    return _split_edges(_split_in_four(mesh, hopeless), chosen)


def _apart(elements: NDArray, middles: NDArray, bad: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Those middles of edges of which no tetrahedron has two: in most ``bad`` ones first."""
    at, edge = np.nonzero(np.isin(elements[:, 4:], middles))
    number = np.searchsorted(middles, elements[at, 4 + edge])
    ends = np.cumsum(np.bincount(number, minlength=len(middles)))
    rows = np.split(at[np.argsort(number, kind="stable")], ends)  # around each of them
    taken, chosen = np.zeros(len(elements), bool), []
    for k in sorted(range(len(middles)), key=lambda k: (-int(bad[rows[k]].sum()), k)):
        if not taken[rows[k]].any():
            taken[rows[k]] = True
            chosen.append(middles[k])
    return np.array(chosen, np.int64)


def _split_edges(mesh: Untangled, chosen: NDArray[np.int64]) -> Untangled:
    """The tetrahedra around edges in two each: nodes amid these edges become corners."""
    nodes, elements, solid_ids, _ = mesh
    at, edge = np.nonzero(np.isin(elements[:, 4:], chosen))
    old, new = elements[at], elements[at, 4 + edge]
    legs = np.sort(np.stack((old[:, :4], np.repeat(new[:, None], 4, axis=1)), axis=2), axis=2)
    pairs, inverse = np.unique(legs.reshape(-1, 2), axis=0, return_inverse=True)
    amid = len(nodes) + inverse.reshape(-1, 4)  # of the new edges, by corner
    row = np.arange(len(at))
    parts = [_with_corner(old, LEGS[edge, end], new, amid, row) for end in (0, 1)]
    kept = np.ones(len(elements), bool)
    kept[at] = False
    return Untangled(
        np.concatenate((nodes, nodes[pairs].mean(axis=1))),
        np.concatenate((elements[kept], *parts)),
        np.concatenate((solid_ids[kept], np.tile(solid_ids[at], 2))), 2 * len(at),
    )  # fmt: skip


def _with_corner(
    old: NDArray, gone: NDArray, new: NDArray, amid: NDArray, row: NDArray
) -> NDArray[np.int64]:
    """Tetrahedra (k, 10) with the corners ``new`` in the place of ``gone``, 0 to 3.

    amid: (k, 4) the nodes amid the edges from ``new`` to the old corners.
    """
    part = old.copy()
    part[row, gone] = new
    for step in (1, 2, 3):
        other = (gone + step) % 4
        part[row, MIDDLE[gone, other]] = amid[row, other]
    return part


def _split_in_four(mesh: Untangled, bad: NDArray[np.bool_]) -> Untangled:
    """Each ``bad`` tetrahedron in four around a new corner in its middle."""
    nodes, elements, solid_ids, _ = mesh
    old, n = elements[bad], len(nodes)
    count = len(old)
    centres = nodes[old[:, :4]].mean(axis=1)
    middles = 0.5 * (nodes[old[:, :4]] + centres[:, None])  # of the new edges, by corner
    new = n + np.arange(count)
    amid = n + count + np.arange(4 * count).reshape(count, 4)
    row = np.arange(count)
    parts = [_with_corner(old, np.full(count, gone), new, amid, row) for gone in range(4)]
    solids = np.concatenate((solid_ids[~bad], np.tile(solid_ids[bad], 4)))
    return Untangled(
        np.concatenate((nodes, centres, middles.reshape(-1, 3))),
        np.concatenate((elements[~bad], *parts)), solids, len(parts) * count,
    )  # fmt: skip
