"""Faces whose boundary crosses itself in (u, v): taken apart in the plane, or closed in space."""

from dataclasses import replace

import numpy as np

from surfmesh._core.insertion import coincident_nodes
from surfmesh.geometry.boxes import diagonal
from surfmesh.meshing.boundary.untangling import untangled
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh, boundary_of
from surfmesh.meshing.faces.polygon_filling import MOST_CORNERS, filled

TOLERANCES, WITHIN = 2.0, 1.0
"""Images that cross may be moved by so many tolerances of their edges; the last time, when
smaller sizes have not helped, by this fraction of the segments there."""

REACH, ALONG = 0.05, 17
"""Of a face's size: a degenerate edge whose image reaches farther is no point; its samples."""

ROUND_KINDS, MOST_OF_A_TURN = ("cone", "cylinder", "sphere", "torus", "revolution"), 6.3
"""Surfaces whose u is an angle, and radians that no image of a point exceeds."""

SLOWEST = 0.1
"""Least speed, of the mean, that a tolerance is translated to (u, v) with."""


def no_point(job: FaceJob) -> str:
    """Why a degenerate piece is none: its image reaches far in space. Empty when all is well."""
    real = [piece.points for loop in job.loops for piece in loop if not piece.degenerate]
    if not real:
        return ""
    size = diagonal(np.concatenate(real))
    t = np.linspace(0.0, 1.0, ALONG)[:, None]
    for piece in (piece for loop in job.loops for piece in loop if piece.degenerate):
        (points,) = job.surface.evaluate((1.0 - t) * piece.uv[0] + t * piece.uv[-1], 0)
        reach = float(np.linalg.norm(points - piece.points[0], axis=1).max())
        if reach > REACH * size:
            place = ", ".join(f"{x:.6g}" for x in piece.points[0])
            (u0, v0), (u1, v1) = piece.uv[[0, -1]]
            return (
                f"its edge at ({place}) is to be one point, but its image from (u, v) = "
                f"({u0:.6g}, {v0:.6g}) to ({u1:.6g}, {v1:.6g}) reaches {reach:.3g} from there: the "
                "loop is open or runs the wrong way; repair the face in the program that made it"
            )
    return ""


def beyond_a_turn(job: FaceJob) -> bool:
    """Does the image of a degenerate piece span more than a turn of a round surface?"""
    if job.surface.kind not in ROUND_KINDS:
        return False
    pieces = (piece for loop in job.loops for piece in loop if piece.degenerate)
    return any(np.abs(piece.uv[-1] - piece.uv[0]).max() > MOST_OF_A_TURN for piece in pieces)


def untangled_job(job: FaceJob) -> FaceJob | None:
    """The job with images in (u, v) that do not cross; None when none do, or by too much."""
    uv, numbers, _, ring, _ = job.polygons
    pieces = [piece for loop in job.loops for piece in loop]
    starts = np.cumsum([0, *(len(piece.uv) - 1 for piece in pieces)]).tolist()
    nodes, row = coincident_nodes(uv, numbers, ring)
    segments = row[ring]
    segments = segments[segments[:, 0] != segments[:, 1]]
    _, along_u, along_v = job.surface.evaluate(uv[nodes], 1)
    speeds = np.stack([np.linalg.norm(along, axis=1) for along in (along_u, along_v)], axis=1)
    mean = np.maximum(speeds.mean(axis=0), np.finfo(float).tiny)
    plane = uv[nodes] * mean
    beside = np.full(len(nodes), np.inf)
    step = np.linalg.norm(plane[segments[:, 1]] - plane[segments[:, 0]], axis=1)
    np.minimum.at(beside, segments.ravel(), np.repeat(step, 2))
    tolerance = np.zeros(len(nodes))
    for piece, start in zip(pieces, starts):
        np.maximum.at(tolerance, row[start : start + len(piece.uv) - 1], piece.tolerance)
    stretch = np.maximum((speeds / mean).max(axis=1), SLOWEST)
    reach = TOLERANCES * tolerance / stretch
    if job.last:
        reach = np.maximum(reach, WITHIN * beside)
    moved = untangled(plane, segments, reach)
    if moved is None or np.array_equal(moved, plane):
        return None
    moved = np.where(moved == plane, uv[nodes], moved / mean)[row]
    following = np.empty(len(uv), np.int64)
    following[ring[:, 0]] = ring[:, 1]
    loops, at = [], iter(starts)
    for loop in job.loops:
        changed = []
        for piece in loop:
            start = next(at)
            own = np.arange(start, start + len(piece.uv) - 1)
            changed.append(replace(piece, uv=moved[np.r_[own, following[own[-1]]]]))
        loops.append(tuple(changed))
    return replace(job, boundary=boundary_of(loops))


def filled_face(job: FaceJob, reason: str) -> FaceMesh | None:
    """A face whose boundary is no loop in (u, v), closed between the nodes of its edges.

    None when it has holes, or too many nodes. Neighbours meet where it has no more than two.
    """
    rings, slot = [], 0
    for loop in job.loops:
        ring: list[tuple] = []
        for piece in loop:
            rows = zip(piece.numbers.tolist(), piece.points, piece.uv, piece.sizes)
            for place, (number, *row) in enumerate(rows, slot):
                if not piece.degenerate and (not ring or ring[-1][0] != number):
                    ring.append((number, place, *row))
            slot += len(piece.numbers)
        while len(ring) > 1 and ring[0][0] == ring[-1][0]:
            ring.pop()
        if len(ring) > 2:
            rings.append(ring)
    if not rings:
        return FaceMesh(remark=f"left out, its neighbours meet, because {reason}")
    while len(rings) > 1:  # loops that touch in a vertex are one
        first, other = rings[0], rings.pop()
        meets = [(i, k) for i, a in enumerate(first) for k, b in enumerate(other) if a[0] == b[0]]
        if not meets:
            return None
        i, k = meets[0]
        rings[0] = first[:i] + other[k:] + other[:k] + first[i:]
    if len(rings[0]) > MOST_CORNERS:
        return None
    numbers, slots, points, uv, sizes = (np.array(column) for column in zip(*rings[0]))
    triangles = filled(points)
    corners = numbers[triangles]
    triangles = triangles[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    if not len(triangles):  # edges run there and back: nothing lies between them
        return None
    remark = f"closed between the nodes of its edges, off the surface, because {reason}"
    return FaceMesh(points, slots, triangles, uv, triangles, sizes, remark=remark)
