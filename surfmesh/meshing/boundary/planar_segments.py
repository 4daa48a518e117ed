"""Step 1 of section 3 in the plane: the segments of a domain, cut to unit metric length.

A segment that is shorter than the target size, or a gap between two lines that is narrower,
asks for a smaller size there; from there sizes grow again as ``growth`` allows.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.geometry.planar.segment_graph import SegmentGraph
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.rules.size_limits import SizeLimits

FIRST_INTERVALS, MOST_HALVINGS = 4, 40
"""Intervals of every segment in which its metric length is first looked at."""

UNEVEN, SHORTEST_INTERVAL, LONGEST_INTERVAL = 1.3, 0.05, 4.0
"""They are halved where sizes differ by this factor, unless shorter than this, and where they
are longer than so many nodes would be apart: a gap in the middle would be missed."""

SHORT = 1.0
"""A size source where a segment is shorter than this times the size, or a gap narrower."""


@dataclass(frozen=True)
class PlanarSegments:
    """Nodes and subsegments: the parts into which they cut the segments of a graph, in the order of
    the lines that were given."""

    uv: np.ndarray
    """(k, 2) nodes, exact."""
    subsegments: np.ndarray
    """(s, 2) int32 pairs of nodes."""
    segment: np.ndarray
    """(s,) int32, the segment of the graph that each is part of."""
    graph: SegmentGraph


def metric_length(graph: SegmentGraph, field: SizeField) -> float:
    """Of all segments, roughly: about how many subsegments they will be cut into."""
    start, end = (graph.points[graph.segments[:, k]] for k in (0, 1))
    owner = np.arange(len(start))
    places = [np.full(len(start), t) for t in (0.0, 0.5, 1.0)]
    first, middle, last = (_speed(field, start, end, owner, t) for t in places)
    return float((first + 4.0 * middle + last).sum() / 6.0)


def cut_segments(graph: SegmentGraph, field: SizeField) -> PlanarSegments:
    """Cut every segment into parts of equal metric length near 1; lone points become nodes."""
    order = _walk(graph)
    start, end = (graph.points[graph.segments[order, k]] for k in (0, 1))
    fractions, steps = _metric_steps(field, start, end)
    lengths = np.array([part[-1] for part in steps])
    count = np.maximum(1, np.round(lengths)).astype(np.int64)
    inner = count - 1
    owner = np.repeat(np.arange(len(order)), inner)
    within = np.arange(len(owner)) - np.repeat(np.cumsum(inner) - inner, inner) + 1
    t = np.empty(len(owner))
    begin = np.cumsum(inner) - inner
    for k in np.flatnonzero(inner).tolist():
        wanted = lengths[k] * within[begin[k] : begin[k] + inner[k]] / count[k]
        t[begin[k] : begin[k] + inner[k]] = np.interp(wanted, steps[k], fractions[k])
    between = start[owner] + t[:, None] * (end - start)[owner]

    # one row of tokens a segment: its first point, its inner nodes, its last point
    points = len(graph.points)
    first = np.cumsum(count + 1) - (count + 1)
    tokens = np.empty(int((count + 1).sum()), np.int64)
    tokens[first] = graph.segments[order, 0]
    tokens[first + count] = graph.segments[order, 1]
    tokens[first[owner] + within] = points + np.arange(len(owner))
    ends = np.ones(len(tokens), bool)
    ends[first + count] = False
    place = np.flatnonzero(ends)
    unique, seen = np.unique(np.concatenate([tokens, graph.lone_points]), return_index=True)
    number = np.empty(points + len(owner), np.int32)
    number[unique[np.argsort(seen)]] = np.arange(len(unique), dtype=np.int32)
    uv = np.empty((len(unique), 2))
    uv[number] = np.concatenate([graph.points, between])
    subsegments = np.stack([number[tokens[place]], number[tokens[place + 1]]], axis=1)
    return PlanarSegments(uv, subsegments, np.repeat(order, count).astype(np.int32), graph)


def _walk(graph: SegmentGraph) -> np.ndarray:
    """The segments (s,) in an order in which most follow a neighbour: insertion is local then.

    Depends on the graph alone, not on the direction in which lines were given.
    """
    s = len(graph.segments)
    ends = graph.segments.ravel()
    by_point = np.argsort(ends, kind="stable") // 2
    first = np.searchsorted(np.sort(ends), np.arange(len(graph.points) + 1)).tolist()
    segments, by_point = graph.segments.tolist(), by_point.tolist()
    seen, order = [False] * s, []
    for start in range(s):
        k = start
        point = segments[k][0]
        while k >= 0 and not seen[k]:
            seen[k] = True
            order.append(k)
            a, b = segments[k]
            point = b if a == point else a
            around = by_point[first[point] : first[point + 1]]
            k = next((other for other in around if not seen[other]), -1)
    return np.array(order, np.int64)


def _metric_steps(
    field: SizeField, start: np.ndarray, end: np.ndarray
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Fractions of each segment from 0 to 1, and the metric length up to there.

    Intervals are halved until the size hardly changes within each.
    """
    owner = np.repeat(np.arange(len(start)), FIRST_INTERVALS)
    first = np.tile(np.arange(FIRST_INTERVALS) / FIRST_INTERVALS, len(start))
    width = np.full(len(owner), 1.0 / FIRST_INTERVALS)
    parts: list[tuple[np.ndarray, ...]] = []
    for halving in range(MOST_HALVINGS + 1):
        speed = np.stack(
            [_speed(field, start, end, owner, first + k * width) for k in (0.0, 0.5, 1.0)]
        )
        length = width * (speed[0] + 4.0 * speed[1] + speed[2]) / 6.0  # Simpson
        low, high = speed.min(axis=0), speed.max(axis=0)
        uneven = (high > UNEVEN * low) & (high * width > SHORTEST_INTERVAL)
        split = (uneven | (high * width > LONGEST_INTERVAL)) & (halving < MOST_HALVINGS)
        parts.append((owner[~split], first[~split], length[~split]))
        owner = np.concatenate([owner[split], owner[split]])
        width = np.tile(0.5 * width[split], 2)
        first = np.concatenate([first[split], first[split] + width[: len(width) // 2]])
        if not len(owner):
            break
    owner, first, length = (np.concatenate(part) for part in zip(*parts))
    order = np.lexsort((first, owner))
    cuts = np.searchsorted(owner[order], np.arange(1, len(start)))
    fractions = [np.append(part, 1.0) for part in np.split(first[order], cuts)]
    return fractions, [np.append(0.0, np.cumsum(part)) for part in np.split(length[order], cuts)]


def _speed(
    field: SizeField, start: np.ndarray, end: np.ndarray, owner: np.ndarray, t: np.ndarray
) -> np.ndarray:
    """Metric length a unit of ``t`` (n,), fractions of the segments ``owner``."""
    step = (end - start)[owner]
    xy = field.chart.to_plane(start[owner] + t[:, None] * step)
    return field.metric_lengths(xy, step / field.chart.rates(xy))


def short_segments(graph: SegmentGraph, slope: float) -> SizeLimits | None:
    """Sizes no larger than the shortest segment at each point of the graph."""
    if not len(graph.segments):
        return None
    length = np.linalg.norm(np.diff(graph.points[graph.segments], axis=1)[:, 0], axis=1)
    shortest = np.full(len(graph.points), np.inf)
    for side in graph.segments.T:
        np.minimum.at(shortest, side, length)
    ends = np.flatnonzero(np.isfinite(shortest))
    return _limits(graph.points[ends], shortest[ends], slope)


def narrow_gaps(
    domain: PlanarDomain, cut: PlanarSegments, field: SizeField, slope: float, fraction: float = 1.0
) -> SizeLimits | None:
    """Sizes no larger than this fraction of the distance to lines that a node's own does not meet.

    Lines that share a point with it are left out: their corner is as sharp as it is.
    """
    import shapely

    graph = domain.graph
    target = field.sizes(field.chart.to_plane(cut.uv))
    lines = shapely.linestrings(graph.points[graph.segments])
    tree = shapely.STRtree(lines)
    places = shapely.points(cut.uv)
    node, near = tree.query(places, predicate="dwithin", distance=SHORT * target / fraction)
    # a node may end several segments: it meets whatever shares a point with one of them
    meets = _meeting(graph, cut, node, near)
    node, near = node[~meets], near[~meets]
    if not len(node):
        return None
    gap = fraction * shapely.distance(places[node], lines[near])
    narrowest = np.full(len(cut.uv), np.inf)
    np.minimum.at(narrowest, node, gap)
    found = np.flatnonzero(narrowest < SHORT * target)
    return _limits(cut.uv[found], narrowest[found], slope) if len(found) else None


def _meeting(
    graph: SegmentGraph, cut: PlanarSegments, node: np.ndarray, near: np.ndarray
) -> np.ndarray:
    """Do the segments ``near`` share a point with a segment of the nodes ``node``, both (n,)?"""
    from scipy.sparse import coo_array

    def table(rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]) -> coo_array:
        return coo_array((np.ones(rows.size, bool), (rows.ravel(), columns.ravel())), shape)

    s = len(graph.segments)
    number = np.repeat(np.arange(s), 2)
    at_point = table(number, graph.segments, (s, len(graph.points))).tocsr()
    touching = (at_point @ at_point.T).tocsr()
    of_node = table(cut.subsegments, np.repeat(cut.segment, 2), (len(cut.uv), s)).tocsr()
    return np.asarray((of_node @ touching).tocsr()[node, near]).ravel().astype(bool)


def _limits(places: np.ndarray, sizes: np.ndarray, slope: float) -> SizeLimits:
    space = np.column_stack([places, np.zeros(len(places))])
    return SizeLimits(space, sizes, slope, places)
