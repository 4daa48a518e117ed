"""Loops that leave no inside on their left.

flat              there and back outside        as a hole in nothing
 ____              ______                          ______
(____)            |      |-----                   |      |
                  |______|                        |______|
"""

from __future__ import annotations

import numpy as np

from surfmesh.cad.model.loop_curves import LoopCurves
from surfmesh.geometry.inside_loops import is_inside, nesting_depth
from surfmesh.geometry.rings import ring_area
from surfmesh.geometry.small_matrices import norm

FLAT = 1e-9
"""Of the square of their length: loops that enclose less enclose nothing."""


def empty_loop(loops: LoopCurves) -> str:
    """In words, when the loops leave no inside on their left."""
    rings = [_polygon(loops, k) for k in range(len(loops.of_face.loops))]
    areas = np.array([ring_area(ring) for ring in rings])
    lengths = [np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).sum() for ring in rings]
    flat = np.abs(areas) <= np.maximum(FLAT * np.square(lengths), _slack(loops) * lengths)
    for number in np.flatnonzero(flat).tolist():
        if not _is_slit(loops, number) and not _is_shared(loops, number):
            return f"its loop {number} encloses nothing near {_corner(loops, number)}"
    real = np.flatnonzero(~flat)
    if not len(real):
        return ""
    whisker = _outside(loops, [rings[k] for k in real])
    if whisker is not None:
        edge, place = loops.coedges[whisker].edge, loops.point(whisker, 0.5)
        return f"its edge {edge} runs there and back outside of its other edges, at {place}"
    depth = nesting_depth([rings[k] for k in real])
    for number, deep in zip(real.tolist(), depth.tolist()):
        if (areas[number] > 0.0) != (deep % 2 == 0):
            way = "counter-clockwise" if areas[number] > 0.0 else "clockwise"
            return (
                f"its loop {number} near {_corner(loops, number)} runs {way} within {deep} "
                "others: they enclose nothing"
            )
    return ""


def _outside(loops: LoopCurves, rings: list[np.ndarray]) -> int | None:
    """A curve that is walked there and back where nothing is inside."""
    half = np.array([0.5])
    by_edge: dict[int, int] = {}
    for number, coedge in enumerate(loops.coedges):
        other = by_edge.setdefault(coedge.edge, number)
        if other != number:
            middle, back = loops.curves[other].evaluate(half), loops.curves[number].evaluate(half)
            reach = 4.0 * max(loops.near[number], loops.tolerance[number])
            if norm(middle - back) <= reach and not is_inside(rings, middle)[0]:
                return number
    return None


def _slack(loops: LoopCurves) -> np.ndarray:
    """(loops,) how far the edges of each may deviate from their p-curves."""
    return np.maximum.reduceat(np.maximum(loops.tolerance, loops.near), loops.first[:-1])


def _is_shared(loops: LoopCurves, loop: int) -> bool:
    """Do neighbours hold every edge of it? Then it is closed without an inside."""
    return all(loops.of_face.shared[k] for k in loops.of_loop(loop))


def _polygon(loops: LoopCurves, loop: int) -> np.ndarray:
    own = [loops.curves[k] for k in loops.of_loop(loop)]
    return np.concatenate(
        [curve.evaluate(np.linspace(0.0, 1.0, 4 * curve.pieces + 1)[:-1]) for curve in own]
    )


def _is_slit(loops: LoopCurves, loop: int) -> bool:
    """Is every edge of the loop walked there and back?"""
    edges = sorted(coedge.edge for coedge in loops.of_face.loops[loop])
    return edges[::2] == edges[1::2]


def _corner(loops: LoopCurves, loop: int) -> str:
    return loops.point(loops.first[loop], 0.0)
