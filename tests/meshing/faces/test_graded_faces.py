"""Curved faces meshed by the core in a queue: each as Python meshes it by itself."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core import faces as core
from surfmesh.meshing.faces import face_mesh
from surfmesh.meshing.faces.face_mesh import mesh_face
from surfmesh.meshing.faces.face_queue import FaceQueue
from surfmesh.meshing.faces.graded_faces import GradedFaces
from surfmesh.sizing.rules.size_limits import SizeLimits
from surfmesh.sizing.rules.size_rules import asked_rules
from tests.meshing.faces.test_face_queue import jobs_of, require_same, worked


def loft():
    return cq.Workplane().rect(4, 4).workplane(offset=5).circle(1.2).loft()


def rounded():
    """Planes, cylinders, tori where rounded edges run round, and spheres with poles."""
    return cq.Workplane().box(6, 4, 2).edges("|Z").fillet(1.0).faces(">Z").edges().fillet(0.4)


def turned():
    """Cones, a closed torus with two seams, a surface of revolution and an extruded spline."""
    cone = cq.Workplane().circle(1.0).workplane(offset=2).circle(0.4).loft()
    torus = cq.Workplane(cq.Solid.makeTorus(3, 0.5)).translate((0, 0, 6))
    vase = [(0.5, 0), (1.0, 1.0), (0.6, 2.0), (0.9, 3.0)]
    made = cq.Workplane("XZ").moveTo(0, 0).lineTo(0.5, 0).spline(vase[1:], includeCurrent=True)
    made = made.lineTo(0, 3).close().revolve(360, (0, 0, 0), (0, 1, 0)).translate((6, 0, 0))
    wave = cq.Workplane().moveTo(0, 0).spline([(1, 0.4), (2, -0.3), (3, 0.2)], includeCurrent=True)
    wave = wave.lineTo(3, 2).lineTo(0, 2).close().extrude(1.0).translate((0, 8, 0))
    parts = [part.val() for part in (cone, torus, made, wave)]
    return cq.Workplane(cq.Compound.makeCompound(parts))


SIZINGS = {
    "size": sm.Sizing(size=0.3),
    "chord": sm.Sizing(chord=0.01),
    "angle": sm.Sizing(angle=15.0),
    "all": sm.Sizing(chord=0.02, angle=25.0, size=0.6, min_size=0.05, max_size=0.7, growth=1.6),
    "quadratic": sm.Sizing(chord=0.01, order=2),
    "balanced": sm.Sizing(chord=0.02, vertices="balanced"),
}


@pytest.mark.parametrize("sizing", SIZINGS.values(), ids=SIZINGS)
@pytest.mark.parametrize("part", [loft, rounded, turned])
def test_the_core_meshes_as_python_does(part, sizing):
    jobs = jobs_of(part(), sizing)
    queue = FaceQueue(jobs, range(len(jobs)))
    graded = {k for k, job in enumerate(jobs) if GradedFaces().face(job) is not None}
    made = worked(queue)
    assert graded and graded <= made.keys()
    for number in graded:
        require_same(made[number], mesh_face(jobs[number]))


def test_nearly_all_kinds_are_meshed_without_python(monkeypatch):
    def refused(job, *_):
        raise AssertionError(f"{job.surface.kind} is meshed by Python")

    monkeypatch.setattr(face_mesh, "face_field", refused)
    kinds = set()
    for part in (loft, rounded, turned):
        jobs = jobs_of(part(), 0.3)
        made = worked(FaceQueue(jobs, range(len(jobs))))
        kinds |= {jobs[k].surface.kind for k, mesh in made.items() if not mesh.failure}
    assert kinds >= {"plane", "cylinder", "cone", "torus", "bspline", "extrusion", "revolution"}


def test_what_the_core_does_not_know_is_left():
    jobs = jobs_of(loft(), 0.3)
    job = next(j for j in jobs if j.surface.kind == "bspline")
    assert GradedFaces().face(job) is not None
    limits = SizeLimits(np.zeros((1, 3)), np.ones(1), 0.2)
    laws = sm.Sizing(size=lambda points: np.full(len(points), 0.3))
    near = sm.Sizing(size=0.3, sources=[sm.Near((0, 0, 0), 0.1)])
    for sizing in (laws, near, sm.Sizing(chord=0.01, anisotropy=4.0), sm.Sizing()):
        assert asked_rules(sizing) is None
    for sizing in (laws, sm.Sizing(chord=0.01, proof=True)):
        assert GradedFaces().face(replace(job, sizing=sizing)) is None
    later = replace(job, limits=limits)
    assert GradedFaces().face(later) is None
    assert FaceQueue([later], [0]).left == [0]
    pole = next(j for j in jobs_of(cq.Workplane().sphere(1), 0.3) if j.boundary.has_degenerate)
    assert GradedFaces().face(pole) is None


def test_faces_with_poles_or_without_pieces_are_refused():
    (job,) = (j for j in jobs_of(cq.Workplane().sphere(1), 0.3) if j.boundary.has_degenerate)
    asked, manner = asked_rules(sm.Sizing(size=1.0)), core.FaceManner(None, None, 0.0)
    surface, steady = job.surface.core, (True, True)
    with pytest.raises(ValueError, match="degenerate"):
        core.GradedFace(surface, surface, steady, 1, job.boundary, asked, 0.2, manner)
    whole = next(j for j in jobs_of(loft(), 0.5) if not j.boundary.has_degenerate)
    with pytest.raises(ValueError, match="pieces"):
        core.GradedFace(surface, surface, steady, 0, whole.boundary, asked, 0.2, manner)
    with pytest.raises(ValueError, match="slope"):
        core.GradedFace(surface, surface, steady, 1, whole.boundary, asked, 0.0, manner)
