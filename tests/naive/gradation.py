"""Graded sizes of patches of nine nodes, slowly: along edges, and across triangles."""

import heapq

import numpy as np

QUARTERS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
SAMPLES = np.linspace(0.0, 1.0, 101)


def graded_by_dijkstra(patch, joined, r, slope, h):
    """h at most slope times the distance along grid edges and diagonals above any other."""
    edges = {}
    for p in patch.tolist():
        for i in range(9):
            for j in range(9):
                if i != j and abs(i % 3 - j % 3) <= 1 and abs(i // 3 - j // 3) <= 1:
                    edges.setdefault(p[i], {})[p[j]] = slope * np.linalg.norm(r[p[i]] - r[p[j]])
    for a, b in joined.tolist():
        edges[a][b] = edges[b][a] = slope * np.linalg.norm(r[a] - r[b])
    done, queue = {}, [(size, node) for node, size in enumerate(h)]
    heapq.heapify(queue)
    while queue:
        size, node = heapq.heappop(queue)
        if node not in done:
            done[node] = size
            for other, rise in edges.get(node, {}).items():
                heapq.heappush(queue, (size + rise, other))
    return np.array([done[node] for node in range(len(h))])


def least_across(r, ha, hb, slope):
    """Least of h + slope times the distance to the first of r (3, 3), on the side of the others.

    It is convex: samples lie ever closer about the smallest.
    """
    low, high = 0.0, 1.0
    for _ in range(4):
        t = low + (high - low) * SAMPLES
        side = (1 - t[:, None]) * r[1] + t[:, None] * r[2]
        values = (1 - t) * ha + t * hb + slope * np.linalg.norm(side - r[0], axis=1)
        k = int(values.argmin())
        low, high = t[max(k - 1, 0)], t[min(k + 1, len(t) - 1)]
    return values.min()


def graded_by_samples(patch, joined, r, slope, h):
    """h at most slope times the distance above what is linear on any side of a triangle.

    Each corner of a quarter of a patch sees two triangles; sides are sampled.
    """
    triangles = []
    for p in patch.tolist():
        for quarter in QUARTERS:
            corners = [p[i] for i in quarter]
            for k in range(4):
                c, a, o, b = (corners[(k + step) % 4] for step in range(4))
                triangles += [(c, a, o), (c, o, b)]
    h = graded_by_dijkstra(patch, joined, r, slope, h)
    while True:
        before = h.copy()
        for c, a, b in triangles:
            if h[c] > min(h[a], h[b]):
                h[c] = min(h[c], least_across(r[[c, a, b]], h[a], h[b], slope))
        if (h >= before * (1 - 1e-6)).all():
            return h
        h = graded_by_dijkstra(patch, joined, r, slope, h)
