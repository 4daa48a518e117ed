"""Faces whose sizes the core grows inward from their edges: planes and cylinders without a law."""

from surfmesh._core.faces import FaceManner, InwardFace
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.boundary_field import has_boundary_field, largest_size, speeds_of
from surfmesh.sizing.options.sizing import Sizing


def inward_face(job: FaceJob, look_for_tubes: bool = False) -> InwardFace | None:
    """What the core meshes a face from; None where it needs to be told the sizes inside."""
    surface, sizing = job.surface, job.sizing
    if not _can_grow_inward(job):
        return None
    (u0, u1), (v0, v1) = domain = job.boundary.box
    if not (u0 < u1 and v0 < v1):
        return None
    return InwardFace(
        as_core_surface(surface), job.boundary, speeds_of(surface),
        largest_size(surface, sizing, domain), sizing.gradient, manner_of(job, sizing),
        look_for_tubes and surface.kind != "plane",
    )  # fmt: skip


def manner_of(job: FaceJob, sizing: Sizing) -> FaceManner:
    """How a face is meshed with these sizes."""
    return FaceManner(
        sizing.straight_chord, sizing.angle, sizing.min_size or 0.0,
        job.optimise, job.limits is None, sizing.is_anisotropic, sizing.gradient,
    )  # fmt: skip


def _can_grow_inward(job: FaceJob) -> bool:
    """Does the core know all of a face's sizes: those of its edges and one that bounds them?"""
    sizing = job.sizing
    return (
        job.limits is None
        and not sizing.is_anisotropic
        and not (sizing.chord is None and sizing.angle is None and sizing.size is None)
        and has_boundary_field(job.surface, sizing)
        and not job.boundary.has_degenerate
    )
