"""Coedges of a face in walking order: which follows which, and what is a loop of its own."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from surfmesh.cad.invariants import ENDS, signed_area
from surfmesh.cad.model import CadCoedge, CadEdge

Loop = tuple[CadCoedge, ...]


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

    The next coedge starts at the vertex where the last one ends. Where several do (both images
    of a seam, a pole) it is the one that is nearest in (u, v).
    """
    ends = np.array([coedge.walk(ENDS) for coedge in coedges])  # (n, 2 ends, 2)
    scale = np.maximum(np.ptp(ends.reshape(-1, 2), axis=0), 1e-300)
    ends = ends / scale
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
            vertex, here = end_of(coedges[last], edges), ends[last, 1]
            ways = [p for p in leaving[vertex] if not used[p]] + [first] * (vertex == home)
            if not ways:
                break  # an open wire; `check` says so
            steps = [np.abs(ends[place, 0] - here).max() for place in ways]
            # touching itself, a wire falls into simple loops: home wins among equals
            near = min(steps) + 1e-6
            after = first if vertex == home and steps[-1] <= near else ways[int(np.argmin(steps))]
            if after == first:
                break
            used[after] = True
            loop.append(after)
        loops.append(tuple(coedges[place] for place in loop))
    return loops


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
        stack = [(start_of(forward, edges), None)]
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
            away, back = pairs[taken][::-1] if from_end else pairs[taken]
            walk.append(away)
            stack.append((end_of(away, edges), back))
        loops.append(tuple(walk))
    return loops


def outer_first(loops: Sequence[Loop]) -> tuple[Loop, ...]:
    """The loop with the largest counter-clockwise area in (u, v) comes first."""
    areas = [signed_area(loop) for loop in loops]
    outer = int(np.argmax(areas)) if areas else 0
    return (*loops[outer : outer + 1], *loops[:outer], *loops[outer + 1 :])
