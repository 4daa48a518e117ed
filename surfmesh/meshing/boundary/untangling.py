"""Boundaries that cross themselves by less than the tolerance of their edges, taken apart.

d                        The face lies between the edges a-b-V and V-c-d, which meet in V
 `-.                     and are only as good as their tolerances: their images may cross
a --`x--- b              before, at x. No finer cutting cures that. The node b is on the
      `c ____            wrong side of c-d: it goes through it to the left, where the
             V           inside of the face is; then c through b-V. Only images in (u, v)
                         move: the points of the nodes in space stay.
"""

import numpy as np
import shapely

from surfmesh._core.triangulation import CROSSING, find_meetings
from surfmesh.geometry.small_matrices import norm

ROUNDS = 200
CLEARANCE = 0.05
"""How far beyond a segment a node goes, of the shorter of the segments concerned."""
TIGHTER = 0.97
"""Factor on the clearance after each round: narrow passages have no room for it."""

# flag of a pair of segments ab, cd: which end of which one lies on the other
_TOUCHES = ((1, 0, 0), (2, 0, 1), (4, 1, 0), (8, 1, 1))


def untangled(nodes: np.ndarray, segments: np.ndarray, reach: np.ndarray) -> np.ndarray | None:
    """Nodes (k, 2) moved so that segments (s, 2) meet at common nodes only.

    The inside is on the left of every segment. reach: (k,) how far each may go. None when some
    would have to go further.
    """
    segments = np.ascontiguousarray(segments, np.int64)
    moved = np.array(nodes, float)
    low, high = moved.min(axis=0), moved.max(axis=0)
    length = np.linalg.norm(moved[segments[:, 1]] - moved[segments[:, 0]], axis=1)
    beside = np.full(len(moved), np.inf)
    np.minimum.at(beside, segments.ravel(), np.repeat(length, 2))
    clearance = CLEARANCE
    for _ in range(ROUNDS):
        pairs, flags = meeting_pairs(moved, segments)
        if not len(pairs):
            return moved
        touched = np.zeros(len(moved), bool)
        for pair, flag in zip(pairs.tolist(), flags.tolist()):
            ends = segments[pair]
            if touched[ends].any():
                continue  # another pair has changed this one: look again
            best, node, target = np.inf, -1, None
            for p, (c, d) in _candidates(moved, ends, flag):
                gap = clearance * min(length[pair].min(), beside[p], reach[p])
                place = np.clip(_through(moved[p], moved[c], moved[d], gap), low, high)
                far = norm(place - nodes[p]) / max(reach[p], 1e-300)
                if far < best and not np.array_equal(place, moved[p]):
                    best, node, target = far, p, place
            if node < 0 or best > 1.0:
                return None
            moved[node] = target
            touched[node] = True
        clearance *= TIGHTER
    return None


def meeting_pairs(nodes: np.ndarray, segments: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (n, 2) of segments that meet other than at a common node, and their flags (n,)."""
    lines = shapely.linestrings(nodes[segments])
    first, second = shapely.STRtree(lines).query(lines)
    pairs = np.stack([first, second], axis=1)[first < second]
    flags, _ = find_meetings(nodes, segments, pairs, 0.0)
    return pairs[flags != 0], flags[flags != 0]


def _candidates(nodes: np.ndarray, ends: np.ndarray, flag: int) -> list:
    """(node, segment) of a pair of segments: which of their ends is where it should not be."""
    if flag & CROSSING:
        return [
            (p, ends[1 - k])
            for k in (0, 1)
            for p in ends[k]
            if _height(nodes[p], *nodes[ends[1 - k]]) < 0.0
        ]
    return [(ends[k, end], ends[1 - k]) for bit, k, end in _TOUCHES if flag & bit]


def _height(p: np.ndarray, c: np.ndarray, d: np.ndarray) -> float:
    """Distance of p from the line cd, positive on its left."""
    (x, y), (px, py) = d - c, p - c
    return (x * py - y * px) / max(np.hypot(x, y), 1e-300)


def _through(p: np.ndarray, c: np.ndarray, d: np.ndarray, gap: float) -> np.ndarray:
    """The place over p that lies ``gap`` to the left of the line cd."""
    x, y = d - c
    left = np.array([-y, x]) / max(np.hypot(x, y), 1e-300)
    return p + (gap - _height(p, c, d)) * left
