"""A few faces of a CAD model, or patches of them, meshed for real: how good the counts are.

A face is chosen as often as it holds a quantile of all triangles, so that the mean of what is
found is that of all triangles. Planes and curved faces are two populations. As many faces are
tried as cost no more than a fraction of the mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.meshing.estimate.estimation import field_triangles
from surfmesh.meshing.estimate.face_counts import Alike
from surfmesh.meshing.estimate.model_estimate import JobsOf
from surfmesh.meshing.estimate.trial_patches import (
    SMALL_PATCH,
    PatchPlan,
    triangles_per_unit,
)
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import mesh_face
from surfmesh.meshing.patch.refinement_loop import refined_in_rounds
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.rules.size_limits import SizeLimits

FieldOf = Callable[[FaceJob], tuple[FaceSurface, SizeField]]

SMALL = 1500
"""Triangles of a face that is meshed as a whole."""


class _Plan(NamedTuple):
    """What is made on trial."""

    faces: int
    patch: PatchPlan
    """On a face that is not small."""

    def cost(self, counts: np.ndarray) -> float:
        """In triangles, where faces of so many are chosen."""
        return float(np.where(counts <= SMALL, counts, self.patch.cost).sum())


_PLANS = (
    _Plan(8, PatchPlan(2, 1000)),
    *(_Plan(faces, PatchPlan(1, SMALL_PATCH)) for faces in (8, 4, 2, 1)),
)
"""From the best on."""

LARGEST_FRACTION = 0.06
"""Of the triangles that are asked for, so many are made on trial: faces differ more than the parts
of one; more where sizes depend on the direction."""

ROUNDS = 3
"""How often the face is meshed at most, with the smaller sizes that it asks for."""

SPREAD = (0.5, 2.5)
"""What lies beyond is no ratio but a face that fails."""


def ratios(
    jobs: list[FaceJob], counts: np.ndarray, alike: Alike, refined: JobsOf, field: FieldOf
) -> np.ndarray:
    """Factors (f,) on the estimated ``counts`` (f,) of the faces. jobs: of the first round;
    refined: what some are tried from; field: of a job."""
    factors, leader = np.ones(len(jobs)), alike.leader
    # on a plane the optimiser has nothing to split where sizes are the same all ways
    stretched = np.array([job.sizing.is_anisotropic for job in jobs], bool)
    plane = np.array([job.surface.kind == "plane" for job in jobs], bool)
    most = LARGEST_FRACTION * counts.sum() if not stretched.any() else np.inf
    for of in (np.flatnonzero(plane & stretched), np.flatnonzero(~plane)):
        sums = np.cumsum(counts[of])
        if not len(of) or not sums[-1] > 0.0:
            continue
        for plan in _PLANS:
            at = (np.arange(plan.faces) + 0.5) / plan.faces * sums[-1]
            tried = leader[of[np.searchsorted(sums, at)]]
            chosen, times = np.unique(tried, return_counts=True)
            if plan.cost(counts[chosen]) <= most:
                each = [
                    _ratio(job, count, plan.patch, field)
                    for job, count in zip(refined(chosen.tolist()), counts[chosen].tolist())
                ]
                factors[of] = np.average(each, weights=times)
                break
    return factors


def _ratio(job: FaceJob, count: float, plan: PatchPlan, field: FieldOf) -> float:
    """Triangles got for each of ``count``; 1 where that cannot be found out."""
    if count > SMALL:
        surface, sizes = field(job)
        per_unit = triangles_per_unit(surface, sizes, job.rings, plan)
        if per_unit is None:
            return 1.0
        return float(np.clip(per_unit * field_triangles(sizes, job.rings) / count, *SPREAD))
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
