"""Triangles that meet where they share nothing: every pair, by an exact test.

Near pairs come from a tree of boxes; the test is that of ``src/space/triangle_pairs.hpp``. Patches
that are proved not to meet themselves are skipped within (``src/space/graph_patches.hpp``), and so
are flat ones with those on one side of them (``src/space/supporting_planes.hpp``). What only comes
near, or touches in a corner at the very same place, does not meet.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import graph_patches, meeting_triangles
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.result.connectivity import Connectivity, connect
from surfmesh.result.facets import facets
from surfmesh.result.surface_mesh import SurfaceMesh

MOST = 200_000  # pairs looked for: a mesh with more of them is broken beyond counting


@dataclass(frozen=True)
class MeetingPair:
    """Two triangles that meet where they share nothing."""

    triangles: tuple[int, int]
    faces: tuple[int, int]
    point: Point  # near which they meet


def meeting_pairs(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(k, 2) numbers of the triangles that meet, the lower first, in order; at most ``MOST``.

    Points must be finite, vertex numbers in range. A triangle without area meets nothing, and
    two triangles on the same three vertices are left to ``mesh.broken_invariant()``.
    """
    if len(mesh.triangles) < 2:
        return np.empty((0, 2), np.int32)
    if mesh.order == 2 and not mesh.broken_invariant():
        return _meeting_curved(mesh)
    pairs = _meeting(mesh.points, mesh.triangles, mesh.connectivity)
    if not len(pairs):
        return pairs
    a, b = np.sort(mesh.triangles[pairs], axis=2).transpose(1, 0, 2)
    pairs = pairs[(a != b).any(axis=1)]
    return pairs[np.lexsort(pairs.T[::-1])][:MOST]


def _meeting(
    points: NDArray[np.float64], triangles: NDArray[np.int32], table: Connectivity
) -> NDArray[np.int32]:
    """(k, 2) pairs in no order; what patches prove is not looked at."""
    patches, support = graph_patches(points, triangles, table.half_edges)
    return meeting_triangles(points, triangles, MOST, patches, support)


def _meeting_curved(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """The same of quadratic triangles, by their facets."""
    cut = facets(mesh)
    pairs = _meeting(cut.points, cut.triangles, connect(cut.triangles))
    pairs = np.sort(cut.parent[pairs], axis=1)
    return np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0)


def located(mesh: SurfaceMesh, pairs: NDArray[np.int32]) -> tuple[MeetingPair, ...]:
    """Where pairs (k, 2) meet: in the middle of what the boxes of both have in common."""
    if not len(pairs):
        return ()
    corners = mesh.points[mesh.triangles[pairs]]  # (k, 2, 3, 3)
    low, high = corners.min(axis=2).max(axis=1), corners.max(axis=2).min(axis=1)
    return tuple(
        MeetingPair((a, b), (int(mesh.face_ids[a]), int(mesh.face_ids[b])), as_point(place))
        for (a, b), place in zip(pairs.tolist(), (low + high) / 2)
    )
