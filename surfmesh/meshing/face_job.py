"""One face of a CAD model: plain arrays in, a mesh of the face or the reason for none out.

    nodes of its edges -> (u, v) loops -> size field -> packing -> boundary -> optimisation
    (numbers, points)     seams twice     graded inward from the sizes of the edges
"""

from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from traceback import extract_tb

import numpy as np

from surfmesh.errors import SurfaceError, SurfmeshError
from surfmesh.geometry.projection import closest_point
from surfmesh.geometry.sides import find_sides
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.background import scalar_sizes_at
from surfmesh.meshing.boundary_loops import BoundaryLoops, cut_line
from surfmesh.meshing.boundary_recovery import recovered
from surfmesh.meshing.filling import MOST_CORNERS, filled
from surfmesh.meshing.gluing import glued, misglued
from surfmesh.meshing.optimise import Optimiser
from surfmesh.meshing.packing import packed
from surfmesh.meshing.seam_limits import seam_limits
from surfmesh.meshing.untangling import untangled
from surfmesh.sizing.boundary_field import boundary_field, has_boundary_field
from surfmesh.sizing.size_field import SizeField, inverse_sizes, size_field
from surfmesh.sizing.size_limits import SizeLimits, along_lines
from surfmesh.sizing.sizing import Sizing

SAME_PLACE = 1e-6
"""Images of one node nearer than this share of the face's box are one node in (u, v)."""

NEAR_STEP = 0.1
"""Or nearer than this share of the segments there."""

FINER = 0.5
"""Factor on the sizes where boundary segments cross."""

COARSE = 2.0
"""Segments of the boundary so many times longer than the sizes inside allow are to be cut."""

TOLERANCES = 2.0
"""Images that cross may be moved by so many tolerances of their edges,"""

SLIGHTLY, WITHIN = 0.02, 1.0
"""or by this share of the segments there; the last time, when all else has failed, further."""

SLOWEST = 0.1
"""Least speed, of the mean, that a tolerance is translated to (u, v) with."""

PROJECTIONS = 4
"""Steps to the closest point of a plane or a cylinder."""


@dataclass(frozen=True)
class Piece:
    """One coedge in walking order, with both ends.

    A degenerate edge has two nodes of the same number; it is cut when the metric is known.
    """

    uv: np.ndarray
    """(n, 2)"""
    numbers: np.ndarray
    """(n,) int64"""
    points: np.ndarray
    """(n, 3)"""
    sizes: np.ndarray
    """(n,)"""
    degenerate: bool = False
    tolerance: float = 0.0
    """The edge lies this near its images, model units."""


@dataclass(frozen=True)
class FaceJob:
    """All that is needed to mesh one face; can be pickled, knows no CAD kernel."""

    surface: Surface
    loops: tuple[tuple[Piece, ...], ...]
    sizing: Sizing
    limits: SizeLimits | None = None
    """From earlier rounds."""
    optimise: bool = True
    last: bool = False
    """Finer edges did not help: take a boundary that crosses itself apart, however far, or
    close it without regard for the surface."""

    def __post_init__(self) -> None:
        if self.limits is not None and self.limits.essential and self.sizing.min_size:
            least = min(self.sizing.min_size, float(self.limits.sizes.min()))
            object.__setattr__(self, "sizing", self.sizing.replaced(min_size=least))


@dataclass(frozen=True)
class FaceMesh:
    """Triangles along r_u x r_v, or a reason."""

    points: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    """(n, 3)"""
    slots: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    """(n,) where the point stands among the job's boundary nodes, loop after loop; -1 inside."""
    triangles: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.int32))
    uv_points: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    uv_triangles: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.int32))
    sizes: np.ndarray = field(default_factory=lambda: np.empty(0))
    inverse_sizes: np.ndarray | None = None
    """Of ``uv_points``, where sizes depend on the direction: see ``SurfaceMesh``."""
    wishes: SizeLimits | None = None
    """Smaller sizes that the face needs."""
    failure: str = ""
    remark: str = ""
    """What was done to it out of the ordinary."""


def mesh_face(job: FaceJob) -> FaceMesh:
    """Mesh one face. Never raises for what is wrong with the face: see ``failure``."""
    try:
        try:
            return _meshed(job)
        except SurfaceError:
            opened = _untangled(job)
            if opened is None:
                raise
            return _meshed(opened, unfold=False)
    except SurfmeshError as error:
        closed = _filled(job, str(error)) if job.last else None
        if closed is not None:
            return closed
        return FaceMesh(failure=str(error), wishes=_wishes_at(job, getattr(error, "where", None)))
    except Exception as error:  # a mistake of ours: it must not take the other faces with it
        at = extract_tb(error.__traceback__)[-1]
        return FaceMesh(
            failure=f"internal error, please report it with the model: {type(error).__name__}: "
            f"{error} ({Path(at.filename).name}, line {at.lineno})"
        )


def _wishes_at(job: FaceJob, where: np.ndarray | None) -> SizeLimits | None:
    """Half the sizes at the segment (2, 2) in (u, v), or the node (2,), that was refused."""
    if where is None:
        return None
    place = np.atleast_2d(where)
    if len(place) > 1:
        place = np.concatenate([place, place.mean(axis=0)[None]])
    (points,) = job.surface.evaluate(place, 0)
    pieces = [piece for loop in job.loops for piece in loop if not piece.degenerate]
    nodes = np.concatenate([piece.points for piece in pieces])
    spacing = np.concatenate([_spacing(piece.points) for piece in pieces])
    near = [int(np.linalg.norm(nodes - point, axis=1).argmin()) for point in points]
    sizes = np.full(len(points), FINER * min(float(spacing[k]) for k in near))
    least = job.sizing.min_size or 0.0
    if not (sizes > least).any() or not (sizes > 0.0).all():
        return None
    return SizeLimits(points, sizes, job.sizing.gradient)


def _untangled(job: FaceJob) -> FaceJob | None:
    """The job with images in (u, v) that do not cross; None when none do, or by too much."""
    pieces = [piece for loop in job.loops for piece in loop]
    uv, numbers, segments, starts = [], [], [], []
    total = 0
    for loop in job.loops:
        first = total
        for piece in loop:
            starts.append(total)
            uv.append(piece.uv[:-1])
            numbers.append(piece.numbers[:-1])
            total += len(piece.uv) - 1
        ring = np.arange(first, total)
        segments.append(np.stack([ring, np.roll(ring, -1)], axis=1))
    uv, numbers, ring = np.concatenate(uv), np.concatenate(numbers), np.concatenate(segments)
    nodes, row = np.unique(_distinct(uv, numbers, ring), return_inverse=True)
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
    share = WITHIN if job.last else SLIGHTLY
    reach = np.maximum(TOLERANCES * tolerance / stretch, share * beside)
    moved = untangled(plane, segments, reach)
    if moved is None or np.array_equal(moved, plane):
        return None
    moved = np.where(moved == plane, uv[nodes], moved / mean)[row]
    following = np.empty(total, np.int64)
    following[ring[:, 0]] = ring[:, 1]
    loops, at = [], iter(starts)
    for loop in job.loops:
        changed = []
        for piece in loop:
            start = next(at)
            own = np.arange(start, start + len(piece.uv) - 1)
            changed.append(replace(piece, uv=moved[np.r_[own, following[own[-1]]]]))
        loops.append(tuple(changed))
    return replace(job, loops=tuple(loops))


def _filled(job: FaceJob, reason: str) -> FaceMesh | None:
    """A face whose boundary is no loop in (u, v), closed between the nodes of its edges.

    None when it has holes, or too many nodes. Neighbours meet where it has no more than two.
    """
    rings, slot = [], 0
    for loop in job.loops:
        ring = []
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
    remark = f"closed between the nodes of its edges, off the surface, because {reason}"
    return FaceMesh(points, slots, triangles, uv, triangles, sizes, remark=remark)


def _wishes_along(
    job: FaceJob, surface: Surface, field: SizeField, loops: BoundaryLoops, points: np.ndarray
) -> SizeLimits | None:
    """What sizes grown from the inside ask for along edges that know their own surroundings only.

    points: (k, 3) of the nodes.
    """
    first, second = loops.segments.T
    length = np.linalg.norm(points[second] - points[first], axis=1)
    middle = 0.5 * (loops.uv[first] + loops.uv[second])
    sizes = np.empty(len(middle))
    scalar_sizes_at(field.background, field.scaling.to_plane(middle), sizes)
    sizes = np.maximum(sizes, job.sizing.min_size or 0.0)
    coarse = length > COARSE * sizes
    if not coarse.any():
        return None
    (places,) = surface.evaluate(middle[coarse], 0)
    return SizeLimits(places, sizes[coarse], job.sizing.gradient)


def _spacing(points: np.ndarray) -> np.ndarray:
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.minimum(np.r_[step[:1], step], np.r_[step, step[-1:]])


def _meshed(job: FaceJob, unfold: bool = True) -> FaceMesh:
    """unfold: ask for smaller sizes at folds. In space, edges that cross do so at any size."""
    surface, field = _field(job)
    loops, fixed, slots = _loops(job, field)
    width, height = field.scaling.extent
    packing = packed(
        field.background,
        (0.0, 0.0, width, height),
        (0.5 * width, 0.5 * height),
        field.expected_vertices(),
    )
    domain = recovered(packing.t, loops, field, surface)
    del packing
    same = domain.node[loops.identity]
    optimiser = Optimiser(domain.t, domain.node, same, surface, field)
    optimiser.embedding.point[domain.node] = fixed  # the edges' nodes, not their images
    wishes: SizeLimits | None = None
    if job.limits is None and not job.sizing.is_anisotropic:  # the edges heed them from now on
        wishes = _wishes_along(job, surface, field, loops, fixed)
    if job.optimise:
        changes = optimiser.run()
        for found, remedy in (
            (changes.far, optimiser.approaching), (changes.folded, optimiser.unfolding),
            (changes.turned, optimiser.straightening),
        ):  # fmt: skip
            if len(found) and (unfold or remedy != optimiser.unfolding):
                more = remedy(found)
                if len(more.sizes):
                    wishes = more.joined_with(wishes)
    else:
        optimiser.settle()
    xy = domain.t.xy[: int(domain.t.count[0])]
    uv = field.scaling.to_uv(xy)
    uv[domain.node] = loops.uv
    parts = glued(surface, loops, domain, uv)
    slot = np.full(len(xy), -1, np.int64)
    slot[domain.node] = slots
    sizes = np.empty(len(parts.place))
    scalar_sizes_at(field.background, xy[parts.place], sizes)
    sizes *= optimiser.embedding.scale[parts.place]
    bad = misglued(parts)
    if len(bad):
        finer = FINER * sizes[bad]
        wishes = SizeLimits(parts.points[bad], finer, job.sizing.gradient, essential=True)
        wishes = wishes.joined_with(_round_tubes(surface, job))
        place = ", ".join(f"{x:.6g}" for x in parts.points[bad[0]])
        return FaceMesh(failure=f"its sides cannot be joined near ({place})", wishes=wishes)
    return FaceMesh(
        parts.points, slot[parts.place], parts.triangles, parts.uv_points, parts.uv_triangles,
        sizes, inverse_sizes(field, xy, optimiser.embedding.scale[: len(xy)]), wishes,
    )  # fmt: skip


def _field(job: FaceJob) -> tuple[Surface, SizeField]:
    """The surface over the box of the loops, and sizes graded inward from them."""
    pieces = [piece for loop in job.loops for piece in loop]
    uv = np.concatenate([piece.uv for piece in pieces])
    low, high = uv.min(axis=0), uv.max(axis=0)
    surface = job.surface.with_domain(((low[0], high[0]), (low[1], high[1])))
    real = [piece for piece in pieces if not piece.degenerate]
    if real and has_boundary_field(surface, job.sizing):
        return surface, _grown_inward(surface, job, real)
    limits = job.limits
    if real:
        limits = SizeLimits(
            np.concatenate([piece.points for piece in real]),
            np.concatenate([piece.sizes for piece in real]),
            job.sizing.gradient,
            np.concatenate([piece.uv for piece in real]),
        )
        if job.sizing.is_anisotropic:  # an edge knows nothing of the sizes across it
            along = np.concatenate([_directions(piece.points) for piece in real])
            limits = replace(limits, in_space=along_lines(along, limits.sizes))
        if job.limits is not None:
            near = _nearest(limits.points, job.limits.points)
            uv_of_limits = limits.uv[near]
            limits = limits.joined_with(replace(job.limits, uv=uv_of_limits))
    numbers = np.concatenate([piece.numbers for piece in pieces])
    repeated = len(numbers) > len(np.unique(numbers)) + len(pieces)
    sides = None
    if surface.kind != "plane" and (repeated or any(piece.degenerate for piece in pieces)):
        sides = find_sides(surface)  # a seam, an edge inside, or a pole
    return surface, size_field(surface, job.sizing, sides, limits)


def _round_tubes(surface: Surface, job: FaceJob) -> SizeLimits | None:
    real = [piece for loop in job.loops for piece in loop if not piece.degenerate]
    if not real:
        return None
    return seam_limits(
        surface,
        np.concatenate([piece.uv for piece in real]),
        np.concatenate([piece.numbers for piece in real]),
        np.concatenate([piece.sizes for piece in real]),
        job.sizing.gradient,
    )


def _grown_inward(surface: Surface, job: FaceJob, real: list[Piece]) -> SizeField:
    """Sizes of a plane or a cylinder: those of its edges and of earlier rounds, grown inward."""
    uv = np.concatenate([piece.uv for piece in real])
    sizes = np.concatenate([piece.sizes for piece in real])
    if job.limits is not None:
        points = np.concatenate([piece.points for piece in real])
        near = uv[_nearest(points, job.limits.points)]
        place = closest_point(surface, job.limits.points, near, PROJECTIONS)[0]
        uv = np.concatenate([uv, place])
        sizes = np.concatenate([sizes, job.limits.sizes])
    return boundary_field(surface, job.sizing, uv, sizes)


def _directions(points: np.ndarray) -> np.ndarray:
    """Unit directions (n, 3) of a polygon at its nodes (n, 3)."""
    step = np.diff(points, axis=0)
    step /= np.maximum(np.linalg.norm(step, axis=1), np.finfo(float).tiny)[:, None]
    mean = np.concatenate([step[:1], step[1:] + step[:-1], step[-1:]])
    return mean / np.maximum(np.linalg.norm(mean, axis=1), np.finfo(float).tiny)[:, None]


def _nearest(points: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    from scipy.spatial import cKDTree

    return cKDTree(points).query(wanted)[1]


def _loops(job: FaceJob, field: SizeField) -> tuple:
    """Nodes and segments in (u, v); the nodes' points, and their places in the job."""
    uv, numbers, points, slots, segments = [], [], [], [], []
    slot = total = 0
    for loop in job.loops:
        start = total
        for piece in loop:
            count = len(piece.numbers)
            place = slot + np.arange(count)
            slot += count
            if piece.degenerate:
                t, line = cut_line(field, piece.uv[0], piece.uv[-1], 1)
                uv.append(line[:-1])
                place = np.full(len(t), place[0])
                numbers.append(np.full(len(t) - 1, piece.numbers[0]))
                points.append(np.repeat(piece.points[:1], len(t) - 1, axis=0))
            else:
                uv.append(piece.uv[:-1])
                numbers.append(piece.numbers[:-1])
                points.append(piece.points[:-1])
            slots.append(place[:-1])
            total += len(place) - 1
        ring = np.arange(start, total)
        segments.append(np.stack([ring, np.roll(ring, -1)], axis=1))
    uv, numbers = np.concatenate(uv), np.concatenate(numbers)
    points, slots = np.concatenate(points), np.concatenate(slots)
    ring_segments = np.concatenate(segments)
    kept = _distinct(uv, numbers, ring_segments)
    nodes, row = np.unique(kept, return_inverse=True)
    segments = row[ring_segments].astype(np.int32)
    segments = segments[segments[:, 0] != segments[:, 1]]
    uv, numbers, points, slots = uv[nodes], numbers[nodes], points[nodes], slots[nodes]
    _, first, inverse = np.unique(numbers, return_index=True, return_inverse=True)
    return BoundaryLoops(uv, segments, first[inverse].astype(np.int64)), points, slots


def _distinct(uv: np.ndarray, numbers: np.ndarray, segments: np.ndarray) -> np.ndarray:
    """For each node (k,) the first that has its number and its place.

    Edges inside a face are walked there and back, loops may touch in a vertex. Images of a
    vertex that edges meet with some tolerance are one place too, if nearer to each other than
    a small part of the segments there: loops would cross in between.
    """
    kept = np.arange(len(numbers))
    place = uv / np.maximum(np.ptp(uv, axis=0), np.finfo(float).tiny)
    step = np.linalg.norm(place[segments[:, 1]] - place[segments[:, 0]], axis=1)
    near = np.full(len(numbers), np.inf)
    np.minimum.at(near, segments.ravel(), np.repeat(step, 2))
    near = np.maximum(NEAR_STEP * near, SAME_PLACE)
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(numbers[order]) != 0, True])
    for begin, end in pairwise(starts):
        group = order[begin:end]
        for k, node in enumerate(group[1:], 1):
            for earlier in group[:k]:
                if np.linalg.norm(place[node] - place[earlier]) <= near[[node, earlier]].max():
                    kept[node] = kept[earlier]
                    break
    return kept
