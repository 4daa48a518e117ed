"""A few faces of a CAD model, or patches of them, meshed for real: how good the counts are.

A face is chosen as often as it holds a quantile of all triangles, so that the mean of what is
found is that of all triangles. Planes and curved faces are two populations.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from surfmesh.meshing.estimate.trial_patches import triangles_per_unit
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import face_field, mesh_face
from surfmesh.meshing.patch.refinement_loop import refined_in_rounds
from surfmesh.sizing.rules.size_limits import SizeLimits

FACES = 8
"""Faces of each population."""

SMALL, MEDIUM, PATCHES = 1500, 8000, 2
"""Triangles of a face that is meshed as a whole, or when no patch fits in; patches of a larger
one."""

ROUNDS = 3
"""How often the face is meshed at most, with the smaller sizes that it asks for."""

SPREAD = (0.5, 2.5)
"""What lies beyond is no ratio but a face that fails."""


def ratios(jobs: list[FaceJob], counts: np.ndarray) -> np.ndarray:
    """Factors (f,) on the estimated ``counts`` (f,) of the faces."""
    found = np.ones(len(jobs))
    plane = np.array([job.surface.kind == "plane" for job in jobs])
    for of in (np.flatnonzero(plane), np.flatnonzero(~plane)):
        sums = np.cumsum(counts[of])
        if not len(of) or not sums[-1] > 0.0:
            continue
        at = (np.arange(FACES) + 0.5) / FACES * sums[-1]
        chosen, times = np.unique(of[np.searchsorted(sums, at)], return_counts=True)
        of_chosen = np.array([_ratio(jobs[face], float(counts[face])) for face in chosen.tolist()])
        found[of] = np.average(of_chosen, weights=times)
    return found


def _ratio(job: FaceJob, count: float) -> float:
    """Triangles got for each of ``count``; 1 where that cannot be found out."""
    if count > SMALL:
        loops = job.rings
        found = triangles_per_unit(*face_field(job), loops, PATCHES)
        if found is not None or count > MEDIUM:
            return 1.0 if found is None else float(np.clip(found, *SPREAD))
    made = 0

    def one_round(limits: Mapping[int, SizeLimits]) -> tuple[int, dict[int, SizeLimits]]:
        nonlocal made
        mesh = mesh_face(replace(job, limits=limits.get(0)))
        made = len(mesh.triangles) or made
        if mesh.refinement is None or mesh.failure or made > SPREAD[1] * count:
            return made, {}
        return made, {0: mesh.refinement}

    known = {} if job.limits is None else {0: job.limits}
    made = refined_in_rounds(one_round, SizeLimits.joined_with, ROUNDS, known)
    return float(np.clip(made / count, *SPREAD)) if made and count > 0.0 else 1.0
