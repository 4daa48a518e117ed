"""Upper bounds of the size, for another round, where the chord is not proved to hold."""

import numpy as np

from surfmesh.accuracy.face_triangles import FaceTriangles, twins_of
from surfmesh.accuracy.proof import proved_distances
from surfmesh.geometry.surface import Surface
from surfmesh.result.connectivity import connect
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

FINER = 0.9
"""Times the size at which a bound that falls with its square would keep to the chord."""

FINEST, COARSEST = 0.5, 0.8
"""Of the sizes, in one round."""


def requests_for_proof(
    surface: Surface,
    sizing: Sizing,
    points: np.ndarray,
    triangles: np.ndarray,
    uv: np.ndarray,
    sizes: np.ndarray,
    roots: np.ndarray | None,
) -> SizeLimits | None:
    """Where triangles are not proved to keep to ``sizing.chord``; None where all are, or none can.

    points (n, 3), triangles (m, 3), uv (m, 3, 2), sizes (n,) of the points; roots (m, 6) of the
    metric at the triangles, where sizes depend on the direction.
    """
    if not sizing.proof or sizing.chord is None or not len(triangles):
        return None
    vertices = np.ascontiguousarray(triangles, np.int32)
    table = connect(vertices)
    twins = twins_of(table.half_edges, table.uses, len(vertices))
    corners = np.ascontiguousarray(points[vertices])
    face = FaceTriangles(corners, np.ascontiguousarray(uv), vertices, twins)
    found = proved_distances(surface, face, np.full(len(vertices), sizing.chord))
    if found is None:
        return None
    bound = found.bound
    # where nothing is bounded, as at an apex, smaller triangles would be no better
    left = np.flatnonzero((bound > sizing.chord) & np.isfinite(bound))
    if not len(left):
        return None
    factor = np.clip(FINER * np.sqrt(sizing.chord / bound[left]), FINEST, COARSEST)
    return SizeLimits(
        corners[left].mean(axis=1),
        factor * sizes[vertices[left]].mean(axis=1),
        sizing.gradient,
        uv=uv[left].mean(axis=1),
        metric_root_3d=None if roots is None else roots[left] / factor[:, None],
    )
