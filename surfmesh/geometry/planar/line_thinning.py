"""Lines of a planar domain with fewer points: thinned by Douglas and Peucker, topology kept.

    chains between junctions, free ends and points that must stay; a closed one without any of
    these starts at a corner of its hull, a small one is held at three points

No line crosses another that it did not cross, and no point that must stay is passed over.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import shapely

from surfmesh.errors import DomainError
from surfmesh.geometry.planar.domain_faces import bounded_faces, loops_around
from surfmesh.geometry.planar.segment_graph import SegmentGraph
from surfmesh.geometry.small_matrices import norm

SMALL = 8.0
"""Closed lines that span less than so many distances keep three points that are far apart."""


def thinned(graph: SegmentGraph, distance: float, stays: np.ndarray) -> SegmentGraph:
    """The graph with lines that lie within ``distance`` of those given.

    stays: (n,) bool, points of the graph that are kept. Raises DomainError where that would
    change which regions there are.
    """
    chains = _chains(graph, stays, SMALL * distance)
    if not chains:
        return graph
    lines = shapely.linestrings(
        np.concatenate([graph.points[nodes] for nodes, _ in chains]),
        indices=np.repeat(np.arange(len(chains)), [len(nodes) for nodes, _ in chains]),
    )
    thin = shapely.get_parts(shapely.simplify(shapely.multilinestrings([lines])[0], distance))
    starts, ends, first = [], [], []
    for (nodes, segments), line in zip(chains, thin):
        kept = _kept(graph.points[nodes], shapely.get_coordinates(line))
        starts.append(nodes[kept[:-1]])
        ends.append(nodes[kept[1:]])
        first.append(segments[kept[:-1]])
    made = _with_segments(graph, *(np.concatenate(part) for part in (starts, ends, first)))
    _require_alike(graph, made, distance)
    return made


def _chains(
    graph: SegmentGraph, stays: np.ndarray, small: float
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points (k,) and segments (k - 1,) of each chain, its first and last point kept.

    small: length of closed chains that are cut in three.
    """
    degree = np.bincount(graph.segments.ravel(), minlength=len(graph.points))
    fixed = stays | (degree != 2)
    by_point = np.argsort(graph.segments.ravel(), kind="stable") // 2
    begin = np.concatenate([[0], np.cumsum(degree)])
    seen = np.zeros(len(graph.segments), bool)

    def walk(point: int, segment: int, stop: np.ndarray) -> tuple[list[int], list[int]]:
        nodes, along = [point], []
        while not seen[segment]:
            seen[segment] = True
            along.append(segment)
            a, b = graph.segments[segment]
            point = int(b if a == point else a)
            nodes.append(point)
            if stop[point]:
                break
            around = by_point[begin[point] : begin[point + 1]]
            segment = int(around[0] if around[1] == segment else around[1])
        return nodes, along

    found = []
    for point in np.flatnonzero(fixed & (degree > 0)).tolist():
        for segment in by_point[begin[point] : begin[point + 1]].tolist():
            if not seen[segment]:
                found.append(walk(point, segment, fixed))
    nowhere = np.zeros(len(graph.points), bool)
    for segment in range(len(seen)):
        if not seen[segment]:
            nodes, along = walk(int(graph.segments[segment, 0]), segment, nowhere)
            found += _from_corners(graph.points, nodes, along, small)
    return [(np.array(nodes), np.array(along)) for nodes, along in found]


def _from_corners(
    points: np.ndarray, nodes: list[int], along: list[int], small: float
) -> list[tuple[list[int], list[int]]]:
    """A closed chain from a corner of its hull; a small one cut at three points far apart."""
    place = points[nodes[:-1]]
    one = int(np.lexsort(place.T)[0])
    two = int(np.linalg.norm(place - place[one], axis=1).argmax())
    x, y = place[two] - place[one]
    three = int(np.abs(x * (place - place[one])[:, 1] - y * (place - place[one])[:, 0]).argmax())
    is_small = norm(place[two] - place[one]) < small
    cuts = sorted({one, two, three}) if is_small else [one]
    turned = [*nodes[cuts[0] : -1], *nodes[: cuts[0] + 1]]
    segments = [*along[cuts[0] :], *along[: cuts[0]]]
    at = [cut - cuts[0] for cut in cuts] + [len(segments)]
    return [(turned[a : b + 1], segments[a:b]) for a, b in pairwise(at)]


def _kept(points: np.ndarray, thin: np.ndarray) -> np.ndarray:
    """Numbers (k,) of the points (n, 2) that make the line ``thin`` (k, 2), in their order."""
    found, place = [], 0
    for point in thin.tolist():
        while points[place].tolist() != point:
            place += 1
        found.append(place)
        place += 1
    return np.array(found)


def _with_segments(
    graph: SegmentGraph, starts: np.ndarray, ends: np.ndarray, first: np.ndarray
) -> SegmentGraph:
    """The graph of segments (s,) between points, each in the place of ``first`` (s,) of old."""
    pairs = np.sort(np.stack([starts, ends], axis=1), axis=1)
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    pairs, first = pairs[order], first[order]
    used = np.zeros(len(graph.points), bool)
    used[pairs] = True
    used[graph.lone_points] = True
    number = np.cumsum(used) - 1
    row = np.full(len(graph.segments), -1)
    row[first] = np.arange(len(first))
    of = row[graph.loop_segments[:, 0]]
    loop_segments = np.stack([of, graph.loop_segments[:, 1]], axis=1)[of >= 0]
    arrays = {
        "points": graph.points[used],
        "segments": number[pairs].astype(np.int32),
        "lone_points": number[graph.lone_points].astype(np.int32),
        "loop_segments": loop_segments[np.lexsort(loop_segments.T[::-1])].astype(np.int32),
        "given": graph.given[first],
    }
    for array in arrays.values():
        array.setflags(write=False)
    return replace(graph, **arrays)


def _require_alike(graph: SegmentGraph, made: SegmentGraph, distance: float) -> None:
    """Raise DomainError unless both have the same regions, with the same points in them."""
    broken = made.broken_invariant()
    faces = [len(bounded_faces(one)[0]) for one in (graph, made)]
    if broken is None and faces[0] == faces[1]:
        around = [loops_around(one, one.points[one.lone_points]) for one in (graph, made)]
        if not len(around[0]) or (around[0] == around[1]).all():
            return
    raise DomainError(
        f"lines cannot be thinned by {distance:g}: parts of the domain would merge or be passed "
        "over; choose a smaller distance"
    )
