"""Coedges of a face in walking order: which follows which, and what is a loop of its own."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge
from surfmesh.cad.model.curve_samples import walked
from surfmesh.cad.model.invariants import ENDS, OPEN_FRACTION, signed_areas
from surfmesh.geometry.inside_loops import is_inside, nesting_depth
from surfmesh.geometry.rings import next_ones, ring_area
from surfmesh.geometry.small_matrices import product

Loop = tuple[CadCoedge, ...]

SAMPLES = 64
"""Of each coedge: the polygon of its loop."""

SURE = 0.5
"""Of what its corners let it differ by: a smaller area of a polygon may have the other sign."""

CLEAR, FLAT = 0.01, 1e-6
"""Of the size of a loop: others so near to it may lie on either side of its curve; of its square:
the area of one that encloses nothing."""


def start_of(coedge: CadCoedge, edges: Sequence[CadEdge]) -> int:
    """The vertex where the loop enters the coedge."""
    edge = edges[coedge.edge]
    return edge.end if coedge.reversed else edge.start


def end_of(coedge: CadCoedge, edges: Sequence[CadEdge]) -> int:
    """The vertex where the loop leaves the coedge."""
    edge = edges[coedge.edge]
    return edge.start if coedge.reversed else edge.end


def chained(coedges: Sequence[CadCoedge], edges: Sequence[CadEdge]) -> list[Loop]:
    """Coedges of one wire, in any order -> closed loops as far as they close.

    The next coedge starts at the vertex where the last one ends. Where several do (both p-curves
    of a seam, a pole) it is the one that is nearest in (u, v).
    """
    if len(coedges) == 1:
        return [tuple(coedges)]
    ends: list[list[list[float]]] = []  # looked up where there is a choice
    leaving = defaultdict(list)
    for place, coedge in enumerate(coedges):
        leaving[start_of(coedge, edges)].append(place)
    loops, used = [], [False] * len(coedges)
    for first in range(len(coedges)):
        if used[first]:
            continue
        used[first], loop, home = True, [first], start_of(coedges[first], edges)
        while True:
            last = loop[-1]
            vertex = end_of(coedges[last], edges)
            ways = [p for p in leaving[vertex] if not used[p]] + [first] * (vertex == home)
            if not ways or ways == [first]:
                break  # closed, or an open wire; `check` says so
            if len(ways) == 1:
                used[ways[0]] = True
                loop.append(ways[0])
                continue
            ends = ends or _scaled_ends(coedges)
            u, v = ends[last][1]
            starts = [ends[place][0] for place in ways]
            steps = [max(abs(start[0] - u), abs(start[1] - v)) for start in starts]
            # touching itself, a wire falls into simple loops: home wins among equals
            near = min(steps) + 1e-6
            after = first if vertex == home and steps[-1] <= near else ways[int(np.argmin(steps))]
            if after == first:
                break
            used[after] = True
            loop.append(after)
        loops.append(tuple(coedges[place] for place in loop))
    return loops


def _scaled_ends(coedges: Sequence[CadCoedge]) -> list[list[list[float]]]:
    """(n, 2 ends, 2) of coedges, in extents of all of them."""
    ends = walked(coedges, ENDS)
    return (ends / np.maximum(np.ptp(ends.reshape(-1, 2), axis=0), 1e-300)).tolist()


def there_and_back(
    pairs: Sequence[tuple[CadCoedge, CadCoedge]], edges: Sequence[CadEdge]
) -> list[Loop]:
    """Edges inside a face, each as (forward, backward) coedges -> one closed walk a component."""
    at = defaultdict(list)
    for number, (forward, _) in enumerate(pairs):
        at[start_of(forward, edges)].append((number, False))
        at[end_of(forward, edges)].append((number, True))
    loops, used = [], [False] * len(pairs)
    for number, (forward, _) in enumerate(pairs):
        if used[number]:
            continue
        walk: list[CadCoedge] = []
        stack: list[tuple[int, CadCoedge | None]] = [(start_of(forward, edges), None)]
        while stack:
            vertex, back = stack[-1]
            way = next(((n, r) for n, r in at[vertex] if not used[n]), None)
            if way is None:  # a dead end: the way back
                stack.pop()
                if back is not None:
                    walk.append(back)
                continue
            taken, from_end = way
            used[taken] = True
            there, return_way = pairs[taken][::-1] if from_end else pairs[taken]
            walk.append(there)
            stack.append((end_of(there, edges), return_way))
        loops.append(tuple(walk))
    return loops


def outer_first(loops: Sequence[Loop]) -> tuple[Loop, ...]:
    """The loop with the largest counter-clockwise area in (u, v) comes first."""
    if len(loops) < 2:
        return tuple(loops)
    outer = int(np.argmax(signed_areas(loops)))
    return (*loops[outer : outer + 1], *loops[:outer], *loops[outer + 1 :])


def misdirected(loops: Sequence[Loop], closed: bool) -> list[int]:
    """Numbers of loops that run the wrong way round for how many others lie around them.

    Outer loops run counter-clockwise, holes in them clockwise, islands in these
    counter-clockwise again. None where that is not certain: loops that are open in (u, v), go
    there and back, or come close to each other. closed: the surface is a sphere or the like, on
    which an outer loop that runs clockwise leaves all but its inside.
    """
    coedges = [coedge for loop in loops for coedge in loop]
    to_ends = walked(coedges, np.arange(SAMPLES + 1) / SAMPLES)
    samples, ends = to_ends[:, :-1], to_ends[:, [0, -1]]
    last = np.cumsum([len(loop) for loop in loops]).tolist()
    parts = [slice(start, end) for start, end in zip([0, *last], last)]
    rings = [samples[part].reshape(-1, 2) for part in parts]
    if _seem_directed(rings):
        return []
    extent = np.ptp(samples.reshape(-1, 2), axis=0)
    if not (extent > 0.0).all() or not all(_meet(ends[part], extent) for part in parts):
        return []
    areas = np.array([ring_area(ring) for ring in rings]) / np.prod(extent)
    boxes = np.array([np.ptp(ring / extent, axis=0).max() for ring in rings])
    slack = np.array([_sag_area(ring / extent) for ring in rings])
    if (np.abs(areas) <= np.maximum(FLAT * boxes**2, SURE * slack)).any():
        return []
    depth = nesting_depth([ring / extent for ring in rings]) if len(rings) > 1 else np.zeros(1, int)
    wrong = (areas > 0.0) != (depth % 2 == 0)
    if closed and (wrong & (depth == 0)).any():
        return []
    if not wrong.any() or not _are_apart([ring / extent for ring in rings], boxes):
        return []
    return np.flatnonzero(wrong).tolist()


def _seem_directed(rings: Sequence[np.ndarray]) -> bool:
    """Do polygons (k, 2) that do not meet each other all run the right way round?

    Then each lies with all its corners, of which one is looked at, within the same others; a
    corner does not count as within its own polygon.
    """
    ahead = np.array([ring_area(ring) > 0.0 for ring in rings])
    if len(rings) == 1:
        return bool(ahead[0])
    return bool((ahead != is_inside(rings, np.array([ring[0] for ring in rings]))).all())


def _sag_area(ring: np.ndarray) -> float:
    """By how much the area of a polygon (k, 2) may differ from that within its curves."""
    before, after = np.concatenate([ring[-1:], ring[:-1]]), next_ones(ring)
    sag = np.linalg.norm(ring - 0.5 * (before + after), axis=1)
    return float(product(sag, np.linalg.norm(after - before, axis=1)))


def turned(loop: Loop) -> Loop:
    """The loop walked the other way round."""
    return tuple(replace(coedge, reversed=not coedge.reversed) for coedge in loop[::-1])


def closes(loop: Loop, extent: np.ndarray) -> bool:
    """Is it closed in (u, v), and not a way round a closed surface?"""
    return _meet(walked(loop, ENDS), extent)


def _meet(ends: np.ndarray, extent: np.ndarray) -> bool:
    """Do coedges with these ends (n, 2 ends, 2) follow each other in (u, v)?"""
    steps = next_ones(ends[:, 0]) - ends[:, 1]
    return bool((np.abs(steps) <= OPEN_FRACTION * extent).all())


def _are_apart(rings: Sequence[np.ndarray], sizes: np.ndarray) -> bool:
    """Is none of the polygons (k, 2) near another, for the larger of both sizes?"""
    import shapely

    lines = shapely.linearrings(np.concatenate(rings), indices=np.repeat(
        np.arange(len(rings)), [len(ring) for ring in rings]
    ))  # fmt: skip
    one, other = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=CLEAR * sizes)
    return bool((one == other).all())
