"""How far the edges of a face are apart: distances from samples of one to the others."""

import numpy as np

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.segments import squared_distance, squared_distance_to_box


@kernel
def edge_gaps(points, target_size, first, ends, edges, first_of_face, segments, boxes, gap):
    """Distance of each sample from the edges that share a face with its own but no vertex.

    points (n, 3): samples, of edge e those from first[e] to first[e + 1]; target_size (n,): farther
    than this is not looked at. ends (e, 2): vertices; edges, first_of_face: those of each face
    in one row. Fills segments (n, 6) and boxes (e, 6), rows (start, end) and (low, high), and
    lowers gap (n,).
    """
    for e in range(len(first) - 1):
        boxes[e, :3], boxes[e, 3:] = np.inf, -np.inf
        for p in range(first[e], first[e + 1]):
            q = min(p + 1, first[e + 1] - 1)
            for axis in range(3):
                segments[p, axis], segments[p, 3 + axis] = points[p, axis], points[q, axis]
                boxes[e, axis] = min(boxes[e, axis], points[p, axis])
                boxes[e, 3 + axis] = max(boxes[e, 3 + axis], points[p, axis])
    for face in range(len(first_of_face) - 1):
        start, end = first_of_face[face], first_of_face[face + 1]
        for i in range(start, end):
            a = edges[i]
            largest = 0.0
            for p in range(first[a], first[a + 1]):
                largest = max(largest, target_size[p])
            for j in range(start, end):
                b = edges[j]
                if a != b and not _meet(ends, a, b) and _apart2(boxes, a, b) < largest * largest:
                    _lower(points, target_size, first, segments, boxes, a, b, gap)


@kernel
def _meet(ends, a, b):
    return (
        ends[a, 0] == ends[b, 0]
        or ends[a, 0] == ends[b, 1]
        or ends[a, 1] == ends[b, 0]
        or ends[a, 1] == ends[b, 1]
    )


@kernel
def _apart2(boxes, a, b):
    """Squared distance of two boxes."""
    total = 0.0
    for axis in range(3):
        d = max(boxes[a, axis] - boxes[b, 3 + axis], boxes[b, axis] - boxes[a, 3 + axis], 0.0)
        total += d * d
    return total


@kernel
def _lower(points, target_size, first, segments, boxes, a, b, gap):
    """Lower the gaps of the samples of edge a to their distances from edge b."""
    for p in range(first[a], first[a + 1]):
        x, y, z = points[p, 0], points[p, 1], points[p, 2]
        nearest = min(gap[p], target_size[p]) ** 2
        if squared_distance_to_box(boxes, b, x, y, z) >= nearest:
            continue
        for s in range(first[b], first[b + 1] - 1):
            found = squared_distance(segments, s, x, y, z)
            if found < nearest:
                nearest = found
                gap[p] = np.sqrt(found)
