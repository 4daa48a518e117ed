"""One face of a CAD model: plain arrays in, a mesh of the face or the reason for none out.

nodes of its edges -> (u, v) loops -> size field -> packing -> boundary -> optimisation
(numbers, points)     seams twice     graded inward from the sizes of the edges
"""

import logging
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from traceback import extract_tb

import numpy as np

from surfmesh._core import faces as core
from surfmesh._core.faces import FaceEnd, FacePolygons, coarse_segments, may_have_tubes
from surfmesh._core.space import PointTree
from surfmesh.errors import SurfaceError, SurfmeshError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import cut_line
from surfmesh.meshing.edges.inner_sizes import sizes_along_edges
from surfmesh.meshing.faces.crossing_segments import limits_where_crossing
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, FaceMesh
from surfmesh.meshing.faces.face_parts import in_parts
from surfmesh.meshing.faces.face_repair import (
    beyond_a_turn,
    filled_face,
    no_point,
    untangled_job,
)
from surfmesh.meshing.faces.inward_faces import inward_face, manner_of
from surfmesh.meshing.faces.strip_triangulation import strip_mesh
from surfmesh.meshing.faces.thin_tubes import without_tubes
from surfmesh.meshing.faces.tube_limits import seam_limits
from surfmesh.meshing.faces.tube_triangles import with_tubes
from surfmesh.meshing.patch.patch_mesh import patch_error
from surfmesh.meshing.patch.proved_patch import Patch, cut_until_proved
from surfmesh.meshing.patch.size_requests import SizeRequests, joined
from surfmesh.sizing.field.boundary_field import boundary_field, has_boundary_field
from surfmesh.sizing.field.size_field import SizeField, size_field
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines

logger = logging.getLogger(__name__)

FINER = 0.5
"""Factor on the sizes where sides cannot be joined."""

LONGER = 1.5
"""Boundary segments so many times longer than the sizes beside them: a plane's sizes depend on
the direction from then on."""

PROJECTIONS = 4
"""Steps to the closest point of a plane or a cylinder."""


def mesh_face(job: FaceJob) -> FaceMesh:
    """Mesh one face. Never raises for what is wrong with the face: see ``failure``."""
    if job.exact is not None and job.exact.at_once:
        return FaceMesh(failure=job.exact.at_once, unmeshable=True)
    reason = no_point(job) if job.boundary.has_degenerate else ""
    if reason and beyond_a_turn(job):
        return FaceMesh(failure=reason)
    mesh = _proved(job, _mesh_parts(job))
    return replace(mesh, failure=reason) if reason and mesh.failure else mesh


def _mesh_parts(job: FaceJob) -> FaceMesh:
    """Mesh a face, its thin tips and necks by themselves."""
    surface = job.surface
    if surface.kind == "plane" or not may_have_tubes(as_core_surface(surface), job.boundary):
        return _mesh_rest(job)
    rest, tubes, slots = without_tubes(job)
    if not tubes or (job.narrow is not None and rest.loops):
        return _mesh_rest(job)
    if not rest.loops:
        return with_tubes(job, rest, FaceMesh(narrow=True), tubes, slots)
    mesh = in_parts(rest, _mesh_rest)
    return mesh if mesh.failure else with_tubes(job, rest, mesh, tubes, slots)


def continued(job: FaceJob, begun: core.FaceMesh) -> FaceMesh:
    """What becomes of a face that the core has begun, by ``inward_face``."""
    return mesh_face(job) if begun.end == FaceEnd.TUBES else _proved(job, _mesh_rest(job, begun))


def _proved(job: FaceJob, mesh: FaceMesh) -> FaceMesh:
    """With cuts, or smaller sizes asked for, where the chord is not proved to hold."""
    if not (job.optimise and job.sizing.proof) or mesh.failure or mesh.remark:
        return mesh
    points, at_rim = mesh.points.copy(), mesh.slots >= 0
    points[at_rim] = job.boundary.points[mesh.slots[at_rim]]  # as neighbours have them too
    made = Patch(
        points, mesh.triangles, mesh.uv_points, mesh.uv_triangles, mesh.sizes,
        mesh.inverse_sizes,
    )  # fmt: skip
    patch, unproved = cut_until_proved(job.surface, job.sizing, made)
    unproved = None if unproved is None else replace(unproved, uv=None)
    return replace(
        mesh, points=patch.points, triangles=patch.triangles, uv_points=patch.uv,
        uv_triangles=patch.uv_triangles, sizes=patch.sizes, inverse_sizes=patch.roots,
        slots=np.append(mesh.slots, np.full(len(patch.points) - len(mesh.points), -1)),
        refinement=joined(mesh.refinement, unproved),
    )  # fmt: skip


def _mesh_rest(job: FaceJob, begun: core.FaceMesh | None = None) -> FaceMesh:
    """Mesh a face without thin tips and necks, or what is left of one."""
    try:
        strip = strip_mesh(job)
        if strip is not None:
            return strip
        try:
            return _never_empty(job, _meshed(job, begun=begun))
        except SurfaceError:
            if job.exact is not None and job.exact.fault:
                return FaceMesh(failure=job.exact.fault, unmeshable=True)
            opened = untangled_job(job)
            if opened is None:
                if job.exact is not None and job.exact.touch:
                    return FaceMesh(failure=job.exact.touch, unmeshable=True)
                raise
            return _never_empty(job, _meshed(opened, unfold=False))
    except SurfmeshError as error:
        closed = filled_face(job, str(error)) if job.last else None
        if closed is not None:
            return closed
        if error.where is None:
            return FaceMesh(failure=str(error))
        where = np.atleast_2d(error.where)
        return FaceMesh(
            failure=str(error),
            refinement=limits_where_crossing(job, where),
            place=tuple(job.surface.evaluate(where[:1])[0][0].tolist()),
        )
    except Exception as error:  # a mistake of ours: it must not take the other faces with it
        logger.debug("internal error on %s", job.surface.name, exc_info=True)
        at = extract_tb(error.__traceback__)[-1]
        return FaceMesh(
            failure=f"internal error, please report it with the model: {type(error).__name__}: "
            f"{error} ({Path(at.filename).name}, line {at.lineno})"
        )


def _never_empty(job: FaceJob, mesh: FaceMesh) -> FaceMesh:
    """The mesh; one without triangles says why, and whether that leaves a hole."""
    if len(mesh.triangles) or mesh.failure or mesh.remark:
        return mesh
    uses: Counter[frozenset[int]] = Counter()
    for loop in job.loops:
        for piece in loop:
            uses.update(map(frozenset, pairwise(piece.numbers.tolist())))
    if all(len(ends) == 1 or count % 2 == 0 for ends, count in uses.items()):
        return replace(mesh, remark="left out, its edges lie on each other and its neighbours meet")
    return replace(mesh, failure="nothing is left of it at sizes this coarse")


def edge_refinement(job: FaceJob) -> SizeLimits | None:
    """What the sizes inside a face ask for along its edges, before it is meshed."""
    try:
        surface, field = face_field(job)
        polygons = _polygons(job, field)
    except SurfmeshError:
        return None
    coarse = coarse_segments(
        as_core_surface(surface), field.chart.core, field.background, polygons,
        job.sizing.min_size or 0.0, job.sizing.is_anisotropic,
    )  # fmt: skip
    return sizes_along_edges(job.sizing, coarse)


def _meshed(
    job: FaceJob, unfold: bool = True, begun: core.FaceMesh | None = None
) -> FaceMesh:  # fmt: skip
    """unfold: ask for smaller sizes at folds. In space, edges that cross do so at any size."""
    made = _made(job, begun)
    patch, gradient = made.patch, job.sizing.gradient
    mapped = patch.mapped
    if made.end == FaceEnd.NOT_JOINED:
        bad = mapped.non_manifold
        place = ", ".join(f"{x:.6g}" for x in mapped.points[bad[0]])
        finer = SizeLimits(mapped.points[bad], FINER * mapped.sizes[bad], gradient, essential=True)
        return FaceMesh(
            failure=f"its sides cannot be joined near ({place})",
            refinement=joined(finer, _round_tubes(job)),
        )
    chord, folds, angle = SizeRequests.of(patch.requests, gradient)
    along = sizes_along_edges(job.sizing, made.coarse)  # the edges follow them from now on
    roots = patch.metric_root_3d if job.sizing.is_anisotropic else None
    return FaceMesh(
        mapped.points, made.slots, mapped.triangles, mapped.uv, mapped.uv_triangles, mapped.sizes,
        roots, joined(angle, folds if unfold else None, chord, along),
    )  # fmt: skip


def _made(job: FaceJob, made: core.FaceMesh | None) -> core.FaceMesh:
    """What the core makes of a face; what failed is raised, but for sides that are not joined."""
    inward = inward_face(job) if made is None else None
    if inward is not None:
        made = core.mesh_inward(inward)
    if made is None or made.end == FaceEnd.UNPREPARED:
        surface, field = face_field(job)
        made = core.mesh_face(
            as_core_surface(surface), field.chart.core, field.background, _polygons(job, field),
            manner_of(job, field),
        )  # fmt: skip
    if made.end == FaceEnd.RUNS_TWICE:
        raise SurfaceError(f"the boundary of {job.surface.name!r} runs twice the same way")
    if made.end == FaceEnd.PATCH_FAILED:
        raise patch_error(made.patch, made.uv, made.segments, job.surface)
    return made


def face_field(job: FaceJob) -> tuple[FaceSurface, SizeField]:
    """The surface over the box of the loops, and sizes graded inward from them.

    Raises ``SizingError``.
    """
    boundary = job.boundary
    surface = job.surface.with_domain(boundary.box)
    grows = has_boundary_field(surface, job.sizing)
    if grows and len(boundary) and not boundary.has_degenerate and not job.sizing.is_anisotropic:
        return surface, _grown_inward(surface, job, boundary.uv, boundary.points, boundary.sizes)
    pieces = [piece for loop in job.loops for piece in loop]
    real = [piece for piece in pieces if not piece.degenerate]
    if real and grows:
        rows = ([getattr(piece, name) for piece in real] for name in ("uv", "points", "sizes"))
        field = _grown_inward(surface, job, *map(np.concatenate, rows))
        if not job.sizing.is_anisotropic or _agrees(field, real):
            return surface, field
    found = limits = job.limits
    if found is not None:
        found = found.not_below(job.sizing.min_size or 0.0)
    if real:
        places = np.concatenate([piece.uv for piece in real])
        limits = SizeLimits(
            np.concatenate([piece.points for piece in real]),
            np.concatenate([piece.sizes for piece in real]),
            job.sizing.gradient,
            places,
            as_cut=True,
        )
        # an edge knows nothing of the sizes across it, but for those that gaps ask for
        if job.sizing.is_anisotropic and job.sizing.gap is None:
            along = np.concatenate([_directions(piece.points) for piece in real])
            limits = replace(limits, metric_root_3d=along_lines(along, limits.sizes))
        if found is not None:
            near = _nearest(limits.points, found.points)
            limits = limits.joined_with(replace(found, uv=places[near]))
    numbers = np.concatenate([piece.numbers for piece in pieces])
    repeated = len(numbers) > len(np.unique(numbers)) + len(pieces)
    sides = None
    if surface.kind != "plane" and (repeated or any(piece.degenerate for piece in pieces)):
        sides = find_sides(surface)  # a seam, an edge inside, or a pole
    return surface, size_field(surface, job.sizing, sides, limits)


def _round_tubes(job: FaceJob) -> SizeLimits | None:
    real = [piece for loop in job.loops for piece in loop if not piece.degenerate]
    if not real:
        return None
    return seam_limits(
        job.surface,
        np.concatenate([piece.uv for piece in real]),
        np.concatenate([piece.numbers for piece in real]),
        np.concatenate([piece.sizes for piece in real]),
        job.sizing.gradient,
    )


def _grown_inward(
    surface: Surface, job: FaceJob, uv: np.ndarray, points: np.ndarray, sizes: np.ndarray
) -> SizeField:
    """Sizes of a plane or a cylinder: those of its edges and of earlier rounds, grown inward.

    uv (n, 2), points (n, 3), sizes (n,): of the nodes of its edges.
    """
    if job.limits is not None:
        near = uv[_nearest(points, job.limits.points)]
        place = closest_point(surface, job.limits.points, near, PROJECTIONS)[0]
        uv = np.concatenate([uv, place])
        found = np.maximum(job.limits.sizes, job.sizing.min_size or 0.0)
        sizes = np.concatenate([sizes, found])
    return boundary_field(surface, job.sizing, uv, sizes, as_cut=True)


def _agrees(field: SizeField, real: list[CoedgeNodes]) -> bool:
    """Is no segment of the boundary much longer than the sizes beside it are in all directions?"""
    for piece in real:
        middle = 0.5 * (piece.uv[1:] + piece.uv[:-1])
        sizes = field.sizes(field.chart.to_plane(middle))
        if (np.linalg.norm(np.diff(piece.points, axis=0), axis=1) > LONGER * sizes).any():
            return False
    return True


def _directions(points: np.ndarray) -> np.ndarray:
    """Unit directions (n, 3) of a polygon at its nodes (n, 3)."""
    step = np.diff(points, axis=0)
    step /= np.maximum(np.linalg.norm(step, axis=1), np.finfo(float).tiny)[:, None]
    mean = np.concatenate([step[:1], step[1:] + step[:-1], step[-1:]])
    return mean / np.maximum(np.linalg.norm(mean, axis=1), np.finfo(float).tiny)[:, None]


def _nearest(points: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Rows (k,) of the points (n, 3) that are nearest to wanted ones (k, 3)."""
    return np.asarray(PointTree(points).nearest(wanted, 1)[1])[:, 0]


def _polygons(job: FaceJob, field: SizeField) -> FacePolygons:
    """The loops in (u, v), their poles cut to unit metric length."""
    if not job.boundary.has_degenerate:
        return FacePolygons.of(job.boundary)
    parts, lengths, slot = [], [], 0
    for loop in job.loops:
        lengths.append(0)
        for piece in loop:
            parts.append(_without_end(piece, field, slot))
            slot += len(piece.numbers)
            lengths[-1] += len(parts[-1][0])
    uv, numbers, points, slots = (np.concatenate(part) for part in zip(*parts))
    return FacePolygons(uv, numbers, points, slots, np.array(lengths, np.int32))


def _without_end(
    piece: CoedgeNodes, field: SizeField, slot: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Parameters, numbers, points and slots of the nodes of one coedge but the last."""
    if not piece.degenerate:
        slots = slot + np.arange(len(piece.numbers) - 1)
        return piece.uv[:-1], piece.numbers[:-1], piece.points[:-1], slots
    line = cut_line(field, piece.uv[0], piece.uv[-1], 1)[1][:-1]
    n = len(line)
    return line, np.full(n, piece.numbers[0]), np.repeat(piece.points[:1], n, 0), np.full(n, slot)
