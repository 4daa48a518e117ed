"""Which nodes of a boundary are one: by number in space, by place in (u, v)."""

import numpy as np

SAME_PLACE = 1e-6
"""Images of one node nearer than this fraction of the face's box are one node in (u, v)."""

NEAR_STEP = 0.1
"""Or nearer than this fraction of the segments there."""


def coincident_nodes(uv: np.ndarray, numbers: np.ndarray, segments: np.ndarray) -> np.ndarray:
    """For each node (k,) the first that has its number and its place.

    Edges inside a face are walked there and back, loops may touch in a vertex. Images of a
    vertex that edges meet with some tolerance are one place too, if nearer to each other than
    a small part of the segments there: loops would cross in between.
    """
    kept = np.arange(len(numbers))
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(numbers[order]) != 0, True])
    if len(starts) > len(numbers):
        return kept
    place = uv / np.maximum(np.ptp(uv, axis=0), np.finfo(float).tiny)
    step = np.linalg.norm(place[segments[:, 1]] - place[segments[:, 0]], axis=1)
    near = np.full(len(numbers), np.inf)
    np.minimum.at(near, segments.ravel(), np.repeat(step, 2))
    near = np.maximum(NEAR_STEP * near, SAME_PLACE)
    for several in np.flatnonzero(np.diff(starts) > 1):
        group = order[starts[several] : starts[several + 1]]
        for k, node in enumerate(group[1:], 1):
            for earlier in group[:k]:
                if np.linalg.norm(place[node] - place[earlier]) <= near[[node, earlier]].max():
                    kept[node] = kept[earlier]
                    break
    return kept
