"""A face that falls into several pieces of (u, v): each is meshed alone, over its own box.

Between them lies what has been cut out, a neck for example; a field over all would resolve it.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.rings import ring_area
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh, boundary_of


def in_parts(job: FaceJob, mesh: Callable[[FaceJob], FaceMesh]) -> FaceMesh:
    """The meshes of all pieces of a job in one; the first that has failed, if one has."""
    groups = _groups(job)
    if len(groups) < 2:
        return mesh(job)
    counts = [sum(len(piece.numbers) for piece in loop) for loop in job.loops]
    starts = np.cumsum([0, *counts])
    found, slots = [], []
    for group in groups:
        part = mesh(replace(job, boundary=boundary_of(job.loops[k] for k in group)))
        if part.failure:
            return part
        found.append(part)
        slots.append(np.concatenate([starts[k] + np.arange(counts[k]) for k in group]))
    return _together(found, slots)


def _groups(job: FaceJob) -> list[list[int]]:
    """Numbers of the loops of each piece: an outer loop and its holes."""
    rings = job.rings
    areas = [ring_area(ring) for ring in rings]
    outer = sorted((k for k, area in enumerate(areas) if area > 0.0), key=lambda k: areas[k])
    if len(outer) < 2:
        return [[*range(len(rings))]]
    groups = {k: [k] for k in sorted(outer)}
    for k, ring in enumerate(rings):
        if k not in groups:
            place = 0.5 * (ring[:1] + ring[1:2])
            owner = next((o for o in outer if is_inside([rings[o]], place)[0]), outer[-1])
            groups[owner].append(k)
    return list(groups.values())


def _together(parts: list[FaceMesh], slots: list[np.ndarray]) -> FaceMesh:
    """One mesh of several; slots: of the whole job for those of each part."""
    first = np.cumsum([0, *(len(part.points) for part in parts)])
    first_uv = np.cumsum([0, *(len(part.uv_points) for part in parts)])
    own = [np.where(part.slots >= 0, slot[part.slots], -1) for part, slot in zip(parts, slots)]
    refinement = None
    for part in parts:
        if part.refinement is not None:
            refinement = part.refinement.joined_with(refinement)
    whole = parts[0].inverse_sizes is not None
    return replace(
        parts[0],
        points=np.concatenate([part.points for part in parts]),
        slots=np.concatenate(own),
        triangles=np.concatenate([p.triangles + k for p, k in zip(parts, first)]).astype(np.int32),
        uv_points=np.concatenate([part.uv_points for part in parts]),
        uv_triangles=np.concatenate(
            [part.uv_triangles + k for part, k in zip(parts, first_uv)]
        ).astype(np.int32),
        sizes=np.concatenate([part.sizes for part in parts]),
        inverse_sizes=np.concatenate([part.inverse_sizes for part in parts]) if whole else None,
        refinement=refinement,
        remark="; ".join(dict.fromkeys(part.remark for part in parts if part.remark)),
    )
